"""A plain HDF5 file of impulse responses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from dwell.responses.dataset import Dataset, hdf5_module


def write_hdf5(path: Path, data: Dataset) -> None:
    """Writes the responses of one house. ``docs/acoustics.md`` lists what is in the file.

    Raises:
        ModuleNotFoundError: ``h5py`` is missing.
        OSError: The file cannot be written.
    """
    h5py = hdf5_module("HDF5")
    with h5py.File(path, "w") as file:
        # One source and receiver a chunk: pairs are read one by one in any order.
        shape = data.shape
        ir = file.create_dataset(
            "ir", shape, np.float32, chunks=(1, 1, *shape[2:]), compression="gzip", shuffle=True
        )
        for source in range(shape[0]):
            ir[source] = data.of_source(source)
        ir.attrs["unit"] = "Pa re an impulse of 1 Pa at 1 m"
        ir.attrs["axes"] = "source, receiver, channel, sample"
        for name, places in (("source", data.sources), ("receiver", data.receivers)):
            row = file.create_dataset(name, data=np.asarray(places, np.float64))
            row.attrs["unit"] = "m"
            row.attrs["axes"] = "x, y (up), z of the house"
        file.attrs["format"] = "dwell impulse responses"
        file.attrs["format_version"] = 1
        file.attrs["house"] = data.house
        file.attrs["house_fingerprint"] = data.fingerprint
        file.attrs["rate_hz"] = data.rate_hz
        file.attrs["yaw_deg"] = data.yaw_deg
        file.attrs["head_radius_m"] = data.head_radius_m
        file.attrs["channels"] = "left, right" if shape[2] == 2 else "omni"
        file.attrs["corners_m"] = data.corners
        file.attrs["settings"] = json.dumps({**data.settings, "air": data.air})
        file.attrs["dwell_version"] = data.version
        file.attrs["created"] = data.created
