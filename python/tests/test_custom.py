"""Tasks, rewards and sensors that are written in Python."""

from __future__ import annotations

import functools
import os
import pickle
import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import dwell
from dwell import _native
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.envs.snapshots import check_and_strip, with_checksum

pytestmark = pytest.mark.usefixtures("open_once")

STEPS = 40


class GoThere(dwell.Task):
    """To a random place; ends there, or with stop."""

    sensors = ("gps", "instruction")
    max_steps = 60

    def __init__(self, near_m: float = 0.4) -> None:
        self.near_m = near_m

    def left_m(self, world: dwell.World) -> float:
        here, goal = world.agents()[0]["position"], self.state["goal"]
        return float(np.hypot(here[0] - goal[0], here[2] - goal[2]))

    def reset(self, world: dwell.World, rng: np.random.Generator) -> dwell.TaskGoal:
        places = world.house.navigation().points(world.agents()[0]["position"])
        self.state["goal"] = places[rng.integers(len(places))].tolist()
        self.state["steps"] = 0
        return dwell.TaskGoal("Go there.", self.left_m(world))

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        self.state["steps"] += 1
        left_m = self.left_m(world)
        return dwell.StepResult(
            reward=-left_m,
            terminated=verdict.terminated or left_m < self.near_m,
            success=left_m < self.near_m,
            distance_m=left_m,
            info={"judged": self.state["steps"], "last": action},
        )

    def expert(self, world: dwell.World) -> str:
        return world.toward(self.state["goal"]) or "stop"


class Doubled(dwell.Reward):
    def reward(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> float:
        return 2.0 * verdict.reward


class Noisy(dwell.Sensor):
    name = "noisy"
    space = gymnasium.spaces.Box(-10.0, 10.0, (3,), np.float32)

    def reset(self, world: dwell.World) -> None:
        self.state["seen"] = 0

    def observe(self, world: dwell.World, rng: np.random.Generator) -> object:
        self.state["seen"] += 1
        return rng.normal(size=3)


class Number(dwell.Sensor):
    name = "number"
    space = gymnasium.spaces.Discrete(1000)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> object:
        return world.native.step_count


class Word(dwell.Sensor):
    name = "word"
    space = gymnasium.spaces.Text(10)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> object:
        return "abc"


ALL = ["gps", "instruction", Noisy, Number, Word]


def test_check_env_has_nothing_to_say_of_python_parts() -> None:
    dwell.register_task("tests/GoThere-v0", GoThere, reward=Doubled, sensors=ALL)
    check_env(gymnasium.make("tests/GoThere-v0", disable_env_checker=True).unwrapped)
    made = gymnasium.make("tests/GoThere-v0")
    assert made.spec is not None
    assert made.spec.max_episode_steps == 60
    made.close()
    with pytest.raises(dwell.ConfigError, match="registered already"):
        dwell.register_task("tests/GoThere-v0", GoThere)
    with pytest.raises(dwell.ConfigError, match="env_id"):
        dwell.register_task("no good id/ /", GoThere)


def play(env: DwellEnv, actions: list[int]) -> list[Any]:
    seen = []
    for action in actions:
        observation, reward, terminated, _, info = env.step(action)
        seen.append((observation, reward, terminated, info, env.state_hash()))
        if terminated:
            break
    return seen


def same(one: list[Any], other: list[Any]) -> bool:
    return pickle.dumps(one) == pickle.dumps(other)


def test_a_task_judges_rewards_double_and_infos_tell() -> None:
    env = DwellEnv(GoThere, sensors=ALL, reward=Doubled, task_settings={"near_m": 0.3})
    observation, _ = env.reset(seed=5)
    assert observation["instruction"] == "Go there."
    assert observation in env.observation_space
    goal = env._runner.plays[0]._parts()["task"].state["goal"]
    for number in range(1, 400):
        action = env.expert_action()
        observation, reward, terminated, _, info = env.step(action)
        here = env.agents()[0]["position"]
        left_m = float(np.hypot(here[0] - goal[0], here[2] - goal[2]))
        assert reward == pytest.approx(-2.0 * left_m, rel=1e-6)
        assert info["distance_to_goal"] == pytest.approx(left_m, rel=1e-6)
        assert (info["judged"], info["last"]) == (number, env.actions()[action])
        assert observation["number"] == number
        if terminated:
            break
    assert info["success"]
    assert 0.0 < info["spl"] <= 1.0
    with pytest.raises(dwell.UsageError, match="ended"):
        env.step(0)


def test_without_a_way_to_go_there_are_no_measures_of_it() -> None:
    class Stay(dwell.Task):
        def reset(self, world: dwell.World, rng: np.random.Generator) -> dwell.TaskGoal:
            return dwell.TaskGoal("Stay.")

        def judge(
            self, world: dwell.World, action: str, verdict: dwell.StepResult
        ) -> dwell.StepResult:
            return dwell.StepResult(1.0, terminated=True, success=True)

    measures = {"distance_to_goal", "spl", "soft_spl"}
    for task, success in ((Stay, True), ("Free", False)):
        env = DwellEnv(task, sensors=["gps"])
        env.reset(seed=1)
        info = env.step(1)[4]
        assert not measures & set(info)
        assert info["success"] is success
        assert info["path_length"] > 0.05
        many = DwellVectorEnv(2, task, sensors=["gps"])
        many.reset(seed=1)
        infos = many.step(np.array([1, 1]))[4]
        assert all(np.isnan(infos[name]).all() for name in measures)


def test_settings_that_a_task_does_not_take_are_answered_with_those_it_does() -> None:
    with pytest.raises(dwell.ConfigError, match="no argument 'nearm'; did you mean near_m"):
        DwellEnv(GoThere, task_settings={"nearm": 1.0})
    with pytest.raises(dwell.ConfigError, match="'colour'; there are none"):
        DwellEnv(dwell.Task, task_settings={"colour": 1})


def test_seeds_and_snapshots_bring_the_same_episode_back() -> None:
    # Without an expert the actions are the same whatever happens.
    actions = [1, 1, 2, 1, 3, 1] * 4
    first, second = (DwellEnv(GoThere, sensors=ALL) for _ in range(2))
    first.reset(seed=8)
    second.reset(seed=8)
    before = play(first, actions[:7])
    assert same(before, play(second, actions[:7]))
    snapshot = first.snapshot()
    after = play(first, actions[7:])
    third = DwellEnv(GoThere, sensors=ALL)
    observation, _ = third.restore(snapshot)
    assert same([observation], [before[-1][0]])
    assert same(after, play(third, actions[7:]))
    assert third.reset(seed=9)[0]["noisy"].tolist() != observation["noisy"].tolist()


def test_a_state_of_thousands_of_digits_is_refused_by_its_place() -> None:
    env = DwellEnv(GoThere, sensors=["gps", Noisy])
    env.reset(seed=1)
    task = env._runner.plays[0]._task
    assert task is not None
    task.state["count"] = 10**308
    env.restore(env.snapshot())
    task.state["count"] = 10**5000
    told = r"task\.state\.count is a whole number of more than 309 digits"
    with pytest.raises(dwell.ConfigError, match=told):
        env.snapshot()


@pytest.mark.parametrize("cut", ["none", "parts", "other"])
def test_snapshots_of_other_parts_are_refused(cut: str) -> None:
    env = DwellEnv(GoThere, sensors=["gps", Noisy])
    env.reset(seed=1)
    env.step(1)
    hash_before = env.state_hash()
    episode, parts, rest = check_and_strip("", env.snapshot()).split(b"\0", 2)
    wrong = {"none": b"", "parts": parts[: len(parts) // 2], "other": b'{"task":{}}'}[cut]
    with pytest.raises(
        dwell.ConfigError,
        match=r"snapshot refused: it(s parts| is of an environment without parts)",
    ):
        env.restore(with_checksum(b"\0".join((episode, wrong, rest))))
    assert env.state_hash() == hash_before
    plain = DwellEnv("Free", sensors=["gps"])
    plain.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="parts in Python"):
        plain.restore(with_checksum(b"\0".join((episode, parts, rest))))


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_many_at_once_are_as_one_alone(mode: AutoresetMode) -> None:
    many = DwellVectorEnv(
        3,
        functools.partial(GoThere, near_m=2.5),
        sensors=ALL,
        reward=Doubled,
        autoreset_mode=mode,
        copy=True,
    )
    one = DwellEnv(functools.partial(GoThere, near_m=2.5), sensors=ALL, reward=Doubled)
    batch, _ = many.reset(seed=20)
    alone, _ = one.reset(seed=22)
    ended = 0
    for _ in range(STEPS):
        for name, value in alone.items():
            assert np.array_equal(batch[name][2], value), name
        actions = many.expert_actions()
        assert actions[2] == one.expert_action()
        batch, rewards, terminated, _, infos = many.step(actions)
        alone, reward, is_over, _, info = one.step(int(actions[2]))
        assert (rewards[2], terminated[2]) == (reward, is_over)
        assert infos["judged"][2] == info["judged"]
        # Of an episode that began within the step nothing is judged yet.
        begun = terminated & (mode is AutoresetMode.SAME_STEP)
        assert np.array_equal(infos["_judged"], ~begun)
        if terminated.any() and mode is AutoresetMode.SAME_STEP:
            k = int(np.flatnonzero(terminated)[0])
            assert infos["final_info"]["judged"][k] >= 1
        if is_over:
            ended += 1
            break
        if terminated.any() and mode is AutoresetMode.DISABLED:
            batch, _ = many.reset(options={"reset_mask": terminated})
        if terminated.any() and mode is AutoresetMode.NEXT_STEP:
            break
    assert batch["word"] == ("abc",) * 3
    many.close()


def test_the_world_of_an_environment_is_that_of_dwell() -> None:
    seen = {}

    class Looking(dwell.Task):
        def reset(self, world: dwell.World, rng: np.random.Generator) -> None:
            room = world.house.rooms()[0]
            world.place_agent(room["stand"], 90.0)
            seen["world"] = world

    env = DwellEnv(Looking, sensors=["gps"])
    env.reset(seed=1)
    world = seen["world"]
    stand = world.house.rooms()[0]["stand"]
    assert env.agents()[0]["position"] == pytest.approx(stand, abs=0.05)
    assert world.state_hash() == env.state_hash()
    # A copy goes its own way from here.
    copy = pickle.loads(pickle.dumps(world))
    assert copy.state_hash() == world.state_hash()
    copy.step()
    assert copy.state_hash() != world.state_hash()
    env.step(1)
    assert world.time_s == pytest.approx(0.05)
    # Where the agent starts counts from where the task has put it.
    assert np.allclose(env.reset(seed=2)[0]["gps"], 0.0)


def test_parts_are_found_by_name() -> None:
    here = __name__
    env = DwellEnv(f"{here}:GoThere", sensors=["gps", f"{here}:Noisy"], reward=f"{here}:Doubled")
    assert set(env.reset(seed=1)[0]) == {"gps", "noisy"}
    again = pickle.loads(pickle.dumps(env))
    assert set(again.reset(seed=1)[0]) == {"gps", "noisy"}


class Nothing(dwell.Sensor):
    def observe(self, world: dwell.World, rng: np.random.Generator) -> object:
        return 0


class Nameless(Nothing):
    space = gymnasium.spaces.Discrete(2)


class Spaceless(Nothing):
    name = "spaceless"


class Blind(dwell.Sensor):
    name = "blind"
    space = gymnasium.spaces.Discrete(2)


class Unrewarding(dwell.Reward):
    pass


class Gps(Noisy):
    name = "gps"


def judging(verdict: object) -> type[dwell.Task]:
    class Judging(dwell.Task):
        sensors = ("gps",)

        def judge(self, world: dwell.World, action: str, _: dwell.StepResult) -> Any:  # noqa: ANN401
            return verdict

    return Judging


def asking(ask: object) -> type[dwell.Task]:
    class Asking(dwell.Task):
        sensors = ("gps", "instruction", "instruction_tokens")

        def reset(self, world: dwell.World, rng: np.random.Generator) -> Any:  # noqa: ANN401
            return ask

    return Asking


def observing(value: object, space: gymnasium.Space[Any]) -> type[dwell.Sensor]:
    class Observing(dwell.Sensor):
        name = "observing"

        def observe(self, world: dwell.World, rng: np.random.Generator) -> object:
            return value

    Observing.space = space
    return Observing


def observed(value: object, **spaces: Any) -> type[dwell.Task]:  # noqa: ANN401 - also wrong ones
    class Observed(dwell.Task):
        sensors = ("gps",)

        def observe(self, world: dwell.World, rng: np.random.Generator) -> Any:  # noqa: ANN401
            return value

    Observed.spaces = spaces
    return Observed


BOX = gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32)
BYTES = gymnasium.spaces.Box(0, 255, (2,), np.uint8)
INTS = gymnasium.spaces.Box(-5, 5, (1,), np.int32)
MAKING: list[tuple[dict[str, Any], str]] = [
    ({"task": GoThere()}, "exists already"),
    ({"task": 5}, "task is 5"),
    ({"task": Noisy}, "expected a subclass of dwell.Task"),
    ({"task": "no.such.module:Task"}, "no.such.module"),
    ({"task": f"{__name__}:Missing"}, "Missing"),
    ({"task": lambda: 3}, "made 3"),
    ({"task": GoThere, "task_settings": 5}, "settings of task is 5"),
    ({"reward": Doubled()}, "exists already"),
    ({"reward": 3}, "reward is 3"),
    ({"reward": lambda world, action, verdict: 1.0}, "no arguments: missing a required argument"),
    ({"reward": lambda world: 1.0}, "a subclass of dwell.Reward, a function without arguments"),
    ({"sensors": ["gps", Noisy()]}, "exists already"),
    ({"sensors": ["gps", Noisy, Noisy]}, "'noisy' twice"),
    ({"sensors": ["gps", Gps]}, "'gps' twice"),
    ({"sensors": [Nameless]}, "Nameless.name is None"),
    ({"sensors": [Spaceless]}, "space is None"),
    ({"sensors": {"mine": 5}}, "mine"),
    ({"sensors": ["gps", Blind]}, "lacks the method observe"),
    ({"reward": Unrewarding}, "lacks the method reward"),
    ({"task": observed({})}, "Observed has a method observe and no spaces"),
    ({"task": observed({}, goal=5)}, "Observed.spaces: goal is 5; allowed are Box, Discrete"),
    ({"task": observed({}, gps=BOX)}, "found 'gps' twice"),
    ({"task": observed({}, noisy=BOX), "sensors": ["gps", Noisy]}, "found 'noisy' twice"),
]


@pytest.mark.parametrize(("arguments", "said"), MAKING)
def test_what_is_no_part_is_refused(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(dwell.ConfigError) as refused:
        DwellEnv(**{"task": "Free", "sensors": ["gps"], **arguments})
    assert said in str(refused.value)


class Pointing(GoThere):
    """Observes its goal, with noise, and one of its settings decides how."""

    def __init__(self, near_m: float = 0.4, size: int = 3) -> None:
        super().__init__(near_m)
        self.spaces = {
            "goal": gymnasium.spaces.Box(-100.0, 100.0, (size,), np.float32),
            "said": gymnasium.spaces.Text(10),
        }

    def observe(self, world: dwell.World, rng: np.random.Generator) -> dict[str, Any]:
        left = np.subtract(self.state["goal"], world.agents()[0]["position"])
        size = self.spaces["goal"].shape
        return {"said": "go", "goal": np.resize(left, size or ()) + rng.normal(0.0, 0.01)}


def test_a_task_observes_alone_and_in_many() -> None:
    dwell.register_task("tests/Pointing-v0", Pointing, sensors=["gps", Number])
    check_env(gymnasium.make("tests/Pointing-v0", disable_env_checker=True).unwrapped)
    one = DwellEnv(Pointing, task_settings={"size": 2}, sensors=["gps", Noisy])
    assert set(one.observation_space.spaces) == {"gps", "noisy", "goal", "said"}  # type: ignore[attr-defined]
    many = DwellVectorEnv(3, Pointing, task_settings={"size": 2}, sensors=["gps", Noisy], copy=True)
    alone, _ = one.reset(seed=22)
    assert alone in one.observation_space
    batch, _ = many.reset(seed=20)
    assert batch["goal"].shape == (3, 2)
    for action in (1, 2, 1):
        for name, value in alone.items():
            assert np.array_equal(batch[name][2], value), name
        alone = one.step(action)[0]
        batch = many.step(np.full(3, action))[0]
    saved, others = one.snapshot(), many.snapshot()
    after = play(one, [1, 3, 1])
    assert same(
        [DwellEnv(Pointing, task_settings={"size": 2}, sensors=["gps", Noisy]).restore(saved)[0]],
        [alone],
    )
    observation, _ = one.restore(saved)
    assert same([observation], [alone])
    assert same(after, play(one, [1, 3, 1]))
    many.reset(seed=1)
    assert np.array_equal(many.restore(others)[0]["goal"], batch["goal"])


class Following(dwell.Task):
    base = "InstructionFollowing"
    sensors = ("instruction",)


def test_a_task_upon_another_has_its_expert() -> None:
    own, base = DwellEnv(Following), DwellEnv(sensors=["instruction"])
    many = DwellVectorEnv(2, Following)
    many.reset(seed=[6, 7])
    own.reset(seed=7)
    base.reset(seed=7)
    assert own.instruction() == base.instruction()
    actions = []
    for _ in range(60):
        actions.append(own.expert_action())
        assert actions[-1] == base.expert_action()
        together = many.expert_actions()
        assert together[1] == actions[-1]
        is_over = own.step(actions[-1])[2]
        base.step(actions[-1])
        if is_over:
            break
        if many.step(together)[2].any():
            break
    assert len(set(actions)) > 1


def test_nothing_is_called_that_makes_no_part(monkeypatch: pytest.MonkeyPatch) -> None:
    called: list[str] = []
    module = sys.modules[__name__]
    monkeypatch.setattr(module, "trap", lambda: called.append("trap"), raising=False)
    for kind in ("task", "reward"):
        for given in ("os:abort", "os:getcwd", "sys:exit", "builtins:dict", f"{__name__}:trap"):
            with pytest.raises(dwell.ConfigError, match=f"{kind} is {given!r}; expected a subcl"):
                DwellEnv(**{"task": "Free", "sensors": ["gps"], kind: given})
    for sensors in (["gps", "os:abort"], {"mine": "os:abort"}, ["gps", os.abort]):
        with pytest.raises(dwell.ConfigError, match=r"expected a subclass of dwell\.Sensor"):
            DwellEnv("Free", sensors=sensors)
    for given in (os.abort, functools.partial(os.abort), functools.partial(Noisy)):
        with pytest.raises(dwell.ConfigError, match=r"expected a subclass of dwell\.Task"):
            DwellEnv(given)  # type: ignore[arg-type] # the fault
    assert not called


def test_what_parts_remember_is_no_deeper_than_json_is_read() -> None:
    deep: list[Any] = []
    for _ in range(50_000):
        deep = [deep]

    class Deep(dwell.Task):
        sensors = ("gps",)

        def reset(self, world: dwell.World, rng: np.random.Generator) -> None:
            self.state["deep"] = deep

    env = DwellEnv(Deep)
    env.reset(seed=1)
    with pytest.raises(dwell.ConfigError, match="nested too deep"):
        env.snapshot()
    plain = DwellEnv("Free", sensors=["gps", Noisy])
    plain.reset(seed=1)
    episode, _, rest = check_and_strip("", plain.snapshot()).split(b"\0", 2)
    with pytest.raises(dwell.ConfigError, match="its parts: nested 100000 deep"):
        plain.restore(with_checksum(b"\0".join((episode, b"[" * 100_000, rest))))


def play_a_step(env: DwellEnv) -> None:
    env.reset(seed=1)
    env.step(1)


PLAYING: list[tuple[dict[str, Any], str]] = [
    ({"task": judging(None)}, "judge gave None"),
    ({"task": judging(dwell.StepResult(reward=float("nan")))}, "reward is nan"),
    ({"task": judging(dwell.StepResult(terminated=1))}, "terminated is 1"),  # type: ignore[arg-type] # the fault
    ({"task": judging(dwell.StepResult(distance_m=-1.0))}, "distance_m is -1"),
    ({"task": judging(dwell.StepResult(info={"spl": 1.0}))}, "info has 'spl'"),
    ({"task": asking("Go.")}, "reset gave 'Go.'"),
    ({"task": asking(dwell.TaskGoal("Gehen Sie zur Tür!"))}, "instruction is"),
    ({"task": asking(dwell.TaskGoal(""))}, "instruction is"),
    ({"task": asking(dwell.TaskGoal("Find the xylotheque."))}, "xylotheque"),
    ({"task": asking(dwell.TaskGoal(distance_m=float("inf")))}, "distance_m is inf"),
    ({"task": observed(None, goal=BOX)}, "Observed.observe is None"),
    ({"task": observed({}, goal=BOX)}, "Observed.observe gave []; its spaces are ['goal']"),
    ({"task": observed({"goal": [0, 0], "x": 1}, goal=BOX)}, "gave ['goal', 'x']; its spaces are"),
    ({"task": observed({"goal": [0, 2]}, goal=BOX)}, "Observed.observe: goal observed [0, 2]; its"),
    ({"task": observed({"goal": "a"}, goal=BOX)}, "goal observed 'a'; its space is Box"),
    ({"sensors": [observing([0.0, 2.0], BOX)]}, "sensor observing observed"),
    ({"sensors": [observing([1, 256], BYTES)]}, "uint8); found int64 of shape (2,)"),
    ({"sensors": [observing([1.5, 2.0], BYTES)]}, "uint8); found float64 of shape (2,)"),
    ({"sensors": [observing([2**40], INTS)]}, "int32); found int64 of shape (1,)"),
    ({"sensors": [observing([0.0, float("nan")], BOX)]}, "sensor observing observed"),
    ({"sensors": [observing([0.0] * 3, BOX)]}, "sensor observing observed"),
    ({"sensors": [observing("text", BOX)]}, "sensor observing observed"),
    ({"sensors": [observing(1.5, gymnasium.spaces.Discrete(3))]}, "sensor observing observed"),
    ({"sensors": [observing(5, gymnasium.spaces.Discrete(3))]}, "sensor observing observed"),
    ({"sensors": [observing(5, gymnasium.spaces.Text(5))]}, "sensor observing observed"),
]


@pytest.mark.parametrize(("arguments", "said"), PLAYING)
def test_what_a_part_gives_is_checked(arguments: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"task": "Free", **arguments}
    env = DwellEnv(**given)
    with pytest.raises(dwell.DwellError) as refused:
        play_a_step(env)
    assert said in str(refused.value)


@pytest.mark.parametrize("value", [[0, 255], np.array([0, 255]), np.array([0, 255], np.uint16)])
def test_whole_numbers_that_fit_are_converted(value: object) -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=[observing(value, BYTES)])
    seen = env.reset(seed=1)[0]["observing"]
    assert seen.dtype == np.uint8
    assert seen.tolist() == [0, 255]


def test_a_task_without_an_expert_says_so() -> None:
    env = DwellEnv(judging(dwell.StepResult()))
    env.reset(seed=1)
    with pytest.raises(dwell.UsageError, match="Judging has no expert"):
        env.expert_action()


def test_the_borders_of_batches_hold() -> None:
    env = DwellEnv("Free", sensors=["gps"])
    batch = env._runner.batch
    with pytest.raises(dwell.UsageError, match="reset first"):
        batch.set_goal(0, "Go.", None)
    with pytest.raises(dwell.UsageError, match="reset first"):
        batch.set_step_result(
            0, {"reward": 0.0, "terminated": False, "success": False, "distance_m": None}
        )
    with pytest.raises(dwell.UsageError, match="no environment 3"):
        _native.World.of_env(batch, 3)
    with pytest.raises(dwell.ConfigError):
        batch.set_step_result(0, {})
    assert isinstance(_native.World.of_env(batch, 0), _native.World)
