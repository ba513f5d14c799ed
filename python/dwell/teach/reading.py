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

from dwell.files import lines, open_file, parse_json, read_json
from dwell.sounds import read_wav
from dwell.teach.dataset import MANIFEST
from dwell.teach.writer import LABEL


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
            OSError: There are none.
        """
        array = self.folder / f"{camera}.npz"
        if array.exists():
            with np.load(array, allow_pickle=False) as kept:
                found: NDArray[np.uint8] = kept[channel]
                return found
        folder = self.folder / camera / channel
        files = [folder / name for name in sorted(os.listdir(folder))]
        return np.stack([_pixels(file) for file in files])

    def mask(self, camera: str, key_frame: int) -> NDArray[np.uint8]:
        """The mask of a camera at a key frame, by its place among them: (height, width)."""
        view = self.label["key_frames"][key_frame]["views"][camera]
        return _pixels(self.folder / view["mask"])

    def sound(self) -> tuple[NDArray[np.float32], int]:
        """The sound at the robot's ears, (2, sample) in Pa, and the samples a second."""
        audio = self.label["audio"]
        return read_wav(self.folder / audio["file"], full_scale_pa=audio["full_scale_pa"])


def recorded_clips(folder: str | os.PathLike[str]) -> Iterator[RecordedClip]:
    """The clips of a recording that is whole, in the order in which they were played.

    Raises:
        OSError: There is no recording, or it is not finished: its list of clips comes last.
    """
    manifest = Path(folder) / MANIFEST
    with open_file(manifest) as file:
        for number, line in enumerate(lines(file, manifest), start=1):
            row = parse_json(line, f"{manifest} line {number}")
            place = Path(folder) / row["folder"]
            yield RecordedClip(place, read_json(place / LABEL))


def _pixels(file: Path) -> NDArray[Any]:
    with Image.open(file) as picture:
        return np.asarray(picture)
