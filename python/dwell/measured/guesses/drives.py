"""Guesses about drives of a robot on two wheels."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from dwell.measured import names
from dwell.measured.guesses import (
    UNKNOWN,
    Clock,
    Guess,
    guess_cleaning,
    guess_clock,
    guess_length,
    guess_table,
    start,
)
from dwell.measured.survey import Survey


def guess_drive(tables: list[Survey], _sounds: list[Path]) -> Guess:
    """A map of drives.

    Raises:
        LookupError: No table has a place, a heading and counts of two wheels.
    """
    for survey in tables:
        numeric = [column for column in survey.columns if column in survey.numbers]
        wheels = names.pair(numeric, ("tick", "enc", "count", "wheel"))
        heading = names.first_named(numeric, names.HEADINGS)
        place = _place(numeric)
        if wheels and heading and place:
            break
    else:
        raise LookupError("no table has a place, a heading and counts of a left and right wheel")
    guess = start("drive")
    guess_table(guess, survey)
    clock = guess_clock(guess, survey)
    guess.say("table.position", place, "two columns that differ in x and y")
    guess.say("table.heading_rad", heading, "its name")
    for key, column in zip(("ticks_left", "ticks_right"), wheels, strict=True):
        guess.say(f"table.{key}", column, "its name; counts since the sample before are meant")
    guess_cleaning(guess, survey, clock, [*place, heading, *wheels])
    guess_length(guess, survey, clock, place)
    unit = _heading_unit(survey, clock, place, heading)
    guess.unit(heading, *unit)
    guess.say(
        "base.rate_hz",
        float(f"{1.0 / clock.step_s:.6g}"),
        f"times rise by {clock.step_s:.6g} s as a rule",
    )
    for key in ("wheel_radius_m", "wheel_base_m", "ticks_per_turn"):
        guess.say(f"base.{key}", None, UNKNOWN)
    episode = guess.mapping["table"]["episode"]
    for other in tables:
        if other is not survey and episode in other.columns:
            group = names.first_named([c for c in other.columns if c != episode], names.GROUPS)
            path = names.first_named(
                [c for c in other.columns if c != episode],
                ("path", "condition", "conditions", "surface", "floor"),
            )
            guess.say("episodes.file", other.file, f"it has the column {episode!r} too")
            guess.say("episodes.episode", episode, "as in the table of samples")
            guess.say("episodes.split_group", group or episode, "held out together")
            guess.say("episodes.conditions", path or episode, "what was special")
            break
    return guess


def _place(columns: list[str]) -> list[str] | None:
    known = {names.bare(column): column for column in columns}
    for x, y in (("x", "y"), ("px", "py"), ("pos_x", "pos_y"), ("position.x", "position.y")):
        if x in known and y in known:
            return [known[x], known[y]]
    return None


def _heading_unit(survey: Survey, clock: Clock, place: list[str], heading: str) -> tuple[str, str]:
    """Radians or degrees: whichever points where the robot goes, or back."""
    named = names.unit_in(heading)
    if named in ("rad", "deg"):
        return named, "its name says so"
    agree = {"rad": 0.0, "deg": 0.0}
    total = 0.0
    for rows in clock.episodes:
        x, y, turn = (survey.numbers[c][rows] for c in (*place, heading))
        dx, dy, turn = np.diff(x), np.diff(y), turn[1:]
        fine = np.isfinite(dx) & np.isfinite(dy) & np.isfinite(turn)
        dx, dy, turn = dx[fine], dy[fine], turn[fine]
        total += float(np.hypot(dx, dy).sum())
        for unit, scale in (("rad", 1.0), ("deg", np.pi / 180.0)):
            agree[unit] += float((dx * np.cos(scale * turn) + dy * np.sin(scale * turn)).sum())
    unit = max(agree, key=lambda name: abs(agree[name]))
    share = abs(agree[unit]) / max(total, 1e-12)
    return unit, f"so {share:.0%} of the way goes along the heading"
