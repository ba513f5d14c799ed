"""Where files can stand, and folders that are there whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from dwell import files


def test_where_no_file_can_stand_is_known_before_anything_is_made(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "nowhere").symlink_to(tmp_path / "missing")
    files.check_writable(tmp_path / "file")
    files.check_writable(tmp_path / "new" / "deep" / "a.png")
    for place, told in (("file/z.png", "is no folder"), ("nowhere", "is a link")):
        with pytest.raises(OSError, match=told):
            files.check_writable(tmp_path / place)
    with pytest.raises(OSError, match="is a folder"):
        files.check_writable(tmp_path)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "nowhere"]


def overtaken(place: Path, first: Path) -> None:
    """Makes a folder while another takes its place."""
    with files.atomic_folder(place) as draft:
        assert draft != first
        (draft / "a").write_text("another")
        place.mkdir()


def test_a_folder_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    place = tmp_path / "above" / "set"
    with files.atomic_folder(place) as draft:
        (draft / "a").write_text("whole")
        assert not place.exists()
        # Another process makes the same meanwhile, and is the second to be ready.
        with pytest.raises(FileExistsError, match="is there already") as refused:
            overtaken(place, draft)
        assert refused.value.filename == str(place)
        place.rmdir()
    assert (place / "a").read_text() == "whole"
    with pytest.raises(FileExistsError, match="is there already"), files.atomic_folder(place):
        pass
    with pytest.raises(RuntimeError), files.atomic_folder(tmp_path / "none"):
        raise RuntimeError
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["above"]
    assert sorted(entry.name for entry in place.parent.iterdir()) == ["set"]
