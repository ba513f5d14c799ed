"""Steps per second of many forked workers beside few: what pools of threads in each of them cost.

The work is always the same: one episode for each of the many, with its own seed and the same walk.
(A step's cost varies with what there is to hear, so equal times would not be equal work.) Every
worker is a process with one environment of its own, forked from a parent that has used the engines
before. Rounds of few and many alternate, so that what else the machine does meets both alike; on a
busy machine many workers get a larger share of it, and the ratio of processor time is the one that
counts.

    .venv/bin/python benches/workers/run.py --workers 2,16 --steps 25 --rounds 5
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import statistics
import time
from multiprocessing.queues import Queue
from multiprocessing.synchronize import Barrier

import numpy as np

import dwell
from dwell.envs import DwellEnv


def episode(env: DwellEnv, seed: int, steps: int) -> None:
    """Plays the walk from the start."""
    walk = [k for k, name in enumerate(env.actions()) if "forward" in name or "turn" in name]
    env.reset(seed=seed)
    for step in range(steps):
        if env.step(np.int64(walk[(step // 3) % len(walk)]))[2]:
            env.reset()


def worker(
    seeds: list[int],
    args: argparse.Namespace,
    ready: Barrier,
    ends: Queue[tuple[float, float]],
) -> None:
    """Plays its episodes when all are ready, and says when it was done."""
    sensors = args.sensors.split(",") if args.sensors else None
    env = DwellEnv(houses=args.house, sensors=sensors)
    episode(env, 0, 5)  # what is made once a process
    ready.wait()
    before = time.process_time()
    for seed in seeds:
        episode(env, seed, args.steps)
    ends.put((time.monotonic(), time.process_time() - before))


def rates(workers: int, episodes: int, args: argparse.Namespace) -> tuple[float, float]:
    """Steps per second, and per second of processor time, of all workers together."""
    fork = multiprocessing.get_context("fork")
    ready, ends = fork.Barrier(workers + 1), fork.Queue()
    processes = [
        fork.Process(target=worker, args=(list(range(k, episodes, workers)), args, ready, ends))
        for k in range(workers)
    ]
    for process in processes:
        process.start()
    ready.wait()
    start = time.monotonic()
    done = [ends.get() for _ in processes]
    for process in processes:
        process.join()
    steps = episodes * args.steps
    return steps / (max(end for end, _ in done) - start), steps / sum(cpu for _, cpu in done)


def main() -> None:
    """Prints each round and the ratios of the medians."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--workers", default="2,16", help="numbers of workers, the last the most")
    parser.add_argument("--steps", type=int, default=25, help="of an episode")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--house", default="builtin:apartment")
    parser.add_argument("--sensors", default="", help="names with commas; default the task's own")
    args = parser.parse_args()
    sizes = [int(size) for size in args.workers.split(",")]
    world = dwell.World(args.house)
    world.render(agent=0)  # the parent has a pool of threads, as a user's has
    found: dict[int, list[tuple[float, float]]] = {size: [] for size in sizes}
    for _ in range(args.rounds):
        for size in sizes:
            found[size].append(rates(size, max(sizes), args))
        shown = {size: [round(rate, 1) for rate in all_[-1]] for size, all_ in found.items()}
        print(json.dumps(shown), flush=True)
    for size in sizes[1:]:
        pairs = list(zip(found[size], found[sizes[0]], strict=True))
        wall, cpu = (statistics.median(many[k] / few[k] for many, few in pairs) for k in (0, 1))
        print(
            f"{size} workers beside {sizes[0]}: {wall:.3f} times the steps per second, "
            f"{cpu:.3f} times those per second of processor time"
        )


if __name__ == "__main__":
    main()
