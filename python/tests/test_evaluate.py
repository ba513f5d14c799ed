"""Policies are evaluated, and results are checked by playing them again."""

from __future__ import annotations

import json
import math
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.cli.job_journal import Journal
from dwell.envs import DwellEnv
from dwell.episode_maker import EpisodeMaker
from dwell.evaluation import differences, evaluate, read_result, write_result
from dwell.evaluation_summary import summary
from dwell.played_actions import packed, unpacked

pytestmark = pytest.mark.usefixtures("open_once")

Command = Callable[..., subprocess.CompletedProcess[str]]
HOUSES = ["builtin:studio", "seed:0?home=studio"]
NEAR = {"max_distance_m": 4.0}


class Wanderer:
    """Walks ahead for a while and stops; remembers how often it was asked."""

    def reset(self, observation: dict[str, Any], info: dict[str, Any]) -> None:
        assert "gps" in observation
        assert "episode_id" in info
        self.left = 9

    def act(self, observation: dict[str, Any]) -> np.int64:
        self.left -= 1
        return np.int64(1 if self.left > 0 else 0)


def make_wanderer() -> Wanderer:
    return Wanderer()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("evaluate") / "val.jsonl"
    maker = EpisodeMaker("PointNav", HOUSES, count=4, seed=5, task_settings=NEAR, expert=True)
    dwell.episodes.write(path, maker.header, maker.episodes())
    return path


@pytest.fixture(scope="module")
def result(made: Path) -> dict[str, Any]:
    """Of a policy that fails now and then, and takes ways about."""

    class Half:
        """The expert, but for detours, and for a stop too early in every second episode."""

        def __init__(self) -> None:
            self.env = DwellEnv("PointNav", episodes=made, sensors=["gps"])
            self.count = 0

        def reset(self, observation: object, info: dict[str, Any]) -> None:
            self.env.reset(options={"episode_id": info["episode_id"]})
            self.count += 1
            self.plan = [3] * 7 + [1] * 9 + [2] * 3
            self.most = 25 if self.count % 2 else 1000

        def act(self, observation: object) -> int:
            self.most -= 1
            action = self.plan.pop() if self.plan else self.env.expert_action()
            action = action if self.most > 0 else 0
            self.env.step(action)
            return action

    return evaluate(Half(), episodes=made, sensors=["gps"])


@pytest.mark.long
def test_metrics_are_those_that_are_reckoned_by_hand(made: Path, result: dict[str, Any]) -> None:
    stated = {one.episode_id: one for one in dwell.episodes.read(made)}
    assert [row["episode_id"] for row in result["episodes"]] == [*stated]
    assert {row["success"] for row in result["episodes"]} == {True, False}
    env = DwellEnv("PointNav", houses=HOUSES, sensors=["gps"], task_settings=NEAR)
    for row in result["episodes"]:
        env.reset(seed=0, options={"episode_id": row["episode_id"]})
        places, paid, is_over = [env.agents()[0]["position"]], 0.0, False
        collisions, last = 0, {}
        for action in unpacked("actions", row["actions"]):
            assert not is_over
            _, reward, is_over, _, last = env.step(action)
            agent = env.agents()[0]
            places.append(agent["position"])
            collisions += agent["collided"]
            paid += reward
        assert is_over
        steps = np.diff(np.array(places, np.float64), axis=0)
        path_m = float(np.linalg.norm(steps, axis=1).sum())
        first_m, last_m = stated[row["episode_id"]].start_distance_to_goal, last["distance_to_goal"]
        assert first_m is not None
        is_done = last_m < 0.2
        spl = is_done * first_m / max(first_m, path_m)
        soft_spl = max(0.0, 1.0 - last_m / first_m) * first_m / max(first_m, path_m)
        count, best = len(steps), stated[row["episode_id"]].expert_actions
        assert best is not None
        assert row["success"] is is_done
        assert row["path_length"] == pytest.approx(path_m, rel=1e-5)
        assert row["spl"] == pytest.approx(spl, rel=1e-5)
        assert row["soft_spl"] == pytest.approx(soft_spl, rel=1e-5)
        assert row["sna"] == pytest.approx(is_done * best / max(best, count))
        assert row["normalized_distance_to_goal"] == pytest.approx(last_m / first_m)
        assert row["reward"] == pytest.approx(paid)
        assert (row["steps"], row["collisions"]) == (count, collisions)
        assert row["state_hash"] == f"{env.state_hash():016x}"
    for name, told in result["metrics"].items():
        values = [float(row[name]) for row in result["episodes"]]
        assert told["mean"] == pytest.approx(sum(values) / len(values))
        assert min(values) <= told["low"] <= told["mean"] <= told["high"] <= max(values)
    kinds = result["by_goal_kind"]
    assert kinds["point"]["episodes"] == 4
    assert kinds["point"]["success"] == result["metrics"]["success"]["mean"]


def test_a_result_says_how_it_was_played(result: dict[str, Any]) -> None:
    assert result["task"]["name"] == "PointNav"
    assert result["task"]["settings"]["success_distance_m"] == result["success_distance_m"] == 0.2
    assert result["made_by"] == dwell.__version__
    assert (result["count"], result["max_steps"], result["seed"]) == (4, 1000, 5)
    assert result["scene_ids"] == HOUSES
    assert result["splits"] == ["none", "train"]
    assert result["stride"] == pytest.approx({"forward_m": 0.1, "turn_deg": 9.0, "look_deg": 9.0})
    assert [row["name"] for row in result["sensors"]["observations"]] == ["gps"]
    assert result["world"]["control_rate_hz"] == 20.0


def test_what_holds_is_verified(result: dict[str, Any], tmp_path: Path, command: Command) -> None:
    path = tmp_path / "result.json"
    write_result(path, result)
    assert read_result(path) == result
    done = command("evaluate", "--verify", path, "--json")
    assert (done.returncode, json.loads(done.stdout)["differences"]) == (0, [])


def at(*place: str | int, to: object) -> Callable[[dict[str, Any]], None]:
    def edit(result: dict[str, Any]) -> None:
        row: Any = result
        for key in place[:-1]:
            row = row[key]
        row[place[-1]] = to

    return edit


@pytest.mark.long
@pytest.mark.parametrize(
    ("edit", "told"),
    [
        (at("episodes", 1, "spl", to=0.25), "episodes[1].spl: the file states 0.25, played it is"),
        (at("episodes", 0, "collisions", to=99), "episodes[0].collisions: the file states 99"),
        (at("episodes", 0, "success", to=True), "episodes[0].success: the file states True"),
        (at("episodes", 2, "state_hash", to="0" * 16), "episodes[2].state_hash: the file states"),
        (at("episodes", 2, "expert_actions", to=3), "episodes[2].expert_actions: the file states"),
        (at("episodes", 0, "actions", to="1*20 0"), "episodes[0].state_hash: the file states"),
        (at("episodes", 0, "actions", to="1*20"), "after all 20 the episode goes on"),
        (at("episodes", 0, "actions", to="0 1"), "the episode ends, and 1 actions are left"),
        (at("episodes", 0, "actions", to="99"), "no action has the number 99"),
        (at("episodes", 0, "actions", to="x"), "found 'x'; expected NUMBER or NUMBER*COUNT"),
        (at("episodes", 0, "seed", to=-1), "episodes[0].seed is -1"),
        (at("episodes", 0, "luck", to=1), "episodes[0].luck: no field of an episode"),
        (at("metrics", "spl", "mean", to=0.9), "metrics.spl.mean: the file states 0.9"),
        (at("metrics", "sna", "high", to=0.9), "metrics.sna.high: the file states 0.9"),
        (at("by_goal_kind", "point", "success", to=1), "by_goal_kind.point.success: the file"),
        (at("count", to=5), "count: the file states 5, played it is 4"),
        (at("success_distance_m", to=9.0), "success_distance_m: the file states 9.0"),
        (at("stride", "forward_m", to=0.2), "episodes[0].state_hash: the file states"),
        (at("scene_ids", to=[]), "scene_ids: the file states []"),
        (at("task", "version", to=7), "task: the result is of version 7 of PointNav"),
        (at("world", "control_rate_hz", to=10.0), "world.control_rate_hz: the file states 10.0"),
        (lambda row: row.pop("max_steps"), "max_steps: missing"),
        (at("prize", to=1), "prize: no field of a result"),
        (at("policy", to="expert"), "the policy does"),
        (at("policy", to="mine"), "policy: the file states 'mine'; allowed are random, expert"),
        (at("policy_source", to="1234"), "policy_source is '1234'; expected 64 hexadecimal digits"),
        (at("made_by", to="somebody"), "made_by is 'somebody'; expected a version of dwell"),
        (at("houses", to=HOUSES[:1]), "no 'seed:0?home=studio' of scene_ids"),
        (at("houses", to=["split:none"]), "houses: split:none: no such split"),
        (at("seed", to=6), "seed: the file states 6, from which `dwell episodes` draws other"),
        (at("seed", to=None), "seed: the file states None"),
        (at("sensors", "settings", to={"gps": {"far": 1}}), "unknown field `far`"),
        (at("sensors", "settings", to={"rgb": {}}), "sensors.observations: rgb: the file states"),
        (at("sensors", "observations", to=[]), "sensors.observations: gps: the file states None"),
        (at("episode_files", 0, "sha256", to="0"), "episode_files[0].sha256 is '0'; expected 64"),
        (at("action_mode", to="velocity"), "episodes[0].actions: action 0 of"),
        (at("metrics", "spl", "mean", to=9 * 10**308), "metrics.spl.mean: the file states 9000"),
    ],
)
def test_what_was_edited_is_found(
    edit: Callable[[dict[str, Any]], None], told: str, result: dict[str, Any]
) -> None:
    other = json.loads(json.dumps(result))
    edit(other)
    assert any(told in sentence for sentence in differences(other)), differences(other)


def test_means_are_compared_with_those_of_what_was_played(result: dict[str, Any]) -> None:
    """Means by the file's own rows, with the edited one in them, were told as played."""
    other = json.loads(json.dumps(result))
    at("episodes", 1, "spl", to=0.25)(other)
    (told,) = differences(other)
    assert told.startswith("episodes[1].spl: the file states 0.25, played it is ")
    # Nobody knows the means where an episode cannot be played.
    at("episodes", 0, "actions", to="1*20")(other)
    mean = result["metrics"]["spl"]["mean"]
    others = [row["spl"] for k, row in enumerate(result["episodes"]) if k != 1]
    found = (sum(others) + 0.25) / len(result["episodes"])
    told = next(one for one in differences(other) if one.startswith("metrics.spl.mean: "))
    states, reckoned = told.split("the file states ")[1].split(
        ", by the episodes that it states it is "
    )
    assert (float(states), float(reckoned)) == (mean, pytest.approx(found))


@pytest.mark.parametrize("wrong", [10**400, math.nan, [[]], object(), "\ud800", {"a": {}}])
def test_what_is_no_result_is_told_by_its_place(wrong: object, result: dict[str, Any]) -> None:
    takes_mappings = {"world", "bootstrap", "metrics", "by_goal_kind", "by_goal_class", "settings"}
    places: list[tuple[Any, ...]] = [(name,) for name in result if name not in takes_mappings]
    places += [("episodes", 1, name) for name in result["episodes"][1]]
    places += [("sensors", "observations"), ("task", "version"), ("stride", "forward_m")]
    for place in places:
        other = json.loads(json.dumps(result))
        at(*place, to=wrong)(other)
        told = differences(other)
        where = ".".join(f"[{one}]" if isinstance(one, int) else one for one in place)
        where = where.replace(".[", "[")
        assert len(told) >= 1
        assert any(sentence.startswith(where) for sentence in told), (place, told)
        for sentence in told:
            assert len(sentence) < 500
            assert not re.search("object (is not|has no)|argument must|convert", sentence), sentence


@pytest.mark.parametrize("count", ["99999999", "9" * 300, "x", "-1", "", "1.5"])
def test_actions_that_are_none_are_told(count: str, result: dict[str, Any]) -> None:
    other = json.loads(json.dumps(result))
    other["episodes"][0]["actions"] = f"1*{count}"
    (told,) = (one for one in differences(other) if one.startswith("episodes[0].actions"))
    assert "more than 10000000 actions" in told or "expected NUMBER or NUMBER*COUNT" in told


@pytest.mark.long
def test_an_expert_that_is_left_out_is_told(made: Path, result: dict[str, Any]) -> None:
    """The mean of SNA would be of the other episodes alone."""
    other = json.loads(json.dumps(result))
    other["episodes"][0].update(expert_actions=None, sna=None)
    means = summary(other["episodes"])
    other.update({name: means[name] for name in means if name in other})
    for files in (None, made):
        told = differences(other, episodes=files)
        assert [one for one in told if one.startswith("episodes[0].expert_actions")], told


@pytest.mark.long
def test_the_files_that_were_played_are_compared(
    made: Path, result: dict[str, Any], tmp_path: Path, command: Command
) -> None:
    path = tmp_path / "result.json"
    write_result(path, result)
    assert command("evaluate", "--verify", path, "--episodes", made).returncode == 0
    # Of a part of a file, the file says what the seed alone does not.
    stated = dwell.episodes.read(made)
    some = tmp_path / "some.jsonl"
    dwell.episodes.write(some, stated.header, [*stated][1::2])
    of_some = evaluate("stop", episodes=some)
    assert differences(of_some) == []
    assert differences(of_some, episodes=some) == []
    (told,) = differences(of_some, episodes=made)
    assert told.startswith("episode_files: the file states")
    reversed_ones = tmp_path / "reversed.jsonl"
    dwell.episodes.write(reversed_ones, stated.header, [*stated][::-1])
    of_reversed = evaluate("stop", episodes=reversed_ones)
    (told,) = differences(of_reversed)
    assert told.endswith("where they were chosen or made otherwise, give reversed.jsonl")
    assert differences(of_reversed, episodes=reversed_ones) == []
    of_reversed["seed"] = 77
    assert any("the episodes' 5" in one for one in differences(of_reversed, episodes=reversed_ones))


@pytest.mark.long
def test_a_baseline_is_asked_what_it_does() -> None:
    result = evaluate("random", task="PointNav", houses="builtin:studio", count=2, seed=4)
    assert differences(result) == []
    # Made here, each is the one at its place, of the seed and in the house that is tried for it.
    for houses in (
        ["builtin:studio", "builtin:apartment"],
        ["builtin:apartment", "builtin:studio"],
    ):
        (told,) = differences({**result, "houses": houses})
        assert told.startswith("seed: the file states 4, from which `dwell episodes` draws other")
    result["policy"] = "stop"
    told = "action 0 of"
    assert any(told in one and "the policy does 0 (stop)" in one for one in differences(result))


def test_a_file_with_an_edited_mean_fails_the_command(
    result: dict[str, Any], tmp_path: Path, command: Command
) -> None:
    path = tmp_path / "result.json"
    write_result(path, result)
    lines = path.read_text("utf-8").replace('"mean": 0.5', '"mean": 0.75', 1)
    path.write_text(lines, "utf-8")
    done = command("evaluate", "--verify", path)
    assert done.returncode == 1
    assert "metrics.success.mean: the file states 0.75, played it is 0.5" in done.stderr
    path.write_text("{}")
    assert "no dwell-evaluation file" in command("evaluate", "--verify", path).stderr


@pytest.mark.long
def test_the_command_gives_what_the_function_does(
    made: Path, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "result.json"
    done = command("evaluate", "expert", "--episodes", made, "--out", out)
    assert done.returncode == 0, done.stderr
    assert "success: 1 (1 to 1)" in done.stdout
    expected = evaluate("expert", episodes=made)
    assert read_result(out) == expected
    assert expected["metrics"]["sna"]["mean"] == 1.0
    # Stopped and begun again it is the same.
    cut, add, left = tmp_path / "cut.json", Journal.add, [2]

    def stop(self: Journal, *args: object) -> None:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        add(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Journal, "add", stop)
    stopped = command("evaluate", "expert", "--episodes", made, "--out", cut)
    assert stopped.returncode == 130
    assert "2 of 4 are kept; run again" in stopped.stderr
    monkeypatch.setattr(Journal, "add", add)
    assert command("evaluate", "expert", "--episodes", made, "--out", cut).returncode == 0
    assert cut.read_bytes() == out.read_bytes()


@pytest.mark.long
def test_baselines_and_policies_by_name_play(made: Path) -> None:
    stopped = evaluate("stop", episodes=made)
    assert stopped["metrics"]["steps"]["mean"] == 1.0
    assert stopped["metrics"]["success"]["mean"] == 0.0
    ahead = evaluate("forward", episodes=made, max_steps=5)
    assert {row["actions"] for row in ahead["episodes"]} == {"1*5"}
    once = evaluate("random", episodes=made)
    assert evaluate("random", episodes=made) == once
    for policy in (Wanderer, Wanderer(), make_wanderer):
        wandered = evaluate(policy, episodes=made, sensors=["gps"])
        assert {row["actions"] for row in wandered["episodes"]} == {"1*8 0"}
        assert differences(wandered) == []


@pytest.mark.long
def test_a_policy_is_imported_by_the_command(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_own_policy.py").write_text(
        "class Wait:\n    def act(self, observation):\n        return 6\n\n\n"
        "def make():\n    return Wait()\n\n\nnumber = 3\n"
    )
    one = ("--task", "PointNav", "--houses", "builtin:studio", "--count", "1", "--json")
    for name in ("my_own_policy:Wait", "my_own_policy:make"):
        done = command("evaluate", name, *one, "--max-steps", "3", "--sensors", "gps")
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["policy"] == name
    for name, told in (
        ("my_own_policy:number", "expected a class with a method act"),
        ("my_own_policy:other", "expected 'module:Name'"),
        ("os:abort", "expected a class with a method act"),
        ("expret", "did you mean expert"),
    ):
        refused = command("evaluate", name, *one)
        assert refused.returncode == 1
        assert told in refused.stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("stop", "expected a file of episodes; or task, houses and count"),
        ("stop --episodes FILE --task PointNav", "--task is given, and an evaluation of episodes"),
        ("stop --episodes FILE --set min_distance_m=4", "task_settings.min_distance_m is 4"),
        ("stop --task PointNav --split val --houses seed:1 --count 1", "--split and --houses"),
        ("--verify FILE --count 3", "--count is given"),
        ("--json", "expected a POLICY"),
    ],
)
def test_options_that_contradict_are_refused(
    options: str, told: str, made: Path, command: Command
) -> None:
    refused = command("evaluate", *options.replace("FILE", str(made)).split())
    assert refused.returncode == 1
    assert told in refused.stderr


def test_an_action_that_is_none_is_refused(made: Path) -> None:
    class Wrong:
        def act(self, observation: object) -> object:
            return 99

    with pytest.raises(dwell.ConfigError, match="the policy's action is 99"):
        evaluate(Wrong(), episodes=made, sensors=["gps"])


def test_corner_cases_of_means() -> None:
    result = evaluate("stop", task="Free", houses="builtin:studio", count=2)
    assert result["metrics"]["spl"] == {"episodes": 0, "mean": None, "low": None, "high": None}
    assert result["by_goal_kind"] == {}
    assert differences(result) == []
    for numbers in ([], [0], [1, 1, 1, 0], [11, 11, 3, 11]):
        assert unpacked("actions", packed(numbers)) == numbers
    assert math.isclose(result["metrics"]["steps"]["mean"], 1.0)


def test_pictures_are_not_taken_to_verify(tmp_path: Path) -> None:
    sensors = {"rgb": {"width": 16, "height": 16, "preset": "flat"}, "audio": {}}
    result = evaluate(
        "stop", task="AudioNav", houses="builtin:studio", count=1, seed=3, sensors=sensors
    )
    assert {row["name"] for row in result["sensors"]["observations"]} == {"rgb", "audio"}
    assert differences(result) == []
