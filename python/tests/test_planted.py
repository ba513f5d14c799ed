"""Effects planted on real measurements are found on top of what is there.

Slow: ``DWELL_TEST_ALL=1`` runs it, where the data are (``DWELL_SHARED_DATA``).
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from dwell.calibration import calibrate
from dwell.measured.importing import import_files

ROOT = Path(__file__).resolve().parents[2]
MAPS = ROOT / "examples" / "measured"
Array = NDArray[np.float64]
Row = dict[str, str]


def brought(folder: Path, name: str) -> Path:
    """The bundle of a real set by the map that is shipped."""
    if "DWELL_TEST_ALL" not in os.environ:
        pytest.skip("slow; DWELL_TEST_ALL=1 runs it")
    pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    shared = Path(os.environ.get("DWELL_SHARED_DATA", ROOT.parent / "shared" / "data"))
    data = shared / "measured" / "physics" / name
    if not data.is_dir():
        pytest.skip(f"{data} is absent")
    out = folder / f"{name}.measured"
    files = [data / "data.parquet", data / "index.csv"]
    import_files([f for f in files if f.exists()], MAPS / f"{name}.json", out, lambda *_: None)
    return out


def planted(bundle: Path, table: str, plant: Callable[[list[Row]], None]) -> Path:
    """A copy of a bundle, with the rows of each episode and channel changed."""
    out = bundle.with_name(f"planted {bundle.name}")
    out.mkdir()
    for file in bundle.iterdir():
        (out / file.name).write_bytes(file.read_bytes())
    with (bundle / table).open() as file:
        reader = csv.DictReader(file)
        rows, head = [*reader], reader.fieldnames or []
    series: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        series.setdefault((row["episode"], row.get("channel", "")), []).append(row)
    for own in series.values():
        plant(own)
    with (out / table).open("w", newline="") as file:
        writer = csv.DictWriter(file, head)
        writer.writeheader()
        writer.writerows(rows)
    return out


def column(rows: list[Row], name: str) -> Array:
    return np.array([float(row[name]) for row in rows])


def put(rows: list[Row], name: str, values: Array) -> None:
    for row, value in zip(rows, values, strict=True):
        row[name] = f"{value:.9g}"


def value(report: dict[str, Any], cause: str) -> tuple[float, list[float]]:
    """The first parameter of a cause alone, and its interval."""
    found = next(row for row in report["candidates"] if row["id"] == cause)["parameters"][0]
    return found["value"], found["interval"]


def lag(t: Array, y: Array, more: float) -> Array:
    """How far a ball is behind the measured fall with ``more`` drag, 1/m, beside its own."""
    fine = np.linspace(t[0], t[-1], 2000)
    path = np.polynomial.Polynomial.fit(t, y, 5)
    v, a = -path.deriv()(fine), -path.deriv(2)(fine)
    middle = slice(200, 1800)
    own = max(0.0, np.sum((9.81 - a[middle]) * v[middle] ** 2) / np.sum(v[middle] ** 4))
    step, behind = fine[1] - fine[0], np.zeros_like(fine)
    plain = slowed = max(v[0], 0.0)
    for j in range(1, len(fine)):
        plain += step * (9.81 - own * plain**2)
        slowed += step * (9.81 - (own + more) * slowed**2)
        behind[j] = behind[j - 1] + step * (plain - slowed)
    result: Array = np.interp(t, fine, behind)
    return result


def test_drag_planted_on_real_drops_adds_to_the_drag_that_is_there(tmp_path: Path) -> None:
    more = 0.2
    bundle = brought(tmp_path, "ball_drops")
    manifest = json.loads((bundle / "manifest.json").read_text())
    bodies = {row["name"]: row for row in manifest["scene"]["bodies"]}

    def plant(rows: list[Row]) -> None:
        body = bodies[rows[0]["entity"]]
        k = 1.204 * more * np.pi * body["radius_m"] ** 2 / (2.0 * body["mass_kg"])
        t, y = column(rows, "t_s"), column(rows, "value")
        put(rows, "value", y + lag(t, y, k))

    first, second = (
        value(calibrate(one), "drag") for one in (bundle, planted(bundle, "trajectory.csv", plant))
    )
    print("drag", first, second)
    half_widths = [0.5 * (ends[1] - ends[0]) for _, ends in (first, second)]
    assert second[0] - first[0] == pytest.approx(more, abs=float(np.hypot(*half_widths)))


def test_a_delay_planted_on_real_drives_is_found(tmp_path: Path) -> None:
    delay_s = 0.15
    bundle = brought(tmp_path, "diffdrive_odometry")

    def plant(rows: list[Row]) -> None:
        t = column(rows, "t_s")
        for name in ("x", "y", "heading"):
            values = column(rows, name)
            values = np.unwrap(values) if name == "heading" else values
            put(rows, name, np.interp(t - delay_s, t, values))

    before = calibrate(bundle)
    after = calibrate(planted(bundle, "drive.csv", plant))
    found = value(after, "tracker_delay")[0] - value(before, "tracker_delay")[0]
    print("delay", value(before, "tracker_delay"), value(after, "tracker_delay"))
    assert found == pytest.approx(delay_s, rel=0.2)


def test_a_scale_planted_on_real_drives_is_found(tmp_path: Path) -> None:
    scale = 1.03
    bundle = brought(tmp_path, "diffdrive_odometry")

    def plant(rows: list[Row]) -> None:
        for name in ("x", "y"):
            put(rows, name, scale * column(rows, name))

    before = calibrate(bundle)
    after = calibrate(planted(bundle, "drive.csv", plant))
    found = value(after, "length_scale")[0] / value(before, "length_scale")[0]
    print("scale", value(before, "length_scale"), value(after, "length_scale"))
    assert found == pytest.approx(scale, abs=0.005)
