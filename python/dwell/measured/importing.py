"""Measurements of users into the bundle that calibration reads, by the word of a map."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from dwell import ConfigError, DwellError, MeasuredDataError, _native
from dwell.files import make_folder, rename_error
from dwell.measured.draft import BundleDraft
from dwell.measured.kinds import KINDS
from dwell.measured.maps import Job, read_map
from dwell.measured.readers import READERS

#: Suffixes of files, which no folder of a bundle has.
_FILE_SUFFIXES = {
    ".json", ".png", ".html", ".wav", ".sofa", ".zip",
    *(suffix for reader in READERS for suffix in reader.suffixes),
}  # fmt: skip


def import_files(
    files: list[Path], map_file: Path, out: Path, progress: Callable[[float, str], None]
) -> dict[str, Any]:
    """Writes the bundle ``out`` whole, or nothing.

    Raises:
        MeasuredDataError: A map or a file that cannot be used; the message names file, column and
            row. It is a ``ValueError``.
        ConfigError: ``out`` has the name of a table or a map, and bundles are folders.
        FileExistsError: ``out`` is there already.
        OSError: The system refuses to read a file or to write the bundle.
        ModuleNotFoundError: A package that reads a file is missing; the message names the extra.
    """
    refuse_file_name(out)
    with measured_faults():
        return _imported(files, map_file, out, progress)


def refuse_file_name(out: Path) -> None:
    """Refuses a bundle that would be called as a table or a picture.

    Raises:
        ConfigError: It would.
    """
    if out.suffix.lower() in _FILE_SUFFIXES:
        raise ConfigError(
            f"{out}: a bundle is a folder, and {out.suffix} ends the name of a file; allowed is "
            f"{str(out.with_suffix('.measured'))!r}"
        )


@contextlib.contextmanager
def measured_faults() -> Iterator[None]:
    """What cannot be used of files and maps is a ``MeasuredDataError``."""
    try:
        yield
    except DwellError:
        raise
    except ValueError as error:
        raise MeasuredDataError(str(error)) from error.__cause__


def _imported(
    files: list[Path], map_file: Path, out: Path, progress: Callable[[float, str], None]
) -> dict[str, Any]:
    if os.path.lexists(out):
        found = "is there already" if out.exists() else "is a link that leads to nothing"
        raise FileExistsError(f"{out}: {found}; remove it or choose another name")
    mapping = read_map(map_file, {name: kind.keys() for name, kind in KINDS.items()})
    given: dict[str, Path] = {}
    for path in files:
        other = given.setdefault(path.name, path)
        if other is not path:
            raise ValueError(f"{path}: has the name of {other}, and maps name files; rename one")
    make_folder(out.parent)
    part = Path(tempfile.mkdtemp(prefix=f".{out.name}.", dir=out.parent))
    draft = BundleDraft(part, str(map_file))
    try:
        job = Job(mapping, str(map_file), given, draft, progress)
        # Numbers that are too large are told by the bundle's checks, with their places.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            counts = KINDS[mapping["kind"]].write(job)
        progress(0.9, "checking the bundle")
        try:
            counts["episodes"] = _native.check_measured(str(part))
        except DwellError as error:
            told = draft.told(str(error), out)
            # What was left out may be why.
            left_out = f" ({'; '.join(job.notes)})" if job.notes else ""
            raise ValueError(told + left_out) from None
        part.chmod(0o755)
        os.rename(part, out)
    except OSError as error:
        # What people know is the name that they gave.
        named = "" if error.filename is None else os.fsdecode(error.filename)
        if error.errno is not None and (not named or named.startswith(str(part))):
            rename_error(error, out)
        raise
    finally:
        shutil.rmtree(part, ignore_errors=True)
    progress(1.0, "done")
    return counts
