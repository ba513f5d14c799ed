"""Impulse responses as SOFA: ``SingleRoomMIMOSRIR`` 1.0 of AES69-2022, netCDF-4 written by h5py."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dwell.responses.dataset import Dataset, hdf5_module

#: What netCDF-4 calls a dimension that has no values of its own, by its format specification.
_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."
_CARTESIAN = {"Type": "cartesian", "Units": "metre"}


def write_sofa(path: Path, data: Dataset) -> None:
    """Writes the responses of one house.

    A measurement (M) is a pair of a source and a listener, by source and then by listener;
    receivers (R) are the listener's channels; there is one emitter (E), in the middle of the
    source. SOFA's z is up: a place (x, y, z) of the house becomes (x, -z, y). The room is the box
    around the house.

    Raises:
        ModuleNotFoundError: ``h5py`` is missing.
        OSError: The file cannot be written.
    """
    h5py = hdf5_module("SOFA")
    sources, receivers, channels, samples = data.shape
    sizes = {"I": 1, "C": 3, "M": sources * receivers, "R": channels, "E": 1, "N": samples}
    with h5py.File(path, "w") as file:
        for name, value in _attributes(data).items():
            file.attrs[name] = _text(value)
        for number, (name, size) in enumerate(sizes.items()):
            scale = file.create_dataset(name, shape=(size,), dtype=">f4", track_times=False)
            scale.make_scale(f"{_NO_VARIABLE}{size:10d}")
            scale.attrs["_Netcdf4Dimid"] = np.int32(number)

        def add(name: str, axes: str, values: ArrayLike | None, **attributes: str) -> Any:  # noqa: ANN401
            """A variable with its dimensions; without values it is left to be filled, in chunks."""
            shape = tuple(sizes[axis] for axis in axes)
            if values is None:
                packed = {"chunks": (1, *shape[1:]), "compression": "gzip", "shuffle": True}
                variable = file.create_dataset(name, shape, np.float64, track_times=False, **packed)
            else:
                row = np.asarray(values, np.float64).reshape(shape)
                variable = file.create_dataset(name, data=row, track_times=False)
            for place, axis in enumerate(axes):
                variable.dims[place].attach_scale(file[axis])
            for key, value in attributes.items():
                variable.attrs[key] = _text(value)
            return variable

        listeners = np.tile(_turned(data.receivers), (sources, 1))
        view = math.radians(data.yaw_deg)
        front = (-math.sin(view), math.cos(view), 0.0)
        ears = [(0.0, data.head_radius_m, 0.0), (0.0, -data.head_radius_m, 0.0)]
        spots = ears if channels == 2 else [(0.0, 0.0, 0.0)]
        box = _turned(data.corners)
        add("ListenerPosition", "MC", listeners, **_CARTESIAN)
        add("ListenerView", "IC", front, **_CARTESIAN)
        add("ListenerUp", "IC", (0.0, 0.0, 1.0), **_CARTESIAN)
        add("ReceiverPosition", "RCI", spots, **_CARTESIAN)
        add(
            "SourcePosition",
            "MC",
            np.repeat(_turned(data.sources), receivers, axis=0),
            **_CARTESIAN,
        )
        add("SourceView", "IC", (1.0, 0.0, 0.0), **_CARTESIAN)
        add("SourceUp", "IC", (0.0, 0.0, 1.0), **_CARTESIAN)
        add("EmitterPosition", "ECI", (0.0, 0.0, 0.0), **_CARTESIAN)
        add("RoomCornerA", "IC", box.min(axis=0))
        add("RoomCornerB", "IC", box.max(axis=0))
        add("RoomCorners", "II", 0.0, **_CARTESIAN)
        add("RoomTemperature", "I", data.air["temperature_c"] + 273.15, Units="kelvin")
        ir = add("Data.IR", "MRNE", None)
        for source in range(sources):
            first = source * receivers
            ir[first : first + receivers] = data.of_source(source)[..., None]
        add("Data.SamplingRate", "I", data.rate_hz, Units="hertz")
        add("Data.Delay", "IRI", np.zeros(channels))


def _attributes(data: Dataset) -> dict[str, str]:
    """All global attributes that the convention asks for, and how the data came to be."""
    return {
        "Conventions": "SOFA",
        "Version": "2.1",
        "SOFAConventions": "SingleRoomMIMOSRIR",
        "SOFAConventionsVersion": "1.0",
        "DataType": "FIR-E",
        "RoomType": "shoebox",
        "Title": f"Simulated impulse responses of {data.house}",
        "DateCreated": data.created,
        "DateModified": data.created,
        "APIName": "dwell",
        "APIVersion": data.version,
        "AuthorContact": "none: computed",
        "Organization": "none: computed",
        "License": "No license provided, ask the author for permission",
        "ApplicationName": "dwell",
        "ApplicationVersion": data.version,
        "DatabaseName": data.house,
        "Comment": "Pa re an impulse of 1 Pa at 1 m. The room is the box around the house.",
        "History": json.dumps({**data.settings, "air": data.air}),
        "Origin": f"simulated; house {data.house}, contents {data.fingerprint}",
        "RoomShortName": data.house,
        "ListenerShortName": _listener(data),
        "SourceShortName": "omnidirectional",
    }


def _listener(data: Dataset) -> str:
    if data.shape[2] != 2:
        return "microphone"
    return "measured head" if "head" in data.settings else "spherical head"


def _turned(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the house's axes (+Y up) to SOFA's (+Z up)."""
    return np.stack([places[:, 0], -places[:, 2], places[:, 1]], axis=1)


def _text(value: str) -> np.bytes_:
    """Text of a fixed length, as netCDF's own characters."""
    return np.bytes_(value.encode("utf-8"))
