"""A folder that ``datasets.load_dataset`` reads as it is: pictures with a table and a card."""

from __future__ import annotations

import json
from pathlib import Path

from dwell.views.datasheet import datasheet
from dwell.views.formats.splits import SplitFiles
from dwell.views.stored import copy_picture, records

_CARD = """---
configs:
- config_name: default
  data_files:
{files}task_categories:
- image-to-text
- visual-question-answering
language:
- en
---

"""


def write(folder: Path, out: Path) -> None:
    """Writes ``SPLIT/metadata.jsonl`` beside the pictures of each part, and ``README.md``.

    ``datasets.load_dataset("imagefolder", data_dir=OUT)`` gives ``image`` and the fields ``id``,
    ``house``, ``light``, ``short``, ``normal``, ``long``, ``questions`` and ``references``.
    """
    parts: list[str] = []
    with SplitFiles(out, ".rows") as files:
        for row, house in records(folder):
            split = row["split"]
            if split not in parts:
                parts.append(split)
                (out / split).mkdir()
            name = f"{row['id']}.png"
            copy_picture(house, row["images"]["rgb"], out / split / name)
            told = {
                "file_name": name,
                **{field: row[field] for field in ("id", "house", "light")},
                **{length: text["text"] for length, text in row["captions"].items()},
                "questions": [
                    {field: one[field] for field in ("text", "answer", "template", "kind")}
                    for one in row["questions"]
                ],
                "references": [
                    {"text": one["text"], "box": _box_of(row, one["id"])}
                    for one in row["references"]
                ],
            }
            files.of(split).write((json.dumps(told, ensure_ascii=False) + "\n").encode())
    for split in parts:
        (out / f"{split}.rows").rename(out / split / "metadata.jsonl")
    listed = "".join(
        f"  - split: {'validation' if part == 'val' else part}\n    path: {part}/**\n"
        for part in sorted(parts)
    )
    card = _CARD.format(files=listed) + datasheet(folder)
    (out / "README.md").write_text(card, "utf-8")


def _box_of(row: dict[str, object], number: int) -> list[int]:
    things = row["things"]
    assert isinstance(things, list), "a record has things"
    return next(thing["box"] for thing in things if thing["id"] == number)
