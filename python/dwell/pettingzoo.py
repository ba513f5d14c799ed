"""Several agents in one house, as PettingZoo has it: ``parallel_env``, ``env`` and ``vector_env``.

Needs the package ``pettingzoo`` (``pip install "dwell[pettingzoo]"``).

Examples:
    >>> from dwell.pettingzoo import parallel_env
    >>> env = parallel_env("PointNav", agents=2, houses="builtin:studio", sensors=["gps"])
    >>> observations, infos = env.reset(seed=1)
    >>> while env.agents:
    ...     observations, rewards, ended, cut, infos = env.step(env.expert_actions())
    >>> [infos[name]["success"] for name in infos]
    [True]
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dwell import ConfigError, UsageError
from dwell.arguments import choice, quoted

try:
    from pettingzoo.utils import BaseWrapper, OrderEnforcingWrapper, parallel_to_aec
except ImportError as error:
    raise ConfigError(
        "dwell.pettingzoo needs the package pettingzoo; install it with "
        'pip install "dwell[pettingzoo]"'
    ) from error

from dwell.envs.parallel import DwellParallelEnv
from dwell.envs.parallel_recorder import ParallelReplayRecorder
from dwell.envs.parallel_vector import DwellParallelVectorEnv
from dwell.envs.parallel_vector_recorder import ParallelVectorReplayRecorder
from dwell.envs.supersuit_compatible import SuperSuitCompatible
from dwell.envs.torchrl_compatible import TorchRLCompatible

if TYPE_CHECKING:
    from pettingzoo import AECEnv

__all__ = [
    "DwellParallelEnv",
    "DwellParallelVectorEnv",
    "ParallelReplayRecorder",
    "ParallelVectorReplayRecorder",
    "SuperSuitCompatible",
    "TorchRLCompatible",
    "env",
    "parallel_env",
    "vector_env",
]


def parallel_env(task: str = "Free", **settings: Any) -> DwellParallelEnv:  # noqa: ANN401 - of the class
    """An environment in which all agents act at once.

    Args:
        task: The task of agents that state no other, by its name.
        **settings: As of :class:`DwellParallelEnv`.
    """
    return DwellParallelEnv(task, **settings)


def env(task: str = "Free", **settings: Any) -> AECEnv[str, Any, Any]:  # noqa: ANN401 - of the class
    """The same with agents that take turns (PettingZoo's AEC API): a step is made after the last.

    Args:
        task: As of :func:`parallel_env`.
        **settings: As of :class:`DwellParallelEnv`.
    """
    return OrderEnforcingWrapper(_Turns(parallel_to_aec(parallel_env(task, **settings))))


class _Turns(BaseWrapper[str, Any, Any]):  # type: ignore[misc] # untyped
    """Says whose turn has no action; PettingZoo itself says nothing."""

    def step(self, action: Any) -> None:  # noqa: ANN401 - of the agent's space
        """Takes one agent's turn.

        Raises:
            UsageError: Its episode has ended, and the action is not ``None``.
            ConfigError: The action is none of the agent's; it is still its turn.
        """
        agent = self.agent_selection
        has_ended = self.terminations[agent] or self.truncations[agent]
        if action is not None and has_ended:
            raise UsageError(
                f"step: the episode of {agent} has ended; its action is {quoted(action, 80)}, "
                "expected None"
            )
        if not has_ended:
            self.unwrapped.check_action(agent, action)
        super().step(action)

    def observe(self, agent: str) -> Any:  # noqa: ANN401 - of the agent's space
        """What an agent observes.

        Raises:
            ConfigError: There is no such agent.
        """
        return super().observe(choice("agent", agent, tuple(self.possible_agents)))

    def __str__(self) -> str:
        return str(self.env)


def vector_env(
    num_envs: int,
    task: str = "Free",
    **settings: Any,  # noqa: ANN401 - of the class
) -> DwellParallelVectorEnv:
    """Several environments, stepped together by the engine.

    Args:
        num_envs: How many.
        task: The task of agents that state no other, by its name.
        **settings: As of :class:`DwellParallelVectorEnv`.
    """
    return DwellParallelVectorEnv(num_envs, task, **settings)
