"""Sensors of one's own, beside those of the engine."""

from __future__ import annotations

import abc
from typing import TYPE_CHECKING, Any

from dwell.plugin_parts import PluginPart

if TYPE_CHECKING:
    import gymnasium
    import numpy as np

    from dwell.world import World


class Sensor(PluginPart, abc.ABC):
    """A sensor in Python: ``DwellEnv(sensors=["rgb", MySensor])`` observes with it.

    Attributes:
        name: Its key in observations.
        space: What it observes: a ``Box``, ``Discrete``, ``MultiDiscrete``, ``MultiBinary`` or
            ``Text`` of gymnasium.

    Examples:
        >>> import dwell
        >>> import gymnasium
        >>> import numpy as np
        >>> from dwell.envs import DwellEnv
        >>> class Height(dwell.Sensor):
        ...     name = "height"
        ...     space = gymnasium.spaces.Box(-100.0, 100.0, (1,), np.float32)
        ...     def observe(self, world, rng):
        ...         return np.float32([world.agents()[0]["position"][1]])
        >>> env = DwellEnv(sensors=["gps", Height])
        >>> observation, info = env.reset(seed=1)
        >>> observation["height"].shape
        (1,)
    """

    name: str
    space: gymnasium.Space[Any]

    def reset(self, world: World) -> None:
        """Begins an episode, after the task has."""

    @abc.abstractmethod
    def observe(self, world: World, rng: np.random.Generator) -> Any:  # noqa: ANN401 - of its space
        """The observation now: an element of :attr:`space`.

        Args:
            world: The environment's world.
            rng: The source of everything random, such as noise; it comes from the episode's seed
                and the step, so that it is the same after a restored snapshot.
        """
