"""The errand as a recording for the Rerun viewer, where the extra is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dwell.house import House


def write(house: House, errand: dict[str, Any], folder: Path) -> dict[str, str]:
    """Writes ``errand.rrd``; returns its file, or a sentence why there is none."""
    try:
        import rerun as rr
    except ImportError:
        return {"missing": "No recording: the Rerun SDK is not installed (pip install rerun-sdk)."}
    path = folder / "errand.rrd"
    rr.init("dwell demo")
    rr.save(str(path))
    rr.log("world", rr.ViewCoordinates.RIGHT_HAND_Y_UP, static=True)
    rr.log("world/way", rr.LineStrips3D([errand["way"]]), static=True)
    boxes = [
        thing for thing in errand["world"].objects() if thing["category"] not in ("", "person")
    ]
    rr.log(
        "world/objects",
        rr.Boxes3D(
            centers=[thing["center"] for thing in boxes],
            sizes=[thing["size"] for thing in boxes],
            labels=[thing["name"] for thing in boxes],
        ),
        static=True,
    )
    for pose, frame in zip(errand["poses"], errand["frames"], strict=True):
        rr.set_time("step", sequence=pose["step"])
        rr.log("world/agent", rr.Points3D([pose["position"]], radii=[0.2]))
        rr.log("eye", rr.Image(frame))
    rr.log("house", rr.TextDocument("\n".join(house.describe("house"))), static=True)
    rr.disconnect()
    return {"file": path.name}
