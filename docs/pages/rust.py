"""What the doc comments of the Rust sources say of an enum's variants or a struct's fields.

The engines read settings and actions as JSON with these very names, so their doc comments are the
only place where units and ranges are said.
"""

from __future__ import annotations

import dataclasses
import re

from pages.sources import text


@dataclasses.dataclass
class Item:
    """A variant or a field.

    Attributes:
        name: As JSON has it.
        about: Its doc comment on one line, links to other items as code.
        type: A field's Rust type.
        fields: A variant's fields.
    """

    name: str
    about: str
    type: str | None = None
    fields: list[Item] = dataclasses.field(default_factory=list)


def snake(name: str) -> str:
    """``MoveForward`` as ``move_forward``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def items(path: str, name: str) -> list[Item]:
    """The items of an enum or struct of a source file, in order.

    Raises:
        LookupError: It is not there, or an item of it has no doc comment.
    """
    body = re.search(rf"^(?:pub )?(?:enum|struct) {name} \{{\n(.*?)^\}}", text(path), re.M | re.S)
    if body is None:
        raise LookupError(f"{path}: no enum or struct {name}")
    found: list[Item] = []
    said: list[str] = []
    for line in body[1].splitlines():
        if (doc := re.match(r"\s*/// ?(.*)", line)) is not None:
            said.append(doc[1])
            continue
        item = re.match(r"( +)(?:pub )?(\w+)(?:: (.+))?(?:,| \{)$", line)
        if item is None:
            continue
        if not said:
            raise LookupError(f"{path}: {name}::{item[2]} has no doc comment")
        known = Item(snake(item[2]), _plain(" ".join(said)), item[3])
        (found if len(item[1]) == 4 else found[-1].fields).append(known)
        said = []
    return found


def module(path: str) -> str:
    """A source file's own doc comment, as Markdown."""
    lines = re.findall(r"^//! ?(.*)$", text(path), re.MULTILINE)
    return _plain("\n".join(lines))


def _plain(comment: str) -> str:
    """A doc comment without rustdoc's links: ``[`Preset`]`` and ``[`Preset`](...)`` as code."""
    return re.sub(r"\[(`[^`]+`)\](?:\([^)]*\))?", r"\1", comment)


#: Rust types of settings and actions for readers who know JSON; a new one needs its line.
_TYPES = {
    "bool": "bool",
    "String": "text",
    "f32": "number",
    "f64": "number",
    "u32": "whole number",
    "i32": "whole number",
    "AgentBody": "mapping",
    "BTreeMap<String, f64>": "numbers by text",
    "BackEnd": "text",
    "Grasp": "text or mapping",
    "HeadId": "head",
    "LawSpec": "mapping",
    "Locomotion": "mapping",
    "ObjectRef": "text or whole number",
    "PixelCamera": "mapping",
    "Projection": "mapping",
}

#: Where the texts come from that a field may have.
_ENUMS = {
    "InstructionKind": "semantics/src/instruct/task.rs",
    "StartChoice": "engine/world/src/tasks/free.rs",
}


def plain_type(rust: str) -> str:
    """A field's type in words.

    Raises:
        LookupError: Nobody has said yet what the type is in JSON.
    """
    if (inner := re.fullmatch(r"Option<(.+)>", rust)) is not None:
        return f"{plain_type(inner[1])}, or none"
    if (array := re.fullmatch(r"\[(\w+); (\d+)\]", rust)) is not None:
        return f"{array[2]} {plain_type(array[1])}s"
    if (several := re.fullmatch(r"Vec<(.+)>", rust)) is not None:
        return f"list of {plain_type(several[1])}"
    if rust in _ENUMS:
        return " or ".join(f"`{one.name}`" for one in items(_ENUMS[rust], rust))
    if rust not in _TYPES:
        raise LookupError(f"docs/pages/rust.py: no word for the type {rust}")
    return _TYPES[rust]
