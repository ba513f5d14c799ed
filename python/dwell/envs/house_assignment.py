"""Assignment of a batch's environments to houses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dwell.envs.config import CACHED_HOUSES
from dwell.envs.env_pool import EnvPool, PreparedEnv
from dwell.envs.episode_calls import closed_together
from dwell.envs.native_batch import NativeBatch
from dwell.envs.prefetch import Prefetcher


class HouseAssignment:
    """Puts environments into the houses of their episodes, which wait there where they can."""

    def __init__(self, runner: NativeBatch, stock: EnvPool, load_ahead: int) -> None:
        """All environments of ``runner`` are in the first house; ``load_ahead`` others may wait."""
        self._runner = runner
        self._stock = stock
        self._names = stock.shelf.names
        self._houses = [0] * runner.count
        most = load_ahead if len(self._names) > 1 else 0
        self._ahead = Prefetcher(stock.make_behind, most, stock.house_behind)
        #: What the next episodes want that are in another house (environment, house, seed), those
        #: first whose turn comes first where all episodes are equally long.
        self._next: dict[int, tuple[int, int, int]] = {}

    def house(self, env: int) -> int:
        """The number of an environment's house."""
        return self._houses[env]

    def name(self, env: int) -> str:
        """The name of an environment's house."""
        return self._names[self._houses[env]]

    def episode_id(self, env: int, seed: int) -> str:
        """The id of an episode with a seed in an environment."""
        return self._stock.shelf.episode_id(self._houses[env], seed)

    def move(self, episodes: Mapping[int, tuple[int, int | None]]) -> set[int]:
        """Puts environments into the houses of their episodes (house and seed).

        Returns:
            Those that are in another house now. The engine has begun their episodes, of a seed.

        Raises:
            UsageError: The environments are closed, by another thread meanwhile.
        """
        away = {k: one for k, one in episodes.items() if self._names[one[0]] != self.name(k)}
        ready = {}
        for k, (house, seed) in away.items():
            if seed is not None and (spare := self._ahead.take((k, house, seed))) is not None:
                ready[k] = spare
        for k, spare in ready.items():
            self._put(k, away[k][0], spare)
        missing = [k for k in away if k not in ready]
        # A few at a time: each takes a world's memory while those that they replace are there.
        for some in (
            missing[at : at + CACHED_HOUSES] for at in range(0, len(missing), CACHED_HOUSES)
        ):
            for k, spare in zip(some, self._made_now([away[k] for k in some]), strict=True):
                self._put(k, away[k][0], spare)
        return set(away)

    def _made_now(self, episodes: Sequence[tuple[int, int | None]]) -> list[PreparedEnv]:
        # A house is opened and prepared by one thread at a time: nothing of it is made twice.
        with self._ahead.reserved({self._names[house] for house, _ in episodes}):
            if self._ahead.closed:
                raise closed_together()
            return self._stock.make(episodes)

    def _put(self, env: int, house: int, spare: PreparedEnv) -> None:
        self._runner.move(env, spare)
        self._houses[env] = house

    def look_ahead(self, episodes: Mapping[int, tuple[int, int]]) -> None:
        """Has environments wait in the houses of episodes (house and seed) that come next."""
        for k, (house, seed) in episodes.items():
            self._next.pop(k, None)
            if self._names[house] != self.name(k):
                self._next[k] = (k, house, seed)
        self._ahead.want(self._next.values())

    def close(self) -> None:
        """Drops all waiting environments."""
        self._ahead.close()
