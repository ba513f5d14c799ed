"""What people get wrong about tables of measurements: each slip is told with what to change."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dwell.measured import import_files

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
    """What is said of it."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the caller looks at the sentence
        brought(folder, *arguments, **more)
    assert not (folder / "o.measured").exists()
    return str(caught.value)


def with_table(mapping: dict[str, Any], **more: object) -> dict[str, Any]:
    return {**mapping, "table": {**mapping["table"], **more}}


@pytest.mark.parametrize("mapping", [FLIGHT, POSES, DRIVE], ids=["flight", "poses", "drive"])
def test_what_is_right_is_imported(tmp_path: Path, mapping: dict[str, Any]) -> None:
    assert brought(tmp_path, mapping)["episodes"] == 4


def put(row: int, column: int, value: object) -> Callable[[Rows], object]:
    return lambda rows: rows[row - 1].__setitem__(column, value)


SAYS: list[tuple[dict[str, Any], Callable[[Rows], object], str]] = [
    (FLIGHT, put(17, 3, ""), "data.csv row 17: column 'y' is empty.*: fill it in, or leave"),
    (FLIGHT, put(17, 3, "NaN"), "data.csv row 17: column 'y' is 'NaN'.*: fill it in, or leave"),
    (FLIGHT, put(17, 3, "1.2 m"), "row 17: column 'y' is '1.2 m'.*: the number alone"),
    (FLIGHT, put(17, 3, '"1,25"'), "row 17: column 'y' is '1,25'.*decimal comma. Write 1.25"),
    (FLIGHT, lambda rows: rows[16].pop(), "row 17: 4 cells, and the head has 5: a cell is missing"),
    (FLIGHT, lambda rows: rows[16].append(1), "row 17: 6 cells, and the head has 5: a cell too"),
    (FLIGHT, put(11, 1, 5.09), r"row 11: column 't_s' is 5.09 again \(row 10\).*stands twice"),
    (FLIGHT, put(11, 1, 5.01), r"row 11: column 't_s' is 5.01 after 5.09 .*sort its rows by time"),
    (FLIGHT, put(1, 0, "e1"), "'t_s' is 5 after 5 |'t_s' is 5 again .*name of its own"),
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


def test_maps_and_lists_of_bodies_are_told_with_what_to_change(tmp_path: Path) -> None:
    assert "no row has both 'mass_kg' (kg)" in refused(tmp_path, FLIGHT, index=("0.0027", ""))
    told = refused(tmp_path, FLIGHT, index=("\ne", "\nE"))
    assert "episodes are called ['e0', 'e1', 'e2']" in told
    assert "write the same names" in told
    told = refused(tmp_path, with_table(FLIGHT, seconds_per_unit=0))
    assert "table: seconds_per_unit is 0; a finite number other than 0" in told


def test_columns_that_are_called_otherwise_are_offered(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, form=lambda text: text.replace("t_s,x", "t [s],x (m)"))
    assert "no column 't_s'; it has ['episode', 't [s]', 'x (m)', 'y', 'z']" in told
    assert "write 't [s]' in the map" in told
    told = refused(tmp_path, FLIGHT, form=lambda text: text.replace("t_s,x,y", "t_s,x,x"))
    assert "column 'x' stands 2 times" in told


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
