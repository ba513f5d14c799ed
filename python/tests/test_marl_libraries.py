"""Libraries of reinforcement learning for several agents step environments of dwell.

They are no dependencies: the tests run where TorchRL, or SuperSuit and Stable-Baselines3, are
installed, and say so where they are not.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pettingzoo.utils import parallel_to_aec

import dwell
from dwell import pettingzoo as zoo

pytestmark = [
    pytest.mark.usefixtures("open_once"),
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore"),
]

SETTINGS: dict[str, Any] = {
    "agents": 3,
    "houses": "builtin:studio",
    "sensors": ["gps", "compass"],
    "max_cycles": 12,
}


def test_infos_are_left_out_but_for_masks() -> None:
    """Needs no library."""
    env = zoo.TorchRLCompatible(zoo.parallel_env("PointNav", action_mask=True, **SETTINGS))
    bare = zoo.parallel_env("PointNav", action_mask=True, **SETTINGS)
    _, infos = env.reset(seed=1)
    _, told = bare.reset(seed=1)
    actions = dict.fromkeys(bare.agents, 1)
    for mine, theirs in ((infos, told), (env.step(actions)[4], bare.step(actions)[4])):
        assert {name: [*info] for name, info in mine.items()} == {
            name: ["action_mask"] for name in bare.possible_agents
        }
        for name, info in mine.items():
            assert np.array_equal(info["action_mask"], theirs[name]["action_mask"])
    env.step({"agent_0": 0, "agent_1": 1, "agent_2": 1})
    assert env.agents == ["agent_1", "agent_2"]
    env.step(actions)
    with pytest.raises(dwell.ConfigError, match="agent_9"):
        env.step({**actions, "agent_9": 1})


def test_torchrl_steps_them_to_the_same_bits() -> None:
    """Rewards and observations of a rollout are those of the bare environment, as are ends."""
    pytest.importorskip("torchrl", reason="needs TorchRL (pip install torchrl)")
    import torch
    from torchrl.envs.libs.pettingzoo import PettingZooWrapper
    from torchrl.envs.utils import check_env_specs

    own = zoo.parallel_env("PointNav", **SETTINGS)
    env = PettingZooWrapper(zoo.TorchRLCompatible(own), use_mask=True, categorical_actions=True)
    check_env_specs(env)
    # Agent 1 stops in the third step.
    plan = np.array([[1, 1 if step != 2 else 0, 2] for step in range(6)])
    state = env.reset()
    bare = zoo.parallel_env("PointNav", **SETTINGS)
    observations, _ = bare.restore(own.snapshot())
    names = bare.possible_agents
    for step, row in enumerate(plan):
        for k, name in enumerate(names):
            if name in bare.agents:
                seen = state["agent", "observation", "gps"][k].numpy()
                assert np.array_equal(seen, observations[name]["gps"])
        live = [*bare.agents]
        observations, rewards, ended, *_ = bare.step(
            {name: int(row[k]) for k, name in enumerate(names) if name in live}
        )
        state["agent", "action"] = torch.as_tensor(row)
        state = env.step(state)["next"]
        for k, name in enumerate(names):
            if name in live:
                assert float(state["agent", "reward"][k, 0]) == np.float32(rewards[name])
                assert bool(state["agent", "done"][k, 0]) == ended[name]
        assert bool(state["agent", "mask"][1]) is (step < 2)
    assert env.rollout(5).batch_size == torch.Size([5])


def test_torchrl_steps_agents_that_take_turns() -> None:
    pytest.importorskip("torchrl", reason="needs TorchRL (pip install torchrl)")
    from torchrl.envs.libs.pettingzoo import PettingZooWrapper

    own = zoo.TorchRLCompatible(zoo.parallel_env("PointNav", **SETTINGS))
    env = PettingZooWrapper(parallel_to_aec(own), use_mask=True, seed=1)
    assert env.rollout(6).batch_size[0] <= 6


def test_agents_of_environments_that_step_together_are_rows() -> None:
    """Needs no library: what SuperSuit's own form of each environment would give."""
    moves = ["move_forward", "turn_left", "turn_right", "wait"]
    settings = {**SETTINGS, "actions": moves, "max_cycles": 3}
    rows = zoo.SuperSuitCompatible(zoo.vector_env(2, "PointNav", **settings))
    assert rows.num_envs == 6
    alone = [zoo.parallel_env("PointNav", **settings) for _ in range(2)]
    names = alone[0].possible_agents
    seen, infos = rows.reset(seed=5)
    theirs = [env.reset(seed=5 + k) for k, env in enumerate(alone)]
    plan = np.random.default_rng(1).integers(0, len(moves), (4, 6))
    for step in range(5):
        for k, (observations, told) in enumerate(theirs):
            for j, name in enumerate(names):
                row = 3 * k + j
                assert np.array_equal(seen["gps"][row], observations[name]["gps"])
                assert infos[row]["episode_id"] == told[name]["episode_id"]
        if step == 4:
            break
        seen, rewards, terminated, truncated, infos = rows.step(plan[step])
        for k, env in enumerate(alone):
            actions = {name: int(plan[step][3 * k + j]) for j, name in enumerate(names)}
            observations, paid, ended, cut, told = env.step(actions)
            theirs[k] = (observations, told)
            part = slice(3 * k, 3 * k + 3)
            assert np.array_equal(rewards[part], np.float32([*paid.values()]))
            assert terminated[part].tolist() == [*ended.values()]
            assert truncated[part].tolist() == [*cut.values()] == [step == 2] * 3
            if step == 2:
                last = [infos[row]["terminal_observation"]["gps"] for row in range(6)[part]]
                assert np.array_equal(last, [observations[name]["gps"] for name in names])
                theirs[k] = env.reset()
            else:
                assert "terminal_observation" not in infos[3 * k]
    rows.close()


def test_rows_of_one_policy_want_agents_alike() -> None:
    agents: dict[str, Any] = {"a": {}, "b": {"sensors": ["gps"]}}
    with pytest.raises(dwell.ConfigError, match="the observation space of b is another"):
        zoo.SuperSuitCompatible(zoo.vector_env(1, **{**SETTINGS, "agents": agents}))
    with pytest.raises(dwell.ConfigError, match=r"expected one of dwell\.pettingzoo\.vector_env"):
        zoo.SuperSuitCompatible(zoo.parallel_env(**SETTINGS))
    rows = zoo.SuperSuitCompatible(zoo.vector_env(1, "PointNav", **SETTINGS))
    rows.reset(seed=1)
    with pytest.raises(dwell.UsageError, match="leave stop out of actions"):
        rows.step(np.array([1, 0, 1]))


def test_stable_baselines_learns_from_environments_that_step_together() -> None:
    reason = "needs SuperSuit and Stable-Baselines3 (pip install supersuit stable-baselines3)"
    wrapper = pytest.importorskip("supersuit.vector.sb3_vector_wrapper", reason=reason)
    sb3 = pytest.importorskip("stable_baselines3", reason=reason)
    moves = ["move_forward", "turn_left", "turn_right", "wait"]
    own = zoo.vector_env(2, "PointNav", actions=moves, **SETTINGS)
    many = wrapper.SB3VecEnvWrapper(zoo.SuperSuitCompatible(own))
    model = sb3.PPO("MultiInputPolicy", many, n_steps=16, batch_size=24, device="cpu")
    before = [row.detach().clone() for row in model.policy.parameters()]
    model.learn(96)
    assert model.num_timesteps == 96
    after = [*model.policy.parameters()]
    assert any(not bool((a == b).all()) for a, b in zip(before, after, strict=True))


def test_stable_baselines_learns_through_supersuit() -> None:
    """One policy for all agents: what they do changes its weights, and rewards are theirs."""
    reason = "needs SuperSuit and Stable-Baselines3 (pip install supersuit stable-baselines3)"
    supersuit = pytest.importorskip("supersuit", reason=reason)
    sb3 = pytest.importorskip("stable_baselines3", reason=reason)
    moves = ["move_forward", "turn_left", "turn_right", "wait"]
    own = zoo.parallel_env("PointNav", actions=moves, **SETTINGS)
    many = supersuit.concat_vec_envs_v1(
        supersuit.pettingzoo_env_to_vec_env_v1(own), 1, num_cpus=0, base_class="stable_baselines3"
    )
    assert many.num_envs == 3
    model = sb3.PPO("MultiInputPolicy", many, n_steps=16, batch_size=24, device="cpu")
    before = [row.detach().clone() for row in model.policy.parameters()]
    model.learn(48)
    after = [*model.policy.parameters()]
    assert any(not bool((a == b).all()) for a, b in zip(before, after, strict=True))
    assert model.num_timesteps == 48
