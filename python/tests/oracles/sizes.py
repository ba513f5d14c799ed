"""Sizes by clouds: what is taller, wider and larger."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, ratio_at_least
from oracles.scene import Cloud, Scene, clear


def taller(scene: Scene, a: str, b: str) -> Answer:
    """Heights of clouds; margin 3 % and a pixel."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    mine, theirs = (float(c.high[1] - c.low[1]) for c in (one, other))
    if min(mine, theirs) < 0.004:
        return "grey"
    margin = 0.03 + one.spacing / mine * 0.3 + other.spacing / theirs * 0.3
    return ratio_at_least(mine, theirs, 1.1, margin)


def _level_edges(cloud: Cloud) -> tuple[float, float]:
    return cloud.edges[0] + cloud.spacing * 0.5, cloud.edges[1] + cloud.spacing * 0.5


def wider(scene: Scene, a: str, b: str) -> Answer:
    """The longer edges of the smallest rectangles from above; margin 6 %."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    return ratio_at_least(_level_edges(one)[0], _level_edges(other)[0], 1.1, 0.06)


def larger(scene: Scene, a: str, b: str) -> Answer:
    """Volumes of the smallest upright boxes; margin a sixth."""
    one, other = scene.cloud(a), scene.cloud(b)
    if not clear(scene, a, b):
        return "grey"
    sizes = [(*_level_edges(c), float(c.high[1] - c.low[1])) for c in (one, other)]
    if min(min(size) for size in sizes) < 0.008:
        return "grey"
    return ratio_at_least(float(np.prod(sizes[0])), float(np.prod(sizes[1])), 1.331, 0.22)
