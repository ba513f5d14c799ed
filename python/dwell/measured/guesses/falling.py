"""Along which axis things fall, whether up or down, and in which unit."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.measured.units import UNITS

Array = NDArray[np.float64]
_G_M_S2 = 9.81
_UNITS = ("m", "cm", "mm", "in", "ft")
#: Deviation from g that is taken for it; the share of samples that must fall, and how many times
#: as many must fall as rise alike, which noise does.
_TOLERANCE, _TELLING_SHARE, _TELLING_RATIO = 0.15, 0.05, 4.0
#: What a map says of axes, by the axis that falls and the sign of height along it.
AXES: dict[tuple[int, float], Any] = {
    (1, 1.0): "y_up",
    (2, 1.0): "z_up",
    (0, 1.0): ["y", "x", "-z"],
    (0, -1.0): ["y", "-x", "z"],
    (1, -1.0): ["x", "-y", "-z"],
    (2, -1.0): ["x", "-z", "y"],
}
#: Reaches of an acceleration: as parts of an episode, and in samples, which catch short flights.
_PARTS, _SAMPLES = (4, 8, 16), (2, 3, 5)


def falling(tracks: list[list[tuple[Array, Array]]]) -> tuple[int, float, str, float] | None:
    """The axis, the sign of height along it, the unit, and the acceleration found.

    Args:
        tracks: Of each axis, times (s) and numbers of each episode.

    Returns:
        ``None`` where too little falls.
    """
    best: tuple[float, tuple[int, float, str, float]] | None = None
    for axis, episodes in enumerate(tracks):
        for part, samples in [*((part, 1) for part in _PARTS), *((10**9, n) for n in _SAMPLES)]:
            found = [_accelerations(t, y, max(len(t) // part, samples)) for t, y in episodes]
            a = np.concatenate(found) if found else np.zeros(0)
            if len(a) < 8:
                continue
            for unit in _UNITS:
                g = _G_M_S2 / UNITS["length"][unit]
                near = {sign: np.abs(a + sign * g) < _TOLERANCE * g for sign in (1.0, -1.0)}
                for sign, fits in near.items():
                    share, other = float(fits.mean()), float(near[-sign].mean())
                    is_telling = share >= max(_TELLING_SHARE, _TELLING_RATIO * other)
                    if is_telling and (best is None or share > best[0]):
                        best = (share, (axis, sign, unit, float(np.median(-sign * a[fits]))))
    return None if best is None else best[1]


def _accelerations(t: Array, y: Array, reach: int) -> Array:
    """Of each sample with those so many before and after it."""
    if len(t) <= 2 * reach:
        return np.zeros(0)
    before, here, after = t[: -2 * reach], t[reach:-reach], t[2 * reach :]
    low, middle, high = y[: -2 * reach], y[reach:-reach], y[2 * reach :]
    with np.errstate(divide="ignore", invalid="ignore"):
        a = 2.0 * ((high - middle) / (after - here) - (middle - low) / (here - before))
        a /= after - before
    result: Array = a[np.isfinite(a)]
    return result
