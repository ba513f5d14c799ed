"""English: sentences to logical forms and back; ``docs/words.md`` says what forms mean."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import integer_in_range, plain_settings, quoted, text

__all__ = ["question_tokens", "read", "say", "vocabulary"]

#: The most words and marks of a question to an oracle.
_MOST_ASKED = 16


def vocabulary() -> list[str]:
    """The words of instructions and utterances; word k, counted from 1, is token k.

    Examples:
        >>> from dwell.language import vocabulary
        >>> "sofa" in vocabulary()
        True
    """
    return [*_native.vocabulary()]


def question_tokens(question: str) -> NDArray[np.int64]:
    """A question as actions hold it under ``ask``, shape (16,), padded with 0.

    Raises:
        ConfigError: It has more than 16 words and marks, or words outside the vocabulary.

    Examples:
        >>> from dwell.language import question_tokens, vocabulary
        >>> tokens = question_tokens("Is it red?")
        >>> [vocabulary()[token - 1] for token in tokens if token]
        ['is', 'it', 'red', '?']
    """
    spaced = text("question", question).lower()
    for mark in ".,?!":
        spaced = spaced.replace(mark, f" {mark} ")
    words = spaced.split()
    if len(words) > _MOST_ASKED:
        raise ConfigError(f"question has {len(words)} words and marks; allowed are {_MOST_ASKED}")
    numbers = {word: number for number, word in enumerate(vocabulary(), 1)}
    if unknown := [word for word in words if word not in numbers]:
        raise ConfigError(
            f"question: {quoted(unknown[0])} is no word of dwell.language.vocabulary()"
        )
    tokens = np.zeros(_MOST_ASKED, np.int64)
    tokens[: len(words)] = [numbers[word] for word in words]
    return tokens


def read(sentence: str) -> list[dict[str, Any]]:
    """The logical forms that a sentence may stand for, the preferred one first.

    Raises:
        ConfigError: It is not understood: the message names unknown words with the nearest known
            ones, or how far the sentence was understood and what could follow.

    Examples:
        >>> from dwell.language import read, say
        >>> say(read("put the mug onto the table".replace("onto", "on"))[0])
        'Put the mug on the table.'
        >>> list(read("Is there a red chair?")[0])
        ['question']
    """
    forms: list[dict[str, Any]] = _native.language_read(text("sentence", sentence))
    return forms


def say(form: Mapping[str, Any], *, seed: int | None = None) -> str:
    """A form in English.

    Args:
        form: As :func:`read` gives it.
        seed: Draws the wording; without it every form has its first one.

    Raises:
        ConfigError: It is no form, or English has no words for it.

    Examples:
        >>> from dwell.language import read, say
        >>> form = read("walk to the kitchen")[0]
        >>> say(form), say(form, seed=5) == say(form, seed=5)
        ('Go to the kitchen.', True)
    """
    given: object = form
    if not isinstance(given, Mapping) or len(given) != 1:
        raise ConfigError(
            f"form is {quoted(form)}; allowed are mappings as dwell.language.read gives, of one "
            "field each"
        )
    form = plain_settings(form, "form")
    drawn = None if seed is None else integer_in_range("seed", seed, high=2**64 - 1)
    said = _native.language_say(form, drawn)
    if said is None:
        raise ConfigError(f"English has no words for the form {quoted(form)}")
    return said
