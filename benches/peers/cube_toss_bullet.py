"""Real cube tosses in Bullet, with the parameters that its authors' evaluation fitted.

Writes one row of scores a toss, and prints means and medians:

    pip install pybullet==3.2.7 pyarrow numpy
    python benches/peers/cube_toss_bullet.py FOLDER_OF_CUBE_TOSS --out bullet.csv

Bullet 3.2.7 with k = 1783.8 N/m, b = 27.22 N s/m and the friction of the plane, 0.358, times that
of the cube, 0.5 (Acosta, Yang, Posa, RA-L 2022, fitted by them on all 550 tosses); ten steps of
1/1480 s between samples.
"""

from __future__ import annotations

import argparse
import csv
import os
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pybullet as bullet

HALF_WIDTH_M = 0.0524
MASS_KG = 0.37
INERTIA_KG_M2 = 0.00081
STIFFNESS_N_M, DAMPING_N_S_M = 1783.8, 27.22
FRICTION_PLANE, FRICTION_CUBE = 0.358, 0.5
RATE_HZ, STEPS = 148.0, 10


def rotated(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A vector turned by a quaternion (x, y, z, w)."""
    t = 2.0 * np.cross(q[:3], v)
    return v + q[3] * t + np.cross(q[:3], t)


def scene() -> int:
    """The cube and a box-shaped ground with its upper face at z = 0; answers the cube.

    As the authors load it: from URDF, so that Bullet's default damping (0.04 a second) acts.
    """
    bullet.connect(bullet.DIRECT)
    bullet.setGravity(0, 0, -9.81)
    bullet.setTimeStep(1.0 / (RATE_HZ * STEPS))
    moments = (
        " ".join(f'i{a}{a}="{INERTIA_KG_M2}"' for a in "xyz")
        + ' ixy="0" ixz="0" iyz="0"'
    )
    edge = 2 * HALF_WIDTH_M
    urdf = (
        f'<robot name="cube"><link name="cube"><inertial><mass value="{MASS_KG}"/>'
        f"<inertia {moments}/></inertial><collision><geometry>"
        f'<box size="{edge} {edge} {edge}"/></geometry></collision></link></robot>'
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.urdf"
        path.write_text(urdf, "utf-8")
        cube = bullet.loadURDF(str(path))
    box = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[2.5, 2.5, 0.5])
    ground = bullet.createMultiBody(0, box, basePosition=[0, 0, -0.5])
    bullet.changeDynamics(cube, -1, lateralFriction=FRICTION_CUBE)
    bullet.changeDynamics(
        ground,
        -1,
        lateralFriction=FRICTION_PLANE,
        contactStiffness=STIFFNESS_N_M,
        contactDamping=DAMPING_N_S_M,
    )
    return cube


def score(
    cube: int, toss: dict[str, np.ndarray], start: dict[str, str]
) -> tuple[float, ...]:
    """Means over samples: position in cube widths, rotation in degrees, e_q."""
    first = int(start["eval_start_k"])
    place, turn = toss["p"][first:], toss["q"][first:]
    linear = [float(start[f"ic_v{axis}"]) for axis in "xyz"]
    body = np.array([float(start[f"ic_w{axis}"]) for axis in "xyz"])
    bullet.resetBasePositionAndOrientation(cube, place[0], turn[0])
    bullet.resetBaseVelocity(cube, linear, rotated(turn[0], body))
    far, angle = [0.0], [0.0]
    for p, q in zip(place[1:], turn[1:], strict=True):
        for _ in range(STEPS):
            bullet.stepSimulation()
        p_sim, q_sim = map(np.array, bullet.getBasePositionAndOrientation(cube))
        far.append(float(np.linalg.norm(p_sim - p)))
        aligned = min(1.0, abs(float(np.dot(q_sim, q)) / float(np.linalg.norm(q))))
        angle.append(2.0 * float(np.arccos(aligned)))
    d, a = np.array(far), np.array(angle)
    e_q = np.mean(d**2 / HALF_WIDTH_M + a**2)
    return d.mean() / (2 * HALF_WIDTH_M), np.degrees(a.mean()), float(e_q)


def main() -> None:
    """Scores every toss and prints the table's row."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="the cube_toss folder")
    parser.add_argument(
        "--out", type=Path, required=True, help="toss, position, rotation, e_q"
    )
    args = parser.parse_args()
    table = pq.read_table(args.folder / "data.parquet")
    column = {name: table[name].to_numpy() for name in table.column_names}
    cube = scene()
    rows = []
    with (args.folder / "index.csv").open() as file:
        for start in csv.DictReader(file):
            here = column["toss"] == int(start["toss"])
            toss = {
                "p": np.stack([column[f"p{c}"][here] for c in "xyz"], 1).astype(float),
                "q": np.stack([column[f"q{c}"][here] for c in "xyzw"], 1).astype(float),
            }
            rows.append((start["toss"], *score(cube, toss, start)))
    part = args.out.with_name(f".{args.out.name}.part")
    with part.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["episode", "position_widths", "rotation_deg", "e_q"])
        writer.writerows(rows)
    os.replace(part, args.out)
    found = np.array([row[1:] for row in rows])
    for name, values in zip(["position", "rotation", "e_q"], found.T, strict=True):
        print(f"{name}: mean {values.mean():.4f}, median {np.median(values):.4f}")
    print(f"e_q < 0.05: {np.mean(found[:, 2] < 0.05):.2f} of {len(rows)}")


if __name__ == "__main__":
    main()
