"""Checks of values by the schemas that the engine makes of its own types."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dwell import _native
from dwell._native import ConfigError
from dwell.arguments import (
    boolean,
    checked_fields,
    finite_number,
    integer_in_range,
    mapping,
    plain_settings,
    point,
    quoted,
    text,
    two_numbers,
)

Check = Callable[[str, object], Any]

#: Bounds of whole numbers by their format.
_BOUNDS = {
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "uint": (0, 2**64 - 1),
    "uint64": (0, 2**64 - 1),
}
#: What the package takes in other forms than the engine.
_WITHOUT_CHECK = {
    "agents",
    "colors",
    "laws",
    "locomotion",
    "parameters",
    "randomize",
    "sound_head",
    "sound_root",
}
#: Checks of lists of numbers by their length.
_LISTS: dict[int, Check] = {2: two_numbers, 3: point}


@functools.cache
def settings() -> dict[str, list[dict[str, Any]]]:
    """The fields of settings by the engine's name of their type."""
    found = _native.settings()
    return found


@functools.cache
def setting_checks(kind: str) -> dict[str, Check]:
    """A check for each field of a type of settings that has one; others are the engine's."""
    return checks([row for row in settings()[kind] if row["name"] not in _WITHOUT_CHECK])


def checks(rows: Sequence[Mapping[str, Any]]) -> dict[str, Check]:
    """A check for each field, by its name."""
    return {row["name"]: check_of(row["schema"]) for row in rows}


def check_of(schema: Mapping[str, Any]) -> Check:
    """The check of a value's type, and of the range of whole numbers; others are the engine's.

    Raises:
        LookupError: There is none for such a schema.
    """
    allowed = words(schema)
    if allowed:
        return functools.partial(_word, allowed)
    kinds = _kinds(schema)
    for kind in ("object", "array", "number", "integer", "boolean", "string"):
        if kind in kinds and kinds.keys() <= {kind, "null"}:
            return _check_of_kind(kind, kinds[kind])
    if kinds.keys() <= {"string", "integer", "null"}:
        number = _check_of_kind("integer", kinds["integer"])
        return functools.partial(_name_or_number, number)
    if kinds.keys() <= {"string", "object", "null"}:
        return _text_or_mapping
    raise LookupError(f"no check for {schema}")


def _kinds(schema: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """The schemas of which a value may be, by their types."""
    several = schema.get("anyOf") or schema.get("oneOf")
    if several:
        return {kind: part for one in several for kind, part in _kinds(one).items()}
    kind = schema.get("type", "string")
    return {each: schema for each in ([kind] if isinstance(kind, str) else kind)}


def _check_of_kind(kind: str, schema: Mapping[str, Any]) -> Check:
    if kind == "integer":
        bounds = _BOUNDS[schema["format"]]
        told = zip(("minimum", "maximum"), bounds, strict=True)
        low, high = (int(schema.get(name, bound)) for name, bound in told)
        return lambda name, value: integer_in_range(name, value, low=low, high=high)
    if kind == "array":
        return _LISTS.get(schema.get("minItems", 0), _as_is)
    if kind == "object" and schema.get("properties"):
        parts = {name: check_of(part) for name, part in schema["properties"].items()}
        return lambda name, value: checked_fields(name, value, parts)
    return {"number": finite_number, "boolean": boolean, "string": text, "object": mapping}[kind]


def words(schema: Mapping[str, Any]) -> list[str]:
    """The words of which a value is one; none where it may be anything else."""
    several = schema.get("anyOf") or schema.get("oneOf")
    if several:
        parts = [words(one) for one in several if one.get("type") != "null"]
        return [word for part in parts for word in part] if all(parts) else []
    return [schema["const"]] if "const" in schema else [*schema.get("enum", [])]


def _word(allowed: Sequence[str], name: str, value: object) -> str:
    """One of several words."""
    if not isinstance(value, str) or value not in allowed:
        raise ConfigError(
            f"{name} is {quoted(value)}; allowed are {', '.join(map(quoted, allowed))}"
        )
    return text(name, value)


def _as_is(_name: str, value: object) -> object:
    return value


def _text_or_mapping(name: str, value: object) -> str | dict[str, Any]:
    if isinstance(value, str):
        return text(name, value)
    found: dict[str, Any] = plain_settings(mapping(name, value, "text or a mapping"), name)
    return found


def _name_or_number(number: Check, name: str, value: object) -> Any:  # noqa: ANN401 - either
    if isinstance(value, str):
        return text(name, value)
    try:
        return number(name, value)
    except ConfigError as error:
        raise ConfigError(f"{error}, and names") from None
