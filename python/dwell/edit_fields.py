"""Fields of edits: places, traits, looks and colours, checked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, get_args

from dwell import ConfigError
from dwell.arguments import (
    boolean,
    choice,
    finite_number,
    integer_in_range,
    point,
    sequence_items,
    text,
)

Point = tuple[float, float, float]
Rgb = tuple[int, int, int]
Anchor = Literal["foot", "middle", "top", "origin"]
Mobility = Literal["fixed", "movable"]
Side = Literal["floor", "walls", "ceiling"]


def place_field(
    at: Point | None, on: str | None, yaw_deg: float | None, anchor: str
) -> dict[str, Any]:
    """A place: a point or the thing that it is on, a heading and an anchor."""
    return {
        "at": None if at is None else point("at", at),
        "on": optional_text("on", on),
        "yaw_deg": None if yaw_deg is None else finite_number("yaw_deg", yaw_deg),
        "anchor": choice("anchor", anchor, ("foot", "middle", "top", "origin")),
    }


def motion_fields(
    place: dict[str, Any], by: Point | None, turn_deg: float | None
) -> dict[str, Any]:
    """Where a thing that is there goes, and by how much it is shifted and turned then.

    Raises:
        ConfigError: Nothing of it is stated.
    """
    stated = (place["at"], place["on"], place["yaw_deg"], by, turn_deg)
    if all(value is None for value in stated):
        raise ConfigError("move: no at, on, yaw_deg, by or turn_deg; expected one of them")
    return {
        "place": place,
        "by": point("by", (0.0, 0.0, 0.0) if by is None else by),
        "turn_deg": finite_number("turn_deg", 0.0 if turn_deg is None else turn_deg),
    }


def traits_field(
    category: str | None,
    mobility: str | None,
    mass_kg: float | None,
    density_kg_m3: float | None,
    pickable: bool | None,
    switch: bool | None,
) -> dict[str, Any] | None:
    """Category, mobility, mass and use as stated; ``None`` where nothing is."""
    traits = {
        "category": optional_text("category", category),
        "mobility": None if mobility is None else choice("mobility", mobility, get_args(Mobility)),
        "mass_kg": None if mass_kg is None else finite_number("mass_kg", mass_kg),
        "density_kg_m3": None
        if density_kg_m3 is None
        else finite_number("density_kg_m3", density_kg_m3),
        "pickable": None if pickable is None else boolean("pickable", pickable),
        "switch": None if switch is None else boolean("switch", switch),
    }
    told = {key: value for key, value in traits.items() if value is not None}
    return told or None


def look_field(
    substance: str | None, srgb: Rgb | None, *, keep_look: bool = False
) -> dict[str, Any] | None:
    """A substance or a colour; ``None`` where neither is stated."""
    if substance is None and srgb is None:
        return None
    color = None if srgb is None else rgb("srgb", srgb)
    return {
        "substance": optional_text("substance", substance),
        "srgb": color,
        "keep_look": keep_look,
    }


def optional_text(name: str, value: object) -> str | None:
    """Text, or ``None``."""
    return None if value is None else text(name, value)


def rgb(name: str, color: Sequence[int]) -> list[int]:
    """A colour: three whole numbers, 0 to 255."""
    rows = sequence_items(name, color, "expected three whole numbers, 0 to 255")
    if len(rows) != 3:
        raise ConfigError(f"{name} has {len(rows)} numbers; expected 3")
    return [integer_in_range(f"{name}[{k}]", value, high=255) for k, value in enumerate(rows)]
