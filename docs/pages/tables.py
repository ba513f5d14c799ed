"""Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; bars in cells are escaped."""
    lines = [head, ["---"] * len(head), *rows]
    cells = [[str(cell).replace("|", r"\|").replace("\n", " ") for cell in row] for row in lines]
    return "\n".join(f"| {' | '.join(row)} |" for row in cells) + "\n"


def code(text: object) -> str:
    """Text as code."""
    return f"`{text}`"


def number(value: float) -> str:
    """A bound, written as short as it can be."""
    if value in (float("inf"), float("-inf")) or abs(value) >= 3.4e38:
        return "any" if value > 0 else "-any"
    return f"{value:,.0f}" if value == int(value) else f"{value:.6g}"
