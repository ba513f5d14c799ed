"""What a process holds that opens house after house and keeps the last few, as environments do.

Each round opens the same houses in the same order, so that rounds end with the same houses kept:
what differs between their ends is the allocator's. Prints resident memory at the end of each round,
and the slope over all but the first tenth of them (at least the first two: textures and models that
houses share are made in the first).

    .venv/bin/python benches/memory/houses.py --houses 50 --rounds 7
"""

from __future__ import annotations

import argparse
import collections
import ctypes
import time
from pathlib import Path

import numpy as np

import dwell

#: As many as an environment keeps.
_KEPT = 16
#: glibc's names of what ``mallopt`` sets.
_OPTIONS = {"arenas": -8, "mmap": -3, "trim": -1, "top": -2}


def resident_mib() -> float:
    """What the process holds in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 2**20


def main() -> None:
    """Opens the houses, round after round."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--houses", type=int, default=50)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--trim", action="store_true", help="malloc_trim after each house")
    parser.add_argument("--mallopt", default="", help="such as mmap=1048576,arenas=1")
    args = parser.parse_args()
    libc = ctypes.CDLL("libc.so.6")
    for option in filter(None, args.mallopt.split(",")):
        name, value = option.split("=")
        if not libc.mallopt(_OPTIONS[name], int(value)):
            raise SystemExit(f"glibc refuses {option}")
    kept: collections.deque[tuple[dwell.World, object]] = collections.deque(maxlen=_KEPT)
    ends = []
    started, trimmed = time.perf_counter(), 0.0
    for k in range(args.rounds):
        for seed in range(args.houses):
            world = dwell.World(f"seed:{seed}")
            world.step()
            kept.append((world, world.render(camera=dwell.Camera(64, 64))))
            if args.trim:
                before = time.perf_counter()
                libc.malloc_trim(0)
                trimmed += time.perf_counter() - before
        ends.append(resident_mib())
        print(
            f"round {k + 1}: {ends[-1]:.1f} MiB, {time.perf_counter() - started:.1f} s",
            flush=True,
        )
    first = min(max(args.rounds // 10, 2), args.rounds - 2)
    rounds = np.arange(first, args.rounds)
    slope = float(np.polyfit(rounds, ends[first:], 1)[0])
    print(
        f"{slope:+.2f} MiB a round, {slope * (len(rounds) - 1):+.1f} MiB over the last "
        f"{len(rounds)} rounds; {args.rounds * args.houses} houses in "
        f"{time.perf_counter() - started:.1f} s, "
        f"{1000 * trimmed / (args.rounds * args.houses):.1f} ms of each in malloc_trim"
    )


if __name__ == "__main__":
    main()
