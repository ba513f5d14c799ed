"""Episodes as files: played again to the same bits, and seen and heard with other sensors."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from dwell import (
    ConfigError,
    DwellError,
    MeasuredDataError,
    SceneError,
    UsageError,
    _native,
    arguments,
)
from dwell.arguments import (
    boolean,
    dwell_version,
    from_json,
    instance_of,
    integer_in_range,
    mapping,
    number_in_range,
    quoted,
    sequence_items,
    text,
    text_list,
    to_json,
)
from dwell.files import atomic_write, read_json
from dwell.house import House
from dwell.replay_agents import (
    AgentStep,
    PlayedAgents,
    ReplayAgent,
    agent_rows,
    check_agents,
    engine_steps,
    scripted_places,
)
from dwell.replay_sensors import picture_faults, without_pictures
from dwell.stated_episodes import checked_episode

if TYPE_CHECKING:
    from dwell.envs.action_modes import EngineActions
    from dwell.envs.native_batch import NativeBatch
    from dwell.envs.python_tasks import RewardChoice, TaskChoice
    from dwell.world import World

#: What a file says of itself.
_FORMAT = "dwell-replay"
#: Of files whose actions are names alone, and of those that say more of an action.
_VERSION, _VERSION_WITH_TARGETS = 2, 3
#: Of files of episodes that state their start or goal.
_VERSION_STATED = 4
#: Of files of episodes of several agents.
_VERSION_OF_AGENTS = 5
#: More than any episode is long; its file stays below what is read.
MAX_STEPS = 1_000_000


@dataclasses.dataclass(frozen=True)
class ReplayStep:
    """An episode at one step.

    Of an episode of several agents ``action``, ``reward``, ``instruction`` and ``success`` are of
    the first one.

    Attributes:
        step: How many steps were made.
        action: The name of the last action; ``None`` at the start, and where there was none.
        reward: What the last step gave; 0 at the start.
        world: The world as it is, to look at and listen to; the same object at every step.
        instruction: What the episode asks.
        success: Whether it is done after the last step.
        is_same: Whether its bits are those that were recorded. Not once somebody has listened to
            ``world`` whose ears no sensor had opened when it was recorded: the sound that ears keep
            is among the bits, though nothing else changes by it.
    """

    step: int
    action: str | None
    reward: float
    world: World
    is_same: bool
    instruction: str
    success: bool
    agents: Mapping[str, AgentStep] = dataclasses.field(default_factory=dict)


@dataclasses.dataclass(frozen=True)
class Replay:
    """A recorded episode: what it was played in, and every action.

    Attributes:
        house: The HOUSE string.
        seed: The episode's seed.
        config: Task, sensors, laws, parameters and rates as JSON for the native side.
        parts: Names of the classes of the Python parts it was played with, empty for most.
        actions: The actions, in order: names, or mappings with ``action`` and what else is said:
            ``velocity``, ``pixel``, ``object``, ``answer``. Of several agents for each step those
            of who acted, by name; they may have ``say`` (``tokens`` and ``effort``).
        hashes: The state's hash at the start and after each action, hexadecimal.
        instruction: What was asked; of several agents the first one.
        success: Whether it was done at the end; of several agents by the first one.
        made_by: The version of dwell that recorded it.
        stated: What the episode stated of its start and goal; ``None``: all was drawn.
        agents: The agents of an episode of several, in the order of ``config``; else empty.
        shared_reward: Which share of their rewards is the mean of their teams'.
        path: The file it was read from, if it was.
        sums: The check sums of all fields of the file; files of version 1 have none.
    """

    house: str
    seed: int
    config: str
    parts: tuple[str, ...]
    actions: tuple[str | dict[str, Any], ...]
    hashes: tuple[str, ...]
    instruction: str
    success: bool
    made_by: str
    stated: Mapping[str, Any] | None = None
    agents: tuple[ReplayAgent, ...] = ()
    shared_reward: float = 0.0
    path: str | None = dataclasses.field(default=None, compare=False)
    sums: Mapping[str, str] | None = dataclasses.field(default=None, compare=False, repr=False)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Replay:
        """Reads a file.

        Raises:
            MeasuredDataError: It is no replay, of another version, or its numbers do not fit.
            ConfigError: ``path`` is no path.
            OSError: The system refuses, or it is no regular file.
        """
        path = arguments.file_path("path", path)
        try:
            row = read_json(path)
        except ValueError as error:
            raise MeasuredDataError(str(error)) from None
        if not isinstance(row, dict) or row.get("format") != _FORMAT:
            raise MeasuredDataError(f"{path}: format: no {_FORMAT} file")
        version = row.get("version")
        if isinstance(version, bool) or version not in range(1, _VERSION_OF_AGENTS + 1):
            raise MeasuredDataError(
                f"{path}: version is {quoted(version)}; this dwell reads 1 to {_VERSION_OF_AGENTS}"
            )
        known = set(_FIELDS) - ({"sums"} if version == 1 else set())
        if version == _VERSION_STATED:
            known.add("stated")
        if version == _VERSION_OF_AGENTS:
            known |= {*_OF_AGENTS}
        if wrong := sorted(known ^ set(row)):
            what = "unknown" if wrong[0] in row else "missing"
            raise MeasuredDataError(f"{path}: field {wrong[0]!r} is {what} in version {version}")
        try:
            replay = cls(
                house=text("house", row["house"]),
                seed=integer_in_range("seed", row["seed"]),
                config=to_json(mapping("config", row["config"])),
                parts=tuple(text_list("parts", row["parts"])),
                actions=tuple(
                    sequence_items("actions", row["actions"], "expected a list of actions")
                ),
                hashes=tuple(_hash_list("hashes", row["hashes"])),
                instruction=text("instruction", row["instruction"]),
                success=boolean("success", row["success"]),
                made_by=dwell_version("made_by", row["made_by"]),
                stated=checked_episode("stated", row["stated"]) if "stated" in row else None,
                agents=tuple(
                    ReplayAgent.of_row(f"agents[{k}]", one)
                    for k, one in enumerate(
                        sequence_items("agents", row.get("agents", []), "expected a list of agents")
                    )
                ),
                shared_reward=number_in_range(
                    "shared_reward", row.get("shared_reward", 0.0), 0.0, 1.0
                ),
                path=path,
                sums=None if version == 1 else mapping("sums", row["sums"]),
            )
            if version == _VERSION_OF_AGENTS and not replay.agents:
                raise ConfigError("agents: found none in version 5")
            replay.check()
        except ConfigError as error:
            raise MeasuredDataError(f"{path}: {error}") from None
        return replay

    def _at(self) -> str:
        return "replay" if self.path is None else self.path

    def check(self) -> None:
        """Refuses fields of other types, unknown actions, and hashes that are not one more.

        Raises:
            MeasuredDataError: The message begins with the file, where there is one.
        """
        try:
            for name, check in _CHECKS.items():
                check(name, getattr(self, name))
            for name in ("actions", "hashes"):
                if not isinstance(given := getattr(self, name), Sequence):
                    raise ConfigError(f"{name} is {quoted(given)}; expected a list")
            if self.stated is not None:
                checked_episode("stated", self.stated)
            if self.sums is not None:
                mapping("sums", self.sums)
            if self.agents:
                self._check_agents()
        except ConfigError as error:
            raise MeasuredDataError(f"{self._at()}: {error}") from None
        try:
            self._engine_actions()
        except ConfigError as error:
            raise MeasuredDataError(f"{self._at()}: {error}") from None
        if len(self.hashes) != len(self.actions) + 1 or len(self.actions) > MAX_STEPS:
            raise MeasuredDataError(
                f"{self._at()}: {len(self.actions)} actions and {len(self.hashes)} hashes; "
                f"expected at most {MAX_STEPS} actions and one hash more"
            )

    def _check_agents(self) -> None:
        """Refuses agents that do not fit the other fields.

        Raises:
            ConfigError: The message begins with the field.
        """
        number_in_range("shared_reward", self.shared_reward, 0.0, 1.0)
        if self.parts or self.stated is not None:
            raise ConfigError("agents: episodes of several have no parts, and state no start")
        check_agents(self.agents, self.actions, self._settings())
        first = self.agents[0]
        for name in ("instruction", "success"):
            if getattr(self, name) != getattr(first, name):
                raise ConfigError(
                    f"{name} is {quoted(getattr(self, name))}; of {first.name}, the first agent, "
                    f"it is {quoted(getattr(first, name))}"
                )

    def _engine_actions(self) -> list[EngineActions]:
        """The actions as the engine takes them; of equal names the same object.

        Raises:
            ConfigError: One is none.
        """
        from dwell.envs.action_modes import EngineActions

        if self.agents:
            return [*engine_steps(self.agents, self._rows())]

        by_name: dict[str, EngineActions] = {}
        found = []
        for k, action in enumerate(self.actions):
            if isinstance(action, str) and action in by_name:
                found.append(by_name[action])
                continue
            found.append(EngineActions.of_row(f"actions[{k}]", action))
            if found[-1].tokens is not None:
                raise ConfigError(f"actions[{k}] has 'say'; those of several agents have it alone")
            if isinstance(action, str):
                by_name[action] = found[-1]
        return found

    def _rows(self) -> list[Mapping[str, Any]]:
        """The actions of several agents: for each step those by name."""
        return [mapping(f"actions[{k}]", row) for k, row in enumerate(self.actions)]

    def _stated(self) -> dict[str, Any]:
        """The fields of a file, but for its check sums."""
        plain = all(isinstance(action, str) for action in self.actions)
        row = {"format": _FORMAT, "version": _VERSION if plain else _VERSION_WITH_TARGETS}
        row |= {name: getattr(self, name) for name in _FIELDS if name not in (*row, "sums")}
        row["config"] = self._settings()
        if self.stated is not None:
            row |= {"version": _VERSION_STATED, "stated": dict(self.stated)}
        if self.agents:
            row |= {
                "version": _VERSION_OF_AGENTS,
                "agents": agent_rows(self.agents),
                "shared_reward": self.shared_reward,
            }
        return row

    def _settings(self) -> dict[str, Any]:
        at = f"{self._at()}: config"
        return mapping(at, from_json(at, text(at, self.config)))

    def write(self, path: str | os.PathLike[str], *, new: bool = False) -> None:
        """Writes a file, whole or not at all.

        Args:
            path: The file.
            new: Nothing may stand there, not even from another process in this moment.

        Raises:
            FileExistsError: It shall be new and is not.
            OSError: The system refuses.
            ConfigError: The settings are none.
            MeasuredDataError: Another field is of another type, or they do not fit each other.
        """
        self.check()
        is_new = boolean("new", new)
        row = self._stated()
        row["sums"] = {name: _sum(value) for name, value in row.items()}
        with atomic_write(arguments.file_path("path", path), new=is_new) as draft:
            draft.write_text(json.dumps(row, indent=1) + "\n", "utf-8")

    def play(
        self,
        *,
        task: TaskChoice | None = None,
        reward: RewardChoice = None,
        renderer: str | None = None,
        house: House | None = None,
    ) -> Iterator[ReplayStep]:
        """Plays the episode again, step by step, the start first.

        Args:
            task: The Python task it was played with, if it was; a file never says what to import.
            reward: The Python reward it was played with.
            renderer: Who makes pictures now; default as it was.
            house: The house, if it is open already.

        Raises:
            HouseError: The house cannot be opened.
            UsageError: It was played with parts in Python that are not given.
            MeasuredDataError: A field is wrong, as :meth:`check` says.
        """
        from dwell.world import World

        self.check()
        with self._named():
            runner = self._runner(task, reward, renderer, house)
            runner.reset([self.seed], stated=[self.stated])
            world = World.of_env(runner.houses[0], _native.World.of_env(runner.batch, 0))
            played = None
            if self.agents:
                scripted = scripted_places(self._settings())
                played = PlayedAgents(self.agents, self.shared_reward, scripted, runner)
            moment = self._moment(0, runner, world, None, played)
        yield moment
        for step, action in enumerate(self._engine_actions(), 1):
            with self._named(f"actions[{step - 1}]: "):
                if played is not None:
                    played.before(action, world)
                answer, _ = runner.step(action)
                moment = self._moment(step, runner, world, answer, played)
            yield moment

    def _runner(
        self,
        task: TaskChoice | None,
        reward: RewardChoice,
        renderer: str | None,
        house: House | None,
    ) -> NativeBatch:
        from dwell.envs.native_batch import NativeBatch
        from dwell.envs.python_tasks import PythonTask, split

        given, custom = [], PythonTask()
        if task is not None or reward is not None:
            _, custom = split("Free" if task is None else task, None, reward, None)
            given = [
                type(make()).__name__ for make in (custom.task, custom.reward) if make is not None
            ]
        if given != [*self.parts]:
            raise UsageError(
                f"this episode was played with {[*self.parts] or 'no parts in Python'}, given are "
                f"{given or 'none'}; task= and reward= take them"
            )
        config = without_pictures(self._settings())
        if renderer is not None:
            world = mapping("config: world", config.get("world", {}))
            config["world"] = {**world, "renderer": renderer}
        opened = House.open(self.house) if house is None else instance_of("house", house, House)
        try:
            return NativeBatch([opened], to_json(config), None, custom=custom)
        except (ConfigError, SceneError) as error:
            raise type(error)(f"config: {error}") from error

    @contextmanager
    def _named(self, place: str = "") -> Iterator[None]:
        """Errors begin with the file and the place in it."""
        try:
            yield
        except DwellError as error:
            raise type(error)(f"{self._at()}: {place}{error}") from error

    def _moment(
        self,
        step: int,
        runner: NativeBatch,
        world: World,
        answer: Mapping[str, Any] | None,
        played: PlayedAgents | None,
    ) -> ReplayStep:
        is_same = f"{world.state_hash():016x}" == self.hashes[step]
        if played is not None:
            row = mapping("action", self.actions[step - 1]) if step else None
            agents = played.after(step, row, answer, world)
            first = agents[self.agents[0].name]
            return ReplayStep(
                step=step,
                action=None if first.action is None else _name(first.action),
                reward=first.reward,
                world=world,
                is_same=is_same,
                instruction=first.instruction,
                success=first.success,
                agents=agents,
            )
        return ReplayStep(
            step=step,
            action=_name(self.actions[step - 1]) if step else None,
            reward=0.0 if answer is None else float(answer["reward"][0]),
            world=world,
            is_same=is_same,
            instruction=runner.batch.instruction(0),
            success=answer is not None and bool(answer["success"][0]),
        )

    def first_difference(self, **parts: Any) -> int | None:  # noqa: ANN401 - as :meth:`play`
        """The first step after which bits differ from those recorded; ``None`` if none do.

        Args:
            **parts: As :meth:`play`.
        """
        for moment in self.play(**parts):
            if not moment.is_same:
                return moment.step
        return None

    def differences(self, **parts: Any) -> list[str]:  # noqa: ANN401 - as :meth:`play`
        """The stated fields that do not hold, a sentence each that begins with the field.

        Every field is held against its check sum, so that nothing was changed by accident since it
        was recorded; and the episode is played: the hash after each step, the instruction and the
        success at the end are those that are stated.

        Args:
            **parts: As :meth:`play`.

        Returns:
            Nothing where all holds.
        """
        self.check()
        told = []
        if self.sums is not None:
            stated = self._stated()
            for name in sorted({*stated, *self.sums}):
                if name not in stated or self.sums.get(name) != _sum(stated[name]):
                    told.append(
                        f"{name}: changed since it was recorded: its check sum in sums differs"
                    )
        try:
            told += self._played_otherwise(parts)
        except DwellError as error:
            told.append(str(error).removeprefix(f"{self._at()}: "))
        return told

    def _played_otherwise(self, parts: Mapping[str, Any]) -> Iterator[str]:
        """The stated fields that do not hold when the episode is played."""
        differs, ended = False, dict[str, int]()
        for moment in self.play(**parts):
            for name, agent in moment.agents.items():
                if not agent.acts:
                    ended.setdefault(name, moment.step)
            if moment.step == 0:
                yield from picture_faults(self._settings(), moment.world.house)
            if moment.step == 0 and moment.instruction != self.instruction:
                yield (
                    f"instruction: the file states {quoted(self.instruction)}, "
                    f"played it is {quoted(moment.instruction)}"
                )
            if not moment.is_same and not differs:
                differs = True
                yield (
                    f"hashes[{moment.step}]: the file states {self.hashes[moment.step]}, played it "
                    f"is {moment.world.state_hash():016x}"
                )
        if moment.success != self.success:
            yield f"success: the file states {self.success}, played it is {moment.success}"
        if self.agents:
            yield from _agent_differences(self.agents, moment.agents, ended)


def _agent_differences(
    agents: Sequence[ReplayAgent], played: Mapping[str, AgentStep], ended: Mapping[str, int]
) -> Iterator[str]:
    """What the file states of the agents and does not hold at the end of the episode."""
    for k, agent in enumerate(agents):
        own = played[agent.name]
        for field, found in (
            ("instruction", own.instruction),
            ("success", own.success),
            ("ended", ended.get(agent.name)),
        ):
            stated = getattr(agent, field)
            if stated != found:
                yield (
                    f"agents[{k}].{field}: of {agent.name} the file states {quoted(stated)}, "
                    f"played it is {quoted(found)}"
                )


#: Fields of files of several agents alone.
_OF_AGENTS = ("agents", "shared_reward")
#: Fields of a replay that are not in every file.
_UNLISTED = ("path", "sums", "stated", *_OF_AGENTS)
#: The fields of a file.
_FIELDS = (
    "format",
    "version",
    *(field.name for field in dataclasses.fields(Replay) if field.name not in _UNLISTED),
    "sums",
)


def _hash_list(name: str, given: object) -> list[str]:
    """A list of text, one more than there may be actions."""
    return text_list(name, given, most=MAX_STEPS + 1)


#: What the fields of a replay may be.
_CHECKS: dict[str, Callable[[str, object], Any]] = {
    "house": text,
    "seed": integer_in_range,
    "config": text,
    "parts": text_list,
    "actions": lambda name, given: sequence_items(name, given, "expected a list of actions"),
    "hashes": _hash_list,
    "instruction": text,
    "success": boolean,
    "made_by": dwell_version,
}


def _name(action: str | Mapping[str, Any]) -> str:
    """The name of an action of a file."""
    return action if isinstance(action, str) else str(action["action"])


def _sum(value: object) -> str:
    """A check sum of a JSON value."""
    written = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(written.encode()).hexdigest()[:16]
