"""Estimators of directions in the free field, and scores of data sets."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import dwell
from dwell.localization.baselines import BASELINES, Blocks, blocks_of, fits
from dwell.localization.clip_facts import class_count
from dwell.localization.labels import Label, direction, write_labels
from dwell.localization.layouts import PRESETS
from dwell.localization.steering import harmonics, peaks, sphere
from dwell.sounds import write_wav

Command = Callable[..., subprocess.CompletedProcess[str]]
RATE_HZ = 16_000


@pytest.fixture(scope="module")
def free() -> dwell.AcousticScene:
    room = dwell.House.shoebox((20.0, 20.0, 20.0), absorption=1.0)
    return dwell.AcousticScene(room, rays=0, image_order=0, rate_hz=RATE_HZ)


def response(
    free: dwell.AcousticScene, array: str, toward: NDArray[np.float64]
) -> NDArray[np.float64]:
    """What an array hears of an impulse 4 m away in a direction (front, left, up)."""
    front, left, up = toward
    place = (10.0 - 4.0 * left, 10.0 + 4.0 * up, 10.0 - 4.0 * front)
    receiver = PRESETS[array].receiver((10.0, 10.0, 10.0), 0.0)
    return free.impulse_responses(place, [receiver])[0].astype(np.float64)


def heard(free: dwell.AcousticScene, array: str, *toward: NDArray[np.float64]) -> Blocks:
    """White noise from directions, and a little of each microphone's own."""
    rng = np.random.default_rng(1)
    sound = np.zeros((PRESETS[array].channels, 4_800))
    for one in toward:
        noise = rng.normal(size=4_800)
        rows = response(free, array, one)
        sound += np.stack([np.convolve(noise, row)[:4_800] for row in rows])
    sound += 0.05 * sound.std() * rng.normal(size=sound.shape)
    return blocks_of(sound, RATE_HZ, PRESETS[array])


def off_deg(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return math.degrees(math.acos(min(1.0, float(one @ other))))


def test_harmonics_are_those_of_the_engine(free: dwell.AcousticScene) -> None:
    for azimuth, elevation in ((20.0, 10.0), (-130.0, 50.0), (75.0, -40.0)):
        toward = direction(azimuth, elevation)
        rows = response(free, "hoa3", toward)
        gains = rows @ rows[0] / (rows[0] @ rows[0])
        assert gains == pytest.approx(harmonics(toward[None], 3)[0], abs=1e-5)


@pytest.mark.parametrize(
    ("name", "array"),
    [("srp_phat", "tetrahedral"), ("music", "tetrahedral"), ("srp_phat", "foa"), ("music", "foa"),
     ("intensity", "foa")],
)  # fmt: skip
def test_a_source_in_the_free_field_is_found(
    free: dwell.AcousticScene, name: str, array: str
) -> None:
    for toward in (direction(-70.0, 25.0), direction(160.0, -30.0)):
        found = BASELINES[name](heard(free, array, toward), 1)
        # The grid has a degree.
        assert off_deg(found[0], toward) < 1.5


@pytest.mark.parametrize(("array", "bound"), [("tetrahedral", 1.5), ("binaural", 7.0)])
def test_a_pair_finds_the_azimuth_of_what_is_ahead(
    free: dwell.AcousticScene, array: str, bound: float
) -> None:
    for azimuth in (-50.0, 0.0, 30.0):
        toward = direction(azimuth, 0.0)
        found = BASELINES["gcc_phat"](heard(free, array, toward), 1)
        assert off_deg(found[0], toward) < bound


# Beams of first order are too wide for SRP-PHAT to separate two sources.
@pytest.mark.parametrize(
    ("name", "array", "bound"), [("music", "foa", 3.0), ("srp_phat", "hoa3", 12.0)]
)
def test_two_sources_are_both_found(
    free: dwell.AcousticScene, name: str, array: str, bound: float
) -> None:
    both = (direction(60.0, 0.0), direction(-60.0, 20.0))
    found = BASELINES[name](heard(free, array, *both), 2)
    assert len(found) == 2
    for toward in both:
        assert min(off_deg(one, toward) for one in found) < bound


def test_peaks_keep_apart() -> None:
    directions = sphere()
    assert np.linalg.norm(directions.mean(axis=0)) < 1e-2
    top = direction(10.0, 5.0)
    second = direction(100.0, 5.0)
    scores = np.exp(20.0 * (directions @ top - 1)) + 0.5 * np.exp(20.0 * (directions @ second - 1))
    found = peaks(directions, scores, 2)
    assert off_deg(found[0], top) < 5.0
    assert off_deg(found[1], second) < 5.0


def test_what_an_array_cannot_do_is_said() -> None:
    assert "ambisonics" in (fits("intensity", PRESETS["tetrahedral"]) or "")
    assert "two microphones" in (fits("gcc_phat", PRESETS["foa"]) or "")
    assert "head" in (fits("music", PRESETS["binaural"]) or "")
    assert fits("srp_phat", PRESETS["eigenmike"]) is None


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory, free: dwell.AcousticScene) -> Path:
    """A data set of two clips, by hand: one source each, for a second, in the free field."""
    out = tmp_path_factory.mktemp("data")
    rng = np.random.default_rng(2)
    for k, azimuth in enumerate((40.0, -100.0)):
        name = f"fold1_room0000_mix{k:06}"
        noise = rng.normal(size=RATE_HZ)
        rows = response(free, "foa", direction(azimuth, 0.0))
        sound = np.stack([np.convolve(noise, row)[:RATE_HZ] for row in rows])
        write_wav(out / "foa_dev" / "dev-train" / f"{name}.wav", sound, RATE_HZ)
        labels = [Label(frame, k, 0, azimuth, 0.0, 1.0 + 2.0 * k) for frame in range(10)]
        write_labels(out / "metadata_dev" / "dev-train" / f"{name}.csv", labels)
        details = {
            "clip": k,
            "snr_db": 15.0 + 10.0 * k,
            "sources": [{"occlusion": "none" if k else "edge"}],
            "recordings": {
                "foa": {
                    "file": f"foa_dev/dev-train/{name}.wav",
                    "full_scale_pa": 1.0,
                    "sources": [{"drr_db": 3.0}],
                }
            },
            "room": {"t20_s": 0.4},
        }
        path = out / "details_dev" / "dev-train" / f"{name}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(details))
    return out


def test_baselines_are_scored_with_a_report_and_a_picture(
    command: Command, data: Path, tmp_path: Path
) -> None:
    report, plot = tmp_path / "report.json", tmp_path / "errors.png"
    done = command("localize", "score", data, "--baseline", "intensity", "srp_phat", "--json",
                   "--out", report, "--plot", plot)  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert said == json.loads(report.read_text())
    for name in ("intensity", "srp_phat"):
        found = said["reports"][name]
        assert found["clips"] == 2
        assert found["measures"]["f20"] == 1.0
        assert found["angle_deg"]["frames"] == 20
        assert found["angle_deg"]["median"] < 1.0
        distances = [(row["from"], row["frames"]) for row in found["by"]["distance_m"]]
        assert distances == [(1.0, 10), (3.0, 10)]
        assert [row["is"] for row in found["by"]["sources"]] == ["1"]
        assert [row["is"] for row in found["by"]["occlusion"]] == ["none", "edge"]
    with Image.open(plot) as picture:
        assert picture.width > 400


def test_estimates_of_another_program_are_scored(
    command: Command, data: Path, tmp_path: Path
) -> None:
    for k, azimuth in enumerate((40.0, -100.0)):
        # Five degrees off in one clip; the other is not found at all.
        rows = [Label(frame, 0, 0, azimuth + 5.0, 0.0) for frame in range(10)] if not k else []
        write_labels(tmp_path / f"fold1_room0000_mix{k:06}.csv", rows)
    done = command("localize", "score", data, "--estimates", tmp_path, "--json")
    measures = json.loads(done.stdout)["reports"]["estimates"]["measures"]
    assert measures["er20"] == 0.5
    assert measures["f20"] == 0.5
    assert measures["lr_cd"] == 0.5
    assert measures["le_cd_deg"] == pytest.approx((5.0 + 180.0) / 2)
    (tmp_path / "fold1_room0000_mix000001.csv").unlink()
    done = command("localize", "score", data, "--estimates", tmp_path)
    assert done.returncode == 1
    assert "expected a file for each clip" in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "expected one of --baseline and --estimates"),
        (["--baseline", "nosuch"], "allowed are gcc_phat"),
        (["--baseline", "gcc_phat"], "two microphones"),
        (["--baseline", "music", "--array", "phone"], "no recording of 'phone'"),
        (["--baseline", "music", "--array", "own"], "give the file"),
        (["--baseline", "music", "--plot", "x.jpg"], "expected the name of a .png file"),
    ],
)
def test_wrong_requests_are_refused(
    command: Command, data: Path, words: list[str], said: str
) -> None:
    done = command("localize", "score", data, *words)
    assert done.returncode == 1
    assert said in done.stderr


def test_a_data_set_of_another_version_is_refused(tmp_path: Path) -> None:
    (tmp_path / "dataset.json").write_text('{"version": 99}')
    with pytest.raises(
        dwell.ConfigError, match=r"dataset\.json: version is 99; this dwell reads 1"
    ):
        class_count(tmp_path)
