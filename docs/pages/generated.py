"""What is written from the engine's tables and kept in the repository: types of Python, tables.

`python docs/write_generated.py` writes it anew; `make check` and the tests refuse what is stale.
"""

from __future__ import annotations

import json
import re

from dwell import _native
from pages.observations import observation_table, specifications
from pages.sources import text
from pages.tables import code, table

#: A part of a page, by its name, between two comments.
_PART = re.compile(r"(<!-- generated: (.+?) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
_PAGES = ("docs/cameras.md", "docs/environments-at-a-glance.md")
_TYPES = "python/dwell/engine_types.py"


def files() -> dict[str, str]:
    """Path and content of every file, as they should be."""
    parts = {"sensors": _sensors(), "sensors of pictures": _sensors_of_pictures()}
    pages = {
        path: _PART.sub(lambda part: f"{part[1]}\n{parts[part[2]]}\n{part[4]}", text(path))
        for path in _PAGES
    }
    return {_TYPES: _types(), **pages}


def stale() -> list[str]:
    """The files that are not as they should be."""
    return [path for path, content in files().items() if text(path) != content]


def _styles() -> dict[str, str | None]:
    """The names of all sensors, and how people are shown what they give."""
    return {row["name"]: row["picture_style"] for row in json.loads(_native.sensors_json())}


def _sensors() -> str:
    styles = _styles()
    groups = {
        "images": [name for name, style in styles.items() if style not in (None, "list")],
        "things in view": [name for name, style in styles.items() if style == "list"],
        "sound, words, movement": [name for name, style in styles.items() if style is None],
    }
    rows = [(group, ", ".join(map(code, names))) for group, names in groups.items()]
    return table(("what", "names"), rows)


def _sensors_of_pictures() -> str:
    names = [name for name, style in _styles().items() if style is not None]
    return observation_table(specifications(names))


def _types() -> str:
    return f'''"""Types that the engine's tables say; written by docs/write_generated.py."""

from __future__ import annotations

from typing import Literal

{_literal("Channel", [name for name, style in _styles().items() if style is not None])}'''


def _literal(name: str, values: list[str]) -> str:
    rows = "".join(f'    "{value}",\n' for value in values)
    return f"{name} = Literal[\n{rows}]\n"
