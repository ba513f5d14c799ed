"""What the programs that hear have in common: arguments in, responses and processor time out."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

#: A response, shape (sample,), for a seed.
Heard = Callable[[int], np.ndarray]


def box(size: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Corners, shape (8, 3), and triangles, shape (12, 3), of a box that is seen from within."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size
    sides = [
        (0, 1, 3, 2),
        (4, 6, 7, 5),
        (0, 4, 5, 1),
        (2, 3, 7, 6),
        (0, 2, 6, 4),
        (1, 5, 7, 3),
    ]
    triangles = [half for a, b, c, d in sides for half in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles)


def run(load: Callable[[Path, int], Heard]) -> None:
    """Hears once to warm up, then ``--times`` more, and writes ``ir[time, sample]`` and ``s``."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scene", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--rays", type=int, required=True)
    parser.add_argument("--times", type=int, default=8)
    args = parser.parse_args()
    heard = load(args.scene, args.rays)
    heard(10_000)
    responses, seconds = [], []
    for seed in range(args.times):
        start = time.process_time()
        responses.append(heard(seed))
        seconds.append(time.process_time() - start)
    length = max(len(response) for response in responses)
    whole = np.zeros((args.times, length), np.float32)
    for row, response in zip(whole, responses, strict=True):
        row[: len(response)] = response
    np.savez(args.out, ir=whole, s=np.array(seconds))
