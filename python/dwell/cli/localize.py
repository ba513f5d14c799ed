"""``dwell localize``: recordings with labels of where sounds are, and how well they are found."""

from __future__ import annotations

import argparse

from dwell.cli import localize_make, localize_score


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the commands."""
    what = parser.add_subparsers(dest="what", metavar="make|score", required=True)
    make = what.add_parser("make", help="recordings in houses, with labels in DCASE's form")
    localize_make.configure(make)
    make.set_defaults(do=localize_make.run)
    score = what.add_parser("score", help="baselines, or what another program found, in measures")
    localize_score.configure(score)
    score.set_defaults(do=localize_score.run)


def run(args: argparse.Namespace) -> int:
    """Runs one of them."""
    return int(args.do(args))
