"""What a Rust source file says of itself."""

from __future__ import annotations

import re

from pages.sources import text


def snake(name: str) -> str:
    """``MoveForward`` as ``move_forward``, ``EmbodiedQA`` as ``embodied_qa``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def module(path: str) -> str:
    """A source file's own doc comment, as Markdown, links to other items as code."""
    lines = re.findall(r"^//! ?(.*)$", text(path), re.MULTILINE)
    return re.sub(r"\[(`[^`]+`)\](?:\([^)]*\))?", r"\1", "\n".join(lines))
