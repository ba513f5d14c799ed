"""A look into files: which tables they hold, and the numbers and texts of their columns."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dwell import csv_values
from dwell.measured.readers import Row, open_table, reader_of
from dwell.measured.tables import INDEX_COLUMN, NO_NUMBER, cell_text

Array = NDArray[np.float64]
#: Rows of a table that are looked at.
MOST_ROWS = 20_000
#: Share of cells of a column of numbers that may be something else.
_FEW_TEXTS = 0.1


@dataclass
class Survey:
    """One table.

    Attributes:
        path: The file; of several with the same columns, the first.
        part: Which table of the file, of formats that hold several.
        columns: Their names.
        numbers: Of each column that holds numbers alone; not a number where a cell has none.
        texts: Of the other columns.
        facts: What the file says of columns itself.
        alike: Files with the same columns, this one among them.
        rows: How many were looked at.
        starts: Where each of the files begins.
    """

    path: Path
    part: str | None
    columns: list[str]
    numbers: dict[str, Array]
    texts: dict[str, list[str]]
    facts: dict[str, str]
    alike: list[Path] = field(default_factory=list)
    rows: int = 0
    starts: list[int] = field(default_factory=list)

    @property
    def file(self) -> str | list[str]:
        """What a map calls it."""
        names = [path.name for path in self.alike]
        return names[0] if len(names) == 1 else names

    def only(self, column: str, value: float) -> Survey:
        """The rows that have a number in a column."""
        kept = self.numbers[column] == value
        starts = [int(kept[:start].sum()) for start in self.starts]
        numbers = {name: values[kept] for name, values in self.numbers.items()}
        texts = {
            name: [cell for cell, keep in zip(cells, kept, strict=True) if keep]
            for name, cells in self.texts.items()
        }
        rows = int(kept.sum())
        return replace(self, numbers=numbers, texts=texts, rows=rows, starts=starts)

    def episodes(self, column: str | None) -> list[slice | NDArray[np.int64]]:
        """The rows of each episode."""
        if column in self.numbers:
            told = [cell_text(v) for v in self.numbers[column].tolist()]
        elif column in self.texts:
            told = self.texts[column]
        else:
            ends = [*self.starts[1:], self.rows]
            return [slice(a, b) for a, b in zip(self.starts, ends, strict=True)]
        found: dict[str, list[int]] = {}
        file = 0
        for k, name in enumerate(told):
            file += file + 1 < len(self.starts) and k >= self.starts[file + 1]
            found.setdefault(name, []).append(k)
        return [np.array(rows, np.int64) for rows in found.values()]


def surveyed(files: list[Path]) -> list[Survey]:
    """The tables of files, the largest first; files of one form are one table.

    Raises:
        ValueError: A file cannot be read; the message names it.
    """
    found: dict[tuple[object, ...], Survey] = {}
    for path in files:
        parts = reader_of(path).parts
        for part in [None] if parts is None else parts(path):
            table = open_table(path, part)
            rows = list(itertools.islice(table.rows, MOST_ROWS))
            if not rows:
                raise ValueError(f"{path}: no rows{'' if part is None else f' in {part!r}'}")
            own = _of_rows(path, part, table.columns, rows, table.delimiter)
            own.facts = dict(table.facts)
            key = (path.suffix, part, tuple(table.columns))
            if key in found:
                _append(found[key], own)
            else:
                found[key] = own
    return sorted(found.values(), key=lambda survey: -survey.rows)


def _of_rows(
    path: Path,
    part: str | None,
    columns: list[str],
    rows: list[tuple[int, Row]],
    delimiter: str,
) -> Survey:
    numbers: dict[str, Array] = {}
    texts: dict[str, list[str]] = {}
    for column in columns:
        cells = [row.get(column) for _, row in rows]
        values = _as_numbers(cells, delimiter)
        if values is None:
            texts[column] = [cell_text(cell) for cell in cells]
        else:
            numbers[column] = values
    numbers.setdefault(INDEX_COLUMN, np.arange(float(len(rows))))
    return Survey(path, part, columns, numbers, texts, {}, [path], len(rows), [0])


def _as_numbers(cells: list[object], delimiter: str) -> Array | None:
    """Numbers, of which some may be missing; ``None`` where more than a few cells are texts."""
    found = np.full(len(cells), math.nan)
    known = texts = 0
    for k, cell in enumerate(cells):
        if cell is None or (isinstance(cell, str) and cell.strip().lower() in NO_NUMBER):
            continue
        try:
            if isinstance(cell, float) and not math.isfinite(cell):
                continue
            found[k] = csv_values.parse_cell_number("", {"": cell}, "", delimiter)
        except ValueError:
            # A slip in a cell or two is for the import to name.
            texts += 1
            if texts > _FEW_TEXTS * len(cells):
                return None
        known += 1
    return found if known > texts or not cells else None


def _append(survey: Survey, other: Survey) -> None:
    """Puts the rows of a file behind those of others of its form."""
    survey.alike.append(other.path)
    survey.starts.append(survey.rows)
    survey.rows += other.rows
    for column in [*survey.numbers, *survey.texts]:
        if column in survey.numbers and column in other.numbers:
            both = np.concatenate([survey.numbers[column], other.numbers[column]])
            survey.numbers[column] = both
            continue
        before = survey.texts.pop(column, None) or [
            cell_text(v) for v in survey.numbers.pop(column).tolist()
        ]
        after = other.texts.get(column) or [cell_text(v) for v in other.numbers[column].tolist()]
        survey.texts[column] = before + after
