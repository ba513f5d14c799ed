"""Images of sensors as pictures for people."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

# Anchors of a dark-to-bright scale with steadily rising lightness, sRGB.
_SCALE = np.array(
    [
        [20, 11, 52],
        [72, 24, 106],
        [126, 36, 130],
        [183, 55, 121],
        [232, 96, 92],
        [252, 159, 88],
        [252, 230, 150],
    ]
)


def scale_colors(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Numbers in [0, 1] on the scale; shape (...,) becomes (..., 3)."""
    place = np.clip(values, 0.0, 1.0) * (len(_SCALE) - 1)
    below = np.minimum(place.astype(np.int64), len(_SCALE) - 2)
    part = (place - below)[..., None]
    colors = _SCALE[below] * (1.0 - part) + _SCALE[below + 1] * part
    scaled: NDArray[np.uint8] = np.rint(colors).astype(np.uint8)
    return scaled


def depth_colors(depth: NDArray[Any]) -> NDArray[np.uint8]:
    """Depth in m, near bright and far dark; shape (h, w, 1) becomes (h, w, 3)."""
    metres = depth[..., 0].astype(np.float64)
    near, far = np.quantile(metres, (0.01, 0.99))
    return scale_colors(1.0 - (metres - near) / max(far - near, 1e-6))


def id_colors(ids: NDArray[Any]) -> NDArray[np.uint8]:
    """Ids in colours that differ well; 0 is black; shape (h, w, 1) becomes (h, w, 3)."""
    numbers = ids[..., 0].astype(np.float64)
    # Steps of the golden ratio around the colour circle never come close to each other soon.
    hue = np.modf(numbers * 0.618033988749895)[0] * 6.0
    value = 0.65 + 0.35 * np.modf(numbers * 0.754877666246693)[0]
    rgb = np.stack([np.abs(np.mod(hue + shift, 6.0) - 3.0) - 1.0 for shift in (0.0, 4.0, 2.0)], -1)
    colors = (0.25 + 0.75 * np.clip(rgb, 0.0, 1.0)) * value[..., None] * 255.0
    colors[numbers == 0] = 0.0
    return np.rint(colors).astype(np.uint8)


def picture(channel: str, image: NDArray[Any]) -> Image.Image:
    """A sensor's image as a picture: rgb as it is, depth on a colour scale, ids in colours."""
    if channel == "rgb":
        return Image.fromarray(image)
    return Image.fromarray(depth_colors(image) if channel == "depth" else id_colors(image))
