"""Patterns of paths: what they find, where they end, what they follow."""

from __future__ import annotations

import glob
import os
from pathlib import Path

import pytest

import dwell
from dwell import path_patterns
from dwell.house_list import HouseList
from dwell.path_patterns import matching_paths

FILES = [
    "a.dwell",
    "b.json",
    "x/a.dwell",
    "x/y/b.dwell",
    "x/y/.h/c.dwell",
    ".hid/d.dwell",
    "x/.e.dwell",
    "z/w/v/u.dwell",
    "[q]/r.dwell",
]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in FILES:
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("")
    return tmp_path


@pytest.mark.parametrize(
    "pattern",
    [
        *("*", "**", "**/", "*/", "x/**", "x/**/", "**/*.dwell", "x/*/*.dwell", "**/y/**"),
        *("**/**/*.dwell", "*/y/b.dwell", "?/a.dwell", "[xz]/**/*.dwell", ".*", "**/.*", "*/.*/*"),
        *("[[]q]/*", "x//*.dwell", "./*.dwell", "./**/*.dwell", "x/../*.dwell", "x/*/../*.dwell"),
        *("nothing/*", "**/u.dwell", "**/x", "*.dwell/", "**/y/b.dwell", "**/*/", "a.dwell/*"),
    ],
)
def test_patterns_find_what_the_standard_library_finds(pattern: str, tree: Path) -> None:
    found = glob.glob(pattern, root_dir=tree, recursive=True)
    assert matching_paths(pattern, str(tree)) == sorted(set(found))
    whole = os.path.join(glob.escape(str(tree)), pattern)
    assert matching_paths(whole) == sorted(set(glob.glob(whole, recursive=True)))


def test_links_lead_neither_around_nor_out(
    tree: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "far.dwell").write_text("")
    (elsewhere / "deep").mkdir()
    (elsewhere / "deep" / "far.dwell").write_text("")
    (tree / "out").symlink_to(elsewhere)
    (tree / "x" / "up").symlink_to(tree)
    (tree / "within").symlink_to(tree / "z")
    (tree / "file.dwell").symlink_to(elsewhere / "far.dwell")
    (tree / "gone.dwell").symlink_to(tree / "nothing")
    below = str(tree)
    everywhere = matching_paths("**/*.dwell", below)
    seen = ["a.dwell", "x/a.dwell", "x/y/b.dwell", "z/w/v/u.dwell", "[q]/r.dwell"]
    assert everywhere == sorted(["file.dwell", "gone.dwell", *seen])
    # A folder that is named is gone into where it stays below; a file is what it is a link to.
    assert matching_paths("*/*/*/u.dwell", below) == ["within/w/v/u.dwell", "z/w/v/u.dwell"]
    assert matching_paths("with*/w/v/*", below) == ["within/w/v/u.dwell"]
    assert matching_paths("*/far.dwell", below) == []
    assert matching_paths("o*t/deep/*", below) == []
    # Where the pattern begins is as it was said.
    assert matching_paths(f"{tree}/out/*.dwell") == [f"{tree}/out/far.dwell"]
    assert matching_paths("out/**/*.dwell", below) == ["out/deep/far.dwell", "out/far.dwell"]


def test_a_pattern_that_would_look_at_everything_is_refused(
    tree: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(dwell.HouseError, match="more than 9 files and folders were looked at"):
        matching_paths("**/*.dwell", str(tree), most_visited=9)
    assert matching_paths("x/*", str(tree), most_visited=9)
    monkeypatch.setattr(path_patterns, "_MOST_VISITED", 1000)
    with pytest.raises(dwell.HouseError, match=r"/\*\*: more than 1000 files and folders"):
        HouseList(["/**"])


def test_a_search_can_be_interrupted(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []

    def listed(path: str) -> None:
        seen.append(path)
        if len(seen) == 3:
            raise KeyboardInterrupt

    scandir = os.scandir
    monkeypatch.setattr(os, "scandir", lambda path: (listed(path), scandir(path))[1])
    with pytest.raises(KeyboardInterrupt):
        matching_paths("**/*", str(tree))
    assert len(seen) == 3


def test_a_list_of_more_houses_than_can_be_counted_is_told_by_its_line(tmp_path: Path) -> None:
    (tmp_path / "many").write_text("builtin:studio\nseed:0..18446744073709551615\n")
    told = "many line 2: seed:.*: 18446744073709551615 houses; allowed are fewer than"
    with pytest.raises(dwell.HouseError, match=told):
        HouseList([f"@{tmp_path}/many"])
    with pytest.raises(dwell.ConfigError, match=r"seed:.* houses; allowed are fewer than 2\*\*63"):
        HouseList(["seed:0..18446744073709551615"])
