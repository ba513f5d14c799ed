"""Pictures of every room: colour, depth and ids side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dwell.camera import Camera
from dwell.engine_types import Channel
from dwell.false_color import picture
from dwell.house import House
from dwell.world import World

_CHANNELS: tuple[Channel, ...] = ("rgb", "depth", "instance")


def pictures(house: House, folder: Path) -> list[dict[str, Any]]:
    """Renders each room from its viewpoint; returns name, kinds, description and files of each."""
    world = World(house, agents=0)
    texts = house.describe("room")
    shown = []
    for k, (room, text) in enumerate(zip(house.rooms(), texts, strict=True)):
        images = world.render(
            position=room["eye"],
            yaw_deg=room["yaw_deg"],
            pitch_deg=-6.0,
            camera=Camera(480, 360),
            channels=_CHANNELS,
        )
        files = {}
        for channel, image in images.items():
            files[channel] = f"room_{k}_{channel}.png"
            picture(channel, image).save(folder / files[channel])
        kind = ", ".join(room["kinds"]) or "room"
        shown.append({"title": kind, "name": room["name"], "text": text, "files": files})
    return shown
