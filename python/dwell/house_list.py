"""Names of many houses, those of ranges of seeds made when they are asked for."""

from __future__ import annotations

import bisect
import operator
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import overload

from dwell import ConfigError, _native
from dwell.arguments import quoted, sequence_items, text

#: One house of a seed, as ranges name theirs.
_SEED = re.compile(r"seed:(0|[1-9][0-9]{0,19})((?s:\?.*)?)")


class HouseList(Sequence[str]):
    """HOUSE strings in order; ``seed:A..B`` stands for its houses and takes no memory for them.

    >>> from dwell.house_list import HouseList
    >>> names = HouseList(["builtin:studio", "seed:0..1000000000?home=studio"])
    >>> len(names), names[1000000000], names.index("seed:7?home=studio")
    (1000000001, 'seed:999999999?home=studio', 8)
    """

    def __init__(self, houses: Iterable[str] = ()) -> None:
        """Keeps the names; opens nothing. Raises as :meth:`append`."""
        #: One house by its name, or seeds and what follows them.
        self._parts: list[str | tuple[range, str]] = []
        #: How many houses there are up to the end of each part.
        self._ends: list[int] = []
        for house in sequence_items("houses", houses, "expected HOUSE strings"):
            self.append(house)

    def append(self, house: str) -> None:
        """Adds a house, or those of a range of seeds.

        Raises:
            HouseError: A range is empty or none of whole numbers.
            ConfigError: There are more than any sequence of Python holds, or it is no text that
                UTF-8 can hold.
        """
        found = _native.seed_range(text("house", house))
        if found is None:
            self.append_name(house)
            return
        seeds = range(found[0], found[1])
        end = len(self) + seeds.stop - seeds.start
        if end >= 2**63:
            raise ConfigError(f"{end} houses; allowed are fewer than 2**63")
        self._parts.append((seeds, found[2]))
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
                yield from (f"seed:{seed}{part[1]}" for seed in part[0])

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
        return f"seed:{part[0][at - self._ends[which]]}{part[1]}"

    def __eq__(self, other: object) -> bool:
        """Returns whether both have the same names in order, however they were given."""
        return self._runs() == other._runs() if isinstance(other, HouseList) else NotImplemented

    __hash__ = None  # type: ignore[assignment] # houses may be appended

    def _runs(self) -> list[str | tuple[range, str]]:
        """The names in the fewest parts: seeds that follow each other as one range."""
        runs: list[str | tuple[range, str]] = []
        for part in self._parts:
            if isinstance(part, str) and (one := _SEED.fullmatch(part)):
                part = range(int(one[1]), int(one[1]) + 1), one[2]
            last = runs[-1] if runs else ""
            if isinstance(part, str) or isinstance(last, str):
                runs.append(part)
            elif last[1] == part[1] and last[0].stop == part[0].start:
                runs[-1] = range(last[0].start, part[0].stop), part[1]
            else:
                runs.append(part)
        return runs

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
            elif wanted and wanted[2] == part[1] and int(wanted[1]) in part[0]:
                yield begin + part[0].index(int(wanted[1]))
            begin = end


def _whole(name: str, value: object) -> int:
    try:
        return operator.index(value)  # type: ignore[arg-type] # what this finds out
    except TypeError:
        raise ConfigError(f"{name} is {quoted(value)}; expected a whole number") from None
