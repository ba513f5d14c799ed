"""LeRobot datasets: a folder with ``meta/info.json`` and Parquet in ``data/chunk-*``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dwell.files import read_json
from dwell.measured.readers.form import MAX_COLUMNS, OpenTable, Row, TableReader
from dwell.measured.readers.parquet_files import parquet_rows

#: Files of a dataset that are read.
_MAX_FILES = 20_000
#: Forms of the dataset whose tables are these.
_VERSIONS = ("v3.", "v2.")


def _open(folder: Path, _part: str | None) -> OpenTable:
    info = read_info(folder)
    names: dict[str, list[str]] = {}
    for feature, about in info["features"].items():
        dtype = about.get("dtype") if isinstance(about, dict) else None
        # Pictures and videos are files of their own.
        if dtype in ("image", "video", "string", None):
            continue
        names[feature] = _element_names(feature, about)
    columns = [name for own in names.values() for name in own]
    if len(columns) > MAX_COLUMNS:
        raise ValueError(f"{folder}: {len(columns)} columns; at most {MAX_COLUMNS} are read")
    facts = {"timestamp": f"info.json: fps is {info.get('fps')}, times are seconds"}
    return OpenTable(columns, _rows(folder, names), facts=facts)


def read_info(folder: Path) -> dict[str, Any]:
    """``meta/info.json``, with its version known."""
    path = folder / "meta" / "info.json"
    if not path.exists():
        raise ValueError(f"{folder}: no meta/info.json; of folders, LeRobot datasets are read")
    info = read_json(path)
    if not isinstance(info, dict) or not isinstance(info.get("features"), dict):
        raise ValueError(f"{path}: no object with 'features'; is it a LeRobot dataset?")
    version = str(info.get("codebase_version"))
    if not version.startswith(_VERSIONS):
        raise ValueError(f"{path}: codebase_version is {version!r}; v2.x and v3.x are read")
    result: dict[str, Any] = info
    return result


def _element_names(feature: str, about: dict[str, Any]) -> list[str]:
    """The columns of a feature: by its elements' names where it has them, else by number."""
    shape, told = about.get("shape") or [1], about.get("names")
    if isinstance(told, dict) and len(told) == 1:
        told = next(iter(told.values()))
    count = shape[0] if isinstance(shape, list) and len(shape) == 1 else 0
    if not isinstance(count, int) or not 0 < count <= MAX_COLUMNS:
        return []
    if count == 1 and not told:
        return [feature]
    if isinstance(told, list) and len({*map(str, told)}) == count == len(told):
        return [f"{feature}.{name}" for name in told]
    return [f"{feature}[{k}]" for k in range(count)]


def _rows(folder: Path, names: dict[str, list[str]]) -> Iterator[tuple[int, Row]]:
    """The rows of all files in the order of their names."""
    root = folder.resolve()
    files = sorted((folder / "data").glob("chunk-*/*.parquet"))
    if not files:
        raise ValueError(f"{folder}: no data/chunk-*/*.parquet")
    if len(files) > _MAX_FILES:
        raise ValueError(f"{folder}: {len(files)} files of data; at most {_MAX_FILES} are read")
    number = 0
    for file in files:
        if not file.resolve().is_relative_to(root):
            raise ValueError(f"{file}: a link out of the dataset; a file inside it is needed")
        for at, row in parquet_rows(file):
            number += 1
            yield number, _named(row, names, f"{file} row {at}")


def _named(row: Row, names: dict[str, list[str]], at: str) -> Row:
    found: Row = {}
    for feature, own in names.items():
        if feature in row:
            found[own[0]] = row[feature]
            continue
        for k, name in enumerate(own):
            cell = f"{feature}[{k}]"
            if cell not in row:
                raise ValueError(f"{at}: no {cell!r}, which info.json tells of")
            found[name] = row[cell]
    return found


READER = TableReader("LeRobot", (), _open, of_folders=True)
