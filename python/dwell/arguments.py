"""Arguments are checked where they enter, and refused with errors of dwell's own tree."""

from __future__ import annotations

import dataclasses
import difflib
import json
import math
import operator
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from dwell._native import ConfigError
from dwell.files import MOST_DIGITS, parse_json

#: What the border holds: seeds and counts are unsigned and have 64 bits.
_MOST = 2**64 - 1
#: The engines reckon in 32 bits: what is larger would be infinite there.
_LARGEST = float(np.finfo(np.float32).max)
#: How deep lists and mappings lie in each other at most, as the native side reads them.
_DEEPEST = 100
#: The first whole number that is not read back from JSON.
_TOO_LARGE = 10**MOST_DIGITS

_Record = TypeVar("_Record")


def quoted(value: object, most: int = 200) -> str:
    """``repr`` for error messages: never much text, and of everything.

    Whole numbers of thousands of digits, and lists in each other without end, have none.
    """
    try:
        row = repr(value)
    except (RecursionError, ValueError):
        return f"a {type(value).__name__} that cannot be written out"
    return row if len(row) <= most else f"{row[:most]}…"


def some(values: Sequence[object], most: int = 8) -> str:
    """The first of many for error messages, and how many there are."""
    if len(values) <= most:
        return quoted([*values])
    return f"[{', '.join(map(quoted, values[:most]))}, …] ({len(values)} in all)"


def whole(name: str, value: object, *, low: int = 0, high: int = _MOST) -> int:
    """A whole number within bounds; ``True``, 1.0 and ``"1"`` are none."""
    allowed = f"whole numbers from {low}" + (f" to {high}" if high != _MOST else "")
    try:
        number = operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {allowed}") from None
    if isinstance(value, bool) or not low <= number <= high:
        if number > _MOST:
            allowed = f"whole numbers from {low} to {high}"
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {allowed}")
    return number


def finite(name: str, value: object) -> float:
    """A finite number as Python's own float; ``True``, ``"1"`` and complex numbers are none."""
    try:
        # NumPy drops the imaginary part of what is complex.
        if isinstance(value, bool | str | bytes) or np.iscomplexobj(np.asarray(value)):
            raise TypeError
        number = float(value)  # type: ignore[arg-type] # what this finds out
    except (TypeError, ValueError, OverflowError):
        raise ConfigError(f"{name} is {quoted(value)}; expected a number") from None
    if not math.isfinite(number):
        raise ConfigError(f"{name} is {number}; allowed are finite numbers")
    if abs(number) > _LARGEST:
        raise ConfigError(
            f"{name} is {number}; allowed are numbers up to {_LARGEST:.3g} either way"
        )
    return number


def numbers(name: str, values: object, dtype: type[np.floating[Any]]) -> NDArray[Any]:
    """An array of real numbers, as C has them; NumPy alone would drop the imaginary part."""
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "fiu" and array.size > 0:
            raise TypeError
    except (TypeError, ValueError, RecursionError):
        raise ConfigError(f"{name}: expected real numbers, found {quoted(values)}") from None
    # What the type does not hold becomes infinite, and is refused by its place.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype)


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


def choice(name: str, value: object, allowed: Sequence[str]) -> str:
    """One of several words."""
    if value not in allowed:
        raise ConfigError(f"{name} is {quoted(value)}; allowed are {', '.join(allowed)}")
    return text(name, value)


def texts(name: str, values: object) -> list[str]:
    """A list of text; one text alone is none."""
    if isinstance(values, str | bytes | Mapping):
        raise ConfigError(f"{name} is {quoted(values)}; expected a list of text")
    try:
        rows = list(values)  # type: ignore[call-overload] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(values)}; expected a list of text") from None
    return [text(f"{name}[{k}]", row) for k, row in enumerate(rows)]


def path(name: str, value: object) -> str:
    """The path of a file or folder, as text."""
    try:
        return text(name, os.fspath(value))  # type: ignore[call-overload] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; expected text or a path") from None


def flag(name: str, value: object) -> bool:
    """``True`` or ``False``."""
    if not isinstance(value, bool | np.bool_):
        raise ConfigError(f"{name} is {quoted(value)}; allowed are True and False")
    return bool(value)


def mapping(name: str, value: object, of: str = "values by name") -> dict[str, Any]:
    """A mapping whose keys are text."""
    if not isinstance(value, Mapping):
        raise ConfigError(f"{name} is {quoted(value)}; expected {of}")
    return {text(f"a name in {name}", key): part for key, part in value.items()}


def fields(
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


def refuse_unknown(of: str, unknown: Iterable[str], known: Iterable[str]) -> None:
    """Refuses arguments that something does not have.

    Raises:
        ConfigError: There is one; the message has the nearest names.
    """
    for name in unknown:
        raise ConfigError(f"{of}: no argument {name!r}; {allowed_values(name, known)}")


def record(
    name: str, value: object, kind: type[_Record], words: Mapping[str, Sequence[str]]
) -> dict[str, Any]:
    """The fields of a data class, numbers or one of several ``words``."""
    if not isinstance(value, kind):
        raise ConfigError(f"{name} is {quoted(value)}; expected a dwell.{kind.__name__}")
    checked: dict[str, Any] = {}
    for field in dataclasses.fields(kind):  # type: ignore[arg-type] # every kind is a data class
        part, at = getattr(value, field.name), f"{name}.{field.name}"
        if field.default is None and part is None:
            checked[field.name] = None
        elif isinstance(field.default, int):
            checked[field.name] = whole(at, part)
        elif field.default is None or isinstance(field.default, float):
            checked[field.name] = finite(at, part)
        else:
            checked[field.name] = choice(at, part, words[field.name])
    return checked


def point(name: str, value: object) -> tuple[float, float, float]:
    """A point (x, y, z) in metres, from any sequence or array of three finite numbers."""
    try:
        if isinstance(value, str | bytes | Mapping):
            raise TypeError
        parts = list(value)  # type: ignore[call-overload] # what this finds out
    except TypeError:
        parts = []
    if len(parts) != 3:
        raise ConfigError(
            f"{name}: expected three numbers (x, y, z) in metres, found {quoted(value)}"
        )
    x, y, z = (finite(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return x, y, z


def triple(name: str, value: Sequence[float]) -> tuple[float, float, float]:
    """Three finite numbers, from any sequence or array."""
    try:
        parts = [] if isinstance(value, str | bytes | bytearray) else list(value)
    except TypeError:
        parts = []
    if len(parts) != 3:
        raise ConfigError(f"{name}: expected three numbers (x, y, z), found {quoted(value)}")
    x, y, z = (finite(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return x, y, z


def unit_quaternion(name: str, value: Sequence[float]) -> tuple[float, ...]:
    """A rotation (x, y, z, w), from four finite numbers that are not all 0, made of unit length."""
    try:
        parts = [finite(f"{name}[{k}]", part) for k, part in enumerate(value)]
    except TypeError:
        parts = []
    length = math.hypot(*parts)
    if len(parts) != 4 or length == 0.0 or not math.isfinite(length):
        raise ConfigError(f"{name}: expected a rotation (x, y, z, w), found {quoted(value)}")
    return tuple(part / length for part in parts)


def pair(name: str, value: object) -> tuple[float, float]:
    """Two finite numbers."""
    if isinstance(value, str | bytes) or not isinstance(value, Sequence) or len(value) != 2:
        raise ConfigError(f"{name}: expected two numbers, found {quoted(value)}")
    first, second = (finite(f"{name}[{k}]", part) for k, part in enumerate(value))
    return first, second


def file_name(name: str, value: object) -> str:
    """A name of a file or folder that leads nowhere else: letters, digits, ``_``, ``-``, ``.``."""
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}", value):
        raise ConfigError(
            f"{name} is {quoted(value)}; allowed are 1 to 100 letters, digits, _, - and ."
        )
    return value


def _plain(at: str, value: object, depth: int = 0) -> Any:  # noqa: ANN401 - any JSON value
    """``value`` as JSON knows it; ``at``: its place, for the error."""
    if depth > _DEEPEST:
        raise ConfigError(
            f"{at[:60]}… is nested too deep; allowed are {_DEEPEST} lists and mappings in "
            "each other"
        )
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        dot = f"{at}." if at else ""
        return {str(key): _plain(f"{dot}{key}", part, depth + 1) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(f"{at}[{k}]", part, depth + 1) for k, part in enumerate(value)]
    if isinstance(value, float):
        return finite(at, value)
    if isinstance(value, int) and abs(value) >= _TOO_LARGE:
        raise ConfigError(
            f"{at} is a whole number of more than {MOST_DIGITS} digits, which no float reaches"
        )
    if value is None or isinstance(value, str | int):
        return value
    raise ConfigError(f"{at} is {quoted(value)}; expected numbers, text, lists or mappings")


def plain(settings: Mapping[str, object] | Sequence[object]) -> Any:  # noqa: ANN401 - of the settings
    """Settings as the native side takes them: numbers, text, lists and mappings.

    Raises:
        ConfigError: They hold something else, or numbers that are not finite, told by its place.
    """
    return _plain("", settings)


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
