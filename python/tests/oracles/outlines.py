"""Convex outlines from above, and the nearest of sets of points."""

from __future__ import annotations

import numpy as np

from oracles.scans import Floats


def area(corners: Floats) -> float:
    """The area of a polygon."""
    if len(corners) < 3:
        return 0.0
    x, z = corners.T
    return float(abs(x @ np.roll(z, -1) - z @ np.roll(x, -1)) / 2)


def shared(one: Floats, other: Floats) -> Floats:
    """The corners of what two convex polygons have in common."""
    x, z = other.T
    if x @ np.roll(z, -1) < z @ np.roll(x, -1):
        other = other[::-1]
    left = one
    for start, end in zip(other, np.roll(other, -1, axis=0), strict=True):
        if len(left) == 0:
            break
        edge = end - start
        side = edge[0] * (left[:, 1] - start[1]) - edge[1] * (left[:, 0] - start[0])
        kept: list[Floats] = []
        for k, here in enumerate(side):
            before = side[k - 1]
            if (here >= 0) != (before >= 0):
                part = before / (before - here)
                kept.append(left[k - 1] + part * (left[k] - left[k - 1]))
            if here >= 0:
                kept.append(left[k])
        left = np.array(kept).reshape(-1, 2)
    return left


def nearest_on(corners: Floats, point: Floats) -> Floats:
    """The point of a polygon's border that is nearest to a point."""
    edge = np.roll(corners, -1, axis=0) - corners
    length = np.maximum((edge**2).sum(axis=1), 1e-18)
    part = np.clip(((point - corners) * edge).sum(axis=1) / length, 0.0, 1.0)
    found = corners + part[:, None] * edge
    nearest: Floats = found[((found - point) ** 2).sum(axis=1).argmin()]
    return nearest


def gap(one: Floats, other: Floats) -> float:
    """The distance of two convex polygons; 0 where they overlap."""
    if len(shared(one, other)) > 0:
        return 0.0
    ways = [np.linalg.norm(nearest_on(other, p) - p) for p in one]
    ways += [np.linalg.norm(nearest_on(one, p) - p) for p in other]
    return float(min(ways))


def over(corners: Floats, point: Floats) -> bool:
    """Whether a point lies over a convex polygon."""
    edge = np.roll(corners, -1, axis=0) - corners
    side = edge[:, 0] * (point[1] - corners[:, 1]) - edge[:, 1] * (point[0] - corners[:, 0])
    return bool(np.all(side >= 0) or np.all(side <= 0))


def products(one: Floats, other: Floats) -> Floats:
    """The inner products of all pairs of rows; without threads, which wait for each other."""
    found: Floats = np.einsum("ik,jk->ij", one, other)
    return found


def nearest_pair(one: Floats, other: Floats) -> tuple[float, Floats, Floats]:
    """The smallest distance of two sets of points, and the two points."""
    best = (np.inf, one[0], other[0])
    for start in range(0, len(one), 256):
        part = one[start : start + 256]
        squares = (
            (part**2).sum(axis=1)[:, None] + (other**2).sum(axis=1) - 2 * products(part, other)
        )
        k, m = np.unravel_index(squares.argmin(), squares.shape)
        way = float(np.linalg.norm(part[k] - other[m]))
        if way < best[0]:
            best = (way, part[k], other[m])
    return best


def thinned(points: Floats, most: int) -> Floats:
    """At most so many of the points, evenly."""
    return points[:: max(1, -(-len(points) // most))]
