"""Rewards of one's own, for any task."""

from __future__ import annotations

import abc
from typing import TYPE_CHECKING

from dwell.plugin_parts import PluginPart

if TYPE_CHECKING:
    from dwell.tasks import StepResult
    from dwell.world import World


class Reward(PluginPart, abc.ABC):
    """A reward in Python: ``DwellEnv(reward=MyReward)`` gives it in place of the task's own.

    Examples:
        >>> import dwell
        >>> from dwell.envs import DwellEnv
        >>> class Gently(dwell.Reward):
        ...     def reward(self, world, action, verdict):
        ...         return verdict.reward - 0.1 * world.agents()[0]["collided"]
        >>> env = DwellEnv(sensors=["gps"], reward=Gently)
        >>> observation, info = env.reset(seed=1)
        >>> observation, reward, *_ = env.step(1)
    """

    def reset(self, world: World) -> None:
        """Begins an episode, after the task has."""

    @abc.abstractmethod
    def reward(self, world: World, action: str, verdict: StepResult) -> float:
        """The reward of the step that has just been made.

        Args:
            world: The world after the step.
            action: The action's name.
            verdict: How the task judged the step, with its own reward.
        """
