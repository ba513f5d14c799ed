"""A house as pictures show it: clouds of points on things, narrow pictures of them, and floors.

Boxes of :meth:`dwell.World.objects` only say where to aim a camera; a thing that reaches past the
picture is marked as ``cut``.
"""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import numpy as np

import dwell
from oracles.floors import Floor
from oracles.outlines import products
from oracles.scans import Flags, Floats, angles_to, flat_picture, frame, scan, take


@dataclasses.dataclass(frozen=True)
class Cloud:
    """Points on the surface of one thing."""

    points: Floats
    spacing: float
    #: It reaches past the scanned box, or too little of it was met.
    cut: bool

    @functools.cached_property
    def low(self) -> Floats:
        """The lowest coordinates."""
        low: Floats = self.points.min(axis=0)
        return low

    @functools.cached_property
    def high(self) -> Floats:
        """The highest coordinates."""
        high: Floats = self.points.max(axis=0)
        return high

    @property
    def middle(self) -> Floats:
        """The middle of the box around the points."""
        return (self.low + self.high) / 2

    @functools.cached_property
    def outline(self) -> Floats:
        """The convex outline from above: corners (n, 2) in x and z, in order."""
        flat = self.points[:, [0, 2]]
        turns = np.arange(40) * (2 * np.pi / 40)
        along = np.stack((np.cos(turns), np.sin(turns)))
        corners = flat[products(flat, along.T).argmax(axis=0)]
        keep = np.any(np.abs(corners - np.roll(corners, 1, axis=0)) > 1e-9, axis=1)
        apart: Floats = corners[keep] if keep.any() else corners[:1]
        return apart

    @functools.cached_property
    def edges(self) -> tuple[float, float]:
        """The longer and the shorter edge of the smallest rectangle around the outline."""
        best = (np.inf, 0.0, 0.0)
        for turn in np.deg2rad(np.arange(0.0, 90.0, 1.0)):
            axes = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
            wide, deep = np.ptp(self.outline @ axes, axis=0)
            best = min(best, (float(wide * deep), float(wide), float(deep)))
        return max(best[1:]), min(best[1:])


def _empty_slabs(
    points: Floats, low: Floats, high: Floats, spacing: float
) -> list[tuple[Floats, Floats]]:
    """The parts of a box beyond the points, on sides where these end well before its middle."""
    slabs = []
    for axis in range(3) if len(points) else ():
        first, last = points[:, axis].min(), points[:, axis].max()
        edge = 0.002 + spacing * 0.3
        if first - low[axis] > edge:
            end = high.copy()
            end[axis] = first
            slabs.append((low, end))
        if high[axis] - last > edge:
            start = low.copy()
            start[axis] = last
            slabs.append((start, high))
    return slabs


@dataclasses.dataclass(frozen=True)
class Glimpse:
    """What a narrow picture from somewhere shows of one thing."""

    #: Directions (n, 3) to its pixels and its points there.
    directions: Floats
    points: Floats
    #: The part that others hide, 0 to 1.
    hidden: float
    #: It reaches past the picture, or the camera is too near.
    cut: bool
    #: Something with a pane of glass is in the picture: ids end at it, people see through it.
    glazed: bool = False

    @property
    def pixels(self) -> int:
        """How many pixels show it."""
        return len(self.directions)


class Scene:
    """A world as pictures show it; everything is looked at once."""

    def __init__(self, world: dwell.World) -> None:
        """Looks at a world that nothing moves in as long as the scene is used."""
        self.world = world
        self.rows: dict[str, dict[str, Any]] = {row["name"]: row for row in world.objects()}
        self.rooms: list[dict[str, Any]] = world.house.rooms()
        self._clouds: dict[str, Cloud] = {}
        self._glimpses: dict[tuple[tuple[float, ...], str], Glimpse] = {}
        boxes = np.array(
            [(np.array(r["center"]), np.array(r["size"]) / 2) for r in self.rows.values()]
        ).reshape(-1, 2, 3)
        stands = np.array([room["stand"] for room in self.rooms]).reshape(-1, 3)
        # A room may reach past all that stands in it.
        reach = np.array([[1.2 * float(room["area_m2"]) ** 0.5] for room in self.rooms])
        reach = reach.reshape(-1, 1) * np.array((1.0, 0.0, 1.0))
        lowest = np.concatenate((boxes[:, 0] - boxes[:, 1], stands - reach))
        highest = np.concatenate((boxes[:, 0] + boxes[:, 1], stands + reach))
        self.low: Floats = lowest.min(axis=0) - 0.6
        self.high: Floats = highest.max(axis=0) + 0.6
        self._floors: dict[float, Floor] = {}
        self._glass: list[int] | None = None

    def aim(self, name: str) -> tuple[Floats, Floats]:
        """The box at which cameras are aimed for a thing, a little larger than it."""
        row = self.rows[name]
        middle, half = np.array(row["center"]), np.array(row["size"]) / 2
        half = half * 1.02 + 0.02
        return middle - half, middle + half

    def cloud(self, name: str) -> Cloud:
        """Points on a thing."""
        if name not in self._clouds:
            low, high = self.aim(name)
            spacing = float(np.clip((high - low).max() / 44, 0.004, 0.06))
            number = self.rows[name]["id"]
            pad = (high - low - np.array(self.rows[name]["size"])) / 2
            ids, points = scan(self.world, low, high, spacing, 2, pad_m=pad)
            mine = points[ids == number]
            for slab in _empty_slabs(mine, low + pad - 0.001, high - pad + 0.001, spacing):
                # Thin parts fall between the pixels: a finer look at where nothing was met.
                finer = float(np.clip((slab[1] - slab[0]).max() / 90, 0.002, spacing))
                ids, points = scan(self.world, slab[0], slab[1], finer, 1)
                mine = np.concatenate((mine, points[ids == number]))
            past = len(mine) < 12 or bool(np.any(mine - low < 0.006) or np.any(high - mine < 0.006))
            if len(mine) == 0:
                mine = ((low + high) / 2)[None]
            self._clouds[name] = Cloud(mine, spacing, past)
        return self._clouds[name]

    def sole(self, name: str) -> Floats:
        """Points, evenly seen from above, where a thing has faces of its lowest 2 cm."""
        cloud = self.cloud(name)
        low, high = cloud.low - 0.004, cloud.high + 0.004
        size = (float(high[0] - low[0]), float(high[2] - low[2]))
        pixel = float(np.clip(max(size) / 120, 0.002, 0.02))
        pixels = (int(np.clip(size[0] / pixel, 4, 200)), int(np.clip(size[1] / pixel, 4, 200)))
        met: Flags = np.zeros(pixels[::-1], np.bool_)
        # From within the thing down to its bottom: the floor hides it from below.
        for lift in (0.02, 0.01, 0.004):
            eye = np.array(((low[0] + high[0]) / 2, cloud.low[1] + lift, (low[2] + high[2]) / 2))
            ids, depth, points = flat_picture(self.world, eye, (0, -90), size, pixels)
            met |= (ids == self.rows[name]["id"]) & (depth < lift + 0.004)
        # Legs may have no bottom, but sides.
        start = np.array((low[0], cloud.low[1] - 0.001, low[2]))
        end = np.array((high[0], cloud.low[1] + 0.02, high[2]))
        numbers, found = scan(self.world, start, end, max(pixel, 0.004))
        sides = found[numbers == self.rows[name]["id"]]
        column = ((sides[:, 0] - low[0]) / size[0] * pixels[0]).astype(int)
        row = ((sides[:, 2] - low[2]) / size[1] * pixels[1]).astype(int)
        met[np.clip(row, 0, pixels[1] - 1), np.clip(column, 0, pixels[0] - 1)] = True
        return points[met]

    def glimpse(self, eye: Floats, name: str) -> Glimpse:
        """A narrow picture of a thing from somewhere."""
        key = (tuple(float(x) for x in eye), name)
        if key not in self._glimpses:
            self._glimpses[key] = self._look(eye, name)
        return self._glimpses[key]

    def _look(self, eye: Floats, name: str) -> Glimpse:
        low, high = self.aim(name)
        to = (low + high) / 2 - eye
        nothing = Glimpse(np.zeros((0, 3)), np.zeros((0, 3)), 0.0, True)
        if np.all(eye > low - 0.05) and np.all(eye < high + 0.05):
            return nothing
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        ways = low + corners * (high - low) - eye
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        view = angles_to(to)
        right, up, ahead = frame(*view)
        apart = float(np.arccos(np.clip((ways @ ahead).min(), -1, 1)))
        if apart > np.deg2rad(62):
            return nothing
        count = 64
        camera = dwell.Camera(
            count, count, fov_deg=float(np.rad2deg(2 * apart) * 1.05 + 0.2), max_objects=256
        )
        taken = take(self.world, eye, view, camera, ("instance", "depth", "visible_objects"))
        ids = taken["instance"][..., 0]
        mine = ids == self.rows[name]["id"]
        half = np.tan(np.deg2rad(float(camera.fov_deg or 90.0)) / 2)
        steps = ((np.arange(count) + 0.5) / count * 2 - 1) * half
        rows, columns = np.nonzero(mine)
        rays = ahead + steps[columns, None] * right - steps[rows, None] * up
        points = eye + rays * taken["depth"][..., 0][mine][:, None]
        rays /= np.linalg.norm(rays, axis=1)[:, None]
        listed = taken["visible_objects"]
        row = listed[listed[:, 0] == self.rows[name]["id"]]
        hidden = float(row[0, 2]) if len(row) else 1.0
        border = np.concatenate((mine[0], mine[-1], mine[:, 0], mine[:, -1]))
        glazed = bool(np.isin(ids, self.glass()).any())
        return Glimpse(rays, points, hidden, bool(border.any()), glazed)

    def glass(self) -> list[int]:
        """The ids of all that has glass on it."""
        if self._glass is None:
            has = ((row, self.world.attributes(name)) for name, row in self.rows.items())
            self._glass = [
                row["id"]
                for row, attributes in has
                if any(substance == "glass" for substance, _ in attributes["substances"])
            ]
        return self._glass

    def floor(self, height: float) -> Floor:
        """The floor of a storey."""
        key = round(height, 2)
        if key not in self._floors:
            self._floors[key] = Floor(self, height)
        return self._floors[key]

    @functools.cached_property
    def heights(self) -> list[float]:
        """The heights of floors, the lowest first."""
        return sorted({round(float(room["floor_y"]), 2) for room in self.rooms})

    def height_below(self, y: float) -> float | None:
        """The floor height that something at a height belongs to."""
        below = [height for height in self.heights if height <= y + 0.02]
        return below[-1] if below else None

    def slices(self, step_m: float = 0.15, cell_m: float = 0.03) -> dict[int, int]:
        """Every id that a sweep of pictures from above shows, each begun lower, with pixels."""
        size = self.high - self.low
        wide, deep = float(size[0]), float(size[2])
        pixels = (int(wide / cell_m), int(deep / cell_m))
        middle = (self.low + self.high) / 2
        seen: dict[int, int] = {}
        for y in np.arange(self.high[1], self.low[1] + 0.5, -step_m):
            ids, _, _ = flat_picture(
                self.world, np.array((middle[0], y, middle[2])), (0, -90), (wide, deep), pixels
            )
            for number, count in zip(*np.unique(ids, return_counts=True), strict=True):
                seen[int(number)] = seen.get(int(number), 0) + int(count)
        return seen


def clear(scene: Scene, *names: str) -> bool:
    """Whether nothing was cut off in scans of things."""
    return not any(scene.cloud(name).cut for name in names)
