"""A joint that a position servo drives: where it is, and where it was told to go."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.measured import following
from dwell.measured.hints import FieldUnit
from dwell.measured.kinds.form import Kind, counted, listing, write_episodes, write_manifest
from dwell.measured.maps import (
    COLUMN,
    TABLE,
    Job,
    Map,
    column_list,
    filled,
    require,
    require_filled,
)
from dwell.measured.places import Place
from dwell.measured.samples import Episode, Field, SampleReader, Samples, single
from dwell.measured.tables import MeasuredTable
from dwell.measured.units import ColumnUnits

TEMPLATE: Map = {
    "kind": "servo",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "joint": {
        "name": "elbow",
        "inertia_kg_m2": 0.01,
        "stiffness_n_m_rad": 40.0,
        "damping_n_m_s_rad": 1.0,
        "max_torque_n_m": 3.0,
        "friction_n_m": 0.0,
    },
    "noise_sd": {"position": None},
    "table": {
        "file": "log.csv",
        "episode": "run",
        "split_group": None,
        "conditions": None,
        "only": {"servo": 3},
        "t_s": "time_ms",
        "units": {
            "time_ms": "ms",
            "pos": {"counts_per_turn": 4096, "zero": 2048},
            "goal": {"counts_per_turn": 4096, "zero": 2048},
        },
        "position": "pos",
        "target": "goal",
    },
    "commands": None,
}
_SCHEMA: Map = {
    "joint": {
        "name": "",
        "inertia_kg_m2": 1.0,
        "stiffness_n_m_rad": 1.0,
        "damping_n_m_s_rad": 1.0,
        "max_torque_n_m": 1.0,
        "friction_n_m": 1.0,
    },
    "noise_sd": {"position": 1.0},
    "table": {**TABLE, "radians_per_unit": 1.0, "position": COLUMN, "target": COLUMN},
    "commands": {
        "file": (str, list),
        "part": "",
        "only": {},
        "units": {},
        "seconds_per_unit": 1.0,
        "radians_per_unit": 1.0,
        "episode": (str, list),
        "t_s": COLUMN,
        "target": COLUMN,
    },
}
_JOINT_VALUES = (
    "inertia_kg_m2",
    "stiffness_n_m_rad",
    "damping_n_m_s_rad",
    "max_torque_n_m",
)
#: Samples of an episode below which nothing can be predicted.
FEWEST = 6
#: Time, s; target, rad; where it stands.
Command = tuple[float, float, Place]
#: Of each of the user's episodes.
Commands = dict[str, list[Command]]


def _write(job: Job) -> dict[str, Any]:
    part, here = job.part("table")
    joint, joint_at = job.part("joint")
    require_filled(joint, ("name", *_JOINT_VALUES), joint_at)
    name = str(joint["name"])
    position, target = require(part, "position", here), part.get("target")
    commands = job.mapping.get("commands")
    if (target is None) == (commands is None):
        raise ValueError(
            f"{here}: {'no' if target is None else 'both a'} 'target' and "
            f"{'no' if commands is None else 'a'} 'commands' part; a servo's targets are a column "
            "of its own table or a table of commands"
        )
    held = None if target is None else Field(target, "angle", key="target")
    reader = SampleReader(job, part, here, [Field(position, "angle", key="position")], held)
    samples = reader.read(step_s=None, fewest=FEWEST)
    origin = {"t_s": [reader.clock], "episode": ["/".join(reader.episode)], "value": [position]}
    origin["position"] = [position]
    with job.draft.table("trajectory.csv", "episode,t_s,entity,channel,value", origin) as write:
        for episode in samples.episodes:
            for k, stamp in enumerate(samples.stamps(episode)):
                value = single(float(episode.values[k, 0]))
                write([episode.name, stamp, name, "position", value], episode.place(k))
    if target is not None:
        rows = _held_commands(reader, samples)
        origin = {"t_s": [reader.clock], "value": [target]}
    else:
        rows, origin = _listed_commands(job, reader, samples)
    following.check(
        reader.table.name,
        [_followed(episode, samples, rows) for episode in samples.episodes],
        *(own for own in reader.hinted if own.dimension == "angle"),
    )
    told = _write_commands(job, samples, rows, origin, name)
    left_out = {e.name: None for e in samples.episodes if e.name not in told}
    if left_out:
        raise ValueError(
            f"{reader.table.name}: episode {next(iter(left_out))!r} has no target; a servo's "
            "episode needs what it was told to do"
        )
    job.draft.fields["scene.joints[0]."] = f"{joint_at}."
    job.draft.fields["channels[0].noise_sd"] = f"{job.at}: noise_sd.position"
    noise = (job.mapping.get("noise_sd") or {}).get("position")
    channel = {"name": "position", "unit": "rad", "clock": "encoder", "noise_sd": noise}
    # Targets that stand beside the positions have their time.
    clock = {} if target is None else {"command_clock": channel["clock"]}
    write_manifest(job, KIND.version, {"joints": [filled(joint)]}, {"channels": [channel], **clock})
    write_episodes(job, listing(samples.episodes))
    return counted(job, samples.rows, len(samples.episodes), {})


def _held_commands(reader: SampleReader, samples: Samples) -> Commands:
    """The targets beside the positions, also where no position was read."""
    seconds = samples.clock.seconds_per_unit
    zeros = {episode.source: episode.zero for episode in samples.episodes}
    return {
        name: [((told - zeros[name]) * seconds, value, place) for told, value, place in rows]
        for name, rows in reader.held.items()
        if name in zeros
    }


def _listed_commands(
    job: Job, reader: SampleReader, samples: Samples
) -> tuple[Commands, dict[str, list[str]]]:
    """A table of commands on the clock of the positions, and its columns."""
    part, at = job.part("commands")
    table = MeasuredTable(part, job.files, at)
    require(part, "episode", at)
    names = column_list(part, "episode", at)
    clock, target = require(part, "t_s", at), require(part, "target", at)
    table.has([*names, clock, target])
    units = ColumnUnits(part, at)
    seconds, radians = units.unit(clock, "time"), units.unit(target, "angle")
    units.refuse_unused()
    units.refuse_idle()
    reader.hinted.append(
        FieldUnit(target, "angle", radians, units.names(target), "target", "commands")
    )
    zeros = {e.source: e.zero * samples.clock.seconds_per_unit for e in samples.episodes}
    rows: Commands = {}
    unknown = 0
    for place, row in table:
        name = table.text(row, names)
        if name not in zeros:
            unknown += 1
            continue
        told = seconds.one(table.number(place, row, clock)) - zeros[name]
        value = radians.one(table.number(place, row, target))
        rows.setdefault(name, []).append((told, value, place))
    if unknown:
        job.notes.append(f"{unknown:,} commands of episodes without positions: left out")
    return rows, {"episode": ["/".join(names)], "t_s": [clock], "value": [target]}


def _write_commands(
    job: Job, samples: Samples, rows: Commands, origin: dict[str, list[str]], joint: str
) -> set[str]:
    """The changes of the target in each episode; the episodes that have any."""
    told_to: set[str] = set()
    head = "episode,t_s,actuator,kind,value"
    with job.draft.table("command.csv", head, origin) as write:
        for episode in samples.episodes:
            commands = sorted(rows.get(episode.source, []), key=lambda command: command[0])
            last = None
            for t_s, value, place in _within(commands, episode, samples):
                if value != last:
                    cells = [episode.name, f"{t_s:.9f}", joint, "position", single(value)]
                    write(cells, place)
                last = value
                told_to.add(episode.name)
    return told_to


def _followed(
    episode: Episode, samples: Samples, rows: Commands
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The positions of an episode that have a target, and their targets."""
    commands = sorted(rows.get(episode.source, []), key=lambda command: command[0])
    told_s = [t_s for t_s, _, _ in commands]
    last = np.searchsorted(told_s, episode.times * samples.clock.seconds_per_unit, "right") - 1
    has = last >= 0
    targets = np.array([value for _, value, _ in commands])
    return episode.values[has, 0], targets[last[has]] if has.any() else np.zeros(0)


def _within(commands: list[Command], episode: Episode, samples: Samples) -> list[Command]:
    """The commands that act in an episode, which may be a part of the user's."""
    seconds = samples.clock.seconds_per_unit
    first, last = (float(episode.times[k]) * seconds for k in (0, -1))
    before = [command for command in commands if command[0] <= first]
    return before[-1:] + [command for command in commands if first < command[0] <= last]


KIND = Kind("servo", "a joint that a position servo drives", TEMPLATE, _SCHEMA, 2, _write)
