"""The environments: one section a task, with the observations of its own choice."""

from __future__ import annotations

import json
from typing import Any

from dwell import _native
from dwell.envs.info_keys import EPISODE_KEYS, GOAL_KEYS, INFO_KEYS
from dwell.schemas import settings
from pages import rust
from pages.observations import fields_table, observation_table, specifications
from pages.sources import ROOT
from pages.tables import code

_TASKS = "engine/world/src/tasks"


def _section(task: dict[str, Any]) -> str:
    name = str(task["name"])
    file = _file(name)
    sensors = [str(sensor) for sensor in json.loads(json.dumps(task["sensors"]))]
    return f"""## {task["id"]}

{rust.module(file)}

- {_limit(task)}
- Actions: [those of all environments](actions.md#discrete).

### Observations of {name}

Without `sensors`; [all that can be asked for](observations.md).

{observation_table(specifications(sensors, name))}
### Settings of {name}

{_settings(task["settings"])}"""


def _limit(task: dict[str, Any]) -> str:
    """When an episode is cut off, and by whom."""
    steps = f"An episode is cut off after {task['max_steps']:,} steps"
    if task["min_agents"] == 1:
        return f"{steps} (by `gymnasium.make`)."
    return (
        f"{steps} (`max_cycles`). At least {task['min_agents']} agents act, by `dwell.pettingzoo`."
    )


def _file(name: str) -> str:
    """The source of a task: a file, or a folder's first file."""
    stem = f"{_TASKS}/{rust.snake(name).replace('-', '_')}"
    return f"{stem}.rs" if (ROOT / f"{stem}.rs").is_file() else f"{stem}/mod.rs"


def _settings(fields: list[dict[str, Any]]) -> str:
    if not fields:
        return "There are none.\n"
    return f"""`task_settings` is a mapping with these fields.

{fields_table(fields)}"""


def page() -> str:
    """The page."""
    tasks = _native.tasks()
    sections = "\n".join(_section(task) for task in tasks)
    info = ", ".join(code(key) for key in (*INFO_KEYS, "action_error", "audio_clipped"))
    goal = ", ".join(code(key) for key in GOAL_KEYS)
    episode = ", ".join(code(key) for key in EPISODE_KEYS[2:])
    return f"""# Environments

`gymnasium.make(ID, houses=..., sensors=..., ...)` makes one, `gymnasium.make_vec` many that step
together; [`DwellEnv`](api/envs.md) lists the arguments, and
[Configure an environment](configuring-environments.md) shows them.

Every step's `info` holds {info}, `scene_id` and `episode_id`. Where a task has no goal there are no
{goal}; in vector environments they are NaN. Where it has one, {episode} say what is asked,
as soon as the episode begins.

{sections}
## Settings of worlds

`world` of an environment, and the further arguments of `dwell.World`. In Python `sound_head` is a
`dwell.Head` or the path of its SOFA file.

{fields_table(settings()["WorldConfig"])}
## Bodies of agents

The mappings of `agents`; how fast a body moves is under
[limits of bodies](actions.md#limits-of-bodies).

{fields_table(settings()["AgentBody"])}"""
