"""Templates of questions about views: forms with a hole, and what must be clear in a picture.

To add one: a function here, and a line in :data:`TEMPLATES`.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal

from dwell.views.forms import (
    Form,
    described,
    exists,
    holds,
    modifier,
    seen,
    the,
    whether,
)

#: A large thing of a record.
Thing = dict[str, Any]


@dataclasses.dataclass(frozen=True)
class Asked:
    """A form that may be asked of any view.

    Attributes:
        form: The question.
        of_all: Descriptions of which every thing in the picture must be clear, and none a speck.
        of_one: Descriptions that must fit one thing in the picture, which is clear.
        needs_light: Whether the things must not be dark.
        clear: What else must be clear: ``apart``, that the two things are beside each other in the
            picture; ``level``, that one is as high as the other,
            and neither lies in or on the other; ``side``, that no thing is near
            the lines between left, ahead and right, or cut off; ``plain``, that things have one
            colour and no pattern; ``settled``, that they are open or closed, not half; ``placed``,
            that a thing is in or on what the answer names.
        side: On which side of the picture a thing is that makes the answer ``yes``.
        words: What the numbers of alternatives mean.
    """

    form: Form
    of_all: tuple[Form, ...] = ()
    of_one: tuple[Form, ...] = ()
    needs_light: bool = False
    clear: Literal["", "apart", "level", "side", "plain", "settled", "placed"] = ""
    side: Literal["", "on_left", "on_right"] = ""
    words: tuple[str, ...] = ()


def _nouns(things: Sequence[Thing]) -> list[str]:
    return sorted({thing["noun"] for thing in things})


def _pairs(things: Sequence[Thing]) -> Iterator[tuple[str, str]]:
    """Nouns of things that are seen together in a view, without doors and windows."""
    nouns = _nouns([thing for thing in things if not thing["is_opening"]])
    for first in nouns:
        for second in nouns:
            if first != second:
                yield first, second


def _existence(things: Sequence[Thing]) -> Iterator[Asked]:
    """Do you see a chair?"""
    for noun in _nouns(things):
        yield Asked(whether(exists(seen(noun))), of_all=(described(noun),))


def _existence_color(things: Sequence[Thing]) -> Iterator[Asked]:
    """Do you see a red chair?"""
    for thing in things:
        if len(thing["colors"]) == 1:
            what = seen(thing["noun"], colors=thing["colors"])
            all_of_noun = (described(thing["noun"]),)
            yield Asked(whether(exists(what)), of_all=all_of_noun, needs_light=True, clear="plain")


def _count(things: Sequence[Thing]) -> Iterator[Asked]:
    """How many chairs do you see?"""
    for noun in _nouns(things):
        yield Asked({"question": {"how_many": seen(noun)}}, of_all=(described(noun),))


def _color(things: Sequence[Thing]) -> Iterator[Asked]:
    """What color is the chair?"""
    for noun in _nouns(things):
        form = {"question": {"attribute": {"kind": "color", "of": the(noun)}}}
        yield Asked(form, of_one=(described(noun),), needs_light=True, clear="plain")


def _more(things: Sequence[Thing]) -> Iterator[Asked]:
    """Do you see more chairs than tables?"""
    for first, second in itertools.permutations(_nouns(things), 2):
        clause = {"more": {"more": seen(first), "than": seen(second)}}
        yield Asked(whether(clause), of_all=(described(first), described(second)))


def _taller(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the chair taller than the table?"""
    for first, second in _pairs(things):
        clause = holds("taller_than", the(first), the(second))
        yield Asked(whether(clause), of_one=(described(first), described(second)))


def _side_of(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the chair to the left of the table?"""
    for first, second in _pairs(things):
        clause = holds("left_of", the(first), the(second))
        both = (described(first), described(second))
        yield Asked(whether(clause), of_one=both, clear="apart")


def _before(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the chair in front of the table?"""
    for first, second in _pairs(things):
        clause = holds("in_front_of", the(first), the(second))
        both = (described(first), described(second))
        yield Asked(whether(clause), of_one=both, clear="level")


def _next_to(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the chair next to the table?"""
    for first, second in _pairs(things):
        clause = holds("next_to", the(first), the(second))
        yield Asked(whether(clause), of_one=(described(first), described(second)))


def _side(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is there a chair on your left?"""
    sides: tuple[Literal["on_left", "on_right"], ...] = ("on_left", "on_right")
    for noun in _nouns(things):
        for side in sides:
            form = whether(exists(seen(noun, modifiers=[modifier(side)])))
            yield Asked(form, of_all=(described(noun),), clear="side", side=side)


def _place(things: Sequence[Thing]) -> Iterator[Asked]:
    """Where is the cup?"""
    for noun in _nouns(things):
        form = {"question": {"attribute": {"kind": "place", "of": the(noun)}}}
        yield Asked(form, of_one=(described(noun),), clear="placed")


def _open(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the door open?"""
    for noun in sorted({thing["noun"] for thing in things if thing["openness"] is not None}):
        clause = {"is": {"subject": the(noun), "quality": {"state": "open"}}}
        yield Asked(whether(clause), of_one=(described(noun),), clear="settled")


def _on(things: Sequence[Thing]) -> Iterator[Asked]:
    """Is the lamp on?"""
    for noun in sorted({thing["noun"] for thing in things if thing["switched_on"] is not None}):
        clause = {"is": {"subject": the(noun), "quality": {"state": "switched_on"}}}
        yield Asked(whether(clause), of_one=(described(noun),))


#: Kind, template and its forms out of the large things of a view.
TEMPLATES: dict[str, tuple[str, Callable[[Sequence[Thing]], Iterator[Asked]]]] = {
    "existence": ("existence", _existence),
    "existence_color": ("existence", _existence_color),
    "count": ("count", _count),
    "color": ("attribute", _color),
    "more": ("comparison", _more),
    "taller": ("comparison", _taller),
    "left_of": ("relation", _side_of),
    "in_front_of": ("relation", _before),
    "next_to": ("relation", _next_to),
    "side": ("location", _side),
    "place": ("location", _place),
    "open": ("state", _open),
    "on": ("state", _on),
}

__all__ = ["TEMPLATES", "Asked"]
