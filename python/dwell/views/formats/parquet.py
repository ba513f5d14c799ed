"""Parquet: a view a row, the pictures inside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from dwell.views.stored import picture_bytes, records

#: Rows that are written at a time.
_ROWS = 256


def write(folder: Path, out: Path) -> None:
    """Writes ``SPLIT.parquet``.

    Columns: ``id``, ``house``, ``split``, ``light``; ``image``, ``depth``, ``instance``,
    ``normals`` (``bytes`` of a PNG and its ``path``, as ``datasets`` reads pictures); ``short``,
    ``normal``, ``long``; ``questions`` (``text``, ``answer``, ``template``, ``kind``);
    ``references`` (``id``, ``text``, ``strategy``); ``record``, the whole as JSON.

    Raises:
        ModuleNotFoundError: pyarrow is not installed.
    """
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            "form parquet needs pyarrow, which is not installed: pip install 'dwell[data]'"
        ) from None
    picture = pa.struct([("bytes", pa.binary()), ("path", pa.string())])
    asked = pa.struct([(name, pa.string()) for name in _ASKED])
    referred = pa.struct([("id", pa.int64()), ("text", pa.string()), ("strategy", pa.string())])
    schema = pa.schema(
        [
            *((name, pa.string()) for name in ("id", "house", "split", "light")),
            *((_PICTURES[kind], picture) for kind in _PICTURES),
            *((length, pa.string()) for length in ("short", "normal", "long")),
            ("questions", pa.list_(asked)),
            ("references", pa.list_(referred)),
            ("record", pa.string()),
        ]
    )
    writers: dict[str, Any] = {}
    waiting: dict[str, list[dict[str, Any]]] = {}

    def flush(split: str) -> None:
        table = pa.Table.from_pylist(waiting.pop(split), schema=schema)
        if split not in writers:
            writers[split] = pq.ParquetWriter(out / f"{split}.parquet", schema)
        writers[split].write_table(table)

    try:
        for row, house in records(folder):
            split = row["split"]
            waiting.setdefault(split, []).append(table_row(row, house))
            if len(waiting[split]) == _ROWS:
                flush(split)
        for split in list(waiting):
            flush(split)
    finally:
        for writer in writers.values():
            writer.close()


_ASKED = ("text", "answer", "template", "kind")
#: Columns of the images of a record.
_PICTURES = {"rgb": "image", "depth": "depth", "instance": "instance", "normals": "normals"}


def table_row(row: dict[str, Any], house: Path) -> dict[str, Any]:
    """A record as a row of a table."""
    pictures = {
        _PICTURES[kind]: {"bytes": picture_bytes(house, name), "path": name}
        for kind, name in row["images"].items()
    }
    return {
        **{name: row[name] for name in ("id", "house", "split", "light")},
        **pictures,
        **{length: text["text"] for length, text in row["captions"].items()},
        "questions": [{name: one[name] for name in _ASKED} for one in row["questions"]],
        "references": [
            {name: one[name] for name in ("id", "text", "strategy")} for one in row["references"]
        ],
        "record": json.dumps(row, ensure_ascii=False),
    }
