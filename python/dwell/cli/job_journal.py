"""Results of a long job, kept as they come: what was interrupted goes on where it stopped."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import zlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

from dwell.files import (
    atomic_write,
    is_draft,
    lines,
    open_exclusive,
    open_file,
    parse_json,
    read_json,
)

_JOB, _DONE, _OF = "job", "done", "of"
#: Of a result's name, in that of its journal; file systems have names of up to 255 bytes.
_NAME_BYTES = 230
#: What is the same for a whole folder; it stands there from the beginning.
_DATASET = "dataset.json"


def claim(out: Path, dataset: dict[str, Any]) -> None:
    """Says what a folder holds; several processes may do so at the same time.

    Raises:
        ValueError: It holds something else, or was begun by another job.
    """
    refuse_other(out, dataset)
    path = out / _DATASET
    if not path.exists():
        with contextlib.suppress(FileExistsError), atomic_write(path, new=True) as draft:
            draft.write_text(json.dumps(dataset, indent=2) + "\n", "utf-8")
        refuse_other(out, dataset)


def refuse_other(out: Path, dataset: dict[str, Any]) -> None:
    """Refuses a folder that :func:`claim` would, and leaves it as it is.

    Raises:
        ValueError: It holds something else, or was begun by another job.
    """
    path = out / _DATASET
    if not path.exists():
        holds = out.exists() and any(not is_draft(name) for name in os.listdir(out))
        # What another process has just begun is no other thing than this.
        if holds and not path.exists():
            raise ValueError(f"{out} holds something else; expected an empty or a new folder")
        if not path.exists():
            return
    found = read_json(path)
    if not isinstance(found, dict):
        raise ValueError(f"{path}: expected an object, found {found!r:.60}")
    other = [key for key in dataset if found.get(key) != dataset[key]]
    if other:
        said = ", ".join(f"{key} {found.get(key)!r:.60}" for key in other)
        raise ValueError(f"{out} was begun with {said}; give another --out, or the same again")


def _hidden_name(name: str) -> str:
    """The name of the journal beside the result ``name``, which may be as long as names can be."""
    whole = os.fsencode(name)
    if len(whole) <= _NAME_BYTES:
        return f".{name}.part"
    return f".{whole[:_NAME_BYTES].decode(errors='ignore')}-{zlib.crc32(whole):08x}.part"


def _line(row: object) -> bytes:
    return (json.dumps(row, ensure_ascii=False) + "\n").encode()


def _is_mark(row: object) -> bool:
    """Returns whether a row of a journal says that those above it are whole."""
    return isinstance(row, dict) and _DONE in row and set(row) <= {_DONE, _OF}


def is_of_files(house: str) -> bool:
    """Returns whether files are read for a house, which may change while a job is stopped."""
    return not house.startswith(("builtin:", "seed:")) or "?map=" in house


def contents_of(house: str) -> str | None:
    """What a house of files holds, in short; ``None`` for one that no file is read for."""
    from dwell import DwellError
    from dwell.house import House

    if not is_of_files(house):
        return None
    try:
        return f"{hash(House.open(house)):x}"
    except (DwellError, OSError):
        return "nothing that can be opened"


class Journal:
    """A file beside the result: rows of each item, then a mark that they are whole."""

    def __init__(self, out: Path, job: dict[str, Any]) -> None:
        """Opens the journal of an earlier, interrupted run of the same job, or a new one.

        Args:
            out: Where the result will stand.
            job: What the rows depend on.

        Raises:
            ValueError: There are rows of another job, which stay, or another process writes them.
            FileExistsError: The result stands there, or another file by that name.
            OSError: The system refuses, or ``out`` is a folder.
        """
        if out.is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a folder, not a file", os.fspath(out))
        self._out = out
        self._path = out.with_name(_hidden_name(out.name))
        out.parent.mkdir(parents=True, exist_ok=True)
        #: Items whose rows are there, in the order they came, with what they were made of.
        self.done: dict[str, str | None] = {}
        is_new = not os.path.lexists(self._path)
        self._file: IO[bytes] = open_exclusive(self._path)
        try:
            keep = self._read(job)
            if not keep and os.path.lexists(out):
                # Nothing was begun for it here: it is somebody else's, or whole.
                if is_new:
                    os.unlink(self._path)
                why = "is there already; name a new file, or remove it first"
                raise FileExistsError(errno.EEXIST, why, os.fspath(out))
            self._file.seek(keep)
            self._file.truncate()
            if not keep:
                self._write([{_JOB: job}])
        except BaseException:
            self.close()
            raise

    def _read(self, job: dict[str, Any]) -> int:
        """Number of bytes of the old journal that are whole; 0 for none."""
        keep = at = 0
        for k, line in enumerate(lines(self._file, self._path)):
            at += len(line)
            try:
                row = parse_json(line, str(self._path))
            except ValueError:
                if k == 0 and not _line({_JOB: job}).startswith(line):
                    raise ValueError(
                        f"{self._path} is no journal of {self._out}, and stays as it is; remove "
                        "it, or give another --out"
                    ) from None
                break
            if k == 0 and row != {_JOB: job}:
                raise ValueError(
                    f"{self._path} keeps what another job has done for {self._out}; run that one "
                    f"again to its end, give another --out, or remove {self._path}"
                )
            if k == 0 or _is_mark(row):
                keep = at
                if k:
                    self.done[str(row[_DONE])] = row.get(_OF)
        return keep

    def _write(self, rows: Sequence[object]) -> None:
        try:
            self._file.write(b"".join(map(_line, rows)))
            self._file.flush()
        except OSError as error:
            # People know the result by its name; the journal is where there is no room.
            error.filename = error.filename or os.fspath(self._path)
            raise

    def add(self, item: str, rows: Sequence[object], of: str | None = None) -> None:
        """Keeps the rows of an item; ``of`` says what they were made of."""
        self._write([*rows, {_DONE: item} if of is None else {_DONE: item, _OF: of}])
        self.done[item] = of

    def refuse_changed(self, of: Callable[[str], str | None]) -> None:
        """Refuses rows of an item that is made of something else now, by what ``of`` says of it.

        Raises:
            ValueError: There are such rows, which stay.
        """
        for item, before in self.done.items():
            if before is not None and of(item) != before:
                raise ValueError(
                    f"{item} has changed since {self._path} kept what was done of it; remove "
                    f"{self._path}, so that all is done anew, or give another --out"
                )

    def finish(self, whole: Callable[[Iterator[Any]], str] | None = None) -> None:
        """Writes the rows of all items into the result, and forgets the journal.

        Args:
            whole: Makes the text of the result of the rows; by default it is a row a line.
        """
        # Locked to the end: another process of this job finds the result, or this journal.
        with self._file:
            self._file.flush()
            with atomic_write(self._out) as path, path.open("wb") as result:
                if whole is not None:
                    result.write(whole(map(json.loads, self._rows())).encode())
                for line in self._rows() if whole is None else ():
                    result.write(line)
            os.unlink(self._path)

    def close(self) -> None:
        """Leaves the journal for the next run."""
        # A row that has no room on the disk is cut, and left out by the next run.
        with contextlib.suppress(OSError):
            self._file.close()

    def _rows(self) -> Iterator[bytes]:
        with open_file(self._path) as file:
            next(file)
            for line in file:
                if not _is_mark(json.loads(line)):
                    yield line
