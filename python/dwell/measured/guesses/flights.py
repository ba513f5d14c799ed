"""Guesses about flights of balls."""

from __future__ import annotations

from pathlib import Path

from dwell.measured import names
from dwell.measured.guesses import (
    UNKNOWN,
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


def guess_flight(tables: list[Survey], _sounds: list[Path]) -> Guess:
    """A map of flights.

    Raises:
        LookupError: No table has times and a height or three coordinates.
    """
    for survey in tables:
        numeric = [column for column in survey.columns if column in survey.numbers]
        places = [
            t
            for t in names.triples(numeric)
            if not names.is_speed(t[0]) and not names.is_spin(t[0])
        ]
        height = names.first_named(numeric, names.HEIGHTS)
        if (places or height) and names.first_named(numeric, names.TIMES):
            break
    else:
        raise LookupError("no table has times and a height or three coordinates")
    guess = start("trajectory", g_m_s2=9.81)
    guess.why["g_m_s2"] = "usual gravity"
    guess_table(guess, survey)
    clock = guess_clock(guess, survey)
    columns = places[0] if places else [str(height)]
    guess_cleaning(guess, survey, clock, columns)
    fall = guess_length(guess, survey, clock, columns)
    if places:
        guess.say(
            "table.channels",
            dict(zip("xyz", columns, strict=True)),
            "three columns that differ in x, y and z",
        )
        axes = None if fall is None else AXES[fall]
        why = "nothing falls: fill it in"
        guess.say("axes", axes, why if fall is None else f"column {columns[fall[0]]!r} falls")
    else:
        guess.say("table.channels", {"y": columns[0]}, f"column {columns[0]!r} is called a height")
        if fall is not None and fall[1] < 0:
            unit = guess.mapping["table"]["units"].pop(columns[0])
            factor = -UNITS["length"][unit]
            guess.unit(columns[0], {"factor": factor}, "it grows downwards")
    _guess_bodies(guess, tables)
    return guess


def _guess_bodies(guess: Guess, tables: list[Survey]) -> None:
    for survey in tables:
        mass = names.first_named(survey.numbers, ("mass", "weight"))
        across = names.first_named(survey.numbers, ("diameter", "size"))
        if mass is None or across is None:
            continue
        guess.say("bodies.file", survey.file, "it has masses and diameters")
        episode = names.first_named(survey.columns, names.EPISODES)
        guess.say("bodies.episode", episode, "as in the table of samples")
        name = names.first_named([c for c in survey.columns if c != episode], names.NAMES)
        guess.say("bodies.name", name or episode, "the body's name")
        guess.say("bodies.mass_kg", mass, "its name")
        guess.say("bodies.diameter_m", across, "its name")
        units = {}
        for column, usual in ((mass, "kg"), (across, "m")):
            units[column] = names.unit_in(column) or usual
        guess.say("bodies.units", units, "names, else kg and m: look")
        return
    for key in ("file", "episode", "name", "mass_kg", "diameter_m"):
        guess.say(f"bodies.{key}", None, "a table of bodies with masses and diameters is needed")
    guess.why["bodies.mass_kg"] = UNKNOWN
