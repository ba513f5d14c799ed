"""Results of a long job, kept as they come: what was interrupted goes on where it stopped."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import zlib
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

from dwell.arguments import quoted
from dwell.files import (
    atomic_write,
    is_draft,
    lines,
    open_exclusive,
    open_file,
    parse_json,
    read_json,
)
from dwell.result_version import VERSION, refuse_other_version

_JOB, _DONE, _OF, _SUM = "job", "done", "of", "sum"
#: What differs between two jobs and is told of.
_MOST_DIFFERENCES = 3
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
            about = {"version": VERSION, **dataset}
            draft.write_text(json.dumps(about, indent=2) + "\n", "utf-8")
        refuse_other(out, dataset)


@contextlib.contextmanager
def alone(out: Path, shard: tuple[int, int]) -> Iterator[None]:
    """Keeps other processes from a shard of the folder ``out``, which is there.

    Raises:
        ValueError: One makes it.
    """
    which, shards = shard
    path = out / f".shard-{which}-of-{shards}.lock"
    try:
        lock = open_exclusive(path)
    except ValueError:
        part = f"shard {which}/{shards} of {out}" if shards > 1 else os.fspath(out)
        raise ValueError(
            f"{part} is being made by another process; wait for its end, or give another --out"
        ) from None
    with lock:
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                os.unlink(path)


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
    refuse_other_version(str(path), found)
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


def _is_begin_of_job(line: bytes) -> bool:
    """Returns whether a line that was cut began as the first one of a journal does."""
    head = b'{"%s": ' % _JOB.encode()
    return line.startswith(head) or head.startswith(line)


def _is_mark(row: object) -> bool:
    """Returns whether a row of a journal says that those above it are whole."""
    return isinstance(row, dict) and _DONE in row and set(row) <= {_DONE, _OF, _SUM}


def _sum_with(before: str, rows: bytes) -> str:
    """The check sum of rows and all before them, which detects damage, but no forgery."""
    return hashlib.blake2b(before.encode() + rows, digest_size=8).hexdigest()


def job_differences(before: object, now: object, at: str = "") -> list[str]:
    """What is another in two jobs, by its place, a clause each."""
    if isinstance(before, dict) and isinstance(now, dict):
        names = [*now, *(name for name in before if name not in now)]
        return [
            clause
            for name in names
            for clause in job_differences(
                before.get(name), now.get(name), f"{at}.{name}" if at else str(name)
            )
        ]
    if before == now:
        return []
    return [f"{at} was {quoted(before, 80)} and is {quoted(now, 80)}"]


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

    def __init__(
        self, out: Path, job: dict[str, Any], *, preliminary: Collection[str] = ()
    ) -> None:
        """Opens the journal of an earlier, interrupted run of the same job, or a new one.

        One in which nothing was finished is begun anew, whatever job it is of.

        Args:
            out: Where the result will stand.
            job: What the rows depend on.
            preliminary: Items that are no work: what is kept of them alone is nothing finished.

        Raises:
            ValueError: There are rows of another job, which stay, or another process writes them;
                or they were damaged.
            FileExistsError: The result stands there, or another file by that name.
            OSError: The system refuses, or ``out`` is a folder.
        """
        if out.is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a folder, not a file", os.fspath(out))
        self._out = out
        self._path = out.with_name(_hidden_name(out.name))
        self._preliminary = {*preliminary}
        out.parent.mkdir(parents=True, exist_ok=True)
        #: Items whose rows are there, in the order they came, with what they were made of.
        self.done: dict[str, str | None] = {}
        self._sum = ""
        self._file: IO[bytes] = open_exclusive(self._path)
        try:
            keep = self._read(job)
        except BaseException:
            self._close_file()
            raise
        try:
            if not keep and os.path.lexists(out):
                # Nothing was begun for it here: it is somebody else's, or whole.
                why = "is there already; name a new file, or remove it first"
                raise FileExistsError(errno.EEXIST, why, os.fspath(out))
            self._file.seek(keep)
            self._file.truncate()
            if not keep:
                self._add_rows([{_JOB: job}])
        except BaseException:
            self.close()
            raise

    def _read(self, job: dict[str, Any]) -> int:
        """Number of bytes of the old journal that are whole; 0 for none."""
        found: object = None
        keep = at = number = 0
        since = b""
        for number, line in enumerate(lines(self._file, self._path), start=1):
            at += len(line)
            try:
                row = parse_json(line, str(self._path))
            except ValueError:
                # What has no end was cut, as by a power cut.
                is_cut = not line.endswith(b"\n")
                if number == 1 and not (is_cut and _is_begin_of_job(line)):
                    raise self._not_ours() from None
                if is_cut:
                    break
                if found == job:
                    raise self._damaged(number) from None
                continue
            if number == 1:
                if not isinstance(row, dict) or set(row) != {_JOB}:
                    raise self._not_ours()
                found = row[_JOB]
            since += line
            # A mark without an end was cut, too.
            if (number == 1 or _is_mark(row)) and line.endswith(b"\n"):
                said = {key: part for key, part in row.items() if key != _SUM}
                rows = since if number == 1 else since[: -len(line)] + _line(said)
                self._sum = _sum_with(self._sum, rows)
                if number > 1:
                    # Of another job nothing is read.
                    if row.get(_SUM) != self._sum and found == job:
                        raise self._damaged(number)
                    self.done[str(row[_DONE])] = row.get(_OF)
                keep, since = at, b""
        if not self._has_work():
            self.done.clear()
            self._sum = ""
            return 0
        if found != job:
            told = job_differences(found, job)
            more = len(told) - _MOST_DIFFERENCES
            clauses = "; ".join(told[:_MOST_DIFFERENCES]) + (
                f"; and {more} more" if more > 0 else ""
            )
            raise ValueError(
                f"{self._path} keeps what another job has done for {self._out}: {clauses}. To go "
                f"on with that job, give its options again; to begin this one, remove {self._path} "
                f"or give another --out"
            )
        return keep

    def _has_work(self) -> bool:
        """Returns whether an item is finished that is work."""
        return any(item not in self._preliminary for item in self.done)

    def _not_ours(self) -> ValueError:
        return ValueError(
            f"{self._path} is no journal of {self._out}, and stays as it is; remove it, or give "
            "another --out"
        )

    def _damaged(self, number: int) -> ValueError:
        return ValueError(
            f"{self._path} line {number}: what is kept up to here is not what was written: it was "
            f"changed or damaged, or is of another version; remove {self._path}, so that all is "
            "done anew, or give another --out"
        )

    def _add_rows(self, rows: Sequence[object], mark: dict[str, Any] | None = None) -> None:
        """Writes rows, and the mark that they are whole with the check sum of all so far."""
        written = b"".join(map(_line, rows))
        after = _sum_with(self._sum, written if mark is None else written + _line(mark))
        if mark is not None:
            written += _line({**mark, _SUM: after})
        try:
            self._file.write(written)
            self._file.flush()
        except OSError as error:
            # People know the result by its name; the journal is where there is no room.
            error.filename = error.filename or os.fspath(self._path)
            raise
        self._sum = after

    def add(self, item: str, rows: Sequence[object], of: str | None = None) -> None:
        """Keeps the rows of an item; ``of`` says what they were made of."""
        self._add_rows(rows, {_DONE: item} if of is None else {_DONE: item, _OF: of})
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

    def finish(
        self,
        whole: Callable[[Iterator[Any]], str] | None = None,
        *,
        order: Callable[[Iterator[bytes]], Iterator[bytes]] = lambda lines: lines,
    ) -> None:
        """Writes the rows of all items into the result, and forgets the journal.

        Args:
            whole: Makes the text of the result of the rows; by default it is a row a line.
            order: Puts these lines in order; by default they stand as they came.
        """
        # Locked to the end: another process of this job finds the result, or this journal.
        with self._file:
            self._file.flush()
            with atomic_write(self._out) as path, path.open("wb") as result:
                if whole is not None:
                    result.write(whole(map(json.loads, self._rows())).encode())
                for line in order(self._rows()) if whole is None else ():
                    result.write(line)
            os.unlink(self._path)

    def close(self) -> None:
        """Leaves the journal for the next run; one in which nothing was finished is removed."""
        if not self._file.closed and not self._has_work():
            # While it is locked: nobody else has begun it anew.
            with contextlib.suppress(OSError):
                os.unlink(self._path)
        self._close_file()

    def _close_file(self) -> None:
        # A row that has no room on the disk is cut, and left out by the next run.
        with contextlib.suppress(OSError):
            self._file.close()

    def _rows(self) -> Iterator[bytes]:
        with open_file(self._path) as file:
            next(file)
            for line in file:
                if not _is_mark(json.loads(line)):
                    yield line
