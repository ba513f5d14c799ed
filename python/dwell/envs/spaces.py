"""Spaces and buffers from the sensors' own specifications."""

from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import _native

_DTYPES: dict[str, Any] = {"uint8": np.uint8, "float32": np.float32, "int32": np.int32}


@dataclasses.dataclass(frozen=True)
class Spec:
    """What a sensor's observation looks like; the table of docs and spaces."""

    name: str
    shape: tuple[int, ...]
    dtype: str
    unit: str
    low: float
    high: float
    about: str

    @property
    def is_text(self) -> bool:
        """Whether the observation is a string."""
        return self.dtype == "text"

    @property
    def is_tokens(self) -> bool:
        """Whether the observation is a row of numbers below ``high``: MultiDiscrete."""
        return self.unit == "token"

    def space(self) -> spaces.Space[Any]:
        """The observation's space."""
        if self.is_text:
            return spaces.Text(min_length=1, max_length=int(self.high), charset=_native.charset())
        if self.is_tokens:
            return spaces.MultiDiscrete(np.full(self.shape, int(self.high)), dtype=np.int32)
        low, high = np.array([self.low, self.high]).astype(_DTYPES[self.dtype])
        box: spaces.Box[Any] = spaces.Box(low, high, self.shape, _DTYPES[self.dtype])
        return box

    def buffer(self, count: int) -> NDArray[Any] | None:
        """An array for ``count`` environments, (count, *shape); ``None`` for text."""
        return None if self.is_text else np.zeros((count, *self.shape), _DTYPES[self.dtype])


def specs(batch: _native.Batch) -> list[Spec]:
    """The specifications of a batch's sensors, in order."""
    rows = json.loads(batch.specs_json())
    return [Spec(**{**row, "shape": tuple(row["shape"])}) for row in rows]


def action_space() -> spaces.Discrete:
    """The space of one environment's action."""
    return spaces.Discrete(len(_native.actions()))
