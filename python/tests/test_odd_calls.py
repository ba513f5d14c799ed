"""Odd values of calls and commands: which are refused, and whether the sentence leads on."""

from __future__ import annotations

import functools
import json
import re
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import pytest
from test_measure import quiet, tosses

import dwell
from dwell import pettingzoo as zoo
from dwell.cli import main
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.episode_maker import EpisodeMaker
from dwell.evaluation import evaluate
from dwell.measured.importing import import_files

Command = Callable[..., subprocess.CompletedProcess[str]]
STUDIO: dict[str, Any] = {"houses": "builtin:studio", "sensors": ["gps"]}

pytestmark = pytest.mark.usefixtures("open_once")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (5, "options is 5; expected values by name"),
        ([], "options is []; expected values by name"),
    ],
)
def test_options_of_several_agents_are_by_name(options: Any, told: str) -> None:  # noqa: ANN401
    env = zoo.parallel_env("PointNav", agents=2, **STUDIO)
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        env.reset(seed=1, options=options)
    env.reset(seed=1, options={"house": 0})


@pytest.mark.parametrize("name", ["", "a\x1b[31m", "a\0b", "a\u202eb", "a\nb"])
def test_names_of_agents_can_be_printed(name: str) -> None:
    told = re.escape(f"agents: a name is {name!r}; expected letters that can be printed")
    with pytest.raises(dwell.ConfigError, match=told):
        zoo.parallel_env("PointNav", agents={name: {}}, **STUDIO)
    zoo.parallel_env("PointNav", agents={"Jörg 2": {}}, **STUDIO)


def test_a_sensor_stands_once_among_names() -> None:
    with pytest.raises(dwell.ConfigError, match="sensors: 'gps' stands there twice"):
        gymnasium.make("dwell/PointNav-v0", houses="builtin:studio", sensors=["gps", "rgb", "gps"])


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ({"kind": "persona"}, "agents[1].kind is 'persona'; allowed are 'capsule', 'person'"),
        (
            {"kind": "person", "hand": "both"},
            "agents[1].hand is 'both'; allowed are 'left', 'right'",
        ),
    ],
)
def test_words_of_bodies_are_told_with_the_body(body: dict[str, Any], told: str) -> None:
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        dwell.World("builtin:studio", agents=[{}, body])


def test_a_path_with_nul_is_none() -> None:
    env = gymnasium.make("dwell/PointNav-v0", **STUDIO)
    with pytest.raises(dwell.ConfigError, match=r"folder is 'a\\x00b'; a path holds no NUL"):
        dwell.envs.ReplayRecorder(env, "a\0b")


def test_a_long_sentence_is_not_told_whole(command: Command) -> None:
    ran = command("check-text", "builtin:studio", "There is a bed." * 2_000)
    assert ran.returncode == 1
    assert len(ran.stderr) < 500
    assert "the text has 30000 bytes; allowed are 4096" in ran.stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("--yaw-deg 90", "--yaw-deg is given, and the response of a pair without --ears or --head"),
        ("--bits 16", "--bits is given, and the response of a pair without --out does not read it"),
        ("--grid 1 --out x --yaw-deg 90", "--yaw-deg is given, and --grid without --ears or"),
        ("--grid 1 --out x --source-height 1", "--source-height is given, and --grid with --so"),
        ("--rate-hz -5", "--rate-hz: expected a whole number from 8000 to 192000, found '-5'"),
    ],
)
def test_options_of_responses_that_nothing_reads_are_refused(
    options: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    mic = [] if "--grid" in options else ["--mic", "2,1,2"]
    try:
        status = main(["ir", "builtin:studio", "--source", "1,1,1", *mic, *options.split()])
    except SystemExit as error:
        status = error.code
    assert status in (1, 2)
    assert told in capsys.readouterr().err


def test_a_constant_of_a_map_is_told_with_the_map(tmp_path: Path) -> None:
    files, path = tosses(tmp_path)
    mapping = json.loads(path.read_text())
    path.write_text(json.dumps({**mapping, "g_m_s2": "x"}))
    with pytest.raises(ValueError, match=r"map\.json: g_m_s2 is 'x'; expected a number"):
        import_files(files, path, tmp_path / "a.measured", quiet)


def test_of_many_columns_the_first_are_told(tmp_path: Path) -> None:
    files, path = tosses(tmp_path)
    files[0].write_text(",".join(f"c{k}" for k in range(10_000)) + "\n")
    with pytest.raises(ValueError, match=r"no column 'id'; it has .*\(10000 in all\)") as raised:
        import_files(files, path, tmp_path / "a.measured", quiet)
    assert len(str(raised.value)) < 500


@pytest.mark.long
def test_who_stops_making_episodes_does_not_wait_for_experts() -> None:
    maker = EpisodeMaker("PointNav", "builtin:studio", count=64, seed=1, expert=True)
    alone = maker.in_parts(maker.parts())
    begun = time.perf_counter()
    next(alone)
    piece_s = time.perf_counter() - begun
    alone.close()
    made = maker.in_parts(maker.parts(), workers=2)
    next(made)
    # Other pieces are being played now.
    begun = time.perf_counter()
    made.close()
    assert time.perf_counter() - begun < 0.5 * piece_s


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"task": 5}, "task is 5; expected text"),
        ({"houses": 5}, "houses is 5; expected a list of text"),
        ({"shard": 5}, "shard is 5; expected two whole numbers"),
        ({"shard": (1, 1)}, "shard[0] is 1; allowed are whole numbers from 0 to 0"),
        ({"expert": "yes"}, "expert is 'yes'; allowed are True and False"),
    ],
)
def test_what_a_maker_of_episodes_is_told_is_checked(fields: dict[str, Any], told: str) -> None:
    arguments: dict[str, Any] = {"task": "PointNav", "houses": "builtin:studio", "count": 1}
    with pytest.raises(dwell.ConfigError, match=re.escape(told)):
        EpisodeMaker(**{**arguments, **fields})


@pytest.mark.parametrize("workers", [0, "2", True])
def test_workers_of_a_maker_of_episodes_are_a_number(workers: Any) -> None:  # noqa: ANN401
    maker = EpisodeMaker("PointNav", "builtin:studio", count=1)
    with pytest.raises(dwell.ConfigError, match=re.escape(f"workers is {workers!r}; allowed are")):
        [*maker.episodes(workers=workers)]


def test_episodes_to_evaluate_are_files() -> None:
    with pytest.raises(dwell.ConfigError, match="episodes is 5; expected the path of a file"):
        evaluate("random", episodes=5)  # type: ignore[arg-type] # on purpose


def test_recorders_and_wrappers_say_which_environments_they_take(tmp_path: Path) -> None:
    several: Any = zoo.parallel_env("PointNav", agents=2, **STUDIO)
    with pytest.raises(dwell.ConfigError, match="ParallelReplayRecorder records several"):
        dwell.envs.ReplayRecorder(several, tmp_path)
    alone = gymnasium.make("dwell/PointNav-v0", **STUDIO)
    for env in (None, 5, alone):
        with pytest.raises(
            dwell.ConfigError, match=r"expected one of dwell\.pettingzoo\.parallel_env"
        ):
            zoo.TorchRLCompatible(env)
    zoo.TorchRLCompatible(several).reset(seed=1)


def test_a_task_that_there_is_not_plays_no_replay(tmp_path: Path) -> None:
    env = dwell.envs.ReplayRecorder(gymnasium.make("dwell/PointNav-v0", **STUDIO), tmp_path)
    env.reset(seed=1)
    env.step(6)
    env.close()
    replay = dwell.Replay.read(tmp_path / "episode_0000.replay")
    with pytest.raises(dwell.ConfigError, match="task is 'x'; "):
        next(replay.play(task="x"))
    assert next(replay.play(task="PointNav")).step == 0


@pytest.mark.parametrize("seekers", [[0, 0], [], [0, 1]])
def test_seekers_stand_once(seekers: list[int]) -> None:
    settings = {"seekers": seekers}
    env = zoo.parallel_env("HideAndSeek", agents=2, task_settings=settings, **STUDIO)
    with pytest.raises(dwell.ConfigError, match=re.escape(f"seekers is {seekers} of 2 agents")):
        env.reset(seed=1)


class Guided(dwell.Task):
    """A task upon one that a single agent cannot have."""

    base = "Cooperate"

    def judge(self, world: dwell.World, action: str, verdict: dwell.StepResult) -> dwell.StepResult:
        return verdict


def test_tasks_of_several_agents_say_who_has_them(tmp_path: Path, command: Command) -> None:
    """The engine's sentence was of agents that nobody had named."""
    told = (
        "'Cooperate', a task of several agents, and here one acts; make it with "
        "dwell.pettingzoo.parallel_env('Cooperate', ...), env or vector_env"
    )
    for make in (DwellEnv, functools.partial(DwellVectorEnv, 2)):
        with pytest.raises(dwell.ConfigError, match=re.escape(f"task is {told}")):
            make("Cooperate", world={"agents": 2}, **STUDIO)
        with pytest.raises(dwell.ConfigError, match=re.escape(f"Guided.base is {told}")):
            make(Guided, **STUDIO)
    places = ("--houses", "builtin:studio", "--count", "1")
    out = ("--out", tmp_path / "episodes.jsonl")
    for words in (
        ("episodes", "Cooperate", *places, *out),
        ("evaluate", "random", "--task", "Cooperate", *places),
    ):
        done = command(*words)
        assert done.returncode == 1
        assert f"task is {told}" in done.stderr
    told = command("episodes", "Nothing", *places, *out).stderr
    assert "task is 'Nothing'; allowed are InstructionFollowing" in told
    assert "Cooperate" not in told


def test_errors_within_a_factory_of_parts_stay_as_they_are() -> None:
    def broken() -> dwell.Reward:
        raise TypeError("mine")

    with pytest.raises(TypeError, match="mine"):
        DwellEnv("Free", reward=broken, **STUDIO)


@pytest.mark.parametrize(
    ("sensors", "told"),
    [
        (
            {"left": {"kind": "rgb"}, "right": {"kind": "rgb", "width": -1}},
            "sensors.right: width is -1: found integer `-1`, expected a whole number from 0",
        ),
        (
            {"rgb": {"width": 4}, "right": {"kind": "rgb", "width": 0}},
            "sensors.right: camera: width is 0; allowed is 1 to 16384 pixels",
        ),
        (
            {"rgb": {"width": 2**32}},
            "sensors.rgb: width is 4294967296: found integer `4294967296`, expected a whole number "
            "from 0 to 4294967295",
        ),
        ({"gps": {}, "rgb": 3}, "sensors.rgb: 3: found integer `3`, expected values by name"),
        (["gps", "rbg"], 'no sensor "rbg"; of the '),
        ([], "sensors is empty; expected at least one sensor, as ['gps']"),
    ],
)
def test_what_is_wrong_with_a_sensor_is_told_with_its_name(
    sensors: Any,  # noqa: ANN401
    told: str,
) -> None:
    """The setting alone was told, and of no sensors at all Gymnasium asserted something."""
    for make in (DwellEnv, functools.partial(DwellVectorEnv, 2)):
        with pytest.raises(dwell.ConfigError, match=f"^{re.escape(told)}"):
            make("Free", houses="builtin:studio", sensors=sensors)
    if sensors and told.startswith("sensors"):
        agents = {"anna": {"sensors": ["gps"]}, "ben": {"sensors": sensors}}
        with pytest.raises(dwell.ConfigError, match=f"^{re.escape(f'agents.ben.{told}')}"):
            zoo.parallel_env("Free", houses="builtin:studio", agents=agents)


def test_what_is_no_sensors_fault_is_told_of_none() -> None:
    told = "^agent is 3; allowed is below the number of agents, 1$"
    with pytest.raises(dwell.ConfigError, match=told):
        DwellEnv("Free", houses="builtin:studio", sensors=["gps", "rgb"], agent=3)


def test_of_several_houses_the_one_that_does_not_open_is_named(tmp_path: Path) -> None:
    for who in ("anna", "ben"):
        dwell.House.open("builtin:studio").write(tmp_path / who / "home.dwell", "dwell")
    (tmp_path / "ben" / "home.dwell" / "house.json").write_text("{")
    env = DwellEnv("Free", houses=str(tmp_path / "*" / "home.dwell"), sensors=["gps"])
    env.reset(options={"house": 0})
    with pytest.raises(dwell.HouseError) as refused:
        env.reset(options={"house": 1})
    assert str(refused.value).startswith(f"{tmp_path / 'ben' / 'home.dwell'}: ")


def test_an_episode_at_its_limit_is_over_also_where_it_is_restored() -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], max_episode_steps=2)
    env.reset(seed=1)
    assert [env.step(1)[3] for _ in range(2)] == [False, True]
    for state in (None, env.snapshot()):
        if state is not None:
            env.restore(state)
        with pytest.raises(dwell.UsageError, match="the episode has ended; call reset first"):
            env.step(1)
    env.reset(seed=1)
    assert not env.step(1)[3]


def test_a_predicate_asked_twice_is_told_once() -> None:
    world = dwell.World("builtin:studio", agents=0)
    assert world.relations(["on", "in", "on"]) == world.relations(["on", "in"])
    with pytest.raises(dwell.ConfigError, match='"open" is said of one thing; relations are'):
        world.relations(["open"])


def test_a_task_of_no_steps_is_refused() -> None:
    class Never(dwell.Task):
        max_steps = -5

    with pytest.raises(dwell.ConfigError, match=r"Never\.max_steps is -5; allowed are whole"):
        DwellEnv(Never, houses="builtin:studio")


def test_a_head_of_a_name_that_no_file_can_have_is_refused_as_its_file() -> None:
    with pytest.raises(dwell.MeasuredDataError, match="File name too long"):
        dwell.Head.from_sofa("x" * 5000)
