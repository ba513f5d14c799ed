"""What holds in every environment and form of actions: gymnasium's checks, the same bits."""

from __future__ import annotations

import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import SyncVectorEnv
from gymnasium.vector.utils import iterate

import dwell
from dwell import _native
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.envs.action_modes import ACTION_MODES
from dwell.envs.registration import env_ids

pytestmark = pytest.mark.usefixtures("open_once")

IDS = env_ids()
MODES = list(ACTION_MODES)
#: Every id in one form of actions, every form several times; the other pairs are slow.
PAIRS = [
    pytest.param(
        env_id,
        mode,
        marks=() if (i + m) % len(MODES) == 0 else pytest.mark.slow,
        id=f"{env_id}-{mode}",
    )
    for i, env_id in enumerate(IDS)
    for m, mode in enumerate(MODES)
]
PICTURE = {"width": 16, "height": 12}


def settings_of(mode: str) -> dict[str, Any]:
    return {"houses": "builtin:apartment", "sensors": ["gps", "compass"], "action_mode": mode}


def bits(observation: dict[str, Any]) -> dict[str, bytes]:
    return {name: np.asarray(value).tobytes() for name, value in observation.items()}


@pytest.mark.long
@pytest.mark.parametrize(("env_id", "mode"), PAIRS)
def test_check_env_has_nothing_to_say(env_id: str, mode: str) -> None:
    # Warnings are errors in this suite.
    env = gymnasium.make(env_id, disable_env_checker=True, **settings_of(mode)).unwrapped
    check_env(env, skip_render_check=True)
    env.close()
    env.close()
    with pytest.raises(dwell.UsageError):
        env.reset(seed=1)


@pytest.mark.long
@pytest.mark.parametrize(("env_id", "mode"), PAIRS)
def test_bits_are_the_same_whoever_steps_and_after_a_restore(env_id: str, mode: str) -> None:
    settings = settings_of(mode)
    task = gymnasium.spec(env_id).kwargs["task"]
    one_thread = DwellVectorEnv(2, task, threads=1, **settings)
    two_threads = DwellVectorEnv(2, task, threads=2, **settings)
    sync = SyncVectorEnv([lambda: DwellEnv(task, **settings)] * 2)
    single = pickle.loads(pickle.dumps(DwellEnv(task, **settings)))
    together = [one_thread, two_threads, sync]
    first = [env.reset(seed=3)[0] for env in together]
    assert bits(first[0]) == bits(first[1]) == bits(first[2])
    assert bits(single.reset(seed=3)[0]) == {k: v[: len(v) // 2] for k, v in bits(first[0]).items()}
    one_thread.action_space.seed(4)
    saved, rest = b"", []
    for step in range(6):
        actions = one_thread.action_space.sample()
        rows = [env.step(actions) for env in together]
        assert bits(rows[0][0]) == bits(rows[1][0]) == bits(rows[2][0])
        assert rows[0][1].tobytes() == rows[1][1].tobytes() == rows[2][1].tobytes()
        if rows[0][2].any():
            break
        own = next(iter(iterate(one_thread.action_space, actions)))
        observation, reward, *_ = single.step(own)
        assert reward == rows[0][1][0]
        assert one_thread.state_hashes()[0] == single.state_hash()
        if saved:
            rest.append((own, bits(observation), single.state_hash()))
        elif step == 1:
            saved = single.snapshot()
    if saved:
        again = DwellEnv(task, **settings)
        again.restore(saved)
        for own, seen, state in rest:
            assert (bits(again.step(own)[0]), again.state_hash()) == (seen, state)


@pytest.mark.long
@pytest.mark.parametrize("sensor", _native.sensors(), ids=lambda row: row["name"])
def test_check_env_has_nothing_to_say_of_any_sensor(sensor: dict[str, Any]) -> None:
    task = (sensor["goal_tasks"] or ["Free"])[0]
    settings = PICTURE if sensor["picture_style"] is not None else {}
    on_wheels = {"agents": [{"locomotion": "differential_drive"}]}
    world = on_wheels if sensor["name"] == "wheel_odometry" else None
    sensors = {sensor["name"]: settings}
    env = DwellEnv(task, houses="builtin:apartment", sensors=sensors, world=world)
    check_env(env, skip_render_check=True)
