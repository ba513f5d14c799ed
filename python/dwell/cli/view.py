"""``dwell view``: a house in the Rerun viewer, or as a recording for it."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from dwell.cli.common import count, count_from_1, path, print_json, refuse_unused
from dwell.files import atomic_write


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("house", metavar="HOUSE|REPLAY", help="a replay file ends with .replay")
    parser.add_argument(
        "--out",
        type=path,
        metavar="FILE.rrd",
        help="write a recording; without it the viewer opens",
    )
    parser.add_argument(
        "--task", help="the scripted expert of this task plays an episode, recorded step by step"
    )
    parser.add_argument(
        "--agents",
        type=count_from_1,
        help="how many agents play --task's episode; default as many as it needs",
    )
    parser.add_argument("--seed", type=count, default=0, help="of --task's episode")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Shows surfaces, boxes, lamps, joints, cameras, ways of sound, and how an episode goes."""
    from dwell import _native
    from dwell.house import House
    from dwell.recording import (
        Recording,
        record_agents,
        record_episode,
        record_house,
        record_replay,
        sdk,
    )
    from dwell.replays import Replay
    from dwell.world import World

    if args.task is None:
        refuse_unused(args, {"house", "out", "json"}, "a view without --task")
    sdk()
    if args.out is None and not _has_display():
        raise ValueError("no display for the viewer; --out FILE.rrd writes a recording for it")
    replay = Replay.read(args.house) if args.house.endswith(".replay") else None
    if replay is not None and args.task is not None:
        raise ValueError("--task plays an episode of its own; a replay is one already")
    house = House.open(args.house if replay is None else replay.house)

    def fill(path: Path | None) -> None:
        recording = Recording(f"dwell {args.house}", path)
        record_house(recording, World(house, agents=0))
        if replay is not None:
            record_replay(recording, house, replay)
        if args.task is not None:
            needed = {row["name"]: row["min_agents"] for row in _native.tasks()}
            agents = needed.get(args.task, 1) if args.agents is None else args.agents
            if agents == 1:
                record_episode(recording, house, args.task, args.seed)
            else:
                record_agents(recording, house, args.task, agents, args.seed)
        recording.close()

    if args.out is None:
        fill(None)
        return 0
    with atomic_write(args.out) as path:
        fill(path)
    if args.json:
        print_json({"file": str(args.out)})
    else:
        print(args.out)
    return 0


def _has_display() -> bool:
    if not sys.platform.startswith("linux"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
