"""``dwell check-text``: whether the claims of a text are true of a house, or of a view in it."""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

from dwell import ConfigError, DwellError
from dwell.arguments import quoted
from dwell.cli.common import decimal, path, print_json

if TYPE_CHECKING:
    from pathlib import Path

    from dwell.world import World

#: The colours of claims on a terminal.
_COLORS = {
    "true": "\x1b[32m",
    "false": "\x1b[31m",
    "undecided": "\x1b[33m",
    "not_understood": "\x1b[35m",
    "no_claim": "",
}
_END_COLOR = "\x1b[0m"


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE")
    texts = parser.add_argument(
        "texts",
        # As errors call it.
        metavar="TEXT (or --file FILE)",
        nargs="+",
        help="a caption or description, whose claims are judged one by one, or a question",
    )
    parser.add_argument(
        "--file",
        type=path,
        action=_file_instead_of(texts),
        metavar="FILE",
        help="more texts, one a line; of FILE.jsonl the field text of each object, with viewer "
        "(position, yaw_deg, pitch_deg) and house where it has them",
    )
    parser.add_argument(
        "--view",
        metavar="VIEW",
        help="the text tells what is seen from the viewpoint of a room, counted from 0, or from "
        "X,Y,Z,YAW[,PITCH] (m, degrees): things out of sight are none of it",
    )
    parser.add_argument(
        "--of-house",
        action="store_true",
        help="with --view: the text tells of the house, and only sides are those of the view",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")
    # Of arguments of which one is enough argparse knows among options alone.
    parser.usage = (
        "%(prog)s [-h] HOUSE [TEXT ...] [--file FILE] [--view VIEW] [--of-house] [--json]\n"
        "  with a TEXT, a FILE, or both"
    )


def _file_instead_of(texts: argparse.Action) -> type[argparse.Action]:
    """An option with which there need be no texts.

    Were texts optional, argparse would not take those behind other options.
    """

    class File(argparse.Action):
        def __call__(
            self,
            parser: argparse.ArgumentParser,
            namespace: argparse.Namespace,
            values: object,
            option: str | None = None,
        ) -> None:
            setattr(namespace, self.dest, values)
            texts.required = False

    return File


def run(args: argparse.Namespace) -> int:
    """Judges every text; 1 where something was not understood."""
    rows, counts = [], Counter[str]()
    worlds = _Worlds(args)
    for at, given in _texts(args):
        try:
            row = _judged(worlds, args, given)
        except (DwellError, ValueError) as error:
            raise ConfigError(f"{at}{error}") from None
        rows.append(row)
        counts.update(claim["status"] for claim in row["claims"])
        if not args.json:
            _say(row)
        for claim in row["claims"]:
            if claim["status"] == "not_understood":
                told = f"{quoted(claim['text'], 200)}: {claim['reason']}"
                print(f"dwell check-text: {told}", file=sys.stderr)
    judged = counts["true"] + counts["false"]
    share = counts["false"] / judged if judged else None
    if args.json:
        whole = {"counts": dict(counts), "false_share": share}
        print_json({"house": args.house, "rows": rows, **whole})
    elif sum(counts.values()) > 1:
        names = ", ".join(f"{counts[name]} {name.replace('_', ' ')}" for name in counts)
        print(f"{sum(counts.values())} claims: {names}")
    return 1 if counts["not_understood"] else 0


class _Worlds:
    """The world of the house that was opened last, and the view of the command line."""

    def __init__(self, args: argparse.Namespace) -> None:
        self._name = args.house
        self._world = self._open(args.house)
        self.viewer = None if args.view is None else _viewer(self._world, args.view)

    def _open(self, name: str) -> World:
        from dwell import House, World

        return World(House.open(name), agents=0)

    def of(self, name: str) -> World:
        if name != self._name:
            self._name, self._world = name, self._open(name)
        return self._world


def _viewer(world: World, view: str) -> dict[str, Any]:
    """The camera that ``--view`` names."""
    parts = view.split(",")
    expected = "expected the number of a room, or X,Y,Z,YAW[,PITCH]"
    try:
        numbers = [decimal(part) for part in parts]
    except ValueError:
        raise ValueError(f"--view: {expected}, found {quoted(view)}") from None
    if len(numbers) in (4, 5):
        *position, yaw, pitch = numbers if len(numbers) == 5 else [*numbers, 0.0]
        return {"position": position, "yaw_deg": yaw, "pitch_deg": pitch}
    rooms = world.house.rooms()
    if len(numbers) != 1 or not view.isdigit():
        raise ValueError(f"--view: {expected}, found {quoted(view)}")
    if int(view) >= len(rooms):
        raise ValueError(f"--view: no room {int(view)}; the house has {len(rooms)}")
    room = rooms[int(view)]
    return {"position": room["eye"], "yaw_deg": room["yaw_deg"]}


def _texts(args: argparse.Namespace) -> Iterator[tuple[str, dict[str, Any]]]:
    """All texts, each with what errors of it begin with."""
    blank = [text for text in args.texts or () if not text.strip()]
    if blank:
        raise ValueError(f"TEXT is {quoted(blank[0])}; expected a sentence")
    for text in args.texts or ():
        yield "", {"text": text}
    if args.file is not None:
        found = False
        for at, row in _of_file(args.file):
            found = True
            yield f"{at}: ", row
        if not found:
            raise ValueError(f"{os.fspath(args.file)}: no text; expected one a line")


def _of_file(file: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """The texts of a file, each with its place."""
    from dwell.files import decoded, lines, open_file, parse_json

    with open_file(file) as opened:
        for number, line in enumerate(lines(opened, file), start=1):
            at = f"{os.fspath(file)} line {number}"
            text = decoded(line, at).strip()
            if not text:
                continue
            if file.suffix.lower() != ".jsonl":
                yield at, {"text": text}
                continue
            row = parse_json(line, at)
            if not isinstance(row, dict) or not isinstance(row.get("text"), str):
                raise ValueError(f"{at}: expected an object with a text, found {quoted(row, 80)}")
            yield at, row


def _judged(worlds: _Worlds, args: argparse.Namespace, given: dict[str, Any]) -> dict[str, Any]:
    """A text with its verdicts; questions have answers."""
    house = given.get("house", args.house)
    world = worlds.of(house)
    viewer = given.get("viewer", worlds.viewer if house == args.house else None)
    scope: Literal["house", "view"] = "house" if viewer is None or args.of_house else "view"
    found = world.check_text(given["text"], viewer=viewer, scope=scope)
    for claim in found["claims"]:
        if claim["form"] is not None and "question" in claim["form"]:
            claim |= {
                key: value
                for key, value in world.check(claim["text"], viewer=viewer).items()
                if key in ("answer", "ambiguities")
            }
    return {**given, "house": house, "viewer": viewer, "scope": scope, **found}


def _say(row: dict[str, Any]) -> None:
    """Prints each claim with its verdict, in colour on a terminal."""
    if not row["claims"]:
        print(f"{quoted(row['text'], 80)} claims nothing.")
    is_terminal = getattr(sys.stdout, "stream", sys.stdout).isatty()
    for claim in row["claims"]:
        verdict = _verdict(claim)
        line = f"{claim['text']} {verdict}"
        # Names come from strangers; the colours are ours.
        out = getattr(sys.stdout, "stream", sys.stdout)
        color = _COLORS[claim["status"]] if is_terminal else ""
        if color:
            sys.stdout.flush()
            out.write(color)
        print(line)
        if color:
            sys.stdout.flush()
            out.write(_END_COLOR)
            out.flush()
        for ambiguity in claim.get("ambiguities", ()):
            names = ", ".join(thing["name"] for thing in ambiguity["things"][:10])
            print(f"  {ambiguity['question'] or 'Which one do you mean?'} ({names})")


def _verdict(claim: dict[str, Any]) -> str:
    """The verdict on a claim, or the answer to a question, for people."""
    status = str(claim["status"])
    if status == "no_claim":
        return _answer(claim["answer"]) if "answer" in claim else "is a request."
    if status in ("undecided", "not_understood"):
        return f"{status.replace('_', ' ')}: {claim['reason']}"
    facts = (", ".join(thing["name"] for thing in fact["things"]) for fact in claim["witnesses"])
    shown = "; ".join(list(dict.fromkeys(facts))[:3])
    elsewhere = ", but true of the house" if claim["holds_elsewhere"] else ""
    return status + (f" ({shown})" if shown else "") + elsewhere


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
