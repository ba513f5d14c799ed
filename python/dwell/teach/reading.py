"""Recordings read back."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from dwell import ConfigError, MeasuredDataError
from dwell.arguments import above_zero, choice, file_path, inner_path, mapping
from dwell.files import lines, open_file, parse_json, read_json
from dwell.sounds import read_wav
from dwell.teach.cameras import MOUNTS
from dwell.teach.dataset import MANIFEST
from dwell.teach.writer import FORMAT, LABEL

#: A picture's file has at most so many bytes, as for the readers of houses.
_MAX_PICTURE_BYTES = 64 * 2**20


@dataclasses.dataclass(frozen=True)
class RecordedClip:
    """A clip in a folder.

    Attributes:
        folder: Where its files are.
        label: What is known of it; ``docs/teach.md`` lists the fields.
    """

    folder: Path
    label: dict[str, Any]

    def pictures(
        self, camera: str, channel: Literal["rgb", "depth"] = "rgb"
    ) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """The pictures of a camera: (frame, height, width, 3) uint8, or depth in mm, uint16.

        Raises:
            ConfigError: There is no such camera or channel.
            MeasuredDataError: A file is no picture, or one of another size than others.
            OSError: There are none, or the system refuses.
        """
        mount = {one.name: one for one in MOUNTS}[
            choice("camera", camera, [m.name for m in MOUNTS])
        ]
        choice("channel", channel, ("rgb", "depth") if mount.has_depth else ("rgb",))
        array = self.folder / f"{camera}.npz"
        if array.exists():
            return _stored(array, channel)
        folder = self.folder / camera / channel
        pictures = [_pixels(folder / name) for name in sorted(os.listdir(folder))]
        shapes = {picture.shape for picture in pictures}
        if len(shapes) != 1:
            raise MeasuredDataError(f"{folder}: pictures of {len(shapes)} sizes; expected one")
        return np.stack(pictures)

    def mask(self, camera: str, key_frame: int) -> NDArray[np.uint8]:
        """The mask of a camera at a key frame, by its place among them: (height, width)."""
        at = f"{self.folder / LABEL}: key_frames[{key_frame}].views.{camera}.mask"
        try:
            file = self.label["key_frames"][key_frame]["views"][camera]["mask"]
        except (LookupError, TypeError):
            raise ConfigError(f"{at}: there is none") from None
        return _pixels(self.folder / inner_path(at, file))

    def sound(self) -> tuple[NDArray[np.float32], int]:
        """The sound at the robot's ears, (2, sample) in Pa, and the samples a second."""
        at = f"{self.folder / LABEL}: audio"
        audio = mapping(at, self.label.get("audio"))
        full_scale_pa = above_zero(f"{at}.full_scale_pa", audio.get("full_scale_pa"))
        file = inner_path(f"{at}.file", audio.get("file"))
        return read_wav(self.folder / file, full_scale_pa=full_scale_pa)


def recorded_clips(folder: str | os.PathLike[str]) -> Iterator[RecordedClip]:
    """The clips of a recording that is whole, in the order in which they were played.

    Raises:
        ConfigError: A file names a folder outside of the recording, or is none of a recording.
        ValueError: A file is no JSON; the message names it.
        OSError: There is no recording, or it is not finished: its list of clips comes last.
    """
    whole = Path(file_path("folder", folder))
    manifest = whole / MANIFEST
    with open_file(manifest) as file:
        for number, line in enumerate(lines(file, manifest), start=1):
            at = f"{manifest} line {number}"
            row = mapping(at, parse_json(line, at))
            place = whole / inner_path(f"{at}: folder", row.get("folder"))
            label = mapping(str(place / LABEL), read_json(place / LABEL))
            if label.get("format") != FORMAT:
                raise ConfigError(f"{place / LABEL}: format: no label of a clip ({FORMAT})")
            yield RecordedClip(place, label)


def _pixels(file: Path) -> NDArray[Any]:
    with open_file(file, _MAX_PICTURE_BYTES) as content:
        try:
            with Image.open(content) as picture:
                return np.asarray(picture)
        # Of a picture that was damaged Pillow raises what its decoders do.
        except Exception as error:
            raise MeasuredDataError(f"{file}: no picture: {error}") from None


def _stored(file: Path, channel: str) -> NDArray[Any]:
    with open_file(file) as content:
        try:
            with np.load(content, allow_pickle=False) as kept:
                found: NDArray[Any] = kept[channel]
                return found
        except Exception as error:
            raise MeasuredDataError(f"{file}: no pictures of {channel}: {error}") from None
