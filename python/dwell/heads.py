"""Heads that receivers and agents can wear: spheres, and what was measured on people."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dwell import ConfigError, DwellError, MeasuredDataError, _native, arguments
from dwell.arguments import finite_number, quoted

#: The built-in head's, m.
RADIUS_M = 0.0875


class Head:
    """A head: its filters from each direction to the ears.

    A copy is the same head; a pickle holds its numbers. :meth:`from_sofa` reads a file, and
    ``docs/acoustics.md`` says how what was measured is heard.
    """

    def __init__(
        self,
        native: _native.Head,
        again: tuple[Callable[..., Head], tuple[Any, ...]],
    ) -> None:
        """Wraps a native head; use :meth:`spherical`, :meth:`measured` or :meth:`from_sofa`.

        Args:
            native: The built half.
            again: A function and its arguments that give the head again, in another process too.
        """
        self._native = native
        self._reopen_state = again

    @classmethod
    def spherical(cls, radius_m: float = RADIUS_M) -> Head:
        """A rigid sphere with ears at both ends of a diameter.

        Args:
            radius_m: 0.03 to 0.2 m.

        Raises:
            ConfigError: The radius is out of range.
        """
        radius_m = finite_number("radius_m", radius_m)
        return cls(_native.Head.spherical(radius_m), (Head.spherical, (radius_m,)))

    @classmethod
    def measured(
        cls,
        sources: ArrayLike,
        responses: ArrayLike,
        rate_hz: float,
        *,
        delays: ArrayLike | None = None,
    ) -> Head:
        """A head from impulse responses that were measured around it in an anechoic room.

        Args:
            sources: Where the sources were, m, in the head's axes (x right, y up, z back). Shape
                (direction, 3); only directions count.
            responses: Shape (direction, 2, sample): left ear, right ear.
            rate_hz: Samples a second, 8,000 to 384,000.
            delays: Shape (direction, 2): samples of silence before each response.

        Raises:
            ConfigError: Shapes or numbers are wrong.
        """
        places = _array("sources", sources, 2, np.float64)
        pairs = _array("responses", responses, 3, np.float32)
        late = _array("delays", np.zeros((len(places), 2)) if delays is None else delays, 2)
        rate_hz = finite_number("rate_hz", rate_hz)
        native = _native.Head.measured(places, pairs, rate_hz, late)
        return cls(native, (_from_arrays, (places, pairs, rate_hz, late)))

    @classmethod
    def from_sofa(cls, path: str | os.PathLike[str]) -> Head:
        """The head of a SOFA file (AES69), convention ``SimpleFreeFieldHRIR``.

        Raises:
            MeasuredDataError: The file cannot be read or is none of a head; the message names
                file and variable.
        """
        from dwell.sofa import read_head

        name = arguments.file_path("path", path)
        found = read_head(name)
        try:
            return cls.measured(
                found.sources, found.responses, found.rate_hz, delays=found.delays_samples
            )
        except DwellError as error:
            raise MeasuredDataError(f"{name}: {error}") from error

    @property
    def native(self) -> _native.Head:
        """The built half."""
        return self._native

    @property
    def id(self) -> int:
        """A number of its contents; equal heads have equal ones."""
        return self._native.id

    @property
    def summary(self) -> dict[str, Any] | None:
        """Facts about the measurement; ``None`` for a sphere.

        ``directions`` and ``filled`` (how many), ``radius_m`` (of the sphere with the nearest
        delays), ``gain_db`` (by which all responses were changed), ``removed_delay_s`` (which was
        taken off all).
        """
        return self._native.summary()

    def __repr__(self) -> str:
        """A sphere, or from how many directions it was measured."""
        summary = self.summary
        what = "sphere" if summary is None else f"{summary['directions']} directions"
        return f"Head({what}, id={self.id:016x})"

    def __eq__(self, other: object) -> bool:
        """Returns whether it is the same head."""
        return isinstance(other, Head) and self.id == other.id

    def __hash__(self) -> int:
        """Equal for equal heads."""
        return hash(self.id)

    def __reduce__(self) -> tuple[Callable[..., Head], tuple[Any, ...]]:
        """Its numbers."""
        return self._reopen_state


def head_of(name: str, head: object) -> Head | None:
    """A head as it is given: itself, the path of a SOFA file, or ``None`` for the built-in one.

    Raises:
        ConfigError: It is something else.
    """
    if head is None or isinstance(head, Head):
        return head
    if isinstance(head, str | os.PathLike):
        return Head.from_sofa(head)
    raise ConfigError(
        f"{name} is {quoted(head)}; allowed are a dwell.Head or the path of a SOFA file"
    )


def _from_arrays(
    places: NDArray[np.float64],
    pairs: NDArray[np.float32],
    rate_hz: float,
    late: NDArray[np.float64],
) -> Head:
    return Head.measured(places, pairs, rate_hz, delays=late)


def _array(name: str, values: ArrayLike, axes: int, dtype: Any = np.float64) -> NDArray[Any]:  # noqa: ANN401
    array = arguments.real_array(name, values, dtype)
    if array.ndim != axes:
        raise ConfigError(f"{name}: expected {axes} axes, found shape {array.shape}")
    return array
