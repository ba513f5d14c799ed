"""The map: what a user's columns mean, as a JSON object whose every key is known."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dwell.arguments import finite_number
from dwell.files import read_json
from dwell.measured.draft import BundleDraft

Map = dict[str, Any]


@dataclass(frozen=True)
class Numbers:
    """The form of a list of numbers; ``count``: so many, or any number of them."""

    count: int | None = None


#: What a key may hold, for keys that may hold one of several kinds.
TEXT_OR_LIST: tuple[type, ...] = (str, list)
TEXT_OR_OBJECT: tuple[type, ...] = (str, dict)
#: The form of the name of a column, as messages say it.
COLUMN = "the name of a column (text)"
#: An object whose keys are names of the user.
NAMES: Map = {}

#: What is checked where it is used.
ANYTHING = None

#: Keys of every map, whatever it measures.
COMMON: Map = {
    "kind": "",
    "confirmed": True,
    "why": NAMES,
    "title": "",
    "licence": "",
    "notes": "",
    "g_m_s2": ANYTHING,
    "environment": {
        "temperature_c": ANYTHING,
        "temperature_sd_k": ANYTHING,
        "humidity_pct": ANYTHING,
        "pressure_pa": ANYTHING,
    },
}
#: Keys of every table of samples.
TABLE: Map = {
    "file": TEXT_OR_LIST,
    "part": "",
    "only": NAMES,
    "episode": TEXT_OR_LIST,
    "split_group": TEXT_OR_LIST,
    "conditions": TEXT_OR_LIST,
    "t_s": COLUMN,
    "t_zero": "",
    "seconds_per_unit": 1.0,
    "units": NAMES,
    "cleaning": {
        "unsorted": "",
        "duplicates": "",
        "repeated_frames": "",
        "gaps": "",
        "short_episodes": "",
    },
}

_KINDS: dict[type, tuple[tuple[type, ...], str]] = {
    bool: ((bool,), "true or false"),
    str: ((str,), "text"),
    float: ((int, float), "a number"),
    list: ((list,), "a list"),
    dict: ((dict,), "an object"),
}


@dataclass
class Job:
    """One import: the map, the files that were given, and the bundle in the making."""

    mapping: Map
    at: str
    files: Mapping[str, Path]
    draft: BundleDraft
    progress: Callable[[float, str], None]
    #: What was left out or looks odd, in sentences.
    notes: list[str] = field(default_factory=list)

    def part(self, key: str) -> tuple[Map, str]:
        """A part that the map must have, and how messages name it."""
        return require(self.mapping, key, self.at), f"{self.at}: {key}"


def read_map(path: Path, schemas: Mapping[str, Map]) -> Map:
    """The map, with every key known and its guesses confirmed.

    Raises:
        ValueError: It has a key that no map of its kind has, a value of another form, or says
            itself that nobody has looked at it.
    """
    mapping = read_json(path)
    if not isinstance(mapping, dict):
        raise ValueError(
            f"{path}: found {mapping!r:.60}; an object with the keys of a map is needed"
        )
    kind = mapping.get("kind")
    if not isinstance(kind, str) or kind not in schemas:
        raise ValueError(f"{path}: kind is {kind!r}; allowed is one of {sorted(schemas)}")
    check_keys(mapping, schemas[kind], str(path))
    refuse_unconfirmed(mapping, str(path))
    result: Map = mapping
    return result


def refuse_unconfirmed(mapping: Mapping[str, Any], at: str) -> None:
    """Refuses a map that says itself that nobody has looked at it."""
    if mapping.get("confirmed") is False:
        count = len(mapping.get("why") or {})
        guesses = f"its {count} guesses, each with its reason under 'why'," if count else "it,"
        raise ValueError(
            f'{at}: "confirmed" is false: read {guesses} correct what is wrong, and write '
            '"confirmed": true; until then nothing is imported'
        )


def check_keys(found: Map, schema: Map, at: str) -> None:
    """Refuses keys that the schema lacks, and values of another form."""
    for key, value in found.items():
        if key not in schema:
            raise ValueError(f"{at}: no key {key!r}; allowed are {list(schema)}")
        form = schema[key]
        if value is None or form is ANYTHING:
            continue
        if isinstance(form, Numbers):
            _check_numbers(f"{at}: {key}", value, form.count)
            continue
        if isinstance(form, tuple):
            kinds = form
            names = {str: "text", list: "a list", dict: "an object"}
            expected = " or ".join(names[kind] for kind in form)
        else:
            kinds, expected = _KINDS[type(form)]
            if isinstance(form, str):
                expected = form or expected
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            raise ValueError(f"{at}: {key} is {value!r:.60}; {expected} is needed")
        if isinstance(form, dict) and form:
            check_keys(value, form, f"{at}: {key}")


def _check_numbers(name: str, value: object, count: int | None) -> None:
    if not isinstance(value, list) or (count is not None and len(value) != count):
        many = "" if count is None else f"{count} "
        raise ValueError(f"{name} is {value!r:.60}; a list of {many}numbers is needed")
    for k, number in enumerate(value):
        finite_number(f"{name}[{k}]", number)


def require(part: Mapping[str, Any], key: str, at: str) -> Any:  # noqa: ANN401 - any JSON value
    """A key that must be there."""
    if part.get(key) is None:
        raise ValueError(f"{at}: {key!r} is missing")
    return part[key]


def require_filled(part: Mapping[str, Any], keys: Sequence[str], at: str) -> None:
    """Refuses a part of which something was not filled in."""
    for key in keys:
        require(part, key, at)


def choice(part: Mapping[str, Any], key: str, allowed: tuple[str, ...], at: str) -> str | None:
    """One of several words; ``None`` where the map does not say."""
    value: str | None = part.get(key)
    if value is not None and value not in allowed:
        raise ValueError(f"{at}: {key} is {value!r}; allowed is one of {list(allowed)}")
    return value


def filled(part: Mapping[str, Any]) -> Map:
    """A part without the keys that say nothing."""
    return {key: value for key, value in part.items() if value is not None}


def columns_of(part: Mapping[str, Any], key: str, count: int, at: str) -> list[str]:
    """The names of several columns."""
    found = require(part, key, at)
    if not isinstance(found, list) or len(found) != count:
        raise ValueError(f"{at}: {key} is {found!r}; {count} names of columns are needed")
    return [str(name) for name in found]


def column_list(part: Mapping[str, Any], key: str, at: str) -> list[str]:
    """One column or several whose texts are joined; empty where the map does not say."""
    found = part.get(key)
    if found is None:
        return []
    if isinstance(found, str):
        return [found]
    if not found or not all(isinstance(name, str) for name in found):
        raise ValueError(f"{at}: {key} is {found!r}; names of columns are needed")
    return list(found)


def scale(part: Mapping[str, Any], key: str, at: str) -> float:
    """The SI value of one unit of a column; 1 where the map does not say."""
    value = part.get(key)
    found = 1.0 if value is None else finite_number(f"{at}: {key}", value)
    if found == 0:
        raise ValueError(f"{at}: {key} is {value!r}; a finite number other than 0 is needed")
    if key == "seconds_per_unit" and found < 0:
        raise ValueError(f"{at}: {key} is {value!r}; a finite number above 0 is needed")
    return found


def point(value: object, at: str) -> list[float]:
    """Three coordinates."""
    if isinstance(value, list) and len(value) == 3:
        numbers = [float(v) for v in value if isinstance(v, int | float) and v is not True]
        if len(numbers) == 3 and all(map(math.isfinite, numbers)):
            return numbers
    raise ValueError(f"{at} is {value!r:.60}; three numbers are needed")
