"""The policy ``ears`` hears from where a sound comes, and goes there by its ears alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dwell
from dwell import ConfigError
from dwell.ears_policy import Chart, Ears, what_is_heard, woodworth_itd_s
from dwell.envs import DwellEnv
from dwell.evaluation import differences, evaluate

pytestmark = pytest.mark.usefixtures("open_once")
RATE_HZ = 16000.0
#: One that sounds all the time.
TASK = {"sounds": ["vacuum_cleaner"]}


def test_the_time_difference_of_a_sphere_is_woodworths() -> None:
    # At 90 degrees (pi / 2 + 1) a / c; the same in front and behind; odd.
    side_s = 0.0875 / 343.0 * (np.pi / 2.0 + 1.0)
    assert woodworth_itd_s(np.array([np.pi / 2.0]))[0] == pytest.approx(side_s)
    angles = np.linspace(-1.5, 1.5, 31)
    assert woodworth_itd_s(np.pi - angles) == pytest.approx(woodworth_itd_s(angles), abs=1e-12)
    assert woodworth_itd_s(-angles) == pytest.approx(-woodworth_itd_s(angles))


def plane_waves(azimuths_rad: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Noise that reaches the ears with Woodworth's delay, a window for each azimuth."""
    rng = np.random.default_rng(5)
    size = 4096
    frequencies = np.fft.rfftfreq(size, 1.0 / RATE_HZ)
    windows = []
    for delay_s in woodworth_itd_s(azimuths_rad):
        spectrum = np.fft.rfft(rng.normal(size=size))
        late = np.fft.irfft(spectrum * np.exp(-2j * np.pi * frequencies * delay_s), size)
        windows.append(np.stack([np.fft.irfft(spectrum, size), late])[:, 1000:1800])
    return np.array(windows)


@pytest.mark.parametrize("azimuth_deg", [-150, -80, -20, 0, 35, 120, 180])
def test_a_head_that_turns_tells_front_from_back(azimuth_deg: float) -> None:
    yaws_rad = np.deg2rad(np.linspace(-40.0, 40.0, 9))
    windows = plane_waves(np.deg2rad(azimuth_deg) - yaws_rad)
    found_deg = 5.0 * what_is_heard(windows, yaws_rad, RATE_HZ).response.argmax()
    assert abs((found_deg - azimuth_deg + 180.0) % 360.0 - 180.0) <= 10.0


def test_a_chart_finds_where_bearings_cross() -> None:
    chart, source_m = Chart(), np.array([1.0, -2.0])
    headings_rad = np.deg2rad(np.arange(0.0, 360.0, 5.0))
    for place_m in ([0.0, 0.0], [2.0, 0.0], [0.0, -1.5]):
        right, back = source_m - place_m
        response = np.cos(headings_rad - np.arctan2(-right, -back))
        chart.add(np.array(place_m), response, 1.0)
    _, heading_rad, distance_m = chart.source(np.array([0.0, 0.0]))
    found_m = distance_m * np.array([-np.sin(heading_rad), -np.cos(heading_rad)])
    assert np.hypot(*(found_m - source_m)) < 0.6
    assert chart.source(np.array([1.2, -2.0]))[0] > 0.0
    assert chart.source(np.array([0.0, 0.0]))[0] < 0.0


@pytest.mark.long
def test_it_turns_to_the_side_of_the_source() -> None:
    """In an open room with carpets it faces the source before it walks.

    By chance it would be within 60 degrees in one of three episodes.
    Of 16 episodes that is 12 or more with a chance of less than 0.1 % (binomial).
    """
    room = dwell.House.shoebox((8.0, 3.0, 8.0), substance="carpet")
    env = DwellEnv("AudioNav", houses=room, sensors=["audio"], task_settings=TASK)
    policy, right = Ears(env), 0
    for seed in range(16):
        observation, info = env.reset(seed=seed)
        policy.reset(observation, info)
        source = next(row for row in env.world.sounds() if row["object"] is None)
        here = env.world.agents()[0]
        to = np.subtract(source["position"], here["position"])
        action = policy.act(observation)
        while env.actions()[action] not in ("move_forward", "stop"):
            observation, *_ = env.step(action)
            action = policy.act(observation)
        yaw_rad = env.world.agents()[0]["yaw_rad"]
        error_rad = np.angle(np.exp(1j * (np.arctan2(-to[0], -to[2]) - yaw_rad)))
        right += abs(error_rad) < np.deg2rad(60.0)
    assert right >= 12


@pytest.mark.long
def test_it_plays_by_name_and_the_result_is_verified() -> None:
    given: dict[str, Any] = {
        "task": "AudioNav",
        "houses": "builtin:studio",
        "count": 2,
        "seed": 1,
        "sensors": ["audio"],
        "max_steps": 60,
    }
    result = evaluate("ears", **given)
    assert result["policy"] == "ears"
    assert result["policy_source"] is None
    assert evaluate("ears", **given) == result
    assert differences(result) == []


def test_without_ears_it_is_refused() -> None:
    for sensors in (["gps"], {"audio": {"receiver": {"kind": "mono"}}}):
        env = DwellEnv("AudioNav", houses="builtin:studio", sensors=sensors)
        with pytest.raises(ConfigError, match="ears needs the sensor audio"):
            Ears(env)
