"""Convolution of long sounds with responses, by overlap and add."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def convolved(sound: NDArray[np.float64], responses: NDArray[np.float64]) -> NDArray[np.float64]:
    """A sound through a response for each channel.

    Args:
        sound: Shape (sample,), or (channel, sample).
        responses: Shape (channel, tap).

    Returns:
        Shape (channel, sample + tap - 1).
    """
    count, taps = sound.shape[-1], responses.shape[1]
    size = 1 << int(np.ceil(np.log2(max(2 * taps, 1024))))
    size = min(size, 1 << int(np.ceil(np.log2(count + taps - 1))))
    hop = size - taps + 1
    blocks = -(-count // hop)
    padded = np.zeros((*sound.shape[:-1], blocks * hop))
    padded[..., :count] = sound
    spectra = np.fft.rfft(padded.reshape(*sound.shape[:-1], blocks, hop), size)
    filters = np.fft.rfft(responses, size)[:, None]
    pieces = np.fft.irfft(filters * spectra, size)
    out = np.zeros((len(responses), (blocks + 1) * hop + size))
    for block in range(blocks):
        out[:, block * hop : block * hop + size] += pieces[:, block]
    return out[:, : count + taps - 1]


def add_at(out: NDArray[np.float64], at: int, piece: NDArray[np.float64]) -> None:
    """Adds what lies within ``out`` when the piece begins at a sample, which may be negative."""
    first, last = max(at, 0), min(at + piece.shape[1], out.shape[1])
    if first < last:
        out[:, first:last] += piece[:, first - at : last - at]


#: How much finer a sound is sampled before it is read between samples.
_FINER = 8


def _quick_size(count: int) -> int:
    """The next length of a transform that is quick: 4, 5, 6 or 8 times a power of two."""
    power = 1 << max(0, int(np.ceil(np.log2(count))) - 3)
    return next(k * power for k in (4, 5, 6, 8) if k * power >= count)


class Delayed:
    """A sound that can be read between its samples."""

    def __init__(self, sound: NDArray[np.float64]) -> None:
        """Samples it more finely, by its spectrum; it is silent before and after."""
        margin = 64
        padded = np.zeros(_quick_size(len(sound) + 2 * margin))
        padded[margin : margin + len(sound)] = sound
        spectrum = np.fft.rfft(padded)
        self._fine = np.fft.irfft(spectrum, _FINER * len(padded)) * _FINER
        self._margin = margin

    def at(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Its pressure at places in samples: cubic polynomials through four fine samples."""
        fine = (places + self._margin) * _FINER
        whole = np.floor(fine).astype(np.int64)
        part = fine - whole
        is_in = (whole >= 1) & (whole < len(self._fine) - 2)
        whole = np.where(is_in, whole, 1)
        before, here, after, later = (self._fine[whole + k] for k in (-1, 0, 1, 2))
        # Lagrange's form.
        found = (
            -before * part * (part - 1.0) * (part - 2.0) / 6.0
            + here * (part + 1.0) * (part - 1.0) * (part - 2.0) / 2.0
            - after * (part + 1.0) * part * (part - 2.0) / 2.0
            + later * (part + 1.0) * part * (part - 1.0) / 6.0
        )
        return np.where(is_in, found, 0.0)
