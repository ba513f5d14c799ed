"""Tasks as environments: what they tell of their goals, and what ears give to networks."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from gymnasium.vector.utils import concatenate, create_empty_array
from numpy.typing import NDArray

from dwell import _native
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.played_actions import said_action


def spectrogram(signal: NDArray[np.float32], reference_pa: float) -> NDArray[np.float64]:
    """The spectrogram of SoundSpaces, from its description: zeros around the signal."""
    padded = np.pad(signal.astype(np.float64), 256)
    window = np.zeros(512)
    window[56:456] = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(400) / 400)
    starts = range(0, len(padded) - 512 + 1, 160)
    frames = np.array([padded[start : start + 512] * window for start in starts])
    magnitudes = np.abs(np.fft.rfft(frames, axis=1)).T
    rows, columns = (-(-size // 4) for size in magnitudes.shape)
    blocks = np.zeros((rows * 4, columns * 4))
    blocks[: magnitudes.shape[0], : magnitudes.shape[1]] = magnitudes
    means = blocks.reshape(rows, 4, columns, 4).mean(axis=(1, 3))
    return np.asarray(np.log1p(means / reference_pa))


@pytest.mark.parametrize(("window_s", "reference_pa"), [(1.0, 1e-3), (0.25, 0.02)])
def test_spectrograms_are_those_of_the_same_window_of_sound(
    window_s: float, reference_pa: float
) -> None:
    sensors = {
        "audio": {"window_s": window_s},
        "spectrogram": {"window_s": window_s, "reference_pa": reference_pa},
    }
    env = DwellEnv("AudioNav", houses="builtin:studio", sensors=sensors)
    env.reset(seed=3)
    for action in (1, 2, 6, 1, 6, 6):
        observation, *_ = env.step(action)
    heard = observation["audio"]
    assert np.abs(heard).max() > 1e-4
    expected = np.stack([spectrogram(ear, reference_pa) for ear in heard], axis=-1)
    assert observation["spectrogram"].shape == expected.shape
    np.testing.assert_allclose(observation["spectrogram"], expected, atol=2e-4)
    env.close()


@pytest.mark.long
@pytest.mark.parametrize(
    "task", [task["name"] for task in _native.tasks() if task["min_agents"] == 1]
)
def test_infos_say_what_is_asked_alone_and_in_a_batch(task: str) -> None:
    houses = ["builtin:apartment", "builtin:studio"]
    one = DwellEnv(task, houses=houses, sensors=["gps"])
    many = DwellVectorEnv(2, task, houses=houses, sensors=["gps"], autoreset_mode="SameStep")
    _, infos = many.reset(seed=4)
    numbers = (0, 6)
    elements = [said_action(one.actions()[number], one) for number in numbers]
    empty = create_empty_array(many.single_action_space, 2)
    stopped = many.step(concatenate(many.single_action_space, elements, empty))[4]
    for k, episode_id in enumerate(infos["episode_id"].tolist()):
        _, info = one.reset(options={"episode_id": episode_id})
        keys = [key for key in infos if not key.startswith("_") and infos[f"_{key}"][k]]
        assert info == {key: infos[key][k] for key in keys}
        step = one.step(elements[k])[4]
        assert {key: step[key] for key in info} == info
        then = {key: stopped["final_info"][key][0] if k == 0 else stopped[key][1] for key in info}
        assert then == info
        if task == "Free":
            assert set(info) == {"scene_id", "episode_id"}
            continue
        if task not in ("SoundLocalization", "Rearrange", "Tidy"):
            assert info["start_distance_to_goal"] >= 0.9
        assert isinstance(info["goal_kind"], str)
        restored = one.restore(one.snapshot())[1]
        assert restored == info


def test_a_task_in_python_asks_for_its_own() -> None:
    from dwell import Task, TaskGoal

    class Own(Task):
        base = "PointNav"
        base_settings = None
        sensors = ("gps",)

        def reset(self, world: object, rng: object) -> TaskGoal:
            return TaskGoal("Go to the goal.", 2.5)

    env = DwellEnv(Own)
    _, info = env.reset(seed=1)
    told = {key: info[key] for key in info if key not in ("scene_id", "episode_id")}
    assert told == {"start_distance_to_goal": 2.5}
    assert env.restore(env.snapshot())[1] == info
    # What a sensor of the base's goal showed before does not stay.
    pointing = DwellEnv(Own, sensors=["pointgoal_with_gps_compass"])
    for seed in (1, 2):
        observation, _ = pointing.reset(seed=seed)
        assert observation["pointgoal_with_gps_compass"].tolist() == [0.0, 0.0]


@pytest.mark.long
def test_a_curriculum_is_a_setting() -> None:
    for furthest_m in (2.0, 4.0):
        env = gymnasium.make(
            "dwell/PointNav-v0",
            houses="seed:0..3",
            sensors=["pointgoal_with_gps_compass"],
            task_settings={"max_distance_m": furthest_m, "ends_at_goal": True},
        )
        starts = [env.reset(seed=seed)[1]["start_distance_to_goal"] for seed in range(6)]
        assert 1.0 <= min(starts) <= max(starts) <= furthest_m
        env.close()
