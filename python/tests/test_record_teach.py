"""Recordings of a person who teaches: what is written, whether it is true, how it goes on."""

from __future__ import annotations

import errno
import json
import math
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell.files import open_exclusive
from dwell.teach import RecordedClip, TeachSettings, record, recorded_clips
from dwell.teach.dataset import clips_of
from dwell.teach.motion import HandPath, Stroke, minimum_jerk
from dwell.teach.person import Pose
from dwell.teach.phrases import read_phrase
from dwell.teach.places import free_layout
from dwell.teach.pointing import first_hit, turned_aim
from dwell.teach.scene import TABLE, stage
from dwell.teach.session import Session, open_session
from dwell.teach.table_mesh import write_table

SMALL = TeachSettings(users=1, clips=3, seed=5, fps=4, width=64, pointing_noise_deg=0.0)
Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small recording."""
    out = tmp_path_factory.mktemp("teach") / "out"
    record(out, SMALL)
    return out


@pytest.fixture(scope="module")
def clips(folder: Path) -> dict[str, RecordedClip]:
    """Its clips by type."""
    return {clip.label["type"]: clip for clip in recorded_clips(folder)}


def contents(folder: Path) -> dict[str, bytes]:
    """All files of a folder."""
    files = (file for file in sorted(folder.rglob("*")) if file.is_file())
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


@pytest.mark.long
def test_a_user_points_shows_and_speaks(folder: Path, clips: dict[str, RecordedClip]) -> None:
    assert sorted(clips) == ["point", "show", "speak"]
    rows = [json.loads(line) for line in (folder / "manifest.jsonl").read_text().splitlines()]
    assert sorted(row["folder"] for row in rows) == [
        "user_01/point_01",
        "user_01/show_01",
        "user_01/speak_01",
    ]
    for clip in clips.values():
        times = clip.label["frames"]["times_s"]
        assert np.allclose(np.diff(times), 0.25)
        assert times[0] == 0.0
        front = clip.pictures("kinect_front")
        assert front.shape == (len(times), 48, 64, 3)
        assert front.dtype == np.uint8
        assert clip.pictures("kinect_front", "depth").dtype == np.uint16
        assert clip.pictures("kinect_top").shape == front.shape
        assert clip.pictures("hd").shape == (len(times), 72, 128, 3)
        sound, rate_hz = clip.sound()
        assert sound.shape == (2, round(times[-1] * rate_hz))
        assert (clip.folder / "speech.txt").read_text().strip() == clip.label["speech"]["phrase"]


def test_labels_lie_where_pictures_show_things(clips: dict[str, RecordedClip]) -> None:
    """Projects the middle of the target by the label's own numbers, through no code of dwell."""
    seen = 0
    for clip in clips.values():
        for number, key in enumerate(clip.label["key_frames"]):
            middle = np.array([*clip.label["tracks_m"]["target"][key["frame"]], 1.0])
            for name, view in key["views"].items():
                camera, box = clip.label["cameras"][name], view["target"]["box"]
                mask = clip.mask(name, number)
                assert np.count_nonzero(mask == 1) == view["target"]["pixels"]
                if box is None or view["occlusion"] > 0.3 or box[1] == 0:
                    continue
                x, y, z, _ = np.linalg.inv(np.array(camera["camera_to_world"])) @ middle
                column = camera["cx"] - camera["fx"] * x / z
                row = camera["cy"] + camera["fy"] * y / z
                whole = box[3] < camera["height"] and box[2] < camera["width"] and box[0] > 0
                if not whole:
                    continue
                assert box[0] - 1 <= column <= box[2] + 1
                assert box[1] - 1 <= row <= box[3] + 1
                seen += 1
                # A Kinect's lateral noise shows what is behind along the rim of a thing.
                if camera["has_depth"] and view["target"]["pixels"] >= 40:
                    depth_m = clip.pictures(name, "depth")[key["frame"]] / 1000.0
                    nearest = np.median(depth_m[mask == 1])
                    # The front of a thing of at most 0.35 m, and a Kinect's noise.
                    assert -z - 0.25 < nearest < -z + 0.1
    assert seen >= 12


def test_what_is_shown_goes_with_the_palm_and_nothing_else_moves(
    clips: dict[str, RecordedClip],
) -> None:
    for kind, clip in clips.items():
        tracks = {name: np.array(rows) for name, rows in clip.label["tracks_m"].items()}
        times = np.array(clip.label["frames"]["times_s"])
        target = tracks["target"]
        if kind != "show":
            assert np.abs(target - target[0]).max() < 0.01
            continue
        carried = times >= clip.label["times_s"]["lift_start_s"] + 0.05
        offset = (target - tracks["palm"])[carried]
        assert np.ptp(offset, axis=0).max() < 0.01
        assert target[-1, 1] - target[0, 1] > 0.15
        assert clip.label["grasp_gap_m"] < 0.05


def test_the_voice_sounds_while_somebody_speaks(clips: dict[str, RecordedClip]) -> None:
    for clip in clips.values():
        sound, rate_hz = clip.sound()
        said = clip.label["speech"]["utterances"]
        start, end = said[0]["start_s"], said[-1]["end_s"]
        before = sound[:, : int((start - 0.02) * rate_hz)]
        during = sound[:, int(start * rate_hz) : int(end * rate_hz)]
        assert np.sqrt((during**2).mean()) > 30.0 * np.sqrt((before**2).mean())
        words = " ".join(row["words"] for row in said)
        assert words == clip.label["speech"]["phrase"].lower().rstrip(".")
        # Words take 0.43 to 0.50 s (docs/sounds.md); pieces follow within a step or two.
        assert 0.40 * len(words.split()) < end - start < 0.56 * len(words.split())


def test_phrases_name_the_target(clips: dict[str, RecordedClip]) -> None:
    """By words alone: the noun is there, and where two things have it, what tells them apart."""
    for clip in clips.values():
        label, phrase = clip.label, clip.label["speech"]["phrase"].lower()
        assert label["target"]["noun"] in phrase
        assert label["speech"]["reads_to"] == [label["target"]["name"]]
        assert (label["speech"]["relation"] is not None) == (label["type"] == "speak")


def ray_meets_box(
    origin: Array, direction: Array, center: Array, size: Array
) -> tuple[float, float]:
    """Where a ray enters and leaves a box along the axes; nothing where the first is larger."""
    with np.errstate(divide="ignore"):
        a = (center - size / 2.0 - origin) / direction
        b = (center + size / 2.0 - origin) / direction
    return float(np.minimum(a, b).max()), float(np.maximum(a, b).min())


def check_ray(session: Session) -> None:
    """A user without noise who points: the line from the eyes leads to the target and meets it."""
    person, world = session.person, session.world
    person.take(Pose(session.meant, *session.ready).pointing_to(person.hand, session.finger))
    joints = person.joints()
    origin, direction = person.ray(joints)
    thing = world.object(session.target)
    number, distance_m = first_hit(world, origin, direction)
    assert number == thing["id"], f"meets {number}"
    enters, leaves = ray_meets_box(
        origin, direction, np.array(thing["center"]), np.array(thing["size"])
    )
    assert enters - 1e-3 <= distance_m <= leaves + 1e-3
    toward = session.meant - joints["eyes"]
    cosine = float(toward @ direction / np.linalg.norm(toward))
    assert math.degrees(math.acos(min(1.0, cosine))) < 0.3


def sessions(settings: TeachSettings) -> list[tuple[str, Session]]:
    """All clips of a recording, ready to be played."""
    return [(c.plan.type, open_session(settings, c.user, c.plan)) for c in clips_of(settings)]


def check_sessions(settings: TeachSettings) -> None:
    """Every ray meets its target first, every phrase is read as its target alone."""
    for kind, session in sessions(settings):
        if kind == "point":
            check_ray(session)
        assert read_phrase(session.world, session.phrase.text) == (session.target,)


def test_rays_without_noise_meet_the_target_and_phrases_read_to_it() -> None:
    check_sessions(TeachSettings(users=2, clips=6, seed=3, pointing_noise_deg=0.0))


@pytest.mark.slow
def test_ten_users_of_thirty_clips() -> None:
    check_sessions(TeachSettings(users=10, clips=30, seed=1, pointing_noise_deg=0.0))


def test_pointing_deviates_as_much_as_stated() -> None:
    """Normal in two directions of 2 degrees: the angle is Rayleigh's, of mean 2 sqrt(pi / 2)."""
    random, eyes, aim = (
        np.random.default_rng(0),
        np.array([0.3, 1.6, -0.2]),
        np.array([1.0, 0.9, 0.4]),
    )
    angles = []
    for right, up in random.normal(0.0, 2.0, (4000, 2)):
        there = turned_aim(eyes, aim, right, up) - eyes
        cosine = there @ (aim - eyes) / np.linalg.norm(there) / np.linalg.norm(aim - eyes)
        angles.append(math.degrees(math.acos(min(1.0, cosine))))
    assert abs(np.mean(angles) - 2.0 * math.sqrt(math.pi / 2.0)) < 0.06
    # To the right of who looks along it, and up.
    right = np.cross(aim - eyes, [0.0, 1.0, 0.0])
    assert (turned_aim(eyes, aim, 5.0, 0.0) - aim) @ right > 0.0
    assert (turned_aim(eyes, aim, 0.0, 5.0) - aim)[1] > 0.0


def test_hands_move_with_the_least_jerk() -> None:
    """The quintic is that which starts and ends at rest without acceleration."""
    rows = [[t**k for k in range(6)] for t in (0.0, 1.0)]
    rows += [[k * t ** max(k - 1, 0) if k else 0.0 for k in range(6)] for t in (0.0, 1.0)]
    rows += [[k * (k - 1) * t ** max(k - 2, 0) for k in range(6)] for t in (0.0, 1.0)]
    found = np.linalg.solve(np.array(rows), np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]))
    for t in np.linspace(0.0, 1.0, 11):
        assert minimum_jerk(t) == pytest.approx(sum(found[k] * t**k for k in range(6)), abs=1e-9)
    path = HandPath([0.0, 0.0, 0.0], [Stroke(1.0, 2.0, np.array([1.0, 0.0, 0.0]), arc_m=0.1)])
    assert path.at(0.5).tolist() == [0.0, 0.0, 0.0]
    assert path.at(1.5) == pytest.approx([0.5, 0.1, 0.0])
    assert path.at(9.0).tolist() == [1.0, 0.0, 0.0]
    # Flash and Hogan: the largest speed is 1.875 times the mean one.
    speed = np.diff([path.at(1.0 + t)[0] for t in np.linspace(0.0, 1.0, 1001)]) * 1000.0
    assert speed.max() == pytest.approx(1.875, abs=1e-3)


class Stopped(Exception):
    """What a test stops a recording with."""


@pytest.mark.long
def test_a_recording_that_was_stopped_ends_up_with_the_same_bytes(
    folder: Path, tmp_path: Path
) -> None:
    out = tmp_path / "again"

    def stop(fraction: float, what: str) -> None:
        del fraction, what
        raise Stopped

    with pytest.raises(Stopped):
        record(out, SMALL, progress=stop)
    assert not (out / "manifest.jsonl").exists()
    done = sorted(path.name for path in (out / "user_01").iterdir() if path.is_dir())
    assert len(done) == 1
    # What a killed process leaves: a clip in the making.
    left = {"point_01", "show_01", "speak_01"} - {*done}
    draft = out / "user_01" / f".{min(left)}.partial-0"
    draft.mkdir()
    (draft / "label.json").write_text("{")
    assert record(out, SMALL)["recorded_now"] == 2
    assert contents(out) == contents(folder)
    assert record(out, SMALL)["recorded_now"] == 0


def test_other_recordings_and_other_files_stay(folder: Path, tmp_path: Path) -> None:
    before = contents(folder)
    with pytest.raises(ValueError, match="was begun with fps 4"):
        record(folder, TeachSettings(**{**SMALL.as_dict(), "fps": 5}))
    assert contents(folder) == before
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ValueError, match=r"holds something else \(letter.txt\)"):
        record(tmp_path, SMALL)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_what_is_missing_in_a_recording_is_told(folder: Path, tmp_path: Path) -> None:
    whole = contents(folder)
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    (copy / "user_01" / "user.json").unlink()
    record(copy, SMALL)
    assert contents(copy) == whole
    clip = copy / "user_01" / "show_01"
    for lost in ("hd/rgb/000001.png", "kinect_top/depth/000000.png", "audio.wav"):
        kept = (clip / lost).read_bytes()
        for left in (kept[: len(kept) // 2], kept[:-1], b"", None):
            (clip / lost).unlink()
            if left is not None:
                (clip / lost).write_bytes(left)
            with pytest.raises(
                ValueError, match=rf"show_01/{lost} is missing or cut; remove .*show_01,"
            ):
                record(copy, SMALL)
        (clip / lost).unlink(missing_ok=True)
        shutil.copy(folder / "user_01" / "show_01" / lost, clip / lost)
    (clip / "label.json").write_text("{")
    with pytest.raises(ValueError, match=r"label\.json: no JSON.*; remove .*show_01, and the clip"):
        record(copy, SMALL)
    shutil.rmtree(clip)
    record(copy, SMALL)
    assert contents(copy) == whole


def test_a_full_disk_is_told_with_the_clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("dwell.teach.writer.Image.Image.save", full)
    with pytest.raises(OSError, match=r"No space left on device: .*user_01/\w+_01"):
        record(tmp_path / "out", SMALL)
    assert [path.name for path in (tmp_path / "out" / "user_01").iterdir()] == ["user.json"]


def test_a_full_temporary_folder_is_told_with_the_file(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        with pytest.raises(OSError, match=r"table\.obj") as refused:
            write_table(tmp_path / "table.obj")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert refused.value.errno == errno.EFBIG


def test_a_folder_that_another_process_begins_in_this_moment_is_not_something_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = os.listdir

    def begun(path: str) -> list[str]:
        (tmp_path / "dataset.json").write_text("{}")
        return listed(path)

    monkeypatch.setattr("dwell.teach.dataset.os.listdir", begun)
    with pytest.raises(ValueError, match="was begun with format None"):
        record(tmp_path, SMALL)


def test_two_processes_do_not_record_into_one_folder(tmp_path: Path) -> None:
    with (
        open_exclusive(tmp_path / ".recording"),
        pytest.raises(ValueError, match="another process"),
    ):
        record(tmp_path, SMALL)


def test_the_table_stands_free_in_a_furnished_house() -> None:
    """Boxes of all things of the house, against those of table, person and robot."""
    house, layout = stage("builtin:apartment")
    rows = {row["name"]: row for row in dwell.World(house, agents=0).objects()}
    table = rows.pop(TABLE)
    places = [(table["center"], [size / 2.0 for size in table["size"]])]
    places += [(place, [0.2, 0.0, 0.2]) for place in (layout.person(0.0), layout.robot())]
    for row in rows.values():
        low = row["center"][1] - row["size"][1] / 2.0
        if low > 1.9 or row["size"][1] < 0.05:
            # Lamps hang above, rugs lie below.
            continue
        for middle, half in places:
            gaps = [
                abs(row["center"][k] - middle[k]) - row["size"][k] / 2.0 - half[k] for k in (0, 2)
            ]
            assert max(gaps) > -0.01, row["name"]


def test_a_house_without_room_for_the_table_is_refused() -> None:
    closet = dwell.HouseBuilder("closet").room("closet", (0.0, 0.0, 1.2, 2.0)).build()
    with pytest.raises(
        dwell.ConfigError, match=r"closet: no room has 1\.6 by 2\.5 m of free floor"
    ):
        free_layout(closet)


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"fps": 7}, "fps is 7; allowed are 1, 2, 3, 4, 5, 6, 8"),
        ({"width": 66}, "width is 66; allowed are multiples of 4"),
        ({"users": 0}, "users is 0"),
        ({"noise": -1.0}, "noise is -1; allowed are 0 to 10"),
        ({"pointing_noise_deg": 90.0}, "pointing_noise_deg is 90; allowed are 0 to 30 degrees"),
        ({"form": "bag"}, "form is 'bag'"),
    ],
)
def test_settings_are_checked(fields: dict[str, Any], told: str) -> None:
    with pytest.raises(dwell.ConfigError, match=told):
        TeachSettings(**fields)


def test_the_command_records_and_says_what_it_cannot(
    command: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    out = tmp_path / "npz"
    options = ("--users", "1", "--clips", "1", "--fps", "2", "--width", "32", "--format", "npz")
    done = command("record", "teach", out, *options, "--noise", "0", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["clips"] == 1
    (clip,) = recorded_clips(out)
    assert clip.pictures("kinect_top", "depth").shape[1:] == (24, 32)
    refused = command("record", "teach", out, *options[:-2])
    assert refused.returncode == 1
    assert "was begun with form 'npz'" in refused.stderr
    small = command("record", "teach", tmp_path / "x", "--house", "builtin:shed")
    assert small.returncode == 1
    assert not (tmp_path / "x").exists()
