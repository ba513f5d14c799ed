"""Environments over other houses than those that they began in."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from dwell import _native
from dwell.envs.config import HouseCache
from dwell.heads import Head
from dwell.house import House


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
        made = _native.prepared_envs(
            [house.native for house in houses], self.config, seeds, threads, stated
        )
        return [PreparedEnv(house, native) for house, native in zip(houses, made, strict=True)]

    def make_behind(self, wanted: tuple[int, int, int]) -> PreparedEnv:
        """One environment (its place, its house, its seed), by this thread alone.

        The engines' threads are left to those who step meanwhile.
        """
        _, house, seed = wanted
        return self.make([(house, seed)], threads=1)[0]


def add_heads(house: House, heads: Sequence[Head]) -> None:
    """Lets agents of worlds over a house wear heads."""
    for head in heads:
        house.native.add_head(head.native)
