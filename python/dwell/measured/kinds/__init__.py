"""Kinds of measurement. A kind is a file here and a line in :data:`KINDS`."""

from __future__ import annotations

from dwell.measured.kinds import drives, flights, poses, responses, servos
from dwell.measured.kinds.form import Kind

__all__ = ["KINDS", "Kind"]

#: By the name that maps have.
KINDS: dict[str, Kind] = {
    kind.name: kind for kind in (poses.KIND, flights.KIND, drives.KIND, servos.KIND, responses.KIND)
}
