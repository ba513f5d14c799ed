"""``dwell.measures``, measures and echograms of scenes, and their pictures."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import measures
from dwell.charts import decay_chart, direction_chart
from dwell.echogram import cell_of

SOURCE, MIC = (1.2, 1.5, 1.4), (4.6, 1.2, 3.3)


@pytest.fixture(scope="module")
def scene(shoebox: dwell.House) -> dwell.AcousticScene:
    return dwell.AcousticScene(shoebox, rays=1000)


def _decaying(rate_hz: int, t60_s: float, seed: int) -> NDArray[np.float64]:
    noise = np.random.default_rng(seed).standard_normal(2 * rate_hz)
    return noise * 10.0 ** (-3.0 * np.arange(len(noise)) / rate_hz / t60_s)


@pytest.mark.long
@pytest.mark.parametrize(
    ("bands", "count", "at_1_khz"), [("octave", 8, 4), ("third_octave", 24, 13)]
)
def test_decaying_noise_has_its_decay(bands: measures.Bands, count: int, at_1_khz: int) -> None:
    found = [
        measures.response_metrics(_decaying(16_000, 0.5, k), 16_000, bands=bands) for k in range(8)
    ]
    assert all(len(rows) == count and "lf" not in rows[0] for rows in found)
    assert found[0][at_1_khz]["centre_hz"] == 1000.0
    mean = {
        key: float(np.mean([rows[at_1_khz][key] or np.nan for rows in found]))
        for key in ("t30_s", "c80_db")
    }
    assert mean["t30_s"] == pytest.approx(0.5, rel=0.05)
    # A band of 230 Hz holds some 8 independent values in the 36 ms after which 1 / e of energy is
    # left: 2 dB for each noise, three standard errors for the mean of eight.
    wanted = 10.0 * math.log10(10.0 ** (6.0 * 0.08 / 0.5) - 1.0)
    assert mean["c80_db"] == pytest.approx(wanted, abs=2.1)


def test_what_is_no_response_is_refused() -> None:
    for wrong in (np.zeros((2, 3)), np.array(["a"]), np.array([1.0, np.nan])):
        with pytest.raises(dwell.ConfigError, match="response"):
            measures.response_metrics(wrong, 16_000)
    with pytest.raises(dwell.ConfigError, match="rate_hz"):
        measures.response_metrics(np.zeros(4), 0)
    with pytest.raises(dwell.ConfigError, match="third_octave"):
        measures.response_metrics(np.zeros(4), 16_000, bands="half")  # type: ignore[arg-type]
    with pytest.raises(dwell.ConfigError, match=r"\(2, samples\)"):
        measures.binaural_metrics(np.zeros((3, 4)), 16_000)
    with pytest.raises(dwell.ConfigError, match="ears: expected real numbers"):
        measures.binaural_metrics([np.zeros(10), np.zeros(11)], 16_000)  # type: ignore[arg-type]
    silent = measures.response_metrics(np.zeros(100), 16_000)
    assert all(value is None for row in silent for key, value in row.items() if key != "centre_hz")


def test_a_head_hears_a_source_on_its_left_earlier_and_louder_there(
    scene: dwell.AcousticScene,
) -> None:
    # The source is ahead at this yaw; a quarter of a turn to the right puts it to the left.
    ahead = math.degrees(math.atan2(-(SOURCE[0] - MIC[0]), -(SOURCE[2] - MIC[2])))
    ears = scene.impulse_response(SOURCE, MIC, ears=True, yaw_deg=ahead - 90.0)
    found = measures.binaural_metrics(ears, scene.rate_hz)
    # Long waves: 3 a / c; Woodworth's short ones: (1 + pi / 2) a / c.
    assert 2.5 * 0.0875 / 343.2 < found["itd_s"] < 3.2 * 0.0875 / 343.2
    assert found["ild_db"] > 3.0
    bands = found["bands"]
    assert all(0.0 <= row["iacc"] <= 1.0 for row in bands)
    # Ears are near each other to long waves and far apart to short ones.
    assert bands[0]["iacc_late"] > 0.9 > bands[5]["iacc_late"]


def test_measures_of_a_scene_are_those_of_its_responses(scene: dwell.AcousticScene) -> None:
    rows = scene.metrics(SOURCE, MIC)
    response = scene.impulse_response(SOURCE, MIC)
    for row, heard in list(
        zip(rows, measures.response_metrics(response[0], scene.rate_hz), strict=True)
    )[3:7]:
        assert heard["t30_s"] == pytest.approx(row["t30_s"], rel=0.15)
        assert heard["g_db"] == pytest.approx(row["g_db"], abs=1.2)
        assert 0.0 < row["lf"] < 1.0
    several = scene.metrics_at(SOURCE, [MIC, dwell.Receiver.binaural(MIC, yaw_deg=0.0)])
    assert several[0] == rows
    assert several[1][4]["t30_s"] == rows[4]["t30_s"]
    assert several[1][4]["lf"] != rows[4]["lf"]


def test_an_echogram_holds_the_energy_of_the_measures(scene: dwell.AcousticScene) -> None:
    echogram = scene.echogram(SOURCE, MIC)
    energy = echogram.over_time(0.001).sum(axis=0)
    for e, row in zip(energy, scene.metrics(SOURCE, MIC), strict=True):
        assert 10.0 * math.log10(100.0 * e) == pytest.approx(row["g_db"], abs=0.05)
    spans = [(0.0, 0.02), (0.02, np.inf)]
    parts = sum(echogram.by_direction(a, b).sum() for a, b in spans)
    assert parts == pytest.approx(energy.sum(), rel=1e-6)
    direct = np.unravel_index(np.argmax(echogram.by_direction(0.0, 0.012)), (6, 8))
    toward = np.subtract(SOURCE, MIC)
    assert int(direct[0]) * 8 + int(direct[1]) == cell_of(toward / np.linalg.norm(toward))
    decay = echogram.decay_db()
    assert decay[0, 4] == 0.0
    assert (np.diff(decay[np.isfinite(decay[:, 4]), 4]) <= 1e-9).all()


def test_charts_show_decays_and_directions(scene: dwell.AcousticScene) -> None:
    echogram = scene.echogram(SOURCE, MIC)
    for draw in (decay_chart, direction_chart):
        picture = draw(echogram, width=400)
        assert picture.width == 400
        assert len(picture.getcolors(1 << 20) or []) > 50


def test_a_response_may_be_one_row_as_one_microphone_gives_it(scene: dwell.AcousticScene) -> None:
    response = scene.impulse_response(SOURCE, MIC)
    assert response.shape[0] == 1
    rate_hz = scene.rate_hz
    assert measures.response_metrics(response, rate_hz) == measures.response_metrics(
        response[0], rate_hz
    )
    with pytest.raises(dwell.ConfigError, match="one row"):
        measures.response_metrics(np.zeros((2, 100), np.float32), rate_hz)
