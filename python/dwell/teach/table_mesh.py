"""The table: a top on four legs, as a mesh file that a house is edited with."""

from __future__ import annotations

import itertools
from pathlib import Path

from dwell.files import errors_named
from dwell.teach.layout import TABLE_M

#: Thickness of the top and edge of a leg, m.
_TOP_M = 0.04
_LEG_M = 0.06
#: The corners of each face of a box, seen from outside, as numbers of the corners below.
_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))

_Range = tuple[float, float]


def write_table(path: Path) -> None:
    """Writes the table as OBJ: its middle at x = z = 0, its feet at y = 0.

    Raises:
        OSError: The system refuses.
    """
    with errors_named(path):
        path.write_text(_obj(_boxes()), "utf-8")


def _boxes() -> list[tuple[_Range, _Range, _Range]]:
    """The ranges of x, y and z of the top and of the legs."""
    width, height, depth = TABLE_M
    under = height - _TOP_M
    boxes = [((-width / 2, width / 2), (under, height), (-depth / 2, depth / 2))]
    x, z = width / 2 - _LEG_M, depth / 2 - _LEG_M
    for right, near in itertools.product((-1.0, 1.0), repeat=2):
        legs = tuple(
            (min(sign * inner, sign * (inner + _LEG_M)), max(sign * inner, sign * (inner + _LEG_M)))
            for sign, inner in ((right, x), (near, z))
        )
        # They end a hair below the top, so that each is a piece of its own.
        boxes.append((legs[0], (0.0, under - 0.001), legs[1]))
    return boxes


def _obj(boxes: list[tuple[_Range, _Range, _Range]]) -> str:
    lines = []
    for number, box in enumerate(boxes):
        lines += [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in itertools.product(*box)]
        first = 8 * number + 1
        lines += ["f " + " ".join(str(first + corner) for corner in face) for face in _FACES]
    return "\n".join(lines) + "\n"
