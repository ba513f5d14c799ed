"""Registration with gymnasium."""

from __future__ import annotations

import json

import gymnasium

from dwell import _native


def env_ids() -> list[str]:
    """The ids of all environments."""
    return [f"dwell/{task['name']}-v{task['version']}" for task in json.loads(_native.tasks_json())]


def register_envs() -> None:
    """Registers every task; again does nothing."""
    for task in json.loads(_native.tasks_json()):
        name = f"dwell/{task['name']}-v{task['version']}"
        if name in gymnasium.registry:
            continue
        gymnasium.register(
            name,
            entry_point="dwell.envs:DwellEnv",
            vector_entry_point="dwell.envs:DwellVectorEnv",
            max_episode_steps=task["max_steps"],
            kwargs={"task": task["name"]},
        )
