"""Episodes as files."""

from __future__ import annotations

import json
import wave
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell import cli
from dwell.envs import DwellEnv, ReplayRecorder

ACTIONS = ["move_forward", "turn_left", "move_forward", "open", "look_down", "move_forward"]


class Shouting(dwell.Task):
    """Changes the world at the start, and draws at random."""

    sensors = ("gps",)

    def reset(self, world: dwell.World, rng: np.random.Generator) -> dwell.Ask:
        world.play("phone", at=world.house.rooms()[rng.integers(3)]["eye"], loop=True)
        return dwell.Ask("Stay.")


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
    with wave.open(str(out / "audio.wav")) as sound:
        assert (sound.getnchannels(), sound.getframerate()) == (2, 16_000)
        assert sound.getnframes() == 800 * len(ACTIONS)


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
    with pytest.raises(dwell.ConfigError, match="expected an environment of dwell"):
        ReplayRecorder(gymnasium.make("CartPole-v1"), tmp_path)  # type: ignore[arg-type] # the fault


WRONG: list[tuple[str, object, str]] = [
    ("format", "other", "no dwell-replay"),
    ("version", 2, "version is 2"),
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
