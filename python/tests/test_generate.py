"""Houses of seeds."""

from __future__ import annotations

import functools
import gc
import json
import re
import shutil
import subprocess
import sys
import time
import weakref
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import pytest

import dwell
from dwell import _native
from dwell.envs import config, single
from dwell.envs.config import HouseCache

Command = Callable[..., subprocess.CompletedProcess[str]]


def test_a_seed_is_a_furnished_house_and_always_the_same() -> None:
    house = dwell.House.generate(8, home="apartment", storeys=1)
    info = house.info()
    assert len(info["rooms"]) >= 3
    assert info["objects"] >= 30
    kinds = {kind for room in info["rooms"] for kind in room["kinds"]}
    assert {"kitchen", "bathroom"} & kinds
    again = dwell.House.open("seed:8?home=apartment&storeys=1")
    assert [again.info(), again.describe("house")] == [info, house.describe("house")]
    assert dwell.House.generate(9, home="apartment").info() != info


def test_a_range_of_seeds_is_several_houses() -> None:
    assert dwell.House.expand("seed:3..5?home=studio") == [
        "seed:3?home=studio",
        "seed:4?home=studio",
    ]
    assert dwell.House.expand("builtin:studio") == ["builtin:studio"]
    with pytest.raises(dwell.HouseError, match="A < B"):
        dwell.House.expand("seed:5..3")
    shelf = HouseCache(["builtin:studio", "seed:0..3"])
    assert [*shelf.names] == ["builtin:studio", "seed:0", "seed:1", "seed:2"]


@pytest.mark.long
def test_houses_of_thousands_of_seeds_are_not_all_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    assert 1 < config.CACHED_HOUSES < 100
    most = 4
    for module in (config, single):
        monkeypatch.setattr(module, "CACHED_HOUSES", most)
    shelf = HouseCache(f"seed:0..{2 * most}?home=studio")
    first = shelf[0]
    assert shelf[0] is first
    held = [weakref.ref(shelf[k]) for k in range(2 * most)]
    del first
    gc.collect()
    assert sum(ref() is not None for ref in held) == most
    env = gymnasium.make(
        "dwell/InstructionFollowing-v0",
        houses=f"seed:0..{most + 2}?home=studio",
        sensors={"rgb": {"width": 64, "height": 64}, "instruction": {}},
    )
    start, _ = env.reset(seed=1, options={"house": 0})
    for house in range(1, most + 2):
        env.reset(options={"house": house})
    again, _ = env.reset(seed=1, options={"house": 0})
    assert (start["rgb"] == again["rgb"]).all()
    env.close()


def test_built_in_houses_are_listed_and_open(monkeypatch: pytest.MonkeyPatch) -> None:
    # It looks for graphics adapters and draws with each: seconds, and no fork draws by GL after it.
    monkeypatch.delattr(_native, "doctor")
    names = dwell.House.builtins()
    assert {"builtin:apartment", "builtin:studio", "builtin:house", "builtin:office"} <= set(names)
    assert dwell.House.open("builtin:house").info()["levels"] == 2


def test_rooms_that_are_asked_for_are_there() -> None:
    rooms = ["living_room", "kitchen", "bathroom", "bedroom"]
    house = dwell.House.generate(3, home="apartment", rooms=rooms)
    kinds = {kind for room in house.info()["rooms"] for kind in room["kinds"]}
    assert {"living room", "kitchen", "bathroom", "bedroom"} <= kinds


@pytest.mark.parametrize(
    ("spec", "told"),
    [
        ({"home": "castle"}, "castle.*studio"),
        ({"area_m2": 0}, "area_m2: found 0; possible: 12 to 400"),
        ({"rooms": ["kitchen"] * 40, "area_m2": 20}, "possible: 1 to 12"),
        ({"style": "x"}, "nordic"),
        ({"turrets": 1}, "turrets"),
    ],
)
def test_what_cannot_be_built_is_said(spec: dict[str, Any], told: str) -> None:
    with pytest.raises(dwell.HouseError, match=told):
        dwell.House.generate(1, **spec)


def test_an_agent_walks_through_a_generated_house() -> None:
    world = dwell.World("seed:8?home=apartment&storeys=1")
    room = world.house.rooms()[0]
    world.place_agent(room["stand"], room["yaw_deg"])
    moved = [world.do("move_forward") for _ in range(3)]
    assert len(moved) == 3
    assert world.agents()[0]["position"][1] == pytest.approx(room["stand"][1], abs=0.1)


def process(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "dwell", "generate", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture
def generate(command: Command) -> Command:
    """``dwell generate`` in this process."""
    return functools.partial(command, "generate")


def rows(manifest: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in manifest.read_text("utf-8").splitlines()]


def content(folder: Path) -> dict[str, bytes]:
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


STUDIOS = ("--count", "8", "--spec", "home=studio")


@pytest.mark.parametrize("form", ["dwell", "suncg", "glb"])
def test_bulk_houses_open_again_and_the_manifest_tells_them(
    tmp_path: Path, form: str, generate: Command
) -> None:
    out = tmp_path / "many"
    done = generate("--count", "2", "--out", out, "--format", form, "--spec", "home=studio")
    assert done.returncode == 0, done.stderr
    for row in rows(out / "manifest.jsonl"):
        made = dwell.House.open(row["house"])
        assert made.info()["fingerprint"] == row["hash"]
        house = dwell.House.open(out / row["path"])
        assert house.info()["triangles"] == row["triangles"]
        if form == "dwell":
            assert house.info()["fingerprint"] == row["hash"]
        if form != "glb":
            assert house.info()["objects"] == row["objects"]


@pytest.mark.long
def test_a_run_that_was_killed_goes_on_and_ends_as_if_it_had_not_been(tmp_path: Path) -> None:
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    assert process(*STUDIOS, "--out", whole).returncode == 0
    command = [sys.executable, "-m", "dwell", "generate", *STUDIOS, "--out", str(cut)]
    journal = cut / ".manifest.jsonl.part"
    running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while running.poll() is None:
        if journal.exists() and journal.read_text("utf-8").count('"done"') >= 2:
            break
        time.sleep(0.002)
    running.kill()
    running.wait()
    again = process(*STUDIOS, "--out", cut, "--json", "--workers", "1")
    assert again.returncode == 0, again.stderr
    assert json.loads(again.stdout)["made_now"] <= 6
    assert content(cut) == content(whole)
    assert json.loads(process(*STUDIOS, "--out", cut, "--json").stdout)["made_now"] == 0


def test_splits_and_shards_part_the_seeds(tmp_path: Path, generate: Command) -> None:
    out = tmp_path / "val"
    for shard in ("0/2", "1/2"):
        options = ("--split", "val", "--count", "3", "--spec", "home=studio", "--shard", shard)
        assert generate(*options, "--out", out).returncode == 0
    found = [rows(out / f"manifest-0000{k}-of-00002.jsonl") for k in range(2)]
    assert [[row["seed"] for row in part] for part in found] == [[8, 28], [18]]
    assert {row["split"] for part in found for row in part} == {"val"}


def test_folders_of_other_jobs_and_bad_options_are_refused(
    tmp_path: Path, generate: Command
) -> None:
    out = tmp_path / "many"
    one = ("--count", "1", "--spec", "home=studio")
    assert generate(*one, "--out", out).returncode == 0
    other = generate("--count", "2", "--spec", "home=studio", "--out", out)
    assert other.returncode == 1
    assert "was begun with count 1" in other.stderr
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter").write_text("dear")
    assert "holds something else" in generate(*one, "--out", tmp_path / "mine").stderr
    assert generate(*one, "--out", out, "--shard", "2/2").returncode == 2
    bad = generate("--count", "1", "--spec", "turrets=1", "--out", tmp_path / "bad")
    assert bad.returncode == 1
    assert "turrets" in bad.stderr


def test_houses_that_were_deleted_are_made_again(tmp_path: Path, generate: Command) -> None:
    out = tmp_path / "many"
    two = ("--count", "2", "--spec", "home=studio", "--out", out, "--json")
    assert generate(*two).returncode == 0
    before = content(out)
    first = out / rows(out / "manifest.jsonl")[0]["path"]
    shutil.rmtree(first)
    again = json.loads(generate(*two).stdout)
    assert (again["houses"], again["made_now"]) == (2, 1)
    assert content(out) == before
    shutil.rmtree(out / "house")
    assert json.loads(generate(*two).stdout)["made_now"] == 2
    assert content(out) == before
    # So is one that was cut.
    geometry = first / "house.glb"
    geometry.write_bytes(geometry.read_bytes()[:-1])
    assert json.loads(generate(*two).stdout)["made_now"] == 1
    assert content(out) == before
    # And one that lost a file.
    geometry.unlink()
    (out / rows(out / "manifest.jsonl")[1]["path"] / "house.json").unlink()
    assert json.loads(generate(*two).stdout)["made_now"] == 2
    assert content(out) == before
    # What this version does not make is not passed off as what the manifest names.
    manifest = out / "manifest.jsonl"
    other = [{**row, "hash": "0"} for row in rows(manifest)]
    for row in other:
        assert row["version"] == 1
        del row["check"]
    manifest.write_text("".join(json.dumps(row) + "\n" for row in other), "utf-8")
    shutil.rmtree(first)
    refused = generate(*two)
    assert refused.returncode == 1
    assert "gives another house now than the manifest says" in refused.stderr


def test_a_house_that_could_not_be_written_is_tried_again(
    tmp_path: Path, generate: Command
) -> None:
    out, whole = tmp_path / "many", tmp_path / "whole"
    three = ("--count", "3", "--spec", "home=studio")
    assert generate(*three, "--out", whole).returncode == 0
    shutil.copytree(whole, out)
    manifest = out / "manifest.jsonl"
    manifest.unlink()
    in_the_way = out / rows(whole / "manifest.jsonl")[1]["path"]
    shutil.rmtree(in_the_way)
    in_the_way.mkdir()
    (in_the_way / "letter").write_text("dear")
    refused = generate(*three, "--out", out)
    assert refused.returncode == 1
    assert "something else stands there already" in refused.stderr
    # Of the last one, which another thread makes, nobody knows how far it came.
    assert re.search("[12] of 3 are kept; run again", refused.stderr)
    assert not manifest.exists()
    shutil.rmtree(in_the_way)
    assert generate(*three, "--out", out).returncode == 0
    assert content(out) == content(whole)


@pytest.mark.long
@pytest.mark.parametrize("form", ["dwell", "suncg"])
def test_models_and_images_that_are_gone_or_cut_are_made_again(
    tmp_path: Path, form: str, generate: Command
) -> None:
    out = tmp_path / "many"
    one = ("--count", "1", "--spec", "home=studio", "--format", form, "--out", out, "--json")
    assert generate(*one).returncode == 0
    before = content(out)

    def files(folder: str, ending: str) -> list[Path]:
        return sorted((out / folder).rglob(f"*{ending}"))

    for path in (
        files("object", ".bin" if form == "dwell" else ".obj")[0],
        files("texture", ".png")[0],
        *([] if form == "dwell" else [files("room", ".mtl")[0], files("object", ".mtl")[-1]]),
    ):
        for change in (
            Path.unlink,
            lambda path: path.write_bytes(b""),
            lambda path: path.write_bytes(path.read_bytes()[:-3]),
        ):
            change(path)
            again = generate(*one)
            assert json.loads(again.stdout)["made_now"] == 1, (path, again.stderr)
            assert content(out) == before
    assert json.loads(generate(*one).stdout)["made_now"] == 0


def test_a_manifest_that_was_changed_is_refused_by_its_line(
    tmp_path: Path, generate: Command
) -> None:
    out = tmp_path / "many"
    two = ("--count", "2", "--spec", "home=studio", "--out", out)
    assert generate(*two).returncode == 0
    manifest = out / "manifest.jsonl"
    first, second = lines = manifest.read_text("utf-8").splitlines()
    other = json.dumps({**json.loads(second), "hash": "0000000000000000"})
    for changed, told in (
        ([first, other], "manifest.jsonl line 2: changed since it was written: its check is"),
        ([*lines, first], "manifest.jsonl line 3: seed 0 stands in line 1 already"),
        ([first], "manifest.jsonl: is at its end where this job has seed 1"),
        ([second], "manifest.jsonl: has seed 1 where this job has seed 0"),
        ([], "manifest.jsonl: is at its end where this job has seed 0"),
    ):
        manifest.write_text("".join(f"{line}\n" for line in changed), "utf-8")
        refused = generate(*two)
        assert refused.returncode == 1
        assert told in refused.stderr
    newer = json.dumps({**json.loads(second), "version": 2})
    manifest.write_text(f"{first}\n{newer}\n", "utf-8")
    assert "line 2: version is 2; this dwell reads 1" in generate(*two).stderr
    # What an older release wrote said no version.
    for file in (manifest, out / "dataset.json"):
        assert '"version": 1' in file.read_text("utf-8")
    older = [{key: row[key] for key in row if key != "version"} for row in map(json.loads, lines)]
    for row in older:
        written = {key: row[key] for key in row if key != "check"}
        row["check"] = f"{zlib.crc32(json.dumps(written, sort_keys=True).encode()):08x}"
    manifest.write_text("".join(json.dumps(row) + "\n" for row in older), "utf-8")
    dataset = json.loads((out / "dataset.json").read_text("utf-8"))
    del dataset["version"]
    (out / "dataset.json").write_text(json.dumps(dataset), "utf-8")
    shutil.rmtree(out / older[0]["path"])
    again = generate(*two)
    assert "(1 made now" in again.stdout, again.stderr
    (out / "dataset.json").write_text(json.dumps({**dataset, "version": 2}), "utf-8")
    assert "dataset.json: version is 2; this dwell reads 1" in generate(*two).stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--count", "0"), "expected a whole number from 1"),
        (("--count", "1", "--workers", "0"), "expected a whole number from 1"),
        (("--count", "1", "--spec", "split=val"), "--split chooses seeds"),
        (("--count", "1", "--spec", "storeys=99"), "storeys: found 99; possible: 1 to 3"),
    ],
)
def test_what_cannot_be_asked_for_begins_no_folder(
    options: tuple[str, ...], told: str, tmp_path: Path, generate: Command
) -> None:
    refused = generate(*options, "--out", tmp_path / "out")
    assert refused.returncode in (1, 2)
    assert told in refused.stderr
    assert not refused.stdout
    assert not (tmp_path / "out").exists()
