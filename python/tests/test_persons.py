"""Persons: their figure, gestures and steps, against projections and lengths worked out here."""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Callable
from typing import Literal

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

import dwell
from dwell import Camera, World

pytestmark = pytest.mark.usefixtures("open_once")

#: Segment lengths over height (Winter 2009, figure 4.1), typed in here once more.
UPPER_ARM, FOREARM, HAND, THIGH, SHIN = 0.186, 0.146, 0.108, 0.245, 0.246


@functools.cache
def hall() -> dwell.House:
    """A bare room."""
    return dwell.House.shoebox((12.0, 3.0, 8.0))


def person(*, seed: int = 0, **body: object) -> World:
    """A world with a person in the middle of a hall, who faces -Z, and a capsule in its corner."""
    agents = [{"kind": "person", **body}, {}]
    world = World(hall(), agents=agents, seed=seed)  # type: ignore[arg-type]
    world.place_agent((6.0, 0.0, 4.0), yaw_deg=0.0)
    world.place_agent((1.0, 0.0, 1.0), agent=1)
    return world


def wide(values: ArrayLike) -> NDArray[np.float64]:
    return np.asarray(values, np.float64)


def at(feet: NDArray[np.float64], *way: float) -> tuple[float, float, float]:
    """A point from the feet, m."""
    x, y, z = (float(a + b) for a, b in zip(feet, way, strict=True))
    return x, y, z


def length(a: ArrayLike, b: ArrayLike) -> float:
    return float(np.linalg.norm(np.subtract(a, b, dtype=np.float64)))


def check_lengths(joints: dict[str, NDArray[np.float32]], height: float) -> None:
    for side in ("left", "right"):
        for a, b, part in (
            ("shoulder", "elbow", UPPER_ARM),
            ("elbow", "wrist", FOREARM),
            ("wrist", "palm", 0.5 * HAND),
            ("wrist", "finger_tip", HAND),
            ("hip", "knee", THIGH),
            ("knee", "ankle", SHIN),
        ):
            found = length(joints[f"{side}_{a}"], joints[f"{side}_{b}"])
            assert found == pytest.approx(part * height, rel=1e-3), (side, a, b)


@pytest.mark.parametrize("height", [1.45, 1.7, 2.0])
def test_a_standing_person_is_as_high_as_it_says_and_looks_through_its_cameras_eyes(
    height: float,
) -> None:
    world = person(height_m=height)
    joints, agent = world.person_joints(0), world.agents()[0]
    check_lengths(joints, height)
    feet = np.array(agent["position"])
    assert agent["body"]["eye_height_m"] == pytest.approx(0.936 * height)
    assert tuple(joints["eyes"]) == pytest.approx(at(feet, 0.0, 0.936 * height, 0.0), abs=2e-3)
    heights = {name: joint[1] - feet[1] for name, joint in joints.items()}
    for name, part in (("shoulder", 0.818), ("hip", 0.530), ("knee", 0.285), ("ankle", 0.039)):
        assert heights[f"left_{name}"] == pytest.approx(part * height, abs=0.01 * height), name
    box = figure_box(world)
    assert box[1] == pytest.approx(height, rel=0.01)


def figure_box(world: World) -> NDArray[np.float64]:
    """Edges of the box around the person, of its picture from in front: width, height, depth."""
    feet = np.array(world.agents()[0]["position"])
    rows = world.render(
        position=at(feet, 0.0, 0.9, 2.5), camera=Camera(256, 256, 70.0), channels=("boxes_3d",)
    )["boxes_3d"]
    (row,) = [row for row in rows if row[0] == person_id(world)]
    return wide(row[4:7])


def person_id(world: World) -> int:
    """The sensors' id of the person: that of the first agent."""
    feet = np.array(world.agents()[0]["position"])
    view = world.render(
        position=at(feet, 0.0, 1.1, 1.5),
        camera=Camera(8, 8, 5.0),
        channels=("instance", "semantic"),
    )
    return int(view["instance"][4, 4, 0])


def test_the_mask_of_a_person_is_where_its_joints_are() -> None:
    world = person()
    feet = np.array(world.agents()[0]["position"])
    world.set_gesture(0, left_hand=at(feet, -0.5, 1.3, -0.2), right_hand=at(feet, 0.45, 0.95, -0.3))
    joints, number = world.person_joints(0), person_id(world)
    width, height = 320, 320
    focal = 0.5 * width / np.tan(np.radians(35.0))
    for yaw_deg in (0.0, 90.0, 180.0, 270.0):
        # The camera stands 2 m away and looks at the person along its own -Z.
        yaw = np.radians(yaw_deg)
        right = np.array((np.cos(yaw), 0.0, -np.sin(yaw)))
        back = np.array((np.sin(yaw), 0.0, np.cos(yaw)))
        eye = np.array(at(feet, 0.0, 0.9, 0.0)) + 2.0 * back
        view = world.render(
            position=tuple(eye),
            yaw_deg=yaw_deg,
            camera=Camera(width, height, 70.0),
            channels=("instance", "depth"),
        )
        mask = view["instance"][..., 0] == number
        assert mask.sum() > 2000
        pixels = []
        for name, joint in joints.items():
            way = wide(joint) - eye
            depth = -way @ back
            column = 0.5 * width + focal * (way @ right) / depth
            row = 0.5 * height - focal * way[1] / depth
            pixels.append((column, row))
            if name.endswith(("finger_tip", "toe")) or name == "eyes":
                continue  # On the skin: a pixel beside may be the room's.
            assert mask[int(row), int(column)], (yaw_deg, name)
            # The joint is inside the limb, not far behind what is seen.
            assert view["depth"][int(row), int(column), 0] < depth + 0.02, (yaw_deg, name)
        rows, columns = np.nonzero(mask)
        low, high = np.min(pixels, axis=0), np.max(pixels, axis=0)
        # A hand's or foot's breadth around the joints, and the crown above the eyes.
        margin = focal * 0.17 / 1.6
        assert low[0] - margin < columns.min() < low[0] + 3
        assert high[0] - 3 < columns.max() < high[0] + margin
        assert high[1] - 3 < rows.max() < high[1] + margin
        # The crown of 1.7 m, within 1 %, of a head that is not farther than 0.15 m from its axis.
        crowns = [0.5 * height - focal * up / away for up, away in ((0.817, 1.85), (0.783, 2.15))]
        assert crowns[0] - 1 < rows.min() < crowns[1] + 1


def test_everybody_else_sees_a_person_and_itself_it_does_not_see() -> None:
    world = person()
    number = person_id(world)
    assert number not in world.render(agent=0, channels=("instance",))["instance"]
    feet = np.array(world.agents()[0]["position"])
    view = world.render(
        position=at(feet, 0.0, 1.0, 2.5),
        camera=Camera(160, 160, 70.0),
        channels=("instance", "semantic", "visible_objects", "boxes_2d", "normals"),
    )
    mask = view["instance"][..., 0] == number
    (number_of_class,) = np.unique(view["semantic"][..., 0][mask])
    assert world.house.semantic_classes()[number_of_class] == "person"
    (row,) = [row for row in view["visible_objects"] if row[0] == number]
    assert row[1] == mask.sum()
    assert row[2] == 0.0
    (box,) = [row for row in view["boxes_2d"] if row[0] == number]
    rows, columns = np.nonzero(mask)
    assert tuple(box[1:5]) == (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
    # Unit normals that face the camera, in many directions.
    normals = view["normals"][mask]
    assert np.linalg.norm(normals, axis=-1) == pytest.approx(1.0, abs=1e-3)
    assert normals[:, 2].min() > -0.01
    assert normals[:, 0].std() > 0.2


def test_palms_reach_what_is_in_reach_and_else_the_line_to_it() -> None:
    world = person()
    height, draw = 1.7, np.random.default_rng(7)
    reach = (UPPER_ARM + FOREARM + 0.5 * HAND) * height
    for side in ("left", "right"):
        shoulder = wide(world.person_joints(0)[f"{side}_shoulder"])
        for distance in (0.1, 0.3, 0.5, 0.64, 0.8, 3.0):
            way = draw.normal(size=3)
            target = shoulder + distance * way / np.linalg.norm(way)
            world.set_gesture(0, **{f"{side}_hand": target})  # type: ignore[arg-type]
            joints = world.person_joints(0)
            check_lengths(joints, height)
            palm = wide(joints[f"{side}_palm"])
            if distance < reach:
                assert palm == pytest.approx(target, abs=1e-4)
            else:
                along = (palm - shoulder) @ (target - shoulder) / distance
                assert along == pytest.approx(reach, rel=1e-3)
                assert length(palm, shoulder + along * (target - shoulder) / distance) < 1e-4
    world.set_gesture(0)
    assert world.person_joints(0)["left_palm"][1] < shoulder[1] - 0.5


def test_the_line_from_eye_to_finger_tip_meets_the_target() -> None:
    world = person()
    draw = np.random.default_rng(11)
    feet = np.array(world.agents()[0]["position"])
    for k in range(60):
        target = feet + draw.uniform((-4.0, 0.0, -4.0), (4.0, 2.5, 4.0))
        side: Literal["left", "right"] = "left" if k % 2 else "right"
        if length(at(feet, 0.0, 1.4, 0.0), target) < 1.0:
            continue
        world.set_gesture(0, pointing=side, point_at=target, look_at=target)
        joints = world.person_joints(0)
        check_lengths(joints, 1.7)
        tip, goal = wide(joints[f"{side}_finger_tip"]), target
        ways = [point - wide(joints["eyes"]) for point in (tip, goal)]
        unit = [way / np.linalg.norm(way) for way in ways]
        assert np.degrees(np.arccos(min(unit[0] @ unit[1], 1.0))) < 0.5
        # The arm is all but straight.
        assert length(joints[f"{side}_shoulder"], tip) > 0.97 * 1.7 * 0.44
    # Without a hand it is the preferred one.
    left = person(hand="left")
    left.set_gesture(0, point_at=at(feet, 0.0, 1.0, -3.0))
    joints = left.person_joints(0)
    assert joints["left_finger_tip"][1] > joints["right_finger_tip"][1] + 0.3


def test_a_head_turns_to_what_is_looked_at_as_far_as_a_neck_does() -> None:
    world = person()
    world.place_agent(world.agents()[0]["position"], yaw_deg=0.0)
    ahead = {"eyes": world.person_joints(0)["eyes"], "head": world.person_joints(0)["head"]}
    assert (ahead["eyes"] - ahead["head"])[2] < 0.0
    feet = np.array(world.agents()[0]["position"])
    for target in ((-2.0, 1.6, -1.0), (2.0, 0.3, -2.0)):
        world.set_gesture(0, look_at=at(feet, *target))
        joints = world.person_joints(0)
        gaze = (joints["eyes"] - joints["head"])[[0, 2]]
        way = (np.array(at(feet, *target)) - joints["eyes"])[[0, 2]]
        cosine = gaze @ way / np.linalg.norm(gaze) / np.linalg.norm(way)
        assert cosine > np.cos(np.radians(2.0))
    world.set_gesture(0, look_at=at(feet, 0.0, 1.6, 5.0))
    gaze = world.person_joints(0)["eyes"] - world.person_joints(0)["head"]
    assert gaze[2] < 0.01


def walk(world: World, steps: int, speed: float) -> list[dict[str, NDArray[np.float64]]]:
    rows = []
    for _ in range(steps):
        world.step([[speed, 0.0, 0.0, 0.0]])
        joints = {name: wide(joint) for name, joint in world.person_joints(0).items()}
        rows.append(joints | {"feet": wide(world.agents()[0]["position"])})
    return rows


def test_feet_alternate_stand_still_and_swing() -> None:
    world = person()
    world.place_agent((2.0, 0.0, 4.0), yaw_deg=-90.0)
    rows = walk(world, 140, 1.0)
    ahead = np.array((1.0, 0.0, 0.0))
    way = (rows[-1]["feet"] - rows[6]["feet"]) @ ahead
    assert way == pytest.approx(6.7, abs=0.1)
    gaps = [(row["left_toe"] - row["right_toe"]) @ ahead for row in rows[6:]]
    signs = [np.sign(gap) for gap in gaps if abs(gap) > 0.05]
    changes = sum(a != b for a, b in itertools.pairwise(signs))
    # 1 m/s: steps of 0.62 m (the walk ratio 0.39 m s).
    expected = way / 0.624
    assert changes == pytest.approx(expected, abs=1.5), (changes, expected)
    slips: list[float] = []
    swings: list[float] = []
    for side in ("left", "right"):
        for a, b in itertools.pairwise(rows[6:]):
            heights = [row[f"{side}_toe"][1] - row["feet"][1] for row in (a, b)]
            moved = (b[f"{side}_toe"] - a[f"{side}_toe"]) @ ahead
            (slips if max(heights) < 0.006 else swings).append(moved)
    # A standing foot goes less than 1 cm a step of 5 cm, a swinging one farther than the body.
    assert len(slips) > 10
    assert np.median(np.abs(slips)) < 0.01
    assert np.max(swings) > 0.07
    # Arms swing against legs.
    pairs = [
        (
            (row["left_palm"] - row["left_shoulder"]) @ ahead,
            (row["left_toe"] - row["left_hip"]) @ ahead,
        )
        for row in rows[6:]
    ]
    assert np.corrcoef(np.transpose(pairs))[0, 1] < -0.5
    for _ in range(20):
        world.step()
    joints = world.person_joints(0)
    assert abs((joints["left_toe"] - joints["right_toe"]) @ ahead) < 0.01


def test_flow_shows_arms_that_move_while_the_body_stands() -> None:
    world = person()
    feet = np.array(world.agents()[0]["position"])
    eye = np.array(at(feet, 0.0, 1.0, -2.5))
    camera = Camera(160, 160, 70.0)
    world.place_agent(at(feet, 0.0, 0.0, 0.0), yaw_deg=0.0)
    world.step()
    world.set_gesture(0, right_hand=at(feet, 0.4, 1.3, -0.3))
    world.step()
    before = wide(world.person_joints(0)["right_palm"])
    world.set_gesture(0, right_hand=at(feet, 0.4, 1.4, -0.3))
    world.step()
    shot = world.render(
        position=tuple(eye), yaw_deg=180.0, camera=camera, channels=("flow", "instance")
    )
    palm = wide(world.person_joints(0)["right_palm"])
    focal = 80.0 / np.tan(np.radians(35.0))
    # The camera looks along +Z; its right is -X.
    pixel = [
        (
            80.0 - focal * (point - eye)[0] / (point - eye)[2],
            80.0 - focal * (point - eye)[1] / (point - eye)[2],
        )
        for point in (before, palm)
    ]
    column, row = pixel[1]
    found = shot["flow"][int(row), int(column)]
    assert found == pytest.approx(np.subtract(pixel[1], pixel[0]), abs=1.0)
    assert np.abs(found).max() > 3.0
    mask = shot["instance"][..., 0] == person_id(world)
    still = np.abs(shot["flow"]).max(axis=-1)[mask] < 0.01
    assert still.mean() > 0.6


def test_snapshots_and_copies_have_the_same_figure_and_bits() -> None:
    world = person()
    feet = np.array(world.agents()[0]["position"])
    walk(world, 7, 0.8)
    world.set_gesture(0, pointing="left", point_at=at(feet, 1.0, 1.0, -3.0), look_at=feet)
    saved, hashed = world.snapshot(), world.state_hash()
    world.set_gesture(0)
    assert world.state_hash() != hashed
    world.restore(saved)
    assert world.state_hash() == hashed
    again = person()
    again.restore(saved)
    eye = at(feet, 0.0, 1.2, 2.0)
    for _ in range(6):
        for one in (world, again):
            one.step([[0.9, 0.0, 0.4, 0.0]])
        assert world.state_hash() == again.state_hash()
        for name, joint in world.person_joints(0).items():
            assert np.array_equal(joint, again.person_joints(0)[name])
        a, b = (
            one.render(position=eye, channels=("rgb", "flow", "depth")) for one in (world, again)
        )
        assert all(np.array_equal(a[name], b[name]) for name in a)
    told = "its agent 0 was made with another body than the world's; the bodies they were made with"
    with pytest.raises(dwell.DwellError, match=told):
        World(hall(), agents=[{"height_m": 1.7, "eye_height_m": 0.936 * 1.7}, {}]).restore(saved)


def test_what_a_hand_holds_is_in_the_hand() -> None:
    world = World("builtin:apartment", agents=[{"kind": "person"}])
    x, _, z = world.body("book_1")["position"]
    world.place_agent((x, 0.0, z + 0.65), yaw_deg=0.0, pitch_deg=-30.0)
    hanging = length(world.person_joints(0)["right_palm"], world.body("book_1")["position"])
    assert world.act("pick", "book_1").success
    for _ in range(3):
        joints, held = world.person_joints(0), world.body("book_1")["position"]
        # Half of the book's length from its middle.
        assert length(joints["right_palm"], held) < 0.15 < hanging
        check_lengths(joints, 1.7)
        world.step([[0.3, 0.0, 0.5, 0.0]])
    world.act("drop")
    for _ in range(20):
        world.step()
    joints = world.person_joints(0)
    assert joints["right_palm"][1] == pytest.approx(joints["left_palm"][1], abs=1e-3)


def test_colours_are_drawn_or_stated() -> None:
    def shirt(world: World) -> NDArray[np.float32]:
        feet = np.array(world.agents()[0]["position"])
        view = world.render(
            position=at(feet, 0.0, 1.15, 1.5), camera=Camera(8, 8, 4.0), channels=("albedo",)
        )
        return view["albedo"][4, 4]

    red = shirt(person(colors={"shirt": [255, 0, 0]}))
    assert red == pytest.approx((1.0, 0.0, 0.0), abs=1e-3)
    drawn = [tuple(shirt(person(seed=seed))) for seed in range(8)]
    assert len(set(drawn)) > 2
    assert [tuple(shirt(person(seed=seed))) for seed in range(8)] == drawn


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda w: w.set_gesture(1), "agent 1 is no person"),
        (lambda w: w.person_joints(1), "agent 1 is no person"),
        (lambda w: w.set_gesture(2), "no agent 2; there are 2, counted from 0"),
        (lambda w: w.set_gesture(0, look_at=(0.0, float("nan"), 0.0)), "look_at"),
        (lambda w: w.set_gesture(0, left_hand=(1e9, 0.0, 0.0)), "left_hand is "),
        (lambda w: w.set_gesture(0, right_hand=(1.0, 2.0)), "right_hand"),
        (lambda w: w.set_gesture(0, pointing="up"), "pointing"),
    ],
)
def test_wrong_gestures_are_refused_with_a_sentence(
    call: Callable[[World], object], told: str
) -> None:
    world = person()
    hashed = world.state_hash()
    with pytest.raises(dwell.DwellError, match=re.escape(told)):
        call(world)
    assert world.state_hash() == hashed


def test_wrong_bodies_are_refused_with_a_sentence() -> None:
    for body, told in (
        ({"kind": "person", "height_m": 2.2}, "height_m is 2.2 (range 1.45 to 2 m of a person)"),
        ({"hand": "left"}, 'hand is of bodies of the kind "person"'),
        ({"kind": "robot"}, "robot"),
        ({"kind": "person", "colors": {"hat": [1, 2, 3]}}, "hat"),
    ):
        with pytest.raises(dwell.DwellError, match=re.escape(told)):
            World(hall(), agents=[body])  # type: ignore[list-item]
