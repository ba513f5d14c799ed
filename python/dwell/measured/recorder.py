"""A wrapper of any Gymnasium environment, a lab's robot too, that records a measured bundle."""

from __future__ import annotations

import csv
import itertools
import json
import logging
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Generic, Literal, SupportsFloat, TypeVar, cast

import gymnasium
import numpy as np

from dwell import ConfigError
from dwell.arguments import above_zero, file_path, finite_number, quoted
from dwell.files import make_folder, read_json
from dwell.measured import maps
from dwell.measured.importing import import_files, refuse_file_name
from dwell.measured.kinds import KINDS
from dwell.measured.maps import Map

ObsType = TypeVar("ObsType")
ActType = TypeVar("ActType")

_LOG = logging.getLogger("dwell.calibration")
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
    Recorded is from a reset to the end of the episode, to the next reset, or to :meth:`write`;
    steps without a reset before them are the environment's own affair. Episodes that are cut so
    short that nothing can be predicted from them are left out of the bundle, and told. Where an
    exception or Ctrl-C ends a ``with`` block, the whole episodes become the bundle, and the
    exception goes on; what forbids the bundle is then logged (logger ``dwell.calibration``).

    Attributes:
        group: Episodes that begin while it stands are held out together; ``None``: each alone.
        conditions: In words, of the episodes that begin while it stands.
    """

    def __init__(
        self,
        env: gymnasium.Env[ObsType, ActType],
        out: str | os.PathLike[str],
        mapping: Mapping[str, Any] | str | os.PathLike[str],
        *,
        step_s: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Wraps an environment.

        Args:
            env: The environment, or a robot's wrapper that speaks Gymnasium.
            out: The bundle to be written, ``NAME.measured``.
            mapping: The map, or a JSON file of it: ``kind``, what is known (``joint``, ``body``,
                ...), and ``table`` with the columns.
            step_s: The time of a step, s; ``None``: ``clock`` tells when an observation comes.
            clock: Returns seconds.

        Raises:
            ConfigError: The map's kind or a key of it is unknown, or impulse responses are asked
                for; or ``out`` is named as a file.
            FileExistsError: The bundle or its log is there already.
            OSError: The system refuses to read the map.
        """
        super().__init__(env)
        self._out = Path(file_path("out", out))
        refuse_file_name(self._out)
        self._mapping = _checked(*_map_of(mapping))
        stem = self._out.name.removesuffix(".measured")
        # Not with_name, which "/" has none of.
        self.log_file = self._out.parent / f"{stem}.log.csv"
        self.map_file = self._out.parent / f"{stem}.map.json"
        for path in (self._out, self.log_file, self.map_file):
            if os.path.lexists(path):
                raise FileExistsError(f"{path}: is there already; remove it or choose another name")
        self._step_s = None if step_s is None else above_zero("step_s", step_s)
        self._clock = _seconds_of(clock)
        self._columns = [*dict.fromkeys(_named(self._mapping["table"]))]
        self.group: str | None = None
        self.conditions = ""
        self.episodes = 0
        self._k = 0
        self._zero_s = 0.0
        self._group = ""
        self._row: dict[str, float] | None = None
        #: Whether something was recorded since the last :meth:`write`, and whether one made the
        #: bundle.
        self._has_news = False
        self._has_bundle = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ObsType, dict[str, Any]]:
        """Begins an episode."""
        self._end()
        observation, info = super().reset(seed=seed, options=options)
        self._zero_s = self._clock()
        self._k = 0
        row = self._seen(observation, info)
        missing = [name for name in self._columns if not name.startswith("action")]
        self._refuse_missing([name for name in missing if name not in row], row)
        self.episodes += 1
        self._group = self.group or f"e{self.episodes}"
        self._row = row
        return observation, info

    def step(self, action: ActType) -> tuple[ObsType, SupportsFloat, bool, bool, dict[str, Any]]:
        """Acts, and records the observation before it with the action."""
        before = self._row
        if before is None:
            # Nothing is recorded before a reset, and after an episode's end.
            return super().step(action)
        told = dict(_numbers("action", action))
        wanted = [name for name in self._columns if name.startswith("action")]
        self._refuse_missing([name for name in wanted if name not in told], told)
        # An environment that raises, or Ctrl-C, leaves an episode that ends with this row.
        self._row = None
        self._write({**before, **told})
        observation, reward, terminated, truncated, info = super().step(action)
        self._k += 1
        self._row = self._seen(observation, info)
        if terminated or truncated:
            self._end()
        return observation, reward, terminated, truncated, info

    def write(self) -> dict[str, Any]:
        """Makes the bundle of all that was recorded; an episode that is under way ends here.

        The bundle of an earlier call is replaced, once the new one is whole.

        Returns:
            Counts, as of ``dwell measure import``; their ``notes`` tell of episodes that were left
            out.

        Raises:
            ConfigError: Nothing was recorded.
            MeasuredDataError: The bundle's checks refuse the recording; log and map stay, more may
                be recorded, and it may be written again. It is a ``ValueError``.
        """
        self._end()
        if not self.episodes:
            raise ConfigError(f"{self._out}: nothing was recorded; reset and step before")
        self._has_news = False
        table = {**self._mapping["table"], "file": self.log_file.name}
        table |= {"episode": "episode", "split_group": "group", "t_s": "t_s"}
        table.setdefault("conditions", "conditions")
        table["cleaning"] = {"short_episodes": "leave_out", **(table.get("cleaning") or {})}
        mapping = {**self._mapping, "table": table}
        self.map_file.write_text(json.dumps(mapping, indent=1) + "\n", "utf-8")
        counts = self._replaced() if self._has_bundle else self._imported(self._out)
        self._has_bundle = True
        return counts

    def close(self) -> None:
        """Writes the bundle, if something was recorded since it was last tried, and closes.

        What was left out is logged as a warning (logger ``dwell.calibration``).

        Raises:
            MeasuredDataError: As of :meth:`write`.
        """
        try:
            self._write_news()
        finally:
            super().close()

    def __exit__(self, *args: object) -> Literal[False]:
        """Closes; an exception of the block goes on, whatever becomes of the bundle.

        Raises:
            MeasuredDataError: As of :meth:`close`, where the block had no exception.
        """
        if args[:1] not in ((), (None,)):
            try:
                self._write_news()
            except Exception as refused:
                # What ended the block is what its user looks for.
                self._has_news = False
                _LOG.warning("%s was not written: %s", self._out, refused)
        self.close()
        return False

    def _write_news(self) -> None:
        """Writes the bundle if something was recorded since it was last tried."""
        if self._has_news or self._row is not None:
            for note in self.write().get("notes", ()):
                _LOG.warning("%s: %s", self._out, note)

    def _imported(self, out: Path) -> dict[str, Any]:
        return import_files([self.log_file], self.map_file, out, lambda *_: None)

    def _replaced(self) -> dict[str, Any]:
        """A new bundle in the place of the own one, which stays where the new one is refused."""
        beside = Path(tempfile.mkdtemp(prefix=f".{self._out.name}.", dir=self._out.parent))
        try:
            counts = self._imported(beside / self._out.name)
            if self._out.exists():
                self._out.rename(beside / "before")
            (beside / self._out.name).rename(self._out)
        finally:
            shutil.rmtree(beside, ignore_errors=True)
        return counts

    def _seen(self, observation: object, info: dict[str, Any]) -> dict[str, float]:
        t_s = self._clock() - self._zero_s if self._step_s is None else self._k * self._step_s
        found = dict(_numbers("observation", observation))
        found.update(_numbers("info", info))
        return {"t_s": t_s, **found}

    def _end(self) -> None:
        """Writes the last observation, after which nothing was done."""
        last, self._row = self._row, None
        if last is not None:
            self._write(last)

    def _write(self, row: Mapping[str, float]) -> None:
        self._has_news = True
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


def _seconds_of(clock: Callable[[], object]) -> Callable[[], float]:
    """A clock of which each time is a finite number."""
    return lambda: finite_number("what clock returned, s,", clock())


def _map_of(mapping: object) -> tuple[Mapping[str, Any], str]:
    """A map, or that of a file, and how messages name it."""
    if isinstance(mapping, Mapping):
        return mapping, "mapping"
    if not isinstance(mapping, str | os.PathLike):
        raise ConfigError(f"mapping is {quoted(mapping)}; expected a map or the path of one")
    path = file_path("mapping", mapping)
    try:
        found = read_json(path)
    except ValueError as error:
        raise ConfigError(str(error)) from None
    if not isinstance(found, dict):
        raise ConfigError(
            f"{path}: found {quoted(found)}; an object with the keys of a map is needed"
        )
    return cast("dict[str, Any]", found), path


def _checked(mapping: Mapping[str, Any], at: str) -> Map:
    """A map whose keys are known, but for the files."""
    kind = mapping.get("kind")
    kinds = sorted(name for name in KINDS if name != "impulse_response")
    if kind not in kinds:
        raise ConfigError(f"{at}: kind is {kind!r}; a recorder writes one of {kinds}")
    try:
        maps.check_keys(dict(mapping), KINDS[str(kind)].keys(), at)
        maps.require(mapping, "table", at)
        maps.refuse_unconfirmed(mapping, at)
    except ValueError as error:
        raise ConfigError(str(error)) from None
    keys = ("file", "part", "episode", "split_group", "t_s")
    own = [key for key in keys if mapping["table"].get(key)]
    if own:
        raise ConfigError(f"{at}: table: {own[0]!r} is the recorder's own; leave it out")
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
