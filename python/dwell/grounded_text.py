"""Texts with the things that they are about."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["Text"]

# How much a text tells.
Length: TypeAlias = Literal["short", "normal", "long"]
# Whether things are told with their colours, materials and sizes.
Style: TypeAlias = Literal["plain", "rich"]


class Text(str):
    """A text of the engine, with its meaning and the things that it is about.

    Attributes:
        spans: The noun phrases from left to right, the outer before the inner: ``start``, ``end``
            (letters), ``ids`` and ``rooms``.
        claims: What the text says, sentence by sentence: ``start``, ``end``, ``form`` as
            :func:`dwell.language.say` takes it, ``ids`` and ``rooms``.
        ids: The ids of instance images and of the scene graph that the text is about, ascending.
        rooms: The rooms that it is about, counted from 0, ascending.

    Examples:
        >>> import dwell
        >>> text = dwell.House.open("builtin:apartment").describe("object")[0]
        >>> span = text.spans[0]
        >>> text[span["start"] : span["end"]] == text, len(span["ids"])
        (True, 1)
    """

    __slots__ = ("claims", "ids", "rooms", "spans")

    spans: list[dict[str, Any]]
    claims: list[dict[str, Any]]
    ids: list[int]
    rooms: list[int]

    def __new__(
        cls,
        text: str,
        spans: Sequence[dict[str, Any]] = (),
        claims: Sequence[dict[str, Any]] = (),
        ids: Sequence[int] = (),
        rooms: Sequence[int] = (),
    ) -> Self:
        """A text with the attributes of the same names."""
        made = super().__new__(cls, text)
        made.spans, made.claims = list(spans), list(claims)
        made.ids, made.rooms = list(ids), list(rooms)
        return made

    def __reduce__(self) -> tuple[type[Text], tuple[Any, ...]]:
        """Pickles with its attributes."""
        return (Text, (str(self), self.spans, self.claims, self.ids, self.rooms))

    def as_dict(self) -> dict[str, Any]:
        """``text``, ``spans``, ``claims``, ``ids`` and ``rooms``."""
        names = ("spans", "claims", "ids", "rooms")
        return {"text": str(self)} | {name: getattr(self, name) for name in names}


def texts(level: str, rows: list[dict[str, Any]]) -> list[Text] | list[str]:
    """Texts of the rows of a level; JSON texts for graphs and instructions."""
    if level == "graph":
        return [row["text"] for row in rows]
    if level == "instructions":
        return [json.dumps(row) for row in rows]
    return [Text(**row) for row in rows]
