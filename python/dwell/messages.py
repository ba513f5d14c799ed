"""What errors say: never much text, and nothing that commands a terminal.

Names come from strangers' files, and values are as long as whoever gives them likes.
"""

from __future__ import annotations

import re

from dwell._native import DwellError

#: What commands a terminal or turns the direction of writing, and what is no text at all.
_COMMANDS = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)
#: A word of which the beginning alone is shown.
_LONG_WORD = re.compile(r"(\S{200})\S{100,}")
#: The most characters of a message, and how many of the beginning and of the end of a longer one
#: are kept, as in those of the engines.
_MOST_CHARACTERS = 8000
_KEPT_CHARACTERS = 2000


def printable(text: str) -> str:
    """Text in which names of strangers command no terminal: they are escaped as in JSON."""
    return _COMMANDS.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def shortened(text: str) -> str:
    """A message that people can read: of a very long one, the beginning and the end."""
    if len(text) <= _MOST_CHARACTERS:
        return text
    left_out = len(text) - 2 * _KEPT_CHARACTERS
    head, tail = text[:_KEPT_CHARACTERS], text[-_KEPT_CHARACTERS:]
    return f"{head}... ({left_out} characters left out) ...{tail}"


def with_short_words(text: str) -> str:
    """A shortened message in which of long words the beginning alone stands."""
    words = _LONG_WORD.sub(lambda word: f"{word[1]}...({len(word[0])} characters)", text)
    return shortened(words)


def _said(error: DwellError) -> str:
    """The message of an error of dwell's tree, wherever it was made."""
    return shortened(printable(super(DwellError, error).__str__()))


def install() -> None:
    """Lets all errors of dwell's tree say printable and short text.

    The engines' are so already. Those of Python are made in many places, and by those who extend
    dwell; what they have in common is their class.
    """
    DwellError.__str__ = _said  # type: ignore[method-assign, assignment]
