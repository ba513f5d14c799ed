"""A house as recordings are made in it: its acoustics, and where arrays and sources can be."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.acoustics import AcousticScene
from dwell.arguments import text
from dwell.house import House
from dwell.house_list import HouseList
from dwell.listening import Point
from dwell.localization.draws import Draws
from dwell.localization.settings import ACOUSTICS, Settings
from dwell.navigation import Navigation, Walker

#: Air that stays between an array and what stands around it, and how much a source takes, m.
_MARGIN_M, _SOURCE_RADIUS_M = 0.1, 0.25
#: Up to this height there is air over places for arrays and sources, m.
_CLEAR_M = 1.9


class OpenHouse:
    """A house, opened for recordings."""

    def __init__(self, house: House | str, settings: Settings) -> None:
        """Opens it.

        Args:
            house: A house, a HOUSE string, or ``shoebox:N``: see :func:`shoebox`.
            settings: How it is heard.

        Raises:
            ConfigError: No array or source fits anywhere.
            HouseError: It cannot be opened.
        """
        if isinstance(house, House):
            self.house, self.name = house, house.name
        else:
            number = shoebox_number(house)
            self.house = House.open(house) if number is None else shoebox(number)
            self.name = house
        traced = {**ACOUSTICS[settings.preset], "rate_hz": settings.rate_hz}
        #: All that is heard; the direct sound and early reflections; the direct sound alone.
        self.full = AcousticScene(self.house, **traced)
        self.early = AcousticScene(self.house, **{**traced, "rays": 0})
        self.direct = AcousticScene(self.house, **{**traced, "rays": 0, "image_order": 0})
        radius = max(one.radius_m for one in settings.layouts())
        self.listeners = self._free(radius + _MARGIN_M)
        self.sources = self._free(_SOURCE_RADIUS_M)
        for what, radius_m, grid in (
            ("an array", radius + _MARGIN_M, self.listeners),
            ("a source", _SOURCE_RADIUS_M, self.sources),
        ):
            if not len(grid.points()):
                raise ConfigError(
                    f"{self.name}: {what} needs a free radius of {radius_m:.2f} m up to "
                    f"{_CLEAR_M:g} m over the floor, and no place has it"
                )

    def _free(self, radius_m: float) -> Navigation:
        return self.house.navigation(Walker(radius_m=radius_m, height_m=_CLEAR_M))

    def check_free(self, what: str, place: Point) -> None:
        """Refuses a place that is in a wall, within a thing or outside of the house.

        Raises:
            ConfigError: It is; the message says which.
        """
        stands = self.sources.points().astype(np.float64)
        away = np.abs(stands[:, [0, 2]] - np.array([place[0], place[2]])).max(axis=1)
        over = place[1] - stands[:, 1]
        if not ((away <= 0.1) & (over > 0.0) & (over < _CLEAR_M)).any():
            raise ConfigError(
                f"{what} at ({place[0]:g}, {place[1]:g}, {place[2]:g}) m is in a wall, within a "
                f"thing, or outside of {self.name}; allowed are places with {_SOURCE_RADIUS_M:g} m "
                f"of air around them, up to {_CLEAR_M:g} m over the floor"
            )

    def household(self) -> list[tuple[str, Point]]:
        """The signals of the house's appliances, and where each sounds, m."""
        from dwell.world import World

        found = []
        for row in World(self.house, agents=0).sounds():
            if "signal" in row["sound"]:
                x, y, z = (float(part) for part in row["position"])
                found.append((str(row["sound"]["signal"]), (x, y, z)))
        return found

    def occlusion(self, source: Point, listener: Point) -> str:
        """What is between: ``none``, ``edge`` (sound bends around it), ``wall`` or ``all``.

        A wall is one that lets sound through; ``all``: no direct sound arrives.
        """
        paths: list[dict[str, Any]] = [
            row["path"]
            for row in self.direct.early_paths(source, listener)
            if not row["path"]["planes"]
        ]
        if any(not path["walls"] and not path["diffraction_points"] for path in paths):
            return "none"
        if any(not path["walls"] for path in paths):
            return "edge"
        return "wall" if paths else "all"


#: Edges of drawn rooms (x, height, z), m, their absorption and scattering.
_EDGES_M = ((3.0, 10.0), (2.4, 3.5), (3.0, 8.0))
_ABSORPTION, _SCATTERING = (0.08, 0.5), (0.05, 0.5)


def shoebox_number(name: str) -> int | None:
    """The number of a room ``shoebox:N``; ``None``: another house."""
    match = re.fullmatch(r"shoebox:([0-9]{1,18})", name)
    return int(match[1]) if match else None


def shoebox(number: int) -> House:
    """An empty rectangular room: its edges, absorption and scattering are drawn from a number."""
    draws = Draws("localize shoebox", number)
    width, height, depth = (draws.uniform(low, high) for low, high in _EDGES_M)
    absorption, scattering = draws.uniform(*_ABSORPTION), draws.uniform(*_SCATTERING)
    return House.shoebox((width, height, depth), absorption=absorption, scattering=scattering)


def house_list(houses: Sequence[str]) -> HouseList:
    """HOUSE strings out of HOUSES strings and ``shoebox:A..B`` (with A, without B).

    Raises:
        ConfigError: A range of rooms is empty or longer than a million.
        HouseError: As :class:`~dwell.house_list.HouseList`.
    """
    found = HouseList()
    for name in houses:
        match = re.fullmatch(r"shoebox:([0-9]{1,18})\.\.([0-9]{1,18})", text("houses", name))
        if match:
            first, end = int(match[1]), int(match[2])
            if not 0 < end - first <= 1_000_000:
                raise ConfigError(f"houses: {name} has {end - first} rooms; allowed are 1 to 10**6")
            for number in range(first, end):
                found.append_name(f"shoebox:{number}")
        elif shoebox_number(name) is not None:
            found.append_name(name)
        elif name.startswith("shoebox:"):
            raise ConfigError(
                f"houses: found {name!r:.80}; allowed are shoebox:N and shoebox:A..B with whole "
                "numbers of at most 18 digits"
            )
        else:
            found.append(name)
    return found


def near(
    places: NDArray[np.float64], middle: NDArray[np.float64], low_m: float, high_m: float
) -> NDArray[np.float64]:
    """The places whose distance from a middle is within bounds."""
    away = np.linalg.norm(places - middle, axis=1)
    found: NDArray[np.float64] = places[(away >= low_m) & (away <= high_m)]
    return found
