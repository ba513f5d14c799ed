"""PyBullet's own renderer on the processor (TinyRenderer)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import glb
import numpy as np
import pybullet
from draw import FAR_M, FOV_DEG, NEAR_M, Renderer, View, axis_depth


def load(folder: Path, size: int) -> Renderer:
    """An OBJ file for every material, drawn in one colour; nothing collides."""
    pybullet.connect(pybullet.DIRECT)
    for k, part in enumerate(glb.read(folder / "house.glb")):
        path = folder / f"part{k}.obj"
        rows = [f"v {x} {y} {z}\n" for x, y, z in part.positions]
        rows += [f"vn {x} {y} {z}\n" for x, y, z in part.normals]
        rows += [f"f {a}//{a} {b}//{b} {c}//{c}\n" for a, b, c in part.triangles + 1]
        path.write_text("".join(rows), "utf-8")
        shape = pybullet.createVisualShape(
            pybullet.GEOM_MESH,
            fileName=str(path),
            rgbaColor=[float(x) for x in part.mean_srgb()],
            flags=pybullet.VISUAL_SHAPE_DOUBLE_SIDED,
        )
        pybullet.createMultiBody(0, -1, shape)
    projection = pybullet.computeProjectionMatrixFOV(FOV_DEG, 1, NEAR_M, FAR_M)

    def draw(view: View) -> tuple[Any, ...]:
        ahead = [a + b for a, b in zip(view["position"], view["forward"], strict=True)]
        return pybullet.getCameraImage(
            size,
            size,
            pybullet.computeViewMatrix(view["position"], ahead, [0, 1, 0]),
            projection,
            shadow=0,
            flags=pybullet.ER_NO_SEGMENTATION_MASK,
            renderer=pybullet.ER_TINY_RENDERER,
        )

    def pictures(seen: tuple[Any, ...]) -> tuple[Any, Any]:
        rgb = np.reshape(seen[2], (size, size, 4)).astype(np.uint8)[..., :3]
        return rgb, axis_depth(np.reshape(seen[3], (size, size)).astype(np.float32))

    return Renderer(
        draw,
        pictures,
        "one colour a material, a lamp far away, no shadows; TinyRenderer, one core",
    )
