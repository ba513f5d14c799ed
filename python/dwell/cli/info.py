"""``dwell info``: a house in numbers."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from dwell import ConfigError
from dwell.cli.common import path, print_json, refuse_unused
from dwell.files import atomic_write

_MAX_WARNINGS = 20


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE", nargs="?", help="without it: built-in houses")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")
    parser.add_argument("--map", metavar="FILE", help="what foreign names of the house mean")
    parser.add_argument(
        "--init-map",
        type=path,
        metavar="FILE",
        help="write a map with what stayed unmapped, to be filled in",
    )


def run(args: argparse.Namespace) -> int:
    """Prints counts, rooms, categories and the report."""
    from dwell.house import House

    if args.house is None:
        refuse_unused(args, {"json"}, "the list of built-in houses")
        names = House.builtins()
        print_json({"builtins": names}) if args.json else print("\n".join(names))
        return 0
    house = House.open(args.house, map=args.map)
    if args.init_map is not None:
        _write_new(args.init_map, house.map_template())
    info = house.info()
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
    for line in [*_unmapped(info["unmapped"]), *_report(info["report"])]:
        print(line)
    return 0


def _write_new(path: Path, text: str) -> None:
    """Writes a file that is not there yet: a map that somebody filled in stays."""
    try:
        with atomic_write(path, new=True) as draft:
            draft.write_text(text, "utf-8")
    except FileExistsError:
        raise ConfigError(f"--init-map: {path} is there already; name a new file") from None


def _unmapped(names: dict[str, list[dict[str, Any]]]) -> list[str]:
    """The names of the house without a known meaning, the most frequent first."""
    lines = []
    for what, rows in names.items():
        if not rows:
            continue
        lines.append(f"unmapped {what}: {len(rows)}")
        for row in rows[:_MAX_WARNINGS]:
            taken = f", taken for {row['taken_for']}" if row["taken_for"] else ""
            lines.append(f"  {row['name']}: {row['count']}, {row['area_m2']:.1f} m2{taken}")
        if len(rows) > _MAX_WARNINGS:
            lines.append(f"  and {len(rows) - _MAX_WARNINGS} more (--json has them)")
    return lines


def _many(count: int, noun: str) -> str:
    return f"{count} {noun}" + ("" if count == 1 else "s")


def _report(report: Any) -> list[str]:  # noqa: ANN401 - JSON
    """The reader's report: how many warnings, and the first of them."""
    warnings = report.get("warnings", []) if isinstance(report, dict) else []
    if not warnings:
        return ["report: nothing to report"]
    not_kept = int(report.get("not_kept", 0))
    lines = [f"report: {_many(len(warnings) + not_kept, 'warning')}"]
    lines += [f"  {warning['sentence']}" for warning in warnings[:_MAX_WARNINGS]]
    if more := max(len(warnings) - _MAX_WARNINGS, 0):
        lines.append(f"  and {more} more (--json has them)")
    if not_kept:
        lines.append(f"  and {not_kept} that were counted and not kept")
    return lines
