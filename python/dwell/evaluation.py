"""Policies are evaluated: all episodes of a file played, and a result that anybody can check.

``dwell evaluate`` is this as a command, ``docs/tutorials/evaluate.md`` an introduction.
"""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from dwell import ConfigError, MeasuredDataError, __version__, _native, arguments
from dwell.arguments import function_or_none, integer_in_range, mapping, plain_settings, quoted
from dwell.episode_maker import EpisodeMaker, whole_settings
from dwell.episodes import Episode, EpisodeFile, Header, read, task_of
from dwell.evaluation_summary import summary
from dwell.files import atomic_write, read_json
from dwell.house_list import HouseList
from dwell.played_actions import element_of, packed, written_action
from dwell.plugin_parts import refusing_exit
from dwell.policies import BASELINES, name_of, naming_policy, policy_of
from dwell.policy_source import file_digest, source_hash
from dwell.schemas import settings

#: What a result says of itself.
_FORMAT, _VERSION = "dwell-evaluation", 1
Sensors = Sequence[str] | Mapping[str, Mapping[str, Any]]
Progress = Callable[[float, str], None]


def _tell_nobody(fraction: float, what: str) -> None:
    pass


@dataclasses.dataclass(frozen=True)
class EpisodeSet:
    """The episodes of an evaluation, and where they come from.

    Attributes:
        header: What they have in common; of several files that of the first.
        episodes: The episodes.
        files: The files that they are read from.
        houses: The HOUSES strings of all files; ``None``: those of the header.
        has_one_seed: Whether all files were drawn from the header's seed.
    """

    header: Header
    episodes: Iterable[Episode]
    files: tuple[str, ...] = ()
    houses: tuple[str, ...] | None = None
    has_one_seed: bool = True

    @classmethod
    def of_files(cls, paths: Sequence[str | os.PathLike[str]]) -> EpisodeSet:
        """All episodes of files.

        Raises:
            MeasuredDataError: A file is none of episodes.
            ConfigError: They do not go together.
            OSError: The system refuses to read one.
        """
        from dwell.envs.episode_shelf import EpisodeIndex

        header = EpisodeIndex(paths).header
        files = [read(path) for path in paths]
        houses = dict.fromkeys(house for file in files for house in file.header.houses)
        return cls(
            header,
            _Chained(files),
            tuple(file.path for file in files),
            tuple(houses),
            all(file.header.seed == header.seed for file in files),
        )


class _Chained:
    """The episodes of several files, again and again."""

    def __init__(self, files: Sequence[EpisodeFile]) -> None:
        self._files = files

    def __iter__(self) -> Iterator[Episode]:
        return itertools.chain.from_iterable(self._files)


class Evaluation:
    """A policy, its episodes and how they are played."""

    @refusing_exit()
    def __init__(
        self,
        policy: object,
        episodes: EpisodeSet,
        *,
        sensors: Sensors | None = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        action_mode: str = "discrete",
        max_steps: int | None = None,
        threads: int | None = None,
    ) -> None:
        """Makes the environment; arguments as :func:`evaluate`."""
        from dwell.envs import DwellEnv

        header = episodes.header
        about = task_of(header.task)
        self.episodes = [*episodes.episodes]
        #: What makes the same evaluation in another process.
        self.recipe: dict[str, Any] = {
            "policy": policy,
            "episodes": dataclasses.replace(episodes, episodes=self.episodes),
            "sensors": sensors,
            "task_settings": task_settings,
            "stride": stride,
            "action_mode": action_mode,
            "max_steps": max_steps,
            "threads": threads,
        }
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
            action_mode=action_mode,
            max_episode_steps=most,
            threads=threads,
        )
        self._policy = policy_of(policy, self.env)
        self._name = name_of(policy)
        #: Whose errors are told as those of a policy.
        self._is_own = self._name not in BASELINES and not self._name.startswith("dwell.")
        usual = {row["name"]: row["schema"]["default"] for row in settings()["StepSizes"]}
        whole_stride = {**usual, **({} if stride is None else dict(stride))}
        #: Whether the actions of an expert compare: they were counted with the usual steps, as
        #: discrete ones.
        self.counts_expert = whole_stride == usual and action_mode == "discrete"
        #: What the result says beside its numbers.
        self.about: dict[str, Any] = {
            "format": _FORMAT,
            "version": _VERSION,
            "made_by": __version__,
            "policy": self._name,
            "policy_source": source_hash(policy, self._policy) if self._is_own else None,
            "task": {"name": header.task, "version": header.task_version, "settings": used},
            "success_distance_m": used.get("success_distance_m"),
            "houses": [*(header.houses if episodes.houses is None else episodes.houses)],
            "scene_ids": [*houses],
            "splits": sorted({_split_of(name) for name in houses}),
            "episode_files": [
                {"name": os.path.basename(file), "sha256": file_digest(file)}
                for file in episodes.files
            ],
            "seed": header.seed if episodes.has_one_seed else None,
            "count": len(self.episodes),
            "sensors": {
                "settings": plain_settings(_by_name(sensors), "sensors"),
                "observations": self.env._runner.batch.specs(),
            },
            "stride": whole_stride,
            "max_steps": most,
            "action_mode": action_mode,
            "actions": self.env.actions(),
            "sliding": True,
            "world": _native.World.of_env(self.env._runner.batch, 0).config(),
        }

    def _naming(self, one: Episode, step: int) -> contextlib.AbstractContextManager[None]:
        """Errors of a user's policy say where they were raised."""
        if not self._is_own:
            return contextlib.nullcontext()
        where = f"at step {step}" if step else "in reset, at the start"
        return naming_policy(self._name, f"{where} of episode {one.episode_id}")

    def options(self, one: Episode) -> dict[str, Any]:
        """The options with which the environment is reset to play an episode."""
        chosen: dict[str, Any] = {"episode_id": one.episode_id}
        if one.stated is not None and not self.about["episode_files"]:
            chosen["episode"] = one.stated
        return chosen

    @refusing_exit()
    def play(self, one: Episode) -> dict[str, Any]:
        """Plays an episode; gives what the result says of it.

        Raises:
            PolicyError: The policy raised something.
            UsageError: A sensor of one's own called ``sys.exit``.
            ConfigError: Its action is none of the environment's; the message names the step.
        """
        if not self.counts_expert:
            one = dataclasses.replace(one, expert_actions=None)
        observation, info = self.env.reset(seed=0, options=self.options(one))
        reset = getattr(self._policy, "reset", None)
        if reset is not None:
            with self._naming(one, 0):
                reset(observation, info)
        actions: list[Any] = []
        reward, is_over = 0.0, False
        while not is_over:
            with self._naming(one, len(actions) + 1):
                given = self._policy.act(observation)
            try:
                action, answer = written_action(given, self.env)
            except ConfigError as error:
                at = f"step {len(actions) + 1} of episode {one.episode_id}"
                raise ConfigError(f"{error}; at {at}") from None
            actions.append(action)
            element = element_of(action, answer, self.env)
            observation, paid, terminated, truncated, info = self.env.step(element)
            reward, is_over = reward + paid, terminated or truncated
        row = _row(one, info, actions, reward, self.env.state_hash())
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
    action_mode: str = "discrete",
    max_steps: int | None = None,
    threads: int | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Plays episodes with a policy.

    Args:
        policy: ``"random"``, ``"expert"``, ``"stop"``, ``"forward"`` (walks ahead and never
            stops), ``"ears"`` (goes to what the sensor ``audio`` hears); an object with
            ``act(observation)`` and, where it likes, ``reset(observation, info)``; a class or
            function that makes one; or its ``"module:Name"``.
        episodes: A file of ``dwell episodes``, or several; or else:
        task: The task's name, of which episodes are made,
        houses: in these HOUSES strings,
        count: so many,
        seed: from this seed.
        sensors: Names of sensors, or settings by name; default ``gps`` for the policies by name
            alone, the task's own sensors for others.
        task_settings: The task's settings; with ``episodes`` only ``reward`` and ``ends_at_goal``.
        stride: How far movement actions go.
        action_mode: The form of actions, as of :class:`dwell.envs.DwellEnv`.
        max_steps: Steps after which an episode is cut off; default the task's.
        threads: How many threads to use; results do not depend on it.
        workers: How many processes play, each with a policy of its own: the result is the same
            where an episode goes the same way whichever was played before it.
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
    from dwell.evaluation_workers import played_rows

    tell = function_or_none("progress", progress) or _tell_nobody
    which = episode_set(episodes, task, houses, count, seed, task_settings)
    job = Evaluation(
        policy,
        which,
        sensors=sensors,
        task_settings=task_settings,
        stride=stride,
        action_mode=action_mode,
        max_steps=max_steps,
        threads=threads,
    )
    rows = []
    for row in played_rows(job, job.episodes, workers=workers):
        rows.append(row)
        tell(len(rows) / len(job.episodes), row["scene_id"])
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
    one: Episode, info: Mapping[str, Any], actions: Sequence[Any], reward: float, state_hash: int
) -> dict[str, Any]:
    """What the result says of an episode."""
    first_m, last_m = one.start_distance_to_goal, info.get("distance_to_goal")
    success = bool(info["success"])
    sna = None
    if one.expert_actions is not None and one.expert_success:
        sna = success * one.expert_actions / max(one.expert_actions, len(actions))
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
        "na": len(actions),
        "sna": sna,
        "distance_to_goal": last_m,
        "normalized_distance_to_goal": last_m / first_m if last_m is not None and first_m else None,
        "path_length": float(info["path_length"]),
        "collisions": int(info["collisions"]),
        "steps": len(actions),
        "reward": reward,
        "actions": packed(actions),
        "state_hash": f"{state_hash:016x}",
        **({} if one.stated is None else {"stated": one.stated}),
    }


def result_of(about: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The result of an evaluation: what it was, means, groups, episodes."""
    return {**about, **summary(rows), "episodes": [*rows]}


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
    policy: object = None,
    episodes: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None = None,
    progress: Progress | None = None,
) -> list[str]:
    """What of a result does not hold when its actions are played again, a sentence each.

    Every stated number is compared: those of each episode, the hash of its end, means, intervals,
    groups, how the episodes were played, and that they come from the stated houses and seed. A
    baseline's actions are compared with what it does; of another policy the actions are taken as
    they are.

    Args:
        result: A result, or its file.
        policy: The policy that the result is of, as for :func:`evaluate`: its source is compared.
        episodes: The files of episodes that the result is of; they are compared. Needed where the
            episodes are not those that ``dwell episodes`` draws from the seed.
        progress: Is told how much is done, 0 to 1, and of which house.

    Returns:
        Nothing where all holds.

    Raises:
        MeasuredDataError: A file is no result.
        OSError: The system refuses to read it.
    """
    from dwell.verification import compared

    row = result if isinstance(result, Mapping) else read_result(result)
    files = None if episodes is None else episode_set(episodes, None, None, None)
    tell = function_or_none("progress", progress) or _tell_nobody
    return compared(row, tell, policy=policy, files=files)
