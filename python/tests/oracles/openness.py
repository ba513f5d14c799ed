"""Openness by how a moved part looks."""

from __future__ import annotations

import numpy as np

import dwell
from oracles.outlines import products, thinned
from oracles.scans import Floats, scan


def openness(world: dwell.World, name: str) -> float | None:
    """How far the joint of a thing that is open widest is open, by comparing scans.

    Each joint is tried shut, open by 6 %, a quarter, half, three quarters and all; the nearest
    scan tells. The world is left as it was.
    """
    rows = [row for row in world.joints() if row["object"] == name]
    if not rows or len(rows) > 3:
        return None
    start = world.snapshot()
    number = world.object(name)["id"]
    parts = (0.0, 0.06, 0.25, 0.5, 0.75, 1.0)
    widest = 0.0
    for row in rows:
        low, high = row["limits"]
        if not -1e-6 <= low <= 1e-6 and not -1e-6 <= high <= 1e-6:
            return None
        end = high if abs(high) > abs(low) else low
        boxes = [world.object(name)]
        for part in parts:
            world.set_joints({row["id"]: (part * end, 0.0)})
            boxes.append(world.object(name))
        ends = [
            (
                np.array(box["center"]) - np.array(box["size"]) / 2 - 0.02,
                np.array(box["center"]) + np.array(box["size"]) / 2 + 0.02,
            )
            for box in boxes
        ]
        box_low, box_high = np.min([e[0] for e in ends], 0), np.max([e[1] for e in ends], 0)
        spacing = float((box_high - box_low).max() / 48)

        def look(low: Floats = box_low, high: Floats = box_high, pixel: float = spacing) -> Floats:
            ids, points = scan(world, low, high, pixel, 1)
            mine: Floats = points[ids == number]
            return mine

        world.restore(start)
        now = look()
        ways = []
        for part in parts:
            world.set_joints({row["id"]: (part * end, 0.0)})
            ways.append(_unlike(now, look()))
        world.restore(start)
        widest = max(widest, parts[int(np.argmin(ways))])
    return widest


def _unlike(one: Floats, other: Floats) -> float:
    """The mean distance from points of each to the nearest of the other."""
    if len(one) == 0 or len(other) == 0:
        return np.inf
    one, other = thinned(one, 1500), thinned(other, 1500)
    squares = (one**2).sum(1)[:, None] + (other**2).sum(1) - 2 * products(one, other)
    ways = np.sqrt(np.maximum(squares, 0))
    return float(ways.min(0).mean() + ways.min(1).mean())
