"""Hostile use of worlds and environments: a documented end, or an error that says what is wrong."""

from __future__ import annotations

import math
import random
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")

SMALL: dict[str, Any] = {"rgb": {"width": 16, "height": 12}, "instruction": {}}
CAMERA = dwell.Camera(16, 12)


class Anything:
    """An object that is nothing dwell takes; its name is the same in every process."""

    def __repr__(self) -> str:
        return "<anything>"


@pytest.mark.parametrize(
    "place",
    [
        pytest.param((0.0, 1.5, 2.5), id="on a wall"),
        pytest.param((0.0, 0.0, 0.0), id="in a corner"),
        pytest.param((-50.0, 1.5, 2.5), id="outside"),
        pytest.param((3.0, -9.0, 2.5), id="under the floor"),
        pytest.param((3e4, 3e4, 3e4), id="far away"),
    ],
)
def test_a_camera_anywhere_sees_finite_numbers(
    shoebox: dwell.House, place: tuple[float, float, float]
) -> None:
    world = dwell.World(shoebox, agents=0)
    for yaw in (0.0, 90.0, 200.0):
        seen = world.render(
            channels=["rgb", "depth", "normals", "instance"],
            position=place,
            yaw_deg=yaw,
            camera=CAMERA,
        )
        assert seen["rgb"].shape == (12, 16, 3)
        depth = seen["depth"]
        assert not np.isnan(depth).any()
        assert (depth >= 0.0).all()
        assert np.isfinite(seen["normals"]).all()


@pytest.mark.parametrize(
    "position",
    [
        (math.nan, 1.0, 1.0),
        (math.inf, 1.0, 1.0),
        (1e39, 1.0, 1.0),
        (1.0, 1.0),
        "here",
        None,
        Anything(),
    ],
)
def test_a_camera_nowhere_is_refused(shoebox: dwell.House, position: object) -> None:
    world = dwell.World(shoebox)
    if position is None:
        assert world.render(position=None, camera=CAMERA)["rgb"].any()
        return
    with pytest.raises(dwell.ConfigError, match="position"):
        world.render(position=position, camera=CAMERA)


def test_ears_and_sources_inside_of_walls_give_finite_sound(apartment: dwell.House) -> None:
    """The ears receive the sound that passes the wall: finite, often silent."""
    scene = dwell.AcousticScene(apartment, rays=300, max_duration_s=0.4)
    for source, mic in (
        ((0.0, 1.5, 1.0), (2.0, 1.5, 2.0)),
        ((2.0, 1.5, 2.0), (0.0, 1.5, 1.0)),
        ((2.0, 1.5, 2.0), (2.0, 1.5, 2.0)),
        ((2.0, 1.5, 2.0), (-40.0, 1.5, 2.0)),
        ((2.0, -5.0, 2.0), (2.0, 1.5, 2.0)),
    ):
        response = scene.impulse_response(source, mic)
        assert response.shape[1] > 0
        assert np.isfinite(response).all()


ACTIONS: list[Any] = [
    math.nan,
    math.inf,
    1.5,
    -1,
    10**30,
    "move_forward",
    None,
    [],
    [0],
    {},
    Anything(),
    True,
    b"0",
    np.array([0, 1]),
    np.array([0.5]),
    np.array(math.nan),
    np.array("0"),
    1j,
]


@pytest.mark.parametrize("action", ACTIONS, ids=repr)
def test_an_action_that_is_none_is_refused_and_changes_nothing(action: object) -> None:
    env = environment()
    before = env.state_hash()
    with pytest.raises(dwell.DwellError, match="action") as caught:
        env.step(action)
    assert not isinstance(caught.value, dwell.EngineBug)
    assert env.state_hash() == before


_ENV: list[DwellEnv] = []


def environment() -> DwellEnv:
    """One environment for the tests that must not change it."""
    if not _ENV:
        env = DwellEnv(sensors=SMALL)
        env.reset(seed=1)
        _ENV.append(env)
    return _ENV[0]


@pytest.mark.parametrize(
    "actions",
    [
        None,
        0,
        [0],
        [0, 1, 2],
        [[0, 1]],
        [0, math.nan],
        [0, "x"],
        [0, 99],
        [0, -1],
        np.zeros((2, 2), int),
        np.array([0.0, 0.5]),
        np.array([1, 1], complex),
        "01",
        [[0], [1, 2]],
    ],
    ids=repr,
)
def test_actions_of_a_vector_that_are_none_are_refused(actions: object) -> None:
    vector = DwellVectorEnv(2, houses="builtin:studio", sensors=SMALL)
    vector.reset(seed=1)
    with pytest.raises(dwell.DwellError, match="action") as caught:
        vector.step(actions)
    assert not isinstance(caught.value, dwell.EngineBug)
    vector.close()


@pytest.mark.parametrize(
    "controls",
    [
        [[math.nan, 0, 0, 0]],
        [[math.inf, 0, 0, 0]],
        [[1e39, 0, 0, 0]],
        [[0, 0, 0]],
        [[0, 0, 0, 0], [0, 0, 0, 0]],
        np.full((1, 4), math.nan, np.float32),
        [{"forward_m_s": math.nan}],
        Anything(),
    ],
    ids=repr,
)
def test_controls_that_are_none_are_refused_and_change_nothing(
    shoebox: dwell.House, controls: object
) -> None:
    world = dwell.World(shoebox)
    before = world.state_hash()
    with pytest.raises(dwell.ConfigError, match=r"control|no agent 1"):
        world.step(controls)
    assert world.state_hash() == before


def test_calls_after_close_say_so() -> None:
    env = DwellEnv(sensors=SMALL)
    env.reset(seed=1)
    env.close()
    calls: list[Callable[[], Any]] = [
        lambda: env.step(0),
        lambda: env.reset(seed=1),
        env.render,
        env.snapshot,
        env.state_hash,
        env.expert_action,
    ]
    for call in calls:
        with pytest.raises(dwell.UsageError, match="closed"):
            call()
    env.close()


def from_many_threads(calls: list[Callable[[], Any]]) -> list[BaseException]:
    """Runs the calls at once, twenty times each; what they raised."""
    raised: list[BaseException] = []
    ready = threading.Barrier(len(calls))

    def run(call: Callable[[], Any]) -> None:
        ready.wait()
        for _ in range(20):
            try:
                call()
            except BaseException as error:
                raised.append(error)

    workers = [threading.Thread(target=run, args=(call,)) for call in calls]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return raised


def test_calls_of_one_world_from_several_threads_are_done_or_refused(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox)
    saved = world.snapshot()
    raised = from_many_threads(
        [
            lambda: world.step([[0.3, 0.0, 0.1, 0.0]]),
            lambda: world.do(1),
            lambda: world.render(camera=CAMERA),
            lambda: world.listen(64),
            world.snapshot,
            lambda: world.restore(saved),
            world.state_hash,
        ]
    )
    assert all(type(error) is dwell.UsageError for error in raised), raised[:3]
    assert all("busy in another thread" in str(error) for error in raised)
    # It is whole afterwards.
    world.restore(saved)
    assert world.state_hash() == dwell.World(shoebox).state_hash()


def test_calls_of_one_environment_from_several_threads_are_done_or_refused() -> None:
    env = DwellEnv(houses="builtin:studio", sensors=SMALL)
    env.reset(seed=1)
    raised = from_many_threads(
        [lambda: env.step(1), lambda: env.step(2), env.snapshot, lambda: env.reset(seed=2)]
    )
    assert all(isinstance(error, dwell.UsageError) for error in raised), raised[:3]
    first = env.reset(seed=3)[0]
    np.testing.assert_array_equal(first["rgb"], env.reset(seed=3)[0]["rgb"])


def test_a_snapshot_that_is_cut_is_refused(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox)
    saved, before = world.snapshot(), world.state_hash()
    for length in range(0, len(saved), max(1, len(saved) // 60)):
        with pytest.raises(dwell.ConfigError, match="snapshot refused"):
            world.restore(saved[:length])
        assert world.state_hash() == before
    with pytest.raises(dwell.ConfigError, match="snapshot refused"):
        world.restore(saved + b"\0")
    world.restore(saved)


def test_a_snapshot_that_was_changed_is_refused_or_leads_to_a_world_that_runs(
    shoebox: dwell.House,
) -> None:
    world = dwell.World(shoebox)
    for _ in range(3):
        world.step([[0.5, 0.0, 0.3, 0.0]])
    saved = world.snapshot()
    draw = random.Random(7)
    said: list[str] = []
    for _ in range(150):
        changed = bytearray(saved)
        for _ in range(draw.randint(1, 3)):
            changed[draw.randrange(len(changed))] = draw.randrange(256)
        try:
            world.restore(bytes(changed))
        except dwell.ConfigError as error:
            said.append(str(error))
            continue
        world.step([[0.5, 0.0, 0.3, 0.0]])
        assert np.isfinite(world.render(channels=["depth"], camera=CAMERA)["depth"]).all()
    assert len(said) > 100
    assert all("snapshot refused" in text for text in said), said[:3]
    world.restore(saved)


def test_a_snapshot_of_another_house_is_refused(
    shoebox: dwell.House, apartment: dwell.House
) -> None:
    saved = dwell.World(apartment).snapshot()
    world = dwell.World(shoebox)
    before = world.state_hash()
    with pytest.raises(dwell.ConfigError, match="house"):
        world.restore(saved)
    assert world.state_hash() == before
    env = environment()
    hash_before = env.state_hash()
    for foreign in (saved, b"", b"dwenv", "text", None, 5):
        with pytest.raises(dwell.DwellError, match="snapshot"):
            env.restore(foreign)  # type: ignore[arg-type]
        assert env.state_hash() == hash_before


@pytest.mark.parametrize("seed", [math.nan, 1.5, -1, "ab", [1], [1, -1], [1, None, 2], Anything()])
def test_seeds_of_a_vector_that_are_none_are_refused(seed: Any) -> None:  # noqa: ANN401 - wrong ones
    vector = DwellVectorEnv(2, houses="builtin:studio", sensors=SMALL)
    with pytest.raises(dwell.ConfigError, match="seed"):
        vector.reset(seed=seed)
    with pytest.raises(dwell.ConfigError, match="options"):
        vector.reset(seed=1, options=5)  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", [-1, 2**64, 10**40, 1.5, "7", math.nan, [1]], ids=repr)
def test_seeds_out_of_range_are_refused(shoebox: dwell.House, seed: object) -> None:
    with pytest.raises(dwell.ConfigError, match="seed"):
        dwell.World(shoebox, seed=seed)
    with pytest.raises(dwell.ConfigError, match="seed"):
        environment().reset(seed=seed)
    assert environment().reset(seed=2**32)[0]["rgb"].shape == (12, 16, 3)


@pytest.mark.parametrize(
    ("houses", "said"),
    [
        ("castle", "is no house this version opens"),
        ("builtin:castle", "no built-in house"),
        ("seed:9..3", "seed"),
        ("seed:0..99999999999999999999", "seed"),
        ("seed:1?home=castle", "castle"),
        ("/nowhere/house.json", "/nowhere"),
        ("a\0b", "is no house this version opens"),
        (["builtin:studio", 5], "houses[1] is 5"),
        (["castle", "castle"], "is no house this version opens"),
        ([[]], "houses[0] is []"),
        ({"a": 1}, "expected HOUSE strings or Houses"),
        (b"builtin:studio", "houses"),
        (math.nan, "houses is nan"),
        (True, "houses is True"),
    ],
    ids=repr,
)
def test_houses_that_are_none_are_refused(houses: object, said: str) -> None:
    with pytest.raises(dwell.DwellError) as caught:
        DwellEnv(houses=houses, sensors=SMALL).reset(seed=1)
    assert not isinstance(caught.value, dwell.EngineBug)
    assert said in str(caught.value)


def test_a_chain_of_more_joints_than_a_world_holds_is_refused(tmp_path: Path) -> None:
    mass = '<mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    links = (f'<link name="link_{k}"><inertial>{mass}</inertial></link>' for k in range(301))
    joints = (
        f'<joint name="joint_{k}" type="continuous"><origin xyz="0 0 0.5"/>'
        f'<parent link="link_{k}"/><child link="link_{k + 1}"/></joint>'
        for k in range(300)
    )
    path = tmp_path / "chain.urdf"
    path.write_text(f'<robot name="chain">{"".join(links)}{"".join(joints)}</robot>')
    house = dwell.House.open(str(path))
    said = 'object "chain": joints that act on each other, from "joint_0" on: 300'
    with pytest.raises(dwell.ConfigError, match=said):
        dwell.World(house)


#: Opens a house with little memory left, and takes a picture of it.
SHORT_OF_MEMORY = """
import re, resource, sys
import dwell
house = dwell.House.open(sys.argv[1])
used = int(re.search("VmSize:\\s*([0-9]+)", open("/proc/self/status").read())[1]) * 1024
resource.setrlimit(resource.RLIMIT_AS, (used + 150 * 2**20, resource.RLIM_INFINITY))
try:
    dwell.World(house, agents=0).render(position=(1.0, 1.0, 1.0), camera=dwell.Camera(16, 12))
except dwell.ConfigError as error:
    print(error)
"""


#: Asks for the largest map with little memory left.
MAP_SHORT_OF_MEMORY = """
import re, resource
import dwell
world = dwell.World("builtin:studio", agents=0)
world.map(64)
used = int(re.search("VmSize:\\s*([0-9]+)", open("/proc/self/status").read())[1]) * 1024
resource.setrlimit(resource.RLIMIT_AS, (used + 400 * 2**20, resource.RLIM_INFINITY))
try:
    world.map(16_384)
except dwell.ConfigError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not say how much is free")
def test_a_map_that_the_memory_does_not_hold_is_refused_by_a_sentence() -> None:
    command = [sys.executable, "-c", MAP_SHORT_OF_MEMORY]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(
        "longest_edge is 16384; allowed is what the memory of this machine"
    )
    assert "are free; take fewer pixels" in done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not say how much is free")
def test_images_that_the_memory_does_not_hold_are_refused_by_a_sentence(tmp_path: Path) -> None:
    from PIL import Image

    # A few KiB of file, and some 190 MiB in a renderer.
    image = Image.new("1", (4096, 4096))
    image.putpixel((7, 7), 1)
    image.save(tmp_path / "big.png")
    (tmp_path / "a.mtl").write_text("newmtl big\nmap_Kd big.png\n")
    corners = "v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\n"
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{corners}o floor\nusemtl big\nf 4 3 2 1\n")
    command = [sys.executable, "-c", SHORT_OF_MEMORY, str(tmp_path / "a.obj")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    told = "the house is one whose images have 16777216 pixels; allowed is what the memory of this"
    assert told in done.stdout
    assert "are free; take smaller images" in done.stdout
