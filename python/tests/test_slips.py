"""Common mistakes in tables of measurements: each is reported with its remedy."""

from __future__ import annotations

import itertools
import json
import math
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dwell.csv_values import TimeParser
from dwell.measured.importing import import_files

Rows = list[list[Any]]
FLIGHT: dict[str, Any] = {
    "kind": "trajectory",
    "bodies": {
        "file": "index.csv",
        "episode": "episode",
        "name": "ball",
        "mass_kg": "mass_kg",
        "diameter_m": "diameter_m",
    },
    "table": {
        "file": "data.csv",
        "episode": "episode",
        "t_s": "t_s",
        "channels": {"x": "x", "y": "y", "z": "z"},
    },
}
POSES: dict[str, Any] = {
    "kind": "pose_trajectory",
    "up": "z",
    "body": {"name": "cube", "mass_kg": 0.37, "half_extents_m": [0.05, 0.05, 0.05]},
    "board": {"friction": 0.2, "restitution": 0.1},
    "poses": {"rate_hz": 100.0, "angular_velocity": "body"},
    "table": {
        "file": "data.csv",
        "episode": "episode",
        "t_s": "t_s",
        "position": ["x", "y", "z"],
        "quaternion_xyzw": ["qx", "qy", "qz", "qw"],
        "velocity": ["vx", "vy", "vz"],
        "angular_velocity": ["wx", "wy", "wz"],
    },
}
DRIVE: dict[str, Any] = {
    "kind": "drive",
    "base": {
        "wheel_radius_m": 0.042,
        "wheel_base_m": 0.2,
        "rate_hz": 20.0,
        "ticks_per_turn": 2796.8,
    },
    "episodes": {
        "file": "index.csv",
        "episode": "episode",
        "split_group": "set",
        "conditions": "path",
    },
    "table": {
        "file": "data.csv",
        "episode": "episode",
        "t_s": "t_s",
        "position": ["x", "y"],
        "heading_rad": "theta",
        "ticks_left": "left",
        "ticks_right": "right",
    },
}
HEADS = {
    "trajectory": "episode,t_s,x,y,z",
    "pose_trajectory": "episode,t_s,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz",
    "drive": "episode,t_s,x,y,theta,left,right",
}


def flights() -> Rows:
    """Four throws of a ball, y up, 100 Hz."""
    rows: Rows = []
    for toss in range(4):
        for k in range(40):
            t = k / 100.0
            height = 1.5 + (2.0 + 0.3 * toss) * t - 4.905 * t * t
            rows.append([f"e{toss}", 5.0 + t, 1.0 + 2.0 * t, height, 1.0 + 0.5 * t])
    return rows


def poses() -> Rows:
    """Four flights of a box that spins about its own x axis, which points up; z up, 100 Hz."""
    rows: Rows = []
    half = math.sqrt(0.5)
    for toss in range(4):
        for k in range(40):
            t = k / 100.0
            c, s = half * math.cos(2.0 * t), half * math.sin(2.0 * t)
            place = (0.3 * toss + t, 0.5 * t, 1.0 + 2.0 * t - 4.905 * t * t)
            rates = (1.0, 0.5, 2.0 - 9.81 * t, 4.0, 0.0, 0.0)
            rows.append([f"e{toss}", t, *place, s, -c, s, c, *rates])
    return rows


def drives() -> Rows:
    """Four drives of a robot that turns left."""
    rows: Rows = []
    for drive in range(4):
        x = y = heading = 0.0
        for k in range(60):
            left, right = (90, 110) if k else (0, 0)
            ways = [ticks / 2796.8 * 2.0 * math.pi * 0.042 for ticks in (left, right)]
            turn, way = (ways[1] - ways[0]) / 0.2, sum(ways) / 2.0
            heading += turn
            x += way * math.cos(heading - 0.5 * turn)
            y += way * math.sin(heading - 0.5 * turn)
            rows.append([f"e{drive}", k / 20.0, x, y, heading, left, right])
    return rows


def scaled(rows: Rows, factor: float, *columns: int) -> None:
    for row in rows:
        for k in columns:
            row[k] *= factor


def exchanged(rows: Rows, a: int, b: int) -> None:
    for row in rows:
        row[a], row[b] = row[b], row[a]


def brought(
    folder: Path,
    mapping: dict[str, Any],
    change: Callable[[Rows], object] = lambda _: None,
    form: Callable[[str], str] = lambda text: text,
    index: tuple[str, str] = ("", ""),
) -> dict[str, int]:
    """Imports a table of which ``change`` makes other rows, and ``form`` another file."""
    kind = mapping["kind"]
    rows = {"trajectory": flights, "pose_trajectory": poses, "drive": drives}[kind]()
    change(rows)
    lines = [HEADS[kind], *(",".join(map(str, row)) for row in rows)]
    folder.joinpath("data.csv").write_bytes(form("\n".join(lines) + "\n").encode("utf-8"))
    heads = {"trajectory": "episode,ball,mass_kg,diameter_m", "drive": "episode,set,path"}
    about = {"trajectory": "ball,0.0027,0.04", "drive": "s,straight"}
    told = [f"e{k},{about.get(kind)}" for k in range(4)]
    text = "\n".join([heads.get(kind, "episode"), *told]) + "\n"
    folder.joinpath("index.csv").write_text(text.replace(*index))
    folder.joinpath("map.json").write_text(json.dumps(mapping))
    files = [folder / "data.csv", folder / "index.csv"]
    return import_files(files, folder / "map.json", folder / "o.measured", lambda *_: None)


def refused(folder: Path, *arguments: Any, **more: Any) -> str:  # noqa: ANN401 - as those of `brought`
    """The error's sentence."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the caller looks at the sentence
        brought(folder, *arguments, **more)
    assert not (folder / "o.measured").exists()
    return str(caught.value)


def with_table(mapping: dict[str, Any], **more: object) -> dict[str, Any]:
    return {**mapping, "table": {**mapping["table"], **more}}


@pytest.mark.parametrize("mapping", [FLIGHT, POSES, DRIVE], ids=["flight", "poses", "drive"])
def test_what_is_right_is_imported(tmp_path: Path, mapping: dict[str, Any]) -> None:
    assert brought(tmp_path, mapping)["episodes"] == 4


UNITS: list[tuple[dict[str, Any], Callable[[Rows], object], str, float]] = [
    (FLIGHT, lambda rows: scaled(rows, 1e3, 1), "seconds_per_unit", 0.001),
    (FLIGHT, lambda rows: scaled(rows, 1e3, 2, 3, 4), "metres_per_unit", 0.001),
    (FLIGHT, lambda rows: scaled(rows, 1e2, 2, 3, 4), "metres_per_unit", 0.01),
    (FLIGHT, lambda rows: scaled(rows, -1.0, 3), "metres_per_unit", -1),
    (POSES, lambda rows: scaled(rows, 1e3, 1), "seconds_per_unit", 0.001),
    (POSES, lambda rows: scaled(rows, 1e2, 1), "seconds_per_unit", 0.01),
    (POSES, lambda rows: scaled(rows, 1e2, 2, 3, 4, 9, 10, 11), "metres_per_unit", 0.01),
    (POSES, lambda rows: scaled(rows, 1e3, 2, 3, 4, 9, 10, 11), "metres_per_unit", 0.001),
    (POSES, lambda rows: scaled(rows, 180 / math.pi, 12), "radians_per_unit", math.pi / 180),
    (DRIVE, lambda rows: scaled(rows, 1e3, 1), "seconds_per_unit", 0.001),
    (DRIVE, lambda rows: scaled(rows, 1e2, 2, 3), "metres_per_unit", 0.01),
    (DRIVE, lambda rows: scaled(rows, 180 / math.pi, 4), "radians_per_unit", math.pi / 180),
]


@pytest.mark.parametrize(("mapping", "change", "key", "value"), UNITS)
def test_another_unit_is_named_with_the_key_of_the_map_that_mends_it(
    tmp_path: Path,
    mapping: dict[str, Any],
    change: Callable[[Rows], object],
    key: str,
    value: float,
) -> None:
    told = refused(tmp_path, mapping, change)
    assert f'"{key}": {str(value)[:6]}' in told, told
    assert brought(tmp_path, with_table(mapping, **{key: value}), change)["episodes"] == 4


def bounced(rows: Rows) -> None:
    """The third throw meets the floor and rises again."""
    for row in rows:
        t = row[1] - 5.2
        if row[0] == "e2" and t > 0.0:
            row[3] = 0.02 + 3.0 * t - 4.905 * t * t
        elif row[0] == "e2":
            row[3] = 0.02 - 3.0 * t - 4.905 * t * t


def flat(rows: Rows) -> None:
    # A ball with topspin, which falls at twice g, seen to a millimetre as cameras see table tennis.
    ways = [(0.007 * k, k) for k in range(25)]
    rows[:] = [
        [f"e{name}", t, 4.0 * t, 1.0 - 10.0 * t * t, 0.001 * (k % 3 == 1)]
        for name in range(4)
        for t, k in ways
    ]


def test_steps_of_what_measures_are_no_fall_along_another_axis(tmp_path: Path) -> None:
    assert brought(tmp_path, FLIGHT, flat)["episodes"] == 4


def test_a_bounce_is_told_with_where_to_cut(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, bounced)
    assert "data.csv, episode e2: column 'y' is falling until t_s 5.19" in told
    assert "rising by 0.3" in told
    assert "Leave out the rows from there on" in told
    assert brought(tmp_path, FLIGHT, cut)["episodes"] == 4


def cut(rows: Rows) -> None:
    bounced(rows)
    rows[:] = [row for row in rows if row[0] != "e2" or row[1] <= 5.2]


def put(row: int, column: int, value: object) -> Callable[[Rows], object]:
    return lambda rows: rows[row - 1].__setitem__(column, value)


def counted_on(rows: Rows) -> None:
    for before, row in itertools.pairwise(rows):
        if row[0] == before[0]:
            row[5] += before[5]
            row[6] += before[6]


SAYS: list[tuple[dict[str, Any], Callable[[Rows], object], str]] = [
    (FLIGHT, put(17, 3, "\uff11"), "row 17: column 'y' is '\uff11'; a finite number is needed"),
    (FLIGHT, put(17, 3, "1.2 m"), "row 17: column 'y' is '1.2 m'.*: the number alone"),
    (FLIGHT, put(17, 3, '"1,25"'), "row 17: column 'y' is '1,25'.*decimal comma. Write 1.25"),
    (FLIGHT, lambda rows: rows[16].pop(), "row 17: 4 cells, and the head has 5: a cell is missing"),
    (FLIGHT, lambda rows: rows[16].append(1), "row 17: 6 cells, and the head has 5: a cell too"),
    (FLIGHT, put(11, 1, 5.09), r"row 11: column 't_s' is 5.09 again \(row 10\).*stands twice"),
    (FLIGHT, put(11, 1, 5.01), r"row 11: column 't_s' is 5.01 after 5.09 .*sort its rows by time"),
    (FLIGHT, put(1, 0, "e1"), "'t_s' is 5 after 5 |'t_s' is 5 again .*name of its own"),
    (FLIGHT, lambda rows: exchanged(rows, 3, 4), 'is another axis up.*"y".*"channels"'),
    (POSES, lambda rows: exchanged(rows, 3, 4), "is another axis up|against differences"),
    (POSES, lambda rows: rows.pop(20), "1 missing before it: fill them in, or end"),
    (POSES, put(5, 8, 5.0), "the length of qx, qy, qz, qw is .* are they the quaternion"),
    (DRIVE, lambda rows: exchanged(rows, 5, 6), "left and right exchanged"),
    (DRIVE, lambda rows: scaled(rows, -1.0, 4), "headings grow clockwise"),
    (DRIVE, lambda rows: scaled(rows, -1.0, 5, 6), "count backwards"),
    (DRIVE, counted_on, "counted since the start"),
    (DRIVE, lambda rows: scaled(rows, 1e-3, 5, 6), "way by the wheels over the tracker's is 0.00"),
    (DRIVE, lambda rows: scaled(rows, 0.0, 5, 6), "way by the wheels over the tracker's is 0.000"),
]


@pytest.mark.parametrize(("mapping", "change", "told"), SAYS)
def test_a_slip_is_told_with_what_to_change(
    tmp_path: Path,
    mapping: dict[str, Any],
    change: Callable[[Rows], object],
    told: str,
) -> None:
    with pytest.raises(ValueError, match=told):
        brought(tmp_path, mapping, change)


def dropped(rows: Rows, unit: float = 1.0) -> None:
    """Balls that fall 40 m through air, whose terminal speed is 20 m/s, at 15 Hz."""
    rows.clear()
    for ball in range(4):
        for k in range(46):
            t = k / 15.0
            way = 20.0**2 / 9.81 * math.log(math.cosh(9.81 * t / 20.0))
            rows.append([f"e{ball}", t, 0.0, (47.0 + ball - way) / unit, 0.0])


def test_feet_are_named_where_air_slows_what_falls(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, lambda rows: dropped(rows, 0.3048))
    assert "lengths in feet? Divide by 3.2808" in told
    assert brought(tmp_path, FLIGHT, dropped)["episodes"] == 4


def in_frames(rows: Rows) -> None:
    for k, row in enumerate(rows):
        row[1] = k % 40


def with_units(unit: str) -> dict[str, Any]:
    return with_table(FLIGHT, units=dict.fromkeys("xyz", unit))


def at_rate(per_second: float) -> dict[str, Any]:
    return with_table(FLIGHT, units={"t_s": {"per_second": per_second}})


FALLS: list[tuple[dict[str, Any], Callable[[Rows], object], str]] = [
    (with_units("mm"), lambda rows: scaled(rows, 1e2, 2, 3, 4), "lengths in centimetres?"),
    (with_units("dm"), lambda rows: None, "lengths in metres?"),
    (with_units("ft"), lambda rows: None, "lengths in metres?"),
    (FLIGHT, lambda rows: scaled(rows, 10.0, 2, 3, 4), "lengths in decimetres?"),
    (FLIGHT, lambda rows: scaled(rows, 0.1, 2, 3, 4), 'too small? Write "metres_per_unit": 10'),
    (FLIGHT, lambda rows: scaled(rows, 2.0, 1), 'rate? Write {"factor": 0.5} for its'),
    (at_rate(50.0), in_frames, "frame rate 100, not 50?"),
    (at_rate(200.0), in_frames, "frame rate 100, not 200?"),
    (with_table(FLIGHT, units={"t_s": "min"}), lambda rows: None, "times in seconds?"),
    (FLIGHT, lambda rows: scaled(rows, 1.0 / 60.0, 1), "times in minutes?"),
    *(
        ({**FLIGHT, "g_m_s2": g}, lambda rows: None, f"{g:g} by g_m_s2: so things fall on Earth")
        for g in (3.7, 98.1)
    ),
]


@pytest.mark.parametrize(("mapping", "change", "told"), FALLS)
def test_what_falls_by_another_acceleration_is_told_with_what_explains_it(
    tmp_path: Path, mapping: dict[str, Any], change: Callable[[Rows], object], told: str
) -> None:
    """All but minutes were imported without a word, and those were taken for milliseconds."""
    found = refused(tmp_path, mapping, change)
    assert "data.csv: what flies falls at about " in found
    assert told in found


def by_gravity(g_m_s2: float) -> Callable[[Rows], object]:
    def change(rows: Rows) -> None:
        for row in rows:
            row[3] += (4.905 - 0.5 * g_m_s2) * (row[1] - 5.0) ** 2

    return change


def through_air(rows: Rows) -> None:
    """A ball of foam (3 g, 7 cm across) is thrown up, with quadratic drag, c_d = 1."""
    rows.clear()
    pull = 0.5 * 1.2 * math.pi * 0.035**2 / 0.003
    for name in range(4):
        x, y, u, v = 0.0, 1.0, 2.0, 4.0 + name
        for k in range(500):
            if k % 10 == 0:
                rows.append([f"e{name}", k / 500.0, x, y, 0.0])
            speed = math.hypot(u, v)
            u -= pull * speed * u / 500.0
            v -= (9.81 + pull * speed * v) / 500.0
            x, y = x + u / 500.0, y + v / 500.0


@pytest.mark.parametrize("g", [0.0, 1.62, 3.71, 24.8])
def test_other_planets_are_imported_where_the_data_agrees(tmp_path: Path, g: float) -> None:
    done = brought(tmp_path, {**FLIGHT, "g_m_s2": g}, by_gravity(g))
    assert done == {"rows": 160, "episodes": 4, "left_out": 0}


def test_what_air_slows_and_buoyancy_carries_is_imported(tmp_path: Path) -> None:
    foam = ("0.0027,0.04", "0.003,0.07")
    assert "notes" not in brought(tmp_path, FLIGHT, through_air, index=foam)
    shutil.rmtree(tmp_path / "o.measured")
    # A balloon, with the air in it: what it falls by is nothing that is known.
    balloon = ("0.0027,0.04", "0.017,0.28")
    assert "notes" not in brought(tmp_path, FLIGHT, by_gravity(1.0), index=balloon)


@pytest.mark.parametrize("g", [0.0, 1.62, 25.0])
def test_a_gravity_that_is_none_of_the_data_is_noted(tmp_path: Path, g: float) -> None:
    """Calibration is there to find it."""
    found: dict[str, Any] = brought(tmp_path, {**FLIGHT, "g_m_s2": g})
    (note,) = found["notes"]
    assert f"about 9.81 m/s2 by column 'y', and free fall is {g:g} by g_m_s2: so things" in note


def test_what_no_slip_explains_is_noted(tmp_path: Path) -> None:
    # Of steel, which air does not slow.
    found: dict[str, Any] = brought(tmp_path, FLIGHT, by_gravity(5.0), index=("0.0027", "0.27"))
    (note,) = found["notes"]
    assert note.startswith("what flies falls at about 5 m/s2 by column 'y', and free fall is 9.8")
    assert note.endswith("are units, frame rate and g_m_s2 right?")


def test_a_gap_is_named(tmp_path: Path) -> None:
    def late(rows: Rows) -> None:
        for row in rows[20:40]:
            row[1] += 3.0

    told = refused(tmp_path, FLIGHT, late)
    assert "data.csv, episode e0: column 't_s' is 8.2 after 5.19" in told
    assert "less than 0.5 s from sample to sample: fill the gap in" in told


def test_faults_name_the_file_row_and_column_that_the_user_has(tmp_path: Path) -> None:
    def renamed(rows: Rows) -> None:
        for row in rows[40:80]:
            row[0] = "a\x1b[31m"

    cases: list[tuple[str, str]] = [
        (refused(tmp_path, FLIGHT, put(57, 3, 1e300)), "data.csv row 57: column 'y' is 1"),
        (refused(tmp_path, FLIGHT, put(57, 2, 1e300)), "data.csv row 57: column 'x' is 1"),
        (
            refused(tmp_path, FLIGHT, put(57, 1, 1e300)),
            "data.csv row 58: column 't_s' is 5.17 after 1e+300 (row 57)",
        ),
        (
            refused(tmp_path, FLIGHT, renamed, index=("e1", "a\x1b[31m")),
            "data.csv row 41: column 'episode' is",
        ),
        (
            refused(tmp_path, FLIGHT, index=("0.04", "0")),
            "index.csv row 1: half of column 'diameter_m' is 0",
        ),
        (
            refused(tmp_path, FLIGHT, index=("0.0027", "-1")),
            "index.csv row 1: column 'mass_kg' is -1",
        ),
        (refused(tmp_path, {**FLIGHT, "g_m_s2": -9.81}), "map.json: g_m_s2 is -9.81"),
        (refused(tmp_path, POSES, put(5, 2, 1e300)), "data.csv row 5: column 'x' is 1"),
        (refused(tmp_path, POSES, put(5, 4, 1e300)), "data.csv row 5: column 'z' is 1"),
        (
            refused(tmp_path, {**POSES, "body": {**POSES["body"], "mass_kg": -1}}),
            "map.json: body.mass_kg is -1",
        ),
        (refused(tmp_path, DRIVE, put(5, 4, 1e300)), "data.csv row 5: column 'theta' is 1"),
        (
            refused(tmp_path, {**DRIVE, "base": {**DRIVE["base"], "wheel_base_m": -1}}),
            "map.json: base.wheel_base_m is -1",
        ),
        (refused(tmp_path, FLIGHT, lambda rows: rows.__delitem__(slice(40, None))), "data.csv: 1"),
    ]
    for told, wanted in cases:
        assert told.startswith(f"{tmp_path}/{wanted}"), told
        assert ".measured" not in told, told


def test_maps_and_lists_of_bodies_are_told_with_what_to_change(tmp_path: Path) -> None:
    assert "how strong it is, which is 9.81" in refused(tmp_path, {**FLIGHT, "g_m_s2": -9.81})
    body = {**POSES["body"], "half_extents_m": [50, 50, 50]}
    assert "in millimetres? Divide it by 1000" in refused(tmp_path, {**POSES, "body": body})
    told = refused(tmp_path, FLIGHT, index=("0.0027", "2.7"))
    assert "is the mass in grams" in told
    told = refused(tmp_path, FLIGHT, index=("0.04", "4"))
    assert "are lengths in millimetres or centimetres" in told
    assert "no row has both 'mass_kg' (kg)" in refused(tmp_path, FLIGHT, index=("0.0027", ""))
    told = refused(tmp_path, FLIGHT, index=("\ne", "\nE"))
    assert "episodes are called ['e0', 'e1', 'e2']" in told
    assert "write the same names" in told
    up = {**POSES, "up": "y"}
    assert '"up": "z" in the map' in refused(tmp_path, up)
    told = refused(tmp_path, with_table(FLIGHT, seconds_per_unit=0))
    assert "table: seconds_per_unit is 0; a finite number other than 0" in told
    for mapping in (FLIGHT, POSES, DRIVE):
        told = refused(tmp_path, with_table(mapping, seconds_per_unit=-1))
        assert "table: seconds_per_unit is -1; a finite number above 0 is needed" in told
    told = refused(tmp_path, with_table(POSES, seconds_per_unit=1e-12))
    assert "data.csv row 2: column 't_s' is" in told
    assert "both are 0.000000000 s at seconds_per_unit 1e-12" in told
    with pytest.raises(ValueError, match=r"is 1e\+300, which is no finite number of seconds"):
        TimeParser("t", 1e38).stamp("data.csv row 1", "e0", 1e300)
    half = {**POSES, "poses": {**POSES["poses"], "rate_hz": 50.0}}
    assert "write 100.000000 for rate_hz" in refused(tmp_path, half)


def test_columns_that_are_called_otherwise_are_offered(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, form=lambda text: text.replace("t_s,x", "t [s],x (m)"))
    assert "no column 't_s'; it has ['episode', 't [s]', 'x (m)', 'y', 'z']" in told
    assert "write 't [s]' in the map" in told
    told = refused(tmp_path, FLIGHT, form=lambda text: text.replace("t_s,x,y", "t_s,x,x"))
    assert "2 columns are called 'x', and the map names one of them; give each a name" in told


@pytest.mark.parametrize(
    "form",
    [
        lambda text: text.replace(",", ";"),
        lambda text: text.replace(",", "\t"),
        lambda text: text.replace(",", ";").replace(".", ","),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("t_s,x", " t_s , x"),
        lambda text: text.replace("\n", "\r\n") + "\r\n\r\n",
    ],
    ids=["semicolons", "tabs", "decimal commas", "mark", "spaces", "blank lines"],
)
def test_files_as_spreadsheets_write_them_are_read(tmp_path: Path, form: Any) -> None:  # noqa: ANN401
    assert brought(tmp_path, FLIGHT, form=form) == {"rows": 160, "episodes": 4, "left_out": 0}
    rows = (tmp_path / "o.measured" / "trajectory.csv").read_text().splitlines()
    assert rows[5] == "e0,5.010000000,ball,y,1.5195095"


def test_files_that_are_no_utf_8_are_named(tmp_path: Path) -> None:
    brought(tmp_path, FLIGHT)
    files = [tmp_path / "data.csv", tmp_path / "index.csv"]
    for encoding, byte in (("utf-16", "0xff"), ("latin-1", "0xe9")):
        text = HEADS["trajectory"] + "\né0,1,1,1,1\n"
        files[0].write_bytes(text.encode(encoding))
        with pytest.raises(ValueError, match=rf"data\.csv: byte {byte} at \d+ is no UTF-8; save"):
            import_files(files, tmp_path / "map.json", tmp_path / "b.measured", lambda *_: None)


def test_a_map_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    brought(tmp_path, FLIGHT)
    mapping, files = tmp_path / "map.json", [tmp_path / "data.csv", tmp_path / "index.csv"]
    mapping.write_text("\ufeff" + mapping.read_text())
    import_files(files, mapping, tmp_path / "b.measured", lambda *_: None)


@pytest.mark.parametrize(
    ("mapping", "change", "told"),
    [
        (FLIGHT, {"channels": {"x": "x", "y": "y", "z": "x"}}, r"channels\.x and channels\.z"),
        (FLIGHT, {"channels": {"y": "t_s"}}, r"'t_s' is both t_s and channels\.y"),
        (POSES, {"position": ["x", "x", "z"]}, r"position\[0\] and position\[1\]"),
        (
            POSES,
            {"quaternion_xyzw": ["qx", "qy", "z", "qw"]},
            r"position\[2\] and z of the quaternion",
        ),
        (DRIVE, {"ticks_right": "left"}, "'left' is both ticks_left and ticks_right"),
    ],
)
def test_a_column_is_one_thing(
    tmp_path: Path, mapping: dict[str, Any], change: dict[str, Any], told: str
) -> None:
    changed = {**mapping, "table": {**mapping["table"], **change}}
    with pytest.raises(ValueError, match=told):
        brought(tmp_path, changed)


@pytest.mark.parametrize("alone", ["velocity", "angular_velocity"])
def test_velocities_of_tosses_come_together_or_not_at_all(tmp_path: Path, alone: str) -> None:
    (other,) = {"velocity", "angular_velocity"} - {alone}
    table = {key: value for key, value in POSES["table"].items() if key != other}
    with pytest.raises(ValueError, match=f"table: '{alone}' without '{other}'; both or neither"):
        brought(tmp_path, {**POSES, "table": table})


@pytest.mark.parametrize(
    ("mapping", "change", "told"),
    [
        (POSES, {"body": {"half_extents_m": [0.05, 0.05]}}, "body: half_extents_m is .* 3 numbers"),
        (POSES, {"body": {"inertia_kg_m2": [1, 1, "a"]}}, r"body: inertia_kg_m2\[2\] is 'a'"),
        (POSES, {"board": {"substances": ["rubber"]}}, "board: substances is .* names of two"),
        (POSES, {"board": {"friction": 11.0}}, r"board\.friction is 11"),
        (FLIGHT, {"noise_sd": {"x": 1e-3, "y": 0.0}}, r"noise_sd\.y is 0"),
        (FLIGHT, {"g_m_s2": -9.81}, "g_m_s2 is -9.81; .* which is 9.81"),
        (FLIGHT, {"environment": {"pressure_pa": 1013}}, "environment.pressure_pa is 1013"),
        (DRIVE, {"base": {"wheel_radius_m": 42.0}}, r"base\.wheel_radius_m is 42"),
    ],
)
def test_faults_of_a_map_are_told_as_the_map_s(
    tmp_path: Path, mapping: dict[str, Any], change: dict[str, Any], told: str
) -> None:
    changed = {**mapping}
    for key, value in change.items():
        changed[key] = {**mapping.get(key, {}), **value} if isinstance(value, dict) else value
    message = refused(tmp_path, changed)
    assert re.match(rf"{re.escape(str(tmp_path / 'map.json'))}: {told}", message), message
    assert "manifest" not in message


def test_what_is_null_in_a_map_is_not_there(tmp_path: Path) -> None:
    poses = {**POSES, "poses": {**POSES["poses"], "filtering": None}}
    poses["body"] = {**POSES["body"], "inertia_kg_m2": None}
    assert brought(tmp_path, poses)["episodes"] == 4
