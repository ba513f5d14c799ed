"""Persons: what they look at, reach for and point at, and where their joints are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import choice, integer_in_range, point

_SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")

#: The largest coordinate of what a person reaches for, m.
_FURTHEST_M = 1000.0
#: A point, m.
_Point: TypeAlias = Sequence[float] | NDArray[np.floating[Any]]


class PersonApi:
    """The part of a world that moves the heads and arms of persons."""

    _native: _native.World

    def set_gesture(
        self,
        agent: int,
        *,
        look_at: _Point | None = None,
        left_hand: _Point | None = None,
        right_hand: _Point | None = None,
        pointing: Literal["left", "right"] | None = None,
        point_at: _Point | None = None,
    ) -> None:
        """Sets what a person looks at and reaches for, at once and until the next call.

        Only its figure moves: its camera, its ears and what it collides with stay. A script makes
        movements smooth by moving the targets at each step.

        Args:
            agent: An agent with a body of the kind ``"person"``.
            look_at: The point that its head turns to, m, as far as a neck turns (75 degrees to a
                side, 57 up or down); ``None``: where its camera looks.
            left_hand: Where the middle of the left palm is, m. Out of reach (0.386 of its height)
                the palm is on the line from the shoulder to it. ``None``: the arm hangs or swings.
            right_hand: As ``left_hand``. With ``None`` the hand that holds a thing, or has just
                acted on one, is there.
            pointing: The hand whose index finger is stretched. Without a target of its own the arm
                is stretched so that the line from between the eyes through the finger tip meets
                ``point_at``, as people point (Taylor and McCloskey 1988, Herbort and Kunde 2016).
            point_at: What is pointed at, m; without one what is looked at. Without ``pointing`` the
                hand is the one that the person prefers.

        Raises:
            ConfigError: There is no such agent, or a point is not three finite numbers of -1000 to
                1000.
            UsageError: The agent is no person.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=[{"kind": "person"}])
            >>> world.set_gesture(0, point_at=(3.0, 1.0, 2.0))
            >>> joints = world.person_joints(0)
            >>> to_tip = joints["right_finger_tip"] - joints["eyes"]
            >>> to_goal = (3.0, 1.0, 2.0) - joints["eyes"]
            >>> bool(np.linalg.norm(np.cross(to_tip, to_goal)) < 1e-4)
            True
        """
        number = integer_in_range("agent", agent)
        points = {
            name: None if given is None else _within_reach(name, point(name, given))
            for name, given in (
                ("look_at", look_at),
                ("left_hand", left_hand),
                ("right_hand", right_hand),
                ("point_at", point_at),
            )
        }
        target = points.pop("point_at")
        hand = None if pointing is None else choice("pointing", pointing, _SIDES)
        if target is not None and hand is None:
            hand = _native.world_person_hand(self._native, number)
        shown = None if hand is None else {"hand": hand, "at": target}
        _native.world_set_gesture(self._native, number, {**points, "pointing": shown})

    def person_joints(self, agent: int) -> dict[str, NDArray[np.float32]]:
        """Where the joints of a person are, m, by name.

        Args:
            agent: An agent with a body of the kind ``"person"``.

        Returns:
            ``eyes`` (the point between them), ``head`` (its middle), ``neck``, ``pelvis``, and of
            ``left_`` and ``right_``: ``shoulder``, ``elbow``, ``wrist``, ``palm`` (its middle),
            ``finger_tip``, ``hip``, ``knee``, ``ankle`` and ``toe``.

        Raises:
            ConfigError: There is no such agent.
            UsageError: It is no person.
        """
        rows = _native.world_person_joints(self._native, integer_in_range("agent", agent))
        return {name: np.array(row, np.float32) for name, row in rows.items()}


def _within_reach(name: str, place: tuple[float, float, float]) -> list[float]:
    if max(map(abs, place)) > _FURTHEST_M:
        raise ConfigError(
            f"{name} is {place}; allowed are coordinates of -{_FURTHEST_M:g} to {_FURTHEST_M:g} m"
        )
    return [*place]
