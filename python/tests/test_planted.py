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


def candidates(report: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {row["id"]: row for row in report["candidates"]}
