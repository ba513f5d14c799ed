"""What is so in a running environment: its world, graph, relations, texts and answers."""

from __future__ import annotations

import abc
import inspect
from typing import TYPE_CHECKING, Any, cast

import gymnasium

from dwell.arguments import refuse_unknown
from dwell.envs.config import sharing_open_houses
from dwell.grounded_text import Text
from dwell.language_api import LanguageApi
from dwell.relation_api import Thing, Viewer

if TYPE_CHECKING:
    from typing_extensions import Self

    from dwell.world import World


#: What :meth:`dwell.World.describe` takes beside the level.
_DESCRIBE = [*inspect.signature(LanguageApi.describe).parameters][2:]


class CurrentStateApi(abc.ABC):
    """Methods about the state as it is now; of an environment with :meth:`world` and snapshots."""

    #: The number of the agent that acts.
    _agent: int

    @property
    @abc.abstractmethod
    def world(self) -> World:
        """The world in which the episode is played; it goes on with the environment's steps."""

    def scene_graph(self, *, viewer: Viewer | None = None) -> dict[str, Any]:
        """The rooms, things and relations now; see :meth:`dwell.World.scene_graph`."""
        return self.world.scene_graph(viewer=viewer)

    def holds(self, name: str, *things: Thing, viewer: Viewer | None = None) -> bool | None:
        """Returns whether a relation holds now; see :meth:`dwell.World.holds`."""
        return self.world.holds(name, *things, viewer=viewer)

    def ask(self, sentence: str, *, viewer: Viewer | None = None) -> dict[str, Any]:
        """Answers a question, or checks a claim, about the state now.

        Args:
            sentence: As :meth:`dwell.World.check` takes it; "you" is the agent that acts.
            viewer: From where left and right are meant; without it the agent's eyes.

        Returns:
            What :meth:`dwell.World.check` gives.

        Examples:
            >>> from dwell.envs import DwellEnv
            >>> env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
            >>> observation, info = env.reset(seed=1)
            >>> env.ask("Is there a bed?")["answer"]["truth"]
            True
        """
        return self.world.check(sentence, viewer=viewer, agent=self._agent)

    def describe(self, level: str = "house", **options: Any) -> list[Text] | list[str]:  # noqa: ANN401 - of the world
        """Sentences about the house as it is now; see :meth:`dwell.World.describe`.

        Args:
            level: What is described.
            **options: As of :meth:`dwell.World.describe`.

        Raises:
            ConfigError: As there; or there is no such option.
        """
        refuse_unknown("describe", [name for name in options if name not in _DESCRIBE], _DESCRIBE)
        return self.world.describe(level, **options)

    def fork(self) -> Self:
        """Another environment at the same moment of the same episode, which goes on by itself.

        The episodes that follow are the same, too. Each has a world of its own in memory.

        Examples:
            >>> from dwell.envs import DwellEnv
            >>> env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
            >>> observation, info = env.reset(seed=1)
            >>> other = env.fork()
            >>> _ = env.step(1), other.step(1)
            >>> env.state_hash() == other.state_hash()
            True
        """
        made: Self = forked(self)
        return made


def forked(env: Any) -> Any:  # noqa: ANN401 - of the environment's own class
    """A new environment of the same arguments, at the moment of ``env``, in its open houses."""
    snapshot = env.snapshot()
    kwargs = cast("dict[str, Any]", env._ezpickle_kwargs)
    with sharing_open_houses(env._shelf):
        other = type(env)(*env._ezpickle_args, **kwargs)
        other.restore(snapshot)
    if isinstance(env, gymnasium.Env):
        other.spec = env.spec
    return other
