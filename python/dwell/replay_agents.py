"""The agents of a recorded episode: what each was asked, did and said, and how it ended."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell import ConfigError, _native
from dwell.arguments import (
    boolean,
    integer_in_range,
    mapping,
    quoted,
    sequence_items,
    text,
)

if TYPE_CHECKING:
    from dwell.envs.action_modes import EngineActions
    from dwell.envs.native_batch import NativeBatch
    from dwell.world import World


#: The sensors that open ears.
_EAR_SENSORS = ("audio", "spectrogram", "heard_tokens", "heard_directions")


@dataclasses.dataclass(frozen=True)
class ReplayAgent:
    """An agent of a recorded episode of several.

    Attributes:
        name: Its name.
        team: That of its team; empty where it stated none.
        instruction: What it was asked.
        success: Whether that was done when its episode ended, or after the last step.
        ended: The step that ended its episode; ``None``: it went on until the last one, or was
            truncated with it.
    """

    name: str
    team: str
    instruction: str
    success: bool
    ended: int | None

    @classmethod
    def of_row(cls, at: str, row: object) -> ReplayAgent:
        """The agent that a file states.

        Raises:
            ConfigError: It is none; the message begins with ``at``.
        """
        fields = mapping(at, row)
        known = [field.name for field in dataclasses.fields(cls)]
        if wrong := sorted({*fields} ^ {*known}):
            what = "unknown" if wrong[0] in fields else "missing"
            raise ConfigError(f"{at}: field {wrong[0]!r} is {what}")
        agent = cls(**fields)
        agent.check(at)
        return agent

    def check(self, at: str) -> None:
        """Refuses fields of other types.

        Raises:
            ConfigError: The message begins with ``at``.
        """
        for name in ("name", "team", "instruction"):
            text(f"{at}.{name}", getattr(self, name))
        boolean(f"{at}.success", self.success)
        if self.ended is not None:
            integer_in_range(f"{at}.ended", self.ended, low=1)


@dataclasses.dataclass(frozen=True)
class AgentStep:
    """An agent at one step of an episode that is played again.

    Attributes:
        action: Its last action as files hold it; ``None`` at the start, of scripted agents and
            after its episode has ended.
        reward: What the last step gave it, its team's share included.
        instruction: What it is asked.
        success: Whether that is done; after the end of its episode: was done then.
        acts: Whether its episode goes on.
        says: The words that it began to say in the last step.
        effort: The vocal effort of these; empty where there are none.
    """

    action: str | dict[str, Any] | None
    reward: float
    instruction: str
    success: bool
    acts: bool
    says: tuple[str, ...] = ()
    effort: str = ""


def scripted_places(config: Mapping[str, Any]) -> list[bool]:
    """Of each agent of the engine's settings whether it is scripted."""
    rows = sequence_items("config.agents", config.get("agents", []), "expected a list of agents")
    found = [mapping(f"config.agents[{k}]", row) for k, row in enumerate(rows)]
    return [boolean("config.agents.scripted", row.get("scripted", False)) for row in found]


def with_ears(config: Mapping[str, Any]) -> list[bool]:
    """Of each agent of the engine's settings whether a sensor opens its ears."""
    usual = {row["name"]: row["sensors"] for row in _native.tasks()}
    general, task = config.get("sensors"), config.get("task", "InstructionFollowing")
    found = []
    for row in config.get("agents", []):
        sensors = row.get("sensors", general)
        kinds = (
            usual.get(row.get("task", task), [])
            if sensors is None
            else [sensor["kind"] for sensor in sensors]
        )
        found.append(any(kind in _EAR_SENSORS for kind in kinds))
    return found


def check_agents(
    agents: Sequence[ReplayAgent], actions: Sequence[object], config: Mapping[str, Any]
) -> None:
    """Refuses agents that are not those of the settings, and actions that are not theirs.

    Raises:
        ConfigError: The message begins with the field.
    """
    names = [agent.name for agent in agents]
    scripted = scripted_places(config)
    if len(set(names)) < len(names) or len(names) != len(scripted):
        raise ConfigError(
            f"agents: found {quoted(names)}; expected {len(scripted)} different names, as config "
            "has so many agents"
        )
    for k, agent in enumerate(agents):
        agent.check(f"agents[{k}]")
        if agent.ended is not None and agent.ended > len(actions):
            raise ConfigError(f"agents[{k}].ended is {agent.ended} of {len(actions)} steps")
    for step, row in enumerate(actions):
        given = mapping(f"actions[{step}]", row, "an action by each agent's name")
        act = [
            agent.name
            for agent, is_scripted in zip(agents, scripted, strict=True)
            if not is_scripted and (agent.ended is None or step < agent.ended)
        ]
        if set(given) != set(act):
            raise ConfigError(
                f"actions[{step}] is of {quoted(sorted(map(str, given)))}; those of {quoted(act)} "
                "act in this step"
            )


def engine_steps(
    agents: Sequence[ReplayAgent], actions: Sequence[Mapping[str, Any]]
) -> Iterator[EngineActions]:
    """The actions of all agents, step by step, as the engine takes them.

    Raises:
        ConfigError: One is none; the message begins with its place.
    """
    from dwell.envs.action_modes import EngineActions
    from dwell.envs.agent_forms import NO_ACTION

    for step, row in enumerate(actions):
        yield EngineActions.interleaved(
            [
                EngineActions.of_row(f"actions[{step}].{agent.name}", row[agent.name])
                if agent.name in row
                else NO_ACTION
                for agent in agents
            ]
        )


class PlayedAgents:
    """The agents of an episode while it is played again."""

    def __init__(
        self,
        agents: Sequence[ReplayAgent],
        shared_reward: float,
        scripted: Sequence[bool],
        runner: NativeBatch,
    ) -> None:
        """At the start of the episode.

        Args:
            agents: As the file states them; of their fields names and teams count.
            shared_reward: Which share of a reward is the team's mean.
            scripted: Who is scripted.
            runner: Who plays it.
        """
        from dwell.envs.agent_settings import places_of_teams

        self._names = [agent.name for agent in agents]
        self._scripted, self._runner = scripted, runner
        self._teams = places_of_teams([agent.team for agent in agents])
        self._share = shared_reward
        self.instructions = [runner.batch.instruction(0, k) for k in range(len(agents))]
        self.success = [False] * len(agents)
        #: Of each the step that ended its episode.
        self.ended: list[int | None] = [None] * len(agents)
        self._says: list[tuple[tuple[str, ...], str]] = [((), "")] * len(agents)

    def before(self, actions: EngineActions, world: World) -> None:
        """A step is about to be made: keeps what is said by it."""
        known, efforts = _native.vocabulary(), _native.vocal_efforts()
        tokens = np.zeros((len(self._names), 1), np.int64)
        if actions.tokens is not None:
            tokens = actions.tokens
        if any(self._scripted):
            own = self._runner.batch.expert_utterances().reshape(len(self._names), -1)
            tokens = np.where(np.array(self._scripted)[:, np.newaxis], own, _wide(tokens, own))
        silent = [world.speaks(k) for k in range(len(self._names))]
        self._says = []
        for k, row in enumerate(tokens.tolist()):
            words = tuple(known[token - 1] for token in row[: [*row, 0].index(0)])
            if not words or silent[k] or self.ended[k] is not None:
                self._says.append(((), ""))
                continue
            effort = 1 if actions.efforts is None else int(actions.efforts[k])
            self._says.append((words, efforts[effort]))

    def after(
        self,
        step: int,
        row: Mapping[str, Any] | None,
        answer: Mapping[str, Any] | None,
        world: World,
    ) -> dict[str, AgentStep]:
        """The agents after a step was made, or at the start, where there is no answer."""
        from dwell.envs.agent_forms import shared_rewards

        rewards = np.zeros(len(self._names))
        if answer is not None:
            own = np.asarray(answer["reward"], np.float64)[np.newaxis]
            rewards = shared_rewards(own, self._teams, self._share)[0]
            for k, ended in enumerate(self.ended):
                if ended is None:
                    self.success[k] = bool(answer["success"][k])
                    if answer["terminated"][k]:
                        self.ended[k] = step
        found = {}
        for k, name in enumerate(self._names):
            # What was said is heard of only where a voice sounds: worlds may be muted.
            words, effort = self._says[k] if world.speaks(k) else ((), "")
            over = self.ended[k]
            found[name] = AgentStep(
                action=None if row is None else row.get(name),
                reward=float(rewards[k]) if over is None or over == step else 0.0,
                instruction=self.instructions[k],
                success=self.success[k],
                acts=over is None,
                says=words,
                effort=effort,
            )
        return found


def _wide(tokens: np.ndarray[Any, np.dtype[np.int64]], like: Any) -> Any:  # noqa: ANN401 - arrays
    """The same with as many columns."""
    rows = np.zeros_like(like)
    rows[:, : tokens.shape[1]] = tokens
    return rows


def agent_rows(agents: Sequence[ReplayAgent]) -> list[dict[str, Any]]:
    """The agents as files hold them."""
    return [dataclasses.asdict(agent) for agent in agents]
