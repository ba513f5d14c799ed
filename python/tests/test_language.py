"""Sentences from Python and the command line: read, said, checked, grounded."""

from __future__ import annotations

import json
from typing import Any

import pytest

import dwell
from dwell import cli
from dwell.language import read, say

HOUSE = "builtin:apartment"


@pytest.fixture(scope="module")
def world() -> dwell.World:
    return dwell.World(HOUSE, agents=1)


def test_forms_come_back_as_they_were() -> None:
    for text in (
        "There are two red chairs in the kitchen.",
        "The lamp on the table but not next to the bed is open.",
        "Pick up the mug, then put the mug on the table.",
        "How many chairs in the kitchen are there?",
    ):
        form = read(text)[0]
        assert say(form) == text
        assert form in read(say(form, seed=3))
        # A form is plain data: it can be stored.
        assert say(json.loads(json.dumps(form))) == text


def test_what_is_not_understood_says_where() -> None:
    with pytest.raises(dwell.ConfigError, match=r'unknown word "chiar" \(known are chair'):
        read("find the chiar")
    with pytest.raises(dwell.ConfigError, match=r'understood as far as "the chair on"'):
        read("the chair on is")
    with pytest.raises(dwell.ConfigError, match="allowed are 4096"):
        read("the left of " * 10_000)
    for wrong in ({}, {"claim": {"exists": "x"}}, {"claim": {"exists": {"id": -1}}}):
        with pytest.raises(dwell.ConfigError):
            say(wrong)
    unsaid = {"claim": {"exists": "hole"}}
    with pytest.raises(dwell.ConfigError, match="no words for the form"):
        say(unsaid)


def test_sentences_of_eighty_words_are_read_with_their_full_stop() -> None:
    words = ["there", "is", "a", "chair", "on", "the", "left", "of", "the", "red", "chair"]
    with pytest.raises(dwell.ConfigError, match="understood as far as"):
        read(" ".join((words * 8)[:80]) + ".")
    with pytest.raises(dwell.ConfigError, match="the text has 81 words; allowed are 80"):
        read(" ".join((words * 8)[:81]) + ".")


@pytest.mark.parametrize("text", ["The bed is bed.", "The sofa is rug."])
def test_an_is_is_no_genitive(text: str) -> None:
    with pytest.raises(dwell.ConfigError, match="nothing is defined that it could mean"):
        read(text)
    assert say(read("Find the plant's pot.")[0]) == "Find the pot from the plant."


def test_the_listener_is_an_agent(world: dwell.World) -> None:
    answer = world.check("You are in the kitchen.", viewer=0)["answer"]
    assert answer["reason"] == "It is about who is spoken to, and no agent is given."


def test_persons_are_among_the_people_of_a_house() -> None:
    world = dwell.World("builtin:studio", agents=[{"kind": "person"}, {}])
    (room,) = (
        name for name in ("studio", "bathroom") if world.holds("in_room", "agent:0", f"room:{name}")
    )
    assert world.check(f"There is a person in the {room}.")["answer"]["truth"] is True
    assert world.check("How many people are there?")["answer"] == {"number": 1}
    who = world.check(f"Who is in the {room}?")["answer"]["things"]
    assert [thing["name"] for thing in who] == ["agent:0"]


def test_what_is_not_decided_has_its_reason() -> None:
    answer = dwell.World(HOUSE).check("What is the largest thing in the kitchen?")["answer"]
    assert "too close in the order to be told apart" in answer["reason"]


def test_claims_are_those_of_the_predicates(world: dwell.World) -> None:
    names = {thing["name"]: thing for thing in world.objects()}
    on = [row for row in world.relations(["on"]) if row[0] in names and row[2] in names]
    assert on
    for above, _, below in on:
        ids = names[above]["id"], names[below]["id"]
        found = world.check(f"object {ids[0]} is on object {ids[1]}")["answer"]
        assert found["truth"] is True
        things = found["witnesses"][0]["things"]
        assert [thing["name"] for thing in things] == [above, below]
        swapped = world.check(f"object {ids[1]} is on object {ids[0]}")["answer"]
        assert swapped["truth"] is world.holds("on", below, above)


def test_phrases_carry_the_ids_that_they_mean(world: dwell.World) -> None:
    found = world.check("there is no bed in the kitchen")
    assert found["said"] == "There is no bed in the kitchen."
    spans = {found["said"][row["start"] : row["end"]]: row["things"] for row in found["phrases"]}
    assert [thing["kind"] for thing in spans["the kitchen"]] == ["room"]
    assert spans["no bed in the kitchen"] == []
    assert found["answer"]["truth"] is True


def test_left_and_right_need_somebody_who_looks(world: dwell.World) -> None:
    claim = "a chair is to the left of a table"
    undecided = world.check(claim)["answer"]
    assert undecided["truth"] is None
    assert "viewer" in undecided["reason"]
    assert world.check("you are in the kitchen", agent=0)["answer"]["truth"] in (True, False)
    with pytest.raises(dwell.ConfigError, match="agent is -1"):
        world.check(claim, agent=-1)
    with pytest.raises(dwell.ConfigError, match="sentence is 5"):
        world.check(5)  # type: ignore[arg-type]


def test_the_command_prints_a_verdict_for_each_sentence(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def printed(*args: str) -> tuple[int, str, str]:
        code = cli.main(["check-text", HOUSE, *args])
        streams = capsys.readouterr()
        return code, streams.out, streams.err

    code, out, _ = printed("There is a bed.", "How many beds are there?", "Go to the kitchen.")
    lines = out.splitlines()
    assert code == 0
    assert lines[0].startswith("There is a bed. true (double_bed_1")
    assert lines[1].split()[-1].isdigit()
    assert lines[2] == "Go to the kitchen. is a request."
    code, out, err = printed("There is a bed.", "There is a bedd.")
    assert code == 1
    assert 'unknown word "bedd"' in err
    code, out, _ = printed("--json", "--view", "0", "Is there a bed?")
    found: dict[str, Any] = json.loads(out)
    assert found["rows"][0]["claims"][0]["answer"]["truth"] is True
    assert printed("--view", "99", "There is a bed.")[0] == 1
