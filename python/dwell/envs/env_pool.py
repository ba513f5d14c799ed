"""Environments over other houses than those that they began in."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TypeVar

from dwell import ConfigError, MeasuredDataError, _native
from dwell.envs.config import HouseCache
from dwell.heads import Head
from dwell.house import House

_Begun = TypeVar("_Begun")


def begun_as_stated(
    begin: Callable[[Sequence[int]], _Begun],
    envs: Sequence[int],
    place: Callable[[int], str | None],
) -> _Begun:
    """Begins the episodes of environments.

    Args:
        begin: Begins those of some of the environments.
        envs: All of them.
        place: Gives file and line of an environment's episode, where it states how it begins.

    Raises:
        MeasuredDataError: An episode cannot begin as its line states it.
        ConfigError: Another one cannot begin.
    """
    try:
        return begin(envs)
    except ConfigError:
        # The engine does not say whose episode it refuses.
        for env in envs:
            at = place(env)
            if at is not None:
                try:
                    begin([env])
                except ConfigError as error:
                    raise MeasuredDataError(f"{at}: {error}") from None
        raise


@dataclasses.dataclass(frozen=True)
class PreparedEnv:
    """A native environment that waits for its place in a batch, and its house."""

    house: House
    native: _native.PreparedEnv


@dataclasses.dataclass(frozen=True)
class EnvPool:
    """Makes environments of one config over the houses of a shelf."""

    shelf: HouseCache
    config: str
    heads: Sequence[Head]
    threads: int | None

    def make(
        self, episodes: Sequence[tuple[int, int | None]], *, threads: int | None = None
    ) -> list[PreparedEnv]:
        """An environment in each house, by its number, with the episode of its seed begun.

        Raises:
            MeasuredDataError: An episode cannot begin as its file states it.
            DwellError: A house cannot be opened, or holds no such episode.
        """
        threads = self.threads if threads is None else threads
        houses = [self.shelf.open(house, threads=threads) for house, _ in episodes]
        for house in houses:
            add_heads(house, self.heads)
        seeds = [seed for _, seed in episodes]
        stated = [
            None if seed is None else self.shelf.stated(house, seed) for house, seed in episodes
        ]

        def begin(rows: Sequence[int]) -> list[_native.PreparedEnv]:
            return _native.prepared_envs(
                [houses[k].native for k in rows],
                self.config,
                [seeds[k] for k in rows],
                threads,
                [stated[k] for k in rows],
            )

        def place(row: int) -> str | None:
            house, seed = episodes[row]
            return None if seed is None else self.shelf.place(house, seed)

        made = begun_as_stated(begin, range(len(houses)), place)
        return [PreparedEnv(house, native) for house, native in zip(houses, made, strict=True)]

    def make_behind(self, wanted: tuple[int, int, int]) -> PreparedEnv:
        """One environment (its place, its house, its seed), by this thread alone.

        The engines' threads are left to those who step meanwhile.
        """
        _, house, seed = wanted
        return self.make([(house, seed)], threads=1)[0]

    def house_behind(self, wanted: tuple[int, int, int]) -> str:
        """The name of the house of what :meth:`make_behind` makes."""
        return self.shelf.names[wanted[1]]


def add_heads(house: House, heads: Sequence[Head]) -> None:
    """Lets agents of worlds over a house wear heads."""
    for head in heads:
        house.native.add_head(head.native)
