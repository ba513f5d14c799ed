"""Actions of agents whose task has an oracle: a form of actions, and what is asked."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import quoted
from dwell.envs.action_arrays import exact_fields, plain_array

if TYPE_CHECKING:
    from dwell.envs.action_modes import ActionForm, EngineActions

#: The most words of a question.
MAX_QUESTION_TOKENS = 16


def question_row(at: str, question: object) -> NDArray[np.int64]:
    """The question of one environment's action as files hold it, shape (1, 16).

    Raises:
        ConfigError: It is none; the message begins with ``at``.
    """
    last = len(_native.vocabulary())
    words = np.asarray(plain_array(at, question, "whole numbers"))
    is_whole = words.shape == (MAX_QUESTION_TOKENS,) and words.dtype.kind in "iu"
    if not is_whole or ((words < 0) | (words > last)).any():
        raise ConfigError(
            f"{at} is {quoted(question)}; expected {MAX_QUESTION_TOKENS} whole numbers from 0 to "
            f"{last}"
        )
    return words.astype(np.int64)[np.newaxis]


class AskingActions:
    """A form of actions with ``ask``: a question to the task's oracle.

    ``ask`` has a number for each place: word k is line k of ``assets/vocabulary.txt``, 0 is none;
    what stands behind the first 0 is not asked. All 0 asks nothing.
    """

    def __init__(self, form: ActionForm) -> None:
        """Adds questions to ``form``."""
        self.form = form
        self.names: list[str] = [*form.names]
        choices = len(_native.vocabulary()) + 1
        asked: spaces.Space[Any] = spaces.MultiDiscrete(np.full(MAX_QUESTION_TOKENS, choices))
        self._last = choices - 1
        self._is_dict = isinstance(form.space, spaces.Dict)
        parts = dict(form.space.spaces) if isinstance(form.space, spaces.Dict) else {}
        self.space: spaces.Space[Any] = spaces.Dict(
            {**(parts or {"action": form.space}), "ask": asked}
        )

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        parts = exact_fields("action", action, list(self.space))  # type: ignore[call-overload] # a Dict
        asked = [parts.pop("ask")]
        return self._with(self.form.one(parts if self._is_dict else parts["action"]), asked, 1)

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        parts = exact_fields("actions", actions, list(self.space))  # type: ignore[call-overload] # a Dict
        asked = parts.pop("ask")
        form = self.form.many(parts if self._is_dict else parts["action"], count)
        return self._with(form, asked, count)

    def _with(self, actions: EngineActions, asked: object, count: int) -> EngineActions:
        shape = (count, MAX_QUESTION_TOKENS)
        expected = f"whole numbers of shape {shape}, from 0 for none to {self._last}"
        words = plain_array("ask", asked, expected)
        if words.shape != shape or words.dtype.kind not in "iu":
            found = f"{words.dtype} of shape {words.shape}"
            raise ConfigError(f"ask: expected {expected}, found {found}")
        if ((words < 0) | (words > self._last)).any():
            raise ConfigError(f"ask: expected {expected}, found {quoted(words.tolist())}")
        return dataclasses.replace(actions, questions=words.astype(np.int64))

    def expert(
        self, numbers: NDArray[np.int64], questions: NDArray[np.int64] | None = None
    ) -> dict[str, Any]:
        """As :meth:`DiscreteActions.expert`.

        Args:
            numbers: The engine's actions, shape (n,).
            questions: What is asked, shape (n, 16); default nothing.
        """
        own = self.form.expert(numbers)
        if questions is None:
            questions = np.zeros((len(numbers), MAX_QUESTION_TOKENS), np.int64)
        return {**(own if self._is_dict else {"action": own}), "ask": questions}
