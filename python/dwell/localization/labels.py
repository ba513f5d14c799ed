"""Labels of sound events in the form of the DCASE challenge: a row for each source and frame."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import file_path, integer_in_range, number_in_range, quoted
from dwell.files import atomic_write, read

#: A frame of labels, s.
FRAME_S = 0.1
#: Rows of a class in a frame: they are paired, in a time that grows with the third power.
MOST_AT_ONCE = 100
#: Frames, classes and sources have 31 bits.
_MAX_NUMBER = 2**31 - 1
#: Farther than any room is long, m.
_MAX_DISTANCE_M = 1e7
#: More than hours of labels have.
_MAX_BYTES = 256 * 2**20
_EXPECTED = "frame, class, source, azimuth, elevation and, if known, distance"


@dataclass(frozen=True)
class Label:
    """Where one source is while one frame lasts.

    Attributes:
        frame: The frame, of 100 ms, from 0.
        class_index: What sounds, a number of the list of classes.
        source: Which source, from 0.
        azimuth_deg: 0 ahead of the array, positive to the left, -180 to 180.
        elevation_deg: Positive up, -90 to 90.
        distance_m: From the array's centre, m; ``None``: not known.
    """

    frame: int
    class_index: int
    source: int
    azimuth_deg: float
    elevation_deg: float
    distance_m: float | None = None


def direction(azimuth_deg: float, elevation_deg: float) -> NDArray[np.float64]:
    """The unit vector (front, left, up) of a direction."""
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    level = math.cos(elevation)
    return np.array([level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation)])


def angles_deg(vector: NDArray[np.float64]) -> tuple[float, float]:
    """Azimuth and elevation of a vector (front, left, up) that is not 0."""
    front, left, up = (float(part) for part in vector)
    return (
        math.degrees(math.atan2(left, front)),
        math.degrees(math.atan2(up, math.hypot(front, left))),
    )


def checked_labels(name: str, labels: object) -> Iterator[Label]:
    """The rows of an argument, of any length, each one that could be written and read.

    Raises:
        ConfigError: One is none.
    """
    if not isinstance(labels, Iterable):
        raise ConfigError(f"{name} is {quoted(labels)}; expected labels")
    for k, row in enumerate(labels):
        if not isinstance(row, Label):
            raise ConfigError(f"{name}[{k}] is {quoted(row)}; expected a Label")
        for field in ("frame", "class_index", "source"):
            integer_in_range(f"{name}[{k}].{field}", getattr(row, field), high=_MAX_NUMBER)
        number_in_range(f"{name}[{k}].azimuth_deg", row.azimuth_deg, -360.0, 360.0, "degrees")
        number_in_range(f"{name}[{k}].elevation_deg", row.elevation_deg, -90.0, 90.0, "degrees")
        if row.distance_m is not None:
            number_in_range(f"{name}[{k}].distance_m", row.distance_m, 0.0, _MAX_DISTANCE_M, "m")
        yield row


def write_labels(path: str | os.PathLike[str], labels: Iterable[Label]) -> None:
    """Writes labels as CSV without a header: angles in degrees to a tenth, distances in cm.

    Raises:
        ConfigError: ``path`` is none, or a row is none that can be read again.
        OSError: The system refuses.
    """
    place, rows = file_path("path", path), []
    for row in sorted(
        checked_labels("labels", labels), key=lambda row: (row.frame, row.source, row.class_index)
    ):
        cells = [f"{row.frame}", f"{row.class_index}", f"{row.source}"]
        cells += [f"{_tenth(row.azimuth_deg)}", f"{_tenth(row.elevation_deg)}"]
        if row.distance_m is not None:
            cells.append(f"{_tenth(100.0 * row.distance_m)}")
        rows.append(",".join(cells) + "\n")
    with atomic_write(place) as draft:
        draft.write_text("".join(rows), "utf-8")


def _tenth(value: float) -> str:
    # Without a negative zero.
    return f"{round(value, 1) + 0.0:.1f}"


def read_labels(
    path: str | os.PathLike[str], *, classes: int | None = None, sources: int | None = None
) -> list[Label]:
    """Reads labels as :func:`write_labels` and the challenge write them: 5 or 6 columns.

    Args:
        path: The file.
        classes: How many classes there are; ``None``: any number.
        sources: How many sources there are; ``None``: any number.

    Raises:
        ConfigError: A row is of another form, a number is out of range, or a frame has more than
            100 rows of a class; the message names file and line.
        OSError: The system refuses, or it is no regular file.
    """
    name = file_path("path", path)
    try:
        text = read(name, _MAX_BYTES).decode()
    except UnicodeDecodeError as error:
        raise ConfigError(f"{name}: byte {error.start} is not UTF-8") from None
    except ValueError as error:
        raise ConfigError(str(error)) from None
    rows: list[Label] = []
    at_once: Counter[tuple[int, int]] = Counter()
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        at = f"{name} line {number}"
        row = _label(at, line)
        for what, found, count in (
            ("class", row.class_index, classes),
            ("source", row.source, sources),
        ):
            if count is not None and found >= count:
                raise ConfigError(f"{at}: {what} is {found}; there are {count}, counted from 0")
        at_once[row.frame, row.class_index] += 1
        if at_once[row.frame, row.class_index] > MOST_AT_ONCE:
            raise ConfigError(f"{at}: {too_many(row)}")
        rows.append(row)
    return rows


def too_many(row: Label) -> str:
    """What is said of more rows of a class in a frame than can be paired."""
    return (
        f"more than {MOST_AT_ONCE} rows of class {row.class_index} in frame {row.frame}; allowed "
        f"are {MOST_AT_ONCE}"
    )


def _label(at: str, line: str) -> Label:
    cells = [cell.strip() for cell in line.split(",")]
    if len(cells) not in (5, 6):
        raise ConfigError(f"{at}: {len(cells)} columns; expected {_EXPECTED}")
    try:
        frame, class_index, source = (int(cell) for cell in cells[:3])
        numbers = [float(cell) for cell in cells[3:]]
    except ValueError:
        raise ConfigError(f"{at}: found {line!r:.80}; expected numbers: {_EXPECTED}") from None
    azimuth, elevation, *distance = numbers
    for what, found in (("frame", frame), ("class", class_index), ("source", source)):
        integer_in_range(f"{at}: {what}", found, high=_MAX_NUMBER)
    # NaN is in no range.
    if not (abs(azimuth) <= 360.0 and abs(elevation) <= 90.0):
        raise ConfigError(
            f"{at}: azimuth {azimuth:g}, elevation {elevation:g}; allowed are -360 to 360 and -90 "
            "to 90 degrees"
        )
    if distance and not 0.0 <= distance[0] <= 100.0 * _MAX_DISTANCE_M:
        allowed = f"0 to {100.0 * _MAX_DISTANCE_M:g} cm"
        raise ConfigError(f"{at}: distance {distance[0]:g}; allowed are {allowed}")
    metres = distance[0] / 100.0 if distance else None
    return Label(frame, class_index, source, azimuth, elevation, metres)
