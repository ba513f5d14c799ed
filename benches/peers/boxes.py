"""A scene of upright boxes for ``dwell bench physics --boxes`` and for ``physics.py`` beside this.

Of one of dwell's own houses: what a hand can take moves, all else stands, and toy cubes are dropped
on the floors:

    python benches/peers/boxes.py house builtin:apartment --toys 50 --out boxes.json

Or of a script that makes such a scene with ``setup(root, house, extra)``, which answers static
parts, fixed boxes and moving boxes, each box as (centre, half extents) in metres, +Y up:

    python benches/peers/boxes.py script SCRIPT.py ROOT HOUSE --extra 50 --out boxes.json

A moving box that begins more than 5 mm inside another is lifted until it is free, lowest first.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Box = tuple[NDArray[np.float64], NDArray[np.float64]]

#: The half edge of a toy cube and the least half edge of any box, m.
TOY_M, THINNEST_M = 0.05, 0.005
#: How deep boxes may overlap at the start, m, and the gap that is left when one is lifted.
OVERLAP_M, GAP_M = 0.005, 0.001


def freed(fixed: list[Box], moving: list[Box]) -> list[Box]:
    """The moving boxes, lifted out of what they overlap."""
    placed, out = list(fixed), []
    for center, half in sorted(moving, key=lambda box: float(box[0][1])):
        center = center.copy()
        for _ in range(200):
            hit = [(c, h) for c, h in placed if np.all(np.abs(center - c) < half + h - OVERLAP_M)]
            if not hit:
                break
            center[1] = max(float(c[1] + h[1]) for c, h in hit) + half[1] + GAP_M
        placed.append((center, half))
        out.append((center, half))
    return out


def of_house(name: str, toys: int, seed: int) -> tuple[list[Box], list[Box]]:
    """The boxes around a house's objects, and toy cubes over random places where one can walk."""
    import dwell

    world = dwell.World(name, agents=0)
    fixed: list[Box] = []
    moving: list[Box] = []
    for thing in world.objects():
        half = np.maximum(0.5 * np.array(thing["size"], float), THINNEST_M)
        box = (np.array(thing["center"], float), half)
        (moving if thing["pickable"] else fixed).append(box)
    for place in world.navigation().sample(seed, toys):
        above = np.array([0.0, 0.3, 0.0])
        moving.append((place.astype(float) + above, np.full(3, TOY_M)))
    return fixed, freed(fixed, moving)


def of_script(path: Path, root: str, house: str, extra: int) -> tuple[list[Box], list[Box]]:
    """What a script's ``setup`` makes; it has lifted its boxes itself."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise SystemExit(f"{path}: no Python script")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    _, fixed, moving = module.setup(root, house, extra)
    return fixed, moving


def rows(boxes: list[Box]) -> list[dict[str, list[float]]]:
    """Boxes as the bench reads them."""
    return [
        {"center": [float(x) for x in center], "half_extents": [float(x) for x in half]}
        for center, half in boxes
    ]


def scene(
    fixed: list[Box],
    moving: list[Box],
    density_kg_m3: float = 300.0,
    rate_hz: float = 100.0,
) -> dict[str, object]:
    """What ``dwell bench physics --boxes`` reads."""
    return {
        "fixed": rows(fixed),
        "dynamic": rows(moving),
        "density_kg_m3": density_kg_m3,
        "physics_rate_hz": rate_hz,
    }


def main() -> None:
    """Writes the file."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    kinds = parser.add_subparsers(dest="kind", required=True)
    house = kinds.add_parser("house", help="of a house of dwell's own")
    house.add_argument("house", metavar="HOUSE")
    house.add_argument("--toys", type=int, default=50)
    house.add_argument("--seed", type=int, default=7)
    script = kinds.add_parser("script", help="of a script with setup(root, house, extra)")
    script.add_argument("script", type=Path)
    script.add_argument("root")
    script.add_argument("house")
    script.add_argument("--extra", type=int, default=50)
    for part in (house, script):
        part.add_argument("--density", type=float, default=300.0, help="of what moves, kg/m3")
        part.add_argument("--rate", type=float, default=100.0, help="physics steps a second")
        part.add_argument("--out", type=Path, required=True)
    args = parser.parse_args()
    if args.kind == "house":
        fixed, moving = of_house(args.house, args.toys, args.seed)
    else:
        fixed, moving = of_script(args.script, args.root, args.house, args.extra)
    made = scene(fixed, moving, args.density, args.rate)
    args.out.write_text(json.dumps(made), "utf-8")
    print(f"{args.out}: {len(moving)} boxes that move, {len(fixed)} that stand")


if __name__ == "__main__":
    main()
