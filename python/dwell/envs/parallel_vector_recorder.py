"""Recording of episodes of several agents in environments that step together."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import file_path, quoted
from dwell.envs.action_modes import EngineActions
from dwell.envs.parallel_recorder import EpisodeOfAgents
from dwell.envs.parallel_vector import DwellParallelVectorEnv
from dwell.envs.recorder import refuse_cut_short, refuse_what_files_cannot_name
from dwell.files import make_folder

ByAgent = dict[str, dict[str, Any]]


class ParallelVectorReplayRecorder:
    """Writes every episode of every environment of a :class:`DwellParallelVectorEnv` into a folder.

    Each is a file of its own, ``episode_0000.replay`` and so on, in the order in which they end,
    as of :class:`dwell.pettingzoo.ParallelReplayRecorder`. A file is written when the episodes of
    all agents of its environment have ended, when the next ones begin there, or at ``close``.
    Attributes that the recorder lacks are those of the environments.

    Examples:
        >>> import tempfile
        >>> import numpy as np
        >>> import dwell
        >>> from dwell.pettingzoo import ParallelVectorReplayRecorder, vector_env
        >>> folder = tempfile.mkdtemp()
        >>> envs = vector_env(2, agents=2, houses="builtin:studio", sensors=["gps"])
        >>> envs = ParallelVectorReplayRecorder(envs, folder)
        >>> observations, infos = envs.reset(seed=1)
        >>> actions = {"agent_0": np.array([1, 2]), "agent_1": np.array([0, 1])}
        >>> observations, *_ = envs.step(actions)
        >>> envs.close()
        >>> replay = dwell.Replay.read(f"{folder}/episode_0000.replay")
        >>> replay.actions, [agent.ended for agent in replay.agents]
        (({'agent_0': 'move_forward', 'agent_1': 'stop'},), [None, 1])
    """

    def __init__(self, env: object, folder: str | os.PathLike[str]) -> None:
        """Records environments of dwell that step together.

        Raises:
            ConfigError: They are none of dwell with several agents, or their houses or heads cannot
                be named in a file.
            OSError: The folder is none, or cannot be made.
        """
        if not isinstance(env, DwellParallelVectorEnv):
            raise ConfigError(f"env is {quoted(env)}; expected one of dwell.pettingzoo.vector_env")
        #: The environments.
        self.env = env
        refuse_what_files_cannot_name(env)
        self._folder = Path(file_path("folder", folder)).absolute()
        make_folder(self._folder)
        self._running: dict[int, EpisodeOfAgents] = {}
        env._recorders.append(self)

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - of the environments
        """What the recorder lacks."""
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.env, name)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[ByAgent, ByAgent]:
        """As of the environments; the episodes before are written."""
        return self.env.reset(seed=seed, options=options)

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        ByAgent,
        dict[str, NDArray[np.float64]],
        dict[str, NDArray[np.bool_]],
        dict[str, NDArray[np.bool_]],
        ByAgent,
    ]:
        """As of the environments; episodes that end are written.

        Raises:
            UsageError: Something else changed a world since the last step, such as a restored
                snapshot; no file can hold that. Or an episode is longer than any file holds. The
                steps before are written; further ones go on, and are not recorded in this
                environment until its next episode.
            OSError: An episode ended and cannot be written; it is kept.
        """
        return self.env.step(actions)

    def began(self, envs: Sequence[int]) -> None:
        """Episodes have begun in these environments; those before are written."""
        for k in envs:
            self._write(k)
            self._running[k] = EpisodeOfAgents(self.env, k, *self.env._ids(k))

    def check(self) -> None:
        """A step is about to be made; see :meth:`step` for what is refused."""
        batch = self.env._runner.batch
        for k, running in [*self._running.items()]:
            refuse_cut_short(self._running, k, running, batch.state_hash(k), self._folder)

    def stepped(
        self, actions: Sequence[EngineActions], answer: Mapping[str, Any], over: NDArray[np.bool_]
    ) -> None:
        """A step was made; episodes of which all have ended are written."""
        count = len(actions)
        for k, running in [*self._running.items()]:
            acted = {place: own.row(k) for place, own in enumerate(actions) if own.numbers[k] >= 0}
            if not acted:
                # An episode has just begun instead.
                continue
            success, terminated = (
                np.asarray(answer[name]).reshape(-1, count)[k] for name in ("success", "terminated")
            )
            state_hash = self.env._runner.batch.state_hash(k)
            running.stepped(acted, state_hash, (success, terminated))
            if over[k]:
                self._write(k)

    def close(self) -> None:
        """Writes the episodes that run, and closes the environments."""
        for k in [*self._running]:
            self._write(k)
        self.env.close()

    def _write(self, env: int) -> None:
        if env in self._running:
            self._running[env].write(self._folder)
            del self._running[env]
