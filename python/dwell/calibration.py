"""Measured data against the simulation."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dwell import ConfigError, _native
from dwell.arguments import (
    file_path,
    finite_number,
    function_or_none,
    integer_in_range,
    openable_file,
    quoted,
    sequence_items,
    text,
)
from dwell.files import make_folder, read_json
from dwell.measured.coverage import Coverage, coverage
from dwell.measured.recorder import Recorder

__all__ = ["Coverage", "Recorder", "calibrate", "coverage", "write_example"]

#: The kind of bundles that are compared with other simulators.
_COMPARED = "pose_trajectory"


def calibrate(
    measured: str | os.PathLike[str],
    *,
    house: str | None = None,
    progress: Callable[[float, str], bool | None] | None = None,
    peers: Sequence[str | os.PathLike[str]] = (),
    budget_s: float | None = None,
) -> dict[str, Any]:
    """Compares a measured bundle with its simulation and names what is missing.

    Args:
        measured: The folder ``NAME.measured``.
        house: The house it was measured in, if the bundle does not say.
        progress: Called with a fraction (0 to 1) and a sentence; ``False`` ends the search with
            what it has.
        peers: Tables of another simulator's scores (``episode, position_widths, rotation_deg,
            e_q``), compared episode by episode; for pose trajectories.
        budget_s: Time after which the search ends with what it has, s; not for pose trajectories.

    Returns:
        The report: residuals, candidates, verdict, gain on held-out episodes; of pose trajectories
        (``kind``) the errors of roll-outs by model, horizon and regime, out of fold. ``html`` is a
        page. A search that was ended early says ``"finished": False`` and names nothing.

    Raises:
        ConfigError: ``peers`` are given and the bundle is of another kind.
        MeasuredDataError: The bundle or a table cannot be used; the message names file, line and
            field. Also where the bundle or a file of it is missing.
        OSError: The system refuses to read a table of ``peers``.
    """
    tables = sequence_items("peers", peers, "expected paths of tables")
    names = [openable_file(f"peers[{k}]", peer) for k, peer in enumerate(tables)]
    told_of = function_or_none("progress", progress)

    def tell(fraction: float, sentence: str) -> bool:
        answer = told_of(fraction, sentence) if told_of else None
        return not (isinstance(answer, bool | np.bool_) and not answer)

    named = None if house is None else text("house", house)
    bundle = file_path("measured", measured)
    if names:
        _refuse_peers(bundle, names)
    budget = None if budget_s is None else finite_number("budget_s", budget_s)
    told = _native.calibrate(bundle, named, tell if told_of else None, names, budget)
    report: dict[str, Any] = json.loads(told)
    return report


def _refuse_peers(bundle: str, peers: Sequence[str]) -> None:
    """Refuses tables of other simulators where nothing is compared with them.

    Raises:
        ConfigError: The bundle holds no pose trajectories.
    """
    try:
        manifest = read_json(Path(bundle, "manifest.json"))
    except (OSError, ValueError):
        # The reader of bundles says what is wrong with it.
        return
    kind = manifest.get("kind") if isinstance(manifest, dict) else None
    if isinstance(kind, str) and kind != _COMPARED:
        raise ConfigError(
            f"peers is {quoted([*peers])}; {bundle} is of the kind {kind!r}, of which nothing is "
            f"compared with other simulators: expected none, or a bundle of the kind {_COMPARED!r}"
        )


def write_example(folder: str | os.PathLike[str], seed: int = 0) -> str:
    """Writes a measured bundle whose world has an effect that the simulation lacks.

    Args:
        folder: Where to; made if it is not there.
        seed: Draws what is hidden.

    Returns:
        What is hidden, in a sentence: what :func:`calibrate` should find.

    Raises:
        OSError: The folder cannot be made, or something else stands there.
    """
    make_folder(Path(file_path("folder", folder)))
    return _native.calibration_example(file_path("folder", folder), integer_in_range("seed", seed))
