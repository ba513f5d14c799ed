"""Clips: a walk with pictures and sound, and what was seen and heard when."""

from __future__ import annotations

import dataclasses
import json
import math
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import number_in_range
from dwell.camera import Camera
from dwell.files import atomic_folder

if TYPE_CHECKING:
    from dwell.world import World

__all__ = ["Clip", "walk", "write_clip"]

#: How fast the walker goes and turns at most, and the angle from which it only turns.
_SPEED_M_S, _TURN_RAD_S, _ONLY_TURNS_RAD = 0.8, 1.5, 0.6
#: Nearer than this a point of the way is passed.
_PASSED_M = 0.3
#: Pictures a second, and pixels of 256 x 256 from which a thing is seen.
_PICTURES_HZ, _LEAST_PIXELS = 2, 200
#: When the sound is on, as shares of the clip.
_SOUNDS = (0.2, 0.8)
#: Level at the louder ear from which the sound is heard in a tenth of a second, dB SPL.
_HEARD_DB, _WINDOW_S, _REFERENCE_PA = 25.0, 0.1, 2e-5
#: The least way that is worth a walk, m.
_LEAST_WAY_M = 2.0


@dataclasses.dataclass
class Clip:
    """A walk.

    Attributes:
        row: ``house``, ``duration_s``, ``pictures`` (``time_s``, ``position``, ``yaw_deg``),
            ``seen`` (``id``, ``name``, ``from_s``, ``to_s``: from the first to the last picture of
            a stretch in which it has 200 of 256 x 256 pixels), ``sounds`` (``signal``, ``object``,
            ``from_s``, ``to_s``), ``heard`` (``signal``, ``object``, ``from_s``, ``to_s``:
            stretches in which it alone has 25 dB SPL at the louder ear).
        pictures: Shape (picture, height, width, 3), uint8.
        sound: At two ears, shape (2, sample), Pa.
        rate_hz: Samples a second.
    """

    row: dict[str, Any]
    pictures: NDArray[np.uint8]
    sound: NDArray[np.float32]
    rate_hz: int


def walk(house: str, *, duration_s: float = 5.0, size: int = 256, seed: int = 0) -> Clip:
    """A walk through a house, in which one of its things sounds.

    Args:
        house: A HOUSE string.
        duration_s: 1 to 10 s.
        size: Edges of the pictures, pixels.
        seed: Draws way and sound, with the name of the house.

    Raises:
        ConfigError: Nobody can walk in the house, or nothing in it sounds.
    """
    from dwell.world import World

    duration_s = number_in_range("duration_s", duration_s, 1.0, 10.0, "s")
    world = World(house, agents=1)
    rng = np.random.default_rng([seed, zlib.crc32(house.encode())])
    way = _way(world, rng)
    sources = [row for row in world.sounds() if row.get("object") and "signal" in row["sound"]]
    if not sources:
        raise ConfigError(f"{house}: nothing in it sounds")
    source = sources[int(rng.integers(len(sources)))]
    start = world.snapshot()
    first = _Walk(world, way, duration_s, size)
    first.go(source)
    # The same once more in silence: the difference is what the source adds at the ears.
    world.restore(start)
    silent = _Walk(world, way, duration_s, 0)
    silent.go(None)
    what = {"signal": source["sound"]["signal"], "object": source["object"]}
    row = {
        "house": house,
        "duration_s": duration_s,
        "pictures": first.rows,
        "seen": first.seen(),
        "sounds": [{**what, **first.span}],
        "heard": [
            {**what, **one}
            for one in _heard(first.sound - silent.sound, world.sound_rate_hz, first.span)
        ],
    }
    return Clip(row, np.stack(first.pictures), first.sound, world.sound_rate_hz)


class _Walk:
    """A walk along a way, with pictures unless their size is 0."""

    def __init__(
        self, world: World, way: NDArray[np.float32], duration_s: float, size: int
    ) -> None:
        self._world, self._way, self._size = world, way, size
        self._step_s = world.samples_a_step / world.sound_rate_hz
        self._steps = round(duration_s / self._step_s)
        self._on, self._off = (round(share * self._steps) for share in _SOUNDS)
        self.span = {
            "from_s": round(self._on * self._step_s, 3),
            "to_s": round(self._off * self._step_s, 3),
        }
        self.pictures: list[NDArray[np.uint8]] = []
        self.rows: list[dict[str, Any]] = []
        self._shown: list[set[int]] = []
        self.sound = np.zeros((2, 0), np.float32)

    def go(self, source: dict[str, Any] | None) -> None:
        """Walks, while a source sounds for a time, or none."""
        world, way = self._world, self._way
        ahead = way[1] - way[0]
        world.place_agent(way[0].tolist(), math.degrees(math.atan2(-ahead[0], -ahead[2])))
        samples = self._steps * world.samples_a_step
        world.listen(samples)
        every = round(1.0 / (_PICTURES_HZ * self._step_s))
        passed, handle = 1, -1
        for k in range(self._steps):
            if source is not None and k == self._on:
                handle = world.play(
                    source["sound"]["signal"],
                    at=source["object"],
                    level_db=source["level_db"],
                    loop=True,
                )
            if source is not None and k == self._off:
                world.stop_sound(handle)
            agent = world.agents()[0]
            if self._size and k % every == 0:
                self._look(agent, k * self._step_s)
            passed, control = _steer(agent, way, passed)
            world.step([control])
        self.sound = world.listen(samples)

    def _look(self, agent: dict[str, Any], time_s: float) -> None:
        lens = Camera(width=self._size, height=self._size, fov_deg=90.0, max_objects=256)
        seen = self._world.render(agent=0, camera=lens, channels=["rgb", "visible_objects"])
        self.pictures.append(seen["rgb"])
        least = _LEAST_PIXELS * (self._size / 256.0) ** 2
        self._shown.append({int(row[0]) for row in seen["visible_objects"] if row[1] >= least})
        place = [round(float(x), 3) for x in agent["position"]]
        row = {"time_s": round(time_s, 3), "position": place}
        self.rows.append({**row, "yaw_deg": round(agent["yaw_deg"], 1)})

    def seen(self) -> list[dict[str, Any]]:
        """The stretches of pictures in which each thing is seen."""
        names = {row["id"]: row["name"] for row in self._world.objects()}
        times = [row["time_s"] for row in self.rows]
        return [
            {"id": number, "name": names[number], "from_s": times[p], "to_s": times[q]}
            for number in sorted(set().union(*self._shown) & set(names))
            for p, q in _stretches([number in ids for ids in self._shown])
        ]


def write_clip(clip: Clip, out: Path) -> None:
    """Writes ``clip.json``, ``sound.wav`` and ``000.png`` ... into a new folder, whole or not.

    Raises:
        FileExistsError: It is there.
    """
    from PIL import Image

    from dwell.sounds import write_wav

    with atomic_folder(out) as draft:
        for k, picture in enumerate(clip.pictures):
            Image.fromarray(picture).save(draft / f"{k:03}.png", compress_level=1)
        write_wav(draft / "sound.wav", clip.sound, clip.rate_hz)
        (draft / "clip.json").write_text(json.dumps(clip.row, indent=1) + "\n", "utf-8")


def _way(world: World, rng: np.random.Generator) -> NDArray[np.float32]:
    """The points of a way that is worth walking."""
    grid = world.navigation()
    for _ in range(50):
        start, goal = grid.sample(int(rng.integers(2**31)), 2)
        route = grid.route(start, goal)
        if route is not None and route.length_m >= _LEAST_WAY_M and len(route.points) >= 2:
            return np.asarray(route.points, np.float32)
    raise ConfigError(f"{world.house.name}: no way of {_LEAST_WAY_M:g} m in it")


def _steer(
    agent: dict[str, Any], way: NDArray[np.float32], passed: int
) -> tuple[int, dict[str, float]]:
    """The next point of the way, and the control that leads there."""
    place = np.asarray(agent["position"])
    last = len(way) - 1
    while passed < last and np.linalg.norm((way[passed] - place)[[0, 2]]) < _PASSED_M:
        passed += 1
    dx, _, dz = way[passed] - place
    distance = math.hypot(dx, dz)
    turn = math.remainder(math.atan2(-dx, -dz) - agent["yaw_rad"], math.tau)
    forward = 0.0 if abs(turn) > _ONLY_TURNS_RAD or distance < _PASSED_M else _SPEED_M_S
    rate = 0.0 if distance < _PASSED_M else max(-_TURN_RAD_S, min(_TURN_RAD_S, 4.0 * turn))
    return passed, {"forward_m_s": forward, "yaw_rate_rad_s": rate}


def _stretches(flags: list[bool]) -> list[tuple[int, int]]:
    """The first and last places of each stretch of true ones."""
    found: list[tuple[int, int]] = []
    for k, flag in enumerate(flags):
        if flag and found and found[-1][1] == k - 1:
            found[-1] = (found[-1][0], k)
        elif flag:
            found.append((k, k))
    return found


def _heard(
    sound: NDArray[np.float32], rate_hz: int, span: dict[str, float]
) -> list[dict[str, float]]:
    """Stretches in which a sound is loud enough while it is on."""
    width = round(_WINDOW_S * rate_hz)
    windows = sound[:, : sound.shape[1] // width * width].reshape(2, -1, width)
    rms = np.sqrt((windows.astype(np.float64) ** 2).mean(axis=2)).max(axis=0)
    loud = 20.0 * np.log10(np.maximum(rms, 1e-12) / _REFERENCE_PA) >= _HEARD_DB
    times = np.arange(len(loud)) * _WINDOW_S
    is_on = (times >= span["from_s"]) & (times + _WINDOW_S <= span["to_s"] + 1e-9)
    return [
        {"from_s": round(p * _WINDOW_S, 1), "to_s": round((q + 1) * _WINDOW_S, 1)}
        for p, q in _stretches((loud & is_on).tolist())
    ]
