"""Houses of seeds."""

from __future__ import annotations

from typing import Any

import pytest

import dwell


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
