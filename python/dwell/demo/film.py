"""What an agent saw and where it went, as an animation and a map."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dwell.world import World


def save_film(frames: Sequence[NDArray[Any]], path: Path, *, frame_s: float) -> None:
    """Writes an animated GIF."""
    images = [Image.fromarray(frame).quantize(128) for frame in frames]
    first, *rest = images
    first.save(path, save_all=True, append_images=rest, duration=round(frame_s * 1000), loop=0)


def save_map(
    world: World, ways: Sequence[tuple[str, Sequence[Sequence[float]]]], path: Path
) -> None:
    """Draws ways over the house from above.

    Args:
        world: The world as it is.
        ways: For each, a colour and positions (x, y, z) in m.
        path: The PNG file.
    """
    image, (left, top), scale = world.map(1000)
    canvas = Image.fromarray(np.ascontiguousarray(image))
    draw = ImageDraw.Draw(canvas)
    for color, way in ways:
        points = [((x - left) * scale, (z - top) * scale) for x, _, z in way]
        if len(points) > 1:
            draw.line(points, fill="white", width=7, joint="curve")
            draw.line(points, fill=color, width=4, joint="curve")
        for (x, y), fill in zip(
            (points[0], points[-1]) if points else (), ("white", color), strict=False
        ):
            draw.ellipse((x - 7, y - 7, x + 7, y + 7), fill=fill, outline="black", width=2)
    canvas.save(path)
