"""What pictures are taken with."""

from __future__ import annotations

import dataclasses
from typing import Literal

Channel = Literal["rgb", "depth", "instance", "semantic"]


@dataclasses.dataclass(frozen=True)
class Camera:
    """A pinhole camera.

    Attributes:
        width: Pixels across, 1 to 8192.
        height: Pixels down.
        fov_deg: Horizontal field of view, degrees; ``None``: at an agent's eyes what
            ``agent/N/camera/fov_deg`` says, elsewhere 90.
        near_m: Nearest distance that is seen, m.
        far_m: Furthest distance, to which depth is clamped, m.
        preset: ``lit`` (lamps and daylight) or ``flat`` (texture times colour).
    """

    width: int = 128
    height: int = 128
    fov_deg: float | None = None
    near_m: float = 0.05
    far_m: float = 50.0
    preset: Literal["flat", "lit"] = "lit"
