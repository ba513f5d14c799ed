"""Cameras."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, get_args

from dwell._native import ConfigError
from dwell.arguments import (
    checked_fields,
    choice,
    finite_number,
    hashable,
    instance_of,
    integer_in_range,
    mapping,
    number_in_range,
    quoted,
    three_numbers,
)

Preset = Literal["flat", "lit", "full"]
#: How much light there may be in a picture, cheapest first.
PRESETS: tuple[Preset, ...] = get_args(Preset)

Classes = Literal["coarse", "fine", "nyu40"]
#: The tables of semantic classes.
CLASSES: tuple[Classes, ...] = get_args(Classes)

_LENS = ("fx", "fy", "cx", "cy")
#: The numbers of each kind of camera.
PROJECTIONS: dict[str, tuple[str, ...]] = {
    "pinhole": _LENS,
    "brown_conrady": (*_LENS, "k1", "k2", "k3", "p1", "p2"),
    "fisheye": (*_LENS, "k1", "k2", "k3", "k4", "half_angle_deg"),
    "equirectangular": (),
    "cubemap": (),
    "orthographic": ("width_m", "height_m"),
}
#: Those that may be left out.
_WITH_DEFAULT = {"k1", "k2", "k3", "k4", "p1", "p2", "half_angle_deg"}

#: Most pixels along an edge, and the end of all depth, as the engine has them.
MAX_PIXELS = 16_384
_FURTHEST_M = 1e6


@dataclasses.dataclass(frozen=True)
class Camera:
    """A camera: a pinhole of some field of view, unless ``projection`` says otherwise.

    Attributes:
        width: Pixels across, 1 to 16384.
        height: Pixels down, 1 to 16384.
        fov_deg: Horizontal field of view, 1 to 175 degrees; ``None``: at an agent's eyes what
            ``agent/N/camera/fov_deg`` says, elsewhere 90.
        near_m: Nearest distance that is seen, 0 to 1e6 m.
        far_m: Furthest distance, to which depth is clamped: more than ``near_m``, at most 1e6 m.
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
        max_objects: Rows of ``visible_objects``, ``boxes_2d`` and ``boxes_3d``, 1 to 4096.
        classes: The classes of ``semantic``, which are those of ``House.semantic_classes``:
            ``coarse``, ``fine`` or ``nyu40``.

    Raises:
        ConfigError: A field is of another type or out of its range, or a projection has another
            number; the ranges of its numbers are checked when a picture is taken.
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
    classes: Classes = "coarse"

    def __post_init__(self) -> None:
        """Checks the fields, and keeps numbers and copies of what the caller may change."""
        found = camera_settings("camera", self)
        found["position_m"] = tuple(found["position_m"])
        for name, value in found.items():
            object.__setattr__(self, name, value)

    def __hash__(self) -> int:
        """Equal for equal cameras."""
        return hash(tuple(hashable(value) for value in vars(self).values()))


def camera_settings(name: str, camera: object) -> dict[str, Any]:
    """A camera's numbers, checked, as the native side takes them."""
    camera = instance_of(name, camera, Camera)
    settings: dict[str, Any] = {
        "width": integer_in_range(f"{name}.width", camera.width, low=1, high=MAX_PIXELS),
        "height": integer_in_range(f"{name}.height", camera.height, low=1, high=MAX_PIXELS),
        "max_objects": integer_in_range(
            f"{name}.max_objects", camera.max_objects, low=1, high=4096
        ),
        "preset": choice(f"{name}.preset", camera.preset, PRESETS),
        "classes": choice(f"{name}.classes", camera.classes, CLASSES),
        "position_m": list(three_numbers(f"{name}.position_m", camera.position_m)),
    }
    for field in ("near_m", "far_m", "yaw_deg", "pitch_deg", "roll_deg"):
        settings[field] = finite_number(f"{name}.{field}", getattr(camera, field))
    number_in_range(f"{name}.near_m", settings["near_m"], 0.0, _FURTHEST_M, "m")
    if not settings["near_m"] < settings["far_m"] <= _FURTHEST_M:
        raise ConfigError(
            f"{name}.far_m is {quoted(camera.far_m)}; allowed is more than near_m, at most 1e6 m"
        )
    if camera.fov_deg is not None:
        at = f"{name}.fov_deg"
        settings["fov_deg"] = number_in_range(at, camera.fov_deg, 1.0, 175.0, "degrees")
    if camera.projection is not None:
        settings["projection"] = _projection(f"{name}.projection", camera.projection)
    return settings


def _projection(name: str, projection: object) -> dict[str, Any]:
    rows = mapping(name, projection, f"a kind (one of {', '.join(PROJECTIONS)}) with its numbers")
    kind = choice(f"{name}.kind", rows.pop("kind", None), tuple(PROJECTIONS))
    known: dict[str, Callable[[str, object], float]] = dict.fromkeys(
        PROJECTIONS[kind], finite_number
    )
    if unknown := sorted(set(rows) - set(known)):
        has = f"has {', '.join(known)}" if known else "has no numbers"
        raise ConfigError(f"{name}: found {quoted(unknown[0])}; {kind} {has}")
    numbers = checked_fields(name, rows, known)
    for missing in sorted(set(known) - _WITH_DEFAULT - set(rows)):
        raise ConfigError(f"{name} has no {missing}; {kind} has {', '.join(known)}")
    return {"kind": kind, **numbers}
