"""Utterances of agents as files hold them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import choice, integer_in_range, sequence_items
from dwell.envs.action_arrays import exact_fields

#: The most words of an utterance.
MAX_TOKENS = 8
#: The number of the vocal effort of conversation.
NORMAL_EFFORT = 1


def said_of_row(at: str, say: object) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The words and the effort of ``say`` in a file, shapes (1, 8) and (1,).

    Raises:
        ConfigError: They are none; the message begins with ``at``.
    """
    fields = exact_fields(at, say, ("tokens", "effort"))
    words = sequence_items(f"{at}: tokens", fields["tokens"], "expected numbers of words")
    last = len(_native.vocabulary())
    if not 1 <= len(words) <= MAX_TOKENS:
        raise ConfigError(f"{at}: {len(words)} tokens; allowed are 1 to {MAX_TOKENS}")
    tokens = np.zeros((1, MAX_TOKENS), np.int64)
    for k, word in enumerate(words):
        tokens[0, k] = integer_in_range(f"{at}: tokens[{k}]", word, low=1, high=last)
    known = _native.vocal_efforts()
    effort = choice(f"{at}: effort", fields["effort"], known)
    return tokens, np.array([known.index(effort)], np.int64)
