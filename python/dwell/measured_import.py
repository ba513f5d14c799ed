"""Tables of measurements (CSV; Parquet with pyarrow) into the bundle that calibration reads."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from dwell import csv_values
from dwell.arguments import finite_number
from dwell.files import make_folder, open_file, read_json
from dwell.measured_draft import BundleDraft
from dwell.measured_templates import TEMPLATES

CsvRow = dict[str, Any]

#: Of episodes that are left out, so many names are told.
MAX_LISTED = 10
#: A table has at most so many bytes, as for the reader of bundles.
_MAX_TABLE_BYTES = 256 * 2**20


def import_files(
    files: list[Path], map_file: Path, out: Path, progress: Callable[[float, str], None]
) -> dict[str, Any]:
    """Writes the bundle ``out`` whole, or nothing.

    Raises:
        ValueError: A map or a table that cannot be used; the message names file, column and row.
        FileExistsError: ``out`` is there already.
    """
    if os.path.lexists(out):
        found = "is there already" if out.exists() else "is a link that leads to nothing"
        raise FileExistsError(f"{out}: {found}; remove it or choose another name")
    mapping = read_map(map_file)
    tables: dict[str, Path] = {}
    for path in files:
        other = tables.setdefault(path.name, path)
        if other is not path:
            raise ValueError(f"{path}: has the name of {other}, and maps name tables; rename one")
    make_folder(out.parent)
    part = Path(tempfile.mkdtemp(prefix=f".{out.name}.", dir=out.parent))
    draft = BundleDraft(part, str(map_file))
    try:
        counts = WRITERS[mapping["kind"]](mapping, str(map_file), tables, draft, progress)
        from dwell import DwellError, _native

        progress(0.9, "checking the bundle")
        try:
            counts["episodes"] = _native.check_measured(str(part))
        except DwellError as error:
            raise ValueError(draft.told(str(error), out)) from None
        part.chmod(0o755)
        os.rename(part, out)
    except OSError as error:
        # What people know is the name that they gave.
        named = "" if error.filename is None else os.fsdecode(error.filename)
        if error.errno is not None and (not named or named.startswith(str(part))):
            error.filename, error.filename2 = os.fspath(out), None
        raise
    finally:
        shutil.rmtree(part, ignore_errors=True)
    progress(1.0, "done")
    return counts


def read_map(path: Path) -> CsvRow:
    """The map, with every key known."""
    mapping = read_json(path)
    if not isinstance(mapping, dict):
        raise ValueError(
            f"{path}: found {mapping!r:.60}; an object with the keys of a map is needed"
        )
    kind = mapping.get("kind")
    if not isinstance(kind, str) or kind not in TEMPLATES:
        raise ValueError(f"{path}: kind is {kind!r}; allowed is one of {sorted(TEMPLATES)}")
    known_columns(mapping, TEMPLATES[kind], str(path))
    result: CsvRow = mapping
    return result


#: What a map holds where its template holds such a thing.
_VALUE_KINDS: dict[type, tuple[tuple[type, ...], str]] = {
    str: ((str,), "text"),
    float: ((int, float), "a number"),
    list: ((list,), "a list"),
    dict: ((dict,), "an object"),
}


def known_columns(found: CsvRow, template: CsvRow, at: str) -> None:
    """Refuses keys that the template lacks."""
    for key, value in found.items():
        if key not in template:
            raise ValueError(f"{at}: no key {key!r}; allowed are {list(template)}")
        if isinstance(template[key], dict) and key != "channels" and value is not None:
            if not isinstance(value, dict):
                raise ValueError(f"{at}: {key} is {value!r:.60}; an object is needed")
            known_columns(value, template[key], f"{at}: {key}")
        kinds, expected = _VALUE_KINDS.get(type(template[key]), ((object,), ""))
        if value is not None and (isinstance(value, bool) or not isinstance(value, kinds)):
            raise ValueError(f"{at}: {key} is {value!r:.60}; {expected} is needed")


def require_columns(mapping: Mapping[str, Any], key: str, at: str) -> Any:  # noqa: ANN401 - any JSON value
    """A key that must be there."""
    if mapping.get(key) is None:
        raise ValueError(f"{at}: {key!r} is missing")
    return mapping[key]


class MeasuredTable:
    """A table's rows, with their places."""

    def __init__(self, part: Mapping[str, Any], tables: Mapping[str, Path], at: str) -> None:
        """Finds the file that the map names among those that were given."""
        name = require_columns(part, "file", at)
        if name not in tables:
            raise ValueError(f"{at}: file {name!r} was not given; given are {sorted(tables)}")
        self.path = tables[name]
        #: The row that was read last, from 1.
        self.row = 0
        self.delimiter = ","
        if self.path.suffix == ".csv":
            self.delimiter = csv_values.delimiter_of(head_of(self.path))
        self.columns, self._rows = open_table(self.path, self.delimiter)

    def __iter__(self) -> Iterator[tuple[str, CsvRow]]:
        """Places and rows."""
        for number, row in self._rows:
            self.row = number
            yield f"{self.path} row {number}", row

    def has(self, names: list[str]) -> None:
        """Refuses columns that are not there."""
        csv_values.require_unique_columns(self.path, self.columns, names)

    def number(self, at: str, row: CsvRow, column: str) -> float:
        """A finite number in a column."""
        return csv_values.parse_cell_number(at, row, column, self.delimiter)

    def numbers(self, at: str, row: CsvRow, columns: list[str]) -> list[float]:
        """Several columns."""
        return [self.number(at, row, column) for column in columns]


def open_table(path: Path, delimiter: str) -> tuple[list[str], Iterator[tuple[int, CsvRow]]]:
    """Columns and rows, counted from 1, of a CSV or Parquet file."""
    if path.suffix == ".parquet":
        try:
            import pyarrow.parquet as parquet
        except ModuleNotFoundError:
            raise ModuleNotFoundError(
                f"{path}: Parquet needs pyarrow; pip install 'dwell[data]'"
            ) from None
        with open_file(path, _MAX_TABLE_BYTES) as file, parquet.ParquetFile(file) as table:
            return list(table.schema_arrow.names), parquet_rows(path)
    if path.suffix != ".csv":
        raise ValueError(f"{path}: {path.suffix or 'no suffix'}; .csv and .parquet are read")
    try:
        head = next(csv.reader([head_of(path)], delimiter=delimiter), [])
    except csv.Error as error:
        raise ValueError(f"{path} line 1: {error}") from None
    columns = [name.strip() for name in head]
    return columns, csv_rows(path, columns, delimiter)


def parquet_rows(path: Path) -> Iterator[tuple[int, CsvRow]]:
    """The rows of a Parquet file, counted from 1."""
    import pyarrow.parquet as parquet

    with open_file(path, _MAX_TABLE_BYTES) as file, parquet.ParquetFile(file) as table:
        batches = (row for batch in table.iter_batches() for row in batch.to_pylist())
        yield from enumerate(batches, start=1)


def open_csv(path: Path) -> io.TextIOWrapper:
    """A CSV file, to be read as text."""
    return io.TextIOWrapper(open_file(path, _MAX_TABLE_BYTES), encoding="utf-8-sig", newline="")


def head_of(path: Path) -> str:
    """The first line of a CSV file."""
    try:
        with open_csv(path) as file:
            return file.readline()
    except UnicodeDecodeError as error:
        raise csv_values.encoding_error(path, error) from None


def csv_rows(path: Path, columns: list[str], delimiter: str) -> Iterator[tuple[int, CsvRow]]:
    """The rows of a CSV file below its head, counted from 1."""
    try:
        with open_csv(path) as file:
            reader = csv.reader(file, delimiter=delimiter)
            rows = (row for row in reader if row)
            for number, row in enumerate(itertools.islice(rows, 1, None), start=1):
                if len(row) != len(columns):
                    raise ValueError(
                        f"{path} row {number}: {len(row)} cells, and the head has {len(columns)}: "
                        f"a cell {'is missing' if len(row) < len(columns) else 'too many'} "
                        f"({delimiter.join(row)[:80]!r})"
                    )
                yield number, dict(zip(columns, row, strict=True))
    except csv.Error as error:
        raise ValueError(f"{path} line {reader.line_num}: {error}") from None
    except UnicodeDecodeError as error:
        raise csv_values.encoding_error(path, error) from None


def unit_scale(part: CsvRow, key: str, at: str) -> float:
    """The SI value of one unit of a column; 1 where the map does not say."""
    value = part.get(key)
    found = 1.0 if value is None else finite_number(f"{at}: {key}", value)
    if found == 0:
        raise ValueError(f"{at}: {key} is {value!r}; a finite number other than 0 is needed")
    return found


def seconds_per_unit(part: CsvRow, at: str) -> float:
    """The seconds of one unit of a clock's column; clocks go forwards."""
    found = unit_scale(part, "seconds_per_unit", at)
    if found < 0:
        raise ValueError(
            f"{at}: seconds_per_unit is {part['seconds_per_unit']!r}; a finite number above 0 is "
            "needed"
        )
    return found


def to_y_up(vector: list[float], up: str) -> list[float]:
    """A vector of a world whose vertical is ``up`` in the engine's, whose is y."""
    x, y, z = vector
    return [x, z, -y] if up == "z" else [x, y, z]


def rotation_to_y_up(q: list[float], up: str) -> list[float]:
    """World from body (x, y, z, w) where ``up`` is vertical: -90 degrees about x go before it."""
    if up != "z":
        return q
    x, y, z, w = q
    half = math.sqrt(0.5)
    return [half * (x - w), half * (y + z), half * (z - y), half * (w + x)]


def columns_of(part: CsvRow, key: str, count: int, at: str) -> list[str]:
    """The names of several columns."""
    found = require_columns(part, key, at)
    if not isinstance(found, list) or len(found) != count:
        raise ValueError(f"{at}: {key} is {found!r}; {count} names of columns are needed")
    return [str(name) for name in found]


def episode_name(value: object) -> str:
    """An episode's name."""
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


def format_single(value: float) -> str:
    """A number with nine digits, as many as single precision has."""
    return f"{value:.9g}"


def write_common(
    mapping: CsvRow,
    at: str,
    draft: BundleDraft,
    scene: CsvRow,
    more: CsvRow,
    groups: dict[str, str],
    conditions: Mapping[str, str] | None = None,
) -> None:
    """The manifest and the list of episodes."""
    g_m_s2 = mapping.get("g_m_s2")
    manifest = {
        "version": 3 if mapping["kind"] == "drive" else 2,
        "title": mapping.get("title") or "measured",
        "licence": mapping.get("licence") or "unknown",
        "kind": mapping["kind"],
        "scene": {
            "environment": {
                "g_m_s2": None if g_m_s2 is None else finite_number(f"{at}: g_m_s2", g_m_s2)
            },
            **scene,
        },
        "notes": mapping.get("notes") or "",
        **more,
    }
    draft.fields["scene.environment."] = f"{at}: "
    (draft.folder / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n", "utf-8")
    with draft.table("episodes.csv", "episode,split_group,conditions") as write:
        for episode, group in groups.items():
            write([episode, group, (conditions or {}).get(episode, "")])


def pose_bundle(
    mapping: CsvRow,
    at: str,
    tables: Mapping[str, Path],
    draft: BundleDraft,
    progress: Callable[[float, str], None],
) -> dict[str, Any]:
    """Poses of a body, with their starts."""
    up = mapping.get("up", "y")
    if up not in ("y", "z"):
        raise ValueError(f"{at}: up is {up!r}; allowed is 'y' or 'z'")
    part, here = require_columns(mapping, "table", at), f"{at}: table"
    body, form = require_columns(mapping, "body", at), require_columns(mapping, "poses", at)
    table = MeasuredTable(part, tables, here)
    place = columns_of(part, "position", 3, here)
    quaternion = columns_of(part, "quaternion_xyzw", 4, here)
    rates = [
        columns_of(part, key, 3, here) if part.get(key) else []
        for key in ("velocity", "angular_velocity")
    ]
    episode, clock = require_columns(part, "episode", here), require_columns(part, "t_s", here)
    group = part.get("split_group") or episode
    table.has([episode, group, clock, *place, *quaternion, *rates[0], *rates[1]])
    times = csv_values.TimeParser(clock, seconds_per_unit(part, here))
    metres = unit_scale(part, "metres_per_unit", here)
    radians = unit_scale(part, "radians_per_unit", here)
    in_body = form.get("angular_velocity") == "body"
    groups: dict[str, str] = {}
    head = "episode,t_s,entity,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz"
    rows = 0
    draft.measured(table, clock, episode)
    draft.fields |= {"scene.bodies[0].": f"{at}: body.", "scene.board.": f"{at}: board."}
    origin = pose_origin(up, [place, *rates]) | {"t_s": [clock], "episode": [episode]}
    with draft.table("poses.csv", head, table, origin) as write:
        for where, row in table:
            name = episode_name(row[episode])
            groups.setdefault(name, episode_name(row[group]))
            draft.begins(name)
            position = [metres * value for value in table.numbers(where, row, place)]
            rotation = table.numbers(where, row, quaternion)
            values = [*to_y_up(position, up), *rotation_to_y_up(rotation, up)]
            if rates[0] and rates[1]:
                speed = [metres * value for value in table.numbers(where, row, rates[0])]
                spin = [radians * value for value in table.numbers(where, row, rates[1])]
                values += [*to_y_up(speed, up), *(spin if in_body else to_y_up(spin, up))]
            told = [format_single(value) for value in values]
            told += [""] * (13 - len(told))
            stamp = times.stamp(where, name, table.number(where, row, clock))
            write([name, stamp, str(body.get("name")), *told])
            rows += 1
            if rows % 4096 == 0:
                progress(0.1, f"{rows} rows of {table.path.name}")
    if mapping.get("starts"):
        progress(0.7, "starts")
        units = (metres, radians)
        write_starts(mapping["starts"], f"{at}: starts", tables, draft, (up, in_body), units)
    scene = {"bodies": [body], "board": require_columns(mapping, "board", at)}
    write_common(mapping, at, draft, scene, {"poses": form}, groups)
    return {"rows": rows, "episodes": len(groups), "left_out": 0}


def pose_origin(up: str, columns: list[list[str]]) -> dict[str, list[str]]:
    """The user's columns of a pose's coordinates, by the bundle's names for them."""
    order = (0, 2, 1) if up == "z" else (0, 1, 2)
    fields = (("x", "y", "z"), ("vx", "vy", "vz"))
    return {
        name: [own[k]]
        for names, own in zip(fields, columns, strict=False)
        for name, k in zip(names, order, strict=True)
        if own
    }


def write_starts(
    part: CsvRow,
    at: str,
    tables: Mapping[str, Path],
    draft: BundleDraft,
    frames: tuple[str, bool],
    units: tuple[float, float],
) -> None:
    """The starts of roll-outs of the episodes; units are those of the table."""
    (up, in_body), (metres, radians) = frames, units
    table = MeasuredTable(part, tables, at)
    linear = columns_of(part, "velocity", 3, at)
    angular = columns_of(part, "angular_velocity", 3, at)
    episode, sample = require_columns(part, "episode", at), require_columns(part, "sample", at)
    table.has([episode, sample, *linear, *angular])
    origin = {"episode": [episode], "sample": [sample]}
    with draft.table("starts.csv", "episode,sample,vx,vy,vz,wx,wy,wz", table, origin) as write:
        for where, row in table:
            speed = [metres * value for value in table.numbers(where, row, linear)]
            spin = [radians * value for value in table.numbers(where, row, angular)]
            values = [*to_y_up(speed, up), *(spin if in_body else to_y_up(spin, up))]
            count = str(int(table.number(where, row, sample)))
            write([episode_name(row[episode]), count, *(format_single(value) for value in values)])


def flight_bundle(
    mapping: CsvRow,
    at: str,
    tables: Mapping[str, Path],
    draft: BundleDraft,
    progress: Callable[[float, str], None],
) -> dict[str, Any]:
    """Flights of balls; episodes whose ball has no mass or diameter are left out."""
    part, here = require_columns(mapping, "table", at), f"{at}: table"
    about, there = require_columns(mapping, "bodies", at), f"{at}: bodies"
    names = [
        require_columns(about, key, there) for key in ("episode", "name", "mass_kg", "diameter_m")
    ]
    listed = MeasuredTable(about, tables, there)
    listed.has(names)
    bodies: dict[str, CsvRow] = {}
    body_of: dict[str, str] = {}
    for where, row in listed:
        if not row[names[2]] or not row[names[3]] or row[names[2]] in ("nan", "NaN"):
            continue
        body = episode_name(row[names[1]])
        mass, diameter = (listed.number(where, row, name) for name in names[2:])
        found = {"name": body, "mass_kg": mass, "radius_m": 0.5 * diameter}
        if body not in bodies:
            field = f"scene.bodies[{len(bodies)}]."
            draft.fields[f"{field}mass_kg"] = f"{where}: column {names[2]!r}"
            draft.fields[f"{field}radius_m"] = f"{where}: half of column {names[3]!r}"
            draft.fields[f"{field}name"] = f"{where}: column {names[1]!r}"
        known = bodies.setdefault(body, found)
        if known != found:
            raise ValueError(
                f"{where}: {body!r} has {mass} kg and {diameter} m across, and in a row above "
                f"{known['mass_kg']} kg and {2.0 * known['radius_m']} m; give each body a name "
                "of its own, or correct the row"
            )
        name = episode_name(row[names[0]])
        if body_of.setdefault(name, body) != body:
            raise ValueError(
                f"{where}: episode {name!r} has the body {body!r}, and in a row above "
                f"{body_of[name]!r}; an episode has one body"
            )
    if not bodies:
        raise ValueError(
            f"{listed.path}: no row has both {names[2]!r} (kg) and {names[3]!r} (m); flights of "
            "bodies without them are left out: fill them in"
        )
    table = MeasuredTable(part, tables, here)
    channels = require_columns(part, "channels", here)
    for channel, column in channels.items():
        if not isinstance(column, str):
            raise ValueError(f"{here}: channels.{channel} is {column!r:.60}; text is needed")
    episode, clock = require_columns(part, "episode", here), require_columns(part, "t_s", here)
    group = part.get("split_group") or episode
    table.has([episode, group, clock, *channels.values()])
    times = csv_values.TimeParser(clock, seconds_per_unit(part, here))
    metres = unit_scale(part, "metres_per_unit", here)
    groups: dict[str, str] = {}
    left_out: dict[str, None] = {}
    rows = 0
    draft.measured(table, clock, episode)
    origin = {"t_s": [clock], "episode": [episode], "value": [*channels.values()]}
    origin |= {axis: [column] for axis, column in channels.items()}
    head = "episode,t_s,entity,channel,value"
    with draft.table("trajectory.csv", head, table, origin) as write:
        for where, row in table:
            name = episode_name(row[episode])
            if name not in body_of:
                left_out[name] = None
                continue
            groups.setdefault(name, episode_name(row[group]))
            draft.begins(name)
            stamp = times.stamp(where, name, table.number(where, row, clock))
            for channel, column in channels.items():
                value = metres * table.number(where, row, column)
                write([name, stamp, body_of[name], channel, format_single(value)])
            rows += 1
    if left_out and not rows:
        raise ValueError(
            f"{table.path}: episodes are called {sorted(left_out)[:3]} in column {episode!r}, and "
            f"{sorted(body_of)[:3]} in column {names[0]!r} of {listed.path}; write the same names"
        )
    progress(0.7, f"{rows} rows of {table.path.name}")
    told = [
        {"name": channel, "unit": "m", "clock": "tracker", "noise_sd": None} for channel in channels
    ]
    scene = {"bodies": list(bodies.values())}
    write_common(mapping, at, draft, scene, {"channels": told}, groups)
    return {
        "rows": rows,
        "episodes": len(groups),
        "left_out": len(left_out),
        **({"left_out_episodes": [*left_out][:MAX_LISTED]} if left_out else {}),
    }


def drive_bundle(
    mapping: CsvRow,
    at: str,
    tables: Mapping[str, Path],
    draft: BundleDraft,
    progress: Callable[[float, str], None],
) -> dict[str, Any]:
    """Drives of a robot on two wheels, with the sessions and paths that a second table lists."""
    part, here = require_columns(mapping, "table", at), f"{at}: table"
    base, listing = (
        dict(require_columns(mapping, "base", at)),
        require_columns(mapping, "episodes", at),
    )
    ticks = require_columns(base, "ticks_per_turn", f"{at}: base")
    if not isinstance(ticks, int | float) or not ticks > 0:
        raise ValueError(f"{at}: base: ticks_per_turn is {ticks!r}; a number above 0 is needed")
    rad_per_tick = 2.0 * math.pi / base.pop("ticks_per_turn")
    names = [
        require_columns(listing, key, f"{at}: episodes")
        for key in ("episode", "split_group", "conditions")
    ]
    listed = MeasuredTable(listing, tables, f"{at}: episodes")
    listed.has(names)
    rows_of: dict[str, CsvRow] = {}
    for where, row in listed:
        name = episode_name(row[names[0]])
        if rows_of.setdefault(name, row) != row:
            raise ValueError(f"{where}: episode {name!r} is listed twice, with other values")
    table = MeasuredTable(part, tables, here)
    place = columns_of(part, "position", 2, here)
    heading, clock = require_columns(part, "heading_rad", here), require_columns(part, "t_s", here)
    wheels = [require_columns(part, key, here) for key in ("ticks_left", "ticks_right")]
    episode = require_columns(part, "episode", here)
    table.has([episode, clock, *place, heading, *wheels])
    times = csv_values.TimeParser(clock, seconds_per_unit(part, here))
    metres = unit_scale(part, "metres_per_unit", here)
    radians = unit_scale(part, "radians_per_unit", here)
    groups: dict[str, str] = {}
    rows = 0
    head = "episode,t_s,x,y,heading,left_rad,right_rad"
    draft.measured(table, clock, episode)
    draft.fields["scene.base."] = f"{at}: base."
    origin = {
        "episode": [episode],
        "t_s": [clock],
        "x": place[:1],
        "y": place[1:],
        "heading": [heading],
        "left_rad": wheels[:1],
        "right_rad": wheels[1:],
    }
    with draft.table("drive.csv", head, table, origin) as write:
        for where, row in table:
            name = episode_name(row[episode])
            if name not in rows_of:
                raise ValueError(
                    f"{where}: episode {name!r} is not in {listed.path}, whose column {names[0]!r} "
                    f"has {sorted(rows_of)[:3]}"
                )
            groups.setdefault(name, episode_name(rows_of[name][names[1]]))
            draft.begins(name)
            seen = [metres * value for value in table.numbers(where, row, place)]
            seen.append(radians * table.number(where, row, heading))
            to_y_up = [rad_per_tick * value for value in table.numbers(where, row, wheels)]
            stamp = times.stamp(where, name, table.number(where, row, clock))
            write([name, stamp, *(format_single(value) for value in [*seen, *to_y_up])])
            rows += 1
            if rows % 4096 == 0:
                progress(0.1, f"{rows} rows of {table.path.name}")
    conditions = {name: episode_name(rows_of[name][names[2]]) for name in groups}
    write_common(mapping, at, draft, {"base": base}, {}, groups, conditions)
    return {"rows": rows, "episodes": len(groups), "left_out": 0}


#: What writes the bundle of each kind of map.
WRITERS = {"pose_trajectory": pose_bundle, "trajectory": flight_bundle, "drive": drive_bundle}
