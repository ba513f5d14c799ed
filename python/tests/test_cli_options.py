"""Options that nothing would read, and streams that take nothing."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from dwell import cli

HOUSE = "builtin:studio"
POINTS = "--source -2,1.5,1 --mic -1,1.5,1 --rays 5"
ROOM = """{"shoebox": [4, 3, 2.5], "walls": {"x0": "a", "x1": "a", "y0": "a", "y1": "a",
"z0": "a", "z1": "a"}, "materials": {"a": {"absorption": 0.1}}, "fs": 8000, "duration_s": 0.1,
"sources": [{"id": "s", "pos": [1, 1, 1]}], "receivers": [{"id": "r", "pos": [2, 2, 1]}]}"""


@pytest.mark.parametrize(
    ("command", "option"),
    [
        (f"ir {HOUSE} {POINTS} --receivers q", "receivers"),
        (f"ir {HOUSE} {POINTS} --format sofa", "format"),
        (f"ir {HOUSE} {POINTS} --level 9", "level"),
        (f"ir {HOUSE} --map edt --plot decay --source 1,1,1 --out x.png", "plot"),
        (f"ir {HOUSE} --map edt --head x.sofa --source 1,1,1 --out x.png", "head"),
        (f"ir {HOUSE} --grid 1 --mic 1,1,1 --out x", "mic"),
        (f"ir {HOUSE} --grid 1 --source 1,1,1 --sources 2 --out x", "source"),
        ("ir ROOM --source 1,1,1", "source"),
        ("ir ROOM --mic 1,1,1", "mic"),
        ("ir ROOM --rate-hz 8000", "rate-hz"),
        ("ir ROOM --ears", "ears"),
        ("ir ROOM --yaw-deg 30", "yaw-deg"),
        ("ir ROOM --bits 16", "bits"),
        ("ir ROOM --plot decay", "plot"),
        (f"render {HOUSE} --projection orthographic --fov-deg 50 --out x", "fov-deg"),
        (f"render {HOUSE} --width-m 3 --out x", "width-m"),
        (f"render {HOUSE} --map --columns 2 --out x", "columns"),
        (f"render {HOUSE} --dollhouse --pitch-deg 3 --out x", "pitch-deg"),
        ("render seed:0..2 --sheet --backend cpu --out x", "backend"),
        (f"bench load {HOUSE} --envs 3", "envs"),
        (f"bench env {HOUSE} --batch 3", "batch"),
        ("info --map x.json", "map"),
        (f"view {HOUSE} --seed 3 --out x.rrd", "seed"),
        ("replay x.replay --verify --width 40", "width"),
        ("measure import a.csv --init --out x.measured", "init"),
    ],
)
def test_options_that_nothing_would_read_are_refused(
    command: str,
    option: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.json").write_text(ROOM, "utf-8")
    assert cli.main(command.replace("ROOM", "room.json").split()) == 1
    assert f"--{option} " in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["room.json"]


def test_a_number_that_stands_twice_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["render", HOUSE, "--intrinsics", "fx=1,fx=2", "--out", "x"]) == 2
    assert "fx stands twice" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "field", "value"),
    [
        (f"render {HOUSE} --out x --yaw-deg -1e1", "yaw_deg", -10.0),
        (f"render {HOUSE} --out x --yaw-deg -1.5E0", "yaw_deg", -1.5),
        (f"render {HOUSE} --out x --yaw-deg -.5", "yaw_deg", -0.5),
        (f"render {HOUSE} --out x --at -2e-1,1,3", "at", (-0.2, 1.0, 3.0)),
        (f"render {HOUSE} --out x --at -.5,1,3", "at", (-0.5, 1.0, 3.0)),
        (f"localize make {HOUSE} --count 1 --out x --snr-db -1e1 5", "snr_db", [-10.0, 5.0]),
        (f"localize make {HOUSE} --count 1 --out x --snr-db -1e1 -5e-1", "snr_db", [-10.0, -0.5]),
    ],
)
def test_a_negative_number_of_any_form_is_a_value(words: str, field: str, value: object) -> None:
    args = cli.parser(words.split()[0]).parse_args(words.split())
    assert getattr(args, field) == value


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (f"render {HOUSE} --out x --yaw-deg -inf", "--yaw-deg: expected a finite number, found"),
        (f"render {HOUSE} --out x --yaw-deg -NaN", "--yaw-deg: expected a finite number, found"),
        (f"render {HOUSE} --out x --at -inf,1,2", "--at: expected finite numbers X,Y,Z, found"),
        (f"render {HOUSE} --out x --width -1e3", "--width: expected a whole number from 1 to"),
        (f"localize make {HOUSE} --count 1 --out x --snr-db -inf 5", "expected a finite number"),
        (f"render {HOUSE} --out x --yaw-deg --map", "--yaw-deg: expected one argument"),
    ],
)
def test_a_negative_number_that_does_not_fit_is_told_as_one(
    words: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(words.split()) == 2
    assert told in capsys.readouterr().err


def in_shell(command: str) -> subprocess.CompletedProcess[str]:
    whole = command.replace("dwell", f"{sys.executable} -m dwell", 1)
    return subprocess.run(
        whole, shell=True, capture_output=True, text=True, timeout=300, check=False
    )


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of Unix")
@pytest.mark.parametrize("command", ["--version", f"info {HOUSE}", f"describe {HOUSE}"])
def test_streams_that_are_closed_take_what_is_printed(command: str) -> None:
    for closed in (">&-", "2>&-", ">&- 2>&-"):
        done = in_shell(f"dwell {command} {closed}")
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    "command", ["--version", "--help", f"info {HOUSE} --json", f"describe {HOUSE}"]
)
def test_a_full_disk_behind_standard_output_is_named(command: str) -> None:
    done = in_shell(f"dwell {command} > /dev/full")
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1, done.stderr
    assert "standard output: No space left on device" in done.stderr


@pytest.mark.skipif(not Path("/proc/self/limits").exists(), reason="the limits of Linux")
def test_a_picture_that_memory_cannot_hold_is_refused(tmp_path: Path) -> None:
    done = subprocess.run(
        f"ulimit -v 1500000; exec {sys.executable} -m dwell render {HOUSE} --width 16000 "
        f"--height 16000 --sensors rgb,albedo --at 0,1.5,0 --out {tmp_path / 'out'}",
        shell=True,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 1
    assert "camera is 16000 by 16000 pixels" in done.stderr
    assert "take a smaller image" in done.stderr


@pytest.mark.parametrize(("told", "number"), [("from 1", "-1"), ("from 1", "0")])
def test_a_count_tells_one_range(
    told: str, number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["generate", "--count", number, "--out", "x"]) == 2
    said = capsys.readouterr().err
    assert f"a whole number {told}" in said
    assert "from 0" not in said


def test_a_name_that_the_stream_cannot_print_is_escaped(tmp_path: Path) -> None:
    house = tmp_path / "ä→.obj"
    house.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for encoding, told in (("ascii", "\\u00e4\\u2192"), ("latin-1", "ä\\u2192")):
        done = subprocess.run(
            [sys.executable, "-m", "dwell", "info", str(house), "--json"],
            env={**os.environ, "PYTHONIOENCODING": encoding},
            capture_output=True,
            timeout=300,
            check=False,
        )
        said = done.stdout.decode(encoding)
        assert done.returncode == 0, done.stderr
        assert told in said
        assert json.loads(said)["name"] == "ä→"


def test_a_house_that_is_no_text_is_told_as_one(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("describe", "info"):
        assert cli.main([command, "\udcff\udcfe bad.dwell"]) == 1
        said = capsys.readouterr().err
        assert "expected text that UTF-8 can hold" in said, said


def test_what_no_picture_can_show_or_be_written_to_is_said_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from dwell import sound_maps

    def computed(*_: object, **__: object) -> None:
        raise AssertionError("it was computed first")

    monkeypatch.setattr(sound_maps, "sound_map", computed)
    (tmp_path / "file").touch()
    command = ["ir", HOUSE, "--source", "1,1,1", "--map", "level"]
    assert cli.main([*command, "--level", "7", "--out", str(tmp_path / "a.png")]) == 1
    assert "--level is 7; the house has 1 storey" in capsys.readouterr().err
    assert cli.main([*command, "--out", str(tmp_path / "file" / "z.png")]) == 1
    assert f"{tmp_path / 'file'}: is no folder" in capsys.readouterr().err


def test_a_measured_room_s_numbers_are_told_by_its_own_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "room.json"
    for field, told in (
        ('"duration_s": 1e6', "room.json: duration_s is 1e+06; allowed is 0.02 to 20 s"),
        (
            '"duration_s": 1, "air": {"pressure_pa": 1}',
            "room.json: air.pressure_pa is 1; allowed is 30000 to 200000 Pa",
        ),
    ):
        path.write_text(ROOM.replace('"duration_s": 0.1', field), "utf-8")
        assert cli.main(["ir", str(path)]) == 1
        assert told in capsys.readouterr().err


@pytest.mark.parametrize("out", ["/", ".", ".."])
def test_a_map_is_no_folder(out: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["info", HOUSE, "--init-map", out]) == 1
    assert f"--init-map: {out} is there already; name a new file" in capfd.readouterr().err


def test_an_interruption_before_a_command_begins_is_told(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def stopped(name: str) -> None:
        raise KeyboardInterrupt

    # While modules are imported.
    monkeypatch.setattr(importlib, "import_module", stopped)
    assert cli.main(["info", HOUSE]) == 130
    assert capfd.readouterr().err == "dwell: interrupted\n"
