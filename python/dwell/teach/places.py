"""Where in a house a table with a person and a robot beside it has room."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import dwell
from dwell import ConfigError
from dwell.teach.layout import ROBOT_FROM_EDGE_M, TABLE_M, Layout

#: Where a person can stand nothing is nearer than its radius, m.
_RADIUS_M = 0.2
#: Where one must be able to stand, on both sides of the middle of the table: along it, and across
#: it as far as the robot, m.
_HALF_WIDTH_M = TABLE_M[0] / 2.0 + 0.1 - _RADIUS_M
_HALF_LENGTH_M = TABLE_M[2] / 2.0 + ROBOT_FROM_EDGE_M
#: From one place that is looked at to the next, m.
_STEP_M = 0.1


def free_layout(house: dwell.House) -> Layout:
    """A place for the table where people can walk all around it: in the largest room that has one.

    Raises:
        ConfigError: There is none.
    """
    grid = house.navigation()
    points = grid.points().astype(np.float64)
    rooms = sorted(house.rooms(), key=lambda room: -room["area_m2"])
    for room in rooms:
        floor_y = room["floor_y"]
        level = points[np.abs(points[:, 1] - floor_y) < 0.05]
        if not len(level):
            continue
        own = _within_reach_of(level, room)
        for yaw_deg in (0.0, 90.0):
            found = _free_rectangle(level, own, yaw_deg)
            if found is not None:
                return Layout((found[0], floor_y, found[1]), yaw_deg)
    side, length = (2.0 * (half + _RADIUS_M) for half in (_HALF_WIDTH_M, _HALF_LENGTH_M))
    raise ConfigError(
        f"{house.name}: no room has {side:.1f} by {length:.1f} m of free floor for the table, the "
        "person and the robot; take a house with less furniture, or none for the room that is made"
    )


def _within_reach_of(level: NDArray[np.float64], room: dict[str, object]) -> NDArray[np.float64]:
    """Places around the middle of a room, the nearest first, as coordinates of middles to try."""
    stand = np.asarray(room["stand"], np.float64)
    side = math.sqrt(float(room["area_m2"]))  # type: ignore[arg-type] # a number
    distance = np.hypot(level[:, 0] - stand[0], level[:, 2] - stand[2])
    near = level[distance <= side]
    found: NDArray[np.float64] = near[np.argsort(distance[distance <= side], kind="stable")]
    return found


def _free_rectangle(
    level: NDArray[np.float64], middles: NDArray[np.float64], yaw_deg: float
) -> tuple[float, float] | None:
    """The first middle around which the floor is free, x and z."""
    across, along = _HALF_WIDTH_M, _HALF_LENGTH_M
    half_x, half_z = (across, along) if yaw_deg == 0.0 else (along, across)
    free = {(round(x / _STEP_M), round(z / _STEP_M)) for x, _, z in level}
    tried: set[tuple[int, int]] = set()
    steps_x = np.arange(-half_x, half_x + 1e-9, _STEP_M)
    steps_z = np.arange(-half_z, half_z + 1e-9, _STEP_M)
    for x, _, z in middles:
        cell = (round(x / _STEP_M), round(z / _STEP_M))
        if cell in tried:
            continue
        tried.add(cell)
        cells = (
            (round((x + dx) / _STEP_M), round((z + dz) / _STEP_M))
            for dx in steps_x
            for dz in steps_z
        )
        if all(cell in free for cell in cells):
            return float(x), float(z)
    return None
