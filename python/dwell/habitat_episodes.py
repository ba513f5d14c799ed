"""Episodes in the files of Habitat and SoundSpaces: PointNav, ObjectNav and AudioNav.

A data set is ``SPLIT.json.gz`` alone, or with a file for each scene in ``content`` beside it. This
reads what stands there; :mod:`dwell.habitat_conversion` makes episodes of dwell of it, and
``docs/formats/habitat-episodes.md`` lists the fields.

The fields are those of habitat-lab's ``NavigationEpisode``, ``ObjectGoalNavEpisode`` and their data
sets, and of SoundSpaces' ``AudioNavDataset``. Axes are ours: +Y up, -Z ahead; rotations are
``[x, y, z, w]``.
"""

from __future__ import annotations

import dataclasses
import gzip
import math
import os
import re
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO

from dwell import ConfigError, MeasuredDataError, arguments
from dwell.arguments import (
    finite_number,
    mapping,
    number_in_range,
    point,
    quoted,
    sequence_items,
    text,
    unit_quaternion,
)
from dwell.files import open_file, parse_json

#: A file is at most so long, as it lies on the disk and as it is read, and holds so many values.
MAX_FILE_BYTES = 256 * 2**20
MAX_TEXT_BYTES = 512 * 2**20
MAX_VALUES = 16_000_000
#: How far an agent may lean at its start, degrees.
_MAX_LEAN_DEG = 5.0
#: Bytes that are unpacked at a time.
_CHUNK = 2**20
#: The folder of files by scene, where a file does not say another.
_CONTENT = "{data_path}/content/{scene}.json.gz"
#: Fields of episodes of other kinds, which are not read.
_OTHER_KINDS = {
    "instruction": "instructions (VLN)",
    "question": "questions (EQA)",
    "goal_image_id": "goals that are pictures",
    "rigid_objs": "rearrangement",
}


@dataclasses.dataclass(frozen=True)
class HabitatEpisode:
    """An episode as a file of Habitat states it.

    Attributes:
        file: The file.
        index: Its place among the file's episodes, from 0.
        task: ``PointNav``, ``ObjectNav`` or ``AudioNav``.
        episode_id: The file's own id of it.
        scene_id: The file's own name of the scene, mostly a path.
        start_position: Where the agent stands, m.
        start_yaw_deg: Where it faces, degrees, positive to the left, 0 along -Z.
        goal_positions: The point to go to, or where the things are, or below the sound, m.
        category: The category of the things; ``None`` for other goals.
        sound_id: The name of the sound; ``None`` for other goals.
        offset_s: After how many seconds it sounds.
        duration_s: For how many seconds it sounds; ``None`` where that is not stated.
        geodesic_distance: The way to the goal that the file states, m; ``None`` without one.
        num_action: How many actions the shortest way takes by the file; ``None`` without it.
    """

    file: str
    index: int
    task: str
    episode_id: str
    scene_id: str
    start_position: tuple[float, float, float]
    start_yaw_deg: float
    goal_positions: tuple[tuple[float, float, float], ...]
    category: str | None = None
    sound_id: str | None = None
    offset_s: float = 0.0
    duration_s: float | None = None
    geodesic_distance: float | None = None
    num_action: int | None = None

    @property
    def at(self) -> str:
        """Where it stands, for messages."""
        return f"{self.file}: episodes[{self.index}]"


def read(path: str | os.PathLike[str]) -> Iterator[HabitatEpisode]:
    """The episodes of a data set, in order: those of the file, then those of its scenes' files.

    Args:
        path: ``SPLIT.json.gz``, or the same unpacked (``.json``).

    Raises:
        MeasuredDataError: A file is none, or too large; the message names file, episode and field.
        OSError: The system refuses, or it is no regular file.

    Examples:
        >>> import gzip, json, tempfile
        >>> from dwell import habitat_episodes
        >>> one = {
        ...     "episode_id": "0",
        ...     "scene_id": "houses/studio.glb",
        ...     "start_position": [1.0, 0.0, 2.0],
        ...     "start_rotation": [0.0, 0.7071068, 0.0, 0.7071068],
        ...     "goals": [{"position": [3.0, 0.0, 2.0], "radius": 0.2}],
        ...     "info": {"geodesic_distance": 2.0},
        ... }
        >>> path = tempfile.mkdtemp() + "/val.json.gz"
        >>> with gzip.open(path, "wt") as file:
        ...     _ = file.write(json.dumps({"episodes": [one]}))
        >>> (found,) = habitat_episodes.read(path)
        >>> found.task, found.scene_id, round(found.start_yaw_deg), found.geodesic_distance
        ('PointNav', 'houses/studio.glb', 90, 2.0)
    """
    name = arguments.file_path("path", path)
    whole = _whole(name)
    yield from _episodes(name, whole)
    for other in _content_files(name, whole):
        yield from _episodes(other, _whole(other))


def _whole(name: str) -> dict[str, Any]:
    """The JSON object of a file."""
    try:
        with open_file(name, MAX_FILE_BYTES) as file:
            found = parse_json(_unpacked(file, name), name, MAX_VALUES, keep_constants=True)
    except ValueError as error:
        raise MeasuredDataError(str(error)) from None
    if not isinstance(found, dict) or not isinstance(found.get("episodes"), list):
        raise MeasuredDataError(
            f"{name}: episodes: found {quoted(found, 60)}; expected a data set of Habitat, "
            '{"episodes": [...]}'
        )
    return found


def _unpacked(file: BinaryIO, name: str) -> bytes:
    """The text of a file, which is unpacked where it begins as gzip does; never above the cap."""
    is_packed = file.read(2) == b"\x1f\x8b"
    file.seek(0)
    parts, size = [], 0
    source: Any = gzip.GzipFile(fileobj=file, mode="rb") if is_packed else file
    try:
        while part := source.read(_CHUNK):
            size += len(part)
            if size > MAX_TEXT_BYTES:
                raise ValueError(
                    f"{name}: more than {MAX_TEXT_BYTES} bytes when unpacked; as many are read"
                )
            parts.append(part)
    except EOFError:
        packed = os.fstat(file.fileno()).st_size
        raise ValueError(f"{name}: its {packed} bytes are no whole gzip: it was cut") from None
    except (gzip.BadGzipFile, zlib.error) as error:
        raise ValueError(f"{name}: no gzip, or a damaged one: {error}") from None
    return b"".join(parts)


def _content_files(name: str, whole: Mapping[str, Any]) -> list[str]:
    """The files of single scenes that belong to the file of a split, by name."""
    with _at(name):
        pattern = text("content_scenes_path", whole.get("content_scenes_path", _CONTENT))
        match = re.fullmatch(r"\{data_path\}/((?:[\w-]+/)*)\{scene\}([\w.-]*)", pattern)
        if match is None:
            raise ConfigError(
                f"content_scenes_path is {quoted(pattern)}; expected one as {_CONTENT}"
            )
    folder = Path(name).parent.joinpath(match[1])
    if not folder.is_dir() or folder.samefile(Path(name).parent):
        return []
    found = (one for one in folder.iterdir() if one.name.endswith(match[2] or ".json.gz"))
    return sorted(os.fspath(one) for one in found)


@contextmanager
def _at(place: str) -> Iterator[None]:
    """Errors in the block begin with a place in a file."""
    try:
        yield
    except ConfigError as error:
        raise MeasuredDataError(f"{place}: {error}") from None


def _episodes(name: str, whole: Mapping[str, Any]) -> Iterator[HabitatEpisode]:
    """The episodes of one file."""
    shared: Mapping[str, Any] = {}
    categories: Mapping[str, Any] | None = None
    with _at(name):
        if whole.get("goals_by_category") is not None:
            shared = mapping("goals_by_category", whole["goals_by_category"])
        if whole.get("category_to_task_category_id") is not None:
            told = whole["category_to_task_category_id"]
            categories = mapping("category_to_task_category_id", told)
    for index, row in enumerate(whole["episodes"]):
        with _at(f"{name}: episodes[{index}]"):
            yield _episode(name, index, row, shared, categories)


def _episode(
    name: str,
    index: int,
    row: object,
    shared: Mapping[str, Any],
    categories: Mapping[str, Any] | None,
) -> HabitatEpisode:
    if not isinstance(row, Mapping):
        raise ConfigError(f"found {quoted(row, 60)}; expected an episode, a JSON object")
    for field, kind in _OTHER_KINDS.items():
        if row.get(field) is not None:
            raise ConfigError(
                f"{field}: an episode of {kind}; PointNav, ObjectNav and AudioNav are read"
            )
    scene_id = text("scene_id", _needed(row, "scene_id"))
    goals, category = _goals(row, scene_id, shared)
    if category is not None and categories is not None and category not in categories:
        raise ConfigError(
            f"object_category is {quoted(category)}; category_to_task_category_id has "
            f"{', '.join(map(quoted, [*categories][:40]))}"
        )
    sound: dict[str, Any] = {}
    if row.get("sound_id") is not None:
        if category is not None:
            raise ConfigError(
                "sound_id: an episode with an object_category (SemanticAudioNav); AudioNav is read"
            )
        sound = _sound(row)
    task = "AudioNav" if sound else "PointNav" if category is None else "ObjectNav"
    info = row.get("info")
    told = {} if info is None else mapping("info", info)
    return HabitatEpisode(
        file=name,
        index=index,
        task=task,
        episode_id=_id(_needed(row, "episode_id")),
        scene_id=scene_id,
        start_position=point("start_position", _needed(row, "start_position")),
        start_yaw_deg=_yaw_deg("start_rotation", _needed(row, "start_rotation")),
        goal_positions=goals,
        category=category,
        geodesic_distance=_distance(told),
        num_action=_count(told),
        **sound,
    )


def _needed(row: Mapping[str, Any], field: str) -> object:
    if row.get(field) is None:
        raise ConfigError(f"{field}: missing; an episode has it")
    return row[field]


def _id(told: object) -> str:
    """An id: text, or a whole number as most files have it."""
    if isinstance(told, bool) or not isinstance(told, str | int):
        raise ConfigError(f"episode_id is {quoted(told)}; expected text or a whole number")
    return str(told)[:200]


def _goals(
    row: Mapping[str, Any], scene_id: str, shared: Mapping[str, Any]
) -> tuple[tuple[tuple[float, float, float], ...], str | None]:
    """Where the goals are, and the category of those that are things."""
    category = row.get("object_category")
    own = row.get("goals")
    at = "goals"
    if shared and category is not None and not own:
        key = f"{PurePosixPath(scene_id).name}_{category}"
        at = f"goals_by_category[{quoted(key)}]"
        if key not in shared:
            raise ConfigError(
                f"object_category is {quoted(category)}; goals_by_category has no {quoted(key)}"
            )
        own = shared[key]
    rows = sequence_items(at, own, "expected a list of goals")
    if not rows:
        raise ConfigError(f"{at} is []; expected at least one goal")
    places = []
    for k, goal in enumerate(rows):
        if not isinstance(goal, Mapping):
            raise ConfigError(f"{at}[{k}] is {quoted(goal, 60)}; expected a goal, a JSON object")
        if goal.get("position") is None:
            raise ConfigError(f"{at}[{k}].position: missing; a goal has it")
        places.append(point(f"{at}[{k}].position", goal["position"]))
        named = goal.get("object_category")
        if category is None and named is not None:
            category = named
        if named is not None and named != category:
            raise ConfigError(
                f"{at}[{k}].object_category is {quoted(named)}; the episode's is {quoted(category)}"
            )
    if category is None:
        if len(places) > 1:
            raise ConfigError(f"{at}: {len(places)} points; one is read")
        return tuple(places), None
    return tuple(places), text("object_category", category)


def _sound(row: Mapping[str, Any]) -> dict[str, Any]:
    duration = row.get("duration")
    return {
        "sound_id": text("sound_id", row["sound_id"]),
        "offset_s": _seconds("offset", row.get("offset") or 0.0),
        "duration_s": None if duration is None else _seconds("duration", duration),
    }


def _seconds(name: str, value: object) -> float:
    """Seconds; SoundSpaces has files with numbers and with text that is one."""
    if isinstance(value, str) and re.fullmatch(r"[0-9]{1,9}(\.[0-9]{1,9})?", value):
        value = float(value)
    return number_in_range(name, value, 0.0, 1e6, "s")


def _distance(info: Mapping[str, Any]) -> float | None:
    """The stated way; where there was none to be found, Habitat states an infinite one or none."""
    value = info.get("geodesic_distance")
    if value is None or value == math.inf:
        return None
    return number_in_range("info.geodesic_distance", value, 0.0, 1e6)


def _count(info: Mapping[str, Any]) -> int | None:
    value = info.get("num_action")
    return None if value is None else arguments.integer_in_range("info.num_action", value)


def _yaw_deg(name: str, value: object) -> float:
    """The heading of a rotation ``[x, y, z, w]`` about the vertical axis, degrees.

    Raises:
        ConfigError: It is none, or leans.
    """
    rows = sequence_items(name, value, "expected a rotation [x, y, z, w]")
    x, y, z, w = unit_quaternion(
        name, [finite_number(f"{name}[{k}]", v) for k, v in enumerate(rows)]
    )
    up = 1.0 - 2.0 * (x * x + z * z)
    if up < math.cos(math.radians(_MAX_LEAN_DEG)):
        lean_deg = math.degrees(math.acos(max(-1.0, up)))
        raise ConfigError(
            f"{name} leans by {lean_deg:.0f} degrees; an agent stands upright, and a rotation is "
            "[x, y, z, w]"
        )
    return math.degrees(math.atan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x * x + y * y)))
