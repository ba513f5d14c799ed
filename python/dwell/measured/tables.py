"""The rows of a table that a map names: of one file, or of several of the same columns."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from dwell import csv_values
from dwell.measured.maps import column_list, require
from dwell.measured.places import Place
from dwell.measured.readers import Row, open_table

#: Columns that every table has: the file's name without its suffix, and the row, from 0.
FILE_COLUMN, INDEX_COLUMN = "{file}", "{index}"
#: Cells that stand for no number.
NO_NUMBER = {"", "nan", "na", "n/a", "null", "none", "-", "inf", "+inf", "-inf"}


def cell_text(value: object) -> str:
    """What a cell says, as names are written: 3.0 is 3."""
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


class MeasuredTable:
    """A table's rows, with their places."""

    def __init__(self, part: Mapping[str, Any], files: Mapping[str, Path], at: str) -> None:
        """Finds the files that the map names among those that were given."""
        self.paths = files_named(require(part, "file", at), files, at)
        self._section: str | None = part.get("part")
        self._only = {
            column: {cell_text(v) for v in (value if isinstance(value, list) else [value])}
            for column, value in (part.get("only") or {}).items()
        }
        self._at = at
        self._needed: list[str] = []
        self.delimiter = ","
        first = open_table(self.paths[0], self._section)
        self.columns = first.columns

    @property
    def name(self) -> str:
        """How messages name it."""
        return str(self.paths[0]) if len(self.paths) == 1 else str(self.paths[0].parent)

    def has(self, names: list[str]) -> None:
        """Refuses columns that are not there."""
        needed = [*names, *self._only]
        self._needed = [name for name in needed if name not in (FILE_COLUMN, INDEX_COLUMN)]
        csv_values.require_unique_columns(self.paths[0], self.columns, self._needed)

    def __iter__(self) -> Iterator[tuple[Place, Row]]:
        """Places and rows."""
        matched = False
        for path in self.paths:
            found = open_table(path, self._section)
            self.delimiter = found.delimiter
            csv_values.require_unique_columns(path, found.columns, self._needed)
            stem = path.stem
            rows = found.rows if found.rows_with is None else found.rows_with(self._needed)
            for number, row in rows:
                row.setdefault(FILE_COLUMN, stem)
                row.setdefault(INDEX_COLUMN, number - 1)
                if all(cell_text(row.get(name)) in told for name, told in self._only.items()):
                    matched = True
                    yield Place(path, number), row
        if self._only and not matched:
            only = {name: sorted(values) for name, values in self._only.items()}
            raise ValueError(f"{self._at}: only is {only}; no row of {self.name} has that")

    def text(self, row: Row, columns: list[str]) -> str:
        """The texts of columns without space around them, joined by a slash."""
        return "/".join(cell_text(row.get(name)).strip() for name in columns)

    def number(self, place: Place, row: Row, column: str) -> float:
        """A finite number in a column."""
        return csv_values.parse_cell_number(str(place), row, column, self.delimiter)

    def measured(self, place: Place, row: Row, column: str) -> float:
        """A number in a column; not a number where there is none, as of a tracker that lost it."""
        value = row.get(column)
        if type(value) is float or type(value) is int:
            return value if math.isfinite(value) else math.nan
        if value is None or (isinstance(value, str) and value.strip().lower() in NO_NUMBER):
            return math.nan
        return csv_values.parse_cell_number(str(place), row, column, self.delimiter)


def files_named(told: str | list[str], files: Mapping[str, Path], at: str) -> list[Path]:
    """The given files of a name, a pattern (``throw_*.csv``) or a list of names."""
    found: list[Path] = []
    for name in [told] if isinstance(told, str) else told:
        if name in files:
            found.append(files[name])
            continue
        matching = sorted(known for known in files if fnmatch.fnmatchcase(known, str(name)))
        if not matching:
            raise ValueError(f"{at}: file {name!r} was not given; given are {sorted(files)}")
        found += [files[known] for known in matching]
    if not found:
        raise ValueError(f"{at}: file is {told!r}; the name of a file is needed")
    return found


def names_of(part: Mapping[str, Any], key: str, at: str, default: list[str]) -> list[str]:
    """The columns of a name, such as an episode's, or a default."""
    return column_list(part, key, at) or default
