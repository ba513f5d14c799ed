"""How many threads jobs start, and what is kept of them."""

from __future__ import annotations

import argparse
import json
import os
import threading
from pathlib import Path
from typing import Any

import pytest

import dwell
from dwell import cli, views, workers
from dwell.cli import generate
from dwell.episode_maker import EpisodeMaker
from dwell.house_list import HouseList


def test_no_more_threads_are_started_than_have_something_to_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 4)
    assert workers.thread_count(None, 100) == 4
    assert workers.thread_count(3, 100) == 3
    assert workers.thread_count(1024, 10**9) == 16
    assert workers.thread_count(16, 2) == 2
    assert workers.thread_count(16, 0) == 1


@pytest.mark.parametrize("workers", ["0", "1025", "99999999999"])
@pytest.mark.parametrize(
    "arguments",
    [
        ["generate", "--count", "1", "--out", "new", "--workers"],
        ["episodes", "Free", "--houses", "builtin:studio", "--out", "new", "--workers"],
        ["evaluate", "stop", "--task", "Free", "--houses", "builtin:studio", "--workers"],
        ["views", "make", "builtin:studio", "--out", "new", "--threads"],
    ],
)
def test_workers_above_the_cap_are_refused(
    arguments: list[str], workers: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([*arguments, workers]) == 2
    expected = f"expected a whole number from 1 to 1024, found '{workers}'\n"
    assert capsys.readouterr().err.endswith(expected)


def test_workers_above_the_cap_are_refused_in_python(tmp_path: Path) -> None:
    maker = EpisodeMaker("Free", ["builtin:studio"], count=1)
    with pytest.raises(dwell.ConfigError, match=r"workers is 1025; allowed are .* 1 to 1024"):
        next(maker.episodes(workers=1025))
    houses = HouseList(["builtin:studio"])
    with pytest.raises(dwell.ConfigError, match=r"threads is 0; allowed are .* 1 to 1024"):
        next(views.make(houses, tmp_path, views.ViewSettings(), threads=0))


def test_houses_that_were_finished_before_a_stop_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    made: list[int] = []
    three = threading.Event()

    def house(_: argparse.Namespace, seed: int) -> dict[str, Any]:
        """The row of a house that cannot be made; the first one is stopped after three others."""
        if seed == 0 and not three.is_set():
            assert three.wait(60)
            raise KeyboardInterrupt
        made.append(seed)
        if len(made) == 3:
            three.set()
        return generate._checked({"version": 1, "seed": seed, "house": "x", "error": "y"})

    monkeypatch.setattr(generate, "_house", house)
    arguments = ["generate", "--count", "7", "--out", str(tmp_path / "new"), "--workers", "2"]
    assert cli.main(arguments) == 130
    assert "dwell generate: 3 of 7 are kept; run again" in capsys.readouterr().err
    assert cli.main(arguments) == 1
    assert sorted(made) == [*range(7)]
    manifest = tmp_path / "new" / "manifest.jsonl"
    rows = [json.loads(line) for line in manifest.read_text().splitlines()]
    assert [row["seed"] for row in rows] == [*range(7)]
