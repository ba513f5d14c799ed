"""Bodies and joints of a world: what moves, read and set."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypedDict

from dwell import ConfigError, _native
from dwell.arguments import (
    checked_fields,
    finite_number,
    integer_in_range,
    mapping,
    point,
    quoted,
    sequence_items,
    text,
    three_numbers,
    two_numbers,
    unit_quaternion,
)

#: Ids have 32 bits.
_MAX_ID = 2**32 - 1

JointCommand = Literal["off", "position", "velocity", "effort"]


class _Body(TypedDict):
    object: str


class BodyPlacement(_Body, total=False):
    """A thing and where it is put: the arguments of :meth:`BodyApi.set_body`."""

    part: str | None
    position: Sequence[float] | None
    rotation: Sequence[float] | None
    linear_m_s: Sequence[float]
    angular_rad_s: Sequence[float]


class BodyApi:
    """The part of a world that reads and sets poses and velocities of bodies and joints."""

    _native: _native.World

    def joints(self) -> list[dict[str, Any]]:
        """Every joint: id, name, object, kind, limits, motor, position, velocity, command."""
        return self._native.joints()

    def command_joint(self, joint: int, kind: JointCommand, value: float = 0.0) -> None:
        """Commands a joint's motor, until the next command.

        Args:
            joint: Its id, as in :meth:`joints`.
            kind: ``position`` (rad or m), ``velocity`` (per second), ``effort`` (N m or N) or
                ``off``.
            value: The number.

        Raises:
            ConfigError: For a kind or a joint that does not exist, or a number that is not finite.
            UsageError: The joint cannot obey.
        """
        joint = integer_in_range("joint", joint, high=_MAX_ID)
        self._native.command_joint(joint, text("kind", kind), finite_number("value", value))

    def set_joints(self, joints: Mapping[int, tuple[float, float]]) -> None:
        """Sets positions and velocities of joints at once; what hangs on them moves along.

        Args:
            joints: By id, as in :meth:`joints`: (rad or m, and per second).

        Raises:
            ConfigError: For what is no pair of finite numbers, and a joint that there is not.
            DwellError: A position is beyond the joint's limits, or a speed beyond 1000 rad/s or
                m/s. Nothing has changed then.
        """
        if not isinstance(joints, Mapping):
            raise ConfigError(f"joints is {quoted(joints)}; expected (position, velocity) by id")
        rows = []
        for joint, stand in joints.items():
            position, velocity = two_numbers(f"joint {quoted(joint)}: (position, velocity)", stand)
            rows.append((integer_in_range("joint", joint, high=_MAX_ID), position, velocity))
        self._native.set_joints(rows)

    def body(self, object: str, *, part: str | None = None) -> dict[str, tuple[float, ...]]:
        """A thing's pose and velocities.

        Args:
            object: Its name.
            part: One of its parts, by name; without it the first that moves.

        Returns:
            ``position`` (m) and ``rotation`` (x, y, z, w) of the part's origin, ``linear_m_s`` and
            ``angular_rad_s``.
        """
        body = self._native.body(
            text("object", object), None if part is None else text("part", part)
        )
        return {name: tuple(values) for name, values in body.items()}

    def set_body(
        self,
        object: str,
        *,
        part: str | None = None,
        position: Sequence[float] | None = None,
        rotation: Sequence[float] | None = None,
        linear_m_s: Sequence[float] = (0.0, 0.0, 0.0),
        angular_rad_s: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        """Places a thing that moves freely, or the base of a free robot.

        It is awake afterwards, what hangs on it by joints moves along, and :meth:`body` reads back
        what was set. Joints are set by :meth:`set_joints`, agents by :meth:`place_agent`.

        Args:
            object: Its name.
            part: One of its parts, by name; without it the first that moves.
            position: Of the part's origin, m; where it is, if left out.
            rotation: (x, y, z, w) of any length but 0; as it is, if left out.
            linear_m_s: Velocity of the part's origin; at rest, if left out.
            angular_rad_s: Rotation about the world's axes.

        Raises:
            ConfigError: For a thing that does not exist or what is no finite number.
            DwellError: It is fixed, held, frozen at the start or moved by a joint, or physics
                cannot keep the numbers. Nothing has changed then.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> name = next(thing["name"] for thing in world.objects() if thing["pickable"])
            >>> world.set_body(name, position=(1.0, 1.5, 1.0), linear_m_s=(0.0, 2.0, 0.0))
            >>> world.body(name)["linear_m_s"]
            (0.0, 2.0, 0.0)
        """
        row: BodyPlacement = {
            "object": object,
            "part": part,
            "position": position,
            "rotation": rotation,
            "linear_m_s": linear_m_s,
            "angular_rad_s": angular_rad_s,
        }
        self._set_rows([_placement("", row)])

    def set_bodies(self, bodies: Sequence[BodyPlacement]) -> None:
        """Places several things at once, each as :meth:`set_body` does: all of them, or none.

        Contacts are found once for all of them: of a thousand things in a heap this takes as long
        as a single one.

        Args:
            bodies: The arguments of :meth:`set_body` of each; ``object`` alone must be there.

        Raises:
            ConfigError: As :meth:`set_body`, or a row that is none.
            DwellError: As :meth:`set_body`.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> names = [thing["name"] for thing in world.objects() if thing["pickable"]][:2]
            >>> rows = [{"object": name, "position": (1.0, 1.5 + k, 1.0)}
            ...         for k, name in enumerate(names)]
            >>> world.set_bodies(rows)
            >>> world.body(names[1])["position"]
            (1.0, 2.5, 1.0)
        """
        rows = [
            _placement(f"bodies[{k}]", row)
            for k, row in enumerate(sequence_items("bodies", bodies, "expected a list of dicts"))
        ]
        named: dict[tuple[str, str | None], int] = {}
        for k, row in enumerate(rows):
            first = named.setdefault((row["object"], row["part"]), k)
            if first != k:
                raise ConfigError(
                    f"bodies[{k}] is {quoted(row['object'])}, as bodies[{first}] is; expected each "
                    "once"
                )
        self._set_rows(rows)

    def _set_rows(self, rows: list[dict[str, Any]]) -> None:
        for row in rows:
            # What is not stated stays as it is.
            if row["position"] is None or row["rotation"] is None:
                now = self.body(row["object"], part=row["part"])
                row["position"] = row["position"] or now["position"]
                row["rotation"] = row["rotation"] or now["rotation"]
        self._native.set_bodies(rows)


def _placement(at: str, row: object) -> dict[str, Any]:
    """A row of :meth:`BodyApi.set_bodies`, checked."""
    checks: dict[str, Callable[[str, Any], Any]] = {
        "object": text,
        "part": text,
        "position": point,
        "rotation": unit_quaternion,
        "linear_m_s": three_numbers,
        "angular_rad_s": three_numbers,
    }
    checked: dict[str, Any] = {"part": None, "position": None, "rotation": None}
    stated = mapping(at, row, "the arguments of set_body by name")
    checked |= checked_fields(at, {k: v for k, v in stated.items() if v is not None}, checks)
    if "object" not in checked:
        raise ConfigError(f"{at} is {quoted(row)}; expected the name of a thing as object")
    at_rest = dict.fromkeys(("linear_m_s", "angular_rad_s"), (0.0, 0.0, 0.0))
    return at_rest | checked
