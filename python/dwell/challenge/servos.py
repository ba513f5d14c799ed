"""A world of servo joints: what may be hidden in one, and what its encoder writes.

A joint with inertia follows commands by a position servo. The linear part is exact for what is
constant in steps of 1 ms; play and friction act between them.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.challenge.effects import Effect, Values

__all__ = ["ServoConditions", "Servos"]

_Array = NDArray[np.float64]

#: Commands a second, and steps of the integrator a command.
_COMMANDS_HZ, _SUBSTEPS = 100.0, 10
_DURATION_S = 3.0


@dataclasses.dataclass(frozen=True)
class ServoConditions:
    """What is known of the runs of a case; drawn before the cause.

    Attributes:
        inertia_kg_m2: Of all that turns.
        stiffness_n_m_rad: Of the servo.
        damping_n_m_s_rad: Of the servo.
        max_torque_n_m: Of the servo.
        rate_hz: Samples per second.
        commands: rad, shape (episode, command).
        starts: Angle in rad and velocity in rad/s at the start, shape (episode, 2).
        samples: Of each episode, shape (episode,).
    """

    inertia_kg_m2: float
    stiffness_n_m_rad: float
    damping_n_m_s_rad: float
    max_torque_n_m: float
    rate_hz: float
    commands: _Array
    starts: _Array
    samples: NDArray[np.int64]


class Servos:
    """Runs of one joint. Nuisances are each run's start: angle and velocity."""

    name = "servos"
    entity = "elbow"
    #: Standard deviations of noise, rad.
    noise_sds: tuple[float, ...] = (0.0002, 0.0005, 0.001)
    effects: tuple[Effect, ...] = (
        Effect("backlash", "library", ("half_width",), (2e-5, 0.05)),
        Effect("latency", "library", ("delay_s",), (2e-5, 0.1)),
        Effect("first_order_lag", "library", ("tau_s",), (2e-5, 0.2)),
        Effect("joint_friction", "library", ("coulomb",), (5e-5, 0.3)),
        Effect("motor_constants", "library", ("torque_scale",), (0.5, 1.5), 1.0),
        Effect("command_scale", "fault", ("scale",), (0.9, 1.1), 1.0),
        # A torque that comes and goes six times a turn: of magnets, or teeth.
        Effect("cogging", "outside", ("n_m",), (5e-5, 0.5)),
        # An encoder off its axis.
        Effect("eccentric_encoder", "outside", ("rad",), (5e-5, 0.1)),
    )
    channels: tuple[str, ...] = ("position",)

    def conditions(self, rng: np.random.Generator) -> ServoConditions:
        """Draws the runs of a case: sums of two sines and a step."""
        count = 8
        t = np.arange(int(_DURATION_S * _COMMANDS_HZ)) / _COMMANDS_HZ
        commands = np.empty((count, len(t)))
        for k in range(count):
            slow, fast = rng.uniform(0.2, 0.6), rng.uniform(0.05, 0.15)
            commands[k] = slow * np.sin(rng.uniform(1.0, 3.0) * t)
            commands[k] += fast * np.sin(rng.uniform(4.0, 9.0) * t)
            commands[k] += rng.uniform(-0.4, 0.4) * (t > rng.uniform(1.0, 2.5))
        rate_hz = float(rng.choice([50.0, 100.0]))
        inertia = float(rng.uniform(0.002, 0.006))
        stiffness = float(rng.uniform(1.0, 3.0))
        ratio = float(rng.uniform(0.5, 1.0))
        return ServoConditions(
            inertia_kg_m2=inertia,
            stiffness_n_m_rad=stiffness,
            damping_n_m_s_rad=2.0 * ratio * float(np.sqrt(inertia * stiffness)),
            max_torque_n_m=3.0,
            rate_hz=rate_hz,
            commands=commands,
            starts=np.zeros((count, 2)),
            samples=np.full(count, int(_DURATION_S * rate_hz), np.int64),
        )

    def nuisances(self, known: ServoConditions) -> _Array:
        """What is unknown of each episode, shape (episode, 2)."""
        return known.starts

    def observe(self, known: ServoConditions, nuisances: _Array, values: Values) -> _Array:
        """What an encoder without noise writes.

        Args:
            known: The runs.
            nuisances: Each run's start, shape (episode, 2).
            values: The hidden parameters by effect.

        Returns:
            rad, shape (episode, sample, 1).
        """

        def value(name: str, neutral: float = 0.0) -> float:
            return values[name][0] if name in values else neutral

        h = 1.0 / _COMMANDS_HZ / _SUBSTEPS
        scale = value("motor_constants", 1.0)
        pull = scale * known.stiffness_n_m_rad
        stay, answer = _held_response(
            np.array(
                [
                    [0.0, 1.0],
                    [
                        -pull / known.inertia_kg_m2,
                        -scale * known.damping_n_m_s_rad / known.inertia_kg_m2,
                    ],
                ]
            ),
            np.array([0.0, 1.0 / known.inertia_kg_m2]),
            h,
        )
        asked = value("command_scale", 1.0) * self._delayed(known, value("latency") / h)
        play, lag = value("backlash"), value("first_order_lag")
        keep = np.exp(-h / lag) if lag > 0.0 else 0.0
        friction = value("joint_friction")
        cogging = value("cogging")
        now = nuisances.copy()
        told = np.zeros(len(now))
        output = np.zeros(len(now))
        every = round(_COMMANDS_HZ * _SUBSTEPS / known.rate_hz)
        seen = np.empty((len(now), int(known.samples[0]), 1))
        for step in range(asked.shape[1]):
            if step % every == 0:
                seen[:, step // every, 0] = now[:, 0]
            told = keep * told + (1.0 - keep) * asked[:, step]
            # The play operator: the output stays until it is pushed from either side.
            output = np.minimum(np.maximum(output, told - play), told + play)
            torque = pull * output
            if cogging:
                torque = torque + cogging * np.sin(6.0 * now[:, 0])
            if friction:
                free = torque - pull * now[:, 0]
                now = _slid(now, torque, free, friction, (stay, answer), h)
            else:
                now = now @ stay.T + torque[:, None] * answer
        seen[..., 0] += value("eccentric_encoder") * np.sin(seen[..., 0])
        return seen

    def _delayed(self, known: ServoConditions, steps: float) -> _Array:
        """Commands at each step, so many later; within one their mean. Shape (episode, step)."""
        held = np.repeat(known.commands, _SUBSTEPS, axis=1)
        whole, part = int(steps), steps % 1.0
        padded = np.concatenate([np.zeros((len(held), whole + 1)), held], axis=1)
        count = held.shape[1]
        later: _Array = (1.0 - part) * padded[:, 1 : count + 1] + part * padded[:, :count]
        return later

    def manifest(self, known: ServoConditions, noise_sd: float | None) -> dict[str, Any]:
        """``manifest.json`` of the bundle."""
        joint = {
            "name": self.entity,
            "inertia_kg_m2": known.inertia_kg_m2,
            "stiffness_n_m_rad": known.stiffness_n_m_rad,
            "damping_n_m_s_rad": known.damping_n_m_s_rad,
            "max_torque_n_m": known.max_torque_n_m,
        }
        # One clock stamps commands and samples.
        position = {
            "name": "position",
            "unit": "rad",
            "clock": "controller",
            "noise_sd": noise_sd,
        }
        return {
            "version": 1,
            "title": "Runs of a servo",
            "licence": "CC0-1.0",
            "kind": "servo",
            "scene": {"joints": [joint]},
            "channels": [position],
        }

    def further(self, known: ServoConditions, rng: np.random.Generator) -> _Array:
        """Channels that nothing hides in: none, shape (episode, sample, 0)."""
        del rng
        return np.empty((len(known.samples), int(known.samples[0]), 0))

    def commands(self, known: ServoConditions) -> tuple[float, _Array]:
        """Commands a second, and angles in rad, shape (episode, command)."""
        return _COMMANDS_HZ, known.commands


def _slid(
    now: _Array,
    torque: _Array,
    free: _Array,
    friction: float,
    response: tuple[_Array, _Array],
    h: float,
) -> _Array:
    """A step with Coulomb friction, which holds what it can and else acts against the motion.

    Args:
        now: Angles and velocities, shape (episode, 2).
        torque: All that is constant in the step, shape (episode,), N m.
        free: What acts on a joint at rest, N m.
        friction: N m.
        response: As of :func:`_held_response`.
        h: s.
    """
    stay, answer = response
    speed = now[:, 1]
    rests = speed == 0.0
    way = np.where(rests, np.sign(free), np.sign(speed))
    after: _Array = now @ stay.T + (torque - friction * way)[:, None] * answer
    # What would turn round comes to rest on the way.
    turns = ~rests & (after[:, 1] * speed < 0.0)
    share = speed / np.where(turns, speed - after[:, 1], 1.0)
    after[turns, 0] = (now[:, 0] + 0.5 * speed * share * h)[turns]
    after[turns, 1] = 0.0
    holds = rests & (np.abs(free) <= friction)
    after[holds] = now[holds]
    return after


def _held_response(system: _Array, force: _Array, h: float) -> tuple[_Array, _Array]:
    """What a linear system does in a step with constant force, exactly.

    K. J. Astrom and B. Wittenmark, Computer-Controlled Systems, 3rd ed. (1997), equation 2.4.

    Returns:
        The matrix of states, shape (2, 2), and the answer to the force, shape (2,).
    """
    values, vectors = np.linalg.eig(system.astype(np.complex128))
    stay = ((vectors * np.exp(values * h)) @ np.linalg.inv(vectors)).real.astype(np.float64)
    answer = np.linalg.solve(system, (stay - np.eye(2)) @ force).astype(np.float64)
    return stay, answer
