"""What an environment is told, as JSON for the native side."""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from dwell import ConfigError
from dwell.arguments import fields, finite, mapping, text, texts, to_json, whole
from dwell.envs.custom import Native, RewardChoice, Sensors
from dwell.house import House
from dwell.settings import Laws, world_settings

Houses = str | os.PathLike[str] | House | Sequence[str | os.PathLike[str] | House]

_STRIDE = {"forward_m": finite, "turn_deg": finite, "look_deg": finite}


class EnvSettings(TypedDict, total=False):
    """What :class:`dwell.envs.DwellEnv` may be told beside its task, and explains."""

    houses: Houses
    sensors: Sensors
    reward: RewardChoice
    laws: Laws
    parameters: Mapping[str, float] | None
    task_settings: Mapping[str, Any] | None
    #: ``forward_m``, ``turn_deg``, ``look_deg``.
    stride: Mapping[str, float] | None
    world: Mapping[str, Any] | None
    threads: int | None
    render_mode: str | None


def arguments_of(env: type) -> list[str]:
    """The names of the arguments that an environment takes."""
    parameters = inspect.signature(env.__init__).parameters.values()  # type: ignore[misc] # of the class itself
    return [one.name for one in parameters if one.kind is not one.VAR_KEYWORD][1:]


#: Houses, with their environments, that are kept for the next episode in them: enough for those
#: who go around a few, and few enough for those who go through thousands.
KEPT = 16


class HouseShelf:
    """Houses by number.

    Those given by HOUSE string are opened at first use; the last :data:`KEPT` stay open.
    """

    def __init__(self, houses: Houses) -> None:
        """Keeps what it is given, one house counting as a list of one; opens nothing."""
        alone = isinstance(houses, str | os.PathLike | House)
        try:
            given = [houses] if alone else list(houses)  # type: ignore[arg-type] # not alone
        except TypeError:
            raise ConfigError(f"houses is {houses!r}; expected HOUSE strings or Houses") from None
        rows = [one for row in given for one in _expanded(row)]
        if not rows:
            raise ConfigError("houses: expected at least one HOUSE string or House, found none")
        self._given: dict[str, House] = {}
        self._open = functools.lru_cache(KEPT)(House.open)
        #: HOUSE strings; for a house that was handed over, its name, numbered where that is taken.
        self.names: list[str] = []
        for k, row in enumerate(rows):
            if isinstance(row, House):
                self.names.append(row.name if row.name not in self.names else f"{row.name}~{k}")
                self._given[self.names[-1]] = row
            elif isinstance(row, str | os.PathLike):
                self.names.append(os.fspath(row))
            else:
                raise ConfigError(f"houses[{k}] is {row!r}; expected a HOUSE string or a House")

    @property
    def has_objects(self) -> bool:
        """Whether houses were handed over that a HOUSE string does not open."""
        return bool(self._given)

    def __getitem__(self, index: int) -> House:
        """House ``index`` modulo their number."""
        name = self.names[index % len(self.names)]
        return self._given.get(name) or self._open(name)

    def episode_id(self, index: int, seed: int) -> str:
        """What an episode of a seed in house ``index`` modulo their number is called."""
        return f"{self.names[index % len(self.names)]}#{seed}"

    def episode(self, episode_id: object) -> tuple[int, int]:
        """House and seed of what :meth:`episode_id` gave.

        Raises:
            ConfigError: It is none, or of a house that is not here.
        """
        name, mark, seed = str(episode_id).rpartition("#")
        if not mark or not seed.isdecimal() or name not in self.names:
            raise ConfigError(
                f"episode_id is {episode_id!r}; expected HOUSE#NUMBER, as info has it, of a house "
                f"of this environment: {self.names[:12]}"
            )
        return self.names.index(name), whole("episode_id", int(seed))


def _expanded(row: object) -> list[object]:
    """What stands for itself, or the houses of a range of seeds."""
    return [*House.expand(row)] if isinstance(row, str) else [row]


def env_json(
    native: Native,
    *,
    laws: Laws = None,
    parameters: Mapping[str, float] | None = None,
    stride: Mapping[str, float] | None = None,
    world: Mapping[str, Any] | None = None,
) -> str:
    """The native ``EnvConfig`` as JSON."""
    config: dict[str, Any] = {
        "task": text("task", native.task),
        "world": world_settings(laws, parameters, world),
    }
    if native.settings is not None:
        config["task_settings"] = mapping("task_settings", native.settings)
    if stride is not None:
        config["stride"] = fields("stride", stride, _STRIDE)
    if native.sensors is not None:
        config["sensors"] = _sensors(native.sensors)
    return to_json(config)


def _sensors(sensors: Sequence[str] | Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Kinds with their settings. A sensor whose settings hold ``kind`` keeps its name beside it."""
    by_name = isinstance(sensors, Mapping)
    named: dict[str, Any] = {} if by_name else {name: {} for name in texts("sensors", sensors)}
    rows = []
    for name, settings in (mapping("sensors", sensors) if by_name else named).items():
        if not isinstance(settings, Mapping) or "kind" not in settings:
            rows.append({"kind": name, "settings": settings})
            continue
        own = mapping(f"sensors.{name}", settings)
        kind = text(f"sensors.{name}.kind", own.pop("kind"))
        rows.append({"kind": kind, "settings": {"name": name, **own}})
    return rows
