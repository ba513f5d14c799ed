"""The frame of a table scene: the robot on one side of the table, the person on the other."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from dwell.teach.motion import Point

#: The table, m: along its edge, high, from the robot's edge to the person's. High enough that
#: short and tall people reach what lies before them without bending.
TABLE_M = (1.4, 0.9, 0.6)
#: How far the middles of things may lie from the middle of the table towards either end, m.
THINGS_HALF_WIDTH_M = 0.56
#: Where on the table things lie: from the person's edge, m.
THINGS_FROM_EDGE_M = (0.10, 0.44)
#: From the person's edge of the table to the middle of its body, m.
PERSON_FROM_EDGE_M = 0.17
#: From the robot's edge of the table to its middle, m.
ROBOT_FROM_EDGE_M = 0.75


@dataclasses.dataclass(frozen=True)
class Layout:
    """Where the table stands and how it is turned.

    Attributes:
        origin: The middle of the table on the floor, m.
        yaw_deg: Where the robot faces, positive to the left, 0 along -Z; the person faces it.
    """

    origin: tuple[float, float, float]
    yaw_deg: float

    def point(self, right_m: float, up_m: float, ahead_m: float) -> Point:
        """A point from the middle of the table on the floor, as the robot sees it, m."""
        turn = math.radians(self.yaw_deg)
        right = np.array([math.cos(turn), 0.0, -math.sin(turn)])
        ahead = np.array([-math.sin(turn), 0.0, -math.cos(turn)])
        up = np.array([0.0, up_m, 0.0])
        found: Point = np.asarray(self.origin) + right_m * right + ahead_m * ahead + up
        return found

    def on_table(self, right_m: float, from_edge_m: float, above_m: float = 0.0) -> Point:
        """A point above the table: to the robot's right, and from the person's edge, m."""
        return self.point(right_m, TABLE_M[1] + above_m, TABLE_M[2] / 2.0 - from_edge_m)

    def person(self, right_m: float) -> Point:
        """Where the person stands, on the floor, m."""
        return self.point(right_m, 0.0, TABLE_M[2] / 2.0 + PERSON_FROM_EDGE_M)

    def robot(self) -> Point:
        """Where the robot stands, on the floor, m."""
        return self.point(0.0, 0.0, -(TABLE_M[2] / 2.0 + ROBOT_FROM_EDGE_M))

    @property
    def person_yaw_deg(self) -> float:
        """Where the person faces: the robot."""
        return self.yaw_deg + 180.0
