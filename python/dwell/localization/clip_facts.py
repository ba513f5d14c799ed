"""What the details of a clip say of a recording, checked: data sets come from strangers."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dwell import ConfigError
from dwell.arguments import (
    above_zero,
    finite_number,
    inner_path,
    integer_in_range,
    mapping,
    text,
    text_list,
)
from dwell.files import read_json
from dwell.localization.settings import RATES_HZ
from dwell.result_version import refuse_other_version

#: How much of a source is hidden.
OCCLUSIONS = ("none", "edge", "wall", "all")


def read_details(path: Path) -> dict[str, Any]:
    """The details of a clip, as a run wrote them.

    Raises:
        ConfigError: It is no such file.
        OSError: The system refuses.
    """
    try:
        found = read_json(path)
    except ValueError as error:
        raise ConfigError(str(error)) from None
    if not isinstance(found, dict) or not {"clip", "sources", "recordings"} <= set(found):
        raise ConfigError(f"{path}: no details of a clip, as dwell localize make writes them")
    return found


def class_count(folder: Path) -> int | None:
    """How many classes a data set has; ``None`` where it does not say.

    Raises:
        ConfigError: What it says is no list, or of another version.
        OSError: The system refuses.
    """
    path = folder / "dataset.json"
    try:
        found = mapping(os.fspath(path), read_json(path))
        refuse_other_version(os.fspath(path), found)
    except FileNotFoundError:
        return None
    except ValueError as error:
        raise ConfigError(str(error)) from None
    if "classes" not in found:
        return None
    return len(text_list(f"{path}: classes", found["classes"]))


@dataclass(frozen=True)
class ClipFacts:
    """What is known of a recording beside its labels; what nobody knows is ``None``.

    Attributes:
        file: The recording below the data set's folder.
        full_scale_pa: The pressure of a full sample of 16 bits, Pa.
        rates_hz: What the samples a second may be: the stated ones, or all that are made.
        snr_db: Sound over noise, dB.
        t20_s: Reverberation time of the room, s.
        drr_db: Of each source direct sound over all else, dB.
        occlusion: Of each source how much hides it, one of :data:`OCCLUSIONS`.
    """

    file: str
    full_scale_pa: float
    rates_hz: tuple[int, ...]
    snr_db: float | None
    t20_s: float | None
    drr_db: tuple[float | None, ...]
    occlusion: tuple[str | None, ...]


def array_names(path: Path, details: dict[str, Any]) -> list[str]:
    """The arrays that recorded a clip."""
    return [*mapping(f"{path}: recordings", details["recordings"])]


def clip_facts(path: Path, details: dict[str, Any], array: str) -> ClipFacts:
    """What the details in a file say of an array's recording.

    Raises:
        ConfigError: They are none; the message names the file and the field.
    """
    at = f"{path}: recordings.{array}"
    record = mapping(at, mapping(f"{path}: recordings", details["recordings"])[array])
    sources = _rows(f"{path}: sources", details["sources"])
    known = _rows(f"{at}.sources", record.get("sources", []))
    if len(known) != len(sources):
        raise ConfigError(f"{at}.sources has {len(known)} rows; the clip has {len(sources)}")
    room = mapping(f"{path}: room", details.get("room", {}))
    return ClipFacts(
        file=inner_path(f"{at}.file", record.get("file")),
        full_scale_pa=above_zero(f"{at}.full_scale_pa", record.get("full_scale_pa")),
        rates_hz=_rates(f"{path}: rate_hz", details.get("rate_hz")),
        snr_db=_number(f"{path}: snr_db", details.get("snr_db")),
        t20_s=_number(f"{path}: room.t20_s", room.get("t20_s")),
        drr_db=tuple(
            _number(f"{at}.sources[{k}].drr_db", row.get("drr_db")) for k, row in enumerate(known)
        ),
        occlusion=tuple(
            _occlusion(f"{path}: sources[{k}].occlusion", row.get("occlusion"))
            for k, row in enumerate(sources)
        ),
    )


def _rows(name: str, value: object) -> list[dict[str, Any]]:
    if not isinstance(value, list):
        raise ConfigError(f"{name} is {value!r:.60}; expected a list with a row for each source")
    return [mapping(f"{name}[{k}]", row) for k, row in enumerate(value)]


def _rates(name: str, value: object) -> tuple[int, ...]:
    if value is None:
        return RATES_HZ
    rate_hz = integer_in_range(name, value)
    if rate_hz not in RATES_HZ:
        raise ConfigError(f"{name} is {rate_hz}; allowed are {', '.join(map(str, RATES_HZ))}")
    return (rate_hz,)


def _number(name: str, value: object) -> float | None:
    return None if value is None else finite_number(name, value)


def _occlusion(name: str, value: object) -> str | None:
    found = None if value is None else text(name, value)
    if found is not None and found not in OCCLUSIONS:
        raise ConfigError(f"{name} is {found!r:.60}; allowed are {', '.join(OCCLUSIONS)}")
    return found
