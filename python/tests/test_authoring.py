"""Houses made and changed by people, from Python."""

from __future__ import annotations

import gc
import json
import math
import pickle
import wave
import weakref
from collections.abc import Callable
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import dwell
from dwell.cli import main

CUBE = (
    "o cube\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\nusemtl oak_1\n"
    "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
)


def flat() -> dwell.HouseBuilder:
    plan = dwell.HouseBuilder("flat", style="nordic", seed=3)
    plan.room("study", (0.0, 0.0, 4.0, 3.0), floor="carpet", walls=("plaster", (200, 210, 220)))
    plan.room("hall", (4.1, 0.0, 6.0, 3.0))
    plan.door("study", "hall", name="way", opened=1.0)
    plan.window("study", "west")
    return plan.add("desk", (1.0, 0.0, 1.5), yaw_deg=90, name="desk").add("mug", on="desk")


def test_a_built_house_is_as_it_was_planned_and_travels(tmp_path: Path) -> None:
    house = flat().build()
    areas = {room["name"]: room["area_m2"] for room in house.rooms()}
    assert areas == pytest.approx({"study": 12.049, "hall": 5.749}, abs=1e-3)
    info = house.info()
    assert info["name"] == "flat"
    assert (
        info["categories"]["door"] == info["categories"]["window"] == info["categories"]["cup"] == 1
    )
    assert pickle.loads(pickle.dumps(house)).info() == info
    opened = dwell.House.open(flat().save(tmp_path / "flat.plan.json"))
    assert opened.info()["fingerprint"] == info["fingerprint"]
    with pytest.raises(dwell.ConfigError, match=r"\.plan\.json"):
        flat().save(tmp_path / "flat.json")


def test_edits_make_a_new_house_that_pickles_and_writes(tmp_path: Path) -> None:
    mesh = tmp_path / "cube.obj"
    mesh.write_text(CUBE)
    house = flat().build()
    before = house.info()
    with house.edit() as edit:
        edit.move("desk", by=(0.2, 0.0, 0.0))
        edit.add_file(mesh, (2.5, 0.0, 2.0), name="mine", scale=0.2, mass_kg=2.0, category="box")
        edit.add_box(
            (0.3, 0.1, 0.2), on="mine", name="brick", substance="brick", density_kg_m3=1800
        )
        edit.add_copy("cup_1", on="brick")
        edit.add_emitter("radio", thing="mine", level_db=50.0)
        edit.describe("brick", pickable=False).rename("changed").rename("den", room="study")
        with pytest.raises(dwell.ConfigError, match="move: no at, on, yaw_deg, by or turn_deg"):
            edit.move("desk")
    assert house.info() == before
    changed = edit.house
    info = changed.info()
    assert (info["name"], info["objects"]) == ("changed", before["objects"] + 3)
    assert (info["rooms"][0]["name"], info["emitters"]) == ("den", before["emitters"] + 1)
    assert pickle.loads(pickle.dumps(changed)).info() == info
    changed.write(tmp_path / "a.dwell", "dwell")
    again = dwell.House.open(tmp_path / "a.dwell").info()
    assert again["fingerprint"] == info["fingerprint"]
    world = dwell.World(changed)
    told = world.parameter("part/mine/body/mass_kg")["value"]
    assert told == pytest.approx(2.0)
    back = changed.edit().remove("mine", with_things=True).done()
    assert not {"mine", "brick"} & set(names(back))


def test_a_chain_of_edits_holds_its_first_house_and_pickles() -> None:
    first = dwell.House.shoebox((4.0, 2.5, 3.0), substance="plaster")
    house = first.edit().add_box((0.2, 0.2, 0.2), (0.05, 0.0, 1.0), name="crate").done()
    middle = house.edit().rename("middle").done()
    between, house = weakref.ref(middle), middle
    for k in range(1200):
        house = house.edit().move("crate", by=(0.001 if k % 2 else -0.001, 0.0, 0.0)).done()
    del middle
    gc.collect()
    assert between() is None
    report = house.info()["report"]["warnings"]
    assert [row["at"]["field"] for row in report] == ["crate"]
    assert report[0]["count"] > 1000
    again = pickle.loads(pickle.dumps(house))
    assert again == house
    assert again.info()["report"] == house.info()["report"]


def names(house: dwell.House) -> list[str]:
    return [thing["name"] for thing in dwell.World(house, agents=0).objects()]


def test_what_cannot_be_is_said_with_what_is_possible(apartment: dwell.House) -> None:
    with pytest.raises(dwell.HouseError, match=r"edits\[1\]\.remove\.object: found \"sofaa\""):
        apartment.edit().rename("x").remove("sofaa").done()
    with pytest.raises(dwell.HouseError, match="nearest are sofa"):
        apartment.edit().add("soffa", (0.0, 0.0, 0.0)).done()
    with pytest.raises(dwell.ConfigError, match="signal is 'gramophone'; allowed are"):
        apartment.edit().add_emitter("gramophone", (0.0, 0.0, 0.0))
    with pytest.raises(dwell.ConfigError, match="one of room, thing, structure and material"):
        apartment.edit().re_material(substance="oak")
    with pytest.raises(dwell.ConfigError, match="at"):
        apartment.edit().add("mug", (0.0, float("nan"), 0.0))
    with pytest.raises(dwell.HouseError, match="overlap"):
        dwell.HouseBuilder().room("a", (0, 0, 4, 3)).room("b", (3, 0, 6, 3)).build()
    with pytest.raises(dwell.HouseError, match=r"width_m: found 3.5; possible: at most 2.900 m"):
        flat().door("hall", "study", width_m=3.5).build()
    with pytest.raises(dwell.UsageError, match="after the with block"):
        _ = apartment.edit().house
    sound = {"signal": "gramophone", "level_db": 40}
    edits = json.dumps([{"add_emitter": {"at": [0, 0, 0], "sound": sound}}])
    with pytest.raises(dwell.HouseError, match="gramophone"):
        apartment.native.edited(edits)


def test_a_sound_file_and_starts_travel_with_the_house(tmp_path: Path) -> None:
    kettle = tmp_path / "kettle.wav"
    with wave.open(str(kettle), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        tone = 9000 * np.sin(2 * np.pi * 500 * np.arange(8000) / 8000)
        file.writeframes(tone.astype("<i2").tobytes())
    edit = flat().build().edit()
    edit.add_emitter(sound=kettle, thing="desk", level_db=70, loop=False, start_s=0.5)
    edit.agent_start(room="hall", yaw_deg=45).agent_start((1.0, 0.0, 2.5), room="study")
    house = edit.done()
    assert house.info()["sound_files"] == ["kettle.wav"]
    assert [start["room"] for start in house.info()["agent_starts"]] == ["hall", "study"]
    house.write(tmp_path / "a.dwell", "dwell")
    assert (tmp_path / "a.dwell" / "sound_0.wav").read_bytes() == kettle.read_bytes()
    kettle.unlink()
    env = gymnasium.make(
        "dwell/Free-v0", houses=str(tmp_path / "a.dwell"), sensors={"audio": {}, "compass": {}}
    )
    for seed in (0, 1):
        env.reset(seed=seed)
        loud = [np.abs(env.step(3)[0]["audio"]).max() for _ in range(20)]
        # Before it begins one hears only one's own steps.
        assert np.mean(loud[12:]) > 3.0 * np.mean(loud[:9])
        agent = env.unwrapped.agents()[0]
        assert agent["position"] == pytest.approx([5.05, 0.0, 1.5], abs=0.1)
    env.close()
    (tmp_path / "a.dwell" / "sound_0.wav").write_bytes(b"RIFFnothing")
    broken = dwell.House.open(tmp_path / "a.dwell")
    for _ in range(2):
        with pytest.raises(dwell.DwellError, match=r'kettle\.wav, played by "desk": data: found'):
            dwell.World(broken)


def test_sounds_that_cannot_be_are_refused(apartment: dwell.House, tmp_path: Path) -> None:
    edit = apartment.edit()
    with pytest.raises(dwell.ConfigError, match="a sound file needs one"):
        edit.add_emitter(sound="a.wav", at=(0.0, 0.0, 0.0))
    with pytest.raises(dwell.ConfigError, match="found both"):
        edit.add_emitter("radio", (0.0, 0.0, 0.0), sound="a.wav", level_db=50)
    broken = tmp_path / "a.wav"
    broken.write_bytes(b"RIFFnothing")
    with pytest.raises(dwell.HouseError, match=r"a\.wav"):
        edit.add_emitter(sound=broken, at=(0.0, 0.0, 0.0), level_db=50).done()


def test_an_environment_in_an_edited_house_is_sound() -> None:
    house = flat().add("toy_ball", (5.0, 0.0, 1.0)).add("stool", (3.0, 0.0, 0.6)).build()
    sensors = {"rgb": {"width": 16, "height": 16}, "audio": {}}
    env = gymnasium.make("dwell/InstructionFollowing-v0", houses=house, sensors=sensors)
    check_env(env.unwrapped, skip_render_check=True)
    env.close()


def test_a_map_gives_foreign_names_a_meaning(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.obj").write_text(
        "o Floor\nv 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nusemtl Slot.1\nf 1 2 3 4\n"
        "o Thing.7\nv 1 0 1\nv 1 1 1\nv 2 0 1\nusemtl Slot.2\nf 5 6 7\n"
    )
    path, map_file = str(tmp_path / "a.obj"), tmp_path / "m.toml"
    assert main(["info", path, "--init-map", str(map_file)]) == 0
    assert "unmapped nodes: 1" in capsys.readouterr().out
    assert main(["info", path, "--init-map", str(map_file)]) == 1
    assert "is there already" in capsys.readouterr().err
    text = map_file.read_text()
    assert '"Slot.1" = ""' in text
    map_file.write_text(
        text.replace('"Slot.1" = ""', '"Slot.1" = "oak"').replace(
            '"Thing.7" = ""', '"Thing.7" = "picture_frame"'
        )
    )
    house = dwell.House.open(path, map=map_file)
    unmapped = house.info()["unmapped"]
    assert [row["name"] for row in unmapped["materials"]] == ["Slot.2"]
    assert unmapped["nodes"] == []
    assert house.info()["categories"] == {"picture_frame": 1}
    assert pickle.loads(pickle.dumps(house)).info() == house.info()
    assert main(["info", path, "--map", str(map_file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["unmapped"] == unmapped
    with pytest.raises(dwell.HouseNotFoundError):
        dwell.House.open(path, map=tmp_path / "none.toml")


def test_one_sees_what_was_built() -> None:
    house = flat().build()
    world = dwell.World(house, agents=0)
    camera = dwell.Camera(64, 64)
    view = world.render(position=(2.5, 1.4, 1.5), yaw_deg=-90.0, camera=camera, channels=["depth"])
    # Through the open door the hall's far wall, 3.5 m away; the wall beside it at 1.5 m.
    depth = view["depth"]
    assert np.nanmax(depth) > 3.2
    assert np.isclose(depth, 1.5, atol=0.01).sum() > 500


def test_a_kettle_is_as_loud_as_its_sound_played_at_it() -> None:
    """Its emitter is within its mesh, which is closed; it is heard from beside it."""
    builder = dwell.HouseBuilder().room("kitchen", [(0, 0), (4, 0), (4, 3), (0, 3)])
    builder.add("dining_table", (2, 0, 1.5), name="table")
    builder.add("kettle", on="table", name="kettle")
    house = builder.build()

    def level_db(begin: Callable[[dwell.World], object]) -> float:
        world = dwell.World(house)
        world.place_agent((2, 0, 0.6), yaw_deg=180)
        begin(world)
        heard = []
        for _ in range(20):
            world.step()
            heard.append(world.listen(800))
        power = float(np.mean(np.concatenate(heard[5:], axis=1) ** 2))
        return 10 * math.log10(power / 4e-10)

    own = level_db(lambda world: world.act("toggle", "kettle"))
    played = level_db(lambda world: world.play("kettle", at="kettle", level_db=64))
    assert own == pytest.approx(played, abs=1.0)
    assert own > 70  # 64 dB at 1 m, in a bare kitchen
