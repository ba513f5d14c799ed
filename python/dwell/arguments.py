"""Arguments are checked where they enter, and refused with errors of dwell's own tree."""

from __future__ import annotations

import dataclasses
import difflib
import itertools
import json
import math
import operator
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, ValuesView
from collections.abc import Set as AbstractSet
from pathlib import PurePath
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from dwell._native import ConfigError
from dwell.files import MAX_DIGITS, open_file, parse_json

#: What the border holds: seeds and counts are unsigned and have 64 bits.
_MAX_UINT64 = 2**64 - 1
#: The engines reckon in 32 bits: what is larger would be infinite there.
MAX_FLOAT32 = float(np.finfo(np.float32).max)
#: How deep lists and mappings lie in each other at most, as the native side reads them.
_MAX_DEPTH = 100
#: More than anybody lists; what never ends is told by it.
_MOST_LISTED = 1_000_000
#: The first whole number that is not read back from JSON.
_FIRST_UNREADABLE_INTEGER = 10**MAX_DIGITS

_Record = TypeVar("_Record")
_Kind = TypeVar("_Kind")


def quoted(value: object, most: int = 200) -> str:
    """``repr`` for error messages: never much text, and of everything.

    Whole numbers of thousands of digits, and lists in each other without end, have none.
    """
    try:
        row = repr(value)
    except (RecursionError, ValueError):
        return f"a {type(value).__name__} that cannot be written out"
    return row if len(row) <= most else f"{row[:most]}…"


def abbreviated_list(values: Sequence[object], most: int = 8) -> str:
    """The first of many for error messages, and how many there are."""
    if len(values) <= most:
        return quoted([*values])
    return f"[{', '.join(map(quoted, values[:most]))}, …] ({len(values)} in all)"


def integer_in_range(name: str, value: object, *, low: int = 0, high: int = _MAX_UINT64) -> int:
    """A whole number within bounds; ``True``, 1.0 and ``"1"`` are none."""
    allowed = f"whole numbers from {low}" + (f" to {high}" if high != _MAX_UINT64 else "")
    try:
        number = operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {allowed}") from None
    if isinstance(value, bool) or not low <= number <= high:
        if number > _MAX_UINT64:
            allowed = f"whole numbers from {low} to {high}"
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {allowed}")
    return number


def finite_number(name: str, value: object) -> float:
    """A finite number as Python's own float; ``True``, ``"1"`` and complex numbers are none."""
    try:
        # NumPy drops the imaginary part of what is complex, and reads text. Nothing else is made an
        # array: a range may have any length.
        is_other = hasattr(value, "__array__") and np.asarray(value).dtype.kind in "cSU"
        # Python reads what has neither as text, if it is bytes of any kind.
        is_number = hasattr(value, "__float__") or hasattr(value, "__index__")
        if isinstance(value, bool) or is_other or not is_number:
            raise TypeError
        number = float(value)  # type: ignore[arg-type] # what this finds out
    except (TypeError, ValueError, OverflowError):
        raise ConfigError(f"{name} is {quoted(value)}; expected a number") from None
    if not math.isfinite(number):
        raise ConfigError(f"{name} is {number}; allowed are finite numbers")
    if abs(number) > MAX_FLOAT32:
        raise ConfigError(
            f"{name} is {number}; allowed are numbers up to {MAX_FLOAT32:.3g} either way"
        )
    return number


def refuse_masked(name: str, values: object) -> None:
    """Refuses an array that hides elements: NumPy would show what its mask hides."""
    if np.ma.is_masked(values):
        raise ConfigError(
            f"{name} has masked elements; give what stands for them, as its filled(0.0)"
        )


def number_in_range(name: str, value: object, low: float, high: float, unit: str = "") -> float:
    """A finite number within bounds."""
    number = finite_number(name, value)
    if not low <= number <= high:
        raise ConfigError(
            f"{name} is {number:g}; allowed are {low:g} to {high:g}{unit and ' '}{unit}"
        )
    return number


def above_zero(name: str, value: object) -> float:
    """A finite number above 0."""
    number = finite_number(name, value)
    if number <= 0.0:
        raise ConfigError(f"{name} is {number:g}; allowed are numbers above 0")
    return number


def part_of_parts(name: str, value: object) -> tuple[int, int]:
    """Which of how many parts, from 0: (K, N)."""
    expected = "two whole numbers, a part from 0 and how many parts there are"
    rows = sequence_items(name, value, f"expected {expected}")
    if len(rows) != 2:
        raise ConfigError(f"{name} is {quoted(value)}; expected {expected}")
    parts = integer_in_range(f"{name}[1]", rows[1], low=1)
    return integer_in_range(f"{name}[0]", rows[0], high=parts - 1), parts


def inner_path(name: str, value: object) -> str:
    """A path within a folder: neither absolute nor with ``..``, which would lead out of it."""
    found = file_path(name, value)
    if os.path.isabs(found) or ".." in PurePath(found).parts:
        raise ConfigError(f"{name} is {quoted(found, 80)}; allowed are paths within the folder")
    return found


def instance_of(name: str, value: object, kind: type[_Kind]) -> _Kind:
    """What is of a class of dwell."""
    if not isinstance(value, kind):
        raise ConfigError(f"{name} is {quoted(value)}; expected a dwell.{kind.__name__}")
    return value


def hashable(value: object) -> object:
    """What equal values have in common, and what has a hash."""
    if isinstance(value, Mapping):
        return frozenset((key, hashable(part)) for key, part in value.items())
    if isinstance(value, list | tuple | np.ndarray):
        return tuple(hashable(part) for part in value)
    return value


class _Endless(itertools.chain[Any]):
    """Too many elements, which those refuse who read them; a list would be written out first."""

    def __repr__(self) -> str:
        return "an iterator without an end in sight"


def kept(value: object) -> Any:  # noqa: ANN401 - of the same kind
    """A copy to keep: who gave lists, mappings or arrays may change them later.

    What can be gone through once becomes a list. Other values stay the same, and so does what is
    nested too deep, which those refuse that read it.
    """
    return _kept(value, 0, {})


def _kept(value: object, depth: int, made: dict[int, Any]) -> Any:  # noqa: ANN401 - of the same kind
    """A copy; ``made``: those that there are: a value may hold another, or itself, many times."""
    if depth > _MAX_DEPTH or id(value) in made:
        return made.get(id(value), value)
    if isinstance(value, dict):
        mapped = made[id(value)] = {}
        mapped.update((key, _kept(part, depth + 1, made)) for key, part in value.items())
        return mapped
    if type(value) is list:
        listed = made[id(value)] = []
        listed.extend(_kept(part, depth + 1, made) for part in value)
        return listed
    if type(value) is tuple:
        parts = made[id(value)] = tuple(_kept(part, depth + 1, made) for part in value)
        return parts
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, Iterator):
        rows = [*itertools.islice(value, _MOST_LISTED + 1)]
        return rows if len(rows) <= _MOST_LISTED else _Endless(rows, value)
    return value


def refuse_no_array(name: str, values: object) -> None:
    """Refuses what shall not become an array: what a mask hides a part of, and very long ranges.

    A range holds none of its numbers, so that it costs nothing; an array of them does.
    """
    refuse_masked(name, values)
    seen: set[int] = set()
    left = [values]
    while left:
        part = left.pop()
        if isinstance(part, range) and part[_MOST_LISTED:]:
            raise ConfigError(
                f"{name} has {part}; allowed are at most {_MOST_LISTED} numbers of a range"
            )
        # A list may hold itself.
        if isinstance(part, list | tuple) and id(part) not in seen:
            seen.add(id(part))
            left += [row for row in part if isinstance(row, list | tuple | range)]


def real_array(name: str, values: object, dtype: type[np.floating[Any]]) -> NDArray[Any]:
    """An array of real numbers, as C has them; NumPy alone would drop the imaginary part."""
    refuse_no_array(name, values)
    try:
        found = np.asarray(values)
        if found.dtype.kind not in "fiu" and found.size > 0:
            raise TypeError
    except (TypeError, ValueError, RecursionError):
        raise ConfigError(f"{name}: expected real numbers, found {quoted(values)}") from None
    # What the type does not hold becomes infinite, and is refused by its place.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(found, dtype)


def finite_row(name: str, row: NDArray[np.float64]) -> NDArray[np.float32]:
    """A row of finite numbers of 32 bits; the first that is none is told by its place."""
    if row.ndim != 1:
        raise ConfigError(f"{name}: expected one row of numbers, found the shape {row.shape}")
    wrong = np.flatnonzero(~(np.abs(row) <= MAX_FLOAT32))
    if wrong.size:
        finite_number(f"{name}[{wrong[0]}]", row[wrong[0]])
    return row.astype(np.float32)


def sequence_items(
    name: str, values: object, expected: str, *, most: int = _MOST_LISTED
) -> list[Any]:
    """The elements of a list, an array or what else has an order and is no text.

    A set has none: what came first would differ from one process to the next.

    Raises:
        ConfigError: It has none, or no elements, or more than ``most`` (some have no end); the
            message says what was ``expected``. Or a mask hides some of them.
    """
    refuse_masked(name, values)
    rows = _ordered(values, most)
    if rows is None:
        raise ConfigError(f"{name} is {_found(values)}; {expected}")
    if len(rows) > most:
        raise ConfigError(
            f"{name} is {quoted(values)}, which has more than {most} elements; {expected}"
        )
    return rows


def _ordered(values: object, most: int) -> list[Any] | None:
    """The elements, if there are any; at most one more than ``most`` are looked at."""
    if isinstance(values, AbstractSet | ValuesView | str | bytes | bytearray | Mapping):
        return None
    try:
        found = [*itertools.islice(values, most + 1)]  # type: ignore[call-overload] # this finds out
    except TypeError:
        return None
    return found


def _found(values: object) -> str:
    no_order = isinstance(values, AbstractSet | ValuesView)
    return f"{quoted(values)}{', which keeps no order' if no_order else ''}"


def text(name: str, value: object) -> str:
    """Text."""
    if not isinstance(value, str):
        raise ConfigError(f"{name} is {quoted(value)}; expected text")
    if not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError:
            raise ConfigError(
                f"{name} is {quoted(value)}; expected text that UTF-8 can hold"
            ) from None
    return value


def dwell_version(name: str, value: object) -> str:
    """A version of dwell, such as ``"0.2.0"``."""
    found = text(name, value)
    if not re.fullmatch(r"[0-9]+\.[0-9]+\.[0-9]+[0-9A-Za-z.+-]{0,40}", found):
        raise ConfigError(f"{name} is {quoted(found, 60)}; expected a version of dwell")
    return found


def choice(name: str, value: object, allowed: Sequence[str]) -> str:
    """One of several words."""
    # Before they are compared: an array compares each of its elements.
    if not isinstance(value, str) or value not in allowed:
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {', '.join(allowed)}")
    return value


def text_list(name: str, values: object, *, most: int = _MOST_LISTED) -> list[str]:
    """A list of text; one text alone is none."""
    rows = sequence_items(name, values, "expected a list of text", most=most)
    return [text(f"{name}[{k}]", row) for k, row in enumerate(rows)]


def file_path(name: str, value: object) -> str:
    """The path of a file or folder, as text that is not empty."""
    found = path(name, value)
    if not found:
        raise ConfigError(f"{name} is ''; expected the path of a file or folder")
    return found


def path(name: str, value: object) -> str:
    """The path of a file or folder, as text."""
    try:
        found = text(name, os.fspath(value))  # type: ignore[call-overload] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; expected text or a path") from None
    if "\0" in found:
        raise ConfigError(f"{name} is {quoted(found)}; a path holds no NUL")
    return found


def openable_file(name: str, value: object) -> str:
    """The path of a file that can be read, for those who open it later.

    Raises:
        ConfigError: It is no path.
        OSError: The system refuses to open it, or it is no regular file.
    """
    found = file_path(name, value)
    try:
        open_file(found).close()
    except ValueError as error:
        raise ConfigError(f"{name}: {error}") from None
    return found


def boolean(name: str, value: object) -> bool:
    """``True`` or ``False``."""
    if not isinstance(value, bool | np.bool_):
        raise ConfigError(f"{name} is {quoted(value)}; allowed are True and False")
    return bool(value)


def mapping(name: str, value: object, of: str = "values by name") -> dict[str, Any]:
    """A mapping whose keys are text."""
    if not isinstance(value, Mapping):
        raise ConfigError(f"{name} is {quoted(value)}; expected {of}")
    at = f"a name in {name}" if name else "a name"
    return {text(at, key): part for key, part in value.items()}


def reset_options(value: object, *allowed: str) -> dict[str, Any]:
    """The options of a ``reset``, none of which is unknown."""
    options = {} if value is None else mapping("options", value)
    if unknown := sorted({*options} - {*allowed}):
        known = f"{', '.join(allowed[:-1])} and {allowed[-1]}"
        raise ConfigError(f"options: no {quoted(unknown[0])}; allowed are {known}")
    return options


def checked_fields(
    name: str, value: object, known: Mapping[str, Callable[[str, object], Any]]
) -> dict[str, Any]:
    """A mapping of known fields, each checked by its own rule."""
    checked = {}
    for key, part in mapping(name, value).items():
        if key not in known:
            at = f"{name}: " if name else ""
            raise ConfigError(f"{at}no field {key!r}; {allowed_values(key, known)}")
        checked[key] = known[key](f"{name}.{key}" if name else key, part)
    return checked


def allowed_values(name: str, known: Iterable[str]) -> str:
    """The allowed values in place of ``name``: the nearest names first, then all."""
    names = [*known]
    if not names:
        return "there are none"
    near = difflib.get_close_matches(name, names, 3)
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    return f"{meant}allowed are {', '.join(names)}"


#: Arguments that are called otherwise elsewhere, and their names here, where these are known.
_CALLED_OTHERWISE = {"max_episode_steps": "max_cycles"}


def refuse_unknown(of: str, unknown: Iterable[str], known: Iterable[str]) -> None:
    """Refuses arguments that something does not have.

    Raises:
        ConfigError: There is one; the message has the nearest names.
    """
    known = [*known]
    for name in unknown:
        own = _CALLED_OTHERWISE.get(name)
        if own in known:
            raise ConfigError(f"{of}: no argument {quoted(name)}; here it is called {own}")
        raise ConfigError(f"{of}: no argument {quoted(name)}; {allowed_values(name, known)}")


def dataclass_from_mapping(
    name: str, value: object, kind: type[_Record], words: Mapping[str, Sequence[str]]
) -> dict[str, Any]:
    """The fields of a data class, numbers or one of several ``words``."""
    instance_of(name, value, kind)
    checked: dict[str, Any] = {}
    for field in dataclasses.fields(kind):  # type: ignore[arg-type] # every kind is a data class
        part, at = getattr(value, field.name), f"{name}.{field.name}"
        if field.default is None and part is None:
            checked[field.name] = None
        elif isinstance(field.default, int):
            checked[field.name] = integer_in_range(at, part)
        elif field.default is None or isinstance(field.default, float):
            checked[field.name] = finite_number(at, part)
        else:
            checked[field.name] = choice(at, part, words[field.name])
    return checked


def point(name: str, value: object) -> tuple[float, float, float]:
    """A point (x, y, z) in metres, from any sequence or array of three finite numbers."""
    return _three(name, value, "expected three numbers (x, y, z) in metres")


def three_numbers(name: str, value: Sequence[float]) -> tuple[float, float, float]:
    """Three finite numbers, from any sequence or array."""
    return _three(name, value, "expected three numbers (x, y, z)")


def _three(name: str, value: object, expected: str) -> tuple[float, float, float]:
    refuse_masked(name, value)
    parts = _ordered(value, 3)
    if parts is None or len(parts) != 3:
        raise ConfigError(f"{name}: {expected}, found {_found(value)}")
    x, y, z = (finite_number(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return x, y, z


def unit_quaternion(name: str, value: Sequence[float]) -> tuple[float, ...]:
    """A rotation (x, y, z, w), from four finite numbers that are not all 0, made of unit length."""
    expected = "expected a rotation (x, y, z, w)"
    refuse_masked(name, value)
    given = _ordered(value, 4) or ()
    parts = [finite_number(f"{name}[{k}]", part) for k, part in enumerate(given)]
    length = math.hypot(*parts)
    if len(parts) != 4 or length == 0.0 or not math.isfinite(length):
        raise ConfigError(f"{name}: {expected}, found {_found(value)}")
    return tuple(part / length for part in parts)


def two_numbers(name: str, value: object) -> tuple[float, float]:
    """Two finite numbers."""
    refuse_masked(name, value)
    parts = _ordered(value, 2)
    if parts is None or len(parts) != 2:
        raise ConfigError(f"{name}: expected two numbers, found {_found(value)}")
    first, second = (finite_number(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return first, second


def file_name(name: str, value: object) -> str:
    """A name of a file or folder that leads nowhere else: letters, digits, ``_``, ``-``, ``.``."""
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}", value):
        raise ConfigError(
            f"{name} is {quoted(value)}; allowed are 1 to 100 letters, digits, _, - and ."
        )
    return value


def function_or_none(name: str, value: object) -> Callable[..., Any] | None:
    """A function, or nothing.

    Raises:
        ConfigError: It is something else.
    """
    if value is not None and not callable(value):
        raise ConfigError(f"{name} is {quoted(value)}; expected a function or None")
    return value


def _plain(at: str, value: object, depth: int = 0) -> Any:  # noqa: ANN401 - any JSON value
    """``value`` as JSON knows it; ``at``: its place, for the error."""
    if depth > _MAX_DEPTH:
        raise ConfigError(
            f"{at[:60]}… is nested too deep; allowed are {_MAX_DEPTH} lists and mappings in "
            "each other"
        )
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ConfigError(f"{at} has masked elements; give what stands for them")
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        dot = f"{at}." if at else ""
        return {
            text(f"a name in {at or 'the settings'}", str(key)): _plain(
                f"{dot}{key}", part, depth + 1
            )
            for key, part in value.items()
        }
    if isinstance(value, list | tuple):
        return [_plain(f"{at}[{k}]", part, depth + 1) for k, part in enumerate(value)]
    if isinstance(value, float):
        return finite_number(at, value)
    if isinstance(value, int) and abs(value) >= _FIRST_UNREADABLE_INTEGER:
        raise ConfigError(
            f"{at} is a whole number of more than {MAX_DIGITS} digits, which no float reaches"
        )
    if isinstance(value, str):
        return text(at, value)
    if value is None or isinstance(value, int):
        return value
    raise ConfigError(f"{at} is {quoted(value)}; expected numbers, text, lists or mappings")


def plain_settings(settings: Mapping[str, Any] | Sequence[Any], at: str = "") -> Any:  # noqa: ANN401 - of the settings
    """Settings as the native side takes them: numbers, text, lists and mappings.

    Args:
        settings: The settings.
        at: What the places begin with.

    Raises:
        ConfigError: They hold something else, or numbers that are not finite, told by its place.
    """
    return _plain(at, settings)


def to_json(settings: Mapping[str, object] | Sequence[object], at: str = "") -> str:
    """Settings as JSON text for the native side; what JSON cannot hold is refused by its place.

    Args:
        settings: The settings.
        at: What the places begin with.
    """
    return json.dumps(_plain(at, settings))


def from_json(at: str, written: str | bytes) -> Any:  # noqa: ANN401 - any JSON value
    """The value of a JSON text; ``at``: its place, for the error.

    Raises:
        ConfigError: It is no JSON, or nested too deep.
    """
    raw = written.encode(errors="surrogatepass") if isinstance(written, str) else written
    try:
        return parse_json(raw, at)
    except ValueError as error:
        raise ConfigError(str(error)) from None
