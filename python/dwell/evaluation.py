"""Policies are evaluated: all episodes of a file played, and a result that anybody can check.

``dwell evaluate`` is this as a command, ``docs/tutorials/evaluate.md`` an introduction.
"""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from dwell import ConfigError, MeasuredDataError, __version__, _native, arguments
from dwell.arguments import integer_in_range, mapping, plain_settings, quoted
from dwell.episode_maker import EpisodeMaker, whole_settings
from dwell.episodes import Episode, EpisodeFile, Header, read, task_of
from dwell.files import atomic_write, read_json
from dwell.house_list import HouseList
from dwell.policies import checked_action, name_of, policy_of
from dwell.schemas import settings

#: What a result says of itself.
_FORMAT, _VERSION = "dwell-evaluation", 1
#: Of the intervals: how many samples of episodes, with what seed, and how wide.
_RESAMPLES, _BOOTSTRAP_SEED, _LEVEL = 1000, 0, 0.95
#: What is averaged over episodes.
METRICS = (
    "success",
    "spl",
    "soft_spl",
    "sna",
    "distance_to_goal",
    "normalized_distance_to_goal",
    "path_length",
    "collisions",
    "steps",
    "reward",
)
#: What success is counted by.
_GROUPS = ("goal_kind", "goal_class")
#: Metrics of floats: equal where they differ by less than a text of JSON may round.
_TOLERANCE = 1e-9

Sensors = Sequence[str] | Mapping[str, Mapping[str, Any]]
Progress = Callable[[float, str], None]


@dataclasses.dataclass(frozen=True)
class EpisodeSet:
    """The episodes of an evaluation, and where they come from."""

    header: Header
    episodes: Iterable[Episode]
    files: tuple[str, ...] = ()

    @classmethod
    def of_files(cls, paths: Sequence[str | os.PathLike[str]]) -> EpisodeSet:
        """All episodes of files.

        Raises:
            MeasuredDataError: A file is none of episodes.
            ConfigError: They do not go together.
            OSError: The system refuses to read one.
        """
        from dwell.envs.episode_shelf import EpisodeIndex

        header = EpisodeIndex([*paths]).header
        files = [read(path) for path in paths]
        return cls(header, _Chained(files), tuple(file.path for file in files))


class _Chained:
    """The episodes of several files, again and again."""

    def __init__(self, files: Sequence[EpisodeFile]) -> None:
        self._files = files

    def __iter__(self) -> Iterator[Episode]:
        return itertools.chain.from_iterable(self._files)


class Evaluation:
    """A policy, its episodes and how they are played."""

    def __init__(
        self,
        policy: object,
        episodes: EpisodeSet,
        *,
        sensors: Sensors | None = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        max_steps: int | None = None,
        threads: int | None = None,
    ) -> None:
        """Makes the environment; arguments as :func:`evaluate`."""
        from dwell.envs import DwellEnv
        from dwell.policies import BASELINES

        header = episodes.header
        about = task_of(header.task)
        self.episodes = [*episodes.episodes]
        houses = HouseList()
        for name in dict.fromkeys(one.scene_id for one in self.episodes):
            houses.append_name(name)
        own = {} if task_settings is None else mapping("task_settings", task_settings)
        used = whole_settings(header.task, {**header.task_settings, **own})
        if sensors is None:
            is_blind = isinstance(policy, str) and policy in BASELINES
            sensors = ["gps"] if is_blind else about["sensors"]
        most = about["max_steps"] if max_steps is None else max_steps
        most = integer_in_range("max_steps", most, low=1)
        kwargs: dict[str, Any] = {"episodes": [*episodes.files], "houses": None}
        if not episodes.files:
            kwargs = {"houses": houses}
        self.env = DwellEnv(
            header.task,
            **kwargs,
            sensors=sensors,
            task_settings=own if episodes.files else used,
            stride=stride,
            max_episode_steps=most,
            threads=threads,
        )
        self._policy = policy_of(policy, self.env)
        usual = {row["name"]: row["schema"]["default"] for row in settings()["StepSizes"]}
        whole_stride = {**usual, **({} if stride is None else dict(stride))}
        #: The expert's actions were counted with the usual steps.
        self._has_usual_steps = whole_stride == usual
        files = [] if not episodes.files else [os.path.basename(file) for file in episodes.files]
        #: What the result says beside its numbers.
        self.about: dict[str, Any] = {
            "format": _FORMAT,
            "version": _VERSION,
            "made_by": __version__,
            "policy": name_of(policy),
            "task": {"name": header.task, "version": header.task_version, "settings": used},
            "success_distance_m": used.get("success_distance_m"),
            "houses": [*header.houses],
            "scene_ids": [*houses],
            "splits": sorted({_split_of(name) for name in houses}),
            "episode_files": files,
            "seed": header.seed,
            "count": len(self.episodes),
            "sensors": {
                "settings": plain_settings(_by_name(sensors), "sensors"),
                "observations": self.env._runner.batch.specs(),
            },
            "stride": whole_stride,
            "max_steps": most,
            "actions": self.env.actions(),
            "sliding": True,
            "world": _native.World.of_env(self.env._runner.batch, 0).config(),
        }

    def options(self, one: Episode) -> dict[str, Any]:
        """The options with which the environment is reset to play an episode."""
        chosen: dict[str, Any] = {"episode_id": one.episode_id}
        if one.stated is not None and not self.about["episode_files"]:
            chosen["episode"] = one.stated
        return chosen

    def play(self, one: Episode) -> dict[str, Any]:
        """Plays an episode; gives what the result says of it."""
        if not self._has_usual_steps:
            one = dataclasses.replace(one, expert_actions=None)
        observation, info = self.env.reset(seed=0, options=self.options(one))
        reset = getattr(self._policy, "reset", None)
        if reset is not None:
            reset(observation, info)
        numbers: list[int] = []
        reward, is_over = 0.0, False
        while not is_over:
            number, answer = checked_action(self._policy.act(observation), self.env)
            numbers.append(number)
            action = number if answer is None else {"action": number, "answer": answer}
            observation, paid, terminated, truncated, info = self.env.step(action)
            reward, is_over = reward + paid, terminated or truncated
        row = _row(one, info, numbers, reward, self.env.state_hash())
        if answer is not None:
            row["answer"] = answer
        return row | {name: info.get(name) for name in self.env._measures}


def evaluate(
    policy: object,
    *,
    episodes: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None = None,
    task: str | None = None,
    houses: str | Sequence[str] | None = None,
    count: int | None = None,
    seed: int = 0,
    sensors: Sensors | None = None,
    task_settings: Mapping[str, Any] | None = None,
    stride: Mapping[str, float] | None = None,
    max_steps: int | None = None,
    threads: int | None = None,
    progress: Progress = lambda fraction, what: None,
) -> dict[str, Any]:
    """Plays episodes with a policy.

    Args:
        policy: ``"random"``, ``"expert"``, ``"stop"``, ``"forward"`` (walks ahead and never
            stops); an object with ``act(observation)`` and, where it likes, ``reset(observation,
            info)``; a class or function that makes one; or its ``"module:Name"``.
        episodes: A file of ``dwell episodes``, or several; or else:
        task: The task's name, of which episodes are made,
        houses: in these HOUSES strings,
        count: so many,
        seed: from this seed.
        sensors: Names of sensors, or settings by name; default ``gps`` for the policies by name
            alone, the task's own sensors for others.
        task_settings: The task's settings; with ``episodes`` only ``reward`` and ``ends_at_goal``.
        stride: How far movement actions go.
        max_steps: Steps after which an episode is cut off; default the task's.
        threads: How many threads to use; results do not depend on it.
        progress: Is told how much is done, 0 to 1, and of which house.

    Returns:
        The result, as JSON holds it: how it was played, ``metrics`` (mean, and an interval that
        holds the mean with 95 %, by a bootstrap), ``by_goal_kind``, ``by_goal_class``, and
        ``episodes``, each with its metrics, its actions and the state's hash at the end.

    Raises:
        ConfigError: The arguments do not go together.
        MeasuredDataError: The file of episodes is none, or its episodes are others here.

    Examples:
        >>> from dwell.evaluation import evaluate, differences
        >>> result = evaluate(
        ...     "expert", task="PointNav", houses="builtin:studio", count=3, seed=1
        ... )
        >>> result["metrics"]["success"]["mean"], len(result["episodes"])
        (1.0, 3)
        >>> differences(result)
        []
    """
    which = episode_set(episodes, task, houses, count, seed, task_settings)
    job = Evaluation(
        policy,
        which,
        sensors=sensors,
        task_settings=task_settings,
        stride=stride,
        max_steps=max_steps,
        threads=threads,
    )
    rows = []
    for k, one in enumerate(job.episodes, start=1):
        rows.append(job.play(one))
        progress(k / len(job.episodes), one.scene_id)
    return result_of(job.about, rows)


def episode_set(
    episodes: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None,
    task: str | None,
    houses: str | Sequence[str] | None,
    count: int | None,
    seed: int = 0,
    task_settings: Mapping[str, Any] | None = None,
    *,
    expert: bool = False,
) -> EpisodeSet:
    """The episodes of files, or those that are made of a task; ``expert``: with its actions.

    Raises:
        ConfigError: Both are given, or neither.
    """
    if episodes is not None:
        if task is not None or houses is not None or count is not None:
            raise ConfigError("episodes: task, houses and count are those of the file; leave them")
        if isinstance(episodes, str | os.PathLike):
            return EpisodeSet.of_files([episodes])
        return EpisodeSet.of_files(episodes)
    if task is None or houses is None or count is None:
        raise ConfigError("expected a file of episodes; or task, houses and count to make some")
    maker = EpisodeMaker(
        task, houses, count=count, seed=seed, task_settings=task_settings, expert=expert
    )
    return EpisodeSet(maker.header, [*maker.episodes()])


def _split_of(house: str) -> str:
    """The split of a house's looks; of houses that no seed makes ``none``."""
    if not house.startswith("seed:"):
        return "none"
    found = [field[6:] for field in house.partition("?")[2].split("&") if field[:6] == "split="]
    return found[0] if found else "train"


def _by_name(sensors: Sensors) -> dict[str, Mapping[str, Any]]:
    return dict(sensors) if isinstance(sensors, Mapping) else {name: {} for name in sensors}


def _row(
    one: Episode, info: Mapping[str, Any], numbers: Sequence[int], reward: float, state_hash: int
) -> dict[str, Any]:
    """What the result says of an episode."""
    first_m, last_m = one.start_distance_to_goal, info.get("distance_to_goal")
    success = bool(info["success"])
    sna = None
    if one.expert_actions is not None and one.expert_success:
        sna = success * one.expert_actions / max(one.expert_actions, len(numbers))
    return {
        "episode_id": one.episode_id,
        "scene_id": one.scene_id,
        "seed": one.seed,
        "goal_kind": one.goal_kind,
        "goal_class": one.goal_class,
        "start_distance_to_goal": first_m,
        "expert_actions": one.expert_actions if one.expert_success else None,
        "success": success,
        "spl": info.get("spl"),
        "soft_spl": info.get("soft_spl"),
        "sna": sna,
        "distance_to_goal": last_m,
        "normalized_distance_to_goal": last_m / first_m if last_m is not None and first_m else None,
        "path_length": float(info["path_length"]),
        "collisions": int(info["collisions"]),
        "steps": len(numbers),
        "reward": reward,
        "actions": packed(numbers),
        "state_hash": f"{state_hash:016x}",
        **({} if one.stated is None else {"stated": one.stated}),
    }


def packed(numbers: Iterable[int]) -> str:
    """Actions as text, equal ones in a row together: ``1*12 3 0``."""
    runs = ((number, len([*same])) for number, same in itertools.groupby(numbers))
    return " ".join(f"{number}*{count}" if count > 1 else f"{number}" for number, count in runs)


def unpacked(name: str, written: object) -> list[int]:
    """The actions of :func:`packed`.

    Raises:
        ConfigError: It is none.
    """
    numbers: list[int] = []
    for word in arguments.text(name, written).split():
        number, _, count = word.partition("*")
        if not number.isdecimal() or not (count or "1").isdecimal() or len(word) > 20:
            raise ConfigError(f"{name}: found {quoted(word)}; expected NUMBER or NUMBER*COUNT")
        times = int(count or 1)
        if len(numbers) + times > 10_000_000:
            raise ConfigError(f"{name}: more than 10000000 actions")
        numbers += [int(number)] * times
    return numbers


def result_of(about: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The result of an evaluation: what it was, means, groups, episodes."""
    return {**about, **summary(rows), "episodes": [*rows]}


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Means with their intervals, and success by what was asked."""
    groups = {}
    for key in _GROUPS:
        names = sorted({row[key] for row in rows if row[key] is not None})
        groups[f"by_{key}"] = {
            name: _group([row for row in rows if row[key] == name]) for name in names
        }
    own = (measure["name"] for task in _native.tasks() for measure in task["measures"])
    measured = [name for name in own if all(name in row for row in rows)]
    return {
        "bootstrap": {"resamples": _RESAMPLES, "seed": _BOOTSTRAP_SEED, "level": _LEVEL},
        "metrics": {name: _mean([row[name] for row in rows]) for name in (*METRICS, *measured)},
        **groups,
    }


def _group(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {"episodes": len(rows)}
    for name in ("success", "spl"):
        values = [float(row[name]) for row in rows if row[name] is not None]
        found[name] = math.fsum(values) / len(values) if values else None
    return found


def _mean(values: Sequence[float | None]) -> dict[str, Any]:
    """The mean of those that there are, and a percentile interval by a bootstrap."""
    known = np.array([float(value) for value in values if value is not None])
    if not known.size:
        return {"episodes": 0, "mean": None, "low": None, "high": None}
    stream = np.random.default_rng(_BOOTSTRAP_SEED)
    means = [
        float(known[stream.integers(known.size, size=known.size)].mean()) for _ in range(_RESAMPLES)
    ]
    low, high = np.quantile(means, [(1 - _LEVEL) / 2, (1 + _LEVEL) / 2])
    mean = math.fsum(known.tolist()) / known.size
    return {"episodes": int(known.size), "mean": mean, "low": float(low), "high": float(high)}


def write_result(path: str | os.PathLike[str], result: Mapping[str, Any]) -> None:
    """Writes a result, whole or not at all.

    Raises:
        OSError: The system refuses.
    """
    with atomic_write(arguments.file_path("path", path)) as draft:
        draft.write_text(text_of(result), "utf-8")


def text_of(result: Mapping[str, Any]) -> str:
    """The text of a result's file: an episode a line."""
    rows = ",\n".join(f"  {json.dumps(row, ensure_ascii=False)}" for row in result["episodes"])
    head = json.dumps({**result, "episodes": []}, indent=1, ensure_ascii=False)
    return f"{head[: head.rindex('[]')]}[\n{rows}\n ]\n}}\n"


def read_result(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Reads a result.

    Raises:
        MeasuredDataError: It is none, or of another version.
        OSError: The system refuses, or it is no regular file.
    """
    name = arguments.file_path("path", path)
    try:
        row = read_json(name)
    except ValueError as error:
        if isinstance(error, OSError):
            raise
        raise MeasuredDataError(str(error)) from None
    if not isinstance(row, dict) or row.get("format") != _FORMAT:
        raise MeasuredDataError(f"{name}: format: no {_FORMAT} file")
    if row.get("version") != _VERSION or isinstance(row["version"], bool):
        told = quoted(row.get("version"))
        raise MeasuredDataError(f"{name}: version is {told}; this dwell reads {_VERSION}")
    return row


def differences(
    result: Mapping[str, Any] | str | os.PathLike[str],
    *,
    progress: Progress = lambda fraction, what: None,
) -> list[str]:
    """What of a result does not hold when its actions are played again, a sentence each.

    Every stated number is compared: those of each episode, the hash of its end, means, intervals,
    groups, and how the episodes were played.

    Args:
        result: A result, or its file.
        progress: Is told how much is done, 0 to 1, and of which house.

    Returns:
        Nothing where all holds.

    Raises:
        MeasuredDataError: A file is no result.
        OSError: The system refuses to read it.
    """
    from dwell.verification import compared

    row = result if isinstance(result, Mapping) else read_result(result)
    return compared(row, progress)


def is_same(one: object, other: object) -> bool:
    """Returns whether two values of JSON are the same, floats but for rounding."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(is_same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(itertools.starmap(is_same, pairs))
    if isinstance(one, bool) or isinstance(other, bool):
        return one is other
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)
    return one == other
