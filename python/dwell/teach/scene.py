"""A house with the table, and the things of a clip on it."""

from __future__ import annotations

import dataclasses
import functools
import math
import tempfile
from pathlib import Path

import numpy as np

import dwell
from dwell.teach.layout import THINGS_FROM_EDGE_M, THINGS_HALF_WIDTH_M, Layout
from dwell.teach.places import free_layout
from dwell.teach.table_mesh import write_table
from dwell.teach.things import POOL, THINGS_ON_THE_TABLE, add, sizes_m

#: What everybody calls the table in a house.
TABLE = "teaching_table"
#: Between the rings around two things at least, m.
_GAP_M = 0.015
#: How often places are drawn before they are drawn anew from the first thing on.
_TRIES = 400
#: The target lies where the person's arms reach: to the sides of the middle, and from the edge, m.
_TARGET_HALF_WIDTH_M = 0.36
_TARGET_FROM_EDGE_M = (0.10, 0.28)


@dataclasses.dataclass(frozen=True)
class PlacedThing:
    """A thing on the table: of the pool, to the robot's right, from the person's edge, turned."""

    name: str
    right_m: float
    from_edge_m: float
    yaw_deg: float


def stage(house: str | None) -> tuple[dwell.House, Layout]:
    """A house with the table and nothing on it, and how the table stands.

    Raises:
        ConfigError: No room of the house has the place.
    """
    return _stage(house)


@functools.lru_cache(maxsize=4)
def _stage(house: str | None) -> tuple[dwell.House, Layout]:
    if house is None:
        opened, layout = _room(), Layout((2.2, 0.0, 2.2), 0.0)
    else:
        opened = dwell.House.open(house)
        layout = free_layout(opened)
    with tempfile.TemporaryDirectory(prefix="dwell-teach-") as folder:
        file = Path(folder) / "table.obj"
        write_table(file)
        edit = opened.edit()
        edit.add_file(
            file,
            layout.origin,
            yaw_deg=layout.yaw_deg,
            name=TABLE,
            category="table",
            mobility="fixed",
            substance="oak",
            srgb=(176, 140, 100),
        )
        return edit.done(), layout


def _room() -> dwell.House:
    """A room of 4.4 by 4.4 m with a window behind the robot and a lamp above the table."""
    builder = dwell.HouseBuilder("teaching room", style="nordic", seed=1)
    builder.room(
        "room", (0.0, 0.0, 4.4, 4.4), kind="living room", floor="carpet", ceiling="acoustic_panel"
    )
    builder.window("room", "south").add_lamp((2.2, 2.5, 2.2))
    return builder.build()


def place_things(
    random: np.random.Generator, target: int, others: tuple[int, ...]
) -> list[PlacedThing]:
    """Draws where things lie: none meets another, seen from above.

    Args:
        random: The clip's stream.
        target: The thing that the clip is about, by its number in the pool.
        others: The user's other things; those that lie on the table are drawn.

    Returns:
        The target first.
    """
    on_table = [target, *random.choice(others, THINGS_ON_THE_TABLE - 1, replace=False).tolist()]
    while True:
        placed = _try_to_place(random, on_table)
        if placed is not None:
            return placed


def _try_to_place(random: np.random.Generator, on_table: list[int]) -> list[PlacedThing] | None:
    placed: list[PlacedThing] = []
    rings: list[tuple[float, float, float]] = []
    for number in on_table:
        thing = POOL[number]
        is_target = not placed
        half_width = _TARGET_HALF_WIDTH_M if is_target else THINGS_HALF_WIDTH_M
        near, far = _TARGET_FROM_EDGE_M if is_target else THINGS_FROM_EDGE_M
        width, _, depth = sizes_m()[thing.name]
        radius = math.hypot(width, depth) / 2.0
        for _ in range(_TRIES):
            right = float(random.uniform(-half_width, half_width))
            from_edge = float(random.uniform(near, far))
            yaw_deg = float(random.uniform(-180.0, 180.0))
            if all(
                math.hypot(right - x, from_edge - z) >= radius + other + _GAP_M
                for x, z, other in rings
            ):
                break
        else:
            return None
        rings.append((right, from_edge, radius))
        placed.append(PlacedThing(thing.name, right, from_edge, yaw_deg))
    return placed


def furnished(house: dwell.House, layout: Layout, placed: list[PlacedThing]) -> dwell.House:
    """The house with things on the table; their order is that of the pool, whatever was drawn."""
    by_name = {thing.name: thing for thing in placed}
    edit = house.edit()
    for thing in POOL:
        if thing.name in by_name:
            row = by_name[thing.name]
            x, y, z = map(float, layout.on_table(row.right_m, row.from_edge_m))
            add(edit, thing, (x, y, z), row.yaw_deg)
    return edit.done()
