"""``dwell info``: a house in numbers."""

from __future__ import annotations

import argparse
from typing import Any

from dwell.cli.common import print_json

_MOST_WARNINGS = 20


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE", nargs="?", help="without it: built-in houses")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Prints counts, rooms, categories and the report."""
    from dwell.house import House

    if args.house is None:
        names = House.builtins()
        print_json({"builtins": names}) if args.json else print("\n".join(names))
        return 0
    info = House.open(args.house).info()
    if args.json:
        print_json(info)
        return 0
    print(f"{info['name']} ({info['source']})")
    print(
        f"{_many(info['levels'], 'storey')}, {_many(len(info['rooms']), 'room')}, "
        f"{_many(info['structure'], 'piece')} of structure, {_many(info['objects'], 'object')}, "
        f"{_many(info['joints'], 'joint')}, {_many(info['triangles'], 'triangle')}"
    )
    print(
        f"{_many(info['materials'], 'material')}, {_many(info['textures'], 'texture')}, "
        f"{_many(info['lights'], 'light')}, {_many(info['emitters'], 'source')} of sound"
    )
    for room in info["rooms"]:
        kinds = ", ".join(room["kinds"]) or "no kind given"
        things = _many(room["objects"], "object")
        print(f"  {room['name']}: {kinds}, {room['area_m2']:.1f} m2, {things}")
    rows = sorted(info["categories"].items(), key=lambda row: (-row[1], row[0]))
    print("categories: " + ", ".join(f"{count} {name or 'unknown'}" for name, count in rows))
    for line in _report(info["report"]):
        print(line)
    return 0


def _many(count: int, noun: str) -> str:
    return f"{count} {noun}" + ("" if count == 1 else "s")


def _report(report: Any) -> list[str]:  # noqa: ANN401 - JSON
    """The reader's report: how many warnings, and the first of them."""
    warnings = report.get("warnings", []) if isinstance(report, dict) else []
    if not warnings:
        return ["report: nothing to report"]
    total = len(warnings) + int(report.get("not_kept", 0))
    lines = [f"report: {_many(total, 'warning')}"]
    lines += [f"  {warning['sentence']}" for warning in warnings[:_MOST_WARNINGS]]
    if total > _MOST_WARNINGS:
        lines.append(f"  and {total - _MOST_WARNINGS} more (--json has them)")
    return lines
