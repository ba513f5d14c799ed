"""Flights of balls: one height or all three coordinates, and how they spin."""

from __future__ import annotations

from typing import Any

import numpy as np

from dwell.measured import falls
from dwell.measured.axes import Axes
from dwell.measured.kinds.form import Kind, counted, listing, write_episodes, write_manifest
from dwell.measured.maps import COLUMN, TABLE, Job, Map, require, require_filled
from dwell.measured.places import Place
from dwell.measured.samples import Episode, Field, SampleReader, single
from dwell.measured.tables import MeasuredTable, cell_text
from dwell.measured.units import ColumnUnits

TEMPLATE: Map = {
    "kind": "trajectory",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "g_m_s2": None,
    "bodies": {
        "file": "index.csv",
        "episode": "episode",
        "name": "ball",
        "mass_kg": "mass_kg",
        "diameter_m": "diameter_m",
    },
    "table": {
        "file": "data.parquet",
        "episode": "episode",
        "split_group": None,
        "t_s": "t_s",
        "units": {"t_s": "s", "height_m": "m"},
        "channels": {"y": "height_m"},
    },
}
_SCHEMA: Map = {
    "axes": (str, list),
    "noise_sd": {"x": 1.0, "y": 1.0, "z": 1.0, "wx": 1.0, "wy": 1.0, "wz": 1.0},
    "body": {"name": "", "mass_kg": 1.0, "radius_m": 1.0},
    "bodies": {
        "file": "",
        "part": "",
        "units": {},
        "episode": (str, list),
        "name": COLUMN,
        "mass_kg": COLUMN,
        "diameter_m": COLUMN,
    },
    "table": {**TABLE, "metres_per_unit": 1.0, "radians_per_unit": 1.0, "channels": {}},
}
#: What each channel of the bundle measures, and its unit there.
_CHANNELS = {
    **dict.fromkeys("xyz", ("length", "m")),
    **dict.fromkeys(("wx", "wy", "wz"), ("spin", "rad/s")),
}
#: Ratio of the noise of two coordinates of one tracker from which on their units are doubted.
_UNLIKE_NOISE = 30.0
#: Samples of an episode below which nothing can be predicted.
FEWEST = 6


def _write(job: Job) -> dict[str, Any]:
    part, here = job.part("table")
    if (job.mapping.get("body") is None) == (job.mapping.get("bodies") is None):
        raise ValueError(
            f"{job.at}: what flew is one 'body', or a table of 'bodies': one of them is needed"
        )
    listed, bodies, body_of = _bodies(job) if job.mapping.get("bodies") else _one_body(job)
    everyone = job.mapping.get("body")
    channels = require(part, "channels", here)
    for channel, column in channels.items():
        if not isinstance(column, str):
            raise ValueError(f"{here}: channels.{channel} is {column!r:.60}; {COLUMN} is needed")
        if channel not in _CHANNELS:
            raise ValueError(f"{here}: no channel {channel!r}; allowed are {list(_CHANNELS)}")
    axes = Axes(job.mapping, job.at)
    turned = job.mapping.get("axes") is not None
    names = _turned_names(channels, here) if turned else list(channels)
    if not set(names) & {"x", "y", "z"}:
        raise ValueError(f"{here}: channels are {names}; a flight has a place, y or x, y and z")
    spins = [_CHANNELS[name][0] == "spin" for name in names]
    fields = [
        Field(channels[name], _CHANNELS[name][0], optional=spin, key=f"channels.{name}")
        for name, spin in zip(names, spins, strict=True)
    ]
    reader = SampleReader(job, part, here, fields)
    left_out: dict[str, None] = {}
    seen: dict[str, None] = {}

    def accept(_place: Place, name: str) -> bool:
        seen[name] = None
        if everyone is not None or name in body_of:
            return True
        left_out[name] = None
        return False

    samples = reader.read(step_s=None, fewest=FEWEST, accept=accept)
    if left_out and not samples.episodes:
        raise ValueError(
            f"{reader.table.name}: episodes are called {sorted(left_out)[:3]} in column "
            f"{'/'.join(reader.episode)!r}, and {sorted(body_of)[:3]} in column "
            f"{job.mapping['bodies']['episode']!r} of {listed}; write the same names"
        )
    order = [*axes.order, *(3 + k for k in axes.order)] if turned else [*range(len(names))]
    columns = [channels[names[k]] for k in order[: len(names)]]
    reader.bundle_names = dict(zip(names, columns, strict=True))
    for episode in samples.episodes:
        unseen = np.isnan(episode.values).all(axis=0)
        if unseen.any():
            column = channels[names[int(unseen.argmax())]]
            raise ValueError(
                f"{episode.place(0)}: episode {episode.name!r} has no number in column {column!r}; "
                "leave the episode or the channel out"
            )
    if "y" in names:
        in_engine = axes if turned else None
        one = next(iter(bodies.values()))
        of = {name: bodies[body] for name, body in body_of.items()}
        note = _fall_note(reader, samples.episodes, names, in_engine, of, one)
        if note is not None:
            job.notes.append(note)
    origin = {"t_s": [reader.clock], "episode": ["/".join(reader.episode)], "value": columns}
    origin |= {name: [column] for name, column in zip(names, columns, strict=True)}
    with job.draft.table("trajectory.csv", "episode,t_s,entity,channel,value", origin) as write:
        for episode in samples.episodes:
            values = episode.values
            if turned:
                # Spins turn as vectors do: the axes are right-handed.
                values = np.hstack(
                    [axes.vectors(part) for part in np.split(values, len(names) // 3, 1)]
                )
            body = everyone["name"] if everyone is not None else body_of[episode.source]
            for k, stamp in enumerate(samples.stamps(episode)):
                place = episode.place(k)
                for name, value in zip(names, values[k], strict=True):
                    if value != value:
                        continue
                    write([episode.name, stamp, body, name, single(float(value))], place)
    job.progress(0.7, f"{samples.rows} rows of {reader.table.name}")
    if (unlike := _unlike_noise(samples.episodes, fields)) is not None:
        job.notes.append(unlike)
    noise = job.mapping.get("noise_sd") or {}
    told = [
        {
            "name": name,
            "unit": _CHANNELS[name][1],
            "clock": "tracker",
            "noise_sd": noise.get(name),
        }
        for name in names
    ]
    for k, name in enumerate(names):
        job.draft.fields[f"channels[{k}].noise_sd"] = f"{job.at}: noise_sd.{name}"
    write_manifest(job, KIND.version, {"bodies": list(bodies.values())}, {"channels": told})
    write_episodes(job, listing(samples.episodes))
    return counted(job, samples.rows, len(samples.episodes), left_out)


def _fall_note(
    reader: SampleReader,
    episodes: list[Episode],
    names: list[str],
    axes: Axes | None,
    body_of: dict[str, Map],
    everyone: Map,
) -> str | None:
    """What there is to say of how things fall; ``axes``: where channels are the user's axes."""
    places = [k for k, name in enumerate(names) if _CHANNELS[name][0] == "length"]
    height = names.index("y")
    column = reader.fields[height if axes is None else axes.order[1]].column
    flights = []
    for episode in episodes:
        seen = episode.values[:, places]
        body = body_of.get(episode.source, everyone)
        flights.append(
            falls.Flight(
                episode.times * reader.clock_unit.factor,
                seen if axes is None else axes.vectors(seen),
                float(body["mass_kg"]),
                float(body["radius_m"]),
            )
        )
    mapping, units = reader.job.mapping, reader.part.get("units") or {}
    clock = units.get(reader.clock)
    told = falls.Told(
        heights=column,
        height_axis=places.index(height),
        unit=reader.unit_of(column),
        is_named=any(reader.units.names(reader.fields[k].column) for k in places),
        clock=reader.clock,
        seconds=reader.clock_unit.factor,
        frames=isinstance(clock, dict) and "per_second" in clock,
        g_m_s2=mapping.get("g_m_s2"),
        environment=mapping.get("environment") or {},
    )
    return falls.check(reader.table.name, flights, told)


def _unlike_noise(episodes: list[Episode], fields: list[Field]) -> str | None:
    """A word on places of which some have much more noise; falls tell the unit of heights alone."""
    noise: dict[str, float] = {}
    for k, own in enumerate(fields):
        if own.dimension == "length":
            # Third differences hold little of a motion.
            sizes = [np.abs(np.diff(episode.values[:, k], 3)) for episode in episodes]
            all_sizes = np.concatenate([np.zeros(0), *sizes])
            median = float(np.median(all_sizes)) if len(all_sizes) else 0.0
            noise[own.column] = median / (0.6745 * 20.0**0.5)
    calm, loud = (least(noise, key=lambda name: noise[name]) for least in (min, max))
    # What is written with few digits, or made up, has none.
    if noise[calm] <= 0.0 or noise[loud] < _UNLIKE_NOISE * noise[calm]:
        return None
    return (
        f"places in column {loud!r} have noise of {noise[loud]:.2g} m, those in column {calm!r} "
        f"{noise[calm]:.2g} m: are the units of both right?"
    )


def _turned_names(channels: Map, here: str) -> list[str]:
    """The channels in the order in which axes turns them."""
    names = ["x", "y", "z"]
    if set(channels) - set(names):
        names += ["wx", "wy", "wz"]
    if set(channels) != set(names):
        raise ValueError(
            f"{here}: channels are {list(channels)}; axes turns flights of which x, y and z are "
            "there, and wx, wy and wz all or none. Of a height alone write {'y': its column}, "
            "without axes"
        )
    return names


def _one_body(job: Job) -> tuple[str, dict[str, Map], dict[str, str]]:
    """The body of all episodes."""
    body, at = job.part("body")
    require_filled(body, ("name", "mass_kg", "radius_m"), at)
    job.draft.fields["scene.bodies[0]."] = f"{at}."
    return job.at, {body["name"]: body}, {}


def _bodies(job: Job) -> tuple[str, dict[str, Map], dict[str, str]]:
    """The table's name, the bodies, and the body of each episode; unknown ones are left out."""
    about, there = job.part("bodies")
    keys = ("name", "mass_kg", "diameter_m")
    name_column, mass_column, diameter_column = (require(about, key, there) for key in keys)
    episode = require(about, "episode", there)
    episode = [episode] if isinstance(episode, str) else list(episode)
    table = MeasuredTable(about, job.files, there)
    table.has([*episode, name_column, mass_column, diameter_column])
    units = ColumnUnits(about, there)
    kilograms = units.unit(mass_column, "mass")
    # The table's metres_per_unit is that of the samples alone.
    metres = units.unit(diameter_column, "length")
    units.refuse_unused()
    bodies: dict[str, Map] = {}
    body_of: dict[str, str] = {}
    for place, row in table:
        told = [table.measured(place, row, column) for column in (mass_column, diameter_column)]
        if np.isnan(told).any():
            continue
        body = cell_text(row[name_column])
        mass, diameter = kilograms.one(told[0]), metres.one(told[1])
        found = {"name": body, "mass_kg": mass, "radius_m": 0.5 * diameter}
        if body not in bodies:
            field = f"scene.bodies[{len(bodies)}]."
            fields = job.draft.fields
            fields[f"{field}mass_kg"] = f"{place}: column {mass_column!r}"
            fields[f"{field}radius_m"] = f"{place}: half of column {diameter_column!r}"
            fields[f"{field}name"] = f"{place}: column {name_column!r}"
        known = bodies.setdefault(body, found)
        if known != found:
            raise ValueError(
                f"{place}: {body!r} has {mass} kg and {diameter} m across, and in a row above "
                f"{known['mass_kg']} kg and {2.0 * known['radius_m']} m; give each body a name "
                "of its own, or correct the row"
            )
        name = table.text(row, episode)
        if body_of.setdefault(name, body) != body:
            raise ValueError(
                f"{place}: episode {name!r} has the body {body!r}, and in a row above "
                f"{body_of[name]!r}; an episode has one body"
            )
    if not bodies:
        raise ValueError(
            f"{table.name}: no row has both {mass_column!r} (kg) and {diameter_column!r} (m); "
            "flights of bodies without them are left out: fill them in"
        )
    return table.name, bodies, body_of


KIND = Kind("trajectory", "flights of balls", TEMPLATE, _SCHEMA, 2, _write)
