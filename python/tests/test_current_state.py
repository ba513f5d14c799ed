"""What environments tell of the state as it is now, and their forks."""

from __future__ import annotations

from typing import Any

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


@pytest.mark.long
@pytest.mark.parametrize("many", [False, True])
def test_episodes_after_a_restore_are_those_that_followed_the_snapshot(many: bool) -> None:
    houses = ["builtin:studio", "builtin:apartment"]

    def made() -> Any:  # noqa: ANN401 - of one kind or the other
        if many:
            return DwellVectorEnv(1, "Free", houses=houses, sensors=["gps"])
        return DwellEnv("Free", houses=houses, sensors=["gps"])

    def following(env: Any) -> list[str]:  # noqa: ANN401 - of one kind or the other
        found = [env.reset()[1]["episode_id"] for _ in range(4)]
        return [one[0] for one in found] if many else found

    env, other = made(), made()
    env.reset(seed=6)
    saved = env.snapshot()
    expected = following(env)
    assert len(set(expected)) == 4
    other.reset(seed=77)
    for again in (env, other, made()):
        again.restore(saved)
        assert following(again) == expected
    # A seed goes before it.
    other.restore(saved)
    fresh = made()
    assert other.reset(seed=5)[1]["episode_id"] == fresh.reset(seed=5)[1]["episode_id"]
    assert following(other) == following(fresh)


def test_the_world_of_one_of_several_has_the_house_in_which_it_is() -> None:
    houses = ["builtin:studio", "builtin:apartment"]
    many = DwellVectorEnv(2, "Free", houses=houses, sensors=["gps"])
    many.reset(seed=1)
    worlds, seen = [many.world(k) for k in range(2)], set()
    for _ in range(8):
        _, infos = many.reset()
        for k, world in enumerate(worlds):
            seen.add((k, world.house.name))
            assert infos["scene_id"][k] == f"builtin:{world.house.name}"
            assert world.house is many.world(k).house
            # What the house and the world say of things is of the same one.
            assert world.house.info()["objects"] == len(world.objects())
    assert len(seen) == 4


def test_an_option_of_texts_that_there_is_not_is_refused_by_its_name() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="no argument 'foo'; allowed are length, style"):
        env.describe("room", foo=1)
    with pytest.raises(dwell.ConfigError, match="did you mean length"):
        env.describe("room", lenght="short")
    assert env.describe("room", length="short") == env.world.describe("room", length="short")
