"""What sounds in a clip: the engine's signals, or files of one's own, by class."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, DwellError, MeasuredDataError
from dwell.arguments import quoted
from dwell.sounds import read_wav, signals, synthesize

#: Signals of a household that come from one place; those for measuring are no classes.
SIGNALS = (
    "alarm",
    "clock",
    "doorbell",
    "footsteps",
    "hair_dryer",
    "kettle",
    "phone",
    "radio",
    "speech",
    "tap",
    "television",
    "vacuum_cleaner",
)
#: The signals that appliances of houses have beside those.
_OF_HOUSES = ("dishwasher", "fan", "fridge", "hum", "microwave", "toilet_flush", "washing_machine")
#: Of a file, dB SPL at 1 m, as a lively voice; the files' own levels mean nothing.
_FILE_LEVEL_DB = 65.0
_REFERENCE_PA = 2e-5
_MAX_FILES = 100_000
#: Of a file: its samples a second, and how long it is, s. More would take memory without bound.
_RATES_HZ, _MAX_S = (1_000, 384_000), 300.0
#: Sounds begin and end so softly, s.
_EDGE_S = 0.005
#: Mean power of a stretch in which a sound is there, over that of the whole sound.
_SOUNDING = 0.1


@dataclass(frozen=True)
class Sound:
    """One sound: a signal by its name, or a file.

    Attributes:
        name: The signal, or the file below the folder.
        class_index: Its class.
        level_db: Its level at 1 m, dB SPL over its whole length.
    """

    name: str
    class_index: int
    level_db: float


class Pool:
    """All sounds of a data set, by class."""

    def __init__(self, sounds: str) -> None:
        """Lists the sounds, and reads each file once.

        Args:
            sounds: ``signals``, ``household``, or a folder with a folder of WAV files a class.

        Raises:
            ConfigError: There is no such folder, or none with a sound in it.
            MeasuredDataError: A file is no sound.
            OSError: The system refuses.
        """
        self._folder: Path | None = None
        if sounds in ("signals", "household"):
            levels = {row["name"]: float(row["usual_level_db"]) for row in signals()}
            of_houses = _OF_HOUSES if sounds == "household" else ()
            self.classes = sorted({*SIGNALS, *of_houses})
            self.sounds = [Sound(name, k, levels[name]) for k, name in enumerate(self.classes)]
            return
        self._folder = Path(sounds)
        if not self._folder.is_dir():
            raise ConfigError(
                f"sounds is {quoted(sounds)}; allowed are signals, household, or a folder that has "
                "a folder of WAV files for each class"
            )
        found = sorted(self._folder.glob("*/*.wav"))[: _MAX_FILES + 1]
        if not found or len(found) > _MAX_FILES:
            raise ConfigError(
                f"sounds: {len(found)} files CLASS/NAME.wav in {sounds!r}; allowed are 1 to "
                f"{_MAX_FILES}"
            )
        self.classes = sorted({path.parent.name for path in found})
        self.sounds = []
        for path in found:
            name = path.relative_to(self._folder).as_posix()
            self._read(name)
            kind = self.classes.index(path.parent.name)
            self.sounds.append(Sound(name, kind, _FILE_LEVEL_DB))

    def _read(self, name: str) -> tuple[NDArray[np.float64], int]:
        path = os.path.join(self._folder or "", name)
        channels, rate_hz = read_wav(path)
        low, high = _RATES_HZ
        if not low <= rate_hz <= high:
            raise ConfigError(
                f"{path}: {rate_hz} samples a second; allowed are {low} to {high}: write it anew "
                "with the rate it was recorded at"
            )
        if channels.shape[1] > _MAX_S * rate_hz:
            raise ConfigError(
                f"{path}: {channels.shape[1] / rate_hz:.0f} s long; allowed are {_MAX_S:g} s: cut "
                "it into several files"
            )
        mono = channels.mean(axis=0, dtype=np.float64)
        if not np.any(mono):
            raise ConfigError(f"{path}: its samples are none, or silent")
        return mono, rate_hz

    def _read_again(self, name: str) -> tuple[NDArray[np.float64], int]:
        try:
            return self._read(name)
        except DwellError as error:
            raise MeasuredDataError(f"{error}; it was a sound when the run began") from error

    def stretch(
        self, sound: Sound, rate_hz: int, count: int, heard: int, start: float
    ) -> tuple[float, int]:
        """Where a sound begins so that it sounds, and how many samples it then has.

        Args:
            sound: One of :attr:`sounds`.
            rate_hz: Samples a second.
            count: How many samples at most.
            heard: How many of them are heard, from the first on.
            start: Where to begin, as of :meth:`samples`. It stays where the sound sounds from
                there on; the places where it does not are spread evenly over those where it does.

        Raises:
            MeasuredDataError: A file is no sound any more.
            OSError: The system refuses to read a file.
        """
        edge = round(_EDGE_S * rate_hz)
        first, last = edge, min(count - edge, heard)
        if self._folder is None:
            whole = _loop(sound.name, rate_hz)
            starts = len(whole)
            if not 0 < last - first < starts:
                return start, count
            around = np.resize(whole, starts + last)
        else:
            around, own_hz = self._read_again(sound.name)
            count = min(count, _resampled_size(len(around), own_hz, rate_hz))
            first, last, own_count = (round(n * own_hz / rate_hz) for n in (first, last, count))
            starts = len(around) - own_count
            if starts <= 0 or last <= first:
                return start, count
            whole = around
        energy = np.concatenate(([0.0], np.cumsum(around**2)))
        power = (energy[last : last + starts] - energy[first : first + starts]) / (last - first)
        is_there = power >= min(_SOUNDING * float(np.mean(whole**2)), float(power.max()))
        at = min(int(start * starts), starts - 1)
        if not is_there[at]:
            there, silent = np.flatnonzero(is_there), np.flatnonzero(~is_there)
            place = int(np.searchsorted(silent, at)) * len(there) // len(silent)
            start = (float(there[place]) + 0.5) / starts
        return start, count

    def samples(self, sound: Sound, rate_hz: int, count: int, start: float) -> NDArray[np.float64]:
        """Pressure at 1 m, Pa: so many samples of a signal from anywhere in its loop, or of a file.

        Args:
            sound: One of :attr:`sounds`.
            rate_hz: Samples a second.
            count: How many samples at most; a file may be shorter.
            start: Where to begin, 0 to 1 of the loop, or of what a file is too long.

        Raises:
            MeasuredDataError: A file is no sound any more.
            OSError: The system refuses to read a file.
        """
        if self._folder is None:
            whole = _loop(sound.name, rate_hz)
            level = np.sqrt(np.mean(whole**2))
            first = int(start * len(whole))
            cut = np.take(whole, np.arange(first, first + count), mode="wrap")
        else:
            mono, own_hz = self._read_again(sound.name)
            whole = resampled(mono, own_hz, rate_hz)
            level = np.sqrt(np.mean(whole**2))
            first = int(start * max(len(whole) - count, 0))
            cut = whole[first : first + count].copy()
        found: NDArray[np.float64] = cut * (_REFERENCE_PA * 10.0 ** (sound.level_db / 20.0) / level)
        return _faded(found, rate_hz)


@functools.lru_cache(64)
def _loop(signal: str, rate_hz: int) -> NDArray[np.float64]:
    """A signal's loop."""
    return synthesize(signal, rate_hz=rate_hz).astype(np.float64)


def _faded(sound: NDArray[np.float64], rate_hz: int) -> NDArray[np.float64]:
    """Begins and ends within 5 ms, without a click."""
    edge = min(round(_EDGE_S * rate_hz), len(sound) // 2)
    if edge:
        ramp = 0.5 - 0.5 * np.cos(np.pi * (np.arange(edge) + 0.5) / edge)
        sound[:edge] *= ramp
        sound[-edge:] *= ramp[::-1]
    return sound


def resampled(sound: NDArray[np.float64], from_hz: int, to_hz: int) -> NDArray[np.float64]:
    """A sound at another rate, by its spectrum."""
    if from_hz == to_hz:
        return sound
    # Zeros after the end, so that it does not come around to the beginning.
    padded = np.concatenate((sound, np.zeros(min(len(sound), from_hz // 10))))
    step = np.gcd(from_hz, to_hz)
    padded = np.concatenate((padded, np.zeros(-len(padded) % (from_hz // step))))
    count = len(padded) * to_hz // from_hz
    spectrum = np.fft.rfft(padded)
    kept = np.zeros(count // 2 + 1, complex)
    shared = min(len(kept), len(spectrum))
    kept[:shared] = spectrum[:shared]
    found: NDArray[np.float64] = np.fft.irfft(kept, count) * (count / len(padded))
    return found[: _resampled_size(len(sound), from_hz, to_hz)]


def _resampled_size(count: int, from_hz: int, to_hz: int) -> int:
    """How many samples a sound has at another rate."""
    return count if from_hz == to_hz else max(1, round(count * to_hz / from_hz))
