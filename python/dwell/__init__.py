"""A household that agents see, touch, hear and talk about.

>>> import dwell
>>> house = dwell.House.open("builtin:apartment")
>>> world = dwell.World(house)
>>> image = world.render(agent=0)["rgb"]  # (128, 128, 3) uint8

Environments are registered on import: ``gymnasium.make("dwell/InstructionFollowing-v1")``.
"""

from __future__ import annotations

import importlib
import os
import sys
from typing import TYPE_CHECKING, Any

from dwell import messages
from dwell._native import (
    ConfigError,
    DwellError,
    EngineBug,
    HouseError,
    HouseFileError,
    HouseNotFoundError,
    MeasuredDataError,
    SceneError,
    UsageError,
    __version__,
)

if TYPE_CHECKING:
    from dwell.acoustics import AcousticScene
    from dwell.actions import Outcome, PointedTarget
    from dwell.building import HouseBuilder
    from dwell.calibration import calibrate
    from dwell.camera import Camera
    from dwell.directivity import Directivity
    from dwell.editing import HouseEdit
    from dwell.envs import register_envs, register_task
    from dwell.grounded_text import Text
    from dwell.heads import Head
    from dwell.house import House
    from dwell.listening import Microphone, Receiver, Source
    from dwell.navigation import Navigation, Walker
    from dwell.relations import predicates
    from dwell.replays import Replay
    from dwell.rewards import Reward
    from dwell.sensors import Sensor
    from dwell.tasks import StepResult, Task, TaskGoal
    from dwell.world import World

# Imported at first use, so that the command line starts fast.
_LAZY = {
    "AcousticScene": "dwell.acoustics",
    "TaskGoal": "dwell.tasks",
    "Camera": "dwell.camera",
    "Directivity": "dwell.directivity",
    "Head": "dwell.heads",
    "House": "dwell.house",
    "HouseBuilder": "dwell.building",
    "HouseEdit": "dwell.editing",
    "Microphone": "dwell.listening",
    "Navigation": "dwell.navigation",
    "Outcome": "dwell.actions",
    "PointedTarget": "dwell.actions",
    "Receiver": "dwell.listening",
    "Replay": "dwell.replays",
    "Reward": "dwell.rewards",
    "Sensor": "dwell.sensors",
    "Source": "dwell.listening",
    "Task": "dwell.tasks",
    "StepResult": "dwell.tasks",
    "Text": "dwell.grounded_text",
    "Walker": "dwell.navigation",
    "World": "dwell.world",
    "calibrate": "dwell.calibration",
    "predicates": "dwell.relations",
    "register_envs": "dwell.envs",
    "register_task": "dwell.envs",
}

# The public modules themselves, by the names that the documentation gives them.
_MODULES = {
    "acoustics",
    "actions",
    "building",
    "calibration",
    "camera",
    "charts",
    "configs",
    "directivity",
    "echogram",
    "editing",
    "envs",
    "episode_maker",
    "episodes",
    "evaluation",
    "grounded_text",
    "habitat_conversion",
    "habitat_episodes",
    "heads",
    "house",
    "listening",
    "localization",
    "measures",
    "navigation",
    "places",
    "plans",
    "policies",
    "relations",
    "replays",
    "rewards",
    "sensors",
    "sound_maps",
    "sounds",
    "tasks",
    "teach",
    "world",
}

__all__ = [
    "AcousticScene",
    "Camera",
    "ConfigError",
    "Directivity",
    "DwellError",
    "EngineBug",
    "Head",
    "House",
    "HouseBuilder",
    "HouseEdit",
    "HouseError",
    "HouseFileError",
    "HouseNotFoundError",
    "MeasuredDataError",
    "Microphone",
    "Navigation",
    "Outcome",
    "PointedTarget",
    "Receiver",
    "Replay",
    "Reward",
    "SceneError",
    "Sensor",
    "Source",
    "StepResult",
    "Task",
    "TaskGoal",
    "Text",
    "UsageError",
    "Walker",
    "World",
    "__version__",
    "calibrate",
    "predicates",
    "register_envs",
    "register_task",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - whatever the module holds under the name
    if name in _MODULES:
        return importlib.import_module(f"dwell.{name}")
    module = _LAZY.get(name)
    if module is None:
        raise AttributeError(f"module 'dwell' has no attribute {name!r}")
    return getattr(importlib.import_module(module), name)


def __dir__() -> list[str]:
    """The importable names, also those that are loaded at first use."""
    return sorted({*globals(), *__all__, *_MODULES})


messages.install()

# Importing gymnasium takes longer than most commands: the command line does without.
if os.path.basename(sys.argv[0] if sys.argv else "") not in ("dwell", "dwell.exe", "-m"):
    importlib.import_module("dwell.envs").register_envs()
