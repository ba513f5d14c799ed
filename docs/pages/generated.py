"""What is written from the engine's tables and kept in the repository: types of Python, tables.

`python docs/write_generated.py` writes it anew; `make check` and the tests refuse what is stale.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

from dwell import _native
from dwell.schemas import settings
from dwell.schemas import words as schema_words_of
from pages.observations import fields_table, observation_table, specifications
from pages.sources import documents, text
from pages.tables import code, table

#: A part of a page, by its name, between two comments.
_PART = re.compile(r"(<!-- generated: (.+?) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
_PAGES = ("docs/cameras.md", "docs/environments-at-a-glance.md")
_TYPES = "python/dwell/engine_types.py"

#: Typed dictionaries, the engine's types whose fields they have, and their texts.
_TYPED_DICTS = (
    ("WorldSettings", "WorldConfig", "What :class:`dwell.World` may be told besides."),
    ("BodySettings", "AgentBody", "In what an agent's body differs from the default."),
    ("AirSettings", "Air", "The air of an :class:`dwell.AcousticScene`."),
    ("AcousticSettings", "AcousticConfig", "What :class:`dwell.AcousticScene` may be told."),
    ("GeneratorSettings", "HouseSpec", "What :meth:`dwell.House.generate` may be told."),
)
#: What the package has as arguments of their own.
_OWN = {"WorldSettings": ("agents", "laws", "parameters", "randomize")}
#: What the package takes in other forms than the engine.
_ANNOTATIONS = {
    ("WorldSettings", "sound_head"): "Head | str | os.PathLike[str] | None",
    ("WorldSettings", "sound_root"): "str | os.PathLike[str] | None",
    ("BodySettings", "locomotion"): "Locomotion",
    ("BodySettings", "colors"): "Mapping[str, Sequence[int]]",
    ("AcousticSettings", "air"): "AirSettings",
    ("GeneratorSettings", "rooms"): "Sequence[str]",
    ("GeneratorSettings", "adjacency"): "Sequence[tuple[str, str]]",
}
_PYTHON = {"boolean": "bool", "integer": "int", "number": "float", "string": "str"}


def files() -> dict[str, str]:
    """Path and content of every file, as they should be."""
    parts = {
        "environments": _environments(),
        "sensors": _sensors(),
        "sensors of pictures": _sensors_of_pictures(),
        **{f"task {task['name']}": _task(task) for task in _native.tasks()},
    }
    pages = {
        path: _PART.sub(lambda part: f"{part[1]}\n{parts[part[2]]}\n{part[4]}", text(path))
        for path in (*_PAGES, *(f"docs/{page}" for page in documents("docs/tasks")))
    }
    return {_TYPES: _types(), **pages}


def stale() -> list[str]:
    """The files that are not as they should be."""
    return [path for path, content in files().items() if text(path) != content]


def _environments() -> str:
    makers = {True: code("dwell.pettingzoo"), False: code("gymnasium.make")}
    rows = [
        (
            code(task["id"]),
            task["about"],
            _names(task["sensors"]),
            makers[task["min_agents"] > 1],
        )
        for task in _native.tasks()
    ]
    return table(("id", "what is asked", "sensors without `sensors=`", "made by"), rows)


def _task(task: Mapping[str, Any]) -> str:
    env_id = task["id"]
    return f"""`{env_id}`. Sensors without `sensors=`: {_names(task["sensors"])}. `task_settings`:

{fields_table(task["settings"])}"""


def _names(names: Iterable[str]) -> str:
    return ", ".join(map(code, names))


def _styles() -> dict[str, str | None]:
    """The names of all sensors, and how people are shown what they give."""
    return {row["name"]: row["picture_style"] for row in _native.sensors()}


def _sensors() -> str:
    styles = _styles()
    groups = {
        "images": [name for name, style in styles.items() if style not in (None, "list")],
        "things in view": [name for name, style in styles.items() if style == "list"],
        "sound, words, goals, movement": [name for name, style in styles.items() if style is None],
    }
    return table(("what", "names"), [(group, _names(names)) for group, names in groups.items()])


def _sensors_of_pictures() -> str:
    names = [name for name, style in _styles().items() if style is not None]
    return observation_table(specifications(names))


_HEAD = '''"""Types that the engine's tables say; written by docs/write_generated.py."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    from dwell.heads import Head
'''


def _types() -> str:
    channels = [name for name, style in _styles().items() if style is not None]
    (locomotion,) = (row for row in settings()["AgentBody"] if row["name"] == "locomotion")
    kinds = [kind["required"][0] for kind in locomotion["schema"]["oneOf"]]
    aliases = [
        _literal("Channel", channels),
        _literal("LocomotionName", kinds),
        "Locomotion = str | Mapping[str, Mapping[str, float]]\n",
    ]
    dicts = [_typed_dict(*row) for row in _TYPED_DICTS]
    return "\n".join([_HEAD, *aliases]) + "".join(f"\n\n{one}" for one in dicts)


def _literal(name: str, values: list[str]) -> str:
    rows = "".join(f'    "{value}",\n' for value in values)
    return f"{name} = Literal[\n{rows}]"


def _typed_dict(name: str, kind: str, about: str) -> str:
    rows = [row for row in settings()[kind] if row["name"] not in _OWN.get(name, ())]
    lines = [f"class {name}(TypedDict, total=False):", f'    """{about}"""', ""]
    for row in rows:
        lines += [f"    #: {line}" for line in textwrap.wrap(row["about"], 92)]
        annotation = _ANNOTATIONS.get((name, row["name"])) or _annotation(row["schema"])
        lines.append(f"    {row['name']}: {annotation}")
    return "\n".join([*lines, ""])


def _annotation(schema: dict[str, Any]) -> str:
    """The type of Python that a value has, as arguments are given."""
    words = schema_words_of(schema)
    if words:
        return f"Literal[{', '.join(json.dumps(word) for word in words)}]"
    kinds = schema["type"]
    kind = kinds if isinstance(kinds, str) else next(one for one in kinds if one != "null")
    return _PYTHON[kind]
