"""Diffuse noise: what an array hears of equal and independent sound from all sides."""

from __future__ import annotations

import functools
import itertools

import numpy as np
from numpy.typing import NDArray

from dwell.acoustics import AcousticScene
from dwell.house import House
from dwell.localization.draws import Draws
from dwell.localization.layouts import Layout

#: Directions that stand for all; how far the sources there are, m; edge of the room without echo.
_DIRECTIONS, _AWAY_M, _EDGE_M = 256, 5.0, 40.0
#: Taps of each direction's response, and samples before its delay.
_TAPS, _LEAD = 256, 64
#: Below it noise falls no more towards high frequencies (pink above), Hz.
_PINK_FROM_HZ = 50.0


@functools.lru_cache(32)
def _roots(layout: Layout, rate_hz: int) -> NDArray[np.complex128]:
    """At each frequency the square root of the coherence between channels: (bin, m, m)."""
    room = House.shoebox((_EDGE_M, _EDGE_M, _EDGE_M), absorption=1.0)
    free = AcousticScene(room, rays=0, image_order=0, rate_hz=rate_hz, air_absorption=False)
    middle = 0.5 * _EDGE_M
    receiver = layout.receiver((middle, middle, middle), 0.0)
    first = int(_AWAY_M / 343.2 * rate_hz) - _LEAD
    covariance = np.zeros((_TAPS // 2 + 1, layout.channels, layout.channels), complex)
    for k in range(_DIRECTIONS):
        # A spiral of equal areas (R. Swinbank, R. J. Purser, 2006).
        up = 1.0 - (2.0 * k + 1.0) / _DIRECTIONS
        level, turn = np.sqrt(1.0 - up * up), np.pi * (1.0 + np.sqrt(5.0)) * k
        away = _AWAY_M * np.array([level * np.cos(turn), up, level * np.sin(turn)])
        x, y, z = (float(middle + part) for part in away)
        heard = free.impulse_responses((x, y, z), [receiver], threads=1)[0]
        spectra = np.fft.rfft(heard[:, first : first + _TAPS].astype(np.float64), _TAPS).T
        covariance += spectra[:, :, None] * spectra[:, None].conj()
    covariance /= np.mean(np.trace(covariance, axis1=1, axis2=2).real) / layout.channels
    values, vectors = np.linalg.eigh(covariance)
    scaled = vectors * np.sqrt(np.maximum(values, 0.0))[:, None]
    found: NDArray[np.complex128] = scaled @ vectors.conj().transpose(0, 2, 1)
    return found


def diffuse_noise(
    layout: Layout, rate_hz: int, samples: int, *key: str | int
) -> NDArray[np.float64]:
    """Pink noise from all sides at an array, of a power of 1 in the mean over channels.

    Channels are as coherent as a diffuse field makes them: sin(kd) / (kd) between two open
    microphones d apart (R. K. Cook et al., JASA 27, 1072 (1955)).

    Args:
        layout: The array.
        rate_hz: Samples a second.
        samples: How many.
        *key: What it is drawn from.

    Returns:
        Shape (channel, sample).
    """
    roots = _roots(layout, rate_hz)
    draws = Draws("localize noise", *key)
    size = samples + samples % 2
    white = np.stack([np.fft.rfft(draws.normals(size)) for _ in range(layout.channels)], axis=1)
    hz = np.fft.rfftfreq(size, 1.0 / rate_hz)
    white /= np.sqrt(np.maximum(hz, _PINK_FROM_HZ))[:, None]
    white[0] = 0.0
    place = hz / rate_hz * _TAPS
    mixed = np.empty_like(white)
    # Between two frequencies of the table what both would make is blended.
    edges = np.searchsorted(place, np.arange(len(roots)))
    edges[-1] = len(hz)
    for k, (first, last) in enumerate(itertools.pairwise(edges)):
        part = (place[first:last] - k)[:, None]
        # Not by BLAS, whose sums may depend on how many threads it has.
        some = white[first:last]
        low, high = (np.einsum("fj,ij->fi", some, root) for root in roots[k : k + 2])
        mixed[first:last] = (1.0 - part) * low + part * high
    found = np.fft.irfft(mixed.T, size)[:, :samples]
    scaled: NDArray[np.float64] = found / np.sqrt(np.mean(found**2))
    return scaled
