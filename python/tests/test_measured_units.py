"""Units of columns: what is told of a wrong one has an effect on it, and on no other column."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from test_measured_kinds import JOINT
from test_slips import DRIVE, FLIGHT, POSES, Rows, brought, in_frames, refused, scaled, with_table

from dwell.csv_values import TimeParser
from dwell.measured.importing import import_files

DEGREES = 180 / math.pi
LENGTHS = dict.fromkeys("xyz", "m")
VELOCITIES = dict.fromkeys(("vx", "vy", "vz"), "m/s")


def followed(mapping: dict[str, Any], told: str) -> dict[str, Any]:
    """The map with the units that a message tells."""
    at = told.index('"units": ') + len('"units": ')
    units, end = json.JSONDecoder().raw_decode(told, at)
    part = told[end:].split("in the map's ")[1].split()[0].rstrip(")")
    own = {**mapping[part].get("units", {}), **units}
    return {**mapping, part: {**mapping[part], "units": own}}


#: The map, what its units name, what is wrong, and what is told.
NAMED: list[tuple[dict[str, Any], dict[str, Any], Callable[[Rows], object], str]] = [
    (FLIGHT, {"t_s": "s"}, lambda rows: scaled(rows, 1e3, 1), '{"t_s": "ms"}'),
    (
        FLIGHT,
        LENGTHS,
        lambda rows: scaled(rows, 1e2, 2, 3, 4),
        '{"x": "cm", "y": "cm", "z": "cm"}',
    ),
    (FLIGHT, {"y": "m"}, lambda rows: scaled(rows, 1e2, 2, 3, 4), '"y": "cm"'),
    (FLIGHT, {"y": "m"}, lambda rows: scaled(rows, -1.0, 3), '{"y": {"factor": -1.0}}'),
    (POSES, {"t_s": "s"}, lambda rows: scaled(rows, 1e3, 1), '{"t_s": "ms"}'),
    (POSES, {"t_s": "s"}, lambda rows: scaled(rows, 1e2, 1), '{"t_s": {"factor": 0.01}}'),
    (
        POSES,
        LENGTHS | VELOCITIES,
        lambda rows: scaled(rows, 1e3, 2, 3, 4, 9, 10, 11),
        '"z": "mm", "vx": "mm/s"',
    ),
    (
        POSES,
        dict.fromkeys(("wx", "wy", "wz"), "rad/s"),
        lambda rows: scaled(rows, DEGREES, 12),
        '{"wx": "deg/s", "wy": "deg/s", "wz": "deg/s"}',
    ),
    (DRIVE, {"t_s": "s"}, lambda rows: scaled(rows, 1e3, 1), '{"t_s": "ms"}'),
    (DRIVE, {"x": "m"}, lambda rows: scaled(rows, 1e2, 2, 3), '{"x": "cm", "y": "cm"}'),
    (DRIVE, {"theta": "rad"}, lambda rows: scaled(rows, DEGREES, 4), '{"theta": "deg"}'),
]


@pytest.mark.parametrize(("mapping", "units", "change", "told"), NAMED)
def test_the_unit_of_a_column_that_units_name_is_told_there(
    tmp_path: Path,
    mapping: dict[str, Any],
    units: dict[str, Any],
    change: Callable[[Rows], object],
    told: str,
) -> None:
    """A key for all columns was told, which says nothing of those that units name."""
    named = with_table(mapping, units=units)
    said = refused(tmp_path, named, change)
    assert told in said
    assert "_per_unit" not in said
    assert brought(tmp_path, followed(named, said), change)["episodes"] == 4


def test_frames_of_a_named_column_are_told_by_their_rate(tmp_path: Path) -> None:
    named = with_table(FLIGHT, units={"t_s": "s"})
    said = refused(tmp_path, named, in_frames)
    assert 'import with "units": {"t_s": {"per_second": 60}} in the map\'s table (60 is' in said
    right = with_table(FLIGHT, units={"t_s": {"per_second": 100}})
    assert brought(tmp_path, right, in_frames)["episodes"] == 4


@pytest.mark.parametrize("factor", [10.0, 0.1])
def test_lengths_that_are_wrong_by_ten_are_told_by_column_where_units_name_them(
    tmp_path: Path, factor: float
) -> None:
    def change(rows: Rows) -> None:
        scaled(rows, 1.0 / factor, 2, 3, 4)

    named = with_table(FLIGHT, units={axis: {"factor": 1.0} for axis in "xyz"})
    said = refused(tmp_path, named, change)
    word = {10.0: '{"factor": 10.0}', 0.1: '"dm"'}[factor]
    assert f"""Write {word} for the "units" of 'y' and of all lengths like it in the map""" in said
    assert "metres_per_unit" not in said
    units = dict.fromkeys("xyz", json.loads(word))
    assert brought(tmp_path, with_table(FLIGHT, units=units), change)["episodes"] == 4


def test_a_key_for_all_columns_is_told_beside_the_one_that_the_map_has(tmp_path: Path) -> None:
    def change(rows: Rows) -> None:
        scaled(rows, 2e3, 1)

    halved = with_table(FLIGHT, seconds_per_unit=0.5)
    said = refused(tmp_path, halved, change)
    assert 'import with "seconds_per_unit": 0.0005 in the map\'s table' in said
    mended = with_table(FLIGHT, seconds_per_unit=0.0005)
    assert brought(tmp_path, mended, change)["episodes"] == 4


@pytest.mark.parametrize(
    ("mapping", "key", "columns"),
    [
        (FLIGHT, "seconds_per_unit", ["t_s"]),
        (FLIGHT, "metres_per_unit", ["x", "y", "z"]),
        (POSES, "radians_per_unit", ["wx", "wy", "wz"]),
        (DRIVE, "metres_per_unit", ["x", "y"]),
        (DRIVE, "radians_per_unit", ["theta"]),
    ],
)
def test_a_key_without_effect_beside_units_is_refused(
    tmp_path: Path, mapping: dict[str, Any], key: str, columns: list[str]
) -> None:
    units = {column: {"factor": 1.0} for column in columns}
    told = refused(tmp_path, with_table(mapping, units=units, **{key: 0.001}))
    listed = " and of ".join(map(repr, columns))
    assert f"table: {key} has no effect, since 'units' has a unit of {listed}; leave" in told
    # One that is not named is read by it.
    del units[columns[-1]]
    assert brought(tmp_path, with_table(mapping, units=units, **{key: 1.0}))["episodes"] == 4


def test_scales_of_a_table_are_those_of_starts(tmp_path: Path) -> None:
    starts = {
        "file": "index.csv",
        "episode": "episode",
        "sample": "k",
        "velocity": ["a", "a", "a"],
        "angular_velocity": ["a", "a", "a"],
    }
    units = LENGTHS | VELOCITIES
    mapping = {**with_table(POSES, units=units, metres_per_unit=0.01), "starts": starts}
    brought(tmp_path, POSES)
    (tmp_path / "index.csv").write_text("episode,k,a\ne0,20,300\n")
    files = [tmp_path / "data.csv", tmp_path / "index.csv"]

    def imported(name: str, **more: object) -> list[dict[str, str]]:
        own = {**mapping, "starts": {**starts, **more}}
        (tmp_path / "map.json").write_text(json.dumps(own))
        import_files(files, tmp_path / "map.json", tmp_path / name, lambda *_: None)
        with (tmp_path / name / "starts.csv").open() as file:
            return list(csv.DictReader(file))

    assert imported("b.measured")[0]["vx"] == "3"
    with pytest.raises(ValueError, match="table: metres_per_unit has no effect"):
        imported("c.measured", units={"a": {"factor": 0.01}})
    with pytest.raises(ValueError, match="starts: units: column 'b' is none that the map reads"):
        imported("c.measured", units={"b": "m/s"})


def test_times_that_are_the_same_second_are_told_with_what_says_their_unit(
    tmp_path: Path,
) -> None:
    told = refused(tmp_path, with_table(POSES, units={"t_s": {"factor": 1e-12}}))
    assert "both are 0.000000000 s at 1e-12 s each" in told
    assert "correct the unit of 't_s' in 'units' in the map" in told
    with pytest.raises(ValueError, match="at 1e\\+38 s each; correct one of them"):
        TimeParser("t", 1e38, is_in_units=True).stamp("data.csv row 1", "e0", 1e300)


SERVO: dict[str, Any] = {
    "kind": "servo",
    "joint": JOINT,
    "table": {"file": "log.csv", "episode": "run", "t_s": "t", "position": "pos", "target": "goal"},
}


def followed_by(folder: Path, mapping: dict[str, Any], pos: float, goal: float) -> dict[str, Any]:
    """Imports five runs at 50 Hz of a joint that follows steps; a radian is so much of each."""
    rows, goals = ["run,t,pos,goal"], ["run,t,goal"]
    for run in range(5):
        angle = 0.0
        for k in range(200):
            target = 0.6 if (k // 40) % 2 else -0.2 * (run + 1)
            angle += 0.2 * (target - angle)
            rows.append(f"{run},{k / 50},{pos * angle},{goal * target}")
            goals.append(f"{run},{k / 50},{goal * target}")
    (folder / "log.csv").write_text("\n".join(rows) + "\n")
    (folder / "goals.csv").write_text("\n".join(goals) + "\n")
    (folder / "map.json").write_text(json.dumps(mapping))
    out = folder / "o.measured"
    files = [folder / name for name in ("log.csv", "goals.csv")]
    return import_files(files, folder / "map.json", out, lambda *_: None)


def apart(mapping: dict[str, Any]) -> dict[str, Any]:
    """The map with targets in a table of their own."""
    table = {key: value for key, value in mapping["table"].items() if key != "target"}
    commands = {"file": "goals.csv", "episode": "run", "t_s": "t", "target": "goal"}
    return {**mapping, "table": table, "commands": commands}


#: The map, how much a radian is of positions and targets, and the units that are told.
BOTH: list[tuple[dict[str, Any], float, float, str]] = [
    (SERVO, DEGREES, 1.0, '"units": {"pos": "deg"} in the map\'s table'),
    (SERVO, 1.0, DEGREES, '"units": {"goal": "deg"} in the map\'s table'),
    (apart(SERVO), 1.0, DEGREES, '"units": {"goal": "deg"} in the map\'s commands'),
    # Small motions, and those that one key for both has made small.
    (SERVO, 0.05 * DEGREES, 0.05, '"units": {"pos": "deg"} in the map\'s table'),
    (SERVO, 0.05, 0.05 * DEGREES, '"units": {"goal": "deg"} in the map\'s table'),
    (apart(SERVO), 0.05, 0.05 * DEGREES, '"units": {"goal": "deg"} in the map\'s commands'),
    (
        with_table(SERVO, radians_per_unit=1 / DEGREES),
        DEGREES,
        1.0,
        '"units": {"goal": "rad"} in the map\'s table',
    ),
    (
        with_table(SERVO, units={"pos": "deg", "goal": "deg"}),
        1.0,
        DEGREES,
        '"units": {"pos": "rad"} in the map\'s table',
    ),
]


@pytest.mark.parametrize(("mapping", "pos", "goal", "told"), BOTH)
def test_positions_and_targets_in_two_units_are_told_by_column(
    tmp_path: Path, mapping: dict[str, Any], pos: float, goal: float, told: str
) -> None:
    """One key for both was told, and made a joint that goes 57 times as far as its targets."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the sentence is looked at
        followed_by(tmp_path, mapping, pos, goal)
    said = str(caught.value)
    assert told in said
    assert "_per_unit" not in said
    assert followed_by(tmp_path, followed(mapping, said), pos, goal)["episodes"] == 5


@pytest.mark.parametrize("share", [1.0, 0.7, 0.1, 0.005])
def test_joints_that_do_not_reach_their_targets_are_imported(tmp_path: Path, share: float) -> None:
    assert followed_by(tmp_path, SERVO, share, 1.0)["episodes"] == 5
