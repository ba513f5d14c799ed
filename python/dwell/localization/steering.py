"""What an array makes of a plane wave from a direction, and grids of directions."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from dwell.localization.layouts import Layout
from dwell.localization.measures import angles_between_deg

SPEED_M_S = 343.2


def microphones(layout: Layout) -> NDArray[np.float64]:
    """Places of an array's microphones, (front, left, up), m."""
    right, up, back = np.array(layout.microphones, np.float64).reshape(-1, 3).T
    found: NDArray[np.float64] = np.stack((-back, -right, up), axis=1)
    return found


def harmonics(directions: NDArray[np.float64], order: int) -> NDArray[np.float64]:
    """Real spherical harmonics up to an order of 3, ACN, SN3D: (direction, channel).

    As C. Nachbar et al., "ambiX", Ambisonics Symposium (2011), has them.
    """
    x, y, z = directions.T
    rows = [np.ones_like(x), y, z, x]
    if order > 1:
        root = np.sqrt(3.0)
        rows += [root * x * y, root * y * z, 0.5 * (3.0 * z * z - 1.0), root * x * z]
        rows += [0.5 * root * (x * x - y * y)]
    if order > 2:
        outer, inner, root = np.sqrt(5.0 / 8.0), np.sqrt(3.0 / 8.0), np.sqrt(15.0)
        rows += [outer * y * (3.0 * x * x - y * y), root * x * y * z]
        rows += [inner * y * (5.0 * z * z - 1.0), 0.5 * z * (5.0 * z * z - 3.0)]
        rows += [inner * x * (5.0 * z * z - 1.0), 0.5 * root * z * (x * x - y * y)]
        rows += [outer * x * (x * x - 3.0 * y * y)]
    return np.stack(rows, axis=1)


def steering(
    layout: Layout, directions: NDArray[np.float64], hz: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """What each channel hears of a plane wave, of length 1: (frequency, direction, channel)."""
    if layout.kind == "ambisonics":
        found = harmonics(directions, layout.order)[None].astype(complex).repeat(len(hz), axis=0)
    else:
        earlier_s = directions @ microphones(layout).T / SPEED_M_S
        found = np.exp(2j * np.pi * hz[:, None, None] * earlier_s[None])
    unit: NDArray[np.complex128] = found / np.linalg.norm(found, axis=2, keepdims=True)
    return unit


@functools.lru_cache(1)
def sphere() -> NDArray[np.float64]:
    """A thousand directions spread evenly over the sphere (a spiral of equal areas)."""
    k = np.arange(1000)
    up = 1.0 - (2.0 * k + 1.0) / len(k)
    level, turn = np.sqrt(1.0 - up * up), np.pi * (1.0 + np.sqrt(5.0)) * k
    found: NDArray[np.float64] = np.stack((level * np.cos(turn), level * np.sin(turn), up), axis=1)
    return found


@functools.lru_cache(8)
def steering_to_sphere(layout: Layout, hz: tuple[float, ...]) -> NDArray[np.complex128]:
    """As :func:`steering`, to :func:`sphere`."""
    return steering(layout, sphere(), np.array(hz))


def around(direction: NDArray[np.float64], reach_deg: float = 6.0) -> NDArray[np.float64]:
    """Directions a degree apart around one."""
    other = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(direction, other)
    first /= np.linalg.norm(first)
    second = np.cross(direction, first)
    steps = np.tan(np.radians(np.arange(-reach_deg, reach_deg + 0.5)))
    u, v = (grid.ravel()[:, None] for grid in np.meshgrid(steps, steps))
    found: NDArray[np.float64] = direction + u * first + v * second
    unit: NDArray[np.float64] = found / np.linalg.norm(found, axis=1, keepdims=True)
    return unit


def peaks(
    directions: NDArray[np.float64],
    scores: NDArray[np.float64],
    count: int,
    apart_deg: float = 20.0,
) -> NDArray[np.float64]:
    """The directions of the highest scores, each so far from the others: (at most count, 3)."""
    left, found = scores.astype(np.float64).copy(), []
    for _ in range(count):
        best = int(np.argmax(left))
        if not np.isfinite(left[best]):
            break
        found.append(directions[best])
        near = angles_between_deg(directions, directions[best][None])[:, 0] < apart_deg
        left[near] = -np.inf
    return np.array(found).reshape(-1, 3)
