"""Data sets of Habitat, written by hand, and places of a house for them."""

from __future__ import annotations

import gzip
import json
import math
from pathlib import Path
from typing import Any

import dwell
from dwell.envs import DwellEnv
from dwell.habitat_conversion import HabitatConverter

HOUSE = "builtin:studio"
SCENE = "data/scene_datasets/made/studio.basis.glb"
HOUSES = {"studio": HOUSE}
#: The field of a start, and of a goal of a point.
Row = dict[str, Any]


def rotation(yaw_deg: float) -> list[float]:
    """A turn about +Y, as Habitat writes it: ``[x, y, z, w]``."""
    half = math.radians(yaw_deg) / 2.0
    return [0.0, math.sin(half), 0.0, math.cos(half)]


def written(path: Path, whole: object) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    with gzip.open(path, "wt", encoding="utf-8") as file:
        json.dump(whole, file)
    return path


def navigation() -> dwell.navigation.Navigation:
    """Where somebody of the usual size can stand in the house, whose doors are open."""
    body = DwellEnv("PointNav", houses=HOUSE, sensors=["gps"]).world.native.config()["agents"][0]
    walker = dwell.Walker(
        radius_m=body["radius_m"],
        height_m=body["height_m"],
        step_m=body["step_height_m"],
        doors="open",
    )
    return dwell.House.open_by(HOUSE, None).navigation(walker)


def point_nav(number: int, place: tuple[list[float], list[float], float]) -> Row:
    """An episode of PointNav-v1."""
    start, goal, way_m = place
    return {
        "episode_id": str(number),
        "scene_id": SCENE,
        "start_position": [*start],
        "start_rotation": rotation(40.0 * number - 130.0),
        "info": {"geodesic_distance": way_m, "difficulty": "easy"},
        "goals": [{"position": [*goal], "radius": None}],
        "shortest_paths": None,
        "start_room": None,
    }


def converted(
    path: Path,
    out: Path,
    **options: Any,  # noqa: ANN401 - of the converter
) -> HabitatConverter:
    converter = HabitatConverter(path, HOUSES, **options)
    dwell.episodes.write(out, converter.header, converter.episodes())
    return converter
