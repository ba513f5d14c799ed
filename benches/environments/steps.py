"""Steps a second of environments as users drive them: from Python, with what the sensors give.

    python benches/environments/steps.py              # every case: some three minutes
    python benches/environments/steps.py --case "free rgbd" --seconds 20

A row for each case: steps a second (the median over repeats; the slowest and fastest); ms of
processor that a step takes on all threads together, which other work on the machine changes less;
and, from a further repeat, ms of a step in each of the engine's calls, and Python's own share.
Agents walk at random (half of the actions move ahead, a quarter each turn left and right) from one
seed; episodes end after 500 steps, and the reset is within the time. Cases of one house differ in
sensors alone: what a sensor costs is the difference of their rows.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import statistics
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

#: The numbers of move_forward (twice), turn_left and turn_right.
WALK = (1, 1, 2, 3)
EPISODE_STEPS = 500
FLAT = {"width": 128, "height": 128, "preset": "flat"}
RGBD = {"rgb": FLAT, "depth": FLAT}
HOUSES = ("seed:1", "seed:2", "seed:3", "seed:4")
#: How far an agent that talks walks in a step, m: 1 m/s at 20 Hz.
STRIDE_M = 0.05


@dataclasses.dataclass(frozen=True)
class Case:
    """What is measured: a task, its house and sensors, and how many environments."""

    task: str
    house: str
    sensors: Any
    count: int | None = None
    source: bool = False
    #: Whether the house's own sounds are stopped.
    silent: bool = False


class TimedBatch:
    """A native batch whose calls are timed."""

    def __init__(self, batch: Any) -> None:  # noqa: ANN401 - the native batch has no base class
        """Wraps ``batch``."""
        self.batch = batch
        #: By call, s.
        self.spent: dict[str, float] = {}

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - what the batch has there
        """What the batch has of this name; calls are timed."""
        found = getattr(self.batch, name)
        if not callable(found):
            return found

        def call(*args: Any, **kwargs: Any) -> Any:  # noqa: ANN401 - as the batch does
            start = time.perf_counter()
            try:
                return found(*args, **kwargs)
            finally:
                self.spent[name] = self.spent.get(name, 0.0) + time.perf_counter() - start

        return call


def talking_agent(worlds: list[dwell.World], case: Case) -> Callable[[int], None]:
    """Lets another agent of each world talk; gives what moves it a stride along a way at each step.

    The way leads from one end of the floor to the other and back.
    """
    navigation = dwell.House.open(case.house).navigation()
    points = navigation.points()
    ends = points[np.argmin(points[:, 0])], points[np.argmax(points[:, 0])]
    route = navigation.route(*ends)
    way = np.asarray(route.points if route else [points[0]])
    lengths = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))]
    for world in worlds:
        for sound in world.sounds() if case.silent else []:
            world.stop_sound(sound["handle"])
        world.play("speech", at=1, loop=True)

    def move(step: int) -> None:
        whole = max(lengths[-1], STRIDE_M)
        along = abs((step * STRIDE_M + whole) % (2.0 * whole) - whole)
        place = [float(np.interp(along, lengths, way[:, axis])) for axis in range(3)]
        for world in worlds:
            world.place_agent(place, agent=1)

    return move


def steps_of(env: DwellEnv | DwellVectorEnv, case: Case) -> Iterator[None]:
    """Steps for ever."""
    random = np.random.default_rng(1)
    env.reset(seed=1)
    # Held from here on: calls of a batch that is being timed cannot give another.
    worlds = (
        [env.world] if isinstance(env, DwellEnv) else [env.world(k) for k in range(env.num_envs)]
    )
    move = talking_agent(worlds, case) if case.source else None
    step = 0
    while True:
        if move:
            move(step)
        if case.count is None:
            env.step(int(random.choice(WALK)))
        else:
            env.step(random.choice(WALK, case.count))
        step += 1
        if step % EPISODE_STEPS == 0:
            env.reset()
            move = talking_agent(worlds, case) if case.source else None
        yield


def measured(case: Case, seconds: float, repeats: int) -> dict[str, Any]:
    """The figures of a case."""
    settings: dict[str, Any] = {"houses": case.house, "sensors": case.sensors}
    if case.source:
        settings["world"] = {"agents": [{}, {}]}
    env: DwellEnv | DwellVectorEnv = (
        DwellEnv(case.task, **settings)
        if case.count is None
        else DwellVectorEnv(case.count, case.task, **settings)
    )
    going = steps_of(env, case)
    for _ in range(20):
        next(going)

    def repeat() -> tuple[float, int]:
        start, steps = time.perf_counter(), 0
        while time.perf_counter() - start < seconds / (repeats + 1):
            next(going)
            steps += 1
        return time.perf_counter() - start, steps

    rates, processor_s, environment_steps = [], time.process_time(), 0
    for _ in range(repeats):
        took, steps = repeat()
        rates.append(steps * (case.count or 1) / took)
        environment_steps += steps * (case.count or 1)
    processor_s = time.process_time() - processor_s
    runner = env._runner
    timed = runner.batch = TimedBatch(runner.batch)  # type: ignore[assignment] # it answers the same calls
    took, steps = repeat()
    runner.batch = timed.batch
    env.close()
    return {
        "steps_per_s": statistics.median(rates),
        "processor_ms": 1e3 * processor_s / environment_steps,
        "from_to": [min(rates), max(rates)],
        "python_share": 1.0 - sum(timed.spent.values()) / took,
        "ms": {name: 1e3 * spent / steps for name, spent in timed.spent.items()},
    }


def cases() -> dict[str, Case]:
    """Every case by its name."""
    found = {}
    for count in (None, 64):
        for label, sensors in (("body", ["gps"]), ("rgbd", RGBD)):
            for house in HOUSES:
                found[f"free {label} x{count or 1} {house}"] = Case("Free", house, sensors, count)
    for house in HOUSES:
        found[f"free steps heard {house}"] = Case("Free", house, ["audio"])
        found[f"free talker heard {house}"] = Case("Free", house, ["audio"], source=True)
        found[f"free talker alone {house}"] = Case(
            "Free", house, ["audio"], source=True, silent=True
        )
    apartment = ("InstructionFollowing", "builtin:apartment")
    pictures = ["rgb", "depth", "semantic", "instruction"]
    found["instructions body"] = Case(*apartment, ["instruction"])
    found["instructions pictures"] = Case(*apartment, pictures)
    found["instructions default"] = Case(*apartment, None)
    return found


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=6.0, help="for each case")
    parser.add_argument("--repeats", type=int, default=5, help="the median counts")
    parser.add_argument("--case", default="", help="cases whose name has this")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    args = parser.parse_args()
    for name, case in cases().items():
        if args.case not in name:
            continue
        row = measured(case, args.seconds, args.repeats)
        if args.json:
            print(json.dumps({"case": name, **row}), flush=True)
            continue
        calls = ", ".join(f"{call} {ms:.2f}" for call, ms in row["ms"].items() if ms >= 0.01)
        low, high = row["from_to"]
        print(
            f"{name:32} {row['steps_per_s']:7.0f}/s ({low:.0f} to {high:.0f})  "
            f"processor {row['processor_ms']:6.2f} ms  "
            f"Python {100 * row['python_share']:4.1f} %  ms: {calls}",
            flush=True,
        )


if __name__ == "__main__":
    main()
