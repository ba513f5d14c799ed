"""Records of views: what a camera sees, and what can be said of it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.camera import Camera
from dwell.views.cameras import HeldCamera
from dwell.views.masks import box, encode_rle

if TYPE_CHECKING:
    from dwell.engine_types import Channel
    from dwell.world import World

__all__ = ["RELATIONS", "ViewRecord", "view_record"]

#: What a record has of images.
IMAGES: tuple[Channel, ...] = ("rgb", "depth", "instance", "normals")
#: Relations between things in a picture that a record tells.
RELATIONS = (
    "on",
    "in",
    "hangs_on",
    "next_to",
    "above",
    "under",
    "left_of",
    "right_of",
    "in_front_of",
    "behind",
)
#: Pixels of 256 x 256 from which a thing is referred to, related and asked for.
_LEAST_PIXELS = 200
#: Things in a picture at most, by pixels.
_MOST_THINGS = 256


@dataclasses.dataclass
class ViewRecord:
    """What a camera sees and what can be said of it.

    Attributes:
        row: What is written as JSON: ``id``, ``house``, ``light``, ``camera`` (``width``,
            ``height``, ``fov_deg``, ``position``, ``yaw_deg``, ``pitch_deg``,
            ``eye_height_m``), ``room``,
            ``things``, ``captions``, ``references``, ``relations``, ``questions``.
        images: ``rgb`` (height, width, 3) uint8; ``depth`` (height, width, 1) float32, m;
            ``instance`` (height, width, 1) int32; ``normals`` (height, width, 3) float32 in the
            camera's frame (right, up, back).
    """

    row: dict[str, Any]
    images: dict[str, NDArray[Any]]

    def pixels_of(self) -> dict[int, int]:
        """The pixels of each thing by its id."""
        return {thing["id"]: thing["pixels"] for thing in self.row["things"]}


class HouseNames:
    """What records of one house share: its things and rooms by number."""

    def __init__(self, world: World) -> None:
        """Of a world, whose things keep their names."""
        self.things = {row["id"]: row for row in world.objects()}
        self.rooms = [room["name"] for room in world.house.info()["rooms"]]


def view_record(
    world: World,
    camera: HeldCamera,
    *,
    id: str,
    light: str = "own",
    size: int = 256,
    seed: int | None = None,
    names: HouseNames | None = None,
) -> ViewRecord:
    """The record of a view, without questions.

    Args:
        world: The house as it is now.
        camera: From where.
        id: Of the record.
        light: How the house is lit: ``day``, ``lamp`` or ``own``.
        size: Edges of the images, pixels.
        seed: Draws the wordings; without it every form has its first one.
        names: Those of the world; found where they are not given.

    Returns:
        ``things``: what has pixels in the image, the largest first: ``id``, ``name``,
        ``category``, ``pixels``, ``box`` (first column, first row, width, height), ``mask`` (COCO's
        run lengths), ``occlusion`` (the part that others hide, 0 to 1), ``luma`` (mean of the
        picture, 0 to 1), and of large ones ``noun``, ``colors``, ``material``, ``size``,
        ``pattern``, ``color_share`` (of the largest),
        ``openness``, ``switched_on``, ``distance_m``, ``center`` and ``extents`` of its box in the
        house, m, and ``is_opening`` (doors, windows). Of things of less than 200 of 256 x 256
        pixels nothing is asked and no relation told. ``captions``: by length
        ``text``, ``spans`` (``start``, ``end``, ``ids``, ``boxes``) and ``claims``.
        ``references``: ``id``, ``strategy``, ``text`` and ``spans``. ``relations``: subject,
        predicate, object.
    """
    lens = Camera(width=size, height=size, fov_deg=90.0, max_objects=_MOST_THINGS)
    seen = world.render(
        **camera.viewer(), camera=lens, channels=[*IMAGES, "visible_objects", "boxes_2d"]
    )
    images: dict[str, NDArray[Any]] = {name: seen[name] for name in IMAGES}
    least = _LEAST_PIXELS * (size / 256.0) ** 2
    rows = [row for row in seen["visible_objects"].tolist() if row[1] > 0]
    rows.sort(key=lambda row: (-row[1], row[0]))
    names = HouseNames(world) if names is None else names
    objects = names.things
    rows = [row for row in rows if int(row[0]) in objects]
    ids = [int(row[0]) for row in rows]
    # Facts of all, words of the large ones.
    large = [int(row[0]) for row in rows if row[1] >= least]
    said = _native.world_view_words(world.native, camera.viewer(), large, list(RELATIONS), seed)
    facts = dict(zip(large, said["things"], strict=True))
    instance = images["instance"][..., 0]
    things = []
    for row, number in zip(rows, ids, strict=True):
        mask = instance == number
        thing = {
            "id": number,
            "name": objects[number]["name"],
            "category": objects[number]["category"],
            "pixels": int(row[1]),
            "box": box(mask),
            "mask": encode_rle(mask),
            "occlusion": round(float(row[2]), 4),
            "luma": round(luminance(images["rgb"], mask), 4),
        }
        if number in facts:
            thing |= _facts(facts[number])
        things.append(thing)
    boxes = {thing["id"]: thing["box"] for thing in things}
    row = {
        "id": id,
        "house": world.house.name,
        "light": light,
        "camera": {"width": size, "height": size, "fov_deg": 90.0, **dataclasses.asdict(camera)},
        "room": None if said["room"] is None else names.rooms[said["room"]],
        "things": things,
        "captions": {
            length: _text(text, boxes) | {"claims": text["claims"]}
            for length, text in said["captions"].items()
        },
        "references": [
            {"id": text["id"], "strategy": text["strategy"], **_text(text, boxes)}
            for text in said["references"]
        ],
        "relations": said["relations"],
        "questions": [],
    }
    return ViewRecord(row, images)


def _facts(facts: dict[str, Any]) -> dict[str, Any]:
    """What the record tells of a large thing."""
    told = {name: facts[name] for name in ("noun", "material", "size", "openness", "switched_on")}
    for name in ("center", "extents"):
        told[name] = [round(number, 3) for number in facts[name]]
    told["pattern"] = facts["pattern"]
    shares = [share for _, share in facts["colors"]]
    told["color_share"] = round(max(shares, default=0.0), 3)
    told["colors"] = facts["spoken_colors"]
    told["distance_m"] = None if facts["distance_m"] is None else round(facts["distance_m"], 2)
    told["is_opening"] = facts["is_opening"]
    return told


def _text(text: dict[str, Any], boxes: dict[int, list[int]]) -> dict[str, Any]:
    """A text with its noun phrases, each with the boxes of what the image shows of it."""
    spans = []
    for span in text["spans"]:
        ids = [number for number in span["ids"] if number in boxes]
        spans.append(
            {
                "start": span["start"],
                "end": span["end"],
                "ids": ids,
                "boxes": [boxes[number] for number in ids],
            }
        )
    return {"text": text["text"], "spans": spans}


def luminance(image: NDArray[np.uint8], mask: NDArray[np.bool_]) -> float:
    """The mean luma of the pixels of a mask, 0 to 1."""
    if not mask.any():
        return 0.0
    red, green, blue = image[mask].astype(np.float64).mean(axis=0) / 255.0
    return float(0.2126 * red + 0.7152 * green + 0.0722 * blue)
