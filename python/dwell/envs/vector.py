"""Several environments in one call, rendered in one submission."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any, NoReturn, cast

import numpy as np
from gymnasium.utils import EzPickle
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from dwell import ConfigError, UsageError
from dwell.arguments import (
    abbreviated_list,
    boolean,
    integer_in_range,
    kept,
    quoted,
    refuse_unknown,
)
from dwell.camera import camera_settings
from dwell.envs.action_modes import EngineActions, action_form, masked_form
from dwell.envs.config import (
    CACHED_HOUSES,
    EpisodeFiles,
    Houses,
    agent_number,
    arguments_of,
    env_json,
    kept_houses,
    step_limit,
)
from dwell.envs.current_state import forked
from dwell.envs.env_pool import EnvPool
from dwell.envs.episode_shelf import EpisodeIndex, settings_as_stated, shelf_of
from dwell.envs.house_assignment import HouseAssignment
from dwell.envs.info_keys import INFO_KEYS, step_infos
from dwell.envs.native_batch import NativeBatch
from dwell.envs.python_tasks import RewardChoice, Sensors, TaskChoice, split
from dwell.envs.saved_world import SavedWorld
from dwell.envs.sensor_errors import refuse_blind
from dwell.envs.single import (
    RENDER_CAMERA,
    DwellEnv,
    checked_render_mode,
    steps_a_second,
)
from dwell.envs.snapshots import EnvSnapshot
from dwell.envs.step_recorder import Recorder
from dwell.envs.vector_calls import VectorCalls
from dwell.envs.vector_reset import VectorReset
from dwell.world import World
from dwell.world_settings import Laws, Randomize, with_head


def _autoreset_mode(mode: object) -> AutoresetMode:
    try:
        return AutoresetMode(mode)
    except ValueError:
        allowed = ", ".join(repr(one.value) for one in AutoresetMode)
        raise ConfigError(f"autoreset_mode is {quoted(mode)}; allowed are {allowed}") from None


class DwellVectorEnv(VectorCalls, VectorEnv[dict[str, Any], Any, NDArray[Any]], EzPickle):
    """``num_envs`` environments stepped together, rendered in one submission.

    Seeded with ``s``, environment k plays to the bit the episodes that a :class:`DwellEnv` with the
    same arguments plays that is seeded with ``s + k``: houses are drawn from ``houses``, everything
    else comes from the episode's seed. Houses of coming episodes are opened in the background
    (``load_ahead``).

    Observations are the environments' own buffers: copy what must outlive the next step, or say
    ``copy=True``. A pickle holds the arguments, as that of a single environment.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - gymnasium declares it an instance variable
        "render_modes": ["rgb_array"],
        "render_fps": DwellEnv.metadata["render_fps"],
    }

    def __init__(
        self,
        num_envs: int = 1,
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
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = False,
        overlap: bool = False,
        load_ahead: int = CACHED_HOUSES,
        render_mode: str | None = None,
        **unknown: NoReturn,
    ) -> None:
        """Makes the environments; arguments as :class:`dwell.envs.DwellEnv`.

        Args:
            num_envs: How many.
            task: The task's name, or a subclass of :class:`dwell.Task`.
            houses: A HOUSES string or a :class:`dwell.House`, or several.
            episodes: A file of episodes, or several, of which each reset draws one.
            sensors: Names of sensors, or settings by name; subclasses of :class:`dwell.Sensor`.
            reward: A subclass of :class:`dwell.Reward`.
            laws: Laws to install, or what calibration found.
            parameters: Values by address.
            randomize: Intervals from which each episode draws, or what calibration found.
            task_settings: The task's own settings.
            stride: How far movement actions go.
            action_mode: As of a single environment.
            actions: As of a single environment.
            action_mask: As of a single environment.
            world: Further fields of the native WorldConfig.
            agent: Which of each world's agents acts.
            threads: How many threads to use; results do not depend on it.
            max_episode_steps: Steps after which an episode is truncated; ``None`` or -1: never.
            autoreset_mode: ``NextStep``: an environment whose episode has ended begins the next one
                in the next step, whose action it does not play; ``SameStep``: in the same step, of
                which ``infos["final_obs"]`` and ``infos["final_info"]`` keep what it ended with;
                ``Disabled``: when ``reset`` is called with its ``reset_mask``.
            copy: Whether observations are copies.
            overlap: Whether a graphics adapter takes the pictures of environments that have stepped
                while others still step. Observations are the same, of the same step; without an
                adapter nothing changes.
            load_ahead: How many environments may wait, each in a house of its own, for the episodes
                that follow, made by a thread while others are played; 0: none, and a step at an
                episode's end takes as long as opening its house.
            render_mode: ``rgb_array`` or ``None``.
            **unknown: There are no others; such are refused with the nearest names.
        """
        refuse_unknown("DwellVectorEnv", unknown, arguments_of(DwellVectorEnv))
        # Copies: a pickle makes these environments anew, whatever the caller does with his own.
        houses, sensors, laws = kept_houses(houses), kept(sensors), kept(laws)
        parameters, task_settings = kept(parameters), kept(task_settings)
        randomize = kept(randomize)
        stride, world, actions = kept(stride), kept(world), kept(actions)
        episodes = kept(episodes)
        EzPickle.__init__(
            self,
            num_envs,
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
            autoreset_mode=autoreset_mode,
            copy=copy,
            overlap=overlap,
            load_ahead=load_ahead,
            render_mode=render_mode,
        )
        num_envs = integer_in_range("num_envs", num_envs, low=1, high=65_536)
        self._copy, overlap = boolean("copy", copy), boolean("overlap", overlap)
        self.num_envs = num_envs
        self.render_mode = checked_render_mode(render_mode)
        self.autoreset_mode = _autoreset_mode(autoreset_mode)
        self._limit = step_limit(max_episode_steps)
        load_ahead = integer_in_range("load_ahead", load_ahead)
        world, heads = with_head(world)
        stated = None if episodes is None else EpisodeIndex(episodes)
        task_settings = settings_as_stated(stated, task, task_settings)
        native, custom = split(task, task_settings, reward, sensors)
        config = env_json(
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
        shelf = shelf_of(houses, stated)
        threads = None if threads is None else integer_in_range("threads", threads, low=1)
        self._shelf = shelf
        self._config, self._custom, self._heads = config, custom, heads
        runner = NativeBatch(
            [shelf[0]] * num_envs, config, threads, custom=custom, overlap=overlap, heads=heads
        )
        pool = EnvPool(shelf, config, heads, threads)
        self._opened = runner, HouseAssignment(runner, pool, load_ahead)
        batch = runner.batch
        rate_hz = steps_a_second(batch)
        own = {"autoreset_mode": self.autoreset_mode, "render_fps": rate_hz}
        self.metadata = {**self.metadata, **own}
        self._streams: list[np.random.Generator | None] = [None] * num_envs
        #: The seed of every environment's episode, once it has one.
        self._seeds: list[int | None] = [None] * num_envs
        #: What :meth:`_ids` gives; ``None`` where episodes have begun since.
        self._episode_infos: dict[str, Any] | None = None
        self._done = np.ones(num_envs, np.bool_)
        #: Who writes down what is played.
        self._recorders: list[Recorder] = []
        #: Whose latest reset, restoring or step did not come to its end.
        self._stopped = np.zeros(num_envs, np.bool_)
        self._actions = action_form(config, batch.answer_fields(), asks=batch.takes_questions())
        self._masks = masked_form(action_mask, self._actions)
        #: Keys of a step's answer that become infos.
        self._info_keys = (*INFO_KEYS, *runner.measures)
        refuse_blind(runner.space)
        self.single_observation_space = runner.space
        self.single_action_space = self._actions.space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def _observation(self) -> dict[str, Any]:
        now = self._runner.observation()
        if not self._copy:
            return now
        return {
            key: value if isinstance(value, tuple) else value.copy() for key, value in now.items()
        }

    def _start(
        self, which: NDArray[np.bool_], asked: Mapping[int, tuple[int, int]] | None = None
    ) -> None:
        """Begins episodes: those of ``asked`` (house and seed), else drawn ones."""
        episodes: dict[int, tuple[int, int]] = {}
        for k in np.flatnonzero(which).tolist():
            drawn = self._draw(self._stream(k))
            episodes[k] = (asked or {}).get(k, drawn)
        self._stopped[which] = True
        moved = self._places.move(episodes)
        seeds: list[int | None] = [None] * self.num_envs
        stated: list[dict[str, Any] | None] = [None] * self.num_envs
        for k, (house, seed) in episodes.items():
            seeds[k], stated[k] = seed, self._shelf.stated(house, seed)
        self._runner.reset(seeds, moved, stated, lambda k: self._shelf.place(*episodes[k]))
        for k, (house, seed) in episodes.items():
            self._shelf.check(house, seed, self._runner.batch, k)
            self._seeds[k] = seed
        self._episode_infos = None
        self._done[which] = False
        self._stopped[which] = False
        self._look_ahead(which)
        for recorder in self._recorders:
            recorder.began([*episodes])

    def _stream(self, env: int) -> np.random.Generator:
        stream = self._streams[env]
        if stream is None:
            raise UsageError(f"no episode of environment {env} has begun; reset it")
        return stream

    def _draw(self, stream: np.random.Generator) -> tuple[int, int]:
        """The next episode's house and seed, drawn as a single environment draws them."""
        return self._shelf.draw(stream)

    def _look_ahead(self, which: NDArray[np.bool_]) -> None:
        """Opens ahead the houses in which environments of ``which`` go on after this episode."""
        # Of copies: drawn again when the episodes begin.
        following = {
            k: self._draw(deepcopy(self._stream(k))) for k in np.flatnonzero(which).tolist()
        }
        self._places.look_ahead(following)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts episodes.

        Args:
            seed: One seed (then environment k has ``seed + k``), or one for each environment.
            options: ``reset_mask``: which environments to reset, shape (num_envs,) bool.
                ``episode_id``: an earlier ``info["episode_id"]`` for each environment, to play the
                same episodes again; ``None`` where one is drawn, and for those left out.

        Returns:
            Observations and infos: ``scene_id``, ``episode_id`` and what is asked, as
            :meth:`DwellEnv.reset` gives them, of every environment.
        """
        self._refuse_closed()
        self._refuse_call("reset")
        given = VectorReset.of(seed, options, self.num_envs)
        which, seeds = given.which, given.seeds
        asked = {k: self._shelf.episode(one) for k, one in given.episode_ids.items()}
        for k in np.flatnonzero(which):
            if seeds[k] is not None or self._streams[k] is None:
                self._streams[k] = np.random.default_rng(seeds[k])
        with self._calling("reset"):
            self._start(which, asked)
            self._stopped[which] = True
            self._runner.observe(which)
            self._stopped[which] = False
        return self._observation(), self._ids()

    def _ids(self) -> dict[str, Any]:
        """Infos that stay the same in an episode, of every environment that has one."""
        if self._episode_infos is None:
            self._episode_infos = self._gathered_ids()
        infos = {key: value.copy() for key, value in self._episode_infos.items()}
        if self._masks is not None:
            infos["action_mask"] = self._masks.masks(self._runner.action_masks())
            infos["_action_mask"] = infos["_episode_id"].copy()
        return infos

    def _gathered_ids(self) -> dict[str, Any]:
        has = np.array([seed is not None for seed in self._seeds], np.bool_) & ~self._stopped
        scenes, episodes = (np.full(self.num_envs, None, object) for _ in range(2))
        for k in np.flatnonzero(has).tolist():
            scenes[k] = self._places.name(k)
            episodes[k] = self._places.episode_id(k, self._seeds[k] or 0)
        infos = {
            "scene_id": scenes,
            "_scene_id": has,
            "episode_id": episodes,
            "_episode_id": has.copy(),
        }
        for k in np.flatnonzero(has).tolist():
            infos = self._add_info(infos, self._runner.batch.episode_goal(k), k)
        return infos

    def step(
        self,
        actions: Any,  # noqa: ANN401 - of the action space
    ) -> tuple[
        dict[str, Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Makes one control step in every environment.

        ``infos`` hold what a single environment's ``info`` does. What is not known, as
        ``distance_to_goal``, ``spl`` and ``soft_spl`` without a goal, is NaN, and its mask (such as
        ``infos["_spl"]``) false.
        """
        self._refuse_closed()
        if any(stream is None for stream in self._streams):
            raise UsageError("step: no episode has begun; call reset first")
        self._refuse_call("step")
        if self._stopped.any():
            which = abbreviated_list(np.flatnonzero(self._stopped).tolist())
            raise UsageError(f"step: no episode of environments {which} has begun; reset them")
        taken = self._actions.many(actions, self.num_envs)
        begins = self._done.copy()
        if begins.any() and self.autoreset_mode is not AutoresetMode.NEXT_STEP:
            which = abbreviated_list(np.flatnonzero(begins).tolist())
            raise UsageError(f"environments {which} have ended; reset them with reset_mask first")
        with self._calling("step"):
            return self._stepped(taken, begins)

    def _stepped(
        self, taken: EngineActions, begins: NDArray[np.bool_]
    ) -> tuple[
        dict[str, Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Makes a step; in the environments of ``begins`` an episode begins instead."""
        if begins.any():
            self._start(begins)
        for recorder in self._recorders:
            recorder.check()
        taken = taken.without(begins)
        # Steps that the tasks did not judge to their end are none.
        self._stopped[~begins] = True
        answer, further = self._runner.step(taken)
        self._stopped[~begins] = False
        rewards = np.asarray(answer["reward"], np.float64)
        terminated = np.asarray(answer["terminated"], np.bool_)
        truncated = np.zeros(self.num_envs, np.bool_)
        if self._limit is not None:
            truncated = (self._runner.batch.steps() >= self._limit) & ~begins
        self._runner.observe(np.ones(self.num_envs, np.bool_))
        infos = step_infos(answer, self._info_keys, ~begins)
        infos["audio_clipped"] = np.array(self._runner.batch.clipped(), np.int64)
        infos["_audio_clipped"] = np.ones(self.num_envs, np.bool_)
        infos |= self._ids()
        for k, row in enumerate(further):
            try:
                infos = self._add_info(infos, dict(row), k)
            except (OverflowError, TypeError, ValueError) as error:
                raise ConfigError(
                    f"info of environment {k} is {quoted(dict(row))}; expected values that one "
                    f"array for each name holds, of one kind in all environments: {error}"
                ) from None
        self._done = terminated | truncated
        for recorder in self._recorders:
            recorder.stepped(taken, infos["success"], self._done)
        if self._done.any() and self.autoreset_mode is AutoresetMode.SAME_STEP:
            own = [
                key
                for key in infos
                if key not in (*self._info_keys, "action_error", "audio_clipped")
            ]
            infos |= self._restart(infos, [key for key in own if not key.startswith("_")])
            infos |= self._ids()
        return self._observation(), rewards, terminated, truncated, infos

    def _restart(self, infos: dict[str, Any], own: Sequence[str]) -> dict[str, Any]:
        """Starts ended environments anew within the step; what they ended with goes into infos."""
        ended = self._done.copy()
        last = self._runner.observation()
        final = np.full(self.num_envs, None, object)
        for k in np.flatnonzero(ended):
            final[k] = {
                key: value[k] if isinstance(value, tuple) else value[k].copy()
                for key, value in last.items()
            }
        final_info: dict[str, Any] = {}
        for key in (*self._info_keys, "action_error", "audio_clipped", *own):
            values, known = infos[key], infos[f"_{key}"]
            final_info |= {key: values.copy(), f"_{key}": ended & known}
            # The episode that begins has made no step.
            infos[f"_{key}"] = known & ~ended
            if values.dtype.kind == "f":
                infos[key] = np.where(ended, np.nan, values)
        self._start(ended)
        self._runner.observe(ended)
        return {
            "final_obs": final,
            "_final_obs": ended,
            "final_info": final_info,
            "_final_info": ended,
        }

    def snapshot(self) -> list[bytes]:
        """Every environment as bytes: world, episode, its steps, and the seeds that follow.

        Raises:
            UsageError: No episode has begun in one of them.
        """
        self._refuse_closed()
        self._refuse_call("snapshot")
        rows = []
        for k, (seed, stream) in enumerate(zip(self._seeds, self._streams, strict=True)):
            if seed is None or stream is None or self._stopped[k]:
                raise UsageError(f"snapshot: no episode of environment {k} has begun; reset it")
            saved = EnvSnapshot(
                episode_id=self._places.episode_id(k, seed),
                done=bool(self._done[k]),
                stream=stream,
                parts=self._runner.saved_parts(k),
                world=self._runner.batch.snapshot(k),
            )
            rows.append(saved.to_vector_bytes())
        return rows

    def restore(self, snapshots: Sequence[bytes | None]) -> tuple[dict[str, Any], dict[str, Any]]:
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
        self._refuse_closed()
        self._refuse_call("restore")
        given: object = snapshots
        if not isinstance(given, list | tuple) or len(given) != self.num_envs:
            raise ConfigError(
                f"snapshots is {quoted(given, 60)}; expected a list of {self.num_envs}: bytes, or "
                "None, for each environment"
            )
        rows: dict[int, tuple[EnvSnapshot, int, int]] = {}
        for k, snapshot in enumerate(given):
            if snapshot is None:
                continue
            saved = EnvSnapshot.of_vector_bytes(f"snapshots[{k}]", snapshot)
            try:
                rows[k] = saved, *self._shelf.episode(saved.episode_id)
            except ConfigError as error:
                raise ConfigError(f"snapshots[{k}]: snapshot refused: {error}") from None
            self._runner.loaded(k, saved.parts)
        which = np.array([k in rows for k in range(self.num_envs)], np.bool_)
        with self._calling("restore"):
            running = {
                k: SavedWorld(
                    self._places.house(k),
                    seed,
                    self._runner.batch.snapshot(k),
                    self._runner.saved_parts(k),
                )
                for k in rows
                if (seed := self._seeds[k]) is not None and not self._stopped[k]
            }
            worlds = {
                k: SavedWorld(house, seed, saved.world, saved.parts)
                for k, (saved, house, seed) in rows.items()
            }
            self._runner.restore_all(worlds, running, self._places.move)
            self._stopped[which] = True
            for k, (saved, _, seed) in rows.items():
                self._seeds[k], self._streams[k], self._done[k] = seed, saved.stream, saved.done
            self._episode_infos = None
            self._look_ahead(which)
            self._runner.observe(which)
            self._stopped[which] = False
        return self._observation(), self._ids()

    def stated_episode(self, env: int) -> dict[str, Any] | None:
        """What an environment's episode states of its start and goal; ``None``: all was drawn."""
        k = integer_in_range("env", env, high=self.num_envs - 1)
        seed = self._seeds[k]
        return None if seed is None else self._shelf.stated(self._places.house(k), seed)

    def world(self, env: int) -> World:
        """The world of an environment; see :attr:`DwellEnv.world`.

        It goes with the environment into the houses of later episodes: ``house`` is that of now.
        """
        self._refuse_closed()
        return self._runner.world(integer_in_range("env", env, high=self.num_envs - 1))

    def fork(self) -> DwellVectorEnv:
        """Other environments at the same moments of their episodes, which all have begun."""
        return cast("DwellVectorEnv", forked(self))

    def expert_actions(self) -> Any:  # noqa: ANN401 - of the action space
        """The actions of the task's scripted expert now, an element of the action space."""
        return self._runner.expert(self._actions)

    def state_hashes(self) -> list[int]:
        """The state hash of every environment."""
        return [self._runner.batch.state_hash(k) for k in range(self.num_envs)]

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """The agents' views, (240, 320, 3) uint8 each; ``None`` without a render mode."""
        self._refuse_closed()
        if self.render_mode is None:
            return None
        view = {"camera": camera_settings("camera", RENDER_CAMERA)}
        return tuple(self._runner.batch.render(k, view) for k in range(self.num_envs))

    def close_extras(self, **kwargs: Any) -> None:  # noqa: ANN401 - gymnasium's signature
        """Closes the worlds; after it everything but ``close`` is refused."""
        self._drop()
