"""States of a world's agents and objects."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dwell import ConfigError, _native
from dwell.arguments import integer_in_range, quoted, text


class StateApi:
    """The agents and objects of a world, as they are now."""

    _native: _native.World

    def agents(self) -> list[dict[str, Any]]:
        """The states of all agents: a mapping for each, with angles in degrees and in radians.

        Returns:
            ``position``: the point between its feet, m. ``yaw_deg``, ``yaw_rad``: where it faces,
            positive to the left, 0 along -Z. ``pitch_deg``, ``pitch_rad``: where it looks, positive
            up. ``velocity``: m/s. ``grounded``: whether it stands on something. ``collided``:
            whether something stopped it in the last step. ``holding``: the place in
            :meth:`objects` of what is in its hand, or ``None``. ``crouched_by_m``: how much lower
            than its height it is. ``gyro_rad_s``: how fast it turns, positive to the left.
            ``body``: what its body can now, as ``agents`` of the constructor, with the numbers that
            :meth:`set_parameters` set. ``base``: its wheels, as ``wheel_rad_s``,
            ``wheel_rotation_rad`` (left, right), ``twist`` and ``odometry``.
        """
        return agent_states(self._native.agents())

    def objects(self) -> list[dict[str, Any]]:
        """The states of all objects: a mapping for each.

        Returns:
            ``id``: its number in instance images. ``name``: its name, for :meth:`act` and kin.
            ``category``: its coarse class, as :meth:`House.semantic_classes` lists them.
            ``center`` and ``size``: middle and edges (x, y, z) of the box around it along the
            world's axes, m. ``room``: the name of the room around its middle, or ``None``.
            ``pickable``: whether a hand can take it, as far as shape and use say. ``held_by``: the
            number of the agent that holds it, or ``None``. ``on``: whether it is switched on;
            ``None`` without a switch. ``openness``: how far it is open, 0 to 1; ``None`` without a
            joint. ``rests_on``: the names of what carries it, ``"building"`` for floors and walls;
            empty while it is held or flies, and of what never moves, such as heavy or built-in
            furniture, where physics looks for no contacts. ``lies_in``: the names of what it lies
            in; empty for what a hand cannot take. ``sounds``: whether it makes a sound of its own
            while it is switched on or has no switch.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> [row["name"] for row in world.objects() if row["sounds"]][:3]
            ['clock_1', 'laptop_1', 'radio_1']
        """
        objects = self._native.objects()
        return objects

    def object(self, name: str | int) -> dict[str, Any]:
        """The state of one object, as a row of :meth:`objects`.

        Args:
            name: Its name, or its ``id``.

        Raises:
            ConfigError: There is none; the message has the nearest names.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> radio = world.object("radio_1")
            >>> radio["on"], radio["room"], world.object(radio["id"]) == radio
            (False, 'child_room', True)
        """
        named: object = name
        if isinstance(named, str):
            found = self._native.object(text("name", named))
        elif isinstance(named, int | np.integer) and not isinstance(named, bool):
            found = self._native.object(integer_in_range("name", named, high=2**31 - 1))
        else:
            raise ConfigError(f"name is {quoted(named)}; expected the name of an object, or its id")
        return found


def agent_states(agents: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The engine's states of agents, with their angles in degrees, too."""
    for agent in agents:
        for angle in ("yaw", "pitch"):
            agent[f"{angle}_deg"] = math.degrees(agent[f"{angle}_rad"])
    return agents
