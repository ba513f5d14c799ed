"""What an array records of a scene: direct, early and late sound, each by itself.

What stands still is convolved with one response. While something moves, the direct sound is read
from the source's signal with the delay that each microphone has at each sample, and filtered by
responses a few centimetres apart; reflections are those of responses further apart, crossfaded:
early ones by pressure, late ones, which are incoherent from place to place, by energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dwell.acoustics import AcousticScene
from dwell.listening import Point
from dwell.localization.convolving import Delayed, add_at, convolved
from dwell.localization.draws import Draws
from dwell.localization.layouts import Layout
from dwell.localization.pool import Pool
from dwell.localization.rooms import OpenHouse
from dwell.localization.scenes import Scene, SceneSource
from dwell.localization.settings import NEW_EARLY, NEW_LATE, Settings
from dwell.localization.trajectory import Trajectory, axes

#: Movement from one response of the direct sound to the next, m and degrees.
_NEW_DIRECT = (0.05, 2.0)
#: Samples before the direct sound that are kept of its response.
_LEAD = 64
#: Delays are reckoned so often, s.
_DELAY_STEP_S = 0.001

_Sound = NDArray[np.float64]


@dataclass
class Recording:
    """What an array records, shape (channel, sample), Pa.

    Attributes:
        layout: The array.
        direct: The direct sound.
        early: Early reflections.
        late: Late reverberation.
        responses: Of each source at its onset: direct, early and late, each (channel, tap).
    """

    layout: Layout
    direct: _Sound
    early: _Sound
    late: _Sound
    responses: list[tuple[_Sound, _Sound, _Sound]]


class Renderer:
    """Records scenes in a house."""

    def __init__(self, opened: OpenHouse, settings: Settings, pool: Pool) -> None:
        """Keeps what all clips share."""
        self._opened, self._settings, self._pool = opened, settings, pool
        kelvin = 273.15 + float(opened.full.config["air"]["temperature_c"])
        # ISO 9613-1, as the engine has it.
        self._speed = 343.2 * float(np.sqrt(kelvin / 293.15))

    def record(self, scene: Scene, layouts: Sequence[Layout]) -> list[Recording]:
        """What each layout records of a scene, without noise. All hear the same rays.

        Raises:
            ConfigError: A source that is no appliance begins in a wall, a thing, or outside.
        """
        if self._settings.sounds != "household":
            for number, source in enumerate(scene.sources):
                self._opened.check_free(f"source {number}", source.way.points[0])
        found = []
        for layout in layouts:
            shape = (layout.channels, self._settings.samples)
            found.append(Recording(layout, np.zeros(shape), np.zeros(shape), np.zeros(shape), []))
        for number, source in enumerate(scene.sources):
            seed = Draws("localize rays", scene.seed, number).below(2**31)
            sound = self._pool.samples(
                source.sound, self._settings.rate_hz, source.samples, source.start
            )
            if source.way.moves or scene.listener.moves:
                self._moving(found, scene.listener, source, sound, seed)
            else:
                self._still(found, scene.listener, source, sound, seed)
        return found

    def _still(
        self,
        found: list[Recording],
        listener: Trajectory,
        source: SceneSource,
        sound: _Sound,
        seed: int,
    ) -> None:
        for one, ways in zip(
            found, self._split(found, source.way.points[0], listener, 0.0, seed), strict=True
        ):
            one.responses.append(ways)
            for out, response in zip((one.direct, one.early, one.late), ways, strict=True):
                add_at(out, source.onset, convolved(sound, response))

    def _heard(
        self,
        scene: AcousticScene,
        found: list[Recording],
        place: Point,
        listener: Trajectory,
        time_s: float,
        seed: int,
    ) -> list[_Sound]:
        """The response at each layout while something moves."""
        when = np.array([time_s])
        x, y, z = (float(part) for part in listener.positions(when)[0])
        yaw_deg = float(listener.yaws_deg(when)[0])
        receivers = [one.layout.receiver((x, y, z), yaw_deg) for one in found]
        heard = scene.impulse_responses(place, receivers, seed=seed, threads=1)
        # A sample at least, where nothing arrives.
        return [
            response.astype(np.float64) if response.shape[1] else np.zeros((len(response), 1))
            for response in heard
        ]

    def _split(
        self,
        found: list[Recording],
        place: Point,
        listener: Trajectory,
        time_s: float,
        seed: int,
    ) -> list[tuple[_Sound, _Sound, _Sound]]:
        """For each layout the response in three parts that add up to it."""
        opened = self._opened
        full, early, direct = (
            self._heard(scene, found, place, listener, time_s, seed)
            for scene in (opened.full, opened.early, opened.direct)
        )
        return [
            (first, _minus(second, first), _minus(third, second))
            for first, second, third in zip(direct, early, full, strict=True)
        ]

    def _moving(
        self,
        found: list[Recording],
        listener: Trajectory,
        source: SceneSource,
        sound: _Sound,
        seed: int,
    ) -> None:
        opened, preset = self._opened, self._settings.preset
        rate = self._settings.rate_hz
        first_s, length_s = source.onset / rate, len(sound) / rate
        begins = self._split(found, _place(source.way, first_s), listener, first_s, seed)
        for one, ways in zip(found, begins, strict=True):
            one.responses.append(ways)
        for bounds, below, above, is_late in (
            (NEW_EARLY[preset], opened.direct, opened.early, False),
            (NEW_LATE[preset], opened.early, opened.full, True),
        ):
            times = _node_times(listener, source.way, first_s, length_s, bounds)
            weights = _crossfades(times, first_s, len(sound), rate)
            for node, (time_s, (begin, weight)) in enumerate(zip(times, weights, strict=True)):
                place = _place(source.way, time_s)
                less, more = (
                    self._heard(scene, found, place, listener, time_s, seed + node)
                    for scene in (below, above)
                )
                # Late sound from one place to the next is incoherent: its energies add up.
                piece = sound[begin : begin + len(weight)]
                piece = piece * (np.sqrt(weight) if is_late else weight)
                for one, first, second in zip(found, less, more, strict=True):
                    out = one.late if is_late else one.early
                    add_at(out, source.onset + begin, convolved(piece, _minus(second, first)))
        self._glide(found, listener, source, sound, seed)

    def _delays_s(
        self, listener: Trajectory, way: Trajectory, times: _Sound, layout: Layout
    ) -> _Sound:
        """How long ago what arrives at some moments left the source: (channel, moment), s."""
        here = listener.positions(times)
        turned = axes(listener.yaws_deg(times))
        # An array's axes are right, up and back; those of its facing front, left and up.
        right, up, back = -turned[:, 1], turned[:, 2], -turned[:, 0]
        rows = []
        for x, y, z in layout.offsets():
            ear = here + x * right + y * up + z * back
            delay = np.zeros(len(times))
            for _ in range(3):
                delay = np.linalg.norm(way.positions(times - delay) - ear, axis=1) / self._speed
            rows.append(delay)
        return np.array(rows)

    def _glide(
        self,
        found: list[Recording],
        listener: Trajectory,
        source: SceneSource,
        sound: _Sound,
        seed: int,
    ) -> None:
        """Adds the direct sound of what moves."""
        rate, samples = self._settings.rate_hz, self._settings.samples
        grid_s = np.arange(0.0, self._settings.duration_s + 2 * _DELAY_STEP_S, _DELAY_STEP_S)
        delays = [self._delays_s(listener, source.way, grid_s, one.layout) for one in found]
        nearest, farthest = min(map(np.min, delays)), max(map(np.max, delays))
        first = max(source.onset + int(rate * nearest) - _LEAD, 0)
        last = min(source.onset + len(sound) + int(rate * farthest) + _LEAD, samples)
        if first >= last:
            return
        when = np.arange(first, last) / rate
        delayed, heard = Delayed(sound), []
        for rows in delays:
            lag = [when - np.interp(when, grid_s, row) for row in rows]
            heard.append(np.stack([delayed.at(row * rate - source.onset) for row in lag]))
        length_s = (last - first) / rate
        times = _node_times(listener, source.way, when[0], length_s, _NEW_DIRECT, by_direction=True)
        weights = _crossfades(times, when[0], last - first, rate)
        at_nodes = [
            self._delays_s(listener, source.way, np.array(times), one.layout) for one in found
        ]
        for node, (time_s, (begin, weight)) in enumerate(zip(times, weights, strict=True)):
            middle_s = float(np.mean([rows[:, node].mean() for rows in at_nodes]))
            place = _place(source.way, time_s - middle_s)
            responses = self._heard(self._opened.direct, found, place, listener, time_s, seed)
            for one, rows, sounds, response in zip(found, at_nodes, heard, responses, strict=True):
                filters = _advanced(response, rate * rows[:, node])
                piece = sounds[:, begin : begin + len(weight)] * weight
                add_at(one.direct, first + begin - _LEAD, convolved(piece, filters))


def _place(way: Trajectory, time_s: float) -> Point:
    x, y, z = (float(part) for part in way.positions(np.array([time_s]))[0])
    return x, y, z


def _minus(longer: _Sound, shorter: _Sound) -> _Sound:
    """The difference of responses of different lengths."""
    found = np.zeros((longer.shape[0], max(longer.shape[1], shorter.shape[1])))
    found[:, : longer.shape[1]] = longer
    found[:, : shorter.shape[1]] -= shorter
    return found


def _advanced(response: _Sound, samples: _Sound) -> _Sound:
    """A response with each channel's direct sound at :data:`_LEAD` instead of its delay."""
    size = 1 << int(np.ceil(np.log2(response.shape[1] + 2 * _LEAD)))
    turns = np.fft.rfftfreq(size)[None] * (samples[:, None] - _LEAD)
    moved = np.fft.irfft(np.fft.rfft(response, size) * np.exp(2j * np.pi * turns), size)
    return moved[:, : size // 2]


def _node_times(
    listener: Trajectory,
    way: Trajectory,
    first_s: float,
    length_s: float,
    bounds: tuple[float, float],
    *,
    by_direction: bool = False,
) -> list[float]:
    """Moments between which nothing moves or turns more than a bound, from first to last."""
    times = first_s + np.linspace(0.0, length_s, max(2, int(length_s / 0.01)))
    moved = np.linalg.norm(np.diff(way.positions(times), axis=0), axis=1)
    moved += np.linalg.norm(np.diff(listener.positions(times), axis=0), axis=1)
    turned = np.abs(np.diff(listener.yaws_deg(times)))
    if by_direction:
        # Of what is near the direction changes faster than the place.
        away = way.positions(times) - listener.positions(times)
        unit = away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
        turned += np.degrees(np.linalg.norm(np.diff(unit, axis=0), axis=1))
    gone = np.concatenate(([0.0], np.cumsum(np.maximum(moved / bounds[0], turned / bounds[1]))))
    count = int(np.ceil(gone[-1]))
    if not count:
        return [first_s]
    return [float(np.interp(k * gone[-1] / count, gone, times)) for k in range(count + 1)]


def _crossfades(
    times: list[float], first_s: float, samples: int, rate_hz: int
) -> list[tuple[int, _Sound]]:
    """For each node the sample at which it begins to count, and its weights: they add up to 1."""
    if len(times) == 1:
        return [(0, np.ones(samples))]
    nodes = (np.array(times) - first_s) * rate_hz
    found = []
    for node, middle in enumerate(nodes):
        before = nodes[node - 1] if node else middle - 1.0
        after = nodes[node + 1] if node + 1 < len(nodes) else middle + 1.0
        begin = 0 if not node else max(int(np.ceil(before)), 0)
        end = samples if node + 1 == len(nodes) else min(int(np.floor(after)) + 1, samples)
        at = np.arange(begin, end)
        rising = np.ones(len(at)) if not node else (at - before) / (middle - before)
        falling = np.ones(len(at)) if node + 1 == len(nodes) else (after - at) / (after - middle)
        found.append((begin, np.clip(np.minimum(rising, falling), 0.0, 1.0)))
    return found
