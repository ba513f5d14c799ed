"""Who leads in PiedPiper: what they sound like, and where they walk."""

from __future__ import annotations

from typing import Any

import numpy as np

import dwell
from dwell.pettingzoo import DwellParallelEnv, parallel_env

SCRIPTED: dict[str, Any] = {"scripted": True, "sensors": []}
#: A house of two storeys.
HOUSE = "seed:1415"


def game(houses: str, **settings: object) -> DwellParallelEnv:
    return parallel_env(
        "PiedPiper",
        agents={"follower": {"sensors": ["gps"]}, "one": SCRIPTED, "other": SCRIPTED},
        houses=houses,
        task_settings=settings,
    )


def test_no_thing_of_the_house_sounds_as_who_leads() -> None:
    env = game("builtin:apartment")
    of_leaders = set()
    for seed in range(12):
        env.reset(seed=seed)
        sounds = [row for row in env.world.sounds() if row["on"]]
        things = {row["sound"]["signal"] for row in sounds if row["object"] is not None}
        leaders = {row["sound"]["signal"] for row in sounds if row["object"] is None}
        assert len(leaders) == 2
        # Two of the five are heard from things of the apartment.
        assert {"radio", "television"} <= things
        assert not leaders & things
        of_leaders |= leaders
    assert of_leaders == {"alarm", "kettle", "vacuum_cleaner"}


def test_sounds_of_things_are_drawn_where_there_are_no_others() -> None:
    env = game("builtin:apartment", sounds=["radio", "television"])
    env.reset(seed=0)
    sounds = [row for row in env.world.sounds() if row["on"] and row["object"] is None]
    assert {row["sound"]["signal"] for row in sounds} == {"radio", "television"}


def heights(env: DwellParallelEnv, seed: int, steps: int) -> np.ndarray[Any, Any]:
    """Heights of the agents' feet, m; shape (steps + 1, 3)."""
    env.reset(seed=seed)
    turn = dwell.world.actions().index("turn_left")
    rows = []
    for step in range(steps + 1):
        rows.append([own["position"][1] for own in env.agent_states().values()])
        if step < steps:
            env.step({"follower": turn})
    return np.array(rows)


def test_all_keep_to_one_storey_unless_they_are_asked_not_to() -> None:
    env = game(HOUSE, steps=400)
    floors = set()
    for seed in range(5):
        found = heights(env, seed, 150)
        # Part of a flight of stairs is a storey's, too.
        assert np.ptp(found) < 1.6, (seed, found.min(), found.max())
        floors.add(round(float(np.median(found))))
    assert len(floors) == 2
    env = game(HOUSE, steps=400, across_storeys=True)
    assert max(np.ptp(heights(env, seed, 0)) for seed in range(5)) > 2.0
