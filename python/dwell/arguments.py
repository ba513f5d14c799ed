"""Arguments are checked where they enter, and refused with errors of dwell's own tree."""

from __future__ import annotations

import json
import math
import operator
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dwell._native import ConfigError

#: What the border holds: seeds and counts are unsigned and have 64 bits.
_MOST = 2**64 - 1


def whole(name: str, value: object, *, low: int = 0, high: int = _MOST) -> int:
    """A whole number within bounds; ``True``, 1.0 and ``"1"`` are none."""
    allowed = f"whole numbers from {low}" + (f" to {high}" if high != _MOST else "")
    try:
        number = operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {value!r}; allowed are {allowed}") from None
    if isinstance(value, bool) or not low <= number <= high:
        raise ConfigError(f"{name} is {value!r}; allowed are {allowed}")
    return number


def finite(name: str, value: object) -> float:
    """A finite number as Python's own float."""
    try:
        number = float(value)  # type: ignore[arg-type] # what this finds out
    except (TypeError, ValueError):
        raise ConfigError(f"{name} is {value!r}; expected a number") from None
    if not math.isfinite(number):
        raise ConfigError(f"{name} is {number}; allowed are finite numbers")
    return number


def point(name: str, value: Sequence[float]) -> tuple[float, float, float]:
    """A point (x, y, z) in metres, from any sequence or array of three finite numbers."""
    try:
        parts = list(value)
    except TypeError:
        parts = []
    if len(parts) != 3:
        raise ConfigError(f"{name}: expected three numbers (x, y, z) in metres, found {value!r}")
    x, y, z = (finite(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return x, y, z


def triple(name: str, value: Sequence[float]) -> tuple[float, float, float]:
    """Three finite numbers, from any sequence or array."""
    try:
        parts = list(value)
    except TypeError:
        parts = []
    if len(parts) != 3:
        raise ConfigError(f"{name}: expected three numbers (x, y, z), found {value!r}")
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
        raise ConfigError(f"{name}: expected a rotation (x, y, z, w), found {value!r}")
    return tuple(part / length for part in parts)


def pair(name: str, value: object) -> tuple[float, float]:
    """Two finite numbers."""
    if isinstance(value, str | bytes) or not isinstance(value, Sequence) or len(value) != 2:
        raise ConfigError(f"{name}: expected two numbers, found {value!r}")
    first, second = (finite(f"{name}[{k}]", part) for k, part in enumerate(value))
    return first, second


def file_name(name: str, value: object) -> str:
    """A name of a file or folder that leads nowhere else: letters, digits, ``_``, ``-``, ``.``."""
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}", value):
        raise ConfigError(f"{name} is {value!r}; allowed are 1 to 100 letters, digits, _, - and .")
    return value


def bodies(agents: object) -> list[dict[str, Any]]:
    """A body for each agent, from a count or from mappings of what differs from the default."""
    if isinstance(agents, str | bytes) or not isinstance(agents, Sequence):
        return [{} for _ in range(whole("agents", agents, high=64))]
    for k, body in enumerate(agents):
        if not isinstance(body, Mapping):
            raise ConfigError(f"agents[{k}] is {body!r}; expected a mapping")
    return [dict(body) for body in agents]


def _plain(at: str, value: object) -> Any:  # noqa: ANN401 - any JSON value
    """``value`` as JSON knows it; ``at``: its place, for the error."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        dot = f"{at}." if at else ""
        return {str(key): _plain(f"{dot}{key}", part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(f"{at}[{k}]", part) for k, part in enumerate(value)]
    if isinstance(value, float):
        return finite(at, value)
    if value is None or isinstance(value, str | int):
        return value
    raise ConfigError(f"{at} is {value!r}; expected numbers, text, lists or mappings")


def to_json(settings: Mapping[str, object] | Sequence[object]) -> str:
    """Settings as JSON text for the native side; what JSON cannot hold is refused by its place."""
    return json.dumps(_plain("", settings))
