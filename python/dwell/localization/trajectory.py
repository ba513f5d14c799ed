"""Where something is over time: at a place, or on a way at a constant speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.listening import Point


@dataclass(frozen=True)
class Trajectory:
    """Corners and when they are passed; before the first and after the last it stands still.

    Attributes:
        points: Corners, m.
        times_s: When each is passed, rising.
        yaw_deg: Where it faces at the beginning, positive to the left.
        yaw_rate_deg_s: How fast it turns to the left.
    """

    points: tuple[Point, ...]
    times_s: tuple[float, ...]
    yaw_deg: float = 0.0
    yaw_rate_deg_s: float = 0.0

    @classmethod
    def along(
        cls,
        corners: NDArray[np.float64],
        speed_m_s: float,
        start_s: float,
        *,
        yaw_deg: float = 0.0,
        yaw_rate_deg_s: float = 0.0,
    ) -> Trajectory:
        """A way at a constant speed from a moment on."""
        legs = np.linalg.norm(np.diff(corners, axis=0), axis=1)
        kept = np.concatenate(([True], legs > 1e-6))
        times = start_s + np.concatenate(([0.0], np.cumsum(legs))) / speed_m_s
        points = tuple((float(x), float(y), float(z)) for x, y, z in corners[kept])
        return cls(points, tuple(map(float, times[kept])), yaw_deg, yaw_rate_deg_s)

    @property
    def moves(self) -> bool:
        """Whether it is elsewhere or faces elsewhere later."""
        return len(self.points) > 1 or self.yaw_rate_deg_s != 0.0

    def positions(self, times_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places at some moments, shape (moment, 3), m."""
        corners = np.array(self.points)
        return np.stack(
            [np.interp(times_s, self.times_s, corners[:, axis]) for axis in range(3)], axis=1
        )

    def yaws_deg(self, times_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where it faces at some moments, degrees."""
        return self.yaw_deg + self.yaw_rate_deg_s * np.asarray(times_s)

    def to_json(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "points": [list(point) for point in self.points],
            "times_s": list(self.times_s),
            "yaw_deg": self.yaw_deg,
            "yaw_rate_deg_s": self.yaw_rate_deg_s,
        }


def axes(yaw_deg: NDArray[np.float64]) -> NDArray[np.float64]:
    """Front, left and up of what faces somewhere: shape (moment, 3, 3), rows the three axes."""
    yaw = np.radians(yaw_deg)
    s, c, zero, one = np.sin(yaw), np.cos(yaw), np.zeros_like(yaw), np.ones_like(yaw)
    front, left, up = (-s, zero, -c), (-c, zero, s), (zero, one, zero)
    return np.stack([np.stack(axis, axis=-1) for axis in (front, left, up)], axis=-2)


def seen_from(
    listener: Trajectory, source: Trajectory, times_s: Sequence[float] | NDArray[np.floating[Any]]
) -> NDArray[np.float64]:
    """A source in the listener's axes (front, left, up), shape (moment, 3), m."""
    times = np.asarray(times_s, np.float64)
    away = source.positions(times) - listener.positions(times)
    found: NDArray[np.float64] = np.einsum("tij,tj->ti", axes(listener.yaws_deg(times)), away)
    return found
