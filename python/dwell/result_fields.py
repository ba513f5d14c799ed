"""The fields of a result of an evaluation: what each may hold, told by its place."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from dwell import ConfigError
from dwell.arguments import (
    boolean,
    dwell_version,
    finite_number,
    integer_in_range,
    mapping,
    plain_settings,
    quoted,
    sequence_items,
    text,
    text_list,
)

_Check = Callable[[str, Any], Any]
#: Steps of an episode, at most.
_MOST_STEPS = 10_000_000
#: Episodes and actions of an expert, at most.
_MOST_COUNT = 2**31 - 1


def _count(low: int = 0, high: int = _MOST_COUNT) -> _Check:
    return lambda at, value: integer_in_range(at, value, low=low, high=high)


def _or_none(check: _Check) -> _Check:
    return lambda at, value: None if value is None else check(at, value)


def _matching(pattern: str, expected: str) -> _Check:
    def check(at: str, value: object) -> str:
        found = text(at, value)
        if not re.fullmatch(pattern, found):
            raise ConfigError(f"{at} is {quoted(found, 60)}; expected {expected}")
        return found

    return check


def _mapping_of(checks: Mapping[str, _Check]) -> _Check:
    """A mapping with all of some fields, and no others."""

    def check(at: str, value: object) -> dict[str, Any]:
        row = mapping(at, value)
        for name in checks:
            if name not in row:
                raise ConfigError(f"{at}.{name}: missing; a result has it")
        for name in row:
            if name not in checks:
                known = ", ".join(checks)
                raise ConfigError(
                    f"{at}.{quoted(name, 60)}: no field of a result; allowed: {known}"
                )
        return {name: checks[name](f"{at}.{name}", part) for name, part in row.items()}

    return check


def _list_of(check: _Check, expected: str) -> _Check:
    def checked(at: str, value: object) -> list[Any]:
        rows = sequence_items(at, value, f"expected {expected}")
        return [check(f"{at}[{k}]", row) for k, row in enumerate(rows)]

    return checked


def _named(at: str, value: object) -> dict[str, Any]:
    row = mapping(at, value)
    return {**row, "name": text(f"{at}.name", row.get("name"))}


def _by_name(at: str, value: object) -> dict[str, dict[str, Any]]:
    return {name: mapping(f"{at}.{name}", part) for name, part in mapping(at, value).items()}


def _actions(at: str, value: object) -> object:
    if isinstance(value, str):
        return text(at, value)
    return sequence_items(at, value, "expected text, or a list of [times, action]")


_HEX = "[0-9a-f]"
_NUMBER = _or_none(finite_number)
#: Of a result, beside its episodes.
_ABOUT: dict[str, _Check] = {
    "format": text,
    "version": _count(),
    "made_by": dwell_version,
    "policy": text,
    "policy_source": _or_none(_matching(f"{_HEX}{{64}}", "64 hexadecimal digits")),
    "task": _mapping_of({"name": text, "version": _count(), "settings": mapping}),
    "success_distance_m": _NUMBER,
    "houses": text_list,
    "scene_ids": text_list,
    "splits": text_list,
    "episode_files": _list_of(
        _mapping_of({"name": text, "sha256": _matching(f"{_HEX}{{64}}", "64 hexadecimal digits")}),
        "a list of files with name and sha256",
    ),
    "seed": _or_none(integer_in_range),
    "count": _count(low=1),
    "sensors": _mapping_of(
        {"settings": _by_name, "observations": _list_of(_named, "a list with a name each")}
    ),
    "stride": lambda at, value: {
        name: finite_number(f"{at}.{name}", part) for name, part in mapping(at, value).items()
    },
    "max_steps": _count(low=1, high=_MOST_STEPS),
    "action_mode": text,
    "actions": text_list,
    "sliding": boolean,
    "world": mapping,
    "bootstrap": mapping,
    "metrics": mapping,
    "by_goal_kind": mapping,
    "by_goal_class": mapping,
}
#: Of an episode; measures of tasks, and the answer, are there where the task has them.
_EPISODE: dict[str, _Check] = {
    "episode_id": text,
    "scene_id": text,
    "seed": integer_in_range,
    "goal_kind": _or_none(text),
    "goal_class": _or_none(text),
    "start_distance_to_goal": _NUMBER,
    "expert_actions": _or_none(_count(high=_MOST_STEPS)),
    "success": boolean,
    "spl": _NUMBER,
    "soft_spl": _NUMBER,
    "na": _count(high=_MOST_STEPS),
    "sna": _NUMBER,
    "distance_to_goal": _NUMBER,
    "normalized_distance_to_goal": _NUMBER,
    "path_length": finite_number,
    "collisions": _count(high=_MOST_STEPS),
    "steps": _count(high=_MOST_STEPS),
    "reward": finite_number,
    "actions": _actions,
    "state_hash": _matching(f"{_HEX}{{16}}", "16 hexadecimal digits"),
}


def checked_result(result: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """A result whose fields are of their kinds, and what is wrong with it, a sentence each.

    Returns:
        The result; what is wrong. Where anything is that others rest on, it is not gone on with.
    """
    told: list[str] = []
    try:
        row = mapping("the result", plain_settings(result, ""))
    except ConfigError as error:
        return {}, [str(error)]
    for name, check in _ABOUT.items():
        if name not in row:
            told.append(f"{name}: missing; a result has it")
            continue
        _tell(told, check, name, row[name])
    told += [
        f"{name}: no field of a result" for name in row if name not in _ABOUT and name != "episodes"
    ]
    episodes = row.get("episodes")
    if not isinstance(episodes, list) or not episodes:
        told.append(f"episodes: found {quoted(episodes, 60)}; expected a list of episodes")
        return row, told
    for k, episode in enumerate(episodes):
        at = f"episodes[{k}]"
        if not isinstance(episode, dict):
            told.append(f"{at} is {quoted(episode, 60)}; expected values by name")
            continue
        for name, check in _EPISODE.items():
            if name not in episode:
                told.append(f"{at}.{name}: missing; an episode has it")
                continue
            _tell(told, check, f"{at}.{name}", episode[name])
    return row, told


def _tell(told: list[str], check: _Check, at: str, value: object) -> None:
    try:
        check(at, value)
    except ConfigError as error:
        told.append(str(error))
