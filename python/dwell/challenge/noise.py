"""Noise of measurements: kinds, lost samples, gross errors."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

__all__ = ["Noise"]

_Array = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Noise:
    """How a channel is measured.

    Attributes:
        kind: ``gaussian``, ``student_t3`` or ``ar1``.
        sd: Its standard deviation, the channel's unit.
        correlation: Of neighbouring samples, for ``ar1``.
        step: Of quantisation, the channel's unit; 0 for none.
        lost: Share of samples that are missing.
        gross: Share of samples that are off by 20 standard deviations.
    """

    kind: str
    sd: float
    correlation: float
    step: float
    lost: float
    gross: float

    @classmethod
    def draw(cls, rng: np.random.Generator, sd: float) -> Noise:
        """Draws a kind: half Gaussian, a quarter with heavy tails, a quarter correlated."""
        kind = str(rng.choice(["gaussian", "student_t3", "ar1"], p=[0.5, 0.25, 0.25]))
        return cls(
            kind=kind,
            sd=sd,
            correlation=float(rng.uniform(0.3, 0.9)) if kind == "ar1" else 0.0,
            step=0.5 * sd if rng.random() < 0.25 else 0.0,
            lost=0.02 if rng.random() < 0.5 else 0.0,
            gross=0.01 if rng.random() < 0.25 else 0.0,
        )

    def add(self, rng: np.random.Generator, clean: _Array) -> _Array:
        """Measures, along the first axis.

        Args:
            rng: Draws it.
            clean: Shape (sample, channel).

        Returns:
            Shape (sample, channel); NaN where a sample is lost, in all channels.
        """
        shape = clean.shape
        if self.kind == "student_t3":
            # Of variance 1.
            noise = rng.standard_t(3, shape) / np.sqrt(3.0)
        else:
            noise = rng.standard_normal(shape)
        for k in range(1, len(noise) if self.kind == "ar1" else 0):
            fresh = np.sqrt(1.0 - self.correlation**2)
            noise[k] = self.correlation * noise[k - 1] + fresh * noise[k]
        gross = rng.random(shape) < self.gross
        noise += np.where(gross, 20.0 * rng.choice([-1.0, 1.0], shape), 0.0)
        seen: _Array = clean + self.sd * noise
        if self.step > 0.0:
            seen = self.step * np.rint(seen / self.step)
        lost = rng.random(len(seen)) < self.lost
        # An episode keeps its ends.
        lost[[0, -1]] = False
        seen[lost] = np.nan
        return seen
