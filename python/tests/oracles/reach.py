"""Reach by a map of one's own, and by walking there."""

from __future__ import annotations

from typing import Any

import numpy as np

import dwell
from oracles.answers import Answer
from oracles.floors import CELL_M, Floor, grown, steps_from, way_back
from oracles.places import room_of
from oracles.scans import Flags, Ints
from oracles.scene import Scene


class Walk:
    """Where an agent can go on its storey: blocked cells in pictures from all sides."""

    #: How much wider or slimmer than its body something that surely fits, or surely does not, is.
    MARGIN_M = 0.05

    def __init__(self, scene: Scene, agent: dict[str, Any]) -> None:
        """Maps the storey that an agent stands on."""
        self.scene, self.body = scene, agent["body"]
        self.place = np.array(agent["position"])
        height = scene.height_below(float(self.place[1]) + 0.05)
        self.floor: Floor = scene.floor(scene.heights[0] if height is None else height)
        blocked = self.floor.blocked(self.body["step_height_m"] + 0.02, self.body["height_m"])
        radius = float(self.body["radius_m"])
        self.sure = self._from_here(~grown(blocked, radius + self.MARGIN_M))
        self.maybe = self._from_here(~grown(blocked, radius - self.MARGIN_M))

    def _from_here(self, free: Flags) -> Ints:
        row, column = self.floor.cell(self.place)
        spots = np.argwhere(free)
        if len(spots) == 0:
            return np.full(free.shape, -1, np.int32)
        away = np.hypot(*(spots - (row, column)).T) * CELL_M
        start = spots[away.argmin()]
        if away.min() > 0.25:
            return np.full(free.shape, -1, np.int32)
        return steps_from(free, (int(start[0]), int(start[1])))

    def room(self, name: str) -> Answer:
        """Whether a way leads into a room of this storey."""
        number = self.floor.number(name)
        if number < 0:
            return "grey"
        if (self.floor.inner(name) & (self.sure >= 0)).any():
            return "yes"
        if ((self.floor.ids == number) & (self.maybe >= 0)).any() or len(self.scene.heights) > 1:
            return "grey"
        return "no" if (self.maybe >= 0).any() else "grey"

    def _eyes(self, steps: Ints, room: str, name: str, reach: float) -> Flags:
        """Cells of a room from whose eyes a thing is within reach."""
        cloud = self.scene.cloud(name)
        sure = steps is self.sure
        there = self.floor.inner(room) if sure else self.floor.ids == self.floor.number(room)
        spots = np.argwhere((steps >= 0) & there)
        found = np.zeros(steps.shape, np.bool_)
        if len(spots) == 0:
            return found
        flat = (spots[:, ::-1] + 0.5) * CELL_M + self.floor.corner
        height = np.full(len(spots), self.floor.height + float(self.body["eye_height_m"]))
        eyes = np.column_stack((flat[:, 0], height, flat[:, 1]))
        away = np.linalg.norm(
            np.maximum(0, np.maximum(cloud.low - eyes, eyes - cloud.high)), axis=1
        )
        found[tuple(spots[away <= reach].T)] = True
        return found

    def thing(self, name: str) -> Answer:
        """Whether a thing can be reached; margins of radius 0.05 m, of reach 0.12 m."""
        room = room_of(self.scene, name)
        if room is None or self.scene.cloud(name).cut or self.floor.number(room) < 0:
            return "grey"
        reach = float(self.body["reach_m"])
        if self._eyes(self.sure, room, name, reach - 0.12).any():
            return "yes"
        if len(self.scene.heights) > 1 or not (self.maybe >= 0).any():
            return "grey"
        return "grey" if self._eyes(self.maybe, room, name, reach + 0.12).any() else "no"

    def walk_to(self, world: dwell.World, name: str) -> Answer:
        """Walks to where a thing is within reach, step by step; ``grey`` where it gets stuck."""
        room = room_of(self.scene, name)
        if room is None:
            return "grey"
        reach = float(self.body["reach_m"])
        ends = np.argwhere(self._eyes(self.sure, room, name, reach - 0.12))
        if len(ends) == 0:
            return "grey"
        end = min(((int(r), int(c)) for r, c in ends), key=lambda cell: int(self.sure[cell]))
        way = [self.floor.point(*cell) for cell in way_back(self.sure, end)]
        world.place_agent([float(x) for x in self.place])
        at = 0
        for _ in range(2 * len(way) + 60):
            here = np.array(world.agents()[0]["position"])
            while at < len(way) - 1 and np.hypot(*(way[at] - here)[[0, 2]]) < 0.12:
                at += 1
            to = way[at] - here
            away = float(np.hypot(to[0], to[2]))
            if at == len(way) - 1 and away < 0.06:
                break
            speed = min(1.2, away / 0.05)
            # It faces -Z.
            world.step([(-to[2] / max(away, 1e-9) * speed, to[0] / max(away, 1e-9) * speed, 0, 0)])
        here = np.array(world.agents()[0]["position"]) + np.array(
            (0.0, float(self.body["eye_height_m"]), 0.0)
        )
        cloud = self.scene.cloud(name)
        away = float(np.linalg.norm(np.maximum(0, np.maximum(cloud.low - here, here - cloud.high))))
        return "yes" if away <= reach else "grey"
