"""Places by floors: rooms and storeys of things, and the sizes of rooms."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, all_of, at_most, ratio_at_least
from oracles.floors import CELL_M
from oracles.scene import Scene


def room_of(scene: Scene, name: str) -> str | None:
    """The room under a thing's middle; ``None`` where that is not clear."""
    middle = scene.cloud(name).middle
    height = scene.height_below(float(middle[1]))
    if height is None or middle[1] > height + 2.8:
        return None
    return scene.floor(height).room_at(middle)


def in_room(scene: Scene, name: str, room: str) -> Answer:
    """The floor under the middle in a picture from above; margin 0.05 m."""
    found = room_of(scene, name)
    if found is not None:
        return "yes" if found == room else "no"
    middle = scene.cloud(name).middle
    height = next(float(row["floor_y"]) for row in scene.rooms if row["name"] == room)
    if scene.floor(round(height, 2)).is_outside(middle, room) or middle[1] < height - 0.4:
        return "no"
    return "grey"


def same_room(scene: Scene, *names: str) -> Answer:
    """Whether things are in one room."""
    rooms = [room_of(scene, name) for name in names]
    if len({room for room in rooms if room is not None}) > 1:
        return "no"
    return "grey" if None in rooms else "yes"


def on_storey(scene: Scene, name: str, number: int) -> Answer:
    """The highest floor below a thing's foot, counted from below; margin 0.1 m about 0.3 m."""
    foot = float(scene.cloud(name).low[1])
    if any(abs(height - 0.3 - foot) < 0.1 for height in scene.heights):
        return "grey"
    below = sum(height - 0.3 < foot for height in scene.heights) - 1
    return "yes" if below == number else "no"


def larger_room(scene: Scene, a: str, b: str) -> Answer:
    """Floors' cells, which reach into walls; margin 0.15."""
    counts = []
    for name in (a, b):
        height = next(float(row["floor_y"]) for row in scene.rooms if row["name"] == name)
        floor = scene.floor(round(height, 2))
        counts.append(int((floor.ids == floor.number(name)).sum()))
    return ratio_at_least(counts[0], counts[1], 1.21, 0.15)


def in_middle_of(scene: Scene, name: str, room: str) -> Answer:
    """The middle third of the box around the floor's cells, margin 0.1 m; level rooms alone."""
    middle = scene.cloud(name).middle
    inside = in_room(scene, name, room)
    if inside != "yes":
        return inside
    floor = scene.floor(scene.height_below(float(middle[1])) or 0.0)
    cells = np.argwhere(floor.ids == floor.number(room))
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    part = ((middle[[2, 0]] - floor.corner[::-1]) / CELL_M - low) / (high - low)
    margins = 0.1 / CELL_M / (high - low)
    return all_of(*(at_most(abs(x - 0.5), 1 / 6, m) for x, m in zip(part, margins, strict=True)))
