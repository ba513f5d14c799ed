"""Episodes that draw parameters from intervals, as calibration found them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium
import pytest

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv

pytestmark = pytest.mark.usefixtures("open_once")

GRAVITY = "world/gravity_m_s2"
DRAG = "law/drag/c_d"
#: As ``dwell calibrate`` writes it.
FOUND: dict[str, Any] = {
    "laws": [
        {"id": "drag", "version": 1, "target": None, "params": {"c_d": 0.5}},
        {"id": "viscous_damping", "version": 1, "target": None, "params": {"linear_per_s": 0.1}},
    ],
    "parameters": {GRAVITY: 9.8},
    "intervals": {DRAG: [0.4, 0.6], GRAVITY: [9.7, 9.9]},
    "provenance": None,
}
INTERVALS: dict[str, list[float]] = {GRAVITY: [1.0, 2.0], DRAG: [0.4, 0.6]}


def drawn(world: dwell.World) -> tuple[float, float]:
    return tuple(world.parameter(address)["value"] for address in (GRAVITY, DRAG))  # type: ignore[return-value] # two


def test_what_is_wrong_in_a_file_is_said_of_randomize(tmp_path: Path) -> None:
    file = tmp_path / "found.json"
    file.write_text(json.dumps({**FOUND, "parameters": {GRAVITY: "9.8"}}))
    with pytest.raises(dwell.ConfigError, match=r"^randomize: .*found\.json: parameters"):
        dwell.World("builtin:studio", randomize=str(file))


def test_a_world_draws_by_its_seed(shoebox: dwell.House) -> None:
    worlds = [dwell.World(shoebox, seed=seed, randomize=INTERVALS) for seed in (0, 0, 1)]
    first, again, other = map(drawn, worlds)
    assert first == again != other
    for gravity, drag in (first, other):
        assert 1.0 <= gravity <= 2.0
        assert 0.4 <= drag <= 0.6
    # One parameter more draws nothing else of the others.
    alone = dwell.World(shoebox, seed=0, randomize={GRAVITY: [1.0, 2.0]})
    assert alone.parameter(GRAVITY)["value"] == first[0]


def test_episodes_draw_anew_and_an_episode_comes_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "found.json"
    path.write_text(json.dumps(FOUND), "utf-8")
    env = gymnasium.make(
        "dwell/PointNav-v0", houses="builtin:studio", sensors=["compass"], randomize=path
    )
    own = env.unwrapped
    assert isinstance(own, DwellEnv)
    seen = []
    for _ in range(3):
        _, info = env.reset(seed=5 if not seen else None)
        seen.append((info["episode_id"], drawn(own.world), own.state_hash()))
    assert len({values for _, values, _ in seen}) == 3
    for _, (gravity, drag), _ in seen:
        assert 9.7 <= gravity <= 9.9
        assert 0.4 <= drag <= 0.6
    # What was found and is not drawn is installed, too.
    assert own.world.parameter("law/viscous_damping/linear_per_s")["value"] == pytest.approx(0.1)
    episode_id, values, state = seen[1]
    env.reset(options={"episode_id": episode_id})
    assert (drawn(own.world), own.state_hash()) == (values, state)
    saved = own.snapshot()
    env.reset()
    own.restore(saved)
    assert drawn(own.world) == values


def test_findings_of_a_newer_release_are_refused(shoebox: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match="version is 2; this dwell reads 1"):
        dwell.World(shoebox, randomize={**FOUND, "version": 2})
    dwell.World(shoebox, randomize={**FOUND, "version": 1})


def test_vector_environments_draw_what_single_ones_do() -> None:
    settings: dict[str, Any] = {
        "houses": "builtin:studio",
        "sensors": ["compass"],
        "randomize": INTERVALS,
    }
    vector = DwellVectorEnv(2, "PointNav", **settings)
    _, infos = vector.reset(seed=7)
    single = DwellEnv("PointNav", **settings)
    for k in range(2):
        single.reset(options={"episode_id": infos["episode_id"][k]})
        assert drawn(single.world) == drawn(vector.world(k))


def test_what_is_told_goes_before_what_was_found(shoebox: dwell.House) -> None:
    own = [{"id": "drag", "version": 1, "params": {"c_d": 0.9}}]
    fixed = {**FOUND, "intervals": {}}
    world = dwell.World(shoebox, laws=own, parameters={GRAVITY: 3.0}, randomize=fixed)
    assert drawn(world) == (3.0, pytest.approx(0.9))
    # A value is stated or drawn.
    for randomize in (FOUND, {GRAVITY: [1.0, 2.0]}):
        with pytest.raises(dwell.ConfigError, match=f"found both for '{GRAVITY}'"):
            dwell.World(shoebox, parameters={GRAVITY: 3.0}, randomize=randomize)
    # Bounds of a parameter hold whatever the interval says.
    edge = dwell.World(shoebox, randomize={DRAG: [-1.0, 0.0]})
    assert edge.parameter(DRAG)["value"] == 0.0


@pytest.mark.parametrize(
    ("randomize", "told"),
    [
        ({GRAVITY: 9.0}, r"world/gravity_m_s2 is 9\.0; expected \[low, high\]"),
        ({GRAVITY: [2.0, 1.0]}, "low <= high"),
        ({GRAVITY: [float("nan"), 1.0]}, "nan"),
        ({"law/nope/x": [0.0, 1.0]}, "nope"),
        ({GRAVITY: [981.0, 982.0]}, "allowed is an interval that has something of 0 to 100"),
        ({DRAG: [-2.0, -1.0]}, "allowed is an interval that has something of 0 to 20"),
        ({**FOUND, "lows": 1}, "no field 'lows'"),
        (7, "randomize is 7"),
    ],
)
def test_intervals_that_are_none_are_refused(
    shoebox: dwell.House,
    randomize: object,
    told: str,
) -> None:
    with pytest.raises(dwell.DwellError, match=told):
        dwell.World(shoebox, randomize=randomize)  # type: ignore[arg-type] # what is refused


def test_a_file_of_intervals_is_named(shoebox: dwell.House, tmp_path: Path) -> None:
    path = tmp_path / "found.json"
    path.write_text("{junk", "utf-8")
    with pytest.raises(dwell.ConfigError, match=r"randomize: .*found\.json"):
        dwell.World(shoebox, randomize=path)
    with pytest.raises(dwell.ConfigError, match="randomize="):
        DwellEnv(world={"randomize": INTERVALS})
