"""Questions to an oracle: their form in actions, and replies in observations and infos."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import dwell
from dwell import ConfigError
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder
from dwell.evaluation import evaluate
from dwell.language import question_tokens, vocabulary

pytestmark = pytest.mark.usefixtures("open_once")

WAIT = 6


@pytest.fixture(name="env")
def _env() -> Iterator[DwellEnv]:
    env = DwellEnv("Dialogue", houses="builtin:apartment", sensors=["reply", "reply_tokens"])
    yield env
    env.close()


def _asked(text: str) -> dict[str, object]:
    return {"action": WAIT, "ask": question_tokens(text)}


def test_a_question_is_answered_in_the_same_step_and_in_words(env: DwellEnv) -> None:
    observation, info = env.reset(seed=1)
    assert observation["reply"] == ""
    assert not observation["reply_tokens"].any()
    assert "reply" not in info
    assert info["goal_kind"].startswith("one_of_")
    observation, reward, *_, info = env.step(_asked("In which room is it?"))
    assert observation["reply"] == info["reply"] != ""
    said = [vocabulary()[token - 1] for token in observation["reply_tokens"] if token]
    assert " ".join(said) == info["reply"].lower().replace(".", " .")
    assert reward == pytest.approx(-0.11)
    assert info["questions_asked"] == 1
    observation, reward, *_, info = env.step(_asked(""))
    assert observation["reply"] == ""
    assert "reply" not in info
    assert reward == pytest.approx(-0.01)
    *_, info = env.step(_asked("of of of"))
    assert info["reply"] == "What do you mean?"
    assert info["questions_not_understood"] == 1


def test_the_room_that_is_told_is_that_of_the_thing(env: DwellEnv) -> None:
    for seed in range(6):
        _, info = env.reset(seed=seed)
        (meant,) = info["goal_objects"]
        *_, info = env.step(_asked("Is it in the kitchen?"))
        told = env.world.check(f"Object {meant} is in the kitchen.")["answer"]["truth"]
        expected = {True: "That is true.", False: "That is not true.", None: "I do not know."}
        assert info["reply"] == expected[told]


def test_wrong_questions_get_a_sentence(env: DwellEnv) -> None:
    env.reset(seed=1)
    with pytest.raises(ConfigError, match="expected \\['action', 'ask'\\]"):
        env.step({"action": WAIT})
    for ask in (np.zeros(15, np.int64), np.full(16, -1), np.full(16, 10**6), np.zeros(16), "red"):
        with pytest.raises(ConfigError, match="ask"):
            env.step({"action": WAIT, "ask": ask})
    with pytest.raises(ConfigError, match="'xyzzy' is no word"):
        question_tokens("Is it xyzzy?")
    with pytest.raises(ConfigError, match="17 words and marks; allowed are 16"):
        question_tokens("red " * 17)
    with pytest.raises(ConfigError, match="with the task Dialogue alone"):
        DwellEnv("PointNav", houses="builtin:studio", sensors=["reply"])


def test_a_vector_environment_asks_for_each() -> None:
    env = DwellVectorEnv(2, "Dialogue", houses="builtin:apartment", sensors=["reply"])
    env.reset(seed=3)
    nothing = np.zeros(16, np.int64)
    asked = np.stack([question_tokens("What color is it?"), nothing])
    observation, *_, infos = env.step({"action": np.array([WAIT, WAIT]), "ask": asked})
    assert observation["reply"][0] == infos["reply"][0] != ""
    assert observation["reply"][1] == infos["reply"][1] == ""
    assert infos["_reply"].tolist() == [True, False]
    assert env.action_space.contains(env.expert_actions())
    env.close()


@pytest.mark.long
def test_what_was_asked_is_in_recorded_files(tmp_path: Path) -> None:
    env = DwellEnv("Dialogue", houses="builtin:apartment", sensors=["reply"])
    recorded = ReplayRecorder(env, tmp_path)
    recorded.reset(seed=2)
    done, asks = False, 0
    while not done:
        action = env.expert_action()
        asks += bool(action["ask"].any())
        _, _, done, _, info = recorded.step(action)
    recorded.close()
    assert asks >= 1
    assert info["success"]
    (file,) = tmp_path.iterdir()
    replay = dwell.Replay.read(file)
    rows = [row for row in replay.actions if isinstance(row, dict) and "question" in row]
    assert len(rows) == asks
    assert replay.differences() == []


def test_gymnasium_makes_it() -> None:
    env = gymnasium.make("dwell/Dialogue-v0", houses="builtin:apartment", sensors=["reply"])
    _, info = env.reset(seed=4)
    assert isinstance(env.action_space, gymnasium.spaces.Dict)
    assert info["goal_kind"] in {f"one_of_{n}" for n in range(2, 7)}
    env.close()


@pytest.mark.long
def test_an_evaluation_keeps_what_was_asked() -> None:
    result = evaluate(
        "expert", task="Dialogue", houses="builtin:apartment", count=3, sensors=["reply"]
    )
    assert result["metrics"]["success"]["mean"] == 1.0
    assert all(row["questions_asked"] >= 1 for row in result["episodes"])
