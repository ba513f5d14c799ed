"""A clip as a folder of files, whole or not at all."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from dwell.files import errors_named, is_whole, make_folder
from dwell.sounds import write_wav
from dwell.teach.cameras import MOUNTS
from dwell.teach.labels import MASK_VALUES, KeyFrame
from dwell.teach.play import PlayedClip
from dwell.teach.session import Session
from dwell.teach.things import POOL

#: The label's file, and what it calls itself.
LABEL = "label.json"
FORMAT, VERSION = "dwell-teach-clip", 1
#: The pressure of a full sample of the sound, Pa: a shout at the ear.
FULL_SCALE_PA = 4.0


@contextlib.contextmanager
def whole_folder(place: Path) -> Iterator[Path]:
    """A folder in the making that becomes ``place`` when all went well, and is gone otherwise.

    Raises:
        OSError: The system refuses.
    """
    make_folder(place.parent)
    draft = place.with_name(f".{place.name}.partial-0")
    with errors_named(place):
        # What a killed process has left; the recording's lock says that it is not alive.
        if draft.exists():
            shutil.rmtree(draft)
        draft.mkdir()
        try:
            yield draft
            os.replace(draft, place)
        except BaseException:
            shutil.rmtree(draft, ignore_errors=True)
            raise


def write_clip(place: Path, session: Session, clip: PlayedClip) -> dict[str, Any]:
    """Writes a clip's pictures, sound, masks and label; returns the label."""
    label = clip_label(session, clip)
    with whole_folder(place) as folder:
        for mount in MOUNTS:
            pictures: dict[str, list[Any]] = {"rgb": clip.rgb[mount.name]}
            if mount.has_depth:
                pictures["depth"] = clip.depth[mount.name]
            _write_pictures(folder, mount.name, pictures, session.settings.form)
        make_folder(folder / "masks")
        for key in clip.key_frames:
            for name, view in key.views.items():
                Image.fromarray(view.mask).save(folder / mask_name(name, key), format="PNG")
        # What is louder is cut off there.
        sound = np.clip(clip.sound, -FULL_SCALE_PA, FULL_SCALE_PA)
        rate_hz = session.settings.sound_rate_hz
        write_wav(folder / "audio.wav", sound, rate_hz, full_scale_pa=FULL_SCALE_PA)
        (folder / "speech.txt").write_text(session.phrase.text + "\n", "utf-8")
        (folder / LABEL).write_text(json.dumps(label, indent=1) + "\n", "utf-8")
    return label


def missing_file(place: Path, label: dict[str, Any], form: str) -> str | None:
    """The first file of a written clip, below its folder, that is not there or cut."""
    try:
        frames = range(int(label["frames"]["count"]))
        masks = [str(view["mask"]) for key in label["key_frames"] for view in key["views"].values()]
    except (KeyError, TypeError, ValueError, AttributeError):
        # Whoever lists the clips says what a label lacks.
        return None
    names = itertools.chain(("audio.wav", "speech.txt", *masks), _picture_files(frames, form))
    return next((name for name in names if not is_whole(place / name)), None)


def _picture_files(frames: range, form: str) -> Iterator[str]:
    for mount in MOUNTS:
        if form == "npz":
            yield f"{mount.name}.npz"
            continue
        for channel in ("rgb", "depth") if mount.has_depth else ("rgb",):
            for number in frames:
                yield picture_name(mount.name, channel, number)


def picture_name(camera: str, channel: str, frame: int) -> str:
    """The file of a picture below the clip's folder."""
    return f"{camera}/{channel}/{frame:06}.png"


def mask_name(camera: str, key: KeyFrame) -> str:
    """The file of a mask below the clip's folder."""
    return f"masks/{camera}_{key.frame:06}.png"


def _write_pictures(folder: Path, name: str, pictures: dict[str, list[Any]], form: str) -> None:
    if form == "npz":
        arrays: dict[str, Any] = {channel: np.stack(rows) for channel, rows in pictures.items()}
        np.savez_compressed(folder / f"{name}.npz", **arrays)
        return
    for channel, frames in pictures.items():
        make_folder(folder / name / channel)
        for number, picture in enumerate(frames):
            file = folder / picture_name(name, channel, number)
            Image.fromarray(picture).save(file, format="PNG")


def clip_label(session: Session, clip: PlayedClip) -> dict[str, Any]:
    """What a label says; ``docs/teach.md`` lists the fields."""
    settings, plan, user = session.settings, session.plan, session.user
    objects = {row["name"]: row for row in session.world.objects()}
    times = {name: round(t, 4) for name, t in vars(plan.timeline).items()}
    target = objects[session.target]
    return {
        "format": FORMAT,
        "version": VERSION,
        "type": plan.type,
        "user": user.as_dict(),
        "clip": {
            "number": plan.number,
            "number_of_type": plan.number_of_type,
            "tables_laid": session.tries,
        },
        "target": _thing(session, target["name"], target["id"]),
        "things": [_thing(session, name, objects[name]["id"]) for name in session.things],
        "speech": {
            "phrase": session.phrase.text,
            "first_word": session.phrase.first_word,
            "reads_to": [*session.phrase.reads_to],
            "relation": session.phrase.relation,
            "landmarks": [*session.phrase.landmarks],
            "sides_as_seen_by": "robot",
            "utterances": clip.utterances,
        },
        "times_s": times,
        "frames": {"fps": settings.fps, "count": len(clip.times_s), "times_s": clip.times_s},
        "ray": _ray(session, clip),
        "grasp_gap_m": None if clip.grasp_gap_m is None else round(clip.grasp_gap_m, 5),
        "tracks_m": clip.tracks,
        "key_frames": [_key(key) for key in clip.key_frames],
        "mask_values": MASK_VALUES,
        "cameras": {mount.name: mount.as_dict(settings, session.layout) for mount in MOUNTS},
        "audio": {
            "file": "audio.wav",
            "rate_hz": settings.sound_rate_hz,
            "channels": ["left", "right"],
            "full_scale_pa": FULL_SCALE_PA,
            "peak_pa": round(float(np.abs(clip.sound).max(initial=0.0)), 5),
        },
    }


def _thing(session: Session, name: str, number: int) -> dict[str, Any]:
    kinds = {thing.name: thing.kind for thing in POOL}
    found = session.world.attributes(name)
    return {
        "id": number,
        "name": name,
        "kind": kinds[name],
        "noun": found["noun"],
        "is_target": name == session.target,
    }


def _ray(session: Session, clip: PlayedClip) -> dict[str, Any] | None:
    if clip.ray is None:
        return None
    names = {row["id"]: row["name"] for row in session.world.objects()}
    ray = clip.ray
    apex = next(key for key in clip.key_frames if key.name == "apex")
    return {
        "time_s": round(apex.time_s, 6),
        "origin_m": _rounded(ray.origin),
        "direction": _rounded(ray.direction),
        "aim_m": _rounded(session.aim),
        "meant_m": _rounded(session.meant),
        "noise_deg": session.user.pointing_noise_deg,
        "first_hit": {
            "id": ray.hit_id,
            "name": names.get(ray.hit_id),
            "distance_m": round(ray.distance_m, 5),
            "is_target": names.get(ray.hit_id) == session.target,
        },
    }


def _key(key: KeyFrame) -> dict[str, Any]:
    views = {
        name: {
            "mask": mask_name(name, key),
            "target": view.target.as_dict(),
            "hand": view.hand.as_dict(),
            "occlusion": view.occlusion,
        }
        for name, view in key.views.items()
    }
    row = {"name": key.name, "frame": key.frame, "time_s": round(key.time_s, 6)}
    return {**row, "views": views}


def _rounded(values: Any) -> list[float]:  # noqa: ANN401 - an array or a tuple
    return [round(float(x), 6) for x in values]
