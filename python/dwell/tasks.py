"""Tasks of one's own: what an episode asks for, and how it is judged."""

from __future__ import annotations

import dataclasses
import types
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from dwell.plugin_parts import PluginPart

if TYPE_CHECKING:
    import gymnasium
    import numpy as np

    from dwell.world import World


@dataclasses.dataclass(frozen=True)
class TaskGoal:
    """The goal of an episode, as an instruction.

    Attributes:
        instruction: What the sensor ``instruction`` gives: 1 to 120 letters of English, spaces, and
            the marks ``. , ' -``. The sensor ``instruction_tokens`` knows the words of
            ``assets/vocabulary.txt`` only.
        distance_m: The way to the goal, m; ``None`` where there is no place to go to. From it come
            ``distance_to_goal``, ``spl`` and ``soft_spl`` of ``info``, which has none of them
            without.
    """

    instruction: str = "Explore."
    distance_m: float | None = None


@dataclasses.dataclass(frozen=True)
class StepResult:
    """The verdict on a step.

    Attributes:
        reward: The step's reward.
        terminated: Whether the task has come to its end, well or badly.
        success: Whether what was asked is done.
        distance_m: The way to the goal that is left, m; ``None``: as after the step before.
        info: What else goes into ``info``: numbers, flags, text.
    """

    reward: float = 0.0
    terminated: bool = False
    success: bool = False
    distance_m: float | None = None
    info: Mapping[str, Any] = dataclasses.field(default_factory=dict)


class Task(PluginPart):
    """A task in Python: a subclass says how an episode starts and how each step is judged.

    ``DwellEnv(task=MyTask)`` plays it; ``task_settings`` are the arguments of ``MyTask()``. It is
    played upon a task of the engine, which puts the agent to a start and judges first.

    Attributes:
        base: The task of the engine: ``Free`` (the agent stands anywhere, nothing is asked,
            ``stop`` ends the episode), or another whose episodes are judged differently here.
        base_settings: Its settings.
        sensors: The sensors of its environment when nobody says otherwise, as ``sensors`` of
            :class:`dwell.envs.DwellEnv`; ``None``: those of ``base``.
        max_steps: Steps after which an episode is cut off by ``gymnasium.make``, if the task is
            registered by :func:`dwell.register_task`.
        spaces: What the task itself observes, by name, beside the sensors: spaces as those of
            :class:`dwell.Sensor`. They are part of the environment's observations whichever
            sensors it has. Where they follow from the task's settings, ``__init__`` sets them.

    Examples:
        >>> import dwell
        >>> from dwell.envs import DwellEnv
        >>> class GoUp(dwell.Task):
        ...     sensors = ["gps"]
        ...     def judge(self, world, action, verdict):
        ...         return dwell.StepResult(reward=float(world.agents()[0]["position"][1]))
        >>> env = DwellEnv(task=GoUp)
        >>> observation, info = env.reset(seed=1)
        >>> observation, reward, terminated, truncated, info = env.step(1)
        >>> terminated
        False
    """

    base: ClassVar[str] = "Free"
    base_settings: ClassVar[Mapping[str, Any] | None] = None
    sensors: ClassVar[Sequence[Any] | Mapping[str, Any] | None] = None
    max_steps: ClassVar[int] = 1000
    spaces: Mapping[str, gymnasium.Space[Any]] = types.MappingProxyType({})

    def reset(self, world: World, rng: np.random.Generator) -> TaskGoal | None:
        """Arranges a new episode: ``base`` has put the agent to a start.

        Args:
            world: The environment's world, to look at and to change; it is at its start.
            rng: The source of everything random here; it comes from the episode's seed.

        Returns:
            What is asked; ``None``: as ``base`` asks.
        """
        del world, rng
        return None

    def judge(self, world: World, action: str, verdict: StepResult) -> StepResult:
        """Judges the step that has just been made.

        Args:
            world: The world after the step.
            action: The action's name, one of :func:`dwell.world.actions`.
            verdict: How ``base`` judges the step.

        Returns:
            How it is judged.
        """
        del world, action
        return verdict

    def observe(self, world: World, rng: np.random.Generator) -> Mapping[str, Any]:
        """The task's observations now: an element of each of :attr:`spaces`, by name.

        Args:
            world: The environment's world.
            rng: The source of everything random, such as noise; it comes from the episode's seed
                and the step, so that it is the same after a restored snapshot.
        """
        del world, rng
        return {}

    def expert(self, world: World) -> str | None:
        """The name of the action that somebody who knows the house would take now.

        Returns:
            ``None``: what the expert of ``base`` takes. ``Free`` has no expert.
        """
        del world
        return None
