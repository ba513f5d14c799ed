"""Writes what all renderers and engines get of one house: house.glb, views.json, boxes.json.

Runs in the environment that holds dwell; ``run.py`` calls it.
"""

from __future__ import annotations

import argparse
import json
import shutil
from pathlib import Path

import boxes
import numpy as np

import dwell

#: Of a view: the eye above the floor, m; how far up and down it looks, degrees.
EYE_M, PITCH_DEG = 1.5, 20.0


def views(house: dwell.House, count: int, seed: int) -> list[dict[str, list[float]]]:
    """Views from where one can stand, in random directions; degrees as ``World.render`` has."""
    draw = np.random.default_rng(seed)
    rows = []
    for place in house.navigation().sample(seed, count):
        yaw, pitch = draw.uniform(-180, 180), draw.uniform(-PITCH_DEG, PITCH_DEG)
        across = np.cos(np.radians(pitch))
        forward = [
            -across * np.sin(np.radians(yaw)),
            np.sin(np.radians(pitch)),
            -across * np.cos(np.radians(yaw)),
        ]
        position = [float(place[0]), float(place[1]) + EYE_M, float(place[2])]
        rows.append(
            {
                "position": position,
                "forward": [float(x) for x in forward],
                "angles_deg": [float(yaw), float(pitch)],
            }
        )
    return rows


def main() -> None:
    """Writes the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("house", metavar="HOUSE")
    parser.add_argument("out", type=Path)
    parser.add_argument("--views", type=int, default=100)
    parser.add_argument("--toys", type=int, default=50)
    parser.add_argument("--seed", type=int, default=7)
    args = parser.parse_args()
    shutil.rmtree(args.out, ignore_errors=True)
    args.out.mkdir(parents=True)
    house = dwell.House.open(args.house)
    house.write(args.out / "house.glb", "glb")
    rows = views(house, args.views, args.seed)
    (args.out / "views.json").write_text(json.dumps(rows), "utf-8")
    scene = boxes.scene(*boxes.of_house(args.house, args.toys, args.seed))
    (args.out / "boxes.json").write_text(json.dumps(scene), "utf-8")
    told = {
        "dwell": dwell.__version__,
        "triangles": house.info()["triangles"],
        "objects": house.info()["objects"],
    }
    (args.out / "house.json").write_text(json.dumps(told), "utf-8")


if __name__ == "__main__":
    main()
