"""What is seen from somewhere in a room: pictures from a grid of places to stand."""

from __future__ import annotations

import numpy as np

import dwell
from oracles.answers import Answer
from oracles.floors import Floor, grown
from oracles.scans import SIX_SIDES, Flags, Floats, frame, take
from oracles.scene import Scene
from oracles.sight import seen

EYES_M = 1.5
#: Pixels of a strip of 90 degrees.
STRIP = 512


class Outlook:
    """Grids of eyes, 1.5 m above a room's floor, and what pictures from there show.

    Nobody stands where furniture reaches higher than the eyes or hangs about them, 0.1 m around it
    too. A coarse grid, 0.25 m off the border and not below doors' tops, tells what is seen for
    sure; finer ones, over all of the floor with doorways, tell what is seen from nowhere.
    """

    def __init__(self, scene: Scene) -> None:
        """Looks at nothing yet."""
        self.scene = scene
        self._tall: dict[float, Flags] = {}
        self._high: dict[float, Flags] = {}
        self._eyes: dict[tuple[str, int], Floats] = {}
        self._ranges: dict[tuple[str, int], Floats] = {}

    def _map(self, floor: Floor) -> None:
        """Marks cells over which furniture, or anything, is higher than the eyes."""
        tall, high = np.zeros(floor.shape, np.bool_), np.zeros(floor.shape, np.bool_)
        furniture = [
            row["id"]
            for name, row in self.scene.rows.items()
            if not name.startswith(("door", "window", "garage"))
        ]
        for y in (1.55, 1.7, 1.9, 2.05, 2.3, 2.45):
            ids, _, points = floor.from_above(floor.height + y)
            above = (ids > 0) & (points[..., 1] > floor.height + EYES_M - 0.02)
            high |= above
            tall |= above & np.isin(ids, furniture)
        self._tall[floor.height], self._high[floor.height] = grown(tall, 0.1), grown(high, 0.1)

    def eyes(self, room: str, step: int) -> Floats:
        """Places of eyes (n, 3) at every so many cells of 0.05 m; 0: about 40 for the coarse grid.

        Things may hang lower than a room's ceiling is: below a lamp, too, nobody stands.
        """
        key = (room, step)
        if key not in self._eyes:
            height = next(float(r["floor_y"]) for r in self.scene.rooms if r["name"] == room)
            floor = self.scene.floor(round(height, 2))
            if floor.height not in self._tall:
                self._map(floor)
            if step > 0:
                free = (floor.ids == floor.number(room)) & ~self._tall[floor.height]
            else:
                free = floor.inner(room, 0.25) & ~self._high[floor.height]
            spots = np.argwhere(free)
            wide = max(1, step)
            while step == 0 and len(spots[np.all(spots % wide == wide // 2, axis=1)]) > 40:
                wide += 1
            spots = spots[np.all(spots % wide == wide // 2, axis=1)]
            places = np.array([floor.point(int(r), int(c)) for r, c in spots]).reshape(-1, 3)
            self._eyes[key] = places + np.array((0.0, EYES_M, 0.0))
        return self._eyes[key]

    def thing(self, name: str, room: str) -> Answer:
        """Seen if a third of it is from a tenth of the places, and from three; unseen if nowhere.

        Between these, one of the nine rays from one of 32 other places may or may not meet it.
        """
        coarse = self.eyes(room, 0)
        if len(coarse) < 8:
            return "grey"
        answers = [seen(self.scene, eye, name, None) for eye in coarse]
        if answers.count("yes") >= max(3, 0.1 * len(coarse)):
            return "yes"
        if answers.count("no") < len(answers):
            return "grey"
        nowhere = all(seen(self.scene, eye, name, None) == "no" for eye in self.eyes(room, 2))
        return "no" if nowhere else "grey"

    def _around(self, room: str, step: int) -> Floats:
        """Distances (n, 4, 512) to what is met at the eyes' height: strips of four pictures."""
        key = (room, step)
        if key not in self._ranges:
            camera = dwell.Camera(STRIP, 2, fov_deg=90.0, near_m=1e-3)
            steps = (np.arange(STRIP) + 0.5) / STRIP * 2 - 1
            found = []
            for eye in self.eyes(room, step):
                for view in SIX_SIDES[:4]:
                    depth = take(self.scene.world, eye, view, camera, ("depth",))["depth"][..., 0]
                    found.append(depth.astype(np.float64).min(axis=0) * np.hypot(1.0, steps))
            self._ranges[key] = np.array(found).reshape(-1, 4, STRIP)
        return self._ranges[key]

    def _joined(self, seen_room: str, room: str, step: int) -> tuple[Flags, Flags] | None:
        """Pairs of places (n, m) that a straight line surely joins, and that it surely does not."""
        ends = self.eyes(room, step), self.eyes(seen_room, step)
        if min(len(ends[0]), len(ends[1])) < 8 or abs(float(ends[0][0, 1] - ends[1][0, 1])) > 0.05:
            return None
        way = ends[1][None] - ends[0][:, None]
        length = np.linalg.norm(way, axis=2)
        free: Flags = np.ones(length.shape, np.bool_)
        blocked: Flags = np.zeros(length.shape, np.bool_)
        rows, columns = np.indices(length.shape)
        for sign, place, name in ((1, rows, room), (-1, columns, seen_room)):
            ranges = self._around(name, step)
            sides = np.array([[frame(*view)[k] for k in (0, 2)] for view in SIX_SIDES[:4]])
            right, ahead = (np.einsum("nmk,vk->nmv", sign * way, sides[:, k]) for k in range(2))
            view = ahead.argmax(axis=2)
            tangent = np.take_along_axis(right / np.maximum(ahead, 1e-9), view[..., None], 2)
            column = ((tangent[..., 0] + 1) / 2 * STRIP).astype(int)
            met = [
                ranges[place, view, np.clip(column + shift, 0, STRIP - 1)] for shift in (-1, 0, 1)
            ]
            free &= np.min(met, axis=0) > length
            blocked |= np.max(met, axis=0) < length - 0.02
        return free, blocked

    def room(self, seen_room: str, room: str) -> Answer:
        """Seen if straight lines join 2 % of pairs of places, and 8; unseen if they join none.

        A line is free if nothing is nearer than its end in pictures from both ends.
        """
        coarse = self._joined(seen_room, room, 0)
        if coarse is None:
            return "grey"
        if coarse[0].sum() >= max(8, 0.02 * coarse[0].size):
            return "yes"
        fine = self._joined(seen_room, room, 4)
        return "no" if fine is not None and fine[1].all() and coarse[1].all() else "grey"
