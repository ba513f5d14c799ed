"""Episodes of Habitat and SoundSpaces as episodes of dwell: in our houses, by our distances.

Each states its start and goal. It is begun once, in the house that stands for its scene: what the
house does not have is told, and the way to the goal stands beside the one that Habitat states.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from dwell import ConfigError, HouseError, MeasuredDataError, _native
from dwell.arguments import (
    abbreviated_list,
    allowed_values,
    boolean,
    choice,
    file_path,
    mapping,
    number_in_range,
    point,
    quoted,
    text,
    text_list,
)
from dwell.episode_maker import begun_episode, expert_run, sensors_of_goals, whole_settings
from dwell.episodes import Episode, Header, task_of
from dwell.habitat_episodes import HabitatEpisode, read
from dwell.house import House
from dwell.navigation import Walker

if TYPE_CHECKING:
    from dwell.envs.native_batch import NativeBatch

#: Endings of houses in a folder; of a ``*.scene_instance.json`` the name before is the scene's.
_HOUSES = (".dwell", ".glb", ".gltf", ".scene_instance.json", ".house.json", ".json", ".xml")
#: The classes of categories of Habitat that have other names here, or are divided: what an episode
#: tells, then what counts as it.
_CLASSES: dict[str, tuple[str, ...]] = {
    "bed": ("bed", "double_bed", "single_bed", "bunker_bed", "baby_bed"),
    "chair": ("chair", "armchair", "office_chair"),
    "table": ("table", "coffee_table", "dining_table", "desk"),
    "tv_monitor": ("television",),
}
#: How the engine says that a point is none to stand on.
_START, _GOAL = "episode.start.position is", "episode.goal.position is"
#: How far ways may differ and count as the same: a share of the longer one, and m.
_SAME_SHARE, _SAME_M = 0.1, 0.3

Houses = Mapping[str, str] | str | os.PathLike[str]


@dataclasses.dataclass
class Comparison:
    """What Habitat states of the ways to goals, against ours.

    Attributes:
        converted: How many episodes were converted.
        skipped: Why others were not, by where they stand.
        moved: How many starts and goals were moved to the nearest place to stand.
        compared: How many ways are stated.
        mean_m: By how much they differ on average, m, without signs.
        most_m: By how much they differ at most, m.
        differing: Those that differ by more than 10 % and 0.3 m: where they stand, the way that is
            stated and ours, m.
    """

    converted: int = 0
    skipped: dict[str, str] = dataclasses.field(default_factory=dict)
    moved: int = 0
    compared: int = 0
    mean_m: float = 0.0
    most_m: float = 0.0
    differing: dict[str, tuple[float, float]] = dataclasses.field(default_factory=dict)

    def add(self, at: str, stated_m: float | None, found_m: float | None) -> None:
        """Compares the ways of an episode."""
        self.converted += 1
        if stated_m is None or found_m is None:
            return
        off_m = abs(stated_m - found_m)
        self.mean_m = (self.mean_m * self.compared + off_m) / (self.compared + 1)
        self.compared += 1
        self.most_m = max(self.most_m, off_m)
        if off_m > _SAME_M and off_m > _SAME_SHARE * max(stated_m, found_m):
            self.differing[at] = (stated_m, found_m)


def _refuse_unread(task: str, **told: Mapping[str, bool]) -> None:
    """Refuses options that were given and are of the episodes of another task.

    Args:
        task: That of the episodes.
        **told: By the name of a task its options, and whether they were given.
    """
    for other, options in told.items():
        given = [name for name, is_given in options.items() if is_given]
        if other != task and given:
            raise ConfigError(
                f"{given[0]} is given, and is read for episodes of {other}; these are of {task}"
            )


class HabitatConverter:
    """Converts a data set of Habitat or SoundSpaces.

    Examples:
        >>> import gzip, json, tempfile
        >>> import dwell
        >>> from dwell.habitat_conversion import HabitatConverter
        >>> goals = [{"object_id": "1", "position": [0.0, 0.5, 0.0], "object_category": "sofa"}]
        >>> one = {
        ...     "episode_id": "0",
        ...     "scene_id": "scenes/studio.glb",
        ...     "start_position": [1.25, 0.0, 2.05],
        ...     "start_rotation": [0.0, 0.0, 0.0, 1.0],
        ...     "goals": goals,
        ... }
        >>> folder = tempfile.mkdtemp()
        >>> with gzip.open(f"{folder}/val.json.gz", "wt") as file:
        ...     _ = file.write(json.dumps({"episodes": [one]}))
        >>> converter = HabitatConverter(
        ...     f"{folder}/val.json.gz", {"studio": "builtin:studio"}, snap_m=5.0
        ... )
        >>> dwell.episodes.write(f"{folder}/val.jsonl", converter.header, converter.episodes())
        1
        >>> (found,) = dwell.episodes.read(f"{folder}/val.jsonl")
        >>> found.episode_id, found.goal, found.instruction
        ('builtin:studio#0', {'class': 'sofa'}, 'Find a sofa.')
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        houses: Houses,
        *,
        task: str | None = None,
        task_settings: Mapping[str, Any] | None = None,
        snap_m: float = 0.0,
        move: tuple[float, float, float] = (0.0, 0.0, 0.0),
        instances: Literal["class", "stated"] = "class",
        classes: Mapping[str, str | Sequence[str]] | None = None,
        sounds: Mapping[str, str] | None = None,
        sound_root: str | os.PathLike[str] | None = None,
        everlasting: bool = False,
        expert: bool = False,
        on_skip: Callable[[str, str], None] = lambda at, sentence: None,
    ) -> None:
        """Reads the first episode, which says of which task they are; opens no house.

        Args:
            path: The data set, as :func:`dwell.habitat_episodes.read` takes it.
            houses: HOUSE strings by scene: by the file's own ``scene_id``, by the name of its file
                or folder, or by that name up to its first dot. Or a folder with a house for each
                scene, of that name.
            task: The task; default the one that the episodes are of. Another is refused.
            task_settings: The task's settings. Doors stand open unless they say otherwise: agents
                of Habitat do not open them.
            snap_m: How far a start or goal on which nobody can stand is moved at most, m.
            move: What is added to all places, m, where a house has another origin than its scene.
            instances: Which things count: all of the ``class``, or those that are ``stated``, by
                where they are.
            classes: Classes of dwell by categories of the file, where their names differ: one, or
                the one that is told and those that count as it.
            sounds: Signals by ``sound_id``, where their names differ.
            sound_root: A folder with the sounds as files, in place of signals; environments that
                play the episodes need it as ``world={"sound_root": ...}``.
            everlasting: Whether sounds sound from the start to the end, whatever the file states.
            expert: Whether the task's expert plays each episode, for ``expert_actions``.
            on_skip: Is told of each episode that is skipped, and why.

        Raises:
            MeasuredDataError: The file is none, or holds no episode.
            ConfigError: An argument is wrong, or the episodes are of another task.
            OSError: The system refuses.
        """
        self._path = file_path("path", path)
        first = next(read(self._path), None)
        if first is None:
            raise MeasuredDataError(f"{self._path}: episodes: there are none")
        if task is not None and task != first.task:
            raise ConfigError(
                f"task is {quoted(task)}; the episodes of {self._path} are of {first.task}"
            )
        self._scenes = _Scenes(houses)
        self._snap_m = number_in_range("snap_m", snap_m, 0.0, 100.0, "m")
        self._move = point("move", move)
        self._instances = choice("instances", instances, ("class", "stated"))
        self._classes = _classes(classes)
        self._sounds = _texts("sounds", sounds)
        self._sound_root = None if sound_root is None else file_path("sound_root", sound_root)
        self._everlasting = boolean("everlasting", everlasting)
        self._expert = boolean("expert", expert)
        self._on_skip = on_skip
        _refuse_unread(
            first.task,
            ObjectNav={"instances": instances != "class", "classes": bool(self._classes)},
            AudioNav={
                "sounds": bool(self._sounds),
                "sound_root": sound_root is not None,
                "everlasting": self._everlasting,
            },
        )
        about = task_of(first.task)
        self._max_steps = int(about["max_steps"])
        self.comparison = Comparison()
        self.header = Header(
            task=first.task,
            task_version=int(about["version"]),
            task_settings=whole_settings(
                first.task, {"open_doors": True, **({} if task_settings is None else task_settings)}
            ),
            houses=tuple(self._scenes.named()),
            seed=0,
            count=0,
        )

    def episodes(self, most: int | None = None) -> Iterator[Episode]:
        """The episodes in order, each begun once; those that cannot begin are skipped.

        :attr:`comparison` says afterwards how they compare.

        Args:
            most: After how many converted episodes to stop.

        Raises:
            MeasuredDataError: An episode is none, or of another task or of an unknown scene,
                category or sound; the message names file, episode and field.
            ConfigError: None can be played.
        """
        comparison = self.comparison = Comparison()
        sentence = ""
        house: tuple[str, NativeBatch | None, str] = ("", None, "")
        for number, one in enumerate(read(self._path)):
            if most is not None and comparison.converted >= most:
                return
            if one.task != self.header.task:
                raise MeasuredDataError(
                    f"{one.at}: an episode of {one.task} among those of {self.header.task}"
                )
            stated = self._stated(one)
            with _Place(one.at):
                name = self._scenes.house(one.scene_id)
            if name != house[0]:
                house = (name, *self._env(name))
            _, env, sentence = house
            found = sentence if env is None else self._begun(env, name, number, one, stated)
            if isinstance(found, str):
                sentence = found
                comparison.skipped[one.at] = found
                self._on_skip(one.at, found)
                continue
            comparison.add(one.at, one.geodesic_distance, found.start_distance_to_goal)
            yield found
        if not comparison.converted:
            raise ConfigError(
                f"{self._path}: none of {len(comparison.skipped)} episodes can be played in these "
                f"houses; the last: {sentence}"
            )

    def _env(self, name: str) -> tuple[NativeBatch | None, str]:
        """An environment in a house, or why there is none."""
        from dwell.envs.config import env_json
        from dwell.envs.native_batch import NativeBatch
        from dwell.envs.python_tasks import NativeSettings

        header = self.header
        native = NativeSettings(header.task, header.task_settings, sensors_of_goals(header.task))
        world = None if self._sound_root is None else {"sound_root": self._sound_root}
        try:
            return NativeBatch([House.open(name)], env_json(native, world=world), None), ""
        except HouseError as error:
            return None, str(error)

    def _begun(
        self,
        env: NativeBatch,
        name: str,
        seed: int,
        one: HabitatEpisode,
        stated: dict[str, dict[str, Any]],
    ) -> Episode | str:
        """The episode as it begins, or why it does not; ``stated`` is what it states, moved."""
        moved = 0
        # Start and goal are each moved once.
        for _ in range(3):
            try:
                env.reset([seed], stated=[stated])
                break
            except ConfigError as error:
                part = next(
                    (k for k, told in (("start", _START), ("goal", _GOAL)) if told in str(error)),
                    None,
                )
                near = None if part is None else self._snapped(env, stated[part]["position"])
                if part is None or near is None or moved == 2:
                    return str(error)
                stated[part]["position"] = near
                moved += 1
        found = begun_episode(env, name, seed)
        self.comparison.moved += moved
        expert = expert_run(env, self._max_steps) if self._expert else {}
        return dataclasses.replace(
            found,
            start=stated["start"],
            goal=stated["goal"],
            source_id=f"{Path(one.file).name}#{one.episode_id}",
            source_distance_to_goal=one.geodesic_distance,
            **expert,
        )

    def _snapped(self, env: NativeBatch, place: list[float]) -> list[float] | None:
        """The nearest point on which the agent can stand, where it is as near as is allowed."""
        if self._snap_m <= 0.0:
            return None
        body = _native.World.of_env(env.batch, 0).config()["agents"][0]
        walker = Walker(
            radius_m=body["radius_m"],
            height_m=body["height_m"],
            step_m=body["step_height_m"],
            doors="open",
        )
        points = env.houses[0].navigation(walker).points()
        if not len(points):
            return None
        away_m = np.linalg.norm(points.astype(np.float64) - np.array(place), axis=1)
        nearest = int(away_m.argmin())
        if away_m[nearest] > self._snap_m:
            return None
        return [float(value) for value in points[nearest]]

    def _stated(self, one: HabitatEpisode) -> dict[str, dict[str, Any]]:
        """What an episode states, as the engine takes it."""
        start = {"position": self._moved(one.start_position), "yaw_deg": one.start_yaw_deg}
        if one.category is not None:
            with _Place(one.at):
                goal = _class_goal(one.category, self._classes)
            if self._instances == "stated":
                goal["positions"] = [self._moved(place) for place in one.goal_positions]
            return {"start": start, "goal": goal}
        goal = {"position": self._moved(one.goal_positions[0])}
        if one.sound_id is not None:
            with _Place(one.at):
                goal |= self._sound(one.sound_id)
            if one.offset_s and not self._everlasting:
                goal["offset_s"] = one.offset_s
            if one.duration_s is not None and not self._everlasting:
                goal["duration_s"] = one.duration_s
        return {"start": start, "goal": goal}

    def _sound(self, sound_id: str) -> dict[str, str]:
        """The sound of a name of SoundSpaces, which has files."""
        if self._sound_root is not None:
            return {"sound_file": self._sounds.get(sound_id, sound_id)}
        stem = PurePosixPath(sound_id).name.partition(".")[0]
        name = self._sounds.get(sound_id, self._sounds.get(stem, stem))
        known = [row["name"] for row in _native.signals()]
        if name not in known:
            raise ConfigError(
                f"sound_id is {quoted(sound_id)}; map it to a signal (sounds=, --sounds "
                f"{stem}=SIGNAL), or give the folder of sound files (sound_root=, --sound-root): "
                f"{allowed_values(name, known)}"
            )
        return {"sound": name}

    def _moved(self, place: tuple[float, float, float]) -> list[float]:
        return [value + offset for value, offset in zip(place, self._move, strict=True)]


class _Place:
    """Errors in the block begin with a place in a file."""

    def __init__(self, at: str) -> None:
        self._at = at

    def __enter__(self) -> None:
        """Begins."""

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        """Names the place."""
        if isinstance(error, ConfigError):
            raise MeasuredDataError(f"{self._at}.{error}") from None


class _Scenes:
    """The houses that stand for scenes."""

    def __init__(self, houses: Houses) -> None:
        """Reads the names of a folder's houses, or keeps a mapping."""
        self._folder: str | None = None
        if isinstance(houses, Mapping):
            self._by_name = _texts("houses", houses)
            if not self._by_name:
                raise ConfigError("houses is {}; expected HOUSE strings by scene, or a folder")
            return
        self._folder = file_path("houses", houses)
        found: dict[str, list[str]] = {}
        with os.scandir(self._folder) as rows:
            names = sorted(row.name for row in rows)
        for name in names:
            ending = next((end for end in _HOUSES if name.endswith(end)), None)
            if ending is not None and not name.startswith("."):
                own = os.path.join(self._folder, name)
                found.setdefault(name.partition(".")[0], []).append(own)
        several = next((rows for rows in found.values() if len(rows) > 1), None)
        if several is not None:
            raise ConfigError(
                f"houses: {abbreviated_list(several)} are of one scene; give a mapping "
                "(SCENE=HOUSE) that says which is meant"
            )
        self._by_name = {stem: own for stem, (own,) in found.items()}
        if not self._by_name:
            raise ConfigError(
                f"houses: {quoted(self._folder)} holds no house (*{', *'.join(_HOUSES)})"
            )

    def named(self) -> list[str]:
        """All the houses."""
        return list(dict.fromkeys(self._by_name.values()))

    def house(self, scene_id: str) -> str:
        """The house of a scene.

        Raises:
            ConfigError: There is none.
        """
        parts = PurePosixPath(scene_id.replace("\\", "/")).parts
        # A scene of Replica is named by its folder, all others by their files.
        for name in (
            scene_id,
            *reversed(parts),
            *(part.partition(".")[0] for part in reversed(parts)),
        ):
            if name in self._by_name:
                return self._by_name[name]
        where = "the mapping" if self._folder is None else f"the folder {quoted(self._folder)}"
        raise ConfigError(
            f"scene_id is {quoted(scene_id)}; {where} has houses of "
            f"{abbreviated_list([*self._by_name])}"
        )


def _texts(name: str, given: Mapping[str, str] | None) -> dict[str, str]:
    rows = {} if given is None else mapping(name, given, "names by name")
    return {key: text(f"{name}[{quoted(key)}]", value) for key, value in rows.items()}


def _classes(given: Mapping[str, str | Sequence[str]] | None) -> dict[str, tuple[str, ...]]:
    rows = {} if given is None else mapping("classes", given, "classes by category")
    found: dict[str, tuple[str, ...]] = {}
    for key, value in rows.items():
        at = f"classes[{quoted(key)}]"
        found[key] = (value,) if isinstance(value, str) else tuple(text_list(at, value))
        if not found[key]:
            raise ConfigError(f"{at} is {quoted(value)}; expected at least one class")
    return found


def _class_goal(category: str, mapped: Mapping[str, tuple[str, ...]]) -> dict[str, Any]:
    """The goal of a category of Habitat.

    Raises:
        ConfigError: There is no such class; the message says how a category is mapped.
    """
    names = []
    for word in mapped.get(category, _CLASSES.get(category, (category,))):
        name = _native.object_class(word)
        if name is None:
            raise ConfigError(
                f"object_category is {quoted(category)}; map it to a class (classes=, --classes "
                f"{category}=CLASS): {allowed_values(word, _native.object_classes())}"
            )
        names.append(name)
    return {"class": names[0], **({"also": names[1:]} if names[1:] else {})}
