"""``dwell ir --map`` and ``--plot``: what sound does in a house, as pictures."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import numpy as np

from dwell.cli.common import ProgressBar, count, number, print_json
from dwell.files import atomic_write

if TYPE_CHECKING:
    from PIL import Image

    from dwell.acoustics import AcousticScene

_MEASURES = ("level", "edt", "t20", "t30", "c50", "c80", "d50", "ts", "drr")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "--map",
        choices=_MEASURES,
        help="a measure (500 Hz and 1 kHz) over a storey from above, as a picture",
    )
    parser.add_argument(
        "--plot",
        choices=("decay", "directions"),
        help="what is left of the energy in each octave, or from where it comes, as a picture",
    )
    parser.add_argument("--level", type=count, default=0, help="of a map: the storey, from 0")
    parser.add_argument(
        "--height", type=number, default=1.2, metavar="M", help="of maps and grids: of microphones"
    )
    parser.add_argument("--width", type=count, default=900, help="of a picture, pixels")


def run(args: argparse.Namespace) -> int:
    """Computes and writes the picture."""
    from dwell.acoustics import AcousticScene

    if args.out is None or args.out.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        found = "nothing" if args.out is None else repr(str(args.out))
        raise ValueError(f"--out: expected FILE.png or FILE.jpg, found {found}")
    if args.source is None or (args.plot and args.mic is None):
        raise ValueError("--source is needed, and --mic for --plot: points X,Y,Z in metres")
    if not 200 <= args.width <= 4096:
        raise ValueError(f"--width is {args.width}; allowed are 200 to 4096")
    scene = AcousticScene(
        args.house,
        laws=args.laws,
        rate_hz=args.rate_hz,
        rays=args.rays,
        image_order=args.image_order,
    )
    storeys = scene.house.info()["levels"]
    if args.map and args.level >= storeys:
        # Before anything is computed.
        storey = "storey" if storeys == 1 else "storeys"
        raise ValueError(f"--level is {args.level}; the house has {storeys} {storey}, from 0")
    facts: dict[str, object]
    picture, facts = _map(scene, args) if args.map else _plot(scene, args)
    with atomic_write(args.out) as path:
        form = "PNG" if args.out.suffix.lower() == ".png" else "JPEG"
        picture.save(path, form, **({"quality": 88} if form == "JPEG" else {}))
    told = {**facts, "width": picture.width, "height": picture.height, "out": str(args.out)}
    if args.json:
        print_json(told)
    else:
        print(", ".join(f"{key} {value}" for key, value in told.items()))
    return 0


def _map(scene: AcousticScene, args: argparse.Namespace) -> tuple[Image.Image, dict[str, object]]:
    from dwell.sound_maps import draw_map, sound_map
    from dwell.world import World

    found = sound_map(
        scene,
        args.source,
        args.map,
        spacing_m=0.5 if args.grid is None else args.grid,
        height_m=args.height,
        seed=args.seed,
        threads=args.threads,
        progress=ProgressBar(),
    )
    world = World(scene.house, agents=0)
    picture = draw_map(found, world, args.level, longest_edge=args.width)
    known = found.values[np.isfinite(found.values)]
    return picture, {
        "map": args.map,
        "places": len(found.values),
        "without": len(found.values) - len(known),
        "lowest": float(known.min()),
        "median": float(np.median(known)),
        "highest": float(known.max()),
    }


def _plot(scene: AcousticScene, args: argparse.Namespace) -> tuple[Image.Image, dict[str, object]]:
    from dwell.charts import decay_chart, direction_chart

    echogram = scene.echogram(args.source, args.mic, seed=args.seed, threads=args.threads)
    draw = decay_chart if args.plot == "decay" else direction_chart
    facts = {"plot": args.plot, "paths": len(echogram.path_s), "bins": len(echogram.tail_energy)}
    return draw(echogram, width=args.width), facts
