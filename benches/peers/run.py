"""Dwell beside Panda3D, MuJoCo and PyBullet, on one of dwell's own houses, in one run.

    .venv/bin/python benches/peers/run.py

Needs an interpreter that holds dwell. Makes an environment of its own for the peers in out/peers,
exports the house by dwell's writer, then lets all draw the same views and drop the same boxes, in
turns, and prints medians and ratios as a Markdown table. A peer that cannot be installed or
cannot start is named with the reason, and the others go on. See README.md beside this.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import shlex
import shutil
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
#: Peers as pip knows them, with the versions that were tried.
PEERS = {
    "panda3d": "panda3d==1.10.16",
    "mujoco": "mujoco==4.0.0",
    "pybullet": "pybullet==3.2.7",
}
TITLES = {"panda3d": "Panda3D", "mujoco": "MuJoCo", "pybullet": "PyBullet"}
#: Depth within this part counts as the same, and so much of a picture must be the same. Glass
#: makes the difference: some write its depth, others that of what is behind.
SAME_DEPTH, SAME_PICTURE = 0.02, 0.75


class Absent(Exception):
    """A peer that is not to be had, with the reason."""


def environment(
    folder: Path, peers: dict[str, str], compile_too: bool
) -> tuple[Path, dict[str, str]]:
    """The interpreter of peers by what pip calls them, and why some of them are missing."""
    python = folder / "env" / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(folder / "env")], check=True)
    pip = [
        str(python),
        "-m",
        "pip",
        "--disable-pip-version-check",
        "install",
        "--quiet",
    ]
    subprocess.run([*pip, "numpy", "pillow"], check=True)
    missing = {}
    for name, wanted in peers.items():
        wheels = [] if compile_too else ["--only-binary", ":all:"]
        told = subprocess.run([*pip, *wheels, wanted], capture_output=True, text=True, check=False)
        if told.returncode != 0:
            missing[name] = f"pip cannot install {wanted}: {last_line(told.stderr)}"
    return python, missing


class Drawer:
    """A renderer in a process of its own, with the house loaded."""

    def __init__(self, python: str, name: str, folder: Path, house: str, size: int) -> None:
        """Starts it; it answers once its pictures are kept."""
        words = [python, str(HERE / "draw.py"), name, str(folder)]
        self.errors = folder / f"{name}.log"
        self.child = subprocess.Popen(
            [*words, "--house", house, "--size", str(size)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors.open("w"),
            text=True,
        )
        self.told = self._answer()["told"]

    def _answer(self) -> dict[str, Any]:
        assert self.child.stdout is not None
        # Some libraries greet on standard output themselves.
        for line in self.child.stdout:
            if line.startswith("{"):
                answer: dict[str, Any] = json.loads(line)
                return answer
        self.child.wait()
        raise Absent(last_line(self.errors.read_text("utf-8")))

    def views_per_s(self) -> float:
        """Draws all views once."""
        assert self.child.stdin is not None
        self.child.stdin.write("again\n")
        self.child.stdin.flush()
        return float(self._answer()["views_per_s"])

    def close(self) -> None:
        """Ends it."""
        assert self.child.stdin is not None
        self.child.stdin.close()
        self.child.wait()


def drawn(
    peer_python: Path, missing: dict[str, str], folder: Path, args: argparse.Namespace
) -> dict[str, dict[str, Any]]:
    """Views a second of all renderers, their medians over rounds in turns."""
    drawers: dict[str, Drawer] = {}
    for name in ("dwell", "dwell_lit", *PEERS):
        if name in missing:
            continue
        python = sys.executable if name.startswith("dwell") else str(peer_python)
        try:
            drawers[name] = Drawer(python, name, folder, args.house, args.size)
        except Absent as why:
            missing[name] = f"it cannot draw: {why}"
    rates: dict[str, list[float]] = {name: [] for name in drawers}
    for _ in range(args.rounds):
        for name, drawer in drawers.items():
            rates[name].append(drawer.views_per_s())
    for drawer in drawers.values():
        drawer.close()
    return {
        name: {
            "rate": statistics.median(rates[name]),
            "told": drawer.told,
            "same": same_pictures(folder, name),
        }
        for name, drawer in drawers.items()
    }


def same_pictures(folder: Path, name: str) -> float:
    """The part of the kept pictures whose depth is that of dwell's, 0 to 1."""
    with np.load(folder / "dwell.npz") as own, np.load(folder / f"{name}.npz") as other:
        off = np.abs(other["depth"] / own["depth"] - 1.0)
    return float(np.mean(off < SAME_DEPTH))


def dropped(peer_python: Path, folder: Path, args: argparse.Namespace) -> dict[str, Any]:
    """Physics steps a second of all engines, by physics.py."""
    words = [
        str(peer_python),
        str(HERE / "physics.py"),
        str(folder / "boxes.json"),
        "--json",
    ]
    dwell = shlex.join([sys.executable, "-m", "dwell"])
    options = ["--dwell", dwell, "--house", args.house, "--repeats", str(args.rounds)]
    told = subprocess.run([*words, *options], check=False, capture_output=True, text=True)
    if told.returncode != 0:
        raise SystemExit(told.stderr)
    figures: dict[str, Any] = json.loads(told.stdout.splitlines()[-1])
    return figures


def table(views: dict[str, dict[str, Any]], steps: dict[str, Any], args: argparse.Namespace) -> str:
    """The Markdown table."""
    flat, lit = views["dwell"]["rate"], views["dwell_lit"]["rate"]
    rows = [
        f"| `{args.house}`, {args.size} by {args.size} pixels, colour and depth | views a second "
        "| `flat` is so many times as fast | `lit` is | same depth |",
        "| --- | --- | --- | --- | --- |",
    ]
    for name, figures in views.items():
        title = {"dwell": "dwell, `flat`", "dwell_lit": "dwell, `lit`"}.get(name) or _title(name)
        rows.append(
            f"| {title}: {figures['told']} | {figures['rate']:,.0f} "
            f"| {flat / figures['rate']:.2g} | {lit / figures['rate']:.2g} "
            f"| {100 * figures['same']:.0f} % |"
        )
    rates = steps["steps_per_s"]
    rows += [
        "",
        f"| {steps['bodies']} boxes fall and come to rest, {steps['rate_hz']:.0f} Hz "
        "| steps a second | dwell is so many times as fast |",
        "| --- | --- | --- |",
    ]
    titles = {
        "dwell": "dwell, walls and floors of the house; what rests sleeps",
        "dwell_sleeping_off": "dwell, nothing sleeps",
        "mujoco": f"{_title('mujoco')}, on a plane",
        "pybullet": f"{_title('pybullet')}, on a plane",
    }
    for name, title in titles.items():
        if name in rates:
            rows.append(f"| {title} | {rates[name]:,.0f} | {rates['dwell'] / rates[name]:.2g} |")
    return "\n".join(rows)


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("house", metavar="HOUSE", nargs="?", default="builtin:apartment")
    parser.add_argument("--size", type=int, default=128, help="pixels across and down")
    parser.add_argument("--views", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=5, help="the median counts")
    parser.add_argument("--out", type=Path, default=Path("out/peers"))
    parser.add_argument("--compile", action="store_true", help="peers without a wheel by source")
    args = parser.parse_args()
    folder = args.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    peer_python, missing = environment(folder, PEERS, args.compile)
    scene = folder / "scene"
    exporting = [sys.executable, str(HERE / "export.py"), args.house, str(scene)]
    subprocess.run([*exporting, "--views", str(args.views)], check=True)
    views = drawn(peer_python, missing, scene, args)
    steps = dropped(peer_python, scene, args)
    house = json.loads((scene / "house.json").read_text("utf-8"))
    text = table(views, steps, args)
    print(text)
    print(
        f"\n{house['triangles']:,} triangles, {args.views} views, medians of {args.rounds} rounds "
        f"in turns; dwell {house['dwell']}, Python {platform.python_version()}, "
        f"{len(os.sched_getaffinity(0))} cores of {_processor()}, load at the end "
        f"{os.getloadavg()[0]:.1f}, {datetime.date.today().isoformat()}."
    )
    for name, why in missing.items():
        print(f"{TITLES[name]} is missing: {why}")
    (folder / "table.md").write_text(text + "\n", "utf-8")
    (folder / "figures.json").write_text(json.dumps({"views": views, "physics": steps}), "utf-8")
    others = [name for name, figures in views.items() if figures["same"] < SAME_PICTURE]
    if others:
        print(f"These did not draw the same views, so their figures mean nothing: {others}")
    return int(bool(others))


def _title(name: str) -> str:
    return f"{TITLES[name]} {PEERS[name].partition('==')[2]}"


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text("utf-8").splitlines():
        if line.startswith("model name"):
            return " ".join(line.partition(":")[2].split())
    return platform.machine()


def last_line(text: str) -> str:
    """The last line that is not empty, where programs say why they failed."""
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1].strip() if lines else "it says nothing"


if __name__ == "__main__":
    if shutil.which("nvidia-smi"):
        print("There is an NVIDIA driver here: the OpenGL peers may draw on it, dwell on the cpu.")
    sys.exit(main())
