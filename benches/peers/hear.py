"""Noise against time of sound by dwell, pyroomacoustics and RLR-Audio-Propagation, in one run.

    .venv/bin/python benches/peers/hear.py [--rlr]

A room of 9.7 x 5.5 x 2.7 m with the absorption of a measured laboratory, one source, one receiver,
one thread each. Every program hears it several times with other random rays. Its noise is how far
the measures of ISO 3382-1 spread, and energies of 10 ms between 20 and 50, 50 and 200, 200 and
500 ms. See README.md beside this.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from run import environment, last_line

from dwell import measures

HERE = Path(__file__).resolve().parent
PEERS = {
    "pyroomacoustics": "pyroomacoustics==0.10.1",
    "rlr": "rlr-audio-propagation==0.0.1",
}
RAYS = {
    "dwell": (300, 1000, 3000, 10_000),
    "pyroomacoustics": (1000, 3000, 10_000, 30_000),
    "rlr": (300, 1000, 5000, 10_000),
}
WINDOWS_MS = ((20, 50), (50, 200), (200, 500))
STEP_MS = 10
#: Measures by octave from 250 Hz to 4 kHz: their names here and in a row of measures, and whether
#: their spread is told over their mean.
MEASURES = (
    ("T30", "t30_s", True),
    ("EDT", "edt_s", True),
    ("C80, dB", "c80_db", False),
    ("D50", "d50", False),
)
NOISES = [name for name, _, _ in MEASURES] + [f"{a} to {b} ms" for a, b in WINDOWS_MS]
SCENE: dict[str, Any] = {
    "name": "laboratory",
    "fs": 48_000,
    "duration_s": 1.0,
    "shoebox": [9.7, 5.5, 2.7],
    "walls": dict.fromkeys(("x0", "x1", "y0", "y1", "z0", "z1"), "wall"),
    "bands_hz": [125, 250, 500, 1000, 2000, 4000],
    "materials": {
        "wall": {
            "absorption": [0.25, 0.17, 0.165, 0.17, 0.18, 0.19],
            "scattering": [0.1, 0.12, 0.15, 0.2, 0.25, 0.3],
        }
    },
    "air": {"temperature_c": 20, "humidity_pct": 50, "pressure_pa": 101_325},
    "sources": [{"id": "S", "pos": [6.1, 3.9, 1.5]}],
    "receivers": [{"id": "R", "pos": [2.3, 2.1, 1.2]}],
}


def of_energies(responses: np.ndarray) -> list[float]:
    """Relative standard deviation of energies of 10 ms, the mean over each window."""
    step = SCENE["fs"] * STEP_MS // 1000
    count = responses.shape[1] // step
    energy = (responses[:, : count * step].astype(np.float64) ** 2).reshape(-1, count, step).sum(2)
    spread = energy.std(0, ddof=1) / np.maximum(energy.mean(0), 1e-30)
    return [float(spread[a // STEP_MS : b // STEP_MS].mean()) for a, b in WINDOWS_MS]


def of_measures(responses: np.ndarray) -> list[float]:
    """Standard deviation of each measure, the mean over octaves; dwell measures all programs."""
    heard = [measures.response_metrics(response, SCENE["fs"]) for response in responses]
    octaves = [k for k, row in enumerate(heard[0]) if 200 < float(row["centre_hz"] or 0) < 5000]
    spreads = []
    for _, key, relative in MEASURES:
        values = np.array([[rows[k][key] for k in octaves] for rows in heard], np.float64)
        spread = values.std(0, ddof=1)
        spreads.append(float(np.mean(spread / values.mean(0) if relative else spread)))
    return spreads


def heard(python: str, name: str, folder: Path, rays: int, times: int) -> dict[str, Any] | str:
    """Seconds a response and noise, or why there are none."""
    out = folder / f"{name}_{rays}.npz"
    words = [
        python,
        str(HERE / f"hear_{name}.py"),
        str(folder / "scene.json"),
        str(out),
    ]
    told = subprocess.run(
        [*words, "--rays", str(rays), "--times", str(times)],
        capture_output=True,
        text=True,
        check=False,
    )
    if told.returncode != 0:
        return last_line(told.stderr)
    with np.load(out) as file:
        return {
            "rays": rays,
            "s": float(np.median(file["s"])),
            "noise": of_measures(file["ir"]) + of_energies(file["ir"]),
        }


def seconds_at(curve: list[dict[str, Any]], which: int, wanted: float) -> float:
    """Seconds after which a program has a noise: along its curve, beyond its ends with the root."""
    seconds = np.log([one["s"] for one in curve])
    spread = np.log([one["noise"][which] for one in curve])
    if wanted > curve[0]["noise"][which]:
        return float(np.exp(seconds[0] + 2 * (spread[0] - np.log(wanted))))
    if wanted < curve[-1]["noise"][which]:
        return float(np.exp(seconds[-1] + 2 * (spread[-1] - np.log(wanted))))
    return float(np.exp(np.interp(-np.log(wanted), -spread, seconds)))


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--times", type=int, default=12, help="responses of each setting")
    parser.add_argument("--rlr", action="store_true", help="install it, too (CC BY-NC 4.0)")
    parser.add_argument("--out", type=Path, default=Path("out/peers"))
    args = parser.parse_args()
    folder = args.out.resolve() / "sound"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.json").write_text(json.dumps(SCENE), "utf-8")
    names = ["pyroomacoustics", *(["rlr"] if args.rlr else [])]
    wanted = {name: PEERS[name] for name in names}
    # RLR has no wheel.
    python, missing = environment(args.out.resolve(), wanted, compile_too=True)
    curves: dict[str, list[dict[str, Any]]] = {name: [] for name in ("dwell", *names)}
    for setting in range(len(RAYS["dwell"])):
        for name, curve in curves.items():
            if name in missing:
                continue
            own = sys.executable if name == "dwell" else str(python)
            one = heard(own, name, folder, RAYS[name][setting], args.times)
            if isinstance(one, str):
                missing[name] = f"it cannot hear: {one}"
            else:
                curve.append(one)
    print("| program | rays | s | " + " | ".join(NOISES) + " |")
    print("| --- " * (3 + len(NOISES)) + "|")
    for name, curve in curves.items():
        for one in curve:
            spreads = " | ".join(f"{x:.3f}" for x in one["noise"])
            print(f"| {name} | {one['rays']:,} | {one['s']:.3f} | {spreads} |")
    for name in names:
        if name in missing:
            continue
        print(f"\ndwell is so many times as fast as {name} at its noise, by {name}'s rays:")
        for which, noise in enumerate(NOISES):
            ratios = [
                one["s"] / seconds_at(curves["dwell"], which, one["noise"][which])
                for one in curves[name]
            ]
            print(f"  {noise}: " + ", ".join(f"{ratio:.2g}" for ratio in ratios))
    for name, why in missing.items():
        print(f"{name} is missing: {why}")
    (folder / "figures.json").write_text(json.dumps(curves), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
