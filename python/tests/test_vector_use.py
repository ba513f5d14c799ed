"""Environments that step together are looked at, recorded, limited and closed."""

from __future__ import annotations

import json
import sys
import types
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
from dwell import cli
from dwell.envs import DwellEnv, DwellVectorEnv, ReplayRecorder, VectorReplayRecorder

pytestmark = pytest.mark.usefixtures("open_once")

SMALL = {"rgb": {"width": 16, "height": 16}, "instruction": {}}
STUDIO = "builtin:studio"


def test_frames_are_those_of_single_environments() -> None:
    many = gymnasium.make_vec(
        "dwell/Free-v0", 2, houses=STUDIO, sensors=["gps"], render_mode="rgb_array"
    )
    assert many.metadata["render_fps"] == DwellEnv.metadata["render_fps"]
    assert many.render_mode == "rgb_array"
    many.reset(seed=3)
    frames = many.render()
    assert isinstance(frames, tuple)
    for k, frame in enumerate(frames):
        one = DwellEnv("Free", houses=STUDIO, sensors=["gps"], render_mode="rgb_array")
        one.reset(seed=3 + k)
        assert np.array_equal(frame, one.render())  # type: ignore[arg-type] # has a mode
    many.close()
    assert DwellVectorEnv(1, "Free", houses=STUDIO, sensors=["gps"]).render() is None
    with pytest.raises(dwell.ConfigError, match="render_mode: found 'human'"):
        DwellVectorEnv(1, houses=STUDIO, render_mode="human")


def test_gymnasium_records_videos_of_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    videos: list[tuple[list[Any], float]] = []

    class Clip:
        def __init__(self, frames: list[Any], fps: float) -> None:
            videos.append((frames, fps))

        def write_videofile(self, path: str, **_: object) -> None:
            Path(path).touch()

        def close(self) -> None:
            pass

    # Only what writes the file stands in.
    names = ["moviepy", "moviepy.video", "moviepy.video.io", "moviepy.video.io.ImageSequenceClip"]
    for name in names:
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    sys.modules[names[-1]].ImageSequenceClip = Clip  # type: ignore[attr-defined] # stands in
    sys.modules["moviepy"].video = sys.modules["moviepy.video"]  # type: ignore[attr-defined]
    many = DwellVectorEnv(2, "Free", houses=STUDIO, sensors=["gps"], render_mode="rgb_array")
    folder = tmp_path / "videos"
    recorded = gymnasium.wrappers.vector.RecordVideo(
        many, str(folder), episode_trigger=lambda episode: episode == 0
    )
    recorded.reset(seed=1)
    for _ in range(3):
        recorded.step(np.array([1, 2]))
    recorded.close()
    ((frames, fps),) = videos
    assert (len(frames), fps) == (4, 20)
    assert frames[0].size == 2 * 240 * 320 * 3


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_every_episode_of_many_is_a_replay(tmp_path: Path, mode: str) -> None:
    envs = VectorReplayRecorder(
        gymnasium.make_vec(
            "dwell/InstructionFollowing-v0",
            2,
            houses=[STUDIO, "seed:1?home=studio"],
            sensors={"gps": {}},
            autoreset_mode=mode,
            max_episode_steps=3,
        ),
        tmp_path,
    )
    _, infos = envs.reset(seed=4)
    ids = [*infos["episode_id"]]
    for actions in ([1, 3], [0, 1], [1, 2], [3, 1], [1, 1]):
        *_, terminated, truncated, infos = envs.step(np.array(actions))
        if mode == "Disabled" and (terminated | truncated).any():
            _, infos = envs.reset(options={"reset_mask": terminated | truncated})
        ids += [one for one in infos["episode_id"] if one not in ids]
    envs.close()
    files = sorted(tmp_path.iterdir())
    replays = [dwell.Replay.read(file) for file in files]
    played = [f"{replay.house}#{replay.seed}" for replay in replays]
    # An episode in which nothing was done is none.
    assert len(set(played)) == len(played) >= 4
    assert set(played) >= set(ids[:-2])
    assert set(played) <= set(ids)
    first = replays[played.index(ids[0])]
    assert first.actions == ("move_forward", "stop")
    assert replays[played.index(ids[1])].actions[:2] == ("turn_right", "move_forward")
    houses = {replay.house: dwell.House.open(replay.house) for replay in replays}
    for replay in replays:
        assert replay.first_difference(house=houses[replay.house]) is None
    assert cli.main(["replay", str(files[0]), "--verify"]) == 0


def test_what_no_file_can_hold_is_refused(tmp_path: Path, shoebox: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match="handed over as an object"):
        VectorReplayRecorder(DwellVectorEnv(1, "Free", houses=shoebox, sensors=["gps"]), tmp_path)
    many = DwellVectorEnv(2, "Free", houses=STUDIO, sensors=["gps"])
    with pytest.raises(dwell.ConfigError, match="VectorReplayRecorder records such"):
        ReplayRecorder(many, tmp_path)  # type: ignore[arg-type] # the fault
    with pytest.raises(dwell.ConfigError, match="expected a vector environment of dwell"):
        VectorReplayRecorder(gymnasium.make_vec("CartPole-v1"), tmp_path)
    recorder = VectorReplayRecorder(many, tmp_path)
    recorder.reset(seed=1)
    recorder.step(np.array([1, 1]))
    saved = many.snapshot()
    recorder.step(np.array([1, 1]))
    many.restore([None, saved[1]])
    with pytest.raises(dwell.UsageError, match="the world of environment 1 was changed"):
        recorder.step(np.array([1, 1]))
    recorder.close()
    # The steps before the change are kept, those of the changed environment too.
    steps = [len(dwell.Replay.read(file).actions) for file in sorted(tmp_path.iterdir())]
    assert steps == [2, 2]


@pytest.mark.parametrize("limit", [float("nan"), 0, -2, float("inf"), 2.5, True, "7"])
def test_a_limit_is_a_whole_number_of_steps(limit: Any) -> None:  # noqa: ANN401 - what is refused
    for make in (DwellEnv, lambda **given: DwellVectorEnv(1, **given)):
        with pytest.raises(dwell.ConfigError, match=r"max_episode_steps is .* from 1"):
            make(houses=STUDIO, sensors=SMALL, max_episode_steps=limit)


def test_any_whole_number_of_steps_is_a_limit_and_none_is_none(shoebox: dwell.House) -> None:
    for limit in (None, -1, 1, 10**5000):
        env = DwellVectorEnv(1, "Free", houses=shoebox, sensors=["gps"], max_episode_steps=limit)
        env.reset(seed=1)
        assert env.step(np.array([6]))[3].tolist() == [limit == 1]
        env.close()


def test_an_unknown_autoreset_mode_is_answered_with_those_there_are() -> None:
    for mode in ("x", None, 3):
        with pytest.raises(dwell.ConfigError, match="allowed are 'NextStep', 'SameStep', 'Dis"):
            DwellVectorEnv(1, houses=STUDIO, autoreset_mode=mode)  # type: ignore[arg-type]


def test_what_is_closed_answers_no_call_but_close() -> None:
    many = DwellVectorEnv(1, houses=STUDIO, sensors=SMALL, render_mode="rgb_array")
    many.reset(seed=1)
    saved = many.snapshot()
    many.close()
    many.close()
    for call in (
        lambda: many.reset(),
        lambda: many.step(np.array([1])),
        many.render,
        many.snapshot,
        lambda: many.restore(saved),
        many.expert_actions,
        many.state_hashes,
    ):
        with pytest.raises(dwell.UsageError, match="closed"):
            call()
    one = DwellEnv(houses=STUDIO, sensors=SMALL, render_mode="rgb_array")
    one.reset(seed=1)
    kept = one.snapshot()
    one.close()
    for call in (
        one.render,
        one.snapshot,
        lambda: one.restore(kept),
        one.expert_action,
        one.state_hash,
        one.instruction,
        one.agents,
        one.describe,
        one.actions,
    ):
        with pytest.raises(dwell.UsageError, match="closed"):
            call()


def test_a_restored_episode_is_truncated_at_the_same_step() -> None:
    given = {"houses": STUDIO, "sensors": ["gps"]}
    env_id = "dwell/Free-v0"
    envs = (
        gymnasium.make(env_id, max_episode_steps=6, **given),
        gymnasium.wrappers.TimeLimit(DwellEnv("Free", **given), 6),  # type: ignore[arg-type]
        DwellEnv("Free", max_episode_steps=6, **given),  # type: ignore[arg-type]
    )
    for env in envs:
        env.reset(seed=1)
        for _ in range(2):
            env.step(np.int64(6))
        saved = env.unwrapped.snapshot()  # type: ignore[attr-defined] # a DwellEnv
        assert [env.step(np.int64(6))[3] for _ in range(4)] == [False] * 3 + [True]
        # Back within the episode, and into it from another one.
        for seed in (None, 7):
            if seed is not None:
                env.reset(seed=seed)
            env.unwrapped.restore(saved)  # type: ignore[attr-defined] # a DwellEnv
            assert [env.step(np.int64(6))[3] for _ in range(4)] == [False] * 3 + [True]
        env.close()


HUGE = "9" * 5000
DEEP = b"[" * 100_000


def test_ids_and_snapshots_of_any_text_are_refused_with_a_sentence() -> None:
    one = DwellEnv(houses=STUDIO, sensors=SMALL)
    many = DwellVectorEnv(1, houses=STUDIO, sensors=SMALL)
    one.reset(seed=1)
    many.reset(seed=1)
    ids: list[Any] = [
        f"{STUDIO}#{HUGE}",
        f"{STUDIO}#٣",
        f"{STUDIO}#-1",
        HUGE,
        (10**4999) * 10,
        "\0",
    ]
    for episode_id in ids:
        with pytest.raises(dwell.ConfigError, match="HOUSE#NUMBER") as refused:
            one.reset(options={"episode_id": episode_id})
        assert len(str(refused.value)) < 500
        with pytest.raises(dwell.ConfigError, match="HOUSE#NUMBER"):
            many.reset(options={"episode_id": [episode_id]})
    episode = f"{STUDIO}#1".encode()
    head = b"dwvec2\0"
    told = json.dumps({"episode_id": f"{STUDIO}#{HUGE}", "done": False, "stream": {}}).encode()
    for snapshot in (
        f"{STUDIO}#{HUGE}".encode(),
        episode,
        b"\xff" * 99,
        DEEP,
        episode + b"\0" + DEEP + b"\0x",
        head + DEEP + b"\0\0",
        head + told + b"\0\0",
        head + told.replace(b"{}", HUGE.encode()) + b"\0\0",
        head + told.replace(b"{}", DEEP) + b"\0\0",
    ):
        with pytest.raises(dwell.ConfigError):
            one.restore(snapshot)
        with pytest.raises(dwell.ConfigError):
            many.restore([snapshot])
    for seed in (10**5000, [10**5000]):
        with pytest.raises(dwell.ConfigError, match="seed is"):
            many.reset(seed=seed)


def test_what_memory_cannot_hold_is_refused_with_how_many_it_would() -> None:
    large = {"rgb": {"width": 4096, "height": 4096}}
    with pytest.raises(dwell.ConfigError, match=r"num_envs is 65536; allowed is at most \d+ on"):
        DwellVectorEnv(65_536, houses=STUDIO, sensors=large)
    names = ["rgb", "depth", "instance", "semantic", "normals", "albedo", "flow"]
    huge = {name: {"width": 16_384, "height": 16_384} for name in names}
    with pytest.raises(dwell.ConfigError, match=r"on this machine|smaller images"):
        DwellVectorEnv(65_536, houses=STUDIO, sensors=huge)
