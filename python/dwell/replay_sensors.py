"""The sensors of pictures in the settings of a replay: no bit of a world depends on them."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from typing import Any

from dwell import DwellError, _native
from dwell.arguments import text, to_json
from dwell.house import House


def without_pictures(config: dict[str, Any]) -> dict[str, Any]:
    """The settings without sensors of pictures: no bit of a world depends on them.

    What remains is heard or felt. Who plays an episode again looks at the world itself.

    Raises:
        ConfigError: The kind of a sensor is no text.
    """
    pictures = picture_kinds()

    def kept(row: object, at: str) -> object:
        if not isinstance(row, dict) or not isinstance(row.get("sensors"), list):
            return row
        sensors = enumerate(row["sensors"])
        return row | {"sensors": [own for k, own in sensors if not shown(own, f"{at}sensors[{k}]")]}

    def shown(row: object, at: str) -> bool:
        # The engine says which sensor, and not that it is the kind.
        return isinstance(row, dict) and text(f"{at}.kind", row.get("kind")) in pictures

    general = config.get("task", "InstructionFollowing")
    usual = {row["name"]: [{"kind": kind} for kind in row["sensors"]] for row in _native.tasks()}
    agents = config.get("agents")
    if isinstance(agents, list) and config.get("sensors") is None:
        # Whose sensors nobody chose has those of its task.
        agents = [
            {**row, "sensors": usual[row.get("task", general)]}
            if isinstance(row, dict)
            and row.get("sensors") is None
            and _is_name_in(usual, row.get("task", general))
            else row
            for row in agents
        ]
    elif config.get("sensors") is None and _is_name_in(usual, general):
        config = config | {"sensors": usual[general]}
    if isinstance(agents, list):
        config = config | {
            "agents": [kept(row, f"config: agents[{k}].") for k, row in enumerate(agents)]
        }
    result = kept(config, "config: ")
    return result if isinstance(result, dict) else config


def _is_name_in(known: Container[str], found: object) -> bool:
    """Returns whether a value of a file is one of these names; what is no name the engine tells."""
    return isinstance(found, str) and found in known


def picture_faults(config: Mapping[str, Any], house: House) -> Iterator[str]:
    """The sensors of pictures that no environment takes, a sentence each.

    Args:
        config: The settings of a replay that can be played without them.
        house: Its house.
    """
    kinds = picture_kinds()
    agents = config.get("agents") or []
    owners = [("", config), *((f"agents[{k}].", row) for k, row in enumerate(agents))]
    for whose, owner in owners:
        for k, row in enumerate(owner.get("sensors") or []):
            if row.get("kind") not in kinds:
                continue
            # By the renderer that every machine has.
            alone = {"task": "Free", "sensors": [row], "world": {"renderer": "cpu"}}
            try:
                _native.Batch([house.native], to_json(alone), 1)
            except DwellError as error:
                yield f"config: {whose}sensors[{k}]: {error}"


def picture_kinds() -> set[str]:
    """The kinds of sensors that are pictures, on which no bit of a world depends."""
    return {row["name"] for row in _native.sensors() if row["picture_style"] is not None}
