"""CSV in UTF-8, parted by commas, semicolons or tabs."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator
from pathlib import Path

from dwell import csv_values
from dwell.files import open_file
from dwell.measured.readers.form import MAX_TABLE_BYTES, OpenTable, Row, TableReader


def _open(path: Path, _part: str | None) -> OpenTable:
    head = _head(path)
    delimiter = csv_values.delimiter_of(head)
    try:
        cells = next(csv.reader([head], delimiter=delimiter), [])
    except csv.Error as error:
        raise ValueError(f"{path} line 1: {error}") from None
    columns = [name.strip() for name in cells]
    return OpenTable(columns, _rows(path, columns, delimiter), delimiter)


#: Most characters of a line: rows of tables are far shorter, and a line is in memory as a whole.
_MAX_LINE = 1_000_000


def _lines(file: io.TextIOWrapper, path: Path) -> Iterator[str]:
    """The lines of a table.

    Raises:
        ValueError: One is longer than any row.
    """
    number = 0
    while line := file.readline(_MAX_LINE + 1):
        number += 1
        if len(line) > _MAX_LINE:
            raise ValueError(
                f"{path} line {number} has more than {_MAX_LINE:,} characters; end each row of the "
                "table by a line feed"
            )
        yield line


def _text(path: Path) -> io.TextIOWrapper:
    return io.TextIOWrapper(open_file(path, MAX_TABLE_BYTES), encoding="utf-8-sig", newline="")


def _head(path: Path) -> str:
    """The first line."""
    try:
        with _text(path) as file:
            return next(_lines(file, path), "")
    except UnicodeDecodeError as error:
        raise csv_values.encoding_error(path, error) from None


def _rows(path: Path, columns: list[str], delimiter: str) -> Iterator[tuple[int, Row]]:
    """The rows below the head."""
    try:
        with _text(path) as file:
            reader = csv.reader(_lines(file, path), delimiter=delimiter)
            rows = (row for row in reader if row)
            for number, row in enumerate(itertools.islice(rows, 1, None), start=1):
                if len(row) != len(columns):
                    raise ValueError(
                        f"{path} row {number}: {len(row)} cells, and the head has {len(columns)}: "
                        f"a cell {'is missing' if len(row) < len(columns) else 'too many'} "
                        f"({delimiter.join(row)[:80]!r})"
                    )
                yield number, dict(zip(columns, row, strict=True))
    except csv.Error as error:
        raise ValueError(f"{path} line {reader.line_num}: {error}") from None
    except UnicodeDecodeError as error:
        raise csv_values.encoding_error(path, error) from None


READER = TableReader("CSV", (".csv", ".tsv"), _open)
