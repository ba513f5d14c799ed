"""Asks oracles and predicates the same questions in many houses, and keeps where they differ.

    export PYTHONPATH=python/tests
    python -m oracles --houses 1000 --journal survey.jsonl    # goes on where it stopped
    python -m oracles --journal survey.jsonl --table          # what was found so far

Each house is a line of the journal. A house that SUNCG's data is needed for is skipped, and says
so, where the data is absent (``DWELL_SHARED_DATA`` or ``../shared/data``).
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import logging
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from oracles.survey import Survey

BUILTINS = ("builtin:studio", "builtin:apartment")
COLUMNS = ("asked", "agreed", "disagreed", "undecidable")


def suncg_house(data: Path) -> Path | None:
    """The sample house of SUNCG, if it is there."""
    return next(iter(sorted((data / "suncg" / "house").glob("*/house.json"))), None)


def names(count: int, data: Path) -> Iterator[str]:
    """The houses, real and built-in ones first."""
    found = suncg_house(data)
    if found is None:
        print(f"skipped: the SUNCG house (nothing below {data / 'suncg'})", file=sys.stderr)
    else:
        yield str(found)
    yield from BUILTINS
    for seed in range(count):
        yield f"seed:{seed}"


def examined(house: str, number: int, seed: int) -> dict[str, Any]:
    """A line of the journal: answers counted, and every disagreement."""
    begun = time.monotonic()
    line: dict[str, Any] = {"house": house}
    try:
        survey = Survey(house, seed)
        # Maps of storeys and sweeps take longest.
        survey.all(reach=number % 2 == 0, sweep=number % 3 == 0)
    except Exception as error:
        return line | {"error": f"{type(error).__name__}: {error}"}
    counts: dict[str, list[int]] = {}
    apart: list[dict[str, Any]] = []
    held: dict[str, list[int]] = {}
    for question in survey.asked:
        row = counts.setdefault(question.name, [0, 0, 0, 0])
        row[0] += 1
        if question.oracle == "grey":
            row[3] += 1
            continue
        held.setdefault(question.name, [0, 0, 0])[("yes", "no", "void").index(question.engine)] += 1
        row[1 if question.oracle == question.engine else 2] += 1
        if question.oracle != question.engine:
            apart.append(dataclasses.asdict(question))
    return line | {
        "counts": counts,
        "decided": held,
        "disagreements": apart,
        "seconds": round(time.monotonic() - begun, 2),
    }


def lines_of(journal: Path) -> list[dict[str, Any]]:
    """The whole lines of a journal; one that was cut off by an interruption is left out."""
    found = []
    for line in journal.read_text().splitlines() if journal.exists() else ():
        try:
            found.append(json.loads(line))
        except ValueError:
            continue
    return found


def table(lines: list[dict[str, Any]]) -> str:
    """The counts by predicate and way, as Markdown."""
    sums: dict[str, list[int]] = {}
    held: dict[str, list[int]] = {}
    for line in lines:
        for name, row in line.get("counts", {}).items():
            sums[name] = [a + b for a, b in zip(sums.get(name, [0] * 4), row, strict=True)]
        for name, row in line.get("decided", {}).items():
            held[name] = [a + b for a, b in zip(held.get(name, [0] * 3), row, strict=True)]
    rows = [
        "| predicate (oracle) | " + " | ".join(COLUMNS) + " | agreement | held / not / void |",
        "| --- |" + " ---: |" * 6,
    ]
    for name, row in sorted(sums.items()):
        decided = row[1] + row[2]
        share = f"{100 * row[1] / decided:.2f} %" if decided else "-"
        parts = " / ".join(str(x) for x in held.get(name, [0, 0, 0]))
        rows.append(f"| {name} | " + " | ".join(map(str, row)) + f" | {share} | {parts} |")
    errors = [line for line in lines if "error" in line]
    rows.append("")
    rows.append(f"{len(lines)} houses, {len(errors)} with errors.")
    rows += [f"{line['house']}: {line['error']}" for line in errors]
    return "\n".join(rows)


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser("oracles", description=__doc__.split("\n", 1)[0])
    parser.add_argument("--houses", type=int, default=40, help="how many generated houses")
    parser.add_argument("--seed", type=int, default=0, help="of what is asked")
    parser.add_argument("--journal", type=Path, required=True)
    parser.add_argument("--table", action="store_true", help="tell what was found, ask nothing")
    parser.add_argument(
        "--data", type=Path, default=Path(os.environ.get("DWELL_SHARED_DATA", "../shared/data"))
    )
    options = parser.parse_args()
    lines = lines_of(options.journal)
    if not options.table:
        logging.disable(logging.WARNING)
        done = {line["house"] for line in lines}
        with options.journal.open("a") as journal:
            # A line that was cut off is closed.
            if options.journal.stat().st_size and not options.journal.read_bytes().endswith(b"\n"):
                journal.write("\n")
            for number, house in enumerate(names(options.houses, options.data)):
                if house not in done:
                    line = examined(house, number, options.seed)
                    journal.write(json.dumps(line) + "\n")
                    journal.flush()
                    lines.append(line)
    print(table(lines))


if __name__ == "__main__":
    main()
