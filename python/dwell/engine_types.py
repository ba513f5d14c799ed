"""Types that the engine's tables say; written by docs/write_generated.py."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    from dwell.heads import Head

Channel = Literal[
    "rgb",
    "depth",
    "instance",
    "semantic",
    "normals",
    "albedo",
    "surfels",
    "flow",
    "visible_objects",
    "boxes_2d",
    "boxes_3d",
]
LocomotionName = Literal[
    "walking",
    "differential_drive",
    "holonomic",
]
Locomotion = str | Mapping[str, Mapping[str, float]]


class WorldSettings(TypedDict, total=False):
    """What :class:`dwell.World` may be told besides."""

    #: Control steps per second of simulated time; 1 to 1,000, default 20.
    control_rate_hz: float
    #: Physics steps per second; a whole multiple of the control rate, default 120.
    physics_rate_hz: float
    #: Sound samples per second; 8,000 to 192,000, default 16,000; a whole number of samples must
    #: fit a control step.
    sound_rate_hz: int
    #: How carefully sound is traced: `"rl"` (fast, default), `"full"` or `"reference"` (slow).
    sound_preset: Literal["rl", "full", "reference"]
    #: The head on which all agents' ears are, of those that `Engines::add_head` got; without one a
    #: sphere.
    sound_head: Head | str | os.PathLike[str] | None
    #: The folder below which sound files are, as a path; without one no file is played.
    sound_root: str | os.PathLike[str] | None
    #: Whether agents' voices are silent, default false: what they say is neither heard nor
    #: understood.
    muted: bool
    #: Who renders pictures: `"cpu"` (default), `"gpu"`, or `"gpu:NAME"` with a part of an
    #: adapter's name.
    renderer: str
    #: How long things may come to rest before the world begins, s, 0 to 60; less where all rest
    #: sooner. Without it nothing is moved in advance in a world, and 2 s pass before an
    #: environment's.
    settle_s: float


class BodySettings(TypedDict, total=False):
    """In what an agent's body differs from the default."""

    #: Radius of the capsule, m; 0.05 to 1.
    radius_m: float
    #: Height of the capsule, m; at least twice the radius, at most 3; 1.45 to 2 of a person,
    #: default 1.7 there.
    height_m: float
    #: Height of eyes and ears above the feet, m; at most the height; of a person 0.936 of its
    #: height by default.
    eye_height_m: float
    #: The highest step that it climbs, m; 0 to 1.
    step_height_m: float
    #: The steepest slope that it walks up, rad; 0 to 1.4.
    max_slope_rad: float
    #: The heaviest object that it lifts, kg; 0 to 500. A heavier one falls from its hand in the
    #: next step.
    lift_kg: float
    #: Reach of its hand from its eye, m; 0.1 to 5.
    reach_m: float
    #: The force with which it pushes obstacles and with which its hand pushes and pulls, N; 0 to
    #: 10,000.
    push_force_n: float
    #: The strongest pull of its hand on a door or drawer, N·m or N; 0 to 10,000.
    hand_effort: float
    #: The largest edge of an object that it carries, m; 0.05 to 5.
    max_carry_size_m: float
    #: The horizontal field of view of the cameras at its eyes that state none of their own,
    #: degrees; 1 to 170, default 90. In a world it is the value of `agent/N/camera/fov_deg` until
    #: that is set: then it is that of all its cameras but those with a `projection`, whatever they
    #: state.
    camera_fov_deg: float
    #: Its locomotion; default: it walks.
    locomotion: Locomotion
    #: `"capsule"` (default) or `"person"`: a jointed figure that is seen as a person.
    kind: Literal["capsule", "person"]
    #: The hand with which a person holds and reaches, default `"right"`.
    hand: Literal["left", "right"]
    #: Colours of a person, sRGB, 0 to 255; what is not stated is drawn.
    colors: Mapping[str, Sequence[int]]


class AirSettings(TypedDict, total=False):
    """The air of an :class:`dwell.AcousticScene`."""

    #: Temperature, degrees Celsius; -40 to 60.
    temperature_c: float
    #: Relative humidity, percent; 0 to 100.
    humidity_pct: float
    #: Static pressure, kPa; 30 to 200.
    pressure_kpa: float


class AcousticSettings(TypedDict, total=False):
    """What :class:`dwell.AcousticScene` may be told."""

    #: Sample rate of impulse responses, Hz; 8,000 to 192,000.
    rate_hz: int
    #: Rays of the energy tail; 0 (no tail) to 10,000,000.
    rays: int
    #: Longest time that a ray travels, s; 0.02 to 20. Responses end 0.05 s later at most.
    max_duration_s: float
    #: Width of the histogram's bins, s; 0.0005 to 0.05.
    bin_s: float
    #: Highest order of the image sources; 0 (direct sound only) to 4. Specular paths of higher
    #: orders belong to the tail.
    image_order: int
    #: Number of the largest planes that are combined exhaustively, as long as that makes at most
    #: 20,000 sequences an order; 0 to 200.
    image_planes: int
    #: Rays from the receiver that discover further sequences of planes; 0 to 100,000.
    discovery_rays: int
    #: Decay of the rays' energy down to which their number is kept, dB; 10 to 120. Above it, faint
    #: rays end and strong ones split, so that there are always as many; below, their number falls
    #: with their energy. Bands count alike.
    roulette_db: float
    #: Radius of the detection sphere in which paths with specular last reflections are counted, m;
    #: 0.05 to 2. It holds for paths up to 8 m and grows with their length, up to 0.35 of the cube
    #: root of the volume in sight.
    receiver_radius_m: float
    #: Relative standard error of the tail's energy, in every band, below which no more rays are
    #: traced; 0 (all rays) to 1.
    max_error: float
    #: Random arrivals a second in the tail's pressure; 500 to 100,000. Denser ones cannot be
    #: distinguished.
    arrivals_per_s: float
    #: Makes panels below 4 m² mirror only short waves and scatter long ones, except panels that
    #: hang at a wall or lean out of one.
    panel_size: bool
    #: Makes surfaces absorb more at grazing and less at normal incidence; their tables'
    #: coefficients are for a diffuse field. Without it they hold for every angle.
    absorption_by_angle: bool
    #: Temperature, humidity, pressure.
    air: AirSettings
    #: Enables absorption by air.
    air_absorption: bool
    #: Lets sound pass through walls and doors by their materials' transmission loss.
    transmission: bool
    #: Enables diffraction: paths around what hides the source, and the shadowing by edges beside
    #: the straight line.
    diffraction: bool
    #: Radius of the spherical head, m; 0.03 to 0.2.
    head_radius_m: float


class GeneratorSettings(TypedDict, total=False):
    """What :meth:`dwell.House.generate` may be told."""

    #: What kind of home.
    home: Literal["studio", "apartment", "house", "office"]
    #: Number of storeys, 1 to 3; more than one only for a house or with `rooms`.
    storeys: int
    #: Floor of all rooms together, hallways too, without balconies and terraces, m²; 12 to 400.
    #: Kept to within a fifth, as far as the rooms allow.
    area_m2: float
    #: Exactly these rooms, 1 to 12; empty: as the home usually has. Hallways come by themselves.
    rooms: Sequence[str]
    #: Kinds of rooms that shall have a door between them, as far as the plan allows.
    adjacency: Sequence[tuple[str, str]]
    #: The name of a style of furniture.
    style: str
    #: How much of the furniture that a home can do without is there, 0 to 1.
    furniture_density: float
    #: How much small stuff lies about, 0 to 1.
    clutter: float
    #: How doors stand at the start.
    doors: Literal["closed", "open", "ajar", "mixed"]
    #: Local solar time, h, 0 to 24: where the sun stands on a fine day in April. Which way north
    #: lies is drawn.
    time_of_day: float
    #: Which looks of furniture it may have.
    split: Literal["train", "val", "test", "all"]
