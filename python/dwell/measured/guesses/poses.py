"""Guesses about poses of a body."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from dwell.measured import names, rotations
from dwell.measured.guesses import (
    UNKNOWN,
    Array,
    Clock,
    Guess,
    guess_cleaning,
    guess_clock,
    guess_length,
    guess_table,
    start,
)
from dwell.measured.guesses.falling import AXES
from dwell.measured.survey import Survey
from dwell.measured.units import UNITS


def guess_poses(tables: list[Survey], _sounds: list[Path]) -> Guess:
    """A map of poses.

    Raises:
        LookupError: No table has positions and a quaternion.
    """
    for survey in tables:
        numeric = [column for column in survey.columns if column in survey.numbers]
        turn = names.quaternion(numeric)
        found = names.triples([c for c in numeric if turn is None or c not in turn[0]])
        places = [t for t in found if not names.is_speed(t[0]) and not names.is_spin(t[0])]
        if turn is not None and places:
            break
    else:
        raise LookupError("no table has three columns of positions and four of a quaternion")
    guess = start("pose_trajectory", axes=None, g_m_s2=9.81)
    guess.why["g_m_s2"] = "usual gravity"
    guess_table(guess, survey)
    clock = guess_clock(guess, survey)
    place = places[0]
    guess.say("table.position", place, "three columns that differ in x, y and z")
    speeds = [t for t in found if names.is_speed(t[0]) and not t[0].startswith("ic_")]
    spins = [t for t in found if names.is_spin(t[0]) and not t[0].startswith("ic_")]
    times = guess_cleaning(guess, survey, clock, [*place, *turn[0]])
    fall = guess_length(guess, survey, clock, place)
    axes = "y_up" if fall is None else AXES[fall]
    guess.say(
        "axes",
        axes,
        "nothing falls: fill it in" if fall is None else f"column {place[fall[0]]!r} falls",
    )
    if fall is None:
        guess.mapping["axes"] = None
    rate_hz = float(f"{1.0 / (clock.step_s * times):.6g}")
    guess.say(
        "poses.rate_hz",
        rate_hz,
        f"times rise by {clock.step_s:.6g} s as a rule"
        + (f", and each frame stands {times} times" if times > 1 else ""),
    )
    guess.say("poses.filtering", "", "the tracker's own filter, such as 'median 3'")
    spin = spins[0] if spins else None
    _guess_rotation(guess, survey, clock, turn, spin)
    if speeds and spin is not None:
        guess.say("table.velocity", speeds[0], "three columns that are called velocities")
        guess.say("table.angular_velocity", spin, "three columns that are called spins")
        _guess_speed(guess, survey, clock, place, speeds[0])
    guess.say("body.name", "body", "any name")
    for key in ("body.mass_kg", "body.half_extents_m", "board.friction", "board.restitution"):
        guess.say(key, None, UNKNOWN)
    return guess


def _guess_rotation(
    guess: Guess,
    survey: Survey,
    clock: Clock,
    turn: tuple[list[str], bool],
    spin: list[str] | None,
) -> None:
    """The order of the quaternion, and the frame and unit of spins."""
    columns, named = turn
    orders = {"quaternion_xyzw": columns}
    if not named:
        orders = {"quaternion_wxyz": columns, "quaternion_xyzw": columns}
    if spin is None:
        key = next(iter(orders))
        why = "its names say so" if named else "w first, as most programs; no spins tell: look"
        guess.say(f"table.{key}", columns, why)
        guess.say("poses.angular_velocity", "world", "there are no spins")
        return
    found: dict[tuple[str, bool, str], float] = {}
    numbers = survey.numbers
    for (key, own), unit in product(orders.items(), ("rad/s", "deg/s")):
        xyzw = own if key == "quaternion_xyzw" else [*own[1:], own[0]]
        pairs = []
        for rows in clock.episodes:
            q = np.stack([numbers[c][rows] for c in xyzw], axis=1)
            w = np.stack([numbers[c][rows] for c in spin], axis=1) * UNITS["spin"][unit]
            whole = ~np.isnan(q).any(axis=1)
            pairs.append((q[whole], w[whole], clock.step_s))
        for in_body, share in (rotations.mismatches(pairs, swapped=False) or {}).items():
            found[key, in_body, unit] = share
    if not found:
        guess.say(f"table.{next(iter(orders))}", columns, "too little turns to tell: look")
        guess.say("poses.angular_velocity", None, "too little turns to tell: fill it in")
        return
    key, in_body, unit = min(found, key=lambda reading: found[reading])
    share = found[key, in_body, unit]
    why = f"so spins agree with the rotations but for {share:.0%} of the turning"
    guess.say(f"table.{key}", orders[key], "its names say so" if named else why)
    guess.say("poses.angular_velocity", "body" if in_body else "world", why)
    for column in spin:
        guess.unit(column, unit, why)


def _guess_speed(
    guess: Guess, survey: Survey, clock: Clock, place: list[str], speed: list[str]
) -> None:
    """The unit of velocities by differences of positions."""
    units = guess.mapping["table"]["units"]
    shown: list[Array] = []
    stated: list[Array] = []
    for rows in clock.episodes:
        t = clock.times_s[rows]
        for p, v in zip(place, speed, strict=True):
            length = UNITS["length"][units[p] or "m"]
            with np.errstate(divide="ignore", invalid="ignore"):
                shown.append(np.diff(survey.numbers[p][rows]) * length / np.diff(t))
            stated.append(survey.numbers[v][rows][1:])
    a, b = np.concatenate(shown), np.concatenate(stated)
    fine = np.isfinite(a) & np.isfinite(b)
    factor = float((a[fine] * b[fine]).sum() / max((a[fine] ** 2).sum(), 1e-12))
    choices = ("m/s", "cm/s", "mm/s", "km/h")
    ratios = [abs(np.log(max(factor, 1e-9) * UNITS["speed"][unit])) for unit in choices]
    unit = choices[int(np.argmin(ratios))]
    for column in speed:
        why = f"so they are {factor * UNITS['speed'][unit]:.2f} times what positions show"
        guess.unit(column, unit, why)
