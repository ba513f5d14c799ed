"""Joint measures of localization and detection, as the DCASE challenge takes them.

A. Mesaros et al., "Joint Measurement of Localization and Detection of Sound Events", WASPAA 2019;
A. Politis et al., "Overview and Evaluation of Sound Event Localization and Detection in DCASE
2019", IEEE/ACM TASLP 29 (2021). Counted as the challenge's own program counts: in segments of a
second until 2023, in each frame since 2024.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import (
    above_zero,
    choice,
    integer_in_range,
    number_in_range,
    sequence_items,
)
from dwell.localization.assignment import least_cost_pairs
from dwell.localization.labels import MOST_AT_ONCE, Label, checked_labels, direction, too_many

#: What is averaged over classes.
_AVERAGED = ("f20", "le_cd_deg", "lr_cd", "relative_distance_error")
#: Labels of one class by frame.
_Frames = dict[int, list[Label]]


def angles_between_deg(
    first: NDArray[np.float64], second: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Angles along great circles between unit vectors, shape (n, 3) and (m, 3): (n, m), degrees."""
    across = np.linalg.norm(np.cross(first[:, None], second[None]), axis=2)
    # Exact for small angles, too, where the cosine alone is not.
    found: NDArray[np.float64] = np.degrees(np.arctan2(across, first @ second.T))
    return found


@dataclass
class _Counts:
    """What is counted of one class."""

    references: int = 0
    hits: int = 0
    misplaced: int = 0
    false_positives: int = 0
    misses: int = 0
    matched: int = 0
    angles_deg: float = 0.0
    relative_distances: list[float] = field(default_factory=list)


class JointMeasures:
    """Counts recordings, one after another; then :meth:`result`."""

    def __init__(
        self,
        *,
        max_angle_deg: float = 20.0,
        segment_frames: int = 10,
        average: str = "macro",
        max_relative_distance: float | None = None,
        classes: Sequence[int] | None = None,
    ) -> None:
        """Counts nothing yet.

        Args:
            max_angle_deg: Up to this angle what was found is where the reference is, 0 to 180.
            segment_frames: Frames that are judged together: 10 until 2023, 1 since 2024.
            average: ``macro``, the mean over classes, or ``micro``, over all that is counted.
            max_relative_distance: Up to this share of the distance, too; 1 since 2024. Only in
                segments of one frame; ``None``: distances do not count.
            classes: Classes that ``macro`` averages over; without it those that occur. The
                challenge's program takes all of its list.

        Raises:
            ConfigError: A number is out of range.
        """
        self._max_angle_deg = number_in_range("max_angle_deg", max_angle_deg, 0.0, 180.0, "degrees")
        self._segment = integer_in_range("segment_frames", segment_frames, low=1, high=10_000)
        self._average = choice("average", average, ("macro", "micro"))
        self._max_distance = (
            None
            if max_relative_distance is None
            else above_zero("max_relative_distance", max_relative_distance)
        )
        if self._max_distance is not None and self._segment != 1:
            raise ConfigError(
                f"max_relative_distance with segment_frames {self._segment}; expected 1"
            )
        self._classes = (
            None
            if classes is None
            else [
                integer_in_range(f"classes[{k}]", one)
                for k, one in enumerate(sequence_items("classes", classes, "expected classes"))
            ]
        )
        self._counts: dict[int, _Counts] = defaultdict(_Counts)
        self._substituted = self._deleted = self._inserted = 0

    def add(self, reference: Iterable[Label], estimate: Iterable[Label]) -> None:
        """Counts one recording.

        Raises:
            ConfigError: These are no labels that can be written, or one frame has more than 100 of
                a class.
        """
        first = self._segments("reference", reference)
        second = self._segments("estimate", estimate)
        for segment in sorted({*first, *second}):
            wrong, missed = 0, 0
            given, found = first.get(segment, {}), second.get(segment, {})
            for kind in sorted({*given, *found}):
                one = self._judge(self._counts[kind], given.get(kind, {}), found.get(kind, {}))
                wrong, missed = wrong + one[0], missed + one[1]
            self._substituted += min(wrong, missed)
            self._deleted += max(0, missed - wrong)
            self._inserted += max(0, wrong - missed)

    def _segments(self, name: str, labels: Iterable[Label]) -> dict[int, dict[int, _Frames]]:
        """Labels by segment, class and frame."""
        found: dict[int, dict[int, _Frames]] = {}
        for row in checked_labels(name, labels):
            kinds = found.setdefault(row.frame // self._segment, {})
            rows = kinds.setdefault(row.class_index, {}).setdefault(row.frame, [])
            rows.append(row)
            if len(rows) > MOST_AT_ONCE:
                raise ConfigError(f"{name}: {too_many(row)}")
        return found

    def _judge(self, counts: _Counts, given: _Frames, found: _Frames) -> tuple[int, int]:
        """Counts a class in a segment; returns false positives and misses for the error rate."""
        references = max((len(rows) for rows in given.values()), default=0)
        estimates = max((len(rows) for rows in found.values()), default=0)
        counts.references += references
        if not references or not estimates:
            counts.false_positives += estimates
            counts.misses += references
            return estimates, references
        tracks: dict[int, list[float]] = defaultdict(list)
        is_far: dict[int, bool] = {}
        for frame in sorted({*given} & {*found}):
            self._match(given[frame], found[frame], tracks, is_far, counts)
        if not tracks:
            # Both are in the segment, never at the same time. What the challenge's program counts.
            counts.misses += estimates
            return 0, estimates
        wrong = 0
        for track, angles in tracks.items():
            mean = float(np.mean(angles))
            counts.angles_deg += mean
            counts.matched += 1
            if mean <= self._max_angle_deg and not is_far.get(track, False):
                counts.hits += 1
            else:
                counts.misplaced += 1
                wrong += 1
        more, fewer = max(0, estimates - references), max(0, references - estimates)
        counts.false_positives += more
        counts.misses += fewer
        return wrong + more, fewer

    def _match(
        self,
        given: list[Label],
        found: list[Label],
        tracks: dict[int, list[float]],
        is_far: dict[int, bool],
        counts: _Counts,
    ) -> None:
        """Pairs the labels of a frame with the least sum of angles; a track is a row's rank."""
        angles = angles_between_deg(_directions(given), _directions(found))
        for row, column in zip(*least_cost_pairs(angles), strict=True):
            tracks[int(row)].append(float(angles[row, column]))
            true_m, found_m = given[row].distance_m, found[column].distance_m
            if true_m is not None and found_m is not None:
                share = abs(found_m - true_m) / max(true_m, 1e-9)
                counts.relative_distances.append(share)
                if self._max_distance is not None and share > self._max_distance:
                    is_far[int(row)] = True
            elif self._max_distance is not None:
                raise ConfigError("max_relative_distance: a label has no distance")

    def result(self) -> dict[str, Any]:
        """The measures of all that was added.

        Returns:
            ``er20``, ``f20`` (named for 20 degrees whatever the bound), ``le_cd_deg``, ``lr_cd``,
            ``seld`` (their mean, 0 is best), ``relative_distance_error`` (``None``: no distances),
            ``references``, and ``classes``: for each the same without ``er20`` and ``seld``. Where
            nothing was matched, the error of localization is 180 degrees in segments, and
            ``None``, left out of the mean, in single frames.
        """
        known = sorted(self._counts) if self._classes is None else self._classes
        # The challenge leaves out what cannot be said since 2024, and took the worst before.
        unmatched_deg = None if self._segment == 1 else 180.0
        by_class = {kind: _scores([self._counts[kind]], unmatched_deg) for kind in known}
        references = sum(one.references for one in self._counts.values())
        mistakes = self._substituted + self._deleted + self._inserted
        if self._average == "micro" or not by_class:
            mean = _scores([*self._counts.values()], unmatched_deg)
        else:
            rows = by_class.values()
            mean = {name: _mean([row[name] for row in rows]) for name in _AVERAGED}
        er20 = mistakes / references if references else float(mistakes > 0)
        parts = [er20, 1.0 - mean["f20"], 1.0 - mean["lr_cd"]]
        if mean["le_cd_deg"] is not None:
            parts.append(mean["le_cd_deg"] / 180.0)
        return {
            "er20": er20,
            **{name: mean[name] for name in _AVERAGED},
            "seld": float(np.mean(parts)),
            "references": references,
            "classes": by_class,
        }


def _directions(labels: list[Label]) -> NDArray[np.float64]:
    return np.array([direction(row.azimuth_deg, row.elevation_deg) for row in labels])


def _mean(values: list[float | None]) -> float | None:
    """The mean of those that there are."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


def _scores(counts: list[_Counts], unmatched_deg: float | None) -> dict[str, Any]:
    hits = sum(one.hits for one in counts)
    misplaced = sum(one.misplaced for one in counts)
    wrong = sum(one.false_positives + one.misses for one in counts)
    matched = sum(one.matched for one in counts)
    misses = sum(one.misses for one in counts)
    shares = [share for one in counts for share in one.relative_distances]
    judged = hits + misplaced + 0.5 * wrong
    return {
        "f20": hits / judged if judged else 0.0,
        "le_cd_deg": sum(one.angles_deg for one in counts) / matched if matched else unmatched_deg,
        "lr_cd": matched / (matched + misses) if matched + misses else 0.0,
        "relative_distance_error": _mean([*shares]),
        "references": sum(one.references for one in counts),
    }
