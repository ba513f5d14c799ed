"""Whether what flies falls as things do there, and what explains that it does not."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.measured.units import UNITS, Unit, written

Array = NDArray[np.float64]

STANDARD_GRAVITY_M_S2 = 9.80665
#: Gas constant of dry air, J/(kg K).
_AIR_J_KG_K = 287.05
#: Deviation of a fall from what is told, beside what air does, that is no fault of units.
_TOLERANCE = 0.3
#: The most that air does to a sphere, as a coefficient of half density, speed squared and section:
#: drag (0.1 to 0.8 of balls, up to 1.2 of rough slow ones) and lift (up to 0.5) together.
_MOST_OF_AIR = 1.5
#: Times free fall up to which lift is believed to pull things down for most of their way: spin
#: presses a table-tennis ball down by twice its weight in fast strokes, for a part of them.
_MOST_PRESSED = 2.8
#: Share of the air's weight in that of the body above which buoyancy and the air that is carried
#: along rule: a balloon.
_LIGHT = 0.3
#: Radius of no body that flies, m; of larger ones not even the volume is a float.
_HUGE_M = 1e6
#: Shares of all samples: below the first nothing falls as it is told; from the second on a cause
#: explains the motion, if it explains more than what is told by the third.
_FALLING, _TELLING, _BETTER = 0.25, 0.6, 0.3
#: Causes are told together whose accelerations are within this of the nearest, as a logarithm.
_CLOSE = 0.25
#: Acceleration that is told of where free fall is 0, m/s2; air slows what flies.
_WEIGHTLESS_M_S2 = 1.0
#: Reaches of an acceleration, as parts of a flight: near ones catch what changes, far ones see
#: through noise. What holds of two of the three holds.
_PARTS = (4, 8, 16)
#: Frames a second of cameras.
_FRAME_RATES = (24, 25, 30, 48, 50, 60, 90, 100, 120, 150, 200, 240, 250, 300, 480, 500, 960, 1000)
#: Free fall on planets and moons on which something was measured, times that on Earth.
_LEAST_GRAVITY, _MOST_GRAVITY = 0.1, 3.0
_NAMES = {
    "m": "metres",
    "dm": "decimetres",
    "cm": "centimetres",
    "mm": "millimetres",
    "in": "inches",
    "ft": "feet",
    "s": "seconds",
    "ms": "milliseconds",
    "us": "microseconds",
    "ns": "nanoseconds",
    "min": "minutes",
}
#: What ``dwell calibrate`` says itself, with the table's own keys, by what is told and what is.
_TOLD_LATER = {
    ("length", 1.0): ("mm", "cm", "in", "ft"),
    ("time", 1.0): ("ms", "us", "ns"),
    **{("length", UNITS["length"][small]): ("m",) for small in ("mm", "cm", "in")},
    **{("time", UNITS["time"][small]): ("s",) for small in ("ms", "us", "ns")},
}


@dataclasses.dataclass(frozen=True)
class Flight:
    """An episode.

    Attributes:
        t_s: Times.
        places: Shape (sample, axis), m.
        mass_kg: Of what flew.
        radius_m: Of what flew.
    """

    t_s: Array
    places: Array
    mass_kg: float
    radius_m: float


@dataclasses.dataclass(frozen=True)
class Told:
    """What a map says of columns and of gravity.

    Attributes:
        heights: The column of heights.
        height_axis: Which of the places' axes that is.
        unit: What its numbers are.
        is_named: Whether the map's ``units`` name a column of lengths, so that
            ``metres_per_unit`` says nothing of it.
        clock: The column of times.
        seconds: What one of its numbers is, s.
        frames: Whether times are numbers of frames.
        g_m_s2: Free fall, unchecked; ``None`` where the map does not say it.
        environment: ``temperature_c`` and ``pressure_pa`` where they are there.
    """

    heights: str
    height_axis: int
    unit: Unit
    is_named: bool
    clock: str
    seconds: float
    frames: bool
    g_m_s2: Any
    environment: Mapping[str, Any]

    @property
    def metres(self) -> float:
        """What one of the heights' numbers is, m."""
        return abs(self.unit.factor)


@dataclasses.dataclass(frozen=True)
class _Motion:
    """Of all samples, for one reach of the acceleration.

    Attributes:
        fall: Acceleration downwards, m/s2.
        air: The most that air does to it at that speed, m/s2.
    """

    fall: Array
    air: Array


@dataclasses.dataclass(frozen=True)
class _Cause:
    """A slip that may be in the map.

    Attributes:
        length: How many times too large lengths are then.
        time: How many times too large times are then.
        hint: What to write.
        is_told_later: Whether reading the bundle tells it.
    """

    length: float
    time: float
    hint: str
    is_told_later: bool = False

    @property
    def fall(self) -> float:
        """How many times too large accelerations are then."""
        return self.length / self.time**2


def check(at: str, flights: Iterable[Flight], told: Told) -> str | None:
    """Looks at all flights of a table.

    Args:
        at: What messages begin with.
        flights: The episodes, with the map's units.
        told: What the map says.

    Returns:
        A note where things do not fall as is told, and no usual slip of units explains it.

    Raises:
        ValueError: They do not, and one does.
    """
    g: Any = STANDARD_GRAVITY_M_S2 if told.g_m_s2 is None else told.g_m_s2
    motions = _motions(flights, told)
    # What is no gravity is refused with the bundle.
    if motions is None or not isinstance(g, int | float) or not 0.0 <= g < math.inf:
        return None
    fall = float(np.median(motions[0].fall))
    expected = f"free fall is {g:g}" + ("" if told.g_m_s2 is None else " by g_m_s2")
    said = f"what flies falls at about {fall:.3g} m/s2 by column {told.heights!r}, and {expected}"
    share = _share(motions, g) if g else 0.0
    if not math.isclose(g, STANDARD_GRAVITY_M_S2, rel_tol=_TOLERANCE):
        on_earth = _share(motions, STANDARD_GRAVITY_M_S2, _Cause(1.0, 1.0, ""))
        if on_earth >= _TELLING and on_earth >= share + _BETTER:
            told_so = (
                f'{said}: so things fall on Earth. Write the free fall of the place for "g_m_s2", '
                "or leave it out"
            )
            # A wrong gravity is what calibration finds; but not where reading the bundle takes it
            # for a wrong unit, or where no planet has it.
            later = [cause for cause in _causes(told, 1.0) if cause.is_told_later]
            is_mistaken = any(_falls_by(motions, g * cause.fall) >= _FALLING for cause in later)
            if share < _FALLING and (is_mistaken or g > _MOST_GRAVITY * STANDARD_GRAVITY_M_S2):
                raise ValueError(f"{at}: {told_so}")
            return told_so
    if share >= _TELLING or (g == 0.0 and abs(fall) < _WEIGHTLESS_M_S2):
        return None
    causes = _causes(told, fall / g) if g else []
    shares = [_share(motions, g, cause) for cause in causes]
    # How far the fall is from what each of them makes of it.
    apart = [abs(math.log(max(fall, 1e-12) / (g * cause.fall))) for cause in causes]
    order = sorted(range(len(causes)), key=lambda k: apart[k])
    telling = [k for k in order if shares[k] >= max(_TELLING, share + _BETTER)]
    near = [causes[k] for k in telling if apart[k] <= apart[telling[0]] + _CLOSE]
    if near and all(cause.is_told_later for cause in near):
        return None
    hints = "; or ".join(dict.fromkeys(cause.hint for cause in near[:3]))
    if near and told.g_m_s2 is None and _LEAST_GRAVITY <= fall / g <= _MOST_GRAVITY:
        hints += '; or is free fall another there? Write "g_m_s2"'
    if near and share < _FALLING:
        raise ValueError(f"{at}: {said}: {hints}")
    if near or share < _FALLING:
        return f"{said}: {hints or 'are units, frame rate and g_m_s2 right?'}"
    return None


def _motions(flights: Iterable[Flight], told: Told) -> list[_Motion] | None:
    """The motions at each reach; ``None`` where nothing can be said."""
    rows: list[list[tuple[Array, Array]]] = [[] for _ in _PARTS]
    air_kg_m3 = _air_density(told.environment)
    for flight in flights:
        # What is no mass or no radius is refused with the bundle.
        if not 0.0 < flight.mass_kg < math.inf or not 0.0 < flight.radius_m < _HUGE_M:
            continue
        volume_m3 = 4.0 / 3.0 * math.pi * flight.radius_m**3
        if air_kg_m3 * volume_m3 > _LIGHT * flight.mass_kg:
            continue
        section_m2 = math.pi * flight.radius_m**2
        pull = 0.5 * air_kg_m3 * _MOST_OF_AIR * section_m2 / flight.mass_kg
        for k, part in enumerate(_PARTS):
            found = _accelerations(flight.t_s, flight.places, max(len(flight.t_s) // part, 1))
            if found is not None and len(found[0]):
                acceleration, speed = found
                with np.errstate(over="ignore"):
                    rows[k].append((-acceleration[:, told.height_axis], pull * speed**2))
    if not all(rows):
        return None
    return [
        _Motion(np.concatenate([a for a, _ in row]), np.concatenate([b for _, b in row]))
        for row in rows
    ]


def _air_density(environment: Mapping[str, Any]) -> float:
    """Density of dry air, kg/m3, by the ideal gas."""
    found = {"temperature_c": 20.0, "pressure_pa": 101_325.0}
    for name in found:
        value = environment.get(name)
        if isinstance(value, int | float) and math.isfinite(value):
            found[name] = float(value)
    kelvin = max(found["temperature_c"] + 273.15, 1.0)
    return max(found["pressure_pa"], 0.0) / (_AIR_J_KG_K * kelvin)


def _accelerations(t: Array, places: Array, reach: int) -> tuple[Array, Array] | None:
    """Accelerations (sample, axis) of samples with those so many before and after, and speeds."""
    if len(t) <= 2 * reach:
        return None
    before, here, after = t[: -2 * reach], t[reach:-reach], t[2 * reach :]
    low, middle, high = places[: -2 * reach], places[reach:-reach], places[2 * reach :]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        first = (middle - low) / (here - before)[:, None]
        second = (high - middle) / (after - here)[:, None]
        acceleration = 2.0 * (second - first) / (after - before)[:, None]
        speed = np.linalg.norm(high - low, axis=1) / (after - before)
    good = np.isfinite(acceleration).all(axis=1) & np.isfinite(speed)
    return acceleration[good], speed[good]


def _share(motions: Sequence[_Motion], g: float, cause: _Cause | None = None) -> float:
    """The share of samples that fall by ``g`` and the air, were it not for a slip."""

    def of(motion: _Motion) -> float:
        fall, air = motion.fall / g, motion.air / g
        if cause is not None:
            fall, air = fall / cause.fall, air * (cause.time / cause.length) ** 2
            # With a unit of one's choice nearly anything could be air.
            air = np.minimum(air, _TOLERANCE)
        low = 1.0 - _TOLERANCE - air
        high = 1.0 + _TOLERANCE + np.minimum(air, _MOST_PRESSED - 1.0 - _TOLERANCE)
        return float(((fall >= low) & (fall <= high)).mean())

    return _middle(motions, of)


def _falls_by(motions: Sequence[_Motion], g: float) -> float:
    """The share of samples that fall by ``g``, whatever the air."""
    if g == 0.0:
        return 0.0
    return _middle(motions, lambda one: float((np.abs(one.fall / g - 1.0) <= _TOLERANCE).mean()))


def _middle(motions: Sequence[_Motion], of: Callable[[_Motion], float]) -> float:
    return sorted(map(of, motions))[len(motions) // 2]


def _causes(told: Told, found: float) -> list[_Cause]:
    """Slips that are usual; ``found``: how many times too fast things fall."""
    causes = []
    for name, metres in UNITS["length"].items():
        # Nobody writes places of flights in micrometres.
        if name != "um" and not math.isclose(metres, told.metres):
            later = name in _TOLD_LATER.get(("length", told.metres), ())
            scale = "" if told.is_named else f', or "metres_per_unit": {metres:g},'
            hint = (
                f'are lengths in {_NAMES[name]}? Write "{name}" for the "units" of '
                f"{told.heights!r} and of all lengths like it{scale} in the map's table"
            )
            causes.append(_Cause(told.metres / metres, 1.0, hint, later))
    named = [cause.length for cause in causes]
    for times in (10.0, 100.0, 1000.0):
        for factor, word in ((times, "large"), (1.0 / times, "small")):
            if not any(math.isclose(factor, one) for one in named):
                what = f'"metres_per_unit": {told.metres / factor:g}'
                if told.is_named:
                    unit = written(told.unit.read_as(Unit(1.0 / factor)), "length")
                    like = f"{told.heights!r} and of all lengths like it"
                    what = f'{json.dumps(unit)} for the "units" of {like}'
                hint = f"are lengths {times:g} times too {word}? Write {what} in the map's table"
                causes.append(_Cause(factor, 1.0, hint))
    if told.frames:
        return causes + _frame_rates(told, found)
    for name, seconds in UNITS["time"].items():
        if not math.isclose(seconds, told.seconds):
            later = name in _TOLD_LATER.get(("time", told.seconds), ())
            hint = (
                f'are times in {_NAMES[name]}? Write "{name}" for the "units" of '
                f"{told.clock!r} in the map's table"
            )
            causes.append(_Cause(1.0, told.seconds / seconds, hint, later))
    for times in (2.0, 4.0):
        for factor, word in ((times, "long"), (1.0 / times, "short")):
            hint = (
                f"are times in column {told.clock!r} {times:g} times too {word}, as of another "
                'frame rate? Write {"factor": '
                f'{told.seconds / factor:g}}} for its "units" in the map\'s table'
            )
            causes.append(_Cause(1.0, factor, hint))
    return causes


def _frame_rates(told: Told, found: float) -> list[_Cause]:
    """Other frame rates than that which is told: the usual one that fits best."""
    rate = 1.0 / told.seconds
    if found <= 0.0:
        return []
    fitting = rate / math.sqrt(found)
    usual = min(_FRAME_RATES, key=lambda one: abs(math.log(one / fitting)))
    if math.isclose(usual, rate):
        return []
    hint = (
        f'is the frame rate {usual}, not {rate:g}? Write {{"per_second": {usual}}} for the "units" '
        f"of {told.clock!r} in the map's table"
    )
    return [_Cause(1.0, usual / rate, hint)]
