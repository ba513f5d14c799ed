"""``dwell ir SCENE.json``: every impulse response of a measured room, as the scorers read them."""

from __future__ import annotations

import argparse
import difflib
import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dwell import ConfigError
from dwell.arguments import finite_number, integer_in_range
from dwell.cli.common import ProgressBar, print_json, refuse_other_suffix
from dwell.files import MAX_TEXT_BYTES, atomic_write, check_writable, read, read_json
from dwell.listening import Receiver

# Receivers this near are one array, of at most so many microphones.
_MAX_ARRAY_SIZE_M = 0.5
_MAX_MICROPHONES = 128
#: What responses may last.
_DURATION_S = (0.02, 20.0)
#: Of the air: the usual value, the least and the largest, and the unit.
_AIR = {
    "temperature_c": (20.0, -40.0, 60.0, "°C"),
    "humidity_pct": (50.0, 0.0, 100.0, "%"),
    "pressure_pa": (101_325.0, 30_000.0, 200_000.0, "Pa"),
}


@dataclass(frozen=True)
class MeasuredRoom:
    """The content of a scene file beside its walls. ``docs/formats/measured-room.md``."""

    path: Path
    rate_hz: int
    duration_s: float
    air: dict[str, float]
    sources: dict[str, tuple[float, float, float]]
    receivers: dict[str, tuple[float, float, float]]

    @classmethod
    def read(cls, path: Path) -> MeasuredRoom:
        """Reads a scene file.

        Raises:
            ValueError: A field is not what it must be; it names the field.
        """
        file = read_json(path)
        if not isinstance(file, dict):
            raise ValueError(f"{path}: expected an object, found {type(file).__name__}")
        air = _object(path, "air", file.get("air", {}))
        if unknown := sorted(set(air) - set(_AIR)):
            raise ValueError(f"{path}: air: expected {', '.join(_AIR)}, found {unknown[0]!r}")
        return cls(
            path=path,
            rate_hz=integer_in_range(f"{path}: fs", file.get("fs", 48000), low=8000, high=192_000),
            duration_s=_within(
                f"{path}: duration_s", file.get("duration_s", 2.0), *_DURATION_S, "s"
            ),
            air={
                name: _within(f"{path}: air.{name}", air.get(name, usual), low, high, unit)
                for name, (usual, low, high, unit) in _AIR.items()
            },
            sources=_places(path, "sources", file),
            receivers=_places(path, "receivers", file),
        )

    def config(self) -> dict[str, Any]:
        """Its rate, duration and air, as ``AcousticScene`` takes them."""
        return {
            "rate_hz": self.rate_hz,
            "max_duration_s": self.duration_s,
            "air": {
                "temperature_c": self.air["temperature_c"],
                "humidity_pct": self.air["humidity_pct"],
                "pressure_kpa": self.air["pressure_pa"] / 1000.0,
            },
        }


def is_measured_room(house: str) -> bool:
    """Returns whether a HOUSE string names a scene file with materials and receivers."""
    path = Path(house)
    if path.suffix.lower() != ".json" or not path.is_file():
        return False
    if path.stat().st_size > MAX_TEXT_BYTES:
        return False
    text = read(path)
    # One of the two lists may have its name misspelt, which the reader then says.
    has_places = b'"receivers"' in text or b'"sources"' in text
    has_walls = b'"mesh"' in text or b'"shoebox"' in text
    return b'"materials"' in text and has_places and has_walls


def _within(name: str, value: object, low: float, high: float, unit: str) -> float:
    """A number of a range, told by the file's own name for it."""
    found = finite_number(name, value)
    if not low <= found <= high:
        raise ValueError(f"{name} is {found:g}; allowed is {low:g} to {high:g} {unit}")
    return found


def run(args: argparse.Namespace) -> int:
    """Computes all responses, writes them, and prints what they took."""
    from dwell.acoustics import AcousticScene

    refuse_other_suffix(args.out, ".npz")
    if args.out is not None:
        check_writable(args.out)
    room = MeasuredRoom.read(Path(args.house))
    sources = _picked("--sources", room.sources, args.sources)
    receivers = _picked("--receivers", room.receivers, args.receivers)
    started = time.perf_counter()
    try:
        scene = AcousticScene(
            args.house,
            laws=args.laws,
            rays=args.rays,
            image_order=args.image_order,
            **room.config(),
        )
    except ConfigError as error:
        # Rate, duration and air are the file's.
        raise ConfigError(f"{room.path}: {error}") from None
    built = time.perf_counter()
    length = round(room.duration_s * room.rate_hz)
    responses = np.zeros((len(sources), len(receivers), length), np.float32)
    groups = group_microphones(list(receivers.values()))
    bar, pairs = ProgressBar(), len(sources) * len(receivers)
    for i, source in enumerate(sources.values()):
        heard = scene.impulse_responses(
            source, [group.receiver for group in groups], seed=args.seed, threads=args.threads
        )
        for group, response in zip(groups, heard, strict=True):
            used = min(response.shape[1], length)
            responses[i, group.members, :used] = response[:, :used]
        bar((i + 1) / len(sources), f"{i + 1} of {len(sources)} sources")
    took = time.perf_counter() - built
    if args.out:
        with atomic_write(args.out) as path, path.open("wb") as out:
            np.savez_compressed(out, ir=responses, fs=np.int64(room.rate_hz))
    print_json(
        {
            "peer": "dwell",
            "scene": Path(args.house).stem,
            "sources": list(sources),
            "receivers": list(receivers),
            "fs": room.rate_hz,
            "samples": length,
            "rays": args.rays,
            "order": args.image_order,
            "threads": args.threads,
            "build_s": round(built - started, 4),
            "ir_s": round(took, 4),
            "ir_s_per_pair": round(took / max(pairs, 1), 4),
            "max_rss_mb": _resident_mb(),
            "out": str(args.out) if args.out else None,
        }
    )
    return 0


@dataclass(frozen=True)
class MicrophoneGroup:
    """Receivers that are heard as one array, and which they are among all."""

    members: list[int]
    receiver: Receiver


def group_microphones(places: list[tuple[float, float, float]]) -> list[MicrophoneGroup]:
    """Receivers near each other as arrays, whose tails then differ as a real array's do.

    Each joins the first group whose first member is within 0.5 m and that has less than 128.
    """
    members: list[list[int]] = []
    for k, place in enumerate(places):
        near = (
            group
            for group in members
            if math.dist(places[group[0]], place) <= _MAX_ARRAY_SIZE_M
            and len(group) < _MAX_MICROPHONES
        )
        group = next(near, None)
        if group is None:
            members.append([k])
        else:
            group.append(k)
    groups = []
    for group in members:
        centre = [sum(places[k][axis] for k in group) / len(group) for axis in range(3)]
        around = [[places[k][axis] - centre[axis] for axis in range(3)] for k in group]
        alone = Receiver.omni(places[group[0]])
        groups.append(
            MicrophoneGroup(group, Receiver.array(centre, around) if len(group) > 1 else alone)
        )
    return groups


def _resident_mb() -> float | None:
    try:
        import resource
    except ImportError:  # Windows has none.
        return None
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1)


def _object(path: Path, field: str, value: object) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    raise ValueError(f"{path}: {field}: expected an object, found {type(value).__name__}")


def _places(path: Path, field: str, file: dict[str, Any]) -> dict[str, tuple[float, float, float]]:
    """Places by id in the house's axes: (x, y, z) with z up becomes (x, z, -y)."""
    rows = file.get(field)
    near = difflib.get_close_matches(field, [name for name in file if name != field], 1)
    if rows is None and near:
        raise ValueError(f"{path}: {field}: missing; {near[0]!r} is nearly its name")
    if not isinstance(rows, list) or not rows:
        raise ValueError(f"{path}: {field}: expected a list of id and pos, found {rows!r:.60}")
    places: dict[str, tuple[float, float, float]] = {}
    for k, row in enumerate(rows):
        at = f"{path}: {field}[{k}]"
        known = _object(path, f"{field}[{k}]", row)
        name, pos = known.get("id"), known.get("pos")
        if not isinstance(name, str) or name in places:
            raise ValueError(f"{at}.id: expected a name of its own, found {name!r}")
        if not isinstance(pos, list) or len(pos) != 3:
            raise ValueError(f"{at}.pos: expected [x, y, z] in metres, found {pos!r}")
        x, y, z = (finite_number(f"{at}.pos", number) for number in pos)
        places[name] = (x, z, -y)
    return places


def _picked(
    option: str, places: dict[str, tuple[float, float, float]], names: str | None
) -> dict[str, tuple[float, float, float]]:
    if names is None:
        return places
    wanted = [name for name in names.split(",") if name]
    unknown = [name for name in wanted if name not in places]
    if unknown or not wanted:
        raise ValueError(
            f"{option}: no {', '.join(unknown) or names!r}; there are {', '.join(places)}"
        )
    return {name: place for name, place in places.items() if name in wanted}
