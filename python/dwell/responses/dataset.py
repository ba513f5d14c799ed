"""The responses of one house, as its file holds them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Dataset:
    """All responses between some sources and some receivers in one house.

    Attributes:
        house: The HOUSE string.
        fingerprint: What the house is, by its contents.
        rate_hz: Samples a second.
        sources: Where sound was made (source, 3), m, in the house's axes (+Y up).
        receivers: Where it was heard (receiver, 3), m; the middle of the head for ears.
        yaw_deg: Where heads face: 0 to -Z, 90 to -X.
        parts: For each source a NumPy file of shape (receiver, channel, sample), Pa re an impulse
            of 1 Pa at 1 m; the first sample is the moment of the impulse. Two channels are ears,
            left first. Their numbers of samples may differ.
        head_radius_m: Radius of the head that ears are on; of a measured one, of the sphere that it
            resembles.
        corners: The box around the house (2, 3), m.
        air: ``temperature_c``, ``humidity_pct``, ``pressure_kpa``.
        settings: What else the responses depend on: rays, order of images, seed, laws.
        version: Of dwell.
        created: When they were computed, ``YYYY-MM-DD HH:MM:SS`` in UTC.
    """

    house: str
    fingerprint: str
    rate_hz: int
    sources: NDArray[np.float64]
    receivers: NDArray[np.float64]
    yaw_deg: float
    parts: Sequence[Path]
    head_radius_m: float
    corners: NDArray[np.float64]
    air: dict[str, float]
    settings: dict[str, Any]
    version: str
    created: str

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Sources, receivers, channels and samples of the longest part, at least one."""
        shapes = [np.load(part, mmap_mode="r").shape for part in self.parts]
        receivers, channels, _ = shapes[0]
        return len(shapes), receivers, channels, max(1, *(shape[2] for shape in shapes))

    def of_source(self, source: int) -> NDArray[np.float32]:
        """The responses of one source, with silence behind shorter ones."""
        found = np.load(self.parts[source])
        rows = np.zeros(self.shape[1:], np.float32)
        rows[:, :, : found.shape[2]] = found
        return rows


def hdf5_module(wanted: str) -> ModuleType:
    """The module ``h5py``.

    Raises:
        ModuleNotFoundError: It is not installed; the message says what to install.
    """
    try:
        import h5py
    except ModuleNotFoundError:
        raise ModuleNotFoundError(f"{wanted} needs h5py; pip install 'dwell[hdf5]'") from None
    module: ModuleType = h5py
    return module
