"""Types of fields in words, from their JSON schemas."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_WORDS = {
    "boolean": "bool",
    "integer": "whole number",
    "number": "number",
    "object": "mapping",
    "string": "text",
}


def schema_words(schema: Mapping[str, Any]) -> str:
    """A schema in words: ``number, or none``.

    Raises:
        LookupError: Nobody has said yet how to call the type.
    """
    words = list(dict.fromkeys(_each(schema)))
    if "none" not in words:
        return " or ".join(words)
    return f"{' or '.join(word for word in words if word != 'none')}, or none"


def _each(schema: Mapping[str, Any]) -> list[str]:
    several = schema.get("anyOf") or schema.get("oneOf")
    if several:
        return [word for one in several for word in _each(one)]
    if "const" in schema:
        return [f"`{schema['const']}`"]
    if "enum" in schema:
        return [f"`{value}`" for value in schema["enum"]]
    kinds = schema.get("type")
    return [_word(kind, schema) for kind in ([kinds] if isinstance(kinds, str) else kinds or [])]


def _word(kind: str, schema: Mapping[str, Any]) -> str:
    if kind == "null":
        return "none"
    if kind == "array":
        inner = schema_words(schema["items"])
        least = schema.get("minItems")
        fixed = least is not None and least == schema.get("maxItems")
        return f"{least} {inner}s" if fixed else f"list of {inner}"
    if kind not in _WORDS:
        raise LookupError(f"docs/pages/schema_words.py: no word for {schema}")
    return _WORDS[kind]
