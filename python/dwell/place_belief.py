"""What is believed about where somebody is who walks: a probability for each cell of a floor.

A Bayesian filter over cells (Thrun, Burgard and Fox, Probabilistic Robotics (2005), chapter 4).
Who walks goes straight on for a while, stands, and goes on in another direction: the state is a
cell and a heading, or none while it stands. What is heard weighs the cells.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CELL_M, _REACH_M = 0.25, 20.0
#: Headings that are told apart, and how far who walks comes in a step, m.
_HEADINGS, _STEP_M = 12, 0.045
#: Chances to stand, and to go on, in a step.
_STANDS, _GOES = 0.02, 0.03
#: Share of belief that may be anywhere after what was heard, against being sure of what is wrong.
_ANYWHERE = 0.01
#: Chance that a cell where something always is in the way can be stood in all the same.
_SOLID = 0.3


class PlaceBelief:
    """Probabilities of cells around the start; axes ahead and left."""

    def __init__(self) -> None:
        """Anywhere, as probable as anywhere else."""
        axis = np.arange(-_REACH_M, _REACH_M + _CELL_M / 2, _CELL_M)
        self._side = len(axis)
        #: Middles of the cells, m; shape (n, 2).
        self.cells: Array = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
        #: Of who stands, and of who goes, by heading.
        self._standing = np.full((self._side, self._side), 0.4 / len(self.cells))
        goes = 0.6 / _HEADINGS / len(self.cells)
        self._going = np.full((_HEADINGS, self._side, self._side), goes)
        headings_rad = 2.0 * np.pi * np.arange(_HEADINGS) / _HEADINGS
        self._ways = np.stack([np.cos(headings_rad), np.sin(headings_rad)], axis=1)

    def square(self, place: Array, far_m: float) -> NDArray[np.int64]:
        """Rows of ``cells`` around a place, shape (n, n)."""
        middle = np.clip(np.rint((place + _REACH_M) / _CELL_M).astype(int), 0, self._side - 1)
        reach = round(far_m / _CELL_M)
        low = np.clip(middle - reach, 0, self._side - 2 * reach - 1)
        first, second = (np.arange(one, one + 2 * reach + 1) for one in low)
        rows: NDArray[np.int64] = first[:, None] * self._side + second[None, :]
        return rows

    def walked(self, steps: int, solid: NDArray[np.bool_] | None = None) -> None:
        """Time has passed.

        Args:
            steps: How many.
            solid: Where something is always in the way, of each cell, shape (n,).
        """
        stands, goes = _STANDS * steps, _GOES * steps
        far = _STEP_M * steps / _CELL_M * self._ways
        moved = np.stack(
            [_shifted(layer, way) for layer, way in zip(self._going, far, strict=True)]
        )
        if solid is not None:
            passes = np.where(solid.reshape(self._side, self._side), _SOLID, 1.0)
            moved *= passes
        starts = goes * self._standing / _HEADINGS
        self._standing = (1.0 - goes) * self._standing + stands * moved.sum(axis=0)
        self._going = (1.0 - stands) * moved + starts
        self._normalize()

    def heard(self, likelihood: Array) -> None:
        """Weighs the cells by log-likelihood ratios, shape (n,)."""
        weights = np.exp(likelihood.reshape(self._side, self._side))
        self._standing *= weights
        self._going *= weights
        self._normalize()
        share = _ANYWHERE / len(self.cells)
        self._standing = (1.0 - _ANYWHERE) * self._standing + 0.4 * share
        self._going = (1.0 - _ANYWHERE) * self._going + 0.6 * share / _HEADINGS

    def _normalize(self) -> None:
        total = self._standing.sum() + self._going.sum()
        self._standing /= total
        self._going /= total

    def best(
        self, reach_m: float = 1.5, beyond: tuple[Array, float] | None = None
    ) -> tuple[Array, float]:
        """The place near which it most probably is, m, and the probability that it is.

        Args:
            reach_m: How near.
            beyond: Leaves out what is within so many m of a place.
        """
        belief = self._standing + self._going.sum(axis=0)
        if beyond is not None:
            left_out = np.hypot(*(self.cells - beyond[0]).T) < beyond[1]
            belief = np.where(left_out.reshape(belief.shape), 0.0, belief)
        reach = round(0.8 * reach_m / _CELL_M)
        at = int(_summed(belief, reach).argmax())
        near = np.hypot(*(self.cells - self.cells[at]).T) < reach_m
        mass = belief.ravel()[near]
        middle: Array = (mass[:, None] * self.cells[near]).sum(axis=0) / mass.sum()
        return middle, float(mass.sum())


def _shifted(layer: Array, way: Array) -> Array:
    """Moved by less than a cell along both axes, by linear interpolation."""
    for axis, part in enumerate(way):
        share = abs(float(part))
        beside = np.zeros_like(layer)
        ahead, behind = [slice(None)] * 2, [slice(None)] * 2
        ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
        if part < 0.0:
            ahead, behind = behind, ahead
        beside[tuple(ahead)] = layer[tuple(behind)]
        layer = (1.0 - share) * layer + share * beside
    return layer


def _summed(grid: Array, reach: int) -> Array:
    """Sums over squares around each cell."""
    for axis in (0, 1):
        padded = np.pad(grid, [(reach + 1, reach) if k == axis else (0, 0) for k in (0, 1)])
        sums = padded.cumsum(axis=axis)
        size, wide = grid.shape[axis], 2 * reach + 1
        pieces = [np.take(sums, range(k, k + size), axis) for k in (0, wide)]
        grid = pieces[1] - pieces[0]
    return grid
