"""``dwell check-text``: whether sentences are true of a house."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from dwell.arguments import quoted
from dwell.cli.common import count, print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE")
    parser.add_argument("sentences", metavar="TEXT", nargs="+", help="a claim or a question each")
    parser.add_argument(
        "--view",
        type=count,
        metavar="ROOM",
        help="left, right, front and behind as seen from the viewpoint of a room, counted from 0",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Checks every sentence; 1 where one was not understood."""
    from dwell import ConfigError, House, World

    house = House.open(args.house)
    world = World(house, agents=0)
    viewer = None
    if args.view is not None:
        rooms = house.rooms()
        if args.view >= len(rooms):
            raise ValueError(f"--view: no room {args.view}; the house has {len(rooms)}")
        room = rooms[args.view]
        viewer = {"position": room["eye"], "yaw_deg": room["yaw_deg"]}
    rows: list[dict[str, Any]] = []
    for sentence in args.sentences:
        try:
            found = world.check(sentence, viewer=viewer)
        except ConfigError as error:
            rows.append({"text": sentence, "error": str(error)})
            print(f"dwell check-text: {quoted(sentence, 200)}: {error}", file=sys.stderr)
            continue
        rows.append({"text": sentence, **found})
        if not args.json:
            print(f"{sentence} {_answer(found['answer'])}")
            for ambiguity in found["ambiguities"]:
                names = ", ".join(thing["name"] for thing in ambiguity["things"][:10])
                print(f"  {ambiguity['question'] or 'Which one do you mean?'} ({names})")
    if args.json:
        print_json({"house": args.house, "rows": rows})
    return 1 if any("error" in row for row in rows) else 0


_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


def _answer(answer: dict[str, Any] | None) -> str:
    """An answer for people."""
    if answer is None:
        return "is a request."
    if "truth" in answer:
        names = (", ".join(thing["name"] for thing in row["things"]) for row in answer["witnesses"])
        shown = "; ".join(list(dict.fromkeys(names))[:3])
        if answer["truth"] is None:
            return f"undecided: {answer['reason']}"
        return f"{str(answer['truth']).lower()}" + (f" ({shown})" if shown else "")
    if "things" in answer:
        return ", ".join(thing["name"] for thing in answer["things"]) or "nothing"
    if "number" in answer:
        return str(answer["number"])
    if "alternatives" in answer:
        return " and ".join(f"the {_ORDINALS[k]}" for k in answer["alternatives"]) or "neither"
    if "words" in answer:
        return " and ".join(answer["words"])
    return f"undecided: {answer['reason']}"
