"""A hidden error in measured data, found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from dwell.calibration import calibrate, write_example

_SEED = 3


def example(folder: Path, progress: Callable[[float], None]) -> dict[str, Any]:
    """Writes a small measured bundle with something hidden in it, and calibrates it."""
    bundle = folder / "example.measured"
    hidden = write_example(bundle, _SEED)
    report = calibrate(bundle, progress=lambda part, _what: progress(part))
    page = report.pop("html", "")
    (folder / "calibration.html").write_text(page, "utf-8")
    return {
        "hidden": hidden,
        "sentence": report["sentence"],
        "plots": report.get("plots", []),
        "page": "calibration.html",
    }
