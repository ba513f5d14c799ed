"""Joint steps a second of environments in which several agents act, and their memory.

    python benches/environments/several_agents.py               # steps: some minutes
    python benches/environments/several_agents.py --episodes 10000   # memory over many episodes

A row for each case: joint steps a second (the median over repeats; the slowest and fastest), and ms
of processor that a joint step takes on all threads together. All agents walk at random; episodes
end after 500 steps, and the reset is within the time. What a further agent costs is the slope over
cases that differ in their number alone.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import time
from typing import Any

import numpy as np

from dwell.pettingzoo import DwellParallelEnv, parallel_env

RGB = {"rgb": {"width": 64, "height": 64, "preset": "flat"}}
BINAURAL = {**RGB, "audio": {}}
HOUSES = ("seed:1", "seed:2", "seed:3", "seed:4")
#: Agents, sensors, house by name.
CASES: dict[str, tuple[int, Any, str]] = {
    **{f"4 agents rgb 64 binaural {house}": (4, BINAURAL, house) for house in HOUSES},
    **{f"{agents} agents rgb 64 seed:1": (agents, RGB, "seed:1") for agents in (1, 2, 4, 8, 16)},
    **{f"{agents} agents gps seed:1": (agents, ["gps"], "seed:1") for agents in (1, 4, 16)},
    **{
        f"{agents} agents rgb 64 binaural seed:1": (agents, BINAURAL, "seed:1")
        for agents in (1, 2, 4, 8)
    },
}
#: The names of actions of the walk, as often as they are made.
WALK = ("move_forward", "move_forward", "turn_left", "turn_right")


def made(agents: int, sensors: Any, house: str) -> DwellParallelEnv:  # noqa: ANN401 - of the environment
    """An environment whose agents start anywhere and walk."""
    return parallel_env(
        "Free",
        agents=agents,
        houses=house,
        sensors=sensors,
        task_settings={"start": "anywhere"},
        actions=["move_forward", "turn_left", "turn_right"],
        max_cycles=500,
    )


def play(env: DwellParallelEnv, stream: np.random.Generator, seconds: float) -> tuple[int, float]:
    """Joint steps that are made in so many seconds, and s of processor."""
    steps, start, cpu = 0, time.perf_counter(), time.process_time()
    while time.perf_counter() - start < seconds:
        if not env.agents:
            env.reset()
        moves = stream.integers(len(WALK), size=len(env.agents))
        numbers = [("move_forward", "turn_left", "turn_right").index(WALK[move]) for move in moves]
        env.step(dict(zip(env.agents, numbers, strict=True)))
        steps += 1
    return steps, time.process_time() - cpu


def run_steps(cases: list[str], seconds: float, repeats: int) -> None:
    """Prints a row for each case."""
    for name in cases:
        env = made(*CASES[name])
        env.reset(seed=1)
        stream = np.random.default_rng(1)
        play(env, stream, 0.3 * seconds)
        runs = [play(env, stream, seconds) for _ in range(repeats)]
        rates = sorted(steps / seconds for steps, _ in runs)
        cpu_ms = 1e3 * statistics.median(cpu / steps for steps, cpu in runs)
        row = {
            "case": name,
            "joint_steps_s": round(statistics.median(rates), 1),
            "slowest": round(rates[0], 1),
            "fastest": round(rates[-1], 1),
            "processor_ms": round(cpu_ms, 2),
        }
        print(json.dumps(row), flush=True)
        env.close()


def run_memory(episodes: int) -> None:
    """Prints the resident memory while episodes of four agents begin and end."""
    env = made(4, ["gps"], "seed:1")
    env.reset(seed=1)
    for episode in range(episodes + 1):
        env.reset()
        env.step(dict.fromkeys(env.agents, 0))
        if episode in (100, episodes) or (episode and episode % max(1, episodes // 10) == 0):
            with open("/proc/self/statm", encoding="utf-8") as file:
                pages = int(file.read().split()[1])
            resident = pages * resource.getpagesize() / 1e6
            print(
                json.dumps({"episodes": episode, "resident_mb": round(resident, 1)}),
                flush=True,
            )


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--case", action="append", choices=[*CASES], help="default: all")
    parser.add_argument("--seconds", type=float, default=5.0, help="a repeat takes")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument(
        "--episodes", type=int, help="measure memory over so many, in place of steps"
    )
    given = parser.parse_args()
    if given.episodes:
        run_memory(given.episodes)
    else:
        run_steps(given.case or [*CASES], given.seconds, given.repeats)


if __name__ == "__main__":
    main()
