"""Navigation through the package."""

from __future__ import annotations

import copy
import math
import pickle
import re
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.navigation import Navigation

pytestmark = pytest.mark.usefixtures("open_once")


def test_in_an_empty_room_the_way_is_the_straight_line(shoebox: dwell.House) -> None:
    navigation = shoebox.navigation()
    points = navigation.points()
    assert points.dtype == np.float32
    assert points.shape[1] == 3
    start, goal = points[0], points[-1]
    route = navigation.route(start, goal)
    assert route is not None
    assert route.length_m == pytest.approx(float(np.linalg.norm(goal - start)), abs=1e-4)
    assert navigation.distance(start, goal) == route.length_m
    assert route.points.shape == (2, 3)
    assert navigation.island(start) == 0
    assert navigation.island((1e6, 0.0, 0.0)) is None
    assert navigation.route(start, (1e6, 0.0, 0.0)) is None


def test_the_picture_counts_the_places(shoebox: dwell.House) -> None:
    navigation = shoebox.navigation(dwell.Walker(cell_m=0.2))
    storey = navigation.occupancy(0)
    assert storey.free.sum() == len(navigation.points())
    assert storey.cell_m == pytest.approx(0.2)
    with pytest.raises(dwell.DwellError, match="storey 9"):
        navigation.occupancy(9)


def test_what_holds_arrays_is_compared_as_a_whole(shoebox: dwell.House) -> None:
    grid = shoebox.navigation()
    assert grid.occupancy() == copy.deepcopy(grid.occupancy())
    assert grid.route((1, 0, 1), (5, 0, 4)) == grid.route((1, 0, 1), (5, 0, 4))
    assert grid.route((1, 0, 1), (5, 0, 4)) != grid.route((1, 0, 1), (5, 0, 3))
    assert math.copysign(1.0, grid.distance((1, 0, 1), (1, 0, 1)) or 0.0) == 1.0


def test_a_walker_out_of_range_is_refused_by_its_number(shoebox: dwell.House) -> None:
    for where in (shoebox, dwell.World(shoebox)):
        with pytest.raises(dwell.ConfigError, match=r"cell_m is 5; allowed is 0\.02 to 1"):
            where.navigation(dwell.Walker(cell_m=5.0))


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"radius_m": math.nan}, "walker.radius_m is nan; allowed are finite numbers"),
        ({"height_m": "tall"}, "walker.height_m is 'tall'; expected a number"),
        ({"cell_m": [0.1]}, "walker.cell_m is [0.1]; expected a number"),
        ({"doors": "shut"}, "walker.doors is 'shut'; allowed are as_they_stand, open, priced"),
    ],
)
def test_a_walker_is_of_numbers(fields: dict[str, Any], told: str) -> None:
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        dwell.Walker(**fields)


def test_a_grid_follows_no_world_of_another_house_with_as_many_parts(
    apartment: dwell.House,
) -> None:
    other = dwell.House.shoebox((6.0, 3.0, 4.0), substance="plaster")
    twin = dwell.House.shoebox((6.0, 3.0, 4.0), substance="plaster")
    grid = other.navigation()
    assert grid.update(dwell.World(twin)) >= 0
    with pytest.raises(dwell.ConfigError, match="world is over another house"):
        grid.update(dwell.World(dwell.House.shoebox((6.0, 3.0, 5.0), substance="plaster")))


def test_samples_repeat_and_lie_where_a_way_leads(apartment: dwell.House) -> None:
    navigation = apartment.navigation(dwell.Walker(doors="open"))
    start = navigation.sample(3)[0]
    places = navigation.sample(4, 20, start=start)
    assert np.array_equal(places, navigation.sample(4, 20, start=start))
    assert all(navigation.distance(start, place) is not None for place in places)
    reachable = {tuple(point) for point in navigation.points(start)}
    assert all(tuple(place) in reachable for place in places)


def test_a_shut_door_has_a_price_and_a_name(apartment: dwell.House) -> None:
    priced = apartment.navigation(dwell.Walker(doors="priced"))
    shut = [door["name"] for door in priced.doors() if not door["is_open"]]
    assert shut
    places = priced.sample(1, 40)
    routes = [priced.route(places[0], place) for place in places]
    named = {name for route in routes if route is not None for name in route.shut_doors}
    assert named
    assert named <= set(shut)


def test_a_grid_follows_its_world(apartment: dwell.House) -> None:
    world = dwell.World(apartment, agents=1)
    navigation = world.navigation()
    assert navigation.update(world) == 0
    with pytest.raises(dwell.DwellError, match="cell_m"):
        world.navigation(dwell.Walker(cell_m=9.0))


def test_the_grid_that_a_house_keeps_is_nobodys_to_change(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    door = next(joint for joint in world.joints() if joint["object"].startswith("door"))
    places = {tuple(point) for point in apartment.navigation().points()}
    mine = apartment.navigation()
    at = door["limits"][0 if door["position"] == door["limits"][1] else 1]
    world.set_joints({door["id"]: (at, 0.0)})
    assert mine.update(world) > 0
    moved = {tuple(point) for point in mine.points()}
    assert moved == {tuple(point) for point in world.navigation().points()} != places
    assert {tuple(point) for point in apartment.navigation().points()} == places


def test_what_travels_is_the_same_afterwards(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    walker = dwell.Walker(cell_m=0.2, doors="priced")
    followed = apartment.navigation(walker)
    for joint in world.joints():
        if joint["object"].startswith("door"):
            world.set_joints({joint["id"]: (joint["limits"][1], 0.0)})
    followed.update(world)
    for navigation in (apartment.navigation(), world.navigation(walker), followed):
        again = pickle.loads(pickle.dumps(navigation))
        assert np.array_equal(again.points(), navigation.points())
        assert again.doors() == navigation.doors()
        assert again.update(world) == copy.copy(navigation).update(world)
    with pytest.raises(dwell.SceneError):
        Navigation._rebuild(apartment, "{}", b"dwst")
