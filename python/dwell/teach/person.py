"""The person of a scene: the one place that knows how a world keeps its body and gestures."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

import dwell
from dwell.teach.motion import Point
from dwell.teach.users import Hand, UserParameters

if TYPE_CHECKING:
    from dwell.engine_types import BodySettings

#: The person's number among the agents of a world; the robot's is the next.
PERSON, ROBOT = 0, 1


def person_body(user: UserParameters) -> BodySettings:
    """The body of a user, as ``agents`` of a world takes it."""
    body: BodySettings = {
        "kind": "person",
        "height_m": user.height_m,
        "hand": user.hand,
        # It stands close to the table.
        "radius_m": 0.15,
    }
    return body


@dataclasses.dataclass(frozen=True)
class Pose:
    """What a person does with head and hands at a moment.

    Attributes:
        look_at: What the head turns to, m.
        left: The place of the left palm, m.
        right: That of the right one.
        pointing: The hand whose index finger is stretched.
        point_at: What it points at, m.
    """

    look_at: Point
    left: Point | None = None
    right: Point | None = None
    pointing: Hand | None = None
    point_at: Point | None = None

    def with_palm(self, hand: Hand, place: Point | None) -> Pose:
        """The same with a palm elsewhere."""
        if hand == "left":
            return dataclasses.replace(self, left=place)
        return dataclasses.replace(self, right=place)

    def pointing_to(self, hand: Hand, aim: Point) -> Pose:
        """The same with a hand that points; where its palm is, the figure says."""
        return dataclasses.replace(self.with_palm(hand, None), pointing=hand, point_at=aim)


class Person:
    """A user in a world."""

    def __init__(self, world: dwell.World, user: UserParameters) -> None:
        """Takes the person of a world that was made with :func:`person_body`."""
        self._world = world
        self.hand: Hand = user.hand

    def take(self, pose: Pose) -> None:
        """Takes a pose at once."""
        self._world.set_gesture(
            PERSON,
            look_at=_plain(pose.look_at),
            left_hand=_plain(pose.left),
            right_hand=_plain(pose.right),
            pointing=pose.pointing,
            point_at=_plain(pose.point_at),
        )

    def joints(self) -> dict[str, Point]:
        """Where its joints are, by name, m."""
        found = self._world.person_joints(PERSON)
        return {name: np.asarray(place, np.float64) for name, place in found.items()}

    def palm(self, joints: dict[str, Point]) -> Point:
        """The palm of the hand with which it acts."""
        return joints[f"{self.hand}_palm"]

    def ray(self, joints: dict[str, Point]) -> tuple[Point, Point]:
        """The ray of pointing: from the finger tip on, along the line from the eyes over it.

        Returns:
            Origin, m, and direction of length 1.
        """
        tip = joints[f"{self.hand}_finger_tip"]
        along = tip - joints["eyes"]
        return tip, along / np.linalg.norm(along)


def _plain(point: Point | None) -> tuple[float, float, float] | None:
    if point is None:
        return None
    x, y, z = map(float, point)
    return x, y, z
