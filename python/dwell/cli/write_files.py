"""Pictures, images and sounds as files, each whole or not at all."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell.files import atomic_write, save_array

if TYPE_CHECKING:
    from PIL import Image


def save_picture(path: Path, picture: Image.Image) -> str:
    """Writes a PNG whole or not at all."""
    with atomic_write(path) as temporary:
        picture.save(temporary, format="PNG")
    return str(path)


def write_image(folder: Path, name: str, channel: str, image: np.ndarray[Any, Any]) -> list[str]:
    """Writes one image as PNG, and what a PNG cannot hold as NPY too."""
    from dwell.false_color import has_picture, picture

    paths = []
    if has_picture(channel):
        paths.append(save_picture(folder / f"{name}.png", picture(channel, image)))
    if channel != "rgb":
        path = folder / f"{name}.npy"
        with atomic_write(path) as temporary:
            save_array(temporary, image)
        paths.append(str(path))
    return paths


def add_bits(parser: argparse.ArgumentParser) -> None:
    """Adds ``--bits``; see :func:`save_sound`."""
    parser.add_argument(
        "--bits",
        type=int,
        choices=(16, 32),
        default=32,
        help="of samples in FILE.wav: 32-bit float in pascals, or 16 bits, scaled to the peak; "
        "--json tells the pressure at 1.0 or full scale",
    )


def save_sound(path: Path, sound: np.ndarray[Any, Any], rate_hz: int, bits: int) -> dict[str, Any]:
    """Writes pressure, Pa, shape (channel, sample), as WAV, whole or not at all.

    Returns:
        `bits`, and `full_scale_pa`: the pressure that a sample of 1.0 or full scale stands for.
    """
    from dwell.sounds import write_wav

    peak = float(np.abs(sound).max()) if sound.size else 0.0
    full_scale_pa = (peak or 1.0) if bits == 16 else 1.0
    write_wav(path, sound, rate_hz, full_scale_pa=full_scale_pa if bits == 16 else None)
    return {"bits": bits, "full_scale_pa": full_scale_pa}
