"""A sound as a picture: time to the right, frequency up, level as colour."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dwell.false_color import scale_colors

_WINDOW = 512
_HOP = 160
_RANGE_DB = 70.0


def levels_db(sound: NDArray[Any]) -> NDArray[np.float64]:
    """Levels of one channel, dB re its loudest cell; shape (frequency, time)."""
    if sound.shape[0] < _WINDOW:
        sound = np.pad(sound, (0, _WINDOW - sound.shape[0]))
    windows = np.lib.stride_tricks.sliding_window_view(sound, _WINDOW)[::_HOP]
    spectrum = np.abs(np.fft.rfft(windows * np.hanning(_WINDOW), axis=1)).T
    loudest = max(float(spectrum.max()), 1e-12)
    levels: NDArray[np.float64] = 20.0 * np.log10(np.maximum(spectrum / loudest, 1e-8))
    return levels


def save_spectrogram(sound: NDArray[Any], rate_hz: int, path: Path) -> None:
    """Draws both ears, left above right; ``sound``: shape (channel, sample)."""
    width, height, margin = 960, 180, 44
    canvas = Image.new("RGB", (width + margin, (height + 26) * sound.shape[0]), "white")
    draw = ImageDraw.Draw(canvas)
    for k, channel in enumerate(sound):
        cells = np.clip(1.0 + levels_db(channel) / _RANGE_DB, 0.0, 1.0)
        image = Image.fromarray(scale_colors(cells[::-1])).resize((width, height))
        top = k * (height + 26)
        canvas.paste(image, (margin, top))
        draw.text((4, top + 2), f"{rate_hz / 2000:.0f} kHz", fill="black")
        draw.text((4, top + height - 14), "0", fill="black")
        ear = ("left ear", "right ear")[k] if sound.shape[0] == 2 else "microphone"
        seconds = channel.shape[0] / rate_hz
        draw.text((margin, top + height + 6), f"{ear}, 0 to {seconds:.1f} s", fill="black")
    canvas.save(path)
