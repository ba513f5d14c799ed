"""Values of tasks of one's own that neither a snapshot nor an array can hold."""

from __future__ import annotations

import enum
from collections import OrderedDict
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")


class Side(enum.IntEnum):
    LEFT = 1


CHANGED = [
    np.zeros(3),
    (1, 2),
    {3: 1.5},
    "\ud800",
    {"a": [{"b": (1,)}]},
    np.float32(0.5),
    np.float64(0.5),
    np.uint8(3),
    np.int64(3),
    np.bool_(True),
    np.str_("left"),
    Side.LEFT,
    OrderedDict(a=1),
    [{"a": np.float32(0.5)}],
]


@pytest.mark.parametrize("value", CHANGED, ids=repr)
def test_what_would_come_back_as_something_else_is_refused_by_the_snapshot(value: object) -> None:
    class Keeps(dwell.Task):
        sensors = ("gps",)

        def reset(self, world: dwell.World, rng: np.random.Generator) -> None:
            self.state["kept"] = value

    env = DwellEnv(Keeps, houses="builtin:studio")
    env.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match=r"task\.state(\['kept'\]|\.kept)"):
        env.snapshot()


def test_infos_that_no_array_holds_are_refused_by_name() -> None:
    class Tells(dwell.Task):
        sensors = ("gps",)

        def reset(self, world: dwell.World, rng: np.random.Generator) -> None: ...

        def judge(
            self, world: dwell.World, action: str, verdict: dwell.StepResult
        ) -> dwell.StepResult:
            return dwell.StepResult(info={"large": 10**400})

    envs = DwellVectorEnv(2, Tells, houses="builtin:studio")
    envs.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="info of environment 0"):
        envs.step(np.array([1, 1]))


def test_what_an_observation_cannot_hold_is_refused() -> None:
    box = gymnasium.spaces.Box(-np.inf, np.inf, (2,), np.float32)

    class Sees(dwell.Sensor):
        name, space, value = "sees", box, np.zeros(2)

        def observe(self, world: dwell.World, rng: np.random.Generator) -> Any:  # noqa: ANN401 - also wrong
            return self.value

    env = DwellEnv("Free", houses="builtin:studio", sensors=[Sees])
    Sees.value = np.array([-np.inf, 3e38])
    assert env.reset(seed=1)[0]["sees"].tolist() == [-np.inf, np.float32(3e38)]
    Sees.value = np.array([0.0, 1e300])
    with pytest.raises(dwell.ConfigError, match="sensor sees observed"):
        env.reset(seed=1)
    Sees.value = np.ma.masked_array([0.0, 1.0], [False, True])
    with pytest.raises(dwell.ConfigError, match="sensor sees: what it observed has masked"):
        env.reset(seed=1)


class Remembers(dwell.Sensor):
    """Counts how often it was asked, which is seen."""

    name = "remembers"
    space = gymnasium.spaces.Box(0.0, 1e6, (2,), np.float64)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> Any:  # noqa: ANN401 - an array
        self.state["asked"] = self.state.get("asked", 0) + 1
        return np.array([self.state["asked"], rng.random()])


class Says(dwell.Sensor):
    """Tells in words how often it was asked."""

    name = "says"
    space = gymnasium.spaces.Text(20)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> str:
        self.state["asked"] = self.state.get("asked", 0) + 1
        return f"asked{self.state['asked']}"


def test_a_restored_sensor_observes_what_it_did_at_the_moment_of_the_snapshot() -> None:
    arguments: dict[str, Any] = {"houses": "builtin:studio", "sensors": [Remembers, Says]}
    env = DwellEnv("Free", **arguments)
    env.reset(seed=1)
    moment = env.step(1)[0]
    saved = env.snapshot()
    after = [env.step(2)[0] for _ in range(2)]
    for again in (env, DwellEnv("Free", **arguments)):
        # Whether it is restored once, twice, or out of the snapshot of a restored one.
        for kept in (saved, saved, again.restore(saved) and again.snapshot()):
            seen = again.restore(kept)[0]
            for expected in (moment, *after):
                assert seen["remembers"].tobytes() == expected["remembers"].tobytes()
                assert seen["says"] == expected["says"]
                seen = again.step(2)[0]
    many = DwellVectorEnv(2, "Free", **arguments)
    many.reset(seed=1)
    moments = many.step([1, 2])[0]["remembers"].copy()
    rows = many.snapshot()
    step = many.step([2, 2])[0]["remembers"].copy()
    assert many.restore(rows[::-1])[0]["remembers"].tolist() == moments[::-1].tolist()
    assert many.step([2, 2])[0]["remembers"].tolist() == step[::-1].tolist()


@pytest.mark.parametrize("given", [None, ["gps"]])
@pytest.mark.parametrize("sensors", [lambda self: ["gps"], 5, [5], {"gps"}])
def test_sensors_of_a_task_are_sensors_whether_they_are_used_or_not(
    sensors: object,
    given: Any,  # noqa: ANN401
) -> None:
    task = type("Walk", (dwell.Task,), {"sensors": sensors})
    with pytest.raises(
        dwell.ConfigError, match=r"Walk\.sensors.* is .*; expected names of sensors"
    ):
        DwellEnv(task, sensors=given)
