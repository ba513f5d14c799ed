"""Values of tasks of one's own that neither a snapshot nor an array can hold."""

from __future__ import annotations

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv


@pytest.mark.parametrize("value", [np.zeros(3), (1, 2), {3: 1.5}, "\ud800", {"a": [{"b": (1,)}]}])
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
