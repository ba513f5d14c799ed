"""Drafts of files: what killed processes leave, and places without room."""

from __future__ import annotations

import errno
import subprocess
import sys
from pathlib import Path

import pytest

import dwell
from dwell import files

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="places of Unix")


def test_drafts_of_killed_processes_are_removed(tmp_path: Path) -> None:
    left = tmp_path / ".seed_0.partial-0" / "object"
    left.mkdir(parents=True)
    (left / "half.obj").write_text("v 0")
    dwell.House.open("builtin:studio").write_into(tmp_path, "seed_0", "suncg")
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


#: Writes half a file and waits to be killed.
HALF = """
import sys
from dwell.files import atomic_write
with atomic_write(sys.argv[1]) as draft:
    draft.write_text("half")
    print("ready", flush=True)
    sys.stdin.read()
"""


def test_drafts_of_the_living_stay_and_those_of_the_dead_go(tmp_path: Path) -> None:
    place = tmp_path / "a.csv"
    command = [sys.executable, "-c", HALF, str(place)]
    other = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert other.stdout is not None
    assert other.stdout.readline() == "ready\n"
    # As the engine's writer leaves them.
    (tmp_path / ".a.csv.partial-1").write_text("half")
    (tmp_path / ".b.csv.partial-0").write_text("of another file")
    with files.atomic_write(place) as draft:
        draft.write_text("whole")
    assert place.read_text() == "whole"
    kept = [".a.csv.partial-0", ".b.csv.partial-0", "a.csv"]
    assert sorted(path.name for path in tmp_path.iterdir()) == kept
    other.kill()
    other.communicate()
    with files.atomic_write(place) as draft:
        draft.write_text("again")
    assert place.read_text() == "again"
    assert sorted(path.name for path in tmp_path.iterdir()) == kept[1:]


def test_a_draft_that_has_no_room_is_told_by_the_name_that_was_given(tmp_path: Path) -> None:
    place = tmp_path / "a"

    def write() -> None:
        with files.atomic_write(place):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match="No space left") as refused:
        write()
    assert refused.value.filename == str(place)
    assert not [*tmp_path.iterdir()]


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc")
def test_the_system_says_why_nothing_can_be_written() -> None:
    told = r"No such file or directory: '/proc/a\.json'"
    with pytest.raises(OSError, match=told) as caught, files.atomic_write("/proc/a.json"):
        pass
    assert caught.value.errno == errno.ENOENT


def test_a_journal_without_room_is_named(tmp_path: Path) -> None:
    from dwell.cli.job_journal import Journal

    journal = Journal(tmp_path / "rows", {"command": "x"})
    journal._file.close()
    journal._file = Path("/dev/full").open("wb")  # noqa: SIM115 - the journal closes it
    with pytest.raises(OSError, match="No space left") as refused:
        journal.add("a", [{"x": 1}])
    assert refused.value.filename == str(tmp_path / ".rows.part")
    journal.close()
