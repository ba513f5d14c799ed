"""What objects keep is their own: callers may change what they gave, and compare what they have."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import dwell
import dwell.house_list
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")


@pytest.mark.parametrize("kind", [DwellEnv, DwellVectorEnv])
def test_a_pickled_environment_is_the_one_that_was_made(kind: type) -> None:
    given: dict[str, Any] = {
        "task": "Free",
        "houses": ["builtin:studio"],
        "sensors": {"rgb": {"width": 16, "height": 16}},
        "stride": {"turn_deg": 30.0},
        "parameters": {"world/gravity_m_s2": 3.0},
        "world": {"agents": [{"eye_height_m": 1.2}]},
        "laws": [{"id": "drag", "params": {"c_d": 0.5}}],
    }
    untouched = copy.deepcopy(given)
    env, twin = kind(**given), kind(**untouched)
    given["houses"][0] = "builtin:nothing"
    given["sensors"]["rgb"]["width"] = 32
    given["sensors"]["gps"] = {}
    given["stride"]["turn_deg"] = 10.0
    given["parameters"].clear()
    given["world"]["agents"][0]["eye_height_m"] = 1.6
    given["laws"][0]["params"]["c_d"] = 1.0
    again = pickle.loads(pickle.dumps(env))
    assert again.observation_space == twin.observation_space
    for one in (again, twin):
        one.reset(seed=1)
        one.step(np.array([2]) if kind is DwellVectorEnv else 2)
    assert again.snapshot() == twin.snapshot()


def test_houses_that_can_be_gone_through_once_are_kept() -> None:
    env = DwellEnv("Free", houses=iter(["builtin:studio"]), sensors=iter(["gps"]))
    assert pickle.loads(pickle.dumps(env)).reset(seed=1)[1]["scene_id"] == "builtin:studio"
    many = dwell.house_list.HouseList(["seed:0..1000000000?home=studio"])
    env = DwellEnv("Free", houses=many, sensors=["gps"])
    many.append("builtin:nothing")
    assert len(pickle.loads(pickle.dumps(env))._shelf.names) == 10**9


class Watched(dwell.World):
    """A world that counts who looked."""

    looks = 0


def test_a_copied_world_is_of_its_class_and_has_what_it_had(shoebox: dwell.House) -> None:
    world = Watched(shoebox)
    world.looks, shared = 3, [1]
    world.shared = shared  # type: ignore[attr-defined] # of its user
    world.step()
    for other in (copy.copy(world), copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
        assert type(other) is Watched
        assert other.looks == 3
        assert other.shared == [1]
        assert other.state_hash() == world.state_hash()
    assert copy.copy(world).shared is shared  # type: ignore[attr-defined] # as above
    assert copy.deepcopy(world).shared is not shared  # type: ignore[attr-defined] # as above


def test_cameras_and_sources_hold_numbers_of_their_own() -> None:
    place, lens = np.zeros(3), {"kind": "pinhole", "fx": 60, "fy": 60, "cx": 64, "cy": 64}
    camera = dwell.Camera(position_m=place, projection=lens, fov_deg=np.float32(90))
    same = dwell.Camera(position_m=[0, 0, 0], projection=dict(lens), fov_deg=90)
    before = hash(camera)
    assert camera == same
    assert hash(same) == before
    place[0], lens["fx"] = 5.0, 1
    assert camera == same
    assert hash(camera) == before
    for kind in (dwell.Source, dwell.Microphone):
        spot = np.array([1.0, 1.5, 2.0])
        one, other = kind(spot, yaw_deg=np.array(30.0)), kind((1, 1.5, 2), yaw_deg=30)
        spot[0] = 9.0
        assert one == other
        assert hash(one) == hash(other)
        assert one.position == (1.0, 1.5, 2.0)
    pose = {"position": np.ones(3), "rotation": [0.0, 0.0, 0.0, 1.0]}
    receiver = dwell.Receiver(pose, "omni")
    pose["position"][0] = 7.0  # type: ignore[index] # an array
    assert receiver == dwell.Receiver.omni((1, 1, 1))
    assert hash(receiver) == hash(dwell.Receiver.omni((1, 1, 1)))


def test_echograms_compare_as_a_whole(shoebox: dwell.House) -> None:
    scene = dwell.AcousticScene(shoebox, rays=50)
    points = ((1.0, 1.5, 1.0), (4.0, 1.5, 3.0))
    assert scene.echogram(*points) == scene.echogram(*points)
    assert scene.echogram(*points) != scene.echogram(*points[::-1])


def test_house_lists_find_as_lists_do() -> None:
    names = ["a", "seed:3", "b", "a", "seed:2", "seed:3", "a"]
    houses = dwell.house_list.HouseList(["a", "seed:3", "b", "a", "seed:2..4", "a"])
    assert list(houses) == names
    for name in {*names}:
        assert houses.count(name) == names.count(name)
        for start in range(-9, 9):
            for stop in range(-9, 9):
                try:
                    expected = names.index(name, start, stop)
                except ValueError:
                    with pytest.raises(ValueError, match="no house"):
                        houses.index(name, start, stop)
                else:
                    assert houses.index(name, start, stop) == expected
    long = dwell.house_list.HouseList(["seed:0..1000000000"])
    assert long.count("seed:7") == 1
    assert long.index("seed:7", -(10**10)) == 7
