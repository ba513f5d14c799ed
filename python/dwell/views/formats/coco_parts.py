"""What forms of COCO share: images, annotations and categories by split."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dwell import _native
from dwell.views.stored import records


def categories() -> list[dict[str, Any]]:
    """COCO's categories: the kinds of things, counted from 1 in the order of the table."""
    names = _native.object_classes()
    return [
        {"id": k, "name": name, "supercategory": "thing"} for k, name in enumerate(names, start=1)
    ]


class Instances:
    """COCO's file of instances of one part, collected."""

    def __init__(self) -> None:
        """Holds nothing yet."""
        self._ids: dict[str, int] = {row["name"]: row["id"] for row in categories()}
        self.images: list[dict[str, Any]] = []
        self.annotations: list[dict[str, Any]] = []

    def category_of(self, name: str) -> int:
        """The number of a category; one that the table lacks gets the next number."""
        return self._ids.setdefault(name, max(self._ids.values(), default=0) + 1)

    def add(self, row: dict[str, Any], file_name: str) -> int:
        """Adds a view; the number of its image.

        An annotation of COCO has a number of its own; ``instance_id`` is that of the images.
        """
        image = len(self.images) + 1
        camera = row["camera"]
        self.images.append(
            {
                "id": image,
                "file_name": file_name,
                "width": camera["width"],
                "height": camera["height"],
                "view": row["id"],
                "house": row["house"],
            }
        )
        for thing in row["things"]:
            self.annotations.append(
                {
                    "id": len(self.annotations) + 1,
                    "image_id": image,
                    "category_id": self.category_of(thing["category"]),
                    "bbox": thing["box"],
                    "area": thing["pixels"],
                    "segmentation": thing["mask"],
                    "iscrowd": 0,
                    "instance_id": thing["id"],
                    "occlusion": thing["occlusion"],
                }
            )
        return image

    def as_dict(self) -> dict[str, Any]:
        """The file."""
        kinds = [
            {"id": number, "name": name, "supercategory": "thing"}
            for name, number in self._ids.items()
        ]
        return {
            "info": {"description": "views of houses, made by dwell"},
            "images": self.images,
            "annotations": self.annotations,
            "categories": kinds,
        }


def by_split(folder: Path) -> Iterator[tuple[str, dict[str, Any], Path]]:
    """The records with their parts."""
    for row, house in records(folder):
        yield row["split"], row, house


def save(path: Path, value: dict[str, Any]) -> None:
    """Writes one JSON object."""
    with path.open("w", encoding="utf-8") as file:
        json.dump(value, file, ensure_ascii=False)
