"""Recording of episodes of several agents while they are played."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from pettingzoo.utils import BaseParallelWrapper

from dwell import ConfigError, UsageError, __version__
from dwell.arguments import file_path
from dwell.envs.agent_forms import AgentForms
from dwell.envs.agent_settings import AgentRoster
from dwell.envs.native_batch import NativeBatch
from dwell.envs.parallel import DwellParallelEnv
from dwell.envs.recorder import cut_short, refuse_what_files_cannot_name, write_numbered
from dwell.files import make_folder
from dwell.replay_agents import ReplayAgent
from dwell.replays import MAX_STEPS, Replay
from dwell.stated_episodes import seed_of

ByAgent = dict[str, dict[str, Any]]
#: What a step gives.
Step = tuple[ByAgent, dict[str, float], dict[str, bool], dict[str, bool], ByAgent]


class ParallelReplayRecorder(BaseParallelWrapper):  # type: ignore[misc] # untyped
    """Writes every episode of an environment of several agents into a folder.

    The files are ``episode_0000.replay`` and so on, with the actions of all agents, what they said,
    and when each one's episode ended; :class:`dwell.Replay` reads them. A file is written when the
    last agent's episode ends, when the next ones begin, or at ``close``, as
    :class:`dwell.envs.ReplayRecorder` does.

    Examples:
        >>> import tempfile
        >>> import dwell
        >>> from dwell.pettingzoo import ParallelReplayRecorder, parallel_env
        >>> folder = tempfile.mkdtemp()
        >>> env = parallel_env(agents=2, houses="builtin:studio", sensors=["gps"])
        >>> env = ParallelReplayRecorder(env, folder)
        >>> observations, infos = env.reset(seed=1)
        >>> observations, *_ = env.step({"agent_0": 1, "agent_1": 0})
        >>> env.close()
        >>> replay = dwell.Replay.read(f"{folder}/episode_0000.replay")
        >>> replay.actions, [agent.ended for agent in replay.agents]
        (({'agent_0': 'move_forward', 'agent_1': 'stop'},), [None, 1])
        >>> replay.first_difference()
    """

    def __init__(self, env: object, folder: str | os.PathLike[str]) -> None:
        """Wraps an environment of dwell, whatever other wrappers are around it.

        Raises:
            ConfigError: It is none of dwell, or its house or head cannot be named in a file.
            OSError: The folder is none, or cannot be made.
        """
        own = getattr(env, "unwrapped", env)
        if not isinstance(own, DwellParallelEnv):
            raise ConfigError(f"env is {env!r}; expected an environment of dwell.pettingzoo")
        super().__init__(env)
        self._env = own
        refuse_what_files_cannot_name(own)
        self._folder = Path(file_path("folder", folder)).absolute()
        make_folder(self._folder)
        self._running: EpisodeOfAgents | None = None
        #: Why no further step of the episode is recorded.
        self._cut_short: str | None = None

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ByAgent, ByAgent]:
        """Begins an episode; the one before is written."""
        self._write()
        observations, infos = self.env.reset(seed=seed, options=options)
        about = next(iter(infos.values()))
        self._cut_short = None
        ids = (str(about["scene_id"]), str(about["episode_id"]))
        self._running = EpisodeOfAgents(self._env, 0, *ids)
        return observations, infos

    def step(self, actions: dict[str, Any]) -> Step:
        """Makes a step.

        Raises:
            UsageError: Something else changed the world since the last step, such as a restored
                snapshot; no file can hold that. Or the episode is longer than any file holds. The
                steps before are written; until ``reset`` all further ones are refused.
            OSError: The episode ended and cannot be written; it is kept.
        """
        running, live = self._running, [*self._env.agents]
        if running is not None and live:
            self._cut_short = cut_short(running, self._env.state_hash(), self._folder)
        if self._cut_short is not None:
            self._running = None
            raise UsageError(self._cut_short)
        answer: Step = self.env.step(actions)
        if running is not None and live:
            taken = self._env._forms.one(actions, live)
            acted = {k: own.row(0) for k, own in enumerate(taken) if own.numbers[0] >= 0}
            running.stepped(acted, self._env.state_hash(), self._env._ruling)
            if not self._env.agents:
                self._write()
        return answer

    def close(self) -> None:
        """Writes the episode that runs, and closes the environment."""
        self._write()
        super().close()

    def _write(self) -> None:
        if self._running is not None:
            self._running.write(self._folder)
        self._running = None


class InNamedRoles(Protocol):
    """Environments whose agents have names, teams and forms of actions."""

    _config: str
    _forms: AgentForms
    _roster: AgentRoster

    @property
    def _runner(self) -> NativeBatch: ...


class EpisodeOfAgents:
    """An episode of several agents that is being recorded."""

    acts = "actions"

    def __init__(self, env: InNamedRoles, number: int, scene: str, episode_id: str) -> None:
        """An episode has begun.

        Args:
            env: Where.
            number: In which of its environments.
            scene: The HOUSE string.
            episode_id: As of infos.
        """
        roster, batch = env._roster, env._runner.batch
        self._agents = [
            ReplayAgent(name, team, batch.instruction(number, k), success=False, ended=None)
            for k, (name, team) in enumerate(zip(roster.names, roster.team_names, strict=True))
        ]
        self._replay = Replay(
            house=scene,
            seed=seed_of(episode_id),
            config=env._config,
            parts=(),
            actions=(),
            hashes=(),
            instruction=self._agents[0].instruction,
            success=False,
            made_by=__version__,
            shared_reward=env._forms.share,
        )
        self._actions: list[dict[str, Any]] = []
        self._hashes = [f"{batch.state_hash(number):016x}"]

    def stepped(
        self,
        actions: Mapping[int, str | dict[str, Any]],
        state_hash: int,
        ruling: tuple[NDArray[np.bool_], NDArray[np.bool_]],
    ) -> None:
        """A step was made.

        Args:
            actions: Of those who acted, by place, as files hold them.
            state_hash: After it.
            ruling: Whose success and whose end it was, by place.
        """
        success, terminated = ruling
        self._actions.append({self._agents[k].name: row for k, row in actions.items()})
        self._hashes.append(f"{state_hash:016x}")
        for k, agent in enumerate(self._agents):
            if agent.ended is None:
                self._agents[k] = dataclasses.replace(
                    agent,
                    success=bool(success[k]),
                    ended=len(self._actions) if terminated[k] else None,
                )

    def write(self, folder: Path) -> Path | None:
        """Writes the steps so far, if there are any."""
        if not self._actions:
            return None
        replay = dataclasses.replace(
            self._replay,
            actions=tuple(self._actions),
            hashes=tuple(self._hashes),
            success=self._agents[0].success,
            agents=tuple(self._agents),
        )
        return write_numbered(replay, folder)

    @property
    def last_hash(self) -> str:
        """Of the world after the last step, as files hold it."""
        return self._hashes[-1]

    @property
    def is_full(self) -> bool:
        """True if no file holds a further step."""
        return len(self._actions) == MAX_STEPS
