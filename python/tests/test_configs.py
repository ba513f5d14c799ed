"""Settings that type checkers know are those that the engine knows."""

from __future__ import annotations

from typing import ClassVar

import gymnasium
import pytest

import dwell
from dwell import _native
from dwell.engine_types import (
    AcousticSettings,
    AirSettings,
    BodySettings,
    GeneratorSettings,
    WorldSettings,
)
from dwell.envs import DwellEnv
from dwell.envs.config import EnvSettings, arguments_of

pytestmark = pytest.mark.usefixtures("open_once")

#: What World has as arguments of their own.
_OWN = {"agents", "laws", "parameters", "randomize"}


def _allowed(message: str) -> set[str]:
    """The names that the engine's error lists."""
    return set(message.split("expected one of ")[1].replace("`", "").split(" at ")[0].split(", "))


def test_the_names_are_those_of_the_engine() -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError) as world:
        _native.World(room.native, '{"nope": 1}', 0)
    assert _allowed(str(world.value)) - _OWN == set(WorldSettings.__annotations__)
    with pytest.raises(dwell.ConfigError) as body:
        _native.World(room.native, '{"agents": [{"nope": 1}]}', 0)
    assert _allowed(str(body.value)) == set(BodySettings.__annotations__)
    scene = dwell.AcousticScene(room)
    assert set(scene.config) == set(AcousticSettings.__annotations__)
    assert set(scene.config["air"]) == set(AirSettings.__annotations__)
    with pytest.raises(dwell.HouseError) as spec:
        dwell.House.open('seed:1?nope="x"')
    assert _allowed(str(spec.value).split("; ")[0]) == set(GeneratorSettings.__annotations__)


def test_a_task_is_registered_with_what_environments_know() -> None:
    arguments = set(arguments_of(DwellEnv))
    assert set(EnvSettings.__annotations__) == arguments - {"task"}
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError) as env:
        _native.Batch([room.native], '{"nope": 1}')
    # Laws and parameters are the world's there; the others are of Python alone.
    own = {"houses", "episodes", "reward", "laws", "parameters", "randomize", "threads"}
    own |= {"max_episode_steps", "render_mode", "action_mask"}
    # The engine takes several agents; Python's environments are about one.
    assert _allowed(str(env.value)) - {"agents"} == arguments - own - {"agent"}


class Stand(dwell.Task):
    """A task that notes how it is played."""

    seen: ClassVar[list[tuple[float, float, float]]] = []

    def __init__(self, far_m: float = 1.0) -> None:
        self.far_m = far_m

    def reset(self, world: dwell.World, rng: object) -> None:
        del rng
        gravity = world.parameter("world/gravity_m_s2")["value"]
        world.step()
        self.seen.append((self.far_m, gravity, world.time_s))


def test_every_setting_of_a_registered_task_arrives() -> None:
    house = dwell.House.shoebox((4.0, 2.5, 3.0))
    dwell.register_task(
        "tests/Stand-v0",
        Stand,
        houses=house,
        sensors=["depth"],
        reward=None,
        laws=None,
        parameters={"world/gravity_m_s2": 9.0},
        task_settings={"far_m": 2.5},
        stride={"forward_m": 0.5},
        world={"control_rate_hz": 10},
        threads=1,
        render_mode="rgb_array",
    )
    env = gymnasium.make("tests/Stand-v0")
    observation, _ = env.reset(seed=0)
    assert (list(observation), env.render_mode) == (["depth"], "rgb_array")
    gymnasium.make_vec("tests/Stand-v0", num_envs=2, render_mode=None).reset(seed=0)
    assert Stand.seen == [(2.5, 9.0, 0.1)] * 3
    with pytest.raises(dwell.ConfigError, match=r"no argument 'house'; did you mean houses"):
        dwell.register_task("tests/Stand-v1", Stand, house=house)  # type: ignore[call-arg]
    assert "tests/Stand-v1" not in gymnasium.registry


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"rays": "many"}, "rays is 'many'; allowed are whole numbers from 0"),
        ({"rays": 3.5}, "rays is 3.5; allowed are whole numbers from 0"),
        ({"max_duration_s": {}}, "max_duration_s is {}; expected a number"),
        ({"diffraction": 1}, "diffraction is 1; allowed are True and False"),
        ({"air": {"temperature_c": "warm"}}, "air.temperature_c is 'warm'; expected a number"),
        ({"air": 20}, "air is 20; expected values by name"),
    ],
)
def test_wrong_types_are_refused_by_name(settings: dict[str, object], sentence: str) -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError) as error:
        dwell.AcousticScene(room, **settings)  # type: ignore[arg-type] # what is tested
    assert str(error.value).startswith(sentence)


def test_the_same_holds_for_worlds() -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(
        dwell.ConfigError, match=r"16000.0; allowed are whole numbers from 8000 to 192000"
    ):
        dwell.World(room, sound_rate_hz=16000.0)  # type: ignore[arg-type] # what is tested
    with pytest.raises(dwell.ConfigError, match=r"sound_preset is 3; allowed are 'rl', 'full'"):
        dwell.World(room, sound_preset=3)  # type: ignore[arg-type] # what is tested
