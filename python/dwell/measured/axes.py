"""The user's axes and quaternions in those of the engine: right-handed, y up, x, y, z, w."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.measured.maps import choice

Array = NDArray[np.float64]

#: Which of the user's axes is the engine's x, y and z.
_NAMED = {"y_up": ["x", "y", "z"], "z_up": ["x", "z", "-y"]}
_ALLOWED = f"one of {list(_NAMED)}, or which of your axes is x, y (up) and z, as ['x', 'z', '-y']"


class Axes:
    """A rotation from the user's axes to the engine's."""

    def __init__(self, mapping: Mapping[str, Any], at: str, default: str = "y_up") -> None:
        """The key ``axes``, or ``up`` where a map has that."""
        up = choice(mapping, "up", ("y", "z"), at)
        told = mapping.get("axes")
        if told is None and up is None and "axes" in mapping:
            raise ValueError(f"{at}: axes is null: which axis is up? Allowed is {_ALLOWED}")
        if up is not None and told is not None:
            raise ValueError(f"{at}: both 'up' and 'axes' say which axis is up; leave one out")
        found = told if told is not None else f"{up}_up" if up is not None else default
        names = _NAMED.get(found) if isinstance(found, str) else found
        if names is None or len(names) != 3 or {str(n).lstrip("-+") for n in names} != {*"xyz"}:
            raise ValueError(f"{at}: axes is {found!r}; allowed is {_ALLOWED}")
        #: Shape (3, 3): engine from user.
        self.matrix = np.zeros((3, 3))
        #: The user's axis of each of the engine's.
        self.order = ["xyz".index(str(name).lstrip("-+")) for name in names]
        for row, (name, column) in enumerate(zip(names, self.order, strict=True)):
            self.matrix[row, column] = -1.0 if str(name).startswith("-") else 1.0
        if np.linalg.det(self.matrix) < 0.0:
            turned = [*names[:2], names[2][1:] if names[2][0] == "-" else f"-{names[2]}"]
            raise ValueError(
                f"{at}: axes is {names!r}, which is left-handed: the data would be mirrored; "
                f"{turned!r} would be right-handed. Of a left-handed tracker (Unity, Unreal) turn "
                "one coordinate and the rotations first"
            )
        self._rotation = _quaternion(self.matrix)

    def vectors(self, rows: Array) -> Array:
        """Vectors of the user's world in the engine's. Shape (n, 3)."""
        # Without the zeros of a product, which would make -0 of 0.
        signs = self.matrix.sum(axis=1)
        return np.where(rows[:, self.order] == 0.0, 0.0, rows[:, self.order] * signs)

    def rotations(self, rows: Array) -> Array:
        """World from body, x, y, z, w: the body's own axes stay. Shape (n, 4)."""
        if (self.matrix == np.eye(3)).all():
            return rows
        return product(np.broadcast_to(self._rotation, rows.shape), rows)


def _quaternion(matrix: Array) -> Array:
    """The quaternion of a rotation matrix; the part that is largest is found first."""
    m = matrix
    squares = np.array(
        [
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
            1.0 + m[0, 0] + m[1, 1] + m[2, 2],
        ]
    )
    k = 3 if squares[3] >= squares.max() - 1e-9 else int(squares.argmax())
    own = 2.0 * math.sqrt(squares[k] / 4.0)
    others = [
        [0.0, m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        [m[0, 1] + m[1, 0], 0.0, m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], 0.0, m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 0.0],
    ][k]
    found = np.array(others) / (2.0 * own)
    found[k] = own / 2.0
    return found


def product(a: Array, b: Array) -> Array:
    """Products of quaternions x, y, z, w: ``b`` acts first. Shape (n, 4)."""
    ax, ay, az, aw = a.T
    bx, by, bz, bw = b.T
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=1,
    )


def turned(q: Array, vectors: Array) -> Array:
    """Vectors of the body's axes in the world's. Shapes (n, 4), (n, 3)."""
    axis, w = q[:, :3], q[:, 3:]
    across = 2.0 * np.cross(axis, vectors)
    result: Array = vectors + w * across + np.cross(axis, across)
    return result
