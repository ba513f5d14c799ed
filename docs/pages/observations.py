"""The sensors: their tables come from the specifications of which spaces are made."""

from __future__ import annotations

import json
from typing import Any

import dwell
from dwell import _native
from dwell.envs.config import env_json
from dwell.envs.python_tasks import NativeSensors, NativeSettings
from dwell.envs.spaces import SensorSpace, specs
from pages import rust
from pages.schema_words import schema_words
from pages.tables import code, number, table

#: Shapes and ranges do not depend on the house.
_ROOM_M = (4.0, 2.5, 4.0)
_SENSORS = "engine/world/src/sensors"


def sensor_names() -> list[str]:
    """The names of all sensors that the engine has."""
    return [row["name"] for row in json.loads(_native.sensors_json())]


def specifications(sensors: NativeSensors, task: str = "InstructionFollowing") -> list[SensorSpace]:
    """What sensors give; those that are only named with default settings."""
    config = env_json(NativeSettings(task, sensors=sensors))
    room = dwell.House.shoebox(_ROOM_M, substance="plaster")
    return specs(_native.Batch([room.native], config))


def with_setting(**setting: float) -> list[str]:
    """The sensors that have a setting."""

    def has(name: str) -> bool:
        try:
            return bool(specifications({name: setting}))
        except dwell.ConfigError:
            return False

    return [name for name in sensor_names() if has(name)]


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


def settings_table(path: str, struct: str) -> str:
    """Name, type and text of the fields of a struct of settings."""
    rows = [(code(one.name), _type(one), one.about) for one in rust.items(path, struct)]
    return table(("field", "type", "what it is"), rows)


def fields_table(fields: list[dict[str, Any]]) -> str:
    """Name, type and text of fields that the engine describes."""
    rows = [(code(one["name"]), schema_words(one["schema"]), one["about"]) for one in fields]
    return table(("field", "type", "what it is"), rows)


def _listed(names: list[str]) -> str:
    return ", ".join(code(name) for name in names)


def _type(item: rust.Item) -> str:
    return rust.plain_type(item.type or "")


def page() -> str:
    """The page."""
    cameras, ears = with_setting(near_m=0.1), with_setting(window_s=0.1)
    bare = [name for name in sensor_names() if name not in (*cameras, *ears)]
    return f"""# Observations

`sensors` of an environment names them, or maps names to settings; every one below can be asked
for. This page is written from the sensors' specifications, of which environments make their spaces.
Shapes are those of default settings. A unit that is left out is none.

```python
env = gymnasium.make("dwell/InstructionFollowing-v0", sensors=["rgb", "gps", "compass"])
env = gymnasium.make(
    "dwell/InstructionFollowing-v0",
    sensors={{"left": {{"kind": "rgb", "position_m": [-0.05, 0, 0]}}, "depth": {{"width": 64}}}},
)
```

{observation_table(specifications(sensor_names()))}
## Settings of cameras

Of {_listed(cameras)}.

{settings_table(f"{_SENSORS}/camera.rs", "CameraConfig")}
## Settings of ears

Of {_listed(ears)}.

{settings_table(f"{_SENSORS}/audio.rs", "AudioConfig")}
The others have no settings: {_listed(bare)}.
"""
