"""``dwell describe``: sentences about houses."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from dwell.cli.common import ProgressBar, count, path
from dwell.cli.job_journal import Journal, contents_of
from dwell.files import open_file

_LEVELS = ("object", "room", "house", "graph", "instructions")
_LENGTHS = ("short", "normal", "long")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("houses", metavar="HOUSE", nargs="+")
    parser.add_argument("--level", choices=_LEVELS, default="house")
    parser.add_argument(
        "--length",
        choices=_LENGTHS,
        default="normal",
        help="of objects, rooms and houses; long ones also say where things stand to each other",
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
    if args.length != "normal" and args.level not in ("object", "room", "house"):
        raise ValueError(
            f"--length {args.length}: only the levels object, room and house have lengths"
        )
    settings = {"level": args.level, "length": args.length, "seed": args.seed}
    job = {"command": "describe", **settings, "houses": args.houses}
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
                rows = _describe(name, args.level, args.length, args.seed)
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
    length: Any,  # noqa: ANN401
    seed: int | None,
) -> list[dict[str, Any]] | None:
    """The rows of a house; ``None``, and a sentence, for one that cannot be opened."""
    from dwell import DwellError
    from dwell.house import House

    try:
        texts = House.open(name).describe(level, length=length, seed=seed)
    except DwellError as error:
        said = str(error)
        where = "" if said.startswith(name) else f"{name}: "
        print(f"dwell describe: {where}{said}", file=sys.stderr)
        return None
    if level in ("graph", "instructions"):
        return [{"house": name, "level": level, "text": json.loads(text)} for text in texts]
    return [{"house": name, "level": level, **text.as_dict()} for text in texts]


def _say(row: dict[str, Any]) -> None:
    """Prints a row for people."""
    text = row["text"]
    if isinstance(text, dict):
        text = text.get("text") or json.dumps(text, ensure_ascii=False)
    print(text)
