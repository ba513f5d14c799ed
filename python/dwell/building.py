"""A house from a plan: rooms, doors, windows, stairs, and what stands in them.

The plan is noted as plain data: it can be saved and pickled. ``docs/authoring.md`` is the tutorial.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from dwell import ConfigError, _native, arguments
from dwell.arguments import (
    boolean,
    choice,
    finite_number,
    integer_in_range,
    path,
    quoted,
    sequence_items,
    text,
    two_numbers,
)
from dwell.edit_fields import Rgb, optional_text, rgb
from dwell.editing import EditList
from dwell.files import atomic_write
from dwell.house import House

if TYPE_CHECKING:
    from typing_extensions import Self

Covering = str | tuple[str, Rgb]
Compass = Literal["north", "east", "south", "west"]


class HouseBuilder(EditList):
    """A house from a plan: rooms first, then doors, windows and things.

    A room is its free floor; what is left between two rooms is the wall between them, and an outer
    wall goes around. x points east, z south, heights are y; all in metres.
    """

    def __init__(
        self,
        name: str = "house",
        *,
        style: str | None = None,
        seed: int = 0,
        outer_wall_m: float = 0.2,
        hour_h: float = 13.5,
    ) -> None:
        """Begins with one storey.

        Args:
            name: The house's name.
            style: The style of what is not told: ``"nordic"``, ``"modern"``, ...
            seed: Draws what is not told.
            outer_wall_m: Thickness of walls to the outside, 0.05 to 1 m.
            hour_h: Local solar time of sun and sky, 0 to 24 h, on a fine day in April.
        """
        super().__init__()
        self._name = text("name", name)
        self._building: dict[str, Any] = {
            "style": optional_text("style", style),
            "seed": integer_in_range("seed", seed),
            "outer_wall_m": finite_number("outer_wall_m", outer_wall_m),
            "daytime": {"hour_h": finite_number("hour_h", hour_h)},
        }
        self._storeys: list[dict[str, Any]] = [_storey(2.6)]

    def __repr__(self) -> str:
        """The name, and how much was noted."""
        storeys, edits = len(self._storeys), len(self._edits)
        return f"HouseBuilder({self._name!r}, storeys={storeys}, edits={edits})"

    def storey(self, height_m: float = 2.6) -> Self:
        """Begins the next storey, or says how high the first is while it has no rooms.

        Args:
            height_m: From the floor to the ceiling, 1.8 to 20 m.
        """
        # Before anything is taken away: what is refused changes nothing.
        storey = _storey(finite_number("height_m", height_m))
        if not self._storeys[-1]["rooms"]:
            self._storeys.pop()
        self._storeys.append(storey)
        return self

    def room(
        self,
        name: str,
        floor_plan: Sequence[float] | Sequence[tuple[float, float]],
        *,
        kind: str | None = None,
        height_m: float | None = None,
        floor: Covering | None = None,
        walls: Covering | None = None,
        ceiling: Covering | None = None,
    ) -> Self:
        """Adds a room.

        Args:
            name: Its name; no other room has it.
            floor_plan: Its free floor: (x from, z from, x to, z to), or the (x, z) of 4 to 200
                corners with edges along x or z.
            kind: What people call it: ``"living room"``; without it what its name means.
            height_m: The height of a ceiling that hangs lower than the storey's.
            floor: A substance such as ``"carpet"``, or that with a colour ``("carpet", (90, 90,
                120))``; without it as usual for the kind.
            walls: The same for its walls.
            ceiling: The same for its ceiling.
        """
        self._storeys[-1]["rooms"].append(
            {
                "name": text("name", name),
                "outline": _outline(floor_plan),
                "kind": optional_text("kind", kind),
                "height_m": None if height_m is None else finite_number("height_m", height_m),
                "floor": _covering("floor", floor),
                "walls": _covering("walls", walls),
                "ceiling": _covering("ceiling", ceiling),
            }
        )
        return self

    def door(
        self,
        room: str,
        behind: str = "outside",
        side: Compass | None = None,
        *,
        at_m: float | None = None,
        width_m: float = 0.98,
        height_m: float = 2.06,
        leaf: Literal["panel", "glazed", "none"] = "panel",
        hinge: Literal["left", "right"] = "left",
        opened: float = 0.0,
        name: str | None = None,
    ) -> Self:
        """Adds a door between two rooms of the storey, or to the outside.

        Args:
            room: The room into which it swings.
            behind: The other one, or ``"outside"``.
            side: The side of ``room`` on which it is; without it any.
            at_m: Its middle along the wall, x or z; without it the middle of the longest wall
                between the two.
            width_m: Of the opening, 0.5 to 10 m.
            height_m: Of the opening.
            leaf: What closes it; ``"none"``: it is an opening.
            hinge: The side of its hinges as one looks at it from ``room``.
            opened: How far it is open at the start, 0 to 1.
            name: Its name; without one ``door_1`` and so on.
        """
        self._storeys[-1]["doors"].append(
            {
                "rooms": [text("room", room), text("behind", behind)],
                "side": _side(side),
                "at_m": None if at_m is None else finite_number("at_m", at_m),
                "width_m": finite_number("width_m", width_m),
                "height_m": finite_number("height_m", height_m),
                "leaf": choice("leaf", leaf, ("panel", "glazed", "none")),
                "hinge": choice("hinge", hinge, ("left", "right")),
                "open": finite_number("opened", opened),
                "name": optional_text("name", name),
            }
        )
        return self

    def window(
        self,
        room: str,
        side: Compass | None = None,
        *,
        at_m: float | None = None,
        width_m: float = 1.2,
        height_m: float = 1.2,
        sill_m: float = 0.9,
        frosted: bool = False,
        name: str | None = None,
    ) -> Self:
        """Adds a window in an outer wall.

        Args:
            room: The room.
            side: The side of the room: north is -z; without it that of its longest outer wall.
            at_m: Its middle along the wall, x or z; without it the wall's middle.
            width_m: Of the opening, 0.2 to 20 m.
            height_m: Of the opening.
            sill_m: Height of its lower edge above the floor.
            frosted: Of frosted glass.
            name: Its name; without one ``window_1`` and so on.
        """
        self._storeys[-1]["windows"].append(
            {
                "room": text("room", room),
                "side": _side(side),
                "at_m": None if at_m is None else finite_number("at_m", at_m),
                "width_m": finite_number("width_m", width_m),
                "height_m": finite_number("height_m", height_m),
                "sill_m": finite_number("sill_m", sill_m),
                "frosted": boolean("frosted", frosted),
                "name": optional_text("name", name),
            }
        )
        return self

    def stairs(self, rect: Sequence[float], climb: Compass) -> Self:
        """Adds stairs from this storey to the next one.

        Args:
            rect: The floor that they take within one room of both storeys: (x from, z from, x to,
                z to), at least 1.6 m wide and 2.4 m along the climb.
            climb: The direction in which the first of the two flights climbs.
        """
        expected = "expected (x from, z from, x to, z to) in metres"
        corners = [
            finite_number(f"rect[{k}]", at)
            for k, at in enumerate(sequence_items("rect", rect, expected))
        ]
        if len(corners) != 4:
            raise ConfigError(f"rect has {len(corners)} numbers; expected 4")
        self._storeys[-1]["stairs"] = {"rect": corners, "climb": _compass("climb", climb)}
        return self

    def plan(self) -> dict[str, Any]:
        """The plan as plain data; ``docs/authoring.md`` lists the fields."""
        building = {**self._building, "storeys": self._storeys}
        plan = {"format": "dwell-plan", "version": 1, "name": self._name, "building": building}
        whole_plan: dict[str, Any] = json.loads(arguments.to_json({**plan, "edits": self._edits}))
        return whole_plan

    def save(self, file: str | os.PathLike[str]) -> Path:
        """Writes the plan; :meth:`dwell.House.open` opens it.

        Args:
            file: A path that ends in ``.plan.json``. Mesh files of the plan are read below its
                folder when it is opened, so they are to be named from there.
        """
        to = Path(path("file", file))
        if not to.name.endswith(".plan.json"):
            raise ConfigError(f"file is {to.name!r}; expected a name that ends in .plan.json")
        with atomic_write(to) as draft:
            draft.write_text(json.dumps(self.plan(), indent=1) + "\n", encoding="utf-8")
        return to

    def build(self) -> House:
        """Makes the house.

        Raises:
            HouseError: A room, an opening or an edit cannot be; the message names it and the field,
                what was found, and what is possible.
        """
        return _built(json.dumps(self.plan()))


def _storey(height_m: float) -> dict[str, Any]:
    return {"height_m": height_m, "rooms": [], "doors": [], "windows": [], "stairs": None}


def _built(plan: str) -> House:
    return House(_native.House.built(plan), (_built, (plan,)))


def _side(side: str | None) -> str | None:
    return None if side is None else _compass("side", side)


def _compass(name: str, direction: str) -> str:
    return choice(name, direction, ("north", "east", "south", "west"))


def _covering(name: str, covering: Covering | None) -> dict[str, Any] | None:
    if covering is None or isinstance(covering, str):
        return None if covering is None else {"substance": text(name, covering)}
    expected = 'expected a substance, or that with a colour, as ("carpet", (90, 90, 120))'
    parts = sequence_items(name, covering, expected, most=2)
    if len(parts) != 2:
        raise ConfigError(f"{name} is {quoted(covering)}; {expected}")
    return {"substance": text(f"{name}[0]", parts[0]), "srgb": rgb(f"{name}[1]", parts[1])}


def _outline(
    floor_plan: Sequence[float] | Sequence[tuple[float, float]],
) -> list[tuple[float, float]]:
    rows = sequence_items(
        "floor_plan", floor_plan, "expected four numbers or corners (x, z) in metres"
    )
    if len(rows) == 4 and not any(isinstance(row, Sequence | np.ndarray) for row in rows):
        x0, z0, x1, z1 = (finite_number(f"floor_plan[{k}]", at) for k, at in enumerate(rows))
        return [(x0, z0), (x1, z0), (x1, z1), (x0, z1)]
    return [two_numbers(f"floor_plan[{k}]", corner) for k, corner in enumerate(rows)]
