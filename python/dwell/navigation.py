"""Navigation: walkable places, routes, doors."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import dataclass_from_mapping, integer_in_range, point, quoted
from dwell.array_record import ArrayRecord

if TYPE_CHECKING:
    from dwell.house import House
    from dwell.world import World


@dataclasses.dataclass(frozen=True)
class Walker:
    """The body that walks, and the resolution of the grid.

    Attributes:
        cell_m: Edge of a cell, m; 0.02 to 1.
        radius_m: Radius, m; 0 to 2.
        height_m: Height, m; 0.1 to 3.
        step_m: The highest step it climbs, m; 0 to 1.
        max_slope_rad: The steepest slope it walks on, rad; 0 to 1.5.
        doors: ``as_they_stand`` (a shut door blocks), ``open`` (all fully open), or ``priced``
            (shut doors can be opened, which adds ``door_price_m`` to the way).
        door_price_m: What opening a door adds to a way, m.

    Raises:
        ConfigError: One is no number, or ``doors`` none of these.
    """

    cell_m: float = 0.1
    radius_m: float = 0.2
    height_m: float = 1.5
    step_m: float = 0.2
    max_slope_rad: float = 0.785
    doors: Literal["as_they_stand", "open", "priced"] = "as_they_stand"
    door_price_m: float = 2.0

    def __post_init__(self) -> None:
        """Refuses what are no numbers and no way of doors; ranges are the engine's."""
        walker_settings(self)


def walker_settings(walker: Walker | None) -> dict[str, Any]:
    """A walker, the default one for ``None``, as the native half reads it."""
    doors = {"doors": ("as_they_stand", "open", "priced")}
    return dataclass_from_mapping("walker", Walker() if walker is None else walker, Walker, doors)


@dataclasses.dataclass(frozen=True, eq=False)
class Route(ArrayRecord):
    """A way, pulled tight.

    Attributes:
        points: Its corners (n, 3), m.
        length_m: Its length over the ground, m.
        shut_doors: The doors to open on the way, by name (``priced`` only).
    """

    points: NDArray[np.float32]
    length_m: float
    shut_doors: list[str]


@dataclasses.dataclass(frozen=True, eq=False)
class Occupancy(ArrayRecord):
    """A storey from above.

    Attributes:
        free: Where someone can stand (depth, width), rows along z.
        corner: The x and z of the first cell's outer corner, m.
        cell_m: Edge of a cell, m.
    """

    free: NDArray[np.bool_]
    corner: tuple[float, float]
    cell_m: float


class Navigation:
    """The navigation grid of a house as it stands at one moment; all storeys at once.

    A pickle holds the house, the walker and where everything stands.
    """

    def __init__(self, house: House, walks: Mapping[str, Any], native: _native.Navigation) -> None:
        """Wraps a native grid; use ``House.navigation`` or ``World.navigation``."""
        self._house = house
        self._walks = walks
        self._native = native

    @classmethod
    def _rebuild(cls, house: House, walks: Mapping[str, Any], state: bytes | None) -> Navigation:
        """Restores a pickled navigation grid."""
        native = _native.Navigation(house.native, walks, state)
        return cls(house, walks, native)

    def __reduce__(self) -> tuple[Any, tuple[House, Mapping[str, Any], bytes | None]]:
        """House, walker and state."""
        return Navigation._rebuild, (self._house, self._walks, self._native.state())

    def __repr__(self) -> str:
        """The number of walkable places."""
        return f"Navigation(places={len(self.points())})"

    def points(self, start: Sequence[float] | None = None) -> NDArray[np.float32]:
        """Places to stand (n, 3), m; with ``start`` those to which a way leads from there."""
        return self._native.points(None if start is None else point("start", start))

    def sample(
        self, seed: int, count: int = 1, start: Sequence[float] | None = None
    ) -> NDArray[np.float32]:
        """Random places (count, 3), each equally likely; none if there are none."""
        where = None if start is None else point("start", start)
        return self._native.sample(
            integer_in_range("seed", seed), integer_in_range("count", count, high=10_000_000), where
        )

    def island(self, place: Sequence[float]) -> int | None:
        """The number of the island within 0.5 m of a point; 0 is the main one."""
        return self._native.islands([point("place", place)])[0]

    def route(self, start: Sequence[float], goal: Sequence[float]) -> Route | None:
        """The shortest way between two points, each at most 0.5 m from a place to stand."""
        found = self._native.route(point("start", start), point("goal", goal))
        return None if found is None else Route(*found)

    def distance(self, start: Sequence[float], goal: Sequence[float]) -> float | None:
        """Geodesic distance, m: the length of :meth:`route`."""
        route = self.route(start, goal)
        return None if route is None else route.length_m

    def occupancy(self, level: int = 0) -> Occupancy:
        """A storey from above; all storeys share one frame."""
        free, x, z, cell_m = self._native.occupancy(integer_in_range("level", level, high=2**31))
        return Occupancy(free.astype(np.bool_), (x, z), cell_m)

    def doors(self) -> list[dict[str, Any]]:
        """For each door in the way: name, openness, is_open, cells, islands beside it."""
        return self._native.doors()

    def update(self, world: World) -> int:
        """Follows what has moved in a world over the same house.

        Returns:
            How many columns of the grid were looked at again.

        Raises:
            ConfigError: It is a world over another house.
        """
        native = getattr(world, "native", None)
        if not isinstance(native, _native.World):
            raise ConfigError(f"world is {quoted(world)}; expected a dwell.World")
        # As a snapshot: by all that the house holds.
        if world.house.native is not self._house.native and hash(world.house) != hash(self._house):
            raise ConfigError(
                f"world is over another house, {world.house.name!r}; this navigation is of "
                f"{self._house.name!r}"
            )
        return native.follow(self._native)
