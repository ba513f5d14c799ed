"""Pictures from anywhere, and points on the surfaces that they show.

Nothing here asks a predicate, or uses what the engine's predicates rest on.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import dwell

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Flags = NDArray[np.bool_]
View = tuple[float, float]

#: Where the six cameras around a box look: yaw and pitch in degrees.
SIX_SIDES: tuple[View, ...] = ((0, 0), (90, 0), (180, 0), (-90, 0), (0, -90), (0, 90))


def frame(yaw_deg: float, pitch_deg: float) -> tuple[Floats, Floats, Floats]:
    """Directions to the right, up and ahead of a camera; yaw is positive to the left, 0 is -Z."""
    yaw, pitch = np.deg2rad(yaw_deg), np.deg2rad(pitch_deg)
    ahead = np.array((-np.sin(yaw) * np.cos(pitch), np.sin(pitch), -np.cos(yaw) * np.cos(pitch)))
    right = np.array((np.cos(yaw), 0.0, -np.sin(yaw)))
    return right, np.cross(right, ahead), ahead


def angles_to(direction: Floats) -> View:
    """The yaw and pitch in degrees of a direction."""
    x, y, z = direction
    return float(np.rad2deg(np.arctan2(-x, -z))), float(np.rad2deg(np.arctan2(y, np.hypot(x, z))))


def take(
    world: dwell.World,
    position: Floats,
    view: View,
    camera: dwell.Camera,
    channels: Sequence[str] = ("instance", "depth"),
) -> dict[str, NDArray[Any]]:
    """A picture from anywhere, also from outside of rooms and from within things."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        place = [float(x) for x in position]
        return world.render(
            position=place,
            yaw_deg=view[0],
            pitch_deg=view[1],
            camera=camera,
            channels=list(channels),  # type: ignore[arg-type]
        )


def flat_picture(
    world: dwell.World,
    position: Floats,
    view: View,
    size_m: tuple[float, float],
    pixels: tuple[int, int],
    near_m: float = 1e-4,
) -> tuple[Ints, Floats, Floats]:
    """Ids (row, column), distances along the view and points of an orthographic picture."""
    wide, high = size_m
    camera = dwell.Camera(
        width=pixels[0],
        height=pixels[1],
        near_m=near_m,
        projection={"kind": "orthographic", "width_m": wide, "height_m": high},
    )
    taken = take(world, position, view, camera)
    ids = taken["instance"][..., 0]
    depth = taken["depth"][..., 0].astype(np.float64)
    right, up, ahead = frame(*view)
    across = ((np.arange(pixels[0]) + 0.5) / pixels[0] - 0.5) * wide
    down = (0.5 - (np.arange(pixels[1]) + 0.5) / pixels[1]) * high
    points = (
        position
        + across[None, :, None] * right
        + down[:, None, None] * up
        + depth[..., None] * ahead
    )
    return ids, depth, points


def scan(
    world: dwell.World,
    low: Floats,
    high: Floats,
    spacing_m: float,
    slices: int = 3,
    pad_m: Floats | None = None,
) -> tuple[Ints, Floats]:
    """Ids and points of the surfaces within a box, from its six sides.

    From each side there are ``slices`` pictures that begin one behind another, so that what stands
    before a thing does not hide it, and with ``pad_m`` one more that begins just before where
    the thing should: behind the face of a wall or a floor that it stands at.
    """
    middle, size = (low + high) / 2, high - low
    found_ids: list[Ints] = []
    found: list[Floats] = []
    for view in SIX_SIDES:
        right, up, ahead = frame(*view)
        wide, tall, deep = (float(np.abs(axis) @ size) for axis in (right, up, ahead))
        pixels = (int(np.clip(wide / spacing_m, 4, 96)), int(np.clip(tall / spacing_m, 4, 96)))
        starts = [deep * k / slices + 1e-4 for k in range(slices)]
        if pad_m is not None:
            starts.append(float(np.abs(ahead) @ pad_m) - 0.0015)
        for near in starts:
            ids, depth, points = flat_picture(
                world, middle - ahead * deep / 2, view, (wide, tall), pixels, near
            )
            within = (ids > 0) & (depth <= deep)
            found_ids.append(ids[within])
            found.append(points[within])
    return np.concatenate(found_ids), np.concatenate(found)
