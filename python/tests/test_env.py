"""The gymnasium environment keeps its contract."""

from __future__ import annotations

import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")

ENV_ID = "dwell/InstructionFollowing-v0"
SMALL = {
    "rgb": {"width": 32, "height": 24},
    "depth": {"width": 32, "height": 24},
    "instruction": {},
}


@pytest.mark.long
def test_check_env_has_nothing_to_say() -> None:
    # Warnings are errors in this suite.
    env = gymnasium.make(ENV_ID, disable_env_checker=True).unwrapped
    check_env(env)
    env.close()
    env.close()


def test_observations_have_the_documented_keys_and_fit_their_spaces() -> None:
    env = DwellEnv()
    observation, info = env.reset(seed=1)
    keys = {"rgb", "depth", "semantic", "audio", "instruction", "instruction_tokens"}
    assert set(observation) == keys
    assert observation in env.observation_space
    assert observation["rgb"].shape == (128, 128, 3)
    assert observation["audio"].shape == (2, 800)
    assert info["scene_id"] == "builtin:apartment"
    tokens = observation["instruction_tokens"]
    words = dwell._native.vocabulary()
    text = observation["instruction"].lower()
    assert all(words[token - 1].strip(".,") in text for token in tokens if token)
    assert (tokens[len(tokens.nonzero()[0]) :] == 0).all()


@pytest.mark.fresh
def test_the_same_seed_gives_the_same_bits_on_any_number_of_threads() -> None:
    def play(threads: int) -> tuple[list[int], list[bytes]]:
        env = DwellEnv(houses="builtin:studio", threads=threads)
        observation, _ = env.reset(seed=11)
        hashes, bits = [env.state_hash()], [observation["rgb"].tobytes()]
        for step in range(12):
            observation, *_ = env.step([1, 1, 2, 1, 3][step % 5])
            hashes.append(env.state_hash())
            bits.append(observation["rgb"].tobytes() + observation["audio"].tobytes())
        return hashes, bits

    once = play(1)
    assert play(1) == once
    assert play(2) == once


def test_the_expert_fulfils_instructions_and_is_paid_for_it() -> None:
    env = DwellEnv(sensors=["instruction"])
    fulfilled = 0
    for seed in range(6):
        env.reset(seed=seed)
        total, terminated, info = 0.0, False, {}
        for _ in range(900):
            _, reward, terminated, truncated, info = env.step(env.expert_action())
            assert truncated is False
            total += reward
            if terminated:
                break
        if info["success"]:
            fulfilled += 1
            assert total > 2.0
            assert 0.0 < info["spl"] <= 1.0
    # The expert may get stuck in a tight spot, but not often.
    assert fulfilled >= 5


def test_stopping_at_once_fails_and_ends_the_episode() -> None:
    env = DwellEnv(sensors=SMALL)
    env.reset(seed=3)
    _, reward, terminated, _, info = env.step(0)
    assert terminated is True
    assert info["success"] is False
    assert reward < 0.1
    with pytest.raises(dwell.UsageError, match="reset"):
        env.step(1)


def test_failed_actions_say_why() -> None:
    env = DwellEnv(sensors=SMALL)
    env.reset(seed=2)
    drop = env.actions().index("drop")
    *_, info = env.step(drop)
    assert info["action_success"] is False
    assert len(info["action_error"]) > 10


def test_rendering_gives_a_picture_and_unknown_modes_are_refused() -> None:
    env = DwellEnv(sensors=SMALL, render_mode="rgb_array")
    env.reset(seed=0)
    image = env.render()
    assert image is not None
    assert image.shape == (240, 320, 3)
    assert image.std() > 5.0
    with pytest.raises(ValueError, match="render_mode"):
        DwellEnv(render_mode="human")


def test_settings_are_checked_where_they_enter() -> None:
    with pytest.raises(dwell.ConfigError, match="smell"):
        DwellEnv(sensors=["smell"])
    with pytest.raises(dwell.ConfigError, match="Cooking"):
        DwellEnv("Cooking")
    with pytest.raises(dwell.ConfigError, match="drug"):
        DwellEnv(laws=[{"id": "drug", "version": 1, "params": {}}])
    with pytest.raises(dwell.HouseNotFoundError):
        DwellEnv(houses="builtin:castle")
    with pytest.raises(dwell.SceneError, match="object/9999/mass_kg"):
        DwellEnv(parameters={"object/9999/mass_kg": 1.0})


def test_a_spec_survives_pickling_and_json() -> None:
    spec = gymnasium.spec(ENV_ID)
    assert pickle.loads(pickle.dumps(spec)) == spec
    again = gymnasium.envs.registration.EnvSpec.from_json(spec.to_json())
    assert again.id == spec.id


def test_vector_environments_equal_single_ones() -> None:
    vector = gymnasium.make_vec(ENV_ID, num_envs=2, sensors=SMALL)
    observation, _ = vector.reset(seed=[4, 9])
    singles = [DwellEnv(sensors=SMALL) for _ in range(2)]
    alone = [env.reset(seed=seed)[0] for env, seed in zip(singles, (4, 9), strict=True)]
    for step in range(6):
        for k, one in enumerate(alone):
            np.testing.assert_array_equal(observation["rgb"][k], one["rgb"])
            np.testing.assert_array_equal(observation["depth"][k], one["depth"])
            assert observation["instruction"][k] == one["instruction"]
        action = [1, 2, 1][step % 3]
        observation, rewards, *_ = vector.step(np.full(2, action))
        results = [env.step(action) for env in singles]
        alone = [result[0] for result in results]
        np.testing.assert_array_equal(rewards, [result[1] for result in results])
    vector.close()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_every_autoreset_mode_starts_ended_episodes(mode: str) -> None:
    env = gymnasium.make_vec(ENV_ID, num_envs=2, sensors=SMALL, autoreset_mode=mode, copy=True)
    first, _ = env.reset(seed=0)
    actions = np.array([0, 1])
    observation, _, terminated, truncated, infos = env.step(actions)
    assert terminated.tolist() == [True, False]
    assert not truncated.any()
    if mode == "SameStep":
        assert infos["_final_obs"].tolist() == [True, False]
        assert set(infos["final_obs"][0]) == set(first)
    if mode == "Disabled":
        with pytest.raises(RuntimeError, match="reset_mask"):
            env.step(actions)
        env.reset(options={"reset_mask": terminated})
        env.step(np.array([1, 1]))
    if mode == "NextStep":
        observation, rewards, terminated, _, _ = env.step(np.array([1, 1]))
        assert rewards[0] == 0.0
        assert not terminated[0]
    assert observation["rgb"].shape == (2, 24, 32, 3)
    env.close()


def test_vector_environments_truncate_at_the_limit() -> None:
    env = gymnasium.make_vec(
        ENV_ID, num_envs=2, sensors=SMALL, vector_kwargs={}, max_episode_steps=3
    )
    env.reset(seed=0)
    ended = [env.step(np.array([2, 2]))[3].tolist() for _ in range(3)]
    assert ended == [[False, False], [False, False], [True, True]]
    env.close()


def about(agent: int, apartment: dwell.House) -> dict[str, Any]:
    """Arguments of environments that are about one of two agents."""
    return {
        "task": "Free",
        "houses": apartment,
        "task_settings": {"start": "anywhere"},
        "world": {"agents": [{}, {"eye_height_m": 1.0}]},
        "agent": agent,
        "sensors": {
            "compass": {},
            "others": {"kind": "compass", "agent": 1 - agent},
            "rgb": {"width": 16, "height": 12, "preset": "flat"},
        },
    }


@pytest.mark.parametrize("agent", [0, 1])
def test_an_environment_is_about_the_agent_that_it_names(
    agent: int, apartment: dwell.House
) -> None:
    env = DwellEnv(**about(agent, apartment))
    env.reset(seed=3)
    before = env.agents()[1 - agent]["position"]
    turn = env.actions().index("turn_left")
    observation, *_ = env.step(turn)
    assert observation["compass"][0] == pytest.approx(np.radians(9.0), abs=1e-3)
    assert observation["others"][0] == pytest.approx(0.0, abs=1e-6)
    assert env.agents()[1 - agent]["position"] == pytest.approx(before, abs=1e-3)
    many = DwellVectorEnv(1, **about(agent, apartment))
    many.reset(seed=3)
    observations, *_ = many.step(np.array([turn]))
    assert np.array_equal(observations["rgb"][0], observation["rgb"])
    saved = env.snapshot()
    env.step(1)
    assert np.array_equal(env.restore(saved)[0]["rgb"], observation["rgb"])
    other = DwellEnv(**about(1 - agent, apartment))
    with pytest.raises(dwell.DwellError, match=f"agent {agent} acts in it"):
        other.restore(saved)


def test_an_agent_that_does_not_exist_is_refused(apartment: dwell.House) -> None:
    for wrong, told in ((2, "below the number of agents, 2"), (-1, "whole"), (True, "whole")):
        with pytest.raises(dwell.ConfigError, match=told):
            DwellEnv(**{**about(0, apartment), "agent": wrong})


def test_a_picture_for_people_is_what_the_agent_sees(apartment: dwell.House) -> None:
    """Agent 1 has its own eyes: the same place and seed give another picture by another height."""
    pictures = []
    for eye_height_m in (1.0, 1.0, 1.4):
        arguments = about(1, apartment)
        arguments["world"] = {"agents": [{}, {"eye_height_m": eye_height_m}]}
        env = DwellEnv(**arguments, render_mode="rgb_array")
        env.reset(seed=3)
        pictures.append(env.render())
    assert np.array_equal(pictures[0], pictures[1])
    assert not np.array_equal(pictures[0], pictures[2])


def test_parts_know_the_agent_that_they_are_about() -> None:
    class Turned(dwell.Task):
        sensors = ("compass",)

        def judge(
            self, world: dwell.World, action: str, verdict: dwell.StepResult
        ) -> dwell.StepResult:
            del action, verdict
            return dwell.StepResult(reward=float(world.agents()[self.agent]["yaw_rad"]))

    for agent in (0, 1):
        env = DwellEnv(Turned, world={"agents": [{}, {}]}, agent=agent)
        env.reset(seed=1)
        _, reward, *_ = env.step(env.actions().index("turn_left"))
        assert reward == env.agents()[agent]["yaw_rad"] != env.agents()[1 - agent]["yaw_rad"]
