"""Recordings of a person who teaches that were changed by strangers, and odd arguments."""

from __future__ import annotations

import json
import os
import re
import shutil
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import dwell
from dwell.teach import RecordedClip, TeachSettings, record, recorded_clips

SMALL = TeachSettings(users=1, clips=3, seed=5, fps=1, width=32)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("teach") / "out"
    record(out, SMALL)
    return out


@pytest.fixture
def folder(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "out"))


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ([1], "manifest.jsonl line 1 is [1]; expected values by name"),
        (5, "manifest.jsonl line 1 is 5; expected values by name"),
        ({}, "manifest.jsonl line 1: folder is None; expected text or a path"),
        ({"folder": "../../etc"}, "folder is '../../etc'; allowed are paths within the folder"),
        ({"folder": "/etc"}, "folder is '/etc'; allowed are paths within the folder"),
        ({"folder": "a\0b"}, "a path holds no NUL"),
    ],
)
def test_a_list_of_clips_names_folders_in_the_recording(
    folder: Path, row: object, told: str
) -> None:
    (folder / "manifest.jsonl").write_text(json.dumps(row) + "\n")
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        [*recorded_clips(folder)]


def first(folder: Path) -> RecordedClip:
    return next(iter(recorded_clips(folder)))


@pytest.mark.parametrize(
    ("label", "told"),
    [("[]", "label.json is []; expected values by name"), ("{}", "format: no label of a clip")],
)
def test_a_label_that_is_none_is_told(folder: Path, label: str, told: str) -> None:
    (first(folder).folder / "label.json").write_text(label)
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        first(folder)


def test_files_that_labels_name_are_in_the_clip(folder: Path) -> None:
    clip = first(folder)
    clip.label["audio"]["file"] = "/dev/zero"
    clip.label["key_frames"][0]["views"]["hd"]["mask"] = "../../../secret.png"
    for call in (clip.sound, lambda: clip.mask("hd", 0)):
        with pytest.raises(dwell.ConfigError, match="allowed are paths within the folder"):
            call()
    clip.label["audio"] = 5
    with pytest.raises(dwell.ConfigError, match="audio is 5; expected values by name"):
        clip.sound()
    with pytest.raises(dwell.ConfigError, match="there is none"):
        clip.mask("hd", 99)


def png(width: int, height: int) -> bytes:
    """A picture whose header is whole, and whose pixels are cut."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        crc = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", crc)

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    pixels = zlib.compress(b"\0" * 100)
    chunks = chunk(b"IHDR", head) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


def small(file: Path) -> None:
    file.write_bytes(file.parent.joinpath("000001.png").read_bytes()[:60])


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda file: file.write_bytes(b""), "no picture"),
        (small, "no picture"),
        (lambda file: file.write_bytes(png(60_000, 60_000)), "no picture: Image size"),
        (lambda file: shutil.copy(next(file.parents[2].glob("hd/rgb/*")), file), "of 2 sizes"),
    ],
)
def test_a_picture_that_is_none_is_told(
    folder: Path, damage: Callable[[Path], object], told: str
) -> None:
    clip = first(folder)
    damage(clip.folder / "kinect_front" / "rgb" / "000000.png")
    with pytest.raises(dwell.MeasuredDataError, match=told):
        clip.pictures("kinect_front")


def test_a_picture_is_a_regular_file(folder: Path) -> None:
    clip = first(folder)
    file = clip.folder / "kinect_front" / "rgb" / "000000.png"
    file.unlink()
    os.mkfifo(file)
    with pytest.raises(OSError, match="is a named pipe, not a regular file"):
        clip.pictures("kinect_front")


def test_arrays_that_are_none_are_told(folder: Path) -> None:
    clip = first(folder)
    (clip.folder / "hd.npz").write_bytes(b"PK\x03\x04" + b"\0" * 100)
    with pytest.raises(dwell.MeasuredDataError, match=r"hd\.npz: no pictures of rgb"):
        clip.pictures("hd")


def test_cameras_and_channels_are_those_of_the_recording(folder: Path) -> None:
    clip = first(folder)
    camera: Any
    for camera in ("nope", "../x", 5):
        with pytest.raises(dwell.ConfigError, match="allowed are kinect_front, kinect_top, hd"):
            clip.pictures(camera)
    with pytest.raises(dwell.ConfigError, match="channel is 'depth'; allowed are rgb"):
        clip.pictures("hd", "depth")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((5,), "out is 5; expected text or a path"),
        (("",), "out is ''; expected the path of a file or folder"),
        (("a\0b",), "a path holds no NUL"),
        (("x", {"users": 1}), "settings is {'users': 1}; expected TeachSettings"),
    ],
)
def test_arguments_are_checked(arguments: tuple[Any, ...], told: str) -> None:
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        record(*arguments)
