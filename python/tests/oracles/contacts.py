"""Contacts by clouds: what is under, against and touching others."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer
from oracles.outlines import area, nearest_on, nearest_pair, over, shared, thinned
from oracles.scans import Floats, scan
from oracles.scene import Cloud, Scene, clear


def _covered(scene: Scene, a: str, b: str) -> tuple[float, bool]:
    """The part of a's sole that is under b, by a common grid, and whether it may rest on b."""
    one, other = scene.cloud(a), scene.cloud(b)
    cell = max(0.01, 1.6 * max(one.spacing, other.spacing))
    sole = scene.sole(a)
    if len(sole) < 4:
        return np.nan, True

    def cells(points: Floats) -> list[tuple[int, int]]:
        return [(x, z) for x, z in np.floor(points[:, [0, 2]] / cell).astype(int).tolist()]

    mine = cells(sole)
    over_it = set(cells(other.points[other.points[:, 1] > one.middle[1]]))
    at_foot = set(cells(other.points[np.abs(other.points[:, 1] - one.low[1]) < 0.04]))
    part, resting = (sum(key in there for key in mine) / len(mine) for there in (over_it, at_foot))
    return part, resting > 0.1


def _walled(one: Cloud, other: Cloud) -> int:
    """On how many of four sides points of the other are beside one's middle."""
    way = other.points - one.middle
    pixel = 1.5 * other.spacing
    high = np.abs(way[:, 1]) < pixel
    found = 0
    for along, across in ((0, 2), (2, 0)):
        there = way[high & (np.abs(way[:, across]) < pixel), along]
        found += int(bool((there > 0).any())) + int(bool((there < 0).any()))
    return found


def under(scene: Scene, a: str, b: str) -> Answer:
    """What is over the sole, seen from above, in clouds; between 0.2 and 0.67 of it is grey.

    Legs may be open below and slant, so that faces and what they cover differ much.
    """
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    mine, rests = _covered(scene, a, b)
    theirs, _ = _covered(scene, b, a)
    if np.isnan(mine + theirs):
        return "grey"
    if mine < 0.2:
        return "no"
    if theirs > mine - 0.1:
        return "no" if theirs > mine + 0.1 else "grey"
    # Within the other's height it may lie in it, as on a shelf.
    if rests or one.low[1] > other.low[1] + 0.03 or _walled(one, other) >= 3:
        return "grey"
    return "yes" if mine > 0.67 else "grey"


def _border(corners: Floats, step_m: float) -> Floats:
    """Points on a polygon's border, evenly."""
    found = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        count = max(1, round(float(np.linalg.norm(end - start)) / step_m))
        found.append(start + (np.arange(count)[:, None] + 0.5) / count * (end - start))
    return np.concatenate(found)


def against(scene: Scene, a: str, b: str) -> Answer:
    """How much of the outline is near the other's; margins a quarter, of heights 0.06.

    A wall, ``structure:ID``, is what is met of it around the thing. Whether the thing lies on or
    in the other is not asked: grey where outlines overlap.
    """
    one = scene.cloud(a)
    if one.cut:
        return "grey"
    step = 0.005
    border = _border(one.outline, step)
    tall = float(one.high[1] - one.low[1])
    if b.startswith("structure:"):
        reach = np.array((0.1, 0.0, 0.1))
        low, high = one.low - reach, one.high + reach
        if tall < 0.02:
            return "grey"
        ids, points = scan(scene.world, low, high, max(0.008, float((high - low).max()) / 60))
        points = points[ids == int(b[10:])]
        if len(points) < 4:
            # A slim thing's end may be near a wall that another one hides.
            return "no" if one.edges[1] > 0.15 else "grey"
        flat = thinned(points[:, [0, 2]], 3000)
        away = np.sqrt(((border[:, None] - flat) ** 2).sum(axis=2).min(axis=1))
        shared_height = float(np.ptp(points[:, 1]))
        margin = 0.02
        overlap, high_enough = 0.0, True
    else:
        other = scene.cloud(b)
        if other.cut:
            return "grey"
        away = np.array(
            [
                0.0 if over(other.outline, p) else np.linalg.norm(nearest_on(other.outline, p) - p)
                for p in border
            ]
        )
        shared_height = float(min(one.high[1], other.high[1]) - max(one.low[1], other.low[1]))
        height = float(other.high[1] - other.low[1])
        if abs(height / max(tall, 1e-6) - 0.5) < 0.06:
            return "grey"
        margin = 0.01
        overlap = area(shared(one.outline, other.outline))
        high_enough = height > tall / 2
    if not high_enough or shared_height < 0.44 * tall:
        return "no"
    narrower = max(one.edges[1], 0.01)
    # Few with a wide gap, and with a slim one enough.
    most = float((away <= 0.06 + margin).sum()) * len(border) ** -1 * _length(one.outline)
    least = float((away <= 0.06 - margin).sum()) * len(border) ** -1 * _length(one.outline)
    if most < 0.5 * narrower * 0.75:
        return "no"
    if overlap > 0.05 * max(area(one.outline), 1e-6) or shared_height < 0.56 * tall:
        return "grey"
    return "yes" if least > 0.5 * narrower * 1.25 else "grey"


def _length(corners: Floats) -> float:
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum())


def touching(scene: Scene, a: str, b: str) -> Answer:
    """The nearest points of two clouds, with a closer look at where they are; margin 2 pixels."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    if np.any(one.low - other.high > 0.03) or np.any(other.low - one.high > 0.03):
        return "no"
    # Where both may be, within 2 cm.
    low, high = np.maximum(one.low, other.low) - 0.02, np.minimum(one.high, other.high) + 0.02
    numbers = scene.rows[a]["id"], scene.rows[b]["id"]
    fine = max(0.002, float((high - low).max()) / 90)
    ids, points = scan(scene.world, low, high, fine)
    clouds = []
    for thing, number in zip((one, other), numbers, strict=True):
        there = np.all((thing.points > low) & (thing.points < high), axis=1)
        clouds.append(np.concatenate((points[ids == number], thing.points[there])))
    if min(len(cloud) for cloud in clouds) == 0:
        return "no" if fine < 0.01 else "grey"
    way, p, q = nearest_pair(*(thinned(cloud, 4000) for cloud in clouds))
    if way > 0.02 + 3 * fine:
        return "no"
    for half in (0.06, 0.03):
        middle = (p + q) / 2
        ids, points = scan(scene.world, middle - half, middle + half, half / 30, 2)
        mine, theirs = (points[ids == number] for number in numbers)
        if len(mine) == 0 or len(theirs) == 0:
            return "grey"
        way, p, q = nearest_pair(thinned(mine, 2500), thinned(theirs, 2500))
    # The nearest points are pixels; surfaces may be nearer, no further.
    return "yes" if way < 0.0095 else "no" if way > 0.015 else "grey"
