"""A map that is filled in with what files look like, each guess with its reason.

Nothing of it counts until a person has confirmed it: :func:`read_map` refuses it before.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from dwell import ConfigError
from dwell.arguments import choice, file_path, sequence_items
from dwell.measured.guesses import Guess
from dwell.measured.guesses.drives import guess_drive
from dwell.measured.guesses.flights import guess_flight
from dwell.measured.guesses.poses import guess_poses
from dwell.measured.guesses.responses import guess_responses
from dwell.measured.guesses.servos import guess_servo
from dwell.measured.importing import measured_faults
from dwell.measured.kinds import KINDS
from dwell.measured.maps import Map
from dwell.measured.survey import Survey, surveyed

#: What fills in a map of each kind, and refuses tables without its columns.
_GUESSES: dict[str, Callable[[list[Survey], list[Path]], Guess]] = {
    "pose_trajectory": guess_poses,
    "drive": guess_drive,
    "servo": guess_servo,
    "trajectory": guess_flight,
}


def guessed_map(files: Sequence[str | os.PathLike[str]], kind: str | None = None) -> Map:
    """A map of files, to be read by a person and confirmed.

    Args:
        files: Tables, folders of LeRobot datasets, WAV and SOFA files.
        kind: What they measure; ``None``: what their columns look like.

    Raises:
        MeasuredDataError: A table cannot be read, or no kind of measurement has such columns. It
            is a ``ValueError``.
        ConfigError: ``files`` are no paths, or the kind is unknown.
        OSError: The system refuses to read a file.
        ModuleNotFoundError: A package that reads a file is missing; the message names the extra.
    """
    given = sequence_items("files", files, "expected paths of files")
    paths = [Path(file_path(f"files[{k}]", file)) for k, file in enumerate(given)]
    if not paths:
        raise ConfigError("files is empty; expected one or more paths of files")
    if kind is not None:
        choice("kind", kind, sorted(KINDS))
    with measured_faults():
        return _guessed(paths, kind)


def _guessed(files: list[Path], kind: str | None) -> Map:
    sounds = [path for path in files if path.suffix.lower() in (".wav", ".sofa")]
    tables = surveyed([path for path in files if path not in sounds])
    names_sounds = any(
        cells and all(cell.lower().endswith(".wav") for cell in cells)
        for table in tables
        for cells in table.texts.values()
    )
    if kind == "impulse_response" or (kind is None and (sounds or names_sounds)):
        return _printed(guess_responses(tables, sounds))
    reasons = []
    for name, guess in _GUESSES.items():
        if kind in (None, name):
            try:
                # Numbers that are too large are for the checks of the import.
                with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                    return _printed(guess(tables, sounds))
            except LookupError as error:
                reasons.append(f"{name}: {error.args[0]}")
    named = ", ".join(path.name for path in files)
    raise ValueError(
        f"{named}: nothing that is known is measured there ({'; '.join(reasons)}); write a map by "
        f"hand, from the template of one of {sorted(KINDS)} that --init KIND prints"
    )


def _printed(guess: Guess) -> Map:
    """A map with the reasons at its head."""
    head = {"kind": guess.mapping.pop("kind"), "confirmed": False, "why": guess.why}
    result: Map = json.loads(json.dumps({**head, **guess.mapping}))
    return result
