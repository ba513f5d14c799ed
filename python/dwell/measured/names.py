"""What columns are called: names of times and episodes, units in names, triples x, y, z."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from dwell.measured.units import UNITS

#: Units as people write them in names of columns.
_WRITTEN = {
    "sec": "s",
    "secs": "s",
    "seconds": "s",
    "msec": "ms",
    "millis": "ms",
    "usec": "us",
    "µs": "us",
    "nsec": "ns",
    "degrees": "deg",
    "°": "deg",
    "degree": "deg",
    "radians": "rad",
    "rads": "rad/s",
    "rad_s": "rad/s",
    "deg_s": "deg/s",
    "dps": "deg/s",
    "m_s": "m/s",
    "mps": "m/s",
    "meters": "m",
    "metres": "m",
    "inch": "in",
    "grams": "g",
}
_UNITS = {unit for units in UNITS.values() for unit in units} - {"1"}
TIMES = ("header.stamp", "timestamp", "time", "t", "stamp", "log_time", "secs", "clock")
EPISODES = (
    "{group}",
    "episode",
    "episode_index",
    "episode_id",
    "toss",
    "throw",
    "trial",
    "shot",
    "run",
    "drop",
    "recording",
    "take",
    "experiment",
    "demo",
    "drive",
    "test",
    "id",
)
GROUPS = ("split_group", "session", "set", "day", "object", "log")
#: Names of sensors' readings and of what they were told, of a joint.
POSITIONS = ("position", "pos", "present_position", "angle", "q", "joint", "encoder", "measured")
TARGETS = (
    "target",
    "goal",
    "command",
    "cmd",
    "desired",
    "setpoint",
    "reference",
    "action",
    "actions",
)
HEADINGS = ("heading", "theta", "yaw", "psi", "phi")
HEIGHTS = ("height", "altitude", "y", "z", "h")
NAMES = ("ball", "body", "object", "name", "thing")


def unit_in(name: str) -> str | None:
    """The unit that a name ends with: ``t [ms]``, ``x (cm)``, ``height_mm``."""
    found = re.search(r"[\[(]\s*([^\])\d][^\])]*?)\s*[\])]\s*$", name)
    told = found[1] if found else None
    if told is None:
        found = re.search(r"_(rad_s|deg_s|m_s|[a-zµ°]+)$", name.lower())
        told = found[1] if found else None
    if told is None:
        return None
    told = _WRITTEN.get(told.lower(), told.lower())
    return told if told in _UNITS else None


def bare(name: str) -> str:
    """A name without its unit, in small letters."""
    lower = re.sub(r"\s*[\[(][^\])\d][^\])]*[\])]\s*$", "", name.strip()).lower()
    if unit_in(lower) is not None and "_" in lower:
        return re.sub(r"_(rad_s|deg_s|m_s|[a-zµ°]+)$", "", lower)
    return lower


def first_named(columns: Iterable[str], names: Sequence[str]) -> str | None:
    """The column of the first name that is there: alone, else with something about it."""
    by_name: dict[str, str] = {}
    for column in columns:
        by_name.setdefault(bare(column), column)
    for name in names:
        if name in by_name:
            return by_name[name]
    for name in names:
        if len(name) < 3:
            continue
        for known, column in by_name.items():
            if re.search(rf"(^|[^a-z]){re.escape(name)}([^a-z]|$)", known):
                return column
    return None


def triples(columns: Sequence[str]) -> list[list[str]]:
    """Columns that differ in x, y, z, or in 0, 1, 2 at their ends."""
    known = set(columns)
    found: list[list[str]] = []
    for column in columns:
        for place in [k for k, letter in enumerate(column) if letter in "xX"]:
            letters = "xyz" if column[place] == "x" else "XYZ"
            own = [column[:place] + letter + column[place + 1 :] for letter in letters]
            if set(own) <= known:
                found.append(own)
                break
        if column.endswith("[0]"):
            own = [f"{column[:-3]}[{k}]" for k in range(3)]
            if set(own) <= known and f"{column[:-3]}[3]" not in known:
                found.append(own)
    return found


def is_speed(name: str) -> bool:
    """Returns whether a column of a triple is called a velocity."""
    return bool(re.search(r"(^|[^a-z])(v|vel|velocity|linear|speed)([^a-z]|x|$)", bare(name)))


def is_spin(name: str) -> bool:
    """Returns whether a column of a triple is called an angular velocity."""
    return bool(
        re.search(r"(^|[^a-z])(w|omega|ang|angular|gyro|spin|rate)([^a-z]|x|$)", bare(name))
    )


def quaternion(columns: Sequence[str]) -> tuple[list[str], bool] | None:
    """The columns of a quaternion and whether their names say which is w.

    Returns:
        In the order x, y, z, w where names say so, else in the table's order.
    """
    known = set(columns)
    for x, y, z in triples(columns):
        place = next(k for k, (a, b) in enumerate(zip(x, y, strict=True)) if a != b)
        w = x[:place] + ("w" if x[place] == "x" else "W") + x[place + 1 :]
        if w in known:
            return [x, y, z, w], True
    for column in columns:
        stem = column[:-3] if column.endswith("[0]") else None
        for own in (
            [f"{stem}[{k}]" for k in range(4)],
            [re.sub(r"0$", str(k), column) for k in range(4)],
        ):
            if len({*own}) == 4 and set(own) <= known and "q" in bare(column):
                return own, False
    return None


def pair(columns: Sequence[str], words: Sequence[str]) -> list[str] | None:
    """Columns that differ in left and right, and have one of the words in their names."""
    for column in columns:
        for left, right in (("left", "right"), ("_l", "_r"), ("l_", "r_")):
            other = column.replace(left, right)
            if other != column and other in columns and any(w in column.lower() for w in words):
                return [column, other]
    return None
