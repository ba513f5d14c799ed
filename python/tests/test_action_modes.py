"""Forms of actions: their spaces, what they do, their masks, and how files hold them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector.utils import iterate

import dwell
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder, VectorReplayRecorder
from dwell.envs.action_modes import ACTION_MODES

pytestmark = pytest.mark.usefixtures("open_once")

MODES = list(ACTION_MODES)
FIVE = ["stop", "move_forward", "turn_left", "turn_right", "pick"]


@pytest.mark.parametrize("mode", MODES)
def test_several_environments_play_what_single_ones_play(mode: str) -> None:
    settings: dict[str, Any] = {"sensors": ["gps", "compass"], "action_mode": mode}
    many = DwellVectorEnv(2, "Free", houses="builtin:studio", **settings)
    singles = [DwellEnv("Free", houses="builtin:studio", **settings) for _ in range(2)]
    many.reset(seed=4)
    for k, single in enumerate(singles):
        single.reset(seed=4 + k)
    many.action_space.seed(5)
    for _ in range(12):
        actions = many.action_space.sample()
        rows = list(iterate(many.action_space, actions))
        # The episode ends with stop.
        if any(says_stop(mode, row) for row in rows):
            continue
        _, _, _, _, infos = many.step(actions)
        for k, (single, row) in enumerate(zip(singles, rows, strict=True)):
            info = single.step(row)[4]
            assert info["action_error"] == infos["action_error"][k]
            assert single.state_hash() == many.state_hashes()[k]


def says_stop(mode: str, action: Any) -> bool:  # noqa: ANN401 - of an action space
    """Whether an element of an action space declares the task done."""
    match mode:
        case "discrete":
            return bool(action == 0)
        case "velocity":
            return bool((np.abs(action) < 0.05).all())
        case "dict":
            return bool(action["stop"] == 1)
    return bool(action["action"] == 0)


@pytest.mark.parametrize("mode", MODES)
def test_the_expert_arrives_in_every_mode(mode: str) -> None:
    env = DwellEnv("PointNav", houses="builtin:apartment", sensors=["gps"], action_mode=mode)
    for seed in (1, 2):
        env.reset(seed=seed)
        for _ in range(500):
            action = env.expert_action()
            assert env.action_space.contains(action)
            _, _, ended, _, info = env.step(action)
            if ended:
                break
        assert info["success"]


def test_stop_by_velocities_and_by_dict() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], action_mode="velocity")
    env.reset(seed=1)
    assert not env.step(np.array([0.05, 0, 0, 0], np.float32))[2]
    assert env.step(np.full(4, 0.049, np.float32))[2]
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], action_mode="dict")
    env.reset(seed=1)
    rest = {
        "base": np.zeros(3, np.float32),
        "head": np.zeros(1, np.float32),
        "hand": 0,
        "pixel": np.full(2, 0.5, np.float32),
        "stop": 0,
    }
    assert not env.step(rest)[2]
    assert env.step(rest | {"stop": 1})[2]


@pytest.mark.parametrize(
    ("mode", "action", "part"),
    [
        ("discrete", 12, "action is 12; allowed are whole numbers from 0 to 11"),
        ("velocity", [0.0, 0.0, 2.0, 0.0], "action: expected numbers of shape (4,) from -1 to 1"),
        ("velocity", [0.0, np.nan, 0.0, 0.0], "from -1 to 1"),
        ("velocity", [0.0, 0.0], "found float64 of shape (2,)"),
        ("pointer", {"action": 1}, "action has ['action']; expected ['action', 'pixel']"),
        ("pointer", {"action": 1, "pixel": [0.5, -0.1]}, "pixel: expected numbers"),
        ("pointer", 3, "action is 3; expected a mapping with action, pixel"),
        ("object", {"action": 99, "object": 1}, "allowed are 0 to 17"),
        ("object", {"action": 1, "object": -1}, "allowed are 0 to"),
        ("object", {"action": 1, "object": "mug"}, "object: expected whole numbers"),
        ("object", {"action": 1, "object": [[1], [1, 2]]}, "expected whole numbers"),
        ("object", {"action": 1, "object": np.ma.masked_array(30, True)}, "expected whole numbers"),
    ],
)
def test_what_is_no_action_is_refused(mode: str, action: object, part: str) -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], action_mode=mode)
    env.reset(seed=1)
    before = env.state_hash()
    with pytest.raises(dwell.ConfigError) as refused:
        env.step(action)
    assert part in str(refused.value)
    assert env.state_hash() == before
    env.step(env.action_space.sample())


@pytest.mark.parametrize(
    ("settings", "part"),
    [
        ({"action_mode": "fly"}, "action_mode is 'fly'; allowed are discrete, velocity"),
        ({"action_mode": ["discrete"]}, "action_mode is ['discrete']"),
        ({"actions": ["jump"]}, 'no discrete action "jump"'),
        ({"actions": []}, "at least one action"),
        ({"actions": ["wait", "wait"]}, "wait twice"),
        ({"action_mode": "velocity", "actions": ["wait"]}, "velocities are all it has"),
        ({"action_mode": "velocity", "action_mask": True}, "velocity has no actions to mask"),
        ({"action_mask": 1}, "action_mask"),
    ],
)
def test_settings_of_actions_are_checked(settings: dict[str, Any], part: str) -> None:
    with pytest.raises(dwell.ConfigError) as refused:
        DwellEnv("Free", houses="builtin:studio", sensors=["gps"], **settings)
    assert part in str(refused.value)


def test_actions_are_those_that_were_named() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], actions=FIVE)
    assert env.actions() == FIVE
    assert env.action_space == gymnasium.spaces.Discrete(5)
    env.reset(seed=1)
    yaw = env.agents()[0]["yaw_rad"]
    env.step(2)
    assert env.agents()[0]["yaw_rad"] == pytest.approx(yaw + np.radians(9), abs=1e-5)
    walker = DwellEnv("PointNav", houses="builtin:apartment", sensors=["gps"], actions=["stop"])
    walker.reset(seed=1)
    with pytest.raises(dwell.UsageError, match="none of the environment's actions: stop"):
        walker.expert_action()


def test_masks_stand_in_infos_and_samples_keep_to_them() -> None:
    settings: dict[str, Any] = {"sensors": ["gps"], "actions": FIVE, "action_mask": True}
    env = DwellEnv("Free", houses="builtin:studio", **settings)
    _, info = env.reset(seed=1)
    assert info["action_mask"].dtype == np.int8
    assert info["action_mask"].tolist() == [1, 1, 1, 1, 0]
    env.action_space.seed(1)
    sampled = {int(env.action_space.sample(info["action_mask"])) for _ in range(60)}
    assert sampled == {0, 1, 2, 3}
    assert "action_mask" in env.step(1)[4]
    made = gymnasium.make(
        "dwell/Free-v0", houses="builtin:studio", disable_env_checker=True, **settings
    )
    check_env(made.unwrapped)
    many = DwellVectorEnv(2, "Free", houses="builtin:studio", **settings)
    _, infos = many.reset(seed=1)
    assert infos["action_mask"].shape == (2, 5)
    assert infos["action_mask"][0].tolist() == info["action_mask"].tolist()
    assert many.step([1, 2])[4]["_action_mask"].all()


@pytest.mark.parametrize("mode", ["object", "pointer", "dict"])
def test_masks_of_targets_rule_out_what_fails_on_everything(mode: str) -> None:
    env = DwellEnv(
        "Free", houses="builtin:studio", sensors=["instance"], action_mode=mode, action_mask=True
    )
    _, info = env.reset(seed=4)
    field = "hand" if mode == "dict" else "action"
    choices = env.action_space[field]  # type: ignore[index] # a Dict
    hands = {"pick", "place", "drop", "open", "close", "toggle", "push", "put_in", "throw"}
    names = ["", *(name for name in env.actions() if name in hands)]
    names = names if mode == "dict" else env.actions()
    ids = [1, 2, *(thing["id"] for thing in env.world.objects())]

    def succeeds(number: int, target: object) -> bool:
        before = env.snapshot()
        parts = env.action_space.spaces.items()  # type: ignore[attr-defined] # a Dict
        action = {key: np.zeros(part.shape, part.dtype) for key, part in parts}
        action |= {field: number, "object" if mode == "object" else "pixel": target}
        code = env.step(action)[4]["action_success"]
        env.restore(before)
        return bool(code)

    assert info["action_mask"].dtype == np.int8
    assert info["action_mask"].shape == (choices.n,)
    pixels = [np.float32([x, y]) for x in (0.2, 0.5, 0.8) for y in (0.3, 0.5, 0.7, 0.9)]
    seen = 0
    for number, possible in enumerate(info["action_mask"].tolist()):
        if possible or (mode != "dict" and names[number] not in hands):
            continue
        seen += 1
        assert not any(succeeds(number, target) for target in (ids if mode == "object" else pixels))
    assert 0 < seen < len(names)


@pytest.mark.parametrize("mode", MODES)
def test_what_was_recorded_is_played_again(mode: str, tmp_path: Path) -> None:
    settings: dict[str, Any] = {"sensors": ["gps"], "action_mode": mode}
    one = ReplayRecorder(DwellEnv("Free", houses="builtin:studio", **settings), tmp_path / "one")
    one.reset(seed=2)
    one.action_space.seed(3)
    many = VectorReplayRecorder(
        DwellVectorEnv(2, "Free", houses="builtin:studio", **settings), tmp_path / "many"
    )
    many.reset(seed=2)
    many.action_space.seed(3)
    for _ in range(8):
        action = one.action_space.sample()
        if not says_stop(mode, action):
            one.step(action)
        actions = many.action_space.sample()
        if not any(says_stop(mode, row) for row in iterate(many.action_space, actions)):
            many.step(actions)
    one.close()
    many.close()
    files = [*(tmp_path / "one").iterdir(), *(tmp_path / "many").iterdir()]
    assert len(files) == 3
    for file in files:
        replay = dwell.Replay.read(file)
        assert replay.actions
        assert replay.differences() == []


def test_a_file_with_a_wrong_action_names_it(tmp_path: Path) -> None:
    env = ReplayRecorder(
        DwellEnv("Free", houses="builtin:studio", sensors=["gps"], action_mode="pointer"), tmp_path
    )
    env.reset(seed=2)
    env.step({"action": 1, "pixel": np.array([0.25, 0.5], np.float32)})
    env.close()
    file = tmp_path / "episode_0000.replay"
    written = file.read_text("utf-8")
    assert '"version": 3' in written
    file.write_text(written.replace("0.25", "2.5"), "utf-8")
    with pytest.raises(dwell.MeasuredDataError, match=r"actions\[0\]: pixel"):
        dwell.Replay.read(file)


def test_actions_that_a_mode_cannot_leave_out_are_refused() -> None:
    settings: dict[str, Any] = {"houses": "builtin:studio", "sensors": ["gps"]}
    body = ["stop", "move_forward", "turn_left", "turn_right", "look_up", "look_down"]
    for make in (DwellEnv, lambda *args, **kwargs: DwellVectorEnv(2, *args, **kwargs)):
        with pytest.raises(dwell.ConfigError, match="actions have no stop, move_forward, turn_le"):
            make("Free", action_mode="dict", actions=["pick"], **settings)
        with pytest.raises(dwell.ConfigError, match="actions have no look_down; in the action_mo"):
            make("Free", action_mode="dict", actions=[*body[:-1], "pick"], **settings)
        with pytest.raises(dwell.ConfigError, match="velocities are all it has"):
            make("Free", action_mode="velocity", actions=["pick"], **settings)
    env = DwellEnv("Free", action_mode="dict", actions=[*body, "pick"], **settings)
    assert env.action_space["hand"].n == 2  # type: ignore[index] # a Dict
