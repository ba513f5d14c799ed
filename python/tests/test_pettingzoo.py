"""Several agents in one house: PettingZoo's tests, and what it cannot know."""

from __future__ import annotations

import pickle
import re
import types
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from pettingzoo.test import (
    api_test,
    max_cycles_test,
    parallel_api_test,
    parallel_seed_test,
    seed_test,
    state_test,
)

import dwell
from dwell import _native
from dwell import pettingzoo as zoo
from dwell.envs import DwellEnv
from dwell.envs.action_modes import ACTION_MODES

pytestmark = pytest.mark.usefixtures("open_once")

Observations = dict[str, dict[str, Any]]

STUDIO: dict[str, Any] = {"houses": "builtin:studio", "sensors": ["gps", "compass"]}
HOME: dict[str, Any] = {"houses": "builtin:apartment", "sensors": ["gps"]}
TASKS = [task["name"] for task in _native.tasks()]
#: Those whose full contract runs in every test run; the others are slow.
QUICK = ("PointNav", "Cooperate", "PiedPiper", "SocialNav", "HideAndSeek")


def bits(observations: Observations) -> dict[str, dict[str, bytes]]:
    return {
        name: {key: np.asarray(value).tobytes() for key, value in own.items()}
        for name, own in observations.items()
    }


def sample(env: zoo.DwellParallelEnv) -> dict[str, Any]:
    return {name: env.action_space(name).sample() for name in env.agents}


def seed_spaces(env: zoo.DwellParallelEnv, seed: int = 7) -> None:
    for number, name in enumerate(env.possible_agents):
        env.action_space(name).seed(seed + number)


@pytest.mark.long
@pytest.mark.parametrize(
    "task", [pytest.param(t, marks=() if t in QUICK else pytest.mark.slow) for t in TASKS]
)
def test_pettingzoos_tests_have_nothing_to_say(task: str) -> None:
    # Nothing in the apartment needs two and can be carried far.
    home = {**HOME, "houses": "builtin:studio"} if task == "Carry" else HOME

    def make(**more: Any) -> zoo.DwellParallelEnv:  # noqa: ANN401 - of the class
        return zoo.parallel_env(task, agents=3, **home, **more)

    # Warnings are errors in this suite.
    parallel_api_test(make(), num_cycles=12)
    parallel_seed_test(make, num_cycles=6)
    with warnings.catch_warnings():
        # It recommends arrays where observations, and actions with answers, are dictionaries.
        warnings.filterwarnings("ignore", "Observation is not a NumPy array")
        warnings.filterwarnings("ignore", ".* space for each agent probably should be")
        api_test(zoo.env(task, agents=3, **home), num_cycles=12)
    seed_test(lambda: zoo.env(task, agents=3, **home), num_cycles=6)
    state_test(zoo.env(task, agents=3, **home), make(), num_cycles=4)
    moving = {"actions": ["move_forward", "turn_left", "turn_right", "wait"]}
    module = types.SimpleNamespace(
        parallel_env=lambda max_cycles: make(max_cycles=max_cycles, **moving),
        env=lambda max_cycles: zoo.env(task, agents=3, max_cycles=max_cycles, **moving, **home),
    )
    max_cycles_test(module)


def test_one_agent_gets_the_bits_of_the_environment_of_one() -> None:
    alone = DwellEnv("PointNav", **STUDIO)
    among = zoo.parallel_env("PointNav", agents=1, **STUDIO)
    observation, info = alone.reset(seed=4)
    observations, infos = among.reset(seed=4)
    assert bits(observations) == bits({"agent_0": observation})
    assert infos["agent_0"] == info
    seed_spaces(among)
    while among.agents:
        actions = sample(among)
        observation, reward, terminated, truncated, info = alone.step(actions["agent_0"])
        observations, rewards, ended, cut, infos = among.step(actions)
        assert bits(observations) == bits({"agent_0": observation})
        found = (rewards["agent_0"], ended["agent_0"], cut["agent_0"])
        assert found == (reward, terminated, truncated)
        assert infos["agent_0"].pop("speaks") is False
        assert infos["agent_0"] == info
        assert among.state_hash() == alone.state_hash()


@pytest.mark.parametrize("threads", [1, 2])
def test_a_vector_has_the_episodes_of_single_environments(threads: int) -> None:
    settings: dict[str, Any] = {
        "agents": {"a": {}, "b": {"action_mode": "velocity"}},
        "houses": ["builtin:studio", "builtin:apartment"],
        "sensors": ["gps", "compass"],
        "max_cycles": 5,
    }
    many = zoo.vector_env(2, "PointNav", threads=threads, copy=True, **settings)
    singles = [zoo.parallel_env("PointNav", **settings) for _ in range(2)]
    seen, infos = many.reset(seed=8)
    for k, single in enumerate(singles):
        observations, _ = single.reset(seed=8 + k)
        assert bits(observations) == {
            name: {key: value[k].tobytes() for key, value in own.items()}
            for name, own in seen.items()
        }
    for space in many.batched_action_spaces.values():
        space.seed(3)
    began = 0
    for _ in range(14):
        actions = {name: space.sample() for name, space in many.batched_action_spaces.items()}
        seen, rewards, _, truncated, infos = many.step(actions)
        for k, single in enumerate(singles):
            if not single.agents:
                observations, _ = single.reset()
                began += 1
                assert not any(infos[name]["active"][k] for name in infos)
            else:
                own = {name: actions[name][k] for name in single.agents}
                observations, single_rewards, _, cut, _ = single.step(own)
                for name, reward in single_rewards.items():
                    assert rewards[name][k] == reward
                    assert truncated[name][k] == cut[name]
            for name, observation in observations.items():
                for key, value in observation.items():
                    assert seen[name][key][k].tobytes() == value.tobytes()
            assert many.state_hashes()[k] == single.state_hash()
    assert began >= 4
    assert many.state().shape == (2, 26)
    assert set(many.goals(1)) == {"a", "b"}
    many.close()
    many.close()
    with pytest.raises(dwell.UsageError):
        many.reset(seed=1)


@pytest.mark.long
def test_others_change_what_one_sees_by_the_world_alone() -> None:
    def play(other: dict[str, Any], ends: bool) -> list[dict[str, bytes]]:
        env = zoo.parallel_env(
            "Free",
            agents={"own": {}, "other": other},
            houses="builtin:apartment",
            sensors={"rgb": {"width": 16, "height": 12}, "gps": {}},
            laws={"shot_read_noise": {"gain": 0.005, "read": 0.01}},
            task_settings={"start": "anywhere"},
        )
        observations, _ = env.reset(seed=2)
        seen = [bits(observations)["own"]]
        for step in range(6):
            # stop, or wait
            actions = {"own": 1 + step % 3, "other": 0 if ends and step == 1 else 6}
            observations, *_ = env.step({name: actions[name] for name in env.agents})
            seen.append(bits(observations)["own"])
        assert ("other" in env.agents) is not ends
        return seen

    first = play({}, ends=False)
    assert play({}, ends=True) == first
    assert play({"sensors": ["audio", "rgb"]}, ends=False) == first
    assert len(first) == 7


@pytest.mark.parametrize("mode", ACTION_MODES)
def test_snapshots_forks_and_pickles_go_on_with_the_same_bits(mode: str) -> None:
    env = zoo.parallel_env(
        "RoomNav", agents={"a": {"action_mode": mode}, "b": {}}, voice=True, **STUDIO
    )
    again = pickle.loads(pickle.dumps(env))
    assert bits(env.reset(seed=5)[0]) == bits(again.reset(seed=5)[0])
    seed_spaces(env)
    env.step(sample(env))
    saved = env.snapshot()
    fork = env.fork()
    assert fork.agents == env.agents
    for _ in range(4):
        if not env.agents:
            break
        actions = sample(env)
        seen = bits(env.step(actions)[0])
        assert bits(fork.step(actions)[0]) == seen
        assert fork.state_hash() == env.state_hash()
    again.restore(saved)
    assert again.snapshot() == saved
    single = DwellEnv("RoomNav", **STUDIO)
    single.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="snapshot refused"):
        env.restore(single.snapshot())


@pytest.mark.long
@pytest.mark.parametrize("mode", ["discrete", "dict"])
def test_snapshots_and_forks_of_a_vector_go_on_with_the_same_bits(mode: str) -> None:
    settings: dict[str, Any] = {
        "agents": {"a": {"action_mode": mode}, "b": {"voice": True}, "c": {"scripted": True}},
        "houses": ["builtin:studio", "builtin:apartment"],
        "sensors": ["gps", "compass"],
        "max_cycles": 4,
        "copy": True,
    }
    many = zoo.vector_env(2, "PointNav", **settings)
    many.reset(seed=8)
    for space in many.batched_action_spaces.values():
        space.seed(3)

    def actions() -> dict[str, Any]:
        return {name: space.sample() for name, space in many.batched_action_spaces.items()}

    many.step(actions())
    # Agent b's episode ends in environment 0.
    last = actions()
    last["b"]["action"][:] = [0, 2]
    seen, *_ = many.step(last)
    saved, fork = many.snapshot(), many.fork()
    other = zoo.vector_env(2, "PointNav", **settings)
    back, _ = other.restore(saved)
    assert bits(back) == bits(seen)
    began = 0
    for _ in range(7):
        taken = actions()
        seen, rewards, ended, cut, infos = many.step(taken)
        began += not infos["a"]["active"][0]
        for copy in (fork, other):
            again = copy.step(taken)
            assert bits(again[0]) == bits(seen)
            for mine, theirs in zip((rewards, ended, cut), again[1:4], strict=True):
                assert all(np.array_equal(mine[name], theirs[name]) for name in mine)
            assert np.array_equal(again[4]["b"]["active"], infos["b"]["active"])
            assert list(again[4]["b"]["episode_id"]) == list(infos["b"]["episode_id"])
            assert copy.state_hashes() == many.state_hashes()
            assert np.array_equal(copy.state(), many.state())
    assert began >= 1
    assert many.world(1).time_s == other.world(1).time_s
    # Into another environment, and into one of the two.
    other.restore([None, saved[0]])
    hashes = zoo.vector_env(2, "PointNav", **settings)
    hashes.restore([saved[0], saved[0]])
    assert other.state_hashes()[1] == hashes.state_hashes()[0] == hashes.state_hashes()[1]


def test_snapshots_of_a_vector_that_do_not_fit_are_refused() -> None:
    many = zoo.vector_env(2, agents={"a": {}, "b": {}}, **STUDIO)
    with pytest.raises(dwell.UsageError, match="no episode of environments"):
        many.snapshot()
    many.reset(seed=1)
    saved, before = many.snapshot(), many.state_hashes()
    single = zoo.parallel_env(agents={"a": {}, "b": {}}, **STUDIO)
    single.reset(seed=1)
    others = zoo.vector_env(2, agents={"b": {}, "a": {}}, **STUDIO)
    others.reset(seed=1)
    for given, told in (
        (saved[:1], "expected a list of 2"),
        ([saved[0], b""], re.escape("snapshots[1]: snapshot refused: it is empty")),
        ([saved[0], saved[1][:-3]], re.escape("snapshots[1]: snapshot refused: its check sum")),
        ([single.snapshot(), None], re.escape("snapshots[0]: snapshot refused")),
        (others.snapshot(), "of agents"),
    ):
        with pytest.raises(dwell.ConfigError, match=told):
            many.restore(given)
    assert many.state_hashes() == before


def test_masks_are_each_agents_own() -> None:
    agents: dict[str, Any] = {"a": {"actions": ["stop", "open", "pick"]}, "b": {}, "c": {}}
    env = zoo.parallel_env(agents=agents, action_mask=True, **HOME)
    _, infos = env.reset(seed=3)
    many = zoo.vector_env(1, agents=agents, action_mask=True, **HOME)
    _, told = many.reset(seed=[3])
    # What the engine says of each agent alone, whatever the forms: nothing is in a hand yet.
    for name in agents:
        mask = infos[name]["action_mask"]
        assert mask.shape == (env.action_space(name).n,)
        assert np.array_equal(told[name]["action_mask"][0], mask)
        names = env.action_names(name)
        if "drop" in names:
            assert mask[names.index("drop")] == 0
            assert mask[names.index("move_forward")] == 1
        assert mask[names.index("stop")] == 1


def test_rewards_are_shared_within_a_team() -> None:
    agents: dict[str, Any] = {
        "a": {"team": "red"},
        "b": {"team": "red"},
        "c": {"team": "blue"},
    }

    def rewards(share: float) -> dict[str, float]:
        env = zoo.parallel_env("PointNav", agents=agents, shared_reward=share, **HOME)
        env.reset(seed=3)
        found: dict[str, float] = env.step(dict.fromkeys(agents, 1))[1]
        return found

    own, half, all_shared = rewards(0.0), rewards(0.5), rewards(1.0)
    red = 0.5 * (own["a"] + own["b"])
    assert own["a"] != own["b"]
    assert all_shared == pytest.approx({"a": red, "b": red, "c": own["c"]})
    assert half["a"] == pytest.approx(0.5 * own["a"] + 0.5 * red)


def test_scripted_agents_act_and_are_in_nobodys_list() -> None:
    agents: dict[str, Any] = {"own": {}, "other": {"scripted": True}}
    env = zoo.parallel_env("PointNav", agents=agents, **HOME)
    observations, _ = env.reset(seed=3)
    assert env.possible_agents == ["own"] == list(observations)
    assert env.state_space.shape == (26,)
    before = env.agent_states()["other"]["position"]
    for _ in range(20):
        env.step({"own": 6})
    moved = np.subtract(env.agent_states()["other"]["position"], before)
    assert np.linalg.norm(moved) > 0.5
    with pytest.raises(dwell.ConfigError, match="scripted"):
        zoo.parallel_env(agents={"a": {"scripted": True}}, **HOME)
    many = zoo.vector_env(2, "PointNav", agents=agents, **HOME)
    many.reset(seed=3)
    assert list(many.batched_action_spaces) == ["own"]
    _, rewards, *_ = many.step(many.expert_actions())
    assert list(rewards) == ["own"]


def test_a_snapshot_is_of_agents_by_their_names() -> None:
    env = zoo.parallel_env(agents={"a": {}, "b": {}}, **STUDIO)
    env.reset(seed=1)
    env.step({"a": 1, "b": 0})
    for names in ("ba", "a"):
        other = zoo.parallel_env(agents={name: {} for name in names}, **STUDIO)
        with pytest.raises(dwell.ConfigError, match=r"of agents \['a', 'b'\]"):
            other.restore(env.snapshot())


def test_a_vector_says_when_it_has_no_episodes() -> None:
    many = zoo.vector_env(2, **STUDIO)
    calls = (many.state, many.state_hashes, lambda: many.goals(0))
    for call in calls:
        with pytest.raises(dwell.UsageError, match="no episode of environments"):
            call()
    many.reset(seed=1)
    for call in calls:
        call()
    many.close()
    for call in calls:
        with pytest.raises(dwell.UsageError, match="closed"):
            call()


def test_options_are_read_and_refused_as_those_of_one_agent() -> None:
    """``episode_ids`` and ``episode`` were passed over in silence."""
    one = zoo.parallel_env("Free", **STUDIO)
    _, infos = one.reset(seed=1)
    for env in (one, zoo.env("Free", **STUDIO)):
        for name in ("episode_ids", "episode", "seed"):
            told = f"options: no '{name}'; allowed are house and episode_id"
            with pytest.raises(dwell.ConfigError, match=told):
                env.reset(options={name: 1})
        # As PettingZoo's own tests do.
        env.reset(seed=0, options={"options": 1})
        env.reset(options={"episode_id": infos["agent_0"]["episode_id"]})


def test_who_takes_turns_and_has_none_left_is_told() -> None:
    """It was an assertion without a word."""
    env = zoo.env("Free", max_cycles=1, **STUDIO)
    env.reset(seed=1)
    for _ in range(2):
        env.step(0)
    told = "step: the episode of agent_0 has ended; its action is 0, expected None"
    with pytest.raises(dwell.UsageError, match=told):
        env.step(0)
    for _ in range(2):
        env.step(None)
    assert env.agents == []


@pytest.mark.long
def test_a_wrong_action_is_refused_in_the_turn_of_its_agent() -> None:
    env = zoo.env("Free", agents={"a": {}, "b": {}}, **STUDIO)
    env.reset(seed=4)
    for wrong in (99, "x"):
        with pytest.raises(dwell.ConfigError, match="agent a: action is"):
            env.step(wrong)
        assert env.agent_selection == "a"
    env.step(1)
    assert env.agent_selection == "b"
    env.step(2)
    assert env.agent_selection == "a"
    with pytest.raises(dwell.ConfigError, match="agent is 'nobody'; allowed are a, b"):
        env.observe("nobody")


def test_the_pair_that_cooperates_ends_together() -> None:
    env = zoo.parallel_env(
        "Cooperate",
        agents={"guide": {"voice": True}, "follower": {}},
        houses="builtin:apartment",
        sensors=["heard_tokens"],
    )
    env.reset(seed=0)
    spoke = False
    while env.agents:
        infos = env.step(env.expert_actions())[4]
        spoke = spoke or infos["guide"]["speaks"]
    assert spoke
    assert infos["guide"]["success"] == infos["follower"]["success"] is True


def test_words_are_heard_by_those_who_listen() -> None:
    env = zoo.parallel_env(
        "Free",
        agents={"anna": {"voice": {"words": ["sofa", "bed"], "max_tokens": 2}}, "ben": {}},
        houses="builtin:studio",
        sensors=["heard_tokens", "heard_directions"],
        actions=["wait"],
        max_cycles=60,
    )
    assert env.words("anna") == ["", "sofa", "bed"]
    env.reset(seed=5)
    said = {"action": 0, "say": {"tokens": np.array([1, 2])}}
    silent = {"action": 0, "say": {"tokens": np.array([0, 0])}}
    heard, spoke = [], []
    action = said
    while env.agents:
        observations, _, _, _, infos = env.step({"anna": action, "ben": 0})
        action = silent
        heard += [token for token in observations["ben"]["heard_tokens"].tolist() if token]
        spoke.append(infos["anna"]["speaks"])
        assert not observations["anna"]["heard_tokens"].any()
        for name, observation in observations.items():
            assert observation in env.observation_space(name)
    assert len(heard) == 2
    # A token takes 0.43 to 0.5 s.
    assert 16 <= sum(spoke) <= 20


def test_agents_with_voices_speak_as_the_world_says() -> None:
    env = zoo.parallel_env("Free", agents=2, houses="builtin:studio", sensors=["heard_tokens"])
    env.reset(seed=5)
    world = env.world
    assert world.say(0, "the red sofa", effort="loud")
    assert world.speaks(0)
    assert not world.say(0, [5])
    found = []
    for _ in range(60):
        env.step(dict.fromkeys(env.agents, 6))
        found += world.heard(1)
    assert len(found) == 3
    assert {row["speaker"] for row in found} == {0}
    assert all(0.0 <= row["sti"] <= 1.0 and row["level_db"] > 30.0 for row in found)


@pytest.mark.parametrize("task", ["Cooperate", "PiedPiper", "SocialNav", "HideAndSeek", "Carry"])
def test_gymnasium_says_who_has_tasks_of_several_agents(task: str) -> None:
    told = rf"{task} is a task of several agents, .* dwell\.pettingzoo\.parallel_env\('{task}'"
    for make in (gymnasium.make, gymnasium.make_vec):
        with pytest.raises(dwell.UsageError, match=told):
            make(f"dwell/{task}-v0", houses="builtin:studio")


def test_a_limit_of_steps_is_called_max_cycles() -> None:
    told = "no argument 'max_episode_steps'; here it is called max_cycles"
    for make in (zoo.parallel_env, lambda **settings: zoo.vector_env(2, **settings)):
        with pytest.raises(dwell.ConfigError, match=told):
            make(max_episode_steps=5)
