"""What a HOUSES string stands for: houses by name, and seeds by arithmetic."""

from __future__ import annotations

import dataclasses
import glob
import os
import re
from collections.abc import Iterator

from dwell import ConfigError, HouseError, HouseNotFoundError, _native
from dwell.arguments import text
from dwell.files import read, split_lines
from dwell.path_patterns import matching_paths

#: Splits are the seeds below this; of a split's houses each has a number, its place among them.
SPLIT_SEEDS_END = 1_000_000
#: Python counts no sequence that has as many elements.
HOUSES_END = 2**63
FEWER_HOUSES = "allowed are fewer than 2**63"
#: Lines of a list, and files that a pattern finds.
_MOST_NAMED = 1_000_000
#: The last digits of the seeds of a split, ascending; without a split all.
_DIGITS = {"": range(10), "train": range(8), "val": range(8, 9), "test": range(9, 10)}
#: What no path begins with.
_NO_PATHS = ("builtin:", "seed:", "split:", "@")
_SPLIT = re.compile(r"split:([a-z]*)(?::([^?]*))?((?s:\?.*)?)")
_MAP = "?map="


@dataclasses.dataclass(frozen=True)
class Seeds:
    """Houses of seeds in ascending order.

    Attributes:
        split: The split of whose seeds these are; empty for all seeds.
        begin: The first one's place among the seeds of the split.
        end: The place behind the last.
        fields: What follows the seed in a HOUSE string.
    """

    split: str
    begin: int
    end: int
    fields: str

    def name(self, at: int) -> str:
        """The HOUSE string of one, counted from 0."""
        digits = _DIGITS[self.split]
        tens, which = divmod(self.begin + at, len(digits))
        return f"seed:{10 * tens + digits[which]}{self.fields}"

    def find(self, seed: int) -> int | None:
        """The place of a seed, counted from 0; ``None`` where it is not among them."""
        digits = _DIGITS[self.split]
        tens, last = divmod(seed, 10)
        if last not in digits:
            return None
        place = tens * len(digits) + digits.index(last)
        return place - self.begin if self.begin <= place < self.end else None


def stands_for_several(house: str) -> bool:
    """Returns whether a HOUSES string is of a form that stands for several houses.

    Patterns of paths are left out: a path that exists is itself.
    """
    return house.startswith(("split:", "@"))


def parts_of(house: str, folder: str = "") -> Iterator[str | Seeds]:
    """The houses of a HOUSES string, in order.

    Args:
        house: The string.
        folder: The folder that relative paths are relative to.

    Raises:
        HouseError: A range or split is none, or has no such houses; a list names another.
        HouseNotFoundError: No path is of a pattern.
        ConfigError: There are more than any sequence of Python holds.
        OSError: A list cannot be read.
    """
    if house.startswith("@"):
        yield from _listed(house[1:], folder)
    elif house.startswith("split:"):
        yield _split(house)
    elif (found := _native.seed_range(house)) is not None:
        if found[1] - found[0] >= HOUSES_END:
            raise ConfigError(f"{house}: {found[1] - found[0]} houses; {FEWER_HOUSES}")
        yield Seeds("", found[0], found[1], found[2])
    else:
        yield from _paths(house, folder)


def _split(house: str) -> Seeds:
    """The houses of a split: ``split:val``, ``split:val:A..B``, with ``?field=value``."""
    found = _SPLIT.fullmatch(house)
    known = [name for name in _DIGITS if name]
    if found is None or found[1] not in known:
        forms = ", ".join(f"split:{name}" for name in known)
        raise HouseError(
            f"{house}: no such split; allowed are {forms}, each with :A..B for the houses from A "
            "to B - 1 of it and ?field=value for what shall not be drawn"
        )
    name, places, fields = found[1], found[2], found[3][1:]
    count = len(_DIGITS[name]) * SPLIT_SEEDS_END // 10
    begin, end = 0, count
    if places is not None:
        ends = re.fullmatch(r"([0-9]{1,20})\.\.([0-9]{1,20})", places)
        begin, end = (int(ends[1]), int(ends[2])) if ends else (0, 0)
        if not begin < end <= count:
            raise HouseError(
                f"{house}: found {places!r}; allowed is A..B with whole numbers A < B, up to "
                f"{count}, as many houses as the split {name} has"
            )
    if any(field.partition("=")[0] == "split" for field in fields.split("&")):
        raise HouseError(f"{house}: split stands twice; {house.partition('?')[0]} says it already")
    # As `dwell generate --split` names them.
    whole = f"?split={name}{'&' if fields else ''}{fields}"
    _native.seed_range(f"seed:0..1{whole}")
    return Seeds(name, begin, end, whole)


def _paths(house: str, folder: str) -> Iterator[str]:
    """The house itself, or the files that its pattern finds, sorted."""
    head, has_map, mapping = house.partition(_MAP)
    if has_map:
        mapping = os.path.join(folder, mapping)
    if head.startswith(_NO_PATHS):
        yield f"{head}{has_map}{mapping}"
        return
    place = os.path.join(folder, head)
    if not glob.has_magic(head) or "\0" in head or os.path.lexists(place):
        yield f"{place}{has_map}{mapping}"
        return
    names = matching_paths(head, folder)
    if not names:
        raise HouseNotFoundError(
            f"{place}: no path is of this pattern; * stands for any letters of a name, ** for any "
            "folders"
        )
    if len(names) > _MOST_NAMED:
        raise HouseError(f"{place}: {len(names)} paths are of this pattern; at most {_MOST_NAMED}")
    for name in names:
        yield f"{os.path.join(folder, name)}{has_map}{mapping}"


def _listed(path: str, folder: str) -> Iterator[str | Seeds]:
    """The houses of a list: a HOUSES string a line; ``#`` begins a comment of a whole line.

    Blanks and tabs around a string are none of it; every other letter may be one of a path.
    """
    if not path:
        raise HouseError("@: expected @FILE, a file with a HOUSES string a line")
    place = os.path.join(folder, path)
    try:
        rows = split_lines(read(place).decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise HouseError(f"{place}: byte {error.start} is not UTF-8") from None
    except ValueError as error:
        if isinstance(error, OSError):
            raise
        raise HouseError(str(error)) from None
    if len(rows) > _MOST_NAMED:
        raise HouseError(f"{place}: {len(rows)} lines; at most {_MOST_NAMED} are read")
    is_empty = True
    for number, row in enumerate(rows, start=1):
        house, at = row.strip(" \t"), f"{place} line {number}"
        if not house or house.startswith("#"):
            continue
        is_empty = False
        if house.startswith("@"):
            raise HouseError(f"{at}: {house!r:.200} is a list; a list names no other list")
        try:
            yield from parts_of(text("house", house), os.path.dirname(place))
        except HouseNotFoundError as error:
            raise HouseNotFoundError(f"{at}: {error}") from None
        except (HouseError, ConfigError) as error:
            raise HouseError(f"{at}: {error}") from None
    if is_empty:
        raise HouseError(f"{place}: names no house; expected a HOUSES string a line")
