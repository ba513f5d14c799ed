"""What long jobs keep: gone on with, begun anew, and refused where it is not what was written."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dwell.cli.job_journal import Journal, alone
from dwell.episode_maker import EpisodeMaker

pytestmark = pytest.mark.usefixtures("open_once")

Command = Callable[..., subprocess.CompletedProcess[str]]


def begun(out: Path, **job: Any) -> Path:  # noqa: ANN401 - any JSON value
    """A journal of two finished items and half a third; its path."""
    journal = Journal(out, {"command": "x", **job})
    journal.add("a", [{"row": 1, "yaw": 0.5}, {"row": 2}])
    journal.add("b", [{"row": 3}], of="contents")
    journal._file.write(b'{"row": 4}\n{"row": 5')
    journal.close()
    return out.with_name(f".{out.name}.part")


def test_what_was_written_goes_on(tmp_path: Path) -> None:
    out = tmp_path / "rows"
    kept = begun(out, seed=1)
    journal = Journal(out, {"command": "x", "seed": 1})
    assert journal.done == {"a": None, "b": "contents"}
    journal.add("c", [{"row": 6}])
    journal.finish()
    assert [json.loads(line)["row"] for line in out.read_text().splitlines()] == [1, 2, 3, 6]
    assert not kept.exists()


@pytest.mark.parametrize(
    ("before", "after", "line"),
    [
        (b'"yaw": 0.5', b'"yaw": 0.6', 4),
        (b'"row": 2', b'"row": 7', 4),
        (b'"done": "a"', b'"done": "z"', 4),
        (b'{"row": 2}\n', b"", 3),
        (b'{"row": 2}\n', b'{"row": 2}\n{"row": 2}\n', 5),
        (b'{"row": 3}\n', b'{"row": 3\n', 5),
        (b', "of": "contents"', b"", 6),
        (b'"sum": ', b'"mus": ', 6),
    ],
)
def test_what_is_not_as_it_was_written_is_refused(
    before: bytes, after: bytes, line: int, tmp_path: Path
) -> None:
    out = tmp_path / "rows"
    kept = begun(out)
    damaged = kept.read_bytes().replace(before, after, 1)
    assert damaged != kept.read_bytes()
    kept.write_bytes(damaged)
    with pytest.raises(ValueError, match=rf"line {line}: what is kept up to here is not what was"):
        Journal(out, {"command": "x"})
    assert kept.read_bytes() == damaged


def test_another_job_is_told_with_all_that_differs(tmp_path: Path) -> None:
    out = tmp_path / "rows"
    kept = begun(out, seed=1, task={"name": "A", "far": [1, 2]})
    before = kept.read_bytes()
    with pytest.raises(ValueError, match="what another job has done") as refused:
        Journal(out, {"command": "x", "seed": 2, "task": {"name": "A", "far": [1, 3]}, "k": 0})
    told = str(refused.value)
    assert "seed was 1 and is 2; task.far was [1, 2] and is [1, 3]; k was None and is 0" in told
    assert f"remove {kept} or give another --out" in told
    assert kept.read_bytes() == before


@pytest.mark.parametrize(
    "left", [b"", b'{"job": {"comm', b'{"job": {"command": "y"}}\n{"row": 1}\n']
)
def test_what_has_nothing_finished_in_it_is_begun_anew(left: bytes, tmp_path: Path) -> None:
    out = tmp_path / "rows"
    kept = tmp_path / ".rows.part"
    kept.write_bytes(left)
    journal = Journal(out, {"command": "x"})
    assert journal.done == {}
    journal.add("a", [{"row": 9}])
    journal.finish()
    assert out.read_text() == '{"row": 9}\n'
    # And a job that comes to nothing leaves nothing.
    Journal(tmp_path / "other", {"command": "x"}).close()
    begin = Journal(tmp_path / "other", {"command": "x"}, preliminary=["head"])
    begin.add("head", [{"head": 1}])
    begin.close()
    assert [path.name for path in tmp_path.iterdir()] == ["rows"]


@pytest.mark.long
def test_a_mended_command_makes_episodes_where_one_has_failed(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "x.jsonl"
    args = ("episodes", "PointNav", "--houses", "builtin:studio", "--count", "2", "--out", out)
    failed = command(*args, "--set", "min_distance_m=29")
    assert failed.returncode == 1
    assert "can be played in no house" in failed.stderr
    assert [*tmp_path.iterdir()] == []
    # Nor what was killed before it has made one.
    monkeypatch.setattr(Journal, "close", Journal._close_file)
    assert command(*args, "--set", "min_distance_m=29").returncode == 1
    monkeypatch.undo()
    assert [path.name for path in tmp_path.iterdir()] == [".x.jsonl.part"]
    done = command(*args, "--set", "min_distance_m=2")
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["x.jsonl"]


def test_kept_episodes_of_other_options_are_told_by_the_options(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(EpisodeMaker.parts, "__defaults__", (1,))
    out, add, left = tmp_path / "cut.jsonl", Journal.add, [2]

    def stop(self: Journal, *args: object) -> None:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        add(self, *args)  # type: ignore[arg-type]

    args = ("episodes", "PointNav", "--houses", "builtin:studio", "--count", "3", "--out", out)
    monkeypatch.setattr(Journal, "add", stop)
    assert command(*args).returncode == 130
    monkeypatch.setattr(Journal, "add", add)
    kept = tmp_path / ".cut.jsonl.part"
    other = command(*args, "--seed", "4", "--set", "max_distance_m=5")
    assert other.returncode == 1
    assert "task_settings.max_distance_m was 30.0 and is 5" in other.stderr
    assert "seed was 0 and is 4" in other.stderr
    # A start that somebody has turned is found.
    written = kept.read_text("utf-8")
    row = next(line for line in written.splitlines() if "start_yaw_deg" in line)
    turned = json.dumps({**json.loads(row), "start_yaw_deg": 12.5}, ensure_ascii=False)
    kept.write_text(written.replace(row, turned), "utf-8")
    refused = command(*args)
    assert refused.returncode == 1
    assert "line 5: what is kept up to here is not what was written" in refused.stderr
    assert f"remove {kept}" in refused.stderr


@pytest.mark.parametrize(
    "words",
    [
        ("views", "make", "builtin:studio"),
        ("challenge", "make", "--cases", "2"),
    ],
    ids=["views", "challenge"],
)
def test_two_equal_jobs_at_once_are_told(
    words: tuple[str, ...],
    tmp_path: Path,
    command: Command,
) -> None:
    """The slower of the two was told that a folder stands there already."""
    out = tmp_path / "out"
    out.mkdir()
    for shard, told in [((0, 1), os.fspath(out)), ((1, 2), f"shard 1/2 of {out}")]:
        given = ("--shard", f"{shard[0]}/{shard[1]}", "--out", out)
        # The first thing that is made is what the folder holds.
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("dwell.views.dataset.make", lambda *_, **__: iter(()))
            patch.setattr("dwell.challenge.make", lambda *_, **__: iter(()))
            assert command(*words, *given).returncode == 0
        with alone(out, shard):
            done = command(*words, *given)
        assert done.returncode == 1
        assert f"{told} is being made by another process; wait for its end" in done.stderr
    assert os.listdir(out) == ["dataset.json"]
