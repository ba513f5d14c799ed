"""Data sets of recordings that were damaged, forged, or made of odd sounds."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.localization.dataset import DatasetMaker
from dwell.localization.labels import Label, read_labels, write_labels
from dwell.localization.measures import JointMeasures
from dwell.localization.pool import Pool
from dwell.localization.settings import Settings
from dwell.sounds import write_wav

Command = Callable[..., subprocess.CompletedProcess[str]]
SETTINGS = Settings(
    duration_s=1.0, rate_hz=16_000, max_sources=1, arrays=("foa",), parts=True, responses=True
)
BASELINE = ("--baseline", "srp_phat")


def maker() -> DatasetMaker:
    return DatasetMaker(["shoebox:0..1"], SETTINGS, count=2)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("whole") / "data"
    assert [is_new for _, is_new in maker().make(out)] == [True, True]
    # As the command writes it.
    (out / "dataset.json").write_text(json.dumps(maker().to_json()))
    return out


@pytest.fixture
def data(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "data"))


def files(folder: Path) -> dict[str, bytes]:
    return {
        os.fspath(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.mark.parametrize(
    "kind", ["foa_dev/*/*", "foa_dev_parts/*_late", "foa_dev_responses/*", "metadata_dev/*/*"]
)
def test_a_file_that_is_missing_is_made_again(whole: Path, data: Path, kind: str) -> None:
    lost = next(path for path in sorted(data.glob(f"{kind}.*")) if path.suffix in (".wav", ".csv"))
    lost.unlink()
    assert sorted(is_new for _, is_new in maker().make(data)) == [False, True]
    assert files(data) == files(whole)


def test_files_that_were_cut_are_made_again(whole: Path, data: Path) -> None:
    sound = next(iter(sorted(data.glob("foa_dev/*/*.wav"))))
    sound.write_bytes(sound.read_bytes()[:1_000])
    details = sorted(data.glob("details_dev/*/*.json"))[1]
    details.write_text(details.read_text()[:100])
    assert [is_new for _, is_new in maker().make(data)] == [True, True]
    assert files(data) == files(whole)


def edited(data: Path, **fields: object) -> Path:
    """Changes details of the first clip; ``record_NAME``: of its recording."""
    path = sorted(data.glob("details_dev/*/*.json"))[0]
    details: dict[str, Any] = json.loads(path.read_text())
    for name, value in fields.items():
        of, _, field = name.partition("_")
        if of == "record":
            details["recordings"]["foa"][field] = value
        else:
            details[name] = value
    path.write_text(json.dumps(details))
    return path


@pytest.mark.parametrize(
    ("field", "value", "told"),
    [
        ("sources", [], "sources has 1 rows; the clip has 0"),
        ("sources", 5, "sources is 5; expected a list with a row for each source"),
        ("sources", [5], "sources[0] is 5; expected values by name"),
        ("recordings", None, "recordings is None; expected values by name"),
        ("room", "a", "room is 'a'; expected values by name"),
        ("room", {"t20_s": "x"}, "room.t20_s is 'x'; expected a number"),
        ("snr_db", {}, "snr_db is {}; expected a number"),
        ("rate_hz", "x", "rate_hz is 'x'; allowed are whole numbers from 0"),
        ("record_full_scale_pa", "x", "recordings.foa.full_scale_pa is 'x'; expected a number"),
        ("record_full_scale_pa", 0, "full_scale_pa is 0; allowed are numbers above 0"),
        ("record_sources", [{"drr_db": "x"}], "sources[0].drr_db is 'x'; expected a number"),
        ("record_file", 5, "recordings.foa.file is 5; expected text"),
        ("record_file", "/etc/hostname", "allowed are paths within the folder"),
        ("record_file", "../foa.wav", "allowed are paths within the folder"),
    ],
)  # fmt: skip
def test_details_are_checked(
    data: Path, command: Command, field: str, value: object, told: str
) -> None:
    path = edited(data, **{field: value})
    ran = command("localize", "score", data, *BASELINE)
    assert path.name in ran.stderr
    assert told in ran.stderr
    assert "a bug of dwell" not in ran.stderr


def rewritten(data: Path, sound: np.ndarray[Any, Any], rate_hz: int) -> None:
    write_wav(sorted(data.glob("foa_dev/*/*.wav"))[0], sound, rate_hz, full_scale_pa=1.0)


def test_recordings_are_as_long_and_as_fast_as_labels_and_details_say(
    data: Path, command: Command
) -> None:
    rewritten(data, np.ones((4, 16_000)), 7)
    ran = command("localize", "score", data, *BASELINE)
    assert "7 samples a second; allowed are 16000" in ran.stderr
    rewritten(data, np.ones((4, 0)), 16_000)
    ran = command("localize", "score", data, *BASELINE)
    assert "has 0 frames of 100 ms, counted from 0; its labels name frame" in ran.stderr


def test_samples_that_are_no_numbers_are_told_by_their_file(data: Path, command: Command) -> None:
    path = sorted(data.glob("foa_dev/*/*.wav"))[0]
    write_wav(path, np.ones((4, 16_000)), 16_000)
    whole = path.read_bytes()
    path.write_bytes(whole[:-4] + struct.pack("<f", math.nan))
    ran = command("localize", "score", data, *BASELINE)
    assert f"{path.name}: sample 15999 of channel 3 is nan; allowed are finite" in ran.stderr
    assert "Warning" not in ran.stderr


def test_labels_name_sources_and_frames_that_are_there(data: Path, command: Command) -> None:
    labels = sorted(data.glob("metadata_dev/*/*.csv"))[0]
    labels.write_text("0,3,9,0,0,100\n")
    ran = command("localize", "score", data, *BASELINE)
    assert f"{labels.name} line 1: source is 9; there are 1, counted from 0" in ran.stderr
    labels.write_text("0,3,0,0,0,100\n0,99,0,0,0,100\n")
    ran = command("localize", "score", data, *BASELINE)
    assert f"{labels.name} line 2: class is 99; there are 12, counted from 0" in ran.stderr
    (data / "dataset.json").write_text('{"classes": 5}')
    ran = command("localize", "score", data, *BASELINE)
    assert "dataset.json: classes is 5; expected a list of text" in ran.stderr
    (data / "dataset.json").unlink()
    labels.write_text("0,0,0,0,0,0\n" * 200)
    ran = command("localize", "score", data, *BASELINE)
    assert f"{labels.name} line 101: more than 100 rows of class 0 in frame 0" in ran.stderr
    labels.write_text("999999,3,0,0,0,100\n")
    ran = command("localize", "score", data, *BASELINE)
    assert "has 10 frames of 100 ms, counted from 0; its labels name frame 999999" in ran.stderr


def test_the_option_of_a_wrong_name_is_told(data: Path, command: Command) -> None:
    ran = command("localize", "score", data, *BASELINE, "--plot", "x.tiff")
    assert "--plot is 'x.tiff'; expected the name of a .png file" in ran.stderr


def test_sound_files_have_a_rate_and_a_length_that_memory_holds(tmp_path: Path) -> None:
    sound = tmp_path / "dog" / "a.wav"
    write_wav(sound, np.ones((1, 16_000)), 1)
    with pytest.raises(dwell.ConfigError, match=r"a\.wav: 1 samples a second; allowed are 1000 to"):
        Pool(os.fspath(tmp_path))
    write_wav(sound, np.ones((1, 400_000)), 1_000)
    with pytest.raises(dwell.ConfigError, match=r"a\.wav: 400 s long; allowed are 300 s: cut it"):
        Pool(os.fspath(tmp_path))
    content = bytearray(sound.read_bytes())
    content[24:28] = struct.pack("<I", 0)
    sound.write_bytes(content)
    with pytest.raises(dwell.MeasuredDataError, match=r"a\.wav: its head says 0 samples a second"):
        Pool(os.fspath(tmp_path))


def test_a_slip_in_houses_begins_no_folder(tmp_path: Path, command: Command) -> None:
    out = tmp_path / "data"
    options = ("--count", "1", "--duration-s", "1", "--rate-hz", "16000", "--out", out)
    for slip, told in [
        ("shoebox:a..b", "houses: found 'shoebox:a..b'; allowed are shoebox:N and shoebox:A..B"),
        ("bultin:studio", "is no house this version opens"),
    ]:
        ran = command("localize", "make", slip, *options)
        assert told in ran.stderr
        assert not out.exists()
    command("localize", "make", "shoebox:0", *options)


def test_shards_have_a_limit_that_is_told(tmp_path: Path, command: Command) -> None:
    options = ("--count", "1", "--out", tmp_path / "data", "--shard", "0/1000000")
    ran = command("localize", "make", "shoebox:0", *options)
    assert ran.returncode == 2
    assert "expected K/N with K below N, whole numbers up to 99999, found '0/1000000'" in ran.stderr


def test_a_frame_has_no_more_rows_of_a_class_than_can_be_paired(
    whole: Path, tmp_path: Path, command: Command
) -> None:
    for labels in whole.glob("metadata_dev/*/*.csv"):
        (tmp_path / labels.name).write_text("0,0,0,0,0,100\n" * 101)
    ran = command("localize", "score", whole, "--estimates", tmp_path)
    assert ran.returncode == 1
    assert ".csv line 101: more than 100 rows of class 0 in frame 0; allowed are 100" in ran.stderr
    for labels in whole.glob("metadata_dev/*/*.csv"):
        (tmp_path / labels.name).write_text("0,12,0,0,0,100\n")
    ran = command("localize", "score", whole, "--estimates", tmp_path)
    assert ".csv line 1: class is 12; there are 12, counted from 0" in ran.stderr


@pytest.mark.parametrize(
    ("row", "told"),
    [
        (f"{2**31},0,0,10,0", f"frame is {2**31}; allowed are whole numbers from 0 to {2**31 - 1}"),
        (f"0,{2**31},0,10,0", f"class is {2**31}; allowed are whole numbers from 0 to {2**31 - 1}"),
        (f"0,0,{10**12},10,0", f"source is {10**12}; allowed are whole numbers from 0 to 2147"),
        ("0,0,-1,10,0", "source is -1; allowed are whole numbers from 0 to 2147483647"),
        ("0,0,0,10,0,1e10", "distance 1e+10; allowed are 0 to 1e+09 cm"),
    ],
)
def test_a_number_of_a_row_beyond_the_largest_is_told_with_what_is_allowed(
    tmp_path: Path, row: str, told: str
) -> None:
    path = tmp_path / "x.csv"
    path.write_text(f"{2**31 - 1},{2**31 - 1},{2**31 - 1},10,0\n{row}\n")
    with pytest.raises(dwell.ConfigError, match=re.escape(f"x.csv line 2: {told}")):
        read_labels(path)


def test_what_can_be_written_can_be_read_again(tmp_path: Path) -> None:
    most = 2**31 - 1
    rows = [Label(most, most, most, -360.0, 90.0, 1e7)]
    write_labels(tmp_path / "x.csv", rows)
    assert read_labels(tmp_path / "x.csv") == rows


@pytest.mark.parametrize("name", ["arrays", "held_out_arrays"])
@pytest.mark.parametrize(
    ("value", "told"),
    [
        (5, " is 5; expected a list of text"),
        ("foa", " is 'foa'; expected a list of text"),
        (np.zeros(3), "[0] is np.float64(0.0); expected text"),
        (np.zeros(()), " is array(0.); expected a list of text"),
        ([["foa"]], "[0] is ['foa']; expected text"),
    ],
)
def test_arrays_are_a_list_of_text(name: str, value: Any, told: str) -> None:  # noqa: ANN401
    with pytest.raises(dwell.ConfigError, match=re.escape(f"{name}{told}")):
        Settings(**{name: value})
    assert Settings(arrays=["foa"]) == Settings(arrays=("foa",))  # type: ignore[arg-type]


ODD_LABELS = [
    (None, "is None; expected labels"),
    ([1], "[0] is 1; expected a Label"),
    ([Label(-1, 0, 0, 0.0, 0.0)], "[0].frame is -1; allowed are whole numbers"),
    ([Label(0, 0, 0, math.nan, 0.0)], "[0].azimuth_deg is nan; allowed are finite numbers"),
    ([Label(0, 0, 0, 0.0, 91.0)], "[0].elevation_deg is 91; allowed are -90 to 90 degrees"),
    ([Label(0, 0, 0, 0.0, 0.0, -1.0)], "[0].distance_m is -1; allowed are 0 to 1e+07 m"),
]


@pytest.mark.parametrize(("labels", "told"), ODD_LABELS)
def test_labels_are_checked(tmp_path: Path, labels: Any, told: str) -> None:  # noqa: ANN401
    with pytest.raises(dwell.ConfigError, match=f"estimate ?{re.escape(told)}"):
        JointMeasures().add([], labels)
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        write_labels(tmp_path / "x.csv", labels)
    assert not (tmp_path / "x.csv").exists()


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"houses": 5}, "houses is 5; expected a list of text"),
        ({"settings": None}, "settings is None; expected Settings"),
        ({"shard": 5}, "shard is 5; expected two whole numbers"),
        ({"shard": (1,)}, "shard is (1,); expected two whole numbers"),
        ({"shard": (0, 0)}, "shard[1] is 0; allowed are whole numbers from 1"),
        ({"shard": (2, 1)}, "shard[0] is 2; allowed are whole numbers from 0 to 0"),
        ({"shard": (-1, 2)}, "shard[0] is -1; allowed are whole numbers from 0 to 1"),
    ],
)
def test_what_a_maker_is_told_is_checked(fields: dict[str, Any], told: str) -> None:
    arguments: dict[str, Any] = {"houses": "shoebox:0", "settings": SETTINGS, "count": 2, **fields}
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        DatasetMaker(**arguments)


def test_classes_are_a_list() -> None:
    with pytest.raises(dwell.ConfigError, match="classes is 5; expected classes"):
        JointMeasures(classes=5)  # type: ignore[arg-type] # on purpose


def test_paths_are_text_or_paths(tmp_path: Path) -> None:
    assert [is_new for _, is_new in maker().make(str(tmp_path / "data"))] == [True, True]
    number: Any = 5
    for call in (lambda: [*maker().make(number)], lambda: write_labels(number, []),
                 lambda: read_labels(number)):  # fmt: skip
        with pytest.raises(dwell.ConfigError, match="is 5; expected text or a path"):
            call()
