"""Sound files, with the standard library alone, and sounds that a world is told to play."""

from __future__ import annotations

import json
import os
import wave
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.arguments import finite, flag, path, point, to_json, whole


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
    """Reads 16-bit WAV: shape (channel, sample) in [-1, 1], and the samples a second."""
    with wave.open(os.fspath(path), "rb") as file:
        frames = np.frombuffer(file.readframes(file.getnframes()), "<i2")
        channels = file.getnchannels()
        rate_hz = file.getframerate()
    return (frames.reshape(-1, channels).T / 32767.0).astype(np.float32), rate_hz


def signals() -> list[dict[str, Any]]:
    """The built-in signals: name, description, loop_s, usual_level_db (dB SPL at 1 m), level_source."""
    rows: list[dict[str, Any]] = json.loads(_native.signals_json())
    return rows


#: What the names of sound files end with.
_ENDINGS = (".wav", ".flac", ".ogg", ".oga")


def play_json(
    sound: str | os.PathLike[str],
    at: str | int | Sequence[float],
    *,
    level_db: float | None,
    loop: bool,
) -> str:
    """What ``World.play`` asks of the native side.

    Raises:
        ConfigError: For what is no name, place, level or flag.
    """
    name = path("sound", sound)
    kind = "file" if name.lower().endswith(_ENDINGS) else "signal"
    place: dict[str, object]
    if isinstance(at, str):
        place = {"object": at}
    elif isinstance(at, int | np.integer):
        place = {"agent": whole("at", at)}
    else:
        place = {"position": point("at", at)}
    return to_json(
        {
            "sound": {kind: name},
            "at": place,
            "level_db": None if level_db is None else finite("level_db", level_db),
            "loops": flag("loop", loop),
        }
    )
