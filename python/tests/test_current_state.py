"""What environments tell of the state as it is now, and their forks."""

from __future__ import annotations

import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")


def test_what_is_told_is_the_state_as_it_is_now() -> None:
    env = DwellEnv("Free", houses="builtin:apartment", sensors=["gps"])
    env.reset(seed=3)
    before = env.world.snapshot()
    assert env.describe("changes", since=before) == [""]
    hinge = env.world.joints()[0]
    door = hinge["object"]
    assert env.holds("open", door) is False
    env.world.set_joints({hinge["id"]: (hinge["limits"][1], 0.0)})
    assert env.holds("open", door) is True
    told = " ".join(env.describe("changes", since=before))
    assert "is open now" in told
    rows = {row["name"]: row for row in env.scene_graph()["objects"]}
    assert rows[door]["id"] == env.world.object(door)["id"]


def test_questions_are_answered_to_the_agent_that_acts() -> None:
    env = DwellEnv("Free", houses="builtin:apartment", sensors=["gps"])
    env.reset(seed=3)
    rooms = env.scene_graph()["rooms"]
    assert len(rooms) > 2
    asked = env.ask("How many doors are there?")["answer"]["number"]
    # Leaves of doors between rooms, by the graph of the same moment.
    assert asked == sum(row["category"] == "door" for row in env.scene_graph()["objects"])
    with pytest.raises(dwell.ConfigError, match="unknown word"):
        env.ask("Find the sofaa.")
    thing = env.world.objects()[0]["name"]
    assert env.holds("visible", thing) in (True, False, None)


def test_a_fork_goes_on_alone_with_the_same_bits() -> None:
    env = DwellEnv("PointNav", houses="builtin:apartment", sensors=["gps"])
    env.reset(seed=5)
    for _ in range(4):
        env.step(env.expert_action())
    other = env.fork()
    assert other.state_hash() == env.state_hash()
    here = env.state_hash()
    for _ in range(3):
        other.step(1)
    assert env.state_hash() == here
    for _ in range(3):
        env.step(1)
    assert env.state_hash() == other.state_hash()
    # The episodes that follow are the same, too, in houses that are drawn.
    houses = ["builtin:studio", "builtin:apartment"]
    first = DwellEnv("Free", houses=houses, sensors=["gps"])
    first.reset(seed=6)
    second = first.fork()
    for _ in range(3):
        assert second.reset()[1] == first.reset()[1]
    many = DwellVectorEnv(2, "Free", houses="builtin:studio", sensors=["gps"])
    with pytest.raises(dwell.UsageError, match="no episode"):
        many.fork()
    many.reset(seed=5)
    copies = many.fork()
    assert copies.state_hashes() == many.state_hashes()
    copies.step([1, 2])
    assert copies.state_hashes() != many.state_hashes()
    assert many.world(1).state_hash() == many.state_hashes()[1]
    with pytest.raises(dwell.ConfigError, match="env is 2"):
        many.world(2)
