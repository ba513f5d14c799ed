"""Parquet, by pyarrow; lists become columns ``name[0]``, ``name[1]``, ..."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dwell.files import open_file
from dwell.measured.readers.form import (
    MAX_COLUMNS,
    MAX_TABLE_BYTES,
    OpenTable,
    Row,
    TableReader,
    flattened,
    missing_package,
)


def parquet_module(path: Path) -> Any:  # noqa: ANN401 - an extra without types
    """``pyarrow.parquet``."""
    try:
        import pyarrow.parquet as parquet
    except ModuleNotFoundError:
        raise missing_package(path, "pyarrow", "data") from None
    return parquet


def _open(path: Path, _part: str | None) -> OpenTable:
    parquet = parquet_module(path)
    import pyarrow

    try:
        with open_file(path, MAX_TABLE_BYTES) as file, parquet.ParquetFile(file) as table:
            names = list(table.schema_arrow.names)
            nested = any(pyarrow.types.is_nested(kind) for kind in table.schema_arrow.types)
            first = next(iter(table.iter_batches(1)), None) if nested else None
    except pyarrow.ArrowException as error:
        raise ValueError(f"{path}: no Parquet: {error}") from None
    if first is not None and first.num_rows:
        names = [name for name, _ in flattened("", first.to_pylist()[0])]
    if len(names) > MAX_COLUMNS:
        raise ValueError(f"{path}: {len(names)} columns; at most {MAX_COLUMNS} are read")
    return OpenTable(names, parquet_rows(path))


def parquet_rows(path: Path) -> Iterator[tuple[int, Row]]:
    """The rows of a file, counted from 1."""
    parquet = parquet_module(path)
    import pyarrow

    number = 0
    try:
        with open_file(path, MAX_TABLE_BYTES) as file, parquet.ParquetFile(file) as table:
            nested = any(pyarrow.types.is_nested(kind) for kind in table.schema_arrow.types)
            for batch in table.iter_batches():
                for row in batch.to_pylist():
                    number += 1
                    yield number, dict(flattened("", row)) if nested else row
    except pyarrow.ArrowException as error:
        raise ValueError(f"{path} row {number + 1}: {error}") from None


READER = TableReader("Parquet", (".parquet",), _open)
