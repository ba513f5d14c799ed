"""Textbook estimators of directions: GCC-PHAT, SRP-PHAT, MUSIC and the intensity vector.

Each is told how many sources sound, and says where they are. All are NumPy alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.localization.layouts import Layout
from dwell.localization.steering import (
    SPEED_M_S,
    around,
    microphones,
    peaks,
    sphere,
    steering,
    steering_to_sphere,
)

#: Length of a block, s; which frequencies are used, Hz.
_BLOCK_S, _BAND_HZ = 0.02, (300.0, 5_000.0)
#: The ears' sphere, m.
_HEAD_M = 0.0875
_Vectors = NDArray[np.float64]


@dataclass(frozen=True)
class Blocks:
    """Spectra of short blocks of a recording.

    Attributes:
        spectra: Shape (frequency, block, channel).
        hz: The frequencies, Hz.
        layout: The array.
    """

    spectra: NDArray[np.complex128]
    hz: NDArray[np.float64]
    layout: Layout


def blocks_of(sound: NDArray[np.floating[Any]], rate_hz: int, layout: Layout) -> Blocks:
    """Windowed blocks, half of each in the next, of a sound of shape (channel, sample)."""
    size = 1 << int(np.ceil(np.log2(_BLOCK_S * rate_hz)))
    padded = np.pad(sound.astype(np.float64), ((0, 0), (0, max(0, size - sound.shape[1]))))
    pieces: NDArray[np.float64] = np.lib.stride_tricks.sliding_window_view(padded, size, axis=1)[
        :, :: size // 2
    ]
    spectra = np.fft.rfft(pieces * np.hanning(size), axis=2).transpose(2, 1, 0)
    hz: NDArray[np.float64] = np.fft.rfftfreq(size, 1.0 / rate_hz).astype(np.float64)
    used = (hz >= _BAND_HZ[0]) & (hz <= _BAND_HZ[1])
    return Blocks(spectra[used], hz[used], layout)


def gcc_phat(blocks: Blocks, count: int) -> _Vectors:
    """Directions by the delay between two microphones (C. Knapp, G. Carter, 1976).

    Two microphones know one angle: directions are level and ahead, not above or behind.
    """
    layout = blocks.layout
    first, second, axis, apart_m = _widest_pair(layout)
    cross = blocks.spectra[:, :, first] * blocks.spectra[:, :, second].conj()
    phat = np.sum(cross / np.maximum(np.abs(cross), 1e-30), axis=1)
    # Every degree from the pair's one end to the other, and when the second hears it later.
    angle = np.radians(np.arange(-90.0, 90.5))
    later_s = apart_m / SPEED_M_S * np.sin(angle)
    if layout.kind == "binaural":
        # R. Woodworth, H. Schlosberg (1954).
        later_s = _HEAD_M / SPEED_M_S * (np.sin(angle) + angle)
    scores = (phat @ np.exp(-2j * np.pi * blocks.hz[:, None] * later_s)).real
    # Ahead is at right angles to the pair.
    ahead = np.array((axis[1], -axis[0], 0.0))
    ahead = ahead if (ahead[0], ahead[1]) > (0.0, 0.0) else -ahead
    level = np.sin(angle)[:, None] * axis + np.cos(angle)[:, None] * ahead
    return peaks(level, scores, count)


def _widest_pair(layout: Layout) -> tuple[int, int, _Vectors, float]:
    """Two microphones farthest apart from left to right, and the level axis to the first."""
    if layout.kind == "binaural":
        return 0, 1, np.array((0.0, 1.0, 0.0)), 2.0 * _HEAD_M
    places = microphones(layout) * (1.0, 1.0, 0.0)
    between = places[:, None] - places[None]
    wide = between[:, :, 1] - 0.1 * np.abs(between[:, :, 0])
    first, second = np.unravel_index(int(np.argmax(wide)), wide.shape)
    apart = float(np.linalg.norm(between[first, second]))
    if apart < 0.005:
        raise ConfigError(f"gcc_phat: no two microphones of {layout.name} are beside each other")
    return int(first), int(second), between[first, second] / apart, apart


def srp_phat(blocks: Blocks, count: int) -> _Vectors:
    """Directions of the strongest steered response (J. DiBiase, 2000).

    Microphones are weighted alike at each frequency; ambisonic channels, whose levels tell
    directions, together.
    """
    loudness = np.abs(blocks.spectra)
    if blocks.layout.kind == "ambisonics":
        loudness = np.linalg.norm(loudness, axis=2, keepdims=True)
    white = blocks.spectra / np.maximum(loudness, 1e-30)
    covariance = np.einsum("ftm,ftn->fmn", white, white.conj())

    def score(directions: _Vectors) -> NDArray[np.float64]:
        waves = _steered(blocks.layout, directions, blocks.hz)
        found: NDArray[np.float64] = np.sum((waves.conj() @ covariance) * waves, axis=(0, 2)).real
        return found

    return _refined(score, count)


def music(blocks: Blocks, count: int) -> _Vectors:
    """Directions that the noise's subspace lacks (R. Schmidt, 1986), averaged over frequency."""
    channels = blocks.layout.channels
    if count >= channels:
        raise ConfigError(f"music: {count} sources at {channels} channels; expected fewer sources")
    covariance = np.einsum("ftm,ftn->fmn", blocks.spectra, blocks.spectra.conj())
    # Eigenvectors of the smallest eigenvalues come first.
    noise = np.linalg.eigh(covariance)[1][:, :, : channels - count]
    power = np.trace(covariance, axis1=1, axis2=2).real
    # What is 30 dB below the loudest frequency says little.
    weights = (power > 1e-3 * power.max(initial=0.0)).astype(np.float64)

    def score(directions: _Vectors) -> NDArray[np.float64]:
        waves = _steered(blocks.layout, directions, blocks.hz)
        share = np.sum(np.abs(waves.conj() @ noise) ** 2, axis=2)
        found: NDArray[np.float64] = weights @ (1.0 / np.maximum(share, 1e-6))
        return found

    return _refined(score, count)


def intensity(blocks: Blocks, count: int) -> _Vectors:
    """Directions of the active intensity of first-order channels (V. Pulkki, 2007).

    One source: the sum over all blocks and frequencies; several: where most of it points.
    """
    if blocks.layout.kind != "ambisonics":
        raise ConfigError(f"intensity: {blocks.layout.name} is no ambisonics; expected foa or kin")
    pressure, left, up, front = np.moveaxis(blocks.spectra[:, :, :4], 2, 0)
    flow = np.stack([(pressure.conj() * way).real for way in (front, left, up)], axis=2)
    rows = flow.reshape(-1, 3)
    if count == 1:
        return _unit(rows.sum(axis=0, keepdims=True))
    weights, units = np.linalg.norm(rows, axis=1), _unit(rows)
    # Louder bins count less than by their energy, so that one source does not hide another.
    weights = np.sqrt(weights)

    def score(directions: _Vectors) -> NDArray[np.float64]:
        found: NDArray[np.float64] = np.exp(30.0 * (directions @ units.T - 1.0)) @ weights
        return found

    return _refined(score, count)


def _steered(
    layout: Layout, directions: _Vectors, hz: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """What channels hear of plane waves; to the whole sphere from memory."""
    if directions is sphere():
        return steering_to_sphere(layout, tuple(map(float, hz)))
    return steering(layout, directions, hz)


def _unit(rows: _Vectors) -> _Vectors:
    found: _Vectors = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-30)
    return found


def _refined(score: Callable[[_Vectors], NDArray[np.float64]], count: int) -> _Vectors:
    """Peaks over the sphere, each to a degree."""
    found = []
    for coarse in peaks(sphere(), score(sphere()), count):
        fine = around(coarse)
        found.append(fine[int(np.argmax(score(fine)))])
    return np.array(found).reshape(-1, 3)


#: By name, what takes blocks and a number of sources and gives directions (source, 3).
BASELINES: dict[str, Callable[[Blocks, int], _Vectors]] = {
    "gcc_phat": gcc_phat,
    "srp_phat": srp_phat,
    "music": music,
    "intensity": intensity,
}


def fits(name: str, layout: Layout) -> str | None:
    """Why a baseline cannot use an array; ``None``: it can."""
    if name == "intensity" and layout.kind != "ambisonics":
        return "intensity needs ambisonics (foa, hoa2, hoa3)"
    if name == "gcc_phat" and (layout.kind == "ambisonics" or layout.channels < 2):
        return "gcc_phat needs two microphones at different places"
    if name in ("srp_phat", "music") and (layout.kind == "binaural" or layout.channels < 2):
        return f"{name} needs an array or ambisonics, whose waves are known without a head"
    return None
