"""Whether rotations and spins are what the map says: the quaternion's order, body or world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dwell.measured.axes import Axes, product, turned
from dwell.measured.samples import Episode

Array = NDArray[np.float64]
#: Share of the turning that stated spins must leave unexplained to be refuted, and that another
#: reading may leave unexplained to be named.
_WRONG_SHARE, _RIGHT_SHARE = 0.5, 0.25
#: Turning below which a sample says nothing, rad/s, and samples that are needed.
_TELLING_RAD_S = 0.5
_FEWEST = 50
#: Deviation of velocities from differences of positions that is told.
_SCALE_TOLERANCE = 0.05
#: A box lies flat where its vertical is so near to an axis of its own.
_FLAT = np.cos(np.radians(4.0))
#: Episodes that are needed to say how they end.
_FEWEST_ENDS = 6


@dataclass(frozen=True)
class Reading:
    """A way to read the numbers: which quaternion's column is w, and whose axes spins have."""

    wxyz_swapped: bool
    in_body: bool


def misread(quaternions: Array) -> Array:
    """Quaternions, were their columns in the other order: what was called x is w."""
    return quaternions[:, [1, 2, 3, 0]]


def mismatches(
    pairs: Sequence[tuple[Array, Array, float]], *, swapped: bool
) -> dict[bool, float] | None:
    """The share of the turning that spins miss, read as the body's (``True``) and the world's.

    Args:
        pairs: Quaternions of an episode, its spins, and the time between samples.
        swapped: Whether the quaternions are read in the other order.

    Returns:
        ``None`` where too little turns.
    """
    left = {True: 0.0, False: 0.0}
    total, count = 0.0, 0
    for quaternions, spins, step_s in pairs:
        q = misread(quaternions) if swapped else quaternions
        if len(q) < 3:
            continue
        between = product(q[2:], q[:-2] * [-1.0, -1.0, -1.0, 1.0])
        between = np.where(between[:, 3:] < 0.0, -between, between)
        sine = np.linalg.norm(between[:, :3], axis=1)
        angle = 2.0 * np.arctan2(sine, between[:, 3])
        rate = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0) / (2.0 * step_s)
        shown = between[:, :3] * rate[:, None]
        stated, middle = spins[1:-1], q[1:-1]
        telling = (np.linalg.norm(shown, axis=1) >= _TELLING_RAD_S) & ~np.isnan(stated).any(axis=1)
        shown, stated, middle = shown[telling], stated[telling], middle[telling]
        count += len(shown)
        total += float((shown**2).sum())
        left[True] += float(((turned(middle, stated) - shown) ** 2).sum())
        left[False] += float(((stated - shown) ** 2).sum())
    if count < _FEWEST or total == 0.0:
        return None
    return {frame: float(np.sqrt(value / total)) for frame, value in left.items()}


def readings(pairs: Sequence[tuple[Array, Array, float]]) -> dict[Reading, float]:
    """The share of the turning that each reading leaves unexplained; empty: too little turns."""
    found = {}
    for swapped in (False, True):
        shares = mismatches(pairs, swapped=swapped)
        for in_body, share in (shares or {}).items():
            found[Reading(swapped, in_body)] = share
    return found


def speed_note(episodes: Sequence[Episode], rate_hz: float) -> str | None:
    """What velocities say of the scales of clock and lengths; ``None`` where they agree."""
    along = shown_square = 0.0
    for episode in episodes:
        place, stated = episode.values[:, :3], episode.values[1:-1, 7:10]
        if len(place) < 3:
            continue
        shown = (place[2:] - place[:-2]) * (0.5 * rate_hz)
        known = ~np.isnan(stated).any(axis=1)
        along += float((stated[known] * shown[known]).sum())
        shown_square += float((shown[known] ** 2).sum())
    if shown_square == 0.0 or not np.isfinite([along, shown_square]).all():
        return None
    if abs(along / shown_square - 1.0) < _SCALE_TOLERANCE:
        return None
    return (
        f"velocities are {along / shown_square:.3f} times what positions and rate_hz show: is the "
        "scale of the clock or of lengths off?"
    )


def lying_flat(ends: Array, up: Array) -> float:
    """The share of rotations under which a box lies on one of its faces. Shape (n, 4)."""
    axes = [turned(ends, np.broadcast_to(axis, (len(ends), 3))) for axis in np.eye(3)]
    height = np.abs(np.stack([own @ up for own in axes], axis=1)).max(axis=1)
    return float((height >= _FLAT).mean())


def check(
    episodes: Sequence[Episode],
    table: str,
    quaternion: Sequence[str],
    spin: Sequence[str],
    frame: str | None,
    axes: Axes,
    rate_hz: float,
) -> None:
    """Refuses rotations that another reading explains, and says which.

    Raises:
        ValueError: The stated order or frame contradicts the data, and another fits.
    """
    x, y, z, w = quaternion
    other = f'"quaternion_xyzw": {[y, z, w, x]!r}'.replace("'", '"')
    if spin and rate_hz > 0:
        pairs = [(e.values[:, 3:7], e.values[:, 10:13], 1.0 / rate_hz) for e in episodes]
        shares = readings(pairs) if episodes and episodes[0].values.shape[1] > 7 else {}
        stated = Reading(wxyz_swapped=False, in_body=frame == "body")
        if shares and shares[stated] > _WRONG_SHARE:
            best = min(shares, key=lambda reading: shares[reading])
            if best != stated and shares[best] <= _RIGHT_SHARE:
                write = []
                if best.wxyz_swapped:
                    write.append(f"{other} in the map's table: the first of them is w")
                if best.in_body != stated.in_body:
                    meant = "body" if best.in_body else "world"
                    write.append(f'"angular_velocity": "{meant}" in the map\'s poses')
                raise ValueError(
                    f"{table}: {', '.join(spin)} against differences of the quaternions: the share "
                    f"that disagrees is {shares[stated]:.2f}, and {shares[best]:.2f} with "
                    f"{' and '.join(write)}"
                )
        return
    # Without spins, rest tells: a box comes to lie on a face.
    ends = np.stack([e.values[-1, 3:7] for e in episodes]) if episodes else np.zeros((0, 4))
    if len(ends) < _FEWEST_ENDS:
        return
    up = axes.matrix[1]
    now, then = lying_flat(ends, up), lying_flat(misread(ends), up)
    if now < 0.3 and then > 0.8:
        raise ValueError(
            f"{table}: columns {', '.join(quaternion)}: at the ends of {now:.0%} of the episodes "
            f"the body lies on one of its sides, and of {then:.0%} if the first is w; write "
            f"{other} in the map's table"
        )
