"""Headings of drives: a slip is refused by its name, and what is told mends the import."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_slips import DRIVE, Rows, exchanged, refused, scaled, with_table
from test_slips import brought as brought_from

DEGREES = 180 / math.pi


def driven(rows: Rows) -> None:
    """Four drives of 15 s that turn to both sides, seen with some noise."""
    rng = np.random.default_rng(5)
    rows.clear()
    for drive in range(4):
        x, y, heading = 0.0, 0.0, 0.7 * drive - 1.0
        for k in range(300):
            left = (4 + 2 * math.sin(k / 30 + drive)) / 20 * (k > 0)
            right = (4 + 2 * math.cos(k / 40 + drive)) / 20 * (k > 0)
            turn = (right - left) * 0.042 / 0.2
            x += 0.5 * (left + right) * 0.042 * math.cos(heading + 0.5 * turn)
            y += 0.5 * (left + right) * 0.042 * math.sin(heading + 0.5 * turn)
            heading += turn
            seen = rng.normal([x, y, heading], [0.001, 0.001, 0.005])
            ticks = [round(rad / 2 / math.pi * 2796.8) for rad in (left, right)]
            rows.append([f"e{drive}", k / 20, *seen.tolist(), *ticks])


def slip(change: Callable[[Rows], object] = lambda _: None) -> Callable[[Rows], object]:
    """The drives with a slip."""

    def changed(rows: Rows) -> None:
        driven(rows)
        change(rows)

    return changed


def shifted(rows: Rows, by: float) -> None:
    for row in rows:
        row[4] += by


def clockwise_from_north(rows: Rows, unit: float = 1.0) -> None:
    scaled(rows, -1.0, 4)
    shifted(rows, math.pi / 2)
    scaled(rows, unit, 4)


def followed(mapping: dict[str, Any], told: str) -> dict[str, Any]:
    """The map as a message says it should be."""
    table = {**mapping["table"]}
    units = {**table.get("units", {})}
    if "Leave their unit out" in told:
        units.pop(table["heading_rad"])
    for found in re.finditer(r'"units": ', told):
        units.update(json.JSONDecoder().raw_decode(told, found.end())[0])
    if found := re.search(r'"radians_per_unit": ([0-9.]+)', told):
        table["radians_per_unit"] = float(found[1])
    if 'Exchange "ticks_left" and "ticks_right"' in told:
        table["ticks_left"], table["ticks_right"] = table["ticks_right"], table["ticks_left"]
    if 'Exchange the two columns of "position"' in told:
        table["position"] = table["position"][::-1]
    return {**mapping, "table": {**table, "units": units}}


def brought(folder: Path, *arguments: Any) -> list[list[float]]:  # noqa: ANN401 - as those of `brought_from`
    """The numbers of the bundle."""
    assert brought_from(folder, *arguments)["episodes"] == 4
    with (folder / "o.measured" / "drive.csv").open() as file:
        return [[float(cell) for cell in row[1:]] for row in list(csv.reader(file))[1:]]


#: What is wrong, units that the map tells, and what is told.
SLIPS: list[tuple[Callable[[Rows], object], dict[str, Any], str]] = [
    (lambda rows: scaled(rows, -1.0, 4), {}, "do headings grow clockwise"),
    (lambda rows: scaled(rows, -1.0, 4), {"theta": "deg"}, "do headings grow clockwise"),
    (lambda rows: scaled(rows, -DEGREES, 4), {"theta": "deg"}, "do headings grow clockwise"),
    (lambda rows: scaled(rows, -DEGREES, 4), {}, "in degrees.*do headings grow clockwise"),
    (clockwise_from_north, {}, "as of a compass"),
    (lambda rows: clockwise_from_north(rows, DEGREES), {"theta": "deg"}, "as of a compass"),
    (lambda rows: clockwise_from_north(rows, DEGREES), {}, "in degrees.*as of a compass"),
    (lambda rows: scaled(rows, DEGREES, 4), {}, "in degrees.*radians_per_unit"),
    (lambda rows: scaled(rows, DEGREES, 4), {"theta": "rad"}, "in degrees.*units"),
    (lambda _: None, {"theta": "deg"}, "radians read as degrees.*Leave their unit"),
    (lambda rows: shifted(rows, -math.pi / 2), {}, "from another axis than x"),
    (lambda rows: shifted(rows, math.pi), {}, "do headings point to the back"),
    (lambda rows: exchanged(rows, 5, 6), {}, "are left and right exchanged"),
    (lambda rows: scaled(rows, -1.0, 5, 6), {}, "do wheels count backwards"),
    (lambda rows: scaled(rows, -1.0, 3), {}, "Turn the sign of y"),
    (lambda rows: scaled(rows, -100.0, 3), {"x": "m", "y": "cm"}, "Turn the sign of y"),
    (lambda rows: exchanged(rows, 2, 3), {}, "Exchange the two columns of .position"),
]


@pytest.mark.parametrize(("change", "units", "told"), SLIPS)
def test_a_slip_is_told_and_what_is_told_mends_it(
    tmp_path: Path,
    change: Callable[[Rows], object],
    units: dict[str, Any],
    told: str,
) -> None:
    right = brought(tmp_path, DRIVE, slip())
    (tmp_path / "o.measured").rename(tmp_path / "right")
    mapping = with_table(DRIVE, units=units)
    said = refused(tmp_path, mapping, slip(change))
    assert re.search(told, said), said
    assert "column 'theta' is " in said
    assert "; or " not in said, said
    if "in degrees" not in told:
        assert "headings in degrees" not in said
    found = brought(tmp_path, followed(mapping, said), slip(change))
    off = np.array(found) - np.array(right)
    off[:, 3] = np.remainder(off[:, 3] + math.pi, 2 * math.pi) - math.pi
    assert np.abs(off).max() < 1e-6


def test_two_slips_of_different_columns_are_told_at_once(tmp_path: Path) -> None:
    def change(rows: Rows) -> None:
        scaled(rows, DEGREES, 4)
        exchanged(rows, 5, 6)

    said = refused(tmp_path, DRIVE, slip(change))
    assert "headings in degrees?" in said
    assert "left and right exchanged" in said
    assert brought(tmp_path, followed(DRIVE, said), slip(change))
