"""What is where in a picture: masks, boxes, and how much of the target others hide."""

from __future__ import annotations

import dataclasses
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell.teach.cameras import MOUNTS, Mount
from dwell.teach.person import PERSON, ROBOT

if TYPE_CHECKING:
    from dwell.teach.motion import Point
    from dwell.teach.session import Session

#: The values of masks.
MASK_VALUES = {"background": 0, "target": 1, "hand": 2, "person": 3, "other_thing": 4}
#: How far from the line wrist, palm, finger tip the skin of a hand is at most, m.
_HAND_RADIUS_M = 0.06


@dataclasses.dataclass
class SeenPart:
    """What is seen of a thing: the box around it and its pixels.

    Attributes:
        box: First column and row, and those behind the last; ``None``: nothing is seen.
        pixels: How many.
    """

    box: tuple[int, int, int, int] | None
    pixels: int

    def as_dict(self) -> dict[str, Any]:
        """What a label says of it."""
        return {"box": None if self.box is None else [*self.box], "pixels": self.pixels}


@dataclasses.dataclass
class MaskedView:
    """The mask of one camera at a key frame.

    Attributes:
        mask: Shape (height, width), uint8: the values of :data:`MASK_VALUES`.
        target: What is seen of the target.
        hand: What is seen of the hand that acts.
        occlusion: The share of the target that others hide, 0 to 1; ``None``: nothing is seen.
    """

    mask: NDArray[np.uint8]
    target: SeenPart
    hand: SeenPart
    occlusion: float | None


@dataclasses.dataclass
class KeyFrame:
    """A moment with masks.

    Attributes:
        name: ``start``, ``reach`` (half way to the target), ``apex``, ``end``.
        frame: The number of the picture.
        time_s: When it was taken.
        views: The masks by camera.
    """

    name: str
    frame: int
    time_s: float
    views: dict[str, MaskedView]


def key_frame(session: Session, name: str, frame: int, time_s: float) -> KeyFrame:
    """Takes the masks of all cameras as things are now."""
    joints = session.person.joints()
    hand = session.person.hand
    line = [joints[f"{hand}_{part}"] for part in ("wrist", "palm", "finger_tip")]
    return KeyFrame(
        name, frame, time_s, {mount.name: _view(session, mount, line) for mount in MOUNTS}
    )


def _view(session: Session, mount: Mount, hand: list[Point]) -> MaskedView:
    world = session.world
    camera = mount.camera(session.settings)
    seen = world.render(
        agent=ROBOT, camera=camera, channels=("instance", "surfels", "visible_objects")
    )
    ids = seen["instance"][..., 0]
    objects = {row["name"]: row["id"] for row in world.objects()}
    target = objects[session.target]
    # Agents have the ids behind those of objects.
    person = ids == max(objects.values()) + 1 + PERSON
    mask = np.zeros(ids.shape, np.uint8)
    for thing in session.things:
        mask[ids == objects[thing]] = MASK_VALUES["other_thing"]
    mask[person] = MASK_VALUES["person"]
    pose = mount.to_world(session.layout)
    places = seen["surfels"][..., :3][person].astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
    near = np.zeros(len(places), bool)
    for a, b in itertools.pairwise(hand):
        near |= _distance_m(places, a, b) <= _HAND_RADIUS_M
    mask[tuple(axis[near] for axis in np.nonzero(person))] = MASK_VALUES["hand"]
    mask[ids == target] = MASK_VALUES["target"]
    hidden = [float(row[2]) for row in seen["visible_objects"] if int(row[0]) == target]
    return MaskedView(
        mask,
        _part(mask == MASK_VALUES["target"]),
        _part(mask == MASK_VALUES["hand"]),
        round(hidden[0], 4) if hidden else None,
    )


def _distance_m(places: NDArray[np.float64], a: Point, b: Point) -> NDArray[np.float64]:
    """The distance of places from the straight line between two points."""
    along = b - a
    length2 = max(float(along @ along), 1e-12)
    part = np.clip((places - a) @ along / length2, 0.0, 1.0)
    distance: NDArray[np.float64] = np.linalg.norm(places - a - part[:, None] * along, axis=1)
    return distance


def _part(mask: NDArray[np.bool_]) -> SeenPart:
    rows, columns = np.nonzero(mask)
    if not len(rows):
        return SeenPart(None, 0)
    box = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
    return SeenPart(tuple(int(x) for x in box), len(rows))  # type: ignore[arg-type] # four
