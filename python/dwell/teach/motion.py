"""How hands move: along straight lines and low arcs, with the least jerk.

T. Flash, N. Hogan, "The coordination of arm movements: an experimentally confirmed mathematical
model", J. Neurosci. 5 (1985) 1688: between two points at rest a hand goes the part
10 s^3 - 15 s^4 + 6 s^5 of the way after the part s of the time.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Point = NDArray[np.float64]


def minimum_jerk(part: float) -> float:
    """How much of the way is done after a part of the time, both 0 to 1."""
    s = min(max(part, 0.0), 1.0)
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@dataclasses.dataclass(frozen=True)
class Stroke:
    """A movement from one rest to the next.

    Attributes:
        start_s: When it begins.
        end_s: When it ends.
        to: Where it ends, m.
        arc_m: How much higher than the straight line its middle is.
    """

    start_s: float
    end_s: float
    to: Point
    arc_m: float = 0.0


class HandPath:
    """Where a hand is at each time."""

    def __init__(self, start: Sequence[float] | Point, strokes: Sequence[Stroke]) -> None:
        """Joins strokes, the earlier first; before, between and after them the hand rests."""
        self._start = np.asarray(start, np.float64)
        self._strokes = [*strokes]

    def at(self, time_s: float) -> Point:
        """The place of the hand, m."""
        place = self._start
        for stroke in self._strokes:
            if time_s <= stroke.start_s:
                break
            length_s = max(stroke.end_s - stroke.start_s, 1e-9)
            done = minimum_jerk((time_s - stroke.start_s) / length_s)
            rise = np.array([0.0, 4.0 * stroke.arc_m * done * (1.0 - done), 0.0])
            place = place + done * (stroke.to - place) + rise
        return place
