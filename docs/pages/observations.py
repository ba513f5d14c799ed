"""The sensors: their tables come from the specifications of which spaces are made."""

from __future__ import annotations

from typing import Any

import dwell
from dwell import _native
from dwell.envs.config import env_json
from dwell.envs.python_tasks import NativeSensors, NativeSettings
from dwell.envs.spaces import SensorSpace, specs
from pages.schema_words import schema_words
from pages.tables import code, number, table

#: Shapes and ranges do not depend on the house.
_ROOM_M = (4.0, 2.5, 4.0)


def sensor_names() -> list[str]:
    """The names of all sensors that the engine has."""
    return [*_sensors()]


def specifications(sensors: NativeSensors, task: str = "InstructionFollowing") -> list[SensorSpace]:
    """What sensors give; those that are only named with default settings."""
    count = next((int(row["min_agents"]) for row in _native.tasks() if row["name"] == task), 1)
    several = {
        "world": {"agents": [{}] * count},
        "agents": [{"agent": number} for number in range(count)],
    }
    on_wheels = {"world": {"agents": [{"locomotion": "differential_drive"}]}}
    more = on_wheels if "wheel_odometry" in (sensors or ()) else several if count > 1 else {}
    config = env_json(NativeSettings(task, sensors=sensors), **more)
    room = dwell.House.shoebox(_ROOM_M, substance="plaster")
    batch = _native.Batch([room.native], config)
    rows = zip(specs(batch), batch.sensor_agents(), strict=True)
    return [spec for spec, agent in rows if agent == 0]


def all_specifications() -> list[SensorSpace]:
    """What every sensor gives by default; those of goals in the first task that has such goals."""
    found: dict[str, SensorSpace] = {}
    for name, row in _sensors().items():
        tasks = row["goal_tasks"]
        found[name] = specifications([name], *(tasks[:1] if tasks else ()))[0]
    return [*found.values()]


def _sensors() -> dict[str, dict[str, Any]]:
    return {row["name"]: row for row in _native.sensors()}


def _of_goals() -> str:
    rows = [(row["name"], row["goal_tasks"]) for row in _sensors().values() if row["goal_tasks"]]
    return "; ".join(f"{code(name)} with {', '.join(map(code, tasks))}" for name, tasks in rows)


def _by_settings() -> list[tuple[list[str], list[dict[str, Any]]]]:
    """Sensors that have the same settings, with the fields of these."""
    groups: list[tuple[list[str], list[dict[str, Any]]]] = []
    for name, row in _sensors().items():
        same = [names for names, fields in groups if fields == row["settings"]]
        if same:
            same[0].append(name)
        else:
            groups.append(([name], row["settings"]))
    return groups


def observation_table(rows: list[SensorSpace]) -> str:
    """Name, shape, dtype, unit and range of observations."""
    head = ("name", "space", "shape", "dtype", "unit", "lowest", "highest", "what it is")
    return table(head, [_row(spec) for spec in rows])


def _row(spec: SensorSpace) -> tuple[str, ...]:
    kind = type(spec.space()).__name__
    if spec.is_text:
        length = f"{number(spec.high)} characters"
        return (code(spec.name), kind, "", "text", "", "1 character", length, spec.about)
    high = spec.high - 1 if spec.is_tokens else spec.high
    unit = "" if spec.unit == "1" else spec.unit
    bounds = (number(spec.low), number(high))
    return (code(spec.name), kind, code(spec.shape), spec.dtype, unit, *bounds, spec.about)


def fields_table(fields: list[dict[str, Any]]) -> str:
    """Name, type and text of fields that the engine describes."""
    rows = [(code(one["name"]), schema_words(one["schema"]), one["about"]) for one in fields]
    return table(("field", "type", "what it is"), rows)


def _listed(names: list[str]) -> str:
    return ", ".join(code(name) for name in names)


def _section(names: list[str], fields: list[dict[str, Any]]) -> str:
    if not fields:
        return f"The others have no settings: {_listed(names)}.\n"
    return f"Of {_listed(names)}.\n\n{fields_table(fields)}"


def page() -> str:
    """The page."""
    sections = [_section(*group) for group in _by_settings()]
    return f"""# Observations

`sensors` of an environment names them, or maps names to settings; every one below can be asked
for. This page is written from the sensors' specifications, of which environments make their spaces.
Shapes are those of default settings. A unit that is left out is none.

```python
env = gymnasium.make("dwell/InstructionFollowing-v1", sensors=["rgb", "gps", "compass"])
env = gymnasium.make(
    "dwell/InstructionFollowing-v1",
    sensors={{"left": {{"kind": "rgb", "position_m": [-0.05, 0, 0]}}, "depth": {{"width": 64}}}},
)
```

Sensors of goals go with the tasks that have such goals: {_of_goals()}.

{observation_table(all_specifications())}
## Settings

{chr(10).join(sections)}"""
