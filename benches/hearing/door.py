"""How long each step takes while a door opens and many things sound.

Prints a row a step: its wall time and how many things sound; then the longest step and the 99th
percentile of those from the moment that the door moves.

    .venv/bin/python benches/hearing/door.py --house seed:7 --door door_4 --sounds 19 --preset full
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import dwell

#: What is played where the house itself does not sound enough.
_PLAYED = ("radio", "fan", "tap", "kettle", "speech", "clock")


def playing(world: dwell.World) -> int:
    """How many things sound."""
    return sum(row["on"] for row in world.sounds())


def main() -> None:
    """Opens the door and tells the time that every step takes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--house", default="seed:7")
    parser.add_argument("--door", default="door_4")
    parser.add_argument("--sounds", type=int, default=19)
    parser.add_argument("--preset", default="full")
    parser.add_argument("--before", type=int, default=5, help="steps before the door opens")
    parser.add_argument("--steps", type=int, default=120)
    parser.add_argument("--quiet", action="store_true", help="the last line alone")
    args = parser.parse_args()

    world = dwell.World(args.house, sound_preset=args.preset)
    door = next(row for row in world.joints() if row["object"] == args.door)
    names = {row["name"] for row in dwell.sounds.signals()}
    signals = [name for name in _PLAYED if name in names]
    things = [row for row in world.objects() if row["name"] != args.door]
    k = 0
    while playing(world) < args.sounds:
        world.play(
            signals[k % len(signals)],
            at=things[k * len(things) // args.sounds]["name"],
            loop=True,
        )
        k += 1
    world.listen()
    times = []
    for step in range(args.steps):
        if step == args.before:
            world.command_joint(door["id"], "position", door["limits"][1])
        started = time.perf_counter()
        world.step()
        world.listen()
        took = time.perf_counter() - started
        now = next(row for row in world.joints() if row["id"] == door["id"])["position"]
        if step >= args.before:
            times.append(took)
        if not args.quiet:
            print(f"{step:4} {1000 * took:9.1f} ms  {playing(world):3} sounds  door {now:6.3f}")
    print(
        f"longest {max(times):.3f} s, 99th percentile {np.percentile(times, 99):.3f} s, "
        f"mean {np.mean(times):.3f} s, {playing(world)} things sound"
    )


if __name__ == "__main__":
    main()
