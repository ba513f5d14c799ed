"""Environments that play the episodes of files."""

from __future__ import annotations

import array
import hashlib
import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from dwell import ConfigError, HouseError, MeasuredDataError, _native, arguments
from dwell.arguments import (
    mapping,
    plain_settings,
    quoted,
    refuse_unknown,
    sequence_items,
    to_json,
)
from dwell.envs.config import USUAL_HOUSE, EpisodeFiles, HouseCache, Houses
from dwell.envs.python_tasks import TaskChoice
from dwell.episodes import Episode, Header, read, task_of
from dwell.house import House
from dwell.house_list import HouseList
from dwell.object_state_api import agent_states

#: What the settings of a task say about steps, not about which episodes there are: who plays the
#: episodes of a file may choose them anew.
_OF_STEPS = ("reward", "ends_at_goal", "step_done_reward")


class EpisodeIndex:
    """Episodes of files, in 20 bytes each (28 where some state things), and their houses' names.

    Attributes:
        header: The header of the first file; the others have the same task and settings.
        names: The houses, in the order in which they come first.
    """

    def __init__(self, episodes: EpisodeFiles) -> None:
        """Reads the files.

        Raises:
            MeasuredDataError: A file is none of episodes, or a line of it is wrong; or an episode
                stands there twice; the message names file, line and field.
            ConfigError: The files do not go together, or are none.
            OSError: The system refuses to read one, or it is no regular file.
        """
        is_one = isinstance(episodes, str | os.PathLike)
        expected = "expected the path of a file of episodes, or a list of such"
        given = [episodes] if is_one else sequence_items("episodes", episodes, expected)
        if not given:
            raise ConfigError(f"episodes is []; {expected}")
        self._files = [read(arguments.file_path("episodes", one)) for one in given]
        self.header = self._files[0].header
        with self._files[0].in_header():
            _refuse_settings(self.header)
        for file in self._files[1:]:
            _refuse_other(self._files[0].path, self.header, file.path, file.header)
        numbers: dict[str, int] = {}
        houses, seeds, digests = array.array("i"), array.array("Q"), array.array("Q")
        #: Where the lines of those begin that state their start or goal, 0 for others; empty where
        #: none does.
        self._stated_at = array.array("Q")
        #: Up to which episode each file's go.
        self._ends: list[int] = []
        for file in self._files:
            for offset, one in file.placed():
                self._stated_at.append(0 if one.stated is None else offset)
                houses.append(numbers.setdefault(one.scene_id, len(numbers)))
                seeds.append(one.seed)
                digests.append(_digest(one.asked()))
            self._ends.append(len(seeds))
        if not seeds:
            raise ConfigError(f"episodes: {self._files[0].path} holds no episode")
        if not any(self._stated_at):
            self._stated_at = array.array("Q")
        self.names = [*numbers]
        self._houses = np.frombuffer(houses, np.int32)
        self._seeds = np.frombuffer(seeds, np.uint64)
        self._digests = np.frombuffer(digests, np.uint64)
        order = np.lexsort((self._seeds, self._houses))
        same = np.diff(self._houses[order]) == 0
        same &= self._seeds[order][1:] == self._seeds[order][:-1]
        if same.any():
            first = int(np.flatnonzero(same)[0])
            before, again = sorted(map(int, order[first : first + 2]))
            raise MeasuredDataError(
                f"{self.place(again)}: episode_id {quoted(self.id_of(again))} stands in "
                f"{self.place(before)} already; an episode stands once"
            )

    def __len__(self) -> int:
        """How many episodes there are."""
        return len(self._seeds)

    def __getitem__(self, number: int) -> tuple[int, int]:
        """House, by its place in :attr:`names`, and seed of an episode."""
        return int(self._houses[number]), int(self._seeds[number])

    def id_of(self, number: int) -> str:
        """The id of an episode."""
        house, seed = self[number]
        return f"{self.names[house]}#{seed}"

    def stated(self, number: int) -> dict[str, Any] | None:
        """What an episode states of its start and goal; ``None``: all is drawn.

        Raises:
            MeasuredDataError: The file has changed since.
            OSError: The system refuses to read it.
        """
        offset = self._stated_at[number] if self._stated_at else 0
        if not offset:
            return None
        file = self._files[int(np.searchsorted(self._ends, number, "right"))]
        one = file.line_at(offset)
        if one.episode_id != self.id_of(number):
            raise MeasuredDataError(
                f"{self.place(number)}: the episode {quoted(self.id_of(number))} stood there; the "
                "file has changed since"
            )
        return one.stated

    def number(self, house: int, seed: int) -> int | None:
        """Which episode it is that is in a house and of a seed."""
        if not 0 <= seed < 2**64:
            return None
        found = np.flatnonzero((self._seeds == np.uint64(seed)) & (self._houses == house))
        return int(found[0]) if found.size else None

    def check(self, number: int, asked: Mapping[str, Any]) -> None:
        """Refuses what an episode asks when it is played, where the file states something else.

        Raises:
            MeasuredDataError: The message has the field, what the file states and what was found.
        """
        if _digest(asked) == int(self._digests[number]):
            return
        stated = self._stated(self.id_of(number))
        name = next((key for key in asked if stated.get(key) != asked[key]), "what is asked")
        raise MeasuredDataError(
            f"{self.place(number)}: {name}: the file states {quoted(stated.get(name))}, played it "
            f"is {quoted(asked.get(name))}: the file was made by something else than this "
            f"environment (it by dwell {self.header.made_by}, with the default world), or changed"
        )

    def _stated(self, episode_id: str) -> dict[str, Any]:
        """What the file states of an episode; empty where it is gone since."""
        try:
            for file in self._files:
                for one in file:
                    if one.episode_id == episode_id:
                        return one.asked()
        except (OSError, MeasuredDataError):
            pass
        return {}

    def first_in(self, house: int) -> int:
        """The first episode in a house, by the place of that in :attr:`names`."""
        return int(np.flatnonzero(self._houses == house)[0])

    def place(self, number: int) -> str:
        """File and line of an episode, counted from 0."""
        which = int(np.searchsorted(self._ends, number, "right"))
        begin = self._ends[which - 1] if which else 0
        return f"{self._files[which].path} line {number - begin + 2}"


class EpisodeShelf(HouseCache):
    """The houses of episodes of files, of which each draw gives one."""

    def __init__(self, houses: Houses | None, index: EpisodeIndex) -> None:
        """Opens nothing.

        Raises:
            ConfigError: ``houses`` are given, and an episode is in another.
        """
        names = HouseList()
        for name in index.names if houses is None else ():
            names.append_name(name)
        super().__init__(names if houses is None else houses)
        self._index = index
        #: The houses of :attr:`names` that the index numbers, and back.
        self._house_of = [*range(len(index.names))]
        if houses is not None:
            for number, name in enumerate(index.names):
                if name not in self.names:
                    raise ConfigError(
                        f"houses: an episode of the file is in {quoted(name)}, which is not among "
                        f"them: {quoted(self.names[:12])}; leave houses out, or give its houses"
                    )
                self._house_of[number] = self.names.index(name)
        self._number_of = {house: number for number, house in enumerate(self._house_of)}

    def open(self, index: int, *, threads: int | None = None) -> House:
        """House ``index`` modulo their number, opened by so many threads.

        Raises:
            HouseError: There is none of that name; the message begins with file, line and field of
                an episode in it.
        """
        try:
            return super().open(index, threads=threads)
        except HouseError as error:
            number = self._number_of.get(index % len(self.names))
            if number is None:
                raise
            at = self._index.place(self._index.first_in(number))
            raise type(error)(f"{at}: scene_id: {error}") from error

    def draw(self, stream: np.random.Generator) -> tuple[int, int]:
        """House and seed of one of the episodes."""
        house, seed = self._index[int(stream.integers(len(self._index)))]
        return self._house_of[house], seed

    def chosen(self, house: object) -> int:
        """Refuses: an episode has its own house.

        Raises:
            ConfigError: Always.
        """
        raise ConfigError(
            f"options: house is {quoted(house)}; episodes of a file have their own houses, give "
            "episode_id"
        )

    def episode(self, episode_id: object) -> tuple[int, int]:
        """House and seed of an id of the file.

        Raises:
            ConfigError: It is none.
        """
        house, seed = super().episode(episode_id)
        if self._number(house, seed) is None:
            raise ConfigError(
                f"episode_id is {quoted(episode_id)}; expected one of the {len(self._index)} "
                f"episodes of the file, such as {quoted(self._index.id_of(0))}"
            )
        return house, seed

    def _number(self, house: int, seed: int) -> int | None:
        number = self._number_of.get(house)
        return None if number is None else self._index.number(number, seed)

    def stated(self, house: int, seed: int) -> dict[str, Any] | None:
        """What an episode states of its start and goal.

        Raises:
            MeasuredDataError: The file has changed since.
            OSError: The system refuses to read it.
        """
        number = self._number(house, seed)
        return None if number is None else self._index.stated(number)

    def place(self, house: int, seed: int) -> str | None:
        """File and line where an episode states its start or goal.

        Raises:
            MeasuredDataError: The file has changed since.
            OSError: The system refuses to read it.
        """
        number = self._number(house, seed)
        if number is None or self._index.stated(number) is None:
            return None
        return self._index.place(number)

    def refuse_stated(self) -> None:
        """Refuses: episodes of a file state what they state there.

        Raises:
            ConfigError: Always.
        """
        raise ConfigError(
            "options: episode; episodes of a file state their own start and goal, give episode_id"
        )

    def check(self, house: int, seed: int, batch: _native.Batch, env: int = 0) -> None:
        """Refuses an episode that has begun and is not as the file states it.

        Raises:
            MeasuredDataError: As of :meth:`EpisodeIndex.check`.
        """
        number = self._number(house, seed)
        if number is None:
            return
        found = batch.episode_goal(env)
        agent = agent_states(batch.agent_states(env))[batch.agents()[0]]
        played = Episode(
            episode_id="",
            scene_id="",
            seed=seed,
            start_position=agent["position"],
            start_yaw_deg=agent["yaw_deg"],
            instruction=batch.instruction(env),
            **(self._index.stated(number) or {}),
            **found,
        )
        self._index.check(number, played.asked())


def shelf_of(houses: Houses | None, index: EpisodeIndex | None) -> HouseCache:
    """The houses of an environment.

    Raises:
        ConfigError: They are none, or not those of its episodes.
    """
    if index is not None:
        return EpisodeShelf(houses, index)
    return HouseCache(USUAL_HOUSE if houses is None else houses)


def settings_as_stated(
    index: EpisodeIndex | None, task: TaskChoice, given: Mapping[str, Any] | None
) -> Mapping[str, Any] | None:
    """The task's settings: those of the file of episodes, and what ``given`` may choose anew.

    Raises:
        ConfigError: The file is of another task or version, or ``given`` contradicts it.
    """
    if index is None:
        return given
    stated = index.header
    if task != stated.task:
        raise ConfigError(
            f"episodes: the file is of the task {stated.task}, this environment of "
            f"{quoted(task)}; make {task_of(stated.task)['id']}"
        )
    version = task_of(stated.task)["version"]
    if version != stated.task_version:
        raise ConfigError(
            f"episodes: the file is of version {stated.task_version} of {stated.task}, this "
            f"environment of version {version}, which has other episodes"
        )
    own = plain_settings({} if given is None else mapping("task_settings", given), "task_settings")
    for name, value in own.items():
        if name not in _OF_STEPS and value != stated.task_settings.get(name, value):
            raise ConfigError(
                f"task_settings.{name} is {quoted(value)}; the episodes were made with "
                f"{quoted(stated.task_settings[name])}: leave it out, or make others; "
                f"{', '.join(_OF_STEPS)} alone may differ"
            )
    return {**stated.task_settings, **own}


def _refuse_settings(header: Header) -> None:
    """Refuses settings that are none of the task, before anybody plays by them.

    Raises:
        ConfigError: The message names the field.
    """
    task = task_of(header.task)
    if header.task_version != task["version"]:
        # Environments refuse them themselves, whatever the settings.
        return
    known = [row["name"] for row in task["settings"]]
    unknown = [name for name in header.task_settings if name not in known]
    refuse_unknown("task_settings", unknown, known)
    config = {
        "task": header.task,
        "task_settings": header.task_settings,
        "sensors": [{"kind": "gps", "settings": {}}],
    }
    # The engine checks them in a house, whichever that is.
    room = House.shoebox((3.0, 2.5, 3.0), absorption=0.5)
    _native.Batch([room.native], to_json(config), 1)


def _refuse_other(path: str, header: Header, other_path: str, other: Header) -> None:
    for name in ("task", "task_version", "task_settings"):
        one, two = getattr(header, name), getattr(other, name)
        if one != two:
            raise ConfigError(
                f"episodes: {name} of {other_path} is {quoted(two)}, that of {path} is "
                f"{quoted(one)}; files that are played together have the same"
            )


def _digest(asked: Mapping[str, Any]) -> int:
    """A short hash of what an episode asks."""
    written = json.dumps(asked, sort_keys=True).encode()
    return int.from_bytes(hashlib.blake2b(written, digest_size=8).digest(), "little")
