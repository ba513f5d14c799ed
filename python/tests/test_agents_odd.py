"""Several agents in one house: what is refused, and what others may not change."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from test_pettingzoo import HOME, STUDIO, bits

import dwell
from dwell import pettingzoo as zoo

pytestmark = pytest.mark.usefixtures("open_once")

BAD: list[tuple[dict[str, Any], str]] = [
    ({"agents": 0}, "agents is 0; expected a number of agents, 1 to 64"),
    ({"agents": 65}, "agents is 65; expected"),
    ({"agents": {}}, "agents has 0 of them"),
    ({"agents": True}, "agents is True"),
    ({"agents": {"a": {"sensor": []}}}, "did you mean"),
    ({"agents": {"a": {"team": 3}}}, "agents.a.team is 3"),
    ({"agents": {"a": {"body": {"wings": 2}}}}, "wings"),
    ({"agents": {"a": {"task": "Fly"}}}, "Fly"),
    ({"agents": {"a": {"action_mode": "jump"}}}, "action_mode"),
    ({"agents": {"a": {"voice": {"words": ["xyzzy"]}}}}, "agents.a.voice.words: ['xyzzy']"),
    ({"agents": {"a": {"voice": {"max_tokens": 9}}}}, "max_tokens"),
    ({"voice": 3}, "voice"),
    ({"shared_reward": 1.5}, "shared_reward"),
    ({"max_cycles": 0}, "max_cycles is 0"),
    ({"world": {"agents": [{}]}}, "the bodies stand in agents"),
    ({"world": 3}, "world is 3"),
    ({"agents": {"a": {"voice": "yes"}}}, "a mapping with words"),
    ({"sensor": ["gps"]}, "did you mean sensors"),
    ({"task": "Cooperate", "agents": 1}, "at least 2 agents in Cooperate"),
    (
        {"agents": {"a": {}, "b": {"body": {"radius_m": 9.0}}}},
        "agents.b.body: radius_m is 9 (range",
    ),
    ({"agents": {"a": {}, "b": {"body": {"height_m": "x"}}}}, "agents.b.body.height_m is 'x'"),
    (
        {"agents": {"a": {}, "b": {"body": "person"}}},
        "agents.b.body is 'person'; expected a mapping, such as {'kind': 'person'}",
    ),
    ({"agents": {"a": {}, "b": {"body": {"kind": "man"}}}}, "agents.b.body.kind is 'man'; allowed"),
    ({"agents": {"a": {}, "b": {"task_settings": {"x": 1}}}}, "agents.b: task_settings: x is 1"),
    ({"agents": {"a": {}, "b": {"task": "Fly"}}}, 'agents.b: no task "Fly"'),
    ({"agents": {"a": {}, "b": {"actions": ["fly"]}}}, 'agents.b: no discrete action "fly"'),
    ({"agents": {"a": {}, "b": {"action_mode": "jump"}}}, "agents.b: action_mode is 'jump'"),
    ({"agents": {"a": {}, "b": {"sensors": ["nose"]}}}, 'agents.b: no sensor "nose"'),
    ({"agents": {"a": {}, "b": {"stride": {"forward_m": -1}}}}, "agents.b: forward_m is -1"),
    (
        {"agents": {"a": {}, "b": {"action_mode": "velocity"}}, "action_mask": True},
        "agent b: action_mask is True",
    ),
    # Of everybody: nobody is named.
    ({"agents": 2, "sensors": ["nose"]}, 'no sensor "nose"'),
]


@pytest.mark.parametrize(("settings", "told"), BAD, ids=[str(row[0]) for row in BAD])
def test_what_cannot_be_made_is_refused(settings: dict[str, Any], told: str) -> None:
    arguments = {"houses": "builtin:studio", **settings}
    makes: list[Callable[..., Any]] = [zoo.parallel_env, lambda **more: zoo.vector_env(2, **more)]
    for make in makes:
        with pytest.raises((dwell.ConfigError, dwell.SceneError), match=re.escape(told)):
            make(**arguments)


def test_calls_that_go_wrong_say_what_to_do() -> None:
    env = zoo.parallel_env("PointNav", agents=2, **STUDIO)
    for call in (lambda: env.step({}), env.state, env.snapshot, env.expert_actions):
        with pytest.raises(dwell.UsageError, match="reset first"):
            call()
    env.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="none of \\['agent_1'\\]"):
        env.step({"agent_0": 6})
    with pytest.raises(dwell.ConfigError, match="no agent 'agent_9'"):
        env.step({"agent_0": 6, "agent_1": 6, "agent_9": 6})
    with pytest.raises(dwell.ConfigError, match=r"agent agent_0: .*0 to 11"):
        env.step({"agent_0": 12, "agent_1": 6})
    env.step({"agent_0": 0, "agent_1": 6})
    assert env.agents == ["agent_1"]
    with pytest.raises(dwell.UsageError, match="agent_0 has ended"):
        env.step({"agent_0": 6, "agent_1": 6})
    env.step({"agent_1": 0})
    assert env.agents == []
    assert env.step({}) == ({}, {}, {}, {}, {})
    env.close()
    env.close()
    with pytest.raises(dwell.UsageError, match="closed"):
        env.reset(seed=1)


def test_what_is_wrong_with_all_names_nobody() -> None:
    with pytest.raises(dwell.ConfigError) as refused:
        zoo.parallel_env(agents={"a": {}, "b": {}}, houses="builtin:studio", sensors=["nose"])
    assert "agents" not in str(refused.value)


def test_utterances_that_nobody_can_say_are_refused_with_the_agents_name() -> None:
    env = zoo.parallel_env(agents={"anna": {"voice": True}, "ben": {}}, **STUDIO)
    env.reset(seed=1)
    before = env.state_hash()
    for tokens, told in (
        (np.full(8, 99_999), "agent anna: say: tokens are"),
        (["sofa"] * 8, "agent anna: say: tokens are"),
        ([1], "agent anna: say: tokens: expected"),
        (np.full(8, 0.5), "agent anna: say: tokens are"),
    ):
        with pytest.raises(dwell.ConfigError, match=told):
            env.step({"anna": {"action": 1, "say": {"tokens": tokens}}, "ben": 1})
    with pytest.raises(dwell.ConfigError, match="agent anna: action is 1; expected a mapping"):
        env.step({"anna": 1, "ben": 1})
    with pytest.raises(dwell.ConfigError, match="xyzzy"):
        env.world.say(0, "xyzzy")
    for number in (0, 5000, 2**32, 10**30):
        told = rf"words\[0\] is {number}; allowed are whole numbers from 1 to "
        with pytest.raises(dwell.ConfigError, match=told):
            env.world.say(0, [number])
    with pytest.raises(dwell.ConfigError, match="no agent 9; there are 2"):
        env.world.say(9, "sofa")
    assert env.state_hash() == before


def test_who_states_a_team_that_nobody_else_states_is_alone_in_it() -> None:
    agents: dict[str, Any] = {"a": {"team": "red"}, "b": {}, "c": {}}

    def rewards(share: float) -> dict[str, float]:
        env = zoo.parallel_env("PointNav", agents=agents, shared_reward=share, **HOME)
        env.reset(seed=3)
        found: dict[str, float] = env.step(dict.fromkeys(agents, 1))[1]
        return found

    own, shared = rewards(0.0), rewards(1.0)
    both = 0.5 * (own["b"] + own["c"])
    assert shared == pytest.approx({"a": own["a"], "b": both, "c": both})


def test_agents_that_are_put_into_one_place_walk_apart() -> None:
    """As the page on several agents says."""
    env = zoo.parallel_env(agents=2, **STUDIO)
    env.reset(seed=1)
    place = env.world.agents()[0]["position"]
    env.world.place_agent(place, agent=1)

    def apart_m() -> float:
        here, there = (np.array(row["position"]) for row in env.world.agents())
        return float(np.linalg.norm(here - there))

    for _ in range(5):
        env.step({"agent_0": 6, "agent_1": 6})
    assert apart_m() < 0.01
    distances = []
    for _ in range(10):
        env.step({"agent_0": 1, "agent_1": 6})
        distances.append(apart_m())
    assert (np.diff(distances) >= -1e-4).all()
    assert distances[-1] > 0.4
    assert np.isfinite(env.state()).all()


def test_an_action_of_the_dead_changes_nothing_in_a_vector() -> None:
    def play(action: int) -> list[int]:
        many = zoo.vector_env(1, "PointNav", agents=2, threads=1, **STUDIO)
        many.reset(seed=2)
        many.step({"agent_0": [0], "agent_1": [6]})
        hashes = []
        for _ in range(4):
            _, rewards, _, _, infos = many.step({"agent_0": [action], "agent_1": [2]})
            assert rewards["agent_0"][0] == 0.0
            assert not infos["agent_0"]["active"][0]
            hashes += many.state_hashes()
        return hashes

    assert play(1) == play(2)


#: Bodies, sensors, voices and endings of another agent, drawn below.
OTHERS: dict[str, list[Any]] = {
    "sensors": [["gps"], ["audio"], ["rgb"], {"lidar": {"noise_m": 0.1}}, ["heard_tokens"], []],
    "voice": [False, True, {"words": ["sofa"], "efforts": ["whisper", "loud"]}],
    "action_mode": ["discrete", "velocity", "object", "dict"],
    "team": ["", "red"],
}


@pytest.mark.long
@pytest.mark.parametrize(
    "seed", [0, 1, 2, *(pytest.param(k, marks=pytest.mark.slow) for k in range(3, 30))]
)
def test_anything_about_others_but_the_world_changes_no_bit(seed: int) -> None:
    """With random settings of another: sensors with noise, voice, form of actions, end, lateness.

    What the other does in the world is the same: it stands. So whatever else differs must not be
    seen, drawn or paid by its neighbours, before and behind it in the list.
    """
    stream = np.random.default_rng(seed)
    laws = {"shot_read_noise": {"gain": 0.005, "read": 0.01}}

    def play(other: dict[str, Any], ends: int | None) -> list[Any]:
        own = {
            "sensors": {"rgb": {"width": 12, "height": 9}, "lidar": {"beams": 8, "noise_m": 0.2}}
        }
        env = zoo.parallel_env(
            "PointNav",
            agents={"first": own, "other": other, "last": own},
            houses="builtin:studio",
            laws=laws,
            # Else they stand open where an agent has no action that opens them: another world.
            task_settings={"open_doors": True},
        )
        observations, _ = env.reset(seed=seed)
        wait = env.action_names("other").index("wait") if "wait" in env.action_names("other") else 0
        found: list[Any] = []
        for step in range(8):
            actions: dict[str, Any] = {name: 1 + step % 3 for name in ("first", "last")}
            if "other" in env.agents:
                actions["other"] = standing(env, wait, stops=step == ends)
            observations, rewards, *_ = env.step(actions)
            for name in ("first", "last"):
                found.append((bits({name: observations[name]}), rewards[name]))
        assert ("other" in env.agents) is (ends is None)
        return found

    plain = play({}, None)
    for _ in range(2):
        other = {key: rows[stream.integers(len(rows))] for key, rows in OTHERS.items()}
        ends = None if stream.random() < 0.5 else int(stream.integers(6))
        assert play(other, ends) == plain, (other, ends)


def standing(env: zoo.DwellParallelEnv, wait: int, *, stops: bool) -> Any:  # noqa: ANN401 - of the space
    """An action of ``other`` in whatever form that leaves it where it is, or ends its episode."""
    space = env.action_space("other")
    action = space.sample()
    body = np.zeros(4, np.float32)
    # The least turn that is no stop: less than the capsule shows.
    body[3] = 0.0 if stops else 0.06
    if isinstance(action, dict):
        action = {**action}
        if "say" in action:
            action["say"] = {key: np.zeros_like(value) for key, value in action["say"].items()}
        if "base" in action:
            action |= {"base": body[:3], "head": body[3:], "hand": 0, "stop": int(stops)}
        elif isinstance(action["action"], np.ndarray):
            action["action"] = body
        else:
            action["action"] = 0 if stops else wait
        return action
    return body if isinstance(action, np.ndarray) else (0 if stops else wait)
