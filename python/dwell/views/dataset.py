"""Data sets of views: made house by house, each whole or not at all."""

from __future__ import annotations

import dataclasses
import itertools
import json
import os
import re
import shutil
import zlib
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, DwellError
from dwell.arguments import boolean, integer_in_range, text
from dwell.files import atomic_folder, is_whole
from dwell.house_list import HouseList
from dwell.views.cameras import held_cameras
from dwell.views.questions import ask
from dwell.views.record import HouseNames, ViewRecord, view_record
from dwell.views.stored import RECORDS, house_rows, records
from dwell.workers import thread_count, thread_pool, worker_count

__all__ = ["LIGHTS", "ViewSettings", "house_records", "make", "records", "split_of"]

#: Hours at which a generated house is seen in each light, local solar time.
LIGHTS: dict[str, float] = {"day": 12.0, "lamp": 22.0}
_SEED = re.compile(r"seed:([0-9]+)")
#: Depths in PNG are whole millimetres, up to what 16 bits hold.
_MM_PER_M, _MOST_MM = 1000.0, 65_535.0


@dataclasses.dataclass(frozen=True)
class ViewSettings:
    """What a data set of views is made of.

    Attributes:
        views: Of each house, 1 to 1000; half of them by lamp light in houses of seeds.
        size: Edges of the images, pixels, 64 to 1024.
        seed: Draws cameras, wordings and questions.
        questions: Of each template in a view at most.
        situations: Whether ways and failed actions are asked for, too; a tenth of a second each.
    """

    views: int = 8
    size: int = 256
    seed: int = 0
    questions: int = 2
    situations: bool = False

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigError: One is out of its range.
        """
        integer_in_range("views", self.views, low=1, high=1000)
        integer_in_range("size", self.size, low=64, high=1024)
        integer_in_range("seed", self.seed)
        integer_in_range("questions", self.questions, low=0, high=1000)
        boolean("situations", self.situations)


def split_of(house: str) -> str:
    """The part of a house: ``train``, ``val`` or ``test``; of others than seeds by their name."""
    from dwell.house import split_of_seed

    seed = _SEED.match(house)
    if seed:
        return split_of_seed(int(seed[1]))
    return (*["train"] * 8, "val", "test")[zlib.crc32(house.encode()) % 10]


def house_records(name: str, settings: ViewSettings) -> list[ViewRecord]:
    """The records of one house, with questions that are balanced among its views.

    Raises:
        DwellError: It cannot be opened, or nobody can stand in it.
    """
    from dwell.house import House
    from dwell.world import World

    name = text("name", name)
    lights = list(LIGHTS) if _SEED.match(name) and "time_of_day" not in name else ["own"]
    worlds = []
    for light in lights:
        lit = name
        if light != "own":
            lit += ("&" if "?" in name else "?") + f"time_of_day={LIGHTS[light]:g}"
        worlds.append(World(House.open(lit), agents=0))
    names = HouseNames(worlds[0])
    found = []
    cameras = held_cameras(worlds[0], settings.views, settings.seed)
    for k, camera in enumerate(cameras):
        which = k % len(worlds)
        # Each view has wordings of its own.
        seed = (settings.seed + 1_000_003 * k) % 2**63
        record = view_record(
            worlds[which],
            camera,
            id=f"{k:03}",
            light=lights[which],
            size=settings.size,
            seed=seed,
            names=names,
        )
        record.row |= {"house": name, "split": split_of(name)}
        found.append(record)
    if not found:
        raise ConfigError(f"{name}: no place shows three things")
    if settings.questions:
        ask(
            worlds[0],
            found,
            most=settings.questions,
            seed=settings.seed,
            situations=settings.situations,
        )
    return found


def make(
    houses: HouseList,
    out: Path,
    settings: ViewSettings,
    *,
    shard: tuple[int, int] = (0, 1),
    threads: int = 1,
    on_skip: Callable[[str, str], None] | None = None,
) -> Iterator[tuple[int, str, int]]:
    """Makes what is missing of the houses of a shard, in order.

    A house stands in its folder whole or not at all, so what was stopped goes on. Names of ranges
    are made one by one.

    Args:
        houses: All houses of the data set.
        out: Its folder.
        settings: What is made.
        shard: Which of how many parts, from 0.
        threads: Houses at a time, 1 to 1024; at most four for each processor.
        on_skip: Is told a house that cannot be used, and why.

    Yields:
        The number of each house, its name, and how many records were made now; 0 where it was there
        already, or was skipped.

    Raises:
        ValueError: A house is there of which a file was changed or cut.
        OSError: The system refuses.
    """
    which, shards = shard
    numbers = range(which, len(houses), shards)
    todo = ((k, houses[k]) for k in numbers)
    ahead: deque[tuple[int, str, Future[int | str] | None]] = deque()
    threads = thread_count(worker_count("threads", threads), len(numbers))
    with thread_pool(threads) as pool:
        while True:
            for k, name in itertools.islice(todo, 2 * threads - len(ahead)):
                folder = house_folder(out, k)
                is_there = _is_made(folder)
                job = None if is_there else pool.submit(_make_house, name, k, folder, settings)
                ahead.append((k, name, job))
            if not ahead:
                return
            k, name, job = ahead.popleft()
            made = 0 if job is None else job.result()
            if isinstance(made, str):
                if on_skip is not None:
                    on_skip(name, made)
                made = 0
            yield k, name, made


def _is_made(folder: Path) -> bool:
    """Returns whether a house stands in its folder.

    Raises:
        ValueError: Its records were changed, or a picture is missing or cut.
    """
    if not (folder / RECORDS).exists():
        return False
    anew = f"remove {folder}, and the house is made anew"
    try:
        names = [name for row in house_rows(folder) for name in row["images"].values()]
    except ValueError as error:
        raise ValueError(f"{error}; {anew}") from None
    for name in names:
        if not is_whole(folder / name):
            raise ValueError(f"{folder / name} is missing or cut; {anew}")
    return True


def house_folder(out: Path, number: int) -> Path:
    """The folder of a house by its number; at most a thousand stand side by side."""
    return out / "views" / f"{number // 1000:05}" / f"{number:08}"


def _make_house(name: str, number: int, folder: Path, settings: ViewSettings) -> int | str:
    """Makes and writes a house; how many records, or why there are none."""
    try:
        made = house_records(name, settings)
    except OSError as error:
        if not isinstance(error, DwellError):
            raise
        return str(error)
    except DwellError as error:
        return str(error)
    try:
        _write_house(made, number, folder)
    except OSError as error:
        error.filename = error.filename or os.fspath(folder)
        raise
    return len(made)


def _write_house(made: Sequence[ViewRecord], number: int, folder: Path) -> None:
    # One without records is none.
    shutil.rmtree(folder, ignore_errors=True)
    with atomic_folder(folder) as draft:
        rows = []
        for record in made:
            record.row["id"] = f"{number:08}-{record.row['id']}"
            record.row["images"] = _write_images(draft, record)
            rows.append(json.dumps(record.row, ensure_ascii=False) + "\n")
        (draft / RECORDS).write_text("".join(rows), "utf-8")


def _write_images(folder: Path, record: ViewRecord) -> dict[str, str]:
    from PIL import Image

    names = {}
    for kind, image in png_images(record.images).items():
        names[kind] = f"{record.row['id']}.{kind}.png"
        Image.fromarray(image).save(folder / names[kind], compress_level=1)
    return names


def png_images(images: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Images as a PNG holds them.

    Returns:
        ``rgb`` as it is; ``depth`` (height, width) uint16, mm, 65535 for all beyond; ``instance``
        (height, width) uint16, 0 where there is nothing; ``normals`` (height, width, 3) uint8:
        ``round(127.5 (n + 1))``.
    """
    depth = np.clip(np.rint(images["depth"][..., 0] * _MM_PER_M), 0.0, _MOST_MM)
    return {
        "rgb": images["rgb"],
        "depth": depth.astype(np.uint16),
        "instance": np.clip(images["instance"][..., 0], 0, 65_535).astype(np.uint16),
        "normals": np.rint(127.5 * (images["normals"] + 1.0)).astype(np.uint8),
    }
