"""A batch of native environments with its buffers: the common part of single and vector."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.envs.action_modes import ActionForm, AnsweredActions, EngineActions
from dwell.envs.asking import AskingActions
from dwell.envs.env_pool import PreparedEnv, add_heads, begun_as_stated
from dwell.envs.info_keys import GOAL_KEYS
from dwell.envs.python_tasks import PythonEpisode, PythonTask
from dwell.envs.saved_world import SavedWorld
from dwell.envs.sensor_errors import with_sensor
from dwell.envs.silence import SWS, silence_measures, success_when_silent
from dwell.envs.spaces import SensorSpace, shareable, specs
from dwell.heads import Head
from dwell.house import House
from dwell.world import World


class NativeBatch:
    """Native environments with their Python parts, and the arrays they write into."""

    def __init__(
        self,
        houses: Sequence[House],
        config: str,
        threads: int | None,
        *,
        custom: PythonTask | None = None,
        overlap: bool = False,
        heads: Sequence[Head] = (),
    ) -> None:
        """Builds the environments, one for each house of ``houses``; agents may wear ``heads``."""
        for house in houses:
            add_heads(house, heads)
        try:
            self.batch = _native.Batch([house.native for house in houses], config, threads, overlap)
        except ConfigError as error:
            raise with_sensor(error, houses[0], config) from None
        #: How many agents act in each environment; the rows of actions and answers are those of the
        #: first environment's agents, then those of the second's.
        self.agents = len(self.batch.agents())
        #: What is measured beside distance and path, keys of a step's answer.
        of_silence = silence_measures(config) if self.agents == 1 else []
        self.measures = [*self.batch.measures(), *of_silence]
        self.houses = [*houses]
        #: The worlds that were handed out, by environment: they go with it into other houses.
        self._worlds: list[weakref.WeakSet[World]] = [weakref.WeakSet() for _ in houses]
        self.count = len(houses)
        self.specs = specs(self.batch)
        self.buffers: list[NDArray[Any] | None] = [spec.buffer(self.count) for spec in self.specs]
        self.plays = (
            [PythonEpisode(self.batch, k, house, custom) for k, house in enumerate(houses)]
            if custom is not None and custom != PythonTask()
            else []
        )
        #: Whose each sensor is, by the agent's place.
        self._owners = self.batch.sensor_agents()
        #: The spaces of what each agent's sensors observe, by name.
        self.agent_spaces = [
            {spec.name: spec.space() for spec in self._specs_of(agent)}
            for agent in range(self.agents)
        ]
        native = self.agent_spaces[0]
        own = self.plays[0].spaces(native) if self.plays else {}
        own = {name: shareable(space) for name, space in own.items()}
        #: The space of one environment's observation.
        self.space = spaces.Dict({**native, **own})
        self._own: dict[str, Any] = {
            name: [""] * self.count
            if isinstance(space, spaces.Text)
            else np.zeros((self.count, *(space.shape or ())), space.dtype)
            for name, space in own.items()
        }

    def _specs_of(self, agent: int) -> list[SensorSpace]:
        return [
            spec for spec, owner in zip(self.specs, self._owners, strict=True) if owner == agent
        ]

    def move(self, env: int, spare: PreparedEnv) -> None:
        """Puts ``spare`` in the place of an environment, which is in another house from then on."""
        self.batch.replace_env(env, spare.native)
        self.houses[env] = spare.house
        for world in self._worlds[env]:
            world.house = spare.house
        if self.plays:
            self.plays[env].move(spare.house)

    def world(self, env: int) -> World:
        """The world of an environment, whose house is always the one that it is in."""
        made = World.of_env(self.houses[env], _native.World.of_env(self.batch, env))
        self._worlds[env].add(made)
        return made

    def reset(
        self,
        seeds: Sequence[int | None],
        begun: Collection[int] = (),
        stated: Sequence[Mapping[str, Any] | None] | None = None,
        place: Callable[[int], str | None] = lambda env: None,
    ) -> None:
        """Begins the episodes of seeds, one for each environment; ``None``: goes on.

        Args:
            seeds: The seeds.
            begun: The environments in which the engine has begun them already.
            stated: What each episode states of its start and goal, where it states anything.
            place: Gives file and line where an environment's episode states it.

        Raises:
            MeasuredDataError: An episode cannot begin as its file states it.
            ConfigError: Another one cannot begin.
        """

        def begin(envs: Sequence[int]) -> None:
            given = [seed if k in envs else None for k, seed in enumerate(seeds)]
            own = [one if k in envs else None for k, one in enumerate(stated or ())]
            self.batch.reset(given, own or None)

        left = [k for k, seed in enumerate(seeds) if seed is not None and k not in begun]
        begun_as_stated(begin, left, place)
        for play, seed in zip(self.plays, seeds, strict=False):
            if seed is not None:
                play.begin(seed)

    def loaded(self, env: int, parts: bytes) -> dict[str, dict[str, Any]] | None:
        """The states of the parts of an environment, out of its snapshot.

        Raises:
            ConfigError: They are of other parts, or were cut.
        """
        if self.plays:
            return self.plays[env].loaded(parts)
        if parts:
            raise ConfigError("snapshot refused: it is of an environment with parts in Python")
        return None

    def saved_parts(self, env: int) -> bytes:
        """The states of the parts of an environment as bytes; empty where there are none."""
        return self.plays[env].save() if self.plays else b""

    def restore(self, snapshot: bytes, parts: bytes, seed: int, *, env: int = 0) -> None:
        """Restores an environment's snapshot, of an episode of ``seed``."""
        states = self.loaded(env, parts)
        self.batch.restore(env, snapshot)
        if states is not None:
            self.plays[env].load(states, seed)

    def restore_all(
        self,
        saved: Mapping[int, SavedWorld],
        running: Mapping[int, SavedWorld],
        move: Callable[[Mapping[int, tuple[int, int | None]]], object],
    ) -> None:
        """Restores snapshots of environments, all of them or none.

        Args:
            saved: The snapshots.
            running: What the same environments are about now, where they have an episode.
            move: Puts environments into houses, as ``HouseAssignment.move`` does.

        Raises:
            ConfigError: The engine refuses one. The environments are in ``running`` then.
        """
        try:
            self._restore_worlds(saved, move)
        except ConfigError:
            self._restore_worlds(running, move)
            raise

    def _restore_worlds(
        self,
        saved: Mapping[int, SavedWorld],
        move: Callable[[Mapping[int, tuple[int, int | None]]], object],
    ) -> None:
        move({k: (one.house, None) for k, one in saved.items()})
        for k, one in saved.items():
            if self.plays:
                self.restore(one.world, one.parts, one.seed, env=k)
            else:
                self.batch.restore(k, one.world)

    def step(self, actions: EngineActions) -> tuple[dict[str, Any], list[Mapping[str, Any]]]:
        """One control step.

        Returns:
            The engine's answer, as changed by tasks in Python, and what these add to each info.
        """
        answer: dict[str, Any] = actions.step(self.batch)
        if SWS in self.measures:
            answer[SWS] = np.zeros(self.count, np.bool_)
        further = [
            play.judge(name, answer) if name else {}
            for play, name in zip(self.plays, actions.names() if self.plays else (), strict=False)
        ]
        # The engine's shares of a way that there is not are 0, as if it had been missed.
        aimless = np.isnan(answer["distance_to_goal"])
        for key in GOAL_KEYS:
            answer[key][aimless] = np.nan
        if SWS in self.measures:
            answer[SWS] = success_when_silent(self.batch, answer["success"])
        return answer, further

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions of the engine nothing known beforehand rules out, (row, action)."""
        return self.batch.action_masks().reshape(self.count * self.agents, -1)

    def expert_actions(self) -> NDArray[np.int64]:
        """The actions of the tasks' experts now, by the numbers that the engine has for them."""
        own = [play.expert() for play in self.plays]
        if own and None not in own:
            return np.array(own, np.int64)
        return self.batch.expert_actions()

    def expert(self, actions: ActionForm | AnsweredActions) -> Any:  # noqa: ANN401 - of the action space
        """The actions of the tasks' experts now, elements of the batched action space."""
        numbers = self.expert_actions()
        if isinstance(actions, AnsweredActions):
            answers = self.batch.expert_answers().reshape(self.count, -1)
            return actions.expert(numbers, answers)
        if isinstance(actions, AskingActions):
            return actions.expert(numbers, self.batch.expert_questions().reshape(self.count, -1))
        return actions.expert(numbers)

    def observe(self, which: NDArray[np.bool_]) -> None:
        """Writes the observations of the environments in ``which`` into the buffers."""
        self.batch.observe(which, self.buffers)
        for k in np.flatnonzero(which) if self._own else ():
            for name, value in self.plays[k].observe().items():
                self._own[name][k] = value

    def agent_observation(self, agent: int) -> dict[str, Any]:
        """An agent's buffers by name: arrays (count, *shape), reused later; texts in tuples."""
        rows = zip(self.specs, self._owners, self.buffers, strict=True)
        return {
            spec.name: tuple(self.batch.texts(k)) if buffer is None else buffer
            for k, (spec, owner, buffer) in enumerate(rows)
            if owner == agent
        }

    def observation(self) -> dict[str, Any]:
        """The first agent's :meth:`agent_observation`, with the sensors in Python."""
        native = self.agent_observation(0)
        own = {
            name: tuple(values) if isinstance(values, list) else values
            for name, values in self._own.items()
        }
        return {**native, **own}
