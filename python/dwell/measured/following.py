"""Whether the positions of a servo and its targets are in one unit: degrees and radians."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dwell.measured.hints import FieldUnit, by_column
from dwell.measured.units import UNITS, Unit

Array = NDArray[np.float64]

#: The median distance of positions from their targets, rad, beyond which reading the bundle tells.
_LOST_RAD = math.pi
#: Deviation from the ratio of degrees and radians that is taken for it.
_TOLERANCE = 0.3
#: Correlation from which on positions follow their targets, if by another ratio.
_FOLLOWING = 0.5
_DEGREE = UNITS["angle"]["deg"]
_NAMES = {"deg": "degrees", "rad": "radians"}


def check(
    at: str, episodes: Sequence[tuple[Array, Array]], position: FieldUnit, target: FieldUnit
) -> None:
    """Looks at all episodes of a table.

    Args:
        at: What messages begin with.
        episodes: Positions and the targets that held then, rad, by the map's units.
        position: Where positions come from.
        target: Where targets come from.

    Raises:
        ValueError: Positions follow their targets, but vary as many times as much, or as little,
            as degrees do of radians.
    """
    positions, targets = (np.concatenate(own) for own in zip(*episodes, strict=True))
    if not len(positions) or np.median(np.abs(positions - targets)) > _LOST_RAD:
        return
    moved, told = positions - positions.mean(), targets - targets.mean()
    spread, wanted = float(np.sqrt(np.mean(moved**2))), float(np.sqrt(np.mean(told**2)))
    # Numbers that are too large are told by the bundle's checks.
    if not 0.0 < spread < math.inf or not 0.0 < wanted < math.inf:
        return
    ratio = spread / wanted
    if abs(float(np.mean(moved * told))) < _FOLLOWING * spread * wanted:
        return
    for degrees in (1.0 / _DEGREE, _DEGREE):
        if abs(ratio / degrees - 1.0) <= _TOLERANCE:
            raise ValueError(
                f"{at}: positions follow their targets, but vary {ratio:.3g} times as much; "
                "allowed is about as much. That is about the ratio of degrees and radians: "
                f"{_remedy(position, target, degrees)}"
            )


def _remedy(position: FieldUnit, target: FieldUnit, ratio: float) -> str:
    """The units to write, where positions are too large by a ratio."""
    hints = []
    for what, own, factor in (("positions", position, 1.0 / ratio), ("targets", target, ratio)):
        new = own.unit.read_as(Unit(factor))
        for name, word in _NAMES.items():
            if new.zero == 0.0 and math.isclose(new.factor, UNITS["angle"][name]):
                units = by_column([(own, Unit(factor))])
                hints.append(f"are {what} in {word}? Write {units} in the map's {own.part}")
    return "; or ".join(hints) or "check the units of both"
