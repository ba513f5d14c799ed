"""The command line as a user meets it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import wave
from pathlib import Path

import pytest

HOUSE = "builtin:apartment"


def dwell(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "dwell.cli", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def one_object(done: subprocess.CompletedProcess[str]) -> dict[str, object]:
    assert done.returncode == 0, done.stderr
    value = json.loads(done.stdout)
    assert isinstance(value, dict)
    return value


def test_exit_statuses_tell_failure_from_bad_usage() -> None:
    assert dwell("info", HOUSE).returncode == 0
    missing = dwell("info", "builtin:castle")
    assert missing.returncode == 1
    assert missing.stdout == ""
    assert "castle" in missing.stderr
    assert missing.stderr.count("\n") == 1
    assert dwell("cook", HOUSE).returncode == 2
    assert dwell("info").returncode == 2
    assert dwell("render", HOUSE, "--at", "1,2", "--out", "x").returncode == 2
    assert dwell().returncode == 2


def test_doctor_and_info_print_one_object() -> None:
    assert "cpu" in str(one_object(dwell("doctor", "--json"))["render_back_ends"])
    info = one_object(dwell("info", HOUSE, "--json"))
    assert {"rooms", "objects", "triangles"} <= set(info)


def test_render_writes_pictures_and_exact_arrays(tmp_path: Path) -> None:
    out = tmp_path / "views"
    sensors = "rgb,depth,instance,semantic"
    where = ("--at", "2,1.5,2", "--width", "64", "--height", "48")
    files = one_object(dwell("render", HOUSE, *where, "--sensors", sensors, "--out", out, "--json"))
    names = {Path(name).name for name in files["files"]}  # type: ignore[attr-defined]
    assert names >= {"view_rgb.png", "view_depth.npy", "view_instance.png"}
    assert not [path for path in out.iterdir() if path.name.startswith(".")]
    assert dwell("render", HOUSE, "--sensors", "smell", "--out", out).returncode == 1


def test_describe_writes_lines_and_reports_bad_houses(tmp_path: Path) -> None:
    out = tmp_path / "lines.jsonl"
    done = dwell("describe", HOUSE, "builtin:castle", "--level", "room", "--out", out)
    assert done.returncode == 1
    assert "castle" in done.stderr
    rows = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
    assert len(rows) >= 5
    assert all(row["text"].endswith(".") for row in rows)


def test_ir_writes_a_sound_and_its_measures(tmp_path: Path) -> None:
    out = tmp_path / "ir.wav"
    points = ("--source", "2,1.5,6", "--mic", "4,1.5,6")
    facts = one_object(dwell("ir", HOUSE, *points, "--rays", "500", "--out", out, "--json"))
    assert facts["peak_pa"]
    with wave.open(str(out)) as file:
        assert file.getframerate() == facts["rate_hz"]
        assert file.getnframes() == facts["samples"]
    assert dwell("ir", HOUSE).returncode == 1


@pytest.mark.parametrize("stage", ["load", "render", "physics"])
def test_bench_gives_its_figure(stage: str) -> None:
    key = {"load": "load_ms", "render": "views_per_s", "physics": "physics_steps_per_s"}[stage]
    small = ("--repeats", "1", "--steps", "5", "--resolution", "32")
    assert float(str(one_object(dwell("bench", stage, HOUSE, *small, "--json"))[key])) > 0.0


def test_calibrate_finds_what_the_example_hides(tmp_path: Path) -> None:
    from dwell import _native

    bundle = tmp_path / "throws.measured"
    hidden = _native.calibration_example(str(bundle), 1)
    out = tmp_path / "report"
    report = one_object(dwell("calibrate", bundle, "--out", out, "--json"))
    assert "drag" in hidden
    assert "drag" in str(report["sentence"])
    assert "<svg" in (out / "report.html").read_text("utf-8")
    found = json.loads((out / "found.json").read_text("utf-8"))
    assert found["laws"][0]["id"] == "drag"
    assert dwell("calibrate", tmp_path / "nothing").returncode == 1


def test_demo_writes_a_page_that_needs_no_network(tmp_path: Path) -> None:
    out = tmp_path / "demo"
    summary = one_object(dwell("demo", HOUSE, "--out", out, "--json"))
    assert summary["fulfilled"] is True
    page = (out / "index.html").read_text("utf-8")
    assert not re.search(r"(src|href)=[\"']?(https?:)?//", page)
    for name in re.findall(r"(?:src|href)=\"([^\"]+)\"", page):
        assert (out / name).stat().st_size > 0, name
    with wave.open(str(out / "errand.wav")) as sound:
        frames = sound.readframes(sound.getnframes())
    assert any(frames)
    assert dwell("demo", HOUSE, "--out", tmp_path).returncode == 1, "a folder that no demo wrote"
