"""Recording of episodes while they are played."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping, MutableMapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import gymnasium
import numpy as np
from gymnasium.vector import VectorEnv, VectorWrapper
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, __version__
from dwell.arguments import file_path, quoted
from dwell.envs.action_modes import EngineActions
from dwell.envs.config import HouseCache
from dwell.envs.single import DwellEnv
from dwell.envs.vector import DwellVectorEnv
from dwell.files import make_folder
from dwell.heads import Head
from dwell.replays import MAX_STEPS, Replay
from dwell.stated_episodes import seed_of


class RunningEpisode(Protocol):
    """An episode that is being recorded."""

    #: What changes its world, in a word.
    acts: str

    @property
    def last_hash(self) -> str:
        """Of the world after the last step, as files hold it."""

    @property
    def is_full(self) -> bool:
        """True if no file holds a further step."""

    def write(self, folder: Path) -> Path | None:
        """Writes the steps so far, if there are any."""


def cut_short(
    running: RunningEpisode, state_hash: int, folder: Path, whose: str = ""
) -> str | None:
    """Why an episode cannot be recorded further, once its steps so far are written.

    Args:
        running: The episode.
        state_hash: Of its world as it is now.
        folder: Takes the file.
        whose: Of which of several environments.

    Returns:
        A sentence; ``None`` where the next step can be recorded.

    Raises:
        OSError: It cannot be written.
    """
    if f"{state_hash:016x}" != running.last_hash:
        why = (
            f"the world{whose} was changed since the last step by something else than "
            f"{running.acts} (also by listen, which opens ears: name the sensor audio instead); "
            "its episode cannot be recorded further"
        )
    elif running.is_full:
        why = f"the episode{whose} has {MAX_STEPS} steps, all that a file holds"
    else:
        return None
    file = running.write(folder)
    kept = "no step was made before" if file is None else f"the steps before are written in {file}"
    return f"{why}; {kept}; reset begins another"


class _EpisodeInProgress:
    """An episode of one agent that is being recorded."""

    acts = "an action"

    def __init__(
        self,
        env: DwellEnv | DwellVectorEnv,
        info: Mapping[str, Any],
        instruction: str,
        state_hash: int,
        stated: Mapping[str, Any] | None,
    ) -> None:
        self._replay = Replay(
            house=str(info["scene_id"]),
            seed=seed_of(str(info["episode_id"])),
            stated=stated,
            config=env._config,
            parts=tuple(env._custom.part_names()),
            actions=(),
            hashes=(),
            instruction=instruction,
            success=False,
            made_by=__version__,
        )
        self._actions: list[str | dict[str, Any]] = []
        self._hashes = [f"{state_hash:016x}"]
        self._success = False

    def stepped(self, action: str | dict[str, Any], state_hash: int, success: bool) -> None:
        """A step was made, by an action as files hold it."""
        self._actions.append(action)
        self._hashes.append(f"{state_hash:016x}")
        self._success = success

    def write(self, folder: Path) -> Path | None:
        """Writes the steps so far, if there are any."""
        if not self._actions:
            return None
        replay = dataclasses.replace(
            self._replay,
            actions=tuple(self._actions),
            hashes=tuple(self._hashes),
            success=self._success,
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


def write_numbered(replay: Replay, folder: Path) -> Path:
    """Writes an episode as the next ``episode_NNNN.replay`` of a folder.

    Others, of this process or not, may write into the folder at the same time: each episode gets a
    number of its own.

    Raises:
        OSError: The system refuses; nothing was written.
    """
    number = sum(1 for _ in folder.glob("episode_*.replay"))
    while True:
        file = folder / f"episode_{number:04}.replay"
        try:
            if not os.path.lexists(file):
                replay.write(file, new=True)
                return file
        except FileExistsError:
            # Somebody was quicker.
            pass
        except OSError as error:
            kept = f"{len(replay.actions)} steps are kept, and the next reset or close writes them"
            error.strerror = f"{error.strerror}; {kept}"
            raise
        number += 1


def refuse_cut_short(
    all_running: MutableMapping[int, Any],
    number: int,
    running: RunningEpisode,
    state_hash: int,
    folder: Path,
) -> None:
    """Refuses one step of environments of which one's episode cannot be recorded further.

    Args:
        all_running: By environment; the one that is refused leaves them.
        number: Of the environment.
        running: Its episode.
        state_hash: Of its world as it is now.
        folder: Takes the file.

    Raises:
        UsageError: It cannot.
        OSError: It cannot be written; it is kept.
    """
    told = cut_short(running, state_hash, folder, f" of environment {number}")
    if told is not None:
        del all_running[number]
        raise UsageError(f"{told}, and until then its steps are made without a record")


class ReplayRecorder(gymnasium.Wrapper[dict[str, Any], Any, dict[str, Any], Any]):
    """Writes every episode of an environment into a folder, as ``episode_0000.replay`` and so on.

    A file is written when its episode ends, when the next one begins, or at ``close``; numbers go
    on behind the files that are there, also where several processes record into one folder. Where
    something else than a step changes the world, the steps before it are written, and every
    further one is refused until ``reset``. Where
    it cannot be written, as on a full disk, an ``OSError`` says so, and the episode is kept:
    ``reset`` and ``close`` write it once there is room. :class:`dwell.Replay` reads the files.

    Examples:
        >>> import tempfile
        >>> import dwell
        >>> from dwell.envs import DwellEnv, ReplayRecorder
        >>> folder = tempfile.mkdtemp()
        >>> env = ReplayRecorder(DwellEnv("Free", sensors=["gps"]), folder)
        >>> observation, info = env.reset(seed=1)
        >>> observation, *_ = env.step(1)
        >>> env.close()
        >>> replay = dwell.Replay.read(f"{folder}/episode_0000.replay")
        >>> replay.actions, replay.first_difference()
        (('move_forward',), None)
    """

    def __init__(
        self, env: gymnasium.Env[dict[str, Any], Any], folder: str | os.PathLike[str]
    ) -> None:
        """Wraps an environment of dwell, whatever other wrappers are around it.

        Raises:
            ConfigError: It is none of dwell, or its house or head cannot be named in a file.
            OSError: The folder is none, or cannot be made.
        """
        given: object = env
        if isinstance(given, VectorEnv):
            raise ConfigError(f"env is {env!r}; VectorReplayRecorder records such environments")
        if not isinstance(given, gymnasium.Env) or not isinstance(env.unwrapped, DwellEnv):
            raise ConfigError(
                f"env is {quoted(env)}; expected an environment of dwell with one agent; "
                "dwell.pettingzoo.ParallelReplayRecorder records several"
            )
        super().__init__(env)
        self._env = env.unwrapped
        refuse_what_files_cannot_name(self._env)
        self._folder = Path(file_path("folder", folder)).absolute()
        make_folder(self._folder)
        self._running: _EpisodeInProgress | None = None
        #: Why no further step of the episode is recorded.
        self._cut_short: str | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode; the one before is written."""
        self._write()
        observation, info = self.env.reset(seed=seed, options=options)
        instruction, state_hash = self._env.instruction(), self._env.state_hash()
        stated = self._env.stated_episode()
        self._cut_short = None
        self._running = _EpisodeInProgress(self._env, info, instruction, state_hash, stated)
        return observation, info

    def step(
        self,
        action: Any,  # noqa: ANN401 - of the action space
    ) -> tuple[dict[str, Any], Any, bool, bool, dict[str, Any]]:
        """Makes a step.

        Raises:
            UsageError: Something else changed the world since the last step, such as a restored
                snapshot; no file can hold that. Or the episode is longer than any file holds. The
                steps before are written; until ``reset`` all further ones are refused.
            OSError: The episode ended and cannot be written; it is kept.
        """
        running = self._running
        if running is not None:
            self._cut_short = cut_short(running, self._env.state_hash(), self._folder)
        if self._cut_short is not None:
            self._running = None
            raise UsageError(self._cut_short)
        observation, reward, terminated, truncated, info = self.env.step(action)
        if running is not None:
            row = self._env._actions.one(action).row(0)
            running.stepped(row, self._env.state_hash(), bool(info["success"]))
        if terminated or truncated:
            self._write()
        return observation, reward, terminated, truncated, info

    def close(self) -> None:
        """Writes the episode that runs, and closes the environment."""
        self._write()
        super().close()

    def _write(self) -> None:
        if self._running is not None:
            self._running.write(self._folder)
        self._running = None


class VectorReplayRecorder(VectorWrapper[dict[str, Any], Any, dict[str, Any], Any, NDArray[Any]]):
    """Writes every episode of every environment of a :class:`DwellVectorEnv` into a folder.

    Each is a file of its own, ``episode_0000.replay`` and so on, in the order in which they end. A
    file is written when its episode ends, when the next one begins in its environment, or at
    ``close``; numbers go on behind the files that are there.

    Examples:
        >>> import tempfile
        >>> import dwell
        >>> from dwell.envs import DwellVectorEnv, VectorReplayRecorder
        >>> folder = tempfile.mkdtemp()
        >>> envs = VectorReplayRecorder(DwellVectorEnv(2, "Free", sensors=["gps"]), folder)
        >>> observations, infos = envs.reset(seed=1)
        >>> observations, *_ = envs.step([1, 2])
        >>> envs.close()
        >>> [dwell.Replay.read(f"{folder}/episode_000{k}.replay").actions for k in range(2)]
        [('move_forward',), ('turn_left',)]
    """

    def __init__(
        self,
        env: VectorEnv[dict[str, Any], Any, NDArray[Any]],
        folder: str | os.PathLike[str],
    ) -> None:
        """Wraps environments of dwell that step together, whatever other wrappers are around them.

        Raises:
            ConfigError: They are none of dwell, or their houses or head cannot be named in a file.
            OSError: The folder is none, or cannot be made.
        """
        given: object = env
        if not isinstance(given, VectorEnv) or not isinstance(env.unwrapped, DwellVectorEnv):
            raise ConfigError(f"env is {env!r}; expected a vector environment of dwell")
        super().__init__(env)
        self._envs = env.unwrapped
        refuse_what_files_cannot_name(self._envs)
        self._folder = Path(file_path("folder", folder)).absolute()
        make_folder(self._folder)
        self._running: dict[int, _EpisodeInProgress] = {}
        self._envs._recorders.append(self)

    def began(self, envs: Sequence[int]) -> None:
        """Episodes have begun in these environments; those before are written."""
        infos = self._envs._ids()
        for k in envs:
            self._write(k)
            info = {name: infos[name][k] for name in ("scene_id", "episode_id")}
            batch = self._envs._runner.batch
            self._running[k] = _EpisodeInProgress(
                self._envs,
                info,
                batch.instruction(k),
                batch.state_hash(k),
                self._envs.stated_episode(k),
            )

    def check(self) -> None:
        """A step is about to be made.

        Raises:
            UsageError: Something else changed a world since the last step, such as a restored
                snapshot; no file can hold that. Or an episode is longer than any file holds. The
                steps before are written; further ones go on, and are not recorded in this
                environment until its next episode.
            OSError: An episode cannot be written; it is kept.
        """
        batch = self._envs._runner.batch
        for k, running in [*self._running.items()]:
            refuse_cut_short(self._running, k, running, batch.state_hash(k), self._folder)

    def stepped(
        self,
        actions: EngineActions,
        success: NDArray[np.bool_],
        ended: NDArray[np.bool_],
    ) -> None:
        """A step was made; episodes that ended are written."""
        for k in np.flatnonzero(actions.numbers >= 0).tolist():
            if k in self._running:
                state_hash = self._envs._runner.batch.state_hash(k)
                self._running[k].stepped(actions.row(k), state_hash, bool(success[k]))
                if ended[k]:
                    self._write(k)

    def close(self, **kwargs: Any) -> None:  # noqa: ANN401 - gymnasium's signature
        """Writes the episodes that run, and closes the environments."""
        for k in [*self._running]:
            self._write(k)
        super().close(**kwargs)

    def _write(self, env: int) -> None:
        if env in self._running:
            self._running[env].write(self._folder)
            del self._running[env]


class _InNamedHouses(Protocol):
    """Environments with houses, whose agents may wear measured heads."""

    _shelf: HouseCache

    @property
    def _heads(self) -> Sequence[Head]: ...


def refuse_what_files_cannot_name(env: _InNamedHouses) -> None:
    """Refuses houses that were handed over as objects, and measured heads.

    Raises:
        ConfigError: A file cannot name one.
    """
    if env._shelf.has_objects:
        raise ConfigError(
            "houses: a house was handed over as an object, which a file cannot name; write it "
            "(house.write) and give its path"
        )
    if env._heads:
        raise ConfigError("world.sound_head: a file cannot hold a measured head")
