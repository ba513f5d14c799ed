"""Hints of the reader of bundles as hints for a map: they name the bundle's fields, in SI."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass

from dwell.measured.units import Unit


@dataclass(frozen=True)
class FieldUnit:
    """Where a field of the bundle comes from.

    Attributes:
        column: The user's.
        unit: That of its numbers.
        is_told: Whether the map gives it, so that a scale of all columns may say nothing of it.
    """

    column: str
    unit: Unit
    is_told: bool


def for_columns(fault: str, fields: Mapping[str, FieldUnit]) -> str:
    """A fault whose hints name the user's columns, in units that replace those of the map.

    Args:
        fault: A sentence with ``"units": {FIELD: {"factor": F, "zero": Z}}`` for values in SI.
        fields: By the names of the bundle.
    """

    def units(told: Mapping[str, Mapping[str, float]]) -> str:
        hinted: dict[str, dict[str, float]] = {}
        for name, one in told.items():
            own = fields[name]
            new = own.unit.read_as(Unit(one["factor"], one.get("zero", 0.0)))
            numbers = {"factor": new.factor, "zero": new.zero}
            hinted[own.column] = {
                key: float(f"{value:.12g}") for key, value in numbers.items() if value != 0.0
            }
        return f'"units": {json.dumps(hinted, ensure_ascii=False)}'

    def radians(found: re.Match[str]) -> str:
        if not fields["heading"].is_told:
            return found[0]
        return units({"heading": {"factor": float(found[1])}})

    fault = re.sub(r'"units": (\{".*?\}\})', lambda found: units(json.loads(found[1])), fault)
    return re.sub(r'"radians_per_unit": ([0-9.]+)', radians, fault)
