"""A chart of the floor from distances around the body, and the way to a place on it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CELL_M, _HALF = 0.1, 240
#: What is kept clear of: a body's radius and a little.
_CLEAR_M = 0.26
#: Heights over the floor in which something is in the way, m; where the sensor is.
_LOW_M, _HIGH_M, _MOUNT_M = 0.15, 1.6, 0.5
#: Within this what was seen before is forgotten where rays pass, m.
_NEAR_M = 6.0
#: Steps after which a bump is forgotten.
_BUMP_STEPS = 50
#: Half the width of somebody who stands at a goal, m.
_BODY_M = 0.3
#: Where ways end that lead into what nobody saw, m from here.
_WINDOW = 70


class FloorChart:
    """What is free and what is in the way, around the start; axes ahead and left."""

    def __init__(self) -> None:
        """Nothing was seen yet."""
        size = 2 * _HALF + 1
        self._size = size
        #: By ring of the scan.
        self._hits = np.zeros((0, size, size), np.bool_)
        self._voids = np.zeros((size, size), np.bool_)
        self._bumps: list[tuple[int, int, int]] = []

    @staticmethod
    def around(reach_m: float = 9.0, cell_m: float = 0.3) -> Array:
        """Offsets of places around one, m; shape (n, 2)."""
        steps = np.arange(-reach_m, reach_m + cell_m / 2, cell_m)
        offsets: Array = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        return offsets

    def add(
        self, place: Array, yaw_rad: float, ranges: Array, sensors: Mapping[str, Mapping[str, Any]]
    ) -> None:
        """Adds a scan of ``lidar``: shape (rings, beams)."""
        settings = sensors["lidar"]
        reach_m = float(settings.get("max_range_m", 10.0))
        if not len(self._hits):
            self._hits = np.zeros((len(ranges), self._size, self._size), np.bool_)
        beams = ranges.shape[1]
        azimuths = yaw_rad - np.pi + 2.0 * np.pi * np.arange(beams) / beams
        samples_m = np.arange(0.1, min(reach_m, _NEAR_M), 0.09)
        for ring, elevation_deg in enumerate(settings["elevations_deg"]):
            level, rise = np.cos(np.deg2rad(elevation_deg)), np.sin(np.deg2rad(elevation_deg))
            found = ranges[ring]
            level_m = found * level
            heights = _MOUNT_M + found * rise
            ways = np.stack([np.cos(azimuths), np.sin(azimuths)], axis=1)
            # What a ray passed through is free at its height.
            free = samples_m[None, :] < level_m[:, None] - 0.1
            at = place + ways[:, None, :] * samples_m[None, :, None]
            rows, columns = self._cells(at[free])
            self._hits[ring, rows, columns] = False
            hits = (found < reach_m - 0.05) & (heights > _LOW_M)
            hits &= heights < _HIGH_M
            rows, columns = self._cells(place + ways[hits] * level_m[hits, None])
            self._hits[ring, rows, columns] = True
            if rise < 0.0:
                # Where a ray that should meet the floor meets nothing, the house ends.
                void = found >= reach_m - 0.05
                self._voids[self._cells(place - ways[void] * level * _MOUNT_M / rise)] = True

    def blocked(self, places: Array) -> NDArray[np.bool_]:
        """Whether something is in the way at places, shape (n, 2) m."""
        rows, columns = self._cells(places)
        if not len(self._hits):
            return np.zeros(len(places), np.bool_)
        found: NDArray[np.bool_] = np.any(self._hits[:, rows, columns], axis=0)
        found = np.logical_or(found, self._voids[rows, columns])
        return found

    def bumped(self, place: Array, way: Array, step: int) -> None:
        """Something was in the way, in the direction ``way``, that no scan told."""
        ahead = place + 0.3 * way
        rows, columns = self._cells(ahead[None])
        self._bumps = [*self._bumps[-60:], (int(rows[0]), int(columns[0]), step)]

    @staticmethod
    def _cells(places: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        cells = np.clip(np.rint(places / _CELL_M).astype(np.int64) + _HALF, 0, 2 * _HALF)
        return cells[..., 0], cells[..., 1]

    def way(self, place: Array, goal: Array, step: int, *, length: float = 0.02) -> Array | None:
        """The first piece of the shortest way towards a goal, m ahead and left; ``None``: none.

        Args:
            place: Where it begins, m.
            goal: Where it should lead; if it is somebody's place, who stands there is in no way.
            step: The present step, to forget bumps.
            length: How many m it may end further from the goal, for each m that it is shorter.
        """
        blocked: NDArray[np.bool_] = np.any(self._hits, axis=0) | self._voids
        (row,), (column,) = self._cells(goal[None])
        reach = round(_BODY_M / _CELL_M)
        there = np.s_[
            max(row - reach, 0) : row + reach + 1, max(column - reach, 0) : column + reach + 1
        ]
        blocked[there] = False
        for row, column, when in self._bumps:
            if step - when < _BUMP_STEPS:
                blocked[row, column] = True
        (row,), (column,) = self._cells(place[None])
        top, left = max(row - _WINDOW, 0), max(column - _WINDOW, 0)
        crop = blocked[top : row + _WINDOW + 1, left : column + _WINDOW + 1]
        crop = _grown(crop, round(_CLEAR_M / _CELL_M))
        here = (int(row - top), int(column - left))
        # Whoever stands too near to something may leave it.
        rows, columns = np.ogrid[: crop.shape[0], : crop.shape[1]]
        crop[(rows - here[0]) ** 2 + (columns - here[1]) ** 2 <= 6] = False
        steps = _flood(~crop, here)
        cells = np.argwhere(steps >= 0)
        corner = np.array([top - _HALF, left - _HALF])
        places = (cells + corner) * _CELL_M
        cost = np.hypot(*(places - goal).T) + length * _CELL_M * steps[cells[:, 0], cells[:, 1]]
        row, column = (int(value) for value in cells[int(cost.argmin())])
        path = [(row, column)]
        while steps[row, column] > 0:
            row, column = _downhill(steps, row, column)
            path.append((row, column))
        if len(path) < 3:
            return None
        path.reverse()
        ahead = path[min(3, len(path) - 1)]
        for far in path[4:25:2]:
            if not _is_free(crop, here, far):
                break
            ahead = far
        first: Array = (np.array(ahead) + corner) * _CELL_M - place
        return first


def _is_free(blocked: NDArray[np.bool_], start: tuple[int, int], end: tuple[int, int]) -> bool:
    """Whether nothing is on the straight line between two cells."""
    count = 2 * max(abs(end[0] - start[0]), abs(end[1] - start[1])) + 1
    rows, columns = (
        np.linspace(a, b, count).round().astype(int) for a, b in zip(start, end, strict=True)
    )
    return not bool(blocked[rows, columns].any())


def _grown(blocked: NDArray[np.bool_], cells: int) -> NDArray[np.bool_]:
    """Everything within so many cells of what is blocked."""
    grown = blocked.copy()
    for k in range(-cells, cells + 1):
        for j in range(-cells, cells + 1):
            if 0 < k * k + j * j <= cells * cells + 1:
                grown |= _shifted(blocked, k, j)
    return grown


def _shifted(grid: NDArray[np.bool_], down: int, right: int) -> NDArray[np.bool_]:
    moved = np.zeros_like(grid)
    height, width = grid.shape
    moved[max(down, 0) : height + min(down, 0), max(right, 0) : width + min(right, 0)] = grid[
        max(-down, 0) : height + min(-down, 0), max(-right, 0) : width + min(-right, 0)
    ]
    return moved


def _flood(free: NDArray[np.bool_], start: tuple[int, int]) -> NDArray[np.int32]:
    """Steps from ``start`` to each free cell, -1 where none lead; octagons, as of a compass."""
    steps = np.full(free.shape, -1, np.int32)
    front = np.zeros_like(free)
    front[start] = True
    steps[start] = 0
    count = 0
    while front.any():
        count += 1
        near = front.copy()
        near[1:] |= front[:-1]
        near[:-1] |= front[1:]
        near[:, 1:] |= front[:, :-1]
        near[:, :-1] |= front[:, 1:]
        if count % 2 == 0:
            near[1:, 1:] |= front[:-1, :-1]
            near[:-1, :-1] |= front[1:, 1:]
            near[1:, :-1] |= front[:-1, 1:]
            near[:-1, 1:] |= front[1:, :-1]
        front = near & free & (steps < 0)
        steps[front] = count
    return steps


def _downhill(steps: NDArray[np.int32], row: int, column: int) -> tuple[int, int]:
    """The neighbour with the fewest steps."""
    best = (int(steps[row, column]), row, column)
    for k in range(max(row - 1, 0), min(row + 2, steps.shape[0])):
        for j in range(max(column - 1, 0), min(column + 2, steps.shape[1])):
            if 0 <= steps[k, j] < best[0]:
                best = (int(steps[k, j]), k, j)
    return best[1], best[2]
