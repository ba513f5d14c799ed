"""The version of what jobs write: data sets, manifests and rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dwell.arguments import quoted

__all__ = ["VERSION", "refuse_other_version"]

#: The version of a data set's own file, and of the rows of a job's result; older files do not say
#: it.
VERSION = 1


def refuse_other_version(at: str, found: Mapping[str, Any]) -> None:
    """Refuses what a newer release wrote.

    Raises:
        ValueError: It says another version than this dwell reads.
    """
    version = found.get("version", VERSION)
    if version != VERSION or isinstance(version, bool):
        raise ValueError(f"{at}: version is {quoted(version)}; this dwell reads {VERSION}")
