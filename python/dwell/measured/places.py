"""Where a number of the user comes from."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Place(NamedTuple):
    """A row of a file, counted from 1."""

    path: Path
    row: int

    def __str__(self) -> str:
        """As messages begin."""
        return f"{self.path} row {self.row}"
