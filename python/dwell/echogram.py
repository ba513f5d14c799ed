"""Energies over time between a source and a receiver, and from where they come."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import finite_number, mapping, number_in_range
from dwell.array_record import ArrayRecord

#: Nominal centres of the eight octave bands of an echogram, Hz.
CENTRES_HZ = (62.5, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)
#: Rows of equal height from straight down to straight up, and eighths of a turn from +X towards +Z.
CELL_ROWS, CELL_COLUMNS = 6, 8


@dataclass(frozen=True, eq=False)
class Echogram(ArrayRecord):
    """Exact early paths and the traced tail, without any noise.

    Energy is re the same source at 1 m in the free field: 1/d² for a free path of d metres.

    Attributes:
        path_s: When each early path arrives, s after the impulse, shape (path,).
        path_energy: Its energy by octave, shape (path, 8).
        path_arrival: The unit vector to where it comes from, shape (path, 3).
        bin_s: Width of the tail's bins, s.
        tail_energy: Energy of everything else, shape (bin, 8).
        bins_per_direction: Bins that share a row of ``tail_directions``.
        tail_directions: Shares of 48 cells of equal area, shape (direction, 48, 8); a cell is
            8 row + column. A band without any comes from all sides.
    """

    path_s: NDArray[np.float64]
    path_energy: NDArray[np.float64]
    path_arrival: NDArray[np.float64]
    bin_s: float
    tail_energy: NDArray[np.float64]
    bins_per_direction: int
    tail_directions: NDArray[np.float64]

    @classmethod
    def from_json(cls, found: dict[str, Any]) -> Echogram:
        """As the engine writes it.

        Raises:
            ConfigError: A field is missing or of another form.
        """
        try:
            return cls._read(mapping("echogram", found))
        except KeyError as error:
            raise ConfigError(f"echogram: field {error} is missing") from None
        except ConfigError:
            raise
        except (TypeError, ValueError, IndexError) as error:
            raise ConfigError(f"echogram: no echogram of the engine: {error}") from None

    @classmethod
    def _read(cls, found: dict[str, Any]) -> Echogram:
        paths, tail = found["paths"], found["tail"]

        def rows(values: list[Any], *shape: int) -> NDArray[np.float64]:
            return np.asarray(values, np.float64).reshape(-1, *shape)

        lengths_m = np.array([path["length_m"] for path in paths])
        return cls(
            path_s=lengths_m / found["speed_m_s"],
            path_energy=rows([path["energy"] for path in paths], len(CENTRES_HZ)),
            path_arrival=rows([path["arrival"] for path in paths], 3),
            bin_s=float(tail["bin_s"]),
            tail_energy=rows(tail["bins"], len(CENTRES_HZ)),
            bins_per_direction=max(int(tail["bins_per_direction"]), 1),
            tail_directions=rows(
                [row["energy"] for row in tail["directions"]],
                CELL_ROWS * CELL_COLUMNS,
                len(CENTRES_HZ),
            ),
        )

    def over_time(self, step_s: float = 0.001) -> NDArray[np.float64]:
        """Energy of paths and tail in steps from the moment of the impulse, shape (step, 8).

        Raises:
            ConfigError: ``step_s`` is none from 5e-6 to 10 s.
        """
        step_s = number_in_range("step_s", step_s, 5e-6, 10.0, "s")
        last = max(float(self.path_s.max(initial=0.0)) + step_s, self.bin_s * len(self.tail_energy))
        edges = np.arange(int(np.ceil(last / step_s)) + 1) * step_s
        energy = np.zeros((len(edges), len(CENTRES_HZ)))
        np.add.at(energy, (self.path_s / step_s).astype(np.int64), self.path_energy)
        # A bin's energy is spread evenly over it.
        sums = np.vstack([np.zeros(len(CENTRES_HZ)), np.cumsum(self.tail_energy, axis=0)])
        bin_edges = np.arange(len(sums)) * self.bin_s
        for band in range(len(CENTRES_HZ)):
            up_to = np.interp(np.append(edges, edges[-1] + step_s), bin_edges, sums[:, band])
            energy[:, band] += np.diff(up_to)
        return energy

    def decay_db(self, step_s: float = 0.001) -> NDArray[np.float64]:
        """The decay of the energy, dB re all, in steps from the impulse, shape (step, 8).

        Schroeder's backward integral; ``-inf`` where nothing is left.
        """
        left = np.cumsum(self.over_time(step_s)[::-1], axis=0)[::-1]
        with np.errstate(divide="ignore", invalid="ignore"):
            decay: NDArray[np.float64] = 10.0 * np.log10(left / left[:1])
        decay[np.isnan(decay)] = -np.inf
        return decay

    def by_direction(self, from_s: float = 0.0, to_s: float = np.inf) -> NDArray[np.float64]:
        """Energy of all bands of the tail and the paths from each cell, between two times.

        Returns:
            Shape (6, 8): rows from down to up, columns from +X towards +Z.

        Raises:
            ConfigError: A time is no number; ``to_s`` may be infinite.
        """
        from_s = finite_number("from_s", from_s)
        given: object = to_s
        is_open = isinstance(given, float | np.floating) and given == np.inf
        to_s = np.inf if is_open else finite_number("to_s", to_s)
        cells = np.zeros(CELL_ROWS * CELL_COLUMNS)
        for at, energy, arrival in zip(
            self.path_s, self.path_energy, self.path_arrival, strict=True
        ):
            if from_s <= at < to_s:
                cells[cell_of(arrival)] += energy.sum()
        for k, energy in enumerate(self.tail_energy):
            start, end = k * self.bin_s, (k + 1) * self.bin_s
            part = max(min(end, to_s) - max(start, from_s), 0.0) / self.bin_s
            which = k // self.bins_per_direction
            if part <= 0.0:
                continue
            even = np.full((len(cells), len(CENTRES_HZ)), 1.0 / len(cells))
            shares = self.tail_directions[which] if which < len(self.tail_directions) else even
            total = shares.sum(axis=0)
            shares = np.where(total > 0.0, shares / np.where(total > 0.0, total, 1.0), even)
            cells += part * (shares @ energy)
        return cells.reshape(CELL_ROWS, CELL_COLUMNS)


def cell_of(direction: NDArray[np.float64]) -> int:
    """The cell of a unit vector, 8 row + column."""
    x, y, z = (float(part) for part in direction)
    row = min(max(int((y + 1.0) * 0.5 * CELL_ROWS), 0), CELL_ROWS - 1)
    turn = np.arctan2(z, x) / (2.0 * np.pi) % 1.0
    return row * CELL_COLUMNS + min(int(turn * CELL_COLUMNS), CELL_COLUMNS - 1)
