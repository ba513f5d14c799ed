"""The errand as a recording for the Rerun viewer, where the extra is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dwell import UsageError
from dwell.camera import Camera
from dwell.recording import Recording, record_house
from dwell.world import World


def write(errand: dict[str, Any], camera: Camera, folder: Path) -> dict[str, str]:
    """Writes ``errand.rrd``; returns its file, or a sentence why there is none."""
    path = folder / "errand.rrd"
    try:
        recording = Recording("dwell demo", path)
    except UsageError as error:
        return {"missing": f"No recording: {error}."}
    world: World = errand["world"]
    record_house(recording, world)
    recording.way("errand", errand["way"])
    for pose, frame in zip(errand["poses"], errand["frames"], strict=True):
        recording.step(pose["step"], pose, frame, camera)
    recording.close()
    return {"file": path.name}
