"""Objects that can be rebuilt travel to other processes; others say that they cannot."""

from __future__ import annotations

import copy
import pickle

import gymnasium
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

SMALL = {"rgb": {"width": 16, "height": 16}, "instruction": {}}


def test_houses_are_opened_again_and_copies_are_the_same(apartment: dwell.House) -> None:
    assert pickle.loads(pickle.dumps(apartment)).info() == apartment.info()
    assert copy.deepcopy(apartment) is apartment
    box = dwell.House.shoebox((3.0, 2.5, 4.0), absorption=0.3)
    again = pickle.loads(pickle.dumps(box))
    assert dwell.World(again, agents=0).state_hash() == dwell.World(box, agents=0).state_hash()
    with pytest.raises(dwell.UsageError, match="write it"):
        pickle.dumps(dwell.House(apartment.native))


def test_a_copied_world_goes_on_from_its_moment_alone(apartment: dwell.House) -> None:
    world = dwell.World(apartment, seed=4, parameters={"world/gravity_m_s2": 3.7})
    world.place_agent(apartment.rooms()[0]["stand"])
    for _ in range(3):
        world.do("move_forward")
    before = world.state_hash()
    for other in (pickle.loads(pickle.dumps(world)), copy.deepcopy(world)):
        assert other.state_hash() == before
        other.do("turn_left")
        assert world.state_hash() == before
    world.do("turn_left")
    assert other.state_hash() == world.state_hash()


@pytest.mark.usefixtures("open_once")
def test_environments_are_made_anew_from_their_arguments(apartment: dwell.House) -> None:
    env = DwellEnv(sensors=SMALL, houses=apartment, stride={"turn_deg": 30.0})
    env.reset(seed=5)
    for other in (pickle.loads(pickle.dumps(env)), copy.deepcopy(env)):
        other.reset(seed=5)
        assert other.state_hash() == env.state_hash()
    made = gymnasium.make("dwell/InstructionFollowing-v0", sensors=SMALL)
    made.reset(seed=5)
    again = pickle.loads(pickle.dumps(made))
    again.reset(seed=5)
    assert again.unwrapped.state_hash() == made.unwrapped.state_hash()
    vector = DwellVectorEnv(2, sensors=SMALL)
    vector.reset(seed=5)
    twin = pickle.loads(pickle.dumps(vector))
    twin.reset(seed=5)
    assert twin.state_hashes() == vector.state_hashes()


def test_acoustic_scenes_are_prepared_again(shoebox: dwell.House) -> None:
    scene = dwell.AcousticScene(shoebox, rays=50)
    again = pickle.loads(pickle.dumps(scene))
    points = ((1.0, 1.5, 1.0), (4.0, 1.5, 3.0))
    assert (again.impulse_response(*points) == scene.impulse_response(*points)).all()
