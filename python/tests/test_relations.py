"""Predicates, relations, attributes and scene graphs from Python."""

from __future__ import annotations

import importlib.util
import json
from typing import Any

import numpy as np
import pytest

import dwell
import dwell.relations


@pytest.fixture(scope="module")
def world() -> dwell.World:
    return dwell.World("builtin:apartment", agents=2)


def test_questions_have_three_answers(world: dwell.World) -> None:
    radio = world.object("radio_1")
    assert world.holds("in_room", "radio_1", f"room:{radio['room']}") is True
    assert world.holds("in_room", radio["id"], "room:kitchen") is False
    assert world.holds("open", "radio_1") is None
    assert world.why_undecided("open", "radio_1") == "It does not open."
    assert world.why_undecided("in_room", "radio_1", "room:kitchen") is None
    assert world.holds("switched_on", "radio_1") is False
    assert world.holds("on_storey", "radio_1", "storey:0") is True
    assert world.holds("holds", "agent:0", "radio_1") is False
    assert world.holds("reachable", "room:kitchen", "agent:0") in (True, False)
    with pytest.raises(dwell.ConfigError, match='no part "handle"'):
        world.holds("attached_to", "part:radio_1/handle", "radio_1")


def test_sides_are_meant_from_somebody(world: dwell.World) -> None:
    things = ["radio_1", "stand_1"]
    assert world.holds("left_of", *things) is None
    assert world.why_undecided("left_of", *things) == (
        "It depends on where somebody looks from, and no viewer is given."
    )
    center = np.array(world.object("radio_1")["center"])
    for yaw_deg, away in ((0.0, (0.0, 0.0, 2.0)), (90.0, (2.0, 0.0, 0.0))):
        viewer = {"position": tuple(center + away), "yaw_deg": yaw_deg}
        left = world.holds("left_of", *things, viewer=viewer)
        right = world.holds("right_of", *reversed(things), viewer=viewer)
        assert left == right
    assert world.holds("left_of", *things, viewer=1) in (True, False, None)
    refused: list[Any] = [{"yaw_deg": 3}, {"position": (0, 0, 0), "roll": 1}, "me"]
    for other in refused:
        with pytest.raises(dwell.ConfigError, match="viewer is "):
            world.holds("left_of", *things, viewer=other)
    with pytest.raises(dwell.ConfigError, match="no agent 7"):
        world.holds("left_of", *things, viewer=7)


def test_names_that_nothing_has_are_refused(world: dwell.World) -> None:
    with pytest.raises(dwell.ConfigError, match=r'no predicate "beside"; there are \["in_room"'):
        world.holds("beside", "radio_1")
    with pytest.raises(dwell.ConfigError, match="radio_1"):
        world.holds("open", "radio_11")
    with pytest.raises(dwell.ConfigError, match="no room"):
        world.holds("in_room", "radio_1", "room:dungeon")
    with pytest.raises(dwell.ConfigError, match="no storey"):
        world.holds("on_storey", "radio_1", "storey:9")
    with pytest.raises(
        dwell.ConfigError, match="said of one thing; relations are between two things"
    ):
        world.relations(["open"])
    with pytest.raises(dwell.ConfigError, match="needs a viewer"):
        world.relations(["left_of"])
    with pytest.raises(dwell.ConfigError, match="no selection"):
        world.select("middle", ["radio_1"])
    with pytest.raises(dwell.ConfigError, match="allowed are 12, 16, 139 and 949"):
        world.color_names("radio_1", 148)


def test_relations_are_those_that_hold_by_name_and_by_number(world: dwell.World) -> None:
    table = dwell.relations.predicates()
    rows, array = world.relations(), world.relation_array()
    assert array.dtype == np.int32
    assert array.shape == (len(rows), 3)
    assert {row[1] for row in rows} <= {row["name"] for row in table if row["listed"]}
    rooms = [row["name"] for row in world.house.rooms()]
    ids = {row["id"]: row["name"] for row in world.objects()}
    for (subject, name, target), (a, code, b) in zip(rows, array.tolist(), strict=True):
        assert table[code]["name"] == name
        assert ids.get(a, subject) == subject
        if name == "in_room":
            assert target == f"room:{rooms[-1 - b]}"
        if name == "on_storey":
            assert (target, b) == ("storey:0", -1001)
    for subject, name, target in rows[::23]:
        assert world.holds(name, subject, target) is True
    alike = world.relations(["same_kind"])
    assert {row[1] for row in alike} == {"same_kind"}
    seen = world.relations(["left_of", "right_of"], viewer=0)
    assert sum(row[1] == "left_of" for row in seen) > 0
    assert world.relation_array([]).shape == (0, 3)


def test_one_of_several_is_chosen_by_its_place(world: dwell.World) -> None:
    assert world.select("largest", ["radio_1", "refrigerator_1"]) == "refrigerator_1"
    assert world.select("smallest", ["radio_1", "refrigerator_1"]) == "radio_1"
    assert world.select("largest", ["radio_1"], 2) is None
    assert world.select("from_left", ["radio_1"]) is None
    assert world.select("closest_to", ["radio_1"], reference="stand_1") == "radio_1"


def test_what_things_are_like(world: dwell.World) -> None:
    row = world.attributes("refrigerator_1")
    assert row["category"] == "refrigerator"
    assert row["synset"] == "refrigerator.n.01"
    assert row["nyu40_id"] == 24
    assert row["storey"] == 0
    assert row["openness"] == 0.0
    assert row["size"] in ("tiny", "small", "normal", "large", "huge")
    for count in (12, 16, 139, 949):
        names = world.color_names("refrigerator_1", count)
        assert 0 < sum(share for _, share in names) <= 1.001
    assert world.color_names("refrigerator_1") == world.color_names("refrigerator_1", 16)


def test_the_graph_has_storeys_rooms_objects_and_agents(world: dwell.World) -> None:
    graph = world.scene_graph()
    assert len(graph["agents"]) == 2
    assert [row["storey"] for row in graph["storeys"]] == [0]
    assert len(graph["objects"]) == len(world.objects())
    assert json.loads(world.describe("graph")[0]) == graph
    assert len(graph["relations"]) == len(world.relations())
    arrays = dwell.relations.graph_arrays(graph, nodes=400, edges=8000)
    assert arrays["node_kind"].shape == (400,)
    assert arrays["edges"].shape == (8000, 3)
    count, edges = int(arrays["node_count"]), int(arrays["edge_count"])
    assert edges == len(graph["relations"])
    kinds = arrays["node_kind"][:count]
    assert [int((kinds == k).sum()) for k in (0, 1, 2, 3)] == [
        len(graph[name]) for name in ("storeys", "rooms", "objects", "agents")
    ]
    assert (arrays["edges"][:edges, ::2] < count).all()
    assert (arrays["edges"][edges:] == -1).all()
    codes = [row["name"] for row in dwell.relations.predicates()]
    rooms = arrays["edges"][:edges][arrays["edges"][:edges, 1] == codes.index("in_room")]
    assert (kinds[rooms[:, 2]] == 1).all()
    with pytest.raises(dwell.ConfigError, match="edges is 3; this graph has"):
        dwell.relations.graph_arrays(graph, edges=3)


def test_networkx_is_imported_only_when_it_is_asked_for(world: dwell.World) -> None:
    graph = world.scene_graph()
    if importlib.util.find_spec("networkx") is None:
        with pytest.raises(ImportError):
            dwell.relations.to_networkx(graph)
        return
    made = dwell.relations.to_networkx(graph)
    assert made.number_of_edges() == len(graph["relations"])
    assert made.nodes["radio_1"]["synset"] == "radio_receiver.n.01"
    assert made.has_edge("radio_1", f"room:{made.nodes['radio_1']['room']}", key="in_room")


def test_every_predicate_says_what_it_is() -> None:
    for row in dwell.relations.predicates():
        assert row["definition"].endswith(".")
        assert row["source"].endswith(".")
        assert 1 <= len(row["places"]) <= 3
    orders = dwell.relations.orders()
    assert {row["name"] for row in orders} >= {"from_left", "largest", "closest_to"}
    assert all(row["margin"] > 0 for row in orders)
