"""Data sets of views as they are stored: rows that were checked, pictures within the folder."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from dwell import ConfigError
from dwell.arguments import (
    choice,
    file_name,
    finite_number,
    integer_in_range,
    mapping,
    quoted,
    sequence_items,
    text,
)
from dwell.files import is_whole, lines, open_file, parse_json, read
from dwell.views.masks import run_lengths
from dwell.views.record import IMAGES

__all__ = ["RECORDS", "copy_picture", "picture", "picture_bytes", "records"]

#: The file of a house's records; it is there when all else is.
RECORDS = "records.jsonl"
#: A picture's file has at most so many bytes, as for the readers of houses.
_MAX_PICTURE_BYTES = 64 * 2**20
_PNG = b"\x89PNG\r\n\x1a\n"
_SPLITS = ("train", "val", "test")
_LENGTHS = ("short", "normal", "long")


def records(folder: Path) -> Iterator[tuple[dict[str, Any], Path]]:
    """The rows of a data set in order, each with the folder of its images.

    Raises:
        ValueError: A line is no record; the message names file, line and field.
        FileNotFoundError: There is none.
    """
    found = False
    for group in sorted(_folders(folder / "views")):
        for house in sorted(_folders(group)):
            if not (house / RECORDS).exists():
                continue
            found = True
            yield from ((row, house) for row in house_rows(house))
    if not found:
        raise FileNotFoundError(2, "holds no records of views", os.fspath(folder))


def house_rows(house: Path) -> Iterator[dict[str, Any]]:
    """The rows of the folder of a house.

    Raises:
        ValueError: A line is no record; the message names file, line and field.
        OSError: The system refuses, or there is no such file.
    """
    place = _inside(house, RECORDS)
    known: dict[str, int] = {}
    with open_file(place) as file:
        for number, line in enumerate(lines(file, place), start=1):
            at = f"{place} line {number}"
            row = _checked(at, parse_json(line, at))
            if (before := known.setdefault(row["id"], number)) != number:
                raise ConfigError(f"{at}: id is {row['id']!r}, as that of line {before}")
            yield row


def picture_bytes(house: Path, name: str) -> bytes:
    """The file of a picture of a record, from the folder of its house.

    Raises:
        ValueError: It lies outside of the data set, is larger than a picture is, or is none in PNG
            that is whole.
        OSError: The system refuses, or it is no regular file.
    """
    content = read(_inside(house, name), _MAX_PICTURE_BYTES)
    if not content.startswith(_PNG):
        raise ValueError(f"{house / name}: no picture in PNG")
    if not is_whole(house / name):
        raise ValueError(f"{house / name}: the picture was cut")
    return content


def copy_picture(house: Path, name: str, to: Path) -> None:
    """Copies the file of a picture; errors as of :func:`picture_bytes`."""
    to.write_bytes(picture_bytes(house, name))


def picture(house: Path, name: str) -> NDArray[Any]:
    """The values of a picture of a record.

    Raises:
        ValueError: As of :func:`picture_bytes`, or it is no picture.
        OSError: As of :func:`picture_bytes`.
    """
    content = picture_bytes(house, name)
    try:
        with Image.open(io.BytesIO(content)) as opened:
            return np.asarray(opened)
    # Of a picture that was damaged Pillow raises what its decoders do.
    except Exception as error:
        raise ValueError(f"{house / name}: no picture: {error}") from None


def _inside(house: Path, name: str) -> Path:
    """A file of a house's folder, ``FOLDER/views/GROUP/HOUSE``.

    Raises:
        ValueError: It is a link that leads out of ``FOLDER``.
    """
    place = house / name
    if not Path(os.path.realpath(place)).is_relative_to(os.path.realpath(house.parents[2])):
        raise ValueError(f"{place}: a link out of the data set; a file inside it is needed")
    return place


def _folders(folder: Path) -> Sequence[Path]:
    if not folder.is_dir():
        return ()
    return [path for path in folder.iterdir() if path.is_dir() and path.name[0] != "."]


def _checked(at: str, row: object) -> dict[str, Any]:
    """A row of which all that others read is there and of its kind."""
    whole = mapping(at, row)

    def field(name: str) -> Any:  # noqa: ANN401 - any JSON value
        if name not in whole:
            raise ConfigError(f"{at}: no record: field {name!r} is missing")
        return whole[name]

    # Files are called by it.
    file_name(f"{at}: id", field("id"))
    choice(f"{at}: split", field("split"), _SPLITS)
    for name in ("house", "light"):
        text(f"{at}: {name}", field(name))
    images = mapping(f"{at}: images", field("images"))
    if set(images) != {*IMAGES}:
        raise ConfigError(f"{at}: images are of {quoted([*images])}; expected {[*IMAGES]}")
    for kind, name in images.items():
        file_name(f"{at}: images.{kind}", name)
    camera = mapping(f"{at}: camera", field("camera"))
    for edge in ("width", "height"):
        integer_in_range(f"{at}: camera.{edge}", camera.get(edge), low=1)
    captions = mapping(f"{at}: captions", field("captions"))
    for length in {*captions, *_LENGTHS}:
        _texts(f"{at}: captions.{length}", captions.get(length), "text")
    size = (camera["height"], camera["width"])
    known: set[int] = set()
    for own, one in _rows(f"{at}: things", field("things")):
        if (number := _thing(own, one, size)) in known:
            raise ConfigError(f"{own}.id is {number}, as that of a thing before it")
        known.add(number)
    for own, one in _rows(f"{at}: references", field("references")):
        number = integer_in_range(f"{own}.id", _texts(own, one, "text", "strategy").get("id"))
        if number not in known:
            raise ConfigError(f"{own}.id is {number}; expected the id of one of its things")
    for own, one in _rows(f"{at}: questions", field("questions")):
        _texts(own, one, "text", "answer", "template", "kind")
    return whole


def _rows(at: str, found: object) -> Iterator[tuple[str, object]]:
    for k, one in enumerate(sequence_items(at, found, "expected a list")):
        yield f"{at}[{k}]", one


def _texts(at: str, found: object, *names: str) -> dict[str, Any]:
    """An object with texts of these names."""
    own = mapping(at, found)
    for name in names:
        text(f"{at}.{name}", own.get(name))
    return own


def _thing(at: str, found: object, size: tuple[int, int]) -> int:
    """The id of a thing whose box and mask are those of a picture of this height and width."""
    own = _texts(at, found, "category")
    integer_in_range(f"{at}.pixels", own.get("pixels"))
    box = sequence_items(f"{at}.box", own.get("box"), "expected four numbers")
    if len(box) != 4:
        raise ConfigError(f"{at}.box has {len(box)} numbers; expected four")
    left, top, width, height = (
        finite_number(f"{at}.box[{k}]", number) for k, number in enumerate(box)
    )
    if min(left, top, width, height) < 0 or left + width > size[1] or top + height > size[0]:
        raise ConfigError(
            f"{at}.box is {quoted(list(box))}; expected first column, first row, width and height "
            f"within {size[1]} x {size[0]} pixels"
        )
    mask = mapping(f"{at}.mask", own.get("mask"))
    if mask.get("size") != [*size]:
        raise ConfigError(f"{at}.mask.size is {quoted(mask.get('size'))}; expected {[*size]}")
    _check_runs(f"{at}.mask.counts", text(f"{at}.mask.counts", mask.get("counts")), size)
    finite_number(f"{at}.occlusion", own.get("occlusion"))
    return integer_in_range(f"{at}.id", own.get("id"))


def _check_runs(at: str, counts: str, size: tuple[int, int]) -> None:
    """Refuses a text that is no run lengths of a picture of this height and width."""
    try:
        runs = run_lengths(counts)
    except ValueError:
        runs = []
    if sum(runs) != size[0] * size[1] or min(runs, default=0) < 0:
        raise ConfigError(
            f"{at} is {quoted(counts, 60)}; expected COCO's run lengths of {size[1]} x {size[0]} "
            "pixels"
        )
