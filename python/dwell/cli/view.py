"""``dwell view``: a house in the Rerun viewer, or as a recording for it."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from dwell.cli.common import atomic, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE")
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FILE.rrd",
        help="write a recording; without it the viewer opens",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Shows surfaces, boxes, lamps, joints, a camera in every room, and the ways of sound."""
    from dwell.house import House
    from dwell.recording import Recording, record_house, sdk
    from dwell.world import World

    sdk()
    if args.out is None and not _has_display():
        raise ValueError("no display for the viewer; --out FILE.rrd writes a recording for it")
    world = World(House.open(args.house), agents=0)
    if args.out is None:
        recording = Recording(f"dwell {args.house}", None)
        record_house(recording, world)
        recording.close()
        return 0
    with atomic(args.out) as path:
        recording = Recording(f"dwell {args.house}", path)
        record_house(recording, world)
        recording.close()
    if args.json:
        print_json({"file": str(args.out)})
    else:
        print(args.out)
    return 0


def _has_display() -> bool:
    if not sys.platform.startswith("linux"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
