"""Directivities: gains of sources and sensitivities of microphones by direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from dwell._native import ConfigError
from dwell.arguments import choice, finite_number, quoted, real_array

#: Octave bands, 63 Hz to 8 kHz.
BANDS = 8
#: Quieter than this beside the axis, dB, is silence.
SILENT_DB = -120.0


@dataclass(frozen=True)
class Directivity:
    """A directivity that is symmetric about its axis, with a gain of 1 on the axis.

    >>> import dwell
    >>> tweeter = dwell.Directivity.polar([[0] * 8, [-3] * 8, [-12] * 8])  # 0, 90, 180 degrees
    >>> source = dwell.Source((1, 1.2, 1), yaw_deg=90, directivity=tweeter)
    >>> [round(db, 1) for db in dwell.Directivity.first_order(0.5).index_db()[:2]]  # a cardioid
    [4.8, 4.8]
    """

    form: str
    values: tuple[Any, ...] = ()

    def __post_init__(self) -> None:
        """Checks the numbers, and keeps copies of them."""
        form = choice("form", self.form, ("first_order", "sphere", "polar"))
        found = real_array("values", self.values, np.float64)
        is_right = found.shape == {"first_order": (BANDS,), "sphere": (1,)}.get(form, found.shape)
        if form == "polar":
            is_right = found.ndim == 2 and found.shape[1] == BANDS and 2 <= len(found) <= 361
        if not is_right or not np.isfinite(found).all():
            raise ConfigError(
                f"values of the form {form} are {quoted(self.values)}; expected finite numbers as "
                f"Directivity.{form} makes them"
            )
        rows = found.tolist()
        own = tuple(map(tuple, rows)) if form == "polar" else tuple(rows)
        object.__setattr__(self, "values", own)

    @classmethod
    def first_order(cls, gradient: float | Sequence[float]) -> Directivity:
        """``1 - g + g cos(angle)``: 0 equal on all sides, 0.5 cardioid, 1 figure of eight.

        Args:
            gradient: g, 0 to 1, or one for each octave from 63 Hz to 8 kHz; the range is checked
                where it is heard.

        Raises:
            ConfigError: No finite numbers, or neither one nor eight.
        """
        return cls("first_order", tuple(_bands("gradient", gradient).tolist()))

    @classmethod
    def sphere(cls, radius_m: float) -> Directivity:
        """A point on a rigid sphere, 0.01 to 1 m: 0.0875 a talking head, 0.15 a loudspeaker."""
        return cls("sphere", (finite_number("radius_m", radius_m),))

    @classmethod
    def polar(cls, level_db: npt.ArrayLike) -> Directivity:
        """A measured directivity.

        Args:
            level_db: Levels from the axis (0 degrees) to behind (180) at equal steps, dB. Shape
                (angle,) or (angle, 8): octaves from 63 Hz to 8 kHz; 2 to 361 angles. Only what they
                differ by from those on the axis counts; -inf is silence.

        Raises:
            ConfigError: For another shape, NaN, or a level more than 6 dB above that on the axis.
        """
        levels = real_array("level_db", level_db, np.float64)
        if levels.ndim == 1:
            levels = np.repeat(levels[:, None], BANDS, axis=1)
        if levels.ndim != 2 or levels.shape[1] != BANDS or not 2 <= len(levels) <= 361:
            wanted = f"(angle,) or (angle, {BANDS}), 2 to 361 angles"
            raise ConfigError(f"level_db has the shape {levels.shape}; allowed is {wanted}")
        if not np.isfinite(levels[0]).all():
            raise ConfigError(f"level_db on the axis is {levels[0].tolist()}; allowed are numbers")
        levels = levels - levels[0]
        if not (levels <= 6.0).all():
            above = "allowed is at most 6 dB above the axis, and no NaN"
            raise ConfigError(
                f"level_db is up to {levels.max()} dB above that on the axis; {above}"
            )
        gain = np.where(levels <= SILENT_DB, 0.0, 10.0 ** (levels / 20.0))
        return cls("polar", tuple(tuple(row) for row in gain.tolist()))

    @classmethod
    def beam(cls, index_db: float | Sequence[float]) -> Directivity:
        """``((1 + cos(angle)) / 2)^n`` with the n that has a directivity index.

        What a data sheet tells of a loudspeaker is often no more.

        Args:
            index_db: 0 to 20 dB, or one for each octave from 63 Hz to 8 kHz.

        Raises:
            ConfigError: Out of that range, or neither one nor eight numbers.
        """
        index = _bands("index_db", index_db)
        if not ((index >= 0.0) & (index <= 20.0)).all():
            raise ConfigError(f"index_db is {index_db}; allowed is 0 to 20 dB")
        # The mean of the squared gain over the sphere is 1 / (2 n + 1).
        n = (10.0 ** (index / 10.0) - 1.0) / 2.0
        cosines = np.cos(np.radians(np.arange(181.0)))
        gain = np.maximum((1.0 + cosines[:, None]) / 2.0, 0.0) ** n
        return cls("polar", tuple(tuple(row) for row in gain.tolist()))

    def index_db(self) -> list[float]:
        """Level on the axis over that of the same power on all sides, dB. Shape (octave,).

        Raises:
            ConfigError: For a sphere, whose pattern the engine computes.
        """
        angles = np.radians(np.linspace(0.0, 180.0, 721))
        if self.form == "first_order":
            gradient = np.asarray(self.values)
            gain = 1.0 - gradient + gradient * np.cos(angles)[:, None]
        elif self.form == "polar":
            table = np.asarray(self.values)
            known = np.linspace(0.0, math.pi, len(table))
            gain = np.stack([np.interp(angles, known, band) for band in table.T], axis=1)
        else:
            raise ConfigError("index_db: a sphere's pattern is the engine's")
        weight = np.sin(angles)[:, None]
        mean = (gain**2 * weight).sum(axis=0) / weight.sum()
        return [float(db) for db in -10.0 * np.log10(mean)]

    def to_json(self) -> Any:  # noqa: ANN401 - as the engine takes it
        """The engine's form."""
        if self.form == "first_order":
            return {"first_order": {"gradient": list(self.values)}}
        if self.form == "sphere":
            return {"sphere": {"radius_m": self.values[0]}}
        return {"polar": {"gain": [list(row) for row in self.values]}}


def _bands(name: str, value: float | Sequence[float]) -> npt.NDArray[np.float64]:
    """One number for each octave."""
    bands = np.asarray(real_array(name, value, np.float64)).reshape(np.shape(value))
    if bands.shape not in ((), (BANDS,)) or not np.isfinite(bands).all():
        raise ConfigError(f"{name} is {quoted(value)}; allowed is a number, or {BANDS} of them")
    return np.broadcast_to(bands, (BANDS,))


#: Directivities by name; ``loudspeaker`` and ``talker`` are points on rigid spheres.
DIRECTIVITIES: dict[str, Any] = {
    "omni": "omni",
    "cardioid": Directivity.first_order(0.5).to_json(),
    "figure_of_eight": Directivity.first_order(1.0).to_json(),
    "talker": Directivity.sphere(0.0875).to_json(),
    "loudspeaker": Directivity.sphere(0.15).to_json(),
}


def directivity_json(directivity: object) -> Any:  # noqa: ANN401 - a name or a table
    """The engine's form of a name or a directivity."""
    if isinstance(directivity, Directivity):
        return directivity.to_json()
    if not isinstance(directivity, str) or directivity not in DIRECTIVITIES:
        names = ", ".join(DIRECTIVITIES)
        raise ConfigError(
            f"directivity: no {quoted(directivity)}; there are {names}, and dwell.Directivity"
        )
    return DIRECTIVITIES[directivity]
