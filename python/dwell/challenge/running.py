"""Verdicts of ``dwell calibrate`` on cases."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from dwell import ConfigError
from dwell.challenge.rows import check_verdict, read_verdicts
from dwell.challenge.writing import bundle_of

__all__ = ["calibrated_verdict", "run"]

Method = Callable[[Path], dict[str, Any]]


def calibrated_verdict(bundle: Path) -> dict[str, Any]:
    """What ``dwell calibrate`` says of a bundle.

    Returns:
        ``kind`` (``nothing``, ``named``, ``one_of``, ``unexplained``), ``sets`` (explanations, each
        a list of effects; one where it is named), ``parameters`` (by effect and name ``[value, low,
        high]``, of what is named).
    """
    from dwell.calibration import calibrate

    verdict = calibrate(bundle)["verdict"]
    effects = verdict.get("effects", [])
    sets = verdict.get("sets", [[effect["law"] for effect in effects]] if effects else [])
    return {
        "kind": verdict["kind"],
        "sets": sets,
        "parameters": {
            effect["law"]: {
                one["name"]: [one["value"], *one["interval"]] for one in effect["parameters"]
            }
            for effect in effects
        },
    }


def run(
    folder: Path,
    verdicts: Path,
    method: Method = calibrated_verdict,
    shard: tuple[int, int] = (0, 1),
) -> Iterator[tuple[str, bool]]:
    """Asks a method about every bundle in a folder, and appends its verdicts to a file.

    Those that the file has already are not asked again, so what was stopped goes on.

    Args:
        folder: Bundles, ``NAME.measured``.
        verdicts: JSON Lines.
        method: Takes a bundle's folder and returns ``kind``, ``sets`` and ``parameters``, as
            :func:`calibrated_verdict`.
        shard: Which of how many parts, from 0; each with a file of its own.

    Yields:
        The name of each case, and whether it was asked now.

    Raises:
        ConfigError: There are no bundles.
        MeasuredDataError: A bundle cannot be used.
        ValueError: A verdict, of the file or of the method, lacks a field or has a wrong one.
    """
    which, shards = shard
    names = sorted(path.name.removesuffix(".measured") for path in folder.glob("*.measured"))
    if not names:
        raise ConfigError(f"{folder}: no bundles NAME.measured")
    known = {row["case"] for row in read_verdicts(verdicts)} if verdicts.exists() else set()
    _drop_cut_line(verdicts)
    for name in names[which::shards]:
        is_new = name not in known
        if is_new:
            row = {"case": name, **method(bundle_of(folder, name))}
            check_verdict(row, f"the verdict on {name}")
            with open(verdicts, "a", encoding="utf-8") as file:
                file.write(json.dumps(row, allow_nan=False) + "\n")
                file.flush()
                os.fsync(file.fileno())
        yield name, is_new


def _drop_cut_line(path: Path) -> None:
    """Takes away a last line without an end, as a kill leaves it."""
    if path.exists():
        with open(path, "r+b") as file:
            text = file.read()
            file.truncate(text.rfind(b"\n") + 1)
