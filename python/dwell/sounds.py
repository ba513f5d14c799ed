"""Sound files, with the standard library alone; and the built-in signals."""

from __future__ import annotations

import os
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, MeasuredDataError, _native, arguments
from dwell.arguments import above_zero, integer_in_range, real_array
from dwell.files import atomic_write, open_file, read

#: A sound file that is read has at most so many bytes.
_MAX_READ_BYTES = 512 * 2**20

#: Formats of samples in a WAV file: whole numbers, numbers of IEEE 754, and what is told later on.
_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
#: What one sample of all channels takes has 16 bits.
_MAX_FRAME_BYTES = 2**16 - 1
#: Chunks have lengths of 32 bits.
_MAX_WAV_BYTES = 2**32 - 256


def write_wav(
    path: str | os.PathLike[str],
    sound: NDArray[Any],
    rate_hz: int,
    *,
    full_scale_pa: float | None = None,
) -> None:
    """Writes pressure as WAV, whole or not at all: 32-bit float in Pa, or 16 bits.

    Args:
        path: The file.
        sound: Shape (channel, sample), Pa.
        rate_hz: Samples a second.
        full_scale_pa: None: 32-bit float, where 1.0 is 1 Pa. Else 16 bits, for programs that read
            no float, and the pressure that becomes full scale, Pa, above 0; louder samples are
            clipped.

    Raises:
        ConfigError: `sound` is no table of finite real numbers with at least one channel, or more
            than a WAV file holds (4 GiB, 65,535 bytes for a sample of all channels, as many bytes
            a second as 32 bits count), `rate_hz` no whole number from 1, or `full_scale_pa` no
            number above 0.
        OSError: The system refuses, or something stands there that is no regular file.
    """
    sound = real_array("sound", sound, np.float64)
    if sound.ndim != 2 or not sound.shape[0]:
        raise ConfigError(f"sound: expected the shape (channel, sample), found {sound.shape}")
    if not np.isfinite(sound).all():
        raise ConfigError("sound: allowed are finite numbers, Pa")
    if full_scale_pa is None:
        if sound.size and np.abs(sound).max() > np.finfo(np.float32).max:
            raise ConfigError(f"sound: found {np.abs(sound).max():g} Pa; 32 bits hold up to 3e38")
        form, samples = _FLOAT, sound.T.astype("<f4")
    else:
        full = above_zero("full_scale_pa", full_scale_pa)
        scaled = np.clip(sound.T / full, -1.0, 1.0) * 32767.0
        form, samples = _PCM, np.rint(scaled).astype("<i2")
    if samples.nbytes > _MAX_WAV_BYTES:
        raise ConfigError(f"sound: {samples.nbytes} bytes; a WAV file holds {_MAX_WAV_BYTES}")
    channels, width = sound.shape[0], samples.itemsize
    if channels * width > _MAX_FRAME_BYTES:
        most = _MAX_FRAME_BYTES // width
        raise ConfigError(f"sound: {channels} channels; a WAV file of such samples holds {most}")
    rate_hz = integer_in_range("rate_hz", rate_hz, low=1, high=(2**32 - 1) // (channels * width))
    rates = (rate_hz, rate_hz * channels * width, channels * width, 8 * width)
    chunks = [(b"fmt ", struct.pack("<HHIIHH", form, channels, *rates))]
    if form == _FLOAT:
        # Formats other than PCM tell the size of an extension, and how many samples there are.
        chunks[0] = (b"fmt ", chunks[0][1] + struct.pack("<H", 0))
        chunks.append((b"fact", struct.pack("<I", sound.shape[1])))
    chunks.append((b"data", samples.tobytes()))
    body = b"WAVE" + b"".join(
        name + struct.pack("<I", len(content)) + content for name, content in chunks
    )
    with atomic_write(arguments.file_path("path", path)) as draft:
        draft.write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)


def read_wav(
    path: str | os.PathLike[str], *, full_scale_pa: float = 1.0
) -> tuple[NDArray[np.float32], int]:
    """Reads WAV of 16, 24 or 32 bits, or of 32- or 64-bit float.

    Args:
        path: The file.
        full_scale_pa: Of whole numbers, the pressure at full scale, Pa, above 0; 1: fractions
            of it.

    Returns:
        The sound, shape (channel, sample), Pa, and the samples a second.

    Raises:
        ConfigError: ``full_scale_pa`` is no number above 0.
        MeasuredDataError: The file is no WAV, is shorter than its header says, holds samples of
            another form or such that are no finite numbers of 32 bits, or has more than 512 MiB.
        OSError: The system refuses, or it is no regular file.
    """
    full_scale_pa = above_zero("full_scale_pa", full_scale_pa)
    try:
        file = read(arguments.file_path("path", path), _MAX_READ_BYTES)
    except ConfigError:
        raise
    except ValueError as error:
        raise MeasuredDataError(str(error)) from None
    chunks = _chunks(os.fspath(path), file)
    layout, data = chunks.get(b"fmt ", b""), chunks.get(b"data")
    if len(layout) < 16 or data is None:
        raise MeasuredDataError(f"{path}: a WAV file has the chunks fmt and data")
    form, channels, rate_hz, _, _, bits = struct.unpack_from("<HHIIHH", layout)
    if form == _EXTENSIBLE and len(layout) >= 26:
        # The format proper stands at the head of a longer identifier.
        form = int.from_bytes(layout[24:26], "little")
    kinds = {(_FLOAT, 32): "<f4", (_FLOAT, 64): "<f8"}
    kinds |= {(_PCM, 16): "<i2", (_PCM, 24): "<i4", (_PCM, 32): "<i4"}
    if not rate_hz:
        raise MeasuredDataError(f"{path}: its head says 0 samples a second; expected 1 or more")
    if (form, bits) not in kinds or not channels:
        raise MeasuredDataError(
            f"{path}: {channels} channels of format {form} with {bits} bits; "
            "expected format 3 (float) with 32 or 64 bits or 1 (PCM) with 16, 24 or 32"
        )
    kind = kinds[form, bits]
    scale = 1.0 if form == _FLOAT else full_scale_pa / (2 ** (bits - 1) - 1)
    frame = channels * bits // 8
    if len(data) % frame:
        raise MeasuredDataError(
            f"{path}: its data has {len(data)} bytes; expected a multiple of {frame}, as one "
            f"sample of {channels} channels of {bits} bits has"
        )
    if bits == 24:
        # Into the upper three bytes of four, which keeps the sign.
        packed = np.zeros((len(data) // 3, 4), np.uint8)
        packed[:, 1:] = np.frombuffer(data, np.uint8).reshape(-1, 3)
        frames = (packed.view(kind) >> 8).reshape(-1, channels)
    else:
        frames = np.frombuffer(data, kind).reshape(-1, channels)
    # Signalling NaNs are told below, as all that is no number.
    with np.errstate(over="ignore", invalid="ignore"):
        scaled = frames.T * np.float64(scale)
        sound = scaled.astype(np.float32)
    if not (finite := np.isfinite(sound)).all():
        channel, sample = (int(k) for k in np.argwhere(~finite)[0])
        value = scaled[channel, sample]
        allowed = "numbers up to 3.4e+38 either way" if np.isfinite(value) else "finite numbers, Pa"
        raise MeasuredDataError(
            f"{path}: sample {sample} of channel {channel} is {value:g}; allowed are {allowed}"
        )
    return sound, rate_hz


def is_whole_wav(path: str | os.PathLike[str]) -> bool:
    """Whether a file of :func:`write_wav` is there and as long as it says.

    Raises:
        ConfigError: ``path`` is none.
        OSError: The system refuses, or it is no regular file.
    """
    try:
        with open_file(arguments.file_path("path", path)) as file:
            head, size = file.read(12), os.fstat(file.fileno()).st_size
    except FileNotFoundError:
        return False
    is_wave = head[:4] == b"RIFF" and head[8:] == b"WAVE"
    return is_wave and size == 8 + int.from_bytes(head[4:8], "little")


def _chunks(name: str, file: bytes) -> dict[bytes, bytes]:
    """The first chunk of each name.

    Raises:
        MeasuredDataError: The file is no WAV, or ends within one that is read.
    """
    if file[:4] != b"RIFF" or file[8:12] != b"WAVE":
        raise MeasuredDataError(f"{name}: no WAV file: it does not begin with RIFF and WAVE")
    chunks: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= len(file):
        if chunks.get(b"data") == b"" and not all(32 <= c < 127 for c in file[at : at + 4]):
            raise MeasuredDataError(
                f"{name}: its head says that there are 0 bytes of sound, and {len(file) - at} "
                "follow, as of a recording that was not finished: write the length into the head, "
                "as most sound editors do on saving"
            )
        length = int.from_bytes(file[at + 4 : at + 8], "little")
        kind, content = file[at : at + 4], file[at + 8 : at + 8 + length]
        if len(content) < length and kind in (b"fmt ", b"data") and kind not in chunks:
            raise MeasuredDataError(
                f"{name}: its chunk {kind.decode()!r} has {len(content)} bytes, and its header "
                f"says {length}: the file was cut short or damaged"
            )
        chunks.setdefault(kind, content)
        # Chunks begin at even places.
        at += 8 + length + length % 2
    return chunks


def signals() -> list[dict[str, Any]]:
    """The built-in signals: name, description, loop_s, usual_level_db (at 1 m), level_source."""
    return _native.signals()


def synthesize(
    signal: str, *, rate_hz: int = 16_000, seconds: float | None = None
) -> NDArray[np.float32]:
    """A built-in signal from its start, without any room: what its source emits.

    Args:
        signal: Its name, as :func:`signals` lists it.
        rate_hz: Samples a second.
        seconds: How long; by default one period, after which it begins again.

    Returns:
        Shape (samples,), 1 Pa RMS over a period.

    Raises:
        ConfigError: There is no such signal, or a number is out of range.

    Examples:
        >>> import dwell
        >>> dwell.sounds.synthesize("phone", rate_hz=8000).shape
        (48000,)
    """
    name = arguments.text("signal", signal)
    rate = integer_in_range("rate_hz", rate_hz, low=1)
    if seconds is None:
        periods = {row["name"]: float(row["loop_s"]) for row in signals()}
        # Of an unknown name the engine says which there are.
        seconds = periods.get(name, 0.0)
    else:
        seconds = arguments.number_in_range("seconds", seconds, 0.0, 3600.0)
    return _native.synthesize(name, rate, round(seconds * rate))
