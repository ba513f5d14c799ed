"""Guesses about tables of each kind of measurement, with reasons."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.measured import cleaning, names
from dwell.measured.maps import Map
from dwell.measured.survey import Survey
from dwell.measured.tables import FILE_COLUMN, INDEX_COLUMN
from dwell.measured.units import UNITS

Array = NDArray[np.float64]
#: What a person has to fill in.
UNKNOWN = "in none of the files: fill it in"
#: Steps of a clock, s, below which a unit fits: 2 to 2,000 samples a second.
_LONGEST_STEP_S = 0.35
#: Numbers of clocks that count since 1970, by unit.
_SINCE_1970 = {"s": 1e9, "ms": 1e12, "us": 1e15, "ns": 1e18}


@dataclass
class Guess:
    """A map in the making."""

    mapping: Map
    why: dict[str, str] = field(default_factory=dict)

    def say(self, key: str, value: Any, why: str) -> None:  # noqa: ANN401 - any JSON value
        """Puts a value at a path such as ``table.t_s``, with its reason."""
        *path, last = key.split(".")
        part = self.mapping
        for name in path:
            part = part.setdefault(name, {})
        part[last] = value
        self.why[key] = why

    def unit(self, column: str, unit: Any, why: str) -> None:  # noqa: ANN401
        """Puts the unit of a column."""
        self.mapping.setdefault("table", {}).setdefault("units", {})[column] = unit
        self.why[f"table.units.{column}"] = why


@dataclass
class Clock:
    """The guessed clock of a table: times in seconds, and the rows of each episode."""

    column: str
    times_s: Array
    episodes: list[Any]
    step_s: float


def start(kind: str, **more: object) -> Guess:
    """A map of a kind with the facts that no table tells."""
    guess = Guess({"kind": kind, "title": None, "licence": None, "notes": "", **more})
    guess.why["title"] = guess.why["licence"] = UNKNOWN
    return guess


def guess_table(guess: Guess, survey: Survey) -> None:
    """Which file, and which table of it."""
    guess.say("table.file", survey.file, f"it has the most rows ({survey.rows:,} looked at)")
    if survey.part is not None:
        guess.say("table.part", survey.part, "the table of the file that has these columns")


def guess_clock(guess: Guess, survey: Survey) -> Clock:
    """The columns of episodes and of times, the clock's unit, and what is to be cleaned.

    Raises:
        LookupError: The table has no times.
    """
    told = {*survey.numbers} - {INDEX_COLUMN}
    column = names.first_named([c for c in survey.columns if c in told], names.TIMES)
    episode = names.first_named([c for c in survey.columns if c != column], names.EPISODES)
    if episode is None and len(survey.alike) > 1:
        guess.say("table.episode", FILE_COLUMN, f"{len(survey.alike)} files of the same columns")
    elif episode is None:
        guess.say(
            "table.episode",
            None,
            "no column is called episode, toss, trial, run, ...: "
            "name one; at least four episodes are needed",
        )
    else:
        guess.say("table.episode", episode, f"column {episode!r} is called as episodes are")
    group = names.first_named([c for c in survey.columns if c != episode], names.GROUPS)
    if group is not None and group != column:
        guess.say("table.split_group", group, "its episodes are held out together")
    episodes = survey.episodes(episode)
    if column is None and INDEX_COLUMN not in survey.columns:
        raise LookupError("no column of times")
    if column is None:
        guess.say(
            "table.t_s", INDEX_COLUMN, "no column of times; the samples of an episode count from 0"
        )
        guess.unit(INDEX_COLUMN, {"per_second": None}, "the samples a second: fill it in")
        return Clock(INDEX_COLUMN, survey.numbers[INDEX_COLUMN], episodes, 1.0)
    guess.say("table.t_s", column, f"column {column!r} is called as times are")
    return _clock_of(guess, survey, column, episodes)


def _clock_of(guess: Guess, survey: Survey, column: str, episodes: list[Any]) -> Clock:
    times = survey.numbers[column]
    steps = np.concatenate([np.diff(times[rows]) for rows in episodes])
    rising = steps[steps > 0]
    step = float(np.median(rising)) if len(rising) else 1.0
    unit, why = _time_unit(survey, column, step, float(np.nanmedian(np.abs(times))))
    guess.unit(column, unit, why)
    if isinstance(unit, dict):
        return Clock(column, times, episodes, 1.0)
    seconds = UNITS["time"][unit]
    since_1970 = np.nanmedian(times) > 0.5 * _SINCE_1970.get(unit, np.inf)
    if since_1970:
        guess.say("table.t_zero", "first", f"column {column!r} counts since 1970")
    words: dict[str, str] = {}
    at = "table.cleaning"
    if (steps < 0).any():
        words["unsorted"] = "sort"
        guess.why[f"{at}.unsorted"] = f"{int((steps < 0).sum()):,} rows are before the row above"
    zero = float(np.nanmedian(times)) if since_1970 else 0.0
    clock = Clock(column, (times - zero) * seconds, episodes, step * seconds)
    if words:
        guess.mapping["table"]["cleaning"] = words
    return clock


def _time_unit(survey: Survey, column: str, step: float, size: float) -> tuple[Any, str]:
    named = names.unit_in(column)
    if named in UNITS["time"]:
        return named, f"its name says {named}"
    if column in survey.facts:
        return "s", survey.facts[column]
    if column in ("log_time", "publish_time", "header.stamp"):
        return "s", "times of MCAP are read as seconds since the first message"
    for unit, least in _SINCE_1970.items():
        if 0.5 * least < size < 50.0 * least:
            return unit, f"numbers of about {size:.2g} are {unit} since 1970"
    if step == 1.0:
        return {"per_second": None}, "it rises by 1: frames? Fill in the frames a second"
    unit = next((u for u in ("s", "ms", "us") if step * UNITS["time"][u] < _LONGEST_STEP_S), "ns")
    if step >= _LONGEST_STEP_S:
        unit = next(
            (u for u in ("ms", "us", "ns") if step * UNITS["time"][u] < _LONGEST_STEP_S), "ns"
        )
    rate_hz = 1.0 / (step * UNITS["time"][unit])
    return unit, f"it rises by {step:.6g} as a rule, which in {unit} is {rate_hz:.4g} Hz"


def guess_cleaning(guess: Guess, survey: Survey, clock: Clock, columns: list[str]) -> int:
    """What becomes of lost, repeated and double rows; how many times each frame stands."""
    values = np.stack([survey.numbers[column] for column in columns], axis=1)
    words: dict[str, str] = guess.mapping["table"].get("cleaning", {})
    at = "table.cleaning"
    lost = int(np.isnan(values).any(axis=1).sum())
    known = [values[rows][~np.isnan(values[rows]).any(axis=1)] for rows in clock.episodes]
    times = cleaning.repeats(known)
    if times > 1:
        words["repeated_frames"] = "leave_out"
        guess.why[f"{at}.repeated_frames"] = f"each frame stands {times} times in a row"
    double = gaps = 0
    for rows in clock.episodes:
        order = np.argsort(clock.times_s[rows], kind="stable")
        t, v = clock.times_s[rows][order], values[rows][order]
        if len(t) > 1:
            double += int(((np.diff(t) == 0) & ~cleaning.changes(v)).sum())
            gaps += int((np.diff(t) > 1.5 * clock.step_s).sum())
    if double:
        words["duplicates"] = "leave_out"
        guess.why[f"{at}.duplicates"] = f"{double:,} rows stand twice"
    if lost or gaps:
        words["gaps"] = "split"
        guess.why[f"{at}.gaps"] = (
            f"{lost:,} rows have no number in one of these columns, and {gaps:,} steps of time are "
            "longer than one and a half: parts between them become episodes"
        )
    if words:
        guess.mapping["table"]["cleaning"] = words
    return times


def guess_length(
    guess: Guess, survey: Survey, clock: Clock, columns: list[str]
) -> tuple[int, float] | None:
    """The unit of lengths by what falls; the column that falls and whether it grows downwards."""
    from dwell.measured.guesses.falling import falling

    named = {names.unit_in(column) for column in columns} & {*UNITS["length"]}
    tracks = [
        [(clock.times_s[rows], survey.numbers[column][rows]) for rows in clock.episodes]
        for column in columns
    ]
    found = falling(tracks) if clock.step_s < _LONGEST_STEP_S else None
    for column in columns:
        unit, why = names.unit_in(column), "its name says so"
        if unit not in UNITS["length"] and found is not None:
            axis, _, unit, g = found
            why = f"column {columns[axis]!r} falls by {g:.4g} a second squared: things do in {unit}"
        elif unit not in UNITS["length"]:
            size = float(np.nanmax(np.abs(survey.numbers[column])))
            unit = None if size > 30.0 else "m"
            why = f"nothing falls and no name tells; numbers are up to {size:.3g}"
            why += ": fill it in" if unit is None else ": metres?"
        guess.unit(column, unit, why)
    if found is None or (named and found[2] not in named):
        return None
    return found[0], found[1]
