"""What may be hidden in a case."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Literal

__all__ = ["Effect", "Kind", "Values"]

#: Hidden parameters by effect.
Values = Mapping[str, tuple[float, ...]]
#: ``library``: a law that the engines have; ``fault``: of the measurement; ``outside``: neither.
Kind = Literal["library", "fault", "outside"]


@dataclasses.dataclass(frozen=True)
class Effect:
    """A cause.

    Attributes:
        id: Its name, as ``dwell calibrate`` has it where it can name it.
        kind: Whose it is.
        parameters: Names; the strength is the first one's distance from ``neutral``.
        bounds: The least and the largest strength where ``neutral`` is 0, else the least and the
            largest value of the first parameter.
        neutral: The value with which nothing differs.
        two_sided: Whether it may be negative where ``neutral`` is 0.
    """

    id: str
    kind: Kind
    parameters: tuple[str, ...]
    bounds: tuple[float, float]
    neutral: float = 0.0
    two_sided: bool = False

    def signs(self) -> tuple[float, ...]:
        """The signs that its strength may have."""
        return (1.0, -1.0) if self.two_sided or self.neutral != 0.0 else (1.0,)

    def value(self, strength: float) -> tuple[float, ...]:
        """The parameters at a signed strength."""
        return (self.neutral + strength,)

    def clipped(self, strength: float) -> float:
        """A signed strength, brought to at most the largest that occurs."""
        low, high = self.bounds
        if self.neutral == 0.0:
            return min(max(strength, -high), high)
        return min(max(strength, low - self.neutral), high - self.neutral)

    def within(self, strength: float) -> bool:
        """Returns whether a signed strength is one that occurs."""
        low, high = self.bounds
        if self.neutral == 0.0:
            return low <= abs(strength) <= high and (strength > 0.0 or self.two_sided)
        return low <= self.neutral + strength <= high
