"""Episodes that state where they start and what they ask for, and the ids that say so.

The id of such an episode is that of its house and seed, followed by what it states: it can be
played again by its id alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dwell import ConfigError
from dwell.arguments import checked_fields, from_json, plain_settings, quoted, to_json
from dwell.schemas import setting_checks

#: The parts of an episode that can be stated, by the engine's name of their type.
KINDS = {"start": "StatedStart", "goal": "StatedGoal"}


def checked_part(name: str, value: object) -> dict[str, Any]:
    """A start or a goal that is stated; ``name`` ends in which of both it is.

    Raises:
        ConfigError: A field is unknown or of another type; places and ranges are the engine's.
    """
    checks = setting_checks(KINDS[name.rpartition(".")[2]])
    found: dict[str, Any] = plain_settings(checked_fields(name, value, checks), name)
    return found


def checked_episode(name: str, value: object) -> dict[str, Any] | None:
    """What an episode states: ``start`` and ``goal``, or one of them; ``None`` for nothing.

    Raises:
        ConfigError: As of :func:`checked_part`.
    """
    return checked_fields(name, value, dict.fromkeys(KINDS, checked_part)) or None


def id_with_stated(episode_id: str, stated: Mapping[str, Any] | None) -> str:
    """The id of an episode that states something, from that of its house and seed."""
    if stated is None:
        return episode_id
    # The last number sign is the one before what is stated.
    written = to_json(stated).replace("#", "\\u0023")
    return f"{episode_id}#{written}"


def id_and_stated(episode_id: object) -> tuple[object, dict[str, Any] | None]:
    """The id of house and seed, and what the episode states.

    Raises:
        ConfigError: What it states cannot be read.
    """
    if not isinstance(episode_id, str) or not episode_id.endswith("}"):
        return episode_id, None
    plain, _, written = episode_id.rpartition("#")
    if not written.startswith("{"):
        return episode_id, None
    try:
        return plain, checked_episode("episode", from_json("episode", written))
    except ConfigError as error:
        raise ConfigError(f"episode_id is {quoted(episode_id)}: {error}") from None


def seed_of(episode_id: str) -> int:
    """The seed of an episode, by its id."""
    plain, _ = id_and_stated(episode_id)
    return int(str(plain).rpartition("#")[2])
