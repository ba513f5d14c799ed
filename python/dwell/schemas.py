"""Checks of values by the schemas that the engine makes of its own types."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dwell.arguments import finite, flag, mapping, pair, point, text, whole

Check = Callable[[str, object], Any]

#: Bounds of whole numbers by their format.
_BOUNDS = {
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "uint": (0, 2**64 - 1),
    "uint64": (0, 2**64 - 1),
}
#: Checks of lists of numbers by their length.
_LISTS: dict[int, Check] = {2: pair, 3: point}


def checks(fields: Sequence[Mapping[str, Any]]) -> dict[str, Check]:
    """A check for each field, by its name."""
    return {field["name"]: check_of(field["schema"]) for field in fields}


def check_of(schema: Mapping[str, Any]) -> Check:
    """The check of a value's type. Ranges are the engine's.

    Raises:
        LookupError: There is none for such a schema.
    """
    kinds = _kinds(schema)
    for kind in ("object", "array", "number", "integer", "boolean", "string"):
        if kind in kinds and kinds.keys() <= {kind, "null"}:
            return _check_of_kind(kind, kinds[kind])
    if kinds.keys() <= {"string", "integer", "null"}:
        number = _check_of_kind("integer", kinds["integer"])
        return lambda name, value: value if isinstance(value, str) else number(name, value)
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
        low, high = _BOUNDS[schema["format"]]
        return lambda name, value: whole(name, value, low=low, high=high)
    if kind == "array":
        return _LISTS[schema["minItems"]]
    return {"number": finite, "boolean": flag, "string": text, "object": mapping}[kind]


def _text_or_mapping(name: str, value: object) -> str | dict[str, Any]:
    return value if isinstance(value, str) else mapping(name, value, "text or a mapping")
