"""The agents of an environment in which several act: their names, tasks, sensors, bodies, teams."""

from __future__ import annotations

import contextlib
import dataclasses
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypedDict

from dwell import ConfigError, DwellError, SceneError, _native
from dwell.arguments import (
    abbreviated_list,
    boolean,
    checked_fields,
    from_json,
    integer_in_range,
    mapping,
    quoted,
    refuse_unknown,
    text,
    text_list,
    to_json,
)
from dwell.configs import bodies
from dwell.envs.action_modes import checked_mode
from dwell.envs.config import env_json, sensor_rows, step_limit
from dwell.envs.python_tasks import NativeSettings
from dwell.envs.voice import Voice
from dwell.heads import Head
from dwell.house import House
from dwell.schemas import setting_checks
from dwell.world_settings import with_head

#: What ``max_cycles`` is by default: the longest limit of the agents' tasks.
OF_TASKS = "task"
#: The most agents that act in one environment.
MAX_AGENTS = 64
_EXPECTED = f"expected a number of agents, 1 to {MAX_AGENTS}, or settings by the agents' names"


class AgentSettings(TypedDict, total=False):
    """What an agent has of its own; the rest is as the environment says."""

    task: str
    task_settings: Mapping[str, Any]
    sensors: Sequence[str] | Mapping[str, Mapping[str, Any]]
    stride: Mapping[str, float]
    action_mode: str
    actions: Sequence[str]
    body: Mapping[str, Any]
    team: str
    #: Whether it speaks: a switch, or ``words``, ``max_tokens`` and ``efforts``.
    voice: bool | Mapping[str, Any]
    #: Whether it acts as its task's expert says; it is in nobody's list of agents then.
    scripted: bool


#: A number of agents, or settings by name.
Agents = int | Mapping[str, AgentSettings]


@dataclasses.dataclass(frozen=True)
class AgentRoster:
    """Who acts, in order.

    Attributes:
        names: The agents' names.
        rows: The engine's settings of each.
        bodies: The engine's settings of each one's body.
        team_names: Of each the name of its team, empty where it states none.
        teams: Of each the places of those of its team, itself among them.
        voices: What each can say, where it can.
        players: The places of those who take actions; the others are scripted.
    """

    names: list[str]
    rows: list[dict[str, Any]]
    bodies: list[dict[str, Any]]
    team_names: list[str]
    teams: list[list[int]]
    voices: list[Voice | None]
    players: list[int]

    @classmethod
    def of(cls, agents: object, voice: object = False) -> AgentRoster:
        """The agents of an argument; ``voice``: that of agents that state none.

        Raises:
            ConfigError: It is none; there are no agents, or too many; a setting is wrong.
        """
        if isinstance(agents, Mapping):
            given = mapping("agents", agents, "settings by the agents' names")
        else:
            try:
                count = integer_in_range("agents", agents, low=1, high=MAX_AGENTS)
            except ConfigError:
                raise ConfigError(f"agents is {quoted(agents)}; {_EXPECTED}") from None
            given = {f"agent_{k}": {} for k in range(count)}
        if not 1 <= len(given) <= MAX_AGENTS:
            raise ConfigError(f"agents has {len(given)} of them; {_EXPECTED}")
        names = [_name(name) for name in given]
        own = [mapping(f"agents.{name}", given[name]) for name in names]
        for name, settings in zip(names, own, strict=True):
            known = [*AgentSettings.__annotations__]
            refuse_unknown(f"agents.{name}", [key for key in settings if key not in known], known)
        scripted = [
            boolean(f"agents.{n}.scripted", s.get("scripted", False))
            for n, s in zip(names, own, strict=True)
        ]
        players = [k for k, is_scripted in enumerate(scripted) if not is_scripted]
        if not players:
            raise ConfigError("agents: all are scripted; expected at least one that takes actions")
        teams = [
            text(f"agents.{n}.team", s.get("team", "")) for n, s in zip(names, own, strict=True)
        ]
        rows = []
        for k, (name, settings) in enumerate(zip(names, own, strict=True)):
            with of_agents(names, name):
                rows.append(_row(f"agents.{name}", k, settings))
        places = [f"agents.{name}.body" for name in names]
        stated = bodies([settings.get("body", {}) for settings in own], places)
        return cls(
            names,
            rows,
            stated,
            teams,
            places_of_teams(teams),
            [
                Voice.of(f"agents.{n}.voice", s["voice"])
                if "voice" in s
                else Voice.of("voice", voice)
                for n, s in zip(names, own, strict=True)
            ],
            players,
        )

    def place(self, name: object) -> int:
        """The place of an agent among those who act.

        Raises:
            ConfigError: Nobody has the name.
        """
        if name in self.names:
            return self.names.index(str(name))
        raise ConfigError(f"agent is {quoted(name)}; allowed are {abbreviated_list(self.names)}")


@contextlib.contextmanager
def of_agents(names: Sequence[str], name: str | None = None) -> Iterator[None]:
    """What is refused meanwhile tells of agents by their names, not by their numbers.

    Args:
        names: The agents'.
        name: That of the only one whom it can be about, if there is one.
    """
    try:
        yield
    except DwellError as error:
        # What the scene refuses of an agent is its body.
        part = ".body" if isinstance(error, SceneError) else ""
        told = re.sub(
            r"\bagents\[(\d+)\]",
            lambda found: (
                f"agents.{names[int(found[1])]}{part}" if int(found[1]) < len(names) else found[0]
            ),
            str(error),
        )
        if name is not None and not told.startswith(f"agents.{name}"):
            told = f"agents.{name}: {told}"
        raise type(error)(told) from None


def places_of_teams(teams: Sequence[str]) -> list[list[int]]:
    """Of each agent the places of those of its team, itself among them."""
    return [[k for k, other in enumerate(teams) if other == team] for team in teams]


def _name(name: str) -> str:
    """The name of an agent: errors, files and lists of words for people have it."""
    if not name or not name.isprintable():
        raise ConfigError(f"agents: a name is {quoted(name)}; expected letters that can be printed")
    return name


def _row(at: str, number: int, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The engine's ``AgentConfig`` of an agent."""
    row: dict[str, Any] = {"agent": number}
    if "task" in settings:
        row["task"] = text(f"{at}.task", settings["task"])
    if "task_settings" in settings:
        row["task_settings"] = mapping(f"{at}.task_settings", settings["task_settings"])
    if "stride" in settings:
        stride, known = settings["stride"], setting_checks("StepSizes")
        row["stride"] = checked_fields(f"{at}.stride", stride, known)
    if "action_mode" in settings:
        row["action_mode"] = checked_mode(settings["action_mode"])
    if "actions" in settings:
        row["actions"] = text_list(f"{at}.actions", settings["actions"])
    if "sensors" in settings:
        row["sensors"] = sensor_rows(settings["sensors"])
    if settings.get("scripted", False):
        # Nobody looks at what it observes.
        row.update(scripted=True, sensors=row.get("sensors", []))
    return row


@dataclasses.dataclass(frozen=True)
class MultiAgentSetup:
    """The engine's settings of environments in which several agents act.

    Attributes:
        roster: Who acts.
        config: The native ``EnvConfig`` as JSON.
        limit: Steps after which episodes are truncated.
        heads: What the agents' ears are on.
    """

    roster: AgentRoster
    config: str
    limit: int | None
    heads: Sequence[Head]

    @contextlib.contextmanager
    def built(self, house: House) -> Iterator[None]:
        """Environments are built in a house: what is refused names the agent whose setting it is.

        The engine names an agent by its number, or a setting alone. Then those agents are asked for
        one by one to whom the same is told when they are alone, where that is not everybody.
        """
        names = self.roster.names
        with of_agents(names):
            try:
                yield
            except DwellError as error:
                if "agents[" in str(error):
                    raise
                wrong = [k for k in range(len(names)) if self._alone(house, k) == str(error)]
                if not wrong or len(wrong) == len(names):
                    raise
                raise type(error)(f"agents.{names[wrong[0]]}: {error}") from None

    def _alone(self, house: House, agent: int) -> str | None:
        """What is refused of an agent alone."""
        from dwell.envs.native_batch import NativeBatch

        settings = mapping("config", from_json("config", self.config))
        row = {**self.roster.rows[agent], "agent": 0, "scripted": False}
        world = {**settings.get("world", {}), "agents": [self.roster.bodies[agent]]}
        try:
            NativeBatch([house], to_json({**settings, "agents": [row], "world": world}), 1)
        except DwellError as error:
            return str(error)
        return None

    @classmethod
    def plain(cls, task: str, agents: object) -> MultiAgentSetup:
        """Of so many agents of a task, all else by default.

        Raises:
            ConfigError: The number or the task is wrong.
        """
        names = ("sensors", "laws", "parameters", "randomize", "task_settings", "stride", "actions")
        own = {"agents": agents, "action_mode": "discrete", "max_cycles": OF_TASKS, "world": None}
        return cls.of(task, {**dict.fromkeys(names), **own, "voice": False, "muted": False})

    @classmethod
    def of(cls, task: str, given: Mapping[str, Any]) -> MultiAgentSetup:
        """Out of the arguments of an environment.

        Raises:
            ConfigError: One is wrong; the message names it.
        """
        roster = AgentRoster.of(given["agents"], given["voice"])
        world, heads = with_head(given["world"])
        world = None if world is None else mapping("world", world, "fields of the WorldConfig")
        if world is not None and "agents" in world:
            raise ConfigError("world: agents; the bodies stand in agents, as {'a': {'body': {}}}")
        config = env_json(
            NativeSettings(task, given["task_settings"], given["sensors"]),
            laws=given["laws"],
            parameters=given["parameters"],
            randomize=given["randomize"],
            stride=given["stride"],
            action_mode=given["action_mode"],
            actions=given["actions"],
            world={**(world or {}), "agents": roster.bodies, **_muted(given["muted"])},
            agents=roster.rows,
        )
        cycles = given["max_cycles"]
        if cycles == OF_TASKS:
            limits = {row["name"]: int(row["max_steps"]) for row in _native.tasks()}
            own = [row.get("task", task) for row in roster.rows]
            # What no task is called is refused by the engine, which lists those there are.
            cycles = max((limits[name] for name in own if name in limits), default=None)
        return cls(roster, config, step_limit(cycles, "max_cycles"), heads)


def _muted(muted: object) -> dict[str, bool]:
    """The field of a world whose voices are silent; no field where they are not."""
    return {"muted": True} if boolean("muted", muted) else {}
