"""Arrays of microphones: named ones, and those of a file."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import point, quoted, sequence_items
from dwell.files import read_json
from dwell.listening import Point, Receiver

#: The farthest microphone from the centre of an array that stands in a room, m.
MAX_RADIUS_M = 1.0
_MAX_MICROPHONES = 128

#: Azimuth and inclination from straight up of the 32 microphones of the Eigenmike em32, degrees
#: (mh acoustics, *Eigenmike em32 release notes*).
_EM32_DEG = (
    (0, 69), (32, 90), (0, 111), (328, 90), (0, 32), (45, 55), (69, 90), (45, 125),
    (0, 148), (315, 125), (291, 90), (315, 55), (91, 21), (90, 58), (90, 121), (89, 159),
    (180, 69), (212, 90), (180, 111), (148, 90), (180, 32), (225, 55), (249, 90), (225, 125),
    (180, 148), (135, 125), (111, 90), (135, 55), (269, 21), (270, 58), (270, 122), (271, 159),
)  # fmt: skip
_EM32_RADIUS_M = 0.042
#: The four of them that the DCASE challenge takes for its format MIC: azimuth, elevation, degrees.
_TETRAHEDRAL_DEG = ((45, 35), (-45, -35), (135, -35), (-135, 35))


@dataclass(frozen=True)
class Layout:
    """What records: an array in its own axes (forward -Z, left -X, up +Y), a head or ambisonics.

    Attributes:
        name: Its name, that of its folder.
        kind: ``array``, ``ambisonics`` or ``binaural``.
        microphones: Of an array: places, m.
        order: Of ambisonics: 1 to 3.
    """

    name: str
    kind: str
    microphones: tuple[Point, ...] = ()
    order: int = 0

    @property
    def channels(self) -> int:
        """Number of channels."""
        if self.kind == "ambisonics":
            return (self.order + 1) ** 2
        return 2 if self.kind == "binaural" else len(self.microphones)

    @property
    def radius_m(self) -> float:
        """The farthest microphone from the centre, m; of a head a little more than it is large."""
        if self.kind == "binaural":
            return 0.1
        return max((math.dist(place, (0.0, 0.0, 0.0)) for place in self.microphones), default=0.0)

    @property
    def folder(self) -> str:
        """Its folder's name, for the two formats of DCASE that which their programs look for."""
        return f"{'mic' if self.name == 'tetrahedral' else self.name}_dev"

    def receiver(self, position: Point, yaw_deg: float) -> Receiver:
        """The receiver at a place, turned to the left by an angle."""
        if self.kind == "ambisonics":
            return Receiver.ambisonics(position, order=self.order, yaw_deg=yaw_deg)
        if self.kind == "binaural":
            return Receiver.binaural(position, yaw_deg=yaw_deg)
        return Receiver.array(position, self.microphones, yaw_deg=yaw_deg)

    def offsets(self) -> NDArray[np.float64]:
        """For each channel where its delays are reckoned from, in the array's axes, m."""
        if self.kind == "array":
            return np.array(self.microphones, np.float64)
        return np.zeros((self.channels, 3))


def _at(azimuth_deg: float, elevation_deg: float, radius_m: float) -> Point:
    """A place by its direction: azimuth from ahead to the left."""
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    level = radius_m * math.cos(elevation)
    return (
        -level * math.sin(azimuth),
        radius_m * math.sin(elevation),
        -level * math.cos(azimuth),
    )


def _presets() -> dict[str, Layout]:
    arrays = {
        "tetrahedral": [_at(a, e, _EM32_RADIUS_M) for a, e in _TETRAHEDRAL_DEG],
        "six_ring": [_at(60.0 * k, 0.0, 0.05) for k in range(6)],
        "eigenmike": [_at(a, 90.0 - t, _EM32_RADIUS_M) for a, t in _EM32_DEG],
        # Two at the lower edge, one at the upper edge, one beside the camera on the back.
        "phone": [
            (-0.02, -0.07, 0.0),
            (0.02, -0.07, 0.0),
            (0.02, 0.07, 0.0),
            (-0.02, 0.055, -0.008),
        ],
    }
    found = {name: Layout(name, "array", tuple(places)) for name, places in arrays.items()}
    found["binaural"] = Layout("binaural", "binaural")
    for name, order in (("foa", 1), ("hoa2", 2), ("hoa3", 3)):
        found[name] = Layout(name, "ambisonics", order=order)
    return found


#: Named layouts.
PRESETS = _presets()


def layout(text: str) -> Layout:
    """A named layout, or one of a file ``NAME.json``: a list of places (right, up, back), m.

    Raises:
        ConfigError: It is neither, or has no microphones, too many, or one too far from the centre.
        OSError: The system refuses to read the file.
    """
    if text in PRESETS:
        return PRESETS[text]
    if not text.endswith(".json"):
        raise ConfigError(
            f"array is {quoted(text)}; allowed are {', '.join(PRESETS)}, and the path of a .json "
            "file with a list of microphones"
        )
    try:
        found = read_json(text)
    except ValueError as error:
        raise ConfigError(f"array: {error}") from error
    expected = f"expected 1 to {_MAX_MICROPHONES} microphones, each (right, up, back) in metres"
    rows = sequence_items(f"array {text}", found, expected, most=_MAX_MICROPHONES)
    if not rows:
        raise ConfigError(f"array {text}: found none; {expected}")
    name = os.path.basename(text).removesuffix(".json")
    places = tuple(point(f"array {text}: [{k}]", row) for k, row in enumerate(rows))
    one = Layout(name, "array", places)
    if name in PRESETS or not name.replace("_", "").replace("-", "").isalnum():
        raise ConfigError(
            f"array {text}: its name becomes that of a folder; expected letters, digits, _ and -, "
            f"and none of {', '.join(PRESETS)}"
        )
    if one.radius_m > MAX_RADIUS_M:
        raise ConfigError(
            f"array {text}: a microphone is {one.radius_m:g} m from the centre; allowed are "
            f"{MAX_RADIUS_M:g} m, so that it stands free in a room"
        )
    return one
