"""Simple methods to compare with: least squares on all effects, and one effect after the other.

Both know the equations of the worlds, which is more than a method can hope for, and fit them to a
bundle by the Gauss-Newton method; neither asks what else could explain the data, whether something
is left, or whether a value is plausible.
"""

from __future__ import annotations

import csv
import dataclasses
import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.challenge.cases import WORLDS
from dwell.challenge.detection import World
from dwell.challenge.effects import Effect
from dwell.challenge.flights import FlightConditions
from dwell.challenge.servos import ServoConditions

__all__ = ["BASELINES", "least_squares", "one_at_a_time"]

_Array = NDArray[np.float64]
_GRAVITY_M_S2 = 9.80665
_ITERATIONS = 4
#: Standard deviations from which on least squares take an effect for one: of ten by chance one in
#: a hundred cases.
_SIGNIFICANT = 3.3
#: The fall of the information criterion with which an effect counts, and the most effects.
_BIC, _MOST = 10.0, 4
#: Eigenvalue of the scaled normal matrix below which a direction counts as unknown.
_SEEN = 1e-6
#: Residuals beyond so many robust standard deviations count as that many.
_CLIP = 4.0


@dataclasses.dataclass(frozen=True)
class _Data:
    """A bundle as its world has it.

    Attributes:
        world: Its world.
        known: The situation, with starts to first order.
        seen: Shape (episode, sample, channel); NaN where a sample is lost.
    """

    world: World
    known: Any
    seen: _Array


@dataclasses.dataclass
class _Fit:
    """Effects fitted to a bundle.

    Attributes:
        strengths: By position in the world's effects.
        sds: Of them.
        square: Sum of squared residuals, outliers clipped.
        count: Of data.
    """

    strengths: dict[int, float]
    sds: dict[int, float]
    square: float
    count: int


def _read(bundle: Path) -> _Data:
    manifest = json.loads((bundle / "manifest.json").read_text("utf-8"))
    world = WORLDS["servos" if manifest["kind"] == "servo" else "flights"]
    rows: dict[str, dict[str, list[tuple[float, float]]]] = {}
    with open(bundle / "trajectory.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            sample = (float(row["t_s"]), float(row["value"]))
            rows.setdefault(row["episode"], {}).setdefault(row["channel"], []).append(sample)
    gaps = [np.diff([t for t, _ in samples]) for one in rows.values() for samples in one.values()]
    rate_hz = 1.0 / float(np.median(np.concatenate(gaps)))
    tables = {
        channel: _table([one[channel] for one in rows.values()], rate_hz)
        for channel in world.channels
    }
    samples = np.array(
        [np.flatnonzero(~np.isnan(row))[-1] + 1 for row in tables[world.channels[0]]]
    )
    scene = manifest["scene"]
    if world.name == "flights":
        places = np.stack([tables[name] for name in "xyz"], axis=2)
        spins = np.stack([np.nanmean(tables[name], axis=1) for name in ("wx", "wy", "wz")], axis=1)
        ball = scene["bodies"][0]
        known: Any = FlightConditions(
            ball=ball["name"],
            mass_kg=ball["mass_kg"],
            radius_m=ball["radius_m"],
            rate_hz=rate_hz,
            starts=_starts(places, rate_hz),
            spins=spins,
            phases=np.zeros(len(spins)),
            samples=samples,
        )
        return _Data(world, known, places)
    joint = scene["joints"][0]
    commands: dict[str, list[float]] = {}
    with open(bundle / "command.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            commands.setdefault(row["episode"], []).append(float(row["value"]))
    known = ServoConditions(
        inertia_kg_m2=joint["inertia_kg_m2"],
        stiffness_n_m_rad=joint["stiffness_n_m_rad"],
        damping_n_m_s_rad=joint["damping_n_m_s_rad"],
        max_torque_n_m=joint["max_torque_n_m"],
        rate_hz=rate_hz,
        commands=np.array([commands[episode] for episode in rows]),
        starts=np.zeros((len(rows), 2)),
        samples=samples,
    )
    return _Data(world, known, tables["position"][:, :, None])


def _table(episodes: Sequence[Sequence[tuple[float, float]]], rate_hz: float) -> _Array:
    """Samples by number, NaN where there is none. Shape (episode, sample)."""
    places = [[round((t - one[0][0]) * rate_hz) for t, _ in one] for one in episodes]
    table = np.full((len(episodes), max(one[-1] for one in places) + 1), np.nan)
    for row, own, samples in zip(table, places, episodes, strict=True):
        row[own] = [value for _, value in samples]
    return table


def _starts(places: _Array, rate_hz: float) -> _Array:
    """Positions and velocities at the start, by parabolas that fall freely. Shape (episode, 6)."""
    t = np.arange(places.shape[1]) / rate_hz
    free = places + 0.5 * _GRAVITY_M_S2 * np.square(t)[None, :, None] * np.array([0.0, 1.0, 0.0])
    starts = np.empty((len(places), 6))
    for episode, path in enumerate(free):
        for axis in range(3):
            there = ~np.isnan(path[:, axis])
            slope, place = np.polyfit(t[there], path[there, axis], 1)
            starts[episode, [axis, 3 + axis]] = place, slope
    return starts


def _fit(data: _Data, which: Sequence[int]) -> _Fit:
    """Fits starts and effects together."""
    world, known = data.world, data.known
    starts = world.nuisances(known).copy()
    effects = [world.effects[k] for k in which]
    strengths = np.zeros(len(which))
    inverse: _Array = np.zeros((len(which), len(which)))

    def simulated(starts: _Array, strengths: _Array) -> _Array:
        acting = {
            effect.id: effect.value(float(strength))
            for effect, strength in zip(effects, strengths, strict=True)
            if strength
        }
        return world.observe(known, starts, acting)

    valid = ~np.isnan(data.seen)
    scale = 1.0
    for _ in range(_ITERATIONS):
        plain = simulated(starts, strengths)
        left = np.where(valid, data.seen - plain, 0.0)
        # A consistent estimate for a normal distribution, which does not see outliers.
        scale = 1.4826 * float(np.median(np.abs(left[valid])))
        clipped = np.clip(left, -_CLIP * scale, _CLIP * scale)
        own = []
        for k in range(starts.shape[1]):
            moved = starts.copy()
            steps = 1e-4 * np.maximum(1.0, np.abs(moved[:, k]))
            moved[:, k] += steps
            own.append((simulated(moved, strengths) - plain) / steps[:, None, None])
        shared = []
        for k, effect in enumerate(effects):
            moved = strengths.copy()
            step = 0.1 * _typical(effect)
            moved[k] += step
            shared.append((simulated(starts, moved) - plain) / step)
        normal, right = np.zeros_like(inverse), np.zeros(len(which))
        parts = []
        for episode, there in enumerate(valid):
            a = np.column_stack([column[episode][there] for column in own])
            g = np.column_stack([np.empty((len(a), 0))] + [c[episode][there] for c in shared])
            r = clipped[episode][there]
            pinv = np.linalg.pinv(a)
            g_left, r_left = g - a @ (pinv @ g), r - a @ (pinv @ r)
            normal += g_left.T @ g_left
            right += g_left.T @ r_left
            parts.append((pinv, g, r))
        # Directions that the data don't know stay where they are.
        power = np.sqrt(np.maximum(np.diag(normal), np.finfo(np.float64).tiny))
        inverse = np.linalg.pinv(normal / np.outer(power, power), rcond=_SEEN, hermitian=True)
        inverse = inverse / np.outer(power, power)
        changes = inverse @ right
        bounded = np.array(
            [
                _bounded(effect, float(value))
                for effect, value in zip(effects, strengths + changes, strict=True)
            ]
        )
        changes, strengths = bounded - strengths, bounded
        for episode, (pinv, g, r) in enumerate(parts):
            starts[episode] += pinv @ (r - g @ changes)
    rest = (data.seen - simulated(starts, strengths))[valid]
    scale = 1.4826 * float(np.median(np.abs(rest)))
    square = float(np.square(np.clip(rest, -_CLIP * scale, _CLIP * scale)).sum())
    sds = np.sqrt(np.diag(inverse) * square / max(1, rest.size - starts.size))
    return _Fit(
        dict(zip(which, strengths.tolist(), strict=True)),
        dict(zip(which, sds.tolist(), strict=True)),
        square,
        rest.size,
    )


def _typical(effect: Effect) -> float:
    """A strength at which it may be looked for."""
    low, high = effect.bounds
    return math.sqrt(low * high) if effect.neutral == 0.0 else 0.1 * (high - effect.neutral)


def _bounded(effect: Effect, strength: float) -> float:
    """A strength that the world has an answer to."""
    bounded = effect.clipped(strength)
    return bounded if effect.neutral != 0.0 or effect.two_sided else max(0.0, bounded)


def _library(world: World) -> list[int]:
    return [k for k, effect in enumerate(world.effects) if effect.kind != "outside"]


def _verdict(world: World, fit: _Fit, named: Sequence[int]) -> dict[str, Any]:
    if not named:
        return {"kind": "nothing", "sets": [], "parameters": {}}
    parameters = {}
    for k in named:
        effect = world.effects[k]
        value = effect.value(fit.strengths[k])[0]
        half = 1.959964 * fit.sds[k]
        parameters[effect.id] = {effect.parameters[0]: [value, value - half, value + half]}
    ids = [world.effects[k].id for k in named]
    return {"kind": "named", "sets": [ids], "parameters": parameters}


def least_squares(bundle: Path) -> dict[str, Any]:
    """Fits every effect of the library at once and names those that differ from nothing.

    Args:
        bundle: Its folder.

    Returns:
        A verdict, as of :func:`~dwell.challenge.calibrated_verdict`.
    """
    data = _read(bundle)
    fit = _fit(data, _library(data.world))
    named = [k for k, sd in fit.sds.items() if 0.0 < sd * _SIGNIFICANT < abs(fit.strengths[k])]
    return _verdict(data.world, fit, named)


def one_at_a_time(bundle: Path) -> dict[str, Any]:
    """Adds the effect that lowers the information criterion most as long as it falls by 10.

    G. Schwarz, Annals of Statistics 6 (1978), 461-464.

    Args:
        bundle: Its folder.

    Returns:
        A verdict, as of :func:`~dwell.challenge.calibrated_verdict`.
    """
    data = _read(bundle)
    now = _fit(data, [])
    named: list[int] = []
    while len(named) < _MOST:
        others = [k for k in _library(data.world) if k not in named]
        fits = {k: _fit(data, [*named, k]) for k in others}
        best = min(fits, key=lambda k: fits[k].square)
        count = now.count
        fall = count * math.log(now.square / fits[best].square) - math.log(count)
        if fall < _BIC:
            break
        named, now = [*named, best], fits[best]
    return _verdict(data.world, now, named)


#: The methods by name.
BASELINES: dict[str, Callable[[Path], dict[str, Any]]] = {
    "least-squares": least_squares,
    "one-at-a-time": one_at_a_time,
}
