"""How often agents that act as their experts say, or at random, succeed in tasks of several agents.

    python benches/environments/scripted_agents.py Carry --out carry.jsonl --episodes 100
    python benches/environments/scripted_agents.py Carry --out chance.jsonl --episodes 300 --random
    python benches/environments/scripted_agents.py HideAndSeek --out hide.jsonl --episodes 100 \
        --settings '{"seeker_expert": "tours"}'

A line is written for each episode; what is there already is not played again. Houses of a split
follow each other by episode. A seed in whose house the task cannot be played counts as none, and
its line says so. Success is that of each agent: an episode's counts where all of them succeeded.
"""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from dwell import ConfigError
from dwell.challenge.scores import wilson_interval
from dwell.pettingzoo import DwellParallelEnv, parallel_env


def played(env: DwellParallelEnv, seed: int, *, at_random: bool) -> dict[str, Any]:
    """One episode, as a row of the file."""
    try:
        _, infos = env.reset(seed=seed)
    except ConfigError as error:
        return {"seed": seed, "refused": str(error)}
    last = {name: dict(info) for name, info in infos.items()}
    for k, name in enumerate(env.possible_agents):
        env.action_space(name).seed(1000 * seed + k)
    steps = 0
    while env.agents:
        actions = (
            {name: env.action_space(name).sample() for name in env.agents}
            if at_random
            else env.expert_actions()
        )
        *_, infos = env.step(actions)
        steps += 1
        for name, info in infos.items():
            last[name] |= info
    numbers = {
        name: {key: float(value) for key, value in info.items() if is_number(value)}
        for name, info in last.items()
    }
    scene = next(iter(last.values()))["scene_id"]
    return {"seed": seed, "scene": scene, "steps": steps, "agents": numbers}


def is_number(value: object) -> bool:
    """Whether it is one number that can be written down."""
    whole = isinstance(value, bool | int | np.bool_ | np.integer)
    return whole or (isinstance(value, float | np.floating) and math.isfinite(value))


def main() -> None:
    """Plays what is missing, and prints what all lines of the file say."""
    parser = argparse.ArgumentParser()
    parser.add_argument("task")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--episodes", type=int, default=100, help="that can be played")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--split", default="val")
    parser.add_argument("--agents", type=int, default=2)
    parser.add_argument("--settings", type=json.loads, default={}, help="of the task, as JSON")
    parser.add_argument("--sensors", default="gps", help="names, with commas between")
    parser.add_argument("--voice", action="store_true", help="the first one can speak")
    parser.add_argument("--muted", action="store_true", help="nobody can speak")
    parser.add_argument("--random", action="store_true")
    args = parser.parse_args()
    rows = [json.loads(line) for line in args.out.open()] if args.out.exists() else []
    done = {row["seed"] for row in rows}
    count = sum("agents" in row for row in rows)
    seed = args.first
    env = parallel_env(
        args.task,
        agents={f"agent_{k}": {"voice": args.voice and k == 0} for k in range(args.agents)},
        houses=f"split:{args.split}",
        sensors=args.sensors.split(","),
        task_settings=args.settings,
        world={"muted": args.muted},
    )
    with args.out.open("a") as out:
        while count < args.episodes:
            if seed not in done:
                row = played(env, seed, at_random=args.random)
                rows.append(row)
                out.write(json.dumps(row) + "\n")
                out.flush()
                count += "agents" in row
            seed += 1
    games = [row for row in rows if "agents" in row]
    print(f"{len(games)} episodes in {len({row['scene'] for row in games})} houses; ", end="")
    print(f"refused {len(rows) - len(games)}; steps {np.mean([row['steps'] for row in games]):.0f}")
    won = sum(all(own["success"] for own in row["agents"].values()) for row in games)
    low, high = wilson_interval(won, len(games)) or (0.0, 1.0)
    print(f"all succeed in {won}: {100 * won / len(games):.0f} %", end=" ")
    print(f"({100 * low:.1f} to {100 * high:.1f})")
    for name in games[0]["agents"]:
        keys = sorted({key for row in games for key in row["agents"][name]})
        for key in keys:
            found = [row["agents"][name][key] for row in games if key in row["agents"][name]]
            print(f"  {name} {key}: {np.mean(found):.3f} (of {len(found)})")


if __name__ == "__main__":
    main()
