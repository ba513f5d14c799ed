"""Tasks, rewards and sensors in Python are each of one environment."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv


class _Counts(dwell.Task):
    """Counts its steps."""

    sensors = ("gps",)

    def reset(self, world: dwell.World, rng: np.random.Generator) -> None:
        self.state["steps"] = 0

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        self.state["steps"] += 1
        return dwell.StepResult(float(self.state["steps"]), False, False)


class _Steps(dwell.Sensor):
    """How many observations there were."""

    name = "observed"
    space = gymnasium.spaces.Box(0.0, 1e6, (1,), np.float32)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> Any:  # noqa: ANN401
        self.state["n"] = self.state.get("n", 0) + 1
        return np.array([self.state["n"]], np.float32)


class _Paid(dwell.Reward):
    """A reward for each step."""

    def reward(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> float:
        return 1.0


def test_environments_do_not_share_a_part() -> None:
    one, sensor, reward = _Counts(), _Steps(), _Paid()
    for arguments, name in (
        ({"task": lambda: one}, "_Counts"),
        ({"task": "Free", "sensors": ["gps", lambda: sensor]}, "_Steps"),
        ({"task": "Free", "sensors": {"gps": {}, "mine": lambda: sensor}}, "_Steps"),
        ({"task": "Free", "sensors": ["gps"], "reward": lambda: reward}, "_Paid"),
    ):
        with pytest.raises(dwell.ConfigError, match=f"the same {name} in two environments"):
            DwellVectorEnv(2, houses="builtin:studio", **arguments)
    own = DwellVectorEnv(2, lambda: _Counts(), houses="builtin:studio")
    own.reset(seed=1)
    assert [own.step([1, 1])[1].tolist() for _ in range(2)] == [[1.0, 1.0], [2.0, 2.0]]
    own.close()


def test_a_part_is_of_one_environment_as_long_as_that_is_open() -> None:
    one = _Counts()
    # In several houses it is the same environment.
    houses = ["builtin:studio", "seed:3?home=studio"]
    first = DwellEnv(lambda: one, houses=houses)
    for house in range(2):
        first.reset(seed=1, options={"house": house})
        assert [first.step(1)[1] for _ in range(2)] == [1.0, 2.0]
    with pytest.raises(dwell.ConfigError, match="the same _Counts in two environments"):
        DwellEnv(lambda: one, houses="builtin:studio")
    # Who was refused has not touched the state of the other.
    assert first.step(1)[1] == 3.0
    first.close()
    second = DwellEnv(lambda: one, houses="builtin:studio")
    second.reset(seed=1)
    assert second.step(1)[1] == 1.0
    second.close()
