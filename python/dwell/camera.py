"""What pictures are taken with."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, Literal, get_args

from dwell._native import ConfigError
from dwell.arguments import choice, finite, mapping, text, triple, whole

Channel = Literal[
    "rgb",
    "depth",
    "instance",
    "semantic",
    "semantic_fine",
    "semantic_nyu40",
    "normals",
    "albedo",
    "surfels",
    "flow",
    "visible_objects",
    "boxes_2d",
    "boxes_3d",
]

Preset = Literal["flat", "lit", "full"]
#: How much light there may be in a picture, cheapest first.
PRESETS: tuple[Preset, ...] = get_args(Preset)


@dataclasses.dataclass(frozen=True)
class Camera:
    """A camera: a pinhole of some field of view, unless ``projection`` says otherwise.

    Attributes:
        width: Pixels across, 1 to 8192.
        height: Pixels down.
        fov_deg: Horizontal field of view, degrees; ``None``: at an agent's eyes what
            ``agent/N/camera/fov_deg`` says, elsewhere 90.
        near_m: Nearest distance that is seen, m.
        far_m: Furthest distance, to which depth is clamped, m.
        preset: ``flat`` (texture times colour), ``lit`` (lamps and daylight with shadows) or
            ``full`` (all light, soft shadows; for pictures: 600 times as slow as ``lit``).
        projection: The kind of camera with its numbers, in pixels from the top left corner:
            ``{"kind": "pinhole", "fx", "fy", "cx", "cy"}``; ``brown_conrady`` (a pinhole with
            ``k1, k2, k3, p1, p2``); ``fisheye`` (``fx, fy, cx, cy``, Kannala and Brandt's
            ``k1`` to ``k4``, all 0 for equidistant, ``half_angle_deg``); ``equirectangular``;
            ``cubemap`` (six faces below one another, height = 6 width: ahead, left, behind, right,
            up, down); ``orthographic`` (``width_m, height_m``). Depth of fisheyes and cameras that
            see all around is range.
        position_m: Where it is against the eye or place that is rendered from: right, up, back.
        yaw_deg: How it is turned there, to the left.
        pitch_deg: Then up.
        roll_deg: Then about its own axis, counter-clockwise as it looks.
        max_objects: Rows of ``visible_objects``, ``boxes_2d`` and ``boxes_3d``.
    """

    width: int = 128
    height: int = 128
    fov_deg: float | None = None
    near_m: float = 0.05
    far_m: float = 50.0
    preset: Preset = "lit"
    projection: Mapping[str, Any] | None = None
    position_m: Sequence[float] = (0.0, 0.0, 0.0)
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0
    roll_deg: float = 0.0
    max_objects: int = 64


def camera_settings(name: str, camera: object) -> dict[str, Any]:
    """A camera's numbers, checked, as the native side takes them."""
    if not isinstance(camera, Camera):
        raise ConfigError(f"{name} is {camera!r}; expected a dwell.Camera")
    settings: dict[str, Any] = {
        "width": whole(f"{name}.width", camera.width),
        "height": whole(f"{name}.height", camera.height),
        "max_objects": whole(f"{name}.max_objects", camera.max_objects),
        "preset": choice(f"{name}.preset", camera.preset, PRESETS),
        "position_m": list(triple(f"{name}.position_m", camera.position_m)),
    }
    for field in ("near_m", "far_m", "yaw_deg", "pitch_deg", "roll_deg"):
        settings[field] = finite(f"{name}.{field}", getattr(camera, field))
    if camera.fov_deg is not None:
        settings["fov_deg"] = finite(f"{name}.fov_deg", camera.fov_deg)
    if camera.projection is not None:
        settings["projection"] = _projection(f"{name}.projection", camera.projection)
    return settings


def _projection(name: str, projection: object) -> dict[str, Any]:
    rows = mapping(name, projection, "a kind with its numbers")
    return {
        key: text(f"{name}.kind", part) if key == "kind" else finite(f"{name}.{key}", part)
        for key, part in rows.items()
    }
