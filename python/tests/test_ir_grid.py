"""``dwell ir --grid`` and ``--map``: files of other programs, resuming, pictures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import dwell
from dwell.cli import ir_grid, main
from dwell.places import random_sources, receiver_grid

HOUSE = "seed:3?home=studio"
FEW = ("--rays", "50", "--image-order", "1", "--seed", "4")
#: All that AES69-2022 makes mandatory in SingleRoomMIMOSRIR 1.0, variables with their dimensions.
MANDATORY = [
    "Conventions",
    "Version",
    "SOFAConventions",
    "SOFAConventionsVersion",
    "DataType",
    "RoomType",
    "Title",
    "DateCreated",
    "DateModified",
    "APIName",
    "APIVersion",
    "AuthorContact",
    "Organization",
    "License",
    "DatabaseName",
]
DIMENSIONS = {
    "ListenerPosition": "MC",
    "ListenerView": "IC",
    "ListenerUp": "IC",
    "ReceiverPosition": "RCI",
    "SourcePosition": "MC",
    "SourceView": "IC",
    "SourceUp": "IC",
    "EmitterPosition": "ECI",
    "Data.IR": "MRNE",
    "Data.SamplingRate": "I",
    "Data.Delay": "IRI",
}


def _grid(out: Path, *options: str) -> int:
    return main(["ir", HOUSE, "--grid", "1.5", "--out", str(out), *FEW, *options])


@pytest.fixture(scope="module")
def studio() -> dwell.House:
    return dwell.House.open(HOUSE)


def test_receivers_stand_on_a_grid_where_someone_can_stand(studio: dwell.House) -> None:
    places = receiver_grid(studio, 0.5, 1.2)
    assert len(places) > 20
    assert np.abs(places[:, [0, 2]] / 0.5 - np.round(places[:, [0, 2]] / 0.5)).max() < 1e-9
    assert len(np.unique(places, axis=0)) == len(places)
    navigation = studio.navigation()
    assert all(navigation.island(place - (0.0, 1.2, 0.0)) is not None for place in places)
    sources = random_sources(studio, 5, 1.5, seed=1)
    np.testing.assert_array_equal(sources[:2], random_sources(studio, 2, 1.5, seed=1))
    for wrong in (0.0, 11.0, float("nan")):
        with pytest.raises(dwell.ConfigError, match="spacing_m"):
            receiver_grid(studio, wrong)


def test_sofa_has_all_that_its_convention_asks_for(tmp_path: Path, studio: dwell.House) -> None:
    h5py = pytest.importorskip("h5py", reason="SOFA needs h5py")
    assert _grid(tmp_path / "out", "--sources", "2", "--ears", "--yaw-deg", "90") == 0
    (path,) = (tmp_path / "out").glob("*.sofa")
    receivers, sources = receiver_grid(studio, 1.5), random_sources(studio, 2, 1.5, seed=4)
    with h5py.File(path) as file:
        found = {key: file.attrs[key].decode() for key in MANDATORY}
        assert found["SOFAConventions"] == "SingleRoomMIMOSRIR"
        assert found["DataType"] == "FIR-E"
        assert all(found.values())
        for name, axes in DIMENSIONS.items():
            scales = [dim[0].name.removeprefix("/") for dim in file[name].dims]
            assert "".join(scales) == axes, name
            assert file[name].dtype == np.float64
        for name in ("ListenerPosition", "ListenerView", "SourcePosition", "SourceView"):
            assert (file[name].attrs["Type"], file[name].attrs["Units"]) == (b"cartesian", b"metre")
        assert file["Data.SamplingRate"].attrs["Units"] == b"hertz"
        assert file["Data.SamplingRate"][0] == 16_000.0
        pairs = len(sources) * len(receivers)
        assert file["Data.IR"].shape[:2] == (pairs, 2)
        # Facing -X at 90 degrees; the left ear to the left of x to the front.
        np.testing.assert_allclose(file["ListenerView"][0], (-1.0, 0.0, 0.0), atol=1e-12)
        assert file["ReceiverPosition"][0, 1, 0] > 0.0 > file["ReceiverPosition"][1, 1, 0]
        last = pairs - 1
        x, y, z = receivers[-1]
        np.testing.assert_allclose(file["ListenerPosition"][last], (x, -z, y))
        x, y, z = sources[-1]
        np.testing.assert_allclose(file["SourcePosition"][last], (x, -z, y))
        stored = file["Data.IR"][last, :, :, 0]
    scene = dwell.AcousticScene(studio, rays=50, image_order=1)
    head = dwell.Receiver.binaural(receivers[-1], yaw_deg=90.0)
    response = scene.impulse_responses(sources[-1], [head], seed=4)[0]
    np.testing.assert_array_equal(stored[:, : response.shape[1]], response)
    assert not stored[:, response.shape[1] :].any()


def test_other_programs_read_sofa(tmp_path: Path) -> None:
    pytest.importorskip("h5py", reason="SOFA needs h5py")
    sofar = pytest.importorskip("sofar", reason="reads SOFA as others do; needs sofar")
    assert _grid(tmp_path / "out") == 0
    (path,) = (tmp_path / "out").glob("*.sofa")
    found = sofar.read_sofa(str(path), verify=True, verbose=False)
    assert found.GLOBAL_SOFAConventions == "SingleRoomMIMOSRIR"
    assert found.Data_IR.ndim == 4


def test_hdf5_holds_responses_by_source_and_receiver(tmp_path: Path, studio: dwell.House) -> None:
    h5py = pytest.importorskip("h5py", reason="HDF5 needs h5py")
    assert _grid(tmp_path / "out", "--format", "hdf5", "--sources", "2") == 0
    (path,) = (tmp_path / "out").glob("*.h5")
    receivers = receiver_grid(studio, 1.5)
    with h5py.File(path) as file:
        assert file["ir"].shape[:3] == (2, len(receivers), 1)
        np.testing.assert_array_equal(file["receiver"], receivers)
        assert file.attrs["rate_hz"] == 16_000
        assert json.loads(file.attrs["settings"])["rays"] == 50
        distance = np.linalg.norm(file["source"][1] - file["receiver"][0])
        first = np.flatnonzero(file["ir"][1, 0, 0])[0] / 16_000.0
        assert first > distance / 343.2 - 0.003


@pytest.mark.parametrize("options", [("--grid", "0"), ("--grid", "2", "--sources", "0")])
def test_numbers_of_a_grid_are_refused_by_the_name_of_the_option(
    options: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["ir", HOUSE, *options, "--out", str(tmp_path / "out")]) == 1
    assert f"{options[-2]} is " in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_two_processes_do_not_write_one_file(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    with (
        ir_grid._alone(path),
        pytest.raises(ValueError, match="is being written by another process"),
        ir_grid._alone(path),
    ):
        pass
    with ir_grid._alone(path):
        pass
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_a_stopped_run_goes_on_and_gives_the_same_data(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    h5py = pytest.importorskip("h5py", reason="HDF5 needs h5py")
    options = ("--format", "hdf5", "--sources", "3")
    assert _grid(tmp_path / "whole", *options) == 0
    computed: list[int] = []
    compute = ir_grid._source

    def stopping(*args: object) -> NDArray[np.float32]:
        if len(computed) == 2:
            raise KeyboardInterrupt
        computed.append(0)
        return compute(*args)  # type: ignore[arg-type] # what the command gives

    monkeypatch.setattr(ir_grid, "_source", stopping)
    out = tmp_path / "stopped"
    assert _grid(out, *options) == 130
    assert not list(out.glob("*.h5"))
    (parts,) = out.glob(".*.parts")
    assert len(list(parts.glob("*.npy"))) == 2
    # What a killed run leaves half written has no name of its own.
    (parts / ".2.npy.half").write_bytes(b"\x93NUMPY")
    again: list[int] = []

    def counting(*args: object) -> NDArray[np.float32]:
        again.append(0)
        return compute(*args)  # type: ignore[arg-type] # what the command gives

    monkeypatch.setattr(ir_grid, "_source", counting)
    assert _grid(out, *options) == 0
    assert len(again) == 1
    assert not list(out.glob(".*"))
    (a,), (b,) = (tmp_path / "whole").glob("*.h5"), out.glob("*.h5")
    with h5py.File(a) as whole, h5py.File(b) as resumed:
        for name in ("ir", "source", "receiver"):
            assert whole[name][()].tobytes() == resumed[name][()].tobytes()
    assert _grid(out, *options) == 0
    assert len(again) == 1
    assert _grid(out, "--format", "hdf5", "--sources", "4") == 1


@pytest.mark.parametrize("form", ["sofa", "hdf5"])
def test_a_file_of_a_house_that_has_changed_is_made_again(tmp_path: Path, form: str) -> None:
    pytest.importorskip("h5py", reason="both need h5py")
    house, out = tmp_path / "a.dwell", tmp_path / "out"
    options = ["--grid", "3", "--format", form, "--out", str(out), *FEW]
    command = ["ir", str(house), *options]
    for name, makes in ((HOUSE, True), (HOUSE, False), ("seed:5?home=studio", True)):
        dwell.House.open(name).write(house, "dwell")
        before = [path.read_bytes() for path in out.glob("*.*")]
        assert main(command) == 0
        assert ([path.read_bytes() for path in out.glob("*.*")] != before) is makes


def test_without_the_extra_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    assert _grid(tmp_path / "out") == 1
    assert "pip install 'dwell[hdf5]'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_maps_and_plots_are_pictures(
    tmp_path: Path, studio: dwell.House, capsys: pytest.CaptureFixture[str]
) -> None:
    source = ",".join(f"{v:.2f}" for v in random_sources(studio, 1)[0])
    mic = ",".join(f"{v:.2f}" for v in receiver_grid(studio, 1.0)[0])
    out = tmp_path / "map.png"
    common = ("--source", source, *FEW, "--width", "300", "--json")
    assert main(["ir", HOUSE, "--map", "level", "--grid", "1", "--out", str(out), *common]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["lowest"] <= told["median"] <= told["highest"] < 12.0
    with Image.open(out) as picture:
        assert (picture.width, picture.height) == (told["width"], told["height"])
    for kind in ("decay", "directions"):
        jpg = tmp_path / f"{kind}.jpg"
        assert main(["ir", HOUSE, "--plot", kind, "--mic", mic, "--out", str(jpg), *common]) == 0
        with Image.open(jpg) as picture:
            assert picture.format == "JPEG"
    assert main(["ir", HOUSE, "--map", "t30", "--out", str(tmp_path / "x.txt"), *common]) == 1


def test_points_are_microphones_and_what_is_none_is_refused_by_name() -> None:
    scene = dwell.AcousticScene("builtin:studio", rays=100)
    (point,) = scene.impulse_responses((1.0, 1.0, 1.0), [(2.0, 1.0, 2.0)])
    omni = dwell.Receiver.omni((2.0, 1.0, 2.0))
    (receiver,) = scene.impulse_responses((1.0, 1.0, 1.0), [omni])
    assert (point == receiver).all()
    wrong: list[Any] = [None, 5, "abc"]
    for given in wrong:
        with pytest.raises(dwell.ConfigError, match="receivers is"):
            scene.impulse_responses((1.0, 1.0, 1.0), given)
        with pytest.raises(dwell.ConfigError, match="mics is"):
            scene.metrics_at((1.0, 1.0, 1.0), given)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--grid", "1.5", "--height", "9"), "height_m is 9"),
        (("--grid", "1.5", "--image-order", "9"), "image_order"),
    ],
)
def test_what_cannot_be_asked_for_begins_no_folder(
    options: tuple[str, ...], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["ir", HOUSE, "--out", str(out), *FEW, *options]) == 1
    assert told in capsys.readouterr().err
    assert not out.exists()
    out.mkdir()
    (out / "letter").write_text("dear")
    assert main(["ir", HOUSE, "--out", str(out), *FEW, *options]) == 1
    assert "holds something else" in capsys.readouterr().err


@pytest.mark.long
@pytest.mark.parametrize("form", ["hdf5", "sofa"])
def test_a_finished_file_that_was_cut_is_made_again(tmp_path: Path, form: str) -> None:
    pytest.importorskip("h5py", reason="HDF5 needs h5py")
    assert _grid(tmp_path, "--format", form) == 0
    (path,) = [*tmp_path.glob("*.h5"), *tmp_path.glob("*.sofa")]
    whole, changed_ns = path.stat().st_size, path.stat().st_mtime_ns
    assert _grid(tmp_path, "--format", form) == 0
    assert path.stat().st_mtime_ns == changed_ns
    for length in (whole // 2, 50, 0):
        with path.open("r+b") as file:
            file.truncate(length)
        assert _grid(tmp_path, "--format", form) == 0
        assert path.stat().st_size == whole
