"""Records of views: only what the image shows is said, questions are balanced, jobs go on."""

from __future__ import annotations

import hashlib
import json
import tarfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest
from PIL import Image

import dwell
from dwell.house_list import HouseList
from dwell.views import ViewRecord, ViewSettings, dataset, held_cameras, house_records
from dwell.views.blind import NaiveBayes
from dwell.views.formats import FORMS, export
from dwell.views.masks import box, decode_rle, encode_rle

HOUSE = "seed:3?home=studio"
SETTINGS = ViewSettings(views=6, size=96)
Command = Callable[..., CompletedProcess[str]]

pytestmark = pytest.mark.usefixtures("open_once")


@pytest.fixture(scope="module")
def records() -> list[ViewRecord]:
    return house_records(HOUSE, SETTINGS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("views") / "set"
    houses = HouseList(["seed:3..5?home=studio"])
    made = list(dataset.make(houses, out, SETTINGS))
    assert [count for _, _, count in made] == [6, 6]
    return out


def digest(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_masks_come_back() -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        shape = tuple(rng.integers(1, 50, 2))
        mask = rng.random(shape) < rng.random()
        assert (decode_rle(encode_rle(mask)) == mask).all()
    # As the interface of COCO writes it.
    mask = np.zeros((4, 6), bool)
    mask[1:3, 2:5] = True
    assert encode_rle(mask) == {"size": [4, 6], "counts": "9220003"}
    assert box(mask) == [2, 1, 3, 2]
    assert box(np.zeros((2, 2), bool)) == [0, 0, 0, 0]


def test_cameras_are_held_where_one_can_stand() -> None:
    world = dwell.World(HOUSE, agents=0)
    cameras = list(held_cameras(world, 4, 7))
    assert cameras == list(held_cameras(world, 4, 7))
    assert cameras != list(held_cameras(world, 4, 8))
    grid = world.navigation()
    for camera in cameras:
        x, y, z = camera.position
        floor = grid.points()
        near = floor[np.linalg.norm(floor[:, [0, 2]] - (x, z), axis=1).argmin()]
        assert np.hypot(near[0] - x, near[2] - z) < 0.1
        assert 1.40 < y - near[1] < 1.76
        assert -20.0 <= camera.pitch_deg <= 0.0


def test_a_record_says_only_what_its_image_shows(records: list[ViewRecord]) -> None:
    assert len(records) == 6
    assert {record.row["light"] for record in records} == {"day", "lamp"}
    for record in records:
        instance = record.images["instance"][..., 0]
        pixels = record.pixels_of()
        for thing in record.row["things"]:
            mask = decode_rle(thing["mask"])
            assert (mask == (instance == thing["id"])).all()
            assert mask.sum() == thing["pixels"]
            assert thing["box"] == box(mask)
            assert 0.0 <= thing["occlusion"] <= 1.0
        large = {thing["id"] for thing in record.row["things"] if "noun" in thing}
        assert len(large) >= 2
        texts = [*record.row["captions"].values(), *record.row["references"]]
        for text in texts:
            for span in text["spans"]:
                assert set(span["ids"]) <= set(pixels)
                assert len(span["boxes"]) == len(span["ids"])
                assert 0 <= span["start"] < span["end"] <= len(text["text"])
        for subject, _, other in record.row["relations"]:
            assert {subject, other} <= large
        assert {reference["id"] for reference in record.row["references"]} <= large


def test_captions_and_relations_are_true_of_the_view(records: list[ViewRecord]) -> None:
    world = dwell.World(HOUSE, agents=0)
    for record in records:
        camera = record.row["camera"]
        viewer = {name: camera[name] for name in ("position", "yaw_deg", "pitch_deg")}
        for text in record.row["captions"].values():
            found = world.check_text(text["text"], viewer=viewer, scope="view")
            assert {claim["status"] for claim in found["claims"]} <= {"true"}, text["text"]
        for subject, name, other in record.row["relations"][:20]:
            assert world.holds(name, subject, other, viewer=viewer)


def test_a_question_is_asked_twice_with_different_answers(records: list[ViewRecord]) -> None:
    pairs: dict[int, list[tuple[int, dict[str, Any]]]] = {}
    for k, record in enumerate(records):
        for asked in record.row["questions"]:
            pairs.setdefault(asked["pair"], []).append((k, asked))
    assert len(pairs) >= 10
    for both in pairs.values():
        (first, one), (second, other) = both
        assert first != second
        assert (one["text"], one["template"]) == (other["text"], other["template"])
        assert one["answer"] != other["answer"]
    templates = Counter(
        (asked["template"], k)
        for k, record in enumerate(records)
        for asked in record.row["questions"]
    )
    assert max(templates.values()) <= SETTINGS.questions
    world = dwell.World(HOUSE, agents=0)
    for record in records:
        camera = record.row["camera"]
        viewer = {name: camera[name] for name in ("position", "yaw_deg", "pitch_deg")}
        for asked in record.row["questions"][:6]:
            answer = world.check(asked["text"], viewer=viewer)["answer"]
            if "truth" in answer:
                assert asked["answer"] == ("yes" if answer["truth"] else "no")
            elif "number" in answer:
                assert asked["answer"] == str(answer["number"])


def test_ways_and_failures_are_asked_of_the_house() -> None:
    settings = ViewSettings(views=6, size=64, situations=True)
    rows = [record.row for record in house_records(HOUSE, settings)]
    asked = [one for row in rows for one in row["questions"] if one["evidence"] == "house"]
    assert {one["kind"] for one in asked} & {"path", "failure"}
    ways = {one["answer"] for one in asked if one["kind"] == "path"}
    assert ways <= {"left", "right", "around", "not at all"}
    answers: dict[int, set[str]] = {}
    for one in asked:
        answers.setdefault(one["pair"], set()).add(one["answer"])
    assert all(len(both) == 2 for both in answers.values())


def test_who_sees_no_picture_is_right_half_the_time(records: list[ViewRecord]) -> None:
    asked = [(one["text"], one["answer"]) for record in records for one in record.row["questions"]]
    # Whatever is answered by the words alone, of each pair one is wrong.
    guessed = NaiveBayes(asked).answers([text for text, _ in asked])
    assert np.mean([word == own for word, (_, own) in zip(guessed, asked, strict=True)]) <= 0.5


def test_a_stopped_job_goes_on_and_shards_make_the_same(folder: Path, tmp_path: Path) -> None:
    whole = digest(folder)
    assert len(whole) == 2 + 12 * 4
    houses = HouseList(["seed:3..5?home=studio"])
    out = tmp_path / "again"
    stopped = dataset.make(houses, out, SETTINGS, threads=2)
    next(stopped)
    stopped.close()
    # What a kill leaves in the middle of a house.
    second = dataset.house_folder(out, 1)
    if second.exists():
        second.rename(second.with_name(f".{second.name}.partial-0"))
    for k in (0, 1):
        list(dataset.make(houses, out, SETTINGS, shard=(k, 2)))
    assert digest(out) == whole


def test_the_command_skips_bad_houses_and_refuses_other_jobs(
    tmp_path: Path, command: Command
) -> None:
    out = tmp_path / "set"
    words = ("views", "make", HOUSE, "nothing.dwell", "--out", out, "--views", 2, "--size", 64)
    done = command(*words)
    assert done.returncode == 1
    assert "skipped nothing.dwell" in done.stderr
    assert "2 houses; 2 views made now" in done.stdout
    assert command(*words).stdout.startswith("2 houses; 0 views made now")
    other = command(*words, "--seed", 5)
    assert other.returncode == 1
    assert "was begun with" in other.stderr
    sheet = command("views", "datasheet", out)
    assert "| train | 1 | 2 |" in sheet.stdout
    assert command("views", "export", out, "--format", "jsonl", "--out", out).returncode == 1
    assert command("views", "datasheet", tmp_path).returncode == 1


def test_a_clip_tells_what_was_seen_and_heard(tmp_path: Path, command: Command) -> None:
    out = tmp_path / "clip"
    words = ("views", "clip", HOUSE, "--out", out, "--duration-s", 1, "--size", 64, "--seed", 2)
    assert command(*words).returncode == 0
    row = json.loads((out / "clip.json").read_text("utf-8"))
    (sounds,) = row["sounds"]
    assert (sounds["from_s"], sounds["to_s"]) == (0.2, 0.8)
    for heard in row["heard"]:
        assert 0.2 <= heard["from_s"] < heard["to_s"] <= 0.8
    times = [picture["time_s"] for picture in row["pictures"]]
    assert times == [0.0, 0.5]
    assert {one["from_s"] for one in row["seen"]} <= set(times)
    assert (out / "001.png").exists()
    assert (out / "sound.wav").stat().st_size > 2 * 16_000 * 4
    assert command(*words).returncode == 1
    refused = command("views", "clip", HOUSE, "--out", tmp_path / "b", "--duration-s", 60)
    assert "duration_s is 60" in refused.stderr


def test_every_form_holds_all_views(folder: Path, tmp_path: Path) -> None:
    for form in FORMS:
        if form != "parquet":
            export(folder, tmp_path / form, form)
    rows = [row for row, _ in dataset.records(folder)]
    splits = {row["split"] for row in rows}
    lines = [
        json.loads(line)
        for split in splits
        for line in (tmp_path / "jsonl" / f"{split}.jsonl").read_text("utf-8").splitlines()
    ]
    assert sorted(line["id"] for line in lines) == sorted(row["id"] for row in rows)
    assert all(
        (tmp_path / "jsonl" / lines[0]["images"][kind]).exists() for kind in ("rgb", "depth")
    )
    names = []
    for split in splits:
        with tarfile.open(tmp_path / "webdataset" / f"{split}-000000.tar") as tar:
            names += tar.getnames()
    assert sum(name.endswith(".json") for name in names) == len(rows)
    images = 0
    for split in splits:
        notes = tmp_path / "coco" / "annotations"
        instances = json.loads((notes / f"instances_{split}.json").read_text("utf-8"))
        panoptic = json.loads((notes / f"panoptic_{split}.json").read_text("utf-8"))
        images += len(instances["images"])
        kinds = {kind["id"] for kind in instances["categories"]}
        assert {own["category_id"] for own in instances["annotations"]} <= kinds
        for picture in panoptic["annotations"][:2]:
            path = tmp_path / "coco" / f"panoptic_{split}" / picture["file_name"]
            colors = np.asarray(Image.open(path)).astype(int)
            ids = colors[..., 0] + 256 * colors[..., 1] + 65_536 * colors[..., 2]
            shown = {int(number): int((ids == number).sum()) for number in np.unique(ids) if number}
            assert shown == {one["id"]: one["area"] for one in picture["segments_info"]}
    assert images == len(rows)
    refs = json.loads((tmp_path / "refcoco" / "refs.json").read_text("utf-8"))["refs"]
    known = json.loads((tmp_path / "refcoco" / "instances.json").read_text("utf-8"))
    notes_of = {own["id"]: own for own in known["annotations"]}
    assert refs
    assert all(notes_of[ref["ann_id"]]["image_id"] == ref["image_id"] for ref in refs)
    card = (tmp_path / "huggingface" / "README.md").read_text("utf-8")
    assert card.startswith("---\nconfigs:")
    assert "distinct-2" in card
    with pytest.raises(FileExistsError):
        export(folder, tmp_path / "coco", "coco")


def test_parquet_holds_pictures_and_questions(folder: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="needs pyarrow (extra data)")
    export(folder, tmp_path / "tables", "parquet")
    tables = [parquet.read_table(path) for path in (tmp_path / "tables").iterdir()]
    rows = [row for table in tables for row in table.to_pylist()]
    assert len(rows) == 12
    assert rows[0]["image"]["bytes"].startswith(b"\x89PNG")
    assert json.loads(rows[0]["record"])["id"] == rows[0]["id"]


def test_datasets_loads_the_folder(folder: Path, tmp_path: Path) -> None:
    datasets = pytest.importorskip("datasets", reason="needs datasets of Hugging Face")
    export(folder, tmp_path / "hub", "huggingface")
    loaded = datasets.load_dataset("imagefolder", data_dir=str(tmp_path / "hub"))
    assert sum(len(part) for part in loaded.values()) == 12
