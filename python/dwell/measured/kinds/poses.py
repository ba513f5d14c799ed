"""Poses of a rigid body that flies, hits a flat board, slides, rolls and comes to rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from dwell.arguments import finite_number
from dwell.measured import rotations
from dwell.measured.axes import Axes
from dwell.measured.kinds.form import Kind, counted, listing, write_episodes, write_manifest
from dwell.measured.maps import (
    COLUMN,
    TABLE,
    Job,
    Map,
    Numbers,
    choice,
    columns_of,
    filled,
    require,
    require_filled,
)
from dwell.measured.samples import Episode, Field, SampleReader, fields_of, single, singles
from dwell.measured.tables import MeasuredTable
from dwell.measured.units import ColumnUnits

TEMPLATE: Map = {
    "kind": "pose_trajectory",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "up": "z",
    "g_m_s2": None,
    "body": {
        "name": "cube",
        "mass_kg": 0.37,
        "half_extents_m": [0.0524, 0.0524, 0.0524],
        "inertia_kg_m2": None,
    },
    "board": {"friction": 0.18, "restitution": 0.125},
    "poses": {"rate_hz": 148.0, "angular_velocity": "body", "filtering": ""},
    "table": {
        "file": "data.parquet",
        "episode": "toss",
        "split_group": None,
        "t_s": "t_s",
        "units": {"t_s": "s", "px": "m", "py": "m", "pz": "m"},
        "position": ["px", "py", "pz"],
        "quaternion_xyzw": ["qx", "qy", "qz", "qw"],
        "velocity": ["vx", "vy", "vz"],
        "angular_velocity": ["wx", "wy", "wz"],
    },
    "starts": {
        "file": "index.csv",
        "episode": "toss",
        "sample": "eval_start_k",
        "velocity": ["ic_vx", "ic_vy", "ic_vz"],
        "angular_velocity": ["ic_wx", "ic_wy", "ic_wz"],
    },
}
_SCHEMA: Map = {
    "up": "",
    "axes": (str, list),
    "body": {
        "name": "",
        "mass_kg": 1.0,
        "radius_m": 1.0,
        "half_extents_m": Numbers(3),
        "inertia_kg_m2": Numbers(3),
    },
    "board": {"friction": 1.0, "restitution": 1.0, "substances": []},
    "poses": {"rate_hz": 1.0, "angular_velocity": "", "filtering": ""},
    "table": {
        **TABLE,
        "metres_per_unit": 1.0,
        "radians_per_unit": 1.0,
        "position": [],
        "quaternion_xyzw": [],
        "quaternion_wxyz": [],
        "velocity": [],
        "angular_velocity": [],
    },
    "starts": {
        "file": "",
        "part": "",
        "units": {},
        "episode": (str, list),
        "sample": COLUMN,
        "velocity": [],
        "angular_velocity": [],
    },
}
#: Samples of an episode below which nothing can be predicted.
FEWEST = 6
_HEAD = "episode,t_s,entity,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz"


def _quaternion(part: Map, at: str) -> list[str]:
    """The columns of x, y, z, w, in whichever order the map has them."""
    if part.get("quaternion_wxyz") is None:
        return columns_of(part, "quaternion_xyzw", 4, at)
    if part.get("quaternion_xyzw") is not None:
        raise ValueError(f"{at}: both 'quaternion_xyzw' and 'quaternion_wxyz'; leave one out")
    w, x, y, z = columns_of(part, "quaternion_wxyz", 4, at)
    return [x, y, z, w]


def _write(job: Job) -> dict[str, Any]:
    mapping, at = job.mapping, job.at
    axes = Axes(mapping, at)
    part, here = job.part("table")
    body, _ = job.part("body")
    form, form_at = job.part("poses")
    board, board_at = job.part("board")
    require_filled(body, ("name", "mass_kg"), f"{at}: body")
    if body.get("radius_m") is None:
        require(body, "half_extents_m", f"{at}: body")
    require_filled(board, ("friction", "restitution"), board_at)
    substances = board.get("substances")
    if substances is not None and [type(name) for name in substances] != [str, str]:
        raise ValueError(
            f"{board_at}: substances is {substances!r:.60}; the names of two, of the body and of "
            "the board, are needed"
        )
    rate_hz = finite_number(f"{form_at}: rate_hz", require(form, "rate_hz", form_at))
    frame = choice(form, "angular_velocity", ("body", "world"), form_at)
    place = columns_of(part, "position", 3, here)
    quaternion = _quaternion(part, here)
    rates = [
        columns_of(part, key, 3, here) if part.get(key) else []
        for key in ("velocity", "angular_velocity")
    ]
    if rates[1]:
        require(form, "angular_velocity", form_at)
    if bool(rates[0]) != bool(rates[1]):
        told, other = ("velocity", "angular_velocity")[:: 1 if rates[0] else -1]
        raise ValueError(
            f"{here}: {told!r} without {other!r}; both or neither are read: name the columns of "
            f"{other!r} too, or leave {told!r} out"
        )
    has_rates = bool(rates[0])
    fields = fields_of(place, "length", "position")
    fields += [
        Field(column, "number", key=f"{axis} of the quaternion")
        for column, axis in zip(quaternion, "xyzw", strict=True)
    ]
    fields += fields_of(rates[0], "speed", "velocity", optional=True)
    fields += fields_of(rates[1], "spin", "angular_velocity", optional=True)
    starts = bool(mapping.get("starts"))
    reader = SampleReader(job, part, here, fields, lends_scales=starts)
    step_s = 1.0 / rate_hz if rate_hz > 0 else None
    samples = reader.read(step_s=step_s, fewest=FEWEST)
    rotations.check(samples.episodes, reader.table.name, quaternion, rates[1], frame, axes, rate_hz)
    if has_rates and (note := rotations.speed_note(samples.episodes, rate_hz)) is not None:
        job.notes.append(note)
    job.draft.fields |= {"scene.bodies[0].": f"{at}: body.", "scene.board.": f"{at}: board."}
    origin = {"t_s": [reader.clock], "episode": ["/".join(reader.episode)]}
    for names, own in ((("x", "y", "z"), place), (("vx", "vy", "vz"), rates[0])):
        if own:
            origin |= {name: [own[k]] for name, k in zip(names, axes.order, strict=True)}
    with job.draft.table("poses.csv", _HEAD, origin) as write:
        for episode in samples.episodes:
            table = _in_engine(episode, axes, has_rates=has_rates, in_body=frame == "body")
            for k, stamp in enumerate(samples.stamps(episode)):
                cells = singles(table[k])
                if "" in cells[7:]:
                    cells[7:] = [""] * 6
                cells += [""] * (13 - len(cells))
                write([episode.name, stamp, str(body.get("name")), *cells], episode.place(k))
    left_out: dict[str, None] = {}
    if starts:
        job.progress(0.7, "starts")
        left_out = _write_starts(job, reader, samples.episodes, axes, in_body=frame == "body")
    if left_out:
        job.notes.append(
            f"{len(left_out)} starts of samples that were left out: those episodes start at their "
            "first sample"
        )
    scene = {"bodies": [body], "board": board}
    write_manifest(
        job, KIND.version, scene, {"poses": {"angular_velocity": "world", **filled(form)}}
    )
    write_episodes(job, listing(samples.episodes))
    return counted(job, samples.rows, len(samples.episodes), {})


def _in_engine(
    episode: Episode, axes: Axes, *, has_rates: bool, in_body: bool
) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Position, rotation and velocities in the engine's axes, a row a sample."""
    v = episode.values
    parts = [axes.vectors(v[:, :3]), axes.rotations(v[:, 3:7])]
    if has_rates:
        spin = v[:, 10:13]
        parts += [axes.vectors(v[:, 7:10]), spin if in_body else axes.vectors(spin)]
    return np.concatenate(parts, axis=1)


def _write_starts(
    job: Job, reader: SampleReader, episodes: list[Episode], axes: Axes, *, in_body: bool
) -> dict[str, None]:
    """The samples from which episodes are rolled out, and velocities there."""
    part, at = job.part("starts")
    table = MeasuredTable(part, job.files, at)
    linear = columns_of(part, "velocity", 3, at)
    angular = columns_of(part, "angular_velocity", 3, at)
    sample = require(part, "sample", at)
    names = [require(part, "episode", at)] if isinstance(part["episode"], str) else part["episode"]
    table.has([*names, sample, *linear, *angular])
    units = ColumnUnits(part, at, reader.units)
    speeds = [units.unit(column, "speed") for column in linear]
    spins = [units.unit(column, "spin") for column in angular]
    units.refuse_unused()
    reader.units.refuse_idle()
    # Where each of the user's samples is now.
    now = {
        (episode.source, int(number)): (episode.name, k)
        for episode in episodes
        for k, number in enumerate(episode.numbers)
    }
    known = {episode.source for episode in episodes}
    left_out: dict[str, None] = {}
    origin = {"episode": ["/".join(names)], "sample": [sample]}
    with job.draft.table("starts.csv", "episode,sample,vx,vy,vz,wx,wy,wz", origin) as write:
        for place, row in table:
            name = table.text(row, names)
            if name in reader.short:
                continue
            count = int(table.number(place, row, sample))
            found = now.get((name, count), (name, count))
            if name in known and (name, count) not in now and _was_left_out(episodes, name, count):
                left_out[name] = None
                continue
            speed = [
                unit.one(table.number(place, row, c))
                for unit, c in zip(speeds, linear, strict=True)
            ]
            spin = [
                unit.one(table.number(place, row, c))
                for unit, c in zip(spins, angular, strict=True)
            ]
            velocity = axes.vectors(np.array([speed]))[0]
            turning = np.array([spin])
            values = [*velocity, *(turning if in_body else axes.vectors(turning))[0]]
            write([found[0], str(found[1]), *(single(float(v)) for v in values)], place)
    return left_out


def _was_left_out(episodes: list[Episode], name: str, sample: int) -> bool:
    """Whether the user's episode has later samples than one that is not there."""
    return any(e.source == name and int(e.numbers.max()) >= sample for e in episodes)


KIND = Kind(
    "pose_trajectory",
    "poses of a body that flies, hits a board and comes to rest",
    TEMPLATE,
    _SCHEMA,
    2,
    _write,
)
