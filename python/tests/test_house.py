"""Houses as values: equal by content, told by a short text, and what stands outside of them."""

from __future__ import annotations

import json
import logging
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell

SIZE = (4.0, 2.5, 3.0)


def test_houses_are_equal_by_content() -> None:
    one, two = dwell.House.shoebox(SIZE), dwell.House.shoebox(SIZE)
    other = dwell.House.shoebox((4.0, 2.5, 3.5))
    assert one == two
    assert hash(one) == hash(two)
    assert one != other
    assert one != "shoebox"
    assert len({one, two, other}) == 2
    chair = one.edit().add("dining_chair", (2.0, 0.0, 1.0), srgb=(10, 20, 30)).done()
    again = one.edit().add("dining_chair", (2.0, 0.0, 1.0), srgb=(10, 20, 31)).done()
    assert chair != one
    assert chair != again


def test_texts_are_short_and_tell() -> None:
    house = dwell.House.open("builtin:studio")
    things = [
        house,
        dwell.World(house),
        dwell.AcousticScene(house),
        house.edit().add("mug", on="dining_table_1"),
        dwell.HouseBuilder("flat"),
        house.navigation(),
        dwell.Head.spherical(),
    ]
    for thing in things:
        text = repr(thing)
        assert text.startswith(type(thing).__name__ + "(")
        assert " at 0x" not in text
        assert len(text) < 100
    assert f"rooms={len(house.rooms())}" in repr(house)


def test_a_glb_of_our_own_is_the_same_house(tmp_path: Path) -> None:
    house = dwell.House.open("builtin:studio")
    house.write(tmp_path / "studio.glb", "glb")
    again = dwell.House.open(tmp_path / "studio.glb")
    keys = ("rooms", "objects", "joints", "categories")
    before, after = house.info(), again.info()
    assert {key: before.get(key) for key in keys} == {key: after.get(key) for key in keys}
    assert again.describe("object") == house.describe("object")


def test_what_stands_outside_is_told_once(caplog: pytest.LogCaptureFixture) -> None:
    house = dwell.House.shoebox(SIZE)
    world = dwell.World(house)
    with caplog.at_level(logging.WARNING, "dwell"):
        world.render(position=(2.0, 1.0, 1.5))
        world.place_agent((2.0, 0.0, 1.5))
        assert not caplog.records
        for _ in range(3):
            world.render(position=(9.0, 1.0, 1.5))
        world.place_agent((9.0, 0.0, 1.5))
        scene = dwell.AcousticScene(house, rays=100, max_duration_s=0.1)
        scene.impulse_response((2.0, 1.0, 1.5), (2.0, 1.0, 9.0))
    told = [record.getMessage().split(" stands")[0] for record in caplog.records]
    assert told == ["a camera", "an agent", "a microphone"]
    assert "at (9, 1, 1.5) m" in caplog.records[0].getMessage()


def test_a_source_outside_of_a_measured_room_is_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    walls = dict.fromkeys(("x0", "x1", "y0", "y1", "z0", "z1"), "hard")
    room = {"shoebox": [6, 5, 3], "walls": walls, "materials": {"hard": {}}}
    (tmp_path / "room.json").write_text(json.dumps(room), encoding="utf-8")
    scene = dwell.AcousticScene(tmp_path / "room.json", rays=100, max_duration_s=0.1)
    assert scene.house.info()["rooms"] == []
    with caplog.at_level(logging.WARNING, "dwell"):
        scene.impulse_response((3.0, 1.5, -2.5), (2.0, 1.0, -1.0))
        assert not caplog.records
        silence = scene.impulse_response((9.0, 1.5, -2.5), (2.0, 1.0, -1.0))
        scene.echogram((3.0, 1.5, -2.5), (2.0, 1.5, 1.0))
    assert not silence.any()
    told = [record.getMessage().split(" stands")[0] for record in caplog.records]
    assert told == ["a source", "a microphone"]


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"air": {"temperature_c": -400}}, "room.json: air.temperature_c is -400"),
        ({"duration_s": 1e9}, "room.json: duration_s is 1e+09; allowed is 0.02 to 20 s"),
        (
            {"receivers": None, "recievers": []},
            "room.json: receivers: missing; 'recievers' is nearly its name",
        ),
    ],
)
def test_what_a_measured_room_cannot_be_names_its_file(
    tmp_path: Path, changes: dict[str, Any], told: str
) -> None:
    walls = dict.fromkeys(("x0", "x1", "y0", "y1", "z0", "z1"), "hard")
    room = {"shoebox": [6, 5, 3], "walls": walls, "materials": {"hard": {}}}
    places = {
        "sources": [{"id": "s", "pos": [1, 1, 1]}],
        "receivers": [{"id": "r", "pos": [3, 2, 1]}],
    }
    values = {**room, **places, **changes}
    file = tmp_path / "room.json"
    file.write_text(json.dumps({key: value for key, value in values.items() if value is not None}))
    command = [sys.executable, "-m", "dwell", "ir", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert told in done.stderr


def test_things_outside_stand_in_the_report() -> None:
    house = dwell.House.shoebox(SIZE)
    edit = house.edit().add("dining_chair", (9.0, 0.0, 1.0), name="lost")
    edited = edit.add("dining_chair", (2.0, 0.0, 1.0), name="chair").done()
    rows = [row["sentence"] for row in edited.info()["report"]["warnings"]]
    assert len(rows) == 1
    assert "lost" in rows[0]
    assert "outside of every room" in rows[0]
    moved = edited.edit().move("chair", (2.0, 0.0, 9.0)).done()
    assert any("chair" in row["sentence"] for row in moved.info()["report"]["warnings"][1:])


def test_agents_that_start_outside_are_told(caplog: pytest.LogCaptureFixture) -> None:
    edit = dwell.House.shoebox(SIZE).edit().agent_start(at=(2.0, 0.0, 1.5))
    with caplog.at_level(logging.WARNING, "dwell"):
        dwell.World(edit.done())
        assert not caplog.records
        house = edit.agent_start(at=(100.0, 0.0, 100.0), agent=0).done()
        dwell.World(house)
        dwell.World(house)
    told = [record.getMessage().split(" m;")[0] for record in caplog.records]
    assert told == [f"an agent stands outside of every room of {house.name!r}, at (100, 0, 100)"]
    (row,) = [row["sentence"] for row in house.info()["report"]["warnings"]]
    assert row == "edits: agent_starts[0]: stands outside of every room"


@pytest.mark.long
def test_no_goal_has_no_distance() -> None:
    env = gymnasium.make("dwell/Free-v0", sensors=["gps"])
    env.reset(seed=1)
    _, _, _, _, info = env.step(1)
    assert "distance_to_goal" not in info
    assert info["path_length"] > 0.0
    env.close()
    many = gymnasium.make_vec("dwell/Free-v0", num_envs=2, sensors=["gps"])
    many.reset(seed=1)
    _, _, _, _, infos = many.step(np.ones(2, np.int64))
    assert np.isnan(infos["distance_to_goal"]).all()
    many.close()


def test_wrong_names_are_answered_with_the_nearest() -> None:
    house = dwell.House.open("builtin:studio")
    with pytest.raises(dwell.HouseError, match=r"the nearest are single_bed_1"):
        house.edit().add("mug", on="single_bde_1").done()
    room = dwell.House.shoebox(SIZE).edit().add("desk", (2.0, 0.0, 1.0), name="table").done()
    with pytest.raises(dwell.HouseError, match=r"'?tabel.*one of the objects: table"):
        room.edit().add("mug", on="tabel").done()
    with pytest.raises(dwell.ConfigError, match=r"single_bed_1"):
        dwell.World(house).act("pick", "single_bde_1")


def test_a_shoebox_is_of_a_substance_or_absorbs_as_told() -> None:
    size = (4.0, 2.5, 3.0)
    with pytest.raises(dwell.ConfigError, match=r"found both, 'oak' and 0\.1"):
        dwell.House.shoebox(size, substance="oak", absorption=0.1)
    assert dwell.House.shoebox(size, substance="oak", scattering=0.1)
    # What the documentation says of the default: parquet below, plaster around.
    plain = dwell.AcousticScene(dwell.House.shoebox(size)).material_report()
    assert {"parquet", "plaster"} <= {word for word in re.findall(r"\w+", str(plain))}


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"


@pytest.mark.parametrize(
    "text",
    [TRIANGLE, "\ufeff" + TRIANGLE, TRIANGLE.replace("\n", "\r"), TRIANGLE.replace("\n", "\r\n")],
)
def test_lines_of_obj_files_end_and_begin_as_editors_have_them(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(text.encode())
    house = dwell.House.open(str(path))
    assert house.info()["triangles"] == 2
    assert not house.info()["report"]["warnings"]


@pytest.mark.long
def test_a_house_that_could_not_be_read_again_is_not_written(tmp_path: Path) -> None:
    edits = dwell.House.open("builtin:studio").edit()
    for k in range(2):
        edits.add("mug", at=(2.0, 0.0, 2.0), name=f"{k}" + "x" * 2**25)
    with pytest.raises(dwell.HouseError, match="at most 67108864 are read again"):
        edits.done().write(str(tmp_path / "a.dwell"), "dwell")
    assert not list(tmp_path.iterdir())
