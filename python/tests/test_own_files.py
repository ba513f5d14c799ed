"""Files of the user's own that the system refuses are the ``OSError`` that Python raises."""

from __future__ import annotations

import errno
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import dwell
from dwell.calibration import write_example
from dwell.sounds import read_wav, write_wav

READERS: dict[str, Callable[[Path], object]] = {
    "replay": dwell.Replay.read,
    "wav": read_wav,
    "laws": lambda path: dwell.World("builtin:studio", laws=path / "found.json"),
    "peers": lambda path: dwell.calibrate("x.measured", peers=[path]),
}


@pytest.mark.parametrize("reader", READERS)
def test_a_file_that_is_not_there_is_told_by_its_number(reader: str, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere") as caught:
        READERS[reader](tmp_path / "nowhere")
    assert caught.value.errno == errno.ENOENT


def test_an_example_is_not_written_over_a_file(tmp_path: Path) -> None:
    file = tmp_path / "a.measured"
    file.write_text("mine")
    with pytest.raises(NotADirectoryError, match=r"a\.measured"):
        write_example(file)
    assert file.read_text() == "mine"


def test_a_sound_that_cannot_be_read_is_no_house(tmp_path: Path) -> None:
    world = dwell.World("builtin:studio", sound_root=str(tmp_path))
    before = world.state_hash()
    with pytest.raises(FileNotFoundError, match=r"nope\.wav") as caught:
        world.play("nope.wav", at=(1.0, 1.0, 1.0), level_db=60.0)
    assert caught.value.errno == errno.ENOENT
    assert not isinstance(caught.value, dwell.DwellError)
    with pytest.raises(dwell.ConfigError, match=r"\.\./a\.wav"):
        world.play("../a.wav", at=(1.0, 1.0, 1.0), level_db=60.0)
    assert world.state_hash() == before


@pytest.mark.parametrize("scale", [None, 1.0])
def test_a_sound_file_that_was_cut_is_refused(tmp_path: Path, scale: float | None) -> None:
    path = tmp_path / "a.wav"
    write_wav(path, np.zeros((2, 50)), 16_000, full_scale_pa=scale)
    whole = path.read_bytes()
    bytes_in_all = 400 if scale is None else 200
    for cut in (1, 100, bytes_in_all):
        path.write_bytes(whole[:-cut])
        said = f"'data' has {bytes_in_all - cut} bytes, and its header says {bytes_in_all}:"
        with pytest.raises(dwell.MeasuredDataError, match=said):
            read_wav(path)
    # What follows the samples is not read.
    path.write_bytes(whole + b"LIST\xff\xff\0\0x")
    assert read_wav(path)[0].shape == (2, 50)
