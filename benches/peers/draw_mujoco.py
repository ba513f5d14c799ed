"""MuJoCo's renderer without a window (EGL), and without antialiasing, as the others draw."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

os.environ.setdefault("MUJOCO_GL", "egl")

import glb
import mujoco
import numpy as np
from draw import FAR_M, FOV_DEG, NEAR_M, Renderer, View


def load(folder: Path, size: int) -> Renderer:
    """A mesh of one colour for every material; nothing collides."""
    spec = mujoco.MjSpec()
    spec.visual.quality.offsamples = 0
    spec.visual.global_.offwidth = spec.visual.global_.offheight = size
    # Both are parts of the extent.
    spec.stat.extent = 1.0
    spec.visual.map.znear, spec.visual.map.zfar = NEAR_M, FAR_M
    for k, part in enumerate(glb.read(folder / "house.glb")):
        if len(part.positions) < 4:
            continue
        spec.add_mesh(
            name=f"part{k}",
            uservert=part.positions.astype(float).ravel(),
            usernormal=part.normals.astype(float).ravel(),
            userface=part.triangles.astype(np.int32).ravel(),
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=f"part{k}",
            rgba=part.mean_srgb(),
            contype=0,
            conaffinity=0,
        )
    spec.worldbody.add_camera(name="eye", fovy=FOV_DEG)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = mujoco.Renderer(model, size, size)
    renderer.scene.flags[mujoco.mjtRndFlag.mjRND_CULL_FACE] = 0
    renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
    renderer.scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0

    def draw(view: View) -> tuple[Any, Any]:
        back = -np.array(view["forward"])
        right = np.cross([0, 1, 0], back)
        right /= np.linalg.norm(right)
        data.cam_xpos[0] = view["position"]
        data.cam_xmat[0] = np.stack([right, np.cross(back, right), back], 1).ravel()
        renderer.update_scene(data, 0)
        renderer.disable_depth_rendering()
        rgb = renderer.render()
        renderer.enable_depth_rendering()
        return rgb, renderer.render()

    return Renderer(
        draw,
        lambda seen: seen,
        "one colour a material, a lamp at the eye, no shadows; EGL",
    )
