"""``dwell describe``: sentences about houses."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from dwell.cli.common import Bar, atomic

_LEVELS = ("object", "room", "house", "graph", "instructions")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("houses", metavar="HOUSE", nargs="+")
    parser.add_argument("--level", choices=_LEVELS, default="house")
    parser.add_argument("--seed", type=int, help="draws the wording of instructions")
    parser.add_argument("--out", type=Path, metavar="FILE.jsonl", help="one JSON object a line")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Describes every house; one that cannot be opened is reported and skipped (status 1)."""
    from dwell import DwellError
    from dwell.house import House

    rows: list[dict[str, Any]] = []
    failed = 0
    bar = Bar()
    for k, name in enumerate(args.houses):
        try:
            texts = House.open(name).describe(args.level, seed=args.seed)
        except DwellError as error:
            print(f"dwell describe: {name}: {error}", file=sys.stderr)
            failed += 1
            continue
        for text in texts:
            value = json.loads(text) if args.level in ("graph", "instructions") else text
            rows.append({"house": name, "level": args.level, "text": value})
        if len(args.houses) > 1:
            bar((k + 1) / len(args.houses), name)
    if args.out:
        with atomic(args.out) as path:
            path.write_text(
                "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in rows), "utf-8"
            )
    if args.json:
        sys.stdout.write(json.dumps({"level": args.level, "rows": rows}, ensure_ascii=False) + "\n")
    elif not args.out:
        for row in rows:
            text = row["text"]
            if isinstance(text, dict):
                text = text.get("text") or json.dumps(text, ensure_ascii=False)
            print(text)
    return 1 if failed else 0
