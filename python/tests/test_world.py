"""Worlds, houses and sound through the package."""

from __future__ import annotations

import json
import math
import multiprocessing
import os
import pickle
import re
import threading

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import Camera, World, _native
from dwell.envs import DwellEnv

pytestmark = pytest.mark.usefixtures("open_once")


def test_errors_form_one_tree_that_callers_expect() -> None:
    with pytest.raises(FileNotFoundError) as caught:
        dwell.House.open("/nowhere/house.json")
    assert isinstance(caught.value, dwell.HouseNotFoundError)
    assert isinstance(caught.value, dwell.HouseError)
    assert isinstance(caught.value, dwell.DwellError)
    assert isinstance(caught.value, ValueError)
    assert str(caught.value).startswith("/nowhere: ")


def test_the_apartment_is_a_home(apartment: dwell.House) -> None:
    info = apartment.info()
    assert len(info["rooms"]) >= 5
    assert info["objects"] >= 60
    assert len(info["categories"]) >= 25
    kinds = {kind for room in info["rooms"] for kind in room["kinds"]}
    assert {"kitchen", "bathroom", "bedroom", "living room"} <= kinds
    text = apartment.describe("house")[0]
    assert "kitchen" in text
    assert text.endswith(".")


def test_a_shoebox_is_seen_as_its_geometry_says(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox, agents=0)
    camera = dwell.Camera(9, 9, fov_deg=90.0, preset="flat")
    images = world.render(position=(3.0, 1.5, 2.5), camera=camera, channels=["depth", "instance"])
    # Straight ahead is the north wall, z = 0, for every pixel of the middle row.
    np.testing.assert_allclose(images["depth"][4, :, 0], 2.5, atol=1e-4)
    assert images["depth"].dtype == np.float32
    names = {1: "floor", 2: "ceiling", 5: "north"}
    assert images["instance"][4, 4, 0] in names


def test_the_free_field_falls_by_distance() -> None:
    house = dwell.House.shoebox((60.0, 60.0, 60.0), absorption=1.0)
    scene = dwell.AcousticScene(house, rays=0, image_order=0, air_absorption=False)
    for distance in (1.0, 2.0, 5.0, 10.0):
        response = scene.impulse_response((30.0, 30.0, 30.0), (30.0 + distance, 30.0, 30.0))[0]
        level_db = 20.0 * np.log10(np.sqrt(np.sum(response.astype(np.float64) ** 2)) * distance)
        arrival = np.argmax(np.abs(response)) / scene.rate_hz
        assert abs(level_db) < 0.1 + 0.2  # the band-limited pulse loses a little at the band's edge
        assert abs(arrival - distance / 343.2) < 1.0 / scene.rate_hz


def test_ears_tell_left_from_right() -> None:
    house = dwell.House.shoebox((60.0, 60.0, 60.0), absorption=1.0)
    scene = dwell.AcousticScene(house, rays=0, image_order=0)
    left, right = scene.impulse_response((27.0, 30.0, 30.0), (30.0, 30.0, 30.0), ears=True)
    # The head faces -Z, so -X is its left.
    assert np.argmax(np.abs(left)) < np.argmax(np.abs(right))
    assert np.sum(left**2) > np.sum(right**2)


def test_laws_of_sound_act_on_responses() -> None:
    house = dwell.House.shoebox((60.0, 60.0, 60.0), absorption=1.0)
    points = ((30.0, 30.0, 30.0), (33.0, 30.0, 30.0))

    def response(*laws: dict[str, object]) -> NDArray[np.float32]:
        scene = dwell.AcousticScene(house, laws=laws, rays=0, image_order=0)
        heard: NDArray[np.float32] = scene.impulse_response(*points)[0]
        again = pickle.loads(pickle.dumps(scene))
        assert (again.impulse_response(*points)[0] == heard).all()
        return heard

    def law(name: str, **params: float) -> dict[str, object]:
        return {"id": name, "version": 1, "params": params}

    plain = response()
    assert (response(law("microphone_gain", gain_db=0.0)) == plain).all()
    louder = response(law("source_gain", gain_db=6.0), law("microphone_gain", gain_db=-26.0))
    np.testing.assert_allclose(louder, 0.1 * plain, atol=1e-6)
    late = response(law("recording_delay", delay_s=0.01))
    assert (late[160:] == plain).all()
    assert not late[:160].any()
    warm = response(law("temperature_error", offset_k=30.0))
    arrival = 3.0 / (343.2 * (323.15 / 293.15) ** 0.5) * 16_000
    assert abs(np.argmax(np.abs(warm)) - arrival) < 1.0
    with pytest.raises(ValueError, match="gain_db is 200"):
        response(law("microphone_gain", gain_db=200.0))
    with pytest.raises(ValueError, match="microphone_gain"):
        response(law("nope"))


def test_a_snapshot_continues_with_the_same_bits(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    room = apartment.rooms()[0]
    world.place_agent(room["stand"], room["yaw_deg"])
    for _ in range(5):
        world.do("move_forward")
        world.listen()
    saved = world.snapshot()

    def go_on() -> tuple[int, bytes]:
        heard = b""
        for _ in range(6):
            world.do("turn_left")
            heard += world.listen().tobytes()
        return world.state_hash(), heard

    first = go_on()
    world.restore(saved)
    assert go_on() == first
    with pytest.raises(dwell.DwellError):
        world.restore(saved[:-7] + b"nothing")
    assert world.state_hash() == first[0]


@pytest.mark.parametrize("drift_ppm", [-20_000.0, -1.0, 20_000.0])
def test_a_world_with_another_clock_comes_back_with_the_same_hash(drift_ppm: float) -> None:
    world = dwell.World("builtin:studio", laws={"clock_drift": {"drift_ppm": drift_ppm}})
    world.listen(800)
    world.play("noise", at=(2.0, 1.2, 9.4), loop=True)
    for _ in range(30):
        world.step()
        there, snapshot = world.state_hash(), world.snapshot()
        world.restore(snapshot)
        assert world.state_hash() == there


def test_a_snapshot_of_other_agents_or_another_rate_is_refused(shoebox: dwell.House) -> None:
    saved = dwell.World(shoebox, agents=1).snapshot()
    for other, told in [
        (dwell.World(shoebox, agents=2), "agents"),
        (dwell.World(shoebox, agents=[{"height_m": 1.4}]), "agent 0 was made with another body"),
        (dwell.World(shoebox, sound_rate_hz=8000), "8000"),
    ]:
        before = other.state_hash()
        with pytest.raises(dwell.DwellError, match=told):
            other.restore(saved)
        assert other.state_hash() == before


def test_parameters_change_one_world_and_no_other(apartment: dwell.House) -> None:
    world, other = dwell.World(apartment), dwell.World(apartment)
    world.set_parameter("world/gravity_m_s2", 1.62)
    assert world.parameter("world/gravity_m_s2")["value"] == pytest.approx(1.62)
    assert other.parameter("world/gravity_m_s2")["value"] == pytest.approx(9.80665)
    with pytest.raises(dwell.SceneError, match="gravity"):
        world.set_parameter("world/gravity", 1.0)


def test_laws_have_addresses(apartment: dwell.House) -> None:
    world, plain = dwell.World(apartment), dwell.World(apartment)
    before = world.state_hash()
    assert world.parameter("law/drag/c_d")["value"] == 0.0
    world.set_parameter("law/drag/c_d", 0.5)
    assert world.parameters("law/drag/")["law/drag/c_d"]["value"] == 0.5
    assert world.state_hash() != before
    snapshot = world.snapshot()
    world.step()
    after = world.state_hash()
    plain.restore(snapshot)
    assert plain.parameter("law/drag/c_d")["value"] == 0.5
    plain.step()
    assert plain.state_hash() == after
    for address, value, match in [
        ("law/drag/c_d", 1e9, "0 to 20"),
        ("law/drog/c_d", 1.0, "drag"),
        ("law/wheel_slip/slip_per_m_s2", 0.1, "walking"),
    ]:
        with pytest.raises(dwell.DwellError, match=match):
            world.set_parameter(address, value)
    everything = world.parameters()
    assert {"world/gravity_m_s2", "joint/0/friction", "agent/0/camera/fov_deg"} <= set(everything)


def test_numbers_that_bound_each_other_are_set_together(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    before = world.state_hash()
    child = {"height_m": 0.35, "eye_height_m": 0.3, "radius_m": 0.1}
    numbers = {f"agent/0/body/{name}": value for name, value in child.items()}
    for name, value in numbers.items():
        if "height_m" in name and "eye" not in name:
            with pytest.raises(dwell.SceneError, match="out of range"):
                world.set_parameter(name, value)
    for bad, match in [
        ({"agent/0/body/radius_m": 0.2}, "height_m.*0.4 to 3"),
        ({"world/gravity": 1.0}, "known are"),
        ({"world/gravity_m_s2": "x"}, "world/gravity_m_s2"),
        ({"law/drag@nothing/c_d": 1.0}, "nothing"),
    ]:
        with pytest.raises(dwell.DwellError, match=match):
            world.set_parameters({**numbers, **bad})
        assert world.state_hash() == before
    world.set_parameters(numbers)
    assert world.agents()[0]["body"]["height_m"] == pytest.approx(0.35)
    assert world.parameter("agent/0/body/radius_m")["value"] == pytest.approx(0.1)
    other = dwell.World(apartment, parameters=numbers)
    other.restore(world.snapshot())
    assert other.agents() == world.agents()
    with pytest.raises(dwell.ConfigError, match="parameters is"):
        world.set_parameters([("world/gravity_m_s2", 1.0)])  # type: ignore[arg-type]


def test_the_field_of_view_of_an_agent_reaches_its_pictures(apartment: dwell.House) -> None:
    world = dwell.World(apartment, agents=[{"camera_fov_deg": 70.0}])
    room = apartment.rooms()[0]
    world.place_agent(room["stand"], room["yaw_deg"])
    address = "agent/0/camera/fov_deg"
    assert world.parameter(address)["value"] == pytest.approx(70.0)

    def look(fov_deg: float | None) -> np.ndarray:
        camera = dwell.Camera(32, 24, fov_deg=fov_deg, preset="flat")
        return np.asarray(world.render(camera=camera)["rgb"])

    first = look(None)
    np.testing.assert_array_equal(first, look(70.0))
    world.set_parameter(address, 110.0)
    wide = look(None)
    assert np.mean(np.any(first != wide, axis=2)) > 0.1
    np.testing.assert_array_equal(wide, look(110.0))
    np.testing.assert_array_equal(first, look(70.0))


def test_agents_are_put_on_the_move(shoebox: dwell.House) -> None:
    robot = {"locomotion": {"differential_drive": {}}}
    world = dwell.World(shoebox, agents=[{}, robot])
    world.place_agent(
        (3.0, 0.0, 2.0),
        pitch_deg=-30.0,
        linear_m_s=(1.0, 2.0, 0.0),
        yaw_rate_rad_s=0.5,
        crouched_by_m=0.4,
    )
    walker = world.agents()[0]
    assert walker["velocity"] == [1.0, 2.0, 0.0]
    assert walker["pitch_rad"] == pytest.approx(math.radians(-30.0))
    assert walker["crouched_by_m"] == pytest.approx(0.4)
    assert walker["gyro_rad_s"] == 0.5
    world.place_agent((2.0, 0.0, 2.0), agent=1, wheel_rad_s=(4.0, 6.0))
    base = world.agents()[1]
    assert base["base"]["wheel_rad_s"] == [4.0, 6.0]
    assert base["velocity"] == pytest.approx([0.0, 0.0, -0.25])
    before = world.state_hash()
    with pytest.raises(dwell.DwellError, match="no such wheels"):
        world.place_agent((2.0, 0.0, 2.0), wheel_rad_s=(1.0, 1.0))
    with pytest.raises(dwell.ConfigError, match="wheel_rad_s"):
        world.place_agent((2.0, 0.0, 2.0), agent=1, wheel_rad_s=(1.0,))
    assert world.state_hash() == before


def test_things_are_set_to_any_pose_and_velocity(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    rng = np.random.default_rng(1)
    name = next(thing["name"] for thing in world.objects() if thing["pickable"])
    for _ in range(100):
        turn = rng.normal(size=4)
        turn /= np.linalg.norm(turn)
        told = {
            "position": rng.uniform(0.5, 2.0, 3),
            "rotation": turn,
            "linear_m_s": rng.uniform(-5.0, 5.0, 3),
            "angular_rad_s": rng.uniform(-10.0, 10.0, 3),
        }
        world.set_body(name, **told)
        found = world.body(name)
        for key, value in told.items():
            np.testing.assert_allclose(found[key], value, rtol=0.0, atol=1e-6)
    before = world.state_hash()
    for wrong, error, match in [
        ({"linear_m_s": (1e12, 0.0, 0.0)}, dwell.DwellError, "1000 m/s"),
        ({"position": (float("nan"), 0.0, 0.0)}, dwell.ConfigError, "finite"),
        ({"rotation": (0.0, 0.0, 0.0, 0.0)}, dwell.ConfigError, "rotation"),
        ({"part": "wing"}, dwell.ConfigError, "wing"),
    ]:
        with pytest.raises(error, match=match):
            world.set_body(name, **wrong)
    with pytest.raises(dwell.ConfigError, match="no object"):
        world.set_body("unicorn")
    fixed = next(joint["object"] for joint in world.joints())
    with pytest.raises(dwell.DwellError, match="moves it"):
        world.set_body(fixed)
    assert world.state_hash() == before


def test_several_things_are_set_at_once_or_none(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    names = [thing["name"] for thing in world.objects() if thing["pickable"]][:3]
    turned = world.body(names[2])["rotation"]
    rows = [{"object": name, "position": (1.0, 1.5 + k, 2.0)} for k, name in enumerate(names)]
    rows[1] |= {"rotation": (0.0, 2.0, 0.0, 0.0), "linear_m_s": (0.0, 1.0, 0.0), "part": None}
    world.set_bodies(row for row in rows)
    for k, name in enumerate(names):
        assert world.body(name)["position"] == (1.0, 1.5 + k, 2.0)
    assert world.body(names[1])["rotation"] == (0.0, 1.0, 0.0, 0.0)
    assert world.body(names[1])["linear_m_s"] == (0.0, 1.0, 0.0)
    assert world.body(names[2])["rotation"] == turned
    before = world.state_hash()
    world.set_bodies([])
    for wrong, match in [
        ({"object": "unicorn"}, "no object"),
        ({"position": (0.0, 1.0, 0.0)}, r"bodies\[1\] is .*the name of a thing as object"),
        ({"object": names[2], "positon": (0.0, 1.0, 0.0)}, r"bodies\[1\].*did you mean position"),
        ({"object": names[2], "position": (0.0, 1.0)}, r"bodies\[1\]\.position"),
        ({"object": names[0]}, r"bodies\[1\] is '.*', as bodies\[0\] is"),
        (names[2], r"bodies\[1\] is "),
    ]:
        with pytest.raises(dwell.ConfigError, match=match):
            world.set_bodies([{"object": names[0], "position": (2.0, 2.0, 2.0)}, wrong])  # type: ignore[list-item]
    with pytest.raises(dwell.ConfigError, match="bodies is"):
        world.set_bodies({"object": names[0]})  # type: ignore[arg-type]
    assert world.state_hash() == before


def test_houses_survive_their_own_form(apartment: dwell.House, tmp_path: os.PathLike[str]) -> None:
    path = os.path.join(tmp_path, "copy.dwell")
    assert apartment.write(path, "dwell") == []
    again = dwell.House.open(path)
    assert again.info()["categories"] == apartment.info()["categories"]
    assert dwell.World(again).state_hash() == dwell.World(apartment).state_hash()


def _step_in_child(results: multiprocessing.SimpleQueue[int]) -> None:
    world = dwell.World("builtin:apartment")
    world.step()
    world.render(camera=dwell.Camera(32, 32))
    results.put(world.state_hash())


@pytest.mark.fresh
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_forked_child_can_step_and_render(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    world.step()
    world.render(camera=dwell.Camera(32, 32))  # the parent's thread pool exists now
    context = multiprocessing.get_context("fork")
    results: multiprocessing.SimpleQueue[int] = context.SimpleQueue()
    child = context.Process(target=_step_in_child, args=(results,))
    child.start()
    child.join(60)
    assert child.exitcode == 0
    assert results.get() == world.state_hash()


def test_observations_are_written_in_place() -> None:
    from dwell.envs.config import env_json
    from dwell.envs.native_batch import NativeBatch
    from dwell.envs.python_tasks import NativeSettings

    config = env_json(
        NativeSettings("InstructionFollowing", sensors={"rgb": {"width": 16, "height": 16}})
    )
    runner = NativeBatch([dwell.House.open("builtin:apartment")], config, 1)
    runner.batch.reset([0])
    buffer = runner.buffers[0]
    assert buffer is not None
    place = buffer.__array_interface__["data"][0]
    runner.observe(np.ones(1, np.bool_))
    observed = runner.observation()["rgb"]
    assert observed.__array_interface__["data"][0] == place
    assert observed.any()
    with pytest.raises(dwell.ConfigError, match="uint8"):
        runner.batch.observe(np.ones(1, np.bool_), [np.zeros((1, 16, 16, 3), np.float32)])


def test_laws_list_what_docs_and_calibration_need() -> None:
    laws = {law["id"]: law for law in _native.laws()}
    assert {"drag", "backlash"} <= set(laws)
    for law in laws.values():
        assert law["equation"]
        assert law["source"]
        for param in law["params"]:
            assert param["low"] <= param["default"] <= param["high"]


def test_a_body_that_begins_too_large_is_refused_with_a_sentence() -> None:
    house = dwell.House.shoebox((4.0, 2.5, 2.0))
    for given in (
        {"agents": [{"radius_m": 1.0, "height_m": 2.2}]},
        {"parameters": {"agent/0/body/height_m": 2.9}},
    ):
        with pytest.raises(dwell.DwellError, match=r"agent 0.*no room of the house"):
            dwell.World(house, **given)
    dwell.World(house, agents=[{"radius_m": 0.8, "height_m": 2.2}])


def test_one_object_is_asked_for_by_its_name_or_id(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    rows = world.objects()
    held = next(row for row in rows if row["lies_in"])
    for row in (rows[0], held, rows[-1]):
        assert world.object(row["name"]) == row == world.object(np.int32(row["id"]))
    with pytest.raises(dwell.ConfigError, match=r'no object "radio"; .*"radio_1"'):
        world.object("radio")
    with pytest.raises(dwell.ConfigError, match=r"no object 0; objects have the ids [0-9]+ to"):
        world.object(0)
    with pytest.raises(dwell.ConfigError, match=r"no object 1 .it is the piece .* of the building"):
        world.object(1)
    with pytest.raises(
        dwell.ConfigError, match=rf"of the {len(rows)} the nearest are .*\"radio_1\""
    ):
        world.act("pick", "radio")
    for wrong in (-1, 1.5, None, True, ["radio_1"]):
        with pytest.raises(dwell.ConfigError, match="name is"):
            world.object(wrong)  # type: ignore[arg-type] # the fault


@pytest.mark.parametrize("body", ["walking", "differential_drive", "holonomic"])
def test_agents_tell_every_number_that_is_in_force(shoebox: dwell.House, body: str) -> None:
    world = dwell.World(shoebox, agents=[{"locomotion": {body: {}}}])
    env = DwellEnv(houses=shoebox, task="Free", sensors=["gps"])
    env.reset(seed=1)
    of_env = World.of_env(env._shelf[0], _native.World.of_env(env._runner.batch, 0))
    for one, told in ((world, world.agents), (of_env, env.agents)):
        for address, row in one.parameters("agent/0/").items():
            value = (row["value"] + (row["low"] if row["value"] > row["low"] else row["high"])) / 2
            one.set_parameter(address, value)
            _, _, group, name = address.split("/")
            now = told()[0]["body"]
            if group == "base":
                now = now["locomotion"][next(iter(now["locomotion"]))]
            shown = now["camera_fov_deg" if group == "camera" else name]
            assert shown == pytest.approx(one.parameter(address)["value"]), address
            assert shown == pytest.approx(value, rel=1e-5), address


def test_goals_of_instructions_are_the_ids_of_sensors_and_graph(apartment: dwell.House) -> None:
    world = dwell.World(apartment, agents=0)
    graph = json.loads(apartment.describe("graph")[0])
    nouns = {node["id"]: node["noun"] for node in graph["objects"]}
    rows = [json.loads(line) for line in apartment.describe("instructions")]
    asked = {k: row["text"] for row in rows for k in row["goal"]["objects"]}
    assert asked
    # "A piece of red fruit": adjectives come after the "of".
    for k, text in asked.items():
        said = re.escape(nouns[k]).replace(r"of\ ", r"of\ (\w+ )*")
        assert re.search(said, text), (nouns[k], text)
    # As cameras see them that look down from above; many stand under or in something.
    seen = 0
    for k in asked:
        row = world.object(k)
        x, y, z = row["center"]
        eye = (x, y + row["size"][1] / 2 + 0.15, z)
        view = world.render(
            position=eye, pitch_deg=-90.0, camera=Camera(3, 3), channels=["instance"]
        )
        seen += view["instance"][1, 1, 0] == k
    assert seen > len(asked) * 3 // 4


def test_calls_of_several_threads_wait_for_each_other(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox)
    saved = world.snapshot()
    navigation = world.navigation()
    raised: list[BaseException] = []
    ready = threading.Barrier(4)

    def work() -> None:
        ready.wait()
        try:
            for _ in range(10):
                world.step()
                world.render(camera=Camera(8, 8))
                navigation.update(world)
                world.snapshot()
        except BaseException as error:
            raised.append(error)

    workers = [threading.Thread(target=work) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not raised
    # None was lost.
    assert world.native.step_count == 40
    world.restore(saved)
