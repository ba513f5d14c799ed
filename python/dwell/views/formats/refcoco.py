"""Referring expressions as RefCOCO has them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from dwell.views.formats.coco_parts import Instances, by_split, save
from dwell.views.stored import copy_picture


def write(folder: Path, out: Path) -> None:
    """Writes ``refs.json``, ``instances.json`` and the pictures in ``images``.

    A ref is a thing in a picture: ``ref_id``, ``ann_id``, ``image_id``, ``category_id``, ``split``,
    ``file_name`` and ``sentences`` (``sent_id``, ``sent``, ``raw``, ``tokens``, ``strategy``).
    """
    (out / "images").mkdir()
    instances = Instances()
    refs: list[dict[str, Any]] = []
    sentences = 0
    for split, row, house in by_split(folder):
        name = f"{row['id']}.png"
        copy_picture(house, row["images"]["rgb"], out / "images" / name)
        first = len(instances.annotations)
        image = instances.add(row, name)
        annotation_of = {own["instance_id"]: own for own in instances.annotations[first:]}
        said: dict[int, list[dict[str, Any]]] = {}
        for reference in row["references"]:
            words = said.setdefault(reference["id"], [])
            if any(other["raw"] == reference["text"] for other in words):
                continue
            tokens = re.findall(r"\w[\w'-]*", reference["text"].lower())
            sentences += 1
            words.append(
                {
                    "sent_id": sentences,
                    "sent": " ".join(tokens),
                    "raw": reference["text"],
                    "tokens": tokens,
                    "strategy": reference["strategy"],
                }
            )
        for number, words in said.items():
            own = annotation_of[number]
            refs.append(
                {
                    "ref_id": len(refs) + 1,
                    "ann_id": own["id"],
                    "image_id": image,
                    "category_id": own["category_id"],
                    "split": split,
                    "file_name": name,
                    "sent_ids": [one["sent_id"] for one in words],
                    "sentences": words,
                }
            )
    save(out / "refs.json", {"refs": refs})
    save(out / "instances.json", instances.as_dict())
