"""Tasks that expect an answer with stop: their action space, infos, files and evaluations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.vector.utils import concatenate, create_empty_array

import dwell
from dwell import _native
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder
from dwell.evaluation import differences, evaluate
from dwell.played_actions import said_action

pytestmark = pytest.mark.usefixtures("open_once")

TASK = "SoundLocalization"
FIELDS = ["azimuth", "class", "distance", "elevation"]
ERRORS = ["azimuth_error_deg", "elevation_error_deg", "angular_error_deg", "distance_error"]


def made(**settings: Any) -> DwellEnv:  # noqa: ANN401 - as of an environment
    return DwellEnv(TASK, houses="builtin:studio", sensors=["gps"], **settings)


def test_the_right_answer_is_a_success_and_infos_hold_its_errors() -> None:
    env = made()
    assert sorted(env.action_space["answer"]) == FIELDS  # type: ignore[index] # a Dict
    for seed in range(5):
        env.reset(seed=seed)
        action = env.expert_action()
        assert env.action_space.contains(action)
        wait = {**action, "action": env.actions().index("wait")}
        info = env.step(wait)[4]
        assert not set(info) & {*ERRORS, "class_correct"}
        _, reward, terminated, _, info = env.step(env.expert_action())
        assert terminated
        assert info["success"]
        assert reward == pytest.approx(2.49)
        assert all(info[name] < 0.1 for name in ERRORS)
        assert info["class_correct"] == 1.0
    env.reset(seed=1)
    action = env.expert_action()
    action["answer"]["azimuth"] = -action["answer"]["azimuth"]
    info = env.step(action)[4]
    turned = abs(2 * 180.0 * float(action["answer"]["azimuth"][0]))
    assert info["azimuth_error_deg"] == pytest.approx(min(turned, 360 - turned), abs=0.1)


def test_several_environments_answer_at_once() -> None:
    many = DwellVectorEnv(
        3, TASK, houses="builtin:studio", sensors=["gps"], autoreset_mode="Disabled"
    )
    many.reset(seed=3)
    actions = many.expert_actions()
    assert many.action_space.contains(actions)
    actions["action"] = np.array([0, 6, 0])
    actions["answer"]["class"] = (actions["answer"]["class"] + np.array([0, 0, 1])) % 8
    infos = many.step(actions)[4]
    assert infos["success"].tolist() == [True, False, False]
    assert infos["class_correct"][[0, 2]].tolist() == [1.0, 0.0]
    assert np.isnan(infos["class_correct"][1])


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"azimuth": [1.5]}, "answer: azimuth: expected numbers of shape (1,) from -1 to 1"),
        ({"azimuth": ["left"]}, "answer: azimuth"),
        ({"class": 8}, "allowed are 0 to 7"),
        ({"other": 1}, "answer has ['azimuth', 'class', 'distance', 'elevation', 'other']"),
    ],
)
def test_what_is_no_answer_is_refused(change: dict[str, Any], part: str) -> None:
    env = made()
    env.reset(seed=1)
    action = env.expert_action()
    with pytest.raises(dwell.ConfigError) as refused:
        env.step({**action, "answer": {**action["answer"], **change}})
    assert part in str(refused.value)
    with pytest.raises(dwell.ConfigError, match="expected a mapping with action, answer"):
        env.step(0)


@pytest.mark.long
def test_files_and_results_hold_answers(tmp_path: Path) -> None:
    env = ReplayRecorder(made(), tmp_path)
    env.reset(seed=2)
    env.step(env.unwrapped.expert_action())  # type: ignore[attr-defined] # a DwellEnv
    env.close()
    replay = dwell.Replay.read(tmp_path / "episode_0000.replay")
    assert replay.success
    assert replay.differences() == []
    settings: dict[str, Any] = {"task": TASK, "houses": "builtin:studio", "count": 6, "seed": 1}
    result = evaluate("expert", **settings)
    assert result["metrics"]["success"]["mean"] == 1.0
    assert result["metrics"]["angular_error_deg"]["mean"] < 0.1
    assert differences(result) == []
    guessed = evaluate("random", **settings)
    assert guessed["metrics"]["angular_error_deg"]["mean"] > 20
    assert differences(guessed) == []
    guessed["episodes"][2]["answer"]["azimuth"] += 0.5
    assert any("episodes[2]" in sentence for sentence in differences(guessed))


def known(infos: dict[str, Any], k: int) -> set[str]:
    """The keys that a vector's masks say one of its environments has."""
    return {key for key in infos if not key.startswith("_") and infos[f"_{key}"][k]}


@pytest.mark.parametrize("task", [TASK, "Free", "PointNav", "SemanticAudioNav"])
def test_a_vector_knows_the_keys_that_single_environments_have(task: str) -> None:
    settings: dict[str, Any] = {"houses": "builtin:apartment", "sensors": ["gps"]}
    many = DwellVectorEnv(2, task, **settings)
    singles = [DwellEnv(task, **settings) for _ in range(2)]
    many.reset(seed=4)
    for k, single in enumerate(singles):
        single.reset(seed=4 + k)
    one = singles[0]
    for names in (("turn_left", "turn_left"), ("stop", "move_forward")):
        rows = [said_action(name, one) for name in names]
        empty = create_empty_array(many.single_action_space, 2)
        infos = many.step(concatenate(many.single_action_space, rows, empty))[4]
        for k, (single, row) in enumerate(zip(singles, rows, strict=True)):
            info = single.step(row)[4]
            assert known(infos, k) == {*info}
            for key, value in info.items():
                assert infos[key][k] == value, key


def test_questions_are_answered_by_words_of_a_closed_list() -> None:
    env = DwellEnv("EmbodiedQA", houses="builtin:studio", sensors=["question", "question_tokens"])
    words = env.answer_choices()["answer"]
    assert len(set(words)) == len(words)
    assert env.action_space["answer"]["answer"].n == len(words)  # type: ignore[index] # a Dict
    assert words == DwellEnv("EmbodiedQA", houses="seed:3").answer_choices()["answer"]
    for seed in range(4):
        observation, info = env.reset(seed=seed)
        assert env.observation_space.contains(observation)
        assert observation["question"] == env.instruction()
        assert observation["question"].endswith("?")
        tokens = observation["question_tokens"].tolist()
        vocabulary = _native.vocabulary()
        spoken = [vocabulary[token - 1] for token in tokens if token]
        assert "".join(spoken) == observation["question"].lower().replace(" ", "")
        kinds = {"yes": {"existence", "comparison", "state"}, "1": {"count"}}
        action = env.expert_action()
        word = words[action["answer"]["answer"]]
        assert info["goal_kind"] in kinds.get(word, {info["goal_kind"]})
        stop = {**action, "action": 0}
        assert env.step({**stop, "action": 6})[4].keys() >= {"min_distance_to_goal"}
        _, _, terminated, _, info = env.step(stop)
        assert terminated
        assert info["success"]
        assert info["answer_correct"] == 1.0
