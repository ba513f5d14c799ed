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
