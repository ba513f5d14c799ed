"""``dwell views``: pictures with words, in bulk; one file a step below this one."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

from dwell.cli.common import (
    ProgressBar,
    count,
    count_from_1,
    number,
    path,
    print_json,
    shard,
    workers,
)
from dwell.cli.job_journal import alone, claim, refuse_other

#: Houses that were skipped and are told of on standard error.
_MOST_TOLD = 10


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the steps and their options."""
    from dwell.views.formats import FORMS

    steps = parser.add_subparsers(dest="stage", metavar="STEP", required=True)
    make = steps.add_parser("make", help="views of houses with all that is said of them")
    make.add_argument("houses", nargs="+", metavar="HOUSES", help="seed:A..B, split:train, HOUSE")
    make.add_argument("--out", type=path, required=True, metavar="FOLDER")
    make.add_argument("--views", type=count_from_1, default=8, help="of each house (default 8)")
    make.add_argument("--size", type=count, default=256, help="edges of pictures (default 256)")
    make.add_argument(
        "--questions", type=count, default=2, help="of each template in a view at most (default 2)"
    )
    make.add_argument(
        "--situations",
        action="store_true",
        help="also ask which way to turn and why an action fails, which takes a while",
    )
    make.add_argument("--seed", type=count, default=0)
    make.add_argument(
        "--shard", type=shard, default=(0, 1), metavar="K/N", help="the K-th of N parts, from 0"
    )
    make.add_argument("--threads", type=workers, default=1, help="houses at a time (default 1)")
    make.add_argument("--json", action="store_true", help="one JSON object on standard output")
    clip = steps.add_parser("clip", help="a walk with pictures and sound")
    clip.add_argument("house", metavar="HOUSE")
    clip.add_argument("--out", type=path, required=True, metavar="FOLDER")
    clip.add_argument("--duration-s", type=number, default=5.0, metavar="S", help="1 to 10")
    clip.add_argument("--size", type=count, default=256, help="edges of pictures (default 256)")
    clip.add_argument("--seed", type=count, default=0, help="draws the way and what sounds")
    export = steps.add_parser("export", help="a data set of views as other programs read it")
    export.add_argument("folder", type=path, metavar="FOLDER")
    export.add_argument(
        "--format",
        choices=tuple(FORMS),
        required=True,
        help="; ".join(f"{name}: {about}" for name, about in FORMS.items()),
    )
    export.add_argument("--out", type=path, required=True, metavar="DIR")
    sheet = steps.add_parser("datasheet", help="counts, words and biases of a data set")
    sheet.add_argument("folder", type=path, metavar="FOLDER")
    sheet.add_argument("--out", type=path, metavar="FILE.md", help="default: standard output")


def run(args: argparse.Namespace) -> int:
    """Does a step; 1 when a house could not be used."""
    steps = {"make": _make, "clip": _clip, "export": _export, "datasheet": _datasheet}
    return steps[args.stage](args)


def _make(args: argparse.Namespace) -> int:
    """Makes what is missing; a run that was stopped goes on when it is given again."""
    from dwell.house_list import HouseList
    from dwell.views.dataset import ViewSettings, make

    settings = ViewSettings(args.views, args.size, args.seed, args.questions, args.situations)
    houses = HouseList(args.houses)
    job = {"command": "views make", "houses": args.houses, **vars(settings)}
    refuse_other(args.out, job)
    claim(args.out, job)
    skipped: dict[str, str] = {}

    def skip(house: str, why: str) -> None:
        skipped[house] = why
        if len(skipped) <= _MOST_TOLD:
            where = "" if why.startswith(house) else f"{house}: "
            print(f"dwell views: skipped {where}{why}", file=sys.stderr)

    which, shards = args.shard
    todo = len(range(which, len(houses), shards))
    bar, views, done, started = ProgressBar(), 0, 0, time.perf_counter()
    with alone(args.out, args.shard):
        for _, name, made in make(
            houses, args.out, settings, shard=args.shard, threads=args.threads, on_skip=skip
        ):
            views += made
            done += 1
            bar(done / todo, name)
    seconds = time.perf_counter() - started
    if len(skipped) > _MOST_TOLD:
        print(f"dwell views: skipped {len(skipped) - _MOST_TOLD} more houses", file=sys.stderr)
    summary: dict[str, Any] = {
        "houses": done,
        "views_made_now": views,
        "views_per_s": round(views / seconds, 1) if views else None,
        "skipped": len(skipped),
        "folder": str(args.out),
    }
    if args.json:
        print_json(summary)
    else:
        rate = f", {summary['views_per_s']} a second" if views else ""
        print(f"{done} houses; {views} views made now{rate}; {args.out}")
    return 1 if skipped else 0


def _clip(args: argparse.Namespace) -> int:
    from dwell.views.clips import walk, write_clip

    made = walk(args.house, duration_s=args.duration_s, size=args.size, seed=args.seed)
    write_clip(made, args.out)
    print(args.out)
    return 0


def _export(args: argparse.Namespace) -> int:
    from dwell.views.formats import export

    export(args.folder, args.out, args.format)
    print(args.out)
    return 0


def _datasheet(args: argparse.Namespace) -> int:
    from dwell.files import atomic_write
    from dwell.views.datasheet import datasheet

    if args.out is not None:
        _refuse_part_of(args.folder, args.out)
    text = datasheet(args.folder)
    if args.out is None:
        sys.stdout.write(text)
    else:
        with atomic_write(args.out) as draft:
            draft.write_text(text, "utf-8")
    return 0


def _refuse_part_of(folder: Path, out: Path) -> None:
    """Refuses to write over what a data set of views consists of.

    Raises:
        ValueError: The file is, or would be, one of the data set.
    """
    place, own = out.resolve(), folder.resolve()
    if place == own / "dataset.json" or place.is_relative_to(own / "views"):
        raise ValueError(f"--out is {out}, where {folder} has its own files; name another file")
