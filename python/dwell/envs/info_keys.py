"""The keys of infos, and the infos of a step of several environments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Keys of a step's answer that become ``info``; those of :data:`GOAL_KEYS` are NaN without a goal.
INFO_KEYS = (
    "success",
    "action_success",
    "collision",
    "distance_to_goal",
    "spl",
    "soft_spl",
    "path_length",
    "collisions",
)

#: What there is only where a task has a goal to go to.
GOAL_KEYS = ("distance_to_goal", "spl", "soft_spl")

#: What stays the same in an episode; what it asks for is there only where the task of the engine
#: has a goal, and ``goal_class`` where that goal is of a class.
EPISODE_KEYS = (
    "scene_id",
    "episode_id",
    "goal_kind",
    "goal_class",
    "goal_objects",
    "goal_rooms",
    "start_distance_to_goal",
)


def step_info(answer: Mapping[str, Any], measures: Sequence[str], row: int = 0) -> dict[str, Any]:
    """What a step's answer says of one agent; what is not known is left out.

    Args:
        answer: The engine's answer by name, an element for each environment and agent.
        measures: What the agent's task measures beside distance and path.
        row: Which element.
    """
    info: dict[str, Any] = {
        key: np.asarray(answer[key])[row].item() for key in (*INFO_KEYS, *measures)
    }
    unknown = (*GOAL_KEYS, *measures)
    info = {key: value for key, value in info.items() if key not in unknown or not isnan(value)}
    info["action_error"] = answer["action_error"][row]
    # Of tasks with an oracle, where it was asked something.
    if "reply" in answer and answer["reply"][row]:
        info["reply"] = answer["reply"][row]
    return info


def step_infos(
    answer: Mapping[str, Any], keys: Sequence[str], stepped: NDArray[np.bool_]
) -> dict[str, Any]:
    """What a step's answer says of several environments, with gymnasium's masks.

    Args:
        answer: The engine's answer by name, an element for each environment.
        keys: Those of it that become infos.
        stepped: Whose episodes have made a step, shape (n,).

    Returns:
        Arrays by name, and under ``_name`` where each is known: not of environments that made no
        step, nor what is NaN, whose key a single environment leaves out.
    """
    infos: dict[str, Any] = {}
    for key in keys:
        values = np.array(answer[key])
        if values.dtype.kind == "f":
            values[~stepped] = np.nan
            infos[key], infos[f"_{key}"] = values, ~np.isnan(values)
        else:
            infos[key], infos[f"_{key}"] = values, stepped.copy()
    infos["action_error"] = np.array(answer["action_error"], object)
    infos["_action_error"] = stepped.copy()
    if "reply" in answer:
        replies = np.array(answer["reply"], object)
        infos["reply"], infos["_reply"] = replies, stepped & (replies != "")
    return infos
