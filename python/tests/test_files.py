"""Files of users: what is no regular file, too large or no JSON; links, devices, full disks."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import dwell
from dwell import cli, files
from dwell.envs import DwellEnv, ReplayRecorder
from dwell.house_list import HouseList

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="named pipes, devices, links")

#: What names a file that a command reads.
READS = [
    "replay {}.replay",
    "info {}.json",
    "info {}.xml",
    "info builtin:studio?map={}",
    "bench physics --boxes {}",
    "bench render --views {}",
    "ir builtin:studio --source 1,1,1 --mic 2,1,1 --laws {}",
    "measure import {}.csv --map {} --out x.measured",
    "calibrate {here}/bundle.measured",
    "calibrate {here}/whole.measured --peer {}.csv",
    "describe builtin:studio --out {here}/lines",
    "generate --count 1 --out {here}/many",
]


@pytest.fixture
def pipe(tmp_path: Path) -> str:
    """A named pipe under all names that commands want, and a bundle of nothing else."""
    (tmp_path / "bundle.measured").mkdir()
    (tmp_path / "many").mkdir()
    names = ["pipe", *(f"pipe.{kind}" for kind in ("replay", "json", "xml", "csv"))]
    for name in [*names, "bundle.measured/manifest.json", ".lines.part", "many/dataset.json"]:
        os.mkfifo(tmp_path / name)
    return str(tmp_path / "pipe")


@pytest.mark.parametrize("command", READS)
def test_a_named_pipe_is_refused_and_nobody_waits_for_it(
    command: str, pipe: str, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell import _native

    here = Path(pipe).parent
    if "whole" in command:
        _native.calibration_example(str(here / "whole.measured"), 1)
    # Whoever opened it to read would be here for ever; the alarm ends that.
    signal.alarm(60)
    try:
        assert cli.main(command.format(pipe, pipe, here=here).split()) == 1
    finally:
        signal.alarm(0)
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "bug" not in told
    assert "not a regular file" in told or "no house" in told, told


def test_devices_folders_and_sockets_are_refused(tmp_path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "socket"))
    for name, kind in (("/dev/zero", "a device"), (tmp_path, "a folder"), ("socket", "a socket")):
        path = tmp_path / name
        with pytest.raises(OSError, match=f"is {kind}, not a regular file"):
            files.read(path)
        with (
            pytest.raises(OSError, match=f"is {kind}, not a regular file"),
            files.atomic_write(path),
        ):
            pass


@pytest.mark.skipif(not Path("/proc/self/mem").exists(), reason="the system has no /proc")
def test_a_file_whose_bytes_cannot_be_read_is_named() -> None:
    with pytest.raises(OSError, match="/proc/self/mem"):
        dwell.Replay.read("/proc/self/mem")


def test_files_above_their_cap_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"12345")
    assert files.read(path, 5) == b"12345"
    with pytest.raises(ValueError, match="a: 5 bytes; at most 4 are read"):
        files.read(path, 4)
    with path.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(dwell.MeasuredDataError, match="at most 67108864 are read"):
        dwell.Replay.read(path)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"[" * 129 + b"]" * 129, "nested 129 deep; at most 128 is read"),
        (b"[" * 100_000, "nested 100000 deep"),
        (b"[" + b"[]," * 4_000_000 + b"[]]", "8000003 values and names; at most 4000000"),
        (b"1" * 5000, "a whole number of 5000 digits"),
        (b"[1e999]", "1e999 is larger than any float"),
        (b"NaN", "NaN is no number of JSON"),
        (b'"\xff"', "byte 1 is not UTF-8"),
        (b'"\\ud800"', "half of a pair of surrogates"),
        (b"{", "line 1 column 2"),
        (b"", "line 1 column 1"),
    ],
)
def test_odd_json_is_refused_by_a_sentence(tmp_path: Path, text: bytes, told: str) -> None:
    path = tmp_path / "odd.json"
    path.write_bytes(text)
    with pytest.raises(ValueError, match=told) as refused:
        files.read_json(path)
    assert str(refused.value).startswith(str(path))


def test_json_at_the_limit_is_read(tmp_path: Path) -> None:
    path = tmp_path / "deep.json"
    path.write_bytes(
        b'\xef\xbb\xbf{"[[[": ' + b"[" * 127 + b'"\\"]\\ud83d\\ude00"' + b"]" * 127 + b"}"
    )
    value = files.read_json(path)["[[["]
    for _ in range(127):
        [value] = value
    assert value == '"]\N{GRINNING FACE}'


def test_nothing_is_written_through_links(tmp_path: Path) -> None:
    path, link, nowhere = (tmp_path / name for name in ("a", "link", "nowhere"))
    path.write_text("old")
    link.symlink_to(path)
    nowhere.symlink_to(tmp_path / "missing")
    for place in (link, nowhere):
        with pytest.raises(OSError, match="is a link") as refused, files.atomic_write(place):
            pass
        assert refused.value.filename == str(place)
        with pytest.raises(OSError, match="is a link"):
            files.check_writable(place)
    with (
        pytest.raises(FileExistsError, match="is there already"),
        files.atomic_write(link, new=True),
    ):
        pass
    assert path.read_text() == "old"
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a", "link", "nowhere"]


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("ir builtin:studio --grid 2.5 --rays 50 --sources 1", "builtin-studio.sofa"),
        ("generate --count 1 --spec home=studio", "house/seed_0.dwell"),
    ],
)
def test_a_link_in_the_folder_of_a_job_is_refused_and_what_it_leads_to_stays(
    command: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if command.startswith("ir"):
        pytest.importorskip("h5py")
    out, mine = tmp_path / "out", tmp_path / "mine.dwell"
    started = cli.main([*command.split(), "--out", str(out)])
    assert started == 0, capsys.readouterr().err
    if (out / name).is_dir():
        shutil.rmtree(out / name)
        dwell.House.open("builtin:studio").write(mine, "dwell")
    else:
        (out / name).unlink()
        mine.write_text("dear")
    before = _contents(mine)
    (out / name).symlink_to(mine)
    assert cli.main([*command.split(), "--out", str(out)]) == 1
    assert f"{out / name}: is a link" in capsys.readouterr().err
    assert (out / name).is_symlink()
    assert _contents(mine) == before


def _contents(place: Path) -> dict[str, bytes]:
    found = place.rglob("*") if place.is_dir() else (place,)
    return {file.name: file.read_bytes() for file in found if file.is_file()}


#: What writes to a path, which ends as here.
WRITES: list[tuple[str, Callable[[Path], object]]] = [
    ("wav", lambda path: cli.main(["ir", *IR, "--out", str(path)])),
    ("jsonl", lambda path: cli.main(["describe", "builtin:studio", "--out", str(path)])),
    ("png", lambda path: cli.main(["ir", *IR, "--plot", "decay", "--out", str(path)])),
    ("glb", lambda path: dwell.House.open("builtin:studio").write(path, "glb")),
    ("dwell", lambda path: dwell.House.open("builtin:studio").write(path, "dwell")),
    ("toml", lambda path: cli.main(["info", "builtin:studio", "--init-map", str(path)])),
]
IR = ("builtin:studio", "--source", "1,1,1", "--mic", "2,1,1", "--rays", "100")


@pytest.mark.parametrize(("suffix", "write"), WRITES, ids=[suffix for suffix, _ in WRITES])
def test_nothing_but_regular_files_is_replaced(
    suffix: str, write: Callable[[Path], object], tmp_path: Path
) -> None:
    device, pipe = tmp_path / f"null.{suffix}", tmp_path / f"pipe.{suffix}"
    device.symlink_to("/dev/null")
    os.mkfifo(pipe)
    for path in (device, pipe):
        with contextlib.suppress(dwell.HouseError):
            assert write(path) == 1
    assert device.is_symlink()
    assert device.is_char_device()
    assert pipe.is_fifo()


RECORDS = """
import sys
import numpy as np
from dwell.envs import DwellEnv, ReplayRecorder
env = ReplayRecorder(DwellEnv("Free", sensors=["gps"], houses="builtin:studio"), sys.argv[1])
env.reset(seed=0)
print("ready", flush=True)
sys.stdin.readline()
for seed in range(1, 26):
    env.step(np.int64(1))
    env.reset(seed=seed)
env.close()
"""


@pytest.mark.long
def test_processes_that_record_into_one_folder_lose_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-c", RECORDS, str(tmp_path)]
    opened = [
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        for _ in range(4)
    ]
    for process in opened:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    for process in opened:
        process.communicate("go\n")
        assert process.returncode == 0
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == [f"episode_{k:04}.replay" for k in range(100)]
    seeds = [dwell.Replay.read(tmp_path / name).seed for name in names]
    assert sorted(Counter(seeds).values()) == [4] * 25


def test_an_episode_is_kept_while_the_disk_is_full(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    env = ReplayRecorder(DwellEnv("Free", sensors=["gps"], houses="builtin:studio"), tmp_path)
    env.reset(seed=1)
    env.step(np.int64(1))
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        with pytest.raises(OSError, match="1 steps are kept") as refused:
            env.reset(seed=2)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert str(refused.value).endswith("/episode_0000.replay'")
    assert not [*tmp_path.iterdir()]
    env.close()
    assert dwell.Replay.read(tmp_path / "episode_0000.replay").actions == ("move_forward",)


GENERATE = """
import resource, sys
from dwell import cli
most = int(sys.argv.pop(1))
if most:
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
sys.exit(cli.main(["generate", *sys.argv[1:]]))
"""


@pytest.mark.long
@pytest.mark.parametrize("form", ["dwell", pytest.param("suncg", marks=pytest.mark.slow), "glb"])
def test_houses_that_had_no_room_are_made_by_the_next_run(tmp_path: Path, form: str) -> None:
    pytest.importorskip("resource")
    out = tmp_path / "many"
    options = ["--count", "3", "--spec", "home=studio", "--format", form, "--out", str(out)]

    def generate(most: int) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-c", GENERATE, str(most), *options]
        return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)

    full = generate(4096)
    assert full.returncode == 1
    assert "0 of 3 are kept; run again" in full.stderr
    assert "File too large" in full.stderr
    done = generate(0)
    assert done.returncode == 0, done.stderr
    assert "3 houses (3 made now" in done.stdout
    rows = [json.loads(line) for line in (out / "manifest.jsonl").read_text("utf-8").splitlines()]
    assert all(dwell.House.open(out / row["path"]).info()["objects"] for row in rows)
    assert not [path for path in out.rglob("*") if "partial" in path.name]


def test_a_full_disk_that_names_no_file_is_told_with_the_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(args: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("dwell.cli.ir.run", full)
    out = tmp_path / "x.wav"
    assert cli.main(["ir", *IR, "--out", str(out)]) == 1
    assert capsys.readouterr().err == f"dwell ir: {out}: No space left on device\n"


def test_shards_that_begin_together_agree_on_their_folder(tmp_path: Path) -> None:
    from concurrent.futures import ThreadPoolExecutor

    from dwell.cli.job_journal import claim

    dataset = {"command": "generate", "seed": 0}
    with ThreadPoolExecutor(8) as pool:
        for k in range(50):
            out = tmp_path / str(k)
            assert [*pool.map(lambda _: claim(out, dataset), range(8))] == [None] * 8  # noqa: B023
            assert [path.name for path in out.iterdir()] == ["dataset.json"]


def test_rows_of_another_job_are_not_discarded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, kept = tmp_path / "lines", tmp_path / ".lines.part"
    kept.write_text('{"job": {"command": "other"}}\n{"text": "dear"}\n{"done": "x"}\n')
    before = kept.read_bytes()
    assert cli.main(["describe", "builtin:studio", "--out", str(out)]) == 1
    assert "another job" in capsys.readouterr().err
    assert kept.read_bytes() == before
    assert not out.exists()


def test_what_stands_where_a_journal_would_is_left_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, kept = tmp_path / "lines", tmp_path / ".lines.part"
    command = ["describe", "builtin:studio", "--out", str(out)]
    for foreign in (b"dear diary\n", b'{"text": "dear"}\n', b"\xff\x00"):
        kept.write_bytes(foreign)
        assert cli.main(command) == 1
        assert ".lines.part" in capsys.readouterr().err
        assert kept.read_bytes() == foreign
    kept.unlink()
    for aim in ("mine", "nothing"):
        (tmp_path / "mine").write_text("dear")
        kept.symlink_to(tmp_path / aim)
        assert cli.main(command) == 1
        assert "is a link" in capsys.readouterr().err
        kept.unlink()
    assert (tmp_path / "mine").read_text() == "dear"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine"]


def test_a_result_may_have_the_longest_name_that_there_is(tmp_path: Path) -> None:
    from dwell.cli.job_journal import Journal

    for name in ("n" * 255, "é" * 127):
        journal = Journal(tmp_path / name, {"command": "x"})
        journal.add("1", [{"a": 1}])
        journal.finish()
        assert (tmp_path / name).read_text() == '{"a": 1}\n'
    assert len(list(tmp_path.iterdir())) == 2


def test_two_processes_do_not_write_one_journal(tmp_path: Path) -> None:
    from dwell.cli.job_journal import Journal

    job = {"command": "x"}
    first = Journal(tmp_path / "rows", job)
    first.add("a", [{"x": 1}])
    with pytest.raises(ValueError, match="written by another process"):
        Journal(tmp_path / "rows", job)
    first.close()
    second = Journal(tmp_path / "rows", job)
    assert [*second.done] == ["a"]
    second.add("b", [{"x": 2}])
    second.finish()
    assert (tmp_path / "rows").read_text() == '{"x": 1}\n{"x": 2}\n'
    assert [path.name for path in tmp_path.iterdir()] == ["rows"]


@pytest.mark.parametrize("out", ["", ".", "{}"])
def test_a_folder_is_no_file_for_rows(
    out: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status = cli.main(["describe", "builtin:studio", "--out", out.format(tmp_path)])
    told = capsys.readouterr().err
    assert status == (1 if out else 2)
    assert ("is a folder, not a file" if out else "expected a path, found ''") in told
    assert not [*tmp_path.iterdir()]


def test_ranges_of_seeds_take_no_memory() -> None:
    names = HouseList(["builtin:studio", "seed:0..1000000000?home=studio", "seed:5..7"])
    assert len(names) == 1_000_000_003
    assert names[1] == "seed:0?home=studio"
    assert names[-1] == "seed:6"
    assert names[-2:] == ["seed:5", "seed:6"]
    assert names.index("seed:6") == 1_000_000_002
    assert names.index("seed:6?home=studio") == 7
    assert "builtin:studio" in names
    for absent in ("seed:7", "seed:05", "seed:6?", "builtin:house", 5):
        assert absent not in names
    assert list(HouseList(["seed:3..5", "x"])) == ["seed:3", "seed:4", "x"]
    with pytest.raises(IndexError):
        names[len(names)]
    with pytest.raises(dwell.ConfigError, match="at most 1000000 are listed"):
        dwell.House.expand("seed:0..1000001")


def test_as_many_seeds_as_one_likes_are_drawn_one_by_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell.cli import generate

    def stop(args: object, seed: int) -> dict[str, object]:
        if seed >= 300:
            raise KeyboardInterrupt
        return {"seed": seed}

    monkeypatch.setattr(generate, "_house", stop)
    options = ["--count", "1000000000000", "--shard", "0/3", "--workers", "1"]
    assert cli.main(["generate", *options, "--out", str(tmp_path / "many")]) == 130
    assert "100 of 333333333334 are kept" in capsys.readouterr().err


ODD = "a\x1b[31m\x00\x9b\u202eb"


def test_names_command_no_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(dwell.ConfigError, match=r"house is .*a\\x1b\[31m.*a path holds no NUL"):
        dwell.House.open(f"{tmp_path}/{ODD}.glb")
    with pytest.raises(dwell.HouseError) as refused:
        dwell.House.open(f"{tmp_path}/{ODD}.glb".replace("\0", ""))
    assert "\\u001b[31m" in str(refused.value)
    assert cli.main(["info", f"{tmp_path}/{ODD}.glb"]) == 1
    assert cli.main([f"{ODD}", "info"]) == 2
    odd = tmp_path / "a\x1b]0;b\x07.obj"
    odd.write_text("o thing\x1b[2J\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n")
    assert cli.main(["info", str(odd)]) == 0
    assert cli.main(["info", str(odd), "--json"]) == 0
    assert cli.main(["describe", str(odd), "--level", "object"]) == 0
    told = capsys.readouterr()
    assert "\\u001b]0;b" in told.out
    for text in (told.out, told.err):
        assert not [c for c in text if (ord(c) < 32 and c != "\n") or c in "\x7f\x9b\u202e"]


def test_what_is_printed_as_json_stays_json(capsys: pytest.CaptureFixture[str]) -> None:
    from dwell.cli.common import Printable, print_json

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "stdout", Printable(sys.stdout, "standard output"))
        print_json({"name": ODD})
    assert json.loads(capsys.readouterr().out) == {"name": ODD}


@pytest.mark.parametrize(
    "arguments",
    [
        ["info", "a\0b.glb"],
        ["info", "\udcff.glb"],
        ["info", "x" * 5000 + ".glb"],
        ["info", "x" * 5000],
        ["info", "seed:" + "9" * 5000],
        ["info", "seed:0..5"],
        ["replay", "a\0b.replay"],
        ["replay", "x" * 5000 + ".replay"],
        ["render", "seed:0..3", "--out", "x"],
        ["describe", "seed:3..0"],
        ["describe", "builtin:studio", "--out", "a\0b"],
        ["describe", "builtin:studio", "--out", "x" * 5000],
        ["bench", "physics", "--boxes", "x" * 5000],
        ["calibrate", "a\0b"],
        ["calibrate", "x" * 5000],
        ["measure", "import", "a\0b.csv", "--map", "a\0b", "--out", "x"],
        ["generate", "--count", "1", "--out", "a\0b"],
        ["ir", "builtin:studio", "--source", "1,1,1", "--mic", "2,1,1", "--laws", "a\0b"],
        ["ir", "a\0b.json"],
        ["view", "\udcff.replay", "--out", "x.rrd"],
    ],
)
def test_odd_names_are_refused_by_one_sentence(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(arguments) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "bug of dwell" not in told
    assert len(told) < 1000


def test_odd_tables_are_refused_by_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell.measured.kinds import KINDS

    meaning, table = tmp_path / "map.json", tmp_path / "index.csv"
    meaning.write_text(json.dumps({**KINDS["trajectory"].template, "g_m_s2": 9.81}))
    for text in (b'episode,"\n' + b"x" * 200_000, b"\xff\xfe\n", b"episode\n\xff\n", b"a\0b\n1\n"):
        table.write_bytes(text)
        options = ["--map", str(meaning), "--out", str(tmp_path / "x.measured")]
        assert cli.main(["measure", "import", str(table), *options]) == 1
        told = capsys.readouterr().err
        assert "index.csv" in told
        assert "bug of dwell" not in told
        assert len(told) < 1000


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ('{"a": 1, "b": 2, "a": 3}', "a"),
        ('[{"x": {"g_m_s2": 9.81, "g_m_s2": 1.62}}]', "g_m_s2"),
        ('{"\\u0061": 1, "a": 1}', "a"),
    ],
)
def test_a_key_that_stands_twice_is_named_with_its_file(
    text: str, key: str, tmp_path: Path
) -> None:
    path = tmp_path / "map.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=rf"map\.json: key '{key}' stands twice in one object"):
        files.read_json(path)
    # Elsewhere it is another key.
    assert files.parse_json(b'[{"a": 1}, {"a": {"a": 2}}]', "here") == [{"a": 1}, {"a": {"a": 2}}]


def test_an_array_that_a_full_disk_does_not_take_is_told_with_file_and_cause(
    tmp_path: Path,
) -> None:
    resource = pytest.importorskip("resource")
    path = tmp_path / "a.npy"
    array = np.arange(100_000, dtype=np.float32).reshape(100, 10, 100)
    with files.atomic_write(path) as draft:
        files.save_array(draft, array)
    assert (np.load(path) == array).all()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with (
            pytest.raises(OSError, match="File too large") as refused,
            files.atomic_write(path) as draft,
        ):
            files.save_array(draft, array)
        with (
            pytest.raises(OSError, match="cannot be written: 5 requested") as unnamed,
            files.atomic_write(path),
        ):
            raise OSError("5 requested and 3 written")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    for caught in (refused.value, unnamed.value):
        assert caught.filename == str(path)
    assert (np.load(path) == array).all()
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.npy"]
