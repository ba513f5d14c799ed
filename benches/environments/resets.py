"""How long resets of environments take, and whether memory stays flat over many of them.

    python benches/environments/resets.py --task InstructionFollowing
    python benches/environments/resets.py --task PointNav --count 10000 --memory

For a task with its default sensors: ms of a reset in a known house (median and slowest of the last
nine tenths); of the first one in another house, its opening included (cold); and, in a vector
environment that opens houses ahead, what a step takes longer that begins an episode in another
house whose opening had time (warm). ``--memory`` prints the resident memory after each tenth of
``--count`` resets in the known house.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from pathlib import Path

from dwell.envs import DwellEnv, DwellVectorEnv


def resident_mb() -> float:
    """Resident memory of this process, 10^6 bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def known_house(
    task: str, house: str, count: int, *, memory: bool
) -> dict[str, object]:
    """Resets in one house."""
    env = DwellEnv(task, houses=house)
    env.reset(seed=1)
    took, held = [], []
    for k in range(count):
        start = time.perf_counter()
        env.reset()
        took.append(1e3 * (time.perf_counter() - start))
        if (k + 1) % max(1, count // 10) == 0:
            held.append(round(resident_mb(), 1))
    env.close()
    late = took[len(took) // 10 :]
    found: dict[str, object] = {
        "known_ms": round(statistics.median(late), 2),
        "slowest_ms": round(max(late), 1),
    }
    return {**found, "resident_mb": held} if memory else found


def cold(task: str, houses: list[str]) -> float:
    """The median of first resets in houses, their opening included, ms."""
    env = DwellEnv(task, houses=houses)
    env.reset(seed=1, options={"house": 0})
    took = []
    for k in range(1, len(houses)):
        start = time.perf_counter()
        env.reset(options={"house": k})
        took.append(1e3 * (time.perf_counter() - start))
    env.close()
    return statistics.median(took)


def warm(task: str, houses: list[str], count: int) -> float:
    """What a step takes longer that begins an episode in a house opened ahead, ms, the median."""
    env = DwellVectorEnv(
        1, task, houses=houses, autoreset_mode="NextStep", max_episode_steps=4
    )
    env.reset(seed=1)
    begins, others = [], []
    ended = False
    for _ in range(5 * count):
        if ended:
            # The thread that opens ahead has time, as beside a policy that thinks.
            time.sleep(1.0)
        start = time.perf_counter()
        _, _, terminated, truncated, _ = env.step([1])
        (begins if ended else others).append(1e3 * (time.perf_counter() - start))
        ended = bool(terminated[0] or truncated[0])
    env.close()
    return statistics.median(begins) - statistics.median(others)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0] if __doc__ else ""
    )
    parser.add_argument("--task", default="InstructionFollowing")
    parser.add_argument("--house", default="builtin:apartment")
    parser.add_argument(
        "--count", type=int, default=100, help="resets in the known house"
    )
    parser.add_argument("--memory", action="store_true")
    args = parser.parse_args()
    houses = [f"seed:{k}" for k in range(1, 7)]
    row = known_house(args.task, args.house, args.count, memory=args.memory)
    row["cold_ms"] = round(cold(args.task, houses), 1)
    row["warm_ms"] = round(warm(args.task, houses, 8), 2)
    print(json.dumps({"task": args.task, **row}))


if __name__ == "__main__":
    main()
