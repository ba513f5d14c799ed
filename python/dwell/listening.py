"""Sources and receivers of sound for :class:`dwell.AcousticScene`."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dwell._native import ConfigError
from dwell.arguments import (
    finite_number,
    hashable,
    integer_in_range,
    kept,
    mapping,
    point,
    sequence_items,
    unit_quaternion,
)
from dwell.directivity import Directivity, directivity_json
from dwell.heads import Head, head_of

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Source:
    """A source of sound.

    Attributes:
        position: Where it is, m.
        yaw_deg: Where its front points: 0 to -Z, 90 to -X.
        pitch_deg: How far its front is raised.
        directivity: ``omni``, ``cardioid``, ``figure_of_eight``, ``talker``, ``loudspeaker``, or a
            :class:`dwell.Directivity`. Its level is that in front of it.

    Raises:
        ConfigError: A field is of another type, or not finite_number.
    """

    position: Point
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0
    directivity: str | Directivity = "omni"

    def __post_init__(self) -> None:
        """Checks the fields, and keeps numbers."""
        _keep_placed("position", self)

    def to_json(self) -> dict[str, Any]:
        """The engine's form."""
        return {
            "pose": _pose(self.position, self.yaw_deg, self.pitch_deg),
            "directivity": directivity_json(self.directivity),
        }


@dataclass(frozen=True)
class Microphone:
    """One microphone of an array.

    Attributes:
        position: Where it is in the array's axes (forward -Z, left -X, up +Y), m.
        yaw_deg: Where its front points, in the array.
        pitch_deg: How far its front is raised, in the array.
        directivity: As that of a :class:`Source`.

    Raises:
        ConfigError: A field is of another type, or not finite_number.
    """

    position: Point
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0
    directivity: str | Directivity = "omni"

    def __post_init__(self) -> None:
        """Checks the fields, and keeps numbers."""
        _keep_placed("position", self)


@dataclass(frozen=True)
class Receiver:
    """A receiver: see :meth:`omni`, :meth:`binaural`, :meth:`array` and :meth:`ambisonics`."""

    pose: dict[str, Any]
    kind: Any
    head: Head | None = None

    def __post_init__(self) -> None:
        """Checks that it stands somewhere, and keeps copies."""
        pose = mapping("pose", self.pose, "position and rotation")
        if set(pose) != {"position", "rotation"}:
            raise ConfigError(
                f"pose has {', '.join(sorted(pose)) or 'nothing'}; expected position and rotation, "
                "as Receiver.omni and kin make it"
            )
        rotation = sequence_items(
            "pose.rotation", pose["rotation"], "expected a rotation (x, y, z, w)"
        )
        unit_quaternion("pose.rotation", rotation)
        own = {
            "position": [*point("pose.position", pose["position"])],
            "rotation": [finite_number("pose.rotation", part) for part in rotation],
        }
        object.__setattr__(self, "pose", own)
        object.__setattr__(self, "kind", kept(self.kind))

    def __hash__(self) -> int:
        """Equal for equal receivers."""
        return hash((hashable(self.pose), hashable(self.kind), self.head))

    @classmethod
    def omni(cls, position: Sequence[float]) -> Receiver:
        """A microphone that hears equally from all sides: one channel."""
        return cls(_pose(point("position", position), 0.0, 0.0), "omni")

    @classmethod
    def binaural(
        cls,
        position: Sequence[float],
        *,
        yaw_deg: float = 0.0,
        pitch_deg: float = 0.0,
        head: Head | str | os.PathLike[str] | None = None,
    ) -> Receiver:
        """Two ears: left, right.

        Args:
            position: The middle of the head, m.
            yaw_deg: Where it faces.
            pitch_deg: How far its front is raised.
            head: A head or the path of its SOFA file; by default the scene's built-in sphere.
        """
        head = head_of("head", head)
        kind: Any = "binaural" if head is None else {"head": head.id}
        return cls(_pose(point("position", position), yaw_deg, pitch_deg), kind, head)

    @classmethod
    def array(
        cls,
        position: Sequence[float],
        microphones: Sequence[Microphone | Sequence[float]],
        *,
        yaw_deg: float = 0.0,
        pitch_deg: float = 0.0,
    ) -> Receiver:
        """Microphones around a centre: a channel each. All hear one sound field, early and late.

        Args:
            position: The centre, m.
            microphones: 1 to 128; a point (m, in the array's axes) hears equally from all sides.
            yaw_deg: Where the array's front points.
            pitch_deg: How far its front is raised.
        """
        expected = "expected 1 to 128 microphones or points"
        given = sequence_items("microphones", microphones, expected, most=128)
        items = [
            item if isinstance(item, Microphone) else Microphone(point(f"microphones[{k}]", item))
            for k, item in enumerate(given)
        ]
        kind = {
            "array": [
                {
                    "array_from_microphone": _pose(
                        point("microphones", item.position), item.yaw_deg, item.pitch_deg
                    ),
                    "directivity": directivity_json(item.directivity),
                }
                for item in items
            ]
        }
        return cls(_pose(point("position", position), yaw_deg, pitch_deg), kind)

    @classmethod
    def ambisonics(
        cls,
        position: Sequence[float],
        *,
        order: int = 1,
        yaw_deg: float = 0.0,
        pitch_deg: float = 0.0,
    ) -> Receiver:
        """Spherical harmonics of an order from 0 to 3.

        (order + 1)^2 channels in ACN order with SN3D weights.
        """
        kind = {"ambisonics": {"order": integer_in_range("order", order, low=0, high=3)}}
        return cls(_pose(point("position", position), yaw_deg, pitch_deg), kind)

    def to_json(self) -> dict[str, Any]:
        """The engine's form."""
        return {"pose": self.pose, "kind": self.kind}


def _keep_placed(name: str, placed: Source | Microphone) -> None:
    object.__setattr__(placed, name, point(name, placed.position))
    for angle in ("yaw_deg", "pitch_deg"):
        object.__setattr__(placed, angle, finite_number(angle, getattr(placed, angle)))
    directivity_json(placed.directivity)


def source_of(source: Source | Sequence[float]) -> Source:
    """A point is a source that radiates equally on all sides."""
    return source if isinstance(source, Source) else Source(point("source", source))


def _pose(position: Sequence[float], yaw_deg: float, pitch_deg: float) -> dict[str, Any]:
    """Turned about the vertical, after being raised about its own X axis."""
    yaw = 0.5 * math.radians(finite_number("yaw_deg", yaw_deg))
    pitch = 0.5 * math.radians(finite_number("pitch_deg", pitch_deg))
    (sy, cy), (sp, cp) = (math.sin(yaw), math.cos(yaw)), (math.sin(pitch), math.cos(pitch))
    return {
        "position": list(point("position", position)),
        "rotation": [cy * sp, sy * cp, -sy * sp, cy * cp],
    }
