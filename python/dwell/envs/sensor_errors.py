"""Which of an environment's sensors is refused, by its name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gymnasium import spaces

from dwell import ConfigError, DwellError, _native
from dwell.arguments import from_json, to_json
from dwell.house import House

#: How the engine begins what it says of a sensor's settings.
_OF_SETTINGS = "sensor settings: "


def with_sensor(error: ConfigError, house: House, config: str) -> ConfigError:
    """What an environment was refused for, with the sensor where it is one's.

    The engine tells a setting alone. So each sensor is asked for without the others, if without any
    there is nothing to say.
    """
    settings = from_json("config", config)
    if not isinstance(settings, Mapping):
        return error
    said = str(error)
    places = _places(settings)
    if not places or _refused(house, settings, None) == said:
        return error
    for at, place in places:
        if _refused(house, settings, place) == said:
            is_told = f'"{at.rpartition(".")[2]}"' in said
            return error if is_told else ConfigError(f"{at}: {said.removeprefix(_OF_SETTINGS)}")
    return error


def refuse_blind(space: spaces.Dict) -> None:
    """Refuses an environment that observes nothing, which Gymnasium has none of.

    Raises:
        ConfigError: The space is empty.
    """
    if not space.spaces:
        raise ConfigError("sensors is empty; expected at least one sensor, as ['gps']")


_Place = tuple[int | None, int]


def _places(settings: Mapping[str, Any]) -> list[tuple[str, _Place]]:
    """What each sensor is called, and where it stands: whose, and which of theirs."""
    found = []
    agents = settings.get("agents")
    agents = agents if isinstance(agents, list) else []
    owners: list[tuple[str, int | None, object]] = [("", None, settings)]
    owners += [(f"agents[{k}].", k, row) for k, row in enumerate(agents)]
    for whose, agent, owner in owners:
        for k, row in enumerate(_rows(owner)):
            # Those of a replay's file are as somebody wrote them.
            about = row if isinstance(row, Mapping) else {}
            own = about.get("settings")
            name = own.get("name") if isinstance(own, Mapping) else None
            found.append((f"{whose}sensors.{name or about.get('kind')}", (agent, k)))
    return found


def _rows(owner: object) -> list[Any]:
    rows = owner.get("sensors") if isinstance(owner, Mapping) else None
    return rows if isinstance(rows, list) else []


def _refused(house: House, settings: Mapping[str, Any], place: _Place | None) -> str | None:
    """What is refused with the sensor at a place alone, or with none."""
    agent, number = (None, -1) if place is None else place

    def sensors(owner: object, whose: int | None) -> list[Any]:
        return [_rows(owner)[number]] if place is not None and whose == agent else []

    own = {**settings, "sensors": sensors(settings, None)}
    if isinstance(settings.get("agents"), list):
        own["agents"] = [
            {**row, "sensors": sensors(row, k)} if _rows(row) else row
            for k, row in enumerate(settings["agents"])
        ]
    try:
        _native.Batch([house.native], to_json(own), 1)
    except DwellError as error:
        return str(error)
    return None
