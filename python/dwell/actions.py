"""Manipulation by agents, and its outcomes."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping
from typing import Any

from dwell import _native
from dwell.arguments import checked_fields, finite_number, integer_in_range, text
from dwell.camera import Camera, camera_settings
from dwell.schemas import Check, checks


@dataclasses.dataclass(frozen=True)
class PointedTarget:
    """The thing that an agent points at.

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
    """The outcome of an action.

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
    pointed: PointedTarget | None = None

    @classmethod
    def _of(cls, told: Mapping[str, Any]) -> Outcome:
        pointed = told.get("pointed")
        if pointed is not None:
            pointed = PointedTarget(**{**pointed, "point": tuple(pointed["point"])})
        return cls(**{**told, "pointed": pointed})


def _camera(name: str, value: object) -> dict[str, Any]:
    """The camera's parameters on which its pixels depend."""
    if isinstance(value, Camera):
        settings = camera_settings(name, value)
        return {key: part for key, part in settings.items() if key not in _NOT_OF_PIXELS}
    return checked_fields(
        name,
        value,
        {"width": integer_in_range, "height": integer_in_range, "fov_deg": finite_number},
    )


#: What does not change where a camera's pixels look.
_NOT_OF_PIXELS = {"near_m", "far_m", "preset", "max_objects", "classes"}


@functools.cache
def action_table() -> dict[str, list[dict[str, Any]]]:
    """The kinds of actions, and the fields that name what an action is done to."""
    table = _native.action_table()
    return table


@functools.cache
def _checks() -> dict[str, Check]:
    """The fields of an action, and what they may be."""
    table = action_table()
    of_kinds = (checks(kind["fields"]) for kind in table["kinds"])
    found: dict[str, Check] = {"kind": text, **checks(table["target"])}
    return {**found, **{name: one for kind in of_kinds for name, one in kind.items()}} | {
        "camera": _camera
    }


def takes_target(kind: str) -> bool:
    """Returns whether a kind of action has a target; unknown ones may have."""
    rows = {row["name"]: row for row in action_table()["kinds"]}
    return kind not in rows or rows[kind]["target"] is not None


def checked_action(request: Mapping[str, Any]) -> dict[str, Any]:
    """An action with its fields checked, as the native half takes it."""
    return checked_fields("", request, _checks())
