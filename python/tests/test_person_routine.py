"""Routines of people."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dwell
from dwell import World
from dwell.person_routine import PersonRoutine
from dwell.pettingzoo import parallel_env

DAY = {
    "07:00": "Go to the kitchen, then open the fridge.",
    "07:10": "Find the sofa.",
    "07:20": "Go to the bathroom.",
    "12:00": "Switch off the television.",
}


def home() -> World:
    return World("builtin:apartment", agents=[{"kind": "person"}])


def played(routine: PersonRoutine, world: World, reports: int, most: int = 2500) -> int:
    """Steps until so many errands have ended."""
    for step in range(most):
        if len(routine.reports) >= reports:
            return step
        world.do(routine.next_action())
    raise AssertionError(f"{len(routine.reports)} of {reports} errands in {most} steps")


def test_errands_are_done_from_their_time_on() -> None:
    world = home()
    routine = PersonRoutine(world, DAY, start="06:59", hours_per_s=1.0 / 60.0)
    waits = 0
    while routine.errand is None:
        assert routine.hour < 7.0 + 1e-6 or waits
        world.do(routine.next_action())
        waits += 1
    # A minute of the day is a second of the world: twenty steps.
    assert 19 <= waits <= 22
    played(routine, world, 1)
    (report,) = routine.reports
    assert report.failure == ""
    assert report.errand.sentence == DAY["07:00"]
    # Its door swings against the person, who steps back.
    assert world.object("refrigerator_1")["openness"] >= 0.9
    assert world.check("You are in the kitchen.", agent=0)["answer"]["truth"]
    played(routine, world, 2)
    assert routine.reports[1].failure == ""
    # Its head turns to what it looks at until the errand is over.
    assert routine.errand is None


def test_of_errands_that_are_due_at_once_the_last_one_counts() -> None:
    world = home()
    routine = PersonRoutine(world, DAY, start="06:59", hours_per_s=1.0)
    played(routine, world, 1)
    # While it walked to the kitchen more than a day's errands came due.
    world.do(routine.next_action())
    assert routine.errand is not None
    assert (
        routine.errand.hour
        == max((row.hour for row in routine.errands if row.hour <= routine.hour), default=-1.0)
        or routine.errand == routine.errands[-1]
    )


@pytest.mark.parametrize(
    ("sentence", "claims"),
    [
        ("Bring the laptop to the kitchen.", ["The laptop is in the kitchen."]),
        ("Put the laptop on the bed.", ["The laptop is on the bed."]),
        (
            "If the television is on, switch it off, otherwise go to the kitchen.",
            ["The television is off.", "You are not in the kitchen."],
        ),
        (
            "If the television is off, go to the bathroom, otherwise go to the kitchen.",
            ["You are in the kitchen.", "The television is on."],
        ),
        ("Do not switch the television off, and go to the kitchen.", ["The television is on."]),
    ],
)
def test_an_errand_leaves_the_house_as_it_says(sentence: str, claims: list[str]) -> None:
    world = home()
    assert not all(world.check(claim, agent=0)["answer"]["truth"] for claim in claims[:1]) or (
        "not" in sentence
    )
    routine = PersonRoutine(world, {"08:00": sentence}, start="08:00")
    played(routine, world, 1)
    assert [report.failure for report in routine.reports] == [""]
    for _ in range(40):
        world.do("wait")
    for claim in claims:
        assert world.check(claim, agent=0)["answer"]["truth"], claim


def test_what_cannot_be_done_is_reported() -> None:
    world = home()
    day = {"08:00": "Find the piano.", "08:01": "Go to the bathroom."}
    routine = PersonRoutine(world, day, start="08:00")
    world.do(routine.next_action())
    assert [report.failure for report in routine.reports] == ["there is no 'the piano'"]


@pytest.mark.parametrize(
    ("day", "said"),
    [
        ({"25:00": "Find the sofa."}, "expected HH:MM"),
        ({"07:00": "The sofa is red."}, "expected a request"),
        ({"07:00": "Fly."}, r"^errands\[07:00\]: .*fly"),
        ({"07:00": "Find the sofa.", "07:10": ""}, r"^errands\[07:10\]: the text has no words"),
        ({7: "Find the sofa."}, "7"),
    ],
)
def test_wrong_errands_are_refused(day: Any, said: str) -> None:  # noqa: ANN401 - wrong on purpose
    with pytest.raises(dwell.ConfigError, match=said):
        PersonRoutine(home(), day)


def test_a_person_goes_about_its_day_among_other_agents() -> None:
    """As one of the agents of an environment: the routine gives its actions."""
    env = parallel_env(
        "Free",
        agents={"person": {"body": {"kind": "person"}}, "robot": {}},
        houses="builtin:apartment",
        sensors=["gps"],
        max_cycles=None,
    )
    env.reset(seed=3)
    names = dwell.world.actions()
    routine = PersonRoutine(env.world, {"07:00": "Go to the kitchen."}, start="07:00")
    place = np.asarray(env.agent_states()["robot"]["position"])
    for _ in range(900):
        if routine.reports:
            break
        env.step({"person": names.index(routine.next_action()), "robot": names.index("wait")})
    assert [report.failure for report in routine.reports] == [""]
    assert env.world.check("You are in the kitchen.", agent=0)["answer"]["truth"]
    assert np.allclose(place, env.agent_states()["robot"]["position"], atol=1e-3)
