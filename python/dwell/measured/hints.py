"""Hints of the reader of bundles as hints for a map: they name the bundle's fields, in SI."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from dwell.measured.units import SCALES, Unit, written

#: A hint for all columns of a dimension: what is in another unit, and the key with its value.
_OF_ALL = re.compile(
    r"(?P<head>(?P<what>[a-z ]+) in [a-z]+\? Divide (?:them )?by [0-9.]+, or import with )"
    r'"(?P<key>[a-z_]+_per_unit)": (?P<value>[0-9.e-]+) in the map\'s table'
)
_OF_FRAMES = '"seconds_per_unit" in the map\'s table (1/60 is 0.0166667)'
_OF_HEIGHTS = '"metres_per_unit": -1 in the map\'s table'
#: Where a map names what hints speak of; other words mean all columns of a dimension.
_KEYS = {
    "positions": "position",
    "targets": "target",
    "headings": "heading_rad",
    "angular velocities": "angular_velocity",
}


@dataclass(frozen=True)
class FieldUnit:
    """Where a field of the bundle comes from.

    Attributes:
        column: The user's.
        dimension: What it measures.
        unit: That of its numbers.
        is_named: Whether ``units`` of the map name it, so that a scale of all columns says nothing
            of it.
        key: Where the part of the map names the column.
        part: The part of the map that has its unit.
    """

    column: str
    dimension: str
    unit: Unit
    is_named: bool
    key: str = ""
    part: str = "table"


def by_column(units: Sequence[tuple[FieldUnit, Unit]]) -> str:
    """The key ``units`` with new units of columns: values by the map's are told in those."""
    told = {own.column: written(own.unit.read_as(new), own.dimension) for own, new in units}
    return f'"units": {json.dumps(told, ensure_ascii=False)}'


def for_columns(fault: str, fields: Sequence[FieldUnit], names: Mapping[str, str]) -> str:
    """A fault whose hints name the user's columns, in units that replace those of the map.

    A hint for all columns of a dimension stays only where it has an effect on those that are meant,
    and on no others.

    Args:
        fault: A sentence with ``"units": {FIELD: {"factor": F, "zero": Z}}`` for values in SI, or
            with a key for all columns of a dimension.
        fields: What is read.
        names: The columns by the names of the bundle.
    """
    of = {own.column: own for own in fields}

    def of_fields(found: re.Match[str]) -> str:
        told: dict[str, dict[str, float]] = json.loads(found[1])
        if not told.keys() <= names.keys():
            return found[0]
        return by_column(
            [
                (of[names[name]], Unit(one["factor"], one.get("zero", 0.0)))
                for name, one in told.items()
            ]
        )

    def of_all(found: re.Match[str]) -> str:
        factor = Unit(float(found["value"]))
        scaled = _scaled(fields, found["key"])
        keys = [key for what, key in _KEYS.items() if found["what"].endswith(what)]
        meant = [own for own in fields if own.key.startswith(keys[0])] if keys else scaled
        if not meant:
            return found[0]
        if meant == scaled and not any(own.is_named for own in meant):
            value = meant[0].unit.read_as(factor).factor
            told = found["value"] if value == factor.factor else f"{value:.12g}"
            return f'{found["head"]}"{found["key"]}": {told} in the map\'s table'
        units = by_column([(own, factor) for own in meant])
        return f"{found['head']}{units} in the map's {meant[0].part}"

    fault = re.sub(r'"units": (\{".*?\}\})', of_fields, fault)
    fault = _OF_ALL.sub(of_all, fault)
    clocks = _scaled(fields, "seconds_per_unit")
    if any(own.is_named for own in clocks):
        told = json.dumps({clocks[0].column: {"per_second": 60}}, ensure_ascii=False)
        frames = f'"units": {told} in the map\'s table (60 is the number of frames a second)'
        fault = fault.replace(_OF_FRAMES, frames)
    height = of.get(names.get("y", ""))
    if height is not None and any(own.is_named for own in _scaled(fields, "metres_per_unit")):
        units = by_column([(height, Unit(-1.0))])
        fault = fault.replace(_OF_HEIGHTS, f"{units} in the map's table")
    return fault


def _scaled(fields: Sequence[FieldUnit], key: str) -> list[FieldUnit]:
    """The fields of the table whose columns a scale is for."""
    return [own for own in fields if own.part == "table" and SCALES.get(own.dimension) == key]
