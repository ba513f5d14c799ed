"""Environments refuse calls that make no sense, and say why."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.envs.config import HouseCache

pytestmark = pytest.mark.usefixtures("open_once")

SMALL = {"rgb": {"width": 16, "height": 16}, "instruction": {}}


@pytest.mark.parametrize("action", [-1, 12, 1.7, "1", True, None])
def test_a_step_takes_the_number_of_an_action(action: object) -> None:
    env = DwellEnv(sensors=SMALL)
    env.reset(seed=1)
    before = env.state_hash()
    with pytest.raises(dwell.ConfigError, match=r"action is .*0 to 11"):
        env.step(action)  # type: ignore[arg-type]
    assert env.state_hash() == before
    env.step(np.int64(1))


@pytest.mark.parametrize("actions", [[1, -1], [12, 1], [1.5, 1.0], [1], [[1], [1]]])
def test_a_vector_step_takes_numbers_of_actions(actions: object) -> None:
    env = DwellVectorEnv(2, sensors=SMALL)
    env.reset(seed=1)
    before = env.state_hashes()
    with pytest.raises(dwell.ConfigError, match="actions"):
        env.step(np.array(actions))
    assert env.state_hashes() == before


def test_a_step_before_reset_or_after_close_is_refused() -> None:
    vector = DwellVectorEnv(2, sensors=SMALL)
    with pytest.raises(dwell.UsageError, match="call reset first"):
        vector.step(np.array([1, 1]))
    vector.reset(seed=0)
    vector.close()
    with pytest.raises(dwell.UsageError, match="closed"):
        vector.step(np.array([1, 1]))
    with pytest.raises(dwell.UsageError, match="closed"):
        vector.reset(seed=0)
    env = DwellEnv(sensors=SMALL)
    with pytest.raises(dwell.UsageError, match="call reset first"):
        env.step(1)
    env.reset(seed=0)
    env.close()
    env.close()
    with pytest.raises(dwell.UsageError, match="closed"):
        env.step(1)
    with pytest.raises(dwell.UsageError, match="closed"):
        env.reset(seed=0)


def test_an_episode_id_plays_the_same_episode_again(apartment: dwell.House) -> None:
    houses = ["builtin:apartment", apartment]
    env = DwellEnv(sensors=SMALL, houses=houses)
    for seed in range(4):
        observation, info = env.reset(seed=seed)
        once = (env.state_hash(), observation["instruction"], info["scene_id"])
        env.step(1)
        other = DwellEnv(sensors=SMALL, houses=houses)
        observation, again = other.reset(options={"episode_id": info["episode_id"]})
        assert (other.state_hash(), observation["instruction"], again["scene_id"]) == once
        assert again == info
    for wrong in ("castle#1", "builtin:apartment", "builtin:apartment#-1", 7):
        with pytest.raises(dwell.ConfigError, match="HOUSE#NUMBER"):
            env.reset(options={"episode_id": wrong})
    with pytest.raises(dwell.ConfigError, match="hose"):
        env.reset(options={"hose": 1})


def test_arguments_that_there_are_not_are_answered_with_the_nearest_names() -> None:
    with pytest.raises(dwell.ConfigError, match="no argument 'house'; did you mean houses"):
        gymnasium.make("dwell/Free-v0", house="builtin:studio")
    with pytest.raises(dwell.ConfigError, match="no argument 'house'; did you mean houses"):
        gymnasium.make_vec("dwell/Free-v0", num_envs=2, house="builtin:studio")
    with pytest.raises(dwell.ConfigError, match="did you mean forward_m"):
        DwellEnv("Free", stride={"forward": 0.3})


@pytest.mark.fresh
def test_houses_may_be_given_open(apartment: dwell.House) -> None:
    env = DwellEnv(sensors=SMALL, houses=apartment)
    _, info = env.reset(seed=3)
    named = DwellEnv(sensors=SMALL)
    named.reset(seed=3)
    assert info["scene_id"] == "apartment"
    assert env.state_hash() == named.state_hash()


def test_a_batch_tells_its_houses_and_episodes_which_play_again_alone() -> None:
    houses = ["builtin:apartment", "builtin:studio"]
    many = DwellVectorEnv(3, sensors=SMALL, houses=houses, autoreset_mode="SameStep")
    _, infos = many.reset(seed=5)
    assert set(infos["scene_id"]) <= set(houses)
    assert infos["_scene_id"].all()
    assert infos["_episode_id"].all()
    one, first = DwellEnv(sensors=SMALL, houses=houses), infos["episode_id"].tolist()
    for k, episode_id in enumerate(first):
        _, info = one.reset(options={"episode_id": episode_id})
        assert one.state_hash() == many.state_hashes()[k]
        assert info["episode_id"] == episode_id
        told = {
            key: infos[key][k] for key in infos if not key.startswith("_") and infos[f"_{key}"][k]
        }
        assert info == told
        assert info["goal_kind"] in ("go_to_room", "find_object")
        assert info["start_distance_to_goal"] >= 1.0
        assert bool(info["goal_rooms"]) != bool(info["goal_objects"])
    *_, infos = many.step(np.array([0, 1, 1]))
    assert infos["episode_id"][1:].tolist() == first[1:]
    assert infos["final_info"]["episode_id"][0] == first[0] != infos["episode_id"][0]
    one.reset(options={"episode_id": infos["episode_id"][0]})
    assert one.state_hash() == many.state_hashes()[0]
    # And the other way: a batch plays episodes by their ids, too.
    batch = DwellVectorEnv(3, sensors=SMALL, houses=houses)
    _, again = batch.reset(seed=1, options={"episode_id": [first[0], None, first[2]]})
    assert again["episode_id"][[0, 2]].tolist() == [first[0], first[2]]
    for wrong, why in (
        ([first[0]], "found 1"),
        (first[0], "one for each"),
        ([None, "castle#1", None], "HOUSE#NUMBER"),
    ):
        with pytest.raises(dwell.ConfigError, match=why):
            batch.reset(options={"episode_id": wrong})
    with pytest.raises(dwell.ConfigError, match="no 'episode'"):
        batch.reset(options={"episode": first})


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_restored_batch_goes_on_as_before(mode: str) -> None:
    def made() -> DwellVectorEnv:
        return DwellVectorEnv(2, sensors=SMALL, max_episode_steps=5, autoreset_mode=mode, copy=True)

    def go_on(env: DwellVectorEnv) -> list[object]:
        seen: list[object] = []
        # The first ends by its own step, the second at the limit; both begin anew.
        for actions in ([1, 1], [0, 2], [3, 1], [1, 1], [1, 6]):
            observation, rewards, terminated, truncated, infos = env.step(np.array(actions))
            seen += [env.state_hashes(), rewards.tolist(), terminated.tolist()]
            seen += [truncated.tolist(), infos["episode_id"].tolist(), observation["instruction"]]
            seen.append(observation["rgb"].tobytes())
        return seen

    env = made()
    with pytest.raises(dwell.UsageError, match="environment 0 has begun"):
        env.snapshot()
    env.reset(seed=6)
    for actions in ([1, 3], [0, 1]):
        looks, *_, infos = env.step(np.array(actions))
    saved = env.snapshot()
    first = go_on(env)
    assert any(True in row for row in first[3::7])  # type: ignore[operator] # rows of flags
    for again in (env, made()):
        observation, told = again.restore(saved)
        assert np.array_equal(observation["rgb"], looks["rgb"])
        assert told["episode_id"].tolist() == infos["episode_id"].tolist()
        assert go_on(again) == first


def test_snapshots_of_something_else_are_refused_by_a_batch() -> None:
    houses = ["builtin:apartment", "builtin:studio"]
    env = DwellVectorEnv(2, sensors=SMALL, houses=houses)
    env.reset(seed=2)
    saved, before = env.snapshot(), env.state_hashes()
    env.step(np.array([1, 1]))
    after = env.state_hashes()
    single = DwellEnv(sensors=SMALL)
    single.reset(seed=2)
    cut = saved[0].replace(b'"done"', b'"gone"')
    for wrong, why in (
        (saved[0], "expected a list of 2"),
        (saved[:1], "expected a list of 2"),
        ([b"junk", None], r"snapshots\[0\]: snapshot refused"),
        ([None, single.snapshot()], r"snapshots\[1\]: snapshot refused"),
        ([cut, None], "check sum"),
        ([7, None], r"snapshots\[0\] is 7"),
    ):
        with pytest.raises(dwell.ConfigError, match=why):
            env.restore(wrong)  # type: ignore[arg-type]
        assert env.state_hashes() == after
    env.restore([saved[0], None])
    assert env.state_hashes() == [before[0], after[1]]
    with pytest.raises(dwell.ConfigError, match="snapshot refused: its check sum"):
        env.restore([None, saved[1][:-5]])
    assert env.state_hashes() == [before[0], after[1]]


def test_a_refused_snapshot_changes_nothing() -> None:
    """Of another task, and of a world with other steps, which the engine refuses late."""
    room = DwellEnv("RoomNav", houses="builtin:studio", sensors=SMALL)
    room.reset(seed=1)
    other = DwellEnv("PointNav", houses="builtin:apartment", sensors=SMALL)
    other.reset(seed=1)
    slow = DwellEnv(
        "RoomNav", houses="builtin:studio", sensors=SMALL, world={"control_rate_hz": 5.0}
    )
    slow.reset(seed=1)
    twin = DwellEnv("RoomNav", houses="builtin:studio", sensors=SMALL)
    twin.reset(seed=1)
    for saved in (other.snapshot(), slow.snapshot()):
        with pytest.raises(dwell.ConfigError, match="refused"):
            room.restore(saved)
        for env in (room, twin):
            env.step(1)
        assert room.state_hash() == twin.state_hash()
    many = DwellVectorEnv(2, "RoomNav", houses="builtin:studio", sensors=SMALL)
    many.reset(seed=1)
    own = many.snapshot()
    many.step(np.array([1, 2]))
    before = many.state_hashes()
    strange = DwellVectorEnv(
        2, "RoomNav", houses="builtin:studio", sensors=SMALL, world={"control_rate_hz": 5.0}
    )
    strange.reset(seed=1)
    # The first one fits; it is not restored alone.
    with pytest.raises(dwell.ConfigError, match="refused"):
        many.restore([own[0], strange.snapshot()[1]])
    assert many.state_hashes() == before
    many.step(np.array([1, 1]))


def test_what_an_episode_ended_with_stands_in_final_info() -> None:
    env = DwellVectorEnv(2, sensors=SMALL, autoreset_mode="SameStep")
    env.reset(seed=0)
    *_, infos = env.step(np.array([0, 1]))
    final = infos["final_info"]
    assert final["_spl"].tolist() == infos["_final_info"].tolist() == [True, False]
    assert final["distance_to_goal"][0] > 0.0
    assert final["path_length"][0] < 0.01
    # The episode that begins has made no step: what it is called stands beside no end of another.
    assert infos["_distance_to_goal"].tolist() == infos["_success"].tolist() == [False, True]
    assert np.isnan(infos["distance_to_goal"]).tolist() == [True, False]


def test_what_an_episode_that_begins_has_not_yet_is_no_number() -> None:
    env = DwellVectorEnv(2, sensors=SMALL)
    env.reset(seed=0)
    env.step(np.array([0, 1]))
    *_, infos = env.step(np.array([1, 1]))
    for key in ("distance_to_goal", "spl"):
        assert np.isnan(infos[key]).tolist() == [True, False]
        assert infos[f"_{key}"].tolist() == [False, True]


def test_errors_of_hundreds_of_environments_name_the_first_of_them() -> None:
    env = DwellVectorEnv(
        20,
        "Free",
        sensors=["gps"],
        houses="builtin:studio",
        max_episode_steps=1,
        autoreset_mode="Disabled",
    )
    env.reset(seed=1)
    with pytest.raises(dwell.ConfigError) as refused:
        env.step(np.full(20, 99))
    first, many = "[0, 1, 2, 3, 4, 5, 6, 7, …] (20 in all)", "[99, 99, 99, 99, 99, 99, 99, 99, …]"
    told = f"actions of environments {first} are {many} (20 in all); allowed are 0 to 11"
    assert str(refused.value) == told
    env.step(np.zeros(20, np.int64))
    with pytest.raises(dwell.UsageError) as refused_ended:
        env.step(np.zeros(20, np.int64))
    assert str(refused_ended.value).startswith(f"environments {first} have ended; ")
    env.close()


@pytest.mark.parametrize("many", [False, True])
def test_an_environment_that_nobody_holds_goes_at_once(many: bool) -> None:
    houses = ["builtin:studio", "seed:1?home=studio"]
    settings: dict[str, Any] = {"sensors": ["gps"], "houses": houses}
    env = DwellVectorEnv(2, "Free", **settings) if many else DwellEnv("Free", **settings)
    env.reset(seed=1)
    env.step([1, 1] if many else 1)  # type: ignore[arg-type] # of either
    if many:
        # Whoever makes houses ahead holds them, not the environments.
        env._places.close()  # type: ignore[union-attr] # of many
    held = weakref.ref(env)
    runner = weakref.ref(env._runner)
    gc.disable()
    try:
        del env
        assert held() is None
        assert runner() is None
    finally:
        gc.enable()


def test_cut_and_empty_snapshots_are_called_so() -> None:
    env = DwellEnv("Free", sensors=["gps"], houses="builtin:studio")
    env.reset(seed=1)
    saved = env.snapshot()
    with pytest.raises(dwell.ConfigError, match="snapshot refused: it is empty"):
        env.restore(b"")
    told = rf"does not fit its {len(saved) - 1} bytes: it was cut short or damaged"
    with pytest.raises(dwell.ConfigError, match=told):
        env.restore(saved[:-1])
    many = DwellVectorEnv(1, "Free", sensors=["gps"], houses="builtin:studio")
    many.reset(seed=1)
    (row,) = many.snapshot()
    with pytest.raises(dwell.ConfigError, match=r"snapshots\[0\]: snapshot refused: it is empty"):
        many.restore([b""])
    with pytest.raises(dwell.ConfigError, match=r"snapshots\[0\]: .*cut short or damaged"):
        many.restore([row[:-1]])


@pytest.mark.long
def test_a_restored_environment_goes_on_as_before() -> None:
    env = DwellEnv(houses=["builtin:apartment"])
    env.reset(seed=6)
    for action in (1, 2, 1):
        env.step(action)
    saved, looks = env.snapshot(), env.step(6)[0]

    def go_on(env: DwellEnv) -> list[object]:
        seen: list[object] = []
        for action in (1, 3, 1, 0):
            observation, reward, terminated, _, info = env.step(action)
            assert info["audio_clipped"] == 0
            seen += [env.state_hash(), reward, terminated, info["spl"], info["episode_id"]]
            seen += [observation["rgb"].tobytes(), observation["audio"].tobytes()]
        return seen

    first = go_on(env)
    other = DwellEnv()
    other.reset(seed=1)
    for again in (env, other):
        observation, info = again.restore(saved)
        assert info["episode_id"] == first[4]
        assert observation["instruction"] == looks["instruction"]
        again.step(6)
        assert go_on(again) == first
    with pytest.raises(dwell.ConfigError):
        other.restore(saved[:-9])
    with pytest.raises(dwell.ConfigError, match="check sum"):
        other.restore(b"junk")
    flipped = bytearray(saved)
    flipped[63] ^= 0x40
    with pytest.raises(dwell.ConfigError, match="check sum"):
        other.restore(bytes(flipped))


def test_buffers_in_use_say_so() -> None:
    camera = {"width": 16, "height": 16}
    env = DwellEnv(sensors={"instance": camera, "semantic": camera})
    env.reset(seed=1)
    buffer = env._runner.buffers[0]
    with pytest.raises(dwell.UsageError, match="in use by another call"):
        env._runner.batch.observe(np.ones(1, np.bool_), [buffer, buffer])


def test_a_range_of_seeds_of_any_length_is_a_set_of_houses() -> None:
    shelf = HouseCache(["builtin:studio", "seed:0..1000000000000?home=studio"])
    assert len(shelf.names) == 10**12 + 1
    assert shelf.episode("seed:999999999999?home=studio#5") == (10**12, 5)
    assert shelf.episode_id(8, 5) == "seed:7?home=studio#5"
    with pytest.raises(dwell.ConfigError, match=r"of a house of this environment"):
        shelf.episode("seed:1000000000000?home=studio#5")


def test_a_house_that_is_handed_over_twice_has_two_names() -> None:
    house = dwell.House.open("builtin:studio")
    shelf = HouseCache(["seed:3..5", house, house])
    assert [*shelf.names] == ["seed:3", "seed:4", "studio", "studio~3"]
    assert shelf[3] is house


def test_a_house_and_an_episode_of_another_contradict_each_other() -> None:
    env = DwellEnv("Free", houses=["builtin:studio", "seed:1?home=studio"], sensors=["gps"])
    _, info = env.reset(seed=1, options={"house": 0})
    with pytest.raises(dwell.ConfigError, match="house and episode_id"):
        env.reset(options={"episode_id": info["episode_id"], "house": 1})


def test_so_many_laws_are_refused_and_bytes_are_no_numbers() -> None:
    with pytest.raises(dwell.ConfigError, match="found 100000 laws; allowed are at most 1000"):
        dwell.World("builtin:studio", laws=["drag"] * 100_000)
    world = dwell.World("builtin:studio")
    with pytest.raises(dwell.ConfigError, match="linear_m_s"):
        world.set_body(world.objects()[0]["name"], linear_m_s=b"abc")  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["../x:Y", ".:x", "..a:b"])
def test_relative_modules_are_refused_by_a_sentence(name: str) -> None:
    with pytest.raises(dwell.ConfigError, match="expected 'module:Name'"):
        DwellEnv(name, houses="builtin:studio")


def test_an_environment_describes_its_house() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=1)
    house = dwell.House.open("builtin:studio")
    for level in ("house", "room", "object"):
        assert env.describe(level) == house.describe(level)
