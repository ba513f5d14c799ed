"""Places in a house for sources and receivers of sound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import instance_of, integer_in_range, number_in_range
from dwell.house import House

# How far a node may be, in x and z, from the middle of a cell of the floor, m: half and more.
_NEAR_M = 0.075


def receiver_grid(house: House, spacing_m: float, height_m: float = 1.2) -> NDArray[np.float64]:
    """A regular grid over every floor: the nodes at which someone can stand.

    Args:
        house: The house, as it starts.
        spacing_m: Distance of neighbours, m, 0.1 to 10; nodes are at its multiples in x and z.
        height_m: Height over the floor, m, 0.1 to 2.

    Returns:
        Shape (node, 3), m, by floor, then z, then x.

    Raises:
        ConfigError: ``house`` is none, a number is out of range, or there is no such node.
    """
    house = instance_of("house", house, House)
    spacing = number_in_range("spacing_m", spacing_m, 0.1, 10.0)
    height = number_in_range("height_m", height_m, 0.1, 2.0)
    stands = house.navigation().points().astype(np.float64)
    nodes = np.round(stands[:, [0, 2]] / spacing) * spacing
    near = np.abs(nodes - stands[:, [0, 2]]).max(axis=1) <= _NEAR_M
    rows: dict[tuple[float, float, float], float] = {}
    for (x, z), (_, floor, _) in zip(nodes[near], stands[near], strict=True):
        # Cells around one node are of one floor, up to unevenness; the lowest counts.
        key = (round(floor, 0), float(z), float(x))
        rows[key] = min(rows.get(key, np.inf), float(floor))
    if not rows:
        raise ConfigError(f"{house.name}: nobody can stand at a node of a grid of {spacing:g} m")
    return np.array([[x, rows[storey, z, x] + height, z] for storey, z, x in sorted(rows)])


def random_sources(
    house: House, count: int, height_m: float = 1.5, seed: int = 0
) -> NDArray[np.float64]:
    """Random places at which someone can stand, each equally likely.

    Args:
        house: The house, as it starts.
        count: How many, 1 to 10 000.
        height_m: Height over the floor, m, 0.1 to 2.
        seed: The seed; the first places of a seed do not depend on ``count``.

    Returns:
        Shape (count, 3), m.

    Raises:
        ConfigError: ``house`` is none, a number is out of range, or nobody can stand anywhere.
    """
    house = instance_of("house", house, House)
    number = integer_in_range("count", count, low=1, high=10_000)
    height = number_in_range("height_m", height_m, 0.1, 2.0)
    places = house.navigation().sample(integer_in_range("seed", seed), number).astype(np.float64)
    if len(places) < number:
        raise ConfigError(f"{house.name}: nobody can stand anywhere")
    raised: NDArray[np.float64] = places + np.array((0.0, height, 0.0))
    return raised
