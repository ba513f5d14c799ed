"""Episodes of several agents as files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pettingzoo.utils import parallel_to_aec

import dwell
from dwell import cli
from dwell import pettingzoo as zoo
from dwell.envs.action_modes import ACTION_MODES

pytestmark = pytest.mark.usefixtures("open_once")

AGENTS: dict[str, Any] = {
    "anna": {"voice": {"words": ["sofa", "bed"]}, "team": "red"},
    "ben": {"task": "PointNav", "action_mode": "velocity", "team": "red"},
    "carl": {"task": "PointNav", "scripted": True},
}
SETTINGS: dict[str, Any] = {
    "agents": AGENTS,
    "houses": "builtin:studio",
    "sensors": ["gps", "heard_tokens"],
    "shared_reward": 0.5,
}
STEPS = 6


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    """An episode in which Ben's ends before Anna's, and what its steps were."""
    folder = tmp_path_factory.mktemp("agents")
    env = zoo.ParallelReplayRecorder(zoo.parallel_env("Free", **SETTINGS), folder)
    env.reset(seed=3)
    steps = []
    for step in range(STEPS):
        says = np.array([2, 1] if step == 1 else [0, 0])
        tokens = np.zeros(8, np.int64)
        tokens[:2] = says
        # A velocity of nearly nothing is Ben's stop.
        ben = np.array([0.9, 0.1, 0.0, 0.0] if step < 3 else np.zeros(4), np.float32)
        actions = {"anna": {"action": 1 + step % 3, "say": {"tokens": tokens}}, "ben": ben}
        live = {name: actions[name] for name in env.agents}
        _, rewards, ended, _, infos = env.step(live)
        steps.append({"rewards": rewards, "ended": ended, "infos": infos})
    assert env.agents == ["anna"]
    env.close()
    return folder / "episode_0000.replay", steps


@pytest.mark.long
def test_an_episode_of_several_agents_is_played_again_to_the_same_bits(
    played: tuple[Path, list[dict[str, Any]]],
) -> None:
    file, steps = played
    replay = dwell.Replay.read(file)
    assert json.loads(file.read_text("utf-8"))["version"] == 5
    assert [(one.name, one.team, one.ended) for one in replay.agents] == [
        ("anna", "red", None),
        ("ben", "red", 4),
        ("carl", "", None),
    ]
    assert replay.agents[1].instruction != replay.agents[0].instruction
    assert replay.differences() == []
    moments = list(replay.play())
    assert all(moment.is_same for moment in moments)
    assert [set(row) for row in replay.actions] == [{"anna", "ben"}] * 4 + [{"anna"}] * 2
    for moment, step in zip(moments[1:], steps, strict=True):
        assert set(moment.agents) == {*AGENTS}
        for name, reward in step["rewards"].items():
            assert moment.agents[name].reward == reward
            assert moment.agents[name].acts is not step["ended"][name]
            assert moment.agents[name].success == step["infos"][name]["success"]
    said = [(moment.step, moment.agents["anna"].says) for moment in moments if moment.step]
    assert [row for row in said if row[1]] == [(2, ("bed", "sofa"))]
    assert moments[2].agents["anna"].effort == "normal"


@pytest.mark.parametrize("mode", ACTION_MODES)
def test_every_form_of_actions_is_held(mode: str, tmp_path: Path) -> None:
    agents = {"a": {"action_mode": mode, "voice": True}, "b": {"voice": {"efforts": ["loud"]}}}
    bare = zoo.parallel_env("Free", agents=agents, houses="builtin:studio", sensors=["gps"])
    env = zoo.ParallelReplayRecorder(bare, tmp_path)
    for number, name in enumerate(bare.possible_agents):
        bare.action_space(name).seed(number)
    env.reset(seed=2)
    hashes = [bare.state_hash()]
    for _ in range(4):
        env.step({name: bare.action_space(name).sample() for name in env.agents})
        hashes.append(bare.state_hash())
        if not env.agents:
            break
    env.close()
    replay = dwell.Replay.read(tmp_path / "episode_0000.replay")
    assert [int(text, 16) for text in replay.hashes] == hashes
    assert any("say" in row.get("b", {}) for row in replay.actions)
    assert replay.first_difference() is None


def test_environments_that_step_together_are_recorded(tmp_path: Path) -> None:
    """Each as alone, where an agent's ends before the others', and after the next have begun."""
    settings: dict[str, Any] = {**SETTINGS, "max_cycles": 5}
    envs = zoo.ParallelVectorReplayRecorder(zoo.vector_env(2, "Free", **settings), tmp_path / "two")
    envs.reset(seed=[3, 4])
    tokens = np.zeros((2, 8), np.int64)
    tokens[0, 0] = 1
    for step in range(8):
        # Ben's velocities of nearly nothing are his stop: in environment 0 in the third step.
        ben = np.tile(np.array([0.9, 0.1, 0.0, 0.0], np.float32), (2, 1))
        ben[0] *= step != 2
        said = {"tokens": tokens * (step == 1)}
        envs.step({"anna": {"action": np.array([1, 2]), "say": said}, "ben": ben})
    hashes = envs.state_hashes()
    envs.close()
    replays = [dwell.Replay.read(file) for file in sorted((tmp_path / "two").iterdir())]
    # Five steps, one that begins the next, and two of that.
    assert [len(replay.actions) for replay in replays] == [5, 5, 2, 2]
    assert [replay.differences() for replay in replays] == [[]] * 4
    assert [int(replay.hashes[-1], 16) for replay in replays[2:]] == hashes
    assert [one.ended for one in replays[0].agents] == [None, 3, None]
    assert [set(row) for row in replays[0].actions] == [{"anna", "ben"}] * 3 + [{"anna"}] * 2
    assert replays[0].actions[1]["anna"]["say"]["tokens"]
    alone = zoo.ParallelReplayRecorder(zoo.parallel_env("Free", **SETTINGS), tmp_path / "one")
    alone.reset(seed=3)
    no_word = {"tokens": np.zeros(8, np.int64)}
    alone.step(
        {
            "anna": {"action": 1, "say": no_word},
            "ben": np.array([0.9, 0.1, 0.0, 0.0], np.float32),
        }
    )
    alone.close()
    replay = dwell.Replay.read(tmp_path / "one" / "episode_0000.replay")
    assert (replay.seed, replay.house) == (replays[0].seed, replays[0].house)
    assert replay.hashes == replays[0].hashes[:2]


def test_a_world_that_steps_with_others_and_changed_is_not_recorded_further(tmp_path: Path) -> None:
    bare = zoo.vector_env(2, agents=2, houses="builtin:studio", sensors=["gps"])
    envs = zoo.ParallelVectorReplayRecorder(bare, tmp_path)
    walk = dict.fromkeys(bare.possible_agents, np.array([1, 1]))
    envs.reset(seed=1)
    saved = envs.snapshot()
    envs.step(walk)
    envs.restore([None, saved[1]])
    with pytest.raises(dwell.UsageError, match="the world of environment 1 was changed"):
        envs.step(walk)
    envs.step(walk)
    envs.close()
    # Of environment 1 what was before it changed.
    changed, replay = (dwell.Replay.read(file) for file in sorted(tmp_path.iterdir()))
    assert [len(changed.actions), len(replay.actions)] == [1, 2]
    assert changed.differences() == replay.differences() == []
    with pytest.raises(dwell.ConfigError, match=r"expected one of dwell\.pettingzoo\.vector_env"):
        zoo.ParallelVectorReplayRecorder(zoo.parallel_env(agents=2), tmp_path)


def test_agents_that_take_turns_are_recorded_too(tmp_path: Path) -> None:
    own = zoo.parallel_env("Free", agents=2, houses="builtin:studio", sensors=["gps"])
    env = parallel_to_aec(zoo.ParallelReplayRecorder(own, tmp_path))
    env.reset(seed=1)
    for action in (1, 2, 0, 0):
        env.step(action)
    replay = dwell.Replay.read(tmp_path / "episode_0000.replay")
    assert replay.actions[0] == {"agent_0": "move_forward", "agent_1": "turn_left"}
    assert [one.ended for one in replay.agents] == [2, 2]
    assert replay.differences() == []


def changed(file: Path, folder: Path, edit: Any) -> Path:  # noqa: ANN401 - changes a row
    row = json.loads(file.read_text("utf-8"))
    edit(row)
    other = folder / "changed.replay"
    other.write_text(json.dumps(row), "utf-8")
    return other


UNFIT: list[tuple[Any, str]] = [
    (lambda row: row.pop("agents"), "field 'agents' is missing in version 5"),
    (lambda row: row.update(version=3), "is unknown in version 3"),
    (lambda row: row["agents"].pop(), "expected 3 different names"),
    (lambda row: row["agents"][0].pop("team"), "agents[0]: field 'team' is missing"),
    (lambda row: row["agents"][0].update(name="ben"), "expected 3 different names"),
    (lambda row: row["agents"][1].update(ended=0), "agents[1].ended is 0"),
    (lambda row: row["agents"][1].update(ended=9), "agents[1].ended is 9 of 6 steps"),
    (lambda row: row["actions"][5].update(ben="wait"), "actions[5] is of ['anna', 'ben']"),
    (lambda row: row["actions"][0].pop("anna"), "actions[0] is of ['ben']"),
    (lambda row: row["actions"][2].update(anna="fly"), "actions[2].anna is 'fly'"),
    (lambda row: row["actions"][1]["anna"]["say"].update(tokens=[0]), "say: tokens[0] is 0"),
    (lambda row: row["actions"][1]["anna"]["say"].update(effort="sung"), "effort is 'sung'"),
    (lambda row: row.update(success=True), "of anna, the first agent, it is False"),
    (lambda row: row.update(shared_reward=2), "shared_reward is 2"),
]


@pytest.mark.parametrize(("edit", "said"), UNFIT, ids=[row[1] for row in UNFIT])
def test_fields_that_do_not_fit_are_named(
    played: tuple[Path, list[dict[str, Any]]],
    tmp_path: Path,
    edit: Any,  # noqa: ANN401 - changes a row
    said: str,
) -> None:
    with pytest.raises(dwell.MeasuredDataError) as refused:
        dwell.Replay.read(changed(played[0], tmp_path, edit))
    assert said in str(refused.value)


EDITED: list[tuple[Any, str]] = [
    (lambda row: row["actions"][2].update(anna="wait"), "hashes[3]"),
    (lambda row: row["actions"][1].update(anna="turn_left"), "hashes[2]"),
    (lambda row: row["agents"][2].update(instruction="Fly."), "agents[2].instruction: of carl"),
    (lambda row: row["agents"][1].update(success=True), "agents[1].success: of ben"),
    (lambda row: row["agents"][1].update(team="blue"), "agents: changed since"),
    (lambda row: row["agents"][2].update(ended=6), "agents[2].ended: of carl"),
    (lambda row: row.update(shared_reward=0.25), "shared_reward: changed since"),
]


@pytest.mark.parametrize(("edit", "said"), EDITED, ids=[row[1] for row in EDITED])
def test_what_is_edited_is_found(
    played: tuple[Path, list[dict[str, Any]]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    edit: Any,  # noqa: ANN401 - changes a row
    said: str,
) -> None:
    assert cli.main(["replay", str(changed(played[0], tmp_path, edit)), "--verify"]) == 1
    assert said in capsys.readouterr().err


@pytest.mark.long
def test_an_agent_is_chosen_to_see_and_hear_again(
    played: tuple[Path, list[dict[str, Any]]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    options = ["--sensors", "rgb", "--every", "6", "--width", "16", "--height", "12"]
    for name in ("anna", "ben"):
        command = ["replay", str(played[0]), *options, "--agent", name]
        assert cli.main([*command, "--out", str(tmp_path / name)]) == 0
    seen = [(tmp_path / name / "rgb_00000.png").read_bytes() for name in ("anna", "ben")]
    assert seen[0] != seen[1]
    capsys.readouterr()
    command = ["replay", str(played[0]), *options, "--agent", "dora", "--out", str(tmp_path / "d")]
    assert cli.main(command) == 1
    assert "allowed are" in capsys.readouterr().err
    assert cli.main(["replay", str(played[0]), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in told["agents"]] == ["anna", "ben", "carl"]


def test_a_changed_world_is_not_recorded_further(tmp_path: Path) -> None:
    own = zoo.parallel_env("Free", agents=2, houses="builtin:studio", sensors=["gps"])
    env = zoo.ParallelReplayRecorder(own, tmp_path)
    env.reset(seed=1)
    saved = own.snapshot()
    env.step({"agent_0": 1, "agent_1": 1})
    own.restore(saved)
    for _ in range(2):
        with pytest.raises(dwell.UsageError, match="something else than actions"):
            env.step({"agent_0": 1, "agent_1": 1})
    assert len(dwell.Replay.read(tmp_path / "episode_0000.replay").actions) == 1
    with pytest.raises(dwell.ConfigError, match=r"expected an environment of dwell\.pettingzoo"):
        zoo.ParallelReplayRecorder(object(), tmp_path)
    house = dwell.House.open("builtin:studio")
    with pytest.raises(dwell.ConfigError, match="handed over as an object"):
        zoo.ParallelReplayRecorder(zoo.parallel_env(houses=house, sensors=["gps"]), tmp_path)
