"""What the robot sees with: a Kinect ahead, a Kinect above, and a camera of high resolution."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import dwell
from dwell.teach.layout import Layout
from dwell.teach.settings import TeachSettings

if TYPE_CHECKING:
    from dwell.engine_types import BodySettings

#: The robot: its eyes are where the Kinect ahead is mounted, m above the floor.
ROBOT_EYE_M = 1.35
ROBOT_BODY: BodySettings = {"height_m": 1.45, "eye_height_m": ROBOT_EYE_M}
#: The field of view of a Kinect's depth camera, to the sides, degrees (57 by 43).
_KINECT_FOV_DEG = 57.0
#: The end of depth, m.
_FAR_M = 20.0


@dataclasses.dataclass(frozen=True)
class Mount:
    """A camera of the robot.

    Attributes:
        name: Its folder's name.
        position_m: Right, up and back of the robot's eyes.
        yaw_deg: To the left.
        pitch_deg: Up.
        fov_deg: Horizontal field of view.
        has_depth: Whether it is a Kinect.
    """

    name: str
    position_m: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float
    fov_deg: float
    has_depth: bool

    def camera(self, settings: TeachSettings) -> dwell.Camera:
        """The camera in the recording's resolution."""
        width, height = _size(settings.width, has_depth=self.has_depth)
        return dwell.Camera(
            width=width,
            height=height,
            fov_deg=self.fov_deg,
            far_m=_FAR_M,
            position_m=self.position_m,
            yaw_deg=self.yaw_deg,
            pitch_deg=self.pitch_deg,
        )

    def intrinsics(self, settings: TeachSettings) -> dict[str, float]:
        """Size, focal lengths and principal point, px from the upper left corner."""
        width, height = _size(settings.width, has_depth=self.has_depth)
        focal = width / 2.0 / math.tan(math.radians(self.fov_deg) / 2.0)
        return {
            "width": width,
            "height": height,
            "fx": focal,
            "fy": focal,
            "cx": width / 2.0,
            "cy": height / 2.0,
        }

    def to_world(self, layout: Layout) -> NDArray[np.float64]:
        """The camera's frame (right, up, back) in the world's: a rotation and a place, (4, 4)."""
        head = _turned(layout.yaw_deg, 0.0)
        eye = layout.robot() + np.array([0.0, ROBOT_EYE_M, 0.0])
        pose = np.eye(4)
        pose[:3, :3] = head @ _turned(self.yaw_deg, self.pitch_deg)
        pose[:3, 3] = eye + head @ np.asarray(self.position_m)
        return pose

    def as_dict(self, settings: TeachSettings, layout: Layout) -> dict[str, Any]:
        """What a label says of it."""
        pose = [[round(float(x), 6) for x in row] for row in self.to_world(layout)]
        row: dict[str, Any] = {
            **{name: round(x, 6) for name, x in self.intrinsics(settings).items()},
            "camera_to_world": pose,
            "has_depth": self.has_depth,
        }
        if self.has_depth:
            row |= {"depth_unit_m": 0.001, "noise": {"kinect_depth": settings.noise}}
        return row


#: The cameras, by their places.
MOUNTS = (
    Mount("kinect_front", (0.0, 0.0, 0.0), 0.0, -8.0, _KINECT_FOV_DEG, has_depth=True),
    Mount("kinect_top", (0.0, 0.6, 0.0), 0.0, -40.0, _KINECT_FOV_DEG, has_depth=True),
    Mount("hd", (0.25, 0.1, 0.0), 6.0, -11.0, 70.0, has_depth=False),
)


def laws(settings: TeachSettings) -> dict[str, dict[str, float]]:
    """The laws of the robot's cameras."""
    if settings.noise == 0.0:
        return {}
    return {"kinect_depth": {"axial": settings.noise, "lateral": settings.noise}}


def _size(width: int, *, has_depth: bool) -> tuple[int, int]:
    return (width, width * 3 // 4) if has_depth else (2 * width, 2 * width * 9 // 16)


def _turned(yaw_deg: float, pitch_deg: float) -> NDArray[np.float64]:
    """The rotation to the left, and then up."""
    a, b = math.radians(yaw_deg), math.radians(pitch_deg)
    yaw = np.array(
        [[math.cos(a), 0.0, math.sin(a)], [0.0, 1.0, 0.0], [-math.sin(a), 0.0, math.cos(a)]]
    )
    pitch = np.array(
        [[1.0, 0.0, 0.0], [0.0, math.cos(b), -math.sin(b)], [0.0, math.sin(b), math.cos(b)]]
    )
    turned: NDArray[np.float64] = yaw @ pitch
    return turned
