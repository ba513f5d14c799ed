"""Formats of files that hold tables. A format is a file here and a line in :data:`READERS`."""

from __future__ import annotations

from pathlib import Path

from dwell.measured.readers import csv_files, hdf5_files, lerobot, mcap_files, parquet_files
from dwell.measured.readers.form import OpenTable, Row, TableReader

__all__ = ["READERS", "OpenTable", "Row", "TableReader", "open_table", "reader_of"]

READERS: tuple[TableReader, ...] = (
    csv_files.READER,
    parquet_files.READER,
    lerobot.READER,
    hdf5_files.READER,
    mcap_files.READER,
)


def reader_of(path: Path) -> TableReader:
    """The reader of a file.

    Raises:
        ValueError: No reader knows its suffix.
    """
    is_folder = path.is_dir()
    for reader in READERS:
        if reader.of_folders if is_folder else path.suffix.lower() in reader.suffixes:
            return reader
    suffixes = [suffix for reader in READERS for suffix in reader.suffixes]
    raise ValueError(
        f"{path}: {path.suffix or 'no suffix'}; {', '.join(suffixes)} and folders of LeRobot "
        "datasets are read as tables"
    )


def open_table(path: Path, part: str | None = None) -> OpenTable:
    """The table of a file, or one of those that it holds (a topic, a group).

    Raises:
        ValueError: It cannot be read; the message names it.
        ModuleNotFoundError: A package that reads it is not there; the message names the extra.
    """
    reader = reader_of(path)
    if part is not None and reader.parts is None:
        raise ValueError(f"{path}: a {reader.about} file holds one table; leave out 'part'")
    return reader.open(path, part)
