"""What happens in one clip: who listens where, what sounds where and when. Drawn, not yet heard."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.listening import Point
from dwell.localization.draws import Draws
from dwell.localization.pool import Pool, Sound
from dwell.localization.rooms import OpenHouse, near
from dwell.localization.settings import Settings
from dwell.localization.trajectory import Trajectory, seen_from
from dwell.navigation import Navigation

#: Sound travels so far in a second for labels, m.
SPEED_M_S = 343.2
#: Heights of arrays and sources over the floor, m.
_LISTENER_M, _SOURCE_M = (1.0, 1.7), (0.4, 1.8)
#: Speeds of sources and of arrays, m/s, and how fast arrays turn at most, degrees a second.
_SOURCE_SPEED, _LISTENER_SPEED, _TURN_DEG_S = (0.3, 1.5), (0.2, 0.8), 20.0
#: Nobody comes nearer than this, m.
_NEAREST_M = 0.3
#: Places that are tried, and scenes.
_TRIES, _ATTEMPTS = 60, 8


@dataclass(frozen=True)
class SceneSource:
    """One source of a clip.

    Attributes:
        sound: What sounds.
        onset: The sample in which it begins to sound, where it is.
        samples: How many samples it sounds.
        start: Where in its loop it begins, 0 to 1.
        way: Where it is.
        occlusion: What was between it and the array at its onset.
    """

    sound: Sound
    onset: int
    samples: int
    start: float
    way: Trajectory
    occlusion: str


@dataclass(frozen=True)
class Scene:
    """One clip before it is heard.

    Attributes:
        index: Its number in the data set.
        house: The HOUSE string.
        listener: Where the array is, and where it faces.
        sources: What sounds.
        snr_db: Ratio of signal and diffuse noise, dB.
        seed: What rays and noise are drawn from.
    """

    index: int
    house: str
    listener: Trajectory
    sources: tuple[SceneSource, ...]
    snr_db: float
    seed: int

    def to_json(self, classes: list[str]) -> dict[str, Any]:
        """As plain data."""
        return {
            "clip": self.index,
            "house": self.house,
            "snr_db": self.snr_db,
            "seed": self.seed,
            "listener": self.listener.to_json(),
            "sources": [
                {
                    "class": classes[one.sound.class_index],
                    "class_index": one.sound.class_index,
                    "sound": one.sound.name,
                    "level_db": one.sound.level_db,
                    "onset_sample": one.onset,
                    "samples": one.samples,
                    "loop_start": one.start,
                    "occlusion": one.occlusion,
                    "trajectory": one.way.to_json(),
                }
                for one in self.sources
            ],
        }


def draw_scene(opened: OpenHouse, settings: Settings, pool: Pool, index: int) -> Scene:
    """Draws a clip from the data set's seed, its house and its number alone.

    Raises:
        ConfigError: No source can be where it shall be.
        MeasuredDataError: A sound file is none any more.
        OSError: The system refuses to read a sound file.
    """
    why: ConfigError | None = None
    for attempt in range(_ATTEMPTS):
        try:
            scene = _scene(opened, settings, pool, index, attempt)
        except ConfigError as error:
            # Elsewhere in the house there may be a place.
            why = why or error
        else:
            return _sounding(scene, settings, pool)
    raise why or ConfigError(f"{opened.name}: no scene")


def _scene(opened: OpenHouse, settings: Settings, pool: Pool, index: int, attempt: int) -> Scene:
    draws = Draws("localize scene", settings.seed, opened.name, index, attempt)
    foot = _point(draws, opened.listeners)
    listener = _listener(draws, opened, settings, foot)
    count = 1 + draws.below(settings.max_sources)
    sources = [_source(draws, opened, settings, pool, listener) for _ in range(count)]
    snr_db, seed = draws.uniform(*settings.snr_db), draws.below(2**31)
    return Scene(index, opened.name, listener, tuple(sources), snr_db, seed)


def _sounding(scene: Scene, settings: Settings, pool: Pool) -> Scene:
    """The scene with a stretch of each sound in which it sounds while the array hears it."""
    found = []
    for source in scene.sources:
        times_s = np.array((source.onset, source.onset + source.samples)) / settings.rate_hz
        away_m = float(np.linalg.norm(seen_from(scene.listener, source.way, times_s), axis=1).max())
        # What is on its way when the clip ends is not heard.
        late = int(np.ceil(away_m / SPEED_M_S * settings.rate_hz))
        heard = min(source.samples, max(settings.samples - source.onset - late, 1))
        start, samples = pool.stretch(
            source.sound, settings.rate_hz, source.samples, heard, source.start
        )
        found.append(replace(source, start=start, samples=samples))
    return replace(scene, sources=tuple(found))


def _point(draws: Draws, grid: Navigation) -> NDArray[np.float64]:
    points = grid.points()
    found: NDArray[np.float64] = points[draws.below(len(points))].astype(np.float64)
    return found


def _raised(corners: NDArray[np.float64], height_m: float) -> NDArray[np.float64]:
    found: NDArray[np.float64] = np.atleast_2d(corners) + np.array((0.0, height_m, 0.0))
    return found


def _listener(
    draws: Draws, opened: OpenHouse, settings: Settings, foot: NDArray[np.float64]
) -> Trajectory:
    height, yaw = draws.uniform(*_LISTENER_M), draws.uniform(-180.0, 180.0)
    moves = draws.uniform(0.0, 1.0) < settings.moving_listener
    speed, turn = draws.uniform(*_LISTENER_SPEED), draws.uniform(-_TURN_DEG_S, _TURN_DEG_S)
    corners, rate = foot[None], 0.0
    if moves:
        rate = turn
        goals = opened.listeners.points(tuple(map(float, foot))).astype(np.float64)
        goal = goals[draws.below(len(goals))]
        route = opened.listeners.route(tuple(map(float, foot)), tuple(map(float, goal)))
        if route is not None and route.length_m > 0.1:
            corners = route.points.astype(np.float64)
    way = _raised(corners, height)
    return Trajectory.along(way, speed, 0.0, yaw_deg=yaw, yaw_rate_deg_s=rate)


def _source(
    draws: Draws, opened: OpenHouse, settings: Settings, pool: Pool, listener: Trajectory
) -> SceneSource:
    length_s = draws.uniform(min(1.0, settings.duration_s), settings.duration_s)
    onset_s = draws.uniform(0.0, settings.duration_s - length_s)
    start = draws.uniform(0.0, 1.0)
    here = listener.positions(np.array([onset_s]))[0]
    if settings.sounds == "household":
        sound, way = _appliance(draws, opened, settings, pool, here)
    else:
        sound = draws.choice(pool.sounds)
        way = _way(draws, opened, settings, here, listener, onset_s)
    ear: Point = (float(here[0]), float(here[1]), float(here[2]))
    onset = int(onset_s * settings.rate_hz)
    return SceneSource(
        sound,
        onset,
        min(int(length_s * settings.rate_hz), settings.samples - onset),
        start,
        way,
        opened.occlusion(way.points[0], ear),
    )


def _appliance(
    draws: Draws, opened: OpenHouse, settings: Settings, pool: Pool, here: NDArray[np.float64]
) -> tuple[Sound, Trajectory]:
    by_name = {sound.name: sound for sound in pool.sounds}
    low, high = settings.distance_m
    rows = [
        (by_name[name], place)
        for name, place in opened.household()
        if name in by_name and low <= float(np.linalg.norm(np.array(place) - here)) <= high
    ]
    if not rows:
        raise ConfigError(
            f"{opened.name}: no appliance that sounds is {low:g} to {high:g} m from the array"
        )
    sound, place = draws.choice(rows)
    return sound, Trajectory((place,), (0.0,))


def _way(
    draws: Draws,
    opened: OpenHouse,
    settings: Settings,
    here: NDArray[np.float64],
    listener: Trajectory,
    onset_s: float,
) -> Trajectory:
    """Where a source is: at a place in sight of the array, or on a way from there."""
    low, high = settings.distance_m
    height = draws.uniform(*_SOURCE_M)
    feet = opened.sources.points().astype(np.float64)
    places = near(_raised(feet, height), here, low, high)
    ear = (float(here[0]), float(here[1]), float(here[2]))
    for _ in range(_TRIES if len(places) else 0):
        place = places[draws.below(len(places))]
        at = (float(place[0]), float(place[1]), float(place[2]))
        if not settings.in_sight or opened.occlusion(at, ear) == "none":
            break
    else:
        raise ConfigError(
            f"{opened.name}: no source can be {low:g} to {high:g} m from an array at "
            f"({ear[0]:g}, {ear[1]:g}, {ear[2]:g}) m" + (" in its sight" * settings.in_sight)
        )
    moves = draws.uniform(0.0, 1.0) < settings.moving
    speed = draws.uniform(*_SOURCE_SPEED)
    still = Trajectory((at,), (0.0,))
    if not moves:
        return still
    foot = (at[0], at[1] - height, at[2])
    goals = opened.sources.points(foot).astype(np.float64)
    for _ in range(8 if len(goals) else 0):
        goal = goals[draws.below(len(goals))]
        route = opened.sources.route(foot, tuple(map(float, goal)))
        if route is None or route.length_m < 0.3:
            continue
        way = Trajectory.along(_raised(route.points.astype(np.float64), height), speed, onset_s)
        times = np.arange(0.0, settings.duration_s, 0.05)
        if np.linalg.norm(seen_from(listener, way, times), axis=1).min() >= _NEAREST_M:
            return way
    return still
