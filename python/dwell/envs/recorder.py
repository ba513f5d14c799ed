"""Episodes are recorded while they are played."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from dwell import ConfigError, UsageError, __version__
from dwell.arguments import path
from dwell.envs.single import DwellEnv
from dwell.replays import Replay


class ReplayRecorder(gymnasium.Wrapper[dict[str, Any], np.int64, dict[str, Any], np.int64]):
    """Writes every episode of an environment into a folder, as ``episode_0000.replay`` and so on.

    A file is written when its episode ends, when the next one begins, or at ``close``; numbers go
    on behind the files that are there. :class:`dwell.Replay` reads them.

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
                snapshot; no file can hold that.
        """
        if self._running is not None and self._hash() != self._hashes[-1]:
            self._running = None
            raise UsageError(
                "the world was changed since the last step by something else than an action; its "
                "episode cannot be recorded further; reset begins another"
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
        running, self._running = self._running, None
        if running is None or not self._actions:
            return
        number = sum(1 for _ in self._folder.glob("episode_*.replay"))
        while (file := self._folder / f"episode_{number:04}.replay").exists():
            number += 1
        Replay(
            **{
                **vars(running),
                "actions": tuple(self._actions),
                "hashes": tuple(self._hashes),
                "success": self._success,
            }
        ).write(file)
