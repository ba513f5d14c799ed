"""An environment that is called while another of its calls plays the episode."""

from __future__ import annotations

import threading
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

#: What a task calls in the middle of a step.
NESTED: list[Any] = []


class Nesting(dwell.Task):
    sensors = ("gps",)

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        for call in NESTED:
            call()
        return verdict


class Looking(dwell.Sensor):
    name = "looking"
    space = gymnasium.spaces.Discrete(2)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> int:
        for call in NESTED:
            call()
        return 0


@pytest.fixture(autouse=True)
def no_calls() -> Any:  # noqa: ANN401 - of pytest
    NESTED.clear()
    yield
    NESTED.clear()


def test_a_step_within_a_step_is_told_as_one() -> None:
    env = DwellEnv(Nesting, houses="builtin:studio")
    env.reset(seed=1)
    for call in (lambda: env.step(1), env.snapshot, env.expert_action):
        NESTED[:] = [call]
        with pytest.raises(dwell.UsageError, match=r"another call \(step\) .* is running"):
            env.step(1)
        NESTED.clear()
        # The step that a task does not judge to its end is none, as before.
        with pytest.raises(dwell.UsageError, match="no episode has begun"):
            env.step(1)
        env.reset(seed=1)
    env.step(1)


def test_a_step_of_a_sensor_that_observes_is_told_as_one() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=[Looking])
    envs = DwellVectorEnv(1, "Free", houses="builtin:studio", sensors=[Looking])
    for one, action in ((env, 1), (envs, np.array([1]))):
        one.reset(seed=1)
        NESTED[:] = [lambda one=one, action=action: one.step(action)]
        with pytest.raises(dwell.UsageError, match=r"another call \(step\) .* is running"):
            one.step(action)
        with pytest.raises(dwell.UsageError, match=r"another call \(reset\) .* is running"):
            one.reset(seed=1)
        NESTED.clear()


def test_a_step_of_a_vector_within_a_step_is_told_as_one() -> None:
    envs = DwellVectorEnv(2, Nesting, houses="builtin:studio")
    envs.reset(seed=1)
    NESTED[:] = [lambda: envs.step(np.array([1, 1]))]
    with pytest.raises(dwell.UsageError, match=r"another call \(step\) .* is running"):
        envs.step(np.array([1, 1]))


def test_a_step_beside_one_of_another_thread_is_told_as_one() -> None:
    env = DwellEnv(Nesting, houses="builtin:studio")
    env.reset(seed=1)
    inside, over = threading.Event(), threading.Event()
    NESTED[:] = [inside.set, over.wait]
    thread = threading.Thread(target=env.step, args=(1,))
    thread.start()
    inside.wait()
    try:
        with pytest.raises(dwell.UsageError, match=r"another call \(step\) .* in another thread"):
            env.step(1)
    finally:
        over.set()
        thread.join()
    NESTED.clear()
    env.step(1)


def test_pictures_follow_as_fast_as_steps() -> None:
    for rate_hz, told in ((10.0, 10), (None, 20)):
        world = {} if rate_hz is None else {"control_rate_hz": rate_hz}
        env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], world=world)
        envs = DwellVectorEnv(1, "Free", houses="builtin:studio", sensors=["gps"], world=world)
        assert env.metadata["render_fps"] == envs.metadata["render_fps"] == told
    assert DwellEnv.metadata["render_fps"] == 20


def test_calls_of_a_vector_beside_a_step_of_another_thread_are_told_as_such() -> None:
    envs = DwellVectorEnv(2, Nesting, houses="builtin:studio")
    envs.reset(seed=1)
    saved = envs.snapshot()
    inside, over = threading.Event(), threading.Event()
    NESTED[:] = [inside.set, over.wait]
    thread = threading.Thread(target=envs.step, args=(np.array([1, 1]),))
    thread.start()
    inside.wait()
    try:
        for call in (
            envs.snapshot,
            lambda: envs.restore(saved),
            lambda: envs.reset(seed=3),
            lambda: envs.step(np.array([1, 1])),
        ):
            with pytest.raises(dwell.UsageError, match=r"another call \(step\) .* another thread"):
                call()
    finally:
        over.set()
        thread.join()
    NESTED.clear()
    # Nothing of it has harmed the step.
    twins = DwellVectorEnv(2, Nesting, houses="builtin:studio")
    twins.reset(seed=1)
    twins.step(np.array([1, 1]))
    assert envs.state_hashes() == twins.state_hashes()
    assert len(envs.snapshot()) == 2
