"""Episodes that a call left half begun or half judged: nobody plays on in them."""

from __future__ import annotations

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")


class Raised(BaseException):
    """What no ``except Exception`` catches, as KeyboardInterrupt."""


class Failing(dwell.Task):
    """A task that raises where it is told to."""

    sensors = ("gps",)
    at = ""

    def reset(self, world: dwell.World, rng: np.random.Generator) -> None:
        self._maybe("reset")

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        self._maybe("judge")
        return verdict

    def _maybe(self, where: str) -> None:
        if Failing.at == where:
            raise Raised


@pytest.mark.parametrize("at", ["reset", "judge", "house"])
def test_an_environment_without_a_whole_episode_wants_a_reset(
    at: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    houses = ["builtin:studio", "builtin:nothing"]
    env, twin = (DwellEnv(Failing, houses=houses) for _ in range(2))
    first = {"house": 0}
    env.reset(seed=1, options=first)
    saved = env.snapshot()
    monkeypatch.setattr(Failing, "at", at)
    other = {"house": int(at == "house")}
    with pytest.raises((Raised, dwell.HouseError)):
        env.step(1) if at == "judge" else env.reset(seed=2, options=other)
    monkeypatch.setattr(Failing, "at", "")
    for call in (lambda: env.step(1), env.snapshot, env.expert_action):
        with pytest.raises(dwell.UsageError, match="no episode has begun; call reset first"):
            call()
    for begin in (lambda e: e.reset(seed=3, options=first), lambda e: e.restore(saved)):
        begin(env)
        begin(twin)
        env.step(1)
        twin.step(1)
        assert env.state_hash() == twin.state_hash()


def test_options_that_are_none_leave_the_episode_and_what_is_drawn() -> None:
    env, twin = (DwellEnv("Free", sensors=["gps"], houses="builtin:studio") for _ in range(2))
    env.reset(seed=1)
    twin.reset(seed=1)
    for options in ({"nope": 1}, {"house": 1}, {"episode_id": "x#1"}):
        with pytest.raises(dwell.ConfigError):
            env.reset(seed=9, options=options)
    env.step(1)
    twin.step(1)
    assert env.state_hash() == twin.state_hash()
    assert env.reset()[1] == twin.reset()[1]


def test_a_vector_whose_tasks_were_stopped_in_their_judging_wants_a_reset(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    envs = DwellVectorEnv(2, Failing, houses="builtin:studio")
    envs.reset(seed=1)
    monkeypatch.setattr(Failing, "at", "judge")
    with pytest.raises(Raised):
        envs.step([1, 1])
    monkeypatch.setattr(Failing, "at", "")
    with pytest.raises(dwell.UsageError, match=r"no episode of environments \[0, 1\]"):
        envs.step([1, 1])
    with pytest.raises(dwell.UsageError, match="no episode of environment 0"):
        envs.snapshot()
    envs.reset(seed=1)
    envs.step([1, 1])


def test_a_step_after_the_end_is_refused_and_leaves_the_episode() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=1)
    env.step(1)
    assert env.step(0)[2]
    saved, state = env.snapshot(), env.state_hash()
    for _ in range(2):
        with pytest.raises(dwell.UsageError, match="the episode has ended; call reset first"):
            env.step(1)
        assert env.state_hash() == state
    # What has ended can still be kept, copied and told.
    assert env.snapshot() == saved
    assert env.fork().state_hash() == state
    env.reset(seed=2)
    env.step(1)
    # Restored, it has ended as before.
    env.restore(saved)
    assert env.state_hash() == state
    with pytest.raises(dwell.UsageError, match="the episode has ended"):
        env.step(1)
    env.reset(seed=2)
    env.step(1)
