"""``dwell bench``: throughput of a stage, measured in the engines."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from dwell.cli.common import print_json

_STAGES = ("load", "render", "physics", "acoustics", "env")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("stage", choices=_STAGES)
    parser.add_argument("house", metavar="HOUSE", nargs="?", default="builtin:apartment")
    parser.add_argument(
        "--views", type=Path, metavar="FILE", help="JSON list of position and forward"
    )
    parser.add_argument(
        "--boxes",
        type=Path,
        metavar="FILE",
        help="physics: JSON of fixed and dynamic boxes, density_kg_m3 and physics_rate_hz",
    )
    parser.add_argument("--worlds", type=int, default=64, help="physics: worlds stepped together")
    parser.add_argument("--resolution", type=int, default=128, help="pixels across and down")
    parser.add_argument("--preset", choices=("flat", "lit"), default="flat")
    parser.add_argument("--threads", type=int)
    parser.add_argument("--repeats", type=int, default=5, help="the median counts")
    parser.add_argument("--envs", type=int, default=4)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Measures and prints."""
    from dwell import _native

    options: dict[str, Any] = {
        key: getattr(args, key)
        for key in ("resolution", "preset", "threads", "repeats", "envs", "steps", "worlds")
    }
    if args.views:
        rows = json.loads(args.views.read_text("utf-8"))
        options["views"] = [{key: row[key] for key in ("position", "forward")} for row in rows]
    if args.boxes:
        options["boxes"] = json.loads(args.boxes.read_text("utf-8"))
    figures = json.loads(_native.bench_json(args.stage, args.house, json.dumps(options)))
    if args.json:
        print_json(figures)
        return 0
    for key, value in figures.items():
        print(f"{key}: {value:.4g}" if isinstance(value, float) else f"{key}: {value}")
    return 0
