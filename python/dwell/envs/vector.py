"""Several environments in one call, rendered in one submission."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

import numpy as np
from gymnasium.utils import EzPickle
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, _native
from dwell.arguments import mapping, refuse_unknown, whole
from dwell.envs.config import Houses, HouseShelf, arguments_of, env_json
from dwell.envs.custom import RewardChoice, Sensors, TaskChoice, split
from dwell.envs.runner import INFO_KEYS, Runner
from dwell.envs.saved import Saved
from dwell.envs.spaces import action_space
from dwell.settings import Laws, with_head


class DwellVectorEnv(VectorEnv[dict[str, Any], NDArray[np.int64], NDArray[Any]], EzPickle):
    """``num_envs`` environments stepped together; number k plays in house k modulo their number.

    Observations are the environments' own buffers: copy what must outlive the next step, or say
    ``copy=True``. A pickle holds the arguments, as that of a single environment.
    """

    def __init__(
        self,
        num_envs: int = 1,
        task: TaskChoice = "InstructionFollowing",
        *,
        houses: Houses = "builtin:apartment",
        sensors: Sensors = None,
        reward: RewardChoice = None,
        laws: Laws = None,
        parameters: Mapping[str, float] | None = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        world: Mapping[str, Any] | None = None,
        threads: int | None = None,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = False,
        overlap: bool = False,
        render_mode: str | None = None,
        **unknown: NoReturn,
    ) -> None:
        """Makes the environments; arguments as :class:`dwell.envs.DwellEnv`.

        Args:
            num_envs: How many.
            task: The task's name, or a subclass of :class:`dwell.Task`.
            houses: A HOUSE string or a :class:`dwell.House`, or several.
            sensors: Names of sensors, or settings by name; subclasses of :class:`dwell.Sensor`.
            reward: A subclass of :class:`dwell.Reward`.
            laws: Laws to install, or what calibration found.
            parameters: Values by address.
            task_settings: The task's own settings.
            stride: How far movement actions go.
            world: Further fields of the native WorldConfig.
            threads: How many threads to use; results do not depend on it.
            max_episode_steps: Steps after which an episode is truncated; ``None`` or -1: never.
            autoreset_mode: ``NextStep``, ``SameStep`` or ``Disabled``.
            copy: Whether observations are copies.
            overlap: Whether a graphics adapter takes the pictures of environments that have stepped
                while others still step. Observations are the same, of the same step; without an
                adapter nothing changes.
            render_mode: ``None``; single environments render.
            **unknown: There are no others; such are refused with the nearest names.
        """
        refuse_unknown("DwellVectorEnv", unknown, arguments_of(DwellVectorEnv))
        EzPickle.__init__(
            self,
            num_envs,
            task,
            houses=houses,
            sensors=sensors,
            reward=reward,
            laws=laws,
            parameters=parameters,
            task_settings=task_settings,
            stride=stride,
            world=world,
            threads=threads,
            max_episode_steps=max_episode_steps,
            autoreset_mode=autoreset_mode,
            copy=copy,
            overlap=overlap,
            render_mode=render_mode,
        )
        num_envs = whole("num_envs", num_envs, low=1, high=65_536)
        if render_mode is not None:
            raise ConfigError(f"render_mode: found {render_mode!r}, allowed is None")
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"autoreset_mode": self.autoreset_mode, "render_modes": []}
        world, heads = with_head(world)
        native, custom = split(task, task_settings, reward, sensors)
        config = env_json(native, laws=laws, parameters=parameters, stride=stride, world=world)
        shelf = HouseShelf(houses)
        threads = None if threads is None else whole("threads", threads, low=1)
        if not isinstance(overlap, bool):
            raise ConfigError(f"overlap: found {overlap!r}, allowed are True and False")
        rows = [shelf[k] for k in range(num_envs)]
        self._shelf = shelf
        self._runner = Runner(rows, config, threads, custom=custom, overlap=overlap, heads=heads)
        self._limit = max_episode_steps if max_episode_steps and max_episode_steps > 0 else None
        self._copy = copy
        self._streams: list[np.random.Generator | None] = [None] * num_envs
        #: The seed of every environment's episode, once it has one.
        self._seeds: list[int | None] = [None] * num_envs
        self._steps = np.zeros(num_envs, np.int64)
        self._done = np.ones(num_envs, np.bool_)
        #: Whose latest reset did not come to its end.
        self._stopped = np.zeros(num_envs, np.bool_)
        self.single_observation_space = self._runner.space
        self.single_action_space = action_space()
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def _observation(self) -> dict[str, Any]:
        now = self._runner.observation()
        if not self._copy:
            return now
        return {
            key: value if isinstance(value, tuple) else value.copy() for key, value in now.items()
        }

    def _start(self, which: NDArray[np.bool_], asked: Sequence[int | None] | None = None) -> None:
        """Begins episodes: of the seeds in ``asked`` where there are some, else of drawn ones."""
        seeds = [
            int(stream.integers(2**63)) if start and stream is not None else None
            for stream, start in zip(self._streams, which, strict=True)
        ]
        for k, seed in enumerate(asked or ()):
            seeds[k] = seeds[k] if seed is None else seed
        self._stopped[which] = True
        self._runner.reset(seeds)
        for k in np.flatnonzero(which).tolist():
            self._seeds[k] = seeds[k]
        self._steps[which] = 0
        self._done[which] = False
        self._stopped[which] = False

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
                same episodes again; ``None`` where one is drawn.

        Returns:
            Observations and infos: ``scene_id`` and ``episode_id`` of every environment.
        """
        self._refuse_closed()
        options = {} if options is None else mapping("options", options)
        if unknown := sorted(set(options) - {"reset_mask", "episode_id"}):
            raise ConfigError(f"options: no {unknown[0]!r}; allowed are reset_mask and episode_id")
        mask = options.get("reset_mask")
        which = np.ones(self.num_envs, np.bool_) if mask is None else np.asarray(mask)
        if which.shape != (self.num_envs,) or which.dtype != np.bool_ or not which.any():
            raise ConfigError(
                f"reset_mask: expected bool of shape ({self.num_envs},) with a true element, "
                f"found {which.dtype} of shape {which.shape}"
            )
        seeds: list[int | None] = [None] * self.num_envs
        if isinstance(seed, int | np.integer):
            seeds = [whole("seed", seed) + k for k in range(self.num_envs)]
        elif seed is not None:
            try:
                given = list(seed)
            except TypeError:
                expected = "expected a whole number, or one for each environment"
                raise ConfigError(f"seed is {seed!r}; {expected}") from None
            seeds = [None if one is None else whole("seed", one) for one in given]
            if len(seeds) != self.num_envs:
                raise ConfigError(f"seed: expected {self.num_envs} seeds, found {len(seeds)}")
        asked = self._asked(options.get("episode_id"), which)
        for k in np.flatnonzero(which):
            if seeds[k] is not None or self._streams[k] is None:
                self._streams[k] = np.random.default_rng(seeds[k])
        self._start(which, asked)
        self._runner.observe(which)
        return self._observation(), self._ids()

    def _asked(self, episodes: object, which: NDArray[np.bool_]) -> list[int | None]:
        """The seeds of the episodes that are asked for by their ids."""
        expected = f"expected one for each of {self.num_envs} environments, or None"
        if episodes is None:
            return [None] * self.num_envs
        if isinstance(episodes, str) or not isinstance(episodes, Sequence | np.ndarray):
            raise ConfigError(f"episode_id is {episodes!r}; {expected}")
        if len(episodes) != self.num_envs:
            raise ConfigError(f"episode_id: found {len(episodes)}; {expected}")
        return [
            None if one is None or not which[k] else self._seed_of(k, one)
            for k, one in enumerate(episodes)
        ]

    def _seed_of(self, env: int, episode_id: object) -> int:
        """The seed of an episode of an environment, by its id."""
        house, seed = self._shelf.episode(episode_id)
        if self._shelf.names[house] != self._scene(env):
            raise ConfigError(
                f"episode_id is {episode_id!r}; environment {env} plays in {self._scene(env)!r}"
            )
        return seed

    def _scene(self, env: int) -> str:
        return self._shelf.names[env % len(self._shelf.names)]

    def _ids(self) -> dict[str, Any]:
        """``scene_id`` and ``episode_id`` of every environment that has an episode, for infos."""
        has = np.array([seed is not None for seed in self._seeds], np.bool_) & ~self._stopped
        scenes, episodes = (np.full(self.num_envs, None, object) for _ in range(2))
        for k in np.flatnonzero(has).tolist():
            scenes[k] = self._scene(k)
            episodes[k] = self._shelf.episode_id(k, self._seeds[k] or 0)
        return {
            "scene_id": scenes,
            "_scene_id": has,
            "episode_id": episodes,
            "_episode_id": has.copy(),
        }

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[
        dict[str, Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Makes one control step in every environment.

        ``infos`` hold what a single environment's ``info`` does; ``distance_to_goal``, ``spl`` and
        ``soft_spl`` are NaN where the task has no goal.
        """
        self._refuse_closed()
        if any(stream is None for stream in self._streams):
            raise UsageError("step: no episode has begun; call reset first")
        if self._stopped.any():
            which = np.flatnonzero(self._stopped).tolist()
            raise UsageError(f"step: no episode of environments {which} has begun; reset them")
        try:
            numbers = np.asarray(actions)
        except ValueError:
            raise ConfigError(
                f"actions are {actions!r}; expected whole numbers of shape ({self.num_envs},)"
            ) from None
        if numbers.shape != (self.num_envs,) or numbers.dtype.kind not in "iu":
            raise ConfigError(
                f"actions: expected whole numbers of shape ({self.num_envs},), "
                f"found {numbers.dtype} of shape {numbers.shape}"
            )
        last = len(_native.actions()) - 1
        if not ((numbers >= 0) & (numbers <= last)).all():
            raise ConfigError(f"actions are {numbers.tolist()}; allowed are 0 to {last}")
        begins = self._done.copy()
        if begins.any() and self.autoreset_mode is not AutoresetMode.NEXT_STEP:
            which = np.flatnonzero(begins).tolist()
            raise UsageError(f"environments {which} have ended; reset them with reset_mask first")
        if begins.any():
            self._start(begins)
        answer, further = self._runner.step(np.where(begins, -1, numbers.astype(np.int64)))
        self._steps[~begins] += 1
        rewards = np.asarray(answer["reward"], np.float64)
        terminated = np.asarray(answer["terminated"], np.bool_)
        truncated = np.zeros(self.num_envs, np.bool_)
        if self._limit is not None:
            truncated = (self._steps >= self._limit) & ~terminated & ~begins
        self._runner.observe(np.ones(self.num_envs, np.bool_))
        stepped = ~begins
        infos: dict[str, Any] = {}
        for key in INFO_KEYS:
            infos[key] = np.asarray(answer[key])
            infos[f"_{key}"] = stepped
        infos["action_error"] = np.array(answer["action_error"], object)
        infos["_action_error"] = stepped
        infos["audio_clipped"] = np.array(self._runner.batch.clipped(), np.int64)
        infos["_audio_clipped"] = np.ones(self.num_envs, np.bool_)
        infos |= self._ids()
        for k, row in enumerate(further):
            infos = self._add_info(infos, dict(row), k)
        self._done = terminated | truncated
        if self._done.any() and self.autoreset_mode is AutoresetMode.SAME_STEP:
            own = [key for key in infos if key not in (*INFO_KEYS, "action_error", "audio_clipped")]
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
        for key in (*INFO_KEYS, "action_error", *own):
            final_info |= {key: infos[key].copy(), f"_{key}": ended}
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
        rows = []
        for k, (seed, stream) in enumerate(zip(self._seeds, self._streams, strict=True)):
            if seed is None or stream is None or self._stopped[k]:
                raise UsageError(f"snapshot: no episode of environment {k} has begun; reset it")
            saved = Saved(
                episode_id=self._shelf.episode_id(k, seed),
                steps=int(self._steps[k]),
                done=bool(self._done[k]),
                stream=stream,
                parts=self._runner.saved_parts(k),
                world=self._runner.batch.snapshot(k),
            )
            rows.append(saved.to_bytes())
        return rows

    def restore(self, snapshots: Sequence[bytes | None]) -> tuple[dict[str, Any], dict[str, Any]]:
        """Lets environments go to where snapshots were taken; the next steps give the same bits.

        A snapshot may go to another environment of the same house, and to several.

        Args:
            snapshots: One for each environment; ``None`` leaves it where it is.

        Returns:
            Observations of that moment, and infos as :meth:`reset` gives.

        Raises:
            ConfigError: They are not one for each, or one is of something else. Nothing has changed
                then, unless the engine refuses a damaged world: the environments that were given
                snapshots want a reset afterwards.
        """
        self._refuse_closed()
        given: object = snapshots
        if not isinstance(given, list | tuple) or len(given) != self.num_envs:
            raise ConfigError(
                f"snapshots is {given!r:.60}; expected a list of {self.num_envs}: bytes, or None, "
                "for each environment"
            )
        rows: dict[int, tuple[Saved, int]] = {}
        for k, snapshot in enumerate(given):
            if snapshot is None:
                continue
            saved = Saved.of_bytes(f"snapshots[{k}]", snapshot)
            rows[k] = saved, self._seed_of(k, saved.episode_id)
            self._runner.loaded(k, saved.parts)
        which = np.array([k in rows for k in range(self.num_envs)], np.bool_)
        self._stopped[which] = True
        for k, (saved, seed) in rows.items():
            self._runner.restore(saved.world, saved.parts, seed, env=k)
            self._seeds[k], self._streams[k] = seed, saved.stream
            self._steps[k], self._done[k] = saved.steps, saved.done
        self._stopped[which] = False
        self._runner.observe(which)
        return self._observation(), self._ids()

    def _refuse_closed(self) -> None:
        if self.closed:
            raise UsageError("these environments are closed; make new ones")

    def expert_actions(self) -> NDArray[np.int64]:
        """What the task's scripted expert would do now, in every environment."""
        return self._runner.expert_actions()

    def state_hashes(self) -> list[int]:
        """The state hash of every environment."""
        return [self._runner.batch.state_hash(k) for k in range(self.num_envs)]

    def close_extras(self, **kwargs: Any) -> None:  # noqa: ANN401 - gymnasium's signature
        """Nothing to let go of: the worlds go with the object."""
