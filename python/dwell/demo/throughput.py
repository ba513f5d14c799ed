"""Throughput of every stage, from short runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from dwell import DwellError, _native

_RUNS: dict[str, dict[str, Any]] = {
    "load": {"repeats": 2},
    "render": {"repeats": 2},
    "physics": {"repeats": 2, "steps": 40},
    "acoustics": {"repeats": 1, "presets": ["rl"], "walks": 1},
    "env": {"envs": 2, "steps": 20},
}


def measure(house: str, progress: Callable[[float], None]) -> dict[str, Any]:
    """Runs each bench briefly; what fails says so in its place."""
    figures: dict[str, Any] = {}
    for k, (stage, options) in enumerate(_RUNS.items()):
        try:
            figures[stage] = _native.bench(stage, house, options)
        except DwellError as error:
            figures[stage] = {"failed": str(error)}
        progress((k + 1) / len(_RUNS))
    return figures
