"""Cameras of every kind, sensors of pictures, and the laws that spoil them."""

from __future__ import annotations

import json
from typing import Any, get_args

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell.camera import PROJECTIONS, Classes
from dwell.engine_types import Channel
from dwell.envs import DwellEnv


def test_every_camera_and_sensor_gives_arrays_of_its_shape(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    shapes: dict[Channel, tuple[tuple[int, ...], type[np.generic]]] = {
        "rgb": ((24, 32, 3), np.uint8),
        "depth": ((24, 32, 1), np.float32),
        "instance": ((24, 32, 1), np.int32),
        "semantic": ((24, 32, 1), np.int32),
        "normals": ((24, 32, 3), np.float32),
        "albedo": ((24, 32, 3), np.float32),
        "surfels": ((24, 32, 9), np.float32),
        "flow": ((24, 32, 2), np.float32),
        "visible_objects": ((9, 3), np.float32),
        "boxes_2d": ((9, 6), np.int32),
        "boxes_3d": ((9, 11), np.float32),
    }
    camera = dwell.Camera(32, 24, max_objects=9)
    images = world.render(agent=0, camera=camera, channels=list(shapes))
    assert {name: (image.shape, image.dtype.type) for name, image in images.items()} == shapes
    seen = images["instance"][..., 0] > 0
    lengths = np.linalg.norm(images["normals"], axis=-1)
    np.testing.assert_allclose(lengths, seen, atol=1e-4)
    np.testing.assert_array_equal(images["surfels"][..., 3:6], images["normals"])
    np.testing.assert_array_equal(images["surfels"][..., 6:], images["albedo"])
    np.testing.assert_allclose(-images["surfels"][seen, 2], images["depth"][seen, 0], rtol=1e-5)
    # The rows of the lists are those of the ids in the image.
    for thing, box in zip(images["visible_objects"], images["boxes_2d"], strict=True):
        rows, columns = np.nonzero(images["instance"][..., 0] == box[0])
        if box[0] == 0:
            assert not thing.any()
            continue
        assert (thing[0], thing[1], 0 <= thing[2] <= 1) == (box[0], rows.size, True)
        ends = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1, rows.size)
        assert tuple(box[1:]) == ends
    for classes in get_args(Classes):
        camera = dwell.Camera(32, 24, classes=classes)
        image = world.render(agent=0, camera=camera, channels=["semantic"])["semantic"]
        assert image.max() < len(apartment.semantic_classes(classes))
    with pytest.raises(dwell.ConfigError, match='"semantic" with the setting classes = "fine"'):
        world.render(channels=["semantic_fine"])  # type: ignore[list-item] # what is refused
    names = apartment.semantic_classes("nyu40")
    assert (len(names), names[1], names[40]) == (41, "wall", "otherprop")
    with pytest.raises(dwell.ConfigError, match="nyu40"):
        apartment.semantic_classes("rooms")  # type: ignore[arg-type] # what is refused


def test_cameras_of_other_kinds_see_and_are_checked(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox, agents=0)
    place = (2.0, 1.0, 2.0)

    def depth(width: int, height: int, **numbers: float | str) -> NDArray[Any]:
        camera = dwell.Camera(width, height, projection=numbers)
        return world.render(position=place, camera=camera, channels=["depth"])["depth"][..., 0]

    around = depth(64, 32, kind="equirectangular")
    # Left, ahead, right: the walls of the room of 6 by 3 by 5 m, two pixels beside each axis.
    for column, metres in ((16, 2.0), (32, 2.0), (48, 4.0)):
        assert abs(around[16, column] - metres) < 0.02
    assert abs(around[0, 0] - 2.0) < 0.01
    assert abs(around[-1, 0] - 1.0) < 0.01
    assert depth(16, 96, kind="cubemap").shape == (96, 16)
    fisheye = depth(40, 40, kind="fisheye", fx=12, fy=12, cx=20, cy=20)
    assert fisheye[0, 0] == 50.0
    assert abs(fisheye[20, 20] - 2.0) < 0.01
    down = dwell.Camera(
        20, 20, projection={"kind": "orthographic", "width_m": 2, "height_m": 2}, pitch_deg=-90
    )
    floor = world.render(position=place, camera=down, channels=["depth"])["depth"]
    np.testing.assert_allclose(floor, 1.0, atol=1e-4)
    moved = dwell.Camera(20, 20, position_m=(0.0, 0.0, -0.5))
    near = world.render(position=place, camera=moved, channels=["depth"])["depth"]
    np.testing.assert_allclose(near[5:15], 1.5, atol=1e-3)
    for projection, part in (
        ({"kind": "cubemap"}, "six times the width"),
        ({"kind": "mirror_ball"}, "mirror_ball"),
        ({"kind": "fisheye", "fx": 1}, "fy"),
        ({"kind": "pinhole", "fx": "x"}, "camera.projection.fx is 'x'"),
    ):
        with pytest.raises(dwell.ConfigError, match=part):
            world.render(position=place, camera=dwell.Camera(8, 8, projection=projection))


def test_laws_of_cameras_reach_what_an_agent_carries(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox)
    camera = dwell.Camera(16, 12)

    def depth() -> NDArray[Any]:
        return world.render(agent=0, camera=camera, channels=["depth"])["depth"]

    before = depth()
    world.set_parameter("law/depth_scale_bias/scale", 0.1)
    np.testing.assert_allclose(depth(), 1.1 * before, rtol=1e-5)
    world.set_parameter("law/depth_scale_bias/scale", 0.0)
    world.set_parameter("law/redwood_depth/strength", 1.0)
    noisy = depth()
    assert (noisy != before).any()
    np.testing.assert_array_equal(depth(), noisy)
    with pytest.raises(dwell.DwellError, match="no agent"):
        world.set_parameter("law/redwood_depth@5/strength", 1.0)


def test_an_environment_carries_cameras_by_name() -> None:
    size = {"width": 16, "height": 12, "preset": "flat"}
    round_eye = {"kind": "fisheye", "fx": 6, "fy": 6, "cx": 8, "cy": 6}
    sensors = {
        "left": {"kind": "depth", "position_m": [-0.05, 0, 0], **size},
        "right": {"kind": "depth", "position_m": [0.05, 0, 0], **size},
        "round": {"kind": "rgb", "projection": round_eye, **size},
        "flow": size,
        "boxes_3d": {**size, "max_objects": 5},
    }
    env = DwellEnv(sensors=sensors)
    seen, _ = env.reset(seed=3)
    assert list(seen) == list(sensors)
    assert (seen["left"] != seen["right"]).any()
    assert not seen["flow"].any()
    seen, *_ = env.step(3)
    assert env.observation_space.contains(seen)
    assert (seen["round"].shape, seen["boxes_3d"].shape) == ((12, 16, 3), (5, 11))
    with pytest.raises(dwell.ConfigError, match="smell"):
        DwellEnv(sensors={"nose": {"kind": "smell"}}).reset(seed=1)


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"width": 0}, r"camera.width is 0; allowed are whole numbers from 1 to 16384"),
        ({"height": 16385}, r"camera.height is 16385; .* 1 to 16384"),
        ({"fov_deg": 200.0}, r"camera.fov_deg is 200; allowed are 1 to 175 degrees"),
        ({"near_m": -0.1}, r"camera.near_m is -0.1; allowed are 0 to"),
        ({"near_m": 2.0, "far_m": 2.0}, r"camera.far_m is 2.0; allowed is more than near_m"),
        ({"max_objects": 5000}, r"camera.max_objects is 5000; .* 1 to 4096"),
        ({"preset": "dark"}, r"camera.preset is 'dark'"),
    ],
)
def test_a_camera_is_refused_where_it_is_made(fields: dict[str, Any], why: str) -> None:
    with pytest.raises(dwell.ConfigError, match=why):
        dwell.Camera(**fields)


def test_cameras_and_receivers_that_are_equal_have_one_hash() -> None:
    around = {"kind": "fisheye", "fx": 30, "fy": 30.0, "cx": 32, "cy": 32}
    one, other = dwell.Camera(projection=around), dwell.Camera(projection={**around, "fx": 30.0})
    assert one == other
    assert hash(one) == hash(other)
    assert len({dwell.Receiver.omni((1, 1, 1)), dwell.Receiver.omni((1.0, 1.0, 1.0))}) == 1


def test_the_kinds_of_cameras_are_the_engines(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox, agents=0)
    numbers = {"fx": 20.0, "fy": 20.0, "cx": 16.0, "cy": 96.0, "width_m": 2.0, "height_m": 2.0}
    for kind, known in PROJECTIONS.items():
        given = {name: numbers.get(name, 0.0) for name in known if name != "half_angle_deg"}
        camera = dwell.Camera(32, 192, projection={"kind": kind, **given})
        seen = world.render(position=(3.0, 1.5, 2.5), camera=camera)["rgb"]
        assert seen.shape == (192, 32, 3)
        view = {"camera": {"width": 32, "height": 192, "projection": {"kind": kind, **given}}}
        view |= {"position": [3.0, 1.5, 2.5], "yaw_deg": 0.0, "pitch_deg": 0.0}
        view["camera"]["projection"]["nope"] = 1.0  # type: ignore[index] # a mapping
        with pytest.raises(dwell.ConfigError, match="nope"):
            world.native.render(json.dumps(view), ["rgb"])


def test_the_ends_of_a_cameras_ranges_are_the_engines() -> None:
    world = dwell.World(dwell.House.shoebox((4.0, 2.5, 3.0)), agents=0)
    for fields in (
        {"fov_deg": 1.0},
        {"fov_deg": 175.0},
        {"near_m": 0.0, "far_m": 1e6},
        {"max_objects": 1},
        {"max_objects": 4096},
    ):
        camera = dwell.Camera(8, 8, **fields)
        image = world.render(position=(2.0, 1.0, 1.5), camera=camera)["rgb"]
        assert image.shape == (8, 8, 3)


def test_eyes_and_a_place_are_not_rendered_from_together() -> None:
    world = dwell.World(dwell.House.shoebox((4.0, 2.5, 3.0)))
    with pytest.raises(dwell.ConfigError, match="agent, position: found both"):
        world.render(agent=0, position=(2.0, 1.0, 1.5))
    with pytest.raises(dwell.ConfigError, match="yaw_deg is 30 without a position"):
        world.render(yaw_deg=30.0)
