"""Impulse responses of a room: WAV files and a table of places, a SOFA file, or arrivals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import MeasuredDataError, sofa_rooms
from dwell.measured.axes import Axes
from dwell.measured.kinds.form import Kind, counted, write_episodes, write_manifest
from dwell.measured.maps import (
    COLUMN,
    NAMES,
    TEXT_OR_LIST,
    Job,
    Map,
    Numbers,
    check_keys,
    choice,
    column_list,
    point,
    require,
    require_filled,
)
from dwell.measured.places import Place
from dwell.measured.samples import single
from dwell.measured.tables import MeasuredTable, cell_text, names_of
from dwell.measured.units import ColumnUnits
from dwell.sounds import read_wav, write_wav

TEMPLATE: Map = {
    "kind": "impulse_response",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "environment": {"temperature_c": None, "humidity_pct": None, "pressure_pa": None},
    "axes": "z_up",
    "room": {
        "size_m": [6.0, 4.0, 2.5],
        "surfaces": {
            "floor": {"substance": "parquet"},
            "ceiling": {"substance": "plaster"},
            "west": {"substance": "plaster"},
            "east": {"substance": "plaster"},
            "north": {"substance": "plaster"},
            "south": {"substance": "plaster"},
        },
    },
    "table": {
        "file": "index.csv",
        "episode": "file",
        "split_group": "source",
        "conditions": None,
        "wav": "file",
        "channel": None,
        "gain": None,
        "source": "source",
        "receiver": "mic",
    },
    "places": {
        "sources": {"S1": [1.0, 1.0, 1.5]},
        "receivers": {"file": "positions.csv", "name": "mic", "position": ["x", "y", "z"]},
    },
    "sofa": None,
    "arrivals": None,
    "response_times": None,
}
_PLACES: Map = {
    "file": "",
    "part": "",
    "only": NAMES,
    "name": TEXT_OR_LIST,
    "position": [],
    "units": NAMES,
}
_SCHEMA: Map = {
    "axes": TEXT_OR_LIST,
    "origin": [],
    "room": {"size_m": Numbers(3), "surfaces": NAMES, "position_sd_m": 1.0},
    "table": {
        "file": TEXT_OR_LIST,
        "part": "",
        "only": NAMES,
        "episode": TEXT_OR_LIST,
        "split_group": TEXT_OR_LIST,
        "conditions": TEXT_OR_LIST,
        "units": NAMES,
        "wav": COLUMN,
        "channel": COLUMN,
        "gain": COLUMN,
        "source": TEXT_OR_LIST,
        "receiver": TEXT_OR_LIST,
    },
    "places": {"sources": NAMES, "receivers": NAMES},
    "sofa": {"file": TEXT_OR_LIST, "episode": ""},
    "arrivals": {
        "file": TEXT_OR_LIST,
        "part": "",
        "only": NAMES,
        "episode": TEXT_OR_LIST,
        "split_group": TEXT_OR_LIST,
        "conditions": TEXT_OR_LIST,
        "units": NAMES,
        "source": TEXT_OR_LIST,
        "receiver": TEXT_OR_LIST,
        "path": COLUMN,
        "t_s": COLUMN,
    },
    "response_times": "",
}
#: Keys of each side of a room.
_SURFACE: Map = {
    "substance": "",
    "absorption": {"centres_hz": Numbers(), "values": Numbers()},
    "scattering": 1.0,
    "material": "",
}
#: What is known of times, as in bundles.
_TIMES = ("relative", "common_offset", "absolute")
#: Responses of a bundle, as for the reader of bundles.
_MAX_RESPONSES = 2000
_ENDS = "source_x,source_y,source_z,receiver_x,receiver_y,receiver_z"
_HEAD = f"episode,file,{_ENDS},rate_hz"
_ARRIVALS_HEAD = f"episode,{_ENDS},path,t_s"
Point = NDArray[np.float64]


@dataclass(frozen=True)
class _Response:
    """One response, in the user's axes."""

    episode: str
    group: str
    conditions: str
    source: Point
    receiver: Point
    samples: NDArray[np.float32]
    rate_hz: int
    place: Place


def _write(job: Job) -> dict[str, Any]:
    mapping, at = job.mapping, job.at
    given = [key for key in ("table", "sofa", "arrivals") if mapping.get(key) is not None]
    if len(given) != 1:
        raise ValueError(
            f"{at}: responses come from a 'table' of WAV files or from 'sofa', or there are "
            "'arrivals' alone: one of them is needed"
        )
    times = choice(mapping, "response_times", _TIMES, at)
    axes = Axes(mapping, at)
    zero = mapping.get("origin")
    origin = np.zeros(3) if zero is None else np.array(point(zero, f"{at}: origin"))
    episodes: dict[str, tuple[str, str, str]] = {}
    if given == ["arrivals"]:
        count = _write_arrivals(job, axes, origin, episodes)
    else:
        found = _from_sofa(job) if given == ["sofa"] else _from_table(job)
        count = _write_responses(job, found, axes, origin, episodes)
    scene = {}
    if mapping.get("room") is not None:
        require_filled(mapping["room"], ("size_m", "surfaces"), f"{at}: room")
        scene["room"] = _room(mapping["room"], f"{at}: room")
    job.draft.fields["scene.room."] = f"{at}: room."
    more = {} if times is None else {"response_times": times}
    write_manifest(job, KIND.version, scene, more)
    write_episodes(job, [*episodes.values()])
    return counted(job, count, len(episodes), {})


def _room(room: Map, at: str) -> Map:
    """The room, each of whose sides has the form that bundles have."""
    for side, surface in room["surfaces"].items():
        where = f"{at}: surfaces: {side}"
        if not isinstance(surface, dict):
            raise ValueError(
                f"{where} is {surface!r:.60}; an object with some of {list(_SURFACE)} is needed"
            )
        check_keys(surface, _SURFACE, where)
        absorption = surface.get("absorption")
        if absorption is not None:
            require_filled(absorption, ("centres_hz", "values"), f"{where}: absorption")
    return room


def _write_responses(
    job: Job,
    found: Iterator[_Response],
    axes: Axes,
    origin: Point,
    episodes: dict[str, tuple[str, str, str]],
) -> int:
    """The responses and their table; returns how many there are."""
    (job.draft.folder / "ir").mkdir()
    count = 0
    with job.draft.table("ir.csv", _HEAD, {"episode": ["episode"]}) as write:
        for response in found:
            count += 1
            if count > _MAX_RESPONSES:
                raise ValueError(
                    f"{response.place}: more than {_MAX_RESPONSES} responses; import fewer"
                )
            name = f"ir/{count:04}.wav"
            write_wav(job.draft.folder / name, response.samples[None], response.rate_hz)
            listed = (response.episode, response.group, response.conditions)
            episodes.setdefault(response.episode, listed)
            job.draft.begins(response.episode, response.place)
            both = np.stack([response.source, response.receiver]) - origin
            places = axes.vectors(both).ravel()
            row = [response.episode, name, *(single(float(v)) for v in places)]
            write([*row, str(response.rate_hz)], response.place)
            if count % 16 == 0:
                job.progress(0.1, f"{count} responses")
    return count


def _write_arrivals(
    job: Job,
    axes: Axes,
    origin: Point,
    episodes: dict[str, tuple[str, str, str]],
) -> int:
    """The arrivals that a table lists; returns how many there are."""
    part, at = job.part("arrivals")
    table = MeasuredTable(part, job.files, at)
    units = ColumnUnits(part, at)
    path, time = require(part, "path", at), require(part, "t_s", at)
    episode = names_of(part, "episode", at, [])
    group = names_of(part, "split_group", at, episode)
    conditions = names_of(part, "conditions", at, [])
    ends = [_End(job, part, at, key, units) for key in ("source", "receiver")]
    in_s = units.unit(time, "time")
    columns = [*episode, *group, *conditions, path, time, *ends[0].columns, *ends[1].columns]
    table.has([*dict.fromkeys(columns)])
    units.refuse_unused()
    count = 0
    with job.draft.table("arrivals.csv", _ARRIVALS_HEAD, {"episode": ["episode"]}) as write:
        for place, row in table:
            count += 1
            name, of_group, words = (
                table.text(row, names) for names in (episode, group, conditions)
            )
            episodes.setdefault(name, (name, of_group, words))
            job.draft.begins(name, place)
            both = np.stack([end.of(table, place, row) for end in ends]) - origin
            places = [single(float(v)) for v in axes.vectors(both).ravel()]
            t_s = in_s.one(table.number(place, row, time))
            write([name, *places, table.text(row, [path]), repr(float(t_s))], place)
    return count


def _from_table(job: Job) -> Iterator[_Response]:
    """The responses that a table lists."""
    part, at = job.part("table")
    table = MeasuredTable(part, job.files, at)
    units = ColumnUnits(part, at)
    wav = require(part, "wav", at)
    episode = names_of(part, "episode", at, [wav])
    group = names_of(part, "split_group", at, episode)
    conditions = names_of(part, "conditions", at, [])
    gain, channel = part.get("gain"), part.get("channel")
    ends = [_End(job, part, at, key, units) for key in ("source", "receiver")]
    own = [name for name in (gain, channel) if name is not None]
    columns = [*episode, *group, *conditions, wav, *own, *ends[0].columns]
    # A recording with several channels has a receiver for each.
    by_channel = "{channel}" in ends[1].columns
    columns += [name for name in ends[1].columns if name != "{channel}"]
    table.has([*dict.fromkeys(columns)])
    units.refuse_unused()
    known = {path.name: path for path in job.files.values() if path.suffix.lower() == ".wav"}
    for place, row in table:
        told = str(row[wav])
        path = _wav_path(told, known, place)
        channels, rate_hz = _recording(path)
        scaled = 1.0 if gain is None else table.number(place, row, gain)
        names = (table.text(row, columns) for columns in (episode, group, conditions))
        name, of_group, words = names
        wanted = _channels(channels, row.get(channel) if channel else None, path, place)
        if len(wanted) > 1 and not by_channel:
            raise ValueError(
                f"{place}: {path} has {len(channels)} channels; name a column 'channel' that says "
                "which, or make the receiver '{channel}' with a place for each ('1', '2', ...)"
            )
        for number, called in wanted:
            row["{channel}"] = called
            samples = channels[number] * np.float32(scaled)
            source, receiver = (end.of(table, place, row) for end in ends)
            yield _Response(name, of_group, words, source, receiver, samples, rate_hz, place)


def _channels(
    channels: NDArray[np.float32], told: object, path: Path, place: Place
) -> list[tuple[int, str]]:
    """The channels that a row tells of, from 0, and their names; all where it tells of none."""
    count = len(channels)
    words = [] if told is None else cell_text(told).split()
    if not words:
        return [(k, str(k + 1)) for k in range(count)]
    if len(words) == count:
        # As many words as the file has channels are their names.
        return list(enumerate(words))
    if len(words) == 1 and words[0].isdecimal() and 0 < int(words[0]) <= count:
        return [(int(words[0]) - 1, words[0])]
    raise ValueError(
        f"{place}: channels {told!r}, and {path} has {count}; the number of one of them from 1, "
        f"or {count} names are needed"
    )


class _End:
    """Where sources or receivers are: columns of coordinates, or of names with places."""

    def __init__(self, job: Job, part: Map, at: str, key: str, units: ColumnUnits) -> None:
        told = require(part, key, at)
        self.key = key
        self.places: dict[str, Point] | None = None
        places = (job.mapping.get("places") or {}).get(f"{key}s")
        if isinstance(told, list) and len(told) == 3 and places is None:
            self.columns = [str(name) for name in told]
            self._units = [units.unit(column, "length") for column in self.columns]
            return
        self.columns = column_list(part, key, at)
        if places is None:
            raise ValueError(
                f"{at}: {key} is {told!r}: three columns of coordinates, or a column of names "
                f"whose places stand in 'places': '{key}s'"
            )
        where = f"{job.at}: places: {key}s"
        self.places = _listed_places(job, places, where)
        self.where = where

    def of(self, table: MeasuredTable, place: Place, row: dict[str, Any]) -> Point:
        """The place, in the user's axes."""
        if self.places is None:
            told = [table.number(place, row, column) for column in self.columns]
            return np.array([u.one(v) for u, v in zip(self._units, told, strict=True)])
        name = table.text(row, self.columns)
        if name not in self.places:
            raise ValueError(
                f"{place}: {self.key} {name!r} has no place in {self.where}; those there are "
                f"{sorted(self.places)[:12]}"
            )
        return self.places[name]


def _listed_places(job: Job, told: Map, at: str) -> dict[str, Point]:
    """Places by name: in the map, or in a table."""
    if "file" not in told:
        return {name: np.array(point(value, f"{at}: {name}")) for name, value in told.items()}
    for key in told:
        if key not in _PLACES:
            raise ValueError(f"{at}: no key {key!r}; allowed are {list(_PLACES)}")
    table = MeasuredTable(told, job.files, at)
    names = column_list(told, "name", at)
    columns = column_list(told, "position", at)
    if len(columns) != 3 or not names:
        raise ValueError(f"{at}: name and three columns of a position are needed")
    table.has([*names, *columns])
    units = ColumnUnits(told, at)
    lengths = [units.unit(column, "length") for column in columns]
    units.refuse_unused()
    found: dict[str, Point] = {}
    for place, row in table:
        numbers = [table.number(place, row, column) for column in columns]
        there = np.array([u.one(v) for u, v in zip(lengths, numbers, strict=True)])
        name = table.text(row, names)
        if name in found and (found[name] != there).any():
            raise ValueError(f"{place}: {name!r} stands in a row above with another place")
        found[name] = there
    return found


def _wav_path(told: str, known: dict[str, Path], place: Place) -> Path:
    """A WAV file that was given, or one in the table's folder."""
    if told in known:
        return known[told]
    folder = place.path.parent.resolve()
    path = place.path.parent / told
    if not path.resolve().is_relative_to(folder):
        raise ValueError(f"{place}: {told!r} leads out of the table's folder")
    if path.exists() and not path.is_file():
        raise ValueError(f"{place}: {path} is no regular file; a WAV file is expected there")
    if not path.is_file():
        raise ValueError(
            f"{place}: there is no {path}; give the WAV files too, or put them beside the table"
        )
    return path


def _recording(path: Path) -> tuple[NDArray[np.float32], int]:
    try:
        sound, rate_hz = read_wav(path)
    except MeasuredDataError as error:
        raise ValueError(str(error)) from None
    if not sound.any():
        raise ValueError(
            f"{path}: every sample is 0; allowed is an impulse response with sound in it"
        )
    return sound, rate_hz


def _from_sofa(job: Job) -> Iterator[_Response]:
    """The responses of SOFA files; SOFA's own axes are those that the map names."""
    from dwell.measured.tables import files_named

    part, at = job.part("sofa")
    by_receiver = choice(part, "episode", ("measurement", "receiver"), at) == "receiver"
    for path in files_named(require(part, "file", at), job.files, at):
        try:
            room = sofa_rooms.read_room(str(path))
        except MeasuredDataError as error:
            raise ValueError(str(error)) from None
        for row, response in enumerate(room.responses()):
            name = f"{path.stem}/m{response.measurement}"
            name += f"e{response.emitter}" if room.emitters > 1 else ""
            group = name
            name += f"r{response.receiver}" if by_receiver else ""
            place = Place(path, row + 1)
            yield _Response(
                name,
                group,
                "",
                response.source_m,
                response.receiver_m,
                response.samples,
                round(room.rate_hz),
                place,
            )


KIND = Kind("impulse_response", "impulse responses of a room", TEMPLATE, _SCHEMA, 2, _write)
