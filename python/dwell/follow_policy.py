"""A follower for the task PiedPiper that goes by its ears.

Of the world it takes what it hears (``audio``, two ears) and what is named (``instruction``); to
walk without bumping into things ``lidar``, ``gps`` and ``compass``, which say nothing about who
makes which sound.

- *Which.* The dry signals of the library are known, and that they begin with the episode. What is
  heard in 50 ms is explained as a sum of their power spectra and of their echoes, with gains that
  are not negative (the multiplicative updates of Lee and Seung for the Kullback-Leibler
  divergence [1]); the named one's share of each frequency is a Wiener filter for both ears [2].
- *Where.* It stands and turns to listen, as its own steps are louder than most sounds. What passes
  the filter is located as the baseline ``ears`` does (:func:`dwell.ears_policy.what_is_heard`): by
  time and level differences of both ears, over turns of the head. Responses from several places
  are summed over the floor and forgotten after a few seconds, since who makes the sound walks.
  Delays of a few tones are ambiguous: there level differences count more, and of a single tone
  only how it begins, before its echoes come.
- *How far.* The level of the named sound at 1 m is known: what is heard of it bounds the distance.
- *Walking.* It walks in any direction (``action_mode="velocity"``). Distances around the body are
  kept as a map; what was not seen yet counts as free, and where no ray meets a floor the house
  ends. Where it gets nowhere it goes some other way for a while.
- *A thing of the house.* It may make the same sound. Who leads walks: a place next to which the
  sound stays for long is left alone from then on.

References:
    [1] D. D. Lee and H. S. Seung, "Algorithms for non-negative matrix factorization", NIPS 13
    (2000), 556-562: the update of the gains.
    [2] E. Vincent, T. Virtanen and S. Gannot (editors), Audio Source Separation and Speech
    Enhancement (2018), chapter 5: time-frequency masks.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.ears_policy import what_is_heard
from dwell.floor_chart import FloorChart

Array = NDArray[np.float64]

#: The sensors that the policy needs, as settings of an agent.
SENSORS: dict[str, dict[str, Any]] = {
    "audio": {},
    "instruction": {},
    "gps": {},
    "compass": {},
    "lidar": {"beams": 72, "elevations_deg": [-35.0, -18.0, -8.0, 0.0, 15.0, 35.0]},
}
#: What else sounds in houses, by the names of the library; ``noise`` is for the rest.
_OTHERS = ("fridge", "clock", "fan", "footsteps", "noise")
_HEADINGS_RAD = np.deg2rad(np.arange(0.0, 360.0, 5.0))
#: Echoes fall by so much in a frame of 50 ms; so many frames of them count.
_ECHO, _ECHO_FRAMES = 0.4, 6
_UPDATES = 12
#: Frequencies in which sounds are told apart.
_BAND_HZ = (200.0, 7000.0)
#: What a room adds to the free field, dB: as heard in the built-in apartment at 1 m.
_ROOM_DB = 8.0
#: Further than this nobody guesses: sound comes through doors, and the next one is nearer.
_REACH_M = (0.8, 3.5)
#: So many steps without a word of the sound, and it goes further the way it came from.
_STALE_STEPS = 15
#: So many steps within so little, m, and it goes some other way for so many.
_STUCK_STEPS, _STUCK_M, _DETOUR_STEPS = 40, 0.35, 25
#: A batch in which the dry signal is fainter than its mean by this is no sound of its own.
_PAUSE_DB = 8.0
#: Sounds of a few tones: their delays between the ears are ambiguous, their levels are not. What
#: each squared dB by which the level difference is another takes off, and that of a side.
_TONES, _LEVEL_WEIGHT, _AT_THE_SIDE_DB = ("phone", "alarm"), 0.0025, 6.0
#: Of a single tone in a room only how it begins tells where it is. Its mask is widened by so many
#: bins of 20 Hz, so that it answers quickly.
_BEGINS, _WIDE_BINS = ("alarm",), 10
#: Pieces of a frame, samples, and the share of energy that a room keeps from piece to piece.
_PIECE, _FADES = 80, 0.9
#: Sounds that things of houses make, too.
_OF_THINGS = ("radio", "television")
#: Weights of what was heard fall to half in so many steps.
_HALF_LIFE = 30.0
#: Steps after which it thinks again where to go.
_THINK = 5
#: At first it turns all round; later it stands and turns for so many steps to listen, and goes for
#: so many: its own steps are louder than most sounds.
_TURN_STEPS, _LISTEN_STEPS, _GO_STEPS = 40, 14, 15
#: How far a step leads.
_STEP_M = 0.1
#: It does not walk nearer than this.
_KEEP_M = 1.1
#: So many steps next to a sound that does not move, and it is a thing's; within this distance.
_STILL_STEPS, _STILL_M = 130, 0.9


def _widened(mask: Array, bins: int) -> Array:
    """The highest within so many bins to either side."""
    padded = np.pad(mask, bins)
    wide: Array = np.lib.stride_tricks.sliding_window_view(padded, 2 * bins + 1).max(axis=1)
    return wide


class Frame(NamedTuple):
    """How much of the named sound there is in a frame.

    Attributes:
        share: Its share of the energy.
        heard: Its energy at an ear, in means of the dry signal with a root mean square of 1 Pa.
        dry: That of the dry signal at this time, with its echoes, in the same unit.
    """

    share: float
    heard: float
    dry: float


class SoundSeparator:
    """Tells the named one of several known sounds from the others, frame by frame."""

    def __init__(self, named: str, signals: list[str], rate_hz: int, samples: int) -> None:
        """Takes the spectra of the signals.

        Args:
            named: The one to hear.
            signals: All that may sound; the named one among them.
            rate_hz: Samples a second.
            samples: Of a frame.
        """
        self._window = np.hanning(samples)
        frequencies = np.fft.rfftfreq(samples, 1.0 / rate_hz)
        self._band = (frequencies >= _BAND_HZ[0]) & (frequencies < _BAND_HZ[1])
        periods = {row["name"]: row["loop_s"] for row in _native.signals()}
        self._spectra: list[Array] = []
        for name in signals:
            count = round(periods[name] * rate_hz)
            dry = np.asarray(_native.synthesize(name, rate_hz, count), np.float64)
            frames = dry[: count - count % samples].reshape(-1, samples) * self._window
            power = np.abs(np.fft.rfft(frames, axis=1)) ** 2
            # A frame falls between two of the dry signal: the sound needs some time to arrive.
            self._spectra.append(0.5 * (power + np.roll(power, 1, axis=0)) + 1e-9)
        self._named = signals.index(named)
        self._mean = float(self._spectra[self._named][:, self._band].sum(axis=1).mean())
        self._gains = np.full(2 * len(signals), 1.0)
        self._frame = 0
        self._begins = named in _BEGINS
        #: The energy of earlier pieces, as a room lets it fade.
        self._faded = 0.0

    def filtered(self, window: Array) -> tuple[Array, Frame]:
        """What the ears hear of the named sound in the next frame.

        Args:
            window: Pressure, Pa; shape (2, samples).

        Returns:
            The same, filtered; and how much of it there is.
        """
        k, self._frame = self._frame, self._frame + 1
        spectra = np.fft.rfft(window * self._window, axis=1)
        power = (np.abs(spectra) ** 2).sum(axis=0)
        direct = np.stack([rows[k % len(rows)] for rows in self._spectra])
        echo = np.zeros_like(direct)
        for age in range(1, _ECHO_FRAMES + 1):
            if k >= age:
                rows = [one[(k - age) % len(one)] for one in self._spectra]
                echo += _ECHO**age * np.stack(rows)
        parts = np.concatenate([direct, echo + 1e-9])
        heard = power[self._band] + 1e-14
        known = parts[:, self._band]
        scale = heard.sum() / known.sum(axis=1)
        # Gains change slowly: those of the frame before, and a little of everything.
        gains = 0.7 * self._gains + 0.02 * scale
        sums = known.sum(axis=1)
        for _ in range(_UPDATES):
            gains = gains * (known @ (heard / (gains @ known + 1e-16))) / sums
        self._gains = gains
        own = gains[[self._named, self._named + len(self._spectra)]]
        of_named = own @ parts[[self._named, self._named + len(self._spectra)]]
        mask = np.where(self._band, of_named / (gains @ parts + 1e-16), 0.0)
        share = float((mask[self._band] * heard).sum() / heard.sum())
        found = float((mask[self._band] ** 2 * heard).sum()) / 2.0
        dry = float((direct + echo)[self._named, self._band].sum())
        if self._begins:
            mask = _widened(mask, _WIDE_BINS)
        passed = np.fft.irfft(spectra * mask, window.shape[1], axis=1)
        if self._begins:
            passed = self._beginnings(passed)
        return passed, Frame(share, found / self._mean, dry / self._mean)

    def _beginnings(self, sound: Array) -> Array:
        """The parts of a sound in which it grows: what arrives first has met no wall."""
        pieces = sound.reshape(2, -1, _PIECE)
        energies = (pieces**2).sum(axis=(0, 2))
        weights = np.zeros(len(energies))
        for k, energy in enumerate(energies):
            weights[k] = max(0.0, 1.0 - self._faded / (energy + 1e-16))
            self._faded = max(_FADES * self._faded, float(energy))
        weights = 0.05 + 0.95 * weights
        kept: Array = (pieces * weights[None, :, None]).reshape(sound.shape)
        return kept


def _by_level(windows: Array, yaws_rad: Array) -> Array:
    """How well the level differences of both ears fit each heading in the house, at most 0."""
    powers = (windows**2).sum(axis=2) + 1e-14
    found_db = np.clip(10.0 * np.log10(powers[:, 0] / powers[:, 1]), -9.0, 9.0)
    weights = np.sqrt(powers.sum(axis=1))
    azimuths_rad = _HEADINGS_RAD[None, :] - yaws_rad[:, None]
    away_db = found_db[:, None] - _AT_THE_SIDE_DB * np.sin(azimuths_rad)
    fit: Array = -_LEVEL_WEIGHT * (weights[:, None] * away_db**2).sum(axis=0) / weights.sum()
    return np.asarray(fit - fit.mean(), np.float64)


class FollowByEars:
    """The policy; see the module."""

    def __init__(
        self,
        *,
        sounds: tuple[str, ...] = ("radio", "phone", "kettle", "television", "alarm"),
        rate_hz: int = 16_000,
        turn_deg: float = 9.0,
    ) -> None:
        """Takes what may be named, and how far a turn goes.

        Args:
            sounds: As the task's setting.
            rate_hz: Samples a second of ``audio``.
            turn_deg: As of ``stride``.
        """
        self._sounds, self._rate_hz = sounds, rate_hz
        self._turn_rad = np.deg2rad(turn_deg)
        self._levels = {row["name"]: row["usual_level_db"] for row in _native.signals()}

    def reset(self, observation: Mapping[str, Any]) -> None:
        """Begins an episode.

        Raises:
            ConfigError: No known sound is named.
        """
        text = str(observation["instruction"])
        found = re.fullmatch(r"Go near the (.+)\.", text)
        named = found[1].replace(" ", "_") if found else ""
        if named not in self._sounds:
            raise ConfigError(f"instruction is {text!r}; expected one that names a sound")
        samples = np.asarray(observation["audio"]).shape[-1]
        signals = [*dict.fromkeys([*self._sounds, *_OTHERS])]
        self._separator = SoundSeparator(named, signals, self._rate_hz, samples)
        #: The sound that is named.
        self.named = named
        self._level_db = self._levels[named]
        self._chart = FloorChart()
        self._pending: list[tuple[Array, float, Frame]] = []
        #: Where it listened: place, response, weight, step.
        self._heard: list[tuple[Array, Array, float, int]] = []
        self._step = 0
        #: Where it goes, m ahead and left of the start; and where the sound comes from.
        self._way: Array | None = None
        self._towards: Array | None = None
        #: The direction in which it went in the last step.
        self._went: Array | None = None
        self._share = 1.0
        #: Whether it stands and listens, and to which side it turns then.
        self._listens, self._side = True, 1.0
        self._distance_m: float | None = None
        self._still: tuple[Array, int] | None = None
        #: Places of things that make the same sound.
        self._refused: list[Array] = []
        self._last: Array | None = None
        #: Where the sound came from when it was heard last, a unit vector.
        self._bearing = np.zeros(2)
        #: Where it was and when, to notice that it gets nowhere; and what it does about it.
        self._anchor = (np.zeros(2), 0)
        self._detour: tuple[Array, int] | None = None
        self._stream = np.random.default_rng(len(text))

    def act(self, observation: Mapping[str, Any]) -> NDArray[np.float32]:
        """The next action, of the form ``velocity``: ahead, right, turn to the left, look up."""
        place = np.asarray(observation["gps"], np.float64)
        yaw_rad = float(np.asarray(observation["compass"]).ravel()[0])
        if self._went is not None and self._last is not None:
            progress_m = float((place - self._last) @ self._went)
            # Also where it slides along what is in the way.
            if progress_m < 0.3 * self._share * _STEP_M:
                self._chart.bumped(place, self._went, self._step)
        self._last = place
        if self._step % 3 == 0:
            ranges = np.asarray(observation["lidar"], np.float64)
            self._chart.add(place, yaw_rad, ranges, SENSORS)
        filtered, frame = self._separator.filtered(np.asarray(observation["audio"], np.float64))
        if filtered.any() and self._went is None:
            self._pending.append((filtered, yaw_rad, frame))
        self._step += 1
        cycle = (self._step - _TURN_STEPS) % (_LISTEN_STEPS + _GO_STEPS)
        self._listens = self._step < _TURN_STEPS or cycle < _LISTEN_STEPS
        if self._step >= _TURN_STEPS:
            if not self._listens and (cycle - _LISTEN_STEPS) % _THINK == 0:
                self._think(place)
            if cycle == 0:
                self._side = -self._side
        return self._velocity(place, yaw_rad)

    def _think(self, place: Array) -> None:
        """Where the sound is by now, and the way there."""
        self._conclude(place)
        source = self._source()
        self._way = self._towards = None
        if source is None:
            return
        if self.named in _OF_THINGS:
            self._notice_things(place, source)
        if not self._heard:
            return
        self._towards = source - place
        if self._step - self._heard[-1][3] > _STALE_STEPS:
            # It may have walked on meanwhile.
            if self._distance_m is not None and self._distance_m > 2.0:
                source = source + 1.5 * self._bearing
        elif float(np.hypot(*self._towards)) > 0.3:
            self._bearing = self._towards / np.hypot(*self._towards)
        goal = source if self._detour is None else self._detour[0]
        if float(np.hypot(*(goal - place))) > _KEEP_M:
            way = self._chart.way(place, goal, self._step)
            self._way = None if way is None else place + way
        self._notice_stuck(place)

    def _notice_stuck(self, place: Array) -> None:
        """Where it gets nowhere it goes some other way for a while."""
        if self._detour is not None and self._step >= self._detour[1]:
            self._detour = None
        is_away = np.hypot(*(place - self._anchor[0])) > _STUCK_M
        if is_away or self._way is None:
            self._anchor = (place, self._step)
        elif self._step - self._anchor[1] > _STUCK_STEPS:
            angle = self._stream.uniform(0.0, 2.0 * np.pi)
            goal = place + 3.0 * np.array([np.cos(angle), np.sin(angle)])
            self._detour = (goal, self._step + _DETOUR_STEPS)
            self._anchor = (place, self._step)

    def _velocity(self, place: Array, yaw_rad: float) -> NDArray[np.float32]:
        """Goes its way, whatever it faces; its head swings about where the sound comes from."""
        # Less than nothing would say stop.
        turn = self._side
        if not self._listens and self._towards is not None:
            # The next turn passes what it goes to in the middle.
            middle = float(np.arctan2(self._towards[1], self._towards[0]))
            begins = middle - 0.5 * self._side * _LISTEN_STEPS * self._turn_rad
            left_rad = float(np.angle(np.exp(1j * (begins - yaw_rad))))
            turn = float(np.clip(left_rad / self._turn_rad, -1.0, 1.0))
            turn = turn if abs(turn) > 0.06 else 0.06
        ahead = right = 0.0
        self._went = None
        if self._way is not None and not self._listens:
            way = self._way - place
            length_m = float(np.hypot(*way))
            if length_m > 0.05:
                share = self._share = min(1.0, length_m / _STEP_M)
                self._went = way / length_m
                c, s = np.cos(yaw_rad), np.sin(yaw_rad)
                ahead = share * (self._went[0] * c + self._went[1] * s)
                right = share * (self._went[0] * s - self._went[1] * c)
        return np.array([ahead, right, turn, 0.0], np.float32)

    def _conclude(self, place: Array) -> None:
        """Sums up the frames since the last time."""
        if not self._pending:
            return
        windows = np.stack([row[0] for row in self._pending])
        yaws_rad = np.array([row[1] for row in self._pending])
        frames = np.array([row[2] for row in self._pending])
        self._pending = []
        share, found, dry = frames.mean(axis=0)
        if dry < 10.0 ** (-_PAUSE_DB / 10.0) or share < 0.01:
            return
        at_1_m = 4e-10 * 10.0 ** (self._level_db / 10.0)
        gain_db = 10.0 * float(np.log10(found / (dry * at_1_m) + 1e-9))
        response = what_is_heard(windows, yaws_rad, self._rate_hz).response
        if self.named in _TONES:
            response = response + _by_level(windows, yaws_rad)
        audible = float(np.clip(2.0 * share, 0.05, 1.0) * np.clip(1.0 + gain_db / 50.0, 0.05, 1.0))
        self._heard = [*self._heard[-24:], (place, response, audible, self._step)]
        # The free field, and what the room adds; through walls it is further than it seems.
        distance_m = float(np.clip(10.0 ** ((_ROOM_DB - gain_db) / 20.0), *_REACH_M))
        old = self._distance_m
        mixed = distance_m if old is None else old ** (1.0 - audible) * distance_m**audible
        self._distance_m = float(mixed)

    def _source(self) -> Array | None:
        """Where the named sound is, m ahead and to the left of the start; ``None``: unheard."""
        if not self._heard or self._distance_m is None:
            return None
        # As far as it was when it was heard last: who walks on in a pause does not push it away.
        last = self._heard[-1][0]
        cells = last + FloorChart.around()
        told = np.zeros(len(cells))
        for at, response, weight, step in self._heard:
            old = 0.5 ** ((self._step - step) / _HALF_LIFE)
            offsets = cells - at
            headings = np.arctan2(offsets[:, 1], offsets[:, 0]) % (2.0 * np.pi)
            told += (
                weight
                * old
                * np.interp(headings, _HEADINGS_RAD, response, period=2.0 * np.pi)
                * np.minimum(1.0, np.hypot(*offsets.T) / 0.5)
            )
        apart_m = np.maximum(np.hypot(*(cells - last).T), 0.2)
        spread = max(abs(float(told.max())), 1e-6)
        told -= 0.06 * spread * np.log2(apart_m / self._distance_m) ** 2
        for thing in self._refused:
            told[np.hypot(*(cells - thing).T) < 1.8] -= 0.5 * spread
        best: Array = cells[int(told.argmax())]
        return best

    def _notice_things(self, place: Array, source: Array) -> None:
        """A sound next to which it stood for long without its moving is a thing's."""
        if self._still is None or np.hypot(*(source - self._still[0])) > _STILL_M:
            self._still = (source, self._step)
        elif np.hypot(*(source - place)) > 2.5:
            self._still = (self._still[0], self._step)
        elif self._step - self._still[1] > _STILL_STEPS:
            self._refused.append(self._still[0])
            self._still = None
            self._heard = []
