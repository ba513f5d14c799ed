"""Several environments with several agents each, stepped together by the engine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any, NoReturn

import numpy as np
from gymnasium import spaces
from gymnasium.utils import EzPickle
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, _native
from dwell.arguments import boolean, integer_in_range, kept, quoted, refuse_unknown
from dwell.envs.action_modes import EngineActions
from dwell.envs.agent_forms import AgentForms
from dwell.envs.agent_settings import OF_TASKS, Agents, MultiAgentSetup
from dwell.envs.agent_snapshots import agent_parts, parts_of_agents
from dwell.envs.agent_state import agent_state_rows, state_space
from dwell.envs.config import CACHED_HOUSES, Houses, arguments_of, kept_houses
from dwell.envs.current_state import forked
from dwell.envs.env_pool import EnvPool
from dwell.envs.episode_shelf import shelf_of
from dwell.envs.house_assignment import HouseAssignment
from dwell.envs.info_keys import INFO_KEYS, step_infos
from dwell.envs.native_batch import NativeBatch
from dwell.envs.python_tasks import NativeSensors
from dwell.envs.saved_world import SavedWorld
from dwell.envs.snapshots import EnvSnapshot
from dwell.envs.step_recorder import AgentRecorder
from dwell.envs.vector_calls import VectorCalls
from dwell.envs.vector_reset import VectorReset
from dwell.world import World
from dwell.world_settings import Laws, Randomize

#: Arrays by name, by the agents' names.
ByAgent = dict[str, dict[str, Any]]


class DwellParallelVectorEnv(VectorCalls, EzPickle):
    """Houses in which several agents act, as :class:`dwell.pettingzoo.DwellParallelEnv`.

    Everything comes by the agents' names, with the environments as the first axis; the episodes are
    those of a single environment with the same seed, bit for bit. The episodes of an environment
    are over when those of all its agents are, or when they are truncated; the step after that
    begins the next ones, and plays no action there (``NextStep``, as of Gymnasium). Of an agent
    whose episode has ended before the others' no action is looked at, and its reward is 0.
    """

    def __init__(
        self,
        num_envs: int,
        task: str = "Free",
        *,
        agents: Agents = 2,
        houses: Houses | None = None,
        sensors: NativeSensors = None,
        laws: Laws = None,
        parameters: Mapping[str, float] | None = None,
        randomize: Randomize = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        action_mode: str = "discrete",
        actions: Sequence[str] | None = None,
        action_mask: bool = False,
        world: Mapping[str, Any] | None = None,
        voice: bool | Mapping[str, Any] = False,
        muted: bool = False,
        shared_reward: float = 0.0,
        threads: int | None = None,
        max_cycles: int | str | None = OF_TASKS,
        overlap: bool = False,
        copy: bool = False,
        load_ahead: int = CACHED_HOUSES,
        **unknown: NoReturn,
    ) -> None:
        """Makes the environments.

        Args:
            num_envs: How many.
            task: The task of agents that state no other, by its name.
            agents: Who acts in each, as of :class:`dwell.pettingzoo.DwellParallelEnv`.
            houses: A HOUSES string or a :class:`dwell.House`, or several.
            sensors: Names of sensors, or settings by name.
            laws: Laws to install, or what calibration found.
            parameters: Values by address.
            randomize: Intervals from which each episode draws, or what calibration found.
            task_settings: The settings of the task.
            stride: How far movement actions go.
            action_mode: The form of actions.
            actions: Names of the actions to choose from.
            action_mask: Whether infos have masks of actions.
            world: Further fields of the native WorldConfig.
            voice: What agents can say, as of :class:`dwell.pettingzoo.DwellParallelEnv`.
            muted: Whether their voices are silent.
            shared_reward: Which share of a reward is the mean of the agent's team's.
            threads: How many threads to use; results do not depend on it.
            max_cycles: Steps after which all episodes of an environment are truncated.
            overlap: As of :class:`dwell.envs.DwellVectorEnv`.
            copy: Whether observations are copies.
            load_ahead: As of :class:`dwell.envs.DwellVectorEnv`.
            **unknown: There are no others; such are refused with the nearest names.

        Raises:
            ConfigError: A setting is wrong; the message names it.
        """
        refuse_unknown("DwellParallelVectorEnv", unknown, arguments_of(DwellParallelVectorEnv))
        given: dict[str, Any] = {
            "agents": kept(agents),
            "houses": kept_houses(houses),
            "sensors": kept(sensors),
            "laws": kept(laws),
            "parameters": kept(parameters),
            "randomize": kept(randomize),
            "task_settings": kept(task_settings),
            "stride": kept(stride),
            "action_mode": action_mode,
            "actions": kept(actions),
            "action_mask": action_mask,
            "world": kept(world),
            "voice": kept(voice),
            "muted": muted,
            "shared_reward": shared_reward,
            "threads": threads,
            "max_cycles": max_cycles,
            "overlap": overlap,
            "copy": copy,
            "load_ahead": load_ahead,
        }
        EzPickle.__init__(self, num_envs, task, **given)
        self.num_envs = count = integer_in_range("num_envs", num_envs, low=1, high=65_536)
        self._copy, overlap = boolean("copy", copy), boolean("overlap", overlap)
        setup = MultiAgentSetup.of(task, given)
        self._limit, roster = setup.limit, setup.roster
        names = [roster.names[k] for k in roster.players]
        self._players, everybody = roster.players, len(roster.names)
        self._roster, self._config, self._heads = roster, setup.config, setup.heads
        self._shelf = shelf = shelf_of(given["houses"], None)
        threads = None if threads is None else integer_in_range("threads", threads, low=1)
        with setup.built(shelf[0]):
            runner = NativeBatch(
                [shelf[0]] * count, setup.config, threads, overlap=overlap, heads=setup.heads
            )
        pool = EnvPool(shelf, setup.config, setup.heads, threads)
        ahead = integer_in_range("load_ahead", load_ahead)
        self._opened = runner, HouseAssignment(runner, pool, ahead)
        self._forms = AgentForms(
            setup.config, runner, roster, action_mask=action_mask, shared_reward=shared_reward
        )
        self.possible_agents = [*names]
        self.observation_spaces = self._forms.observation_spaces
        self.action_spaces = self._forms.action_spaces
        self.batched_observation_spaces: dict[str, spaces.Space[Any]] = {
            name: batch_space(self.observation_spaces[name], count) for name in names
        }
        self.batched_action_spaces: dict[str, spaces.Space[Any]] = {
            name: batch_space(self.action_spaces[name], count) for name in names
        }
        #: The space of one row of :meth:`state`.
        self.state_space: spaces.Box = state_space(everybody)
        self._streams: list[np.random.Generator | None] = [None] * count
        self._seeds = [0] * count
        #: Whose episodes go on, shape (environment, agent).
        self._active = np.zeros((count, everybody), np.bool_)
        #: Where the next step begins episodes.
        self._over: NDArray[np.bool_] = np.ones(count, np.bool_)
        self._distances = np.full((count, everybody), np.nan)
        self._stopped = np.ones(count, np.bool_)
        #: Who writes down what is played.
        self._recorders: list[AgentRecorder] = []

    def _begun(self, call: str) -> _native.Batch:
        """The engine's environments, in all of which episodes have begun.

        Raises:
            UsageError: They have not, or the environments are closed.
        """
        with self._calling(call):
            if self._stopped.any():
                which = np.flatnonzero(self._stopped).tolist()
                raise UsageError(
                    f"{call}: no episode of environments {which} has begun; reset them"
                )
            return self._runner.batch

    def _start(
        self, which: NDArray[np.bool_], asked: Mapping[int, tuple[int, int]] | None = None
    ) -> None:
        """Begins episodes: those of ``asked`` (house and seed), else drawn ones."""
        episodes: dict[int, tuple[int, int]] = {}
        following: dict[int, tuple[int, int]] = {}
        for k in np.flatnonzero(which).tolist():
            stream = self._streams[k]
            assert stream is not None
            drawn = self._shelf.draw(stream)
            episodes[k] = (asked or {}).get(k, drawn)
            # Of a copy: drawn again when the episodes begin.
            following[k] = self._shelf.draw(deepcopy(stream))
        self._stopped[which] = True
        moved = self._places.move(episodes)
        seeds: list[int | None] = [None] * self.num_envs
        for k, (_, seed) in episodes.items():
            seeds[k] = self._seeds[k] = seed
        self._runner.reset(seeds, moved)
        self._active[which], self._over[which], self._stopped[which] = True, False, False
        self._distances[which] = np.nan
        self._places.look_ahead(following)
        for recorder in self._recorders:
            recorder.began([*episodes])

    def _ids(self, env: int) -> tuple[str, str]:
        """HOUSE string and ``episode_id`` of an environment's episodes."""
        return self._places.name(env), self._places.episode_id(env, self._seeds[env])

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[ByAgent, ByAgent]:
        """Starts episodes in all environments, or in some.

        Args:
            seed: One seed (then environment k has ``seed + k``), or one for each environment.
            options: ``reset_mask`` and ``episode_id``, as of
                :meth:`dwell.envs.DwellVectorEnv.reset`.

        Returns:
            Observations and infos by the agents' names: what a single environment's are, as arrays.
        """
        with self._calling("reset"):
            given = VectorReset.of(seed, options, self.num_envs)
            asked = {k: self._shelf.episode(one) for k, one in given.episode_ids.items()}
            for k in np.flatnonzero(given.which):
                if given.seeds[k] is not None or self._streams[k] is None:
                    self._streams[k] = np.random.default_rng(given.seeds[k])
            self._start(given.which, asked)
            self._runner.observe(given.which)
            return self._observations(), self._infos()

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        ByAgent,
        dict[str, NDArray[np.float64]],
        dict[str, NDArray[np.bool_]],
        dict[str, NDArray[np.bool_]],
        ByAgent,
    ]:
        """Makes one control step in every environment.

        Args:
            actions: By the agents' names elements of ``batched_action_spaces``.

        Returns:
            Observations, rewards, terminations, truncations and infos by the agents' names.
            ``infos[name]["active"]``: whether the agent acted in the step, shape (num_envs,).

        Raises:
            UsageError: An environment's episodes have not begun.
            ConfigError: The actions are none.
        """
        with self._calling("step"):
            if self._stopped.any():
                which = np.flatnonzero(self._stopped).tolist()
                raise UsageError(f"step: no episode of environments {which} has begun; reset them")
            begins = self._over.copy()
            acts = self._active & ~begins[:, np.newaxis]
            taken = self._forms.many(actions, acts)
            if begins.any():
                self._start(begins)
            for recorder in self._recorders:
                recorder.check()
            self._stopped[~begins] = True
            answer, _ = self._runner.step(EngineActions.interleaved(taken))
            self._stopped[~begins] = False
            shape = acts.shape
            rewards = np.where(acts, self._forms.rewards(answer), 0.0)
            terminated = np.asarray(answer["terminated"]).reshape(shape) & acts
            cut = np.zeros(self.num_envs, np.bool_)
            if self._limit is not None:
                cut = (self._runner.batch.steps() >= self._limit) & ~begins
            truncated = acts & cut[:, np.newaxis]
            distances = np.asarray(answer["distance_to_goal"]).reshape(shape)
            self._distances[acts] = distances[acts]
            self._active &= ~(terminated | truncated)
            self._over = np.logical_not(self._active[:, self._players].any(axis=1))
            for recorder in self._recorders:
                recorder.stepped(taken, answer, self._over)
            self._runner.observe(np.ones(self.num_envs, np.bool_))
            infos = self._infos()
            count, by_agent = (
                acts.shape[1],
                [*zip(self._players, self.possible_agents, strict=True)],
            )
            for k, name in by_agent:
                own = {key: value[k::count] for key, value in answer.items()}
                keys = (*INFO_KEYS, *self._forms.measures[k])
                infos[name] |= step_infos(own, keys, acts[:, k])
                infos[name]["active"] = acts[:, k]
                infos[name]["speaks"] = np.asarray(own["speaks"])
            return (
                self._observations(),
                {name: rewards[:, k] for k, name in by_agent},
                {name: terminated[:, k] for k, name in by_agent},
                {name: truncated[:, k] for k, name in by_agent},
                infos,
            )

    def _observations(self) -> ByAgent:
        found = {}
        for k, name in zip(self._players, self.possible_agents, strict=True):
            now = self._runner.agent_observation(k)
            found[name] = (
                {key: v if isinstance(v, tuple) else v.copy() for key, v in now.items()}
                if self._copy
                else now
            )
        return found

    def _infos(self) -> ByAgent:
        scenes, episodes = (np.full(self.num_envs, None, object) for _ in range(2))
        for k, stopped in enumerate(self._stopped.tolist()):
            if not stopped:
                scenes[k], episodes[k] = self._ids(k)
        masks = self._forms.masks(self._runner)
        infos: ByAgent = {}
        for k, name in zip(self._players, self.possible_agents, strict=True):
            mask = masks[k]
            infos[name] = {"scene_id": scenes, "episode_id": episodes}
            if mask is not None:
                infos[name]["action_mask"] = mask
        return infos

    def goals(self, env: int) -> dict[str, dict[str, Any]]:
        """What the episodes of an environment's agents ask for, as a single environment's infos."""
        k = integer_in_range("env", env, high=self.num_envs - 1)
        batch = self._begun("goals")
        rows = zip(self._players, self.possible_agents, strict=True)
        return {name: batch.episode_goal(k, agent) for agent, name in rows}

    def state(self) -> NDArray[np.float32]:
        """The states of all agents, (num_envs, agent x 13); see :meth:`DwellParallelEnv.state`."""
        batch = self._begun("state")
        rows = [
            agent_state_rows(batch.agent_states(k), self._distances[k], self._active[k]).ravel()
            for k in range(self.num_envs)
        ]
        return np.stack(rows)

    def expert_actions(self) -> dict[str, Any]:
        """What the agents' experts would do now, elements of ``batched_action_spaces``."""
        with self._calling("expert_actions"):
            found = self._forms.expert(self._runner)
            return {name: found[name] for name in self.possible_agents}

    def state_hashes(self) -> list[int]:
        """The state hash of every environment."""
        batch = self._begun("state_hashes")
        return [batch.state_hash(k) for k in range(self.num_envs)]

    def world(self, env: int) -> World:
        """The world in which an environment's episodes are played."""
        k = integer_in_range("env", env, high=self.num_envs - 1)
        self._begun("world")
        return self._runner.world(k)

    def snapshot(self) -> list[bytes]:
        """Every environment as bytes: world, episodes, who acts on, and the seeds that follow.

        Raises:
            UsageError: No episode has begun in one of them.
        """
        batch, names = self._begun("snapshot"), self._forms.names
        rows = []
        for k, stream in enumerate(self._streams):
            assert stream is not None
            live = [name for j, name in enumerate(names) if self._active[k, j]]
            saved = EnvSnapshot(
                episode_id=self._places.episode_id(k, self._seeds[k]),
                done=bool(self._over[k]),
                stream=stream,
                parts=agent_parts(names, live, self._distances[k].tolist()),
                world=batch.snapshot(k),
            )
            rows.append(saved.to_vector_bytes())
        return rows

    def restore(self, snapshots: Sequence[bytes | None]) -> tuple[ByAgent, ByAgent]:
        """Restores snapshots in environments; the next steps give the same bits.

        A snapshot may go to another environment, and to several.

        Args:
            snapshots: One for each environment; ``None`` leaves it where it is.

        Returns:
            Observations of that moment, and infos as :meth:`reset` gives.

        Raises:
            ConfigError: They are not one for each, or one is of something else or damaged. Nothing
                has changed then.
        """
        with self._calling("restore"):
            given: object = snapshots
            if not isinstance(given, list | tuple) or len(given) != self.num_envs:
                raise ConfigError(
                    f"snapshots is {quoted(given, 60)}; expected a list of {self.num_envs}: bytes, "
                    "or None, for each environment"
                )
            rows = {
                k: self._saved(f"snapshots[{k}]", snapshot)
                for k, snapshot in enumerate(given)
                if snapshot is not None
            }
            which = np.array([k in rows for k in range(self.num_envs)], np.bool_)
            running = {
                k: SavedWorld(self._places.house(k), self._seeds[k], self._runner.batch.snapshot(k))
                for k in rows
                if not self._stopped[k]
            }
            worlds = {
                k: SavedWorld(house, seed, saved.world)
                for k, (saved, house, seed, *_) in rows.items()
            }
            self._runner.restore_all(worlds, running, self._places.move)
            self._stopped[which] = True
            following: dict[int, tuple[int, int]] = {}
            for k, (saved, _, seed, live, distances) in rows.items():
                self._seeds[k], self._streams[k], self._over[k] = seed, saved.stream, saved.done
                self._active[k] = [name in live for name in self._forms.names]
                self._distances[k] = distances
                following[k] = self._shelf.draw(deepcopy(saved.stream))
            self._places.look_ahead(following)
            self._runner.observe(which)
            self._stopped[which] = False
            return self._observations(), self._infos()

    def _saved(
        self, at: str, snapshot: object
    ) -> tuple[EnvSnapshot, int, int, list[str], list[float]]:
        """A snapshot with its house, its seed, who acts on, and distances."""
        saved = EnvSnapshot.of_vector_bytes(at, snapshot)
        refused = f"{at}: snapshot refused"
        try:
            house, seed = self._shelf.episode(saved.episode_id)
        except ConfigError as error:
            raise ConfigError(f"{refused}: {error}") from None
        live, distances = parts_of_agents(refused, saved.parts, self._forms.names)
        return saved, house, seed, live, distances

    def fork(self) -> DwellParallelVectorEnv:
        """Others at the same moment of the same episodes, which go on by themselves."""
        made: DwellParallelVectorEnv = forked(self)
        return made

    def close(self) -> None:
        """Closes the worlds; after it everything but ``close`` is refused."""
        self._drop()
