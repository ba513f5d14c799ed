"""Episodes are recorded while they are played."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from dwell import ConfigError, UsageError, __version__
from dwell.arguments import path
from dwell.envs.single import DwellEnv
from dwell.replays import MOST_STEPS, Replay


class ReplayRecorder(gymnasium.Wrapper[dict[str, Any], np.int64, dict[str, Any], np.int64]):
    """Writes every episode of an environment into a folder, as ``episode_0000.replay`` and so on.

    A file is written when its episode ends, when the next one begins, or at ``close``; numbers go
    on behind the files that are there, also where several processes record into one folder. Where
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
        self, env: gymnasium.Env[dict[str, Any], np.int64], folder: str | os.PathLike[str]
    ) -> None:
        """Wraps an environment of dwell, whatever other wrappers are around it.

        Raises:
            ConfigError: It is none of dwell, or its house or head cannot be named in a file.
        """
        super().__init__(env)
        if not isinstance(env.unwrapped, DwellEnv):
            raise ConfigError(f"env is {env!r}; expected an environment of dwell")
        self._env = env.unwrapped
        self._env._refuse_what_files_cannot_name()
        self._folder = Path(path("folder", folder))
        self._running: Replay | None = None
        self._actions: list[str] = []
        self._hashes: list[str] = []
        self._success = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode; the one before is written."""
        self._write()
        observation, info = self.env.reset(seed=seed, options=options)
        self._running = Replay(
            house=str(info["scene_id"]),
            seed=int(str(info["episode_id"]).rpartition("#")[2]),
            config=self._env._config,
            parts=tuple(self._env._part_names()),
            actions=(),
            hashes=(),
            instruction=self._env.instruction(),
            success=False,
            made_by=__version__,
        )
        self._actions, self._hashes, self._success = [], [self._hash()], False
        return observation, info

    def step(self, action: np.int64) -> tuple[dict[str, Any], Any, bool, bool, dict[str, Any]]:
        """Makes a step.

        Raises:
            UsageError: Something else changed the world since the last step, such as a restored
                snapshot; no file can hold that. Or the episode is longer than any file holds.
            OSError: The episode ended and cannot be written; it is kept.
        """
        if self._running is not None and self._hash() != self._hashes[-1]:
            self._running = None
            raise UsageError(
                "the world was changed since the last step by something else than an action; its "
                "episode cannot be recorded further; reset begins another"
            )
        if self._running is not None and len(self._actions) == MOST_STEPS:
            self._write()
            raise UsageError(
                f"{MOST_STEPS} steps are written, all that a file holds; reset begins another"
            )
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._actions.append(self._env.actions()[int(action)])
        self._hashes.append(self._hash())
        self._success = bool(info["success"])
        if terminated or truncated:
            self._write()
        return observation, reward, terminated, truncated, info

    def close(self) -> None:
        """Writes the episode that runs, and closes the environment."""
        self._write()
        super().close()

    def _hash(self) -> str:
        return f"{self._env.state_hash():016x}"

    def _write(self) -> None:
        if self._running is not None and self._actions:
            replay = dataclasses.replace(
                self._running,
                actions=tuple(self._actions),
                hashes=tuple(self._hashes),
                success=self._success,
            )
            write_numbered(replay, self._folder)
        self._running = None


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
