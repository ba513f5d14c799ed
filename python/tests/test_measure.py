"""Importing measurements: small tables, faults with their places, real sets where at hand."""

from __future__ import annotations

import csv
import gc
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import dwell
from dwell import _native
from dwell.measured.importing import import_files
from dwell.measured.readers import open_table

ROOT = Path(__file__).resolve().parents[2]
MAPS = ROOT / "examples" / "measured"
RATE_HZ = 100.0
HEAD = "id,t,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz"


def tosses(folder: Path, *, spin_in_body: bool = True) -> tuple[list[Path], Path]:
    """Six flights of a box that spins about its own x axis, which points up; world z up."""
    half = math.sqrt(0.5)
    with (folder / "poses.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(HEAD.split(","))
        for toss in range(6):
            for k in range(40):
                t = k / RATE_HZ
                a = 0.5 * 4.0 * t
                # World from body: a turn of -90 degrees about y puts body x upwards.
                c, s = math.cos(a), math.sin(a)
                turn = (half * c, half * s, -half * c, half * s)
                place = (0.3 * toss + t, 0.5 * t, 1.0 + 2.0 * t - 4.905 * t * t)
                spin = (4.0, 0.0, 0.0) if spin_in_body else (0.0, 0.0, 4.0)
                writer.writerow([toss, t, *place, *turn, 1.0, 0.5, 2.0 - 9.81 * t, *spin])
    mapping: dict[str, Any] = json.loads((MAPS / "cube_toss.json").read_text())
    del mapping["starts"]
    mapping["poses"]["rate_hz"] = RATE_HZ
    mapping["table"] |= {"file": "poses.csv", "episode": "id", "t_s": "t"}
    (folder / "map.json").write_text(json.dumps(mapping))
    return [folder / "poses.csv"], folder / "map.json"


def quiet(_fraction: float, _what: str) -> None:
    pass


def test_poses_arrive_with_the_vertical_turned(tmp_path: Path) -> None:
    files, mapping = tosses(tmp_path)
    out = tmp_path / "a.measured"
    counts = import_files(files, mapping, out, quiet)
    assert counts == {"rows": 240, "episodes": 6, "left_out": 0}
    with (out / "poses.csv").open() as file:
        row = list(csv.DictReader(file))[45]
    t = 5 / RATE_HZ
    assert float(row["x"]) == pytest.approx(0.3 + t)
    assert float(row["y"]) == pytest.approx(1.0 + 2.0 * t - 4.905 * t * t)
    assert float(row["z"]) == pytest.approx(-0.5 * t)
    # The body's x axis, which pointed up, points along the engine's y.
    x, y, z, w = (float(row[key]) for key in ("qx", "qy", "qz", "qw"))
    axis = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
    assert axis == pytest.approx((0.0, 1.0, 0.0), abs=1e-7)
    assert not list(tmp_path.glob(".a.measured*"))


def test_spin_in_the_wrong_frame_is_noticed_and_nothing_is_left(tmp_path: Path) -> None:
    files, mapping = tosses(tmp_path, spin_in_body=False)
    with pytest.raises(ValueError, match=r"wx, wy, wz against differences"):
        import_files(files, mapping, tmp_path / "a.measured", quiet)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.json", "poses.csv"]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m["table"].update(t_s="time"), "no column 'time'"),
        (lambda m: m["table"].update(file="other.csv"), "'other.csv' was not given"),
        (lambda m: m.update(colour="red"), "no key 'colour'"),
        (lambda m: m.update(kind="video"), "kind is 'video'"),
        (lambda m: m["table"].update(position=["px"]), "3 names of columns"),
        (lambda m: m["poses"].update(rate_hz=50.0), r"poses\.csv, episode 0: column 't' is"),
        (lambda m: m["table"].update(metres_per_unit=0.01), "against differences"),
    ],
)
def test_faults_of_the_map_are_named(tmp_path: Path, change: Any, told: str) -> None:  # noqa: ANN401 - a lambda
    files, path = tosses(tmp_path)
    mapping = json.loads(path.read_text())
    change(mapping)
    path.write_text(json.dumps(mapping))
    if told == "against differences":
        # Only velocities are off: positions in metres, velocities in cm/s.
        text = files[0].read_text().splitlines()
        rows = [line.split(",") for line in text]
        for row in rows[1:]:
            row[2:5] = [str(100.0 * float(value)) for value in row[2:5]]
        files[0].write_text("\n".join(",".join(row) for row in rows) + "\n")
    with pytest.raises(ValueError, match=told):
        import_files(files, path, tmp_path / "a.measured", quiet)


# Python reads "1_0" as ten; no table means that.
@pytest.mark.parametrize("cell", ["high", "1_0"])
def test_a_bad_cell_is_named_by_file_column_and_row(tmp_path: Path, cell: str) -> None:
    files, mapping = tosses(tmp_path)
    text = files[0].read_text().splitlines()
    cells = text[17].split(",")
    cells[4] = cell
    text[17] = ",".join(cells)
    files[0].write_text("\n".join(text) + "\n")
    told = rf"poses\.csv row 17: column 'pz' is '{cell}'"
    with pytest.raises(ValueError, match=told):
        import_files(files, mapping, tmp_path / "a.measured", quiet)


def test_the_command_prints_a_template_that_it_reads(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "dwell", "measure", "import"]
    for kind in ("pose_trajectory", "trajectory", "drive"):
        done = subprocess.run(
            [*command, "--init", kind], capture_output=True, text=True, check=True
        )
        assert json.loads(done.stdout)["kind"] == kind
    bare = subprocess.run(command, capture_output=True, text=True, check=False)
    assert bare.returncode == 2
    missing = [*command, "x.csv", "--map", str(tmp_path / "no.json"), "--out", str(tmp_path / "o")]
    assert subprocess.run(missing, capture_output=True, check=False).returncode == 1


def test_ticks_become_turns_of_wheels(tmp_path: Path) -> None:
    table, index = tmp_path / "data.csv", tmp_path / "index.csv"
    rows = ["episode,t_s,x,y,theta,ticks_right,ticks_left"]
    for name in "abcd":
        for k in range(60):
            # 100 ticks of 2796.8 a turn on a wheel of 42 mm are 9.436 mm.
            way = 100 / 2796.8 * 2 * math.pi * 0.042 * k
            rows.append(f"{name},{0.05 * k},{way},0,0,{100 if k else 0},{100 if k else 0}")
    table.write_text("\n".join(rows) + "\n")
    lines = [f"{name},straight,day{name}" for name in "abcd"]
    index.write_text("\n".join(["episode,path,set", *lines]) + "\n")
    mapping = json.loads((MAPS / "diffdrive_odometry.json").read_text())
    mapping["table"]["file"] = "data.csv"
    path = tmp_path / "map.json"
    path.write_text(json.dumps(mapping))
    out = tmp_path / "a.measured"
    assert import_files([table, index], path, out, quiet)["episodes"] == 4
    with (out / "drive.csv").open() as file:
        row = list(csv.DictReader(file))[1]
    assert float(row["left_rad"]) == pytest.approx(2 * math.pi * 100 / 2796.8)
    with (out / "episodes.csv").open() as file:
        first = next(csv.DictReader(file))
    assert (first["split_group"], first["conditions"]) == ("daya", "straight")
    index.write_text("\n".join(["episode,path,set", *lines, "a,curved,daya"]) + "\n")
    with pytest.raises(ValueError, match=r"index.csv row 5: episode 'a' is listed twice"):
        import_files([table, index], path, tmp_path / "b.measured", quiet)
    mapping["base"]["ticks_per_turn"] = 0
    path.write_text(json.dumps(mapping))
    with pytest.raises(ValueError, match="ticks_per_turn is 0"):
        import_files([table, index], path, tmp_path / "b.measured", quiet)


def test_a_ball_with_two_masses_is_refused(tmp_path: Path) -> None:
    mapping: dict[str, Any] = json.loads((MAPS / "ball_drops.json").read_text())
    about, part = mapping["bodies"], mapping["table"]
    about["file"], part["file"] = "index.csv", "data.csv"
    head = [about[key] for key in ("episode", "name", "mass_kg", "diameter_m")]
    flights = [part["episode"], part["t_s"], *part["channels"].values()]
    if part.get("split_group"):
        flights.append(part["split_group"])
    table, index, path = (tmp_path / name for name in ("data.csv", "index.csv", "map.json"))
    path.write_text(json.dumps(mapping))
    values = [[episode, 0.1 * k] for episode in "abcd" for k in range(9)]
    rows = [",".join(map(str, [*row, *[row[1]] * (len(flights) - 2)])) for row in values]
    table.write_text("\n".join([",".join(flights), *rows]) + "\n")
    lines = [",".join(head), *(f"{episode},ball,0.1,0.07" for episode in "abcd")]
    for row, told in (
        (
            "a,ball,0.9,0.07",
            "row 5: 'ball' has 0.9 kg and 0.07 m across, and in a row above",
        ),
        ("a,other,0.9,0.07", "row 5: episode 'a' has the body 'other', and in a row above 'ball'"),
    ):
        index.write_text("\n".join([*lines, row]) + "\n")
        with pytest.raises(ValueError, match=told):
            import_files([table, index], path, tmp_path / "b.measured", quiet)


def test_a_parquet_table_is_closed_where_its_rows_end(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet", reason="Parquet needs pyarrow")
    path = tmp_path / "data.parquet"
    parquet.write_table(pyarrow.table({"t_s": [0.0, 0.5], "y": [1.0, 2.0]}), path)
    # A file that is left open is a warning, which is an error here.
    table = open_table(path)
    assert table.columns == ["t_s", "y"]
    assert [*table.rows] == [(1, {"t_s": 0.0, "y": 1.0}), (2, {"t_s": 0.5, "y": 2.0})]
    del table
    gc.collect()


def shared() -> Path:
    default = ROOT.parent / "shared" / "data"
    return Path(os.environ.get("DWELL_SHARED_DATA", default)) / "measured" / "physics"


@pytest.mark.parametrize(
    ("name", "episodes"),
    [("cube_toss", 367), ("ball_drops", None), ("diffdrive_odometry", 114), ("servo_backlash", 10)],
)
def test_real_sets_are_imported_whole(tmp_path: Path, name: str, episodes: int | None) -> None:
    folder = shared() / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is absent")
    pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    out = tmp_path / f"{name}.measured"
    files = [folder / "data.parquet", folder / "index.csv"]
    counts = import_files(files, MAPS / f"{name}.json", out, quiet)
    assert counts["episodes"] == _native.check_measured(str(out))
    if episodes is not None:
        assert counts["episodes"] == episodes


def test_real_drops_fall_as_they_are_told_and_not_in_other_units(tmp_path: Path) -> None:
    """Whiffle balls, which air slows to a third of free fall, among bowling and golf balls."""
    folder = shared() / "ball_drops"
    if not folder.is_dir():
        pytest.skip(f"{folder} is absent")
    mapping = json.loads((MAPS / "ball_drops.json").read_text("utf-8"))
    mapping["table"]["file"] = "data.csv"
    files = [folder / "data.csv", folder / "index.csv"]

    def imported(name: str, **changed: object) -> dict[str, Any]:
        path = tmp_path / f"{name}.json"
        path.write_text(json.dumps({**mapping, **changed}))
        return import_files(files, path, tmp_path / f"{name}.measured", quiet)

    assert "notes" not in imported("right")
    for name, changed, told in [
        ("dm", {"table": {**mapping["table"], "metres_per_unit": 0.1}}, "lengths in metres?"),
        ("long", {"table": {**mapping["table"], "seconds_per_unit": 2}}, "times in seconds?"),
        ("heavy", {"g_m_s2": 98.1}, "so things fall on Earth"),
    ]:
        with pytest.raises(ValueError, match=re.escape(told)):
            imported(name, **changed)
    for name, g_m_s2 in [("moon", 1.62), ("none", 0.0), ("giant", 25.0)]:
        assert "so things fall on Earth" in imported(name, g_m_s2=g_m_s2)["notes"][0]


def test_two_tables_of_one_name_are_refused(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    first, second = tmp_path / "x.csv", tmp_path / "sub" / "x.csv"
    for path in (first, second):
        path.write_text("t\n0\n")
    told = refused(first, second, tmp_path=tmp_path, mapping={"kind": "trajectory"})
    assert f"{second}: has the name of {first}" in told


def test_a_channel_is_named_by_text(tmp_path: Path) -> None:
    table = tmp_path / "x.csv"
    table.write_text("t,e,m,d\n0,1,1,0.1\n")
    part = {"file": "x.csv", "episode": "e", "t_s": "t", "channels": {"y": 5}}
    bodies = {"file": "x.csv", "episode": "e", "name": "t", "mass_kg": "m", "diameter_m": "d"}
    mapping = {"kind": "trajectory", "title": "t", "licence": "l", "bodies": bodies, "table": part}
    told = refused(table, tmp_path=tmp_path, mapping=mapping)
    assert "channels.y is 5; the name of a column (text) is needed" in told


def refused(*tables: Path, tmp_path: Path, mapping: dict[str, object]) -> str:
    """The error with which an import of tables is refused."""
    path = tmp_path / "map.json"
    path.write_text(json.dumps(mapping))
    with pytest.raises(ValueError, match=r".") as caught:
        import_files([*tables], path, tmp_path / "o.measured", lambda *_: None)
    return str(caught.value)


def test_a_link_that_leads_to_nothing_and_a_map_that_is_a_list_are_told(tmp_path: Path) -> None:
    files, mapping = tosses(tmp_path)
    out = tmp_path / "a.measured"
    out.symlink_to(tmp_path / "nowhere")
    with pytest.raises(FileExistsError, match=r"a\.measured: is a link that leads to nothing"):
        import_files(files, mapping, out, quiet)
    mapping.write_text("[]")
    with pytest.raises(ValueError, match=r"map\.json: found \[\]; an object"):
        import_files(files, mapping, tmp_path / "b.measured", quiet)


def test_a_full_disk_is_told_with_the_bundle_s_name(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    files, mapping = tosses(tmp_path)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with pytest.raises(OSError, match="File too large") as refused:
            import_files(files, mapping, tmp_path / "a.measured", quiet)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert refused.value.filename == str(tmp_path / "a.measured")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.json", "poses.csv"]


def test_episodes_that_are_left_out_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell import cli

    mapping: dict[str, Any] = json.loads((MAPS / "ball_drops.json").read_text())
    about, part = mapping["bodies"], mapping["table"]
    about |= {"file": "index.csv", "episode": "e", "name": "b", "mass_kg": "m", "diameter_m": "d"}
    part |= {"file": "data.csv", "episode": "e", "t_s": "t", "channels": {"y": "y"}}
    part.pop("split_group", None)
    (tmp_path / "map.json").write_text(json.dumps(mapping))
    rows = [f"{e},{k / 15},{9 - 4.905 * (k / 15) ** 2}" for e in "abcde" for k in range(15)]
    (tmp_path / "data.csv").write_text("\n".join(["e,t,y", *rows]) + "\n")
    lines = [f"{e},ball{e},0.1,0.07" for e in "abcd"]
    (tmp_path / "index.csv").write_text("\n".join(["e,b,m,d", *lines]) + "\n")
    command = ["measure", "import", str(tmp_path / "data.csv"), str(tmp_path / "index.csv")]
    command += ["--map", str(tmp_path / "map.json"), "--out", str(tmp_path / "o.measured")]
    assert cli.main(command) == 0
    assert "1 left out, without mass and diameter of their bodies: 'e'" in capsys.readouterr().out


def test_a_bundle_is_no_file(tmp_path: Path) -> None:
    for name in ("b.csv", "b.PARQUET", "b.json"):
        with pytest.raises(
            dwell.ConfigError, match=r"ends the name of a file; allowed is .*b\.meas"
        ):
            import_files([], tmp_path / "map.json", tmp_path / name, lambda *_: None)
    # Names with points are names.
    with pytest.raises(FileNotFoundError):
        import_files([], tmp_path / "map.json", tmp_path / "throws.v1.2", lambda *_: None)


def test_what_cannot_be_used_is_measured_data(tmp_path: Path) -> None:
    (tmp_path / "map.json").write_text('{"kind": "x"}')
    with pytest.raises(dwell.MeasuredDataError, match=r"map\.json: kind is 'x'"):
        import_files([], tmp_path / "map.json", tmp_path / "b.measured", lambda *_: None)
