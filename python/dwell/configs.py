"""Settings by name, and their checks.

The engine has the last word on ranges; here wrong types are refused by the setting's name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args

from dwell._native import ConfigError
from dwell.arguments import (
    checked_fields,
    finite_number,
    integer_in_range,
    mapping,
    quoted,
    sequence_items,
)
from dwell.engine_types import LocomotionName
from dwell.schemas import setting_checks

#: How an agent may get about.
LOCOMOTIONS: tuple[str, ...] = get_args(LocomotionName)


def _locomotion(name: str, value: object) -> object:
    if isinstance(value, str):
        # With its usual numbers.
        value = {value: {}}
    kinds = mapping(name, value, "the name of a locomotion, or its numbers by that name")
    if len(kinds) != 1 or not set(kinds) <= set(LOCOMOTIONS):
        found = " and ".join(map(repr, kinds)) or "none"
        raise ConfigError(f"{name}: found {found:.200}; allowed is one of {', '.join(LOCOMOTIONS)}")
    return {
        kind: {
            field: finite_number(f"{name}.{kind}.{field}", number)
            for field, number in mapping(f"{name}.{kind}", numbers).items()
        }
        for kind, numbers in kinds.items()
    }


def _colors(name: str, value: object) -> object:
    rows = {}
    for part, color in mapping(name, value, "sRGB by what it is the colour of").items():
        channels = sequence_items(f"{name}.{part}", color, "expected three numbers of 0 to 255")
        if len(channels) != 3:
            raise ConfigError(
                f"{name}.{part} is {quoted(color)}; expected three numbers of 0 to 255"
            )
        rows[part] = [
            integer_in_range(f"{name}.{part}[{k}]", channel, high=255)
            for k, channel in enumerate(channels)
        ]
    return rows


def bodies(agents: object, places: Sequence[str] | None = None) -> list[dict[str, Any]]:
    """A body for each agent, from a count or from mappings of what differs from the default.

    ``places``: where each stands, for messages.
    """
    if isinstance(agents, str | bytes) or not isinstance(agents, Sequence):
        try:
            return [{} for _ in range(integer_in_range("agents", agents, high=64))]
        except ConfigError as error:
            raise ConfigError(f"{error}, and lists of a mapping for each body") from None
    known = {**setting_checks("AgentBody"), "locomotion": _locomotion, "colors": _colors}
    rows = []
    for k, body in enumerate(agents):
        at = f"agents[{k}]" if places is None else places[k]
        if not isinstance(body, Mapping):
            like = ", such as {'kind': 'person'}" if isinstance(body, str) else ""
            raise ConfigError(f"{at} is {quoted(body)}; expected a mapping{like}")
        rows.append(checked_fields(at, body, known))
    return rows


def checked(kind: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Settings whose types are those of the engine's ``kind``; names that it lacks are left to it.

    Raises:
        ConfigError: A value is of another type; the message has the name, the value, and what is
            allowed.
    """
    known = setting_checks(kind)
    return {
        name: known[name](name, value) if name in known else value
        for name, value in settings.items()
    }
