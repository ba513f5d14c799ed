"""Pictures and images as files, each whole or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell.files import atomic

if TYPE_CHECKING:
    from PIL import Image


def save_picture(path: Path, picture: Image.Image) -> str:
    """Writes a PNG whole or not at all."""
    with atomic(path) as temporary:
        picture.save(temporary, format="PNG")
    return str(path)


def write_image(folder: Path, name: str, channel: str, image: np.ndarray[Any, Any]) -> list[str]:
    """Writes one image as PNG, and what a PNG cannot hold as NPY too."""
    from dwell.pictures import has_picture, picture

    paths = []
    if has_picture(channel):
        paths.append(save_picture(folder / f"{name}.png", picture(channel, image)))
    if channel != "rgb":
        path = folder / f"{name}.npy"
        with atomic(path) as temporary, temporary.open("wb") as file:
            np.save(file, image)
        paths.append(str(path))
    return paths
