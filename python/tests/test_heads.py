"""Measured heads: SOFA files, the table of KEMAR, agents that wear one."""

from __future__ import annotations

import copy
import functools
import math
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

import dwell
from dwell import measures
from dwell.cli import main
from dwell.sofa import HeadFile, read_head

h5py = pytest.importorskip("h5py")

DATA = Path(os.environ.get("DWELL_SHARED_DATA", Path(__file__).parents[3] / "shared" / "data"))
KEMAR = DATA / "measured" / "acoustics" / "hrtf" / "MIT_KEMAR_normal_pinna.sofa"
needs_kemar = pytest.mark.skipif(not KEMAR.is_file(), reason=f"{KEMAR} is not there")
RADIUS_M, FAR_M, RATE_HZ = 0.0875, 1.4, 44_100
Write = Callable[..., Path]
#: Frequencies and lags of cross-correlations, and what turns the phases of the ones by the others.
LINES_HZ, LAGS_S = 20.0 * np.arange(5, 75), np.arange(-1000, 1001) * 1e-6
SHIFTS = np.exp(-2j * np.pi * np.outer(LINES_HZ, LAGS_S))
#: h5py has no types.
File = Any
Change = Callable[[File], None]


@pytest.fixture(scope="module")
def nowhere() -> dwell.AcousticScene:
    """Free field at 44.1 kHz: direct sound in a hall that is far away."""
    return _free_field(RATE_HZ)


def _free_field(rate_hz: int) -> dwell.AcousticScene:
    hall = dwell.House.shoebox((60.0, 30.0, 60.0), absorption=1.0, scattering=0.0)
    return dwell.AcousticScene(
        hall,
        rate_hz=rate_hz,
        rays=0,
        image_order=0,
        air_absorption=False,
        max_duration_s=0.1,
    )


def _heard(
    scene: dwell.AcousticScene, towards: NDArray[np.float64], head: dwell.Head | None = None
) -> NDArray[np.float64]:
    """A head's response from a direction in SOFA's axes, re the centre: shape (2, sample)."""
    centre = np.array([30.0, 15.0, 30.0])
    x, y, z = towards * FAR_M
    receiver = dwell.Receiver.binaural(tuple(centre), head=head)
    found = scene.impulse_response(tuple(centre + np.array([-y, z, -x])), receiver)
    return np.asarray(found, np.float64) * FAR_M


def _towards(azimuth_deg: float, elevation_deg: float) -> NDArray[np.float64]:
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])


@functools.lru_cache(32)
def _waves(samples: int, rate_hz: float, at_hz: tuple[float, ...]) -> NDArray[np.complex128]:
    """What a response is multiplied with for its spectrum: shape (sample, frequency)."""
    turns = np.outer(at_hz, np.arange(samples)) / rate_hz
    waves: NDArray[np.complex128] = np.exp(-2j * np.pi * turns.T)
    return waves


def _spectrum(
    response: NDArray[np.float64], rate_hz: float, at_hz: NDArray[np.float64]
) -> NDArray[np.complex128]:
    spectrum: NDArray[np.complex128] = response @ _waves(
        response.shape[-1], rate_hz, tuple(at_hz.tolist())
    )
    return spectrum


def _itd_us(pair: NDArray[np.float64], rate_hz: float) -> float:
    """The lag of the largest cross-correlation below 1.5 kHz: positive when the left is first."""
    left, right = _spectrum(pair, rate_hz, LINES_HZ)
    correlation = (left * right.conj()) @ SHIFTS
    return float(1e6 * LAGS_S[correlation.real.argmax()])


def _levels_db(pair: NDArray[np.float64], rate_hz: float, centre_hz: float) -> NDArray[np.float64]:
    """The level of each ear in an octave."""
    lines = np.geomspace(centre_hz / math.sqrt(2.0), centre_hz * math.sqrt(2.0), 201)
    power: NDArray[np.float64] = (np.abs(_spectrum(pair, rate_hz, lines)) ** 2).mean(axis=-1)
    return 10.0 * np.log10(power)


@pytest.fixture(scope="module")
def ball(nowhere: dwell.AcousticScene) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The built-in head from rings 10 degrees apart: directions as azimuth, elevation (degrees) and
    responses (direction, 2, sample)."""
    rows = [(0.0, 90.0), (0.0, -90.0)]
    for elevation in range(-80, 90, 10):
        count = max(6, round(36 * math.cos(math.radians(elevation))))
        rows += [(360.0 * k / count, float(elevation)) for k in range(count)]
    responses = []
    for azimuth, elevation in rows:
        response = _heard(nowhere, _towards(azimuth, elevation))
        responses.append(np.pad(response, ((0, 0), (0, 700)))[:, :700])
    return np.array(rows), np.array(responses)


@pytest.fixture
def write(ball: tuple[NDArray[np.float64], NDArray[np.float64]], tmp_path: Path) -> Write:
    """Writes a SOFA file of the built-in head, changed as a test wants it."""

    def written(change: Change = lambda file: None) -> Path:
        angles, responses = ball
        path = tmp_path / "ball.sofa"
        with h5py.File(path, "w") as file:
            for name, value in {
                "Conventions": "SOFA",
                "SOFAConventions": "SimpleFreeFieldHRIR",
                "DataType": "FIR",
                "RoomType": "free field",
            }.items():
                file.attrs[name] = np.bytes_(value)
            far = np.full(len(angles), FAR_M)
            for name, rows, kind, units in (
                ("ListenerPosition", [[0.0, 0.0, 0.0]], "cartesian", "metre"),
                ("ListenerView", [[1.0, 0.0, 0.0]], "cartesian", "metre"),
                ("ListenerUp", [[0.0, 0.0, 1.0]], None, None),
                ("ReceiverPosition", [[[0.0], [0.09], [0.0]], [[0.0], [-0.09], [0.0]]], None, None),
                ("EmitterPosition", [[[0.0], [0.0], [0.0]]], None, None),
                (
                    "SourcePosition",
                    np.column_stack([angles, far]),
                    "spherical",
                    "degree, degree, metre",
                ),
            ):
                file[name] = np.array(rows, np.float64)
                if kind is not None:
                    file[name].attrs["Type"] = np.bytes_(kind)
                    file[name].attrs["Units"] = np.bytes_(units)
            file["Data.IR"] = responses
            file["Data.SamplingRate"] = np.array([float(RATE_HZ)])
            file["Data.SamplingRate"].attrs["Units"] = np.bytes_("hertz")
            file["Data.Delay"] = np.zeros((1, 2))
            change(file)
        return path

    return written


def _again(file: File, name: str, values: ArrayLike, kind: str | None = None) -> None:
    attributes = dict(file[name].attrs)
    del file[name]
    file[name] = np.asarray(values, np.float64)
    for key, value in attributes.items():
        file[name].attrs[key] = value
    if kind is not None:
        file[name].attrs["Type"] = np.bytes_(kind)
        file[name].attrs["Units"] = np.bytes_("metre")


def test_a_file_of_the_sphere_is_heard_as_the_sphere(
    write: Write, nowhere: dwell.AcousticScene
) -> None:
    head = dwell.Head.from_sofa(write())
    about = head.summary
    assert about is not None
    assert about["filled"] == 0
    assert about["radius_m"] == pytest.approx(RADIUS_M, abs=0.004)
    # The responses were scaled to the centre: no gain is left to take off.
    assert about["gain_db"] == pytest.approx(0.0, abs=0.05)
    # At 8 kHz, and where rings around the bright spot are narrower than the file's 10 degrees.
    at_hz = np.array([250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0])
    for azimuth, elevation in [(0, 0), (90, 0), (270, 30), (140, -50), (33, 4), (5, 62), (322, -7)]:
        found, wanted = (
            _spectrum(_heard(nowhere, _towards(azimuth, elevation), which), RATE_HZ, at_hz)
            for which in (head, None)
        )
        assert np.abs(20.0 * np.log10(np.abs(found / wanted))).max() < 0.5
        assert np.abs(np.angle(found / wanted) / (2.0 * np.pi * at_hz)).max() < 10e-6


def test_files_may_be_written_in_several_ways(write: Write) -> None:
    """Cartesian, turned, elsewhere, ears the other way round, delays: all are the same head."""
    plain = read_head(str(write()))
    assert plain.sources[0] == pytest.approx([0.0, FAR_M, 0.0])  # straight up
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # to the left
    x, y, z = -plain.sources[:, 2], -plain.sources[:, 0], plain.sources[:, 1]
    sofa = np.stack([x, y, z], axis=1)

    def cartesian(file: File) -> None:
        _again(file, "SourcePosition", sofa, "cartesian")

    def turned(file: File) -> None:
        _again(file, "SourcePosition", sofa @ turn.T + [3.0, 2.0, 1.0], "cartesian")
        _again(file, "ListenerView", [[0.0, 1.0, 0.0]])
        _again(file, "ListenerPosition", [[3.0, 2.0, 1.0]])

    def lying(file: File) -> None:
        """On the back: looking up, the crown to -x."""
        tilt = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
        _again(file, "SourcePosition", sofa @ tilt.T, "cartesian")
        _again(file, "ListenerView", [[90.0, 90.0, 1.0]])
        file["ListenerView"].attrs["Type"] = np.bytes_("spherical")
        file["ListenerView"].attrs["Units"] = np.bytes_("degree, degree, metre")
        _again(file, "ListenerUp", [[-1.0, 0.0, 0.0]])
        file["ListenerUp"].attrs["Type"] = np.bytes_("cartesian")

    def swapped(file: File) -> None:
        _again(file, "ReceiverPosition", file["ReceiverPosition"][()][::-1])
        _again(file, "Data.IR", file["Data.IR"][()][:, ::-1])

    def delayed(file: File) -> None:
        _again(file, "Data.IR", np.roll(file["Data.IR"][()], -50, axis=2))
        _again(file, "Data.Delay", np.full((len(sofa), 2), 50.0))

    for change in (cartesian, turned, lying, swapped):
        found = read_head(str(write(change)))
        assert np.allclose(found.sources, plain.sources, atol=1e-9), change.__name__
        assert np.array_equal(found.responses, plain.responses)
    found = read_head(str(write(delayed)))
    assert (found.delays_samples == 50.0).all()


def _set(name: str, values: ArrayLike) -> Change:
    return lambda file: _again(file, name, values)


def _drop(name: str) -> Change:
    def dropped(file: File) -> None:
        del file[name]

    return dropped


def _attribute(name: str, value: str, of: str | None = None) -> Change:
    def changed(file: File) -> None:
        (file if of is None else file[of]).attrs[name] = np.bytes_(value)

    return changed


def _untold(file: File) -> None:
    for name in ("Type", "Units"):
        file["SourcePosition"].attrs.pop(name)


def _spoil(file: File) -> None:
    file["Data.IR"][3, 1, 7] = np.nan


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (_attribute("SOFAConventions", "SimpleFreeFieldHRTF"), r"SOFAConventions: .*\(spectra\)"),
        (_attribute("SOFAConventions", "SingleRoomDRIR"), "SOFAConventions: 'SingleRoomDRIR'"),
        (lambda file: file.attrs.pop("SOFAConventions"), "SOFAConventions: missing"),
        (_attribute("DataType", "TF"), "DataType: 'TF'"),
        (_drop("Data.IR"), "Data.IR: missing"),
        (_drop("SourcePosition"), "SourcePosition: missing"),
        (_drop("ReceiverPosition"), "ReceiverPosition: missing"),
        (_drop("Data.SamplingRate"), "Data.SamplingRate: missing"),
        (_spoil, "Data.IR: holds values that are not finite"),
        (_set("Data.IR", np.full((9, 2, 64), 1e39)), r"Data.IR: holds values above 3\.4e\+38"),
        (_set("Data.SamplingRate", [0.0]), "Data.SamplingRate: "),
        (_set("Data.SamplingRate", [44100.0, 48000.0]), "Data.SamplingRate: "),
        (_attribute("Units", "kilohertz", "Data.SamplingRate"), "Data.SamplingRate: Units"),
        (_set("Data.IR", np.ones((9, 1, 64))), "Data.IR: 1 receivers; a head has 2 ears"),
        (_set("Data.IR", np.ones((9, 64))), r"Data.IR: expected axes \(M, R, N\)"),
        (_set("Data.IR", np.ones((9, 2, 64))), "SourcePosition: expected shape"),
        (_set("Data.Delay", np.zeros((3, 2))), "Data.Delay: expected shape"),
        (_set("ReceiverPosition", np.zeros((2, 3, 1))), "ReceiverPosition: no receiver is left"),
        (_attribute("Type", "polar", "SourcePosition"), "SourcePosition: Type is 'polar'"),
        (_attribute("Units", "gon, gon, metre", "SourcePosition"), "SourcePosition: Units"),
        (_untold, "SourcePosition: Type and Units are missing; allowed are"),
        (_set("ListenerView", [[0.0, 0.0, 0.0]]), "ListenerView: points nowhere"),
        (_set("ListenerUp", [[2.0, 0.0, 0.0]]), "ListenerUp: points nowhere"),
    ],
)
def test_what_is_no_head_is_refused_by_file_and_variable(
    write: Write, change: Change, part: str
) -> None:
    path = write(change)
    with pytest.raises(dwell.MeasuredDataError, match=part) as error:
        dwell.Head.from_sofa(path)
    assert str(error.value).startswith(f"{path}: ")


def test_places_without_a_type_are_those_of_their_units(write: Write) -> None:
    whole = dwell.Head.from_sofa(write(lambda _: None))
    untyped = dwell.Head.from_sofa(write(lambda file: file["SourcePosition"].attrs.pop("Type")))
    assert untyped == whole


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "text.sofa").write_text("no HDF5", "utf-8")
    with pytest.raises(dwell.MeasuredDataError, match=r"text\.sofa: no HDF5"):
        dwell.Head.from_sofa(tmp_path / "text.sofa")
    with pytest.raises(dwell.MeasuredDataError, match=r"none\.sofa: there is no such file"):
        dwell.Head.from_sofa(tmp_path / "none.sofa")
    with pytest.raises(dwell.ConfigError, match=r"radius_m is 0\.5"):
        dwell.Head.spherical(0.5)
    with pytest.raises(dwell.ConfigError, match="responses: expected shape"):
        dwell.Head.measured(np.ones((9, 3)), np.ones((9, 1, 64)), 48_000)
    whole = (np.ones((9, 3)), np.ones((9, 2, 64)), 48_000)
    for at, name in enumerate(("sources", "responses", "rate_hz")):
        parts = [part + 1j if k == at else part for k, part in enumerate(whole)]
        with pytest.raises(dwell.ConfigError, match=f"{name}.* number"):
            dwell.Head.measured(*parts)  # type: ignore[arg-type]
    with pytest.raises(dwell.ConfigError, match=r"rate_hz is .* expected a number"):
        dwell.Head.measured(*whole[:2], np.complex64(48_000))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="level_db: expected real numbers"):
        dwell.Directivity.polar(np.zeros((3, 8), complex))
    with pytest.raises(dwell.ConfigError, match="head is 7"):
        dwell.Receiver.binaural((0.0, 0.0, 0.0), head=7)  # type: ignore[arg-type]


def test_heads_are_values(write: Write) -> None:
    path = write()
    head = dwell.Head.from_sofa(path)
    for other in (pickle.loads(pickle.dumps(head)), copy.copy(head), dwell.Head.from_sofa(path)):
        assert other == head
        assert hash(other) == hash(head)
    assert dwell.Head.spherical(0.08) == pickle.loads(pickle.dumps(dwell.Head.spherical(0.08)))
    assert dwell.Head.spherical(0.08) != dwell.Head.spherical(0.081)
    assert dwell.Head.spherical().summary is None


def test_agents_wear_heads(write: Write, shoebox: dwell.House) -> None:
    """Of a world, its copies and an environment; another head is heard otherwise."""
    head = dwell.Head.from_sofa(write())

    def play(world: dwell.World, steps: int) -> NDArray[np.float32]:
        heard = []
        for _ in range(steps):
            world.step()
            heard.append(world.listen(800))
        return np.concatenate(heard, axis=1)

    def begin(head: dwell.Head | None = None) -> dwell.World:
        world = dwell.World(shoebox, seed=3, sound_head=head)
        world.place_agent((4.0, 0.0, 3.5), yaw_deg=30.0)
        world.listen(800)
        world.play("noise", at=(1.5, 1.4, 1.5), loop=True)
        return world

    world = begin(head)
    first = play(world, 6)
    assert np.array_equal(first, play(begin(head), 6))
    assert not np.array_equal(first, play(begin(), 6))
    other = pickle.loads(pickle.dumps(world))
    assert np.array_equal(play(world, 4), play(other, 4))
    with pytest.raises(dwell.ConfigError, match="sound_head"):
        dwell.World(shoebox, sound_head=3)
    with pytest.raises(dwell.MeasuredDataError, match="no such file"):
        dwell.World(shoebox, sound_head="nothing.sofa")


def test_the_command_line_wears_a_head(
    write: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write()
    places = ("--source", "1.2,1.5,1.4", "--mic", "3.6,1.2,2.3", "--rays", "50")
    options = ("ir", "seed:3?home=studio", *places, "--head", str(path))
    assert main([*options, "--json", "--out", str(tmp_path / "a.wav")]) == 0
    assert '"channels": 2' in capsys.readouterr().out
    assert main([*options, "--plot", "decay", "--out", str(tmp_path / "a.png")]) != 0
    assert "--head" in capsys.readouterr().err


def _kemar() -> tuple[HeadFile, NDArray[np.float64]]:
    """The file, and its directions as azimuth and elevation, degrees."""
    file = read_head(str(KEMAR))
    right, up, back = file.sources.T / np.linalg.norm(file.sources, axis=1)
    azimuth = np.degrees(np.arctan2(-right, -back)) % 360.0
    return file, np.stack([azimuth, np.degrees(np.arcsin(up))], axis=1)


@pytest.mark.long
@needs_kemar
def test_kemar_is_heard_as_measured() -> None:
    """V17: 10 us and 0.5 dB against the file, at its rate and at 16 kHz; the table's figures."""
    head, (file, angles) = dwell.Head.from_sofa(KEMAR), _kemar()
    about = head.summary
    assert about is not None
    assert about["directions"] == 710
    assert 0 < about["filled"] < 20
    assert 0.07 < about["radius_m"] < 0.1
    table = {  # azimuth: ITD, us; ILD in the octave of 8 kHz, dB
        30: (286.0, 13.0),
        45: (424.0, 18.4),
        60: (594.0, 22.1),
        90: (703.0, 19.1),
        120: (587.0, 20.0),
        150: (259.0, 1.9),
    }
    for rate_hz in (44_100, 16_000):
        scene = _free_field(rate_hz)
        octaves = [250.0, 500.0, 1000.0, 2000.0, 4000.0]
        if rate_hz == 44_100:
            octaves.append(8000.0)
        for azimuth, (itd_us, ild_db) in table.items():
            near = int(np.abs(angles - [azimuth, 0.0]).sum(axis=1).argmin())
            measured = file.responses[near].astype(np.float64)
            heard = _heard(scene, _towards(*angles[near]), head)
            assert abs(_itd_us(heard, rate_hz) - _itd_us(measured, RATE_HZ)) < 10.0
            assert abs(_itd_us(heard, rate_hz) - itd_us) < 40.0
            for octave in octaves:
                found = _levels_db(heard, rate_hz, octave) - about["gain_db"]
                wanted = _levels_db(measured, RATE_HZ, octave)
                assert np.abs(found - wanted).max() < 0.5, (rate_hz, azimuth, octave)
            if rate_hz == 44_100:
                left, right = _levels_db(heard, rate_hz, 8000.0)
                assert abs(left - right - ild_db) < 2.0, azimuth


@pytest.mark.slow
@needs_kemar
def test_kemar_between_its_directions() -> None:
    """From every other azimuth: those left out within 0.5 dB by octave on average and 20 us."""
    file, angles = _kemar()
    keep = np.ones(len(angles), bool)
    for elevation in np.unique(angles[:, 1].round(3)):
        ring = np.flatnonzero(np.abs(angles[:, 1] - elevation) < 1e-2)
        keep[ring[np.argsort(angles[ring, 0])][1::2]] = False
    half = dwell.Head.measured(file.sources[keep], file.responses[keep], file.rate_hz)
    about = half.summary
    assert about is not None
    scene = _free_field(RATE_HZ)
    errors, late_us = [], []
    for k in np.flatnonzero(~keep)[::5]:
        heard = _heard(scene, _towards(*angles[k]), half)
        measured = file.responses[k].astype(np.float64)
        late_us.append(abs(_itd_us(heard, RATE_HZ) - _itd_us(measured, RATE_HZ)))
        errors.append(
            [
                _levels_db(heard, RATE_HZ, octave)
                - _levels_db(measured, RATE_HZ, octave)
                - about["gain_db"]
                for octave in (250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)
            ]
        )
    mean = np.abs(np.array(errors)).mean(axis=(0, 2))
    print("dB by octave", mean.round(2), "us", np.max(late_us))
    assert (mean < [0.1, 0.1, 0.1, 0.2, 0.3, 0.5]).all()
    assert np.max(late_us) < 20.0


@needs_kemar
def test_kemar_in_a_reverberant_room(shoebox: dwell.House) -> None:
    """Late sound: long waves are alike at both ears, short ones are not.

    Ears 0.26 m apart for long waves (3/2 of a head's width, Kuhn 1977) share cos(k d) of what comes
    along their axis, as late sound in this long room mostly does: 0.96 at 62.5, 0.83 at 125 Hz.
    """
    scene = dwell.AcousticScene(shoebox, rays=1000, max_duration_s=1.0)
    head = dwell.Head.from_sofa(KEMAR)
    late = []
    for seed in range(4):
        pair = scene.impulse_response((1.2, 1.5, 1.4), (4.6, 1.2, 3.3), head=head, seed=seed)
        bands = measures.binaural_metrics(pair, scene.rate_hz)["bands"]
        late.append([band["iacc_late"] for band in bands])
    coherence = np.mean(late, axis=0)
    print("IACC of late sound by octave", coherence.round(2))
    assert coherence[0] > 0.95
    assert coherence[1] > 0.82
    assert 0.5 < coherence[2] < 0.95
    assert (coherence[4:] < 0.4).all()
