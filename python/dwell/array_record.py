"""Records with arrays among their fields."""

from __future__ import annotations

import dataclasses

import numpy as np


class ArrayRecord:
    """A data class that compares arrays as a whole: made with ``eq=False``, and without a hash."""

    def __eq__(self, other: object) -> bool:
        """Whether all fields hold the same; NaN is the same as NaN."""
        if type(other) is not type(self):
            return NotImplemented
        return all(
            _same(getattr(self, field.name), getattr(other, field.name))
            for field in dataclasses.fields(self)  # type: ignore[arg-type] # of those that inherit
        )

    __hash__ = None  # type: ignore[assignment] # arrays may change


def _same(one: object, other: object) -> bool:
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    return bool(one == other)
