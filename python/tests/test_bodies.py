"""Bodies and joints through the package: wheels, legs, doors; right and wrong arguments."""

from __future__ import annotations

import math
import threading
from typing import Any

import pytest

import dwell
from dwell.configs import LOCOMOTIONS

pytestmark = pytest.mark.usefixtures("open_once")

DRIVE = {"locomotion": {"differential_drive": {"wheel_base_m": 0.4, "left_wheel_radius_m": 0.05}}}
HOLONOMIC = {"locomotion": {"holonomic": {"max_sideways_m_s": 0.5}}}


def _hall() -> dwell.House:
    return dwell.House.shoebox((20.0, 3.0, 20.0))


def _alone(body: dict[str, Any]) -> dwell.World:
    world = dwell.World(_hall(), agents=[body])
    world.place_agent((10.0, 0.0, 10.0))
    return world


def test_wheels_turn_and_drive_a_base() -> None:
    world = _alone(DRIVE)
    for _ in range(40):
        world.step([{"wheel_rad_s": (10.0, 10.0)}])
    agent = world.agents()[0]
    # 10 rad/s on 5 cm after a quarter of a second at 40 rad/s2: 0.5 m/s, 0.0625 m less.
    assert agent["base"]["wheel_rad_s"] == pytest.approx([10.0, 10.0], rel=1e-3)
    assert 10.0 - agent["position"][2] == pytest.approx(0.5 * 2.0 - 0.0625, abs=0.02)
    for _ in range(10):
        world.step([{"wheel_rad_s": (-4.0, 4.0)}])
    # Braking at 40 rad/s2, the wheels differ by nothing for 0.15 s, then by up to 8 rad/s within
    # 0.2 s, and by 8 rad/s for 0.15 s: 2 rad, of 5 cm on a base of 0.4 m.
    assert world.agents()[0]["yaw_rad"] == pytest.approx(0.25, abs=0.01)


def test_a_holonomic_base_goes_sideways_up_to_its_speed() -> None:
    world = _alone(HOLONOMIC)
    for _ in range(60):
        world.step([{"right_m_s": 2.0}])
    assert world.agents()[0]["base"]["twist"][1] == pytest.approx(-0.5, rel=1e-3)
    assert world.agents()[0]["position"][0] > 10.8


def test_legs_run_and_crouch() -> None:
    world = _alone({"locomotion": {"walking": {"max_speed_m_s": 4.0}}})
    for _ in range(20):
        world.step([{"forward_m_s": 9.0}])
    assert 10.0 - world.agents()[0]["position"][2] == pytest.approx(4.0, abs=0.05)
    for _ in range(40):
        world.step([{"crouch": True}])
    assert world.agents()[0]["crouched_by_m"] == pytest.approx(0.6, abs=0.01)


@pytest.mark.parametrize(
    ("body", "control", "part"),
    [
        (DRIVE, {"right_m_s": 1.0}, "its wheels do not go sideways"),
        (DRIVE, {"wheel_rad_s": (1.0, 1.0), "forward_m_s": 1.0}, "not both"),
        (DRIVE, {"crouch": True}, "it has no legs"),
        (HOLONOMIC, {"wheel_rad_s": (1.0, 1.0)}, "it has no such wheels"),
        ({}, {"wheel_rad_s": (1.0, 1.0)}, "it has no such wheels"),
        ({}, {"forward_m_s": math.nan}, "finite"),
        ({}, {"fly": 1.0}, "no field 'fly'"),
    ],
)
def test_controls_that_cannot_be_are_refused(
    body: dict[str, Any], control: dict[str, Any], part: str
) -> None:
    world = _alone(body)
    before = world.state_hash()
    with pytest.raises(dwell.DwellError, match=part):
        world.step([control])
    assert world.state_hash() == before
    with pytest.raises(dwell.DwellError, match="no agent 1"):
        world.step([{}, {}])


def test_a_body_that_cannot_be_is_refused() -> None:
    with pytest.raises(dwell.DwellError, match="radius_m"):
        dwell.World(_hall(), agents=[{"radius_m": -1.0}])
    known = "allowed is one of walking, differential_drive, holonomic"
    for wrong in ("hovering", {"hovering": {}}, {}, {"walking": {}, "holonomic": {}}):
        with pytest.raises(dwell.ConfigError, match=rf"agents\[0\].locomotion: found .*; {known}"):
            dwell.World(_hall(), agents=[{"locomotion": wrong}])


def test_a_locomotion_by_its_name_has_its_usual_numbers() -> None:
    for name in LOCOMOTIONS:
        by_name, in_full = (
            dwell.World(_hall(), agents=[{"locomotion": given}]) for given in (name, {name: {}})
        )
        assert by_name.agents() == in_full.agents()


def test_joints_are_read_told_and_set(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    joints = world.joints()
    lid = next(j for j in joints if j["object"].startswith("trash_can") and j["name"] == "lid")
    assert lid["kind"] == "hinge"
    assert lid["motor"] is None
    world.command_joint(lid["id"], "position", lid["limits"][1])
    for _ in range(100):
        world.step()
    assert world.joints()[lid["id"]]["position"] == pytest.approx(lid["limits"][1], abs=0.05)
    world.set_joints({lid["id"]: (1.2, 0.0)})
    assert world.joints()[lid["id"]]["position"] == pytest.approx(1.2)


def test_wrong_joints_and_commands_are_refused(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    lid = next(j["id"] for j in world.joints() if j["name"] == "lid")
    before = world.state_hash()
    with pytest.raises(dwell.ConfigError, match="no joint 9999; there are"):
        world.command_joint(9999, "off")
    with pytest.raises(dwell.ConfigError, match="no joint 9999; there are"):
        world.set_joints({9999: (0.0, 0.0)})
    with pytest.raises(dwell.ConfigError, match="allowed are off, position, velocity, effort"):
        world.command_joint(lid, "wave", 1.0)  # type: ignore[arg-type]
    with pytest.raises(dwell.ConfigError, match="finite"):
        world.command_joint(lid, "position", math.nan)
    with pytest.raises(dwell.UsageError, match="no motor"):
        world.command_joint(lid, "velocity", 1.0)
    with pytest.raises(dwell.UsageError, match="no motor"):
        world.command_joint(lid, "effort", 1.0)
    with pytest.raises(dwell.ConfigError, match="finite"):
        world.set_joints({lid: (math.inf, 0.0)})
    with pytest.raises(dwell.ConfigError, match="expected"):
        world.set_joints({lid: (1.0,)})  # type: ignore[dict-item]
    with pytest.raises(dwell.ConfigError, match="whole numbers"):
        world.command_joint(-1, "off")
    assert world.state_hash() == before


def test_a_restore_in_the_middle_of_a_step_is_refused(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    saved, done = world.snapshot(), threading.Event()

    def walk() -> None:
        while not done.is_set():
            world.step([{"forward_m_s": 1.0}])

    def restore_until_refused() -> None:
        for _ in range(1_000_000):
            world.restore(saved)

    walker = threading.Thread(target=walk)
    walker.start()
    try:
        with pytest.raises(dwell.UsageError, match="busy in another thread"):
            restore_until_refused()
    finally:
        done.set()
        walker.join()
    world.restore(saved)
    assert world.time_s == 0.0
