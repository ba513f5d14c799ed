"""Cells of tables of measurements, and what to change where they hold something else."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from dwell.arguments import abbreviated_list

#: What parts the cells of a row, by the head of the table.
DELIMITERS = (",", ";", "\t")


def delimiter_of(head: str) -> str:
    """The delimiter: a comma, or semicolon or tab where the head has no comma."""
    return next((mark for mark in DELIMITERS if mark in head), ",")


def encoding_error(path: Path, error: UnicodeDecodeError) -> ValueError:
    """The fault of a file that is no UTF-8."""
    byte = error.object[error.start]
    return ValueError(
        f"{path}: byte {byte:#04x} at {error.start} is no UTF-8; save the file as UTF-8 "
        "(spreadsheets call it CSV UTF-8)"
    )


def require_unique_columns(path: Path, columns: Sequence[str], names: Sequence[str]) -> None:
    """Refuses a head that lacks columns, or has one of them twice."""
    for name in names:
        if columns.count(name) > 1:
            count = columns.count(name)
            raise ValueError(
                f"{path}: {count} columns are called {name!r}, and the map names one of them; give "
                "each a name of its own"
            )
        if name not in columns:
            near = similar_column(name, columns)
            meant = f"; write {near!r} in the map if that is meant" if near else ""
            raise ValueError(
                f"{path}: no column {name!r}; it has {abbreviated_list(columns, 20)}{meant}"
            )


def similar_column(name: str, columns: Sequence[str]) -> str | None:
    """The column that may be meant: of that name but for unit and case, or of a similar one."""

    def bare(text: str) -> str:
        text = re.sub(r"[\[(].*", "", text).strip().lower()
        return re.sub(r"_(s|ms|us|ns|m|mm|cm|rad|deg|kg|g)$", "", text)

    same = [column for column in columns if bare(column) == bare(name)]
    return next(iter(same or difflib.get_close_matches(name, columns, 1)), None)


def parse_cell_number(at: str, row: Mapping[str, object], column: str, delimiter: str) -> float:
    """A finite number in a column; it may have a decimal comma where commas part no cells."""
    value = row.get(column)
    told = value.strip() if isinstance(value, str) else value
    if isinstance(told, str) and delimiter != "," and told.count(",") == 1 and "." not in told:
        told = told.replace(",", ".")
    try:
        # To Python 3_9.9 and full-width digits are numbers; to tables they are slips.
        is_slip = isinstance(told, str) and ("_" in told or not told.isascii())
        found = math.nan if is_slip else float(told)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        found = math.nan
    if math.isfinite(found):
        return found
    raise ValueError(
        f"{at}: column {column!r} {'is empty' if told in (None, '') else f'is {value!r}'}; "
        f"a finite number is needed{suggested_fix(told)}"
    )


def suggested_fix(told: object) -> str:
    """The remedy for a cell that is no finite number."""
    if told in (None, "") or (isinstance(told, float) and math.isnan(told)):
        return MISSING_NUMBER_HINT
    text = str(told)
    if text.lower() in ("nan", "na", "n/a", "null", "none", "-", "inf", "-inf"):
        return MISSING_NUMBER_HINT
    if re.fullmatch(r"[-+]?[\d.]*,\d+", text):
        return (
            f": a decimal comma? Write {text.replace('.', '').replace(',', '.')}, "
            "or part the cells by semicolons"
        )
    if re.fullmatch(r"[-+]?[\d.]+(e[-+]?\d+)?\s*[^\d\s]+", text, re.IGNORECASE):
        return ": the number alone, without its unit"
    return ""


#: What to do about a number that is not there.
MISSING_NUMBER_HINT = (
    ": fill it in, or leave the row out; where times must be even, end the episode before it and "
    "give the rows after it another episode's name"
)


class TimeParser:
    """Times of samples, s: they rise from row to row of an episode."""

    def __init__(self, column: str, seconds_per_unit: float, *, is_in_units: bool = False) -> None:
        """A column, the seconds in one of its numbers, and whether the map's ``units`` say so."""
        self.column = column
        self.seconds_per_unit = seconds_per_unit
        self._key = f"the unit of {column!r} in 'units'" if is_in_units else "seconds_per_unit"
        self._unit = (
            f"{seconds_per_unit:g} s each" if is_in_units else f"{self._key} {seconds_per_unit:g}"
        )
        self._last: dict[str, tuple[float, str]] = {}

    def stamp(self, at: str, episode: str, told: float) -> str:
        """The time of a row, as bundles write it."""
        before, there = self._last.get(episode, (-math.inf, ""))
        if told <= before:
            again = "again" if told == before else f"after {before:g}"
            row = there.rpartition(" ")[2]
            raise ValueError(
                f"{at}: column {self.column!r} is {told:g} {again} (row {row}) in episode "
                f"{episode!r}; times rise within an episode: sort its rows by time, leave out what "
                "stands twice, and give every recording an episode's name of its own"
            )
        self._last[episode] = (told, at)
        stamp = self._told(told)
        if told > before > -math.inf and float(stamp) <= float(self._told(before)):
            raise ValueError(
                f"{at}: column {self.column!r} is {told:g} after {before:g} (row "
                f"{there.rpartition(' ')[2]}), and both are {stamp} s at {self._unit}; times "
                f"rise within an episode by 1e-9 s or more: correct {self._key} in the map"
            )
        if not math.isfinite(float(stamp)):
            raise ValueError(
                f"{at}: column {self.column!r} is {told:g}, which is no finite number of seconds "
                f"at {self._unit}; correct one of them"
            )
        return stamp

    def _told(self, told: float) -> str:
        return f"{told * self.seconds_per_unit:.9f}"
