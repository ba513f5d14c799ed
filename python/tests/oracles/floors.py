"""Storeys from above: whose floor is where, what blocks it, and how far ways lead."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from oracles.scans import SIX_SIDES, Flags, Floats, Ints, flat_picture, frame

if TYPE_CHECKING:
    from oracles.scene import Scene

CELL_M = 0.05


class Floor:
    """A storey from above: which room's floor is where, and what stands on it."""

    def __init__(self, scene: Scene, height: float) -> None:
        """Takes pictures from just above the floor."""
        self.scene, self.height = scene, height
        low, high = scene.low, scene.high
        self.shape = (
            int(np.ceil((high[2] - low[2]) / CELL_M)),
            int(np.ceil((high[0] - low[0]) / CELL_M)),
        )
        self.corner = np.array((low[0], low[2]))
        names: dict[int, str] = {}
        things = {row["id"] for row in scene.rows.values()}
        for room in scene.rooms:
            if abs(float(room["floor_y"]) - height) > 0.05:
                continue
            for lift in (0.05, 0.02, 0.01, 0.005, 0.002):
                eye = np.array(room["stand"]) + np.array((0.0, lift, 0.0))
                ids, _, _ = flat_picture(scene.world, eye, (0, -90), (0.02, 0.02), (2, 2))
                # A rug hides the floor from further up.
                if ids[0, 0] > 0 and int(ids[0, 0]) not in things:
                    names[int(ids[0, 0])] = room["name"]
                    break
        self.names = names
        wanted = np.array(sorted(names), np.int32)
        self.ids: Ints = np.zeros(self.shape, np.int32)
        hidden: Flags = np.zeros(self.shape, np.bool_)
        for lift in (0.05, 0.02, 0.005):
            ids, depth, _ = self.from_above(height + lift)
            here = (self.ids == 0) & np.isin(ids, wanted) & (depth < lift + 0.06)
            self.ids[here] = ids[here]
            hidden |= np.isin(ids, np.array(sorted(things))) & (depth < lift + 0.06)
        # Under furniture there is the floor of around it.
        for _ in range(60):
            before = self.ids
            for shift in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                beside = np.roll(before, shift, axis=(0, 1))
                here = (self.ids == 0) & hidden & (beside > 0)
                self.ids = np.where(here, beside, self.ids)
            if self.ids is before or np.array_equal(self.ids, before):
                break

    def from_above(self, y: float) -> tuple[Ints, Floats, Floats]:
        """An orthographic picture of the storey from a height, a pixel a cell."""
        rows, columns = self.shape
        size = (columns * CELL_M, rows * CELL_M)
        middle = np.array((self.corner[0] + size[0] / 2, y, self.corner[1] + size[1] / 2))
        return flat_picture(self.scene.world, middle, (0, -90), size, (columns, rows))

    def cell(self, point: Floats) -> tuple[int, int]:
        """The row and column of a point."""
        column, row = np.floor((point[[0, 2]] - self.corner) / CELL_M).astype(int)
        return int(row), int(column)

    def point(self, row: int, column: int) -> Floats:
        """The middle of a cell, on the floor."""
        x, z = self.corner + (np.array((column, row)) + 0.5) * CELL_M
        return np.array((x, self.height, z))

    def room_at(self, point: Floats, margin_m: float = 0.05) -> str | None:
        """The room around a point; ``None`` near its border or where no floor is seen."""
        row, column = self.cell(point)
        reach = int(np.ceil(margin_m / CELL_M))
        part = self.ids[
            max(0, row - reach) : row + reach + 1, max(0, column - reach) : column + reach + 1
        ]
        found = set(np.unique(part).tolist()) - {0}
        # Furniture hides some cells; one room and half of the cells are enough.
        if len(found) == 1 and (part > 0).mean() >= 0.5:
            return self.names[found.pop()]
        return None

    def inner(self, room: str, margin_m: float = 0.25) -> Flags:
        """Cells of a room's floor this far within it; floors reach into walls and doorways."""
        return ~grown(self.ids != self.number(room), margin_m)

    def is_outside(self, point: Floats, room: str, margin_m: float = 0.15) -> bool:
        """Whether a point is clearly not over a room's floor."""
        spot = np.argwhere(self.ids == self.number(room))
        if len(spot) == 0:
            return False
        away = np.abs((spot + 0.5) * CELL_M + self.corner[::-1] - point[[2, 0]])
        return bool(np.hypot(*away.T).min() > margin_m)

    def number(self, room: str) -> int:
        """The id of a room's floor; -1 where it is none of this storey."""
        return next((k for k, name in self.names.items() if name == room), -1)

    def blocked(self, step_m: float, body_m: float) -> Flags:
        """Cells over which something is between the height of a step and that of a body."""
        world = self.scene.world
        rows, columns = self.shape
        blocked: Flags = np.zeros(self.shape, np.bool_)
        bottom, top = self.height + step_m, self.height + body_m
        ids, depth, points = self.from_above(top)
        # A hole, too, is no place to stand.
        blocked |= (ids == 0) | (points[..., 1] > bottom)
        for y in np.arange(top, bottom, -0.25):
            _, _, points = self.from_above(float(y))
            blocked |= points[..., 1] > bottom
        _, _, points = self.from_above(bottom)
        blocked |= points[..., 1] < self.height - step_m
        size = np.array((columns * CELL_M, rows * CELL_M))
        middle = self.corner + size / 2
        tall = top - bottom
        for view in SIX_SIDES[:4]:
            right, _, ahead = frame(*view)
            wide, deep = (
                float(abs(axis[0]) * size[0] + abs(axis[2]) * size[1]) for axis in (right, ahead)
            )
            eye = np.array((middle[0], (top + bottom) / 2, middle[1])) - ahead * deep / 2
            pixels = (round(wide / CELL_M), max(4, int(tall / 0.12)))
            for near in np.arange(0.0, deep, 0.15):
                ids, depth, points = flat_picture(
                    world, eye, view, (wide, tall), pixels, float(near) + 1e-4
                )
                hits = points[(ids > 0) & (depth < deep)]
                row = np.floor((hits[:, 2] - self.corner[1]) / CELL_M).astype(int)
                column = np.floor((hits[:, 0] - self.corner[0]) / CELL_M).astype(int)
                fits = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
                blocked[row[fits], column[fits]] = True
        return blocked


def grown(blocked: Flags, radius_m: float) -> Flags:
    """Cells whose middle is at most a radius from the middle of a blocked cell."""
    reach = int(radius_m / CELL_M + 1e-6)
    rows, columns = blocked.shape
    padded = np.pad(blocked, reach)
    found: Flags = blocked.copy()
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            if np.hypot(down, right) * CELL_M <= radius_m + 1e-6:
                found |= padded[
                    reach + down : reach + down + rows, reach + right : reach + right + columns
                ]
    return found


def steps_from(free: Flags, start: tuple[int, int]) -> Ints:
    """How many steps, over edges of cells, lead from a cell to each; -1 where none do."""
    steps: Ints = np.full(free.shape, -1, np.int32)
    front: Flags = np.zeros(free.shape, np.bool_)
    front[start] = True
    if not free[start]:
        return steps
    count = 0
    while front.any():
        steps[front] = count
        count += 1
        spread = np.zeros_like(front)
        spread[1:] |= front[:-1]
        spread[:-1] |= front[1:]
        spread[:, 1:] |= front[:, :-1]
        spread[:, :-1] |= front[:, 1:]
        front = spread & free & (steps < 0)
    return steps


def way_back(steps: Ints, end: tuple[int, int]) -> list[tuple[int, int]]:
    """The cells of a shortest way to a cell, from where steps are counted."""
    way = [end]
    while steps[way[-1]] > 0:
        row, column = way[-1]
        for near in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
            inside = 0 <= near[0] < steps.shape[0] and 0 <= near[1] < steps.shape[1]
            if inside and steps[near] == steps[way[-1]] - 1:
                way.append(near)
                break
    return way[::-1]
