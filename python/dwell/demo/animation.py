"""An agent's views as an animation."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from PIL import Image


def save_film(frames: Sequence[NDArray[Any]], path: Path, *, frame_s: float) -> None:
    """Writes an animated GIF."""
    images = [Image.fromarray(frame).quantize(128) for frame in frames]
    first, *rest = images
    first.save(path, save_all=True, append_images=rest, duration=round(frame_s * 1000), loop=0)
