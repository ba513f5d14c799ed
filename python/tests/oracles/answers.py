"""What oracles answer, how answers and margins combine, and who looks."""

from __future__ import annotations

import dataclasses
from typing import Any, Literal

import numpy as np

from oracles.scans import Floats, frame

#: ``void``: the question makes no sense here. ``grey``: the oracle cannot decide.
Answer = Literal["yes", "no", "void", "grey"]


def all_of(*answers: Answer) -> Answer:
    """Whether all hold; one that does not is enough for ``no``."""
    for answer in ("void", "no", "grey"):
        if answer in answers:
            return answer
    return "yes"


def negated(answer: Answer) -> Answer:
    turned: dict[Answer, Answer] = {"yes": "no", "no": "yes"}
    return turned.get(answer, answer)


def any_of(*answers: Answer) -> Answer:
    """Whether one of them holds, at least."""
    return negated(all_of(*(negated(answer) for answer in answers)))


def at_most(value: float, limit: float, margin: float) -> Answer:
    """Whether a value is at most a limit."""
    return "grey" if abs(value - limit) < margin else "yes" if value < limit else "no"


def at_least(value: float, limit: float, margin: float) -> Answer:
    return negated(at_most(value, limit, margin))


def ratio_at_least(value: float, other: float, limit: float, margin: float) -> Answer:
    return "grey" if min(value, other) <= 0 else at_least(value / other, limit, margin)


@dataclasses.dataclass(frozen=True)
class Viewer:
    """Somebody who looks."""

    eye: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float

    @property
    def asked(self) -> dict[str, Any]:
        """As :meth:`dwell.World.holds` takes it."""
        return {"position": self.eye, "yaw_deg": self.yaw_deg, "pitch_deg": self.pitch_deg}

    @property
    def place(self) -> Floats:
        """The eye."""
        return np.array(self.eye)

    def seen_from(self, directions: Floats) -> tuple[Floats, Floats]:
        """How far to the right and how far ahead, pitch left aside."""
        right, _, ahead = frame(self.yaw_deg, 0.0)
        return directions @ right, directions @ ahead


def azimuth(viewer: Viewer, directions: Floats) -> Floats:
    found: Floats = np.rad2deg(np.arctan2(*viewer.seen_from(directions)))
    return found
