"""Directivities of one's own, heard."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dwell

INDEX_DB = [0.0, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0]


def free_field() -> dwell.AcousticScene:
    """A box so dry and large that the straight way is all that counts."""
    house = dwell.House.shoebox((60, 40, 60), absorption=1.0)
    return dwell.AcousticScene(house, image_order=0, rays=0, max_duration_s=0.1)


def level_db(directivity: dwell.Directivity | str, degrees: float) -> list[float]:
    """Level at 2 m beside the axis by octave, dB."""
    turn = math.radians(degrees)
    ear = (30 - 2 * math.sin(turn), 20, 30 - 2 * math.cos(turn))
    source = dwell.Source((30, 20, 30), directivity=directivity)
    (direct,) = free_field().echogram(source, ear).path_energy
    return [10 * math.log10(energy) for energy in direct]


def test_what_was_measured_is_heard_beside_the_axis() -> None:
    """Levels of a table, at its angles and half-way between them by amplitude."""
    table = [[0.0] * 8, [-3.0 - k for k in range(8)], [-20.0] * 8]
    polar = dwell.Directivity.polar(table)
    front = level_db(polar, 0)
    for band in range(8):
        side = level_db(polar, 90)[band] - front[band]
        assert side == pytest.approx(table[1][band], abs=0.02)
        between = 20 * math.log10((1 + 10 ** (table[1][band] / 20)) / 2)
        assert level_db(polar, 45)[band] - front[band] == pytest.approx(between, abs=0.02)


def test_a_beam_has_its_index() -> None:
    """By the integral over the sphere; and forms that are told otherwise agree."""
    assert dwell.Directivity.beam(INDEX_DB).index_db() == pytest.approx(INDEX_DB, abs=0.05)
    assert dwell.Directivity.first_order(0.0).index_db() == pytest.approx([0.0] * 8, abs=1e-9)
    cardioid = 10 * math.log10(3)
    assert dwell.Directivity.first_order(0.5).index_db() == pytest.approx([cardioid] * 8, abs=0.01)
    assert dwell.Directivity.beam(cardioid).index_db() == pytest.approx([cardioid] * 8, abs=0.01)
    named = level_db("talker", 120)
    assert level_db(dwell.Directivity.sphere(0.0875), 120) == pytest.approx(named, abs=1e-6)


def test_a_microphone_hears_by_its_own() -> None:
    """One that is deaf behind beside one that is not."""
    deaf = dwell.Directivity.polar([0.0, 0.0, -math.inf])
    ears = dwell.Receiver.array(
        (30, 20, 30), [(0, 0, 0), dwell.Microphone((0, 0, 0), directivity=deaf)]
    )
    both = free_field().impulse_response((30, 20, 32), ears)
    assert np.abs(both[0]).max() > 0.3
    assert np.abs(both[1]).max() < 0.02 * np.abs(both[0]).max()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: dwell.Directivity.polar([[0] * 7] * 3), r"shape \(3, 7\)"),
        (lambda: dwell.Directivity.polar([0]), "2 to 361 angles"),
        (lambda: dwell.Directivity.polar(np.zeros((362, 8))), "2 to 361 angles"),
        (lambda: dwell.Directivity.polar([0, math.nan]), "no NaN"),
        (lambda: dwell.Directivity.polar([0, 7]), "7.0 dB above"),
        (lambda: dwell.Directivity.polar([-math.inf, 0]), "on the axis"),
        (lambda: dwell.Directivity.beam(21), "0 to 20 dB"),
        (lambda: dwell.Directivity.beam([1, 2]), "or 8 of them"),
        (lambda: dwell.Directivity.first_order(math.nan), "gradient is nan"),
        (lambda: dwell.Directivity.sphere(math.inf), "radius_m"),
        (lambda: dwell.Directivity.sphere(0.1).index_db(), "engine's"),
        (lambda: level_db("tweeter", 0), "no 'tweeter'"),
        (lambda: level_db(dwell.Directivity.sphere(5.0), 0), "radius_m is 5"),
        (lambda: level_db(dwell.Directivity.first_order(1.5), 0), "gradient is 1.5"),
    ],
)
def test_what_is_no_directivity_is_refused(make: object, words: str) -> None:
    """By name and range."""
    assert callable(make)
    with pytest.raises(dwell.DwellError, match=words):
        make()
