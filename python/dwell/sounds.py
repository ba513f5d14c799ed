"""Sound files, with the standard library alone; and the built-in signals."""

from __future__ import annotations

import json
import os
import wave
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.files import open_file

#: A sound file has at most so many bytes.
_MOST_BYTES = 512 * 2**20


def write_wav(
    path: str | os.PathLike[str], sound: NDArray[Any], rate_hz: int, *, full_scale_pa: float
) -> None:
    """Writes pressure as 16-bit WAV.

    Args:
        path: The file.
        sound: Shape (channel, sample), Pa.
        rate_hz: Samples a second.
        full_scale_pa: The pressure that becomes full scale, Pa; louder samples are clipped.
    """
    scaled = np.clip(sound / full_scale_pa, -1.0, 1.0) * 32767.0
    with wave.open(os.fspath(path), "wb") as file:
        file.setnchannels(max(sound.shape[0], 1))
        file.setsampwidth(2)
        file.setframerate(rate_hz)
        file.writeframes(np.rint(scaled.T).astype("<i2").tobytes())


def read_wav(path: str | os.PathLike[str]) -> tuple[NDArray[np.float32], int]:
    """Reads 16-bit WAV: shape (channel, sample) in [-1, 1], and the samples a second.

    Raises:
        ValueError: It has more than 512 MiB.
        OSError: The system refuses, or it is no regular file.
    """
    with open_file(path, _MOST_BYTES) as opened, wave.open(opened) as file:
        frames = np.frombuffer(file.readframes(file.getnframes()), "<i2")
        channels = file.getnchannels()
        rate_hz = file.getframerate()
    return (frames.reshape(-1, channels).T / 32767.0).astype(np.float32), rate_hz


def signals() -> list[dict[str, Any]]:
    """The built-in signals: name, description, loop_s, usual_level_db (at 1 m), level_source."""
    rows: list[dict[str, Any]] = json.loads(_native.signals_json())
    return rows
