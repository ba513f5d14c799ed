"""Actions of agents that can speak: a form of actions, and what is said."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import (
    abbreviated_list,
    integer_in_range,
    mapping,
    quoted,
    refuse_unknown,
    text_list,
)
from dwell.envs.action_arrays import choices_below, exact_fields, plain_array
from dwell.envs.action_modes import ActionForm, AnsweredActions, EngineActions
from dwell.envs.utterance_rows import MAX_TOKENS, NORMAL_EFFORT


@functools.cache
def _numbers() -> dict[str, int]:
    """The words of the vocabulary with their numbers."""
    return {word: number for number, word in enumerate(_native.vocabulary(), 1)}


@dataclasses.dataclass(frozen=True)
class Voice:
    """What an agent can say.

    Attributes:
        words: The words that it knows; default all of the vocabulary.
        max_tokens: The most words of an utterance, 1 to 8.
        efforts: The vocal efforts that it chooses from; default that of conversation.
    """

    words: Sequence[str] | None = None
    max_tokens: int = MAX_TOKENS
    efforts: Sequence[str] = ("normal",)

    @classmethod
    def of(cls, at: str, voice: object) -> Voice | None:
        """The voice of a setting: ``True``, ``False``, or fields.

        Raises:
            ConfigError: It is none; the message begins with ``at``.
        """
        if isinstance(voice, bool | np.bool_):
            return cls() if voice else None
        if not isinstance(voice, Mapping):
            raise ConfigError(
                f"{at} is {quoted(voice)}; allowed are True, False, and a mapping with words, "
                "max_tokens or efforts"
            )
        fields = mapping(at, voice)
        known = [field.name for field in dataclasses.fields(cls)]
        refuse_unknown(at, [name for name in fields if name not in known], known)
        words = fields.get("words")
        checked = None if words is None else _known(f"{at}.words", words, _numbers())
        efforts = fields.get("efforts", cls.efforts)
        return cls(
            checked,
            integer_in_range(
                f"{at}.max_tokens", fields.get("max_tokens", MAX_TOKENS), low=1, high=MAX_TOKENS
            ),
            _known(f"{at}.efforts", efforts, _native.vocal_efforts()),
        )


def _known(at: str, names: object, known: Sequence[str] | Mapping[str, int]) -> list[str]:
    """Names that are there, at least one, each once."""
    found = text_list(at, names)
    unknown = [name for name in found if name not in known]
    if unknown or not found or len(set(found)) < len(found):
        wrong = abbreviated_list(unknown) if unknown else quoted(found)
        raise ConfigError(f"{at}: {wrong}; allowed are some of {abbreviated_list([*known])}, once")
    return found


class VoicedActions:
    """A form of actions with ``say``: words, and how loudly they are said.

    ``say`` has ``tokens``, for each place a word by its number among those that the agent knows,
    counted from 1, and 0 for none; what stands behind the first 0 is not said. Where there are
    several, ``effort`` is one of the vocal efforts.
    """

    def __init__(self, form: ActionForm | AnsweredActions, voice: Voice) -> None:
        """Adds a voice to ``form``."""
        self.form, self.names = form, form.names
        words = [*_numbers()] if voice.words is None else [*voice.words]
        #: The numbers of the engine, by those of the agent.
        self._tokens = np.array([0, *(_numbers()[word] for word in words)], np.int64)
        #: The words that the agent knows, by their numbers; the first is none.
        self.words = ["", *words]
        known = _native.vocal_efforts()
        self._efforts = np.array([known.index(name) for name in voice.efforts], np.int64)
        self._count = voice.max_tokens
        own: dict[str, spaces.Space[Any]] = {
            "tokens": spaces.MultiDiscrete(np.full(self._count, len(self.words)))
        }
        if len(self._efforts) > 1:
            own["effort"] = spaces.Discrete(len(self._efforts))
        self._keys = [*own]
        self._is_dict = isinstance(form.space, spaces.Dict)
        parts = dict(form.space.spaces) if isinstance(form.space, spaces.Dict) else {}
        parts = parts or {"action": form.space}
        self.space: spaces.Space[Any] = spaces.Dict({**parts, "say": spaces.Dict(own)})

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        parts = exact_fields("action", action, list(self.space))  # type: ignore[call-overload] # a Dict
        said = exact_fields("say", parts.pop("say"), self._keys)
        form = self.form.one(parts if self._is_dict else parts["action"])
        return self._with(form, {key: [value] for key, value in said.items()}, 1)

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        parts = exact_fields("actions", actions, list(self.space))  # type: ignore[call-overload] # a Dict
        said = exact_fields("say", parts.pop("say"), self._keys)
        form = self.form.many(parts if self._is_dict else parts["action"], count)
        return self._with(form, said, count)

    def _with(self, actions: EngineActions, said: Mapping[str, Any], count: int) -> EngineActions:
        expected = f"whole numbers of shape ({count}, {self._count})"
        words = plain_array("say: tokens", said["tokens"], expected)
        if words.shape != (count, self._count):
            raise ConfigError(f"say: tokens: expected {expected}, found shape {words.shape}")
        last = len(self.words) - 1
        if words.dtype.kind not in "iu" or ((words < 0) | (words > last)).any():
            raise ConfigError(
                f"say: tokens are {quoted(words.tolist())}; allowed are whole numbers from 0, for "
                f"none, to {last}"
            )
        flat = words.astype(np.int64).ravel()
        tokens = np.zeros((count, MAX_TOKENS), np.int64)
        tokens[:, : self._count] = self._tokens[flat].reshape(count, self._count)
        chosen = np.zeros(count, np.int64)
        if "effort" in said:
            chosen = choices_below("say: effort", said["effort"], count, len(self._efforts))
        return dataclasses.replace(actions, tokens=tokens, efforts=self._efforts[chosen])

    def of_expert(self, own: Any, tokens: NDArray[np.int64]) -> Any:  # noqa: ANN401 - of the spaces
        """Actions of the form without a voice, with what experts say.

        Args:
            own: Elements of the form's batched space.
            tokens: Numbers of the engine's words up to the first 0, shape (n, 8); words that the
                agent does not know are left out.
        """
        places = np.zeros(len(_numbers()) + 1, np.int64)
        places[self._tokens] = np.arange(len(self.words))
        said = np.zeros((len(tokens), self._count), np.int64)
        for row, words in zip(said, places[tokens], strict=True):
            known = words[words > 0][: self._count]
            row[: len(known)] = known
        say: dict[str, NDArray[Any]] = {"tokens": said}
        if "effort" in self._keys:
            normal = np.flatnonzero(self._efforts == NORMAL_EFFORT)
            say["effort"] = np.full(len(tokens), normal[0] if normal.size else 0, np.int64)
        return {**(own if self._is_dict else {"action": own}), "say": say}
