"""A bundle in the making, which knows from which file, row and column of the user it comes.

The bundle is checked by the reader of bundles, whose faults name the bundle's own files: these are
not there yet, and are told as faults of the user's files.
"""

from __future__ import annotations

import contextlib
import csv
import re
from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol


class _Source(Protocol):
    """A table that is read row by row."""

    path: Path
    row: int


@dataclass
class _Origin:
    """Where the rows of a table of the bundle come from."""

    source: _Source
    #: The user's column of each field; of a field with several, those that take turns.
    columns: Mapping[str, Sequence[str]]
    #: The user's row of each row.
    rows: array[int] = field(default_factory=lambda: array("Q"))


class BundleDraft:
    """The folder, its tables, and where all of it comes from."""

    def __init__(self, folder: Path, map_file: str) -> None:
        """An empty folder, and the name of the map."""
        self.folder = folder
        self._map_file = map_file
        #: The user's name for a field of the manifest, by the field or what it begins with.
        self.fields: dict[str, str] = {}
        self._origins: dict[str, _Origin] = {}
        #: The table of samples, and where each episode begins in it.
        self._main: _Source | None = None
        self._episodes: dict[str, int] = {}
        self._clock = self._name = ""

    def measured(self, source: _Source, clock: str, episode: str) -> None:
        """Says which table holds the samples, and its columns of times and of episodes."""
        self._main, self._clock, self._name = source, clock, episode

    def begins(self, episode: str) -> None:
        """Notes an episode's first row."""
        if self._main is not None:
            self._episodes.setdefault(episode, self._main.row)

    @contextlib.contextmanager
    def table(
        self,
        name: str,
        head: str,
        source: _Source | None = None,
        columns: Mapping[str, Sequence[str]] | None = None,
    ) -> Iterator[Callable[[list[str]], None]]:
        """A CSV file that is written row by row; each comes from the row that ``source`` is at."""
        with (self.folder / name).open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(head.split(","))
            if source is None:
                yield writer.writerow
                return
            origin = self._origins.setdefault(name, _Origin(source, columns or {}))

            def write(row: list[str]) -> None:
                writer.writerow(row)
                origin.rows.append(origin.source.row)

            yield write

    def told(self, fault: str, out: Path) -> str:
        """A fault of the bundle as one of the user's files."""
        here = re.escape(str(self.folder))
        if found := re.match(rf"{here}/manifest\.json: (\S+)( is .*)", fault, re.DOTALL):
            return f"{self._field(found[1])}{found[2]}"
        if found := re.match(rf"{here}/episodes\.csv line (\d+): \S+( is .*)", fault, re.DOTALL):
            row = [*self._episodes.values()][int(found[1]) - 2 :][:1]
            return f"{self._row(row)}: column {self._name!r}{found[2]}"
        if found := re.match(rf"{here}/([a-z]+\.csv)(?: line (\d+))?(.*)", fault, re.DOTALL):
            origin = self._origins.get(found[1])
            if origin is not None:
                return self._in_table(origin, found[2], found[3])
        elif found := re.match(rf"{here}(, episode .*?)?: (.*)", fault, re.DOTALL):
            said = re.sub(r"^t_s is", f"column {self._clock!r} is", found[2])
            return f"{self._row([])}{found[1] or ''}: {said}"
        return fault.replace(str(self.folder), str(out))

    def _in_table(self, origin: _Origin, line: str | None, rest: str) -> str:
        """A fault of a table: ``rest`` is what follows its name and line."""
        where = str(origin.source.path)
        at = int(line) - 2 if line else -1
        if 0 <= at < len(origin.rows):
            where += f" row {origin.rows[at]}"
        said = re.match(r"(.*?: )(\S+)( is .*)", rest, re.DOTALL)
        columns = origin.columns.get(said[2]) if said else None
        if said is None or not columns:
            return f"{where}{rest}"
        turn = max(at, 0) % len(columns)
        return f"{where}{said[1]}column {columns[turn]!r}{said[3]}"

    def _row(self, row: Sequence[int]) -> str:
        """A row of the table of samples."""
        name = self._map_file if self._main is None else str(self._main.path)
        return f"{name} row {row[0]}" if row else name

    def _field(self, name: str) -> str:
        """A field of the manifest, as the user has it."""
        for known, told in self.fields.items():
            if name == known or (known.endswith(".") and name.startswith(known)):
                return told + name.removeprefix(known)
        return f"{self._map_file}: {name}"
