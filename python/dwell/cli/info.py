"""``dwell info``: a house in numbers."""

from __future__ import annotations

import argparse

from dwell.cli.common import print_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Prints counts, rooms, categories and the report."""
    from dwell.house import House

    info = House.open(args.house).info()
    if args.json:
        print_json(info)
        return 0
    print(f"{info['name']} ({info['source']})")
    print(
        f"{info['levels']} storeys, {len(info['rooms'])} rooms, "
        f"{info['structure']} pieces of structure, "
        f"{info['objects']} objects, {info['joints']} joints, {info['triangles']} triangles"
    )
    print(f"{info['materials']} materials, {info['textures']} textures, ", end="")
    print(f"{info['lights']} lights, {info['emitters']} sources of sound")
    for room in info["rooms"]:
        kinds = ", ".join(room["kinds"]) or "no kind given"
        print(f"  {room['name']}: {kinds}, {room['area_m2']:.1f} m2, {room['objects']} objects")
    rows = sorted(info["categories"].items(), key=lambda row: (-row[1], row[0]))
    print("categories: " + ", ".join(f"{count} {name or 'unknown'}" for name, count in rows))
    print(f"report: {_report(info['report'])}")
    return 0


def _report(report: object) -> str:
    """The reader's report in a few words."""
    if isinstance(report, dict):
        parts = [
            f"{len(rows)} {key}" for key, rows in report.items() if isinstance(rows, list) and rows
        ]
        return ", ".join(parts) or "nothing to report"
    return "nothing to report" if not report else str(report)
