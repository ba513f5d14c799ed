"""Where a user points: at what is seen of the target from its eyes; and what a ray meets first."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import dwell
from dwell.teach.motion import Point

#: Edge of the picture of the target from the person's eyes, px.
_EDGE = 48
#: Nearer than this to its eyes a person sees nothing but itself, m.
_FACE_M = 0.3
#: A finger stops so far short of what it points at, m: people point, and do not touch.
_SHORT_M = 0.12
#: A ray begins so far from the finger tip, m: the finger is no hit.
_CLEAR_M = 0.03


def yaw_pitch_deg(direction: Point) -> tuple[float, float]:
    """The angles of a camera that looks along a direction: to the left from -Z, then up."""
    x, y, z = map(float, direction / np.linalg.norm(direction))
    yaw = math.degrees(math.atan2(-x, -z))
    return yaw, math.degrees(math.asin(max(-1.0, min(1.0, y))))


def first_hit(world: dwell.World, origin: Point, direction: Point) -> tuple[int, float]:
    """What a ray meets first.

    Returns:
        Its id of instance images, 0 for nothing, and how far it is, m.
    """
    yaw, pitch = yaw_pitch_deg(direction)
    # A picture of one pixel, whose middle lies on the axis.
    camera = dwell.Camera(width=1, height=1, fov_deg=1.0, near_m=_CLEAR_M, far_m=50.0)
    found = world.render(
        position=origin.tolist(),
        yaw_deg=yaw,
        pitch_deg=pitch,
        camera=camera,
        channels=("instance", "depth"),
    )
    return int(found["instance"][0, 0, 0]), float(found["depth"][0, 0, 0])


def aim_points(world: dwell.World, eyes: Point, target: str) -> tuple[list[Point], float]:
    """Points of the target to point at: those that are seen from the eyes, the innermost first.

    Returns:
        The points, m, and the share of the target that others hide from there.
    """
    thing = world.object(target)
    center, size = np.asarray(thing["center"]), np.asarray(thing["size"])
    toward = center - eyes
    distance = float(np.linalg.norm(toward))
    half_deg = math.degrees(math.atan(0.6 * float(np.linalg.norm(size)) / distance))
    yaw, pitch = yaw_pitch_deg(toward)
    camera = dwell.Camera(
        width=_EDGE, height=_EDGE, fov_deg=min(max(2.0 * half_deg, 1.0), 120.0), near_m=_FACE_M
    )
    seen = world.render(
        position=eyes.tolist(),
        yaw_deg=yaw,
        pitch_deg=pitch,
        camera=camera,
        channels=("instance", "surfels", "visible_objects"),
    )
    own = seen["instance"][..., 0] == thing["id"]
    rows = seen["visible_objects"]
    hidden = [float(row[2]) for row in rows if int(row[0]) == thing["id"]]
    depth = _inwardness(own)
    order = np.argsort(-depth, axis=None, kind="stable")[: np.count_nonzero(own)]
    # A few that differ are enough.
    chosen = order[:: max(1, len(order) // 8)][:8]
    frame = _camera_axes(yaw, pitch)
    points = [eyes + frame @ seen["surfels"].reshape(-1, 9)[k, :3].astype(float) for k in chosen]
    return points, hidden[0] if hidden else 1.0


def finger_goal(eyes: Point, aim: Point) -> Point:
    """Where the finger goes that points at something near: short of it, on the line from the eyes.

    What is farther than an arm reaches is pointed at along the same line.
    """
    toward = aim - eyes
    distance = float(np.linalg.norm(toward))
    found: Point = eyes + max(distance - _SHORT_M, 0.0) / distance * toward
    return found


def turned_aim(eyes: Point, aim: Point, right_deg: float, up_deg: float) -> Point:
    """A point as far from the eyes as ``aim``, in a direction that deviates by two angles."""
    toward = aim - eyes
    yaw, pitch = yaw_pitch_deg(toward)
    axes = _camera_axes(yaw, pitch)
    ahead = np.array([math.tan(math.radians(right_deg)), math.tan(math.radians(up_deg)), -1.0])
    found: Point = eyes + np.linalg.norm(toward) * (axes @ (ahead / np.linalg.norm(ahead)))
    return found


def _camera_axes(yaw_deg: float, pitch_deg: float) -> NDArray[np.float64]:
    """The axes right, up and back of a camera, as columns."""
    a, b = math.radians(yaw_deg), math.radians(pitch_deg)
    ahead = np.array([-math.sin(a) * math.cos(b), math.sin(b), -math.cos(a) * math.cos(b)])
    right = np.array([math.cos(a), 0.0, -math.sin(a)])
    return np.stack([right, np.cross(right, ahead), -ahead], axis=1)


def _inwardness(mask: NDArray[np.bool_]) -> NDArray[np.int64]:
    """How many times the edge can be taken off a mask before a pixel is gone; 0 outside."""
    depth = np.zeros(mask.shape, np.int64)
    left = mask.copy()
    while left.any():
        depth += left
        padded = np.pad(left, 1)
        left = left & padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    return depth
