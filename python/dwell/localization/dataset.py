"""Data sets of recordings with labels, in folders as the DCASE challenge has them.

A clip comes from the data set's seed, its house and its number alone: it is the same in whatever
shard it is made, whatever was made before, and on however many processors.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, DwellError
from dwell.arguments import file_path, integer_in_range, part_of_parts, quoted, text_list
from dwell.files import atomic_write
from dwell.listening import Point
from dwell.localization.clip_facts import read_details
from dwell.localization.draws import Draws
from dwell.localization.labels import FRAME_S, Label, angles_deg, write_labels
from dwell.localization.layouts import Layout
from dwell.localization.noise import diffuse_noise
from dwell.localization.pool import Pool
from dwell.localization.rendering import Recording, Renderer
from dwell.localization.rooms import OpenHouse, house_list
from dwell.localization.scenes import SPEED_M_S, Scene, draw_scene
from dwell.localization.settings import Settings
from dwell.localization.trajectory import seen_from
from dwell.sounds import is_whole_wav, write_wav

#: What may be added to a clip's name.
_PARTS = ("direct", "early", "late", "noise")
#: Octaves whose mean stands for a room (ISO 3382-1:2009, table A.1), Hz.
_MIDDLE_HZ = (500.0, 1000.0)


def labels_of(scene: Scene, settings: Settings) -> list[Label]:
    """A row for each frame during at least half of which a source's direct sound arrives.

    It says where the source is in the middle of the frame.
    """
    frames = int(settings.duration_s / FRAME_S + 1e-9)
    middles = (np.arange(frames, dtype=np.float64) + 0.5) * FRAME_S
    rows = []
    for number, source in enumerate(scene.sources):
        seen = seen_from(scene.listener, source.way, middles)
        away = np.linalg.norm(seen, axis=1)
        begin = source.onset / settings.rate_hz + away / SPEED_M_S
        end = begin + source.samples / settings.rate_hz
        heard_s = np.minimum(end, middles + 0.5 * FRAME_S) - np.maximum(
            begin, middles - 0.5 * FRAME_S
        )
        for frame in np.flatnonzero(heard_s >= 0.5 * FRAME_S - 1e-9):
            azimuth, elevation = angles_deg(seen[frame])
            row = (int(frame), source.sound.class_index, number, azimuth, elevation)
            rows.append(Label(*row, float(away[frame])))
    return sorted(rows, key=lambda row: (row.frame, row.source))


class DatasetMaker:
    """Makes a data set, or a shard of it."""

    def __init__(
        self,
        houses: str | Sequence[str],
        settings: Settings,
        *,
        count: int,
        shard: tuple[int, int] = (0, 1),
    ) -> None:
        """Lists the clips.

        Args:
            houses: HOUSES strings, and ``shoebox:A..B``: empty rooms of drawn sizes.
            settings: How clips are made.
            count: Clips of the whole data set, spread evenly over the houses in order.
            shard: Which of how many parts, from 0.

        Raises:
            ConfigError: There is no house, or no clip for this shard.
            MeasuredDataError: A sound file is none.
            OSError: The system refuses to read a sound file.
        """
        if not isinstance(settings, Settings):
            raise ConfigError(f"settings is {quoted(settings)}; expected Settings")
        names = [houses] if isinstance(houses, str) else text_list("houses", houses)
        self.houses = house_list(names)
        if not self.houses:
            raise ConfigError("houses is empty; expected one or more HOUSE strings")
        self.settings = settings
        self.count = integer_in_range("count", count, low=1, high=10_000_000)
        which, shards = part_of_parts("shard", shard)
        self.clips = range(which * self.count // shards, (which + 1) * self.count // shards)
        self.pool = Pool(settings.sounds)
        self._layouts = settings.layouts()

    def to_json(self) -> dict[str, Any]:
        """What all shards have in common: what clips depend on."""
        return {
            "command": "localize make",
            "houses": len(self.houses),
            "first_house": self.houses[0],
            "last_house": self.houses[-1],
            "count": self.count,
            "classes": self.pool.classes,
            **self.settings.to_json(),
        }

    def house_number(self, clip: int) -> int:
        """In which house a clip is."""
        return clip * len(self.houses) // self.count

    def is_test(self, house: str) -> bool:
        """Whether all clips of a house are of the test part: by its name alone."""
        draws = Draws("localize split", self.settings.seed, house)
        return draws.uniform(0.0, 1.0) < self.settings.test_share

    def name_of(self, clip: int) -> str:
        """The name of a clip, as in STARSS: fold 1 is for training, fold 2 for tests."""
        house = self.house_number(clip)
        fold = 2 if self.is_test(self.houses[house]) else 1
        return f"fold{fold}_room{house:04}_mix{clip:06}"

    def part_of(self, clip: int) -> str:
        """``dev-train`` or ``dev-test``."""
        return "dev-test" if self.is_test(self.houses[self.house_number(clip)]) else "dev-train"

    def details(self, out: Path, clip: int) -> Path:
        """The file that is written last."""
        return out / "details_dev" / self.part_of(clip) / f"{self.name_of(clip)}.json"

    def is_whole(self, out: Path, clip: int) -> bool:
        """Whether all files of a clip are there, and none of them is cut.

        Raises:
            OSError: The system refuses, or something is no regular file.
        """
        details = self.details(out, clip)
        if not details.exists():
            return False
        try:
            sources = len(read_details(details)["sources"])
        except (ConfigError, TypeError):
            return False
        name, part = self.name_of(clip), self.part_of(clip)
        sounds = []
        for layout in self._recorded(is_test=part == "dev-test"):
            sounds.append(out / layout.folder / part / f"{name}.wav")
            if self.settings.parts:
                folder = out / f"{layout.folder}_parts"
                sounds += [folder / f"{name}_{one}.wav" for one in _PARTS]
            if self.settings.responses:
                folder = out / f"{layout.folder}_responses"
                sounds += [folder / f"{name}_source{k}.wav" for k in range(sources)]
        labels = out / "metadata_dev" / part / f"{name}.csv"
        return labels.exists() and all(is_whole_wav(path) for path in sounds)

    def refuse_unopenable(self) -> None:
        """Refuses HOUSES of which none can be opened, before a folder is begun for them.

        Raises:
            HouseError: None can; the message is of the first one.
            ConfigError: The same, where the houses have no place for recordings.
        """
        first: DwellError | OSError | None = None
        for name in dict.fromkeys(self.houses[self.house_number(clip)] for clip in self.clips):
            try:
                OpenHouse(name, self.settings)
            except (DwellError, OSError) as error:
                first = first or error
            else:
                return
        if first is not None:
            raise first

    def _recorded(self, *, is_test: bool) -> list[Layout]:
        """The arrays that record in a part."""
        held_out = self.settings.held_out_arrays
        named = zip(self.settings.arrays, self._layouts, strict=True)
        return [one for name, one in named if is_test or name not in held_out]

    def make(
        self,
        out: str | os.PathLike[str],
        *,
        on_skip: Callable[[str, str], None] = lambda house, why: None,
    ) -> Iterator[tuple[int, bool]]:
        """Makes the clips of the shard that are not there, or of which a file is missing or cut.

        Args:
            out: The folder.
            on_skip: Is told of a house that cannot be opened, whose clips are left out, or of a
                clip for which its house has no place; and why.

        Yields:
            The number of each clip in order, and whether it was made now.

        Raises:
            MeasuredDataError: A sound file is none any more.
            OSError: The system refuses to write, or to read a sound file.
        """
        out = Path(file_path("out", out))
        opened: OpenHouse | None = None
        bad: set[str] = set()
        for clip in self.clips:
            name = self.houses[self.house_number(clip)]
            if name in bad or self.is_whole(out, clip):
                yield clip, False
                continue
            try:
                if opened is None or opened.name != name:
                    opened = OpenHouse(name, self.settings)
            except (DwellError, OSError) as error:
                bad.add(name)
                on_skip(name, str(error))
                yield clip, False
                continue
            try:
                scene = draw_scene(opened, self.settings, self.pool, clip)
            except ConfigError as error:
                on_skip(f"clip {clip}", str(error))
                yield clip, False
                continue
            self._write(out, scene, opened)
            yield clip, True

    def _write(self, out: Path, scene: Scene, opened: OpenHouse) -> None:
        layouts = self._recorded(is_test=self.is_test(scene.house))
        recordings = Renderer(opened, self.settings, self.pool).record(scene, layouts)
        files = {}
        for recording in recordings:
            files[recording.layout.name] = self._write_one(out, scene, recording)
        name, part = self.name_of(scene.index), self.part_of(scene.index)
        path = out / "metadata_dev" / part / f"{name}.csv"
        write_labels(path, labels_of(scene, self.settings))
        told = {
            **scene.to_json(self.pool.classes),
            "rate_hz": self.settings.rate_hz,
            "recordings": files,
            "room": room_measures(scene, opened),
        }
        with atomic_write(self.details(out, scene.index)) as draft:
            draft.write_text(json.dumps(told, indent=1) + "\n", "utf-8")

    def _write_one(self, out: Path, scene: Scene, found: Recording) -> dict[str, Any]:
        """Writes what one array recorded; returns what is known of it."""
        settings, layout = self.settings, found.layout
        parts = {"direct": found.direct, "early": found.early, "late": found.late}
        signal = found.direct + found.early + found.late
        parts["noise"] = noise_of(scene, settings, layout, signal)
        clip = signal + parts["noise"]
        folder = out / layout.folder / self.part_of(scene.index)
        name = self.name_of(scene.index)
        # A power of 2, so that 16 bits of different clips have simple ratios.
        peak = max(float(np.abs(clip).max()), 1e-6)
        full_scale = None if settings.bits == 32 else float(2.0 ** np.ceil(np.log2(peak)))
        rate = settings.rate_hz
        if settings.parts:
            for part in _PARTS:
                path = out / f"{layout.folder}_parts" / f"{name}_{part}.wav"
                write_wav(path, parts[part], rate)
        if settings.responses:
            for number, ways in enumerate(found.responses):
                path = out / f"{layout.folder}_responses" / f"{name}_source{number}.wav"
                write_wav(path, _whole(ways), rate)
        write_wav(folder / f"{name}.wav", clip, rate, full_scale_pa=full_scale)
        return {
            "file": f"{layout.folder}/{self.part_of(scene.index)}/{name}.wav",
            "channels": layout.channels,
            "full_scale_pa": full_scale or 1.0,
            "sources": [
                {"drr_db": _ratio_db(direct, (early, late))}
                for direct, early, late in found.responses
            ],
        }


def noise_of(
    scene: Scene, settings: Settings, layout: Layout, signal: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Diffuse noise of the scene's ratio: the signal's mean power over that of the noise.

    The mean is over channels and over the samples in which a source sounds at its place.
    """
    sounds = np.zeros(settings.samples, bool)
    for source in scene.sources:
        sounds[source.onset : source.onset + source.samples] = True
    power = float(np.mean(signal[:, sounds] ** 2)) if sounds.any() else 0.0
    noise = diffuse_noise(layout, settings.rate_hz, settings.samples, scene.seed, layout.name)
    scaled: NDArray[np.float64] = noise * np.sqrt(power * 10.0 ** (-scene.snr_db / 10.0))
    return scaled


def room_measures(scene: Scene, opened: OpenHouse) -> dict[str, float | None]:
    """T20, EDT and C50 from the first source to the array, octaves of 500 Hz and 1 kHz."""
    first = scene.sources[0]
    x, y, z = scene.listener.points[0]
    middle: Point = (x, y, z)
    rows = opened.full.metrics(first.way.points[0], middle, seed=scene.seed, threads=1)
    told: dict[str, float | None] = {}
    for name in ("t20_s", "edt_s", "c50_db"):
        values = [row[name] for row in rows if row["centre_hz"] in _MIDDLE_HZ]
        known = [value for value in values if value is not None]
        told[name] = float(np.mean(known)) if known else None
    return told


def _whole(ways: tuple[NDArray[np.float64], ...]) -> NDArray[np.float64]:
    whole = np.zeros((ways[0].shape[0], max(way.shape[1] for way in ways)))
    for way in ways:
        whole[:, : way.shape[1]] += way
    return whole


def _ratio_db(direct: NDArray[np.float64], rest: tuple[NDArray[np.float64], ...]) -> float | None:
    """The energy of the direct sound over that of all else, dB; ``None``: one is 0."""
    whole = _whole(rest)
    above, below = float(np.sum(direct**2)), float(np.sum(whole**2))
    return 10.0 * float(np.log10(above / below)) if above > 0.0 < below else None
