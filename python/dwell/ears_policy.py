"""The baseline ``ears``: goes to a sound by what its two ears hear, and by nothing else.

It stops every metre to listen, as its own steps are louder than most sources:

- *Side.* The cross-correlation of both ears, weighted by the phase transform [1, 2] (its power
  below one: [3]), at the interaural time differences of a rigid sphere [4], for every heading;
  and, with a small weight, the interaural level difference at high frequencies [8].
- *Front or back.* A time difference fits two headings, in front and behind. The head turns while
  it listens, and what is in front moves to the other side than what is behind [5]: correlations
  of all windows are added up by the heading in the house, where only the true one stays.
- *Place.* What was heard at several places is added up on a chart, by counting steps and turns.
- *Nearness.* The chart, the level, the interaural cross-correlation coefficient [6] and the peak
  of the steered response tell whether the source is near: there its direct sound is more of what
  is heard [7]. So no level of the source needs to be known.
- *Blocked.* Who walks hears steps. Where there are none, and where it gets no louder, it goes
  another way for a while, at random.
- *Silence.* What was heard counts on, the more the louder it was. What stays silent is walked to
  until something is in the way.

References:
    [1] C. H. Knapp and G. C. Carter, "The generalized correlation method for estimation of time
    delay", IEEE Trans. ASSP 24 (1976), 320-327: PHAT, Table I.
    [2] J. H. DiBiase, H. F. Silverman and M. S. Brandstein, "Robust localization in reverberant
    rooms", in Microphone Arrays (2001): the steered response, SRP-PHAT.
    [3] K. D. Donohue, J. Hannemann and H. G. Dietz, "Performance of phase transform for detecting
    sound sources with microphone arrays", Signal Processing 87 (2007), 1677-1691.
    [4] R. S. Woodworth, Experimental Psychology (1938): a (theta + sin theta) / c.
    [5] H. Wallach, "The role of head movements and vestibular and visual cues in sound
    localization", J. Exp. Psychol. 27 (1940), 339-368.
    [6] ISO 3382-1:2009, annex B: IACC.
    [7] H. Kuttruff, Room Acoustics (2016), chapter 5: direct sound falls by 6 dB per doubling of
    the distance, diffuse sound does not.
    [8] Lord Rayleigh, "On our perception of sound direction", Phil. Mag. 13 (1907), 214-232.
"""

from __future__ import annotations

import json
from collections.abc import Generator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.played_actions import said_action
from dwell.stated_episodes import seed_of

if TYPE_CHECKING:
    from dwell.envs import DwellEnv

Array = NDArray[np.float64]
#: One that gets what was heard for each action that it gives.
Course = Generator[str, Array, None]

_HEAD_RADIUS_M, _SOUND_M_S = 0.0875, 343.0
_REFERENCE_PA = 2e-5
#: Bearings come from these frequencies, nearness from those.
_BEARING_HZ, _NEARNESS_HZ = (300.0, 6000.0), (700.0, 3000.0)
#: Level differences of a source at the side, in these frequencies; what each squared dB that is
#: heard besides takes off the correlation.
_ILD_HZ, _ILD_AT_THE_SIDE_DB, _ILD_WEIGHT = (1500.0, 6000.0), 6.0, 0.01 / 16.0
#: Power of the phase transform: 1 is PHAT, 0 the plain correlation.
_PHAT_POWER = 0.7
#: Headings in the house that are told apart: every 5 degrees, to the left of the start.
_HEADINGS_RAD = np.deg2rad(np.arange(0.0, 360.0, 5.0))
_DELAYS_S = np.arange(-13.0, 13.01, 0.25) / 16000.0
#: Steps whose echo is left to die away, and turns of the head while it listens.
_PAUSE = ("turn_left",) * 3
_LOOK_ABOUT = ("turn_right",) * 9 + ("turn_left",) * 5
#: At first half a turn.
_LOOK_AT_FIRST = ("turn_right",) * 20
_LEG_M = 1.0
#: How much of what was heard at the place before counts still.
_MEMORY = 0.7
#: Places in a row that may be no louder before it goes another way.
_PATIENCE = 3
#: Of places below 1 m from the source and others: see :func:`nearness`.
_NEAR_WEIGHTS = {"margin": 2.8, "level_db": 0.076, "coefficient": -2.2, "peak": 10.0, "one": -7.2}
#: Steps of one's own are heard at these frequencies, in one of so many windows, louder than this.
_THUMP_HZ, _STEP_WINDOWS, _THUMP_DB = (20.0, 80.0), 8, 69.5
#: What has fallen silent is fainter than the loudest by this, dB, at so many places in a row.
_SILENT_DB, _SILENT_PLACES = 25.0, 5


class Heard(NamedTuple):
    """What was heard at a place.

    Attributes:
        response: Of every heading in the house: the steered response, -1 to 1.
        level_db: Level of the loudest windows from 700 to 3000 Hz, dB SPL.
        coefficient: Their interaural cross-correlation coefficient, 0 to 1.
    """

    response: Array
    level_db: float
    coefficient: float


def nearness(heard: Heard, margin: float) -> float:
    """Log-odds that the source is within 1 m, by a logistic regression.

    Its weights are those of 247 places where the policy listened, in 30 houses of the split
    ``train``.

    Args:
        heard: What was heard here.
        margin: By how much the chart says that it is nearby (:meth:`Chart.source`).
    """
    weights = _NEAR_WEIGHTS
    return (
        weights["margin"] * min(max(margin, -0.3), 0.6)
        + weights["level_db"] * heard.level_db
        + weights["coefficient"] * heard.coefficient
        + weights["peak"] * float(heard.response.max())
        + weights["one"]
    )


def woodworth_itd_s(azimuth_rad: Array) -> Array:
    """Interaural time difference of a rigid sphere for a distant source, s.

    Args:
        azimuth_rad: From straight ahead, positive to the left.

    Returns:
        Positive where the left ear hears first.
    """
    lateral = np.arcsin(np.clip(np.sin(azimuth_rad), -1.0, 1.0))
    delays: Array = _HEAD_RADIUS_M / _SOUND_M_S * (lateral + np.sin(lateral))
    return delays


def what_is_heard(windows: Array, yaws_rad: Array, rate_hz: float) -> Heard:
    """Combines windows that were heard at one place.

    Args:
        windows: Pressure, Pa; shape (windows, 2, samples), left ear first.
        yaws_rad: Where the head faced in each, to the left of the start.
        rate_hz: Samples a second.

    Returns:
        What they say together.
    """
    size = 2 * 2 ** int(np.ceil(np.log2(windows.shape[-1])))
    spectra = np.fft.rfft(windows, size, axis=-1)
    frequencies = _frequencies(size, rate_hz)
    steering = np.exp(-2j * np.pi * frequencies[:, None] * _DELAYS_S)
    cross = spectra[:, 0] * spectra[:, 1].conj()

    band = _within(frequencies, _BEARING_HZ)
    strength = np.abs(cross[:, band]) + 1e-20
    flat = cross[:, band] / strength**_PHAT_POWER
    share = np.abs(flat).sum(axis=1, keepdims=True)
    correlations = (flat / share @ steering[band]).real
    weights = np.sqrt(strength.sum(axis=1))
    response = np.zeros(len(_HEADINGS_RAD))
    band = _within(frequencies, _ILD_HZ)
    left, right = (np.abs(spectra[:, :, band]) ** 2).sum(axis=-1).T
    ilds_db = 10.0 * np.log10((left + 1e-12) / (right + 1e-12))
    for k, yaw_rad in enumerate(yaws_rad):
        azimuths_rad = _HEADINGS_RAD - yaw_rad
        told = np.interp(woodworth_itd_s(azimuths_rad), _DELAYS_S, correlations[k])
        away_db = ilds_db[k] - _ILD_AT_THE_SIDE_DB * np.sin(azimuths_rad)
        response += weights[k] * (told - _ILD_WEIGHT * away_db**2)

    band = _within(frequencies, _NEARNESS_HZ)
    # Parseval: the mean square of each ear over the window.
    powers = 2.0 * (np.abs(spectra[:, :, band]) ** 2).sum(axis=-1) / size / windows.shape[-1]
    loud = powers.sum(axis=1) >= np.percentile(powers.sum(axis=1), 60.0)
    together = np.abs((cross[:, band] @ steering[band]).real).max(axis=1)
    apart = np.sqrt(powers.prod(axis=1)) * size * windows.shape[-1] / 2.0
    mean_square = powers[loud].mean() / _REFERENCE_PA**2
    return Heard(
        response / weights.sum(),
        10.0 * float(np.log10(mean_square + 1e-3)),
        float((together / (apart + 1e-20))[loud].mean()),
    )


def _level_db(window: Array, rate_hz: float, band: tuple[float, float]) -> float:
    """Level of a band at both ears, dB SPL: the mean square under a Hann window (Parseval)."""
    taper = np.hanning(window.shape[1])
    spectra = np.fft.rfft(window * taper, axis=1)
    inside = _within(_frequencies(window.shape[1], rate_hz), band)
    power = (np.abs(spectra[:, inside]) ** 2).sum() / window.shape[1] / (taper**2).sum()
    return 10.0 * float(np.log10(power / _REFERENCE_PA**2 + 1e-3))


def _frequencies(samples: int, rate_hz: float) -> Array:
    return np.asarray(np.fft.rfftfreq(samples, 1.0 / rate_hz), np.float64)


def _within(frequencies: Array, band: tuple[float, float]) -> NDArray[np.bool_]:
    return (frequencies >= band[0]) & (frequencies < band[1])


class Chart:
    """What was heard at several places says together where the source is.

    The steered responses are summed over a grid around the start, as those of distributed
    microphones are [2]; older ones count less, since steps are counted with errors.
    """

    _CELL_M, _REACH_M = 0.2, 6.0

    def __init__(self) -> None:
        """Nothing was heard yet."""
        self._heard: list[tuple[Array, Array, float]] = []

    def add(self, place_m: Array, response: Array, weight: float) -> None:
        """Adds what was heard at a place."""
        self._heard = [(at, was, _MEMORY * old) for at, was, old in self._heard[-11:]]
        self._heard.append((place_m, response, weight))

    def source(self, place_m: Array) -> tuple[float, float, float]:
        """Where the source is.

        Returns:
            By how much a source within 0.8 m of ``place_m`` explains more than one beyond 1.3 m,
            as a share; its heading, rad to the left of the start's; its distance, m.
        """
        steps = np.arange(-self._REACH_M, self._REACH_M + self._CELL_M / 2, self._CELL_M)
        cells = place_m + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        told = np.zeros(len(cells))
        for at, response, weight in self._heard:
            right, back = (cells - at).T
            headings = np.arctan2(-right, -back) % (2.0 * np.pi)
            told += weight * np.interp(headings, _HEADINGS_RAD, response, period=2.0 * np.pi)
        apart_m = np.hypot(*(cells - place_m).T)
        near, far = told[apart_m < 0.8].max(), told[apart_m > 1.3].max()
        best = int((told + 1e-6 * np.minimum(apart_m, 3.0)).argmax())
        right, back = cells[best] - place_m
        margin = float(near / max(far, 1e-9) - 1.0)
        return margin, float(np.arctan2(-right, -back)), float(apart_m[best])


class Ears:
    """The policy; see the module."""

    def __init__(self, env: DwellEnv) -> None:
        """Reads the names of actions and the size of steps, and nothing of the world.

        Raises:
            ConfigError: The environment has no sensor ``audio`` of two ears.
        """
        spaces = getattr(env.observation_space, "spaces", {})
        shape = spaces["audio"].shape if "audio" in spaces else ()
        if shape[:1] != (2,):
            raise ConfigError(
                'the policy ears needs the sensor audio, of two ears: sensors=["audio"]'
            )
        self._env = env
        usual = {"turn_deg": 9.0, "forward_m": 0.1}
        stride = {**usual, **json.loads(env._config).get("stride", {})}
        self._turn_rad = np.deg2rad(stride["turn_deg"])
        self._step_m = stride["forward_m"]
        config = _native.World.of_env(env._runner.batch, 0).config()
        self._rate_hz = float(config["sound_rate_hz"])
        #: Of a longer window what is new since the step before.
        self._newest = round(self._rate_hz / config["control_rate_hz"])
        self._begin(0)

    def _begin(self, seed: int) -> None:
        self._stream = np.random.default_rng(seed)
        self._yaw_rad = 0.0
        #: By counting steps: to the right and back of the start.
        self._place_m = np.zeros(2)
        self._course = self._go()
        self._is_new = True

    def reset(self, observation: Mapping[str, Any], info: Mapping[str, Any]) -> None:
        """Begins an episode; of ``info`` it takes what it draws from, ``episode_id``, alone."""
        del observation
        self._begin(seed_of(info["episode_id"]))

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        """The next action."""
        if self._is_new:
            self._is_new = False
            name = next(self._course)
        else:
            window = np.asarray(observation["audio"], np.float64)
            name = self._course.send(window[:, -self._newest :])
        self._yaw_rad += self._turn_rad * ((name == "turn_left") - (name == "turn_right"))
        return said_action(name, self._env, self._stream)

    def _go(self) -> Course:
        """The episode: listens, turns, walks, and stops where the source is near."""
        chart = Chart()
        turns: tuple[str, ...] = _LOOK_AT_FIRST
        best_db, loudest_db, worse, silent, lost = -np.inf, -np.inf, 0, 0, 0
        side = self._draw_side()
        while True:
            heard = yield from self._listen(turns)
            turns = _LOOK_ABOUT
            loudest_db = max(loudest_db, heard.level_db)
            loudness = 10.0 ** ((heard.level_db - loudest_db) / 40.0)
            chart.add(self._place_m, heard.response, loudness)
            is_silent = heard.level_db < loudest_db - _SILENT_DB
            silent = silent + 1 if is_silent else 0
            margin, heading_rad, distance_m = chart.source(self._place_m)
            if nearness(heard, margin) > 0.0:
                break
            worse = 0 if heard.level_db > best_db + 0.5 else worse + 1
            best_db = max(best_db, heard.level_db)
            if worse >= _PATIENCE:
                worse, best_db, lost = 0, heard.level_db, lost + 1
                side = self._draw_side() if self._stream.random() < 0.3 else side
                yield from self._go_about(heading_rad, side, lost)
                continue
            yield from self._face(heading_rad)
            is_free = yield from self._walk(min(_LEG_M, max(0.5, distance_m)))
            if not is_free:
                if silent >= _SILENT_PLACES:
                    break
                side = self._draw_side() if self._stream.random() < 0.3 else side
                yield from self._go_about(heading_rad, side, lost)
        yield "stop"

    def _go_about(self, heading_rad: float, side: int, times: int) -> Course:
        """Goes past what is in the way, to one side; further the more often it had to."""
        yield from self._face(heading_rad + side * self._stream.uniform(0.8, 1.9))
        yield from self._walk(self._stream.uniform(1.0, 2.0 + 0.3 * min(times, 6)) * _LEG_M)

    def _draw_side(self) -> int:
        return 1 if self._stream.random() < 0.5 else -1

    def _listen(self, turns: tuple[str, ...]) -> Generator[str, Array, Heard]:
        """Turns the head."""
        for action in _PAUSE:
            yield action
        windows, yaws_rad = [], []
        for action in turns:
            windows.append((yield action))
            yaws_rad.append(self._yaw_rad)
        return what_is_heard(np.array(windows), np.array(yaws_rad), self._rate_hz)

    def _face(self, heading_rad: float) -> Course:
        """Turns to a heading, the shorter way."""
        left_rad = np.angle(np.exp(1j * (heading_rad - self._yaw_rad)))
        for _ in range(round(abs(left_rad) / self._turn_rad)):
            yield "turn_left" if left_rad > 0 else "turn_right"

    def _walk(self, length_m: float) -> Generator[str, Array, bool]:
        """Walks ahead; gives whether steps were heard until the end."""
        ahead_m = self._step_m * np.array([-np.sin(self._yaw_rad), -np.cos(self._yaw_rad)])
        thumps_db: list[float] = []
        for _ in range(max(1, round(length_m / self._step_m))):
            window = yield "move_forward"
            self._place_m = self._place_m + ahead_m
            thumps_db.append(_level_db(window, self._rate_hz, _THUMP_HZ))
            if len(thumps_db) >= _STEP_WINDOWS and max(thumps_db[-_STEP_WINDOWS:]) < _THUMP_DB:
                self._place_m = self._place_m - (_STEP_WINDOWS - 1) * ahead_m
                return False
        return True
