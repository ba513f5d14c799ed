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

from dwell.measured.places import Place


class WriteRow(Protocol):
    """Writes a row, and notes where it comes from."""

    def __call__(self, row: list[str], place: Place | None = None, /) -> None:
        """The cells in the order of the head."""


@dataclass
class _Origin:
    """Where the rows of a table of the bundle come from."""

    #: The user's column of each field; of a field with several, those that take turns.
    columns: Mapping[str, Sequence[str]]
    paths: list[Path] = field(default_factory=list)
    numbers: dict[Path, int] = field(default_factory=dict)
    #: The user's file and row of each row.
    files: array[int] = field(default_factory=lambda: array("L"))
    rows: array[int] = field(default_factory=lambda: array("Q"))

    def add(self, place: Place) -> None:
        number = self.numbers.setdefault(place.path, len(self.numbers))
        if number == len(self.paths):
            self.paths.append(place.path)
        self.files.append(number)
        self.rows.append(place.row)


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
        self._main = ""
        self._episodes: dict[str, Place] = {}
        self._clock = self._name = ""
        #: What becomes of gaps, for who can have it otherwise.
        self.gap_hint = ""
        #: Makes a fault with hints for the map of one with hints for the bundle.
        self.hints: Callable[[str], str] = str

    def measured(self, table: str, clock: str, episode: str) -> None:
        """Says which table holds the samples, and its columns of times and of episodes."""
        self._main, self._clock, self._name = table, clock, episode

    def begins(self, episode: str, place: Place) -> None:
        """Notes an episode's first row."""
        self._episodes.setdefault(episode, place)

    @contextlib.contextmanager
    def table(
        self, name: str, head: str, columns: Mapping[str, Sequence[str]] | None = None
    ) -> Iterator[WriteRow]:
        """A CSV file that is written row by row; each comes from a place of the user's files."""
        with (self.folder / name).open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(head.split(","))
            origin = self._origins.setdefault(name, _Origin(columns or {}))

            def write(row: list[str], place: Place | None = None, /) -> None:
                writer.writerow(row)
                if place is not None:
                    origin.add(place)

            yield write

    def told(self, fault: str, out: Path) -> str:
        """A fault of the bundle as one of the user's files."""
        # Its rows are those of the user's table.
        told = re.sub(r"\b(rows?) of [a-z]+\.csv\b", r"\1", self._told(self.hints(fault), out))
        is_gap = "missing before it" in told or "fill the gap in" in told
        return told + self.gap_hint if is_gap else told

    def _told(self, fault: str, out: Path) -> str:
        here = re.escape(str(self.folder))
        if found := re.match(rf"{here}/manifest\.json: (\S+)( is .*)", fault, re.DOTALL):
            return f"{self._field(found[1])}{found[2]}"
        if found := re.match(rf"{here}/manifest\.json(?: line \d+)?: (.*)", fault, re.DOTALL):
            # Lines and columns are those of a file that its user has never seen.
            return f"{self._map_file}: {re.sub(r' at line [0-9]+ column [0-9]+$', '', found[1])}"
        if found := re.match(rf"{here}/episodes\.csv line (\d+): \S+( is .*)", fault, re.DOTALL):
            row = [*self._episodes.values()][int(found[1]) - 2 :][:1]
            where = str(row[0]) if row else self._table()
            return f"{where}: column {self._name!r}{found[2]}"
        if found := re.match(rf"{here}/([a-z]+\.csv)(?: line (\d+))?(.*)", fault, re.DOTALL):
            origin = self._origins.get(found[1])
            if origin is not None and origin.paths:
                line = found[2] or self._line(found[1], found[3])
                return _in_table(origin, line, found[3])
        elif found := re.match(rf"{here}(, episode .*?)?: (.*)", fault, re.DOTALL):
            said = re.sub(r"^t_s is", f"column {self._clock!r} is", found[2])
            return f"{self._table()}{found[1] or ''}: {said}"
        return fault.replace(str(self.folder), str(out))

    def _line(self, table: str, rest: str) -> str | None:
        """The line of a table in which a fault's episode and time stand, if it tells both."""
        told = re.match(r", episode (.*), t_s (\S+): ", rest, re.DOTALL)
        if told is None:
            return None
        with (self.folder / table).open(newline="", encoding="utf-8") as file:
            for line, row in enumerate(csv.DictReader(file), 2):
                if row["episode"] == told[1] and float(row["t_s"]) == float(told[2]):
                    return str(line)
        return None

    def _table(self) -> str:
        return self._main or self._map_file

    def _field(self, name: str) -> str:
        """A field of the manifest, as the user has it."""
        for known, told in self.fields.items():
            if name == known or (known.endswith(".") and name.startswith(known)):
                return told + name.removeprefix(known)
        return f"{self._map_file}: {name}"


def _in_table(origin: _Origin, line: str | None, rest: str) -> str:
    """A fault of a table: ``rest`` is what follows its name and line."""
    where = str(origin.paths[0])
    at = int(line) - 2 if line else -1
    if 0 <= at < len(origin.rows):
        where = str(Place(origin.paths[origin.files[at]], origin.rows[at]))
    said = re.match(r"(.*?: )(\S+)( is .*)", rest, re.DOTALL)
    columns = origin.columns.get(said[2]) if said else None
    if said is None or not columns:
        return f"{where}{rest}"
    turn = max(at, 0) % len(columns)
    return f"{where}{said[1]}column {columns[turn]!r}{said[3]}"
