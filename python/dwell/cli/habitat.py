"""``dwell episodes --from``: episodes of Habitat and SoundSpaces become a file of ours."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dwell.cli.common import number, path, point, print_json, refuse_unused
from dwell.files import check_writable

if TYPE_CHECKING:
    from dwell.habitat_conversion import Comparison

#: Of what differs or is skipped, so many are told on standard error.
_MOST_TOLD = 10
#: The options that are read.
_OPTIONS = (
    "task",
    "source",
    "houses",
    "count",
    "out",
    "set",
    "settings",
    "expert",
    "json",
    "snap",
    "move",
    "instances",
    "classes",
    "sounds",
    "sound_root",
    "everlasting",
)


def add_habitat(parser: argparse.ArgumentParser) -> None:
    """Adds the options of episodes that are converted."""
    own = parser.add_argument_group("episodes of Habitat and SoundSpaces")
    own.add_argument(
        "--from",
        dest="source",
        type=path,
        metavar="FILE.json.gz",
        help="the data set: SPLIT.json.gz, with content/SCENE.json.gz beside it where there is",
    )
    own.add_argument(
        "--snap",
        type=number,
        default=0.0,
        metavar="M",
        help="starts and goals on which nobody can stand move at most so far (default 0)",
    )
    own.add_argument(
        "--move",
        type=point,
        default=(0.0, 0.0, 0.0),
        metavar="X,Y,Z",
        help="is added to all places, m, where houses have another origin than their scenes",
    )
    own.add_argument(
        "--instances",
        choices=("class", "stated"),
        default="class",
        help="ObjectNav: all things of the class count (default), or those that are stated",
    )
    own.add_argument(
        "--classes",
        action="append",
        default=[],
        metavar="CATEGORY=CLASS,...",
        help="ObjectNav: a category that has another name here, or several; several times",
    )
    own.add_argument(
        "--sounds",
        action="append",
        default=[],
        metavar="SOUND=SIGNAL",
        help="AudioNav: the signal for a sound_id, such as telephone=phone; several times",
    )
    own.add_argument(
        "--sound-root", type=path, metavar="FOLDER", help="AudioNav: the sounds as files"
    )
    own.add_argument(
        "--everlasting",
        action="store_true",
        help="AudioNav: sounds never end, whatever offset and duration are stated",
    )


def convert(args: argparse.Namespace) -> int:
    """Converts the episodes, and says how their ways compare."""
    from dwell import episodes
    from dwell.cli.episodes import task_settings
    from dwell.habitat_conversion import HabitatConverter

    refuse_unused(args, _OPTIONS, "--from")
    told = 0

    def skip(at: str, sentence: str) -> None:
        nonlocal told
        told += 1
        if told <= _MOST_TOLD:
            print(f"dwell episodes: skipped: {at}: {sentence}", file=sys.stderr)

    converter = HabitatConverter(
        args.source,
        _houses(args.houses),
        task=args.task,
        task_settings=task_settings(args),
        snap_m=args.snap,
        move=args.move,
        instances=args.instances,
        classes={
            name: value.split(",") for name, value in _pairs("--classes", args.classes).items()
        },
        sounds=_pairs("--sounds", args.sounds),
        sound_root=args.sound_root,
        everlasting=args.everlasting,
        expert=args.expert,
        on_skip=skip,
    )
    check_writable(args.out)
    count = episodes.write(args.out, converter.header, converter.episodes(args.count))
    found = converter.comparison
    _tell(found)
    if args.json:
        print_json(_summary(found, count, args.out))
    else:
        ways = (
            f"; of {found.compared} ways that are stated ours differ by {found.mean_m:.2f} m on "
            f"average, {found.most_m:.2f} m at most"
        )
        moved = f"; {found.moved} starts and goals moved" if found.moved else ""
        skipped = f"; {len(found.skipped)} skipped" if found.skipped else ""
        print(f"{count} episodes{skipped}{moved}{ways if found.compared else ''}; {args.out}")
    return 0


def _summary(found: Comparison, count: int, out: Path) -> dict[str, Any]:
    return {
        "episodes": count,
        "skipped": found.skipped,
        "moved": found.moved,
        "distances": {
            "compared": found.compared,
            "mean_m": found.mean_m,
            "most_m": found.most_m,
            "differing": {
                at: {"stated_m": stated_m, "found_m": found_m}
                for at, (stated_m, found_m) in found.differing.items()
            },
        },
        "file": str(out),
    }


def _tell(found: Comparison) -> None:
    """Says what differs, and how many were skipped."""
    if len(found.skipped) > _MOST_TOLD:
        more = len(found.skipped) - _MOST_TOLD
        print(f"dwell episodes: skipped: {more} more episodes", file=sys.stderr)
    for at, (stated_m, found_m) in [*found.differing.items()][:_MOST_TOLD]:
        sentence = f"the way to the goal is {stated_m:.2f} m by the file, {found_m:.2f} m here"
        print(f"dwell episodes: {at}: {sentence}", file=sys.stderr)
    if len(found.differing) > _MOST_TOLD:
        more = len(found.differing) - _MOST_TOLD
        print(f"dwell episodes: {more} more ways differ", file=sys.stderr)


def _houses(given: Sequence[str]) -> dict[str, str] | str:
    """Houses by scene, or a folder.

    Raises:
        ValueError: A word is none of both.
    """
    if len(given) == 1 and Path(given[0]).is_dir():
        return given[0]
    return _pairs("--houses", given)


def _pairs(option: str, words: Sequence[str]) -> dict[str, str]:
    """``NAME=VALUE`` as a mapping.

    Raises:
        ValueError: A word is of another form, or a name stands twice.
    """
    found: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name or not value:
            raise ValueError(f"{option}: expected NAME=VALUE, found {word!r:.60}")
        if name in found:
            raise ValueError(f"{option}: {name} is given twice")
        found[name] = value
    return found
