"""Results of evaluations are checked: their actions are played again."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from dwell import ConfigError, DwellError, _native
from dwell.arguments import integer_in_range, mapping, quoted, text, text_list
from dwell.episode_maker import expert_run
from dwell.episodes import Episode, Header, task_of
from dwell.evaluation import METRICS, EpisodeSet, Evaluation, is_same, summary, unpacked
from dwell.stated_episodes import checked_episode

#: Of an episode that is played again, what is given and not found.
_GIVEN = ("episode_id", "scene_id", "seed", "stated")
#: What an evaluation says of itself that follows from nothing else here.
_TOLD = ("policy", "houses", "seed", "made_by", "sensors", "episode_files")


class _Stated:
    """A policy that does what a result states."""

    def __init__(self) -> None:
        self.numbers: Iterator[int] = iter(())
        #: The answer, which counts with the last action.
        self.answer: object = None

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        """The next action; ``-1``, which is none, behind the last."""
        del observation
        number = next(self.numbers, -1)
        return number if self.answer is None else {"action": number, "answer": self.answer}


def compared(result: Mapping[str, Any], progress: Callable[[float, str], None]) -> list[str]:
    """What of a result does not hold, a sentence each; see :func:`dwell.evaluation.differences`."""
    told: list[str] = []
    try:
        rows = result["episodes"]
        if not isinstance(rows, list) or not rows:
            return [f"episodes: found {quoted(rows)}; expected a list of episodes"]
        stated = _Stated()
        job = _job(result, stated)
        for name, value in job.about.items():
            if name not in _TOLD and name not in result:
                told.append(f"{name}: missing; it is {quoted(value)}")
            elif name not in _TOLD and not is_same(value, result[name]):
                told.append(_differs(name, result[name], value))
        told += _specs(result, job)
        for k, row in enumerate(rows):
            told += _episode(f"episodes[{k}]", row, job, stated, result["actions"])
            progress((k + 1) / len(rows), job.episodes[k].scene_id)
        for name, value in summary(rows).items():
            told += _parts(name, result.get(name), value)
        known = {*job.about, *summary(rows), "episodes"}
        told += [f"{name}: no field of a result" for name in result if name not in known]
    except KeyError as error:
        told.append(f"{error.args[0]}: missing; a result has it")
    except (DwellError, TypeError, AttributeError) as error:
        told.append(str(error))
    return told


def _job(result: Mapping[str, Any], stated: _Stated) -> Evaluation:
    """The evaluation that a result is of."""
    task = mapping("task", result["task"])
    episodes = []
    for k, row in enumerate(result["episodes"]):
        fields = mapping(f"episodes[{k}]", row)
        scene = text(f"episodes[{k}].scene_id", fields["scene_id"])
        seed = integer_in_range(f"episodes[{k}].seed", fields["seed"])
        count = fields["expert_actions"]
        episodes.append(
            Episode(
                episode_id=f"{scene}#{seed}",
                scene_id=scene,
                seed=seed,
                start_position=(0.0, 0.0, 0.0),
                start_yaw_deg=0.0,
                expert_actions=None if count is None else integer_in_range("expert_actions", count),
                expert_success=count is not None,
                **(checked_episode("stated", fields.get("stated", {})) or {}),
            )
        )
    header = Header(
        task=text("task.name", task["name"]),
        task_version=integer_in_range("task.version", task["version"]),
        task_settings=mapping("task.settings", task["settings"]),
        houses=tuple(text_list("houses", result["houses"])),
        seed=integer_in_range("seed", result["seed"]),
        count=len(episodes),
    )
    known = {row["name"]: row["version"] for row in _native.tasks()}
    if known.get(header.task, header.task_version) != header.task_version:
        raise ConfigError(
            f"task: the result is of version {header.task_version} of {header.task}, this dwell "
            f"has version {known[header.task]}"
        )
    sensors = mapping("sensors.settings", mapping("sensors", result["sensors"])["settings"])
    return Evaluation(
        stated,
        EpisodeSet(header, episodes),
        sensors=_without_pictures(sensors),
        stride=mapping("stride", result["stride"]),
        max_steps=integer_in_range("max_steps", result["max_steps"], low=1),
    )


def _without_pictures(sensors: Mapping[str, Any]) -> dict[str, Any]:
    """Those that are no pictures, on which no bit of a world depends; one at least."""
    pictures = {row["name"] for row in _native.sensors() if row["picture_style"] is not None}
    kept = {
        name: own
        for name, own in sensors.items()
        if (own.get("kind", name) if isinstance(own, Mapping) else name) not in pictures
    }
    return kept or {"gps": {}}


def _specs(result: Mapping[str, Any], job: Evaluation) -> Iterator[str]:
    """The sensors' specifications that do not hold: of those that are played again."""
    stated = {row["name"]: row for row in mapping("sensors", result["sensors"])["observations"]}
    for row in job.about["sensors"]["observations"]:
        found = stated.get(row["name"])
        if found is not None and not is_same(row, found):
            yield _differs(f"sensors.observations: {row['name']}", found, row)


def _episode(
    at: str, row: Mapping[str, Any], job: Evaluation, stated: _Stated, names: object
) -> Iterator[str]:
    """What of an episode does not hold."""
    there = job.env.actions()
    now = {
        number: there.index(name)
        for number, name in enumerate(text_list("actions", names))
        if name in there
    }
    numbers = unpacked(f"{at}.actions", row["actions"])
    if unknown := next((number for number in numbers if number not in now), None):
        yield f"{at}.actions: no action has the number {unknown}"
        return
    stated.answer = row.get("answer")
    stated.numbers = (now[number] for number in numbers)
    one = job.episodes[int(at.partition("[")[2][:-1])]
    if row.get("episode_id") != one.episode_id:
        yield _differs(f"{at}.episode_id", row.get("episode_id"), one.episode_id)
    try:
        played = job.play(_asked(job, one))
    except ConfigError as error:
        if "the policy's action" in str(error):
            yield f"{at}.actions: after all {len(numbers)} the episode goes on"
        else:
            yield f"{at}: {error}"
        return
    left = len([*stated.numbers])
    if left:
        yield f"{at}.actions: the episode ends, and {left} actions are left"
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


def _asked(job: Evaluation, one: Episode) -> Episode:
    """An episode with what it asks, as it is found when it begins, and what its expert needs."""
    _, info = job.env.reset(seed=0, options=job.options(one))
    expert: dict[str, Any] = {}
    if one.expert_actions is not None:
        most = int(task_of(job.about["task"]["name"])["max_steps"])
        expert = expert_run(job.env._runner, most)
    return dataclasses.replace(
        one,
        goal_kind=info.get("goal_kind"),
        goal_class=info.get("goal_class"),
        start_distance_to_goal=info.get("start_distance_to_goal"),
        **expert,
    )


def _parts(name: str, stated: object, value: Mapping[str, Any]) -> Iterator[str]:
    """The parts of a mapping that do not hold, by their places."""
    if not isinstance(stated, Mapping) or stated.keys() != value.keys():
        if not is_same(stated, value):
            yield _differs(name, stated, value)
        return
    for key, part in value.items():
        if isinstance(part, Mapping):
            yield from _parts(f"{name}.{key}", stated[key], part)
        elif not is_same(stated[key], part):
            yield _differs(f"{name}.{key}", stated[key], part)


def _differs(name: str, stated: object, found: object) -> str:
    return f"{name}: the file states {quoted(stated)}, played it is {quoted(found)}"
