"""Episodes that state their start or goal: of files and options, in replays and results."""

from __future__ import annotations

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from habitat_files import HOUSE, converted, navigation

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder, VectorReplayRecorder
from dwell.evaluation import differences, evaluate

pytestmark = pytest.mark.usefixtures("open_once")


def test_a_stated_episode_is_the_drawn_one(tmp_path: Path) -> None:
    sensors = ["rgb", "gps", "pointgoal_with_gps_compass"]
    settings = {"open_doors": True}
    env, other = (
        DwellEnv("PointNav", houses=HOUSE, sensors=sensors, task_settings=settings)
        for _ in range(2)
    )
    observation, info = env.reset(seed=4)
    agent = env.agents()[0]
    distance_m, angle = (float(x) for x in observation["pointgoal_with_gps_compass"])
    yaw = agent["yaw_rad"] + angle
    x, y, z = agent["position"]
    near = [x - math.sin(yaw) * distance_m, y, z - math.cos(yaw) * distance_m]
    # The goal as it is seen is exact to some micrometres; its cell's middle is exact.
    points = navigation().points()
    goal = points[np.linalg.norm(points - np.array(near, np.float32), axis=1).argmin()]
    start = {"position": agent["position"], "yaw_rad": agent["yaw_rad"]}
    spec = {"start": start, "goal": {"position": goal}}
    asked = {"episode_id": info["episode_id"], "episode": spec}
    same, told = other.reset(options=asked)
    assert other.state_hash() == env.state_hash()
    for name, value in observation.items():
        assert np.array_equal(value, same[name])
    assert told["start_distance_to_goal"] == info["start_distance_to_goal"]
    # Its id says all of it.
    third = DwellEnv("PointNav", houses=HOUSE, sensors=sensors, task_settings=settings)
    third.reset(seed=9, options={"episode_id": told["episode_id"]})
    assert third.state_hash() == env.state_hash()
    third.restore(other.snapshot())
    assert third.step(1)[4] == other.step(1)[4]
    assert third.state_hash() == other.state_hash()
    folder = tmp_path / "replays"
    recorder = ReplayRecorder(other, folder)
    recorder.reset(options=asked)
    recorder.step(1)
    recorder.close()
    replay = dwell.Replay.read(folder / "episode_0000.replay")
    assert replay.differences() == []
    assert replay.stated is not None
    assert replay.stated["goal"]["position"] == pytest.approx(goal)


def test_options_that_state_wrongly_are_refused(points: Path, tmp_path: Path) -> None:
    env = DwellEnv("PointNav", houses=HOUSE, sensors=["gps"])
    for episode, told in (
        ({"begin": {}}, "no field 'begin'"),
        ({"start": {"position": [1, 2]}}, "episode.start.position: expected three numbers"),
        ({"start": {}}, "missing field `position`"),
        ({"goal": {"position": [math.nan, 0, 0]}}, "episode.goal.position[0] is nan"),
        ({"goal": {"colour": 1}}, "no field 'colour'"),
        ({"goal": 3}, "episode.goal is 3"),
        ({"goal": {"position": [500, 0, 0]}}, "episode.goal.position is [500.0, 0.0, 0.0]"),
        ([], "episode is []"),
    ):
        with pytest.raises(dwell.ConfigError) as refused:
            env.reset(seed=1, options={"episode": episode})
        assert told in str(refused.value), refused.value
    with pytest.raises(dwell.ConfigError, match="one that is drawn from its seed"):
        DwellEnv("Free", houses=HOUSE, sensors=["gps"]).reset(
            options={"episode": {"start": {"position": [0, 0, 0]}}}
        )
    out = tmp_path / "val.jsonl"
    converted(points, out)
    of_file = DwellEnv("PointNav", episodes=out, sensors=["gps"])
    with pytest.raises(dwell.ConfigError, match="state their own start and goal"):
        of_file.reset(options={"episode": {}})


def test_a_file_that_states_wrongly_is_refused(points: Path, tmp_path: Path) -> None:
    out = tmp_path / "val.jsonl"
    converted(points, out)
    lines = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
    for name, value, told in (
        ("start", 3, "line 3: start is 3"),
        ("start", {"position": [1, 2]}, "line 3: start.position: expected three numbers"),
        ("goal", {"place": 1}, "line 3: goal: no field 'place'"),
        ("source_distance_to_goal", -1, "line 3: source_distance_to_goal is -1"),
    ):
        changed = [lines[0], lines[1], {**lines[2], name: value}, *lines[3:]]
        out.write_text("".join(json.dumps(line) + "\n" for line in changed), "utf-8")
        with pytest.raises(dwell.MeasuredDataError) as refused:
            DwellEnv("PointNav", episodes=out, sensors=["gps"])
        assert told in str(refused.value), refused.value
    # What it states decides, not where it is said to lead.
    changed = [*lines[:2], {**lines[2], "goal": lines[1]["goal"]}, *lines[3:]]
    out.write_text("".join(json.dumps(line) + "\n" for line in changed), "utf-8")
    env = DwellEnv("PointNav", episodes=out, sensors=["gps"])
    with pytest.raises(dwell.MeasuredDataError, match="start_distance_to_goal: the file states"):
        env.reset(options={"episode_id": lines[2]["episode_id"]})
    # A file that changes while its episodes are played.
    env.reset(options={"episode_id": lines[1]["episode_id"]})
    out.write_text("".join(json.dumps(line) + "\n" for line in lines[::-1]), "utf-8")
    with pytest.raises(dwell.MeasuredDataError):
        env.reset(options={"episode_id": lines[3]["episode_id"]})


def test_what_the_engine_refuses_is_told_by_file_and_line(points: Path, tmp_path: Path) -> None:
    out = tmp_path / "val.jsonl"
    converted(points, out)
    lines = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
    one, other = lines[1]["episode_id"], lines[2]["episode_id"]
    for name, value, told in (
        ("start", {"position": [1e9, 0, 0]}, "allowed is three numbers up to 1,000,000 m"),
        ("goal", {"position": [1e3, 0, 0]}, "allowed is a point where the agent can stand"),
    ):
        changed = [*lines[:2], {**lines[2], name: value}, *lines[3:]]
        out.write_text("".join(json.dumps(line) + "\n" for line in changed), "utf-8")
        expected = rf"val\.jsonl line 3: episode\.{name}\.position is .*; {told}"
        env = DwellEnv("PointNav", episodes=out, sensors=["gps"])
        with pytest.raises(dwell.MeasuredDataError, match=expected):
            env.reset(options={"episode_id": other})
        many = DwellVectorEnv(2, "PointNav", episodes=out, sensors=["gps"])
        with pytest.raises(dwell.MeasuredDataError, match=expected):
            many.reset(seed=1, options={"episode_id": [one, other]})
        # It is the file's fault, not the environment's.
        assert env.reset(options={"episode_id": one})[1]["episode_id"] == one
        many.reset(seed=1, options={"episode_id": [one, lines[3]["episode_id"]]})
    for settings, told in (
        ({"min_distance_m": -1}, "min_distance_m is -1; allowed is 0 or more"),
        ({"min_distance": 1}, "task_settings: no argument 'min_distance'; did you mean min_dist"),
        ({"reward": {"step": "x"}}, "task_settings: reward is .*, expected a number"),
    ):
        own = {**lines[0], "task_settings": {**lines[0]["task_settings"], **settings}}
        out.write_text("".join(json.dumps(line) + "\n" for line in [own, *lines[1:]]), "utf-8")
        for make in (
            lambda: DwellEnv("PointNav", episodes=out, sensors=["gps"]),
            lambda: evaluate("stop", episodes=out),
        ):
            with pytest.raises(dwell.MeasuredDataError, match=rf"val\.jsonl line 1: {told}"):
                make()


def test_stated_episodes_are_played_side_by_side(points: Path, tmp_path: Path) -> None:
    out = tmp_path / "val.jsonl"
    converted(points, out)
    many = DwellVectorEnv(2, "PointNav", episodes=out, sensors=["gps"], autoreset_mode="SameStep")
    folder = tmp_path / "replays"
    recorder = VectorReplayRecorder(many, folder)
    _, infos = recorder.reset(seed=4)
    alone = [DwellEnv("PointNav", episodes=out, sensors=["gps"]) for _ in range(2)]
    singles = [env.reset(seed=4 + k)[1] for k, env in enumerate(alone)]
    for _ in range(3):
        assert [*infos["episode_id"]] == [info["episode_id"] for info in singles]
        assert many.state_hashes() == [env.state_hash() for env in alone]
        assert [many.stated_episode(k) for k in range(2)] == [env.stated_episode() for env in alone]
        saved = many.snapshot()
        _, _, _, _, infos = recorder.step(np.zeros(2, np.int64))
        singles = [env.reset()[1] for env in alone]
    many.restore(saved)
    recorder.close()
    for file in folder.iterdir():
        assert dwell.Replay.read(file).differences() == []
    again = pickle.loads(pickle.dumps(alone[0]))
    again.reset(seed=4)


@pytest.mark.long
def test_results_of_stated_episodes_hold(points: Path, tmp_path: Path) -> None:
    out = tmp_path / "val.jsonl"
    converted(points, out)
    result = evaluate("expert", episodes=out)
    assert result["metrics"]["success"]["mean"] == 1.0
    assert [row["stated"]["goal"] for row in result["episodes"]] == [
        one.goal for one in dwell.episodes.read(out)
    ]
    assert differences(result) == []
    # An episode beside them that states nothing must come from the seed.
    drawn = [{k: v for k, v in row.items() if k != "stated"} for row in result["episodes"][:1]]
    mixed = {**result, "episodes": [*drawn, *result["episodes"][1:]]}
    assert any(line.startswith("seed: ") for line in differences(mixed))
    result["episodes"][0]["stated"]["goal"] = result["episodes"][1]["stated"]["goal"]
    assert differences(result) != []
