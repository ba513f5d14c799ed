"""What agents do with their hands, and what comes of it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from dwell.arguments import fields, finite, mapping, pair, point, text, to_json, whole
from dwell.camera import Camera, camera_settings


@dataclasses.dataclass(frozen=True)
class Pointed:
    """What an agent points at.

    Attributes:
        id: The id that instance images show.
        kind: ``object``, ``structure`` or ``agent``.
        name: The name in the house; an agent's number.
        point: Where, m.
        distance_m: From the eye, m.
    """

    id: int
    kind: str
    name: str
    point: tuple[float, float, float]
    distance_m: float


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What came of an action.

    Attributes:
        success: Whether it worked, or began to.
        code: Why, in one word.
        sentence: The same for a person, with what to do about it.
        object: The name of the object it was about.
        pointed: What was pointed at, after ``point``.
    """

    success: bool
    code: str
    sentence: str
    object: str | None
    pointed: Pointed | None = None

    @classmethod
    def _of(cls, told: Mapping[str, Any]) -> Outcome:
        pointed = told.get("pointed")
        if pointed is not None:
            pointed = Pointed(**{**pointed, "point": tuple(pointed["point"])})
        return cls(**{**told, "pointed": pointed})


def _thing(name: str, value: object) -> str | int:
    if isinstance(value, str):
        return value
    return whole(name, value, low=-(2**31), high=2**31 - 1)


def _camera(name: str, value: object) -> dict[str, Any]:
    """A camera as what its pixels depend on."""
    if isinstance(value, Camera):
        settings = camera_settings(name, value)
        return {key: part for key, part in settings.items() if key not in _NOT_OF_PIXELS}
    return fields(name, value, {"width": whole, "height": whole, "fov_deg": finite})


#: What does not change where a camera's pixels look.
_NOT_OF_PIXELS = {"near_m", "far_m", "preset", "max_objects"}


def _grasp(name: str, value: object) -> str | dict[str, Any]:
    return value if isinstance(value, str) else mapping(name, value, "text or a mapping")


#: The fields of an action, and what they may be.
_ACTION = {
    "kind": text,
    "object": _thing,
    "part": text,
    "pixel": pair,
    "camera": _camera,
    "origin": point,
    "direction": point,
    "point": point,
    "speed_m_s": finite,
    "force_n": finite,
    "fraction": finite,
    "grasp": _grasp,
}


def action_json(request: Mapping[str, Any]) -> str:
    """An action as the native half reads it."""
    return to_json(fields("", request, _ACTION))
