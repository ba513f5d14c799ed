"""What becomes of rows out of order, rows that stand twice, repeated frames, gaps and stumps.

Nothing is done to them unless the map says so: without its word they are refused, by a sentence
that says what to write.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dwell.measured.maps import choice

if TYPE_CHECKING:
    from dwell.measured.samples import Episode

#: Frames that each stand so many times at most are recognised.
_MOST_REPEATS = 10
#: A step of more usual ones than this is told as a gap.
_GAP_STEPS = 2.5
#: Share of frames that stand a whole number of times, and changes of frames, that tell.
_TELLING_SHARE = 0.9
_FEWEST_CHANGES = 20


class Longest(NamedTuple):
    """The longest time between samples that is no gap, s, and the seconds in one of the column."""

    s: float
    seconds_per_unit: float


class Cleaning:
    """The key ``cleaning`` of a table."""

    def __init__(self, told: Mapping[str, Any], at: str) -> None:
        """The words, each of which may be left out."""
        self.unsorted = choice(told, "unsorted", ("sort",), at)
        self.duplicates = choice(told, "duplicates", ("leave_out",), at)
        self.repeated = choice(told, "repeated_frames", ("leave_out", "keep"), at)
        self.gaps = choice(told, "gaps", ("split",), at)
        self.short_episodes = choice(told, "short_episodes", ("leave_out",), at)
        self.left_out: dict[str, int] = {}

    def ordered(self, episode: Episode, clock: str, columns: Sequence[str]) -> Episode:
        """By time, each time once, where the map says so; else as it is."""
        if self.unsorted is not None and (np.diff(episode.times) < 0).any():
            episode = episode.of(np.argsort(episode.times, kind="stable"))
        same_time = np.flatnonzero(np.diff(episode.times) == 0)
        if not len(same_time):
            return episode
        differ = changes(episode.values)[same_time]
        if differ.any():
            k = int(same_time[differ][0])
            _refuse_contradiction(episode, k, clock, columns)
        if self.duplicates is None:
            return episode
        kept = np.ones(len(episode.times), bool)
        kept[same_time + 1] = False
        self._count("rows that stand twice: left out", len(same_time))
        return episode.of(kept)

    def without_repeats(
        self, episodes: list[Episode], name: str, notes: list[str]
    ) -> list[Episode]:
        """One row of each frame where frames stand several times at later times."""
        times = repeats([episode.values for episode in episodes])
        if times > 1 and self.repeated is None:
            steps = np.concatenate([np.diff(episode.times) for episode in episodes])
            raise ValueError(
                f"{name}: each frame stands {times} times, at times that are "
                f"{float(np.median(steps)):g} apart: the log is faster than what measures. Write "
                '"cleaning": {"repeated_frames": "leave_out"} in the map\'s table, which keeps '
                f"one row in {times} (rate_hz is then that of the frames), or "
                '"keep" if everything really stood still'
            )
        if times > 1 and self.repeated == "leave_out":
            before = sum(len(episode.times) for episode in episodes)
            episodes = [episode.of(first_of_each(episode.values, times)) for episode in episodes]
            after = sum(len(episode.times) for episode in episodes)
            self._count(
                f"rows that repeat a frame, each of which stands {times} times: left out",
                before - after,
            )
        notes.extend(f"{count:,} {what}" for what, count in self.left_out.items())
        return episodes

    def parts(
        self, episodes: list[Episode], longest: Longest, fewest: int, notes: list[str]
    ) -> list[Episode]:
        """An episode for each part between gaps, where the map says so.

        Args:
            episodes: In the order of time.
            longest: The longest time between samples that is no gap.
            fewest: Parts of fewer samples are left out.
            notes: Takes what was done.
        """
        if self.gaps is None:
            return episodes
        names = {episode.name for episode in episodes}
        found: list[Episode] = []
        longest_step = longest.s / longest.seconds_per_unit
        cut = short = lost = kept = 0
        for episode in episodes:
            steps = np.diff(episode.times)
            ends = np.flatnonzero(steps > longest_step) + 1
            usual = float(np.median(steps)) if len(steps) else 0.0
            kept += int(((steps > _GAP_STEPS * usual) & (steps <= longest_step)).sum())
            pieces = np.split(np.arange(len(episode.times)), ends)
            cut += len(ends)
            number = 0
            for piece in pieces:
                if len(pieces) > 1 and len(piece) < fewest:
                    short += 1
                    lost += len(piece)
                    continue
                number += 1
                name = episode.name if number == 1 else f"{episode.name} part {number}"
                if number > 1 and name in names:
                    raise ValueError(
                        f"episode {episode.name!r} has gaps, and its part {number} would be called "
                        f"{name!r}, as another episode is; rename that one"
                    )
                found.append(replace(episode.of(piece), name=name))
        if cut:
            notes.append(f"{cut:,} gaps: an episode of each part")
        if kept:
            notes.append(
                f"{kept:,} gap{'s' if kept > 1 else ''} of at most {longest.s:g} s: left, since "
                "samples need not be evenly spaced"
            )
        if short:
            notes.append(f"{short:,} parts of fewer than {fewest} rows ({lost:,} rows): left out")
        return found

    def without_short(
        self, episodes: list[Episode], fewest: int, name: str, notes: list[str]
    ) -> list[Episode]:
        """Episodes of enough samples; others are left out where the map says so.

        Raises:
            ValueError: It does not, or none has so many.
        """
        found = [episode for episode in episodes if len(episode.times) >= fewest]
        short = [episode for episode in episodes if len(episode.times) < fewest]
        if not short:
            return episodes
        if self.short_episodes is None:
            # What was left out may be why.
            left_out = f" ({'; '.join(notes)})" if notes else ""
            raise ValueError(
                f"{name}, episode {short[0].name}: {len(short[0].times)} rows, at least {fewest} "
                'are needed; or write "cleaning": {"short_episodes": "leave_out"} in the map\'s '
                f"table{left_out}"
            )
        listed = ", ".join(
            f"{episode.name!r} ({len(episode.times)} rows)" for episode in short[:10]
        )
        more = ", ..." if len(short) > 10 else ""
        plural = "s" if len(short) > 1 else ""
        told = (
            f"{len(short):,} episode{plural} of fewer than {fewest} rows: left out {listed}{more}"
        )
        if not found:
            raise ValueError(f"{name}: {told}; none is left")
        notes.append(told)
        return found

    def _count(self, what: str, count: int) -> None:
        self.left_out[what] = self.left_out.get(what, 0) + count


def changes(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether each row differs from the one after it. Shape (n - 1,)."""
    before, after = values[:-1], values[1:]
    same = (before == after) | (np.isnan(before) & np.isnan(after))
    differ: NDArray[np.bool_] = ~same.all(axis=1)
    return differ


def repeats(episodes: Sequence[NDArray[np.float64]]) -> int:
    """How many times each frame stands in a row; 1 where frames do not repeat evenly."""
    found: list[NDArray[np.int64]] = []
    for values in episodes:
        ends = np.flatnonzero(changes(values)) + 1
        # The first and the last may be cut.
        found.append(np.diff(ends))
    runs = np.concatenate(found) if found else np.zeros(0, np.int64)
    if len(runs) < _FEWEST_CHANGES:
        return 1
    for times in range(_MOST_REPEATS, 1, -1):
        # By frames, not by rows: one long rest of a body would outweigh them all.
        if (runs % times == 0).mean() >= _TELLING_SHARE:
            return times
    return 1


def first_of_each(values: NDArray[np.float64], times: int) -> NDArray[np.int64]:
    """One row of each frame that stands so many times; of a rest, as many as it lasts."""
    starts = np.concatenate([[0], np.flatnonzero(changes(values)) + 1, [len(values)]])
    kept: list[int] = []
    for k in range(len(starts) - 1):
        start, end = int(starts[k]), int(starts[k + 1])
        # A first run that was cut is counted from its end.
        offset = (end - start) % times if k == 0 else 0
        kept.extend(range(start + offset, end, times))
    return np.array(kept, np.int64)


def _refuse_contradiction(episode: Episode, k: int, clock: str, columns: Sequence[str]) -> None:
    before, after = episode.values[k], episode.values[k + 1]
    other = int(np.flatnonzero(~((before == after) | (np.isnan(before) & np.isnan(after))))[0])
    raise ValueError(
        f"{episode.place(k + 1)}: column {clock!r} is {episode.times[k + 1]:g} again "
        f"(row {episode.place(k).row}) in episode {episode.source!r}: the frame stands twice and "
        f"contradicts itself (column {columns[other]!r} is {before[other]:g} there and "
        f"{after[other]:g} here); leave the wrong one out, or give every recording an episode's "
        "name of its own"
    )
