"""Several agents' actions on their way to the engine, and what it answers on its way back."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, UsageError
from dwell.arguments import abbreviated_list, mapping, number_in_range, quoted
from dwell.envs.action_modes import AnsweredActions, EngineActions, action_form, masked_form
from dwell.envs.agent_settings import AgentRoster
from dwell.envs.asking import AskingActions
from dwell.envs.native_batch import NativeBatch
from dwell.envs.voice import VoicedActions

#: That of an agent that takes none: it is scripted, or its episode has ended.
NO_ACTION = EngineActions(np.full(1, -1, np.int64))


def shared_rewards(
    own: NDArray[np.float64], teams: Sequence[Sequence[int]], share: float
) -> NDArray[np.float64]:
    """Rewards of which a share is the mean of the agent's team, shape (environment, agent).

    Args:
        own: What each agent is paid itself.
        teams: Of each agent the places of those of its team, itself among them.
        share: 0 (all private) to 1.
    """
    if not share:
        return own
    team = np.stack([own[:, [*places]].mean(axis=1) for places in teams], axis=1)
    return (1.0 - share) * own + share * team


@contextlib.contextmanager
def _of_agent(name: str) -> Iterator[None]:
    """What is refused meanwhile says whose it is."""
    try:
        yield
    except ConfigError as error:
        raise ConfigError(f"agent {name}: {error}") from None


class AgentForms:
    """The spaces and forms of actions of all agents that act in each environment of a batch."""

    def __init__(
        self,
        config: str,
        runner: NativeBatch,
        roster: AgentRoster,
        *,
        action_mask: object,
        shared_reward: object,
    ) -> None:
        """Reads the agents' forms.

        Args:
            config: The native ``EnvConfig`` as JSON.
            runner: A batch of it.
            roster: Who acts.
            action_mask: Whether infos have masks of the actions that are not ruled out.
            shared_reward: Which share of a reward is the mean of the agent's team, 0 to 1.

        Raises:
            ConfigError: An agent's form has no masks; the share is out of range.
        """
        batch = runner.batch
        #: All names, those of scripted agents among them.
        self.names = roster.names
        #: The places of those who take actions.
        self.players = roster.players
        count = len(self.names)
        silent = [
            action_form(config, batch.answer_fields(k), k, asks=batch.takes_questions(k))
            for k in range(count)
        ]
        self._masks = []
        for name, form in zip(self.names, silent, strict=True):
            with _of_agent(name):
                self._masks.append(masked_form(action_mask, form))
        self._forms = [
            form if voice is None else VoicedActions(form, voice)
            for form, voice in zip(silent, roster.voices, strict=True)
        ]
        self.measures = [batch.measures(k) for k in range(count)]
        #: Which share of a reward is the mean of the agent's team.
        self.share = number_in_range("shared_reward", shared_reward, 0.0, 1.0)
        self._teams = roster.teams
        self.action_spaces: dict[str, spaces.Space[Any]] = {
            self.names[k]: self._forms[k].space for k in self.players
        }
        self.observation_spaces = {
            self.names[k]: spaces.Dict(runner.agent_spaces[k]) for k in self.players
        }

    def action_names(self, agent: int) -> list[str]:
        """The names of an agent's actions, in the order of their numbers."""
        return [*self._forms[agent].names]

    def one(self, actions: object, live: list[str]) -> list[EngineActions]:
        """The actions of one environment, by the agents' names, as the engine takes them.

        Returns:
            Those of each agent, :data:`NO_ACTION` of who takes none.

        Raises:
            ConfigError: They are not one for each agent of ``live``, or one is none.
            UsageError: One is of an agent whose episode has ended.
        """
        given = mapping("actions", actions, "actions by the agents' names")
        for name in given:
            if name not in self.action_spaces:
                known = abbreviated_list([*self.action_spaces])
                raise ConfigError(f"actions: no agent {quoted(name)}; allowed are {known}")
            if name not in live:
                raise UsageError(f"actions: the episode of {name} has ended; leave its action out")
        if missing := [name for name in live if name not in given]:
            raise ConfigError(
                f"actions: none of {abbreviated_list(missing)}; expected one for each of "
                f"{abbreviated_list(live)}"
            )
        taken = [NO_ACTION] * len(self.names)
        for k in self.players:
            if self.names[k] in given:
                taken[k] = self.of_agent(k, given[self.names[k]])
        return taken

    def of_agent(self, agent: int, action: object) -> EngineActions:
        """An agent's action as the engine takes it.

        Raises:
            ConfigError: It is none.
        """
        with _of_agent(self.names[agent]):
            return self._forms[agent].one(action)

    def many(self, actions: object, acts: NDArray[np.bool_]) -> list[EngineActions]:
        """The actions of several environments, by the agents' names, as the engine takes them.

        Args:
            actions: Elements of the batched action spaces, of all agents.
            acts: Whose actions are taken, shape (environment, agent), scripted ones among them.

        Returns:
            Those of each agent, one for each environment, with the number -1 for none.

        Raises:
            ConfigError: They are not those of all agents, or one is none.
        """
        given = mapping("actions", actions, "batched actions by the agents' names")
        if set(given) != set(self.action_spaces):
            raise ConfigError(
                f"actions: found {abbreviated_list(sorted(map(str, given)))}; expected those of "
                f"{abbreviated_list([*self.action_spaces])}"
            )
        count = len(acts)
        taken = [EngineActions(np.full(count, -1, np.int64))] * len(self.names)
        for k in self.players:
            with _of_agent(self.names[k]):
                own = self._forms[k].many(given[self.names[k]], count)
            taken[k] = own.without(~acts[:, k])
        return taken

    def rewards(self, answer: Mapping[str, Any]) -> NDArray[np.float64]:
        """What each agent is paid, shape (environment, agent)."""
        own = np.asarray(answer["reward"], np.float64).reshape(-1, len(self.names))
        return shared_rewards(own, self._teams, self.share)

    def masks(self, runner: NativeBatch) -> list[NDArray[np.int8] | None]:
        """Of each agent the actions that are not ruled out, (environment, action), if asked for."""
        if all(mask is None for mask in self._masks):
            return [None] * len(self.names)
        all_rows, count = runner.action_masks(), len(self.names)
        return [
            None if own is None else own.masks(all_rows[k::count])
            for k, own in enumerate(self._masks)
        ]

    def expert(self, runner: NativeBatch) -> dict[str, Any]:
        """What the agents' experts would do now, elements of the batched action spaces."""
        numbers, count = runner.expert_actions(), len(self.names)
        answers = runner.batch.expert_answers().reshape(len(numbers), -1)
        words = runner.batch.expert_utterances().reshape(len(numbers), -1)
        questions = runner.batch.expert_questions().reshape(len(numbers), -1)
        found: dict[str, Any] = {}
        for k, (name, form) in enumerate(zip(self.names, self._forms, strict=True)):
            silent = form.form if isinstance(form, VoicedActions) else form
            if isinstance(silent, AnsweredActions):
                own = silent.expert(numbers[k::count], answers[k::count])
            elif isinstance(silent, AskingActions):
                own = silent.expert(numbers[k::count], questions[k::count])
            else:
                own = silent.expert(numbers[k::count])
            if isinstance(form, VoicedActions):
                own = form.of_expert(own, words[k::count])
            found[name] = own
        return found

    def words(self, agent: int) -> list[str]:
        """The words that an agent can say, by their numbers; the first is none."""
        form = self._forms[agent]
        return [*form.words] if isinstance(form, VoicedActions) else []
