"""The command line as a user meets it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import wave
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dwell import _native, cli
from dwell.cli import info
from dwell.sounds import read_wav

HOUSE = "builtin:apartment"


Command = Callable[..., subprocess.CompletedProcess[str]]
pytestmark = pytest.mark.usefixtures("open_once")


def process(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """``dwell ARGUMENTS`` in a process of its own; the fixture ``command`` runs it in this one."""
    command = [sys.executable, "-m", "dwell", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def one_object(done: subprocess.CompletedProcess[str]) -> dict[str, object]:
    assert done.returncode == 0, done.stderr
    value = json.loads(done.stdout)
    assert isinstance(value, dict)
    return value


@pytest.fixture(scope="module")
def two_points() -> tuple[str, str]:
    """A viewpoint in the living room and the point below it, for the command line."""
    from dwell import House

    room = next(room for room in House.open(HOUSE).rooms() if "living room" in room["kinds"])
    (x, y, z), (stand_x, _, stand_z) = room["eye"], room["stand"]
    return f"{x},{y},{z}", f"{stand_x},1.5,{stand_z}"


@pytest.mark.long
def test_exit_statuses_tell_failure_from_bad_usage() -> None:
    assert process("info", HOUSE).returncode == 0
    missing = process("info", "builtin:castle")
    assert missing.returncode == 1
    assert missing.stdout == ""
    assert "castle" in missing.stderr
    assert missing.stderr.count("\n") == 1
    assert process("cook", HOUSE).returncode == 2
    assert process("render").returncode == 2
    assert process("render", HOUSE, "--at", "1,2", "--out", "x").returncode == 2
    assert process().returncode == 2


@pytest.mark.long
def test_doctor_and_info_print_one_object(monkeypatch: pytest.MonkeyPatch) -> None:
    # As on a server, where drivers of the desktop complain.
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    doctor = process("doctor", "--json")
    assert "XDG_RUNTIME_DIR" not in doctor.stderr
    assert "cpu" in str(one_object(doctor)["render_back_ends"])
    info = one_object(process("info", HOUSE, "--json"))
    assert {"rooms", "objects", "triangles"} <= set(info)


def test_render_writes_pictures_and_exact_arrays(
    tmp_path: Path, two_points: tuple[str, str], command: Command
) -> None:
    out = tmp_path / "views"
    sensors = "rgb,depth,instance,semantic"
    where = ("--at", two_points[0], "--width", "64", "--height", "48")
    files = one_object(
        command("render", HOUSE, *where, "--sensors", sensors, "--out", out, "--json")
    )
    names = {Path(name).name for name in files["files"]}  # type: ignore[attr-defined]
    assert names >= {"view_rgb.png", "view_depth.npy", "view_instance.png"}
    assert not [path for path in out.iterdir() if path.name.startswith(".")]
    assert command("render", HOUSE, "--sensors", "smell", "--out", out).returncode == 1


def test_describe_writes_lines_and_reports_bad_houses(tmp_path: Path, command: Command) -> None:
    out = tmp_path / "lines.jsonl"
    done = command("describe", HOUSE, "builtin:castle", "--level", "room", "--out", out)
    assert done.returncode == 1
    assert "castle" in done.stderr
    rows = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
    assert len(rows) >= 5
    assert all(row["text"].endswith(".") for row in rows)
    assert all(row["version"] == 1 for row in rows)


def test_ir_writes_a_sound_and_its_measures(
    tmp_path: Path, two_points: tuple[str, str], command: Command
) -> None:
    out = tmp_path / "ir.wav"
    points = ("--source", two_points[0], "--mic", two_points[1])
    asked = ("ir", HOUSE, *points, "--rays", "500", "--out", out, "--json")
    facts = one_object(command(*asked))
    assert (facts["bits"], facts["full_scale_pa"]) == (32, 1.0)
    sound, rate_hz = read_wav(out)
    assert (rate_hz, sound.shape) == (facts["rate_hz"], (1, facts["samples"]))
    assert float(np.abs(sound).max()) == facts["peak_pa"]
    # Levels stay: four times as far from the source it is fainter.
    source = [float(x) for x in two_points[0].split(",")]
    near = ",".join(str(x) for x in (source[0] + 0.3, source[1], source[2]))
    points = ("--source", two_points[0], "--mic", near, "--rays", "500")
    loud = one_object(command("ir", HOUSE, *points, "--json"))
    assert float(str(loud["peak_pa"])) > 2.0
    facts = one_object(command(*asked, "--bits", "16"))
    assert (facts["bits"], facts["full_scale_pa"]) == (16, facts["peak_pa"])
    with wave.open(str(out)) as file:
        assert (file.getsampwidth(), file.getframerate()) == (2, facts["rate_hz"])
    again, _ = read_wav(out, full_scale_pa=float(str(facts["full_scale_pa"])))
    assert float(np.abs(again - sound).max()) < 2e-5 * float(str(facts["peak_pa"]))
    assert command("ir", HOUSE).returncode == 1
    assert command(*asked, "--bits", "24").returncode == 2


@pytest.mark.long
@pytest.mark.parametrize(
    ("stage", "figure", "small"),
    [
        ("load", "load_ms", ()),
        ("render", "views_per_s", ("--resolution", "32")),
        ("physics", "physics_steps_per_s", ("--steps", "5")),
    ],
)
def test_bench_gives_its_figure(
    stage: str, figure: str, small: tuple[str, ...], command: Command
) -> None:
    told = one_object(command("bench", stage, HOUSE, "--repeats", "1", *small, "--json"))
    assert float(str(told[figure])) > 0.0


def test_bench_tells_how_far_it_is_and_ends_where_its_listener_raises() -> None:
    told: list[tuple[float, str]] = []
    options = {"repeats": 1, "steps": 5, "worlds": 2}
    _native.bench("physics", HOUSE, options, lambda *part: told.append(part))
    fractions = [fraction for fraction, _ in told]
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)
    assert fractions == sorted(set(fractions))

    def stop(fraction: float, what: str) -> None:
        raise KeyboardInterrupt(what)

    with pytest.raises(KeyboardInterrupt, match="coming to rest"):
        _native.bench("physics", HOUSE, options, stop)


@pytest.mark.long
def test_bench_measures_batches_by_size_and_path(command: Command) -> None:
    small = ("--repeats", "1", "--batch", "1,3", "--resolution", "16,24", "--json")
    by_cpu = one_object(command("bench", "render", HOUSE, "--backend", "cpu", *small))["rows"]
    assert isinstance(by_cpu, list)
    sizes = [(row["resolution"], row["batch"]) for row in by_cpu]
    assert sizes == [(16, 1), (16, 3), (24, 1), (24, 3)]
    assert all(row["views_per_s"] > 0.0 for row in by_cpu)
    assert "several" in command("bench", "render", HOUSE, "--resolution", "16,24").stderr
    adapters = one_object(command("doctor", "--json"))["graphics_adapters"]
    assert isinstance(adapters, list)
    if not adapters:
        pytest.skip("no graphics adapter, not even of software")
    back_end = ("--backend", f"gpu:{adapters[0]['name']}")
    table = one_object(command("bench", "render", HOUSE, *back_end, *small))
    rows = table["rows"]
    assert isinstance(rows, list)
    assert len(rows) == 8
    assert {row["backend"].rsplit(" ", 1)[-1] for row in rows} == {"compute", "raster"}
    for row in rows:
        assert row["overlapped_views_per_s"] > 0.0
        assert row["submit_s"] > 0.0
        assert row["views_per_s"] < row["bound_views_per_s"]


def test_calibrate_finds_what_the_example_hides(tmp_path: Path, command: Command) -> None:
    from dwell import _native

    bundle = tmp_path / "throws.measured"
    hidden = _native.calibration_example(str(bundle), 1)
    out = tmp_path / "report"
    report = one_object(command("calibrate", bundle, "--out", out, "--json"))
    assert "drag" in hidden
    assert "drag" in str(report["sentence"])
    assert "<svg" in (out / "report.html").read_text("utf-8")
    found = json.loads((out / "found.json").read_text("utf-8"))
    assert found["version"] == 1
    assert found["laws"][0]["id"] == "drag"
    assert command("calibrate", tmp_path / "nothing").returncode == 1


def look_at_demo(out: Path, done: subprocess.CompletedProcess[str]) -> dict[str, object]:
    """Checks the folder of a demo; returns the summary."""
    summary = one_object(done)
    assert summary["fulfilled"] is True
    page = (out / "index.html").read_text("utf-8")
    assert not re.search(r"(src|href)=[\"']?(https?:)?//", page)
    for name in re.findall(r"(?:src|href)=\"([^\"]+)\"", page):
        assert (out / name).stat().st_size > 0, name
    with wave.open(str(out / "errand.wav")) as sound:
        frames = sound.readframes(sound.getnframes())
    assert any(frames)
    assert float(str(summary["errand_full_scale_pa"])) > 0.0
    return summary


@pytest.mark.slow
def test_demo_writes_a_page_that_needs_no_network(tmp_path: Path) -> None:
    out = tmp_path / "demo"
    look_at_demo(out, process("demo", HOUSE, "--out", out, "--json"))
    done = process("demo", HOUSE, "--out", tmp_path)
    assert done.returncode == 1, "a folder that no demo wrote"


@pytest.mark.long
def test_demo_of_a_small_house_writes_a_page(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    from dwell.camera import Camera
    from dwell.demo import episode, instruction, throughput

    # Without the bench of acoustics, which first computes references: half a minute.
    small = {
        "load": {"repeats": 1},
        "render": {"repeats": 1},
        "physics": {"repeats": 1, "steps": 2, "worlds": 2},
        "env": {"envs": 1, "steps": 2},
    }
    assert set(small) < set(throughput._RUNS)
    monkeypatch.setattr(throughput, "_RUNS", small)
    monkeypatch.setattr(episode, "CAMERA", Camera(64, 48))
    # A short way.
    monkeypatch.setattr(instruction, "_SEED", 4)
    out = tmp_path / "demo"
    summary = look_at_demo(out, command("demo", "builtin:studio", "--out", out, "--json"))
    figures = summary["figures"]
    assert isinstance(figures, dict)
    assert set(figures) == set(small)
    assert not [stage for stage, found in figures.items() if "failed" in found]
    done = command("demo", "builtin:studio", "--out", tmp_path)
    assert done.returncode == 1, "a folder that no demo wrote"


def test_points_may_be_negative_and_must_be_finite(tmp_path: Path, command: Command) -> None:
    points = ("--source", "-2,1.5,6", "--mic", "-1.5,1.5,-6.5")
    assert command("ir", HOUSE, *points, "--rays", "10", "--json").returncode == 0
    for where in ("nan,0,0", "inf,0,0", "-1,nan,2"):
        done = command("render", HOUSE, "--at", where, "--out", tmp_path / "x")
        assert done.returncode == 2
        assert "finite" in done.stderr


def test_a_sound_has_the_name_of_one(tmp_path: Path, command: Command) -> None:
    points = ("--source", "-2,1.5,6", "--mic", "-1.5,1.5,-6.5")
    done = command("ir", HOUSE, *points, "--rays", "10", "--out", tmp_path / "x.mp3")
    assert done.returncode == 1
    assert "expected the name of a .wav file" in done.stderr
    assert not list(tmp_path.iterdir())


def test_bad_files_and_numbers_get_a_sentence(tmp_path: Path, command: Command) -> None:
    path = tmp_path / "house.json"
    for text in ('{"position": 1}', "[1]", '[{"position": [0, 0], "forward": [0, 0, 1]}]', "{"):
        path.write_text(text, "utf-8")
        done = command("bench", "render", HOUSE, "--views", path)
        assert done.returncode == 1
        assert str(path) in done.stderr
        assert done.stderr.count("\n") == 1
    path.write_text('[{"position": [0, 0, 0], "forward": [0, 0.0, 0]}]', "utf-8")
    done = command("bench", "render", HOUSE, "--views", path)
    assert done.returncode == 1
    assert f"{path}: view 0: forward is 0" in done.stderr
    path.write_text("[]", "utf-8")
    assert "JSON object" in command("bench", "physics", HOUSE, "--boxes", path).stderr
    rows = {"fixed": [], "dynamic": [{"position": [0, 0, 0]}], "density_kg_m3": 1}
    path.write_text(json.dumps({**rows, "physics_rate_hz": 100}))
    told = command("bench", "physics", HOUSE, "--boxes", path).stderr
    assert f"{path}: dynamic[0]: expected center and half_extents, [x, y, z] in metres" in told
    none = {"fixed": [], "dynamic": [], "density_kg_m3": 400, "physics_rate_hz": 0}
    path.write_text(json.dumps(none), "utf-8")
    told = command("bench", "physics", HOUSE, "--boxes", path).stderr
    assert "boxes.physics_rate_hz is 0; allowed is 5 to 5000 Hz" in told
    done = command("describe", HOUSE, "--level", "instructions", "--seed", "-1")
    assert done.returncode == 2
    assert "whole number" in done.stderr
    missing = command("describe", "nope.obj")
    assert missing.stderr.count("nope.obj") == 1


def test_a_bug_of_ours_is_a_sentence_too(monkeypatch: pytest.MonkeyPatch, capsys: object) -> None:
    import dwell.cli as cli
    from dwell.cli import info

    def fall(_args: object) -> int:
        raise IndexError("list index out of range")

    monkeypatch.setattr(info, "run", fall)
    assert cli.main(["info", HOUSE]) == 1
    assert "report it: IndexError" in capsys.readouterr().err  # type: ignore[attr-defined]


def test_only_the_chosen_command_is_imported() -> None:
    program = (
        "import sys; from dwell.cli import main; main(['info', 'builtin:castle']); "
        "print(sorted(name for name in sys.modules if name.startswith('dwell.cli.')))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=300, check=True
    )
    assert done.stdout.strip() == "['dwell.cli.common', 'dwell.cli.info']"


def test_an_interrupted_describe_goes_on_where_it_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from dwell.cli import describe, main
    from dwell.house import House

    names = [HOUSE]
    for name in ("a.dwell", "b.dwell"):
        House.open(HOUSE).write(tmp_path / name, "dwell")
        names.append(str(tmp_path / name))
    out = tmp_path / "lines.jsonl"
    command = ["describe", *names, "--level", "room", "--out", str(out)]
    opened: list[str] = []
    real = describe._describe

    def stop_at(last: int) -> None:
        def watched(name: str, *rest: object) -> object:
            if len(opened) == last:
                raise KeyboardInterrupt
            opened.append(name)
            return real(name, *rest)  # type: ignore[arg-type]

        monkeypatch.setattr(describe, "_describe", watched)

    stop_at(2)
    assert main(command) == 130
    assert not out.exists()
    # What a power cut left half written is written again.
    journal = tmp_path / ".lines.jsonl.part"
    journal.write_bytes(journal.read_bytes() + b'{"house": "b.dwe')
    stop_at(99)
    assert main(command) == 0
    assert opened == names
    rows = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
    assert [row["house"] for row in rows] == [name for name in names for _ in range(6)]
    assert not journal.exists()
    # What is whole stays, whoever runs next.
    whole = out.read_bytes()
    assert main(command) == 1
    assert main([*command, "--seed", "1"]) == 1
    assert out.read_bytes() == whole
    assert not journal.exists()
    out.unlink()
    # Another job neither takes over nor discards what this one left.
    opened.clear()
    stop_at(1)
    assert main(command) == 130
    left = journal.read_bytes()
    opened.clear()
    stop_at(99)
    assert main([*command, "--seed", "1"]) == 1
    assert opened == []
    assert journal.read_bytes() == left


def test_an_interrupted_describe_refuses_a_house_that_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell.cli import describe, main
    from dwell.house import House

    house, out = tmp_path / "a.dwell", tmp_path / "lines.jsonl"
    House.open(HOUSE).write(house, "dwell")
    command = ["describe", str(house), HOUSE, "--out", str(out)]
    real = describe._describe

    def stopped(name: str, *rest: object) -> object:
        if name == HOUSE:
            raise KeyboardInterrupt
        return real(name, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(describe, "_describe", stopped)
    assert main(command) == 130
    monkeypatch.setattr(describe, "_describe", real)
    journal = tmp_path / ".lines.jsonl.part"
    left = journal.read_bytes()
    House.open("builtin:studio").write(house, "dwell")
    capsys.readouterr()
    assert main(command) == 1
    assert f"{house} has changed since {journal} kept" in capsys.readouterr().err
    assert journal.read_bytes() == left
    House.open(HOUSE).write(house, "dwell")
    assert main(command) == 0


def test_what_the_demo_cannot_walk_through_is_refused(tmp_path: Path, command: Command) -> None:
    thing = tmp_path / "thing.obj"
    thing.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "utf-8")
    done = command("demo", thing, "--out", tmp_path / "demo")
    assert done.returncode == 1
    assert "no rooms" in done.stderr
    assert "Traceback" not in done.stderr


def test_calibrate_refuses_a_house_where_none_was_measured_in(
    tmp_path: Path, command: Command
) -> None:
    from dwell import _native

    bundle = tmp_path / "throws.measured"
    _native.calibration_example(str(bundle), 1)
    done = command("calibrate", bundle, "--house", "nope")
    assert done.returncode == 1
    assert "house" in done.stderr


def test_calibrate_refuses_a_folder_in_the_place_of_its_report_at_once(
    tmp_path: Path, command: Command
) -> None:
    (tmp_path / "out" / "report.html").mkdir(parents=True)
    # What was measured is not even looked for.
    done = command("calibrate", tmp_path / "none.measured", "--out", tmp_path / "out")
    assert done.returncode == 1
    assert f"{tmp_path / 'out' / 'report.html'}" in done.stderr
    assert "none.measured" not in done.stderr


def test_a_response_obeys_laws(
    tmp_path: Path, two_points: tuple[str, str], command: Command
) -> None:
    points = ("--source", two_points[0], "--mic", two_points[1], "--rays", "20", "--json")
    plain = one_object(command("ir", HOUSE, *points))
    laws = tmp_path / "found.json"
    law = {"id": "microphone_gain", "version": 1, "params": {"gain_db": 20.0}}
    laws.write_text(json.dumps({"laws": [law], "parameters": {}}), "utf-8")
    louder = one_object(command("ir", HOUSE, *points, "--laws", laws))
    assert isinstance(louder["peak_pa"], float)
    assert isinstance(plain["peak_pa"], float)
    assert abs(louder["peak_pa"] / plain["peak_pa"] - 10.0) < 1e-4
    missing = command("ir", HOUSE, *points, "--laws", tmp_path / "no.json")
    assert missing.returncode == 1
    assert "no.json" in missing.stderr


def test_measures_of_a_response_name_their_bands(
    two_points: tuple[str, str], command: Command
) -> None:
    points = ("--source", two_points[0], "--mic", two_points[1], "--rays", "20")
    metrics = one_object(command("ir", HOUSE, *points, "--json"))["metrics"]
    assert [row["centre_hz"] for row in metrics][:3] == [62.5, 125, 250]  # type: ignore[attr-defined]
    assert "1000 Hz: " in command("ir", HOUSE, *points).stdout


def test_sensors_maps_and_dolls_houses_are_all_written(
    tmp_path: Path, two_points: tuple[str, str], command: Command
) -> None:
    at, size = ("--at", two_points[0]), ("--width", "40", "--height", "30")
    out = ("--out", tmp_path / "all", "--json")
    pictures = one_object(
        command("render", HOUSE, "--sensors", "rgb,depth", *at, *size, "--map", "--dollhouse", *out)
    )
    names = {Path(str(file)).name for file in pictures["files"]}  # type: ignore[attr-defined]
    assert {"view_rgb.png", "view_depth.npy", "map_0.png", "dollhouse.png"} <= names
    assert all((tmp_path / "all" / name).exists() for name in names)
    # Without --sensors and --at only what is asked for.
    out = ("--out", tmp_path / "one", "--json")
    alone = one_object(command("render", "builtin:studio", *size[:2], "--map", *out))
    assert [Path(str(file)).name for file in alone["files"]] == ["map_0.png"]  # type: ignore[attr-defined]
    several = command(
        "render", "seed:1", "seed:2", "--sheet", "--sensors", "rgb", "--out", tmp_path
    )
    assert several.returncode != 0
    assert "without --sensors" in several.stderr


def test_a_report_promises_no_more_than_it_holds() -> None:
    kept = [{"sentence": f"fault {k}"} for k in range(10_000)]
    lines = info._report({"warnings": kept, "not_kept": 990_000})
    assert lines[0] == "report: 1000000 warnings"
    assert lines[1:21] == [f"  fault {k}" for k in range(20)]
    assert lines[21:] == [
        "  and 9980 more (--json has them)",
        "  and 990000 that were counted and not kept",
    ]
    assert info._report({"warnings": kept[:3], "not_kept": 0})[1:] == [
        f"  fault {k}" for k in range(3)
    ]


def test_counts_that_nothing_counts_to_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["generate", "--count", "9" * 19, "--out", str(tmp_path / "houses")]) == 2
    told = capsys.readouterr().err
    assert "expected a whole number from 1 to 9223372036854775807, found '999999" in told
    assert "islice" not in told


def test_describe_has_three_lengths(command: Command) -> None:
    texts = {}
    for length in ("short", "normal", "long"):
        told = command("describe", "builtin:studio", "--level", "room", "--length", length)
        assert told.returncode == 0
        texts[length] = told.stdout
    assert len(texts["short"]) < len(texts["normal"]) < len(texts["long"])
    refused = command("describe", "builtin:studio", "--level", "graph", "--length", "long")
    assert refused.returncode == 1
    assert "texts of level graph have one length" in refused.stderr
