"""``dwell record``: data sets of episodes that are recorded, kind by kind."""

from __future__ import annotations

import argparse
import sys

from dwell.cli.common import ProgressBar, count, count_from_1, number, path, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the kinds of recordings with their options."""
    kinds = parser.add_subparsers(dest="what", metavar="KIND", required=True)
    teach = kinds.add_parser(
        "teach",
        help="a person at a table teaches a robot things: points, shows, speaks (docs/teach.md)",
    )
    teach.add_argument("out", type=path, metavar="OUT", help="the folder; one begun goes on")
    teach.add_argument("--users", type=count_from_1, default=10, help="persons (default 10)")
    teach.add_argument(
        "--clips", type=count_from_1, default=30, help="of each: a third of each type (default 30)"
    )
    teach.add_argument("--seed", type=count, default=0, help="what all is drawn from (default 0)")
    teach.add_argument(
        "--fps", type=count_from_1, default=10, help="pictures a second, a divisor of 120"
    )
    teach.add_argument(
        "--width",
        type=count_from_1,
        default=320,
        metavar="PX",
        help="of the Kinects' pictures; those of the HD camera are twice as wide (default 320)",
    )
    teach.add_argument(
        "--format",
        choices=("png", "npz"),
        default="png",
        help="a PNG for each picture, or the arrays of a camera in one file",
    )
    teach.add_argument(
        "--noise", type=number, default=1.0, help="of the Kinects: 1 as published, 0 none"
    )
    teach.add_argument(
        "--pointing-noise",
        type=number,
        metavar="DEG",
        help="standard deviation of pointing; default: each user's own, 0.5 to 3 degrees",
    )
    teach.add_argument("--house", metavar="HOUSE", help="where (default: a room made for it)")
    teach.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Records; a recording that was stopped goes on where it stopped."""
    from dwell.teach import TeachSettings, record

    settings = TeachSettings(
        users=args.users,
        clips=args.clips,
        seed=args.seed,
        fps=args.fps,
        width=args.width,
        form=args.format,
        noise=args.noise,
        pointing_noise_deg=args.pointing_noise,
        house=args.house,
    )
    try:
        summary = record(args.out, settings, progress=ProgressBar())
    except KeyboardInterrupt:
        print("dwell record: whole clips are kept; run again to go on", file=sys.stderr)
        raise
    if args.json:
        print_json(summary)
    else:
        now = summary["recorded_now"]
        print(f"{summary['clips']} clips ({now} recorded now); {summary['manifest']}")
    return 0
