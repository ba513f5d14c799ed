"""Real rooms: when echoes arrive, and how clear a room is whose absorption its decay tells."""

from __future__ import annotations

import csv
import json
import math
import os
import wave
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import measures

DATA = Path(os.environ.get("DWELL_SHARED_DATA", Path(__file__).parents[3] / "shared" / "data"))
ROOMS = DATA / "measured" / "acoustics"
WALLS = ("x0", "x1", "y0", "y1", "z0", "z1")
SPEED_M_S = 343.2


def rows(path: Path) -> list[dict[str, str]]:
    """Of a table; skips, visibly, where the data is not at hand."""
    if not path.is_file():
        pytest.skip(f"no {path.name} of {path.parent.name} in ../shared or $DWELL_SHARED_DATA")
    with path.open() as file:
        return list(csv.DictReader(file))


def box(
    folder: Path, size: list[float], material: dict[str, Any], *, image_order: int, rays: int
) -> dwell.AcousticScene:
    """A box with one material."""
    scene = {
        "shoebox": size,
        "walls": dict.fromkeys(WALLS, "m"),
        "materials": {"m": material},
        "bands_hz": [125, 250, 500, 1000, 2000, 4000],
        "sources": [{"id": "s", "pos": [1, 1, 1]}],
        "receivers": [{"id": "r", "pos": [2, 1, 1]}],
    }
    path = folder / "room.json"
    path.write_text(json.dumps(scene))
    return dwell.AcousticScene(str(path), image_order=image_order, rays=rays)


def house(x: float, y: float, z: float) -> tuple[float, float, float]:
    """A place of a measured room, whose z is up, in the house."""
    return (x, z, -y)


def test_echoes_arrive_when_they_were_measured(tmp_path: Path) -> None:
    """M5: 840 arrivals of dEchorate, by wall; the medians of the annotators' limits.

    Distances become times by the speed that its positions were calibrated with: at 24 degrees.
    """
    folder = ROOMS / "dechorate"
    toa: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
    for row in rows(folder / "echo_toa.csv"):
        toa[row["mic"], row["src"]][row["path"]] = float(row["toa_s"])
    places = {
        (row["kind"], row["id"]): house(*(float(row[axis]) for axis in "xyz"))
        for row in rows(folder / "positions.csv")
    }
    size = [5.705, 5.965, 2.355]
    scene = box(tmp_path, size, {"absorption": 0.2, "scattering": 0.1}, image_order=1, rays=0)
    speed_m_s = 331.3 + 0.606 * 24.0

    def wall(point: list[float]) -> str:
        x, y, z = point[0], -point[2], point[1]
        sides = ((x, "west", "east"), (y, "south", "north"), (z, "floor", "ceiling"))
        for (value, near, far), length in zip(sides, size, strict=True):
            if abs(value) < 1e-3:
                return near
            if abs(value - length) < 1e-3:
                return far
        raise AssertionError(point)

    late: dict[str, list[float]] = defaultdict(list)
    for (mic, src), measured in toa.items():
        paths = scene.early_paths(places["src", src], places["mic", mic])
        assert len(paths) == 7
        for found in paths:
            points = found["points"]
            name = "direct" if len(points) == 2 else wall(points[1])
            arrival_s = found["path"]["length_m"] / speed_m_s
            late[name].append(1e6 * (arrival_s - measured[name]))
    medians = {name: float(np.median(np.abs(values))) for name, values in late.items()}
    assert sum(len(values) for values in late.values()) == 840
    for name in ("direct", "ceiling", "east", "south", "north"):
        assert medians[name] <= 50.0, medians
    for name in ("west", "floor"):
        assert medians[name] <= 150.0, medians


def recording(path: Path) -> tuple[NDArray[np.float32], int]:
    """The last channel of a WAV file of 16 bits."""
    with wave.open(str(path)) as file:
        assert file.getsampwidth() == 2
        raw = file.readframes(file.getnframes())
        samples = np.frombuffer(raw, "<i2").reshape(-1, file.getnchannels())
        return (samples[:, -1] / 32768.0).astype(np.float32), file.getframerate()


def test_clarity_follows_from_the_decay(tmp_path: Path) -> None:
    """M4: absorption from T30 of the bare state by Sabine, then C50 at 1.5, 2 and 3 m.

    Within 1.5 dB from 250 Hz to 1 kHz. Below, so small a room has single modes: 1.5 dB at 125 Hz.
    Above, the loudspeaker's own directivity counts, which was not measured: at 2 and 4 kHz the
    simulation is 1 to 3 dB less clear.
    """
    folder = ROOMS / "r3vival"
    bare = [row for row in rows(folder / "index.csv") if row["panels_absorptive_pct"] == "000"]
    omni = [row for row in bare if row["source"].startswith("BG")]
    length, width, height = size = [9.7, 5.5, 2.7]
    volume = length * width * height
    surface = 2 * (length * width + width * height + height * length)
    air_per_m = [1.02e-4, 3.04e-4, 6.29e-4, 1.073e-3, 2.277e-3, 6.839e-3]  # ISO 9613-1, 20 C, 50 %
    absorption = []
    for name, air in zip(("125", "250", "500", "1k", "2k", "4k"), air_per_m, strict=True):
        t30_s = float(np.mean([float(row[f"T30_{name}"]) for row in omni]))
        area = 24 * math.log(10) / SPEED_M_S * volume / t30_s - 4 * air * volume
        absorption.append(area / surface)
    scene = box(
        tmp_path, size, {"absorption": absorption, "scattering": 0.2}, image_order=3, rays=5000
    )
    off: dict[tuple[float, float], list[float]] = defaultdict(list)
    mic = house(3.5, 2.75, 1.2)
    for row in bare:
        if not row["distance_m"]:
            continue
        turn, distance_m = math.radians(float(row["azimuth_deg"])), float(row["distance_m"])
        x, y = 3.5 + distance_m * math.cos(turn), 2.75 - distance_m * math.sin(turn)
        place = house(x, y, 1.2)
        yaw = math.degrees(math.atan2(place[0] - mic[0], place[2] - mic[2]))
        source = dwell.Source(place, yaw_deg=yaw, directivity="loudspeaker")
        samples, rate = recording(folder / row["file"])
        found, wanted = scene.metrics(source, mic), measures.of_response(samples, rate)
        for a, b in zip(found, wanted, strict=True):
            assert a["centre_hz"] == b["centre_hz"]
            if a["c50_db"] is not None and b["c50_db"] is not None:
                off[distance_m, a["centre_hz"]].append(a["c50_db"] - b["c50_db"])
    for distance_m in (1.5, 2.0, 3.0):
        for centre_hz in (250.0, 500.0, 1000.0):
            mean_db = float(np.mean(off[distance_m, centre_hz]))
            assert abs(mean_db) <= 1.5, (distance_m, centre_hz, mean_db)
