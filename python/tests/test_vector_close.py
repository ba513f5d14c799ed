"""Environments that step together and are closed by another thread while one steps."""

from __future__ import annotations

import dataclasses
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.envs import DwellVectorEnv
from dwell.envs.env_pool import EnvPool, PreparedEnv
from dwell.envs.prefetch import Prefetcher
from dwell.pettingzoo import DwellParallelVectorEnv

HOUSES = "seed:0..40?home=studio"
LOADER = "dwell-ahead"


@dataclasses.dataclass
class HeldLoader:
    """What makes environments in houses, and holds the thread that makes them ahead."""

    #: Set once the thread makes its first environment.
    inside: threading.Event = dataclasses.field(default_factory=threading.Event)
    #: Lets the thread go on.
    let: threading.Event = dataclasses.field(default_factory=threading.Event)
    #: The houses that are made now.
    houses: list[int] = dataclasses.field(default_factory=list)
    #: Those that two threads made at once.
    twice: list[int] = dataclasses.field(default_factory=list)
    #: How often another thread than the loader made some.
    by_others: int = 0

    def wrap(self, make: Callable[..., list[PreparedEnv]]) -> Callable[..., list[PreparedEnv]]:
        def made(
            pool: EnvPool,
            episodes: Sequence[tuple[int, int | None]],
            *,
            threads: int | None = None,
        ) -> list[PreparedEnv]:
            houses = {house for house, _ in episodes}
            self.twice += [house for house in houses if house in self.houses]
            self.houses += houses
            if threading.current_thread().name == LOADER:
                self.inside.set()
                self.let.wait()
            else:
                self.by_others += 1
            try:
                return make(pool, episodes, threads=threads)
            finally:
                for house in houses:
                    self.houses.remove(house)

        return made


@pytest.fixture
def held(monkeypatch: pytest.MonkeyPatch) -> Iterator[HeldLoader]:
    loader = HeldLoader()
    monkeypatch.setattr(EnvPool, "make", loader.wrap(EnvPool.make))
    yield loader
    loader.let.set()


def _vector(load_ahead: int) -> DwellVectorEnv:
    return DwellVectorEnv(
        3, "Free", houses=HOUSES, sensors=["gps"], max_episode_steps=1, load_ahead=load_ahead
    )


def _parallel(load_ahead: int) -> DwellParallelVectorEnv:
    return DwellParallelVectorEnv(
        3, "Free", houses=HOUSES, sensors=["gps"], max_cycles=1, load_ahead=load_ahead
    )


def _step(envs: Any) -> None:  # noqa: ANN401 - of either kind
    if isinstance(envs, DwellVectorEnv):
        envs.step(np.array([1, 1, 1]))
    else:
        envs.step({name: np.array([1, 1, 1]) for name in envs.possible_agents})


def _until(reached: Callable[[], object]) -> None:
    while not reached():
        time.sleep(0.001)


def _told(call: Callable[[], object], told: list[BaseException | None]) -> threading.Thread:
    """Calls in another thread; what it raised, or ``None``, goes into ``told``."""

    def run() -> None:
        try:
            call()
        except BaseException as error:
            told.append(error)
        else:
            told.append(None)

    thread = threading.Thread(target=run)
    thread.start()
    return thread


def _ahead(envs: Any) -> Prefetcher[Any, Any]:  # noqa: ANN401 - of either kind
    ahead: Prefetcher[Any, Any] = envs._places._ahead
    return ahead


@pytest.mark.parametrize("make", [_vector, _parallel])
def test_a_step_after_another_thread_has_begun_to_close_is_refused(
    make: Callable[[int], Any], held: HeldLoader
) -> None:
    envs = make(3)
    envs.reset(seed=1)
    held.inside.wait()
    ahead, before = _ahead(envs), held.by_others
    closed: list[BaseException | None] = []
    # It waits for the thread that opens houses ahead.
    closing = _told(envs.close, closed)
    _until(lambda: not ahead._wanted)
    try:
        for _ in range(2):
            with pytest.raises(dwell.UsageError, match="these environments are closed"):
                _step(envs)
        with pytest.raises(dwell.UsageError, match="these environments are closed"):
            envs.reset(seed=2)
    finally:
        held.let.set()
        closing.join()
    assert closed == [None]
    assert (held.by_others, held.twice) == (before, [])
    envs.close()


@pytest.mark.parametrize("make", [_vector, _parallel])
def test_a_step_that_waits_for_a_house_is_refused_when_another_thread_closes(
    make: Callable[[int], Any], held: HeldLoader
) -> None:
    envs = make(3)
    envs.reset(seed=1)
    held.inside.wait()
    ahead = _ahead(envs)
    _step(envs)
    before = held.by_others
    stepped: list[BaseException | None] = []
    closed: list[BaseException | None] = []
    stepping = _told(lambda: _step(envs), stepped)
    _until(lambda: ahead._changed._waiters)  # type: ignore[attr-defined]
    closing = _told(envs.close, closed)
    _until(lambda: not ahead._wanted)
    held.let.set()
    stepping.join()
    closing.join()
    (error,) = stepped
    assert isinstance(error, dwell.UsageError), error
    assert "these environments are closed" in str(error)
    assert closed == [None]
    # No house was opened for environments that are closed.
    assert (held.by_others, held.twice) == (before, [])
    assert not [one for one in threading.enumerate() if one.name == LOADER]


def test_a_house_is_prepared_by_one_thread_at_a_time(held: HeldLoader) -> None:
    envs = _vector(1)
    envs.reset(seed=1)
    held.inside.wait()
    ahead = _ahead(envs)
    (house,) = held.houses
    # Another episode of the house in which an environment is made at this moment.
    asked = {
        "reset_mask": np.array([False, False, True]),
        "episode_id": [None, None, f"{envs._shelf.names[house]}#5"],
    }
    told: list[BaseException | None] = []
    thread = _told(lambda: envs.reset(options=asked), told)
    _until(lambda: ahead._changed._waiters or held.twice)  # type: ignore[attr-defined]
    held.let.set()
    thread.join()
    assert told == [None]
    assert held.twice == []
    assert envs.world(2).house is envs._shelf.open(house)
    envs.close()
