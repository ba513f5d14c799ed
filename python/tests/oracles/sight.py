"""Sides and sight by pictures: where masks lie in a viewer's picture, and what it shows."""

from __future__ import annotations

import dataclasses

import numpy as np

from oracles.answers import Answer, Viewer, all_of, at_least, azimuth
from oracles.scans import Floats, View, frame
from oracles.scene import Scene


@dataclasses.dataclass(frozen=True)
class _Mask:
    """A thing in a viewer's picture."""

    answer: Answer
    left: float = 0.0
    right: float = 0.0
    middle: float = 0.0
    near: float = 0.0
    far: float = 0.0
    median: float = 0.0


def _mask(scene: Scene, viewer: Viewer, name: str, most_hidden: float) -> _Mask:
    glimpse = scene.glimpse(viewer.place, name)
    if glimpse.cut or glimpse.pixels < 9 or glimpse.hidden > most_hidden:
        return _Mask("grey")
    side = azimuth(viewer, glimpse.directions)
    if np.abs(side).max() > 74:
        return _Mask("void" if np.abs(side).min() > 80 else "grey")
    right, ahead = viewer.seen_from(glimpse.directions)
    tangents = right / ahead
    _, depth = viewer.seen_from(glimpse.points - viewer.place)
    low, high = float(tangents.min()), float(tangents.max())
    # Pixels of a narrow picture are even enough for a centroid.
    middle = (float(tangents.mean()) + (low + high) / 2) / 2
    return _Mask(
        "yes", low, high, middle, float(depth.min()), float(depth.max()), float(np.median(depth))
    )


def left_by_masks(scene: Scene, viewer: Viewer, a: str, b: str) -> Answer:
    """Centroids of masks in the picture; margin a fifth of both widths, 0.01 at least.

    A mask's centroid is not the picture of the middle: a thing's nearer half is larger there.
    """
    one, other = (_mask(scene, viewer, name, 0.1) for name in (a, b))
    if "void" in (one.answer, other.answer):
        return "void"
    if "grey" in (one.answer, other.answer):
        return "grey"
    margin = 0.01 + 0.2 * (one.right - one.left + other.right - other.left)
    return at_least(other.middle - one.middle, 0.035, margin)


def before_by_masks(scene: Scene, viewer: Viewer, a: str, b: str) -> Answer:
    """Medians of depth and columns of masks; margins: the halves of both depths, 0.12 of widths."""
    one, other = (_mask(scene, viewer, name, 0.15) for name in (a, b))
    if "void" in (one.answer, other.answer):
        return "void"
    if "grey" in (one.answer, other.answer):
        return "grey"
    margin = 0.03 + (one.far - one.near + other.far - other.near) / 2
    common = min(one.right, other.right) - max(one.left, other.left)
    narrower = min(one.right - one.left, other.right - other.left)
    return all_of(
        at_least(other.median - one.median, 0.1, margin),
        at_least(common / max(narrower, 1e-6), 1 / 3, 0.12),
    )


def seen(scene: Scene, eye: Floats, name: str, look: View | None) -> Answer:
    """Pixels that show a thing, all around or in a square picture of 90 degrees from somewhere.

    Seen if a third of it is, and 12 pixels; unseen if no pixel shows it and no glass is about.
    Between these a sight of some of it may or may not be among the rays of the definition.
    """
    glimpse = scene.glimpse(eye, name)
    if glimpse.cut and glimpse.pixels == 0:
        return "grey"
    count = glimpse.pixels
    if look is not None and count:
        right, up, ahead = (glimpse.directions @ axis for axis in frame(*look))
        # How far beyond the edge of the picture, as a share of half its width; behind it far.
        beyond = np.where(ahead > 0.01, np.maximum(abs(right), abs(up)) / ahead.clip(0.01), 100.0)
        count = int((beyond < 1).sum())
        if count == 0:
            return "no" if beyond.min() > 1.02 and not glimpse.glazed else "grey"
    if count == 0:
        return "grey" if glimpse.glazed else "no"
    share = (1 - glimpse.hidden) * count / glimpse.pixels
    return "yes" if share >= 1 / 3 and count >= 12 else "grey"
