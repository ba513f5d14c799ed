"""DCASE's joint measures, against cases counted by hand and the challenge's own program."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import dwell
from dwell.localization.assignment import least_cost_pairs
from dwell.localization.labels import Label, angles_deg, direction, read_labels, write_labels
from dwell.localization.measures import JointMeasures, angles_between_deg


def row(frame: int, kind: int, azimuth: float, source: int = 0, distance: float = 2.0) -> Label:
    return Label(frame, kind, source, azimuth, 0.0, distance)


def measured(
    reference: list[Label], estimate: list[Label], **settings: object
) -> dict[str, object]:
    joint = JointMeasures(**settings)  # type: ignore[arg-type] # of the test's own
    joint.add(reference, estimate)
    return joint.result()


def test_pairs_cost_as_little_as_the_best_of_all_permutations() -> None:
    rng = np.random.default_rng(5)
    for _ in range(200):
        few, many = sorted(map(int, rng.integers(1, 6, 2)))
        costs = rng.integers(0, 6, (few, many)).astype(float)  # with ties
        best = min(
            sum(costs[k, column] for k, column in enumerate(columns))
            for columns in itertools.permutations(range(many), few)
        )
        for table in (costs, costs.T):
            rows, columns = least_cost_pairs(table)
            assert table[rows, columns].sum() == best
            assert len({*rows}) == len({*columns}) == few


def test_angles_are_those_of_the_sphere() -> None:
    one = np.array([direction(0, 0), direction(0, 90), direction(90, 0)])
    assert np.allclose(angles_between_deg(one, one), 90.0 * (1 - np.eye(3)))
    # Haversines of a hundredth of a degree, where the cosine has lost half of its digits.
    near = angles_between_deg(np.array([direction(10, 0)]), np.array([direction(10.01, 0)]))
    assert near[0, 0] == pytest.approx(0.01, rel=1e-9)
    assert angles_deg(direction(-135.0, 35.0)) == pytest.approx((-135.0, 35.0))


def test_what_is_found_exactly_is_without_error() -> None:
    rows = [row(frame, 0, 10.0) for frame in range(20)]
    found = measured(rows, rows)
    assert (found["er20"], found["f20"], found["le_cd_deg"], found["lr_cd"]) == (0, 1, 0, 1)
    assert found["seld"] == 0.0
    assert found["references"] == 2  # one in each second


def test_what_is_found_elsewhere_is_no_detection_but_is_localized() -> None:
    given = [row(frame, 0, 0.0) for frame in range(10)]
    found = measured(given, [row(frame, 0, 30.0) for frame in range(10)])
    # One reference, one estimate beyond 20 degrees: it is inserted, and nothing is missed.
    assert (found["er20"], found["f20"], found["lr_cd"]) == (1.0, 0.0, 1.0)
    assert found["le_cd_deg"] == pytest.approx(30.0)
    on_the_bound = measured(given, [row(frame, 0, 19.999) for frame in range(10)])
    assert on_the_bound["f20"] == 1.0


def test_another_class_is_a_substitution() -> None:
    found = measured([row(0, 0, 0.0)], [row(0, 1, 0.0)])
    # min(FP, FN) = 1 substitution over one reference, not two mistakes.
    assert (found["er20"], found["f20"], found["lr_cd"], found["le_cd_deg"]) == (1, 0, 0, 180)


def test_a_segment_is_judged_by_its_mean_angle_and_a_frame_by_its_own() -> None:
    given = [row(frame, 0, 0.0) for frame in range(10)]
    found = [row(frame, 0, 10.0 if frame < 5 else 40.0) for frame in range(10)]
    second = measured(given, found)
    assert (second["f20"], second["er20"]) == (0.0, 1.0)
    assert second["le_cd_deg"] == pytest.approx(25.0)
    frames = measured(given, found, segment_frames=1)
    assert (frames["f20"], frames["er20"]) == (0.5, 0.5)


def test_two_sources_of_a_class_are_matched_whatever_their_order() -> None:
    given = [row(0, 0, 0.0, 0), row(0, 0, 90.0, 1)]
    found = measured(given, [row(0, 0, 86.0, 0), row(0, 0, 2.0, 1)])
    assert found["f20"] == 1.0
    assert found["le_cd_deg"] == pytest.approx(3.0)
    # One of two found: F = 1 / (1 + 0.5), one deletion of two references.
    half = measured(given, [row(0, 0, 2.0)])
    assert half["f20"] == pytest.approx(2 / 3)
    assert (half["er20"], half["lr_cd"]) == (0.5, 0.5)


def test_macro_is_the_mean_of_classes_and_micro_of_all() -> None:
    # Class 0 in three seconds, found in all; class 1 in one, not found.
    given = [row(10 * k, 0, 0.0) for k in range(3)] + [row(0, 1, 90.0)]
    found = [row(10 * k, 0, 6.0) for k in range(3)]
    macro, micro = measured(given, found), measured(given, found, average="micro")
    assert macro["f20"] == 0.5
    assert macro["le_cd_deg"] == pytest.approx(93.0)
    assert micro["f20"] == pytest.approx(3 / 3.5)
    assert micro["le_cd_deg"] == pytest.approx(6.0)
    assert macro["er20"] == micro["er20"] == 0.25
    # A class of the list that never occurs counts as the challenge's program counts it.
    listed = measured(given, found, classes=range(4))
    assert listed["f20"] == 0.25


def fixed() -> tuple[list[Label], list[Label]]:
    """Two moving sources of one class and one of another; overlaps, gaps, wrong classes."""
    given, found = [], []
    for f in range(40):
        if f < 23:
            given.append(Label(f, 0, 0, -170 + 2 * f, 10, 2.0))
        if 8 <= f < 31:
            given.append(Label(f, 0, 1, 60 - 3 * f, -20, 1.0))
        if 12 <= f < 38:
            given.append(Label(f, 2, 2, f * 4, 0, 3.0))
        if f % 7 != 3 and f < 25:
            found.append(Label(f, 0, 0, 62 - 3 * f + (f % 5) * 4, -18, 1.5))
        if f < 20:
            found.append(Label(f, 0, 1, 175 + 2 * f - 360 * (f > 2), 5, 2.2))
        if 14 <= f < 40:
            found.append(Label(f, 2 if f < 30 else 1, 0, f * 4 + (f - 14) * 2.5, 8, 7.0))
    return given, found


@pytest.mark.parametrize(
    ("average", "er20", "f20", "le_cd_deg", "lr_cd"),
    [
        ("macro", 0.3, 0.41904761904761906, 70.63054060495023, 0.47222222222222215),
        ("micro", 0.3, 0.7, 14.375711182424602, 0.7272727272727273),
    ],
)
def test_seconds_are_counted_as_the_program_of_2022_counts_them(
    average: str, er20: float, f20: float, le_cd_deg: float, lr_cd: float
) -> None:
    # By SELD_evaluation_metrics.py of github.com/sharathadavanne/seld-dcase2022, run once.
    found = measured(*fixed(), average=average, classes=range(3))
    told = [found[name] for name in ("er20", "f20", "le_cd_deg", "lr_cd")]
    assert told == pytest.approx([er20, f20, le_cd_deg, lr_cd], abs=1e-6)


@pytest.mark.parametrize(
    ("average", "er20", "f20", "le_cd_deg", "distance", "lr_cd"),
    [
        ("macro", 0.51388889, 0.26053640, 17.37473248, 0.79901961, 0.45150502),
        ("micro", 0.51388889, 0.48920863, 16.00604310, 0.60666667, 0.69444444),
    ],
)
def test_frames_are_counted_as_the_program_of_2024_counts_them(
    average: str, er20: float, f20: float, le_cd_deg: float, distance: float, lr_cd: float
) -> None:
    # By SELD_evaluation_metrics.py of github.com/partha2409/DCASE2024_seld_baseline, run once.
    found = measured(
        *fixed(), average=average, classes=range(3), segment_frames=1, max_relative_distance=1.0
    )
    names = ("er20", "f20", "le_cd_deg", "relative_distance_error", "lr_cd")
    told = [found[name] for name in names]
    assert told == pytest.approx([er20, f20, le_cd_deg, distance, lr_cd], abs=1e-6)


def test_labels_are_read_as_they_were_written(tmp_path: Path) -> None:
    rows = [Label(3, 1, 0, -12.34, 5.0, 1.234), Label(0, 2, 1, 179.96, -0.01, None)]
    path = tmp_path / "one.csv"
    write_labels(path, rows)
    assert path.read_text() == "0,2,1,180.0,0.0\n3,1,0,-12.3,5.0,123.4\n"
    again = read_labels(path)
    assert again[1] == Label(3, 1, 0, -12.3, 5.0, 1.234)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("1,2,3", "3 columns; expected frame"),
        ("1,2,3,nan,0", "azimuth nan"),
        ("1,2,3,x,0", "expected numbers"),
        ("-1,2,3,0,0", "whole numbers from 0"),
        ("1,2,3,0,0,-5", "distance -5"),
    ],
)
def test_a_wrong_row_is_refused_by_its_line(tmp_path: Path, line: str, said: str) -> None:
    path = tmp_path / "one.csv"
    path.write_text("0,0,0,1,1\n" + line + "\n")
    with pytest.raises(dwell.ConfigError, match=said) as refused:
        read_labels(path)
    assert "line 2" in str(refused.value)


@pytest.mark.parametrize(
    "settings",
    [
        {"max_angle_deg": float("nan")},
        {"segment_frames": 0},
        {"average": "mean"},
        {"max_relative_distance": 1.0},
    ],
)
def test_measures_that_cannot_be_are_refused(settings: dict[str, object]) -> None:
    with pytest.raises(dwell.ConfigError):
        JointMeasures(**settings)  # type: ignore[arg-type] # of the test's own
