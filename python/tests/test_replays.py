"""Episodes as files."""

from __future__ import annotations

import dataclasses
import json
import os
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell import cli, replays
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder, VectorReplayRecorder
from dwell.files import atomic_write
from dwell.sounds import read_wav

pytestmark = pytest.mark.usefixtures("open_once")

ACTIONS = ["move_forward", "turn_left", "move_forward", "open", "look_down", "move_forward"]


class Shouting(dwell.Task):
    """Changes the world at the start, and draws at random."""

    sensors = ("gps",)

    def reset(self, world: dwell.World, rng: np.random.Generator) -> dwell.TaskGoal:
        world.play("phone", at=world.house.rooms()[rng.integers(3)]["eye"], loop=True)
        return dwell.TaskGoal("Stay.")


def recorded(folder: Path, **arguments: Any) -> Path:  # noqa: ANN401 - of DwellEnv
    given = {"task": "Free", "sensors": ["gps"], **arguments}
    env = ReplayRecorder(DwellEnv(**given), folder)
    env.reset(seed=4)
    for action in ACTIONS:
        env.step(np.int64(env.unwrapped.actions().index(action)))  # type: ignore[attr-defined] # a DwellEnv
    env.close()
    return sorted(folder.glob("*.replay"))[-1]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    laws = [{"id": "wind", "version": 1, "params": {"x_m_s": 2.0, "area_m2": 0.1}}]
    return recorded(tmp_path_factory.mktemp("replays"), laws=laws, houses="seed:3?home=studio")


def test_an_episode_is_played_again_to_the_same_bits(file: Path) -> None:
    replay = dwell.Replay.read(file)
    assert list(replay.actions) == ACTIONS
    assert replay.house == "seed:3?home=studio"
    assert replay.first_difference() is None
    moments = list(replay.play())
    assert [moment.step for moment in moments] == list(range(len(ACTIONS) + 1))
    assert moments[-1].world.time_s == pytest.approx(0.05 * len(ACTIONS))


def test_a_change_is_found_at_its_step(file: Path, tmp_path: Path) -> None:
    row = json.loads(file.read_text("utf-8"))
    row["actions"][2] = "turn_right"
    changed = tmp_path / "changed.replay"
    changed.write_text(json.dumps(row), "utf-8")
    assert dwell.Replay.read(changed).first_difference() == 3
    row["actions"][2] = "move_forward"
    row["config"]["world"]["laws"] = []
    changed.write_text(json.dumps(row), "utf-8")
    assert dwell.Replay.read(changed).first_difference() == 0
    assert cli.main(["replay", str(changed), "--verify"]) == 1
    assert cli.main(["replay", str(file), "--verify"]) == 0


@pytest.mark.parametrize("at", ["sensors", "agents", "task"])
def test_pictures_that_no_bit_depends_on_are_not_made(at: str, tmp_path: Path) -> None:
    big = {"width": 16384, "height": 16384}
    own = None if at == "task" else ["gps", "audio"]
    replay = dwell.Replay.read(recorded(tmp_path, houses="builtin:studio", sensors=own))
    config = json.loads(replay.config)
    sensors = [{"kind": "rgb", "settings": big}, {"kind": "gps"}, {"kind": "audio"}]
    if at == "sensors":
        config["sensors"] = sensors
    elif at == "agents":
        config["agents"] = [{"agent": 0, "sensors": sensors}]
    with_pictures = dataclasses.replace(replay, config=json.dumps(config))
    runner = with_pictures._runner(None, None, None, None)
    assert "rgb" not in {spec.name for spec in runner.specs}
    assert [spec.name for spec in runner.specs if spec.name == "audio"] or at == "task"
    assert with_pictures.first_difference() is None


def test_it_is_seen_and_heard_again(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "seen"
    options = ["--sensors", "rgb,depth,audio", "--every", "3", "--width", "32", "--height", "24"]
    assert cli.main(["replay", str(file), *options, "--out", str(out)]) == 0
    names = sorted(path.name for path in out.iterdir())
    steps = ("00000", "00003", "00006")
    images = [f"{name}_{step}" for name in ("depth", "rgb") for step in steps]
    assert names == sorted(
        ["audio.wav", *(f"{name}.png" for name in images), *(f"depth_{k}.npy" for k in steps)]
    )
    assert np.load(out / "depth_00003.npy").shape == (24, 32, 1)
    sound, rate_hz = read_wav(out / "audio.wav")
    assert (rate_hz, sound.shape) == (16_000, (2, 800 * len(ACTIONS)))
    replay = dwell.Replay.read(file)
    heard = [moment.world.listen(moment.world.samples_a_step) for moment in replay.play()]
    assert np.array_equal(sound, np.concatenate(heard[1:], axis=1))


def test_files_are_numbered_and_endings_write(tmp_path: Path) -> None:
    env = ReplayRecorder(gymnasium.make("dwell/InstructionFollowing-v0", sensors=["gps"]), tmp_path)
    for _ in range(2):
        env.reset(seed=1)
        env.step(np.int64(1))
        env.step(np.int64(0))
    assert [path.name for path in sorted(tmp_path.iterdir())] == [
        "episode_0000.replay",
        "episode_0001.replay",
    ]
    one, other = (dwell.Replay.read(path) for path in sorted(tmp_path.iterdir()))
    assert one == other
    assert one.instruction.endswith(".")
    env.close()


def test_a_folder_is_the_one_that_it_was_when_it_was_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    env = ReplayRecorder(DwellEnv("Free", houses="builtin:studio", sensors=["gps"]), "here")
    env.reset(seed=1)
    env.step(1)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    env.close()
    assert [path.name for path in (tmp_path / "here").iterdir()] == ["episode_0000.replay"]


@pytest.mark.skipif(sys.platform == "win32", reason="modes of Unix")
def test_files_are_as_private_as_the_system_says(tmp_path: Path) -> None:
    before = os.umask(0o077)
    try:
        with atomic_write(tmp_path / "a.txt") as draft:
            draft.write_text("a")
    finally:
        os.umask(before)
    assert (tmp_path / "a.txt").stat().st_mode & 0o777 == 0o600


def test_python_parts_are_asked_for_and_never_imported_by_a_file(tmp_path: Path) -> None:
    replay = dwell.Replay.read(recorded(tmp_path, task=Shouting))
    assert replay.parts == ("Shouting",)
    with pytest.raises(dwell.UsageError, match="Shouting"):
        replay.first_difference()
    assert replay.first_difference(task=Shouting) is None


def test_what_no_file_can_hold_is_refused(tmp_path: Path, apartment: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match="handed over as an object"):
        ReplayRecorder(DwellEnv("Free", houses=apartment, sensors=["gps"]), tmp_path)
    env = DwellEnv("Free", sensors=["gps"])
    recorder = ReplayRecorder(env, tmp_path)
    recorder.reset(seed=1)
    snapshot = env.snapshot()
    recorder.step(np.int64(1))
    env.restore(snapshot)
    with pytest.raises(dwell.UsageError, match="something else than an action"):
        recorder.step(np.int64(1))
    recorder.close()
    with pytest.raises(dwell.ConfigError, match="expected an environment of dwell"):
        ReplayRecorder(gymnasium.make("CartPole-v1"), tmp_path)  # type: ignore[arg-type] # the fault


def test_steps_before_a_change_that_no_file_holds_are_written(tmp_path: Path) -> None:
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    recorder = ReplayRecorder(env, tmp_path)
    recorder.reset(seed=1)
    for _ in range(3):
        recorder.step(np.int64(1))
    env.world.listen()
    # Nothing goes on without a record, nor without a word.
    for _ in range(2):
        with pytest.raises(
            dwell.UsageError, match=r"are written in .*episode_0000\.replay; reset b"
        ):
            recorder.step(np.int64(1))
    recorder.reset(seed=2)
    env.world.listen()
    with pytest.raises(dwell.UsageError, match="no step was made before; reset begins another"):
        recorder.step(np.int64(1))
    recorder.reset(seed=3)
    recorder.step(np.int64(2))
    recorder.close()
    before, after = (dwell.Replay.read(path) for path in sorted(tmp_path.iterdir()))
    assert before.actions == ("move_forward",) * 3
    assert before.differences() == []
    assert after.actions == ("turn_left",)


def test_of_environments_that_step_together_the_changed_one_is_told_once(tmp_path: Path) -> None:
    bare = DwellVectorEnv(2, "Free", houses="builtin:studio", sensors=["gps"])
    envs = VectorReplayRecorder(bare, tmp_path)
    envs.reset(seed=1)
    saved = bare.snapshot()
    envs.step(np.array([1, 1]))
    bare.restore([None, saved[1]])
    told = r"world of environment 1 was .* its steps are made without a record$"
    with pytest.raises(dwell.UsageError, match=told):
        envs.step(np.array([1, 1]))
    envs.step(np.array([2, 1]))
    envs.close()
    changed, other = (dwell.Replay.read(path) for path in sorted(tmp_path.iterdir()))
    assert changed.actions == ("move_forward",)
    assert other.actions == ("move_forward", "turn_left")


WRONG: list[tuple[str, object, str]] = [
    ("format", "other", "no dwell-replay"),
    ("version", 4, "field 'stated' is missing in version 4"),
    ("version", 5, "field 'agents' is missing in version 5"),
    ("version", 6, "version is 6"),
    ("success", "yes", "success is 'yes'"),
    ("seed", -1, "seed is -1"),
    ("seed", 1e39, "seed is 1e+39"),
    ("house", 5, "house is 5"),
    ("config", [], "config is []"),
    ("parts", "x", "parts is 'x'"),
    ("actions", ["fly"], "actions[0] is 'fly'"),
    ("hashes", [], "0 hashes"),
    ("extra", 1, "'extra' is unknown"),
]


@pytest.mark.parametrize(("field", "value", "said"), WRONG)
def test_a_wrong_field_is_named(
    file: Path, tmp_path: Path, field: str, value: object, said: str
) -> None:
    row = {**json.loads(file.read_text("utf-8")), field: value}
    wrong = tmp_path / "wrong.replay"
    wrong.write_text(json.dumps(row), "utf-8")
    with pytest.raises(dwell.MeasuredDataError) as refused:
        dwell.Replay.read(wrong)
    assert said in str(refused.value)
    assert str(wrong) in str(refused.value)


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "null", "5", "\udcff"])
def test_what_is_no_replay_is_refused(tmp_path: Path, text: str) -> None:
    wrong = tmp_path / "wrong.replay"
    wrong.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(dwell.MeasuredDataError, match=str(wrong)):
        dwell.Replay.read(wrong)
    assert cli.main(["replay", str(wrong)]) == 1


def test_cut_files_are_refused(file: Path, tmp_path: Path) -> None:
    whole = file.read_bytes()
    for part in range(1, 10):
        cut = tmp_path / "cut.replay"
        cut.write_bytes(whole[: len(whole) * part // 10])
        with pytest.raises(dwell.MeasuredDataError):
            dwell.Replay.read(cut)


def test_a_house_or_setting_that_is_not_there_is_told(file: Path, tmp_path: Path) -> None:
    for field, value in (("house", "nowhere.glb"), ("config", {"task": "Nothing"})):
        row = {**json.loads(file.read_text("utf-8")), field: value}
        wrong = tmp_path / "wrong.replay"
        wrong.write_text(json.dumps(row), "utf-8")
        with pytest.raises(dwell.DwellError):
            dwell.Replay.read(wrong).first_difference()


@pytest.fixture(scope="module")
def instructed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("instructed")
    return recorded(folder, task="InstructionFollowing", houses="seed:3?home=studio")


EDITED: list[tuple[str, Any]] = [
    ("format", "dwell-replays"),
    ("version", 1),
    ("house", "seed:3?home=apartment"),
    ("house", "seed:3?home=studio&style=modern"),
    ("house", "seed:3?home=studio&furniture_density=2"),
    ("seed", 5),
    ("config", lambda config: {**config, "task": "Free"}),
    ("config", lambda config: {**config, "sensors": [{"kind": "compass", "settings": {}}]}),
    ("config", lambda config: {**config, "nothing": 5}),
    ("parts", ["Shouting"]),
    ("actions", lambda actions: ["turn_right", *actions[1:]]),
    ("actions", lambda actions: ["stop", *actions[1:]]),
    ("actions", lambda actions: actions[:-1]),
    ("hashes", lambda hashes: [*hashes[:-1], "0123456789abcdef"]),
    ("hashes", lambda hashes: [*hashes[:-1], hashes[-1].upper()]),
    ("instruction", "Do nothing."),
    ("success", True),
    ("made_by", "0.0.0"),
    ("sums", lambda sums: {**sums, "seed": "0" * 16}),
    ("sums", {}),
]


@pytest.mark.parametrize(("field", "value"), EDITED)
def test_whatever_is_edited_is_found_and_named(
    instructed: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    field: str,
    value: Any,  # noqa: ANN401 - what JSON holds, or what changes it
) -> None:
    row = json.loads(instructed.read_text("utf-8"))
    row[field] = value(row[field]) if callable(value) else value
    edited = tmp_path / "edited.replay"
    edited.write_text(json.dumps(row), "utf-8")
    assert cli.main(["replay", str(edited), "--verify"]) == 1
    told = capsys.readouterr().err
    assert str(edited) in told
    assert field in told


def test_every_field_of_a_file_is_among_those_edited(
    instructed: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert set(json.loads(instructed.read_text("utf-8"))) == {field for field, _ in EDITED}
    assert dwell.Replay.read(instructed).differences() == []
    assert cli.main(["replay", str(instructed), "--verify", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["differences"] == []


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("instruction", "Do nothing.", "instruction: the file states 'Do nothing.', played it is "),
        ("success", True, "success: the file states True, played it is False"),
        ("hashes", ["0" * 16] * (len(ACTIONS) + 1), "hashes[0]: the file states 0000000000000000"),
    ],
)
def test_forged_check_sums_do_not_help(
    instructed: Path, tmp_path: Path, field: str, value: object, said: str
) -> None:
    row = {**json.loads(instructed.read_text("utf-8")), field: value, "version": 1}
    del row["sums"]
    old = tmp_path / "old.replay"
    old.write_text(json.dumps(row), "utf-8")
    # As a file of its own, with sums of what it states now.
    dwell.Replay.read(old).write(tmp_path / "forged.replay")
    for file in (old, tmp_path / "forged.replay"):
        (told,) = dwell.Replay.read(file).differences()
        assert told.startswith(said)


@pytest.mark.parametrize("settings", [{"width": "big"}, {"height": -1}, {"preset": "dark"}])
def test_sensors_of_pictures_that_nobody_takes_are_told(
    instructed: Path, settings: dict[str, Any]
) -> None:
    replay = dwell.Replay.read(instructed)
    sensors = [{"kind": "gps"}, {"kind": "rgb", "settings": settings}]
    config = json.dumps({**json.loads(replay.config), "sensors": sensors})
    # They change no bit, so that nothing else would tell.
    told = dataclasses.replace(replay, config=config, sums=None).differences()
    assert [one for one in told if one.startswith("config: sensors[1]: ")], told


def test_it_is_of_a_version_of_dwell(instructed: Path, tmp_path: Path) -> None:
    row = json.loads(instructed.read_text("utf-8"))
    (tmp_path / "a.replay").write_text(json.dumps({**row, "made_by": "somebody"}), "utf-8")
    with pytest.raises(dwell.DwellError, match="made_by is 'somebody'; expected a version of dw"):
        dwell.Replay.read(tmp_path / "a.replay")


def test_errors_name_the_file(file: Path, tmp_path: Path) -> None:
    nowhere = tmp_path / "nowhere.replay"
    for path in (nowhere, tmp_path):
        with pytest.raises(OSError, match=str(path)):
            dwell.Replay.read(path)
    faults = [
        ("house", "nowhere.glb", "nowhere.glb"),
        ("config", {"task": "Nothing"}, "config: no task"),
        ("config", {"world": {"laws": [{"id": "drag"}]}}, "config: "),
        ("config", {"nothing": 1}, "config: unknown field `nothing`"),
        (
            "config",
            {"world": {"sound_rate_hz": -1}},
            "config: world.sound_rate_hz: found integer `-1`",
        ),
        ("config", {"sensors": [{"kind": [], "settings": {}}]}, "config: sensors[0].kind is []"),
        ("config", {"task": {}}, "config: task"),
        ("config", {"agents": [{"task": []}]}, "config: agents[0].task"),
        ("parts", ["Shouting"], "Shouting"),
    ]
    for field, value, said in faults:
        row = {**json.loads(file.read_text("utf-8")), field: value}
        wrong = tmp_path / "wrong.replay"
        wrong.write_text(json.dumps(row), "utf-8")
        with pytest.raises(dwell.DwellError) as refused:
            next(dwell.Replay.read(wrong).play())
        assert dwell.Replay.read(wrong).differences()
        assert str(refused.value).startswith(f"{wrong}: ")
        assert said in str(refused.value)


def test_a_folder_that_is_none_is_refused_when_a_recorder_is_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
    for folder in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(NotADirectoryError):
            ReplayRecorder(env, folder)
    assert (tmp_path / "file").read_text() == "mine"


def test_listening_changes_a_recording_only_where_no_ears_were_open(tmp_path: Path) -> None:
    """As docs/replays.md says: the sound that ears keep is part of the state."""
    for sensors, is_heard in (["gps"], False), (["gps", "audio"], True):
        folder = tmp_path / "_".join(sensors)
        env = ReplayRecorder(DwellEnv("Free", houses="builtin:studio", sensors=sensors), folder)
        env.reset(seed=1)
        for _ in range(3):
            env.step(np.int64(1))
        env.close()
        replay = dwell.Replay.read(folder / "episode_0000.replay")
        same = []
        for moment in replay.play():
            same.append(moment.is_same)
            moment.world.listen(100)
        assert same == [True, is_heard, is_heard, is_heard]
        assert replay.first_difference() is None


def test_actions_that_can_be_read_once_are_refused(file: Path) -> None:
    replay = dwell.Replay.read(file)
    once = dataclasses.replace(replay, actions=iter(replay.actions))  # type: ignore[arg-type] # what is tested
    with pytest.raises(dwell.MeasuredDataError, match=r"actions is .*; expected a list"):
        once.check()


def test_the_longest_replay_has_one_hash_more_than_actions(file: Path) -> None:
    replay = dwell.Replay.read(file)
    most = replays.MAX_STEPS
    longest = dataclasses.replace(replay, hashes=("0" * 16,) * (most + 1))
    with pytest.raises(dwell.MeasuredDataError, match=f"and {most + 1} hashes; expected at most"):
        longest.check()
    longer = dataclasses.replace(replay, hashes=("0" * 16,) * (most + 2))
    with pytest.raises(dwell.MeasuredDataError, match=f"has more than {most + 1} elements"):
        longer.check()
