"""Manipulation by agents of a world, step by step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dwell import ConfigError, _native
from dwell.actions import Outcome, checked_action, takes_target
from dwell.arguments import integer_in_range, mapping, quoted
from dwell.object_state_api import StateApi


class ActionApi(StateApi):
    """The actions of a world's agents."""

    def act(
        self,
        action: str | Mapping[str, Any],
        object: str | int | None = None,
        *,
        agent: int = 0,
        **details: Any,  # noqa: ANN401 - numbers, names and vectors, checked by the engine
    ) -> Outcome:
        """Lets an agent do something with its hand, without a step of time.

        What takes time (doors, pushes) tells its end through :meth:`delayed_outcomes`.

        Args:
            action: ``pick``, ``drop``, ``place``, ``place_at``, ``put_in``, ``throw``, ``push``,
                ``pull``, ``open``, ``close``, ``toggle``, ``point`` or ``grip``; or a mapping with
                ``kind`` and details.
            object: The thing's name, or its id as instance images show it. Without it, and
                without ``pixel`` and ``direction``, what the agent looks at is meant; of ``drop``
                and ``throw`` what it holds, and nothing else may be named.
            agent: Who does it.
            **details: ``part`` (one drawer of several, by name); ``pixel`` (column, row) and
                ``camera`` (a :class:`Camera` at the agent's eye) or ``origin`` and ``direction``
                of a ray, instead of an object; ``grasp`` of ``pick`` (``"kinematic"`` or
                ``{"spring": {"frequency_hz": 4, "damping_ratio": 1}}``); ``point`` of
                ``place_at``, m; ``direction`` and ``speed_m_s`` of ``throw``; ``force_n`` of
                ``push`` and ``pull``; ``fraction`` of ``open``.

        Raises:
            ConfigError: For a kind, name or detail that does not exist, or a number that is not
                finite.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> world.act("drop").sentence
            'You hold nothing. Pick something first.'
            >>> world.act("point", direction=(0.0, -1.0, 0.0)).pointed.kind
            'structure'
            >>> world.act({"kind": "pick", "object": -1}).code
            'unknown_object'
        """
        request: dict[str, Any] = {"kind": action} if isinstance(action, str) else {}
        if not isinstance(action, str):
            request = mapping("action", action, "the name of an action, or a mapping with kind")
        request |= details
        if object is not None:
            request["object"] = object
        agent = integer_in_range("agent", agent)
        checked = checked_action(request)
        if "object" in checked and not takes_target(checked.get("kind", "")):
            self._refuse_not_held(agent, checked["kind"], checked.pop("object"))
        return Outcome._of(self._native.act(agent, checked))

    def _refuse_not_held(self, agent: int, kind: str, named: str | int) -> None:
        """Refuses to let go of what an agent does not hold; its own name is allowed."""
        held = [row for row in self.objects() if row["held_by"] == agent]
        if not any(named in (row["name"], row["id"]) for row in held):
            holds = ", ".join(repr(row["name"]) for row in held) or "nothing"
            raise ConfigError(
                f"object is {quoted(named)}, which agent {agent} does not hold: it holds {holds}; "
                f"{kind} needs no name"
            )

    def delayed_outcomes(self) -> list[tuple[int | None, Outcome]]:
        """The outcomes, in the last step, of actions that take time: the agent, and its outcome."""
        notices = self._native.delayed_outcomes()
        return [(notice["agent"], Outcome._of(notice["outcome"])) for notice in notices]

    def do(self, action: int | str, *, agent: int = 0) -> Outcome:
        """Makes one control step of a discrete action, by number or name (see :func:`actions`)."""
        names = _native.actions()
        if isinstance(action, str) and action not in names:
            raise ConfigError(f"no action {quoted(action)}; there are {', '.join(names)}")
        number = names.index(action) if isinstance(action, str) else action
        number, agent = (
            integer_in_range("action", number, high=len(names) - 1),
            integer_in_range("agent", agent),
        )
        return Outcome._of(self._native.act_discrete(agent, number))
