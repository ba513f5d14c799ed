"""JSON Lines: a record a line, the images beside them."""

from __future__ import annotations

import json
from pathlib import Path

from dwell.views.formats.splits import SplitFiles
from dwell.views.stored import copy_picture, records


def write(folder: Path, out: Path) -> None:
    """Writes ``SPLIT.jsonl``, and the images below ``images``; paths are relative to ``out``."""
    with SplitFiles(out, ".jsonl") as files:
        for row, house in records(folder):
            there = out / "images" / house.name
            there.mkdir(parents=True, exist_ok=True)
            for name in row["images"].values():
                copy_picture(house, name, there / name)
            paths = {kind: f"images/{house.name}/{name}" for kind, name in row["images"].items()}
            line = json.dumps({**row, "images": paths}, ensure_ascii=False) + "\n"
            files.of(row["split"]).write(line.encode())
