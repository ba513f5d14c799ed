"""``dwell ir``: an impulse response between two points, maps, charts, grids, measured rooms."""

from __future__ import annotations

import argparse

import numpy as np

from dwell.cli import ir_grid, ir_picture, measured_room
from dwell.cli.common import (
    count,
    number,
    path,
    point,
    print_json,
    refuse_other_suffix,
    refuse_unused,
    sound_rate,
)
from dwell.cli.write_files import add_bits, save_sound
from dwell.files import check_writable

#: Options of every way to compute responses, and those of each.
_ALWAYS = {"house", "seed", "rays", "image_order", "laws", "threads", "out", "json"}
_HEARD = _ALWAYS | {"source", "rate_hz", "ears", "head", "yaw_deg"}
_PAIR = _HEARD | {"mic", "bits"}
_GRID = _HEARD | {"grid", "format", "sources", "source_height", "height"}
_MAP = _ALWAYS | {"map", "source", "rate_hz", "grid", "level", "height", "width"}
_PLOT = _ALWAYS | {"plot", "source", "mic", "rate_hz", "width"}
_MEASURED_ROOM = _ALWAYS | {"sources", "receivers"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE", help="or a measured room's SCENE.json")
    parser.add_argument(
        "--source", type=point, metavar="X,Y,Z", help="where the impulse is made, m"
    )
    parser.add_argument("--mic", type=point, metavar="X,Y,Z", help="where it is heard, m")
    parser.add_argument("--rate-hz", type=sound_rate, default=16_000, help="8000 to 192000")
    parser.add_argument(
        "--ears", action="store_true", help="two ears on a head instead of a microphone"
    )
    parser.add_argument(
        "--head",
        type=path,
        metavar="FILE.sofa",
        help="ears on the measured head of a SOFA file (SimpleFreeFieldHRIR)",
    )
    parser.add_argument(
        "--yaw-deg", type=number, default=0.0, help="where the head of --ears or --head faces"
    )
    parser.add_argument("--seed", type=count, default=0)
    parser.add_argument("--rays", type=count, default=5000)
    parser.add_argument("--image-order", type=count, default=3, help="0 to 4")
    parser.add_argument(
        "--laws",
        type=path,
        metavar="FILE",
        help="JSON: a list of laws {id, version, target, params}, or what dwell calibrate found",
    )
    parser.add_argument("--threads", type=count, help="default: one for each core")
    parser.add_argument(
        "--sources", metavar="ID,ID|N", help="of a measured room (default: all); how many of a grid"
    )
    parser.add_argument("--receivers", metavar="ID,ID", help="of a measured room; default: all")
    parser.add_argument(
        "--out",
        type=path,
        metavar="FILE",
        help="FILE.wav: the pressure in pascals for an impulse of 1 Pa at 1 m; of a measured room "
        "FILE.npz: ir, fs; of pictures FILE.png or .jpg; of a grid a folder",
    )
    add_bits(parser)
    ir_picture.configure(parser)
    ir_grid.configure(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Computes the response, writes it, and prints its measures."""
    from dwell.acoustics import AcousticScene
    from dwell.heads import Head

    if measured_room.is_measured_room(args.house):
        refuse_unused(args, _MEASURED_ROOM, "a measured room")
        return measured_room.run(args)
    if args.out is not None and args.grid is None:
        check_writable(args.out)
    if args.map or args.plot:
        refuse_unused(args, _MAP if args.map else _PLOT, "--map" if args.map else "--plot")
        return ir_picture.run(args)
    way, used = ("--grid", _GRID) if args.grid is not None else ("the response of a pair", _PAIR)
    refuse_unused(args, used, way)
    if not args.ears and args.head is None:
        refuse_unused(args, used - {"yaw_deg"}, f"{way} without --ears or --head")
    if args.grid is None and args.out is None:
        refuse_unused(args, used - {"bits"}, f"{way} without --out")
    if args.grid is not None and args.source is not None:
        refuse_unused(args, used - {"source_height"}, f"{way} with --source")
    if args.head is not None:
        # Before anything is computed.
        args.head, args.ears = Head.from_sofa(args.head), True
    if args.grid is not None:
        return ir_grid.run(args)
    if args.source is None or args.mic is None:
        raise ValueError("--source and --mic are needed: two points X,Y,Z in metres")
    refuse_other_suffix(args.out, ".wav")
    scene = AcousticScene(
        args.house,
        laws=args.laws,
        rate_hz=args.rate_hz,
        rays=args.rays,
        image_order=args.image_order,
    )
    response = scene.impulse_response(
        args.source,
        args.mic,
        ears=args.ears,
        yaw_deg=args.yaw_deg,
        head=args.head,
        seed=args.seed,
        threads=args.threads,
    )
    metrics = scene.metrics(args.source, args.mic, seed=args.seed)
    peak = float(np.abs(response).max()) if response.size else 0.0
    saved = save_sound(args.out, response, scene.rate_hz, args.bits) if args.out else {}
    if args.json:
        print_json(
            {
                "rate_hz": scene.rate_hz,
                "channels": response.shape[0],
                "samples": response.shape[1],
                "peak_pa": peak,
                "metrics": metrics,
                "out": str(args.out) if args.out else None,
                **saved,
            }
        )
        return 0
    print(
        f"{response.shape[0]} channels, {response.shape[1]} samples at {scene.rate_hz} Hz, "
        f"peak {peak:.4g} Pa"
    )
    for row in metrics:
        cells = (
            f"{key} {value:.3g}"
            for key, value in row.items()
            if isinstance(value, int | float) and key != "centre_hz"
        )
        print(f"  {row['centre_hz']:g} Hz: " + ", ".join(cells))
    return 0
