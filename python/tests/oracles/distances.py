"""Distances by clouds: what is near, far, closer, above, next to and between others."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, all_of, at_least, at_most
from oracles.outlines import area, gap, nearest_on, over, shared
from oracles.places import same_room
from oracles.scene import Cloud, Scene, clear


def _apart(one: Cloud, other: Cloud) -> float:
    upright = max(0.0, float(one.low[1] - other.high[1]), float(other.low[1] - one.high[1]))
    return float(np.hypot(gap(one.outline, other.outline), upright))


def near(scene: Scene, a: str, b: str) -> Answer:
    """Gaps of outlines of clouds, margin 0.03 m and half a pixel."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    margin = 0.03 + (one.spacing + other.spacing) / 2
    return all_of(at_most(_apart(one, other), 1.2, margin), same_room(scene, a, b))


def far(scene: Scene, a: str, b: str) -> Answer:
    """As of near."""
    if not clear(scene, a, b):
        return "grey"
    return at_least(_apart(scene.cloud(a), scene.cloud(b)), 3.7, 0.05)


def closer_to(scene: Scene, a: str, near: str, far: str) -> Answer:
    """Gaps of outlines, of which the ratio decides; margin of each 0.03 m and half a pixel."""
    if not clear(scene, a, near, far):
        return "grey"
    one = scene.cloud(a)
    others = [scene.cloud(name) for name in (near, far)]
    close, wide = (_apart(one, other) for other in others)
    margins = [0.03 + (one.spacing + other.spacing) / 2 for other in others]
    return at_least(wide - 1.1 * close, 0.0, margins[1] + 1.1 * margins[0])


def above(scene: Scene, a: str, b: str) -> Answer:
    """Lowest and highest points, margin 0.01 m; outlines, margin 0.06 of the smaller."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    smaller = min(area(one.outline), area(other.outline))
    common = area(shared(one.outline, other.outline)) / max(smaller, 1e-9)
    return all_of(
        at_least(float(one.low[1] - other.high[1]), 0.03, 0.01),
        at_least(common, 1 / 3, 0.06),
        same_room(scene, a, b),
    )


def next_to(scene: Scene, a: str, b: str) -> Answer:
    """Gaps of outlines, margin 0.03 m, and common heights, margin 0.06; grey where one may carry.

    Whether one carries or holds the other is not asked: outlines that overlap are grey or, by more
    than half, ``no``.
    """
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    common = min(one.high[1], other.high[1]) - max(one.low[1], other.low[1])
    lower = min(one.high[1] - one.low[1], other.high[1] - other.low[1])
    smaller = min(area(one.outline), area(other.outline))
    overlap = area(shared(one.outline, other.outline)) / max(smaller, 1e-9)
    return all_of(
        at_most(gap(one.outline, other.outline), 0.5, 0.03 + (one.spacing + other.spacing) / 2),
        at_least(float(common / max(lower, 1e-6)), 0.5, 0.06 + 0.01 / max(float(lower), 1e-3)),
        "yes" if overlap < 0.02 else "no" if overlap > 0.56 else "grey",
        same_room(scene, a, b),
    )


def between(scene: Scene, a: str, b: str, c: str) -> Answer:
    """Directions from the middle to the nearest points of outlines; margin 5 degrees."""
    one, others = scene.cloud(a), [scene.cloud(name) for name in (b, c)]
    if not clear(scene, a, b, c):
        return "grey"
    middle = one.middle[[0, 2]]
    answers: list[Answer] = [same_room(scene, a, b, c)]
    ways = []
    for cloud in others:
        nearest = nearest_on(cloud.outline, middle) - middle
        away = float(np.linalg.norm(nearest))
        if over(cloud.outline, middle):
            return "no" if away > 0.02 else "grey"
        if away < 0.02:
            return "grey"
        ways.append(nearest / away)
    angle = float(np.rad2deg(np.arccos(np.clip(ways[0] @ ways[1], -1, 1))))
    answers.append(at_least(angle, 135.0, 5.0))
    # Beside or between them in height, at least with a part of it.
    answers.append(at_most(float(one.low[1] - max(c.high[1] for c in others)), 0.0, 0.02))
    answers.append(at_most(float(min(c.low[1] for c in others) - one.high[1]), 0.0, 0.02))
    return all_of(*answers)
