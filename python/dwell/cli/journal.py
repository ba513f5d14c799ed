"""Results of a long job, kept as they come: what was interrupted goes on where it stopped."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Any

from dwell.cli.common import atomic, read_json

_JOB, _DONE = "job", "done"
#: What is the same for a whole folder; it stands there from the beginning.
_DATASET = "dataset.json"


def claim(out: Path, dataset: dict[str, Any]) -> None:
    """Says what a folder holds.

    Raises:
        ValueError: It holds something else, or was begun by another job.
    """
    path = out / _DATASET
    if path.exists():
        found = read_json(path)
        other = [key for key in dataset if found.get(key) != dataset[key]]
        if other:
            said = ", ".join(f"{key} {found.get(key)!r}" for key in other)
            raise ValueError(f"{out} was begun with {said}; give another --out, or the same again")
        return
    if out.exists() and any(out.iterdir()):
        raise ValueError(f"{out} holds something else; expected an empty or a new folder")
    with atomic(path) as draft:
        draft.write_text(json.dumps(dataset, indent=2) + "\n", "utf-8")


class Journal:
    """A file beside the result: rows of each item, then a mark that they are whole."""

    def __init__(self, out: Path, job: dict[str, Any]) -> None:
        """Opens the journal of an earlier, interrupted run of the same job, or a new one.

        Args:
            out: Where the result will stand.
            job: What the rows depend on; a journal of another job is begun anew.
        """
        self._out = out
        self._path = out.with_name(f".{out.name}.part")
        out.parent.mkdir(parents=True, exist_ok=True)
        #: Items whose rows are there, in the order they came.
        self.done: list[str] = []
        keep = self._read(job)
        self._file: IO[bytes] = self._path.open("r+b" if keep else "wb")
        self._file.seek(keep)
        self._file.truncate()
        if not keep:
            self._write([{_JOB: job}])

    def _read(self, job: dict[str, Any]) -> int:
        """How many bytes of the old journal are whole; 0 for none, or for another job's."""
        if not self._path.exists():
            return 0
        keep = at = 0
        with self._path.open("rb") as file:
            for k, line in enumerate(file):
                at += len(line)
                try:
                    row = json.loads(line)
                except ValueError:
                    break
                if k == 0 and row != {_JOB: job}:
                    return 0
                if k == 0 or (isinstance(row, dict) and set(row) == {_DONE}):
                    keep = at
                    self.done += [row[_DONE]] if k else []
        return keep

    def _write(self, rows: Sequence[object]) -> None:
        text = "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in rows)
        self._file.write(text.encode())
        self._file.flush()

    def add(self, item: str, rows: Sequence[object]) -> None:
        """Keeps the rows of an item."""
        self._write([*rows, {_DONE: item}])
        self.done.append(item)

    def finish(self) -> None:
        """Writes the rows of all items into the result, and forgets the journal."""
        self._file.close()
        with atomic(self._out) as path, path.open("wb") as result:
            for line in self._rows():
                result.write(line)
        os.unlink(self._path)

    def close(self) -> None:
        """Leaves the journal for the next run."""
        self._file.close()

    def _rows(self) -> Iterator[bytes]:
        with self._path.open("rb") as file:
            next(file)
            for line in file:
                if set(json.loads(line)) != {_DONE}:
                    yield line
