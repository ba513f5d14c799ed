"""Episodes as files: played again to the same bits, and seen and heard with other sensors."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell import MeasuredDataError, UsageError, _native
from dwell.arguments import mapping, text, texts, to_json, whole
from dwell.cli.common import atomic
from dwell.house import House

if TYPE_CHECKING:
    from dwell.envs.custom import RewardChoice, TaskChoice
    from dwell.envs.runner import Runner
    from dwell.world import World

#: What a file says of itself.
_FORMAT, _VERSION = "dwell-replay", 1
#: More than any episode is long.
_MOST_STEPS = 10_000_000
#: A file larger than this is none of ours, bytes.
_MOST_BYTES = 2**30


@dataclasses.dataclass(frozen=True)
class Moment:
    """An episode at one step.

    Attributes:
        step: How many steps were made.
        action: The name of the last action; ``None`` at the start.
        reward: What the last step gave; 0 at the start.
        world: The world as it is, to look at and listen to; the same object at every step.
        is_same: Whether its bits are those that were recorded; not once somebody has listened to
            ``world``, since the sound that ears keep is among them.
    """

    step: int
    action: str | None
    reward: float
    world: World
    is_same: bool


@dataclasses.dataclass(frozen=True)
class Replay:
    """A recorded episode: what it was played in, and every action.

    Attributes:
        house: The HOUSE string.
        seed: The episode's seed.
        config: Task, sensors, laws, parameters and rates as JSON for the native side.
        parts: Names of the classes of the Python parts it was played with, empty for most.
        actions: Names of the actions, in order.
        hashes: The state's hash at the start and after each action, hexadecimal.
        instruction: What was asked.
        success: Whether it was done at the end.
        made_by: The version of dwell that recorded it.
    """

    house: str
    seed: int
    config: str
    parts: tuple[str, ...]
    actions: tuple[str, ...]
    hashes: tuple[str, ...]
    instruction: str
    success: bool
    made_by: str

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Replay:
        """Reads a file.

        Raises:
            MeasuredDataError: It is no replay, of a later version, or its numbers do not fit.
        """
        path = Path(path)
        if path.exists() and path.stat().st_size > _MOST_BYTES:
            raise MeasuredDataError(f"{path} is larger than {_MOST_BYTES} bytes")
        try:
            row = json.loads(path.read_bytes())
            if not isinstance(row, dict) or row.get("format") != _FORMAT:
                raise MeasuredDataError(f"{path}: no {_FORMAT} file")
            if row.get("version") != _VERSION:
                raise MeasuredDataError(
                    f"{path}: version is {row.get('version')!r}; this dwell reads {_VERSION}"
                )
            known = {field.name for field in dataclasses.fields(cls)} | {"format", "version"}
            if wrong := sorted(known ^ set(row)):
                what = "unknown" if wrong[0] in row else "missing"
                raise MeasuredDataError(f"{path}: field {wrong[0]!r} is {what}")
            replay = cls(
                house=text("house", row["house"]),
                seed=whole("seed", row["seed"]),
                config=to_json(mapping("config", row["config"])),
                parts=tuple(texts("parts", row["parts"])),
                actions=tuple(texts("actions", row["actions"])),
                hashes=tuple(texts("hashes", row["hashes"])),
                instruction=text("instruction", row["instruction"]),
                success=row["success"] is True,
                made_by=text("made_by", row["made_by"]),
            )
        except MeasuredDataError:
            raise
        except (ValueError, RecursionError) as error:
            raise MeasuredDataError(f"{path}: {error}") from None
        replay.check(str(path))
        return replay

    def check(self, at: str = "replay") -> None:
        """Refuses actions that do not exist, and hashes that are not one more than actions.

        Raises:
            MeasuredDataError: The message begins with ``at``.
        """
        names = _native.actions()
        for k, action in enumerate(self.actions):
            if action not in names:
                raise MeasuredDataError(
                    f"{at}: actions[{k}] is {action!r}; allowed are {', '.join(names)}"
                )
        if len(self.hashes) != len(self.actions) + 1 or len(self.actions) > _MOST_STEPS:
            raise MeasuredDataError(
                f"{at}: {len(self.actions)} actions and {len(self.hashes)} hashes; expected at "
                f"most {_MOST_STEPS} actions and one hash more"
            )

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a file, whole or not at all."""
        row = {"format": _FORMAT, "version": _VERSION, **dataclasses.asdict(self)}
        row["config"] = json.loads(self.config)
        with atomic(Path(path)) as draft:
            draft.write_text(json.dumps(row, indent=1) + "\n", "utf-8")

    def play(
        self,
        *,
        task: TaskChoice | None = None,
        reward: RewardChoice = None,
        renderer: str | None = None,
        house: House | None = None,
    ) -> Iterator[Moment]:
        """Plays the episode again, step by step, the start first.

        Args:
            task: The Python task it was played with, if it was; a file never says what to import.
            reward: The Python reward it was played with.
            renderer: Who makes pictures now; default as it was.
            house: The house, if it is open already.

        Raises:
            HouseError: The house cannot be opened.
            UsageError: It was played with parts in Python that are not given.
        """
        runner = self._runner(task, reward, renderer, house)
        from dwell.world import World

        runner.reset([self.seed])
        world = World.of_env(runner.houses[0], runner.batch.world(0))
        yield self._moment(0, 0.0, world)
        numbers = {name: number for number, name in enumerate(_native.actions())}
        for step, action in enumerate(self.actions, 1):
            answer, _ = runner.step(np.array([numbers[action]], np.int64))
            yield self._moment(step, float(answer["reward"][0]), world)

    def _runner(
        self,
        task: TaskChoice | None,
        reward: RewardChoice,
        renderer: str | None,
        house: House | None,
    ) -> Runner:
        from dwell.envs.custom import Custom, split
        from dwell.envs.runner import Runner

        given, custom = [], Custom()
        if task is not None or reward is not None:
            _, custom = split("Free" if task is None else task, None, reward, None)
            given = [
                type(make()).__name__ for make in (custom.task, custom.reward) if make is not None
            ]
        if given != [*self.parts]:
            raise UsageError(
                f"this episode was played with {[*self.parts] or 'no parts in Python'}, given are "
                f"{given or 'none'}; task= and reward= take them"
            )
        config = json.loads(self.config)
        if renderer is not None:
            config["world"] = {**config.get("world", {}), "renderer": renderer}
        opened = House.open(self.house) if house is None else house
        return Runner([opened], to_json(config), None, custom=custom)

    def _moment(self, step: int, reward: float, world: World) -> Moment:
        return Moment(
            step=step,
            action=self.actions[step - 1] if step else None,
            reward=reward,
            world=world,
            is_same=f"{world.state_hash():016x}" == self.hashes[step],
        )

    def first_difference(self, **parts: Any) -> int | None:  # noqa: ANN401 - as :meth:`play`
        """The first step after which bits differ from those recorded; ``None`` if none do.

        Args:
            **parts: As :meth:`play`.
        """
        for moment in self.play(**parts):
            if not moment.is_same:
                return moment.step
        return None
