"""How far away a known sound is, and on which side: from when it arrives at both ears.

A sound whose waveform is known, and that is known to begin with the episode, arrives at each ear as
its waveform passed through the response of the room. What arrives first has come the shortest way.

- :class:`BroadSound` is for sounds of many frequencies. Each frame is correlated with the waveform,
  weighted by the phase transform [1] with spectra of several frames, so that there is a peak
  where an arrival is. The ears' correlations are read at the delays that a place would have, frame
  by frame with where the head was then, and summed: the steered response [2], in range and bearing.
- :class:`TonalSound` is for sounds of a few tones, which say little while they last: in a room
  their echoes make phases and levels nearly random. How they begin says it: before the first echo
  comes there is the direct sound alone, its delay, and differences of phase and level of the ears.

Both give a logarithm of likelihood for places of a chart: how much better what was heard fits a
source there than no source.

References:
    [1] C. H. Knapp and G. C. Carter, "The generalized correlation method for estimation of time
    delay", IEEE Trans. ASSP 24 (1976), 320-327: PHAT, Table I.
    [2] J. H. DiBiase, H. F. Silverman and M. S. Brandstein, "Robust localization in reverberant
    rooms", in Microphone Arrays (2001): the steered response, SRP-PHAT.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from dwell.ears_policy import woodworth_itd_s
from dwell.sounds import synthesize

Array = NDArray[np.float64]

_SOUND_M_S = 343.0
#: The furthest that is looked for, samples of 16 kHz would be 1200: 26 m.
_REACH_S = 0.075
#: Frequencies in which arrivals are looked for.
_BAND_HZ = (150.0, 7500.0)
#: Frames that are summed up, and bins of a smoothed spectrum.
_FRAMES, _SMOOTH_BINS = 6, 7
#: Frequencies at which the waveform is fainter than its loudest by this factor say nothing; frames
#: of a pause are fainter than the mean by that one.
_LEAST, _PAUSE = 2e-3, 0.1
#: An arrival is a peak so wide, s; an earlier one is one that is earlier by more than this.
_PEAK_S, _EARLIER_S = 3e-4, 1.5e-3
#: By how much earlier arrivals make a later one less probable to be the first.
_SHADOW = 0.8
#: So near the direct sound is the strongest arrival, at least by this share: it falls with the
#: distance, and echoes do not.
_NEAR_M, _DIRECT = 1.2, 0.4
#: What takes off places that are nearer than this by a metre and from which nothing is heard.
_SILENT, _SILENT_M = 1.2, 2.2
#: That is known of sounds that have at least this share of the frequencies; of others, whose
#: correlations have many peaks, arrivals are known to this distance, m.
_BROAD, _FEW_REACH_M = 0.12, 3.5
#: Places within a cell, m from its middle.
_WITHIN_M = np.array([-0.12, -0.06, 0.0, 0.06, 0.12])
#: Likelihood of a peak, by how often it is above what is everywhere.
_SLOPE, _FLOOR, _CAP = 0.75, 1.5, 5.0
#: Sounds of a few tones, and their frequencies, Hz.
TONES_HZ: dict[str, tuple[float, ...]] = {
    "alarm": (3100.0, 6200.0),
    "phone": (460.0, 1380.0, 2200.0),
}
#: Of one tone and its harmonics correlations are periodic.
_SINGLE_TONES = ("alarm",)
#: Length of the window in which a tone's phasor is taken, s.
_PHASOR_S = 0.006
#: What is kept of what was heard, frames; where the level of a beginning is taken, s after it.
_KEPT_FRAMES, _PLATEAU_S = 6, (0.05, 0.1)
#: A beginning must be louder than what was before it by this factor; it is noticed when it is by
#: that one and has this share of the level that it comes to, so long after it arrived, s.
_CLEAR, _NOTICED, _ONSET, _RISE_S = 4.0, 3.0, 0.1, 0.0028
#: How far off such a distance is, m: it is too long where the sound went around something.
_SPREAD_M, _LONGER_M, _OUTLIERS, _GAIN = 0.4, 1.0, 0.03, 20.0
#: Weight of differences of phase, and by how much more those count that are not ambiguous: of tones
#: with periods of more than twice the longest delay between the ears.
_AMBIGUOUS_HZ, _PHASE_WEIGHT, _PLAIN = 750.0, 0.7, 2.5
#: Differences of level count above so many Hz; that of a source at the side, and how far off, dB.
_SHADOW_HZ, _AT_THE_SIDE_DB, _SPREAD_DB = 2000.0, 9.0, 6.0


class Pose(NamedTuple):
    """Where the head was.

    Attributes:
        place: m ahead and to the left of the start.
        yaw_rad: Where it faced, to the left of the start's heading.
    """

    place: Array
    yaw_rad: float


class KnownSound(Protocol):
    """A sound whose arrivals are looked for."""

    def add(self, window: Array, pose: Pose) -> None:
        """Hears the next frame: pressure, Pa; shape (2, samples), left ear first."""

    def likelihood(self, cells: Array, *, again: bool = False) -> Array | None:
        """How much better what was heard fits a source at places than none.

        Args:
            cells: Shape (n, 2), m.
            again: Whether the same is asked of other places next.

        Returns:
            Log-likelihood ratios; ``None``: nothing new was heard.
        """


def known_sounds(named: str, rate_hz: int, samples: int) -> list[KnownSound]:
    """What hears a signal of the library: its arrivals, how it begins, or both.

    Args:
        named: The signal.
        rate_hz: Samples a second.
        samples: Of a frame.
    """
    found: list[KnownSound] = []
    if named not in _SINGLE_TONES:
        found.append(BroadSound(named, rate_hz, samples))
    if named in TONES_HZ:
        found.append(TonalSound(named, rate_hz, samples))
    return found


def dry_signal(named: str, rate_hz: int) -> Array:
    """A period of a signal of the library."""
    return synthesize(named, rate_hz=rate_hz).astype(np.float64)


def _piece(dry: Array, start: int, count: int) -> Array:
    """So many samples of a loop that began at 0; before that nothing."""
    at = np.arange(start, start + count)
    piece: Array = np.where(at >= 0, dry[at % len(dry)], 0.0)
    return piece


def _smoothed(spectrum: Array, bins: int) -> Array:
    sums = np.pad(spectrum, (bins // 2 + 1, bins // 2), mode="edge").cumsum()
    means: Array = (sums[bins:] - sums[:-bins]) / bins
    return means


class _Geometry(NamedTuple):
    """Of places as a head hears them: distances, m, and delays between the ears, s."""

    distance_m: Array
    azimuth_rad: Array
    itd_s: Array

    @classmethod
    def of(cls, cells: Array, pose: Pose) -> _Geometry:
        ways = cells - pose.place
        azimuth_rad = np.arctan2(ways[:, 1], ways[:, 0]) - pose.yaw_rad
        return cls(np.hypot(*ways.T), azimuth_rad, woodworth_itd_s(azimuth_rad))


class BroadSound:
    """A sound of many frequencies."""

    def __init__(self, named: str, rate_hz: int, samples: int) -> None:
        """Takes the waveform."""
        self._dry = dry_signal(named, rate_hz)
        self._rate_hz, self._samples = rate_hz, samples
        self._lags = round(_REACH_S * rate_hz)
        self._size = 1 << int(np.ceil(np.log2(2 * samples + self._lags)))
        frequencies = np.fft.rfftfreq(self._size, 1.0 / rate_hz)
        self._band = (frequencies > _BAND_HZ[0]) & (frequencies < _BAND_HZ[1])
        self._frames: deque[tuple[NDArray[np.complex128], Array, Array, Pose]] = deque(
            maxlen=_FRAMES
        )
        self._taper = np.hanning(samples + 2)[1:-1]
        self._frame = 0
        #: Of the power of a frame's waveform (Parseval).
        self._mean = float((self._dry**2).mean()) * (samples + self._lags)

    def add(self, window: Array, pose: Pose) -> None:
        """Hears the next frame."""
        start = self._frame * self._samples - self._lags
        self._frame += 1
        dry = np.fft.rfft(_piece(self._dry, start, self._lags + self._samples), self._size)
        heard = np.fft.rfft(window * self._taper, self._size, axis=1)
        power = (np.abs(heard) ** 2).sum(axis=0)
        self._frames.append((heard * dry.conj(), power, np.abs(dry) ** 2, pose))

    def likelihood(self, cells: Array, *, again: bool = False) -> Array | None:
        """Log-likelihood ratios of places."""
        del again
        if len(self._frames) < _FRAMES:
            return None
        heard = _smoothed(np.sum([row[1] for row in self._frames], axis=0), _SMOOTH_BINS)
        dry = np.sum([row[2] for row in self._frames], axis=0)
        if dry.mean() < _PAUSE * _FRAMES * self._mean:
            return None
        dry = _smoothed(dry, _SMOOTH_BINS)
        norm = np.sqrt((heard + 1e-16) * (dry + 1e-6 * dry.max() + 1e-16))
        sounds = self._band & (dry > _LEAST * dry.max())
        weight = np.where(sounds, 1.0 / norm, 0.0)
        # A cell is wider than a peak: who is in it may be a little nearer or further away.
        within = np.rint(_WITHIN_M / _SOUND_M_S * self._rate_hz)
        told = np.zeros((len(within), len(cells)))
        total = np.zeros((2, self._lags))
        wide = max(1, round(_PEAK_S * self._rate_hz))
        at = (np.arange(self._lags) - self._lags) % self._size
        kernel = np.ones(wide) / wide
        for cross, _, _, pose in self._frames:
            lags = np.fft.irfft(cross * weight, self._size, axis=1)[:, at]
            lags = np.stack([np.convolve(ear, kernel, "same") for ear in lags])
            total += lags
            of_cells = _Geometry.of(cells, pose)
            for ear, side in ((0, -0.5), (1, 0.5)):
                delay_s = of_cells.distance_m / _SOUND_M_S + side * of_cells.itd_s
                where = np.rint(delay_s * self._rate_hz)[None, :] + within[:, None]
                where = np.clip(where, 0, self._lags - 1)
                told += lags[ear, where.astype(np.int64)]
        told = told.max(axis=0)
        noise = 1.2 * float(np.median(np.abs(total))) * np.sqrt(2.0) + 1e-12
        envelope = np.hypot(*total)
        shift = round(_EARLIER_S * self._rate_hz)
        before = np.concatenate([np.zeros(shift), np.maximum.accumulate(envelope)[:-shift]])
        middle = self._frames[-1][3].place
        away_m = np.hypot(*(cells - middle).T)
        first = np.rint(away_m / _SOUND_M_S * self._rate_hz)
        earlier = before[np.clip(first, 0, self._lags - 1).astype(np.int64)]
        loudest = float(envelope.max())
        ratio = told / (noise + _SHADOW * np.maximum(earlier - 2.0 * noise, 0.0))
        ratio[(away_m < _NEAR_M) & (told < _DIRECT * loudest)] = 0.0
        # Not cut off: of places that all are far above the noise the best one stays the best.
        ratio *= min(1.0, (_FLOOR + _CAP) / max(float(ratio.max()), 1e-9))
        found: Array = _SLOPE * np.maximum(ratio - _FLOOR, 0.0)
        if sounds.sum() < _BROAD * self._band.sum():
            return np.where(away_m < _FEW_REACH_M, found, 0.0)
        # A source next to the ears would be heard.
        missing = np.clip(1.0 - ratio / _FLOOR, 0.0, 1.0)
        found -= missing * _SILENT * np.clip(_SILENT_M - away_m, 0.0, 1.0)
        return found


class TonalSound:
    """A sound of a few tones with pauses."""

    def __init__(self, named: str, rate_hz: int, samples: int) -> None:
        """Takes the waveform, and when it begins after each pause."""
        dry = dry_signal(named, rate_hz)
        self._rate_hz, self._samples = rate_hz, samples
        self._tones = TONES_HZ[named]
        self._lags = round(_REACH_S * rate_hz)
        self._period = len(dry)
        self._begins = _beginnings(dry, rate_hz)
        #: What was heard, with where the head was in each frame.
        self._heard = np.zeros((2, 0))
        self._first, self._poses = 0, deque[Pose](maxlen=_KEPT_FRAMES)
        self._next = self._following(0)
        self._told: tuple[float, Array, Pose] | None = None

    def _following(self, sample: int) -> int:
        """The next beginning from a sample on."""
        periods, rest = divmod(sample, self._period)
        later = [begin for begin in self._begins if begin >= rest]
        return periods * self._period + (later[0] if later else self._period + self._begins[0])

    def add(self, window: Array, pose: Pose) -> None:
        """Hears the next frame."""
        self._heard = np.concatenate([self._heard, window], axis=1)
        self._poses.append(pose)
        surplus = self._heard.shape[1] - _KEPT_FRAMES * self._samples
        if surplus > 0:
            self._heard = self._heard[:, surplus:]
            self._first += surplus
        end = self._first + self._heard.shape[1]
        if end >= self._next + self._lags + round(_PLATEAU_S[1] * self._rate_hz):
            self._notice(self._next - self._first)
            self._next = self._following(self._next + 1)

    def _notice(self, begin: int) -> None:
        """When and how a beginning arrived that was made at a sample of what is kept."""
        rate = self._rate_hz
        before = begin - round(0.02 * rate)
        if before < 0:
            return
        width = round(_PHASOR_S * rate)
        taper = np.hanning(width + 2)[1:-1]
        taper /= taper.sum()
        piece = self._heard[:, before:]
        times_s = np.arange(piece.shape[1]) / rate
        tones = []
        for tone_hz in self._tones:
            turned = piece * np.exp(-2j * np.pi * tone_hz * times_s)
            tones.append([np.convolve(ear, taper, "same") for ear in turned])
        phasors: NDArray[np.complex128] = np.array(tones)
        powers = (np.abs(phasors) ** 2).sum(axis=1)
        made = begin - before
        # Of what was there before: other sounds may hide some of the tones.
        noises = np.median(powers[:, : made - width // 2], axis=1, keepdims=True)
        level = np.sqrt((powers / (noises + 1e-14)).mean(axis=0))
        plateau = [made + round(s * rate) for s in _PLATEAU_S]
        loud = float(np.median(level[plateau[0] : plateau[1]]))
        if loud < _CLEAR:
            return
        bound = max(_NOTICED, _ONSET * loud)
        arrived = made + int(np.argmax(level[made:] > bound))
        delay_s = (arrived - made) / rate - _RISE_S
        piece_of = slice(arrived, arrived + width)
        first = np.array([ear[piece_of] for ear in phasors.reshape(-1, phasors.shape[-1])])
        ears = first.reshape(len(self._tones), 2, -1)
        cross = (ears[:, 0] * ears[:, 1].conj()).sum(axis=1)
        of_ears = (np.abs(ears) ** 2).sum(axis=2)
        which = min((begin + round(delay_s * rate)) // self._samples, len(self._poses) - 1)
        told = np.stack([cross.real, cross.imag, of_ears[:, 0], of_ears[:, 1]])
        self._told = (delay_s, told, self._poses[max(which, 0)])

    def likelihood(self, cells: Array, *, again: bool = False) -> Array | None:
        """Log-likelihood ratios of places."""
        if self._told is None:
            return None
        delay_s, told, pose = self._told
        if not again:
            self._told = None
        of_cells = _Geometry.of(cells, pose)
        away_m = of_cells.distance_m - max(delay_s, 0.0) * _SOUND_M_S
        fit = np.exp(-0.5 * (away_m / _SPREAD_M) ** 2)
        fit = np.maximum(fit, 0.5 * np.exp(np.minimum(away_m, 0.0) / _LONGER_M) * (away_m < 0.0))
        side = np.zeros(len(cells))
        for tone_hz, (real, imaginary, left, right) in zip(self._tones, told.T, strict=True):
            coherence = np.hypot(real, imaginary) / np.sqrt(left * right + 1e-30)
            phase = np.arctan2(imaginary, real)
            expected = 2.0 * np.pi * tone_hz * of_cells.itd_s
            weight = _PHASE_WEIGHT * (_PLAIN if tone_hz < _AMBIGUOUS_HZ else 1.0)
            side += weight * coherence * np.cos(phase - expected)
            if tone_hz > _SHADOW_HZ:
                found_db = np.clip(10.0 * np.log10((left + 1e-30) / (right + 1e-30)), -15.0, 15.0)
                away_db = found_db - _AT_THE_SIDE_DB * np.sin(of_cells.azimuth_rad)
                side -= 0.5 * np.minimum((away_db / _SPREAD_DB) ** 2, 4.0)
        side -= side.max()
        likelihood: Array = np.log(_OUTLIERS + (1.0 - _OUTLIERS) * _GAIN * fit * np.exp(side))
        return likelihood


def _beginnings(dry: Array, rate_hz: int) -> list[int]:
    """Samples of a period at which a signal begins after a pause."""
    piece = round(0.01 * rate_hz)
    count = len(dry) // piece
    power = (dry[: count * piece].reshape(count, piece) ** 2).mean(axis=1)
    sounds = power > 1e-3 * power.max()
    found = []
    for k in np.flatnonzero(sounds & ~np.roll(sounds, 1)):
        at = int(k) * piece
        rows = np.flatnonzero(np.abs(dry[at : at + piece]) > 1e-9)
        found.append(at + int(rows[0]))
    return found
