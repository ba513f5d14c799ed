"""Spaces and buffers from the sensors' own specifications."""

from __future__ import annotations

import dataclasses
import multiprocessing
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector.utils import (
    create_shared_memory,
    read_from_shared_memory,
    write_to_shared_memory,
)
from numpy.typing import NDArray

from dwell import _native

_DTYPES: dict[str, Any] = {"uint8": np.uint8, "float32": np.float32, "int32": np.int32}


class SharedText(spaces.Text):
    """Text that also goes through the shared memory of ``gymnasium.vector.AsyncVectorEnv``.

    Gymnasium reads the text of its own space once, when the environments are made: it stays blank.
    """


class _Texts(Sequence[str]):
    """The texts of several environments as they stand in shared memory; a copy is a tuple."""

    def __init__(self, letters: NDArray[np.int32]) -> None:
        """Reads from ``letters``: code points, shape (environment, letter), 0 behind the end."""
        self._letters = letters

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401 - one text, or some
        return tuple(self)[index]

    def __len__(self) -> int:
        return len(self._letters)

    def __iter__(self) -> Iterator[str]:
        for row in self._letters:
            yield "".join(map(chr, row[row > 0]))

    def __eq__(self, other: object) -> bool:
        return tuple(self) == (tuple(other) if isinstance(other, Sequence) else other)

    def __repr__(self) -> str:
        return repr(tuple(self))

    def __deepcopy__(self, memo: dict[int, Any]) -> tuple[str, ...]:
        return tuple(self)

    __hash__ = None  # type: ignore[assignment] # it changes


@create_shared_memory.register(SharedText)
def _create(space: SharedText, n: int = 1, ctx: Any = multiprocessing) -> Any:  # noqa: ANN401 - gymnasium's
    return ctx.Array(np.dtype(np.int32).char, n * space.max_length)


def _letters(space: SharedText, shared_memory: Any) -> NDArray[np.int32]:  # noqa: ANN401 - gymnasium's
    return np.frombuffer(shared_memory.get_obj(), np.int32).reshape(-1, space.max_length)


@write_to_shared_memory.register(SharedText)
def _write(space: SharedText, index: int, value: str, shared_memory: Any) -> None:  # noqa: ANN401 - gymnasium's
    row = _letters(space, shared_memory)[index]
    row[:] = 0
    row[: len(value)] = [ord(letter) for letter in value]


@read_from_shared_memory.register(SharedText)
def _read(space: SharedText, shared_memory: Any, n: int = 1) -> _Texts:  # noqa: ANN401 - gymnasium's
    return _Texts(_letters(space, shared_memory))


def shareable(space: spaces.Space[Any]) -> spaces.Space[Any]:
    """The same space; of text one that goes through shared memory."""
    if not isinstance(space, spaces.Text) or isinstance(space, SharedText):
        return space
    lengths = {"min_length": space.min_length, "max_length": space.max_length}
    return SharedText(**lengths, charset="".join(space.character_list))


@dataclasses.dataclass(frozen=True)
class SensorSpace:
    """The specification of a sensor's observation; the table of docs and spaces."""

    name: str
    shape: tuple[int, ...]
    dtype: str
    unit: str
    low: float
    high: float
    about: str

    @property
    def is_text(self) -> bool:
        """True if the observation is a string."""
        return self.dtype == "text"

    @property
    def is_tokens(self) -> bool:
        """True if the observation is a row of numbers below ``high``: MultiDiscrete."""
        return self.unit == "token"

    def space(self) -> spaces.Space[Any]:
        """The observation's space."""
        if self.is_text:
            return SharedText(
                min_length=int(self.low), max_length=int(self.high), charset=_native.charset()
            )
        if self.is_tokens:
            return spaces.MultiDiscrete(np.full(self.shape, int(self.high)), dtype=np.int32)
        low, high = np.array([self.low, self.high]).astype(_DTYPES[self.dtype])
        box: spaces.Box[Any] = spaces.Box(low, high, self.shape, _DTYPES[self.dtype])
        return box

    def buffer(self, count: int) -> NDArray[Any] | None:
        """An array for ``count`` environments, (count, *shape); ``None`` for text."""
        return None if self.is_text else np.zeros((count, *self.shape), _DTYPES[self.dtype])


def specs(batch: _native.Batch) -> list[SensorSpace]:
    """The specifications of a batch's sensors, in order."""
    return [SensorSpace(**{**row, "shape": tuple(row["shape"])}) for row in batch.specs()]
