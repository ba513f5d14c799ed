"""Rows lost, out of order, twice, repeated or with gaps; units, axes, readings of spins."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_slips import DRIVE, FLIGHT, POSES, Rows, brought, exchanged, refused, scaled, with_table

from dwell.measured.axes import Axes, product, turned
from dwell.measured.cleaning import first_of_each, repeats
from dwell.measured.importing import import_files


def cleaned(mapping: dict[str, Any], **words: str) -> dict[str, Any]:
    return with_table(mapping, cleaning=words)


def table(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / "o.measured" / name).open() as file:
        return list(csv.DictReader(file))


def lost(*rows: int) -> Callable[[Rows], None]:
    """No height in some rows, in the words of several programs."""

    def change(all_rows: Rows) -> None:
        for row, cell in zip(rows, ["", "NaN", "nan", "null", "NA"], strict=False):
            all_rows[row - 1][3] = cell

    return change


def test_rows_without_a_number_are_left_out_and_counted(tmp_path: Path) -> None:
    counts = brought(tmp_path, FLIGHT, lost(3, 17, 18))
    assert counts["notes"] == ["3 of 160 rows have no number in column y: left out"]
    assert len(table(tmp_path, "trajectory.csv")) == 3 * 157


def test_space_around_the_name_of_an_episode_is_no_part_of_it(tmp_path: Path) -> None:
    def spaced(rows: Rows) -> None:
        rows[1][0], rows[2][0] = f" {rows[1][0]}", f"{rows[2][0]} "

    assert brought(tmp_path, FLIGHT, spaced)["episodes"] == 4


def test_a_table_without_any_number_is_refused(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, lambda rows: [row.__setitem__(3, "") for row in rows])
    assert "160 of 160 rows have no number in column y: left out; none is left" in told


def test_rows_without_a_number_leave_a_gap_that_the_map_can_cut(tmp_path: Path) -> None:
    told = refused(tmp_path, POSES, lost(18))
    assert "1 missing before it" in told
    assert 'write "cleaning": {"gaps": "split"} in the map\'s table' in told
    assert "(1 of 160 rows have no number in column y: left out)" in told.replace("has", "have")
    counts = brought(tmp_path, cleaned(POSES, gaps="split"), lost(18))
    assert counts["episodes"] == 5
    assert "1 gaps: an episode of each part" in counts["notes"]
    names = [row["episode"] for row in table(tmp_path, "episodes.csv")]
    assert names == ["e0", "e0 part 2", "e1", "e2", "e3"]
    groups = {row["split_group"] for row in table(tmp_path, "episodes.csv")[:2]}
    assert groups == {"e0"}


def test_parts_that_are_too_short_are_left_out(tmp_path: Path) -> None:
    counts = brought(tmp_path, cleaned(POSES, gaps="split"), lost(4))
    assert counts["episodes"] == 4
    assert "1 parts of fewer than 6 rows (3 rows): left out" in counts["notes"]


def short(rows: Rows) -> None:
    """A fifth episode, of three rows."""
    rows.extend([["stump", *row[1:]] for row in rows[:3]])


@pytest.mark.parametrize(
    ("mapping", "fewest"), [(POSES, 6), ({**DRIVE, "episodes": None}, 42)], ids=["poses", "drive"]
)
def test_episodes_of_too_few_rows_are_left_out_where_the_map_says_so(
    tmp_path: Path, mapping: dict[str, Any], fewest: int
) -> None:
    told = refused(tmp_path, mapping, short)
    assert f"data.csv, episode stump: 3 rows, at least {fewest} are needed; or write " in told
    assert told.endswith('"cleaning": {"short_episodes": "leave_out"} in the map\'s table')
    counts = brought(tmp_path, cleaned(mapping, short_episodes="leave_out"), short)
    assert counts["episodes"] == 4
    assert counts["notes"] == [f"1 episode of fewer than {fewest} rows: left out 'stump' (3 rows)"]


#: Flights of three coordinates: a row is three samples of the bundle.
THROWS = {**FLIGHT, "bodies": None, "body": {"name": "ball", "mass_kg": 0.0027, "radius_m": 0.02}}


@pytest.mark.parametrize("count", [1, 2, 5])
def test_rows_of_an_episode_are_counted_and_not_its_coordinates(tmp_path: Path, count: int) -> None:
    """From two rows on a flight of three coordinates was an episode."""

    def change(rows: Rows) -> None:
        rows.extend([["stump", *row[1:]] for row in rows[:count]])

    told = refused(tmp_path, THROWS, change)
    assert f"data.csv, episode stump: {count} rows, at least 6 are needed; or write " in told
    assert told.endswith('"cleaning": {"short_episodes": "leave_out"} in the map\'s table')
    assert brought(tmp_path, cleaned(THROWS, short_episodes="leave_out"), change)["episodes"] == 4


def test_rows_without_a_number_are_told_where_they_make_an_episode_short(tmp_path: Path) -> None:
    def change(rows: Rows) -> None:
        rows.extend([["stump", *row[1:]] for row in rows[:8]])
        for k in (-1, -3, -5):
            rows[k][3] = ""

    told = refused(tmp_path, THROWS, change)
    assert "episode stump: 5 rows, at least 6 are needed" in told
    assert told.endswith("(3 of 168 rows have no number in column y: left out)")


def test_starts_follow_their_samples_into_the_parts(tmp_path: Path) -> None:
    starts = {
        "file": "index.csv",
        "episode": "episode",
        "sample": "k",
        "velocity": ["a", "a", "a"],
        "angular_velocity": ["a", "a", "a"],
    }
    mapping = {**cleaned(POSES, gaps="split"), "starts": starts}
    brought(tmp_path, cleaned(POSES, gaps="split"), lost(18))
    (tmp_path / "index.csv").write_text("episode,k,a\ne0,20,1\ne1,5,1\n")
    (tmp_path / "map.json").write_text(json.dumps(mapping))
    files = [tmp_path / "data.csv", tmp_path / "index.csv"]
    out = tmp_path / "b.measured"
    import_files(files, tmp_path / "map.json", out, lambda *_: None)
    with (out / "starts.csv").open() as file:
        rows = list(csv.DictReader(file))
    # Row 18 is sample 17: sample 20 is the third of the second part, from 0.
    assert [(row["episode"], row["sample"]) for row in rows] == [("e0 part 2", "2"), ("e1", "5")]


def tripled(rows: Rows) -> None:
    """A log at 300 Hz of a tracker at 100 Hz."""
    again = [list(row) for row in rows for _ in range(3)]
    for k, row in enumerate(again):
        row[1] += (k % 3) / 300.0
    rows[:] = again


@pytest.mark.parametrize("mapping", [FLIGHT, POSES], ids=["flight", "poses"])
def test_tripled_frames_are_told_and_left_out_where_the_map_says_so(
    tmp_path: Path, mapping: dict[str, Any]
) -> None:
    told = refused(tmp_path, mapping, tripled)
    assert "each frame stands 3 times" in told
    assert '"cleaning": {"repeated_frames": "leave_out"}' in told
    counts = brought(tmp_path, cleaned(mapping, repeated_frames="leave_out"), tripled)
    assert counts["rows"] == 160
    assert counts["notes"] == [
        "320 rows that repeat a frame, each of which stands 3 times: left out"
    ]


def test_a_body_at_rest_and_steps_of_a_sensor_are_no_repeated_frames() -> None:
    rest = np.concatenate([np.arange(30.0), np.full(300, 30.0)])[:, None]
    assert repeats([rest]) == 1
    # Long rests with moves between them, as of a servo.
    moves = [np.concatenate([np.arange(k, k + 5.0), np.full(400, k + 5.0)]) for k in range(9)]
    assert repeats([np.concatenate(moves)[:, None]]) == 1
    steps = np.floor(np.linspace(0.0, 40.0, 500) ** 1.3)[:, None]
    assert repeats([steps]) == 1
    frames = np.repeat(np.concatenate([np.arange(30.0), np.full(5, 30.0)]), 4)[3:, None]
    assert repeats([frames]) == 4
    # Of the first frame only the last row is left, which is not at an even time.
    assert first_of_each(frames, 4).tolist() == [*range(1, 137, 4)]


def twice(rows: Rows) -> None:
    rows.insert(11, list(rows[10]))
    rows.insert(90, list(rows[89]))


def test_rows_that_stand_twice_are_left_out_where_the_map_says_so(tmp_path: Path) -> None:
    assert "stands twice" in refused(tmp_path, FLIGHT, twice)
    counts = brought(tmp_path, cleaned(FLIGHT, duplicates="leave_out"), twice)
    assert counts["rows"] == 160
    assert counts["notes"] == ["2 rows that stand twice: left out"]


def contradicting(rows: Rows) -> None:
    twice(rows)
    rows[11][3] += 0.5


def test_frames_that_contradict_each_other_are_always_refused(tmp_path: Path) -> None:
    for mapping in (FLIGHT, cleaned(FLIGHT, duplicates="leave_out", unsorted="sort")):
        told = refused(tmp_path, mapping, contradicting)
        assert "row 12: column 't_s' is 5.1 again (row 11)" in told
        assert "contradicts itself (column 'y' is 1.65095 there and 2.15095 here)" in told


def test_rows_out_of_order_are_sorted_where_the_map_says_so(tmp_path: Path) -> None:
    def shuffled(rows: Rows) -> None:
        order = np.random.default_rng(0).permutation(len(rows))
        rows[:] = [rows[k] for k in order]

    assert "sort its rows by time" in refused(tmp_path, FLIGHT, shuffled)
    assert "unsorted is 'by time'" in refused(tmp_path, cleaned(FLIGHT, unsorted="by time"))
    assert brought(tmp_path, cleaned(FLIGHT, unsorted="sort"), shuffled)["rows"] == 160
    times = [row["t_s"] for row in table(tmp_path, "trajectory.csv") if row["episode"] == "e2"]
    assert times == sorted(times)


UNITS: list[tuple[dict[str, Any], dict[str, Any], dict[int, float]]] = [
    (FLIGHT, {"x": "cm", "y": "mm"}, {2: 100.0, 3: 1000.0}),
    (FLIGHT, {"t_s": "us", "z": "in"}, {1: 1e6, 4: 1 / 0.0254}),
    (FLIGHT, {"t_s": {"per_second": 100}}, {1: 100.0}),
    (POSES, {"t_s": "ms", "wx": "deg/s", "wy": "rpm"}, {1: 1e3, 12: 180 / math.pi}),
    (POSES, {"vx": "cm/s", "vy": "mm/s", "vz": "km/h"}, {9: 100.0, 10: 1000.0, 11: 3.6}),
    (DRIVE, {"theta": "deg", "x": "cm", "y": "ft"}, {2: 100.0, 3: 1 / 0.3048, 4: 180 / math.pi}),
    (DRIVE, {"theta": {"factor": 0.001, "zero": 0}}, {4: 1000.0}),
]


@pytest.mark.parametrize(("mapping", "units", "factors"), UNITS)
def test_each_column_has_its_own_unit(
    tmp_path: Path, mapping: dict[str, Any], units: dict[str, Any], factors: dict[int, float]
) -> None:
    def change(rows: Rows) -> None:
        for column, factor in factors.items():
            scaled(rows, factor, column)

    name = {"trajectory": "trajectory", "pose_trajectory": "poses", "drive": "drive"}
    brought(tmp_path, mapping)
    wanted = table(tmp_path, f"{name[mapping['kind']]}.csv")
    (tmp_path / "o.measured").rename(tmp_path / "wanted")
    brought(tmp_path, with_table(mapping, units=units), change)
    found = table(tmp_path, f"{name[mapping['kind']]}.csv")
    for a, b in zip(wanted, found, strict=True):
        for key, cell in a.items():
            if key in ("episode", "entity", "channel"):
                assert b[key] == cell
            else:
                assert float(b[key]) == pytest.approx(float(cell), rel=1e-6, abs=1e-8)


def test_a_unit_of_another_dimension_and_of_no_column_are_refused(tmp_path: Path) -> None:
    told = refused(tmp_path, with_table(FLIGHT, units={"t_s": "cm"}))
    assert "'cm', which is of a length, and the column holds a time; allowed is one of" in told
    told = refused(tmp_path, with_table(FLIGHT, units={"height": "cm"}))
    assert "column 'height' is none that the map reads; those are" in told
    told = refused(tmp_path, with_table(FLIGHT, units={"t_s": {"per_second": -30}}))
    assert "clocks go forwards" in told


def test_axes_of_poses_are_rotated_and_mirrored_ones_refused(tmp_path: Path) -> None:
    brought(tmp_path, POSES)
    wanted = table(tmp_path, "poses.csv")
    (tmp_path / "o.measured").rename(tmp_path / "wanted")

    def x_up(rows: Rows) -> None:
        # The user's x is the z of before, y its x, z its y; quaternions likewise.
        for row in rows:
            row[2:5] = row[4], row[2], row[3]
            row[9:12] = row[11], row[9], row[10]
            row[5:9] = product(np.array([[0.5, 0.5, 0.5, 0.5]]), np.array([row[5:9]], float))[
                0
            ].tolist()

    mapping = {k: v for k, v in POSES.items() if k != "up"}
    brought(tmp_path, {**mapping, "axes": ["y", "x", "-z"]}, x_up)
    for a, b in zip(wanted, table(tmp_path, "poses.csv"), strict=True):
        for key in ("x", "y", "z", "vx", "vy", "vz"):
            assert float(a[key]) == pytest.approx(float(b[key]), abs=1e-6)
        # A quaternion and its negative are one rotation.
        along = sum(float(a[key]) * float(b[key]) for key in ("qx", "qy", "qz", "qw"))
        assert abs(along) == pytest.approx(1.0)
    (tmp_path / "o.measured").rename(tmp_path / "found")
    told = refused(tmp_path, {**mapping, "axes": ["y", "x", "z"]}, x_up)
    assert "left-handed" in told
    assert "['y', 'x', '-z'] would be right-handed" in told
    assert "leave one out" in refused(tmp_path, {**POSES, "axes": "y_up"})


def test_any_rotation_of_axes_turns_vectors_and_rotations_alike() -> None:
    draw = np.random.default_rng(4)
    for told in (["z", "x", "y"], ["-y", "x", "z"], ["x", "-y", "-z"], ["-z", "-x", "y"], "z_up"):
        axes = Axes({"axes": told}, "map")
        q = draw.standard_normal((6, 4))
        q /= np.linalg.norm(q, axis=1, keepdims=True)
        v = draw.standard_normal((6, 3))
        assert turned(axes.rotations(q), v) == pytest.approx(axes.vectors(turned(q, v)))


def test_flights_with_z_up_are_turned_by_axes(tmp_path: Path) -> None:
    mapping = {**FLIGHT, "axes": "z_up"}
    told = refused(tmp_path, with_table(mapping, channels={"y": "y"}))
    assert "axes turns flights of which x, y and z are there" in told
    brought(tmp_path, mapping, lambda rows: exchanged(rows, 3, 4))
    rows = table(tmp_path, "trajectory.csv")[:3]
    assert [row["channel"] for row in rows] == ["x", "y", "z"]
    assert [float(row["value"]) for row in rows] == pytest.approx([1.0, 1.5, -1.0])


def swapped(rows: Rows) -> None:
    """The columns that are called x, y, z, w hold w, x, y, z."""
    for row in rows:
        row[5:9] = row[8], row[5], row[6], row[7]


def in_world(rows: Rows) -> None:
    for row in rows:
        row[12:15] = 0.0, 0.0, row[12]


def test_another_order_of_the_quaternion_is_named_by_the_spins(tmp_path: Path) -> None:
    told = refused(tmp_path, POSES, swapped)
    assert '"quaternion_xyzw": ["qy", "qz", "qw", "qx"] in the map\'s table: the first' in told
    right = with_table(POSES, quaternion_xyzw=["qy", "qz", "qw", "qx"])
    assert brought(tmp_path, right, swapped)["episodes"] == 4
    (tmp_path / "o.measured").rename(tmp_path / "first")
    named = with_table(POSES, quaternion_wxyz=["qx", "qy", "qz", "qw"], quaternion_xyzw=None)
    assert brought(tmp_path, named, swapped)["episodes"] == 4


def test_spins_in_the_other_frame_are_named(tmp_path: Path) -> None:
    told = refused(tmp_path, POSES, in_world)
    assert '"angular_velocity": "world" in the map\'s poses' in told

    def both(rows: Rows) -> None:
        swapped(rows)
        in_world(rows)

    told = refused(tmp_path, POSES, both)
    assert "the first of them is w and" in told
    assert '"angular_velocity": "world"' in told


def test_the_order_of_a_quaternion_is_told_by_boxes_that_come_to_rest(tmp_path: Path) -> None:
    def resting(rows: Rows) -> None:
        """Eight tosses that end on a face, turned about the vertical; no spins."""
        rows.clear()
        for toss in range(8):
            for k in range(20):
                turn, tilt = 0.2 + 0.1 * toss, 0.05 * max(0, 12 - k)
                about_z = np.array([[0, 0, math.sin(turn), math.cos(turn)]])
                about_x = np.array([[math.sin(tilt), 0, 0, math.cos(tilt)]])
                q = product(about_z, about_x)[0].tolist()
                height = 0.05 + max(0.0, 0.2 - 4.905 * (k / 100) ** 2)
                row = [f"e{toss}", k / 100, 0.1 * toss, 0, height, *q, *[0.0] * 6]
                rows.append(row)

    part = {k: v for k, v in POSES["table"].items() if k not in ("velocity", "angular_velocity")}
    mapping = {**POSES, "table": part}
    assert brought(tmp_path, mapping, resting)["episodes"] == 8
    (tmp_path / "o.measured").rename(tmp_path / "first")

    def wrong(rows: Rows) -> None:
        resting(rows)
        swapped(rows)

    told = refused(tmp_path, mapping, wrong)
    assert "lies on one of its sides" in told
    assert '"quaternion_xyzw": ["qy", "qz", "qw", "qx"]' in told


def test_a_clock_that_is_a_tenth_off_is_told(tmp_path: Path) -> None:
    """Positions and rate_hz agree with the times, velocities with the true clock."""
    slower = with_table(POSES, seconds_per_unit=1.1)
    slower["poses"] = {**POSES["poses"], "rate_hz": 100.0 / 1.1}
    counts = brought(tmp_path, slower)
    assert counts["notes"] == [
        "velocities are 1.100 times what positions and rate_hz show: is the scale of the clock or "
        "of lengths off?"
    ]


def test_times_since_1970_count_from_the_first_where_the_map_says_so(tmp_path: Path) -> None:
    def epoch(rows: Rows) -> None:
        for row in rows:
            row[1] = round((row[1] + 1.7e9) * 1e3)

    part = with_table(FLIGHT, units={"t_s": "ms"})
    assert "t_s" in refused(tmp_path, part, epoch)
    brought(tmp_path, with_table(part, t_zero="first"), epoch)
    times = [float(row["t_s"]) for row in table(tmp_path, "trajectory.csv")]
    assert times[0] == 0.0
    assert times[3] == pytest.approx(0.01)


def test_air_that_is_no_number_or_none_that_is_breathed_is_refused(tmp_path: Path) -> None:
    told = refused(tmp_path, {**FLIGHT, "g_m_s2": "x"})
    assert "map.json: g_m_s2 is 'x'; expected a number" in told
    told = refused(tmp_path, {**FLIGHT, "environment": {"temperature_c": 300}})
    assert "map.json: environment.temperature_c is 300; allowed is -40 to 60" in told
    told = refused(tmp_path, with_table(FLIGHT, channels={"height": "y"}))
    assert "no channel 'height'; allowed are ['x', 'y', 'z', 'wx', 'wy', 'wz']" in told


def test_one_episode_is_refused(tmp_path: Path) -> None:
    told = refused(tmp_path, FLIGHT, lambda rows: rows.__delitem__(slice(40, None)))
    assert "episodes" in told
    assert "data.csv: 1" in told


def test_a_map_whose_guesses_nobody_confirmed_is_refused(tmp_path: Path) -> None:
    why = {"table.t_s": "column 't' rises in every row"}
    told = refused(tmp_path, {**FLIGHT, "confirmed": False, "why": why})
    assert 'map.json: "confirmed" is false: read its 1 guesses, each with its reason' in told
    assert brought(tmp_path, {**FLIGHT, "confirmed": True, "why": why})["episodes"] == 4


def test_a_file_a_throw_is_a_pattern(tmp_path: Path) -> None:
    brought(tmp_path, FLIGHT)
    head, *lines = (tmp_path / "data.csv").read_text().splitlines()
    for name in ("e0", "e1", "e2", "e3"):
        own = [line for line in lines if line.startswith(name)]
        (tmp_path / f"{name}.csv").write_text("\n".join([head, *own]) + "\n")
    mapping = with_table(FLIGHT, file="e*.csv", episode="{file}")
    (tmp_path / "map.json").write_text(json.dumps(mapping))
    files = [*sorted(tmp_path.glob("e*.csv")), tmp_path / "index.csv"]
    out = tmp_path / "b.measured"
    assert import_files(files, tmp_path / "map.json", out, lambda *_: None)["episodes"] == 4
    assert (out / "trajectory.csv").read_text() == (
        tmp_path / "o.measured" / "trajectory.csv"
    ).read_text()
    # A fault names the file of its row.
    put_in = (tmp_path / "e2.csv").read_text().splitlines()
    put_in[5] = put_in[5].replace("e2,", "e2,x")
    (tmp_path / "e2.csv").write_text("\n".join(put_in))
    with pytest.raises(ValueError, match=r"e2\.csv row 5: column 't_s' is 'x5\.04'"):
        import_files(files, tmp_path / "map.json", tmp_path / "c.measured", lambda *_: None)


def test_short_gaps_of_flights_stay_and_are_told(tmp_path: Path) -> None:
    def lost(rows: Rows) -> None:
        """A gap of 0.13 s in the first flight, and one of 0.61 s in the second."""
        for row in rows[60:80]:
            row[1] += 0.6
            row[3] = 1.5 + 2.3 * (row[1] - 5.0) - 4.905 * (row[1] - 5.0) ** 2
        del rows[10:22]

    counts: dict[str, Any] = brought(tmp_path, with_table(FLIGHT, cleaning={"gaps": "split"}), lost)
    assert counts["notes"] == [
        "1 gaps: an episode of each part",
        "1 gap of at most 0.5 s: left, since samples need not be evenly spaced",
    ]


def test_places_of_unlike_noise_are_told(tmp_path: Path) -> None:
    draw = np.random.default_rng(1)

    def noisy(rows: Rows) -> None:
        for row in rows:
            row[2:5] = np.array(row[2:5]) + 1e-3 * draw.standard_normal(3)

    assert "notes" not in brought(tmp_path, FLIGHT, noisy)
    (tmp_path / "o.measured").rename(tmp_path / "first")
    counts: dict[str, Any] = brought(tmp_path, with_table(FLIGHT, units={"z": "cm"}), noisy)
    (note,) = counts["notes"]
    assert re.match("places in column '[xy]' have noise of .* those in column 'z' ", note), note
