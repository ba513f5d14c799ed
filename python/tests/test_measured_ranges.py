"""Refused: motions that are too small, numbers that stand for nothing. And other gravity."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from test_measured_kinds import JOINT
from test_slips import DRIVE, FLIGHT, POSES, Rows, brought, put, refused, with_table

import dwell
from dwell.calibration import calibrate
from dwell.measured.importing import import_files

#: Without velocities, which tell some of it first.
TOSSES = {**POSES, "table": {k: v for k, v in POSES["table"].items() if "velocity" not in k}}


@pytest.mark.parametrize(
    ("mapping", "units", "told"),
    [
        (
            FLIGHT,
            dict.fromkeys("xyz", "cm"),
            "were lengths in metres read as centimetres.* by 100,",
        ),
        (
            FLIGHT,
            dict.fromkeys("xyz", "mm"),
            "were lengths in metres read as millimetres.* by 1000,",
        ),
        (FLIGHT, dict.fromkeys("xyz", "in"), "were lengths in metres read as inches"),
        (FLIGHT, {"y": "cm"}, "were lengths in metres read as centimetres"),
        (FLIGHT, {"t_s": "ms"}, "were times in seconds read as milliseconds.* by 1000,"),
        (FLIGHT, {"t_s": "us"}, "were times in seconds read as microseconds"),
        (TOSSES, dict.fromkeys("xyz", "cm"), "were lengths in metres read as centimetres"),
    ],
)
def test_units_that_make_a_motion_too_small_are_named(
    tmp_path: Path, mapping: dict[str, Any], units: dict[str, str], told: str
) -> None:
    with pytest.raises(ValueError, match=f"the acceleration in free flight is .*{told}"):
        brought(tmp_path, with_table(mapping, units=units))


def test_what_hardly_falls_is_no_other_unit(tmp_path: Path) -> None:
    def in_air(rows: Rows) -> None:
        """A balloon that is let go: it falls to a speed of 0.5 m/s within a metre."""
        for row in rows:
            t = row[1] - 5.0
            row[3] = 2.0 - 0.5 * (t - 0.05 * (1.0 - math.exp(-t / 0.05)))

    assert brought(tmp_path, FLIGHT, in_air)["episodes"] == 4


def lost(first: int, last: int, number: float) -> Callable[[Rows], object]:
    """The heights of the second throw's rows from ``first`` to ``last``, from 0, are lost."""

    def change(rows: Rows) -> None:
        for row in rows[40 + first : 40 + last + 1]:
            row[3] = number

    return change


@pytest.mark.parametrize(
    ("first", "last", "number", "row"),
    [(7, 7, -9999.0, 48), (7, 12, -1.0, 48), (0, 2, -1.0, 44), (38, 39, 1e5, 79), (7, 7, 30.0, 48)],
)
def test_numbers_that_stand_for_nothing_are_refused_by_row(
    tmp_path: Path, first: int, last: int, number: float, row: int
) -> None:
    told = refused(tmp_path, FLIGHT, lost(first, last, number))
    assert f"data.csv row {row}, episode e1, t_s 5." in told
    assert "column 'y' is " in told
    assert "a number that stands for nothing, as of a tracker that lost the body?" in told


def test_numbers_that_stand_for_nothing_are_refused_in_tosses(tmp_path: Path) -> None:
    told = refused(tmp_path, TOSSES, put(48, 4, -30.0))
    assert "data.csv row 48, episode e1, t_s 0.07" in told
    assert "column 'z' is -30 after " in told


def test_a_smash_is_no_jump(tmp_path: Path) -> None:
    def smashed(rows: Rows) -> None:
        """A shuttlecock at 100 m/s, which is slowed to half of it within 0.1 s."""
        for row in rows:
            row[2] = 10.0 * math.log1p(10.0 * (row[1] - 5.0))

    assert brought(tmp_path, FLIGHT, smashed)["episodes"] == 4


SERVO: dict[str, Any] = {
    "kind": "servo",
    "joint": JOINT,
    "table": {"file": "log.csv", "episode": "run", "t_s": "t", "position": "pos", "target": "goal"},
}


def driven(folder: Path, shown: Callable[[int, float], float], **units: object) -> dict[str, Any]:
    """Imports four runs at 50 Hz whose positions are ``shown`` of the row and the angle, rad."""
    rows = ["run,t,pos,goal"]
    for run in range(4):
        angle = -0.5
        for k in range(150):
            goal = 0.5 if (k // 25) % 2 else -0.5
            angle += 0.3 * (goal - angle)
            rows.append(f"{run},{k / 50},{shown(k, angle)},{goal}")
    (folder / "log.csv").write_text("\n".join(rows) + "\n")
    (folder / "map.json").write_text(json.dumps(with_table(SERVO, units=units)))
    out = folder / "o.measured"
    return import_files([folder / "log.csv"], folder / "map.json", out, lambda *_: None)


@pytest.mark.parametrize(
    ("shown", "told"),
    [
        (
            lambda _, rad: 2048 + 652 * rad,
            r"log\.csv row 1, episode 0, t_s 0: column 'pos' is 1722",
        ),
        (
            lambda _, rad: 80 * rad,
            "median distance of positions from their targets is .*half a turn",
        ),
        (lambda _, rad: math.degrees(rad), "are positions in degrees|positions in degrees\\?"),
        (
            lambda k, rad: -9999 if k == 9 else rad,
            r"row 10, .*column 'pos' is -9999; .*counts_per_t",
        ),
        (lambda k, rad: rad - 6.28319 * (k > 60), r"row 62, .*does the encoder begin again after"),
    ],
)
def test_positions_of_a_servo_are_angles_near_its_targets(
    tmp_path: Path, shown: Callable[[int, float], float], told: str
) -> None:
    with pytest.raises(ValueError, match=told):
        driven(tmp_path, shown)


def test_positions_of_a_servo_that_are_right_are_imported(tmp_path: Path) -> None:
    assert driven(tmp_path, lambda _, rad: rad)["episodes"] == 4
    (tmp_path / "o.measured").rename(tmp_path / "first")
    counts = {"counts_per_turn": 4096, "zero": 2048}
    shown = driven(tmp_path, lambda _, rad: 2048 + 651.9 * rad, pos=counts)
    assert shown["episodes"] == 4


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_wheel_s_diameter_is_no_radius(tmp_path: Path, factor: float) -> None:
    base = {**DRIVE["base"], "wheel_radius_m": 0.042 * factor, "wheel_base_m": 0.2 * factor}
    told = refused(tmp_path, {**DRIVE, "base": base})
    assert "is wheel_radius_m the diameter, or half the radius?" in told


def thrown(folder: Path, falls_by: float, told: float | None) -> dict[str, Any]:
    """The verdict on heights of four throws that fall by so much, where the map tells another."""

    def change(rows: Rows) -> None:
        for k, row in enumerate(rows):
            t = 2.0 * (row[1] - 5.0)
            row[1] = 5.0 + t
            # A noise of half a millimetre that has no pattern.
            noise = 5e-4 * math.sin(12.9898 * k * k)
            row[3] = 1.5 + (2.0 + 0.3 * (k // 40)) * t - 0.5 * falls_by * t * t + noise

    mapping = {**with_table(FLIGHT, channels={"y": "y"}), "g_m_s2": told}
    brought(folder, mapping, change)
    return calibrate(folder / "o.measured")


@pytest.mark.parametrize("told", [1.62, 3.71])
def test_a_gravity_that_was_told_is_the_simulation_s(tmp_path: Path, told: float) -> None:
    report = thrown(tmp_path, told, told)
    assert report["verdict"]["kind"] == "nothing", report["verdict"]


def test_a_wrong_gravity_that_was_told_is_found(tmp_path: Path) -> None:
    report = thrown(tmp_path, 9.80665, 1.62)
    assert "gravity" in json.dumps(report["verdict"]), report["verdict"]


@pytest.mark.parametrize("radius_m", [1e308, 1e103, 1e-300, 100.0])
def test_a_radius_that_no_body_has_is_told_with_the_range(tmp_path: Path, radius_m: float) -> None:
    body = {"name": "ball", "mass_kg": 0.0027, "radius_m": radius_m}
    mapping = {**{key: FLIGHT[key] for key in FLIGHT if key != "bodies"}, "body": body}
    with pytest.raises(ValueError, match=r"body\.radius_m is .*allowed is 0\.001 to 10 m"):
        brought(tmp_path, mapping)


def test_scores_of_other_simulators_are_of_pose_trajectories_alone(tmp_path: Path) -> None:
    brought(tmp_path, FLIGHT)
    [bundle] = tmp_path.glob("*.measured")
    (tmp_path / "peer.csv").write_bytes(b"garbage \0 no table")
    with pytest.raises(dwell.ConfigError, match="is of the kind 'trajectory', of which"):
        calibrate(bundle, peers=[tmp_path / "peer.csv"], budget_s=0.1)
