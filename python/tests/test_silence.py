"""SWS: success in a task whose sound ends, where it was over at the stop."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.envs.silence import FIRST_PLAYED

pytestmark = pytest.mark.usefixtures("open_once")

TASK = "SemanticAudioNav"


def played(env: DwellEnv) -> list[dict[str, Any]]:
    """The sounds that the episode plays, the first one first."""
    return [row for row in env.world.sounds() if row["object"] is None]


@pytest.mark.parametrize("distractors", [0, 3])
def test_the_goal_s_sound_is_the_first_that_an_episode_plays(distractors: int) -> None:
    settings = {"distractors": distractors}
    env = DwellEnv(TASK, houses="builtin:apartment", sensors=["gps"], task_settings=settings)
    for seed in range(3):
        _, info = env.reset(seed=seed)
        sounds = played(env)
        assert min(row["handle"] for row in sounds) == sounds[0]["handle"] == FIRST_PLAYED
        # It sounds from a thing of the class that is asked for, and no other does.
        classes = []
        for row in sounds:
            things = env.world.objects()
            ways = [np.linalg.norm(np.subtract(row["position"], one["center"])) for one in things]
            classes.append(things[int(np.argmin(ways))]["category"])
        assert classes[0] == info["goal_class"]
        assert info["goal_class"] not in classes[1:]
        assert len(sounds) == 1 + distractors


@pytest.mark.parametrize("waits_s", [0.0, 14.0])
def test_success_counts_as_silent_once_the_sound_is_over(waits_s: float) -> None:
    settings: dict[str, Any] = {"houses": "builtin:apartment", "sensors": ["gps"]}
    near = {"max_distance_m": 1.5}
    env = DwellEnv(TASK, task_settings=near, **settings)
    many = DwellVectorEnv(1, TASK, task_settings=near, **settings)
    lengths_s = {row["name"]: row["loop_s"] for row in dwell.sounds.signals()}
    wait = env.actions().index("wait")
    for seed in range(2):
        _, info = env.reset(seed=seed)
        many.reset(seed=seed)
        (sound,) = played(env)
        length_s = lengths_s[sound["sound"]["signal"]]
        assert 2.0 <= length_s <= 12.0
        actions = [wait] * round(20 * waits_s)
        over, steps = False, 0
        while not over:
            action = actions.pop() if actions else env.expert_action()
            *_, over, _, info = env.step(action)
            *_, infos = many.step([action])
            steps += 1
            assert infos["_sws"].all()
            assert infos["sws"][0] == info["sws"]
            if not over:
                assert info["sws"] is False
        assert info["success"]
        # At 20 steps a second; the sound begins with the first.
        assert info["sws"] is (steps / 20 >= length_s)
        assert info["sws"] is (waits_s > 0.0)


def test_a_sound_without_end_is_never_silent_and_other_tasks_have_no_sws() -> None:
    env = DwellEnv(TASK, houses="builtin:apartment", sensors=["gps"], task_settings={"loops": True})
    env.reset(seed=1)
    over, wait = False, [env.actions().index("wait")] * 300
    while not over:
        *_, over, _, info = env.step(wait.pop() if wait else env.expert_action())
    assert (info["success"], info["sws"]) == (True, False)
    other = DwellEnv("AudioNav", houses="builtin:apartment", sensors=["gps"])
    other.reset(seed=1)
    assert "sws" not in other.step(0)[4]
