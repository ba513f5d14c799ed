"""Guesses about a joint that a servo drives."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np

from dwell.measured import names
from dwell.measured.guesses import (
    UNKNOWN,
    Array,
    Guess,
    guess_cleaning,
    guess_clock,
    guess_table,
    start,
)
from dwell.measured.survey import Survey

_JOINT = (
    "inertia_kg_m2",
    "stiffness_n_m_rad",
    "damping_n_m_s_rad",
    "max_torque_n_m",
)


def guess_servo(tables: list[Survey], _sounds: list[Path]) -> Guess:
    """A map of a servo.

    Raises:
        LookupError: No table has a position and its target.
    """
    for survey in tables:
        found = _columns(survey)
        if found is not None:
            break
    else:
        return _guess_apart(tables)
    position, target, why_these = found
    guess = start("servo")
    guess_table(guess, survey)
    several = names.first_named(survey.numbers, ("servo", "motor", "joint", "id"))
    if several is not None and several not in (position, target):
        known = np.unique(survey.numbers[several])
        if 1 < len(known) <= 32:
            told = [int(value) for value in known]
            why = f"the table holds the servos {told}: which? Or make it a part of 'episode'"
            guess.say("table.only", {several: told[0]}, why)
            survey = survey.only(several, float(known[0]))
    clock = guess_clock(guess, survey)
    guess.say("table.position", position, why_these)
    guess.say("table.target", target, why_these)
    guess_cleaning(guess, survey, clock, [position])
    for column in (position, target):
        guess.unit(column, *_unit(column, survey.numbers[position], survey.numbers[target]))
    _guess_joint(guess, position)
    return guess


def _guess_joint(guess: Guess, position: str) -> None:
    guess.say("joint.name", names.bare(position), "any name")
    for key in _JOINT:
        guess.say(f"joint.{key}", None, f"{UNKNOWN}; a value before any fit will do")


def _guess_apart(tables: list[Survey]) -> Guess:
    """A map of positions in one table and commands in another, as topics of a log.

    Raises:
        LookupError: There is no such pair.
    """
    commanding = [t for t in tables if any(word in _title(t) for word in names.TARGETS)]
    for survey, commands in itertools.product(tables, commanding):
        if survey is commands or survey in commanding:
            continue
        position = names.first_named(survey.numbers, names.POSITIONS)
        target = names.first_named(commands.numbers, (*names.TARGETS, *names.POSITIONS, "data"))
        clock = names.first_named(commands.numbers, names.TIMES)
        if position is not None and target is not None and clock is not None:
            break
    else:
        raise LookupError("no table has a column of positions and one of targets")
    guess = start("servo")
    guess_table(guess, survey)
    of_samples = guess_clock(guess, survey)
    guess.say("table.position", position, "its name")
    guess_cleaning(guess, survey, of_samples, [position])
    both = (survey.numbers[position], commands.numbers[target])
    guess.unit(position, *_unit(position, *both))
    why = "its name tells of commands"
    guess.say("commands.file", commands.file, why)
    if commands.part is not None:
        guess.say("commands.part", commands.part, why)
    guess.say("commands.episode", guess.mapping["table"]["episode"], "as of the positions")
    guess.say("commands.t_s", clock, "its name; on the clock of the positions")
    guess.say("commands.target", target, "its name")
    unit, why = _unit(target, *both)
    units = {target: unit}
    time_unit = guess.mapping["table"]["units"].get(of_samples.column)
    if clock == of_samples.column and time_unit is not None:
        units[clock] = time_unit
    guess.say("commands.units", units, why)
    _guess_joint(guess, position)
    return guess


def _title(survey: Survey) -> str:
    return (survey.part or survey.path.stem).lower()


def _columns(survey: Survey) -> tuple[str, str, str] | None:
    """The columns of positions and of targets, and why they are taken."""
    numeric = [column for column in survey.columns if column in survey.numbers]
    for column in numeric:
        if column.startswith("observation.state"):
            other = column.replace("observation.state", "action", 1)
            if other in numeric:
                count = sum(c.startswith("observation.state") for c in numeric)
                return column, other, f"the first of {count} joints of the dataset: which?"
    target = names.first_named(numeric, names.TARGETS)
    rest = [column for column in numeric if column != target]
    rest = [c for c in rest if not any(word in c.lower() for word in names.TARGETS)]
    position = names.first_named(rest, names.POSITIONS)
    if target is None or position is None:
        return None
    return position, target, "its name"


def _unit(column: str, positions: Array, targets: Array) -> tuple[Any, str]:
    named = names.unit_in(column)
    if named in ("rad", "deg", "mrad", "turn"):
        return named, "its name says so"
    both = np.concatenate([positions[~np.isnan(positions)], targets[~np.isnan(targets)]])
    if not len(both):
        return None, "no number tells: fill it in"
    low, high = float(both.min()), float(both.max())
    if (both == np.rint(both)).all() and high > 360.0:
        turn = 4096 if high <= 4096 else 16384 if high <= 16384 else None
        told = {"counts_per_turn": turn, "zero": 0 if turn is None else turn // 2}
        return told, f"whole numbers from {low:g} to {high:g}: counts of an encoder; look both up"
    if max(-low, high) <= 6.6:
        return "rad", f"numbers from {low:.3g} to {high:.3g}"
    caution = ""
    if low >= -100.5 and high <= 100.5:
        caution = (
            "; LeRobot may have written -100 to 100 of the calibrated range, which is no angle"
        )
    return "deg", f"numbers from {low:.3g} to {high:.3g}, too many for radians{caution}"
