"""Episodes in files: which house, which seed, what is asked. Made, read, filtered and written.

A file is JSON Lines: a header, then an episode a line. ``dwell episodes`` makes one, ``episodes=``
of environments plays it, and ``docs/tutorials/evaluate.md`` shows both.
"""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from dwell import ConfigError, MeasuredDataError, __version__, _native, arguments
from dwell.arguments import (
    allowed_values,
    boolean,
    dwell_version,
    finite_number,
    integer_in_range,
    mapping,
    number_in_range,
    plain_settings,
    point,
    quoted,
    sequence_items,
    text,
    text_list,
)
from dwell.files import atomic_write, lines, open_file, parse_json
from dwell.stated_episodes import checked_part

#: What a file says of itself.
_FORMAT, _VERSION = "dwell-episodes", 1
#: A line is at most so long.
_MAX_LINE_BYTES = 2**20


@dataclasses.dataclass(frozen=True)
class Header:
    """What the episodes of a file have in common.

    Attributes:
        task: The task's name.
        task_version: Its version, as in the id of its environment.
        task_settings: All of its settings, those that nobody gave with their defaults.
        houses: The HOUSES strings that the houses were taken from.
        seed: What the episodes were drawn from.
        count: How many there are, in all shards together.
        shard: Which of how many shards this is, from 0: episodes ``K * count // N`` to
            ``(K + 1) * count // N - 1`` of all.
        made_by: The version of dwell that made it.
    """

    task: str
    task_version: int
    task_settings: Mapping[str, Any]
    houses: tuple[str, ...]
    seed: int
    count: int
    shard: tuple[int, int] = (0, 1)
    made_by: str = __version__

    @property
    def places(self) -> range:
        """Which of all episodes are in this shard, counted from 0."""
        which, shards = self.shard
        return range(which * self.count // shards, (which + 1) * self.count // shards)

    def as_dict(self) -> dict[str, Any]:
        """The first line of a file."""
        fields = {name: getattr(self, name) for name in _HEADER_CHECKS}
        about = {"format": _FORMAT, "version": _VERSION}
        return {**about, **plain_settings(fields, "header")}


@dataclasses.dataclass(frozen=True)
class Episode:
    """One episode.

    Attributes:
        episode_id: ``HOUSE#SEED``, as infos have it.
        scene_id: The HOUSE string.
        seed: The episode's seed.
        start_position: Where the agent stands at the start, m.
        start_yaw_deg: Where it faces, degrees, positive to the left, 0 along -Z.
        instruction: What is asked, in words; empty where nothing is.
        goal_kind: What kind of a goal it is, as infos have it; ``None`` without a goal.
        goal_class: The class of the things or rooms that count, where it is of one.
        goal_objects: The ids of the things that count.
        goal_rooms: The ids of the rooms that count.
        start_distance_to_goal: The way to the goal at the start, m; ``None`` where there is none.
        straight_distance_to_goal: Horizontal straight distance, m, where the goal is a place.
        expert_actions: How many actions the expert took, ``stop`` included; ``None`` where it was
            not played.
        expert_path_length: How far it went, m.
        expert_success: Whether it was successful.
        start: Where the episode states to start, in place of a drawn start: ``position``, and
            ``yaw_deg`` or ``yaw_rad``.
        goal: What it states to ask for, in place of a drawn goal: ``position``; ``class``,
            ``objects``, ``positions``; ``sound`` and kin.
        source_id: The episode of another file that it was converted from.
        source_distance_to_goal: The way to the goal that that file states, m.
    """

    episode_id: str
    scene_id: str
    seed: int
    start_position: tuple[float, float, float]
    start_yaw_deg: float
    instruction: str = ""
    goal_kind: str | None = None
    goal_class: str | None = None
    goal_objects: tuple[int, ...] = ()
    goal_rooms: tuple[int, ...] = ()
    start_distance_to_goal: float | None = None
    straight_distance_to_goal: float | None = None
    expert_actions: int | None = None
    expert_path_length: float | None = None
    expert_success: bool | None = None
    start: Mapping[str, Any] | None = dataclasses.field(default=None, hash=False)
    goal: Mapping[str, Any] | None = dataclasses.field(default=None, hash=False)
    source_id: str | None = None
    source_distance_to_goal: float | None = None

    @property
    def stated(self) -> dict[str, Any] | None:
        """What it states of start and goal, as the engine takes it; ``None``: all is drawn."""
        row = {"start": self.start, "goal": self.goal}
        return {name: value for name, value in row.items() if value is not None} or None

    def as_dict(self) -> dict[str, Any]:
        """A line of a file, without the fields that are ``None``."""
        row = {name: getattr(self, name) for name in _CHECKS}
        return {name: value for name, value in row.items() if value is not None}

    def asked(self) -> dict[str, Any]:
        """What an environment must find when it plays the episode.

        Distances and the start are told to the millimetre, where it faces to a tenth of a degree.
        """
        distance_m = self.start_distance_to_goal
        return {
            "instruction": self.instruction,
            "goal_kind": self.goal_kind,
            "goal_class": self.goal_class,
            "goal_objects": list(self.goal_objects),
            "goal_rooms": list(self.goal_rooms),
            "start_distance_to_goal": None if distance_m is None else round(distance_m, 3),
            "start_position": [round(part, 3) + 0.0 for part in self.start_position],
            # Zeros have no sign, and a whole turn is none.
            "start_yaw_deg": round(self.start_yaw_deg % 360.0, 1) % 360.0,
            **(self.stated or {}),
        }

    @classmethod
    def of_dict(cls, row: object) -> Episode:
        """The episode of a line.

        Raises:
            ConfigError: A field is unknown, missing or wrong; the message begins with its name.
        """
        fields = _fields("an episode", row, _CHECKS, _OPTIONAL)
        if fields["episode_id"] != f"{fields['scene_id']}#{fields['seed']}":
            raise ConfigError(
                f"episode_id is {quoted(fields['episode_id'])}; expected scene_id#seed, "
                f"{quoted(fields['scene_id'] + '#' + str(fields['seed']))}"
            )
        return cls(**fields)


class EpisodeFile:
    """A file of episodes: its header, and its episodes as one goes through it, again and again.

    Going through it checks every line; that no episode stands in it twice, environments check.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Reads the header.

        Raises:
            MeasuredDataError: There is none, or it is none of this version.
            ConfigError: ``path`` is no path.
            OSError: The system refuses, or it is no regular file.
        """
        self.path = arguments.file_path("path", path)
        with open_file(self.path) as file:
            _, line = next(self._numbered(file), (1, b""))
        with self._at(1):
            self.header = _header(_parsed(line))

    def __iter__(self) -> Iterator[Episode]:
        """The episodes in order.

        Raises:
            MeasuredDataError: A line is wrong, or there are more or fewer than the header says;
                the message names file, line and field.
            OSError: The system refuses.
        """
        for _, one in self.placed():
            yield one

    def line_at(self, offset: int) -> Episode:
        """The episode whose line begins at a byte of the file.

        Raises:
            MeasuredDataError: There is none, since the file has changed.
            OSError: The system refuses.
        """
        with open_file(self.path) as file, _Place(f"{self.path} at byte {offset}"):
            file.seek(offset)
            try:
                line = next(lines(file, self.path, _MAX_LINE_BYTES), b"")
            except ValueError as error:
                raise ConfigError(str(error)) from None
            return Episode.of_dict(_parsed(line))

    def placed(self) -> Iterator[tuple[int, Episode]]:
        """The episodes in order, each with the byte at which its line begins.

        Raises:
            MeasuredDataError: As of going through them.
            OSError: The system refuses.
        """
        expected, number, offset = len(self.header.places), 1, 0
        with open_file(self.path) as file:
            for number, line in self._numbered(file):
                with self._at(number):
                    if number - 1 > expected:
                        raise ConfigError(
                            f"one episode more than the {expected} that the header says"
                        )
                    if number > 1:
                        yield offset, Episode.of_dict(_parsed(line))
                offset += len(line)
        if number - 1 < expected:
            raise MeasuredDataError(
                f"{self.path} line {number}: the file ends after {number - 1} of {expected} "
                "episodes: it was cut; dwell.episodes.write writes some of a file's episodes"
            )

    def _numbered(self, file: Any) -> Iterator[tuple[int, bytes]]:  # noqa: ANN401 - an open file
        rows = lines(file, self.path, _MAX_LINE_BYTES)
        number = 0
        while True:
            try:
                line = next(rows, None)
            except ValueError as error:
                raise MeasuredDataError(str(error)) from None
            if line is None:
                return
            number += 1
            yield number, line

    def in_header(self) -> _Place:
        """Errors in the block begin with the place of the header."""
        return self._at(1)

    def _at(self, number: int) -> _Place:
        return _Place(f"{self.path} line {number}")


class _Place:
    """Errors in the block begin with a place in a file."""

    def __init__(self, at: str) -> None:
        self._at = at

    def __enter__(self) -> None:
        """Begins."""

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        """Names the place."""
        if isinstance(error, ConfigError):
            raise MeasuredDataError(f"{self._at}: {error}") from None


def _parsed(line: bytes) -> Any:  # noqa: ANN401 - any JSON value
    if not line:
        raise ConfigError("the file is empty; expected a header")
    try:
        return parse_json(line, "no episode")
    except ValueError as error:
        cut = "" if line.endswith(b"\n") else "the line has no end, the file was cut: "
        raise ConfigError(f"{cut}{error}") from None


def _header(row: object) -> Header:
    if not isinstance(row, dict) or row.get("format") != _FORMAT:
        raise ConfigError(
            f'format: no header of episodes; a file begins with {{"format": "{_FORMAT}", ...}}'
        )
    if row.get("version") != _VERSION or isinstance(row["version"], bool):
        raise ConfigError(f"version is {quoted(row.get('version'))}; this dwell reads {_VERSION}")
    own = {name: value for name, value in row.items() if name not in ("format", "version")}
    fields = _fields("a header", own, _HEADER_CHECKS, set())
    task_of(fields["task"])
    return Header(**fields)


def _fields(
    of: str,
    row: object,
    checks: Mapping[str, Callable[[str, object], Any]],
    optional: set[str],
) -> dict[str, Any]:
    """The fields of a line, each checked by its own rule."""
    if not isinstance(row, dict):
        raise ConfigError(f"found {quoted(row, 60)}; expected {of}, one JSON object")
    for name in row:
        if name not in checks:
            raise ConfigError(
                f"{quoted(name, 60)}: no field of {of}; {allowed_values(name, checks)}"
            )
    for name in checks:
        if name not in row and name not in optional:
            raise ConfigError(f"{name}: missing; {of} has it")
    return {name: checks[name](name, value) for name, value in row.items()}


def task_of(name: str, at: str = "task") -> dict[str, Any]:
    """What the engine says of a task of one agent: name, version, settings, sensors, max_steps.

    Raises:
        ConfigError: There is none of the name; the message begins with ``at``.
    """
    tasks = {task["name"]: task for task in _native.tasks()}
    of_one = {name: task for name, task in tasks.items() if task["min_agents"] == 1}
    if text(at, name) in tasks and name not in of_one:
        several = f"{at} is {name!r}, a task of several agents, and here one acts"
        raise ConfigError(f"{several}; {several_agents(name)}")
    if name not in of_one:
        raise ConfigError(f"{at} is {quoted(name)}; {allowed_values(name, of_one)}")
    return of_one[name]


def several_agents(task: str) -> str:
    """What has a task of several agents, as the end of a sentence."""
    return f"make it with dwell.pettingzoo.parallel_env({task!r}, ...), env or vector_env"


def _numbers(name: str, value: object) -> tuple[int, ...]:
    rows = sequence_items(name, value, "expected a list of ids")
    return tuple(integer_in_range(f"{name}[{k}]", row) for k, row in enumerate(rows))


def _distance(name: str, value: object) -> float:
    return number_in_range(name, value, 0.0, 1e6, "m")


def _houses(name: str, value: object) -> tuple[str, ...]:
    return tuple(text_list(name, value))


def _shard(name: str, value: object) -> tuple[int, int]:
    rows = sequence_items(name, value, "expected [K, N]")
    if len(rows) != 2:
        raise ConfigError(f"{name} is {quoted(value)}; expected [K, N]")
    shards = integer_in_range(f"{name}[1]", rows[1], low=1)
    return integer_in_range(f"{name}[0]", rows[0], high=shards - 1), shards


_HEADER_CHECKS: dict[str, Callable[[str, object], Any]] = {
    "task": text,
    "task_version": integer_in_range,
    "task_settings": mapping,
    "houses": _houses,
    "seed": integer_in_range,
    "count": integer_in_range,
    "shard": _shard,
    "made_by": dwell_version,
}
_CHECKS: dict[str, Callable[[str, object], Any]] = {
    "episode_id": text,
    "scene_id": text,
    "seed": integer_in_range,
    "instruction": text,
    "goal_kind": text,
    "goal_class": text,
    "goal_objects": _numbers,
    "goal_rooms": _numbers,
    "start_distance_to_goal": _distance,
    "straight_distance_to_goal": _distance,
    "start_position": point,
    "start_yaw_deg": finite_number,
    "expert_actions": integer_in_range,
    "expert_path_length": _distance,
    "expert_success": boolean,
    "start": checked_part,
    "goal": checked_part,
    "source_id": text,
    "source_distance_to_goal": _distance,
}
_OPTIONAL = {
    field.name for field in dataclasses.fields(Episode) if field.default is not dataclasses.MISSING
}


def read(path: str | os.PathLike[str]) -> EpisodeFile:
    """Opens a file of episodes; only its header is read yet.

    Raises:
        MeasuredDataError: It is no file of episodes; the message names line and field.
        OSError: The system refuses, or it is no regular file.

    Examples:
        >>> import tempfile
        >>> import dwell
        >>> from dwell.episode_maker import EpisodeMaker
        >>> maker = EpisodeMaker("PointNav", ["builtin:studio"], count=4, seed=1)
        >>> folder = tempfile.mkdtemp()
        >>> dwell.episodes.write(f"{folder}/all.jsonl", maker.header, maker.episodes())
        4
        >>> made = dwell.episodes.read(f"{folder}/all.jsonl")
        >>> near = [one for one in made if one.start_distance_to_goal < 6.0]
        >>> dwell.episodes.write(f"{folder}/near.jsonl", made.header, near) == len(near)
        True
    """
    return EpisodeFile(path)


def write(path: str | os.PathLike[str], header: Header, episodes: Iterable[Episode]) -> int:
    """Writes episodes, whole or not at all; the header's ``count`` and ``shard`` become theirs.

    Args:
        path: The file.
        header: What they have in common.
        episodes: The episodes, such as some of those of another file.

    Returns:
        How many there are.

    Raises:
        ConfigError: A header or an episode is none, or there are no episodes.
        OSError: The system refuses.
    """
    given: object = header
    if not isinstance(given, Header):
        raise ConfigError(
            f"header is {quoted(given)}; expected that of a file, dwell.episodes.Header"
        )
    place = arguments.file_path("path", path)
    with atomic_write(place) as draft:
        # The header says how many follow, which is known at the end.
        body = draft.with_name(f"{draft.name}-body")
        count = 0
        with body.open("w", encoding="utf-8") as file:
            rows: Iterable[object] = episodes
            for count, one in enumerate(rows, start=1):
                if not isinstance(one, Episode):
                    at = f"episodes[{count - 1}] is {quoted(one)}"
                    raise ConfigError(f"{at}; expected a dwell.episodes.Episode")
                row = one.as_dict()
                Episode.of_dict(row)
                file.write(line_of(row))
        if not count:
            raise ConfigError("episodes: there are none; a file has at least one")
        with draft.open("w", encoding="utf-8") as file, body.open(encoding="utf-8") as made:
            file.write(line_of(dataclasses.replace(header, count=count, shard=(0, 1)).as_dict()))
            shutil.copyfileobj(made, file)
    return count


def line_of(row: Mapping[str, Any]) -> str:
    """A line of a file."""
    return json.dumps(row, ensure_ascii=False) + "\n"
