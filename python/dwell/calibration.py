"""Measured data against the simulation."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any

from dwell import _native


def calibrate(
    measured: str | os.PathLike[str],
    *,
    house: str | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> dict[str, Any]:
    """Compares a measured bundle with its simulation and names what is missing.

    Args:
        measured: The folder ``NAME.measured``.
        house: The house it was measured in, if the bundle does not say.
        progress: Called with a fraction (0 to 1) and a sentence.

    Returns:
        The report: residuals, candidates, verdict, gain on held-out episodes; ``html`` is a page.

    Raises:
        MeasuredDataError: The bundle cannot be used; the message names file, line and field.
    """
    report: dict[str, Any] = json.loads(_native.calibrate(os.fspath(measured), house, progress))
    return report
