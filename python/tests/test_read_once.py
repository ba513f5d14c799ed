"""Arguments that can be read only once, and calls that are refused and change nothing."""

from __future__ import annotations

import logging
import pickle
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder, VectorReplayRecorder
from dwell.house_list import HouseList


class Counter(dwell.Sensor):
    name = "counter"
    space = gymnasium.spaces.Discrete(2)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> int:
        return 0


def test_an_agent_is_placed_by_an_iterator(apartment: dwell.House) -> None:
    world, twin = dwell.World(apartment), dwell.World(apartment)
    place = apartment.rooms()[0]["stand"]
    world.place_agent(iter(place))
    twin.place_agent(place)
    assert world.state_hash() == twin.state_hash()


def test_who_stands_outside_is_told_of_an_iterator(caplog: pytest.LogCaptureFixture) -> None:
    world = dwell.World(dwell.House.shoebox((4.0, 2.5, 3.0)))
    world.house._told_outside.clear()
    with caplog.at_level(logging.WARNING, "dwell.outside"):
        world.place_agent(iter((40.0, 0.0, 3.4)))  # type: ignore[arg-type] # what is tested
    assert "an agent stands outside of every room" in caplog.text


RESPONSES: dict[str, Callable[[dwell.AcousticScene, Any, Any], Any]] = {
    "impulse_response": lambda scene, source, mic: scene.impulse_response(source, mic).tolist(),
    "metrics": lambda scene, source, mic: scene.metrics(source, mic),
    "echogram": lambda scene, source, mic: scene.echogram(source, mic),
    "early_paths": lambda scene, source, mic: scene.early_paths(source, mic),
}


@pytest.mark.parametrize("response", RESPONSES)
def test_sources_and_microphones_may_be_iterators(response: str) -> None:
    scene = dwell.AcousticScene(dwell.House.shoebox((4.0, 2.5, 3.0)), rays=100)
    taken, places = RESPONSES[response], ((1.0, 1.0, 1.0), (2.0, 1.0, 2.0))
    assert taken(scene, *map(iter, places)) == taken(scene, *places)


@pytest.mark.parametrize("height_m", [None, np.nan, "x", True])
def test_a_refused_storey_leaves_the_plan_as_it_was(height_m: Any) -> None:  # noqa: ANN401
    builder = dwell.HouseBuilder()
    before = builder.plan()
    with pytest.raises(dwell.ConfigError, match="height_m is "):
        builder.storey(height_m)
    assert builder.plan() == before
    builder.storey(2.4).room("hall", (0.0, 0.0, 4.0, 3.0))
    assert [storey["height_m"] for storey in builder.plan()["building"]["storeys"]] == [2.4]


def test_nobody_may_be_given_no_controls(apartment: dwell.House) -> None:
    for agents in (0, 1):
        world, twin = dwell.World(apartment, agents=agents), dwell.World(apartment, agents=agents)
        world.step([])
        twin.step()
        assert world.state_hash() == twin.state_hash()


def test_equal_lists_of_houses_are_equal() -> None:
    houses = HouseList(["builtin:studio", "seed:0..1000000000?home=studio", "seed:4"])
    assert houses == HouseList(["builtin:studio", "seed:0..1000000000?home=studio", "seed:4"])
    assert houses == pickle.loads(pickle.dumps(houses))
    assert HouseList(["seed:0..2", "seed:2"]) == HouseList(["seed:0", "seed:1..3"])
    assert HouseList(["seed:0..2"]) != HouseList(["seed:1", "seed:0"])
    assert HouseList(["seed:0..2"]) != HouseList(["seed:0..3"])
    assert HouseList(["a"]) != ["a"]


def test_episodes_are_recorded_into_a_folder_with_a_name() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    with pytest.raises(dwell.ConfigError, match="folder is ''; expected the path of a file or"):
        ReplayRecorder(env, "")
    envs = DwellVectorEnv(1, "Free", houses="builtin:studio", sensors=["gps"])
    with pytest.raises(dwell.ConfigError, match="folder is ''; expected the path of a file or"):
        VectorReplayRecorder(envs, "")


def test_a_snapshot_without_parts_is_told_as_one() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    other = DwellEnv("Free", houses="builtin:studio", sensors=["gps", Counter])
    env.reset(seed=1)
    other.reset(seed=1)
    before = other.state_hash()
    with pytest.raises(dwell.ConfigError, match=r"without parts in Python; .*'sensor counter'"):
        other.restore(env.snapshot())
    assert other.state_hash() == before
    other.step(1)


def test_an_observation_that_is_read_only_is_told_as_one() -> None:
    envs = DwellVectorEnv(1, "Free", houses="builtin:studio", sensors=["gps"])
    observations, _ = envs.reset(seed=1)
    observations["gps"].flags.writeable = False
    with pytest.raises(dwell.ConfigError, match=r"gps: expected .* that is read-only"):
        envs.step(np.array([1]))
