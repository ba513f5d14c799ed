"""One environment."""

from __future__ import annotations

import functools
import sys
import weakref
from collections.abc import Mapping, Sequence
from types import FrameType
from typing import Any, NoReturn

import gymnasium
import numpy as np
from gymnasium.utils import EzPickle
from gymnasium.wrappers import TimeLimit
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, _native
from dwell.arguments import integer_in_range, kept, quoted, refuse_unknown, reset_options
from dwell.camera import Camera, camera_settings
from dwell.envs.action_modes import (
    ActionForm,
    AnsweredActions,
    action_form,
    first_of,
    masked_form,
)
from dwell.envs.config import (
    CACHED_HOUSES,
    EpisodeFiles,
    HouseCache,
    Houses,
    agent_number,
    arguments_of,
    env_json,
    kept_houses,
    step_limit,
)
from dwell.envs.current_state import CurrentStateApi
from dwell.envs.episode_calls import EpisodeCalls
from dwell.envs.episode_shelf import EpisodeIndex, settings_as_stated, shelf_of
from dwell.envs.info_keys import step_info
from dwell.envs.native_batch import NativeBatch
from dwell.envs.python_tasks import PythonTask, RewardChoice, Sensors, TaskChoice, split
from dwell.envs.sensor_errors import refuse_blind
from dwell.envs.snapshots import EnvSnapshot
from dwell.heads import Head
from dwell.object_state_api import agent_states
from dwell.stated_episodes import checked_episode, id_and_stated, id_with_stated
from dwell.world import World
from dwell.world_settings import Laws, Randomize, with_head

#: The image that ``render()`` gives.
RENDER_CAMERA = Camera(width=320, height=240)


class DwellEnv(EpisodeCalls, CurrentStateApi, gymnasium.Env[dict[str, Any], Any], EzPickle):
    """A task in a house, with one agent.

    An episode's house is drawn from ``houses``, and everything else in it from the seed. The step
    limit is ``max_episode_steps``, or that of ``gymnasium.make`` (a ``TimeLimit`` wrapper); a
    restored episode ends at the same step in both. A pickle holds the arguments: what comes out of
    it is made anew and waits for ``reset``.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - gymnasium declares it an instance variable
        "render_modes": ["rgb_array"],
        "render_fps": 20,
    }

    def __init__(
        self,
        task: TaskChoice = "InstructionFollowing",
        *,
        houses: Houses | None = None,
        episodes: EpisodeFiles | None = None,
        sensors: Sensors = None,
        reward: RewardChoice = None,
        laws: Laws = None,
        parameters: Mapping[str, float] | None = None,
        randomize: Randomize = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        action_mode: str = "discrete",
        actions: Sequence[str] | None = None,
        action_mask: bool = False,
        world: Mapping[str, Any] | None = None,
        agent: int = 0,
        threads: int | None = None,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
        **unknown: NoReturn,
    ) -> None:
        """Makes the environment.

        Args:
            task: The task's name, or a subclass of :class:`dwell.Task`, or its ``"module:Name"``.
            houses: A HOUSES string or a :class:`dwell.House`, or several; default
                ``"builtin:apartment"``, or the houses of ``episodes``.
            episodes: A file of ``dwell episodes``, or several, whose episodes are played: each
                reset draws one. Houses and the task's settings are theirs.
            sensors: Names of sensors, or settings by name; default the task's own choice. Among
                names, or in place of settings, may be subclasses of :class:`dwell.Sensor`.
            reward: A subclass of :class:`dwell.Reward`, in place of the task's own reward.
            laws: Laws to install; or what calibration found (laws and parameters), as a mapping or
                as the path of its ``found.json``.
            parameters: Values by address; they go before those that calibration found.
            randomize: Intervals from which each episode draws by its seed, evenly: ``{address:
                [low, high]}``; or what calibration found, as a mapping or as the path of its
                ``found.json``, which is installed, too.
            task_settings: The task's own settings; the arguments of a task in Python.
            stride: How far movement actions go: ``forward_m``, ``turn_deg``, ``look_deg``.
            action_mode: The form of actions: ``discrete`` (the number of an action; hands act on
                what the agent looks at), ``velocity`` (velocities of the body), ``pointer`` (an
                action, and a place in the picture on which hands act), ``object`` (an action, and
                the id of a thing) or ``dict`` (velocities and a hand together).
            actions: Names of the actions to choose from, in the order of their numbers; default the
                twelve of ``discrete``, all in the other modes.
            action_mask: Whether ``info["action_mask"]`` says which actions are not ruled out, as
                :meth:`gymnasium.spaces.Discrete.sample` takes it; of the action or the hand where
                an action has more fields; not in the mode ``velocity``.
            world: Further fields of the native WorldConfig; ``sound_head`` may be a
                :class:`dwell.Head` or the path of its SOFA file.
            agent: Which of the world's agents acts, observes and is judged, by its place in
                ``world["agents"]``; the others stand still.
            threads: How many threads to use; results do not depend on it.
            max_episode_steps: Steps after which an episode is truncated; ``None`` or -1: never.
                ``gymnasium.make`` takes an argument of this name for its own wrapper.
            render_mode: ``rgb_array`` or ``None``.
            **unknown: There are no others; such are refused with the nearest names.
        """
        refuse_unknown("DwellEnv", unknown, arguments_of(DwellEnv))
        # Copies: a pickle makes this environment anew, whatever the caller does with his own.
        houses, sensors, laws = kept_houses(houses), kept(sensors), kept(laws)
        parameters, task_settings = kept(parameters), kept(task_settings)
        randomize = kept(randomize)
        stride, world, actions = kept(stride), kept(world), kept(actions)
        episodes = kept(episodes)
        EzPickle.__init__(
            self,
            task,
            houses=houses,
            episodes=episodes,
            sensors=sensors,
            reward=reward,
            laws=laws,
            parameters=parameters,
            randomize=randomize,
            task_settings=task_settings,
            stride=stride,
            action_mode=action_mode,
            actions=actions,
            action_mask=action_mask,
            world=world,
            agent=agent,
            threads=threads,
            max_episode_steps=max_episode_steps,
            render_mode=render_mode,
        )
        self.render_mode = checked_render_mode(render_mode)
        self._limit = step_limit(max_episode_steps)
        #: Gymnasium's wrappers around this environment that count steps, too.
        self._counters: list[weakref.ref[TimeLimit[Any, Any]]] = []
        world, self._heads = with_head(world)
        stated = None if episodes is None else EpisodeIndex(episodes)
        task_settings = settings_as_stated(stated, task, task_settings)
        native, self._custom = split(task, task_settings, reward, sensors)
        self._config = env_json(
            native,
            laws=laws,
            parameters=parameters,
            randomize=randomize,
            stride=stride,
            action_mode=action_mode,
            actions=actions,
            world=world,
            agent=agent_number(agent),
        )
        self._agent = agent_number(agent)
        self._shelf = shelf_of(houses, stated)
        threads = None if threads is None else integer_in_range("threads", threads, low=1)
        self._closed = False
        # Not of this environment: one that nobody holds any more goes at once, with its worlds.
        run = functools.partial(
            _run, self._shelf, self._config, threads, custom=self._custom, heads=self._heads
        )
        self._runner_of = functools.lru_cache(CACHED_HOUSES)(run)
        self._house = 0
        self._episode = 0
        self._seed = 0
        #: What somebody stated of the episode's start and goal when it was reset.
        self._stated: dict[str, Any] | None = None
        #: What the episode asks for, as infos have it.
        self._goal: dict[str, Any] = {}
        #: Whether there is no episode to go on with: none has begun, or a call did not come to its
        #: end that began, restored or stepped one.
        self._stopped = True
        #: Whether the episode has ended by what its task says.
        self._ended = False
        #: The call that plays the episode at this moment.
        self._call: str | None = None
        self._alone = np.ones(1, np.bool_)
        self.metadata = {**self.metadata, "render_fps": steps_a_second(self._runner.batch)}
        batch = self._runner.batch
        self._actions = action_form(
            self._config, batch.answer_fields(), asks=batch.takes_questions()
        )
        self._masks = masked_form(action_mask, self._actions)
        self._measures = self._runner.measures
        refuse_blind(self._runner.space)
        self.observation_space = self._runner.space
        self.action_space = self._actions.space

    @property
    def _runner(self) -> NativeBatch:
        self._refuse_closed()
        return self._runner_of(self._house)

    def _observation(self) -> dict[str, Any]:
        self._runner.observe(self._alone)
        return first_row(self._runner.observation())

    def _info(self) -> dict[str, Any]:
        return {
            "scene_id": self._shelf.names[self._house],
            "episode_id": id_with_stated(
                self._shelf.episode_id(self._house, self._seed), self._stated
            ),
            **self._goal,
            **self._mask(),
        }

    def _mask(self) -> dict[str, NDArray[np.int8]]:
        """The actions that are not ruled out, where that is asked for."""
        if self._masks is None:
            return {}
        return {"action_mask": self._masks.masks(self._runner.action_masks())[0]}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts an episode.

        Args:
            seed: Seeds this and all following episodes.
            options: ``house``: the number of the house to play in; else it is drawn.
                ``episode_id``: that of an earlier ``info``, to play the same episode again, or of
                an episode of ``episodes``. ``episode``: what the episode states in place of
                drawing it, ``start`` and ``goal`` or one of them; the rest is drawn.

        Returns:
            Observation and info: ``scene_id``, ``episode_id``, and what is asked, where the task
            has a goal: ``goal_kind``, ``goal_class`` (of things or rooms of a class),
            ``goal_objects`` and ``goal_rooms`` (ids of those that count), and
            ``start_distance_to_goal`` (m). Every step's info has them, too.

        Raises:
            ConfigError: There is no such option, house or episode; nothing has changed then.
            MeasuredDataError: The episode is not as the file of ``episodes`` states it.
            DwellError: The episode cannot begin; the one before is over.
        """
        self._refuse_closed()
        self._refuse_call("reset")
        number = None if seed is None else integer_in_range("seed", seed)
        house, episode, stated = self._asked(options)
        self._counters = _counters_around(self)
        with self._playing("reset"):
            super().reset(seed=number)
            # Both are drawn whatever is asked for, so that the episodes that follow are the same.
            drawn = self._shelf.draw(self.np_random)
            self._house = drawn[0] if house is None else house
            self._seed = drawn[1] if episode is None else episode
            self._stated = stated
            self._runner.reset(
                [self._seed],
                stated=[self.stated_episode()],
                place=lambda _: self._shelf.place(self._house, self._seed),
            )
            self._ended = False
            self._shelf.check(self._house, self._seed, self._runner.batch)
            self._goal = self._runner.batch.episode_goal(0)
            observation = self._observation()
        return observation, self._info()

    def _asked(
        self, options: dict[str, Any] | None
    ) -> tuple[int | None, int | None, dict[str, Any] | None]:
        """House, seed and what is stated of the episode that is requested, each where it is."""
        options = reset_options(options, "house", "episode_id", "episode")
        if "house" in options and "episode_id" in options:
            raise ConfigError(
                "options: house and episode_id; an episode has its own house, give one"
            )
        stated = None
        if "episode" in options:
            self._shelf.refuse_stated()
            stated = checked_episode("episode", options["episode"])
        if "episode_id" in options:
            plain, of_id = id_and_stated(options["episode_id"])
            if of_id is not None:
                self._shelf.refuse_stated()
            return *self._shelf.episode(plain), of_id if stated is None else stated
        if "house" in options:
            return self._shelf.chosen(options["house"]), None, stated
        return None, None, stated

    def step(
        self,
        action: Any,  # noqa: ANN401 - of the action space
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Makes one control step; ``action``: an element of the action space.

        ``info`` has no ``distance_to_goal``, ``spl`` and ``soft_spl`` where the task has no goal.
        """
        self._refuse_stopped("step")
        if self._ended or self._is_at_limit():
            raise UsageError("step: the episode has ended; call reset first")
        taken = self._actions.one(action)
        # A step that the task did not judge to its end is none.
        with self._playing("step"):
            answer, further = self._runner.step(taken)
        info = step_info(answer, self._measures)
        self._ended = terminated = bool(answer["terminated"][0])
        with self._calling("step"):
            observation = self._observation()
        info["audio_clipped"] = self._runner.batch.clipped()[0]
        return (
            observation,
            float(answer["reward"][0]),
            terminated,
            self._is_at_limit(),
            {
                **info,
                **self._info(),
                **(further[0] if further else {}),
            },
        )

    def _is_at_limit(self) -> bool:
        """Whether the episode has as many steps as are allowed."""
        return self._limit is not None and self._steps() >= self._limit

    def _steps(self) -> int:
        """Number of steps of the episode so far."""
        return int(self._runner.batch.steps()[0])

    def render(self) -> NDArray[np.uint8] | None:
        """The agent's view, (240, 320, 3) uint8; ``None`` without a render mode."""
        self._refuse_closed()
        if self.render_mode is None:
            return None
        view = {"camera": camera_settings("camera", RENDER_CAMERA)}
        image: NDArray[np.uint8] = self._runner.batch.render(0, view)
        return image

    def close(self) -> None:
        """Closes the worlds; may be called again. After it everything else is refused."""
        # First: a call of another thread that runs would make the worlds anew.
        self._closed = True
        self._runner_of.cache_clear()

    def expert_action(self) -> Any:  # noqa: ANN401 - of the action space
        """The action of the task's scripted expert now, an element of the action space.

        Raises:
            UsageError: It wants to do what the environment's actions do not have.
        """
        self._refuse_stopped("expert_action")
        action = first_of(self._runner.expert(self._actions))
        return int(action) if isinstance(action, np.integer) else action

    def state_hash(self) -> int:
        """A number that changes with any bit of state, physics, sound queues or random streams."""
        return self._runner.batch.state_hash(0)

    def snapshot(self) -> bytes:
        """Episode, world and what the following episodes are drawn from as bytes, with a check sum.

        Raises:
            ConfigError: A part's state holds what would come back as another kind.
            UsageError: No episode has begun.
        """
        self._refuse_stopped("snapshot")
        saved = EnvSnapshot(
            episode_id=id_with_stated(
                self._shelf.episode_id(self._house, self._seed), self._stated
            ),
            done=self._ended,
            stream=self.np_random,
            parts=self._runner.saved_parts(0),
            world=self._runner.batch.snapshot(0),
        )
        return saved.to_bytes()

    def restore(self, snapshot: bytes) -> tuple[dict[str, Any], dict[str, Any]]:
        """Restores a snapshot; the next steps give the same bits as they did then.

        The episodes that ``reset`` without a seed draws afterwards are those that followed then,
        as in vector environments. The episode is truncated at the same step, too, whether
        ``max_episode_steps`` says at which or a ``TimeLimit`` wrapper of gymnasium through which it
        was last reset.

        Returns:
            Observation and info of that moment.

        Raises:
            ConfigError: It is of something else, or was damaged. Nothing has changed then.
        """
        self._refuse_closed()
        self._refuse_call("restore")
        saved = EnvSnapshot.of_bytes("snapshot", snapshot)
        try:
            plain, stated = id_and_stated(saved.episode_id)
            house, seed = self._shelf.episode(plain)
        except ConfigError as error:
            raise ConfigError(f"snapshot refused: {error}") from None
        # Nothing changes before it was accepted.
        runner = self._runner_of(house)
        runner.loaded(0, saved.parts)
        with self._playing("restore", or_stay=True):
            runner.restore(saved.world, saved.parts, seed)
            self._house, self._seed, self._stated = house, seed, stated
            self._ended, self.np_random = saved.done, saved.stream
            self._goal = runner.batch.episode_goal(0)
            for counter in self._counters:
                if (wrapper := counter()) is not None:
                    wrapper._elapsed_steps = self._steps()  # type: ignore[assignment] # None first
            observation = self._observation()
        return observation, self._info()

    def stated_episode(self) -> dict[str, Any] | None:
        """What the episode states of its start and goal, where they were not drawn."""
        self._refuse_closed()
        own = self._stated
        return self._shelf.stated(self._house, self._seed) if own is None else own

    def instruction(self) -> str:
        """The instruction of the episode."""
        return self._runner.batch.instruction(0)

    def agents(self) -> list[dict[str, Any]]:
        """The agents' states, as :meth:`dwell.World.agents` tells them."""
        return agent_states(self._runner.batch.agent_states(0))

    @property
    def world(self) -> World:
        """The world in which the episode is played; it goes on with the environment's steps.

        A change that is no action is in no recorded file, and ends with the episode. The next
        episode may be in another house, and then in another world: ask anew after ``reset``.
        """
        return self._runner.world(0)

    @property
    def action_form(self) -> ActionForm:
        """The form of actions, without the answer that some tasks expect."""
        form = self._actions
        return form.form if isinstance(form, AnsweredActions) else form

    @property
    def has_answers(self) -> bool:
        """Whether actions hold an answer for the task."""
        return isinstance(self._actions, AnsweredActions)

    def actions(self) -> list[str]:
        """The names of the actions, in the order of their numbers."""
        self._refuse_closed()
        return [*self._actions.names]

    def answer_choices(self) -> dict[str, list[str]]:
        """The words of each choice of the task's answer, in the order of their numbers."""
        self._refuse_closed()
        fields = self._runner.batch.answer_fields()
        choices = {field["name"]: field["choices"] for field in fields}
        return {name: [*words] for name, words in choices.items() if words is not None}


def _run(
    shelf: HouseCache,
    config: str,
    threads: int | None,
    house: int,
    *,
    custom: PythonTask,
    heads: Sequence[Head],
) -> NativeBatch:
    """The runner in a house of a shelf."""
    return NativeBatch([shelf[house]], config, threads, custom=custom, heads=heads)


def first_row(observation: Mapping[str, Any]) -> dict[str, Any]:
    """The only environment's observation out of a batch's buffers, as copies."""
    return {
        name: value[0] if isinstance(value, tuple) or value.ndim == 1 else value[0].copy()
        for name, value in observation.items()
    }


def steps_a_second(batch: _native.Batch) -> float:
    """Control steps in a second of simulated time, which is also how fast pictures follow."""
    rate_hz = float(_native.World.of_env(batch, 0).config()["control_rate_hz"])
    return int(rate_hz) if rate_hz.is_integer() else rate_hz


def checked_render_mode(mode: object) -> str | None:
    """A render mode of environments.

    Raises:
        ConfigError: There is none of this name.
    """
    modes = DwellEnv.metadata["render_modes"]
    if mode is None or (isinstance(mode, str) and mode in modes):
        return mode
    raise ConfigError(f"render_mode: found {quoted(mode)}, allowed are None and {modes}")


def _counters_around(env: DwellEnv) -> list[weakref.ref[TimeLimit[Any, Any]]]:
    """Gymnasium's step limits through which ``env.reset`` is being called: they count from here.

    A wrapper does not tell what it wraps that it is there, so the calls are looked through.
    """
    found = []
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        if frame.f_code is TimeLimit.reset.__code__:
            wrapper = frame.f_locals["self"]
            if wrapper.unwrapped is env:
                found.append(weakref.ref(wrapper))
        frame = frame.f_back
    return found
