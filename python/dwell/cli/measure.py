"""``dwell measure import``: tables of measurements into a bundle that ``dwell calibrate`` reads."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from dwell.cli.common import ProgressBar, path, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    what = parser.add_subparsers(dest="what", metavar="import", required=True)
    command = what.add_parser("import", help="read tables (CSV; Parquet with pyarrow)")
    command.add_argument("files", nargs="*", type=path, metavar="FILES", help="the tables")
    command.add_argument("--map", type=path, metavar="FILE", help="what the columns mean (JSON)")
    command.add_argument("--out", type=path, metavar="NAME.measured", help="the bundle to write")
    command.add_argument(
        "--init",
        nargs="?",
        const="pose_trajectory",
        choices=["pose_trajectory", "trajectory", "drive"],
        metavar="KIND",
        help="print a template of the map (pose_trajectory, trajectory or drive) and leave",
    )
    command.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Imports, checks the bundle as ``dwell calibrate`` would, and moves it into place."""
    from dwell.measured_import import import_files
    from dwell.measured_templates import TEMPLATES

    if args.init:
        if args.files or args.map or args.out:
            raise ValueError("--init prints a template and reads nothing else; give it alone")
        sys.stdout.write(json.dumps(TEMPLATES[args.init], indent=2) + "\n")
        return 0
    if not args.files or args.map is None or args.out is None:
        print(
            "dwell measure import: FILES, --map and --out are needed (or --init)", file=sys.stderr
        )
        return 2
    counts = import_files(args.files, args.map, args.out, ProgressBar())
    if args.json:
        print_json({"out": str(args.out), **counts})
    else:
        left_out = _left_out(counts)
        print(f"{args.out}: {counts['episodes']} episodes, {counts['rows']} rows{left_out}")
    return 0


def _left_out(counts: dict[str, Any]) -> str:
    """Which episodes are not in the bundle, and why."""
    count = counts["left_out"]
    if not count:
        return ""
    names = ", ".join(map(repr, counts["left_out_episodes"]))
    more = ", ..." if count > len(counts["left_out_episodes"]) else ""
    return f", {count} left out, without mass and diameter of their bodies: {names}{more}"
