"""Sentences that tell the true reason, and the nearest names."""

import gymnasium
import pytest

import dwell
from dwell.envs import DwellEnv


def test_a_joint_that_is_too_stiff_for_the_hand_is_told() -> None:
    world = dwell.World("builtin:studio", agents=[{"hand_effort": 0.01}])
    world.place_agent([2.52, 0.0, 5.42], 171.3)
    assert world.act("open", "refrigerator_1", fraction=0.4).code == "started"
    told = []
    for _ in range(200):
        world.step()
        told += [outcome for _, outcome in world.delayed_outcomes()]
    assert told
    assert all(outcome.code == "blocked" for outcome in told)
    assert all("the hand pulls with 0.01 N m" in outcome.sentence for outcome in told)
    assert world.object("refrigerator_1")["openness"] < 1e-6


def test_the_nearest_of_many_names_are_told() -> None:
    with pytest.raises(dwell.DwellError, match=r"of the \d+ the nearest are \[\"book_1\""):
        dwell.World("builtin:studio", laws=[{"id": "drag", "target": "book1"}])
    with pytest.raises(dwell.ConfigError, match=r"of the \d+ the nearest are \[\"sofa\""):
        DwellEnv("ObjectNav", houses="builtin:studio", task_settings={"classes": ["soffa"]})


@pytest.mark.parametrize("seed", range(4))
def test_the_expert_stops_though_its_stride_steps_over_the_goal(seed: int) -> None:
    env = gymnasium.make(
        "dwell/PointNav-v0",
        houses="builtin:apartment",
        sensors=["gps"],
        stride={"forward_m": 0.25, "turn_deg": 10.0},
        max_episode_steps=500,
    )
    env.reset(seed=seed)
    done = False
    while not done:
        _, _, ended, cut, info = env.step(env.unwrapped.expert_action())  # type: ignore[attr-defined]
        done = ended or cut
    assert info["success"]
