"""Shared parts of the tests."""

from __future__ import annotations

import functools
import os
import re
import subprocess
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from habitat_files import navigation, point_nav, written

import dwell
from dwell import cli

Open = Callable[[str, int | None], dwell.House]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leaves out the tests marked ``long`` of shares other than ``DWELL_TEST_SHARE`` ("3/8")."""
    share = os.environ.get("DWELL_TEST_SHARE")
    if share is None or os.environ.get("DWELL_TEST_ALL"):
        return
    number, shares = map(int, share.split("/"))

    def is_left_out(item: pytest.Item) -> bool:
        own = zlib.crc32(item.nodeid.encode()) % shares + 1
        return item.get_closest_marker("long") is not None and own != number

    config.hook.pytest_deselected(items=[item for item in items if is_left_out(item)])
    items[:] = [item for item in items if not is_left_out(item)]


@pytest.fixture(scope="session")
def opened() -> Open:
    """Opens a house the first time that it is asked for, and then gives the same one."""
    return functools.cache(dwell.House.open_by)


@pytest.fixture(scope="session")
def apartment(opened: Open) -> dwell.House:
    return opened("builtin:apartment", None)


@pytest.fixture(scope="session")
def shoebox() -> dwell.House:
    return dwell.House.shoebox((6.0, 3.0, 5.0), substance="plaster")


@pytest.fixture
def open_once(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, opened: Open
) -> None:
    """Built-in houses and studios of seeds, opened by name, are those of the tests before.

    Houses do not change, and what engines derive from one (grids, planes, sound) is then made once
    in a process and not in each test. For files that ask what happens in a house, not for those
    about opening one or deriving from it; tests marked ``fresh`` open their own.
    """
    if request.node.get_closest_marker("fresh"):
        return
    open_by = dwell.House.open_by

    def open_known(name: str, threads: int | None) -> dwell.House:
        if isinstance(name, str) and re.fullmatch(r"builtin:\w+|seed:\d\?home=studio", name):
            return opened(name, threads)
        return open_by(name, threads)

    monkeypatch.setattr(dwell.House, "open_by", staticmethod(open_known))


@pytest.fixture
def command(
    capfd: pytest.CaptureFixture[str],
) -> Callable[..., subprocess.CompletedProcess[str]]:
    """``dwell ARGUMENTS`` in this process: the status, and what was printed."""

    def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        words = [*map(str, arguments)]
        capfd.readouterr()
        status = cli.main(words)
        return subprocess.CompletedProcess(words, status, *capfd.readouterr())

    return run


@pytest.fixture(scope="session")
def places() -> list[tuple[list[float], list[float], float]]:
    """Starts and goals with the way between them, of the largest island of the house."""
    grid = navigation()
    rows = []
    for seed in range(40):
        start, goal = (list(map(float, row)) for row in grid.sample(seed, 2))
        if grid.island(start) == 0 == grid.island(goal):
            way_m = grid.distance(start, goal)
            if way_m is not None and way_m > 1.5:
                rows.append((start, goal, way_m))
    assert len(rows) > 4
    return rows


@pytest.fixture
def points(tmp_path: Path, places: list[Any]) -> Path:
    """A data set of PointNav, with a file for its one scene."""
    path = tmp_path / "pointnav" / "val" / "val.json.gz"
    written(path, {"episodes": []})
    rows = [point_nav(k, place) for k, place in enumerate(places[:4])]
    written(path.parent / "content" / "studio.json.gz", {"episodes": rows})
    return path
