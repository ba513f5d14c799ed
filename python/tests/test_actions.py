"""Actions of hands, through the package."""

from __future__ import annotations

import math
from typing import Any

import pytest

import dwell
import dwell.world

pytestmark = pytest.mark.usefixtures("open_once")


@pytest.fixture
def world(apartment: dwell.House) -> dwell.World:
    world = dwell.World(apartment, agents=2)
    room = apartment.rooms()[0]
    world.place_agent(room["stand"], room["yaw_deg"])
    return world


def before(world: dwell.World, thing: dict[str, Any]) -> None:
    """Puts agent 0 where it reaches a thing, looking at it."""
    x, _, z = thing["center"]
    for turn in range(24):
        angle = math.tau * turn / 24
        at = (x + 0.75 * math.sin(angle), 0.0, z + 0.75 * math.cos(angle))
        world.place_agent(at, math.degrees(angle))
        if world.act("pick", thing["name"]).success:
            return
    pytest.fail(f"nobody reaches {thing['name']}")


def test_a_thing_goes_from_hand_to_floor(world: dwell.World) -> None:
    things = [t for t in world.objects() if t["pickable"] and 0.3 < t["center"][1] < 1.0]
    before(world, things[0])
    name = things[0]["name"]
    held = next(t for t in world.objects() if t["name"] == name)
    assert held["held_by"] == 0
    assert held["rests_on"] == []
    told = world.act("throw", direction=(0.0, 1.0, 0.0), speed_m_s=0.5)
    assert told.success
    for _ in range(60):
        world.step()
    lying = next(t for t in world.objects() if t["name"] == name)
    assert lying["held_by"] is None
    assert lying["rests_on"]


def test_pixels_mean_what_the_picture_shows(world: dwell.World) -> None:
    camera = dwell.Camera(64, 48, fov_deg=80.0, preset="flat")
    ids = world.render(agent=0, camera=camera, channels=["instance"])["instance"][:, :, 0]
    for row in range(2, 48, 9):
        for column in range(2, 64, 9):
            told = world.act("point", pixel=(column, row), camera=camera)
            assert told.pointed is not None
            assert told.pointed.id == ids[row, column]
            assert told.pointed.distance_m > 0.0


def test_wrong_actions_are_refused_with_a_reason(world: dwell.World) -> None:
    agent_id = 1 + max(thing["id"] for thing in world.objects())
    assert world.act("pick", agent_id).code == "target_is_self"
    assert world.act("pick", agent_id + 1).code == "not_an_object"
    assert world.act("pick", 10**6).code == "unknown_object"
    with pytest.raises(dwell.ConfigError, match="finite"):
        world.act("throw", direction=(math.nan, 0.0, 0.0))
    with pytest.raises(dwell.ConfigError, match="no object"):
        world.act("pick", "unicorn")
    with pytest.raises(dwell.ConfigError, match="there are"):
        world.act("fly")
    with pytest.raises(dwell.ConfigError, match="no field"):
        world.act("pick", colour="red")
    with pytest.raises(dwell.ConfigError, match="no agent 7; there are 2, counted from 0"):
        world.act("drop", agent=7)


def test_a_door_tells_when_it_has_opened(world: dwell.World) -> None:
    doors = [t for t in world.objects() if t["category"] == "door" and t["openness"] == 0.0]
    x, _, z = doors[0]["center"]
    for turn in range(24):
        angle = math.tau * turn / 24
        at = (x + 0.9 * math.sin(angle), 0.0, z + 0.9 * math.cos(angle))
        world.place_agent(at, math.degrees(angle))
        if world.act("open", doors[0]["name"], fraction=0.5).success:
            break
    told = []
    for _ in range(80):
        world.step()
        told += world.delayed_outcomes()
    assert [(who, outcome.object) for who, outcome in told] == [(0, doors[0]["name"])]


def test_what_is_held_may_be_named_when_it_is_dropped(world: dwell.World) -> None:
    things = [t for t in world.objects() if t["pickable"] and 0.3 < t["center"][1] < 1.0]
    before(world, things[0])
    name, other = things[0]["name"], things[1]["name"]
    with pytest.raises(dwell.ConfigError, match=f"does not hold: it holds '{name}'"):
        world.act("drop", other)
    with pytest.raises(dwell.ConfigError, match="agent 1 does not hold: it holds nothing"):
        world.act("throw", name, agent=1)
    assert world.act("drop", name).success
    before(world, world.objects()[things[0]["id"] - world.objects()[0]["id"]])
    assert world.act({"kind": "throw", "object": things[0]["id"]}).success
    assert world.agents()[0]["holding"] is None


def test_a_sound_of_what_is_switched_off_says_what_to_do(world: dwell.World) -> None:
    rows = {row["object"]: row for row in world.sounds()}
    with pytest.raises(dwell.UsageError, match=r"radio_1 is switched off .*act\('toggle'"):
        world.start_sound(rows["radio_1"]["handle"])
    clock = rows["clock_1"]["handle"]
    world.stop_sound(clock)
    world.start_sound(clock)
    with pytest.raises(dwell.UsageError, match="no sound"):
        world.start_sound(10**6)


def test_objects_and_agents_have_the_fields_that_are_documented(world: dwell.World) -> None:
    for told, about in (
        (world.objects(), dwell.World.objects.__doc__),
        (world.agents(), dwell.World.agents.__doc__),
    ):
        assert about is not None
        assert [name for name in told[0] if f"``{name}``" not in about] == []
    agent = world.agents()[0]
    assert agent["yaw_deg"] == pytest.approx(math.degrees(agent["yaw_rad"]))
    world.place_agent(agent["position"], 30.0, pitch_deg=-20.0)
    turned = world.agents()[0]
    assert (turned["yaw_deg"], turned["pitch_deg"]) == pytest.approx((30.0, -20.0), abs=1e-4)


def test_a_spring_that_cannot_be_is_told_in_words(world: dwell.World) -> None:
    spring = {"spring": {"frequency_hz": 100.0, "damping_ratio": 1.0}}
    told = world.act("pick", "pillow_1", grasp=spring)
    assert told.code == "bad_number"
    assert told.sentence.startswith("A spring of 100 Hz and damping ratio 1 cannot be; a spring's")
