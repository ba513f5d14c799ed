"""Drives of a robot on two wheels; the ticks are counts since the sample before."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from dwell.arguments import finite_number
from dwell.measured.kinds.form import Kind, counted, listing, write_episodes, write_manifest
from dwell.measured.maps import (
    COLUMN,
    TABLE,
    Job,
    Map,
    column_list,
    columns_of,
    require,
    require_filled,
)
from dwell.measured.places import Place
from dwell.measured.readers import Row
from dwell.measured.samples import Field, SampleReader, fields_of, singles
from dwell.measured.tables import MeasuredTable

TEMPLATE: Map = {
    "kind": "drive",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "base": {
        "wheel_radius_m": 0.042,
        "wheel_base_m": 0.2,
        "rate_hz": 20.0,
        "ticks_per_turn": 2796.8,
    },
    "episodes": {
        "file": "index.csv",
        "episode": "episode",
        "split_group": "set",
        "conditions": "path",
    },
    "table": {
        "file": "data.parquet",
        "episode": "episode",
        "t_s": "t_s",
        "units": {"t_s": "s", "x": "m", "y": "m", "theta": "rad"},
        "position": ["x", "y"],
        "heading_rad": "theta",
        "ticks_left": "ticks_left",
        "ticks_right": "ticks_right",
    },
}
_SCHEMA: Map = {
    "base": {"wheel_radius_m": 1.0, "wheel_base_m": 1.0, "rate_hz": 1.0, "ticks_per_turn": 1.0},
    "episodes": {
        "file": "",
        "part": "",
        "episode": (str, list),
        "split_group": (str, list),
        "conditions": (str, list),
    },
    "table": {
        **TABLE,
        "metres_per_unit": 1.0,
        "radians_per_unit": 1.0,
        "position": [],
        "heading_rad": COLUMN,
        "ticks_left": COLUMN,
        "ticks_right": COLUMN,
    },
}
#: Samples of an episode below which nothing can be predicted.
FEWEST = 42


def _write(job: Job) -> dict[str, Any]:
    part, here = job.part("table")
    told, base_at = job.part("base")
    require_filled(told, ("wheel_radius_m", "wheel_base_m"), base_at)
    base = dict(told)
    ticks = require(base, "ticks_per_turn", base_at)
    if not isinstance(ticks, int | float) or not ticks > 0:
        raise ValueError(f"{base_at}: ticks_per_turn is {ticks!r}; a number above 0 is needed")
    rad_per_tick = 2.0 * math.pi / base.pop("ticks_per_turn")
    listed = _listed(job) if job.mapping.get("episodes") is not None else None
    place = columns_of(part, "position", 2, here)
    heading = require(part, "heading_rad", here)
    wheels = [require(part, key, here) for key in ("ticks_left", "ticks_right")]
    fields = [*fields_of(place, "length", "position"), Field(heading, "angle", key="heading_rad")]
    fields += [Field(part[key], "number", key=key) for key in ("ticks_left", "ticks_right")]
    reader = SampleReader(job, part, here, fields)
    names = ("x", "y", "heading", "left_rad", "right_rad")
    reader.bundle_names = {name: own.column for name, own in zip(names, fields, strict=True)}

    def accept(place: Place, name: str) -> bool:
        if listed is not None and name not in listed[1]:
            raise ValueError(
                f"{place}: episode {name!r} is not in {listed[0]}, which has "
                f"{sorted(listed[1])[:3]}"
            )
        return True

    rate_hz = finite_number(f"{base_at}: rate_hz", require(base, "rate_hz", base_at))
    step_s = 1.0 / rate_hz if rate_hz > 0 else None
    samples = reader.read(step_s=step_s, fewest=FEWEST, accept=accept)
    if listed is not None:
        samples.episodes = [
            replace(e, group=listed[1][e.source][0], conditions=listed[1][e.source][1])
            for e in samples.episodes
        ]
    job.draft.fields["scene.base."] = f"{job.at}: base."
    origin = {
        "episode": ["/".join(reader.episode)],
        "t_s": [reader.clock],
        "x": place[:1],
        "y": place[1:],
        "heading": [heading],
        "left_rad": wheels[:1],
        "right_rad": wheels[1:],
    }
    head = "episode,t_s,x,y,heading,left_rad,right_rad"
    with job.draft.table("drive.csv", head, origin) as write:
        for episode in samples.episodes:
            values = episode.values.copy()
            values[:, 3:] *= rad_per_tick
            for k, stamp in enumerate(samples.stamps(episode)):
                write([episode.name, stamp, *singles(values[k])], episode.place(k))
    write_manifest(job, KIND.version, {"base": base}, {})
    write_episodes(job, listing(samples.episodes))
    return counted(job, samples.rows, len(samples.episodes), {})


def _listed(job: Job) -> tuple[str, dict[str, tuple[str, str]]]:
    """The table of episodes, and the group and conditions of each."""
    part, at = job.part("episodes")
    columns = []
    for key in ("episode", "split_group", "conditions"):
        require(part, key, at)
        columns.append(column_list(part, key, at))
    table = MeasuredTable(part, job.files, at)
    table.has([name for own in columns for name in own])
    rows: dict[str, Row] = {}
    for place, row in table:
        name = table.text(row, columns[0])
        row = {key: value for key, value in row.items() if key in table.columns}
        if rows.setdefault(name, row) != row:
            raise ValueError(f"{place}: episode {name!r} is listed twice, with other values")
    groups = {
        name: (table.text(row, columns[1]), table.text(row, columns[2]))
        for name, row in rows.items()
    }
    return table.name, groups


KIND = Kind("drive", "drives of a robot on two wheels", TEMPLATE, _SCHEMA, 3, _write)
