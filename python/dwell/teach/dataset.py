"""A recording as a folder: users, their clips, and a list of all; one that was stopped goes on."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from dwell import ConfigError
from dwell.arguments import file_path, quoted
from dwell.files import atomic_write, is_draft, make_folder, open_exclusive, read_json
from dwell.teach.plan import ClipPlan, clip_plans
from dwell.teach.play import play
from dwell.teach.scene import stage
from dwell.teach.session import open_session
from dwell.teach.settings import TeachSettings
from dwell.teach.things import POOL, THINGS_OF_A_USER
from dwell.teach.users import UserParameters, user_parameters
from dwell.teach.writer import LABEL, missing_file, write_clip

#: What the folder holds beside those of users.
DATASET, MANIFEST, USER = "dataset.json", "manifest.jsonl", "user.json"
_LOCK = ".recording"
FORMAT, VERSION = "dwell-teach", 1

Progress = Callable[[float, str], None]


@dataclasses.dataclass(frozen=True)
class Clip:
    """A clip of a recording.

    Attributes:
        user: Who teaches.
        plan: What is drawn of it.
    """

    user: UserParameters
    plan: ClipPlan

    @property
    def folder(self) -> str:
        """Its folder below the recording's."""
        return f"{user_folder(self.user)}/{self.plan.folder}"


def user_folder(user: UserParameters) -> str:
    """The folder of a user's clips."""
    return f"user_{user.number:02}"


def clips_of(settings: TeachSettings) -> Iterator[Clip]:
    """All clips of a recording, in the order in which they are played."""
    for number in range(1, settings.users + 1):
        user = user_parameters(settings, number, pool=len(POOL), things=THINGS_OF_A_USER)
        for plan in clip_plans(settings, user):
            yield Clip(user, plan)


def record(
    out: str | os.PathLike[str],
    settings: TeachSettings | None = None,
    *,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Records what is not there yet; a recording that was stopped ends up with the same bytes.

    Args:
        out: The folder; an empty or a new one, or one that the same settings have begun.
        settings: What is recorded.
        progress: Told how much is there, 0 to 1, and what was done last.

    Returns:
        ``clips``, ``recorded_now`` and ``manifest``, the path of the list of all clips.

    Raises:
        ValueError: The folder holds something else or was begun with other settings, or another
            process records into it.
        OSError: The system refuses.
        DwellError: The house cannot be opened, or has no place for the table.
    """
    settings = TeachSettings() if settings is None else settings
    if not isinstance(settings, TeachSettings):
        raise ConfigError(f"settings is {quoted(settings)}; expected TeachSettings")
    folder = Path(file_path("out", out))
    # Before the folder is begun; who goes on needs the house as it was.
    house, _ = stage(settings.house)
    whole = {
        "format": FORMAT,
        "version": VERSION,
        **settings.as_dict(),
        "house_contents": f"{hash(house):x}",
    }
    _refuse_other(folder, whole)
    make_folder(folder)
    with _locked(folder):
        _refuse_other(folder, whole)
        if not (folder / DATASET).exists():
            _write_json(folder / DATASET, whole)
        rows, made = [], 0
        count = settings.users * settings.clips
        for done, clip in enumerate(clips_of(settings)):
            _write_user(folder, clip)
            label = _label_there(folder / clip.folder, settings)
            if label is None:
                label = _record_clip(folder, settings, clip)
                made += 1
            rows.append(_row(clip, label))
            if progress is not None:
                progress((done + 1) / count, clip.folder)
        with atomic_write(folder / MANIFEST) as draft:
            draft.write_text("".join(json.dumps(row) + "\n" for row in rows), "utf-8")
    return {"clips": count, "recorded_now": made, "manifest": os.fspath(folder / MANIFEST)}


def _record_clip(folder: Path, settings: TeachSettings, clip: Clip) -> dict[str, Any]:
    session = open_session(settings, clip.user, clip.plan)
    return write_clip(folder / clip.folder, session, play(session))


def _write_user(folder: Path, clip: Clip) -> None:
    """Writes the parameters of a clip's user, where they are not there."""
    user = folder / user_folder(clip.user) / USER
    if not user.exists():
        _write_json(user, clip.user.as_dict())


def _label_there(place: Path, settings: TeachSettings) -> dict[str, Any] | None:
    """The label of a clip that is whole; folders get their name when they are.

    Raises:
        ValueError: Something else stands there, or a file is missing or cut.
    """
    if not os.path.lexists(place):
        return None
    anew = f"remove {place}, and the clip is recorded anew"
    try:
        label = read_json(place / LABEL)
    except FileNotFoundError:
        raise ValueError(f"{place} has no {LABEL}: it is no clip, or was changed; {anew}") from None
    except ValueError as error:
        raise ValueError(f"{error}; {anew}") from None
    if not isinstance(label, dict):
        raise ValueError(f"{place / LABEL}: expected an object, found {label!r:.60}; {anew}")
    if missing := missing_file(place, label, settings.form):
        raise ValueError(f"{place / missing} is missing or cut; {anew}")
    return label


def _row(clip: Clip, label: dict[str, Any]) -> dict[str, Any]:
    """The line of a clip in the list of all."""
    try:
        return {
            "folder": clip.folder,
            "user": clip.user.number,
            "type": label["type"],
            "target": label["target"]["name"],
            "id": label["target"]["id"],
            "phrase": label["speech"]["phrase"],
            "first_word": label["speech"]["first_word"],
            "frames": label["frames"]["count"],
        }
    except (KeyError, TypeError) as error:
        at = f"{clip.folder}/{LABEL}"
        raise ValueError(f"{at}: expected the label of a clip; {error} is missing") from None


def _refuse_other(folder: Path, whole: dict[str, Any]) -> None:
    """Refuses a folder with something else in it, and leaves it as it is.

    Raises:
        ValueError: It holds something else, or was begun with other settings.
    """
    file = folder / DATASET
    if not file.exists():
        if folder.is_dir():
            others = (n for n in os.listdir(folder) if not is_draft(n) and n != _LOCK)
            other = next(others, None)
            # What another process has just begun is no other thing than this.
            if other and not file.exists():
                raise ValueError(
                    f"{folder} holds something else ({other}); expected an empty or a new folder"
                )
        if not file.exists():
            return
    found = read_json(file)
    if not isinstance(found, dict):
        raise ValueError(f"{file}: expected an object, found {found!r:.60}")
    other_fields = [key for key in whole if found.get(key) != whole[key]]
    if other_fields:
        said = ", ".join(f"{key} {found.get(key)!r:.60}" for key in other_fields)
        raise ValueError(
            f"{folder} was begun with {said}; name another folder, or give the same again"
        )


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Keeps other processes from recording into a folder.

    Raises:
        ValueError: One does.
    """
    file = folder / _LOCK
    try:
        lock = open_exclusive(file)
    except ValueError:
        raise ValueError(
            f"{folder} is being recorded into by another process; wait for its end, or name "
            "another folder"
        ) from None
    with lock:
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                os.unlink(file)


def _write_json(file: Path, value: dict[str, Any]) -> None:
    with atomic_write(file) as draft:
        draft.write_text(json.dumps(value, indent=1) + "\n", "utf-8")
