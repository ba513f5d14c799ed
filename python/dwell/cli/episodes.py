"""``dwell episodes``: seeded episodes of a task over many houses, as a file."""

from __future__ import annotations

import argparse
import functools
import os
import sys
import time
from typing import Any

from dwell.arguments import from_json
from dwell.cli.common import (
    ProgressBar,
    count,
    count_from_1,
    path,
    print_json,
    refuse_unused,
    settings_of,
    shard,
    workers,
)
from dwell.cli.habitat import add_habitat, convert
from dwell.cli.job_journal import Journal, contents_of, is_of_files
from dwell.files import check_writable

#: Houses that were skipped and are told of on standard error.
_MOST_TOLD = 10
_HEADER = "header"
#: The options of episodes that are made, not converted.
_MAKING = (
    "task",
    "houses",
    "count",
    "out",
    "seed",
    "set",
    "settings",
    "expert",
    "shard",
    "workers",
    "json",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "task", metavar="TASK", nargs="?", help="such as PointNav; with --from that of the file"
    )
    parser.add_argument(
        "--houses",
        metavar="HOUSES",
        nargs="+",
        required=True,
        help="split:val, seed:A..B, data/*.dwell, @list.txt, HOUSE; several. With --from: "
        "SCENE=HOUSE, several, or a folder with a house for each scene, of its name",
    )
    parser.add_argument(
        "--count", type=count_from_1, help="how many episodes; with --from at most so many"
    )
    parser.add_argument("--out", type=path, required=True, metavar="FILE.jsonl")
    parser.add_argument("--seed", type=count, default=0, help="what they are drawn from")
    add_task_settings(parser)
    parser.add_argument(
        "--expert",
        action="store_true",
        help="the task's expert plays each: how many actions it needs, how far it goes",
    )
    parser.add_argument(
        "--shard", type=shard, default=(0, 1), metavar="K/N", help="the K-th of N parts, from 0"
    )
    parser.add_argument(
        "--workers", type=workers, help="threads, at most 1024 (default: one a processor)"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")
    add_habitat(parser)


def add_task_settings(parser: argparse.ArgumentParser) -> None:
    """Adds ``--set`` and ``--settings``; see :func:`task_settings`."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="FIELD=VALUE",
        help="a setting of the task, as min_distance_m=2; several times",
    )
    parser.add_argument("--settings", metavar="JSON", help="settings of the task by name")


def task_settings(args: argparse.Namespace) -> dict[str, Any]:
    """The task's settings that the options give.

    Raises:
        ValueError: They are none, or one is given twice.
    """
    whole = {} if args.settings is None else from_json("--settings", args.settings)
    if not isinstance(whole, dict):
        raise ValueError(f"--settings: expected a JSON object, found {args.settings[:60]!r}")
    return settings_of("--set", args.set, whole)


def run(args: argparse.Namespace) -> int:
    """Makes the episodes; a run that was stopped goes on where it stopped."""
    from dwell.episode_maker import EpisodeMaker

    if args.source is not None:
        return convert(args)
    refuse_unused(args, _MAKING, "a task of which episodes are made")
    if args.task is None or args.count is None:
        raise ValueError("expected TASK and --count, or --from with a file of Habitat")
    skipped: dict[str, str] = {}

    def skip(house: str, sentence: str) -> None:
        if house not in skipped:
            skipped[house] = sentence
            if len(skipped) <= _MOST_TOLD:
                print(f"dwell episodes: skipped: {sentence}", file=sys.stderr)

    maker = EpisodeMaker(
        args.task,
        args.houses,
        count=args.count,
        seed=args.seed,
        task_settings=task_settings(args),
        shard=args.shard,
        expert=args.expert,
        on_skip=skip,
    )
    check_writable(args.out)
    started = time.perf_counter()
    made = _make(args, maker)
    seconds = time.perf_counter() - started
    summary = {
        "episodes": len(maker.header.places),
        "made_now": made,
        "episodes_per_s": made / seconds if made else None,
        "skipped": skipped,
        "file": str(args.out),
    }
    if len(skipped) > _MOST_TOLD:
        more = len(skipped) - _MOST_TOLD
        print(f"dwell episodes: skipped: {more} more houses", file=sys.stderr)
    if args.json:
        print_json(summary)
    else:
        rate = f" ({made} made now, {made / seconds:.1f} a second)" if made else ""
        print(f"{summary['episodes']} episodes{rate}; {args.out}")
    return 0


def _make(args: argparse.Namespace, maker: Any) -> int:  # noqa: ANN401 - an EpisodeMaker
    """Makes what is not there yet; returns how many."""
    header = maker.header.as_dict()
    job = {"command": "episodes", "expert": args.expert, **header}
    journal = Journal(args.out, job, preliminary=(_HEADER,))
    contents = functools.lru_cache(64)(contents_of)

    def of(item: str) -> str | None:
        """What the houses of files hold that a piece is in."""
        first, _, last = item.partition("-")
        places = range(int(first), int(last) + 1) if last else range(0)
        houses = {maker.house_of(place) for place in places}
        told = [contents(house) for house in sorted(houses) if is_of_files(house)]
        return " ".join(filter(None, told)) or None

    bar, made, whole = ProgressBar(), 0, len(maker.header.places)
    try:
        journal.refuse_changed(of)
        if _HEADER not in journal.done:
            journal.add(_HEADER, [header])
        left = (part for part in maker.parts() if _item(part) not in journal.done)
        for part, episodes in maker.in_parts(left, workers=args.workers or os.cpu_count() or 1):
            journal.add(_item(part), [one.as_dict() for one in episodes], of(_item(part)))
            made += len(episodes)
            bar((part.stop - maker.header.places.start) / whole, episodes[-1].scene_id)
        journal.finish()
    except BaseException:
        journal.close()
        kept = max(len(journal.done) - 1, 0)
        if kept:
            print(f"dwell episodes: {kept} pieces are kept; run again", file=sys.stderr)
        raise
    return made


def _item(part: range) -> str:
    return f"{part.start}-{part.stop - 1}"
