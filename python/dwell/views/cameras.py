"""Cameras as a person would hold them, drawn by a seed."""

from __future__ import annotations

import dataclasses
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell.camera import Camera

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dwell.world import World

__all__ = ["HeldCamera", "held_cameras"]

#: Heights of eyes of standing adults above the floor, m: the 5th percentile of women to the 95th
#: of men (S. Pheasant and C. Haslegrave, Bodyspace, 3rd ed., 2006).
_EYE_HEIGHTS_M = (1.41, 1.75)
#: How a picture is tilted, degrees: level to somewhat down.
_PITCHES_DEG = (-20.0, 0.0)
#: Nearer than this nothing may cover more than that share of the picture.
_NEAR_M, _MOST_NEAR = 0.5, 0.2
#: Things in a picture, each of so many pixels of 256 x 256.
_LEAST_THINGS, _LEAST_SHARE = 3, 200.0 / 65_536.0
#: The least part of a picture that things cover: nobody takes a picture of a wall.
_LEAST_COVERED = 0.08
#: The edge of the small pictures by which places are judged, pixels.
_SMALL = 64
#: Places that are tried for each picture.
_TRIES = 30


@dataclasses.dataclass(frozen=True)
class HeldCamera:
    """A camera in somebody's hands; the horizon is level.

    Attributes:
        position: Where it is, m.
        yaw_deg: Where it looks, positive to the left.
        pitch_deg: Positive up.
        eye_height_m: How high it is above where its holder stands.
    """

    position: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float
    eye_height_m: float = 1.6

    def viewer(self) -> dict[str, Any]:
        """As :meth:`dwell.World.holds` takes it."""
        return {
            "position": self.position,
            "yaw_deg": self.yaw_deg,
            "pitch_deg": self.pitch_deg,
        }


def held_cameras(world: World, count: int, seed: int) -> Iterator[HeldCamera]:
    """Cameras in a house: at eye height where one can stand, with three things or more in sight.

    A thing counts from 200 of 256 x 256 pixels. Things cover 8 % of the picture or more, and what
    is nearer than half a metre a fifth at most.

    Args:
        world: The house as it is now.
        count: How many; fewer where no place is found by 30 tries each.
        seed: Draws them, with the name of the house.
    """
    rng = np.random.default_rng([seed, zlib.crc32(world.house.name.encode())])
    tries = _TRIES * count
    places = world.navigation().sample(int(rng.integers(2**31)), tries)
    small = Camera(width=_SMALL, height=_SMALL, fov_deg=90.0, max_objects=1)
    things = [row["id"] for row in world.objects()]
    found = 0
    for place in places:
        height_m, turn, tilt = rng.random(3)
        low, high = _EYE_HEIGHTS_M
        eye = [float(place[0]), float(place[1]) + low + (high - low) * height_m, float(place[2])]
        position = (round(eye[0], 3), round(eye[1], 3), round(eye[2], 3))
        down, level = _PITCHES_DEG
        camera = HeldCamera(
            position,
            round(360.0 * turn - 180.0, 1),
            round(down + (level - down) * tilt, 1),
            round(position[1] - float(place[1]), 3),
        )
        if world.house.native.room_at(position) is None:
            continue
        seen = world.render(**camera.viewer(), camera=small, channels=["depth", "instance"])
        if _is_good(seen, things):
            found += 1
            yield camera
            if found == count:
                return


def _is_good(seen: dict[str, NDArray[Any]], things: list[int]) -> bool:
    """Returns whether a small picture shows enough, and nothing right before the lens."""
    near = float((seen["depth"] < _NEAR_M).mean())
    ids, pixels = np.unique(seen["instance"], return_counts=True)
    is_thing = np.isin(ids, things)
    large = (pixels >= _LEAST_SHARE * _SMALL**2) & is_thing
    covered = float(pixels[is_thing].sum()) / _SMALL**2
    return near <= _MOST_NEAR and covered >= _LEAST_COVERED and int(large.sum()) >= _LEAST_THINGS
