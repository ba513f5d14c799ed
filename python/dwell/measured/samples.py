"""The samples of a table by episode: read, in SI, in order, and cut where they have gaps."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dwell.csv_values import TimeParser
from dwell.measured import cleaning
from dwell.measured.hints import FieldUnit, for_columns
from dwell.measured.maps import Job, Map, choice, require
from dwell.measured.places import Place
from dwell.measured.readers import Row
from dwell.measured.tables import FILE_COLUMN, MeasuredTable, names_of
from dwell.measured.units import ColumnUnits, Unit

Array = NDArray[np.float64]
#: Time from sample to sample, where it need not be even, from which on it is a gap, s.
_LONGEST_S = 0.5
#: Rows between two words of progress.
_ROWS_A_WORD = 4096


@dataclass(frozen=True)
class Field:
    """A number of every sample.

    Attributes:
        column: The user's.
        dimension: What it measures.
        optional: Whether a sample without it is kept.
        key: Where the table's part of the map names the column.
    """

    column: str
    dimension: str
    optional: bool = False
    key: str = ""


def fields_of(
    columns: Sequence[str], dimension: str, key: str, *, optional: bool = False
) -> list[Field]:
    """A field of each of a list's columns."""
    return [Field(column, dimension, optional, f"{key}[{k}]") for k, column in enumerate(columns)]


@dataclass(frozen=True)
class Episode:
    """The samples of one episode, by time.

    Attributes:
        name: In the bundle.
        source: The user's name, of which this may be a part.
        group: Episodes of one group are held out together.
        conditions: In words.
        times: As the column has them, from the episode's zero.
        values: In SI. Shape (sample, field).
        numbers: Of each sample among the rows of the user's episode, from 0.
        rows: Of each sample, as (file, row).
        paths: The files.
        zero: The time that was taken from ``times``.
    """

    name: str
    source: str
    group: str
    conditions: str
    times: Array
    values: Array
    numbers: NDArray[np.int64]
    rows: NDArray[np.int64]
    paths: Sequence[Path]
    zero: float = 0.0

    def place(self, k: int) -> Place:
        """The place of a sample."""
        file, row = self.rows[k]
        return Place(self.paths[int(file)], int(row))

    def of(self, kept: NDArray[np.bool_] | NDArray[np.int64] | slice) -> Episode:
        """Some of the samples."""
        return replace(
            self,
            times=self.times[kept],
            values=self.values[kept],
            numbers=self.numbers[kept],
            rows=self.rows[kept],
        )


@dataclass
class Samples:
    """All episodes of a table.

    Attributes:
        episodes: In the order in which they begin.
        clock: Makes times as bundles write them, and refuses those that do not rise.
    """

    episodes: list[Episode]
    clock: TimeParser

    @property
    def rows(self) -> int:
        """How many samples."""
        return sum(len(episode.times) for episode in self.episodes)

    def stamps(self, episode: Episode) -> list[str]:
        """The times of an episode, s."""
        return [
            self.clock.stamp(str(episode.place(k)), episode.name, float(told))
            for k, told in enumerate(episode.times)
        ]


@dataclass
class _Growing:
    """An episode that is being read."""

    group: str
    conditions: str
    times: array[float] = field(default_factory=lambda: array("d"))
    values: array[float] = field(default_factory=lambda: array("d"))
    numbers: array[int] = field(default_factory=lambda: array("q"))
    rows: array[int] = field(default_factory=lambda: array("q"))
    seen: int = 0


class SampleReader:
    """Reads the table of a map's part."""

    def __init__(
        self,
        job: Job,
        part: Map,
        at: str,
        fields: Sequence[Field],
        held: Field | None = None,
        *,
        lends_scales: bool = False,
    ) -> None:
        """Opens it, and refuses columns that are not there.

        Args:
            job: The import.
            part: The table's part of the map.
            at: How messages name it.
            fields: What every sample has.
            held: What holds until it changes, and counts in rows without a sample too.
            lends_scales: Whether another part of the map may be read by the table's scales.
        """
        self.job, self.part, self.at = job, part, at
        self.fields = fields
        self.table = MeasuredTable(part, job.files, at)
        several = len(self.table.paths) > 1
        self.episode = names_of(part, "episode", at, [FILE_COLUMN] if several else [])
        if not self.episode:
            require(part, "episode", at)
        self.group = names_of(part, "split_group", at, self.episode)
        self.conditions = names_of(part, "conditions", at, [])
        self.clock: str = require(part, "t_s", at)
        _refuse_shared(at, self.clock, [*fields, *([] if held is None else [held])])
        names = [*self.episode, *self.group, *self.conditions, self.clock]
        if held is not None:
            names.append(held.column)
        self.table.has([*dict.fromkeys([*names, *(own.column for own in fields)])])
        self.units = units = ColumnUnits(part, at)
        #: What one number of the clock is, s.
        self.clock_unit = units.unit(self.clock, "time")
        self._units = [units.unit(own.column, own.dimension) for own in fields]
        self._held = held
        self._held_unit = None if held is None else units.unit(held.column, held.dimension)
        #: By the user's episode: time as the column has it, value in SI, and where it stands.
        self.held: dict[str, list[tuple[float, float, Place]]] = {}
        #: The user's episodes that were left out for too few samples.
        self.short: set[str] = set()
        units.refuse_unused()
        if not lends_scales:
            units.refuse_idle()
        #: What hints speak of, and the columns by the bundle's names.
        self.hinted = [self._hinted(Field(self.clock, "time", key="t_s"), self.clock_unit)]
        self.hinted += [self._hinted(*row) for row in zip(fields, self._units, strict=True)]
        if held is not None and self._held_unit is not None:
            self.hinted.append(self._hinted(held, self._held_unit))
        self.bundle_names: dict[str, str] = {}
        job.draft.hints = lambda fault: for_columns(fault, self.hinted, self.bundle_names)
        self._from_first = choice(part, "t_zero", ("first",), at) is not None
        self.cleaning = cleaning.Cleaning(part.get("cleaning") or {}, f"{at}: cleaning")
        job.draft.measured(self.table.name, self.clock, "/".join(self.episode))
        if self.cleaning.gaps is None:
            job.draft.gap_hint = (
                '; or write "cleaning": {"gaps": "split"} in the map\'s table, which makes an '
                "episode of each part"
            )

    def _hinted(self, own: Field, unit: Unit) -> FieldUnit:
        is_named = self.units.names(own.column)
        return FieldUnit(own.column, own.dimension, unit, is_named, own.key)

    def unit_of(self, column: str) -> Unit:
        """The unit of a field's column."""
        found = zip(self.fields, self._units, strict=True)
        return next(unit for own, unit in found if own.column == column)

    def read(
        self,
        *,
        step_s: float | None,
        fewest: int,
        accept: Callable[[Place, str], bool] | None = None,
    ) -> Samples:
        """All samples.

        Args:
            step_s: The time between samples where it must be even; ``None``: below 0.5 s.
            fewest: Parts between gaps that have fewer samples are left out, and whole episodes
                where the map says so.
            accept: Says whether an episode is kept.
        """
        growing = self._grown(accept)
        paths = self.table.paths
        episodes = []
        for name, own in growing.items():
            if not own.times:
                continue
            values = np.frombuffer(own.values, np.float64).reshape(len(own.times), -1)
            told = np.frombuffer(own.times, np.float64)
            numbers = np.frombuffer(own.numbers, np.int64)
            rows = np.frombuffer(own.rows, np.int64).reshape(-1, 2)
            episode = Episode(
                name, name, own.group, own.conditions, told, values, numbers, rows, paths
            )
            episodes.append(self.cleaning.ordered(episode, self.clock, self._columns()))
        episodes = self.cleaning.without_repeats(episodes, self.table.name, self.job.notes)
        if self._from_first:
            episodes = [_from_first(episode) for episode in episodes]
        seconds = self.clock_unit.factor
        longest = cleaning.Longest(_LONGEST_S if step_s is None else 1.5 * step_s, seconds)
        episodes = self.cleaning.parts(episodes, longest, fewest, self.job.notes)
        enough = self.cleaning.without_short(episodes, fewest, self.table.name, self.job.notes)
        self.short = {e.source for e in episodes} - {e.source for e in enough}
        episodes = enough
        for episode in episodes:
            self.job.draft.begins(episode.name, episode.place(0))
        in_si = [replace(episode, values=self._si(episode.values)) for episode in episodes]
        is_named = self.units.names(self.clock)
        return Samples(in_si, TimeParser(self.clock, seconds, is_in_units=is_named))

    def _hold(self, place: Place, row: Row, name: str, told: float) -> None:
        if self._held is None or self._held_unit is None:
            return
        value = self.table.measured(place, row, self._held.column)
        rows = self.held.setdefault(name, [])
        value = self._held_unit.one(value)
        is_new = not rows or rows[-1][1] != value or self.cleaning.unsorted is not None
        if value == value and is_new:
            rows.append((told - self.clock_unit.zero, value, place))

    def _columns(self) -> list[str]:
        return [own.column for own in self.fields]

    def _si(self, values: Array) -> Array:
        columns = [unit.si(values[:, k]) for k, unit in enumerate(self._units)]
        return np.stack(columns, axis=1)

    def _grown(self, accept: Callable[[Place, str], bool] | None) -> dict[str, _Growing]:
        growing: dict[str, _Growing] = {}
        missing: Counter[tuple[str, ...]] = Counter()
        table, count = self.table, 0
        files = {path: k for k, path in enumerate(table.paths)}
        for place, row in table:
            name = table.text(row, self.episode)
            if accept is not None and not accept(place, name):
                continue
            count += 1
            own = growing.get(name)
            if own is None:
                group, conditions = (
                    table.text(row, names) for names in (self.group, self.conditions)
                )
                own = growing[name] = _Growing(group, conditions)
            own.seen += 1
            told = table.measured(place, row, self.clock)
            values = [table.measured(place, row, of.column) for of in self.fields]
            lost = [
                of.column
                for of, value in zip(self.fields, values, strict=True)
                if value != value and not of.optional
            ]
            if told != told:
                lost.append(self.clock)
            else:
                self._hold(place, row, name, told)
            if lost:
                missing[(*dict.fromkeys(lost),)] += 1
                continue
            own.times.append(told - self.clock_unit.zero)
            own.values.extend(values)
            own.numbers.append(own.seen - 1)
            own.rows.extend((files[place.path], place.row))
            if count % _ROWS_A_WORD == 0:
                self.job.progress(0.1, f"{count} rows of {place.path.name}")
        for columns, lost_count in missing.items():
            self.job.notes.append(_lost(lost_count, count, columns))
        if growing and not any(own.times for own in growing.values()):
            lost_rows = _lost(count, count, next(iter(missing)))
            raise ValueError(f"{table.name}: {lost_rows}; none is left")
        empty = [name for name, own in growing.items() if not own.times]
        if empty:
            self.job.notes.append(f"episodes without any number: left out {_listed(empty)}")
        return growing


def _refuse_shared(at: str, clock: str, fields: Sequence[Field]) -> None:
    """Refuses a column that is to be two things."""
    keys = {clock: "t_s"}
    for own in fields:
        if own.column in keys:
            raise ValueError(
                f"{at}: column {own.column!r} is both {keys[own.column]} and {own.key}; each of "
                "them needs a column of its own"
            )
        keys[own.column] = own.key


def _lost(count: int, of: int, columns: Sequence[str]) -> str:
    names = f"column{'s' if len(columns) > 1 else ''} {', '.join(columns)}"
    have = "has" if count == 1 else "have"
    return f"{count:,} of {of:,} rows {have} no number in {names}: left out"


def _listed(names: Sequence[str]) -> str:
    more = ", ..." if len(names) > 10 else ""
    return ", ".join(map(repr, names[:10])) + more


def _from_first(episode: Episode) -> Episode:
    zero = float(episode.times[0])
    return replace(episode, times=episode.times - zero, zero=zero)


def single(value: float) -> str:
    """A number with nine digits, as many as single precision has."""
    return f"{value:.9g}"


def singles(values: Array) -> list[str]:
    """Numbers with nine digits; empty where there is none."""
    return ["" if value != value else f"{value:.9g}" for value in values.tolist()]
