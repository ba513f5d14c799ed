"""Cases: a situation, what is hidden in it and how strongly, and how it is measured."""

from __future__ import annotations

import dataclasses
import hashlib
from typing import Any

import numpy as np

from dwell import ConfigError
from dwell.arguments import integer_in_range, quoted
from dwell.challenge.detection import Detector, World
from dwell.challenge.effects import Effect, Kind
from dwell.challenge.flights import Flights
from dwell.challenge.noise import Noise
from dwell.challenge.servos import Servos

__all__ = ["STRATA", "WORLDS", "Case", "ChallengeSettings", "case", "name_of"]

#: The worlds. To add one: a file with a class like :class:`Flights`, and its name here.
WORLDS: dict[str, World] = {world.name: world for world in (Flights(), Servos())}

#: Cases of each kind in 800: nothing, one effect that can be told from others as far as the data
#: goes, two, something outside the library, a fault of the measurement.
STRATA: dict[str, int] = {"nothing": 300, "one": 200, "two": 100, "outside": 100, "fault": 100}
_OF_KIND: dict[str, Kind] = {"one": "library", "outside": "outside", "fault": "fault"}

#: Detection units, log-uniform; a unit is a d' of 5.
_UNITS = (0.3, 30.0)
_D_PRIME_A_UNIT = 5.0
#: Effects and strengths that are tried before a case draws another situation.
_TRIES = 12
_NAME_BITS = 48


@dataclasses.dataclass(frozen=True)
class ChallengeSettings:
    """What cases are drawn.

    Attributes:
        cases: How many, 1 to 100,000; their kinds are in the shares of :data:`STRATA`.
        seed: Draws them; case k is the same whatever the number of cases.
        worlds: Names of :data:`WORLDS`.
    """

    cases: int = 80
    seed: int = 0
    worlds: tuple[str, ...] = tuple(WORLDS)

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigError: One is out of its range.
        """
        integer_in_range("cases", self.cases, low=1, high=100_000)
        integer_in_range("seed", self.seed)
        if not self.worlds:
            raise ConfigError(f"worlds is empty; expected some of {', '.join(WORLDS)}")
        for name in self.worlds:
            if name not in WORLDS:
                known = ", ".join(WORLDS)
                raise ConfigError(f"worlds has {quoted(name)}; expected some of {known}")


@dataclasses.dataclass(frozen=True)
class Case:
    """A case with its answer.

    Attributes:
        number: From 0.
        name: What its bundle is called: random.
        world: Of :data:`WORLDS`.
        kind: Of :data:`STRATA`.
        known: The situation.
        values: Hidden parameters by effect.
        d_prime: The ideal test's, by effect alone.
        rivals: The d' between what is hidden and the nearest strength of each single effect that
            ``dwell calibrate`` knows, but for the hidden one itself.
        noise: How it is measured.
        noise_is_known: Whether the bundle says how large the noise is.
    """

    number: int
    name: str
    world: str
    kind: str
    known: Any
    values: dict[str, tuple[float, ...]]
    d_prime: dict[str, float]
    rivals: dict[str, float]
    noise: Noise
    noise_is_known: bool

    def answer(self) -> dict[str, Any]:
        """The row of the answers' file."""
        effects = {effect.id: effect for effect in WORLDS[self.world].effects}
        return {
            "case": self.name,
            "world": self.world,
            "kind": self.kind,
            "hidden": [
                {
                    "id": id,
                    "kind": effects[id].kind,
                    "parameters": dict(zip(effects[id].parameters, values, strict=True)),
                    "d_prime": round(self.d_prime[id], 3),
                }
                for id, values in self.values.items()
            ],
            "rivals": {id: round(value, 3) for id, value in self.rivals.items()},
            "noise": dataclasses.asdict(self.noise),
        }


def _kind_of(number: int) -> str:
    """The kind of a case: in every 800 in a row, in every 8 nearly, in the shares of the strata."""
    total = sum(STRATA.values())
    # A golden-ratio sequence, which spreads each kind evenly over the numbers.
    place = int((number * 0.6180339887498949) % 1.0 * total)
    for kind, share in STRATA.items():
        if place < share:
            return kind
        place -= share
    raise AssertionError("shares add up to the total")


def name_of(number: int, settings: ChallengeSettings) -> str:
    """What a case's bundle is called; other settings but ``cases`` give other names."""
    return _name(np.random.default_rng([settings.seed, number]), settings)


def _name(rng: np.random.Generator, settings: ChallengeSettings) -> str:
    """The first draw of a case."""
    drawn = int(rng.integers(1 << _NAME_BITS))
    if settings.worlds != tuple(WORLDS):
        # The same draw in other worlds is another case.
        worlds = " ".join(settings.worlds).encode()
        digest = hashlib.blake2b(worlds, digest_size=_NAME_BITS // 8).digest()
        drawn ^= int.from_bytes(digest, "big")
    return f"{drawn:012x}"


def case(number: int, settings: ChallengeSettings) -> Case:
    """Draws a case; of all arguments but ``cases`` alone.

    Args:
        number: Which, from 0.
        settings: Seed and worlds.
    """
    kind = _kind_of(number)
    rng = np.random.default_rng([settings.seed, number])
    name = _name(rng, settings)
    while True:
        world = WORLDS[settings.worlds[int(rng.integers(len(settings.worlds)))]]
        known = world.conditions(rng)
        noise = Noise.draw(rng, float(rng.choice(world.noise_sds)))
        is_known = bool(rng.random() < 0.5)
        if kind == "nothing":
            return Case(
                number, name, world.name, kind, known, {}, {}, {}, noise, noise_is_known=is_known
            )
        detector = Detector(world, known, noise.sd)
        values = _hidden(rng, world, kind, detector)
        if values is None:
            continue
        rivals = {
            rival.id: detector.distance(values, rival)
            for rival in world.effects
            if rival.kind != "outside" and (len(values) > 1 or rival.id not in values)
        }
        alone = {id: detector.d_prime({id: value}) for id, value in values.items()}
        return Case(number, name, world.name, kind, known, values, alone, rivals, noise, is_known)


def _hidden(
    rng: np.random.Generator, world: World, kind: str, detector: Detector
) -> dict[str, tuple[float, ...]] | None:
    """Draws one effect, or two, with strengths in detection units; ``None`` where none fits."""
    for _ in range(_TRIES):
        wanted = 2 if kind == "two" else 1
        of_kind = [one for one in world.effects if one.kind == _OF_KIND.get(kind, "library")]
        chosen: list[Effect] = [
            of_kind[k] for k in rng.choice(len(of_kind), size=wanted, replace=False)
        ]
        values = {}
        for effect in chosen:
            low, high = np.log(_UNITS)
            units = float(np.exp(rng.uniform(low, high)))
            sign = float(rng.choice(effect.signs()))
            strength = detector.strength(effect, _D_PRIME_A_UNIT * units, sign)
            if strength is not None:
                values[effect.id] = effect.value(strength)
        if len(values) == wanted:
            return values
    return None
