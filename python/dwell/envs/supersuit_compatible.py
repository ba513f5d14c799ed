"""Environments of several agents that step together, as SuperSuit hands them to one policy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, UsageError
from dwell.arguments import quoted
from dwell.envs.parallel_vector import DwellParallelVectorEnv
from dwell.envs.parallel_vector_recorder import ParallelVectorReplayRecorder

ByAgent = dict[str, dict[str, Any]]
Infos = list[dict[str, Any]]


class SuperSuitCompatible:
    """Each agent of each environment as a row of one vector environment.

    It keeps the contract of SuperSuit's ``MarkovVectorEnv``, so that its wrapper for
    Stable-Baselines3 takes it: ``observation_space`` and ``action_space`` are those of one agent,
    infos are a list, and environments whose episodes are over begin the next ones in the same step,
    with ``terminal_observation`` in the infos. Rows are those of environment 0, by agent, then of
    environment 1, and so on. The episodes of all agents of an environment end
    together.
    """

    def __init__(self, env: object) -> None:
        """Wraps environments that step together.

        Raises:
            ConfigError: They are none of :func:`dwell.pettingzoo.vector_env`, or the agents' spaces
                differ.
        """
        if not isinstance(env, DwellParallelVectorEnv | ParallelVectorReplayRecorder):
            raise ConfigError(f"env is {quoted(env)}; expected one of dwell.pettingzoo.vector_env")
        self.env = env
        self._names: list[str] = [*env.possible_agents]
        first = self._names[0]
        for kind, spaces in (
            ("observation", env.observation_spaces),
            ("action", env.action_spaces),
        ):
            if other := [name for name in self._names if spaces[name] != spaces[first]]:
                raise ConfigError(
                    f"agents: the {kind} space of {other[0]} is another than that of {first}; "
                    "one policy needs equal ones"
                )
        self.observation_space = self.single_observation_space = env.observation_spaces[first]
        self.action_space = self.single_action_space = env.action_spaces[first]
        self.num_envs = env.num_envs * len(self._names)
        self.render_mode = None
        self.metadata: dict[str, Any] = {"render_modes": []}
        self._actions: Any = None

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, Infos]:
        """Begins episodes in all environments.

        Returns:
            Observations of all rows, and infos of each.
        """
        observations, infos = self.env.reset(seed=seed, options=options)
        return self._joined([observations[name] for name in self._names]), self._listed(infos)

    def step(
        self,
        actions: Any,  # noqa: ANN401 - of the action space
    ) -> tuple[Any, NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_], Infos]:
        """Makes a step in all environments.

        Raises:
            UsageError: The episode of one agent of an environment ended before the others'.
            ConfigError: The actions are none.
        """
        count = len(self._names)
        given = {name: _part(actions, k, count) for k, name in enumerate(self._names)}
        observations, rewards, terminated, truncated, infos = self.env.step(given)
        cut = [np.logical_or(terminated[name], truncated[name]) for name in self._names]
        ended = np.stack(cut, axis=1)
        over: NDArray[np.bool_] = np.all(ended, axis=1)
        early = np.argwhere(ended & ~over[:, np.newaxis])
        if len(early):
            k, agent = (int(number) for number in early[0])
            raise UsageError(
                f"step: the episode of {self._names[agent]} ended before those of others in "
                f"environment {k}; leave stop out of actions, and give max_cycles"
            )
        rows = self._joined([observations[name] for name in self._names])
        listed = self._listed(infos)
        if over.any():
            for row in np.flatnonzero(np.repeat(over, count)).tolist():
                listed[row]["terminal_observation"] = _row(rows, row)
            begun, about = self.env.reset(options={"reset_mask": over})
            rows = self._joined([begun[name] for name in self._names])
            for row, info in enumerate(self._listed(about)):
                if over[row // count]:
                    listed[row] |= info
        paid = self._joined([rewards[name] for name in self._names]).astype(np.float32)
        ends = [
            self._joined([one[name] for name in self._names]) for one in (terminated, truncated)
        ]
        return rows, paid, ends[0], ends[1], listed

    def step_async(self, actions: Any) -> None:  # noqa: ANN401 - of the action space
        """Keeps the actions for :meth:`step_wait`."""
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[Any, NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_], Infos]:
        """Makes the step whose actions were given."""
        return self.step(self._actions)

    def env_is_wrapped(self, wrapper_class: object) -> list[bool]:
        """Whether a row's environment is wrapped in a class; none is."""
        del wrapper_class
        return [False] * self.num_envs

    def close(self) -> None:
        """Closes the environments."""
        self.env.close()

    def _joined(self, by_agent: Sequence[Any]) -> Any:  # noqa: ANN401 - an element of a batched space
        """What agents have, environment by environment."""
        first = by_agent[0]
        if isinstance(first, Mapping):
            return {key: self._joined([one[key] for one in by_agent]) for key in first}
        if isinstance(first, tuple):
            return tuple(item for items in zip(*by_agent, strict=True) for item in items)
        joined = np.stack(by_agent, axis=1)
        return joined.reshape(-1, *joined.shape[2:])

    def _listed(self, infos: ByAgent) -> Infos:
        """Infos of each row; what is masked as missing is left out."""
        rows: Infos = []
        for k in range(self.env.num_envs):
            for name in self._names:
                own = infos[name]
                told = {
                    key: value[k]
                    for key, value in own.items()
                    if not key.startswith("_") and bool(own.get(f"_{key}", _ALWAYS)[k])
                }
                rows.append(told)
        return rows


class _Always:
    """A mask of what is always there."""

    def __getitem__(self, row: int) -> bool:
        return True


_ALWAYS = _Always()


def _part(actions: Any, agent: int, count: int) -> Any:  # noqa: ANN401 - of the action space
    """The actions of one agent in all environments."""
    if isinstance(actions, Mapping):
        return {key: _part(own, agent, count) for key, own in actions.items()}
    return actions[agent::count]


def _row(rows: Any, row: int) -> Any:  # noqa: ANN401 - an element of a batched space
    """One row of batched observations."""
    if isinstance(rows, Mapping):
        return {key: _row(own, row) for key, own in rows.items()}
    return rows[row]
