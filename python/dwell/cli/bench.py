"""``dwell bench``: throughput of a stage, measured in the engines."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from dwell.camera import PRESETS
from dwell.cli.common import (
    ProgressBar,
    add_back_end,
    back_end,
    count,
    path,
    print_json,
    refuse_unused,
)
from dwell.files import read_json

#: Stages, and the options that each reads.
_STAGES = {
    "load": {"repeats"},
    "render": {
        "views",
        "resolution",
        "batch",
        "preset",
        "backend",
        "path",
        "batches",
        "threads",
        "repeats",
    },
    "physics": {"boxes", "worlds", "threads", "repeats", "steps"},
    "acoustics": {"threads", "repeats"},
    "env": {"envs", "steps"},
}
#: Fields of ``--boxes``, and of each box.
_BOXES = ("fixed", "dynamic", "density_kg_m3", "physics_rate_hz")
_BOX = ("center", "half_extents")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("stage", choices=tuple(_STAGES))
    parser.add_argument("house", metavar="HOUSE", nargs="?", default="builtin:apartment")
    parser.add_argument(
        "--views", type=path, metavar="FILE", help="JSON list of position and forward"
    )
    parser.add_argument(
        "--boxes",
        type=path,
        metavar="FILE",
        help="physics: JSON of fixed and dynamic boxes, density_kg_m3 and physics_rate_hz",
    )
    parser.add_argument("--worlds", type=count, default=64, help="physics: worlds stepped together")
    parser.add_argument(
        "--resolution",
        type=_counts,
        default=[128],
        metavar="N[,N...]",
        help="pixels across and down; several with --batch",
    )
    parser.add_argument(
        "--batch",
        type=_counts,
        default=[],
        metavar="N[,N...]",
        help="render: views in a batch, each of a world of its own; a row for each and each "
        "resolution, by both paths of an adapter unless --path names one",
    )
    parser.add_argument("--preset", choices=PRESETS, default="flat")
    add_back_end(parser)
    parser.add_argument(
        "--batches", type=count, default=1, help="render: how often all views are in one batch"
    )
    parser.add_argument("--threads", type=count, help="default: what the machine allows")
    parser.add_argument("--repeats", type=count, default=5, help="the median counts")
    parser.add_argument("--envs", type=count, default=4)
    parser.add_argument("--steps", type=count, default=200)
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Measures and prints."""
    from dwell import _native

    used = _STAGES[args.stage] | {"stage", "house", "json"}
    refuse_unused(args, used, f"bench {args.stage}")
    options: dict[str, Any] = {
        key: getattr(args, key)
        for key in (
            "batch",
            "preset",
            "threads",
            "repeats",
            "envs",
            "steps",
            "worlds",
            "batches",
        )
    }
    options["resolution"] = args.resolution[0]
    options["resolutions"] = args.resolution
    if len(args.resolution) > 1 and not args.batch:
        raise ValueError("--resolution takes several numbers only beside --batch")
    options["backend"] = back_end(args)
    if args.views:
        options["views"] = _views(args.views)
    if args.boxes:
        options["boxes"] = read_json(args.boxes)
        if not isinstance(options["boxes"], dict):
            raise ValueError(f"{args.boxes}: expected one JSON object of fixed and dynamic boxes")
        if missing := [field for field in _BOXES if field not in options["boxes"]]:
            raise ValueError(
                f"{args.boxes}: {', '.join(missing)} missing; expected are {', '.join(_BOXES)}"
            )
        for field in _BOXES[:2]:
            _check_boxes(f"{args.boxes}: {field}", options["boxes"][field])
    figures = _native.bench(args.stage, args.house, options, ProgressBar())
    if args.json:
        print_json(figures)
        return 0
    for row in figures.pop("rows", []):
        print("  ".join(f"{key} {_word(value)}" for key, value in row.items()))
    for key, value in figures.items():
        print(f"{key}: {value:.4g}" if isinstance(value, float) else f"{key}: {value}")
    return 0


def _counts(text: str) -> list[int]:
    """Whole numbers, at least 1, with commas between them."""
    return [count(part) for part in text.split(",")]


def _word(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _check_boxes(at: str, rows: object) -> None:
    """Refuses what is no list of boxes."""
    if not isinstance(rows, list):
        raise ValueError(f"{at}: expected a list of boxes, found {rows!r:.60}")
    for k, row in enumerate(rows):
        if not isinstance(row, dict) or {*row} != {*_BOX} or not all(map(_is_point, row.values())):
            raise ValueError(
                f"{at}[{k}]: expected {' and '.join(_BOX)}, [x, y, z] in metres each, "
                f"found {row!r:.200}"
            )


def _views(path: Path) -> list[dict[str, Any]]:
    """The views of a file; fields beside position and forward are left out."""
    rows = read_json(path)
    if not isinstance(rows, list):
        raise ValueError(f"{path}: expected a JSON list of views, found {type(rows).__name__}")
    keys = ("position", "forward")
    for k, row in enumerate(rows):
        if not isinstance(row, dict) or not all(_is_point(row.get(key)) for key in keys):
            raise ValueError(
                f"{path}: view {k}: expected position and forward, three finite numbers each, "
                f"found {row!r:.200}"
            )
        if not any(row["forward"]):
            raise ValueError(f"{path}: view {k}: forward is 0; a direction has a length")
    return [{key: row[key] for key in keys} for row in rows]


def _is_point(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(isinstance(part, int | float) and math.isfinite(part) for part in value)
    )
