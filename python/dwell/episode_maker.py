"""Makes episodes for files: seeded, spread evenly over many houses, in any number of parts."""

from __future__ import annotations

import dataclasses
import functools
import itertools
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell import ConfigError, HouseError, _native
from dwell.arguments import (
    boolean,
    integer_in_range,
    mapping,
    part_of_parts,
    plain_settings,
    refuse_unknown,
    text_list,
)
from dwell.episodes import Episode, Header, task_of
from dwell.house import House
from dwell.house_list import HouseList
from dwell.object_state_api import agent_states
from dwell.workers import thread_count, thread_pool, worker_count

if TYPE_CHECKING:
    from dwell.envs.native_batch import NativeBatch

#: Seeds that are tried in a house before the next house is taken.
_SEEDS_IN_A_HOUSE = 4
#: Houses in a row in which no episode begins; then there is none.
_MOST_HOUSES_IN_VAIN = 200
#: How the engine says that a task asks for what a house lacks.
_UNPLAYABLE = "cannot be played in house"
#: Of goals that are a place: horizontal distance and direction.
_STRAIGHT = "pointgoal_with_gps_compass"
#: Houses that stay open for those who ask for them next.
_OPEN_HOUSES = 16


class EpisodeMaker:
    """The episodes of a task over houses: the same arguments give the same episodes.

    Episode k of ``count`` is in the house at ``k * houses // count``, so that few episodes are
    spread over many houses, and those of a house follow each other. Its seed comes from ``seed``
    and k alone, so that it is the same in whatever part it is made. Where the task cannot be played
    in a house, the next one takes its place.

    Examples:
        >>> from dwell.episode_maker import EpisodeMaker
        >>> maker = EpisodeMaker("PointNav", "split:val?home=studio", count=100_000, seed=3)
        >>> one = maker.episode(99_999)
        >>> one.scene_id, one.goal_kind, round(one.start_distance_to_goal) > 0
        ('seed:999998?split=val&home=studio', 'point', True)
    """

    def __init__(
        self,
        task: str,
        houses: str | Sequence[str],
        *,
        count: int,
        seed: int = 0,
        task_settings: Mapping[str, Any] | None = None,
        shard: tuple[int, int] = (0, 1),
        expert: bool = False,
        on_skip: Callable[[str, str], None] = lambda house, sentence: None,
    ) -> None:
        """Opens no house yet.

        Args:
            task: The task's name.
            houses: HOUSES strings.
            count: How many episodes, in all shards together.
            seed: What they are drawn from.
            task_settings: The task's settings.
            shard: Which of how many parts to make.
            expert: Whether the task's expert plays each episode, for ``expert_actions``.
            on_skip: Is told of each house that is skipped, and why; the same one more than once.

        Raises:
            ConfigError: There is no such task, setting or shard.
            HouseError: The HOUSES strings are wrong.
        """
        about = task_of(task)
        given = [houses] if isinstance(houses, str) else text_list("houses", houses)
        self.houses = HouseList(given)
        if not self.houses:
            raise ConfigError("houses: expected at least one HOUSES string, found none")
        which, shards = part_of_parts("shard", shard)
        self._asks = bool(about["asks"])
        self._expert = boolean("expert", expert)
        self._on_skip = on_skip
        self._max_steps = int(about["max_steps"])
        self._sensors = sensors_of_goals(task)
        self.header = Header(
            task=task,
            task_version=int(about["version"]),
            task_settings=whole_settings(task, task_settings),
            houses=tuple(given),
            seed=integer_in_range("seed", seed),
            count=integer_in_range("count", count, low=1),
            shard=(which, shards),
        )

    def episodes(self, *, workers: int = 1) -> Iterator[Episode]:
        """The episodes of the shard, in order, made by so many threads."""
        for _, some in self.in_parts(self.parts(), workers=workers):
            yield from some

    def parts(self, most: int = 16) -> Iterator[range]:
        """The places of the shard's episodes in pieces of at most ``most``, none listed ahead."""
        places = self.header.places
        begin = places.start
        while begin < places.stop:
            end = min((begin // most + 1) * most, places.stop)
            yield range(begin, end)
            begin = end

    def in_parts(
        self, parts: Iterable[range], *, workers: int = 1
    ) -> Iterator[tuple[range, list[Episode]]]:
        """The episodes of pieces of the shard, in the order of the pieces.

        Raises:
            ConfigError: There is no house in which the task can be played, or ``workers`` is no
                whole number from 1 to 1024.
        """
        threads = thread_count(worker_count("workers", workers), len(self.header.places))
        left = iter(parts)
        # A few ahead, and no more: there may be very many.
        ahead: deque[tuple[range, Future[list[Episode]]]] = deque()
        stop = threading.Event()
        with thread_pool(threads) as pool:
            try:
                while True:
                    for part in itertools.islice(left, 2 * threads - len(ahead)):
                        ahead.append((part, pool.submit(self._some, part, threads, stop)))
                    if not ahead:
                        return
                    part, future = ahead.popleft()
                    yield part, future.result()
            finally:
                # The pieces that are being made end with the next step.
                stop.set()

    def _some(self, places: range, workers: int, stop: threading.Event) -> list[Episode]:
        envs: dict[str, NativeBatch] = {}
        threads = 1 if workers > 1 else None
        made = []
        for place in places:
            if stop.is_set():
                break
            made.append(self.episode(place, envs, threads, stop))
        return made

    def house_of(self, place: int) -> str:
        """The house that is tried first for an episode."""
        return self.houses[place * len(self.houses) // self.header.count]

    def episode(
        self,
        place: int,
        envs: dict[str, NativeBatch] | None = None,
        threads: int | None = None,
        stop: threading.Event | None = None,
    ) -> Episode:
        """Makes the episode at a place.

        Args:
            place: From 0 to ``count`` - 1.
            envs: Environments by house, of which the last is kept for the next call.
            threads: How many threads to use.
            stop: Ends the expert's episode, and all tries of other houses, once it is set; what
                comes back then is no whole episode.

        Raises:
            ConfigError: There is no house in which the task can be played, by the engine's words.
        """
        envs = {} if envs is None else envs
        drawn = drawn_seeds(self.header.seed, place)
        first = place * len(self.houses) // self.header.count
        tries, sentence = min(len(self.houses), _MOST_HOUSES_IN_VAIN), ""
        for house in range(first, first + tries):
            name = self.houses[house % len(self.houses)]
            found = self._in_house(name, next(drawn), envs, threads, stop)
            if isinstance(found, Episode):
                return found
            sentence = found
            if stop is not None and stop.is_set():
                break
            self._on_skip(name, sentence)
        every = "no house" if tries == len(self.houses) else f"none of {tries} houses in a row"
        raise ConfigError(f"{self.header.task} can be played in {every} of these: {sentence}")

    def _in_house(
        self,
        name: str,
        seeds: Sequence[int],
        envs: dict[str, NativeBatch],
        threads: int | None,
        stop: threading.Event | None,
    ) -> Episode | str:
        """An episode in a house, or why there is none."""
        sentence = ""
        try:
            if name not in envs:
                # One world at a time: the house before is not come back to.
                envs.clear()
                envs[name] = self._env(name, threads)
            for seed in seeds:
                try:
                    return self._begun(envs[name], name, seed, stop)
                except ConfigError as error:
                    if _UNPLAYABLE not in str(error):
                        raise
                    sentence = str(error)
        except HouseError as error:
            sentence = str(error)
        except ConfigError as error:
            if _UNPLAYABLE not in str(error):
                raise
            sentence = str(error)
        return sentence if name in sentence else f"{name}: {sentence}"

    def _env(self, name: str, threads: int | None) -> NativeBatch:
        from dwell.envs.config import env_json
        from dwell.envs.native_batch import NativeBatch
        from dwell.envs.python_tasks import NativeSettings

        header = self.header
        config = env_json(NativeSettings(header.task, header.task_settings, self._sensors))
        return NativeBatch([_house(name, threads)], config, threads)

    def _begun(
        self, env: NativeBatch, name: str, seed: int, stop: threading.Event | None
    ) -> Episode:
        env.reset([seed])
        one = begun_episode(env, name, seed)
        if self._expert and self._asks:
            one = dataclasses.replace(one, **expert_run(env, self._max_steps, stop))
        return one


def sensors_of_goals(task: str) -> list[str]:
    """Sensors by which :func:`begun_episode` says all that there is: none that sees or listens."""
    has_place = any(
        row["name"] == _STRAIGHT and task in row["goal_tasks"]
        for row in _native.sensors()
        if row["goal_tasks"]
    )
    return ["gps", _STRAIGHT] if has_place else ["gps"]


def begun_episode(env: NativeBatch, name: str, seed: int) -> Episode:
    """The episode that has just begun in an environment with :func:`sensors_of_goals`.

    Args:
        env: The environment.
        name: The HOUSE string of its house.
        seed: The episode's seed.
    """
    asked = env.batch.episode_goal(0)
    agent = agent_states(env.batch.agent_states(0))[0]
    x, y, z = agent["position"]
    straight_m = None
    if any(spec.name == _STRAIGHT for spec in env.specs):
        env.observe(np.ones(1, np.bool_))
        straight_m = float(env.observation()[_STRAIGHT][0, 0])
    return Episode(
        episode_id=f"{name}#{seed}",
        scene_id=name,
        seed=seed,
        instruction=env.batch.instruction(0),
        straight_distance_to_goal=straight_m,
        start_position=(float(x), float(y), float(z)),
        start_yaw_deg=float(agent["yaw_deg"]),
        **asked,
    )


def drawn_seeds(seed: int, place: int) -> Iterator[list[int]]:
    """The seeds that are tried for the episode at a place, those of each house that is tried.

    Args:
        seed: What the episodes of a file are drawn from.
        place: The episode's place among all of them, from 0.
    """
    stream = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(place,)))
    while True:
        yield [int(stream.integers(2**63)) for _ in range(_SEEDS_IN_A_HOUSE)]


def expert_run(
    env: NativeBatch, most_steps: int, stop: threading.Event | None = None
) -> dict[str, Any]:
    """Plays the episode that has begun with the task's expert.

    Args:
        env: The environment.
        most_steps: After so many steps it is over.
        stop: Ends it earlier, once it is set.

    Returns:
        ``expert_actions``: how many it took, ``stop`` included; ``expert_path_length``, m;
        ``expert_success``.
    """
    for count in itertools.count(1):
        answers, questions = env.batch.expert_answers(), env.batch.expert_questions()
        answer = env.batch.step(env.expert_actions(), answers=answers, questions=questions)
        is_stopped = stop is not None and stop.is_set()
        if answer["terminated"][0] or count == most_steps or is_stopped:
            break
    return {
        "expert_actions": count,
        "expert_path_length": float(answer["path_length"][0]),
        "expert_success": bool(answer["success"][0]),
    }


@functools.lru_cache(_OPEN_HOUSES)
def _house(name: str, threads: int | None) -> House:
    return House.open_by(name, threads)


def whole_settings(task: str, given: Mapping[str, Any] | None) -> dict[str, Any]:
    """The settings of a task, those that are not given with their defaults.

    Raises:
        ConfigError: There is no such task or field; other values the engine refuses.
    """
    fields = {row["name"]: row["schema"] for row in task_of(task)["settings"]}
    own = plain_settings({} if given is None else mapping("task_settings", given), "task_settings")
    refuse_unknown("task_settings", [name for name in own if name not in fields], fields)
    whole = {name: _whole(schema, own.get(name)) for name, schema in fields.items()}
    # Else doors would stand as the actions of whoever plays the episodes have it: here all act.
    if whole.get("open_doors", True) is None:
        whole["open_doors"] = False
    return whole


def _whole(schema: Mapping[str, Any], given: Any) -> Any:  # noqa: ANN401 - any JSON value
    default = schema.get("default")
    if isinstance(default, dict) and isinstance(given, dict):
        return {**default, **given}
    return default if given is None else given
