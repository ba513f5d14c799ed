"""How strong an effect is for whoever knows it: the ideal test's d'.

With white noise and unknown starts the likelihood-ratio test between "nothing" and a known effect
has d' = |P r| / sigma, where r is what the effect changes and P takes away what other starts could
do as well (S. Kay, Fundamentals of Statistical Signal Processing II, section 13.3).
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from dwell.challenge.effects import Effect, Values

__all__ = ["Detector", "World"]

_Array = NDArray[np.float64]
#: Relative step of derivatives by starts.
_STEP = 1e-4


class World(Protocol):
    """Situations that are measured, and what may be hidden in them."""

    name: str
    entity: str
    noise_sds: tuple[float, ...]
    effects: tuple[Effect, ...]
    channels: tuple[str, ...]

    def conditions(self, rng: np.random.Generator) -> Any:  # noqa: ANN401 - of each world its own
        """Draws what is known of a case."""

    def nuisances(self, known: Any) -> _Array:  # noqa: ANN401
        """What is unknown of each episode, shape (episode, nuisance)."""

    def observe(self, known: Any, nuisances: _Array, values: Values) -> _Array:  # noqa: ANN401
        """What is measured without noise, shape (episode, sample, channel)."""

    def further(self, known: Any, rng: np.random.Generator) -> _Array:  # noqa: ANN401
        """Channels that nothing hides in, with noise, shape (episode, sample, channel)."""

    def commands(self, known: Any) -> tuple[float, _Array] | None:  # noqa: ANN401
        """Commands a second, and their values, shape (episode, command); ``None`` of none."""

    def manifest(self, known: Any, noise_sd: float | None) -> dict[str, Any]:  # noqa: ANN401
        """``manifest.json`` of the bundle."""


class Detector:
    """The ideal test of one case."""

    def __init__(self, world: World, known: Any, noise_sd: float) -> None:  # noqa: ANN401
        """Computes what unknown starts can do.

        Args:
            world: The world of the case.
            known: Its conditions.
            noise_sd: Standard deviation of the noise.
        """
        self._world, self._known, self._noise = world, known, noise_sd
        self._starts = world.nuisances(known)
        self._plain = world.observe(known, self._starts, {})
        columns = []
        for k in range(self._starts.shape[1]):
            moved = self._starts.copy()
            step = _STEP * np.maximum(1.0, np.abs(moved[:, k]))
            moved[:, k] += step
            change = world.observe(known, moved, {}) - self._plain
            columns.append(change / step[:, None, None])
        self._bases = []
        for episode, count in enumerate(known.samples):
            one = np.column_stack([column[episode, :count].ravel() for column in columns])
            self._bases.append(np.linalg.qr(one)[0])

    def change(self, values: Values) -> _Array:
        """What starts can't explain of hidden effects, in standard deviations; one row of all."""
        seen = self._world.observe(self._known, self._starts, values) - self._plain
        parts = []
        for episode, (count, basis) in enumerate(
            zip(self._known.samples, self._bases, strict=True)
        ):
            one = seen[episode, :count].ravel()
            parts.append(one - basis @ (basis.T @ one))
        return np.concatenate(parts) / self._noise

    def d_prime(self, values: Values) -> float:
        """The d' between these effects and none."""
        return float(np.linalg.norm(self.change(values)))

    def strength(self, effect: Effect, d_prime: float, sign: float) -> float | None:
        """The signed strength at which an effect has a d', within a hundredth, or ``None``."""
        low, high = effect.bounds
        if effect.neutral == 0.0:
            strength = sign * np.sqrt(low * high)
        else:
            strength = 0.5 * ((high if sign > 0 else low) - effect.neutral)
        for _ in range(30):
            reached = self.d_prime({effect.id: effect.value(strength)})
            if not np.isfinite(reached) or reached <= 0.0:
                return None
            if abs(reached / d_prime - 1.0) < 0.01:
                break
            further = effect.clipped(strength * float(np.clip(d_prime / reached, 0.1, 10.0)))
            if further == strength:
                return None
            strength = further
        else:
            return None
        return float(strength) if effect.within(strength) else None

    def distance(self, values: Values, rival: Effect) -> float:
        """The d' between hidden effects and the strength of a rival that comes nearest to them.

        The rival's change is taken as proportional to its strength near the one that fits, found
        by repeated projection.
        """
        target = self.change(values)
        low, high = rival.bounds
        strength = np.sqrt(low * high) if rival.neutral == 0.0 else 0.1 * (high - rival.neutral)
        best = float(np.linalg.norm(target))
        for _ in range(8):
            own = self.change({rival.id: rival.value(strength)})
            power = float(own @ own)
            if not np.isfinite(power) or power == 0.0:
                break
            best = min(best, float(np.linalg.norm(target - own)))
            factor = float(own @ target) / power
            if abs(factor) < 1e-3 or abs(factor - 1.0) < 1e-3:
                break
            further = rival.clipped(strength * float(np.clip(factor, -10.0, 10.0)))
            if further == strength or np.sign(further) not in rival.signs():
                break
            strength = further
        return best
