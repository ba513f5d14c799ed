"""``dwell render``: pictures from a place in a house."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from dwell.cli.common import atomic, count, number, point, print_json

if TYPE_CHECKING:
    from dwell.camera import Camera

_SENSORS = (
    "rgb",
    "depth",
    "instance",
    "semantic",
    "semantic_fine",
    "semantic_nyu40",
    "normals",
    "albedo",
    "surfels",
    "flow",
    "visible_objects",
    "boxes_2d",
    "boxes_3d",
)
_PROJECTIONS = ("pinhole", "fisheye", "equirectangular", "cubemap", "orthographic")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE")
    parser.add_argument(
        "--at", type=point, metavar="X,Y,Z", help="where the eye is, m; default: every room"
    )
    parser.add_argument(
        "--yaw-deg", type=number, default=0.0, help="positive to the left; 0 looks along -Z"
    )
    parser.add_argument("--pitch-deg", type=number, default=0.0, help="positive up")
    parser.add_argument("--sensors", default="rgb", help=f"some of {','.join(_SENSORS)}")
    parser.add_argument("--width", type=count, default=640)
    parser.add_argument("--height", type=count, default=480)
    parser.add_argument("--fov-deg", type=number, default=90.0, help="horizontal field of view")
    parser.add_argument(
        "--projection",
        choices=_PROJECTIONS,
        default="pinhole",
        help="fisheye: equidistant, --fov-deg across; all around: --height follows --width",
    )
    parser.add_argument(
        "--width-m", type=number, default=6.0, help="what an orthographic image spans"
    )
    parser.add_argument("--preset", choices=("flat", "lit"), default="lit")
    parser.add_argument("--out", type=Path, required=True, help="folder for the files")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Renders, writes PNG (pictures) and NPY (exact depth and ids), and names the files."""
    from dwell.camera import Channel
    from dwell.house import House
    from dwell.world import World

    channels = args.sensors.split(",")
    if unknown := [name for name in channels if name not in _SENSORS]:
        raise ValueError(f"--sensors: no {unknown[0]!r}; allowed are {', '.join(_SENSORS)}")
    house = House.open(args.house)
    world = World(house, agents=0)
    camera = _camera(args)
    views: list[tuple[str, Any, float]] = [("view", args.at, args.yaw_deg)]
    if args.at is None:
        views = [
            (f"room_{k}", room["eye"], room["yaw_deg"]) for k, room in enumerate(house.rooms())
        ]
    files: list[str] = []
    for name, eye, yaw_deg in views:
        images = world.render(
            position=eye,
            yaw_deg=yaw_deg,
            pitch_deg=args.pitch_deg,
            camera=camera,
            channels=cast("list[Channel]", channels),
        )
        for channel, image in images.items():
            files += _write(args.out, f"{name}_{channel}", channel, image)
    if args.json:
        print_json({"files": files})
    else:
        print("\n".join(files))
    return 0


def _camera(args: argparse.Namespace) -> Camera:
    """The camera that the options describe."""
    import math

    from dwell.camera import Camera

    width, height, preset = args.width, args.height, args.preset
    if args.projection == "pinhole":
        return Camera(width, height, args.fov_deg, preset=preset)
    numbers: dict[str, Any] = {}
    if args.projection == "fisheye":
        focal = width / math.radians(args.fov_deg)
        numbers = {"fx": focal, "fy": focal, "cx": width / 2, "cy": height / 2}
        numbers["half_angle_deg"] = min(args.fov_deg / 2, 180.0)
    elif args.projection == "orthographic":
        numbers = {"width_m": args.width_m, "height_m": args.width_m * height / width}
    else:
        height = max(width // 2, 1) if args.projection == "equirectangular" else 6 * width
    return Camera(width, height, preset=preset, projection={"kind": args.projection, **numbers})


def _write(folder: Path, name: str, channel: str, image: np.ndarray[Any, Any]) -> list[str]:
    """Writes one image as PNG, and what a PNG cannot hold as NPY too."""
    from dwell.pictures import has_picture, picture

    paths = []
    if has_picture(channel):
        paths.append(folder / f"{name}.png")
        with atomic(paths[-1]) as path:
            picture(channel, image).save(path, format="PNG")
    if channel != "rgb":
        paths.append(folder / f"{name}.npy")
        with atomic(paths[-1]) as path, path.open("wb") as file:
            np.save(file, image)
    return [str(path) for path in paths]
