"""Environments that step together play what single ones play, in a house drawn for each episode."""

from __future__ import annotations

import copy
import threading
from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

NAMES = ["seed:0?home=studio", "seed:1?home=studio", "builtin:studio"]
SMALL = {"rgb": {"width": 16, "height": 16}, "instruction": {}}
#: Steps of an episode at most.
LIMIT = 3
MODES = ["NextStep", "SameStep", "Disabled"]


@pytest.fixture(scope="module")
def houses() -> list[dwell.House]:
    return [dwell.House.open(name) for name in NAMES]


def bits(observation: dict[str, Any], env: int | None = None) -> tuple[bytes, str]:
    rgb, text = observation["rgb"], observation["instruction"]
    return (rgb if env is None else rgb[env]).tobytes(), text if env is None else text[env]


def single(seed: int, actions: list[int], houses: Any) -> Iterator[list[Any]]:  # noqa: ANN401
    """Each step of episodes of one environment: what begins one has no reward."""
    env = DwellEnv(sensors=SMALL, houses=houses, max_episode_steps=LIMIT)
    observation, info = env.reset(seed=seed)
    yield [bits(observation), env.state_hash(), info["episode_id"], 0.0, False, False]
    for action in actions:
        observation, reward, terminated, truncated, info = env.step(action)
        ends = [info["episode_id"], reward, terminated, truncated]
        yield [bits(observation), env.state_hash(), *ends]
        if terminated or truncated:
            observation, info = env.reset()
            yield [bits(observation), env.state_hash(), info["episode_id"], 0.0, False, False]


@pytest.mark.long
@pytest.mark.parametrize(("mode", "load_ahead"), [*((mode, 16) for mode in MODES), (MODES[0], 0)])
def test_environment_k_plays_the_episodes_of_a_single_one(
    mode: str, load_ahead: int, houses: list[dwell.House]
) -> None:
    seed, count, moves = 3, 2, [1, 3, 2, 1, 0, 1, 2, 3, 1, 1]
    many = DwellVectorEnv(
        count,
        sensors=SMALL,
        houses=houses,
        max_episode_steps=LIMIT,
        autoreset_mode=mode,
        load_ahead=load_ahead,
    )
    observation, infos = many.reset(seed=seed)
    played: list[list[Any]] = [[] for _ in range(count)]

    def note(k: int, reward: float, *ends: bool) -> None:
        seen = bits(observation, k), many.state_hashes()[k]
        played[k].append([*seen, infos["episode_id"][k], reward, *ends])

    for k in range(count):
        note(k, 0.0, False, False)
    own: list[list[int]] = [[] for _ in range(count)]
    done = np.zeros(count, np.bool_)
    for move in moves:
        begins = done & (mode == "NextStep")
        observation, rewards, terminated, truncated, infos = many.step(np.full(count, move))
        done = terminated | truncated
        for k in range(count):
            if not begins[k]:
                own[k].append(move)
            if mode == "SameStep" and done[k]:
                ends = infos["final_info"]["episode_id"][k]
                assert infos["final_info"]["audio_clipped"][k] == 0
                last = infos["final_obs"][k]
                played[k].append(
                    [bits(last), None, ends, rewards[k], bool(terminated[k]), bool(truncated[k])]
                )
                note(k, 0.0, False, False)
            else:
                note(k, float(rewards[k]), bool(terminated[k]), bool(truncated[k]))
        if mode == "Disabled" and done.any():
            observation, infos = many.reset(options={"reset_mask": done})
            for k in np.flatnonzero(done).tolist():
                note(k, 0.0, False, False)
    many.close()
    scenes = set()
    for k in range(count):
        expected = list(single(seed + k, own[k], houses))
        assert abs(len(played[k]) - len(expected)) <= 1
        for row, same in zip(played[k], expected, strict=False):
            # The last state before a restart in the same step is not there to be hashed.
            assert [row[0], *row[2:]] == [same[0], *same[2:]]
            assert row[1] in (same[1], None)
            scenes.add(row[2].rpartition("#")[0])
    assert len(scenes) == 3


def test_any_environment_plays_any_episode_and_any_snapshot_of_the_houses(
    houses: list[dwell.House],
) -> None:
    many = DwellVectorEnv(2, sensors=SMALL, houses=houses)
    ids = [f"{houses[1].name}#5", f"{houses[2].name}#7"]
    _, infos = many.reset(seed=1, options={"episode_id": ids})
    assert infos["episode_id"].tolist() == ids
    one = DwellEnv(sensors=SMALL, houses=houses)
    for k, episode_id in enumerate(ids):
        one.reset(options={"episode_id": episode_id})
        assert one.state_hash() == many.state_hashes()[k]
    many.step(np.array([1, 1]))
    saved, before = many.snapshot(), many.state_hashes()
    _, infos = many.reset(options={"episode_id": [ids[1], None], "reset_mask": [True, False]})
    assert infos["episode_id"][0] == ids[1]
    before_refusal = many.state_hashes()
    with pytest.raises(dwell.ConfigError, match=r"episode_id\[1\] is .* leaves environment 1 out"):
        many.reset(options={"episode_id": ids, "reset_mask": [True, False]})
    assert many.state_hashes() == before_refusal
    _, infos = many.restore(saved[::-1])
    assert infos["episode_id"].tolist() == ids[::-1]
    assert many.state_hashes() == before[::-1]
    many.close()


class Counting(dwell.Task):
    """Counts its steps, and knows its house."""

    sensors = ("gps",)

    def reset(self, world: dwell.World, rng: np.random.Generator) -> dwell.TaskGoal:
        del rng
        self.state["steps"] = 0
        return dwell.TaskGoal(
            f"Stay in {world.house.name.replace(':', ' ')}."[:40].replace("?", " ")
        )

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        del action, verdict
        self.state["steps"] += 1
        rooms = float(len(world.house.rooms()))
        return dwell.StepResult(reward=rooms, terminated=self.state["steps"] == 2)


@pytest.mark.long
def test_tasks_in_python_go_from_house_to_house(
    houses: list[dwell.House], apartment: dwell.House
) -> None:
    houses = [*houses, apartment]
    rooms = {house.name: float(len(house.rooms())) for house in houses}
    many = DwellVectorEnv(2, Counting, houses=houses, autoreset_mode="SameStep")
    _, infos = many.reset(seed=2)
    for _ in range(8):
        scenes = infos["scene_id"].tolist()
        _, rewards, _, _, infos = many.step(np.array([6, 6]))
        assert rewards.tolist() == [rooms[scene] for scene in scenes]
    many.close()


@pytest.mark.parametrize("load_ahead", [0, 16])
def test_a_house_that_cannot_be_opened_is_told_by_the_reset_that_needs_it(load_ahead: int) -> None:
    houses = ["builtin:studio", "nowhere.glb"]
    env = DwellVectorEnv(2, sensors=SMALL, houses=houses, load_ahead=load_ahead)
    good = ["builtin:studio#1", "builtin:studio#2"]
    for seed in range(20):
        # An episode in the good house, of which the next one is drawn from the stream.
        env.reset(seed=seed, options={"episode_id": good})
        env.step(np.array([0, 1]))
        rng = np.random.default_rng(seed)
        first, _, second = rng.integers(2), rng.integers(2**63), rng.integers(2)
        del first
        if second == 1:
            break
        env.step(np.array([1, 1]))
    with pytest.raises(dwell.HouseNotFoundError, match="nowhere"):
        env.step(np.array([1, 1]))
    with pytest.raises(dwell.UsageError, match=r"environments \[0\] has begun; reset them"):
        env.step(np.array([1, 1]))
    env.reset(options={"reset_mask": [True, False], "episode_id": [good[0], None]})
    env.step(np.array([1, 1]))
    env.close()
    assert not [one for one in threading.enumerate() if one.name == "dwell-ahead"]


def test_the_houses_that_wait_are_bounded(
    monkeypatch: pytest.MonkeyPatch, houses: list[dwell.House]
) -> None:
    env = DwellVectorEnv(6, "Free", sensors=["gps"], houses=houses, load_ahead=2)
    wanted: list[int] = []
    monkeypatch.setattr(env._places._ahead, "want", lambda keys: wanted.append(len([*keys])))
    env.reset(seed=0)
    assert wanted[-1] > 2
    assert env._places._ahead._most == 2
    env.close()
    one = DwellVectorEnv(2, "Free", sensors=["gps"], houses=houses[0], load_ahead=5)
    assert one._places._ahead._most == 0
    with pytest.raises(dwell.ConfigError, match="load_ahead is -1"):
        DwellVectorEnv(1, load_ahead=-1)


@pytest.mark.long
def test_sync_async_and_native_environments_give_what_the_single_one_gives() -> None:
    given = {"houses": "builtin:studio", "sensors": SMALL, "max_episode_steps": 3}
    env_id = "dwell/InstructionFollowing-v0"

    def played(mode: str | None, **vector: Any) -> list[Any]:  # noqa: ANN401 - of gymnasium
        envs = gymnasium.make_vec(env_id, 2, vectorization_mode=mode, vector_kwargs=vector, **given)
        observation, _ = envs.reset(seed=5)
        rows: list[Any] = [[bits(observation, k) for k in range(2)]]
        for action in (1, 3, 1, 2, 1):
            observation, rewards, terminated, truncated, _ = envs.step(np.full(2, action))
            seen = [bits(observation, k) for k in range(2)]
            rows.append([seen, rewards.tolist(), terminated.tolist(), truncated.tolist()])
        envs.close()
        return rows

    native = played(None)
    assert all(text.endswith(".") for _, text in native[0])
    assert played("sync") == native
    # What stood at a step stays in a copy.
    assert played("async", context="spawn") == native


def test_texts_in_shared_memory_are_live_and_copies_are_not() -> None:
    from gymnasium.vector.utils import (
        create_shared_memory,
        read_from_shared_memory,
        write_to_shared_memory,
    )

    from dwell.envs.spaces import shareable

    plain = gymnasium.spaces.Text(8, charset="abcü ")
    space = gymnasium.spaces.Dict({"said": shareable(plain)})
    assert space["said"] == plain
    assert shareable(space["said"]) is space["said"]
    memory = create_shared_memory(space, 2)
    seen = read_from_shared_memory(space, memory, 2)
    assert tuple(seen["said"]) == ("", "")
    write_to_shared_memory(space, 1, {"said": "ab ü"}, memory)
    assert seen["said"][1] == "ab ü"
    kept = copy.deepcopy(seen)
    write_to_shared_memory(space, 1, {"said": "c"}, memory)
    assert (kept["said"], tuple(seen["said"])) == (("", "ab ü"), ("", "c"))
