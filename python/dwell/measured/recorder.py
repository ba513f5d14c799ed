"""A wrapper of any Gymnasium environment, a lab's robot too, that records a measured bundle."""

from __future__ import annotations

import csv
import itertools
import json
import os
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Generic, SupportsFloat, TypeVar

import gymnasium
import numpy as np

from dwell import ConfigError
from dwell.arguments import above_zero, file_path
from dwell.files import make_folder
from dwell.measured import maps
from dwell.measured.importing import import_files
from dwell.measured.kinds import KINDS
from dwell.measured.maps import Map

ObsType = TypeVar("ObsType")
ActType = TypeVar("ActType")

#: Numbers of an observation beyond which it is a picture.
_MOST_NUMBERS = 4096
#: Columns that every row has.
_OWN = ("episode", "group", "conditions", "t_s")


class Recorder(gymnasium.Wrapper[ObsType, ActType, ObsType, ActType], Generic[ObsType, ActType]):
    """Records what an environment observes and is told to do, as a bundle for calibration.

    The map is that of ``dwell measure import`` without its files: columns are numbers of the
    observation, the action and the info, by their paths (``observation[2]``,
    ``observation.joint_pos[0]``, ``action[0]``, ``info.torque``), and units, axes and cleaning are
    those of any map. Row k of an episode has the observation and the info of step k, and the
    action that was taken then. The rows stand in ``NAME.log.csv`` beside the bundle
    ``NAME.measured`` and the map in ``NAME.map.json``: what the import refuses is not lost.

    Attributes:
        group: Episodes that begin while it stands are held out together; ``None``: each alone.
        conditions: In words, of the episodes that begin while it stands.
    """

    def __init__(
        self,
        env: gymnasium.Env[ObsType, ActType],
        out: str | os.PathLike[str],
        mapping: Mapping[str, Any],
        *,
        step_s: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Wraps an environment.

        Args:
            env: The environment, or a robot's wrapper that speaks Gymnasium.
            out: The bundle to be written, ``NAME.measured``.
            mapping: The map: ``kind``, what is known (``joint``, ``body``, ...), and ``table``
                with the columns.
            step_s: The time of a step, s; ``None``: ``clock`` tells when an observation comes.
            clock: Returns seconds.

        Raises:
            ConfigError: The map's kind or a key of it is unknown, or impulse responses are asked
                for.
            FileExistsError: The bundle or its log is there already.
        """
        super().__init__(env)
        self._out = Path(file_path("out", out))
        self._mapping = _checked(mapping)
        stem = self._out.name.removesuffix(".measured")
        # Not with_name, which "/" has none of.
        self.log_file = self._out.parent / f"{stem}.log.csv"
        self.map_file = self._out.parent / f"{stem}.map.json"
        for path in (self._out, self.log_file, self.map_file):
            if os.path.lexists(path):
                raise FileExistsError(f"{path}: is there already; remove it or choose another name")
        self._step_s = None if step_s is None else above_zero("step_s", step_s)
        self._clock = clock
        self._columns = [*dict.fromkeys(_named(self._mapping["table"]))]
        self.group: str | None = None
        self.conditions = ""
        self.episodes = 0
        self._k = 0
        self._zero_s = 0.0
        self._group = ""
        self._row: dict[str, float] | None = None
        self._is_written = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ObsType, dict[str, Any]]:
        """Begins an episode."""
        self._end()
        observation, info = super().reset(seed=seed, options=options)
        self._zero_s = self._clock()
        self._k = 0
        self.episodes += 1
        self._group = self.group or f"e{self.episodes}"
        self._row = self._seen(observation, info)
        missing = [name for name in self._columns if not name.startswith("action")]
        self._refuse_missing([name for name in missing if name not in self._row], self._row)
        return observation, info

    def step(self, action: ActType) -> tuple[ObsType, SupportsFloat, bool, bool, dict[str, Any]]:
        """Acts, and records the observation before it with the action."""
        if self._row is not None:
            told = dict(_numbers("action", action))
            wanted = [name for name in self._columns if name.startswith("action")]
            self._refuse_missing([name for name in wanted if name not in told], told)
            self._write({**self._row, **told})
        observation, reward, terminated, truncated, info = super().step(action)
        self._k += 1
        self._row = self._seen(observation, info)
        if terminated or truncated:
            self._end()
        return observation, reward, terminated, truncated, info

    def write(self) -> dict[str, Any]:
        """Makes the bundle of what was recorded.

        Returns:
            Counts, as of ``dwell measure import``.

        Raises:
            ConfigError: Nothing was recorded.
            ValueError: The bundle's checks refuse the recording; log and map stay.
        """
        self._end()
        if not self.episodes:
            raise ConfigError(f"{self._out}: nothing was recorded; reset and step before")
        self._is_written = True
        table = {**self._mapping["table"], "file": self.log_file.name}
        table |= {"episode": "episode", "split_group": "group", "t_s": "t_s"}
        table.setdefault("conditions", "conditions")
        mapping = {**self._mapping, "table": table}
        self.map_file.write_text(json.dumps(mapping, indent=1) + "\n", "utf-8")
        return import_files([self.log_file], self.map_file, self._out, lambda *_: None)

    def close(self) -> None:
        """Writes the bundle, if something was recorded and nothing written, and closes."""
        try:
            if self.episodes and not self._is_written:
                self.write()
        finally:
            super().close()

    def _seen(self, observation: object, info: dict[str, Any]) -> dict[str, float]:
        t_s = self._clock() - self._zero_s if self._step_s is None else self._k * self._step_s
        found = dict(_numbers("observation", observation))
        found.update(_numbers("info", info))
        return {"t_s": t_s, **found}

    def _end(self) -> None:
        """Writes the last observation, after which nothing was done."""
        if self._row is not None:
            self._write(self._row)
        self._row = None

    def _write(self, row: Mapping[str, float]) -> None:
        is_new = not self.log_file.exists()
        if is_new:
            make_folder(self.log_file.parent)
        with self.log_file.open("a", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            if is_new:
                writer.writerow([*_OWN, *self._columns])
            own = [f"e{self.episodes}", self._group, self.conditions, f"{row['t_s']:.9f}"]
            numbers = [row.get(name) for name in self._columns]
            writer.writerow([*own, *("" if v is None else repr(v) for v in numbers)])

    def _refuse_missing(self, names: list[str], found: Mapping[str, float]) -> None:
        if names:
            raise ConfigError(
                f"mapping: table: no number {names[0]!r}; there are "
                f"{[*itertools.islice(found, 24)]}"
            )


def _checked(mapping: Mapping[str, Any]) -> Map:
    """A map whose keys are known, but for the files."""
    kind = mapping.get("kind")
    kinds = sorted(name for name in KINDS if name != "impulse_response")
    if kind not in kinds:
        raise ConfigError(f"mapping: kind is {kind!r}; a recorder writes one of {kinds}")
    try:
        maps.check_keys(dict(mapping), KINDS[str(kind)].keys(), "mapping")
        maps.require(mapping, "table", "mapping")
    except ValueError as error:
        raise ConfigError(str(error)) from None
    keys = ("file", "part", "episode", "split_group", "t_s")
    own = [key for key in keys if mapping["table"].get(key)]
    if own:
        raise ConfigError(f"mapping: table: {own[0]!r} is the recorder's own; leave it out")
    return json.loads(json.dumps(mapping))  # type: ignore[no-any-return]


def _named(table: Mapping[str, Any]) -> Iterator[str]:
    """The columns that a table names."""
    for key, value in table.items():
        if key in maps.TABLE or value is None:
            continue
        if isinstance(value, str):
            yield value
        elif isinstance(value, list):
            yield from (str(name) for name in value)
        elif isinstance(value, dict):
            yield from (str(name) for name in value.values())


def _numbers(name: str, value: object) -> Iterator[tuple[str, float]]:
    """The numbers of a nested value by path; pictures and texts are left out."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _numbers(f"{name}.{key}", inner)
    elif isinstance(value, bool | int | float | np.number | np.bool_):
        yield name, float(value)
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        if value.ndim == 0:
            yield name, float(value)
        elif value.size <= _MOST_NUMBERS:
            for place, number in np.ndenumerate(value):
                yield name + "".join(f"[{k}]" for k in place), float(number)
    elif isinstance(value, list | tuple) and len(value) <= _MOST_NUMBERS:
        for k, inner in enumerate(value):
            yield from _numbers(f"{name}[{k}]", inner)
