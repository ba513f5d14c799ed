"""The features of this machine and this build."""

from __future__ import annotations

import os
import tempfile
from typing import Any

from dwell import _native


def facts_of_machine() -> dict[str, Any]:
    """Versions, threads, instructions, graphics adapters, built-in houses.

    Drivers of the desktop complain on standard error where ``XDG_RUNTIME_DIR`` is not set, as on
    servers; nothing here needs it, so that for the probe an empty folder stands in.
    """
    if "XDG_RUNTIME_DIR" in os.environ:
        return _facts()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_RUNTIME_DIR"] = folder
        try:
            return _facts()
        finally:
            del os.environ["XDG_RUNTIME_DIR"]


def _facts() -> dict[str, Any]:
    facts = _native.doctor()
    return facts
