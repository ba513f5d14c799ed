"""Results of evaluations are checked: their actions are played again."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from dwell import ConfigError, DwellError, _native
from dwell.arguments import quoted
from dwell.episode_maker import expert_run
from dwell.episodes import Episode, Header, task_of
from dwell.evaluation import EpisodeSet, Evaluation
from dwell.evaluation_summary import METRICS, is_same, summary
from dwell.played_actions import element_of, refuse_other_form, unpacked, written_action
from dwell.policies import BASELINES, name_of, policy_of
from dwell.policy_source import source_hash
from dwell.replay_sensors import picture_kinds
from dwell.result_fields import checked_result
from dwell.stated_episodes import checked_episode
from dwell.verified_origin import origin_differences

if TYPE_CHECKING:
    from dwell.envs import DwellEnv

#: Of an episode that is played again, what is given and not found.
_GIVEN = ("episode_id", "scene_id", "seed", "stated")
#: What an evaluation says of itself that is checked in another way than by comparing.
_TOLD = (
    "policy",
    "policy_source",
    "houses",
    "seed",
    "made_by",
    "sensors",
    "episode_files",
)


class _EndError(Exception):
    """There are no actions left, and the episode goes on."""


class _Stated:
    """A policy that does what a result states, and compares it with what a baseline does."""

    def __init__(self) -> None:
        self.env: DwellEnv | None = None
        #: The baseline that the result is said to be of.
        self.rule: Any = None
        self.begin([], None)

    def begin(self, actions: list[Any], answer: Mapping[str, Any] | None) -> None:
        """The actions of the next episode; the answer counts with the last."""
        self.actions, self.answer, self.at = actions, answer, 0
        #: The first action that the baseline does not take: its place and what it does.
        self.other: tuple[int, Any] | None = None

    def reset(self, observation: Mapping[str, Any], info: Mapping[str, Any]) -> None:
        """Begins an episode."""
        if hasattr(self.rule, "reset"):
            self.rule.reset(observation, info)

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        """The next action."""
        if self.at == len(self.actions):
            raise _EndError
        assert self.env is not None
        action = self.actions[self.at]
        if self.rule is not None and self.other is None:
            own, answer = written_action(self.rule.act(observation), self.env)
            is_last = self.at == len(self.actions) - 1
            if not is_same(own, action) or (is_last and not is_same(answer, self.answer)):
                self.other = self.at, own if not is_same(own, action) else answer
        self.at += 1
        return element_of(action, self.answer, self.env)


def compared(
    result: Mapping[str, Any],
    progress: Callable[[float, str], None],
    *,
    policy: object = None,
    files: EpisodeSet | None = None,
) -> list[str]:
    """What of a result does not hold, a sentence each; see :func:`dwell.evaluation.differences`."""
    row, told = checked_result(result)
    if told:
        return told
    stated = _Stated()
    try:
        job = _job(row, stated)
        for name, value in job.about.items():
            if name in _TOLD:
                continue
            if isinstance(value, Mapping):
                told += _parts(name, row[name], value, "played it is")
            elif not is_same(value, row[name]):
                told.append(_differs(name, row[name], value))
        told += _policy(row, job, stated, policy)
        told += origin_differences(row, files, counts_expert=job.counts_expert)
        told += _specs(row, job)
        rows: list[dict[str, Any]] = row["episodes"]
        played: list[dict[str, Any]] = []
        for k, episode in enumerate(rows):
            told += _episode(k, episode, job, stated, row["actions"], played)
            progress((k + 1) / len(rows), job.episodes[k].scene_id)
        # Nobody knows the means of episodes of which one cannot be played.
        is_whole = len(played) == len(rows)
        by = "played it is" if is_whole else "by the episodes that it states it is"
        for name, value in summary(played if is_whole else _with_measures(rows, job)).items():
            told += _parts(name, row[name], value, by)
    except DwellError as error:
        told.append(str(error))
    return told


def _job(result: Mapping[str, Any], stated: _Stated) -> Evaluation:
    """The evaluation that a result is of."""
    task = result["task"]
    # Experts are counted for all episodes of a file, or for none.
    is_counted = len(result["episode_files"]) < 2 and any(
        row["expert_actions"] is not None for row in result["episodes"]
    )
    episodes = [
        Episode(
            episode_id=f"{row['scene_id']}#{row['seed']}",
            scene_id=row["scene_id"],
            seed=row["seed"],
            start_position=(0.0, 0.0, 0.0),
            start_yaw_deg=0.0,
            expert_actions=row["expert_actions"],
            expert_success=is_counted or row["expert_actions"] is not None,
            **(checked_episode("stated", row.get("stated", {})) or {}),
        )
        for row in result["episodes"]
    ]
    header = Header(
        task=task["name"],
        task_version=task["version"],
        task_settings=task["settings"],
        houses=tuple(result["houses"]),
        seed=result["seed"] or 0,
        count=len(episodes),
    )
    known = {row["name"]: row["version"] for row in _native.tasks()}
    if known.get(header.task, header.task_version) != header.task_version:
        raise ConfigError(
            f"task: the result is of version {header.task_version} of {header.task}, this dwell "
            f"has version {known[header.task]}"
        )
    job = Evaluation(
        stated,
        EpisodeSet(header, episodes),
        sensors=_without_pictures(result["sensors"]["settings"]),
        stride=result["stride"],
        action_mode=result["action_mode"],
        max_steps=result["max_steps"],
    )
    stated.env = job.env
    return job


def _policy(
    result: Mapping[str, Any], job: Evaluation, stated: _Stated, policy: object
) -> Iterator[str]:
    """What is said of the policy and is not so."""
    name, source = result["policy"], result["policy_source"]
    if name in BASELINES:
        stated.rule = policy_of(name, job.env)
        if source is not None:
            yield f"policy_source: the file states {quoted(source)}; {name} is dwell's own, of None"
    elif ":" not in name:
        known = ", ".join(BASELINES)
        yield f"policy: the file states {quoted(name)}; allowed are {known} and 'module:Name'"
    if policy is None:
        return
    if name_of(policy) != name:
        yield f"policy: the file states {quoted(name)}, given is {quoted(name_of(policy))}"
        return
    own = None if name in BASELINES else source_hash(policy, policy_of(policy, job.env))
    if own != source:
        yield (
            f"policy_source: the file states {quoted(source)}, that of the policy given is "
            f"{quoted(own)}: it has changed since"
        )


def _without_pictures(sensors: Mapping[str, Any]) -> dict[str, Any]:
    """Those that are no pictures, on which no bit of a world depends; one at least."""
    pictures = picture_kinds()
    kept = {name: own for name, own in sensors.items() if own.get("kind", name) not in pictures}
    return kept or {"gps": {}}


def _specs(result: Mapping[str, Any], job: Evaluation) -> Iterator[str]:
    """The sensors' specifications that do not follow from their settings, pictures included."""
    from dwell.envs import DwellEnv

    settings = result["sensors"]["settings"]
    if not settings:
        yield "sensors.settings: found none; expected at least one sensor"
        return
    try:
        env = DwellEnv(
            result["task"]["name"],
            houses=job.episodes[0].scene_id,
            sensors=settings,
            task_settings=result["task"]["settings"],
        )
    except DwellError as error:
        yield f"sensors.settings: {error}"
        return
    found = {row["name"]: row for row in env._runner.batch.specs()}
    env.close()
    stated = {row["name"]: row for row in result["sensors"]["observations"]}
    for name in dict.fromkeys([*found, *stated]):
        if not is_same(stated.get(name), found.get(name)):
            at = f"sensors.observations: {name}"
            yield _differs(at, stated.get(name), found.get(name))


def _episode(
    k: int,
    row: Mapping[str, Any],
    job: Evaluation,
    stated: _Stated,
    names: list[str],
    rows: list[dict[str, Any]],
) -> Iterator[str]:
    """What of an episode does not hold; ``rows`` takes what it is when it is played."""
    at, one = f"episodes[{k}]", job.episodes[k]
    try:
        actions = _as_numbered_here(at, unpacked(f"{at}.actions", row["actions"]), job, names)
        stated.begin(actions, row.get("answer"))
        if row["episode_id"] != one.episode_id:
            yield _differs(f"{at}.episode_id", row["episode_id"], one.episode_id)
        played = job.play(_asked(job, one))
    except _EndError:
        yield f"{at}.actions: after all {len(actions)} the episode goes on"
        return
    except DwellError as error:
        yield f"{error}" if str(error).startswith(at) else f"{at}: {error}"
        return
    rows.append(played)
    if left := len(actions) - stated.at:
        yield f"{at}.actions: the episode ends, and {left} actions are left"
    if stated.other is not None:
        place, own = stated.other
        told = f"{_said(actions[place], names)}, the policy does {_said(own, names)}"
        yield f"{at}.actions: action {place} of {len(actions)}: the file states {told}"
    for name, value in played.items():
        if name in _GIVEN or name == "actions":
            continue
        if name not in row:
            yield f"{at}.{name}: missing; played it is {quoted(value)}"
        elif not is_same(value, row[name]):
            yield _differs(f"{at}.{name}", row[name], value)
    for name in row:
        if name not in played:
            yield f"{at}.{name}: no field of an episode; metrics are {', '.join(METRICS)}"


def _as_numbered_here(at: str, actions: list[Any], job: Evaluation, names: list[str]) -> list[Any]:
    """The actions by the numbers that this version of dwell has for them.

    Raises:
        ConfigError: One is none.
    """
    if job.about["action_mode"] != "discrete":
        refuse_other_form(f"{at}.actions", actions, job.env)
        return actions
    there = job.env.actions()
    now = {number: there.index(name) for number, name in enumerate(names) if name in there}
    for number in actions:
        if not isinstance(number, int) or number not in now:
            raise ConfigError(f"{at}.actions: no action has the number {quoted(number, 60)}")
    return [now[number] for number in actions]


def _said(action: object, names: list[str]) -> str:
    if isinstance(action, int) and 0 <= action < len(names):
        return f"{action} ({names[action]})"
    return quoted(action)


def _asked(job: Evaluation, one: Episode) -> Episode:
    """An episode with what it asks, as it is found when it begins, and what its expert needs."""
    _, info = job.env.reset(seed=0, options=job.options(one))
    expert: dict[str, Any] = {}
    if one.expert_success:
        most = int(task_of(job.about["task"]["name"])["max_steps"])
        expert = expert_run(job.env._runner, most)
    return dataclasses.replace(
        one,
        goal_kind=info.get("goal_kind"),
        goal_class=info.get("goal_class"),
        start_distance_to_goal=info.get("start_distance_to_goal"),
        **expert,
    )


def _with_measures(rows: list[dict[str, Any]], job: Evaluation) -> list[dict[str, Any]]:
    """The rows with the task's measures alone, as numbers; what else there is was told."""
    measures = job.env._measures
    known = [{name: row.get(name) for name in measures} for row in rows]
    for k, row in enumerate(known):
        for name, value in row.items():
            if value is not None and not isinstance(value, bool | int | float):
                raise ConfigError(f"episodes[{k}].{name} is {quoted(value)}; expected a number")
    of_tasks = {measure["name"] for task in _native.tasks() for measure in task["measures"]}
    return [
        {name: part for name, part in row.items() if name not in of_tasks} | own
        for row, own in zip(rows, known, strict=True)
    ]


def _parts(name: str, stated: object, value: object, by: str) -> Iterator[str]:
    """The parts of two values that do not hold, by their places; ``by``: what the second is by."""
    if is_same(stated, value):
        return
    if isinstance(value, Mapping) and isinstance(stated, Mapping) and stated.keys() == value.keys():
        for key, part in value.items():
            yield from _parts(f"{name}.{key}", stated[key], part, by)
    elif isinstance(value, list) and isinstance(stated, list) and len(stated) == len(value):
        for k, part in enumerate(value):
            yield from _parts(f"{name}[{k}]", stated[k], part, by)
    else:
        yield _differs(name, stated, value, by)


def _differs(name: str, stated: object, found: object, by: str = "played it is") -> str:
    return f"{name}: the file states {quoted(stated)}, {by} {quoted(found)}"
