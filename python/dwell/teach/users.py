"""The persons who teach: what makes one differ from another."""

from __future__ import annotations

import dataclasses
from typing import Any, Literal

import numpy as np

from dwell.teach.draws import stream
from dwell.teach.settings import TeachSettings

Hand = Literal["left", "right"]

#: Mean and standard deviation of the height of adults, women and men together, m, and the limits
#: within which it is drawn. NCD Risk Factor Collaboration, eLife 5 (2016) e13410: means of 1.59 and
#: 1.71 m over the world; the deviation of both together is an estimate.
_HEIGHT_M = (1.66, 0.09)
_HEIGHT_RANGE_M = (1.50, 1.90)
#: The share of left-handers: M. Papadatou-Pastou et al., Psychol. Bull. 146 (2020) 481: 10.6 %.
_LEFT_HANDED = 0.106
#: Standard deviations of pointing, degrees. An estimate; errors of a few degrees of the line from
#: the eye over the finger tip are usual (S. Mayer et al., CHI 2018).
_POINTING_NOISE_DEG = (0.5, 3.0)
#: How much slower than the quickest a user moves.
_PACE = (0.85, 1.3)
#: How often a user opens what is said while pointing and showing with "this", "that", "here" or
#: "look"; else only the thing is named. An estimate.
_DEICTIC = (0.85, 1.0)
#: What a user may open with, and how much it is liked: weights are drawn for each user.
OPENINGS = ("this is", "that is", "here is", "look at", "this", "that")


@dataclasses.dataclass(frozen=True)
class UserParameters:
    """What makes a user.

    Attributes:
        number: Counted from 1.
        height_m: Of the body.
        hand: With which the user points and takes things.
        pointing_noise_deg: Standard deviation of the direction of pointing, to each side and up.
        pace: How long movements take, as a multiple of the usual time.
        deictic: The share of clips that point or show in which the phrase opens with one of
            ``openings``.
        openings: Weights of the words that open a phrase, by these words; their sum is 1.
        voice: The seed from which pitch and vocal tract of the voice, and the colours of skin, hair
            and clothes, are drawn.
        things: Numbers of the user's things in the pool, from 0.
    """

    number: int
    height_m: float
    hand: Hand
    pointing_noise_deg: float
    pace: float
    deictic: float
    openings: dict[str, float]
    voice: int
    things: tuple[int, ...]

    def as_dict(self) -> dict[str, Any]:
        """The parameters as plain data."""
        return dataclasses.asdict(self)


def user_parameters(
    settings: TeachSettings, number: int, *, pool: int, things: int
) -> UserParameters:
    """Draws a user.

    Args:
        settings: Of the recording; its pointing noise goes before the user's own.
        number: The user, counted from 1.
        pool: How many things there are.
        things: How many of them the user has.
    """
    random = stream(settings.seed, "user", number)
    mean, deviation = _HEIGHT_M
    height_m = float(np.clip(random.normal(mean, deviation), *_HEIGHT_RANGE_M))
    hand: Hand = "left" if random.uniform() < _LEFT_HANDED else "right"
    own_noise_deg = float(random.uniform(*_POINTING_NOISE_DEG))
    pace, deictic = float(random.uniform(*_PACE)), float(random.uniform(*_DEICTIC))
    weights = random.dirichlet(np.ones(len(OPENINGS)))
    stated_deg = settings.pointing_noise_deg
    return UserParameters(
        number=number,
        height_m=round(height_m, 3),
        hand=hand,
        pointing_noise_deg=round(own_noise_deg, 3) if stated_deg is None else stated_deg,
        pace=round(pace, 3),
        deictic=round(deictic, 3),
        openings={words: round(float(w), 4) for words, w in zip(OPENINGS, weights, strict=True)},
        voice=int(random.integers(2**31)),
        things=tuple(sorted(int(k) for k in random.choice(pool, things, replace=False))),
    )
