"""Discrete actions of movement as velocities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dwell import UsageError, _native


def velocities_of(numbers: NDArray[np.int64]) -> NDArray[np.float32]:
    """The velocities of discrete movement actions, shape (n, 4).

    Raises:
        UsageError: One is of the hand, which velocities cannot say.
    """
    moves = {
        "move_forward": (1, 0, 0, 0),
        "turn_left": (0, 0, 1, 0),
        "turn_right": (0, 0, -1, 0),
        "look_up": (0, 0, 0, 1),
        "look_down": (0, 0, 0, -1),
        "stop": (0, 0, 0, 0),
        "wait": (0, 0, 0, 0),
    }
    names = [*_native.actions(), "wait"]
    rows = []
    for number in numbers.tolist():
        if names[number] not in moves:
            raise UsageError(f"the expert wants to {names[number]}, which velocities cannot say")
        rows.append(moves[names[number]])
    return np.array(rows, np.float32).reshape(-1, 4)
