"""Settings by name, as type checkers and editors know them, and their checks.

The engine has the last word on ranges; here wrong types are refused by the setting's name.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypedDict

from dwell._native import ConfigError
from dwell.arguments import fields, finite, flag, mapping, quoted, text, whole
from dwell.heads import Head

Home = Literal["studio", "apartment", "house", "office"]
Doors = Literal["open", "closed", "ajar", "mixed"]
Split = Literal["train", "val", "test", "all"]
#: How an agent may get about.
LOCOMOTIONS = ("walking", "differential_drive", "holonomic")
Locomotion = str | Mapping[str, Mapping[str, float]]


class WorldSettings(TypedDict, total=False):
    """What :class:`dwell.World` may be told beside its own arguments."""

    #: Control steps a second of simulated time, 1 to 1,000; default 20.
    control_rate_hz: float
    #: Physics steps a second, a whole multiple of the control rate; default 120.
    physics_rate_hz: float
    #: Sound samples a second, 8,000 to 192,000; default 16,000.
    sound_rate_hz: int
    #: How carefully sound is traced; default ``"rl"``.
    sound_preset: Literal["rl", "full", "reference"]
    #: The head that all ears are on, or the path of its SOFA file; by default a sphere.
    sound_head: Head | str | os.PathLike[str] | None
    #: The folder below which sound files are.
    sound_root: str | os.PathLike[str] | None
    #: ``"cpu"``, ``"gpu"`` or ``"gpu:NAME"``.
    renderer: str
    #: How long things may come to rest before the world begins, s, 0 to 60; default 0, and 2 in
    #: environments.
    settle_s: float


class BodySettings(TypedDict, total=False):
    """In what an agent's body differs from the default."""

    #: Radius of the capsule, m, 0.05 to 1.
    radius_m: float
    #: Height of the capsule, m, at least twice the radius, at most 3.
    height_m: float
    #: Height of eyes and ears above the feet, m, at most the height.
    eye_height_m: float
    #: The highest step it climbs, m, 0 to 1.
    step_height_m: float
    #: The steepest slope it walks up, rad, 0 to 1.4.
    max_slope_rad: float
    #: The heaviest thing it lifts, kg, 0 to 500.
    lift_kg: float
    #: How far from its eye its hand reaches, m, 0.1 to 5.
    reach_m: float
    #: The force with which it pushes, N, 0 to 10,000.
    push_force_n: float
    #: The strongest pull of its hand on a door or drawer, N m or N, 0 to 10,000.
    hand_effort: float
    #: The largest edge of what it carries, m, 0.05 to 5.
    max_carry_size_m: float
    #: What its cameras see across, degrees, 1 to 170.
    camera_fov_deg: float
    #: How it gets about: ``"walking"``, ``"differential_drive"`` or ``"holonomic"``, or one of them
    #: with its numbers.
    locomotion: Locomotion


class AirSettings(TypedDict, total=False):
    """The air of an :class:`dwell.AcousticScene`."""

    temperature_c: float
    humidity_pct: float
    pressure_kpa: float


class AcousticSettings(TypedDict, total=False):
    """What :class:`dwell.AcousticScene` may be told; its ``config`` lists the values."""

    #: Samples a second of impulse responses, 8,000 to 192,000.
    rate_hz: int
    #: Rays of the energy tail, 0 (no tail) to 10,000,000.
    rays: int
    #: Longest time that a ray travels, s, 0.02 to 20.
    max_duration_s: float
    #: Width of the histogram's bins, s.
    bin_s: float
    #: Highest order of image sources, 0 to 4.
    image_order: int
    #: How many of the largest planes are combined exhaustively, 0 to 200.
    image_planes: int
    #: Rays that discover further sequences of planes, 0 to 100,000.
    discovery_rays: int
    #: How far a ray may fall below its start before chance ends it, dB, 10 to 120.
    roulette_db: float
    #: Radius of the ball in which late specular paths are counted, m, 0.05 to 2.
    receiver_radius_m: float
    #: Relative standard error at which no more rays are traced, 0 (all rays) to 1.
    max_error: float
    #: Random arrivals a second of the tail's pressure, 500 to 100,000.
    arrivals_per_s: float
    #: Whether small panels mirror only short waves.
    panel_size: bool
    #: Whether surfaces absorb more of what grazes them; else all angles alike.
    absorption_by_angle: bool
    #: Temperature, humidity, pressure.
    air: AirSettings
    #: Whether air absorbs.
    air_absorption: bool
    #: Whether sound passes through walls and doors.
    transmission: bool
    #: Whether sound bends around edges.
    diffraction: bool
    #: Radius of the spherical head, m, 0.03 to 0.2.
    head_radius_m: float


class GeneratorSettings(TypedDict, total=False):
    """What :meth:`dwell.House.generate` shall not draw from the seed."""

    home: Home
    #: 1 to 3.
    storeys: int
    area_m2: float
    #: Names such as ``"living_room"``.
    rooms: list[str]
    #: Pairs of rooms that shall lie beside each other.
    adjacency: list[tuple[str, str]]
    style: str
    #: 0 to 1.
    furniture_density: float
    #: 0 to 1.
    clutter: float
    doors: Doors
    #: 0 to 24 h.
    time_of_day: float
    #: Which looks it may have.
    split: Split


_Check = Callable[[str, object], Any]


def _as_is(_name: str, value: object) -> object:
    return value


def _air(name: str, value: object) -> dict[str, Any]:
    known: dict[str, _Check] = dict.fromkeys(AirSettings.__annotations__, finite)
    return fields(name, value, known)


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
            field: finite(f"{name}.{kind}.{field}", number)
            for field, number in mapping(f"{name}.{kind}", numbers).items()
        }
        for kind, numbers in kinds.items()
    }


#: What a setting must be, by the annotation that it has above.
_CHECKS: dict[str, _Check] = {
    "float": finite,
    "int": whole,
    "bool": flag,
    "str": text,
    "AirSettings": _air,
    "Locomotion": _locomotion,
}


def bodies(agents: object) -> list[dict[str, Any]]:
    """A body for each agent, from a count or from mappings of what differs from the default."""
    if isinstance(agents, str | bytes) or not isinstance(agents, Sequence):
        return [{} for _ in range(whole("agents", agents, high=64))]
    known = {
        name: _CHECKS[getattr(annotation, "__forward_arg__", str(annotation))]
        for name, annotation in BodySettings.__annotations__.items()
    }
    rows = []
    for k, body in enumerate(agents):
        if not isinstance(body, Mapping):
            raise ConfigError(f"agents[{k}] is {quoted(body)}; expected a mapping")
        rows.append(fields(f"agents[{k}]", body, known))
    return rows


def checked(kind: type, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Settings whose types are those of ``kind``; names that it lacks are left to the engine.

    Raises:
        ConfigError: A value is of another type; the message has the name, the value, and what is
            allowed.
    """
    rows = {}
    for name, value in settings.items():
        annotation = kind.__annotations__.get(name)
        rule = getattr(annotation, "__forward_arg__", str(annotation))
        if rule.startswith("Literal") and not isinstance(value, str):
            raise ConfigError(f"{name} is {quoted(value)}; allowed are {rule[8:-1]}")
        rows[name] = _CHECKS.get(rule, _as_is)(name, value)
    return rows
