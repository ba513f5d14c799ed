"""Verdicts of ``dwell calibrate`` on cases."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from dwell import ConfigError
from dwell.arguments import quoted
from dwell.challenge.rows import check_verdict, read_verdicts
from dwell.challenge.writing import bundle_of
from dwell.files import append, make_folder, open_exclusive

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
    *,
    name: str | None = None,
) -> Iterator[tuple[str, bool]]:
    """Asks a method about every bundle in a folder, and appends its verdicts to a file.

    Those that the file has already are not asked again, so what was stopped goes on.

    Args:
        folder: Bundles, ``NAME.measured``.
        verdicts: JSON Lines; no other process has the file until all are judged.
        method: Takes a bundle's folder and returns ``kind``, ``sets`` and ``parameters``, as
            :func:`calibrated_verdict`.
        shard: Which of how many parts, from 0; each with a file of its own.
        name: ``method`` of each verdict; the function's own name by default.

    Yields:
        The name of each case, and whether it was asked now.

    Raises:
        ConfigError: There are no bundles.
        MeasuredDataError: A bundle cannot be used.
        ValueError: A verdict, of the file or of the method, lacks a field or has a wrong one, those
            of the file are another method's, or another process writes it.
        OSError: The system refuses; the error names the file.
    """
    which, shards = shard
    cases = sorted(path.name.removesuffix(".measured") for path in folder.glob("*.measured"))
    if not cases:
        raise ConfigError(f"{folder}: no bundles NAME.measured")
    called = name or str(getattr(method, "__name__", type(method).__name__))
    make_folder(verdicts.parent)
    with open_exclusive(verdicts) as file:
        try:
            known = _known(verdicts, called)
            # A last line without an end is what a kill leaves.
            file.truncate(file.read().rfind(b"\n") + 1)
            file.seek(0, os.SEEK_END)
            for one in cases[which::shards]:
                is_new = one not in known
                if is_new:
                    row = {"case": one, **method(bundle_of(folder, one)), "method": called}
                    check_verdict(row, f"the verdict on {one}")
                    append(file, (json.dumps(row, allow_nan=False) + "\n").encode(), verdicts)
                yield one, is_new
        finally:
            if file.seek(0, os.SEEK_END) == 0:
                os.unlink(verdicts)


def _known(verdicts: Path, name: str) -> set[str]:
    """The cases that a method has judged.

    Raises:
        ValueError: A row is of another method, or none.
    """
    known = set()
    for row in read_verdicts(verdicts):
        if row.get("method") != name:
            whose = quoted(row["method"]) if row.get("method") else "one that is not named"
            raise ValueError(
                f"{verdicts} keeps verdicts of another method: {whose}, not {quoted(name)}; give "
                "another --out, or the same method again"
            )
        known.add(row["case"])
    return known
