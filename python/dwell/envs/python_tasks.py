"""Tasks, rewards and sensors that are written in Python, on native environments."""

from __future__ import annotations

import base64
import binascii
import dataclasses
import functools
import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, _native
from dwell.arguments import (
    boolean,
    finite_number,
    from_json,
    integer_in_range,
    mapping,
    quoted,
    refuse_no_array,
    sequence_items,
    text,
    to_json,
)
from dwell.envs.info_keys import EPISODE_KEYS
from dwell.episodes import task_of
from dwell.house import House
from dwell.plugin_parts import claim_part, factory
from dwell.rewards import Reward
from dwell.sensors import Sensor
from dwell.tasks import StepResult, Task, TaskGoal
from dwell.world import World

#: By name, or what makes a task of one's own: a class, a function or ``"module:Name"``.
TaskChoice = str | Callable[..., Task]
#: What makes a reward of one's own.
RewardChoice = str | Callable[[], Reward] | None
#: Names of sensors and what makes sensors of one's own; or settings or such a maker by name.
Sensors = (
    Sequence[str | Callable[[], Sensor]]
    | Mapping[str, Mapping[str, Any] | Callable[[], Sensor]]
    | None
)

#: Names of the engine's sensors, or their settings by name.
NativeSensors = Sequence[str] | Mapping[str, Mapping[str, Any]] | None

_SENSORS_EXPECTED = (
    "expected names of sensors, subclasses of dwell.Sensor or 'module:Name' of one; settings are "
    "given by name, as sensors={'rgb': {'width': 64}}"
)

#: Streams of random numbers of an episode: the task's, and from the next number on the sensors'.
_TASK_STREAM = 0
#: What a snapshot calls the latest observations beside the states of parts.
_OBSERVED = "observed"
#: The spaces that sensors can have, each with arrays or text as elements.
_SPACES = (spaces.Box, spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary, spaces.Text)


@dataclasses.dataclass(frozen=True)
class PythonTask:
    """The factories of an environment's parts in Python; empty for most."""

    task: Callable[[], Task] | None = None
    reward: Callable[[], Reward] | None = None
    sensors: tuple[Callable[[], Sensor], ...] = ()

    def part_names(self) -> list[str]:
        """The names of the classes of task and reward, where they are written in Python."""
        return [type(make()).__name__ for make in (self.task, self.reward) if make is not None]


@dataclasses.dataclass(frozen=True)
class NativeSettings:
    """The engine's settings of task and sensors."""

    task: str
    settings: Mapping[str, Any] | None = None
    sensors: NativeSensors = None


def split(
    task: TaskChoice,
    settings: Mapping[str, Any] | None,
    reward: RewardChoice,
    sensors: Sensors,
) -> tuple[NativeSettings, PythonTask]:
    """Separates the engine's settings from the parts that are played in Python."""
    make_task, own_sensors = None, None
    if not isinstance(task, str) or ":" in task:
        make_task = factory("task", task, Task, settings)
        one = make_task()
        task, settings = text("task.base", one.base), one.base_settings
        task_of(task, f"{type(one).__name__}.base")
        integer_in_range(f"{type(one).__name__}.max_steps", one.max_steps, low=1)
        # Also those that are not used: whoever writes a task shall see that they are none.
        own_sensors = _sensors(f"{type(one).__name__}.sensors", one.sensors)
    else:
        task_of(task)
    names, own = _sensors("sensors", sensors)
    if sensors is None and own_sensors is not None:
        names, own = own_sensors
    make_reward = None if reward is None else factory("reward", reward, Reward)  # type: ignore[type-abstract] # its kind
    return NativeSettings(task, settings, names), PythonTask(make_task, make_reward, own)


def _sensors(
    at: str,
    sensors: Sensors,
) -> tuple[NativeSensors, tuple[Callable[[], Sensor], ...]]:
    if sensors is None:
        return None, ()
    own: list[Callable[[], Sensor]] = []
    if isinstance(sensors, Mapping):
        settings = {}
        for name, row in mapping(at, sensors).items():
            if callable(row) or isinstance(row, str):
                own.append(_named(name, factory(f"{at}.{name}", row, Sensor)))  # type: ignore[type-abstract]
            else:
                settings[name] = row
        return settings, tuple(own)
    if isinstance(sensors, str):
        return sensors, ()
    rows = sequence_items(at, sensors, _SENSORS_EXPECTED)
    names = []
    for k, row in enumerate(rows):
        if not isinstance(row, str) and not callable(row) and not isinstance(row, Sensor):
            raise ConfigError(f"{at}[{k}] is {quoted(row)}; {_SENSORS_EXPECTED}")
        if not isinstance(row, str) or ":" in row:
            own.append(factory(f"{at}[{k}]", row, Sensor))  # type: ignore[type-abstract]
        else:
            names.append(row)
    return names, tuple(own)


def _named(name: str, make: Callable[[], Sensor]) -> Callable[[], Sensor]:
    def made() -> Sensor:
        sensor = make()
        sensor.name = name
        return sensor

    return made


class PythonEpisode:
    """The Python parts of one environment, and the world that they look at."""

    def __init__(self, batch: _native.Batch, env: int, house: House, custom: PythonTask) -> None:
        """Makes the parts of environment ``env``.

        Raises:
            ConfigError: One is a part of another environment.
        """
        self._batch = batch
        self._env = env
        self._custom = custom
        self._world = World.of_env(house, _native.World.of_env(batch, env))
        self._task = None if custom.task is None else custom.task()
        self._reward = None if custom.reward is None else custom.reward()
        self.sensors = [make() for make in custom.sensors]
        self._seed = 0
        #: What was observed last; ``None`` where something has happened since.
        self._seen: dict[str, Any] | None = None
        #: Whether that came with a snapshot and nobody has been given it.
        self._is_restored = False
        agent = batch.agents()[0]
        for part in (*self.sensors, self._task, self._reward):
            if part is not None:
                claim_part(part, self, self._is_same_env)
                if agent:
                    part.agent = agent

    def _is_same_env(self, other: PythonEpisode) -> bool:
        """Whether another is of the same environment, in another house: one plays at a time."""
        return other._custom is self._custom and other._env == self._env

    def move(self, house: House) -> None:
        """Moves the environment into another house; parts may have kept the world."""
        self._world.house = house

    def _parts(self) -> dict[str, Task | Reward | Sensor]:
        parts: dict[str, Task | Reward | Sensor] = {
            f"sensor {sensor.name}": sensor for sensor in self.sensors
        }
        if self._task is not None:
            parts["task"] = self._task
        if self._reward is not None:
            parts["reward"] = self._reward
        return parts

    def begin(self, seed: int) -> None:
        """Begins the episode of a seed, after the engine has."""
        self._seed = seed
        self._seen, self._is_restored = None, False
        for part in self._parts().values():
            part.state = {}
        if self._task is not None:
            self._ask(self._task.reset(self._world, self._rng(_TASK_STREAM)))
        if self._reward is not None:
            self._reward.reset(self._world)
        for sensor in self.sensors:
            sensor.reset(self._world)

    def _ask(self, asked: object) -> None:
        if asked is None:
            self._batch.set_goal(self._env)
            return
        if not isinstance(asked, TaskGoal):
            raise ConfigError(
                f"{self._name()}.reset gave {quoted(asked)}; expected a dwell.TaskGoal or None"
            )
        distance_m = asked.distance_m
        if distance_m is not None:
            distance_m = finite_number("distance_m", distance_m)
        self._batch.set_goal(self._env, text("instruction", asked.instruction), distance_m)

    def _name(self) -> str:
        return type(self._task).__name__

    def _rng(self, *stream: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self._seed, spawn_key=stream))

    def judge(self, action: str, answer: dict[str, Any]) -> Mapping[str, Any]:
        """Judges a step in place of the engine, whose ``answer`` it changes; gives further info."""
        k = self._env
        self._seen, self._is_restored = None, False
        if self._task is None and self._reward is None:
            return {}
        distance_m = float(answer["distance_to_goal"][k])
        verdict = StepResult(
            reward=float(answer["reward"][k]),
            terminated=bool(answer["terminated"][k]),
            success=bool(answer["success"][k]),
            distance_m=None if math.isnan(distance_m) else distance_m,
        )
        if self._task is not None:
            verdict = _checked(self._name(), self._task.judge(self._world, action, verdict))
        reward = verdict.reward
        if self._reward is not None:
            reward = finite_number("reward", self._reward.reward(self._world, action, verdict))
        ruling = {
            "reward": reward,
            "terminated": verdict.terminated,
            "success": verdict.success,
            "distance_m": verdict.distance_m,
        }
        ruled = {**ruling, **self._batch.set_step_result(k, ruling)}
        for key, value in ruled.items():
            if key in answer:
                answer[key][k] = math.nan if value is None else value
        info = mapping(f"{self._name()}.judge: info", verdict.info)
        if taken := sorted(set(info) & {*answer, *EPISODE_KEYS, "action_mask"}):
            raise ConfigError(f"{self._name()}.judge: info has {taken[0]!r}, which exists already")
        return info

    def expert(self) -> int | None:
        """The number of the expert's action; ``None`` where the task is the engine's."""
        if self._task is None:
            return None
        given = self._task.expert(self._world)
        if given is None:
            if not _asks(self._task.base):
                raise UsageError(
                    f"the task {self._name()} has no expert, nor has its base {self._task.base}; "
                    "write its method expert"
                )
            return self._batch.expert_action(self._env)
        name = text("the expert's action", given)
        names = _native.actions()
        if name not in names:
            raise ConfigError(
                f"the expert's action is {quoted(name)}; allowed are {', '.join(names)}"
            )
        return names.index(name)

    def spaces(self, native: Mapping[str, spaces.Space[Any]]) -> dict[str, spaces.Space[Any]]:
        """The spaces of the task and the sensors by name, beside those of the engine.

        Raises:
            ConfigError: A name or a space is missing, wrong, or there already.
        """
        found: dict[str, spaces.Space[Any]] = {}
        if self._task is not None:
            at = f"{self._name()}.spaces"
            for name, space in mapping(at, self._task.spaces, "spaces by name").items():
                _add(found, native, f"{at}: {name}", name, space)
            if not found and type(self._task).observe is not Task.observe:
                raise ConfigError(
                    f"{self._name()} has a method observe and no spaces; name there what it "
                    "observes, as spaces = {'goal': gymnasium.spaces.Box(...)}"
                )
        for sensor in self.sensors:
            at = f"{type(sensor).__name__}.name"
            name = text(at, getattr(sensor, "name", None))
            if not name:
                raise ConfigError(f"{at} is ''; expected a name for what it observes")
            _add(found, native, f"sensor {name}: space", name, getattr(sensor, "space", None))
        return found

    def observe(self) -> dict[str, Any]:
        """The observations of task and sensors now, by name, each in its space.

        Those of a snapshot are given again: looking once more might change what a part remembers.
        """
        if self._is_restored and self._seen is not None:
            self._is_restored = False
            return self._seen
        step = self._world.native.step_count
        self._seen, seen = None, {}
        if self._task is not None and self._task.spaces:
            at, rng = f"{self._name()}.observe", self._rng(_TASK_STREAM, step)
            values = mapping(at, self._task.observe(self._world, rng))
            if set(values) != set(self._task.spaces):
                wanted = sorted(self._task.spaces)
                raise ConfigError(f"{at} gave {sorted(values)}; its spaces are {wanted}")
            for name, space in self._task.spaces.items():
                seen[name] = _element(f"{at}: {name}", space, values[name])
        for stream, sensor in enumerate(self.sensors, _TASK_STREAM + 1):
            value = sensor.observe(self._world, self._rng(stream, step))
            seen[sensor.name] = _element(f"sensor {sensor.name}", sensor.space, value)
        self._seen = seen
        return seen

    def _own_spaces(self) -> dict[str, Any]:
        """The spaces of :meth:`observe`, by name."""
        of_task = {} if self._task is None else self._task.spaces
        return {**of_task, **{sensor.name: sensor.space for sensor in self.sensors}}

    def save(self) -> bytes:
        """The states of the parts, and what was observed last.

        Raises:
            ConfigError: It would come back as something else.
        """
        saved = {}
        for name, part in self._parts().items():
            at = f"{name}.state"
            saved[name] = to_json(part.state, at)
            _refuse_what_changes(at, part.state)
        if self._seen is not None:
            saved[_OBSERVED] = json.dumps({name: _packed(one) for name, one in self._seen.items()})
        rows = (f"{json.dumps(name)}: {state}" for name, state in saved.items())
        return f"{{{', '.join(rows)}}}".encode()

    def loaded(self, saved: bytes) -> dict[str, dict[str, Any]]:
        """The states that :meth:`save` wrote, by part, and what was observed.

        Raises:
            ConfigError: It is of other parts or of none, or was cut.
        """
        if not saved:
            raise ConfigError(
                "snapshot refused: it is of an environment without parts in Python; expected "
                f"{[*self._parts()]}"
            )
        at = "snapshot refused: its parts"
        states = mapping(at, from_json(at, saved))
        names = [*self._parts()]
        seen = states.pop(_OBSERVED, None)
        if set(states) != set(names):
            raise ConfigError(f"{at} are {[*states]}; expected {names}")
        found = {name: mapping(f"{at}: {name}", state) for name, state in states.items()}
        if seen is not None:
            at, own = f"{at}: {_OBSERVED}", self._own_spaces()
            rows = mapping(at, seen)
            if set(rows) != set(own):
                raise ConfigError(f"{at} has {sorted(rows)}; expected {sorted(own)}")
            found[_OBSERVED] = {
                name: _unpacked(f"{at}: {name}", space, rows[name]) for name, space in own.items()
            }
        return found

    def load(self, states: Mapping[str, dict[str, Any]], seed: int) -> None:
        """Restores the state that :meth:`save` wrote, in an episode of ``seed``."""
        self._seed = seed
        for name, part in self._parts().items():
            part.state = states[name]
        self._seen = states.get(_OBSERVED)
        self._is_restored = self._seen is not None


def _refuse_what_changes(at: str, value: object) -> None:
    """Refuses values that JSON returns as another kind."""
    kind = type(value)
    if kind is dict:
        for key, part in value.items():  # type: ignore[attr-defined] # of a dict
            if type(key) is not str:
                raise ConfigError(f"{at} has the key {quoted(key)}; a snapshot holds keys of text")
            _refuse_what_changes(f"{at}[{key!r:.60}]", part)
    elif kind is list:
        for k, part in enumerate(value):  # type: ignore[arg-type] # a list
            _refuse_what_changes(f"{at}[{k}]", part)
    elif kind is str:
        text(at, value)
    elif value is not None and kind not in (bool, int, float):
        raise ConfigError(
            f"{at} is {quoted(value)}; a snapshot holds numbers, text, lists and dicts of Python's "
            "own kinds: of an array or a number of NumPy keep its tolist(), of a tuple a list"
        )


def _packed(observed: object) -> str | dict[str, str]:
    """An observation as JSON holds it: text, or an array's bytes."""
    if isinstance(observed, str):
        return observed
    return {"bytes": base64.b64encode(np.ascontiguousarray(observed).tobytes()).decode()}


def _unpacked(at: str, space: spaces.Space[Any], packed: object) -> Any:  # noqa: ANN401 - of the space
    """The observation that :func:`_packed` wrote.

    Raises:
        ConfigError: It is none of this space.
    """
    if isinstance(space, spaces.Text):
        return _element(at, space, packed)
    try:
        raw = base64.b64decode(text(at, mapping(at, packed).get("bytes")), validate=True)
        array = np.frombuffer(raw, space.dtype).reshape(space.shape or ())
    except (ValueError, binascii.Error) as error:
        raise ConfigError(f"{at}: expected an element of {space}: {error}") from None
    return _element(at, space, array)


def _checked(task: str, verdict: object) -> StepResult:
    if not isinstance(verdict, StepResult):
        raise ConfigError(f"{task}.judge gave {quoted(verdict)}; expected a dwell.StepResult")
    distance_m = verdict.distance_m
    return dataclasses.replace(
        verdict,
        reward=finite_number("reward", verdict.reward),
        terminated=boolean("terminated", verdict.terminated),
        success=boolean("success", verdict.success),
        distance_m=None if distance_m is None else finite_number("distance_m", distance_m),
    )


@functools.cache
def _asks(base: str) -> bool:
    """Returns whether a task of the engine states a goal, by which its expert acts."""
    return any(row["name"] == base and row["asks"] for row in _native.tasks())


def _element(at: str, space: spaces.Space[Any], value: object) -> Any:  # noqa: ANN401 - of the space
    """The observation in the form of its space.

    Raises:
        ConfigError: It is no element; the message begins with ``at``.
    """
    element: Any = value
    form = ""
    if not isinstance(space, spaces.Text):
        try:
            refuse_no_array(f"{at}: what it observed", value)
            given = np.asarray(value)
            form = (
                f"; found {given.dtype} of shape {given.shape}"
                if given.dtype.kind in "biufc"
                else ""
            )
            element = _converted(given, np.dtype(space.dtype))
        except ConfigError:
            raise
        except (TypeError, ValueError):
            element = None
    # A Discrete space wants its elements as scalars.
    is_scalar = isinstance(space, spaces.Discrete) and element is not None and element.shape == ()
    if element is None or not space.contains(element[()] if is_scalar else element):
        raise ConfigError(f"{at} observed {quoted(value)}; its space is {space}{form}")
    return element


def _converted(given: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any] | None:
    """Numbers as another type, where that holds them: whole ones exactly; ``None`` elsewhere."""
    if given.dtype.kind == "f" and dtype.kind == "f":
        # What is too large for the type becomes infinite there.
        with np.errstate(over="ignore"):
            narrow = given.astype(dtype)
        return narrow if (np.isfinite(narrow) | ~np.isfinite(given)).all() else None
    if given.dtype.kind in "iu" and dtype.kind in "iu":
        whole = given.astype(dtype)
        return whole if (whole == given).all() else None
    return given.astype(dtype, casting="same_kind")


def _add(
    found: dict[str, spaces.Space[Any]],
    native: Mapping[str, spaces.Space[Any]],
    at: str,
    name: str,
    space: object,
) -> None:
    """Adds a space; ``at``: its owner, for errors."""
    if name in found or name in native:
        raise ConfigError(f"observations: found {name!r} twice; allowed is each name once")
    if not isinstance(space, _SPACES):
        known = ", ".join(kind.__name__ for kind in _SPACES)
        raise ConfigError(f"{at} is {quoted(space)}; allowed are {known}")
    found[name] = space
