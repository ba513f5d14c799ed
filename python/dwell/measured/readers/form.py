"""What every reader of tables gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Row = dict[str, Any]

#: A table has at most so many bytes, as for the reader of bundles.
MAX_TABLE_BYTES = 256 * 2**20
#: A table has at most so many columns.
MAX_COLUMNS = 4096


@dataclass(frozen=True)
class OpenTable:
    """A table whose head was read.

    Attributes:
        columns: Their names.
        rows: Each row with its number, from 1.
        delimiter: What parts the cells where they are text.
        facts: What the file itself says of columns, in words, by column.
        rows_with: Of formats whose columns may differ in length: the rows that have these columns.
            It refuses columns of which there are not equally many values. ``rows`` are those of
            most columns, without the others.
    """

    columns: list[str]
    rows: Iterator[tuple[int, Row]]
    delimiter: str = ","
    facts: Mapping[str, str] = field(default_factory=dict)
    rows_with: Callable[[Sequence[str]], Iterator[tuple[int, Row]]] | None = None


@dataclass(frozen=True)
class TableReader:
    """A format.

    Attributes:
        about: Its name.
        suffixes: Of its files.
        open: Reads a table; the second argument says which, of formats that hold several.
        parts: The names of the tables in a file; ``None``: a file is one table.
        of_folders: Whether it is a folder.
    """

    about: str
    suffixes: tuple[str, ...]
    open: Callable[[Path, str | None], OpenTable]
    parts: Callable[[Path], list[str]] | None = None
    of_folders: bool = False


def missing_package(path: Path, package: str, extra: str) -> ModuleNotFoundError:
    """The fault of a package that is not installed."""
    return ModuleNotFoundError(f"{path}: reading it needs {package}; pip install 'dwell[{extra}]'")


def flattened(name: str, value: object) -> Iterator[tuple[str, Any]]:
    """The numbers and texts of a nested value, by path: ``pose.position.x``, ``state[3]``."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from flattened(f"{name}.{key}" if name else str(key), inner)
    elif isinstance(value, list | tuple):
        # What is longer is a picture or a scan, not a few columns.
        if len(value) <= MAX_COLUMNS:
            for k, inner in enumerate(value):
                yield from flattened(f"{name}[{k}]", inner)
    else:
        yield name, value
