"""The follower of PiedPiper that goes by its ears."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import _native
from dwell.floor_chart import FloorChart
from dwell.follow_policy import SENSORS, FollowByEars, SoundSeparator
from dwell.pettingzoo import parallel_env

RATE_HZ, SAMPLES = 16_000, 800
SOUNDS = ["radio", "phone", "kettle", "television", "alarm"]


@pytest.mark.parametrize(
    ("named", "other"),
    [("kettle", "alarm"), ("phone", "radio"), ("radio", "kettle"), ("alarm", "television")],
)
def test_the_named_sound_is_taken_out_of_a_mixture(named: str, other: str) -> None:
    """As loud as each other; the components are known, so what is kept and what is left is, too."""
    frames = 60
    own, others = (
        np.asarray(_native.synthesize(name, RATE_HZ, frames * SAMPLES), np.float64)
        for name in (named, other)
    )
    both = SoundSeparator(named, SOUNDS, RATE_HZ, SAMPLES)
    alone = SoundSeparator(named, SOUNDS, RATE_HZ, SAMPLES)
    kept = np.zeros(2)
    before = np.zeros(2)
    for k in range(frames):
        piece = slice(k * SAMPLES, (k + 1) * SAMPLES)
        mixed = np.stack([own[piece] + others[piece]] * 2)
        _, frame = both.filtered(mixed)
        _, of_other = alone.filtered(np.stack([others[piece]] * 2))
        kept += [frame.share * (mixed**2).sum(), of_other.share * (others[piece] ** 2).sum()]
        before += [(own[piece] ** 2).sum(), (others[piece] ** 2).sum()]
    # Of its own energy most is found, of the other's alone little is taken for it.
    assert 0.5 < kept[0] / before[0] / 2.0 < 1.6
    assert kept[1] / before[1] < 0.1 * 2.0


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


def test_the_deaf_follower_goes_nowhere_and_never_stops() -> None:
    policy = FollowByEars()
    policy.reset(observation())
    for _ in range(120):
        action = policy.act(observation())
        assert np.array_equal(action[:2], [0.0, 0.0])
        # Nothing of at least 0.05 would say stop.
        assert abs(action[2]) >= 0.05


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
