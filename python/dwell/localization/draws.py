"""Numbers drawn from a key: the same on every machine and with every version of NumPy."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

_Item = TypeVar("_Item")


class Draws:
    """A stream of random numbers of its own for each key."""

    def __init__(self, *key: str | int) -> None:
        """Begins the stream of a key, such as a purpose, a seed and a number."""
        words = hashlib.blake2b(repr(key).encode(), digest_size=16).digest()
        # Its raw bits are those of the published generator, and stay; NumPy's distributions may
        # change from one version to the next.
        self._bits = np.random.Philox(key=int.from_bytes(words, "little"))

    def uniforms(self, count: int) -> NDArray[np.float64]:
        """Numbers from 0 to below 1, each equally likely."""
        raw: NDArray[np.uint64] = np.asarray(self._bits.random_raw(count), np.uint64)
        return (raw >> np.uint64(11)).astype(np.float64) * 2.0**-53

    def uniform(self, low: float, high: float) -> float:
        """A number from ``low`` to ``high``."""
        return low + (high - low) * float(self.uniforms(1)[0])

    def below(self, count: int) -> int:
        """A whole number from 0 to below ``count``."""
        return min(int(self.uniforms(1)[0] * count), count - 1)

    def choice(self, items: Sequence[_Item]) -> _Item:
        """One of several, each equally likely."""
        return items[self.below(len(items))]

    def normals(self, count: int) -> NDArray[np.float64]:
        """Numbers of the standard normal distribution (G. Box, M. Muller, 1958)."""
        half = (count + 1) // 2
        radius = np.sqrt(-2.0 * np.log1p(-self.uniforms(half)))
        angle = 2.0 * np.pi * self.uniforms(half)
        return np.concatenate((radius * np.cos(angle), radius * np.sin(angle)))[:count]
