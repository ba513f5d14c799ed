"""COCO: instances, panoptic and captions, by split."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from dwell.views.formats.coco_parts import Instances, by_split, save
from dwell.views.stored import copy_picture, picture


def write(folder: Path, out: Path) -> None:
    """Writes ``annotations/{instances,panoptic,captions}_SPLIT.json`` and the pictures.

    Pictures are in ``SPLIT``, those of ``panoptic_SPLIT`` hold ``id = R + 256 G + 65536 B`` of each
    segment, which is the id of the thing. Only things are segments; all else is 0. Masks are
    compressed run lengths, also of instances.
    """
    (out / "annotations").mkdir()
    instances: dict[str, Instances] = {}
    panoptic: dict[str, list[dict[str, Any]]] = {}
    captions: dict[str, list[dict[str, Any]]] = {}
    for split, row, house in by_split(folder):
        of_split = instances.setdefault(split, Instances())
        for name in (split, f"panoptic_{split}"):
            (out / name).mkdir(exist_ok=True)
        name = f"{row['id']}.png"
        copy_picture(house, row["images"]["rgb"], out / split / name)
        image = of_split.add(row, name)
        ids = picture(house, row["images"]["instance"]).astype(np.int32)
        known = [thing["id"] for thing in row["things"]]
        ids = np.where(np.isin(ids, known), ids, 0)
        colors = np.stack([ids % 256, ids // 256 % 256, ids // 65_536], axis=-1).astype(np.uint8)
        Image.fromarray(colors).save(out / f"panoptic_{split}" / name, compress_level=1)
        panoptic.setdefault(split, []).append(
            {
                "image_id": image,
                "file_name": name,
                "segments_info": [
                    {
                        "id": thing["id"],
                        "category_id": of_split.category_of(thing["category"]),
                        "area": thing["pixels"],
                        "bbox": thing["box"],
                        "iscrowd": 0,
                    }
                    for thing in row["things"]
                ],
            }
        )
        told = captions.setdefault(split, [])
        for length, text in row["captions"].items():
            told.append(
                {
                    "id": len(told) + 1,
                    "image_id": image,
                    "caption": text["text"],
                    "length": length,
                }
            )
    for split, own in instances.items():
        whole = own.as_dict()
        save(out / "annotations" / f"instances_{split}.json", whole)
        rest = {name: whole[name] for name in ("info", "images")}
        kinds = [{**kind, "isthing": 1} for kind in whole["categories"]]
        save(
            out / "annotations" / f"panoptic_{split}.json",
            {**rest, "annotations": panoptic[split], "categories": kinds},
        )
        save(
            out / "annotations" / f"captions_{split}.json",
            {**rest, "annotations": captions[split]},
        )
