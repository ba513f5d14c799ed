"""``dwell localize``: recordings with labels of where sounds are, and how well they are found."""

from __future__ import annotations

import argparse

from dwell.cli import localize_make


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the commands."""
    what = parser.add_subparsers(dest="what", metavar="make", required=True)
    make = what.add_parser("make", help="recordings in houses, with labels in DCASE's form")
    localize_make.configure(make)
    make.set_defaults(do=localize_make.run)


def run(args: argparse.Namespace) -> int:
    """Runs one of them."""
    return int(args.do(args))
