"""Where places seem to be that are heard around corners.

Sound from behind a wall comes through a door: it has gone as far as the way is long, and comes from
where that way is seen to begin, the edge of the frame (Kuttruff, Room Acoustics (2016), chapter 2:
geometrical and diffracted paths). A listener that knows what is in the way can tell from that where
it was made.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Neighbours of a cell, in cells.
_NEXT = [(k, j) for k in (-1, 0, 1) for j in (-1, 0, 1) if (k, j) != (0, 0)]


def apparent_places(
    place: Array, cells: Array, ranges_m: tuple[Array, Array], solid: NDArray[np.bool_]
) -> tuple[Array, NDArray[np.bool_]]:
    """Where sounds of a square of cells seem to come from.

    Args:
        place: Where the listener is, m.
        cells: Middles of the cells, shape (rows, columns, 2) m, on a grid.
        ranges_m: Azimuths in that frame, rising, rad, and how far it is seen in each, m.
        solid: Whether something is in the way, shape (rows, columns).

    Returns:
        Apparent places, as ``cells``; those of cells to which no way is known are where they are.
        And whether a cell is seen.
    """
    ways = cells - place
    straight = np.hypot(ways[..., 0], ways[..., 1])
    azimuths = np.arctan2(ways[..., 1], ways[..., 0])
    rays, far = ranges_m
    # Between two rays no more is seen than by the shorter one.
    far = np.minimum(far, np.minimum(np.roll(far, 1), np.roll(far, -1)))
    seen = straight < np.interp(azimuths, rays, far, period=2.0 * np.pi)
    length = np.where(seen & ~solid, straight, np.inf)
    # Of what is seen the way begins there; of the rest where it comes out of what is not seen.
    begins = azimuths.copy()
    cell_m = float(np.hypot(*(cells[1, 1] - cells[0, 0]))) / np.sqrt(2.0)
    for _ in range(2 * len(cells)):
        changed = False
        for step in _NEXT:
            beside = _moved(length, step, np.inf) + cell_m * float(np.hypot(*step))
            shorter = (beside < length - 1e-9) & ~seen & ~solid
            if shorter.any():
                changed = True
                length = np.where(shorter, beside, length)
                begins = np.where(shorter, _moved(begins, step, 0.0), begins)
        if not changed:
            break
    known = np.isfinite(length) & ~seen
    directions = np.stack([np.cos(begins), np.sin(begins)], axis=-1)
    reach = np.where(known, length, 0.0)[..., None]
    return np.where(known[..., None], place + reach * directions, cells), seen


def _moved(grid: Array, step: tuple[int, int], outside: float) -> Array:
    """The grid moved by a cell."""
    (down, right), (rows, columns) = step, grid.shape
    moved = np.full_like(grid, outside)
    moved[max(down, 0) : rows + min(down, 0), max(right, 0) : columns + min(right, 0)] = grid[
        max(-down, 0) : rows + min(-down, 0), max(-right, 0) : columns + min(-right, 0)
    ]
    return moved
