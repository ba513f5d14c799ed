"""The follower of PiedPiper that goes by its ears."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell.ears_policy import woodworth_itd_s
from dwell.floor_chart import FloorChart
from dwell.follow_policy import SENSORS, FollowByEars
from dwell.pettingzoo import parallel_env
from dwell.place_belief import PlaceBelief
from dwell.sound_ranging import Pose, dry_signal, known_sounds
from dwell.sound_ways import apparent_places

RATE_HZ, SAMPLES = 16_000, 800
PLACE = np.array([1.5, 1.0])


def arriving(named: str, steps: int, yaw_rad: float) -> list[NDArray[np.float64]]:
    """Frames at both ears of who stands at the start, of a sound at ``PLACE`` without any room."""
    dry = dry_signal(named, RATE_HZ)
    far_m = float(np.hypot(*PLACE))
    azimuth_rad = np.array([np.arctan2(PLACE[1], PLACE[0]) - yaw_rad])
    itd_s = float(woodworth_itd_s(azimuth_rad)[0])
    times = np.arange(steps * SAMPLES, dtype=np.float64)
    ears = []
    for side in (-0.5, 0.5):
        at = times - (far_m / 343.0 + side * itd_s) * RATE_HZ
        # An ear in the shadow of the head hears less.
        gain = 10.0 ** (-side * 9.0 * np.sin(azimuth_rad[0]) / 20.0) / far_m
        sound = np.interp(at % len(dry), np.arange(len(dry) + 1), np.append(dry, dry[0]))
        ears.append(gain * np.where(at < 0.0, 0.0, sound))
    noise = np.random.default_rng(5).normal(scale=0.02, size=(2, len(times)))
    both = np.stack(ears) + noise
    return [both[:, k * SAMPLES : (k + 1) * SAMPLES] for k in range(steps)]


@pytest.mark.parametrize(
    ("named", "off_m"),
    [("kettle", 0.4), ("radio", 0.4), ("television", 0.4), ("alarm", 0.8), ("phone", 1.0)],
)
def test_a_sound_is_placed_by_its_arrivals(named: str, off_m: float) -> None:
    """In the free field, by a head that looks into two directions: front and back differ.

    How tones begin is noticed a little later in rooms, for which the delay is corrected.
    """
    belief = PlaceBelief()
    for yaw_rad in (0.0, 1.2):
        hears = known_sounds(named, RATE_HZ, SAMPLES)
        for k, window in enumerate(arriving(named, 28, yaw_rad)):
            for one in hears:
                one.add(window, Pose(np.zeros(2), yaw_rad))
                told = one.likelihood(belief.cells) if k % 6 == 0 else None
                if told is not None:
                    belief.heard(told)
    place, sure = belief.best()
    assert np.hypot(*(place - PLACE)) < off_m, place
    assert sure > 0.5


def test_nothing_is_known_of_a_sound_that_pauses() -> None:
    """Of six seconds a phone rings two."""
    (broad, _) = known_sounds("phone", RATE_HZ, SAMPLES)
    told = []
    for _ in range(120):
        broad.add(np.zeros((2, SAMPLES)), Pose(np.zeros(2), 0.0))
        told.append(broad.likelihood(np.ones((1, 2))) is not None)
    assert 30 < sum(told) < 60
    assert not any(told[60:120])


def test_belief_goes_on_as_who_walks() -> None:
    belief = PlaceBelief()
    for step in range(0, 60, 3):
        belief.walked(3)
        place = np.array([0.045 * step, 0.0])
        away = np.hypot(*(belief.cells - place).T)
        belief.heard(4.0 * np.exp(-0.5 * (away / 0.3) ** 2))
    last, sure = belief.best(1.0)
    assert np.hypot(*(last - [0.045 * 57, 0.0])) < 0.4
    assert sure > 0.8
    # Nothing is heard for a second: it goes on ahead rather than back, and is less sure.
    for _ in range(6):
        belief.walked(3)
    later, less = belief.best(1.0)
    assert later[0] > last[0] + 0.1
    assert less < sure


def test_places_behind_a_wall_are_heard_where_the_way_begins() -> None:
    """A wall ahead with a gap at the left: the way leads around its end."""
    axis = np.arange(-4.0, 4.01, 0.25)
    cells = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
    wall = (np.abs(cells[..., 0] - 2.0) < 0.1) & (cells[..., 1] < 1.1)
    azimuths = np.arange(0.0, 2.0 * np.pi, np.deg2rad(1.0))
    ends = np.where(np.cos(azimuths) > 1e-6, 2.0 / np.maximum(np.cos(azimuths), 1e-6), 10.0)
    far = np.where(ends * np.sin(azimuths) < 1.1, ends, 10.0)
    apparent, seen = apparent_places(np.zeros(2), cells, (azimuths, far), wall)
    at = np.argwhere((cells[..., 0] == 3.5) & (cells[..., 1] == 0.0))[0]
    place = apparent[tuple(at)]
    corner = np.array([2.0, 1.25])
    way_m = float(np.hypot(*corner) + np.hypot(*(np.array([3.5, 0.0]) - corner)))
    assert not seen[tuple(at)]
    assert abs(float(np.hypot(*place)) - way_m) < 0.15 * way_m
    assert abs(float(np.arctan2(place[1], place[0]) - np.arctan2(*corner[::-1]))) < 0.3
    # What is seen is where it is.
    at = np.argwhere((cells[..., 0] == 1.0) & (cells[..., 1] == 2.0))[0]
    assert seen[tuple(at)]
    assert np.array_equal(apparent[tuple(at)], [1.0, 2.0])


class Rooms:
    """Two rooms in a box, with a gap in the wall between them; axes ahead and left."""

    WALLS = np.array(
        [
            [[-2.0, -2.0], [4.0, -2.0]],
            [[4.0, -2.0], [4.0, 2.0]],
            [[4.0, 2.0], [-2.0, 2.0]],
            [[-2.0, 2.0], [-2.0, -2.0]],
            [[1.0, -2.0], [1.0, 0.8]],
        ]
    )

    def ranges(self, place: NDArray[Any], yaw_rad: float) -> NDArray[np.float64]:
        """Where the rays of the policy's ``lidar`` end, (ring, beam) m: on walls or the floor."""
        settings = SENSORS["lidar"]
        beams = settings["beams"]
        azimuths = yaw_rad - np.pi + 2.0 * np.pi * np.arange(beams) / beams
        level = np.full(beams, np.inf)
        for start, end in self.WALLS:
            along = end - start
            for k, azimuth in enumerate(azimuths):
                ray = np.array([np.cos(azimuth), np.sin(azimuth)])
                det = ray[0] * -along[1] + ray[1] * along[0]
                if abs(det) < 1e-9:
                    continue
                way = start - place
                far = (way[0] * -along[1] + way[1] * along[0]) / det
                part = (ray[0] * way[1] - ray[1] * way[0]) / det
                if far > 0.0 and -1e-9 <= part <= 1.0 + 1e-9:
                    level[k] = min(level[k], far)
        rows = []
        for elevation_deg in settings["elevations_deg"]:
            rise = np.deg2rad(elevation_deg)
            found = level / np.cos(rise)
            if rise < 0.0:
                found = np.minimum(found, 0.5 / np.sin(-rise))
            rows.append(np.minimum(found, 10.0))
        return np.array(rows)


def test_a_way_leads_through_the_gap_of_a_wall_that_was_seen() -> None:
    rooms, chart = Rooms(), FloorChart()
    place, goal = np.array([0.0, -1.0]), np.array([2.5, -1.0])
    path = [place]
    for step in range(120):
        chart.add(place, 0.3 * step, rooms.ranges(place, 0.3 * step), SENSORS)
        way = chart.way(place, goal, step)
        if way is None:
            break
        place = place + way / np.hypot(*way) * min(0.1, float(np.hypot(*way)))
        path.append(place)
    assert np.hypot(*(path[-1] - goal)) < 0.4
    crossed = [b for a, b in itertools.pairwise(path) if a[0] < 1.0 <= b[0]]
    assert len(crossed) == 1
    # Not through the wall, and not within a body's radius of its end, but for half a cell.
    assert crossed[0][1] > 0.8 + 0.2 - 0.05


@pytest.mark.parametrize("edge_m", [0.6, 100.0])
def test_where_no_floor_is_seen_nobody_goes(edge_m: float) -> None:
    """A floor that ends 0.6 m ahead, or does not, and nothing else in sight."""
    chart, place = FloorChart(), np.zeros(2)
    settings = SENSORS["lidar"]
    azimuths = -np.pi + 2.0 * np.pi * np.arange(settings["beams"]) / settings["beams"]
    for step in range(60):
        ranges = np.full((len(settings["elevations_deg"]), settings["beams"]), 10.0)
        for ring, elevation_deg in enumerate(settings["elevations_deg"]):
            if elevation_deg < 0.0:
                down = np.deg2rad(-elevation_deg)
                ends_m = place[0] + 0.5 / np.tan(down) * np.cos(azimuths)
                ranges[ring, ends_m < edge_m] = 0.5 / np.sin(down)
        chart.add(place, 0.0, ranges, SENSORS)
        way = chart.way(place, np.array([3.0, 0.0]), step)
        if way is not None:
            place = place + 0.1 * way / max(float(np.hypot(*way)), 0.1)
        assert place[0] < edge_m
    assert bool(place[0] > 2.0) is (edge_m > 1.0)


def observation(**more: object) -> dict[str, Any]:
    rings, beams = len(SENSORS["lidar"]["elevations_deg"]), SENSORS["lidar"]["beams"]
    return {
        "audio": np.zeros((2, SAMPLES), np.float32),
        "instruction": "Go near the kettle.",
        "gps": np.zeros(2, np.float32),
        "compass": np.zeros(1, np.float32),
        "lidar": np.full((rings, beams), 3.0, np.float32),
        **more,
    }


def test_the_deaf_follower_searches_and_never_stops() -> None:
    policy = FollowByEars()
    policy.reset(observation())
    went = 0
    for _ in range(80):
        action = policy.act(observation())
        went += bool(action[:2].any())
        # Nothing of at least 0.05 would say stop.
        assert np.abs(action).max() >= 0.05
    assert went > 20
    # What it knows is what it does not hear beside it.
    assert policy.belief.best()[1] < 0.1


def test_what_names_no_sound_is_refused() -> None:
    for text in ("Go.", "Go near the piano.", ""):
        with pytest.raises(dwell.ConfigError, match="names a sound"):
            FollowByEars().reset(observation(instruction=text))


@pytest.mark.slow
def test_with_ears_it_is_nearer_than_without() -> None:
    """In four episodes of the apartment; what it reaches in many houses is on the task's page."""

    def following(*, deaf: bool) -> list[float]:
        leader = {"scripted": True, "sensors": []}
        env = parallel_env(
            "PiedPiper",
            agents={
                "follower": {"sensors": SENSORS, "action_mode": "velocity"},
                "one": leader,
                "other": leader,
            },
            houses="builtin:apartment",
            task_settings={"steps": 400},
        )
        policy, shares = FollowByEars(), []
        for seed in range(4):
            observations, _ = env.reset(seed=seed)
            silence = np.zeros((2, SAMPLES), np.float32)
            for begins in (True, False):
                while begins or env.agents:
                    seen = observations["follower"]
                    seen = {**seen, "audio": silence} if deaf else seen
                    if begins:
                        policy.reset(seen)
                        break
                    observations, *_, infos = env.step({"follower": policy.act(seen)})
            shares.append(float(infos["follower"]["following"]))
        return shares

    hears, deaf = following(deaf=False), following(deaf=True)
    assert np.mean(hears) > np.mean(deaf) + 0.1, (hears, deaf)
