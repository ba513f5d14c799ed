"""Draws the views of an exported house with one renderer, as often as it is told to.

    python draw.py NAME FOLDER --size 128

Prints one JSON object a line. The first says what is drawn; after that, every line on standard
input draws all views once and is answered with ``views_per_s``. Colour and depth of every view
are read back into memory. The first views are kept in FOLDER for comparison: NAME.npz with
``rgb`` (view, height, width, 3) uint8 and ``depth`` (view, height, width) float32, m.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

#: Of all renderers alike.
FOV_DEG, NEAR_M, FAR_M = 90.0, 0.05, 50.0
#: How many views are kept.
KEPT = 6

View = dict[str, list[float]]
Image = NDArray[Any]


class Renderer(NamedTuple):
    """A renderer with the house in it.

    Attributes:
        draw: Draws a view; whatever it returns has been read back.
        pictures: Of what ``draw`` returned, colour (height, width, 3) uint8 and depth (height,
            width) in m along the axis. Not timed.
        told: What is drawn, in words.
    """

    draw: Callable[[View], Any]
    pictures: Callable[[Any], tuple[Image, Image]]
    told: str


def axis_depth(buffer: NDArray[np.float32]) -> NDArray[np.float32]:
    """Depth in m along the axis, of OpenGL's depth buffer, 0 to 1."""
    return FAR_M * NEAR_M / (FAR_M - buffer * (FAR_M - NEAR_M))


def main() -> None:
    """Loads, keeps some pictures, then draws on demand."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "name", choices=("dwell", "dwell_lit", "panda3d", "mujoco", "pybullet")
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--house", default="builtin:apartment")
    parser.add_argument("--size", type=int, default=128)
    args = parser.parse_args()
    views: list[View] = json.loads((args.folder / "views.json").read_text("utf-8"))
    name, _, preset = args.name.partition("_")
    module = importlib.import_module(f"draw_{name}")
    # What libraries print themselves must not stand between the answers.
    answers, sys.stdout = sys.stdout, sys.stderr
    renderer: Renderer = (
        module.load(args.house, args.size, preset or "flat")
        if name == "dwell"
        else module.load(args.folder, args.size)
    )
    kept = [renderer.pictures(renderer.draw(view)) for view in views[:KEPT]]
    rgb, depth = (np.stack([pair[k] for pair in kept]) for k in range(2))
    np.savez(args.folder / f"{args.name}.npz", rgb=rgb, depth=depth.astype(np.float32))
    print(json.dumps({"told": renderer.told}), file=answers, flush=True)
    for _ in sys.stdin:
        started = time.perf_counter()
        for view in views:
            renderer.draw(view)
        rate = len(views) / (time.perf_counter() - started)
        print(json.dumps({"views_per_s": rate}), file=answers, flush=True)


if __name__ == "__main__":
    main()
