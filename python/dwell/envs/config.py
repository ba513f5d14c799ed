"""What an environment is told, as JSON for the native side."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from dwell.house import House

Houses = str | Sequence[str]
Laws = str | os.PathLike[str] | Sequence[Mapping[str, Any]] | None
Sensors = Sequence[str] | Mapping[str, Mapping[str, Any]] | None


def house_names(houses: Houses) -> list[str]:
    """HOUSE strings; one string counts as a list of one."""
    names = [houses] if isinstance(houses, str) else list(houses)
    if not names:
        raise ValueError("houses: expected at least one HOUSE string, found none")
    return names


class HouseShelf:
    """Houses by name, opened at first use and kept."""

    def __init__(self, names: Sequence[str]) -> None:
        """Keeps the names; opens nothing."""
        self.names = list(names)
        self._open: dict[str, House] = {}

    def __getitem__(self, index: int) -> House:
        """House ``index`` modulo their number."""
        name = self.names[index % len(self.names)]
        if name not in self._open:
            self._open[name] = House.open(name)
        return self._open[name]


def _laws(laws: Laws) -> list[dict[str, Any]]:
    if laws is None:
        return []
    if not isinstance(laws, str | os.PathLike):
        return [dict(law) for law in laws]
    found = json.loads(Path(laws).read_text(encoding="utf-8"))
    rows: list[dict[str, Any]] = found["laws"] if isinstance(found, dict) else found
    return rows


def env_json(
    task: str,
    *,
    sensors: Sensors,
    laws: Laws,
    parameters: Mapping[str, float] | None,
    task_settings: Mapping[str, Any] | None,
    stride: Mapping[str, float] | None,
    world: Mapping[str, Any] | None,
) -> str:
    """The native ``EnvConfig`` as JSON."""
    config: dict[str, Any] = {
        "task": task,
        "world": {
            "laws": _laws(laws),
            "parameters": dict(parameters or {}),
            **(world or {}),
        },
    }
    if task_settings is not None:
        config["task_settings"] = dict(task_settings)
    if stride is not None:
        config["stride"] = dict(stride)
    if sensors is not None:
        rows = sensors.items() if isinstance(sensors, Mapping) else ((name, {}) for name in sensors)
        config["sensors"] = [{"kind": name, "settings": dict(settings)} for name, settings in rows]
    return json.dumps(config)
