"""``dwell render``: pictures from a place in a house, and of houses."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, get_args

from dwell.camera import CLASSES, PRESETS, Camera
from dwell.cli.common import (
    ProgressBar,
    add_back_end,
    back_end,
    count,
    image_edge,
    number,
    path,
    point,
    print_json,
    refuse_unused,
)
from dwell.cli.write_files import save_picture, write_image
from dwell.engine_types import Channel

if TYPE_CHECKING:
    from dwell.world import World

_SENSORS: tuple[Channel, ...] = get_args(Channel)
_PROJECTIONS = (
    "pinhole",
    "brown_conrady",
    "fisheye",
    "equirectangular",
    "cubemap",
    "orthographic",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE", nargs="+", help="several only with --sheet")
    parser.add_argument(
        "--at", type=point, metavar="X,Y,Z", help="where the eye is, m; default: every room"
    )
    parser.add_argument(
        "--yaw-deg",
        type=number,
        help="positive to the left; 0 looks along -Z (default 0, --dollhouse 25)",
    )
    parser.add_argument("--pitch-deg", type=number, default=0.0, help="positive up")
    parser.add_argument(
        "--sensors",
        help=f"some of {','.join(_SENSORS)}; default rgb; beside --map, --dollhouse and --sheet "
        "none, unless there is --at",
    )
    parser.add_argument("--width", type=image_edge, help="default 640; --map and --dollhouse 1200")
    parser.add_argument("--height", type=image_edge, default=480)
    parser.add_argument("--fov-deg", type=number, default=90.0, help="horizontal field of view")
    parser.add_argument(
        "--projection",
        choices=_PROJECTIONS,
        default="pinhole",
        help="fisheye: equidistant, --fov-deg across; all around: --height follows --width",
    )
    parser.add_argument(
        "--intrinsics",
        type=_numbers,
        default={},
        metavar="fx=..,fy=..,cx=..,cy=..,k1=..",
        help="numbers of the projection instead of those that --fov-deg gives, pixels from the "
        "top left corner (docs/cameras.md)",
    )
    parser.add_argument(
        "--width-m", type=number, default=6.0, help="what an orthographic image spans"
    )
    parser.add_argument("--preset", choices=PRESETS, default="lit")
    parser.add_argument("--classes", choices=CLASSES, default="coarse", help="those of semantic")
    parser.add_argument(
        "--map", action="store_true", help="the plan of every storey, with names and a scale"
    )
    parser.add_argument(
        "--dollhouse", action="store_true", help="every storey from outside, cut open"
    )
    parser.add_argument(
        "--sheet",
        action="store_true",
        help="one picture with all of a house, or with the doll's houses of several",
    )
    parser.add_argument("--cut-m", type=number, default=1.6, help="height of --dollhouse's cut")
    parser.add_argument("--columns", type=count, default=4, help="pictures in a row of --sheet")
    add_back_end(parser)
    parser.add_argument("--out", type=path, required=True, help="folder for the files")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Renders, writes PNG (pictures) and NPY (exact depth and ids), and names the files."""
    from dwell.house import House
    from dwell.house_list import HouseList
    from dwell.plans import MAX_COLUMNS
    from dwell.world import World

    pictured, refused = args.map or args.dollhouse or args.sheet, 0
    if args.sensors is None and not (pictured and args.at is None):
        args.sensors = "rgb"
    channels = [] if args.sensors is None else [_sensor(name) for name in args.sensors.split(",")]
    if args.sheet and not 1 <= args.columns <= MAX_COLUMNS:
        raise ValueError(
            f"--columns is {args.columns}; allowed are whole numbers from 1 to {MAX_COLUMNS}"
        )
    houses = HouseList(args.house)
    refuse_unused(args, _used(args, bool(channels), len(houses)), "this picture")
    files: list[str] = []
    if args.sheet and len(houses) > 1:
        if channels or args.map or args.dollhouse:
            raise ValueError(
                "several houses: --sheet takes their doll's houses alone, without --sensors, --at, "
                "--map and --dollhouse"
            )
        files, refused = _sheet(args, houses)
    elif len(houses) > 1:
        raise ValueError(f"{len(houses)} houses; several are taken by --sheet alone")
    else:
        world = World(House.open(houses[0]), agents=0, renderer=back_end(args))
        files = _views(args, world, channels) if channels else []
        if pictured:
            files += _whole(args, world)
    if args.json:
        print_json({"files": files})
    else:
        print("\n".join(files))
    return 1 if refused else 0


def _used(args: argparse.Namespace, has_views: bool, houses: int) -> set[str]:
    """The options that these pictures read."""
    used = {"house", "out", "json", "map", "dollhouse", "sheet", "sensors"}
    if houses > 1:
        # What else there is with several houses is refused with a reason of its own.
        return used | {"columns", "at"}
    used |= {"backend", "path"}
    if has_views:
        used |= {"at", "yaw_deg", "pitch_deg", "width", "projection", "intrinsics"}
        used |= {"preset", "classes"}
        if args.projection in ("pinhole", "brown_conrady", "fisheye"):
            used |= {"height", "fov_deg"}
        elif args.projection == "orthographic":
            used |= {"height", "width_m"}
    if args.map:
        used |= {"width"}
    if args.dollhouse:
        used |= {"width", "yaw_deg", "cut_m"}
    if args.sheet:
        used |= {"columns", "preset"}
    return used


def _sensor(name: str) -> Channel:
    for known in _SENSORS:
        if name == known:
            return known
    raise ValueError(f"--sensors: no {name!r}; allowed are {', '.join(_SENSORS)}")


def _sheet(args: argparse.Namespace, houses: Sequence[str]) -> tuple[list[str], int]:
    """The doll's houses of many; one that cannot be opened is told of and left out."""
    from dwell import DwellError, plans

    tiles, bar, refused = [], ProgressBar(), 0
    for k, name in enumerate(houses):
        bar(k / len(houses), name)
        try:
            tiles.append(plans.house_tile(name))
        except DwellError as error:
            refused += 1
            print(f"dwell render: {error}", file=sys.stderr)
    bar(1.0, f"{len(tiles)} houses")
    if not tiles:
        return [], refused
    picture = plans.sheet(tiles, columns=args.columns)
    return [save_picture(args.out / "sheet.png", picture)], refused


def _whole(args: argparse.Namespace, world: World) -> list[str]:
    """Pictures of the whole house."""
    from dwell import plans

    width, files = 1200 if args.width is None else args.width, []
    if args.map:
        for level in range(plans.levels_of(world.house)):
            plan = plans.floor_plan(world, level, longest_edge=width)
            files.append(save_picture(args.out / f"map_{level}.png", plan))
    if args.dollhouse:
        yaw_deg = 25.0 if args.yaw_deg is None else args.yaw_deg
        doll = plans.dollhouse(world, width=width, yaw_deg=yaw_deg, cut_m=args.cut_m)
        files.append(save_picture(args.out / "dollhouse.png", doll))
    if args.sheet:
        sheet = plans.house_sheet(
            world, columns=args.columns, preset=args.preset, progress=ProgressBar()
        )
        files.append(save_picture(args.out / "sheet.png", sheet))
    return files


def _views(args: argparse.Namespace, world: World, channels: list[Channel]) -> list[str]:
    """The sensors' observations from a place, or from the viewpoint of every room."""
    camera = _camera(args)
    views: list[tuple[str, Any, float]] = [("view", args.at, args.yaw_deg or 0.0)]
    if args.at is None:
        rooms = enumerate(world.house.rooms())
        views = [(f"room_{k}", room["eye"], room["yaw_deg"]) for k, room in rooms]
    if not views:
        raise ValueError("this house has no rooms; say with --at where the camera stands")
    files: list[str] = []
    for name, eye, yaw_deg in views:
        images = world.render(
            position=eye,
            yaw_deg=yaw_deg,
            pitch_deg=args.pitch_deg,
            camera=camera,
            channels=channels,
        )
        for channel, image in images.items():
            files += write_image(args.out, f"{name}_{channel}", channel, image)
    return files


def _numbers(text: str) -> dict[str, float]:
    """Reads ``fx=500,fy=500``."""
    numbers = {}
    for part in text.split(","):
        name, found, value = part.partition("=")
        if not found or not name.strip().isidentifier():
            raise argparse.ArgumentTypeError(f"expected NAME=NUMBER,..., found {text!r}")
        if name.strip() in numbers:
            raise argparse.ArgumentTypeError(f"{name.strip()} stands twice in {text!r}")
        numbers[name.strip()] = number(value)
    return numbers


def _camera(args: argparse.Namespace) -> Camera:
    """The camera that the options describe."""
    import math

    kind, height, preset, classes = args.projection, args.height, args.preset, args.classes
    width = 640 if args.width is None else args.width
    if kind == "pinhole" and not args.intrinsics:
        return Camera(width, height, args.fov_deg, preset=preset, classes=classes)
    numbers: dict[str, Any] = {}
    if kind in ("pinhole", "brown_conrady", "fisheye"):
        widest = 360.0 if kind == "fisheye" else 179.0
        if not 0.0 < args.fov_deg <= widest:
            raise ValueError(
                f"--fov-deg: found {args.fov_deg:g}; allowed are above 0 to {widest:g}"
            )
        half_rad = math.radians(args.fov_deg / 2)
        focal = width / 2 / (half_rad if kind == "fisheye" else math.tan(half_rad))
        numbers = {"fx": focal, "fy": focal, "cx": width / 2, "cy": height / 2}
    if kind == "brown_conrady":
        numbers |= dict.fromkeys(("k1", "k2", "k3", "p1", "p2"), 0.0)
    elif kind == "fisheye":
        numbers["half_angle_deg"] = min(args.fov_deg / 2, 180.0)
    elif kind == "orthographic":
        numbers = {"width_m": args.width_m, "height_m": args.width_m * height / width}
    elif kind in ("equirectangular", "cubemap"):
        height = max(width // 2, 1) if kind == "equirectangular" else 6 * width
    projection = {"kind": kind, **numbers, **args.intrinsics}
    return Camera(width, height, preset=preset, projection=projection, classes=classes)
