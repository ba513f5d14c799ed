"""The warning of a place outside of every room, given once: allowed, and mostly a mistake."""

from __future__ import annotations

import logging

from dwell.house import House

_LOG = logging.getLogger("dwell.outside")


def warn_outside_rooms(house: House, what: str, position: tuple[float, float, float]) -> None:
    """Logs a warning when a point lies in no room; in a house without rooms: beyond all walls.

    Once for a house and a kind of thing: cameras that fly around a house would fill the log. The
    point is a checked one: what a caller gave can perhaps be read only once.
    """
    told = house._told_outside
    if what in told:
        return
    x, y, z = position
    if house.native.is_outside((x, y, z)):
        told.add(what)
        _LOG.warning(
            "%s stands outside of every room of %r, at (%g, %g, %g) m; heights (y) count from the "
            "ground floor, and house.rooms() has a place to stand in each room. This is said once.",
            what,
            house.name,
            x,
            y,
            z,
        )
