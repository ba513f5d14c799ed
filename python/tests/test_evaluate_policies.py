"""Policies of users in evaluations: their source, their errors, their modes, their processes."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import dwell
from dwell.cli.job_journal import Journal
from dwell.envs import DwellEnv
from dwell.envs.action_modes import ACTION_MODES
from dwell.episode_maker import EpisodeMaker
from dwell.evaluation import differences, evaluate, read_result
from dwell.played_actions import element_of, unpacked
from dwell.policies import PolicyError

pytestmark = pytest.mark.usefixtures("open_once")

Command = Callable[..., subprocess.CompletedProcess[str]]
ONE: dict[str, Any] = {"task": "PointNav", "houses": "builtin:studio", "count": 1}
OPTIONS = ("--task", "PointNav", "--houses", "builtin:studio", "--count", "3")
SPINNER = """
from beside import DIRECTION

class Spin:
    def __init__(self):
        self.left = 3

    def reset(self, observation, info):
        self.left = 3

    def act(self, observation):
        self.left -= 1
        return DIRECTION if self.left > 0 else 0
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder in which the command is given; what is imported from it is forgotten."""
    monkeypatch.chdir(tmp_path)
    before = {*sys.modules}
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield tmp_path
    forget(before)


def forget(before: set[str]) -> None:
    for name in {*sys.modules} - before:
        if name in ("spinner", "beside", "my_faulty_policy"):
            del sys.modules[name]


@contextlib.contextmanager
def stopped_after(count: int) -> Iterator[None]:
    """Ctrl-C after so many episodes."""
    add, left = Journal.add, [count]

    def stop(self: Journal, *args: object) -> None:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        add(self, *args)  # type: ignore[arg-type]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Journal, "add", stop)
        yield


@pytest.mark.long
@pytest.mark.parametrize("changed", ["spinner.py", "beside.py"])
def test_a_policy_that_has_changed_does_not_go_on(
    changed: str, folder: Path, command: Command
) -> None:
    (folder / "spinner.py").write_text(SPINNER)
    (folder / "beside.py").write_text("DIRECTION = 2\n\n\ndef other():\n    return 1\n")
    (folder / "spinner.py").write_text(f"from beside import other\n{SPINNER}")
    args = ("evaluate", "spinner:Spin", *OPTIONS, "--sensors", "gps", "--out", folder / "r.json")
    before = {*sys.modules}
    with stopped_after(2):
        assert command(*args).returncode == 130
    kept = folder / ".r.json.part"
    written = kept.read_bytes()
    old = (folder / changed).read_text()
    (folder / changed).write_text(old.replace("3", "5").replace("return 1", "return 2"))
    forget(before)
    refused = command(*args)
    assert refused.returncode == 1
    assert "the policy's source (a hash) was " in refused.stderr
    assert f"to begin this one, remove {kept} or give another --out" in refused.stderr
    assert kept.read_bytes() == written
    # As it was, it goes on; elsewhere the result of the changed one is another's.
    (folder / changed).write_text(old)
    forget(before)
    done = command(*args)
    assert done.returncode == 0, done.stderr
    result = read_result(folder / "r.json")
    assert [row["actions"] for row in result["episodes"]] == ["2*2 0"] * 3
    assert "all that it states holds" in command("evaluate", "--verify", folder / "r.json").stdout
    forget(before)
    checked = command("evaluate", "spinner:Spin", "--verify", folder / "r.json")
    assert checked.stdout.rstrip().endswith("all that it states holds")
    (folder / changed).write_text(f"{old}\n# changed\n")
    forget(before)
    checked = command("evaluate", "spinner:Spin", "--verify", folder / "r.json")
    assert checked.returncode == 1
    assert "policy_source: the file states" in checked.stderr
    assert "has changed since" in checked.stderr


@pytest.mark.long
def test_what_a_policy_says_of_itself_is_part_of_its_source() -> None:
    class Weighted:
        identity = "weights 1"

        def act(self, observation: object) -> int:
            return 0

    first = evaluate(Weighted, sensors=["gps"], **ONE)["policy_source"]
    assert len(first) == 64
    assert evaluate(Weighted(), sensors=["gps"], **ONE)["policy_source"] == first
    Weighted.identity = "weights 2"
    assert evaluate(Weighted, sensors=["gps"], **ONE)["policy_source"] != first
    assert evaluate("stop", **ONE)["policy_source"] is None
    Weighted.identity = 3  # type: ignore[assignment] # the fault
    with pytest.raises(dwell.ConfigError, match="the policy's identity is 3; expected a text"):
        evaluate(Weighted, sensors=["gps"], **ONE)


def test_a_maker_that_needs_arguments_is_refused() -> None:
    def make(weights: str, *rest: object, best: bool, usual: int = 1) -> object:
        del weights, rest, best, usual
        return object()

    with pytest.raises(dwell.ConfigError, match=r"make is made with weights, best; expected"):
        evaluate(make, sensors=["gps"], **ONE)


FAULTY = """
class Faulty:
    def __init__(self):
        self.steps = 0

    def act(self, observation):
        self.steps += 1
        if self.steps == 3:
            self.look_up_the_way(observation)
        return 2

    def look_up_the_way(self, observation):
        return observation["way"]


class Unmade:
    def __init__(self):
        raise RuntimeError("no weights")

    def act(self, observation):
        return 0
"""


def test_what_a_policy_raises_is_told_as_its_own(folder: Path, command: Command) -> None:
    (folder / "my_faulty_policy.py").write_text(FAULTY)
    name = "my_faulty_policy:Faulty"
    out = folder / "r.json"
    done = command("evaluate", name, *OPTIONS, "--sensors", "gps", "--out", out)
    assert done.returncode == 1
    assert "bug of dwell" not in done.stderr
    told = f"the policy {name} raised KeyError: 'way', at step 3 of episode builtin:studio#"
    assert told in done.stderr
    # The traceback is the user's, from the call of act on.
    trace = done.stderr[: done.stderr.index("dwell evaluate: ")]
    assert 'return observation["way"]' in trace
    assert "self.look_up_the_way(observation)" in trace
    assert "evaluation.py" not in trace
    # Nothing was played to its end, so nothing is left.
    assert [path.name for path in folder.iterdir()] == ["my_faulty_policy.py"]
    made = command("evaluate", "my_faulty_policy:Unmade", *OPTIONS)
    assert "raised RuntimeError: no weights, when it was made" in made.stderr
    assert 'raise RuntimeError("no weights")' in made.stderr
    (folder / "my_faulty_policy.py").write_text("import something_that_is_not_there\n")
    del sys.modules["my_faulty_policy"]
    imported = command("evaluate", name, *OPTIONS)
    assert "raised ModuleNotFoundError" in imported.stderr
    assert "when its module was imported" in imported.stderr
    missing = command("evaluate", "no_policy_at_all:Name", *OPTIONS)
    assert "expected 'module:Name'" in missing.stderr


LEAVERS = """
import sys

import dwell
import gymnasium


class Acting:
    def act(self, observation):
        sys.exit(0)


class Beginning:
    def reset(self, observation, info):
        raise SystemExit

    def act(self, observation):
        return 0


class Made:
    def __init__(self):
        sys.exit()

    def act(self, observation):
        return 0


class Looking(dwell.Sensor):
    name = "looking"
    space = gymnasium.spaces.Discrete(2)

    def observe(self, world, rng):
        sys.exit(0)
"""


def test_code_that_ends_the_process_is_told_and_fails(folder: Path, command: Command) -> None:
    (folder / "my_faulty_policy.py").write_text(LEAVERS)
    out = folder / "r.json"

    def told(policy: str, sensor: str = "gps") -> str:
        done = command("evaluate", policy, *OPTIONS, "--sensors", sensor, "--out", out)
        assert done.returncode == 1
        return done.stderr.splitlines()[-1]

    module = "my_faulty_policy"
    acting = told(f"{module}:Acting")
    assert f"the policy {module}:Acting raised SystemExit: 0, at step 1 of episode" in acting
    assert "raised SystemExit, in reset, at the start" in told(f"{module}:Beginning")
    assert "raised SystemExit, when it was made" in told(f"{module}:Made")
    looking = f"{module}:Looking"
    # The policy brings its folder.
    (folder / "spinner.py").write_text("class Spin:\n    def act(self, observation): return 0\n")
    assert "sys.exit(0) in my_faulty_policy.py line 34" in told("spinner:Spin", looking)
    (folder / f"{module}.py").write_text("raise SystemExit(0)\n")
    del sys.modules[module]
    assert "raised SystemExit: 0, when its module was imported" in told(f"{module}:Acting")
    assert "whose module ends the process: sys.exit(0) in" in told("spinner:Spin", looking)
    assert not out.exists()


def test_errors_of_a_policy_keep_their_cause() -> None:
    class Beginning:
        def reset(self, observation: object, info: object) -> None:
            raise ZeroDivisionError

        def act(self, observation: object) -> int:
            return 0

    with pytest.raises(PolicyError, match="raised ZeroDivisionError, in reset, at the st") as error:
        evaluate(Beginning, sensors=["gps"], **ONE)
    assert isinstance(error.value.__cause__, ZeroDivisionError)
    assert isinstance(error.value, dwell.DwellError)

    class Wrong:
        def act(self, observation: object) -> object:
            return 99

    told = r"the policy's action is 99; .*; at step 1 of episode builtin:studio#\d+"
    with pytest.raises(dwell.ConfigError, match=told):
        evaluate(Wrong, sensors=["gps"], **ONE)


@pytest.mark.long
@pytest.mark.parametrize(
    ("task", "mode"),
    [
        *(
            pytest.param("PointNav", mode, marks=() if mode == "dict" else pytest.mark.slow)
            for mode in ACTION_MODES
            if mode != "discrete"
        ),
        ("SoundLocalization", "velocity"),
        pytest.param("SoundLocalization", "dict", marks=pytest.mark.slow),
    ],
)
def test_every_mode_is_played_stated_and_verified(task: str, mode: str) -> None:
    # Velocities open no doors.
    own = {"open_doors": True, "max_distance_m": 3.0} if task == "PointNav" else {}
    given: dict[str, Any] = {**ONE, "seed": 3, "task": task, "task_settings": own}
    expert = evaluate("expert", action_mode=mode, **given)
    assert expert["action_mode"] == mode
    assert expert["metrics"]["success"]["mean"] == 1.0
    assert differences(expert) == []
    # The same actions in an environment of its own end in the same state.
    kwargs: dict[str, Any] = {"sensors": ["gps"], "action_mode": mode, "task_settings": own}
    env = DwellEnv(task, houses="builtin:studio", **kwargs)
    for row in expert["episodes"]:
        env.reset(options={"episode_id": row["episode_id"]})
        actions = unpacked("actions", row["actions"])
        assert len(actions) == row["na"] == row["steps"]
        for action in actions:
            env.step(element_of(action, row.get("answer"), env))
        assert f"{env.state_hash():016x}" == row["state_hash"]
    for policy in ("random", "stop", "forward"):
        played = evaluate(policy, action_mode=mode, max_steps=4, **given)
        assert differences(played) == []
        assert len(unpacked("actions", played["episodes"][0]["actions"])) in (1, 2, 3, 4)
    assert evaluate("random", action_mode=mode, max_steps=9, **given) == evaluate(
        "random", action_mode=mode, max_steps=9, **given
    )
    # What was edited is found.
    other = json.loads(json.dumps(expert))
    other["episodes"][0]["actions"] = other["episodes"][0]["actions"][1:]
    assert any("episodes[0]" in sentence for sentence in differences(other))
    other["episodes"][0]["actions"] = [[1, "jump"]]
    assert any("actions: action 0 of 1" in sentence for sentence in differences(other))
    other = {**expert, "action_mode": "discrete"}
    assert differences(other) != []


def test_more_modes_than_there_are_are_refused(command: Command) -> None:
    assert command("evaluate", "stop", *OPTIONS, "--action-mode", "thought").returncode == 2


@pytest.mark.long
def test_processes_give_the_same_bytes(folder: Path, command: Command) -> None:
    (folder / "spinner.py").write_text(SPINNER)
    (folder / "beside.py").write_text("DIRECTION = 2\n")
    maker = EpisodeMaker("PointNav", "builtin:studio", count=5, seed=5)
    dwell.episodes.write(folder / "val.jsonl", maker.header, maker.episodes())
    args = ("evaluate", "spinner:Spin", "--episodes", folder / "val.jsonl", "--sensors", "gps")
    # Several first: they find the policy's folder where no earlier command has named it.
    two = command(*args, "--out", folder / "two.json", "--workers", "2")
    assert two.returncode == 0, two.stderr
    assert command(*args, "--out", folder / "one.json").returncode == 0
    assert (folder / "two.json").read_bytes() == (folder / "one.json").read_bytes()
    # Begun by one and ended by several, the same; and errors come back whole.
    with stopped_after(2):
        assert command(*args, "--out", folder / "cut.json").returncode == 130
    assert command(*args, "--out", folder / "cut.json", "--workers", "3").returncode == 0
    assert (folder / "cut.json").read_bytes() == (folder / "one.json").read_bytes()
    (folder / "my_faulty_policy.py").write_text(FAULTY)
    failed = command("evaluate", "my_faulty_policy:Faulty", *args[2:], "--workers", "2")
    assert failed.returncode == 1
    assert "raised KeyError: 'way', at step 3 of episode" in failed.stderr
    assert 'return observation["way"]' in failed.stderr


def test_a_policy_that_no_other_process_can_have_is_refused() -> None:
    class Local:
        def act(self, observation: object) -> int:
            return 0

    with pytest.raises(dwell.ConfigError, match="cannot be given to other processes"):
        evaluate(Local(), sensors=["gps"], workers=2, **{**ONE, "count": 2})
    with pytest.raises(dwell.ConfigError, match="workers is 0"):
        evaluate("stop", workers=0, **ONE)
