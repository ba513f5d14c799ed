"""Measured rooms from SOFA files: responses from sources to receivers, with their places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dwell import MeasuredDataError, _native
from dwell.sofa import SofaReader

CONVENTIONS = (
    "SingleRoomSRIR",
    "SingleRoomMIMOSRIR",
    "SingleRoomDRIR",
    "GeneralFIR",
    "GeneralFIR-E",
)
#: Of each form of the data, where the axes M, R, E and N are; without E.
_AXES = {"FIR": None, "FIR-E": (0, 1, 3, 2), "FIRE": (0, 1, 2, 3)}
#: A delay of more samples is none.
_MOST_DELAY = 10_000_000

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RoomResponse:
    """A response from an emitter to a receiver, in the file's own axes.

    Attributes:
        measurement: Its number, from 0.
        emitter: Of the source, from 0.
        receiver: Of the listener, from 0.
        source_m: Shape (3,).
        receiver_m: Shape (3,).
        samples: Shape (sample,).
    """

    measurement: int
    emitter: int
    receiver: int
    source_m: Array
    receiver_m: Array
    samples: NDArray[np.float32]


@dataclass(frozen=True)
class RoomFile:
    """The content of a file.

    Attributes:
        data: Shape (measurement, receiver, emitter, sample).
        delays: Shape (measurement, receiver, emitter), samples.
        sources_m: Shape (measurement, emitter, 3).
        receivers_m: Shape (measurement, receiver, 3).
        rate_hz: Samples a second.
    """

    data: Array
    delays: Array
    sources_m: Array
    receivers_m: Array
    rate_hz: float

    @property
    def emitters(self) -> int:
        """Emitters of a source."""
        return int(self.data.shape[2])

    def responses(self) -> Iterator[RoomResponse]:
        """All responses, by measurement."""
        for m, r, e in np.ndindex(self.data.shape[:3]):
            late = np.zeros(round(float(self.delays[m, r, e])), np.float32)
            samples = np.concatenate([late, self.data[m, r, e].astype(np.float32)])
            yield RoomResponse(m, e, r, self.sources_m[m, e], self.receivers_m[m, r], samples)


def read_room(path: str) -> RoomFile:
    """Reads the responses of a room.

    Raises:
        MeasuredDataError: The message names file and variable.
    """
    if not Path(path).exists():
        raise MeasuredDataError(f"{path}: there is no such file")
    return _RoomReader(path, _native.Hdf5.open(path)).room()


class _RoomReader(SofaReader):
    """The file of a room."""

    def room(self) -> RoomFile:
        found = self.file.text(None, "SOFAConventions")
        if found not in CONVENTIONS:
            what = "missing; this is no SOFA file" if found is None else repr(found)
            raise self.fault(
                "SOFAConventions", f"{what}; rooms are read from {', '.join(CONVENTIONS)}"
            )
        kind = self.file.text(None, "DataType") or "FIR"
        if kind not in _AXES:
            raise self.fault("DataType", f"{kind!r}; allowed is one of {list(_AXES)}")
        axes = _AXES[kind]
        data = self.numbers("Data.IR")
        if data.ndim != (3 if axes is None else 4):
            raise self.fault("Data.IR", f"shape {data.shape}, which is none of {kind}")
        data = data[:, :, None, :] if axes is None else data.transpose(axes)
        if 0 in data.shape:
            raise self.fault("Data.IR", f"shape {data.shape}; all lengths are at least 1")
        count, receivers, emitters, _ = data.shape
        return RoomFile(
            data,
            self.delays(count, receivers, emitters),
            self.places("Source", "Emitter", count, emitters),
            self.places("Listener", "Receiver", count, receivers),
            self.rate_hz(),
        )

    def delays(self, count: int, receivers: int, emitters: int) -> Array:
        """The delays, of each response."""
        shape = (count, receivers, emitters)
        if not self.has("Data.Delay"):
            return np.zeros(shape)
        told = self.numbers("Data.Delay")
        told = told.reshape(*told.shape, 1) if told.ndim == 2 else told
        fits = told.ndim == 3 and all(
            own in (1, of) for own, of in zip(told.shape, shape, strict=True)
        )
        if not fits or (told < 0.0).any() or (told > _MOST_DELAY).any():
            raise self.fault("Data.Delay", f"shape {told.shape}; samples from 0 of each response")
        return np.broadcast_to(told, shape)

    def places(self, holder: str, part: str, count: int, parts: int) -> Array:
        """The places of a holder's parts in each measurement. Shape (count, parts, 3)."""
        name = f"{holder}Position"
        centre = self.cartesian(name, self.rows(name, count, 3))
        name = f"{part}Position"
        if not self.has(name):
            return np.broadcast_to(centre[:, None, :], (count, parts, 3))
        told = self.numbers(name)
        told = told.reshape(*told.shape, 1) if told.ndim == 2 else told
        if told.shape[:2] != (parts, 3) or told.shape[2] not in (1, count):
            raise self.fault(name, f"shape {told.shape}; allowed is ({parts}, 3, 1 or {count})")
        own = self.cartesian(name, np.moveaxis(told, 1, 2))
        own = np.broadcast_to(np.moveaxis(own, 1, 0), (count, parts, 3))
        front, left, up = self.frame(holder, count)
        offset = own[..., :1] * front + own[..., 1:2] * left + own[..., 2:] * up
        places: Array = centre[:, None, :] + offset
        return places

    def frame(self, holder: str, count: int) -> tuple[Array, Array, Array]:
        """The axes of a holder, each of shape (count, 1, 3)."""
        front = np.tile([1.0, 0.0, 0.0], (count, 1))
        up = np.tile([0.0, 0.0, 1.0], (count, 1))
        view = f"{holder}View"
        if self.has(view):
            front = self.unit(view, self.cartesian(view, self.rows(view, count, 3)))
        if self.has(f"{holder}Up"):
            up = self.cartesian(f"{holder}Up", self.rows(f"{holder}Up", count, 3), view)
        across = up - front * (front * up).sum(axis=1, keepdims=True)
        up = self.unit(f"{holder}Up", across)
        return front[:, None], np.cross(up, front)[:, None], up[:, None]
