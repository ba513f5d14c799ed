"""Sides by clouds: what is left of, before and faced by a viewer."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, Viewer, all_of, at_least, at_most, azimuth
from oracles.places import room_of
from oracles.scene import Scene


def _ahead(scene: Scene, viewer: Viewer, name: str) -> Answer:
    side = abs(float(azimuth(viewer, (scene.cloud(name).middle - viewer.place)[None])[0]))
    if scene.cloud(name).cut:
        return "grey"
    return "grey" if 72 < side < 78 else "yes" if side < 75 else "void"


def left_by_clouds(scene: Scene, viewer: Viewer, a: str, b: str) -> Answer:
    """The directions to the middles of clouds; margin 0.008 and 3 % of the widths."""
    answers = [_ahead(scene, viewer, name) for name in (a, b)]
    if "void" in answers or "grey" in answers:
        return "void" if "void" in answers else "grey"
    places, margin = [], 0.008
    for name in (a, b):
        cloud = scene.cloud(name)
        right, ahead = viewer.seen_from((cloud.middle - viewer.place)[None])
        if ahead[0] < 0.15:
            return "grey"
        places.append(float(right[0] / ahead[0]))
        level = float(np.linalg.norm((cloud.high - cloud.low)[[0, 2]]))
        margin += (0.03 * level + 0.004) / float(ahead[0]) * (1 + abs(places[-1]))
    return at_least(places[1] - places[0], 0.035, margin)


def before_by_clouds(scene: Scene, viewer: Viewer, a: str, b: str) -> Answer:
    """Depths of middles, margin 0.03 m, and columns of clouds, margin 0.07 of the narrower."""
    answers = [_ahead(scene, viewer, name) for name in (a, b)]
    if "void" in answers or "grey" in answers:
        return "void" if "void" in answers else "grey"
    depths, columns = [], []
    for name in (a, b):
        cloud = scene.cloud(name)
        right, ahead = viewer.seen_from(cloud.points - viewer.place)
        depths.append(float(viewer.seen_from((cloud.middle - viewer.place)[None])[1][0]))
        # What reaches beside or behind the viewer has no columns.
        if ahead.min() < 0.1:
            columns.append((np.nan, np.nan))
        else:
            tangents = right / ahead
            pixel = cloud.spacing / 2 / depths[-1]
            columns.append((float(tangents.min()) - pixel, float(tangents.max()) + pixel))
    nearer = at_least(depths[1] - depths[0], 0.1, 0.03)
    if nearer == "no":
        return "no"
    common = min(columns[0][1], columns[1][1]) - max(columns[0][0], columns[1][0])
    narrower = min(end - start for start, end in columns)
    if np.isnan(common + narrower):
        return "grey"
    return all_of(nearer, at_least(common / narrower, 1 / 3, 0.07))


def before_by_boxes(scene: Scene, viewer: Viewer, a: str, b: str) -> Answer:
    """As by clouds, by the corners of upright boxes along the world's axes: to tell causes."""
    columns = []
    for name in (a, b):
        row = scene.rows[name]
        middle, size = np.array(row["center"]), np.array(row["size"])
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        right, ahead = viewer.seen_from(middle + (corners - 0.5) * size - viewer.place)
        tangents = np.clip(right / np.maximum(ahead, 0.05), -3.73, 3.73)
        columns.append((float(tangents.min()), float(tangents.max())))
    common = min(columns[0][1], columns[1][1]) - max(columns[0][0], columns[1][0])
    narrower = min(end - start for start, end in columns)
    return "yes" if common >= narrower / 3 * 0.97 else "no"


def facing(scene: Scene, viewer: Viewer, name: str, room: str | None) -> Answer:
    """Whether an agent faces a thing of its room: 30 degrees, margin 1."""
    cloud = scene.cloud(name)
    if cloud.cut or room is None:
        return "grey"
    found = room_of(scene, name)
    side = abs(float(azimuth(viewer, (cloud.middle - viewer.place)[None])[0]))
    same: Answer = "grey" if found is None else "yes" if found == room else "no"
    return all_of(same, at_most(side, 30.0, 1.0))
