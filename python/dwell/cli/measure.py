"""``dwell measure import``: files of measurements into a bundle that ``dwell calibrate`` reads."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from dwell.cli.common import ProgressBar, path, print_json

_ASKED = ""


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    what = parser.add_subparsers(dest="what", metavar="import", required=True)
    command = what.add_parser(
        "import", help="read tables (CSV, Parquet, LeRobot, HDF5, MCAP), WAV and SOFA"
    )
    command.add_argument("files", nargs="*", type=path, metavar="FILES", help="the files")
    command.add_argument("--map", type=path, metavar="FILE", help="what the columns mean (JSON)")
    command.add_argument("--out", type=path, metavar="NAME.measured", help="the bundle to write")
    command.add_argument(
        "--init",
        nargs="?",
        const=_ASKED,
        metavar="KIND",
        help="print a map and leave: with FILES one that is filled in with what was guessed and "
        "why; without, the template of KIND (pose_trajectory, trajectory, drive, servo or "
        "impulse_response)",
    )
    command.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Imports, checks the bundle as ``dwell calibrate`` would, and moves it into place."""
    if args.init is not None:
        return _init(args)
    from dwell.measured.importing import import_files

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
        for note in counts.get("notes", []):
            print(f"  {note}")
    return 0


def _init(args: argparse.Namespace) -> int:
    """Prints a map."""
    from dwell.measured.kinds import KINDS

    if args.map or args.out:
        raise ValueError("--init prints a map and writes no bundle; leave out --map and --out")
    kind, files = args.init or None, list(args.files)
    if kind is not None and kind not in KINDS:
        # The first of the files, which stand behind the option.
        files.insert(0, Path(kind))
        kind = None
    if files:
        from dwell.measured.guessing import guessed_map

        mapping = guessed_map(files, kind)
    else:
        template = KINDS[kind or "pose_trajectory"].template
        mapping = {"kind": template["kind"], "confirmed": False, **template}
    sys.stdout.write(json.dumps(mapping, indent=2) + "\n")
    return 0


def _left_out(counts: dict[str, Any]) -> str:
    """Which episodes are not in the bundle, and why."""
    count = counts["left_out"]
    if not count:
        return ""
    names = ", ".join(map(repr, counts["left_out_episodes"]))
    more = ", ..." if count > len(counts["left_out_episodes"]) else ""
    return f", {count} left out, without mass and diameter of their bodies: {names}{more}"
