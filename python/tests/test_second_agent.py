"""The demo's second agent: heard before it is seen, out of what is measured."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.demo import page, second_agent

pytestmark = pytest.mark.usefixtures("open_once")


@pytest.fixture(scope="module")
def meeting(apartment: dwell.House, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return second_agent.meet(apartment, tmp_path_factory.mktemp("meeting"))


@pytest.mark.long
def test_it_is_heard_before_it_is_seen(meeting: dict[str, Any]) -> None:
    heard, seen = meeting["heard"], meeting["seen"]
    assert heard["step"] < seen["step"]
    assert heard["pixels"] == 0 < seen["pixels"]
    assert {len(way) for way in meeting["ways"]} == {meeting["steps"] + 1}
    lines = [what for _, who, what in meeting["told"] if who == second_agent.LISTENER]
    assert lines[0].startswith("hears ")
    order = [line.startswith("sees ") for line in lines]
    assert sum(order) == 1
    assert order.index(True) > 0


def test_its_words_are_what_makes_it_louder_at_both_ears(meeting: dict[str, Any]) -> None:
    levels_db = np.array(meeting["levels_db"])
    begins = next(step for step, _, what in meeting["told"] if what.startswith("says "))
    before = levels_db[begins - 4 : begins].mean(axis=0)
    until = meeting["heard"]["step"]
    assert (levels_db[begins + 1 : until].max(axis=0) > before + 6.0).all()


def test_pixels_are_those_of_the_other_alone(apartment: dwell.House) -> None:
    world = dwell.World(apartment, agents=2)
    x, y, z = apartment.rooms()[0]["stand"]
    number = second_agent._instance_id(world, second_agent.OTHER)
    found = []
    # Ahead is -Z.
    for back in (-0.8, 0.8):
        world.place_agent((x, y, z), agent=0)
        world.place_agent((x, y, z + back), agent=1)
        found.append(second_agent._pixels(world, number))
    assert found[0] > 500
    assert found[1] == 0


def test_the_page_says_when(meeting: dict[str, Any], tmp_path: Path) -> None:
    text = page._second_agent(meeting)
    assert f"Heard first after {meeting['heard']['time_s']:g} s" in text
    assert f"Seen first after {meeting['seen']['time_s']:g} s" in text
    assert text.count("<polyline") == 2
    silent = {**meeting, "heard": None, "seen": None}
    assert "No word of it was heard. It did not come into view." in page._second_agent(silent)
    studio = second_agent.meet(dwell.House.open("builtin:studio"), tmp_path)
    assert "No room" in page._second_agent(studio)


@pytest.mark.long
def test_without_a_voice_nothing_is_heard(
    apartment: dwell.House, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dwell.World, "say", lambda *_, **__: False)
    monkeypatch.setattr(second_agent, "_MAX_STEPS", 45)
    told = second_agent.meet(apartment, tmp_path)
    assert told["heard"] is None
