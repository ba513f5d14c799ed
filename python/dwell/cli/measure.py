"""``dwell measure``: files of measurements into a bundle, and which states a bundle has."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from dwell.arguments import allowed_values, quoted
from dwell.cli.common import ProgressBar, path, print_json

_ASKED = ""


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    what = parser.add_subparsers(dest="what", metavar="import|coverage", required=True)
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
    command = what.add_parser("coverage", help="which states a bundle has, and what to record")
    command.add_argument("measured", type=path, metavar="NAME.measured", help="the bundle")
    command.add_argument("--out", type=path, metavar="FILE.png", help="the picture to write")
    command.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Imports and checks as ``dwell calibrate`` would, or looks at a bundle."""
    if args.what == "coverage":
        return _coverage(args)
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


def _coverage(args: argparse.Namespace) -> int:
    """Draws the recorded states and prints what to record."""
    from dwell.calibration import coverage
    from dwell.files import atomic_write, check_writable

    if args.out is not None:
        if args.out.suffix != ".png":
            raise ValueError(f"--out is {args.out}; a name that ends in .png is needed")
        check_writable(args.out)
    found = coverage(args.measured)
    if args.out is not None:
        picture = found.picture()
        with atomic_write(args.out) as draft:
            picture.save(draft, "PNG")
    if args.json:
        axes = list(found.names)
        told = {"kind": found.kind, "axes": axes, "share": found.share, "advice": found.advice}
        print_json(told)
    else:
        print("\n".join(found.advice))
    return 0


def _init(args: argparse.Namespace) -> int:
    """Prints a map."""
    from dwell.measured.kinds import KINDS

    if args.map or args.out:
        raise ValueError("--init prints a map and writes no bundle; leave out --map and --out")
    kind, files = args.init or None, list(args.files)
    if kind is not None and kind not in KINDS:
        if not Path(kind).exists():
            told = f"--init is {quoted(kind)}, which is no file that is there and no kind"
            raise ValueError(f"{told}; of kinds {allowed_values(kind, KINDS)}")
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
