"""Guidance by somebody who knows the house: for scripted agents and experts."""

from __future__ import annotations

from collections.abc import Sequence

from dwell import _native
from dwell.arguments import integer_in_range, point, text


class GuideApi:
    """The part of a world that guides agents."""

    _native: _native.World

    def toward(self, goal: Sequence[float], *, agent: int = 0) -> str | None:
        """The action that leads an agent along the shortest path, opening doors on it.

        Args:
            goal: Where to, m; somebody of the agent's size must be able to stand within 0.6 m.
            agent: Who goes.

        Returns:
            The action's name; ``None`` at the goal, or where no way leads there.

        Raises:
            ConfigError: Nobody can stand near the goal.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> goal = world.house.rooms()[-1]["stand"]
            >>> while (action := world.toward(goal)) is not None:
            ...     outcome = world.do(action)
            >>> world.navigation().distance(world.agents()[0]["position"], goal) < 0.5
            True
        """
        return _name(self._native.guide(integer_in_range("agent", agent), point("goal", goal)))

    def facing(self, object: str, *, agent: int = 0) -> str | None:
        """The action that turns an agent's gaze towards a thing.

        Args:
            object: Its name.
            agent: Who looks.

        Returns:
            The action's name; ``None`` when the agent looks at it as straight as its turns allow.
        """
        return _name(self._native.face(integer_in_range("agent", agent), text("object", object)))

    def gaze_target(self, *, agent: int = 0) -> str | None:
        """The name of the thing in the middle of an agent's view, at most 10 m away."""
        return self._native.gaze_target(integer_in_range("agent", agent))


def _name(number: int | None) -> str | None:
    return None if number is None else _native.actions()[number]
