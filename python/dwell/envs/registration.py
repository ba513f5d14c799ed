"""Registration with gymnasium."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import gymnasium

from dwell import ConfigError, UsageError, _native
from dwell.arguments import integer_in_range, quoted, refuse_unknown, text
from dwell.envs.config import EnvSettings
from dwell.envs.python_tasks import TaskChoice
from dwell.episodes import several_agents
from dwell.messages import with_short_words
from dwell.plugin_parts import factory
from dwell.tasks import Task

if TYPE_CHECKING:
    from typing_extensions import Unpack


def env_ids() -> list[str]:
    """The ids of all environments of one agent."""
    return [task["id"] for task in _native.tasks() if task["min_agents"] == 1]


def refuse_several(task: str, **_: object) -> NoReturn:
    """Takes the place of an environment that Gymnasium cannot have.

    Raises:
        UsageError: Always; it says what has the task.
    """
    raise UsageError(
        f"{task} is a task of several agents, and gymnasium.make has environments of one; "
        f"{several_agents(task)}"
    )


def register_envs() -> None:
    """Registers every task; again does nothing.

    Those of several agents are there to say who has them: :func:`env_ids` has the others.
    """
    for task in _native.tasks():
        name = task["id"]
        if name in gymnasium.registry:
            continue
        if task["min_agents"] > 1:
            refusal = f"{__name__}:{refuse_several.__name__}"
            own = {"task": task["name"]}
            gymnasium.register(name, entry_point=refusal, vector_entry_point=refusal, kwargs=own)
            continue
        gymnasium.register(
            name,
            entry_point="dwell.envs:DwellEnv",
            vector_entry_point="dwell.envs:DwellVectorEnv",
            max_episode_steps=task["max_steps"],
            kwargs={"task": task["name"]},
        )


def register_task(env_id: str, task: TaskChoice, **settings: Unpack[EnvSettings]) -> None:
    """Registers a user's task with gymnasium.

    Args:
        env_id: What ``gymnasium.make`` and ``make_vec`` will know it by, such as ``"me/Fetch-v0"``.
        task: A subclass of :class:`dwell.Task`, or its ``"module:Name"``, by which other processes
            find it, too.
        **settings: Further arguments of :class:`dwell.envs.DwellEnv`.

    Raises:
        ConfigError: The id is of no form that gymnasium knows, or taken; an argument that
            ``DwellEnv`` does not have.
    """
    known = [*EnvSettings.__annotations__]
    refuse_unknown("register_task", [name for name in settings if name not in known], known)
    made = factory("task", task, Task, settings.get("task_settings"))()
    steps = integer_in_range(f"{type(made).__name__}.max_steps", made.max_steps, low=1)
    if text("env_id", env_id) in gymnasium.registry:
        raise ConfigError(f"env_id is {quoted(env_id)}, which is registered already")
    try:
        gymnasium.register(
            env_id,
            entry_point="dwell.envs:DwellEnv",
            vector_entry_point="dwell.envs:DwellVectorEnv",
            max_episode_steps=steps,
            kwargs={"task": task, **settings},
        )
    except gymnasium.error.Error as error:
        raise ConfigError(f"env_id is {quoted(env_id)}: {with_short_words(str(error))}") from None
