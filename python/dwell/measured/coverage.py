"""Which states a bundle has recorded, as a picture, and what to record beside them."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dwell import MeasuredDataError, _native
from dwell.arguments import file_path, integer_in_range
from dwell.charts import BACKGROUND_COLOR, TEXT_COLOR, font
from dwell.false_color import scale_colors
from dwell.files import read_json
from dwell.measured.readers import Row, open_table

Array = NDArray[np.float64]
#: Cells of the picture along each axis.
_CELLS = 32
#: Pictures are drawn this much larger and then made smaller, so that edges are smooth.
_SUPERSAMPLING = 2
#: Below so many episodes and groups, little can be held out.
_FEW_EPISODES, _FEW_GROUPS = 12, 4


@dataclass(frozen=True)
class Coverage:
    """The recorded states of a bundle.

    Attributes:
        kind: The bundle's.
        x: A number of each state.
        y: Another one.
        names: What both are, with units.
        advice: What to record, in sentences.
    """

    kind: str
    x: Array
    y: Array
    names: tuple[str, str]
    advice: list[str] = field(default_factory=list)

    @property
    def share(self) -> float:
        """The share of the picture's cells in which something was recorded."""
        return float((self._counts()[0] > 0).mean())

    def _counts(self) -> tuple[Array, Array, Array]:
        x, y = (_span(values) for values in (self.x, self.y))
        return np.histogram2d(self.x, self.y, bins=_CELLS, range=[x, y])

    def picture(self, *, width: int = 640) -> Image.Image:
        """How often each state was recorded: from dark (once) to bright (most).

        Args:
            width: Pixels across, 64 to 8192.

        Raises:
            ConfigError: ``width`` is out of range.
        """
        width = integer_in_range("width", width, low=64, high=8192)
        wide = _SUPERSAMPLING * width
        size = wide // 32
        left, top, edge = 5 * size, 2 * size, wide - 7 * size
        counts, xs, ys = self._counts()
        canvas = Image.new("RGB", (wide, edge + 6 * size), BACKGROUND_COLOR)
        draw = ImageDraw.Draw(canvas)
        level = np.log1p(counts) / max(float(np.log1p(counts).max()), 1e-9)
        colors = scale_colors(0.15 + 0.85 * level)
        for i, j in zip(*np.nonzero(counts), strict=True):
            x0, x1 = (left + edge * k // _CELLS for k in (int(i), int(i) + 1))
            y0, y1 = (top + edge - edge * k // _CELLS for k in (int(j), int(j) + 1))
            red, green, blue = (int(part) for part in colors[i, j])
            draw.rectangle((x0, y1, x1 - 1, y0 - 1), fill=(red, green, blue))
        draw.rectangle((left, top, left + edge, top + edge), outline=TEXT_COLOR)
        for part in (0.0, 0.5, 1.0):
            x, y = (float(own[0] + part * (own[-1] - own[0])) for own in (xs, ys))
            below = (left + part * edge, top + edge + size)
            draw.text(below, f"{x:.3g}", TEXT_COLOR, font(size), "mm")
            beside = (left - size // 2, top + (1.0 - part) * edge)
            draw.text(beside, f"{y:.3g}", TEXT_COLOR, font(size), "rm")
        middle = (left + edge / 2, top + edge + 3 * size)
        draw.text(middle, self.names[0], TEXT_COLOR, font(size), "mm")
        draw.text((left, top - size), self.names[1], TEXT_COLOR, font(size), "ls")
        smaller = (width, canvas.height // _SUPERSAMPLING)
        return canvas.resize(smaller, Image.Resampling.BOX)


def coverage(measured: str | os.PathLike[str]) -> Coverage:
    """Looks at the states that a bundle has recorded.

    Args:
        measured: The folder ``NAME.measured``.

    Raises:
        MeasuredDataError: The bundle cannot be used, or holds impulse responses, which have no
            states.
    """
    folder = Path(file_path("measured", measured))
    _native.check_measured(str(folder))
    kind = read_json(folder / "manifest.json")["kind"]
    if kind not in _STATES:
        raise MeasuredDataError(f"{folder}: kind is {kind!r}; states are those of {list(_STATES)}")
    listed = _rows(folder / "episodes.csv")
    groups = {row["split_group"] for row in listed}
    found: Coverage = _STATES[kind](folder)
    if len(listed) < _FEW_EPISODES:
        found.advice.append(
            f"{len(listed)} episodes: record {_FEW_EPISODES} or more, so that some can be held out"
        )
    if len(groups) < _FEW_GROUPS:
        found.advice.append(
            f"{len(groups)} groups: record in {_FEW_GROUPS} sessions or more, or with other things"
        )
    if not found.advice:
        found.advice.append("nothing is missing that is known of")
    return found


def _rows(path: Path) -> list[Row]:
    return [row for _, row in open_table(path).rows]


def _by_episode(rows: list[Row], columns: list[str]) -> list[Array]:
    """Numbers of each episode by time, the times first; empty cells are not numbers."""
    found: dict[str, list[list[float]]] = {}
    for row in rows:
        cells = [row[name] for name in ("t_s", *columns)]
        found.setdefault(row["episode"], []).append([float(c) if c else np.nan for c in cells])
    tables = [np.array(own) for own in found.values()]
    return [own[np.argsort(own[:, 0], kind="stable")] for own in tables]


def _span(values: Array) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _rates(table: Array, column: int) -> Array:
    """Central differences of a column, per second."""
    if len(table) < 3:
        return np.zeros(len(table))
    rates: Array = np.gradient(table[:, column], table[:, 0])
    return rates


def _flights(folder: Path) -> Coverage:
    rows = _rows(folder / "trajectory.csv")
    heights = _by_episode([row for row in rows if row["channel"] == "y"], ["value"])
    speeds: dict[tuple[str, str], Array] = {}
    for channel in ("x", "y", "z"):
        own = [row for row in rows if row["channel"] == channel]
        for k, table in enumerate(_by_episode(own, ["value"])):
            speeds[str(k), channel] = _rates(table, 1) ** 2
    x, y, fastest = [], [], []
    for k, table in enumerate(heights):
        parts = [speeds[str(k), c] for c in ("x", "y", "z") if (str(k), c) in speeds]
        parts = [part for part in parts if len(part) == len(table)]
        speed = np.sqrt(np.sum(parts, axis=0))
        x.append(speed)
        y.append(table[:, 1])
        fastest.append(float(np.median(speed)))
    advice = []
    if max(fastest) < 1.5 * min(fastest):
        advice.append(
            f"all flights have nearly one speed ({min(fastest):.2g} to {max(fastest):.2g} m/s): "
            "throw some twice as hard, since drag grows with the speed's square and a wrong scale "
            "does not"
        )
    return Coverage(
        "trajectory", np.concatenate(x), np.concatenate(y), ("speed, m/s", "height, m"), advice
    )


def _poses(folder: Path) -> Coverage:
    columns = ["x", "y", "z", "qx", "qy", "qz", "qw"]
    tables = _by_episode(_rows(folder / "poses.csv"), columns)
    speed, spin = [], []
    for table in tables:
        speed.append(np.linalg.norm([_rates(table, k) for k in (1, 2, 3)], axis=0))
        q = table[:, 4:8]
        # A quaternion and its negative are one rotation.
        apart = [np.linalg.norm(q[1:] - sign * q[:-1], axis=1) for sign in (1.0, -1.0)]
        turns = 4.0 * np.arcsin(np.minimum(*apart).clip(0.0, 2.0) / 2.0) / np.diff(table[:, 0])
        spin.append(np.append(turns, turns[-1:]))
    top = [float(np.max(own)) for own in spin]
    rests = sum(float(own[-1]) < 0.05 for own in speed)
    advice = []
    if max(top) < 1.0:
        advice.append("nothing turns by more than 1 rad/s: throw some with spin")
    if rests < len(tables) // 2:
        advice.append(
            f"{rests} of {len(tables)} episodes end at rest: record until the body lies still, "
            "which tells its friction and the tracker's noise"
        )
    names = ("speed, m/s", "spin, rad/s")
    return Coverage("pose_trajectory", np.concatenate(speed), np.concatenate(spin), names, advice)


def _drives(folder: Path) -> Coverage:
    tables = _by_episode(_rows(folder / "drive.csv"), ["x", "y", "heading"])
    speed, turn = [], []
    for table in tables:
        along = np.cos(table[:, 3]) * _rates(table, 1) + np.sin(table[:, 3]) * _rates(table, 2)
        speed.append(along)
        unwrapped = np.column_stack([table[:, 0], np.unwrap(table[:, 3])])
        turn.append(_rates(unwrapped, 1))
    x, y = np.concatenate(speed), np.concatenate(turn)
    left, right = float((y > 0.05).mean()), float((y < -0.05).mean())
    advice = []
    if min(left, right) < 0.2 * max(left, right):
        way = "right" if left > right else "left"
        advice.append(
            f"it turns to the {way} in {min(left, right):.0%} of the time, to the other side in "
            f"{max(left, right):.0%}: drive the same paths the other way round, which tells wheels "
            "of two sizes from a wrong wheel base"
        )
    if max(left, right) < 0.05:
        advice.append("it hardly turns: drive squares both ways, and turns on the spot")
    if not (x < -0.02).any():
        advice.append("it never drives backwards: do, if it ever will")
    return Coverage("drive", x, y, ("speed, m/s", "turning to the left, rad/s"), advice)


def _servos(folder: Path) -> Coverage:
    tables = _by_episode(_rows(folder / "trajectory.csv"), ["value"])
    commands = _by_episode(_rows(folder / "command.csv"), ["value"])
    x = np.concatenate([table[:, 1] for table in tables])
    y = np.concatenate([_rates(table, 1) for table in tables])
    steps = [np.diff(table[:, 1]) for table in commands]
    every = np.concatenate(steps) if steps else np.zeros(0)
    reversals = sum(int((own[1:] * own[:-1] < 0).sum()) for own in steps)
    advice = []
    if reversals < 2 * len(commands):
        advice.append(
            f"the target turns back {reversals} times in {len(commands)} episodes: move to and "
            "fro, since backlash shows at reversals alone"
        )
    sizes = np.abs(every[every != 0.0])
    if len(sizes) and sizes.max() < 3.0 * sizes.min():
        advice.append(
            f"all steps of the target have nearly one size ({sizes.min():.2g} to "
            f"{sizes.max():.2g} rad): add some of a third, where friction holds, and larger ones, "
            "where the torque ends"
        )
    return Coverage("servo", x, y, ("position, rad", "speed, rad/s"), advice)


_STATES: dict[str, Callable[[Path], Coverage]] = {
    "trajectory": _flights,
    "pose_trajectory": _poses,
    "drive": _drives,
    "servo": _servos,
}
