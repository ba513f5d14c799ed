"""An environment in which several agents act at once, as PettingZoo's parallel API has it."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

import numpy as np
from gymnasium import spaces
from gymnasium.utils import EzPickle, seeding
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from dwell import ConfigError
from dwell.arguments import integer_in_range, kept, refuse_unknown, reset_options
from dwell.camera import camera_settings
from dwell.envs.action_modes import EngineActions
from dwell.envs.agent_forms import AgentForms
from dwell.envs.agent_settings import OF_TASKS, Agents, MultiAgentSetup
from dwell.envs.agent_snapshots import agent_parts, parts_of_agents
from dwell.envs.agent_state import agent_state_rows, state_space
from dwell.envs.config import (
    CACHED_HOUSES,
    HouseCache,
    Houses,
    arguments_of,
    kept_houses,
)
from dwell.envs.current_state import CurrentStateApi
from dwell.envs.episode_calls import EpisodeCalls
from dwell.envs.episode_shelf import shelf_of
from dwell.envs.info_keys import step_info
from dwell.envs.native_batch import NativeBatch
from dwell.envs.python_tasks import NativeSensors
from dwell.envs.single import (
    RENDER_CAMERA,
    checked_render_mode,
    first_row,
    steps_a_second,
)
from dwell.envs.snapshots import EnvSnapshot
from dwell.heads import Head
from dwell.object_state_api import agent_states
from dwell.world import World
from dwell.world_settings import Laws, Randomize

#: What PettingZoo's own tests give to see that there are options.
_OF_TESTS = {"options"}


class DwellParallelEnv(EpisodeCalls, CurrentStateApi, ParallelEnv, EzPickle):  # type: ignore[misc] # untyped
    """A house in which several agents act at once, each with a task, sensors and a body of its own.

    All act at one clock. An agent's episode ends by itself: then it is no longer in ``agents``, its
    body stands where it is, and the others go on. What one agent observes and draws depends on the
    others by what happens in the world alone. Which of two hands gets a thing, and who passes a
    door first, is decided by where they are, never by an agent's name or place in the list.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - PettingZoo declares it an instance variable
        "name": "dwell",
        "render_modes": ["rgb_array"],
        "is_parallelizable": True,
        "render_fps": 20,
    }

    def __init__(
        self,
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
        render_mode: str | None = None,
        **unknown: NoReturn,
    ) -> None:
        """Makes the environment.

        Args:
            task: The task of agents that state no other, by its name.
            agents: How many agents act (``agent_0``, ``agent_1`` and so on), or settings by the
                agents' names: ``task``, ``task_settings``, ``sensors``, ``stride``,
                ``action_mode``, ``actions``, ``body`` (fields of the native AgentBody), ``voice``,
                ``team``, and ``scripted`` (it acts as its task's expert says, and is in no list);
                what an agent does not state is as for all. At most 64.
            houses: A HOUSES string or a :class:`dwell.House`, or several; default
                ``"builtin:apartment"``.
            sensors: Names of sensors, or settings by name; default each task's own choice.
            laws: Laws to install, or what calibration found.
            parameters: Values by address.
            randomize: Intervals from which each episode draws, or what calibration found.
            task_settings: The settings of the task.
            stride: How far movement actions go.
            action_mode: The form of actions, as of :class:`dwell.envs.DwellEnv`.
            actions: Names of the actions to choose from.
            action_mask: Whether each info has an ``action_mask``.
            world: Further fields of the native WorldConfig; the agents' bodies stand in ``agents``.
            voice: What agents that state no ``voice`` can say: nothing (``False``), all words of
                the vocabulary (``True``), or ``words``, ``max_tokens`` (1 to 8) and ``efforts`` (of
                ``whisper``, ``normal``, ``raised``, ``loud``, ``shout``). Actions have a ``say``
                then; who has the sensors ``heard_tokens`` and ``heard_directions``, or ears, hears.
            muted: Whether all voices are silent: what is said goes nowhere.
            shared_reward: Which share of an agent's reward is the mean of its team's, 0 (all
                private) to 1; who states no ``team`` is in one with all others who state none.
            threads: How many threads to use; results do not depend on it.
            max_cycles: Steps after which the episodes of all are truncated; by default the longest
                limit of the agents' tasks, ``None``: never.
            render_mode: ``rgb_array`` or ``None``.
            **unknown: There are no others; such are refused with the nearest names.

        Raises:
            ConfigError: A setting is wrong; the message names it.
        """
        refuse_unknown("DwellParallelEnv", unknown, arguments_of(DwellParallelEnv))
        given = {
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
            "render_mode": render_mode,
        }
        EzPickle.__init__(self, task, **given)
        self.render_mode = checked_render_mode(render_mode)
        setup = MultiAgentSetup.of(task, given)
        self._roster, self._config, self._limit = setup.roster, setup.config, setup.limit
        self._heads = setup.heads
        self._shelf = shelf_of(given["houses"], None)
        threads = None if threads is None else integer_in_range("threads", threads, low=1)
        self._closed = False
        run = functools.partial(_run, self._shelf, self._config, threads, setup.heads)
        self._runner_of = functools.lru_cache(CACHED_HOUSES)(run)
        self._house, self._seed = 0, 0
        self._np_random: np.random.Generator | None = None
        #: Of each agent, by its place, what its episode asks for.
        self._goals: list[dict[str, Any]] = []
        #: Each agent's distance to its goal after the last step, m; NaN where there is none.
        self._distances = np.full(len(self._roster.names), np.nan)
        #: Whose task the last step fulfilled, and whose episode it ended, by the agents' places.
        self._ruling = (np.zeros(0, np.bool_), np.zeros(0, np.bool_))
        self._stopped = True
        self._call: str | None = None
        self._alone = np.ones(1, np.bool_)
        with setup.built(self._shelf[0]):
            runner = self._runner
        self._forms = AgentForms(
            self._config,
            runner,
            self._roster,
            action_mask=action_mask,
            shared_reward=shared_reward,
        )
        self.metadata = {
            **self.metadata,
            "name": f"dwell/{task}",
            "render_fps": steps_a_second(self._runner.batch),
        }
        self._agent = 0
        self.possible_agents = [self._roster.names[k] for k in self._roster.players]
        self.agents: list[str] = []
        self.observation_spaces = self._forms.observation_spaces
        self.action_spaces = self._forms.action_spaces
        #: The space of :meth:`state`.
        self.state_space: spaces.Box = state_space(len(self._roster.names))

    def observation_space(self, agent: str) -> spaces.Dict:
        """The space of an agent's observations; always the same object."""
        return self._forms.observation_spaces[self._named(agent)]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's actions; always the same object."""
        return self._forms.action_spaces[self._named(agent)]

    def check_action(self, agent: str, action: object) -> None:
        """Refuses what is no action of an agent.

        Raises:
            ConfigError: It is none, or there is no such agent.
        """
        self._forms.of_agent(self._roster.place(agent), action)

    def _named(self, agent: object) -> str:
        return self._roster.names[self._roster.place(agent)]

    @property
    def _runner(self) -> NativeBatch:
        self._refuse_closed()
        return self._runner_of(self._house)

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
        """Starts the episodes of all agents.

        Args:
            seed: Seeds these and all following episodes.
            options: ``house``: the number of the house to play in; ``episode_id``: that of an
                earlier info, to play the same episodes again.

        Returns:
            Observations and infos by the agents' names; see :meth:`dwell.envs.DwellEnv.reset`.

        Raises:
            ConfigError: There is no such option, house or episode; nothing has changed then.
        """
        self._refuse_closed()
        self._refuse_call("reset")
        number = None if seed is None else integer_in_range("seed", seed)
        house, episode = self._asked(options)
        with self._playing("reset"):
            self.agents = []
            if number is not None or self._np_random is None:
                self._np_random, _ = seeding.np_random(number)
            drawn = self._shelf.draw(self._np_random)
            self._house = drawn[0] if house is None else house
            self._seed = drawn[1] if episode is None else episode
            self._runner.reset([self._seed])
            self._distances[:] = np.nan
            self._read_goals()
            observations = self._observations(self.possible_agents)
            self.agents = [*self.possible_agents]
        return observations, self._infos(self.agents)

    def _asked(self, options: dict[str, Any] | None) -> tuple[int | None, int | None]:
        if isinstance(options, Mapping) and {*options} == _OF_TESTS:
            return None, None
        options = reset_options(options, "house", "episode_id")
        if "house" in options and "episode_id" in options:
            raise ConfigError(
                "options: house and episode_id; an episode has its own house, give one"
            )
        if "episode_id" in options:
            return self._shelf.episode(options["episode_id"])
        return self._shelf.chosen(options["house"]) if "house" in options else None, None

    def _read_goals(self) -> None:
        batch = self._runner.batch
        self._goals = [batch.episode_goal(0, k) for k in range(len(self._roster.names))]

    def _observations(self, names: Sequence[str]) -> dict[str, dict[str, Any]]:
        self._runner.observe(self._alone)
        return {
            name: first_row(self._runner.agent_observation(self._roster.place(name)))
            for name in names
        }

    def _infos(self, names: Sequence[str]) -> dict[str, dict[str, Any]]:
        about = {
            "scene_id": self._shelf.names[self._house],
            "episode_id": self._shelf.episode_id(self._house, self._seed),
        }
        masks = self._forms.masks(self._runner)
        infos = {}
        for name in names:
            k = self._roster.place(name)
            infos[name] = {**about, **self._goals[k]}
            if (mask := masks[k]) is not None:
                infos[name]["action_mask"] = mask[0]
        return infos

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, dict[str, Any]],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Makes one control step, in which all agents act at once.

        Args:
            actions: An element of its action space for each agent of ``agents``.

        Returns:
            Observations, rewards, terminations, truncations and infos of those who were in
            ``agents`` before the step. Without any agent left, all are empty.

        Raises:
            UsageError: No episode has begun, or an action is of an agent whose episode has ended.
            ConfigError: An action is missing, or is none.
        """
        self._refuse_stopped("step")
        live = self.agents
        if not live and not actions:
            return {}, {}, {}, {}, {}
        taken = EngineActions.interleaved(self._forms.one(actions, live))
        with self._playing("step"):
            answer, _ = self._runner.step(taken)
            rewards = self._forms.rewards(answer)[0]
            self._distances[:] = np.asarray(answer["distance_to_goal"])
            self._ruling = (np.asarray(answer["success"]), np.asarray(answer["terminated"]))
            cut = self._limit is not None and int(self._runner.batch.steps()[0]) >= self._limit
            ended = {name: bool(answer["terminated"][self._roster.place(name)]) for name in live}
            observations = self._observations(live)
            clipped = self._runner.batch.clipped()
            infos = self._infos(live)
            for name in live:
                k = self._roster.place(name)
                infos[name] |= step_info(answer, self._forms.measures[k], k)
                infos[name]["audio_clipped"] = clipped[k]
                infos[name]["speaks"] = bool(answer["speaks"][k])
            self.agents = [] if cut else [name for name in live if not ended[name]]
        return (
            observations,
            {name: float(rewards[self._roster.place(name)]) for name in live},
            ended,
            dict.fromkeys(live, cut),
            infos,
        )

    def state(self) -> NDArray[np.float32]:
        """The state of all agents, for a critic that sees everything.

        Returns:
            Shape (agent x 13,), by agent as they were given, scripted ones among them; see
            :data:`dwell.envs.agent_state.STATE_FIELDS`.
        """
        self._refuse_stopped("state")
        active = np.array([name in self.agents for name in self._roster.names], np.bool_)
        states = self._runner.batch.agent_states(0)
        return agent_state_rows(states, self._distances, active).ravel()

    def render(self) -> NDArray[np.uint8] | None:
        """The agents' views side by side, (240, 320 x agents, 3) uint8; ``None`` without a mode."""
        self._refuse_closed()
        self._refuse_call("render")
        if self.render_mode is None:
            return None
        camera = camera_settings("camera", RENDER_CAMERA)
        batch, players = self._runner.batch, self._roster.players
        views = [batch.render(0, {"camera": camera, "agent": number}) for number in players]
        return np.concatenate(views, axis=1)

    def close(self) -> None:
        """Closes the worlds; may be called again. After it everything else is refused."""
        # First: a call of another thread that runs would make the worlds anew.
        self._closed = True
        self._runner_of.cache_clear()

    def expert_actions(self) -> dict[str, Any]:
        """What the experts of the agents of ``agents`` would do now, by the agents' names.

        Raises:
            UsageError: One wants to do what the agent's actions do not have.
        """
        self._refuse_stopped("expert_actions")
        found = self._forms.expert(self._runner)
        return {name: _first(found[name]) for name in self.agents}

    def action_names(self, agent: str) -> list[str]:
        """The names of an agent's actions, in the order of their numbers."""
        return self._forms.action_names(self._roster.place(agent))

    def words(self, agent: str) -> list[str]:
        """The words that an agent can say, by the numbers of ``say``; the first is none."""
        return self._forms.words(self._roster.place(agent))

    def agent_states(self) -> dict[str, dict[str, Any]]:
        """The agents' states by name, as :meth:`dwell.World.agents` tells them."""
        states = agent_states(self._runner.batch.agent_states(0))
        return dict(zip(self._roster.names, states, strict=True))

    @property
    def world(self) -> World:
        """The world in which the episodes are played; see :attr:`dwell.envs.DwellEnv.world`."""
        return self._runner.world(0)

    def state_hash(self) -> int:
        """A number that changes with any bit of state, physics, sound queues or random streams."""
        self._refuse_closed()
        self._refuse_call("state_hash")
        return self._runner.batch.state_hash(0)

    def snapshot(self) -> bytes:
        """Episodes, world and what the following episodes are drawn from as bytes.

        Raises:
            UsageError: No episode has begun.
        """
        self._refuse_stopped("snapshot")
        assert self._np_random is not None
        saved = EnvSnapshot(
            episode_id=self._shelf.episode_id(self._house, self._seed),
            done=not self.agents,
            stream=self._np_random,
            parts=agent_parts(self._roster.names, self.agents, self._distances.tolist()),
            world=self._runner.batch.snapshot(0),
        )
        return saved.to_bytes()

    def restore(
        self, snapshot: bytes
    ) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
        """Restores a snapshot; the next steps give the same bits as they did then.

        Returns:
            Observations and infos of that moment, of the agents whose episodes went on.

        Raises:
            ConfigError: It is of something else, or was damaged. Nothing has changed then.
        """
        self._refuse_closed()
        self._refuse_call("restore")
        saved = EnvSnapshot.of_bytes("snapshot", snapshot)
        try:
            house, seed = self._shelf.episode(saved.episode_id)
        except ConfigError as error:
            raise ConfigError(f"snapshot refused: {error}") from None
        at = "snapshot refused"
        live, distances = parts_of_agents(at, saved.parts, self._roster.names)
        with self._playing("restore", or_stay=True):
            self._runner_of(house).batch.restore(0, saved.world)
            self._house, self._seed, self._np_random = house, seed, saved.stream
            self._distances[:] = distances
            self._read_goals()
            observations = self._observations(live)
            self.agents = live
        return observations, self._infos(live)


def _run(
    shelf: HouseCache, config: str, threads: int | None, heads: Sequence[Head], house: int
) -> NativeBatch:
    return NativeBatch([shelf[house]], config, threads, heads=heads)


def _first(batched: Any) -> Any:  # noqa: ANN401 - of any action space
    """The only element of a batched action, a number as such."""
    if isinstance(batched, Mapping):
        return {key: _first(value) for key, value in batched.items()}
    return int(batched[0]) if isinstance(batched[0], np.integer) else batched[0]
