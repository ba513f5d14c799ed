"""Environments of several agents as TorchRL takes them."""

from __future__ import annotations

from typing import Any

from pettingzoo import ParallelEnv
from pettingzoo.utils import BaseParallelWrapper

from dwell import ConfigError
from dwell.arguments import quoted

ByAgent = dict[str, dict[str, Any]]


class TorchRLCompatible(BaseParallelWrapper):  # type: ignore[misc] # untyped
    """Leaves of each info its ``action_mask``, and lets actions of those whose episodes ended be.

    TorchRL's ``PettingZooWrapper`` makes tensors of all that infos hold, and takes it for granted
    that ``reset`` and ``step`` give the same keys; names of houses and goals are text. It also
    gives actions of agents whose episodes have ended; nobody looks at them.
    """

    def __init__(self, env: object) -> None:
        """Wraps an environment in which all agents act at once.

        Raises:
            ConfigError: It is none.
        """
        if not isinstance(env, ParallelEnv):
            raise ConfigError(
                f"env is {quoted(env)}; expected one of dwell.pettingzoo.parallel_env"
            )
        super().__init__(env)

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ByAgent, ByAgent]:
        """As the environment's, with fewer infos."""
        observations, infos = self.env.reset(seed=seed, options=options)
        return observations, _plain(infos)

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[ByAgent, dict[str, float], dict[str, bool], dict[str, bool], ByAgent]:
        """As the environment's, with fewer infos, by the actions of those who act."""
        ended = {*self.env.possible_agents} - {*self.env.agents}
        actions = {name: action for name, action in actions.items() if name not in ended}
        observations, rewards, terminations, truncations, infos = self.env.step(actions)
        return observations, rewards, terminations, truncations, _plain(infos)


def _plain(infos: ByAgent) -> ByAgent:
    return {
        name: {key: value for key, value in info.items() if key == "action_mask"}
        for name, info in infos.items()
    }
