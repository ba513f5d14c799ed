"""How often the follower by ears (:mod:`dwell.follow_policy`) succeeds in PiedPiper, and why not.

    python benches/environments/follow_by_ears.py --out hears.jsonl --episodes 100
    python benches/environments/follow_by_ears.py --out deaf.jsonl --episodes 100 --deaf

Two leaders, one follower, houses of a split, all else by default. A line is written for each
episode; what is there already is not played again, so a run that was stopped goes on, and several
may write files of different seeds. A deaf follower gets silence for what its ears hear.

Why it failed, the first that holds: the right leader was on another storey in most of the second
half; the follower was nearer to the wrong one there; a thing of the house makes the same sound; it
never came near; it lost the right one again.
"""

from __future__ import annotations

import argparse
import collections
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from dwell.challenge.scores import wilson_interval
from dwell.follow_policy import SENSORS, FollowByEars
from dwell.pettingzoo import parallel_env

#: A storey is higher than this, m; the mouth is so high over the feet.
_STOREY_M, _MOUTH_M = 1.5, 1.5
_EVERY = 10


def played(env: Any, seed: int, *, deaf: bool) -> dict[str, Any]:  # noqa: ANN401 - untyped
    """One episode, as a row of the file."""
    policy = FollowByEars()
    observations, infos = env.reset(seed=seed)
    seen = heard(observations["follower"], deaf=deaf)
    policy.reset(seen)
    named = policy.named
    own = [row for row in env.world.sounds() if row["object"] and row["on"]]
    trace: list[tuple[float, float, float]] = []
    steps = 0
    while env.agents:
        observations, *_, infos = env.step({"follower": policy.act(seen)})
        seen = heard(observations["follower"], deaf=deaf)
        steps += 1
        if steps % _EVERY == 0:
            trace.append(distances(env, named))
    info = infos["follower"]
    return {
        "seed": seed,
        "scene": info["scene_id"],
        "sound": named,
        "decoy": any(row["sound"].get("signal") == named for row in own),
        "success": bool(info["success"]),
        "following": float(info["following"]),
        "found": float(info.get("found_step") or -1),
        "trace": trace,
    }


def heard(observation: dict[str, Any], *, deaf: bool) -> dict[str, Any]:
    """What the follower observes; of the deaf nothing makes a sound."""
    if not deaf:
        return observation
    return {**observation, "audio": np.zeros((2, 800), np.float32)}


def distances(env: Any, named: str) -> tuple[float, float, float]:  # noqa: ANN401 - untyped
    """To the right leader: level, and up or down; and level to the wrong one, m."""
    here = np.array(env.agent_states()["follower"]["position"])
    mouths = {
        row["sound"]["signal"]: np.array(row["position"]) - here
        for row in env.world.sounds()
        if row["object"] is None
    }
    right = mouths.pop(named)
    (wrong,) = mouths.values()

    def level_m(way: Any) -> float:  # noqa: ANN401 - an array
        return round(float(math.hypot(way[0], way[2])), 1)

    return level_m(right), round(abs(float(right[1]) - _MOUTH_M), 1), level_m(wrong)


def why(row: dict[str, Any]) -> str:
    """The cause of an episode's end; see the module."""
    if row["success"]:
        return "success"
    second = row["trace"][len(row["trace"]) // 2 :]
    if np.mean([height > _STOREY_M for _, height, _ in second]) > 0.5:
        return "another storey"
    if np.mean([wrong < 2.0 < right for right, _, wrong in second]) > 0.5:
        return "the wrong one"
    if row["decoy"]:
        return "a thing makes the same sound"
    return "never near" if row["found"] < 0 else "lost again, or found late"


def main() -> None:
    """Plays what is missing, and prints what all lines of the files say."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--also", type=Path, nargs="*", default=[], help="files to sum up with it")
    parser.add_argument("--episodes", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--split", default="val")
    parser.add_argument("--deaf", action="store_true")
    args = parser.parse_args()
    files = [args.out, *args.also]
    rows = [json.loads(line) for file in files if file.exists() for line in file.open()]
    done = {row["seed"] for row in rows}
    missing = [k for k in range(args.first, args.first + args.episodes) if k not in done]
    sensors = {name: own for name, own in SENSORS.items() if name != "audio" or not args.deaf}
    leader = {"scripted": True, "sensors": []}
    env = missing and parallel_env(
        "PiedPiper",
        agents={
            "follower": {"sensors": sensors, "action_mode": "velocity"},
            "one": leader,
            "other": leader,
        },
        houses=f"split:{args.split}",
    )
    with args.out.open("a") as out:
        for seed in missing:
            rows.append(played(env, seed, deaf=args.deaf))
            out.write(json.dumps(rows[-1]) + "\n")
            out.flush()
    won = sum(row["success"] for row in rows)
    low, high = wilson_interval(won, len(rows)) or (0.0, 1.0)
    print(f"success {won} of {len(rows)}: {100 * won / len(rows):.0f} % ", end="")
    print(f"({100 * low:.0f} to {100 * high:.0f})")
    following = np.array([row["following"] for row in rows])
    print(
        f"following {following.mean():.2f}, near once {np.mean([r['found'] > 0 for r in rows]):.2f}"
    )
    for cause, count in collections.Counter(map(why, rows)).most_common():
        print(f"{count:4d} {cause}")
    for sound in sorted({row["sound"] for row in rows}):
        own = [row["success"] for row in rows if row["sound"] == sound]
        print(f"{sound}: {sum(own)} of {len(own)}")


if __name__ == "__main__":
    main()
