"""Logical forms as data: the small ones that questions are made of; see ``docs/words.md``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Form = dict[str, Any]


def described(
    noun: str,
    quantifier: str = "some",
    *,
    colors: Sequence[str] = (),
    modifiers: Sequence[Form] = (),
) -> Form:
    """A description of things by their noun."""
    return {
        "quantifier": quantifier,
        "noun": {"object": noun},
        "size": None,
        "state": None,
        "colors": list(colors),
        "material": None,
        "modifiers": list(modifiers),
        "selection": None,
    }


def modifier(predicate: str, *arguments: Form) -> Form:
    """A relation or place of what is described."""
    return {"negated": False, "predicate": predicate, "arguments": list(arguments)}


def seen(noun: str, **more: Any) -> Form:  # noqa: ANN401 - as of described
    """Things that the listener sees."""
    places = [*more.pop("modifiers", ()), modifier("visible")]
    return described(noun, modifiers=places, **more)


def phrase(description: Form) -> Form:
    """A description as an argument of a clause."""
    return {"described": description}


def the(noun: str, **more: Any) -> Form:  # noqa: ANN401 - as of described
    """``the NOUN`` as an argument of a clause."""
    return phrase(described(noun, "the", **more))


def whether(clause: Form) -> Form:
    """A yes-no question."""
    return {"question": {"whether": clause}}


def exists(description: Form) -> Form:
    """The clause that there is such a thing."""
    return {"exists": phrase(description)}


def holds(predicate: str, *arguments: Form | str) -> Form:
    """The clause that a predicate holds of its arguments."""
    return {"holds": {"predicate": predicate, "arguments": list(arguments)}}
