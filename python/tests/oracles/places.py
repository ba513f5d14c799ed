"""Places by floors: rooms and storeys of things, and the sizes of rooms."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, Viewer, all_of, at_least, at_most, ratio_at_least
from oracles.floors import CELL_M
from oracles.scans import Floats
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


def upright_box(scene: Scene, room: str) -> tuple[Floats, Floats] | None:
    """The least and greatest x and z of a room's floor in m; ``None`` of a room that is turned.

    A room is turned if a rectangle at another angle is smaller by a twentieth or more.
    """
    height = next(float(row["floor_y"]) for row in scene.rooms if row["name"] == room)
    floor = scene.floor(round(height, 2))
    cells = np.argwhere(floor.ids == floor.number(room))[:, ::-1]
    if len(cells) == 0:
        return None
    sizes = []
    for turn in np.deg2rad(np.arange(0.0, 90.0, 3.0)):
        axes = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
        sizes.append(float(np.prod(np.ptp(cells @ axes, axis=0) + 1)))
    if min(sizes) < 0.95 * sizes[0]:
        return None
    return floor.corner + cells.min(axis=0) * CELL_M, floor.corner + (
        cells.max(axis=0) + 1
    ) * CELL_M


def at_end_of(scene: Scene, name: str, room: str, viewer: Viewer | None = None) -> Answer:
    """The outer quarters of the box around the floor's cells, margin 0.12 m; level rooms alone.

    Where the edges differ by less than 0.25 m either may be the longer: grey, if they do not tell
    alike. A viewer's own end is the one on its side of the middle, margin 0.1 m.
    """
    middle = scene.cloud(name).middle
    inside = in_room(scene, name, room)
    if inside != "yes":
        return inside
    box = upright_box(scene, room)
    if box is None:
        return "grey"
    edges = box[1] - box[0]
    part = (middle[[0, 2]] - box[0]) / edges - 0.5
    answers = [
        at_least(abs(float(x)), 0.25, 0.12 / edge) for x, edge in zip(part, edges, strict=True)
    ]
    if viewer is not None:
        height = scene.height_below(float(viewer.place[1]))
        if height is None or scene.floor(height).room_at(viewer.place) != room:
            return "grey"
        here = (viewer.place[[0, 2]] - box[0]) / edges - 0.5
        for axis in range(2):
            # How far the viewer is on the other side of the middle than the thing.
            beyond = -float(here[axis] * np.sign(part[axis]))
            far_end = at_least(beyond, 0.0, 0.1 / float(edges[axis]))
            answers[axis] = all_of(answers[axis], far_end)
    if abs(edges[0] - edges[1]) < 0.25:
        return answers[0] if answers[0] == answers[1] else "grey"
    return answers[int(edges[1] > edges[0])]
