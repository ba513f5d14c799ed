"""Where files can stand, which is known before anything is made."""

from __future__ import annotations

from pathlib import Path

import pytest

from dwell import files


def test_where_no_file_can_stand_is_known_before_anything_is_made(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "nowhere").symlink_to(tmp_path / "missing")
    files.check_writable(tmp_path / "file")
    files.check_writable(tmp_path / "new" / "deep" / "a.png")
    for place, told in (("file/z.png", "is no folder"), ("nowhere", "leads to no file")):
        with pytest.raises(OSError, match=told):
            files.check_writable(tmp_path / place)
    with pytest.raises(OSError, match="is a folder"):
        files.check_writable(tmp_path)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "nowhere"]
