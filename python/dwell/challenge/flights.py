"""A world of thrown balls: what may be hidden in it, and what a tracker writes.

Positions by the classical Runge-Kutta method with two steps a sample.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.challenge.effects import Effect, Values

__all__ = ["FlightConditions", "Flights"]

_Array = NDArray[np.float64]

_GRAVITY_M_S2 = 9.80665
#: Dry air at 20 degrees Celsius and 101,325 Pa, kg/m3.
_AIR_KG_M3 = 1.2041
_SUBSTEPS = 2
#: Standard deviation of measured spins, rad/s.
_SPIN_NOISE_RAD_S = 0.5

#: Name, mass in kg and radius in m of the balls that are thrown.
_BALLS = (
    ("tennis ball", 0.0577, 0.033),
    ("table-tennis ball", 0.0027, 0.02),
    ("foam ball", 0.012, 0.035),
    ("balloon", 0.02, 0.1),
)


@dataclasses.dataclass(frozen=True)
class FlightConditions:
    """What is known of the throws of a case; drawn before the cause.

    Attributes:
        ball: Its name.
        mass_kg: Of the ball.
        radius_m: Of the ball.
        rate_hz: Samples per second.
        starts: Positions, m, and velocities, m/s, at the start. Shape (episode, 6); Y is up.
        spins: rad/s, shape (episode, 3).
        phases: Of what changes with time, rad, shape (episode,).
        samples: Of each episode, shape (episode,).
    """

    ball: str
    mass_kg: float
    radius_m: float
    rate_hz: float
    starts: _Array
    spins: _Array
    phases: _Array
    samples: NDArray[np.int64]


class Flights:
    """Throws of a ball. Nuisances are each throw's start: three positions, three velocities."""

    name = "flights"
    entity = "ball"
    #: Standard deviations of noise, m.
    noise_sds: tuple[float, ...] = (0.0005, 0.002, 0.005)
    effects: tuple[Effect, ...] = (
        Effect("drag", "library", ("c_d",), (0.1, 2.0)),
        Effect("viscous_damping", "library", ("linear_per_s",), (0.002, 0.5)),
        Effect("magnus", "library", ("c_l",), (0.02, 2.0)),
        Effect("buoyancy", "library", ("fluid_density_kg_m3",), (0.9, 1.4)),
        # What gravity is on Earth.
        Effect("gravity", "library", ("gravity_m_s2",), (9.764, 9.834), _GRAVITY_M_S2),
        Effect("length_scale", "fault", ("scale",), (0.9, 1.1), 1.0),
        Effect("clock_scale", "fault", ("scale",), (0.9, 1.1), 1.0),
        Effect("frame_tilt", "fault", ("about_z_rad",), (0.0005, 0.2), two_sided=True),
        Effect("drag_v_1.5", "outside", ("k",), (0.001, 5.0)),
        Effect("fan", "outside", ("m_s2",), (0.01, 20.0)),
        Effect("magnet", "outside", ("m3_s2",), (0.001, 5.0), two_sided=True),
    )
    channels: tuple[str, ...] = ("x", "y", "z", "wx", "wy", "wz")

    def conditions(self, rng: np.random.Generator) -> FlightConditions:
        """Draws the throws of a case."""
        ball, mass_kg, radius_m = _BALLS[int(rng.integers(len(_BALLS)))]
        count = int(rng.integers(15, 31))
        # A third of the cases: one way to throw, so that rivals can't be told apart.
        alike = rng.random() < 1.0 / 3.0
        fast = 3.0 if ball == "balloon" else 8.0
        slowest, fastest = (0.5 * fast, 0.52 * fast) if alike else (1.0, fast)
        speed = rng.uniform(slowest, fastest, count)
        up = rng.uniform(0.2, 1.2, count)
        around = rng.uniform(0.0, 2.0 * np.pi, count)
        starts = np.column_stack(
            [
                np.zeros(count),
                rng.uniform(1.0, 1.5, count),
                np.zeros(count),
                speed * np.cos(up) * np.cos(around),
                speed * np.sin(up),
                speed * np.cos(up) * np.sin(around),
            ]
        )
        rate_hz = float(rng.choice([60.0, 90.0, 120.0]))
        return FlightConditions(
            ball=ball,
            mass_kg=mass_kg,
            radius_m=radius_m,
            rate_hz=rate_hz,
            starts=starts,
            spins=rng.uniform(-60.0, 60.0, (count, 3)),
            phases=rng.uniform(0.0, 2.0 * np.pi, count),
            samples=(rate_hz * rng.uniform(0.5, 0.8, count)).astype(np.int64),
        )

    def nuisances(self, known: FlightConditions) -> _Array:
        """What is unknown of each episode, shape (episode, 6)."""
        return known.starts

    def observe(self, known: FlightConditions, nuisances: _Array, values: Values) -> _Array:
        """What a tracker without noise writes of positions.

        Args:
            known: The throws.
            nuisances: Each throw's start, shape (episode, 6).
            values: The hidden parameters by effect.

        Returns:
            m, shape (episode, sample, 3); beyond an episode's samples as if it went on.
        """
        most = int(known.samples.max())
        tau = values.get("clock_scale", (1.0,))[0]
        paths = np.empty((len(nuisances), most, 3))
        now = nuisances.copy()
        # The clock writes tau t at time t: its samples are evenly spaced on it.
        h = 1.0 / known.rate_hz / tau / _SUBSTEPS
        rates = _Rates(known, values)
        for k in range(most):
            paths[:, k] = now[:, :3]
            for sub in range(_SUBSTEPS):
                now = _runge_kutta(rates, (k * _SUBSTEPS + sub) * h, now, h)
        lean = values.get("frame_tilt", (0.0,))[0]
        cos, sin = np.cos(lean), np.sin(lean)
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        seen: _Array = values.get("length_scale", (1.0,))[0] * paths @ turn.T
        return seen

    def manifest(self, known: FlightConditions, noise_sd: float | None) -> dict[str, Any]:
        """``manifest.json`` of the bundle."""
        places = [{"name": name, "unit": "m", "clock": "c", "noise_sd": noise_sd} for name in "xyz"]
        spins = [
            {"name": name, "unit": "rad/s", "clock": "c", "noise_sd": _SPIN_NOISE_RAD_S}
            for name in self.channels[3:]
        ]
        ball = {"name": "ball", "mass_kg": known.mass_kg, "radius_m": known.radius_m}
        return {
            "version": 1,
            "title": f"Throws of a {known.ball}",
            "licence": "CC0-1.0",
            "kind": "trajectory",
            "scene": {
                "environment": {
                    "temperature_c": 20.0,
                    "humidity_pct": 0.0,
                    "pressure_pa": 101_325.0,
                },
                "bodies": [ball],
            },
            "channels": places + spins,
        }

    def further(self, known: FlightConditions, rng: np.random.Generator) -> _Array:
        """Channels that nothing hides in: measured spins, rad/s, shape (episode, sample, 3)."""
        most = int(known.samples.max())
        noise = _SPIN_NOISE_RAD_S * rng.standard_normal((len(known.spins), most, 3))
        return known.spins[:, None, :] + noise

    def commands(self, known: FlightConditions) -> None:
        """None: nothing is commanded."""
        del known


class _Rates:
    """The rates of positions and velocities."""

    def __init__(self, known: FlightConditions, values: Values) -> None:
        def value(name: str) -> float:
            return values[name][0] if name in values else 0.0

        area = np.pi * known.radius_m**2
        dynamic = 0.5 * _AIR_KG_M3 * area / known.mass_kg
        self.quadratic = dynamic * value("drag")
        self.linear = value("viscous_damping")
        self.between = value("drag_v_1.5")
        self.lift = dynamic * known.radius_m * value("magnus")
        displaced = value("buoyancy") * 4.0 / 3.0 * np.pi * known.radius_m**3 / known.mass_kg
        gravity = values.get("gravity", (_GRAVITY_M_S2,))[0]
        # Half of the displaced mass moves along with a sphere (H. Lamb, Hydrodynamics, article 92).
        self.fall = gravity * (1.0 - displaced) / (1.0 + 0.5 * displaced)
        self.fan = value("fan")
        self.magnet = value("magnet")
        self.spins, self.phases = known.spins, known.phases

    def __call__(self, t: float, now: _Array) -> _Array:
        place, v = now[:, :3], now[:, 3:]
        out = np.empty_like(now)
        out[:, :3] = v
        out[:, 3:] = -self.linear * v
        if self.quadratic or self.between:
            speed = np.sqrt(np.einsum("ij,ij->i", v, v))[:, None]
            out[:, 3:] -= (self.quadratic * speed + self.between * np.sqrt(speed)) * v
        out[:, 4] -= self.fall
        if self.lift:
            out[:, 3:] += self.lift * np.cross(self.spins, v)
        if self.fan:
            out[:, 3] += self.fan * np.sin(14.0 * t + self.phases)
        if self.magnet:
            # Below a table in front of the thrower.
            way = np.array([1.0, 0.3, 0.5]) - place
            far = np.linalg.norm(way, axis=1, keepdims=True)
            out[:, 3:] += self.magnet * way / np.maximum(far, 0.3) ** 3
        return out


def _runge_kutta(rates: _Rates, t: float, now: _Array, h: float) -> _Array:
    a = rates(t, now)
    b = rates(t + 0.5 * h, now + 0.5 * h * a)
    c = rates(t + 0.5 * h, now + 0.5 * h * b)
    d = rates(t + h, now + h * c)
    return now + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
