"""Units of columns, each turned into SI where it is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.arguments import finite_number
from dwell.measured.maps import scale

_DEGREE = math.pi / 180.0
_TURN = 2.0 * math.pi
#: The SI value of one of each unit, by what it measures.
UNITS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "length": {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    "angle": {"rad": 1.0, "mrad": 1e-3, "deg": _DEGREE, "turn": _TURN},
    "speed": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "km/h": 1.0 / 3.6},
    "spin": {"rad/s": 1.0, "deg/s": _DEGREE, "turn/s": _TURN, "rpm": _TURN / 60.0},
    "mass": {"kg": 1.0, "g": 1e-3, "lb": 0.45359237, "oz": 0.028349523125},
    "number": {"1": 1.0},
}
#: The map's older key for all columns of a dimension that have no unit of their own.
SCALES = {
    "time": "seconds_per_unit",
    "length": "metres_per_unit",
    "speed": "metres_per_unit",
    "angle": "radians_per_unit",
    "spin": "radians_per_unit",
}
#: Keys of a unit that is told by numbers: counts of an encoder, frames of a camera, or any factor.
_TOLD = {
    "counts_per_turn": ("angle", "spin"),
    "per_second": ("time",),
    "factor": tuple(UNITS),
    "zero": tuple(UNITS),
}


@dataclass(frozen=True)
class Unit:
    """What one unit of a column is, and which number stands for nothing."""

    factor: float = 1.0
    zero: float = 0.0

    def si(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Numbers of the column in SI."""
        result: NDArray[np.float64] = (values - self.zero) * self.factor
        return result

    def one(self, value: float) -> float:
        """A number of the column in SI."""
        return (value - self.zero) * self.factor

    def read_as(self, other: Unit) -> Unit:
        """The unit of numbers whose values by this one are told in another."""
        return Unit(other.factor * self.factor, self.zero + other.zero / self.factor)


def written(unit: Unit, dimension: str) -> str | dict[str, float]:
    """A unit as maps write it: by its name, or by numbers."""
    if unit.zero == 0.0:
        for name, factor in UNITS[dimension].items():
            if math.isclose(unit.factor, factor):
                return name
    numbers = {"factor": unit.factor, "zero": unit.zero}
    return {key: float(f"{value:.12g}") for key, value in numbers.items() if value != 0.0}


class ColumnUnits:
    """The units of a part of a map, by column."""

    def __init__(
        self, part: Mapping[str, Any], at: str, inherited: ColumnUnits | None = None
    ) -> None:
        """The key ``units`` and the older scales; those of ``inherited`` where it has none."""
        self._part = part
        self._at = at
        self._told: dict[str, Any] = dict(part.get("units") or {})
        #: What is read, and what it measures.
        self._asked: dict[str, str] = {}
        #: The scales by which another part reads its columns.
        self._lent: set[str] = set()
        self._inherited = inherited

    def names(self, column: str) -> bool:
        """Whether ``units`` name a column, so that the older scales say nothing of it."""
        return column in self._told

    def unit(self, column: str, dimension: str) -> Unit:
        """The unit of a column that measures a length, a time, ..."""
        self._asked[column] = dimension
        if not self.names(column):
            return self._default(dimension)
        told, at = self._told[column], f"{self._at}: units: column {column!r}"
        if told is None:
            raise ValueError(
                f"{at} has no unit; write one of {list(UNITS[dimension])}, or an object with one "
                f"of {list(_TOLD)}"
            )
        if isinstance(told, dict):
            return _by_numbers(told, dimension, at)
        if told not in UNITS[dimension]:
            others = [name for name, units in UNITS.items() if told in units]
            other = ""
            if others:
                other = f" is of {_with_article(others[0])}, and the column holds "
                other += _with_article(dimension)
            raise ValueError(
                f"{at} is in {told!r}{'' if not other else ', which' + other}; allowed is one of "
                f"{list(UNITS[dimension])}, or an object with one of {list(_TOLD)}"
            )
        return Unit(UNITS[dimension][told])

    def _default(self, dimension: str) -> Unit:
        key = SCALES.get(dimension)
        if key is None:
            return Unit()
        if self._part.get(key) is None and self._inherited is not None:
            self._inherited._lent.add(key)
            return self._inherited._default(dimension)
        return Unit(scale(self._part, key, self._at))

    def refuse_unused(self) -> None:
        """Refuses units of columns that the map reads nothing from."""
        for column in self._told:
            if column not in self._asked:
                raise ValueError(
                    f"{self._at}: units: column {column!r} is none that the map reads; those are "
                    f"{sorted(self._asked)}"
                )

    def refuse_idle(self) -> None:
        """Refuses older scales that say nothing, since ``units`` name all columns they are for."""
        for key in dict.fromkeys(SCALES.values()):
            columns = [name for name, what in self._asked.items() if SCALES.get(what) == key]
            is_idle = columns and all(map(self.names, columns)) and key not in self._lent
            if self._part.get(key) is not None and is_idle:
                raise ValueError(
                    f"{self._at}: {key} has no effect, since 'units' has a unit of "
                    f"{' and of '.join(map(repr, columns))}; leave {key} out, and write in 'units' "
                    "what their numbers are in"
                )


def _with_article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


def _by_numbers(told: dict[str, Any], dimension: str, at: str) -> Unit:
    """A unit that is told by numbers."""
    numbers = {}
    for key, value in told.items():
        if key not in _TOLD:
            raise ValueError(f"{at}: no key {key!r}; allowed are {list(_TOLD)}")
        if dimension not in _TOLD[key]:
            raise ValueError(f"{at}: {key} is of a {_TOLD[key][0]}; the column is a {dimension}")
        numbers[key] = finite_number(f"{at}: {key}", value)
        if key != "zero" and numbers[key] == 0.0:
            raise ValueError(f"{at}: {key} is 0; a finite number other than 0 is needed")
    factors = {
        "counts_per_turn": lambda value: _TURN / value,
        "per_second": lambda value: 1.0 / value,
        "factor": lambda value: value,
    }
    stated = [key for key in factors if key in numbers]
    if len(stated) != 1:
        raise ValueError(f"{at}: it has {list(told)}; exactly one of {list(factors)} is needed")
    factor = factors[stated[0]](numbers[stated[0]])
    if dimension == "time" and factor < 0:
        raise ValueError(f"{at}: {stated[0]} is {numbers[stated[0]]:g}; clocks go forwards")
    return Unit(factor, numbers.get("zero", 0.0))
