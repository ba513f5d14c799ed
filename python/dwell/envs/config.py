"""Settings of an environment, as JSON for the native side."""

from __future__ import annotations

import contextlib
import inspect
import operator
import os
import re
import weakref
from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from copy import deepcopy
from typing import Any, TypedDict

import numpy as np

from dwell import ConfigError, HouseError, _native
from dwell.arguments import (
    checked_fields,
    integer_in_range,
    kept,
    mapping,
    path,
    quoted,
    sequence_items,
    text,
    text_list,
    to_json,
)
from dwell.envs.action_modes import checked_mode
from dwell.envs.python_tasks import NativeSettings, RewardChoice, Sensors
from dwell.house import House
from dwell.house_list import HouseList
from dwell.schemas import setting_checks
from dwell.world_settings import Laws, Randomize, world_settings

Houses = str | os.PathLike[str] | House | Sequence[str | os.PathLike[str] | House]
#: A file of episodes, or several, as the shards of one.
EpisodeFiles = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]


class EnvSettings(TypedDict, total=False):
    """The settings of :class:`dwell.envs.DwellEnv` beside its task; it explains them."""

    houses: Houses | None
    episodes: EpisodeFiles | None
    sensors: Sensors
    reward: RewardChoice
    laws: Laws
    parameters: Mapping[str, float] | None
    randomize: Randomize
    task_settings: Mapping[str, Any] | None
    #: ``forward_m``, ``turn_deg``, ``look_deg``.
    stride: Mapping[str, float] | None
    #: ``discrete``, ``velocity``, ``pointer``, ``object`` or ``dict``.
    action_mode: str
    #: Names of the actions to choose from.
    actions: Sequence[str] | None
    action_mask: bool
    world: Mapping[str, Any] | None
    agent: int
    threads: int | None
    max_episode_steps: int | None
    render_mode: str | None


def arguments_of(env: type) -> list[str]:
    """The names of the arguments that an environment takes."""
    parameters = inspect.signature(env.__init__).parameters.values()  # type: ignore[misc] # of the class itself
    return [one.name for one in parameters if one.kind is not one.VAR_KEYWORD][1:]


#: Houses, with their environments, that are kept for the next episode in them: enough for those
#: who go around a few, and few enough for those who go through thousands.
CACHED_HOUSES = 16


def step_limit(value: object, name: str = "max_episode_steps") -> int | None:
    """The step limit of an environment, an argument of a ``name``: ``None`` and -1 are none.

    Raises:
        ConfigError: It is no whole number from 1.
    """
    if value is None:
        return None
    try:
        number = operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        number = 0
    if number == -1:
        return None
    if isinstance(value, bool) or number < 1:
        raise ConfigError(
            f"{name} is {quoted(value)}; allowed are whole numbers from 1, None or -1 "
            "for episodes without a limit"
        )
    return min(number, 2**63 - 1)


def agent_number(agent: object) -> int:
    """Which of a world's agents an environment is about; the engine knows how many there are.

    Raises:
        ConfigError: It is no whole number from 0.
    """
    return integer_in_range("agent", agent, high=2**32 - 1)


#: The house of environments that are told of none.
USUAL_HOUSE = "builtin:apartment"


def kept_houses(houses: Houses | None) -> Houses | None:
    """A copy of the houses of an environment; those of a range of seeds are not made for it."""
    found: Houses | None = deepcopy(houses) if isinstance(houses, HouseList) else kept(houses)
    return found


#: Houses that are open, by name, with which caches begin.
_OPEN: ContextVar[Mapping[str, House]] = ContextVar("open houses")


@contextlib.contextmanager
def sharing_open_houses(cache: HouseCache) -> Iterator[None]:
    """Caches that are made meanwhile have the houses that are open in ``cache``."""
    token = _OPEN.set({**cache.alive})
    try:
        yield
    finally:
        _OPEN.reset(token)


class HouseCache:
    """Houses by number.

    Those given by HOUSE string are opened at first use. The last :data:`CACHED_HOUSES` stay open,
    and those that somebody plays in.
    """

    def __init__(self, houses: Houses) -> None:
        """Keeps the houses, one house counting as a list of one; opens nothing."""
        alone = isinstance(houses, str | os.PathLike | House)
        expected = "expected HOUSE strings or Houses"
        is_list = isinstance(houses, HouseList)
        given = [houses] if alone else [] if is_list else sequence_items("houses", houses, expected)
        if not (houses if is_list else given):
            raise ConfigError("houses: expected at least one HOUSE string or House, found none")
        self._given: dict[str, House] = {}
        #: The latest last.
        self._kept: OrderedDict[str, House] = OrderedDict()
        #: All that are open, whoever keeps them.
        self.alive = weakref.WeakValueDictionary(_OPEN.get({}))
        #: HOUSE strings; for a house that was handed over, its name, numbered where that is taken.
        self.names = deepcopy(houses) if isinstance(houses, HouseList) else HouseList()
        for k, row in enumerate(given):
            if isinstance(row, House):
                is_taken = row.name in self.names
                self.names.append_name(f"{row.name}~{len(self.names)}" if is_taken else row.name)
                self._given[self.names[-1]] = row
            elif isinstance(row, str):
                self.names.append(text(f"houses[{k}]", row))
            elif isinstance(row, os.PathLike):
                self.names.append_name(path(f"houses[{k}]", row))
            else:
                raise ConfigError(
                    f"houses[{k}] is {quoted(row)}; expected a HOUSE string or a House"
                )

    @property
    def has_objects(self) -> bool:
        """True if some houses are objects that no HOUSE string opens."""
        return bool(self._given)

    def __getitem__(self, index: int) -> House:
        """House ``index`` modulo their number."""
        return self.open(index)

    def open(self, index: int, *, threads: int | None = None) -> House:
        """House ``index`` modulo their number, opened by so many threads.

        Raises:
            HouseError: It cannot be opened; of several the message begins with its name.
        """
        name = self.names[index % len(self.names)]
        house = self._given.get(name) or self.alive.get(name)
        if house is None:
            house = self.alive[name] = self._opened(name, threads)
        # Without a lock, which a fork beside another thread would leave held.
        self._kept.pop(name, None)
        self._kept[name] = house
        while len(self._kept) > CACHED_HOUSES:
            self._kept.popitem(last=False)
        return house

    def _opened(self, name: str, threads: int | None) -> House:
        """The house of a name; of several the error says which it is."""
        try:
            return House.open_by(name, threads)
        except HouseError as error:
            if len(self.names) == 1 or name in str(error):
                raise
            raise type(error)(f"{name}: {error}") from error

    def draw(self, stream: np.random.Generator) -> tuple[int, int]:
        """House and seed of the next episode."""
        return int(stream.integers(len(self.names))), int(stream.integers(2**63))

    def chosen(self, house: object) -> int:
        """The number of a house that somebody asks for.

        Raises:
            ConfigError: There is none of the number.
        """
        return integer_in_range("options: house, an index,", house, high=len(self.names) - 1)

    def stated(self, house: int, seed: int) -> dict[str, Any] | None:
        """What an episode states of its start and goal; here all of them are drawn."""
        del house, seed
        return None

    def place(self, house: int, seed: int) -> str | None:
        """File and line where an episode states its start or goal; here no file states any."""
        del house, seed
        return None

    def refuse_stated(self) -> None:
        """Refuses that somebody states an episode's start and goal; here everybody may."""

    def check(self, house: int, seed: int, batch: _native.Batch, env: int = 0) -> None:
        """Refuses an episode that has begun and is not the one that was promised; none is here."""

    def episode_id(self, index: int, seed: int) -> str:
        """The id of an episode with a seed in house ``index`` modulo their number."""
        return f"{self.names[index % len(self.names)]}#{seed}"

    def episode(self, episode_id: object) -> tuple[int, int]:
        """House and seed of an id of :meth:`episode_id`.

        Raises:
            ConfigError: It is none, or of a house that is not here.
        """
        name, _, seed = (episode_id if isinstance(episode_id, str) else "").rpartition("#")
        if not re.fullmatch("[0-9]{1,20}", seed) or name not in self.names:
            raise ConfigError(
                f"episode_id is {quoted(episode_id)}; expected HOUSE#NUMBER, as info has it, of a "
                f"house of this environment: {quoted(self.names[:12])}"
            )
        return self.names.index(name), integer_in_range("episode_id", int(seed))


def env_json(
    native: NativeSettings,
    *,
    laws: Laws = None,
    parameters: Mapping[str, float] | None = None,
    randomize: Randomize = None,
    stride: Mapping[str, float] | None = None,
    action_mode: str = "discrete",
    actions: Sequence[str] | None = None,
    world: Mapping[str, Any] | None = None,
    agent: int = 0,
    agents: Sequence[Mapping[str, Any]] | None = None,
) -> str:
    """The native ``EnvConfig`` as JSON.

    ``agents``: a row for each of several agents that act, in the engine's own form.
    """
    config: dict[str, Any] = {
        "task": text("task", native.task),
        "world": world_settings(laws, parameters, world, randomize),
    }
    if native.settings is not None:
        config["task_settings"] = mapping("task_settings", native.settings)
    if stride is not None:
        config["stride"] = checked_fields("stride", stride, setting_checks("StepSizes"))
    # What is usual is not stated: files say it as they always did.
    if checked_mode(action_mode) != "discrete":
        config["action_mode"] = action_mode
    if actions is not None:
        config["actions"] = text_list("actions", actions)
    if native.sensors is not None:
        config["sensors"] = sensor_rows(native.sensors)
    if agents is not None:
        config["agents"] = [*agents]
    elif agent:
        config["agents"] = [{"agent": agent}]
    return to_json(config)


def sensor_rows(
    sensors: Sequence[str] | Mapping[str, Mapping[str, Any]],
) -> list[dict[str, Any]]:
    """Kinds with their settings. A sensor whose settings hold ``kind`` keeps its name beside it."""
    by_name = isinstance(sensors, Mapping)
    named: dict[str, Any] = {}
    for name in [] if by_name else text_list("sensors", sensors):
        if name in named:
            raise ConfigError(
                f"sensors: {name!r:.60} stands there twice; several of one kind have names of "
                'their own: {"left": {"kind": "rgb"}, "right": {"kind": "rgb"}}'
            )
        named[name] = {}
    rows = []
    for name, settings in (mapping("sensors", sensors) if by_name else named).items():
        if not isinstance(settings, Mapping) or "kind" not in settings:
            rows.append({"kind": name, "settings": settings})
            continue
        own = mapping(f"sensors.{name}", settings)
        kind = text(f"sensors.{name}.kind", own.pop("kind"))
        rows.append({"kind": kind, "settings": {"name": name, **own}})
    return rows
