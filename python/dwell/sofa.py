"""Measured heads from SOFA files: ``SimpleFreeFieldHRIR`` of AES69, netCDF-4, which is HDF5."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dwell import MeasuredDataError, _native
from dwell.arguments import MAX_FLOAT32

CONVENTION = "SimpleFreeFieldHRIR"
_LENGTHS = {"metre", "metres", "meter", "meters", "m"}
_ANGLES = {"degree": 1.0, "degrees": 1.0, "radian": 180.0 / np.pi, "radians": 180.0 / np.pi}


@dataclass(frozen=True)
class HeadFile:
    """The content of a file, in the head's axes (x right, y up, z back).

    Attributes:
        sources: Shape (direction, 3), m from the head's centre.
        responses: Shape (direction, 2, sample): left, right.
        delays_samples: Shape (direction, 2).
        rate_hz: Samples a second.
    """

    sources: NDArray[np.float64]
    responses: NDArray[np.float32]
    delays_samples: NDArray[np.float64]
    rate_hz: float


def read_head(path: str) -> HeadFile:
    """Reads a head.

    SOFA's axes are x to the front, y to the left, z up; ``ListenerView`` and ``ListenerUp`` turn
    them. The left ear is the receiver with the larger y, whichever stands first.

    Raises:
        MeasuredDataError: The message names file and variable.
    """
    try:
        Path(path).stat()
    except FileNotFoundError:
        raise MeasuredDataError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MeasuredDataError(f"{path}: {error.strerror}") from None
    return _HeadReader(path, _native.Hdf5.open(path)).head()


class SofaReader:
    """One open file."""

    def __init__(self, path: str, file: _native.Hdf5) -> None:
        """A file, and its path for messages."""
        self.path = path
        self.file = file

    def fault(self, variable: str, why: str) -> MeasuredDataError:
        """The fault of a variable."""
        return MeasuredDataError(f"{self.path}: {variable}: {why}")

    def rate_hz(self) -> float:
        """Samples a second."""
        rates = self.numbers("Data.SamplingRate").ravel()
        units = self.file.text("Data.SamplingRate", "Units") or "hertz"
        if units.lower() not in ("hertz", "hz"):
            raise self.fault("Data.SamplingRate", f"Units is {units!r}; allowed is 'hertz'")
        if rates.size == 0 or rates[0] <= 0.0 or (rates != rates[0]).any():
            raise self.fault("Data.SamplingRate", f"{rates}; allowed is one rate above 0 Hz")
        return float(rates[0])

    def unit(self, name: str, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Rows of length 1."""
        length = np.linalg.norm(rows, axis=1, keepdims=True)
        if (length < 1e-6).any():
            raise self.fault(name, "points nowhere")
        unit: NDArray[np.float64] = rows / length
        return unit

    def cartesian(
        self, name: str, rows: NDArray[np.float64], like: str | None = None
    ) -> NDArray[np.float64]:
        """Coordinates as x, y, z by the variable's Type and Units, or those of ``like``."""
        holder, kind = name, self.file.text(name, "Type")
        if kind is None and like is not None and self.has(like):
            holder, kind = like, self.file.text(like, "Type")
        units = [
            part.strip().lower() for part in (self.file.text(holder, "Units") or "").split(",")
        ]
        if kind is None and units[0] in _ANGLES:
            kind = "spherical"
        elif kind is None and units == [""] and name == "SourcePosition":
            # Conventions differ in what they suppose.
            raise self.fault(
                name, "Type and Units are missing; allowed are 'cartesian' and 'spherical'"
            )
        kind = (kind or "cartesian").lower()
        if kind == "cartesian":
            if units != [""] and not set(units) <= _LENGTHS:
                raise self.fault(name, f"Units is {', '.join(units)!r}; allowed is 'metre'")
            return rows
        if kind != "spherical":
            raise self.fault(name, f"Type is {kind!r}; allowed are 'cartesian' and 'spherical'")
        angles = units[0] if units != [""] else "degree"
        known = angles in _ANGLES and units[1:2] in ([], [angles]) and set(units[2:]) <= _LENGTHS
        if not known:
            raise self.fault(
                name, f"Units is {', '.join(units)!r}; allowed is 'degree, degree, metre'"
            )
        azimuth, elevation = np.radians(_ANGLES[angles] * np.moveaxis(rows[..., :2], -1, 0))
        across = rows[..., 2] * np.cos(elevation)
        return np.stack(
            [
                across * np.cos(azimuth),
                across * np.sin(azimuth),
                rows[..., 2] * np.sin(elevation),
            ],
            axis=-1,
        )

    def rows(self, name: str, count: int, columns: int) -> NDArray[np.float64]:
        """A variable with axes (I or M, columns), for each measurement."""
        values = self.numbers(name)
        if values.ndim != 2 or values.shape[0] not in (1, count) or values.shape[1] != columns:
            raise self.fault(
                name, f"expected shape (1 or {count}, {columns}), found {values.shape}"
            )
        return np.broadcast_to(values, (count, columns))

    def numbers(self, name: str) -> NDArray[np.float64]:
        """A variable, all of it finite, also in 32 bits."""
        self.shape(name)
        numbers, shape = self.file.numbers(name)
        if not np.isfinite(numbers).all():
            raise self.fault(name, "holds values that are not finite")
        if (np.abs(numbers) > MAX_FLOAT32).any():
            raise self.fault(name, f"holds values above {MAX_FLOAT32:.3g} either way")
        return numbers.reshape(shape)

    def shape(self, name: str) -> tuple[int, ...]:
        """The lengths of the axes of a variable that must be there."""
        shape = self.file.shape(name)
        if shape is None:
            raise self.fault(name, "missing")
        return tuple(shape)

    def has(self, name: str) -> bool:
        """Returns whether there is such a variable."""
        return self.file.shape(name) is not None


class _HeadReader(SofaReader):
    """The file of a head."""

    def head(self) -> HeadFile:
        """All of it, checked."""
        self.check_convention()
        shape = self.shape("Data.IR")
        if len(shape) != 3:
            raise self.fault("Data.IR", f"expected axes (M, R, N), found shape {shape}")
        count, receivers, samples = shape
        if receivers != 2:
            raise self.fault("Data.IR", f"{receivers} receivers; a head has 2 ears")
        if count * samples == 0:
            raise self.fault(
                "Data.IR", f"{count} directions of {samples} samples; both are at least 1"
            )
        responses = self.numbers("Data.IR")
        rate_hz = self.rate_hz()
        delays = self.rows("Data.Delay", count, 2) if self.has("Data.Delay") else None
        late = np.zeros((count, 2)) if delays is None else delays
        if self.left_is_second():
            responses, late = responses[:, ::-1], late[:, ::-1]
        return HeadFile(
            self.sources(count),
            np.ascontiguousarray(responses, np.float32),
            np.ascontiguousarray(late, np.float64),
            rate_hz,
        )

    def check_convention(self) -> None:
        found = self.file.text(None, "SOFAConventions")
        if found is None:
            raise self.fault("SOFAConventions", "missing; this is no SOFA file")
        if found != CONVENTION:
            spectra = " (spectra)" if found.endswith("HRTF") else ""
            raise self.fault(
                "SOFAConventions", f"{found!r}{spectra}; heads are read from {CONVENTION!r}"
            )
        if (data := self.file.text(None, "DataType") or "FIR") != "FIR":
            raise self.fault("DataType", f"{data!r}; allowed is 'FIR'")

    def left_is_second(self) -> bool:
        """Returns whether the second receiver is the left ear."""
        ears = self.numbers("ReceiverPosition")
        if ears.ndim not in (2, 3) or ears.shape[:2] != (2, 3):
            raise self.fault(
                "ReceiverPosition", f"expected shape (2, 3, I or M), found {ears.shape}"
            )
        places = np.moveaxis(ears.reshape(2, 3, -1), 1, 2)
        sideways = self.cartesian("ReceiverPosition", places)[..., 1]
        left = sideways[0] - sideways[1]
        if not ((left > 1e-6).all() or (left < -1e-6).all()):
            raise self.fault(
                "ReceiverPosition", "no receiver is left (+y) of the other in every measurement"
            )
        return bool((left < 0.0).all())

    def sources(self, count: int) -> NDArray[np.float64]:
        """Positions of the sources, in the head's axes. Shape (M, 3)."""

        def place(name: str, like: str | None = None) -> NDArray[np.float64]:
            return self.cartesian(name, self.rows(name, count, 3), like)

        sources = place("SourcePosition")
        if self.has("ListenerPosition"):
            sources = sources - place("ListenerPosition")
        front, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        front, up = np.tile(front, (count, 1)), np.tile(up, (count, 1))
        if self.has("ListenerView"):
            front = self.unit("ListenerView", place("ListenerView"))
        if self.has("ListenerUp"):
            up = place("ListenerUp", "ListenerView")
        upright = up - front * (front * up).sum(axis=1, keepdims=True)
        up = self.unit("ListenerUp", upright)
        left = np.cross(up, front)
        x, y, z = ((sources * axis).sum(axis=1) for axis in (front, left, up))
        return np.stack([-y, z, -x], axis=1)
