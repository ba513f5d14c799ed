"""The paths of a pattern, out of a bounded number of files and folders that are looked at."""

from __future__ import annotations

import fnmatch
import glob
import os
from collections.abc import Iterator

from dwell import HouseError

#: Files and folders that a pattern looks at before it is refused.
_MOST_VISITED = 1_000_000
_ANY_FOLDERS = "**"


def matching_paths(pattern: str, folder: str = "", most_visited: int | None = None) -> list[str]:
    """The paths of a pattern, as :func:`glob.glob` finds them, sorted.

    ``*``, ``?`` and ``[...]`` stand for letters of a name, ``**`` for any folders; names that begin
    with a dot are found where the pattern says the dot. ``**`` follows no links, and no other part
    of a pattern follows one to a folder outside of the folder in which the pattern begins. Folders
    that cannot be listed are passed over.

    Args:
        pattern: The pattern; what is found begins as it does.
        folder: The folder that a relative pattern is relative to.
        most_visited: Files and folders that are looked at, at most; by default a million.

    Raises:
        HouseError: There are more to look at.
    """
    search = _Search(pattern, folder, _MOST_VISITED if most_visited is None else most_visited)
    return sorted(set(search.paths()))


class _Search:
    """The search for one pattern; ``path`` is always as found, relative to the folder."""

    def __init__(self, pattern: str, folder: str, most_visited: int) -> None:
        self._place = os.path.join(folder, pattern)
        self._folder = folder
        self._left = self._most = most_visited
        drive, rest = os.path.splitdrive(pattern)
        parts = rest.split(os.sep) if os.altsep is None else rest.replace("/", os.sep).split(os.sep)
        start = drive
        if rest.startswith(os.sep):
            start = drive + os.sep
        # An empty last part asks for folders; others say nothing.
        self._parts = [part for part in parts[:-1] if part] + parts[-1:]
        while len(self._parts) > 1 and not glob.has_magic(self._parts[0]):
            start = os.path.join(start, self._parts.pop(0))
        self._start = start
        self._base = os.path.realpath(self._real(start))

    def _real(self, path: str) -> str:
        return os.path.join(self._folder, path) or os.curdir

    def paths(self) -> Iterator[str]:
        """What is found, in any order, some of it twice."""
        # Where to go on, at which part; folders that ** has gone into go on at it.
        waiting = [(self._start, 0, False)]
        seen = set(waiting)
        while waiting:
            for found, part, is_within in self._step(*waiting.pop()):
                if part == len(self._parts):
                    yield found
                elif (found, part, is_within) not in seen:
                    seen.add((found, part, is_within))
                    waiting.append((found, part, is_within))

    def _step(self, path: str, at: int, is_within: bool) -> Iterator[tuple[str, int, bool]]:
        """What one part of the pattern finds in a folder."""
        part = self._parts[at]
        is_last = at == len(self._parts) - 1
        if not part:
            if path and os.path.isdir(self._real(path)):
                yield os.path.join(path, ""), at + 1, False
        elif part == _ANY_FOLDERS:
            if not is_within and not is_last:
                yield path, at + 1, False
            elif not is_within and path and os.path.isdir(self._real(path)):
                yield os.path.join(path, ""), at + 1, False
            for entry in self._entries(path):
                if entry.name.startswith("."):
                    continue
                found = os.path.join(path, entry.name)
                is_folder = entry.is_dir(follow_symlinks=False)
                if is_last or is_folder:
                    yield found, at + 1, False
                if is_folder:
                    yield found, at, True
        elif not glob.has_magic(part):
            found = os.path.join(path, part)
            if os.path.lexists(self._real(found)) and (is_last or self._is_inside(found)):
                yield found, at + 1, False
        else:
            for entry in self._entries(path):
                is_hidden = entry.name.startswith(".") and not part.startswith(".")
                if is_hidden or not fnmatch.fnmatch(entry.name, part):
                    continue
                found = os.path.join(path, entry.name)
                if is_last or (entry.is_dir() and self._is_inside(found)):
                    yield found, at + 1, False

    def _is_inside(self, path: str) -> bool:
        """Returns whether a folder is no link that leads out of where the pattern begins."""
        real = self._real(path)
        if not os.path.islink(real):
            return True
        aim = os.path.realpath(real)
        return aim == self._base or aim.startswith(os.path.join(self._base, ""))

    def _entries(self, path: str) -> Iterator[os.DirEntry[str]]:
        try:
            with os.scandir(self._real(path)) as rows:
                for entry in rows:
                    self._left -= 1
                    if self._left < 0:
                        raise HouseError(
                            f"{self._place}: more than {self._most} files and folders were looked "
                            "at; begin the pattern in a folder that holds fewer, or list the "
                            "houses in a file, @FILE"
                        )
                    yield entry
        except OSError:
            # As of somebody else, or gone meanwhile.
            return
