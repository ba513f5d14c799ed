"""Images of sensors as pictures for people."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from dwell import _native

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


def direction_colors(normals: NDArray[Any]) -> NDArray[np.uint8]:
    """Unit vectors, -1 to 1 as dark to bright in red, green and blue; none is black."""
    colors = np.rint((normals.astype(np.float64) * 0.5 + 0.5).clip(0.0, 1.0) * 255.0)
    colors[(normals == 0.0).all(-1)] = 0.0
    return colors.astype(np.uint8)


def light_colors(light: NDArray[Any]) -> NDArray[np.uint8]:
    """Linear light, 0 to 1, as sRGB (IEC 61966-2-1)."""
    light = light.astype(np.float64).clip(0.0, 1.0)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    colors: NDArray[np.uint8] = np.rint(encoded * 255.0).astype(np.uint8)
    return colors


def flow_colors(flow: NDArray[Any]) -> NDArray[np.uint8]:
    """Movement: the direction as hue, speed as saturation; what rests is white."""
    x, y = flow[..., 0].astype(np.float64), flow[..., 1].astype(np.float64)
    speed = np.hypot(x, y)
    part = np.clip(speed / max(float(np.quantile(speed, 0.99)), 1e-6), 0.0, 1.0)
    hue = np.mod(np.arctan2(y, x) / (2.0 * np.pi), 1.0) * 6.0
    rgb = np.stack([np.abs(np.mod(hue + shift, 6.0) - 3.0) - 1.0 for shift in (0.0, 4.0, 2.0)], -1)
    colors = 1.0 - part[..., None] * (1.0 - rgb.clip(0.0, 1.0))
    shown: NDArray[np.uint8] = np.rint(colors * 255.0).astype(np.uint8)
    return shown


#: How the images of a style are shown; what lists things has no picture.
_SHOWN: dict[str, Callable[[NDArray[Any]], NDArray[np.uint8]]] = {
    "colors": lambda image: image,
    "depth": depth_colors,
    "ids": id_colors,
    "directions": direction_colors,
    "light": lambda image: light_colors(image[..., -3:]),
    "flow": flow_colors,
}


@functools.cache
def _styles() -> dict[str, str | None]:
    """The picture style of each sensor, by name."""
    return {row["name"]: row["picture_style"] for row in _native.sensors()}


def has_picture(channel: str) -> bool:
    """Returns whether a sensor gives an image, and not a list."""
    return _styles().get(channel) in _SHOWN


def picture(channel: str, image: NDArray[Any]) -> Image.Image:
    """A sensor's image as a picture for people: colours as they are, others in colours."""
    return Image.fromarray(_SHOWN[str(_styles()[channel])](image))
