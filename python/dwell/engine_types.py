"""Types that the engine's tables say; written by docs/write_generated.py."""

from __future__ import annotations

from typing import Literal

Channel = Literal[
    "rgb",
    "depth",
    "instance",
    "semantic",
    "normals",
    "albedo",
    "surfels",
    "flow",
    "visible_objects",
    "boxes_2d",
    "boxes_3d",
]
