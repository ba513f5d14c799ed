"""``dwell demo``: the whole thing once."""

from __future__ import annotations

import argparse
from pathlib import Path

from dwell.cli.common import ProgressBar, path, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE", nargs="?", default="builtin:apartment")
    parser.add_argument("--out", type=path, default=Path("out/demo"), metavar="DIR")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Walks an agent through the house and writes a page about it."""
    from dwell import demo

    summary = demo.run(args.house, args.out, ProgressBar())
    if args.json:
        print_json(summary)
    else:
        print(f"Open {args.out / 'index.html'}")
    return 0
