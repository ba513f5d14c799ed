"""Rows of answers and verdicts, checked where they come from files or from methods."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from dwell.arguments import quoted
from dwell.files import lines, open_file, parse_json

__all__ = ["check_verdict", "read_answers", "read_verdicts"]

VERDICT_KINDS = ("nothing", "named", "one_of", "unexplained")
_Check = Callable[[Any], bool]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_numbers(value: object) -> bool:
    """By name."""
    return isinstance(value, dict) and all(map(_is_number, value.values()))


def _is_estimates(value: object) -> bool:
    """By name a value and its interval."""
    return isinstance(value, dict) and all(
        isinstance(one, list | tuple) and len(one) == 3 and all(map(_is_number, one))
        for one in value.values()
    )


def _is_sets(value: object) -> bool:
    return isinstance(value, list | tuple) and all(
        isinstance(one, list | tuple) and one and all(isinstance(id, str) for id in one)
        for one in value
    )


def _is_hidden(value: object) -> bool:
    return isinstance(value, list) and all(
        isinstance(one, dict)
        and isinstance(one.get("id"), str)
        and _is_number(one.get("d_prime"))
        and _is_numbers(one.get("parameters"))
        for one in value
    )


_VERDICT: dict[str, tuple[_Check, str]] = {
    "kind": (lambda value: value in VERDICT_KINDS, f"one of {', '.join(VERDICT_KINDS)}"),
    "sets": (_is_sets, "explanations, each a list of effects"),
    "parameters": (
        lambda value: isinstance(value, dict) and all(map(_is_estimates, value.values())),
        "by effect and name [value, low, high]",
    ),
    "method": (
        lambda value: value is None or isinstance(value, str),
        "the name of what judged, or none",
    ),
}
_ANSWER: dict[str, tuple[_Check, str]] = {
    "kind": (lambda value: isinstance(value, str), "the kind of the case"),
    "hidden": (_is_hidden, "objects with id, parameters and d_prime"),
    "rivals": (_is_numbers, "numbers by effect"),
}


def _check(row: Mapping[str, Any], fields: dict[str, tuple[_Check, str]], at: str) -> None:
    for name, (is_right, expected) in fields.items():
        found = row.get(name)
        if not is_right(found):
            raise ValueError(f"{at}: {name} is {quoted(found, 80)}; expected {expected}")


def check_verdict(row: Mapping[str, Any], at: str) -> None:
    """Checks a verdict.

    Args:
        row: What a method returned.
        at: What messages begin with.

    Raises:
        ValueError: A field is missing or wrong.
    """
    _check(row, _VERDICT, at)


def read_answers(path: Path) -> Iterator[dict[str, Any]]:
    """The rows of a file of answers.

    Raises:
        ValueError: A line is none, or a case stands twice; the message names line and field.
    """
    return _rows(path, _ANSWER)


def read_verdicts(path: Path) -> Iterator[dict[str, Any]]:
    """The rows of a file of verdicts.

    Raises:
        ValueError: A line is none, or a case stands twice; the message names line and field.
    """
    return _rows(path, _VERDICT)


def _rows(path: Path, fields: dict[str, tuple[_Check, str]]) -> Iterator[dict[str, Any]]:
    seen: dict[str, int] = {}
    with open_file(path) as file:
        for number, line in enumerate(lines(file, path), start=1):
            if not line.endswith(b"\n"):
                # As a kill leaves it.
                return
            at = f"{path} line {number}"
            row = parse_json(line, at)
            if not isinstance(row, dict) or not isinstance(row.get("case"), str):
                raise ValueError(f"{at}: expected an object with a case, found {quoted(row, 80)}")
            _check(row, fields, at)
            before = seen.setdefault(row["case"], number)
            if before != number:
                case = quoted(row["case"])
                raise ValueError(f"{at}: case {case} stands in line {before}, too; expected once")
            yield row
