"""What a data set of recordings is made by."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

from dwell import ConfigError
from dwell.arguments import (
    boolean,
    choice,
    integer_in_range,
    number_in_range,
    quoted,
    text,
    text_list,
    two_numbers,
)
from dwell.localization.layouts import Layout, layout

#: Sample rates of recordings, Hz.
RATES_HZ = (16_000, 24_000, 48_000)
#: How sound is traced, as docs/acoustics.md lists the presets.
ACOUSTICS: dict[str, dict[str, Any]] = {
    "rl": {"rays": 300, "image_order": 2, "max_duration_s": 1.0, "bin_s": 0.008},
    "full": {"rays": 5000, "image_order": 3, "max_duration_s": 2.0, "bin_s": 0.004},
}
#: How far and how much something moves until its early reflections, and its late sound, are
#: computed anew, m and degrees.
NEW_EARLY = {"rl": (0.5, 15.0), "full": (0.35, 5.0)}
NEW_LATE = {"rl": (1.0, 30.0), "full": (0.35, 5.0)}
_MAX_SOURCES = 4


@dataclass(frozen=True)
class Settings:
    """Settings of a data set; all clips of one have the same.

    Attributes:
        arrays: What records, each the same scenes: names of presets, or files.
        held_out_arrays: Arrays that record the test part alone.
        sounds: ``signals``, ``household`` (the house's own appliances, where they stand), or a
            folder with a folder of WAV files for each class.
        duration_s: Length of a clip, s, 1 to 60.
        rate_hz: 16,000, 24,000 or 48,000.
        preset: ``rl`` or ``full``.
        max_sources: Sources of a clip, 1 to 4; how many is drawn.
        moving: Share of sources that move, 0 to 1.
        moving_listener: Share of clips in which the array moves and turns, 0 to 1.
        snr_db: Lowest and highest ratio of signal and diffuse noise, dB, -60 to 100.
        distance_m: Nearest and farthest source at the start, m, 0.3 to 20.
        in_sight: Whether nothing is between array and source at its onset.
        test_share: Share of houses of the test part, 0 to 1.
        bits: Of samples in files: 16, or 32 (float, Pa).
        parts: Whether direct sound, early and late sound, and noise are written, too.
        responses: Whether the impulse responses of each source's first place are written, too.
        seed: What all is drawn from.

    Raises:
        ConfigError: One is of another type, or out of range.
    """

    arrays: tuple[str, ...] = ("foa",)
    held_out_arrays: tuple[str, ...] = ()
    sounds: str = "signals"
    duration_s: float = 10.0
    rate_hz: int = 24_000
    preset: str = "rl"
    max_sources: int = 2
    moving: float = 0.0
    moving_listener: float = 0.0
    snr_db: tuple[float, float] = (10.0, 30.0)
    distance_m: tuple[float, float] = (0.5, 4.0)
    in_sight: bool = True
    test_share: float = 0.2
    bits: int = 16
    parts: bool = False
    responses: bool = False
    seed: int = 0

    def __post_init__(self) -> None:
        """Checks the fields; lists become tuples."""
        for name in ("arrays", "held_out_arrays"):
            object.__setattr__(self, name, tuple(text_list(name, getattr(self, name))))
        if not self.arrays:
            raise ConfigError("arrays is empty; expected one or more")
        names = [one.folder for one in self.layouts()]
        if len({*names}) < len(names):
            raise ConfigError(f"arrays is {quoted(self.arrays)}; each may stand there once")
        if unknown := {*self.held_out_arrays} - {*self.arrays}:
            raise ConfigError(f"held_out_arrays has {min(unknown)!r}, which is none of arrays")
        if {*self.held_out_arrays} == {*self.arrays}:
            raise ConfigError("held_out_arrays has all arrays; nothing would record the rest")
        text("sounds", self.sounds)
        number_in_range("duration_s", self.duration_s, 1.0, 60.0, "s")
        if integer_in_range("rate_hz", self.rate_hz) not in RATES_HZ:
            raise ConfigError(f"rate_hz is {self.rate_hz}; allowed are 16000, 24000 and 48000")
        choice("preset", self.preset, tuple(ACOUSTICS))
        integer_in_range("max_sources", self.max_sources, low=1, high=_MAX_SOURCES)
        for name in ("moving", "moving_listener", "test_share"):
            number_in_range(name, getattr(self, name), 0.0, 1.0)
        _rising("snr_db", self.snr_db, -60.0, 100.0, "dB")
        _rising("distance_m", self.distance_m, 0.3, 20.0, "m")
        if integer_in_range("bits", self.bits) not in (16, 32):
            raise ConfigError(f"bits is {self.bits}; allowed are 16 and 32")
        for name in ("in_sight", "parts", "responses"):
            boolean(name, getattr(self, name))
        integer_in_range("seed", self.seed)

    def layouts(self) -> list[Layout]:
        """The arrays."""
        return [*map(layout, self.arrays)]

    @property
    def samples(self) -> int:
        """Samples of a clip."""
        return round(self.duration_s * self.rate_hz)

    def to_json(self) -> dict[str, Any]:
        """As plain data."""
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in dataclasses.asdict(self).items()
        }


def _rising(name: str, value: object, low: float, high: float, unit: str) -> None:
    first, last = two_numbers(name, value)
    for number in (first, last):
        number_in_range(name, number, low, high, unit)
    if first > last:
        raise ConfigError(f"{name} is {first:g} to {last:g}; expected the lower one first")
