"""The longest steps at an episode's end, with and without houses loaded ahead.

Environments step together through episodes of a few steps, each in a house drawn from many. After
each step the caller waits for a while, as one who trains is busy elsewhere. A round begins with new
environments.

    .venv/bin/python benches/workers/change.py --houses "seed:0..200" --steps 60 --think 0.1
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np

from dwell.envs import DwellVectorEnv


def step_times(
    args: argparse.Namespace, load_ahead: int
) -> tuple[list[float], list[float]]:
    """Seconds of steps that begin episodes, and of the others."""
    envs = DwellVectorEnv(
        args.envs,
        args.task,
        houses=args.houses,
        sensors=args.sensors.split(","),
        max_episode_steps=args.length,
        load_ahead=load_ahead,
    )
    envs.reset(seed=0)
    began: list[float] = []
    others: list[float] = []
    ended = False
    for _ in range(args.steps):
        start = time.perf_counter()
        *_, terminated, truncated, _ = envs.step(np.full(args.envs, 6))
        (began if ended else others).append(time.perf_counter() - start)
        ended = bool((terminated | truncated).any())
        time.sleep(args.think)
    envs.close()
    return began, others


def main() -> None:
    """Prints a line for each round and kind."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--houses", default="seed:0..200")
    parser.add_argument("--task", default="InstructionFollowing")
    parser.add_argument("--sensors", default="rgb,depth,instruction")
    parser.add_argument("--envs", type=int, default=2)
    parser.add_argument("--length", type=int, default=15, help="steps of an episode")
    parser.add_argument("--steps", type=int, default=62)
    parser.add_argument("--think", type=float, default=0.1, help="between steps, s")
    parser.add_argument("--rounds", type=int, default=2)
    args = parser.parse_args()
    for _ in range(args.rounds):
        for load_ahead in (0, 16):
            began, others = step_times(args, load_ahead)
            print(
                f"load_ahead={load_ahead}: {len(began)} steps began episodes, longest "
                f"{1e3 * max(began):.0f} ms, median {1e3 * statistics.median(began):.0f} ms; "
                f"others longest {1e3 * max(others):.0f} ms, "
                f"median {1e3 * statistics.median(others):.0f} ms"
            )


if __name__ == "__main__":
    main()
