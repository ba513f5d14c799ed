"""``dwell calibrate``: measured data against the simulation."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from dwell.cli.common import Bar, atomic, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "measured", metavar="NAME.measured", help="the folder of the measured bundle"
    )
    parser.add_argument("--house", help="the HOUSE it was measured in, if the bundle does not say")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="for report.html, report.json, found.json"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Calibrates, writes the report, and prints the verdict."""
    from dwell.calibration import calibrate

    report = calibrate(args.measured, house=args.house, progress=Bar())
    page = report.pop("html", "")
    if args.out:
        files = {
            "report.html": page,
            "report.json": json.dumps(report, indent=1, ensure_ascii=False),
            "found.json": json.dumps(report["found"], indent=1),
        }
        for name, text in files.items():
            with atomic(args.out / name) as path:
                path.write_text(text, "utf-8")
    if args.json:
        print_json(report)
    else:
        print(report["sentence"])
        if args.out:
            print(f"Open {args.out / 'report.html'}")
    return 0
