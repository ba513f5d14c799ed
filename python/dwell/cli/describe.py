"""``dwell describe``: sentences about houses."""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import TYPE_CHECKING, Any

from dwell.cli.common import ProgressBar, count, path
from dwell.cli.job_journal import Journal, contents_of, is_of_files
from dwell.files import open_file
from dwell.result_version import VERSION

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Literal

    from dwell.grounded_text import Text
    from dwell.house import House
    from dwell.world import World

_LEVELS = ("object", "room", "house", "view", "route", "changes", "graph", "instructions")
_LENGTHS = ("short", "normal", "long")
_STYLES = ("plain", "rich")
#: Levels of which there is one length, and one style.
_OF_ONE_LENGTH = ("changes", "graph", "instructions")
_OF_ONE_STYLE = ("route", *_OF_ONE_LENGTH)


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("houses", metavar="HOUSE", nargs="+")
    parser.add_argument(
        "--level",
        choices=_LEVELS,
        default="house",
        help="view: from the best viewpoint of each room; route: from each room to each other; "
        "changes: HOUSE is a replay, and its end is compared with its start",
    )
    parser.add_argument(
        "--length",
        choices=_LENGTHS,
        default="normal",
        help="of objects, rooms, houses, views and routes; long ones also say where things stand "
        "to each other",
    )
    parser.add_argument(
        "--style",
        choices=_STYLES,
        default="rich",
        help="of objects, rooms, houses and views: plain ones name things without their colours, "
        "materials and sizes",
    )
    parser.add_argument("--seed", type=count, help="draws the wordings, with the name of the house")
    parser.add_argument(
        "--out",
        type=path,
        metavar="FILE.jsonl",
        help="one JSON object a line; a run that was stopped goes on",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Describes every house; one that cannot be opened is reported and skipped (status 1)."""
    from dwell.house_list import HouseList

    houses = HouseList(args.houses)
    if args.length != "normal" and args.level in _OF_ONE_LENGTH:
        raise ValueError(f"--length {args.length}: texts of level {args.level} have one length")
    if args.style != "rich" and args.level in _OF_ONE_STYLE:
        raise ValueError(f"--style {args.style}: texts of level {args.level} have one style")
    options = {"length": args.length, "style": args.style, "seed": args.seed}
    job = {"command": "describe", "level": args.level, **options, "houses": args.houses}
    journal = Journal(args.out, job) if args.out else None
    printer = _Printer(args.level) if args.json else None
    told, failed = set() if journal is None else set(journal.done), 0
    bar = ProgressBar()
    try:
        if journal is not None:
            journal.refuse_changed(contents_of)
        for k, name in enumerate(houses):
            if name not in told:
                told.add(name)
                contents = None if journal is None else contents_of(name)
                rows = _describe(name, args.level, options)
                failed += rows is None
                if journal is not None and rows is not None:
                    journal.add(name, rows, contents)
                elif journal is None:
                    for row in rows or []:
                        (printer or _say)(row)
            if len(houses) > 1:
                bar((k + 1) / len(houses), name)
    except BaseException:
        if journal is not None:
            journal.close()
            kept = len(journal.done)
            print(f"dwell describe: {kept} of {len(houses)} are kept; run again", file=sys.stderr)
        raise
    if journal is not None:
        journal.finish()
        if printer:
            with open_file(args.out) as file:
                for line in file:
                    printer(json.loads(line))
    if printer:
        printer.end()
    return 1 if failed else 0


class _Printer:
    """One JSON object on standard output, printed row by row."""

    def __init__(self, level: str) -> None:
        self._before = f'{{"level": {json.dumps(level)}, "rows": ['

    def __call__(self, row: dict[str, Any]) -> None:
        sys.stdout.write(self._before + json.dumps(row, ensure_ascii=False))
        self._before = ", "

    def end(self) -> None:
        sys.stdout.write(("" if self._before == ", " else self._before) + "]}\n")


def _describe(
    name: str,
    level: Any,  # noqa: ANN401
    options: dict[str, Any],
) -> list[dict[str, Any]] | None:
    """The rows of a house; ``None``, and a sentence, for one that cannot be opened."""
    from dwell import DwellError

    try:
        return list(_rows(name, level, options))
    except DwellError as error:
        said = str(error)
        where = "" if said.startswith(name) else f"{name}: "
        print(f"dwell describe: {where}{said}", file=sys.stderr)
        return None


def _rows(
    name: str,
    level: Any,  # noqa: ANN401
    options: dict[str, Any],
) -> Iterator[dict[str, Any]]:
    from dwell.house import House

    about = {"version": VERSION, "house": name, "level": level}
    if level == "changes":
        yield {**about, **_changes(name, options["seed"]).as_dict()}
        return
    house = House.open(name)
    if level in ("view", "route"):
        yield from ({**about, **row} for row in _from_viewpoints(house, level, options))
        return
    for text in house.describe(level, **options):
        if level in ("graph", "instructions"):
            yield {**about, "text": json.loads(text)}
        else:
            yield {**about, **text.as_dict()}


def _from_viewpoints(
    house: House, level: Literal["view", "route"], options: dict[str, Any]
) -> Iterator[dict[str, Any]]:
    """What is seen from the best viewpoint of each room, and the ways from there."""
    from dwell.world import World

    world, rooms, seed = World(house, agents=0), house.rooms(), options["seed"]
    for number, room in enumerate(rooms):
        viewer = {"position": room["eye"], "yaw_deg": room["yaw_deg"]}
        # Each room has wordings of its own.
        key = None if seed is None else (seed + 1_000_003 * number) % 2**64
        own = {**options, "seed": key, "viewer": viewer}
        if level == "view":
            (text,) = world.describe(level, **own)
            yield {"viewer": viewer, **text.as_dict()}
            continue
        for goal in rooms:
            to = f"room:{goal['name']}"
            if goal is not room:
                for text in world.describe(level, **own, to=to):
                    yield {"viewer": viewer, "to": to, **text.as_dict()}


def _changes(path: str, seed: int | None) -> Text:
    """What an episode changed, told to its agent.

    Raises:
        ConfigError: It is a house.
    """
    from dwell import ConfigError
    from dwell.replays import Replay

    if not is_of_files(path) or os.path.isdir(path):
        raise ConfigError(
            "--level changes expects the file of a replay, as ReplayRecorder writes it, not a house"
        )
    before: bytes | None = None
    world: World | None = None
    for step in Replay.read(path).play():
        world = step.world
        before = world.snapshot() if before is None else before
    assert world is not None, "a replay has a start"
    (text,) = world.describe("changes", seed=seed, agent=0, since=before)
    return text


def _say(row: dict[str, Any]) -> None:
    """Prints a row for people."""
    text = row["text"]
    if isinstance(text, dict):
        text = text.get("text") or json.dumps(text, ensure_ascii=False)
    print(text)
