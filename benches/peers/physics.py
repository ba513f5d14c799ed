"""Physics steps a second of MuJoCo, PyBullet and dwell on one scene of boxes, side by side.

    .venv/bin/python benches/peers/boxes.py house builtin:apartment --out boxes.json
    out/peers/env/bin/python benches/peers/physics.py boxes.json --dwell .venv/bin/dwell

``run.py``, which makes that environment, calls this too. A peer that is not installed is left out.
The peers have a plane at the floor where dwell has the house's own walls and floors (MuJoCo has no
concave meshes). Runs are interleaved, dwell's first, and the median counts; ratios are dwell's
steps per second over the peer's, from the same start. Dwell lets things sleep, as it does by
default, and is told of without sleep and all asleep too.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import shlex
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

GRAVITY_M_S2 = 9.80665

Scene = dict[str, Any]


def floor(scene: Scene) -> float:
    """The lowest side of all boxes, m."""
    boxes = scene["fixed"] + scene["dynamic"]
    return min(box["center"][1] - box["half_extents"][1] for box in boxes)


def mujoco_rate(scene: Scene, steps: int) -> float:
    """Steps a second of MuJoCo."""
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.gravity = [0, -GRAVITY_M_S2, 0]
    spec.option.timestep = 1.0 / scene["physics_rate_hz"]
    plane = spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[50, 50, 0.1]
    )
    # Its Z is up, ours Y.
    plane.quat = [np.sqrt(0.5), -np.sqrt(0.5), 0, 0]
    plane.pos = [0, floor(scene), 0]
    kind = mujoco.mjtGeom.mjGEOM_BOX
    for box in scene["fixed"]:
        spec.worldbody.add_geom(type=kind, size=box["half_extents"], pos=box["center"])
    for box in scene["dynamic"]:
        body = spec.worldbody.add_body(pos=box["center"])
        body.add_freejoint()
        body.add_geom(
            type=kind, size=box["half_extents"], density=scene["density_kg_m3"]
        )
    model = spec.compile()
    data = mujoco.MjData(model)
    start = time.perf_counter()
    for _ in range(steps):
        mujoco.mj_step(model, data)
    return steps / (time.perf_counter() - start)


def bullet_rate(scene: Scene, steps: int) -> float:
    """Steps a second of PyBullet."""
    import pybullet

    client = pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, -GRAVITY_M_S2, 0)
    pybullet.setTimeStep(1.0 / scene["physics_rate_hz"])
    ground = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 1, 0])
    pybullet.createMultiBody(0, ground, basePosition=[0, floor(scene), 0])
    for name in ("fixed", "dynamic"):
        for box in scene[name]:
            half = box["half_extents"]
            shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
            mass = (
                8.0
                * float(np.prod(half))
                * scene["density_kg_m3"]
                * (name == "dynamic")
            )
            pybullet.createMultiBody(mass, shape, basePosition=box["center"])
    start = time.perf_counter()
    for _ in range(steps):
        pybullet.stepSimulation()
    rate = steps / (time.perf_counter() - start)
    pybullet.disconnect(client)
    return rate


def dwell_figures(command: str, house: str, boxes: Path, steps: int) -> dict[str, Any]:
    """What ``dwell bench physics`` says."""
    options = [
        "--boxes",
        str(boxes),
        "--steps",
        str(steps),
        "--worlds",
        "1",
        "--repeats",
        "1",
    ]
    told = subprocess.run(
        [*shlex.split(command), "bench", "physics", house, *options, "--json"],
        check=True,
        capture_output=True,
        text=True,
    )
    figures: dict[str, Any] = json.loads(told.stdout)
    return figures


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("boxes", type=Path)
    parser.add_argument(
        "--house", default="builtin:apartment", help="whose walls dwell has"
    )
    parser.add_argument(
        "--dwell", default="dwell", help="the command, with its first words"
    )
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args()
    scene = json.loads(args.boxes.read_text("utf-8"))
    peers: dict[str, Callable[[Scene, int], float]] = {
        "mujoco": mujoco_rate,
        "pybullet": bullet_rate,
    }
    peers = {name: run for name, run in peers.items() if importlib.util.find_spec(name)}
    rates: dict[str, list[float]] = {}
    for _ in range(args.repeats):
        figures = dwell_figures(args.dwell, args.house, args.boxes, args.steps)
        for key in ("", "_sleeping_off", "_all_asleep"):
            value = figures[f"physics_steps_per_s{key}"]
            rates.setdefault(f"dwell{key}", []).append(value)
        for name, run in peers.items():
            rates.setdefault(name, []).append(run(scene, args.steps))
    medians = {name: statistics.median(values) for name, values in rates.items()}
    ratios = {
        f"{own}/{peer}": medians[own] / medians[peer]
        for own in medians
        if own.startswith("dwell")
        for peer in peers
    }
    kept = {key: figures[key] for key in ("bodies", "frozen_at_start", "fallen")}
    kept["rate_hz"] = scene["physics_rate_hz"]
    if args.json:
        json.dump({"steps_per_s": medians, "ratios": ratios, **kept}, sys.stdout)
        return
    for name, rate in medians.items():
        print(f"{name:>20}: {rate:,.0f} steps/s")
    for name, ratio in ratios.items():
        print(f"{name:>30}: {ratio:.2f}")
    print(", ".join(f"{key} {value}" for key, value in kept.items()))


if __name__ == "__main__":
    main()
