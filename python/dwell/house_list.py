"""Names of many houses, those of ranges of seeds made when they are asked for."""

from __future__ import annotations

import bisect
import operator
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import overload

from dwell import ConfigError
from dwell.arguments import quoted, sequence_items, text
from dwell.house_strings import FEWER_HOUSES, HOUSES_END, Seeds, parts_of

#: One house of a seed, as ranges name theirs.
_SEED = re.compile(r"seed:(0|[1-9][0-9]{0,19})((?s:\?.*)?)")


class HouseList(Sequence[str]):
    """HOUSE strings in order, out of HOUSES strings, each of which may stand for several houses.

    ``seed:A..B`` stands for the houses of its seeds and takes no memory for them, ``split:val`` for
    those of a split (``split:train``, ``split:test``), ``split:val:A..B`` for some of them,
    ``data/*.dwell`` for the paths of that pattern, and ``@FILE`` for the HOUSES strings of a file.

    >>> from dwell.house_list import HouseList
    >>> names = HouseList(["builtin:studio", "seed:0..1000000000?home=studio"])
    >>> len(names), names[1000000000], names.index("seed:7?home=studio")
    (1000000001, 'seed:999999999?home=studio', 8)
    >>> names = HouseList(["split:val:0..50000?home=studio"])
    >>> len(names), names[49999]
    (50000, 'seed:499998?split=val&home=studio')
    """

    def __init__(self, houses: Iterable[str] = ()) -> None:
        """Keeps the names; opens nothing. Raises as :meth:`append`."""
        #: One house by its name, or houses of seeds.
        self._parts: list[str | Seeds] = []
        #: How many houses there are up to the end of each part.
        self._ends: list[int] = []
        for house in sequence_items("houses", houses, "expected a list of HOUSE strings"):
            self.append(house)

    def append(self, house: str) -> None:
        """Adds the houses that a HOUSES string stands for.

        Raises:
            HouseError: A range is empty or none of whole numbers, a split is none, a pattern finds
                nothing, or a line of a list is wrong.
            ConfigError: There are more than any sequence of Python holds, or it is no text that
                UTF-8 can hold.
            OSError: The system refuses to read a list, or it is no regular file.
        """
        for part in parts_of(text("house", house)):
            if isinstance(part, str):
                self.append_name(part)
                continue
            end = len(self) + part.end - part.begin
            if end >= HOUSES_END:
                raise ConfigError(f"{end} houses; {FEWER_HOUSES}")
            self._parts.append(part)
            self._ends.append(end)

    def append_name(self, name: str) -> None:
        """Adds one house by its name, whatever that is."""
        self._parts.append(name)
        self._ends.append(len(self) + 1)

    def __len__(self) -> int:
        """Number of houses, equal ones counted each time."""
        return self._ends[-1] if self._ends else 0

    def __iter__(self) -> Iterator[str]:
        """The names in order."""
        for part in self._parts:
            if isinstance(part, str):
                yield part
            else:
                yield from map(part.name, range(part.end - part.begin))

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        """A name; a slice is a list."""
        if isinstance(index, slice):
            parts = (index.start, index.stop, index.step)
            whole = (None if part is None else _whole("house", part) for part in parts)
            return [self[k] for k in range(*slice(*whole).indices(len(self)))]
        at = _whole("house", index)
        at += len(self) if at < 0 else 0
        if not 0 <= at < len(self):
            raise IndexError(f"house {index} of {len(self)}")
        which = bisect.bisect_right(self._ends, at)
        part = self._parts[which]
        if isinstance(part, str):
            return part
        return part.name(at - (self._ends[which - 1] if which else 0))

    def __eq__(self, other: object) -> bool:
        """Returns whether both have the same names in order, however they were given."""
        if not isinstance(other, HouseList):
            return NotImplemented
        if len(self) != len(other):
            return False
        begin = 0
        for end in sorted({*self._ends, *other._ends}):
            # Up to here each goes on by one rule: seeds with the same last digits, which are the
            # same from there on where eleven in a row are.
            if any(self[k] != other[k] for k in range(begin, min(begin + 11, end))):
                return False
            begin = end
        return True

    __hash__ = None  # type: ignore[assignment] # houses may be appended

    def __contains__(self, name: object) -> bool:
        """Returns whether a house of this name is among them; none is made to find it."""
        return next(self._places(name), None) is not None

    def index(self, name: object, start: int = 0, stop: int | None = None) -> int:
        """The first place of a name from ``start`` on and before ``stop``, which count as a list's.

        Raises:
            ValueError: It is not there.
        """
        begin = _whole("start", start)
        end = len(self) if stop is None else _whole("stop", stop)
        begin, end, _ = slice(begin, end).indices(len(self))
        for place in self._places(name):
            if begin <= place < end:
                return place
        raise ValueError(f"no house {name!r}")

    def count(self, name: object) -> int:
        """How many times a name is among them."""
        return sum(1 for _ in self._places(name))

    def _places(self, name: object) -> Iterator[int]:
        """The places of a name in order; none is made to find them."""
        if not isinstance(name, str):
            return
        wanted = _SEED.fullmatch(name)
        begin = 0
        for part, end in zip(self._parts, self._ends, strict=True):
            if isinstance(part, str):
                if part == name:
                    yield begin
            elif wanted and wanted[2] == part.fields:
                place = part.find(int(wanted[1]))
                if place is not None:
                    yield begin + place
            begin = end


def _whole(name: str, value: object) -> int:
    try:
        return operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; expected a whole number") from None
