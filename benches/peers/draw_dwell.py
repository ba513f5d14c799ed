"""Dwell's own renderer, as a Python program uses it: one call a view."""

from __future__ import annotations

from typing import Any

from draw import FAR_M, FOV_DEG, NEAR_M, Renderer, View

import dwell
from dwell.camera import Preset


def load(house: str, size: int, preset: Preset) -> Renderer:
    """The house as dwell opens it, seen in a preset."""
    world = dwell.World(house, agents=0)
    camera = dwell.Camera(size, size, FOV_DEG, NEAR_M, FAR_M, preset=preset)

    def draw(view: View) -> dict[str, Any]:
        yaw, pitch = view["angles_deg"]
        return world.render(
            position=view["position"],
            yaw_deg=yaw,
            pitch_deg=pitch,
            camera=camera,
            channels=("rgb", "depth"),
        )

    light = {"flat": "no light", "lit": "lamps and daylight with shadows"}[preset]
    return Renderer(
        draw,
        lambda seen: (seen["rgb"], seen["depth"][..., 0]),
        f"textures, {light}; every thing may move",
    )
