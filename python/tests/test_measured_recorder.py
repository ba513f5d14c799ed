"""The recorder of environments, the picture of what was recorded, and the advice."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from PIL import Image
from test_measured_kinds import JOINT
from test_slips import DRIVE, FLIGHT, POSES, brought

import dwell
from dwell import cli
from dwell.calibration import Recorder, coverage
from dwell.measured.importing import import_files

DT_S = 0.02


class Arm(gymnasium.Env[dict[str, Any], Any]):
    """A robot's wrapper as a lab has it: counts of an encoder, a goal in degrees."""

    def __init__(self, steps: int = 40) -> None:
        self.observation_space = gymnasium.spaces.Dict(
            {
                "counts": gymnasium.spaces.Box(-1e6, 1e6, (2,), np.float64),
                "camera": gymnasium.spaces.Box(0, 255, (96, 96, 3), np.uint8),
            }
        )
        self.action_space = gymnasium.spaces.Box(-180.0, 180.0, (1,), np.float64)
        self.steps, self.k, self.angle = steps, 0, 0.0

    def _seen(self) -> dict[str, Any]:
        counts = np.array([0.0, 2048 + round(self.angle / 360 * 4096)])
        return {"counts": counts, "camera": np.zeros((96, 96, 3), np.uint8)}

    def reset(self, **more: Any) -> tuple[dict[str, Any], dict[str, Any]]:  # noqa: ANN401
        super().reset(**more)
        self.k, self.angle = 0, 0.0
        return self._seen(), {"temperature": 31.0}

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:  # noqa: ANN401
        if math.isnan(action[0]):
            raise RuntimeError("broken")
        self.k += 1
        self.angle += 0.3 * (float(action[0]) - self.angle)
        return self._seen(), 0.0, False, self.k >= self.steps, {"temperature": 31.0}


MAP: dict[str, Any] = {
    "kind": "servo",
    "joint": JOINT,
    "table": {
        "position": "observation.counts[1]",
        "target": "action[0]",
        "units": {
            "observation.counts[1]": {"counts_per_turn": 4096, "zero": 2048},
            "action[0]": "deg",
        },
    },
}


def played(env: gymnasium.Env[Any, Any], episodes: int = 4) -> None:
    for episode in range(episodes):
        env.reset(seed=episode)
        over, k = False, 0
        while not over:
            goal = 40.0 if (k // 10) % 2 else -20.0 * (1 + episode)
            _, _, terminated, truncated, _ = env.step(np.array([goal]))
            over, k = terminated or truncated, k + 1


def test_a_robot_s_wrapper_is_recorded_as_a_bundle(tmp_path: Path) -> None:
    recorder = Recorder(Arm(), tmp_path / "arm.measured", MAP, step_s=DT_S)
    recorder.conditions = "no load"
    played(recorder)
    # The last observations have no action, and no target that they would need.
    assert recorder.write() == {"rows": 164, "episodes": 4, "left_out": 0}
    with (tmp_path / "arm.measured" / "trajectory.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["t_s"]) for row in rows[:3]] == pytest.approx([0.0, DT_S, 2 * DT_S])
    # One step brings it three tenths of the way to -20 degrees.
    counts = round(-6.0 / 360 * 4096)
    assert float(rows[1]["value"]) == pytest.approx(2 * math.pi * counts / 4096)
    with (tmp_path / "arm.measured" / "command.csv").open() as file:
        commands = [row for row in csv.DictReader(file) if row["episode"] == "e1"]
    assert [float(row["t_s"]) for row in commands] == pytest.approx([0.0, 0.2, 0.4, 0.6])
    assert float(commands[0]["value"]) == pytest.approx(math.radians(-20.0))
    with (tmp_path / "arm.measured" / "episodes.csv").open() as file:
        episodes = list(csv.DictReader(file))
    assert [row["split_group"] for row in episodes] == ["e1", "e2", "e3", "e4"]
    assert {row["conditions"] for row in episodes} == {"no load"}


def test_log_and_map_stand_beside_the_bundle_and_import_as_it_did(tmp_path: Path) -> None:
    with Recorder(Arm(), tmp_path / "arm.measured", MAP, step_s=DT_S) as recorder:
        recorder.group = "morning"
        played(recorder)
    log, mapping = tmp_path / "arm.log.csv", tmp_path / "arm.map.json"
    command = ["measure", "import", str(log), "--map", str(mapping)]
    assert cli.main([*command, "--out", str(tmp_path / "b.measured")]) == 0
    for name in ("trajectory.csv", "command.csv", "episodes.csv"):
        again = (tmp_path / "b.measured" / name).read_text()
        assert (tmp_path / "arm.measured" / name).read_text() == again
    assert "morning" in again


@pytest.mark.parametrize("told", ["x", None, float("nan"), [1.0]])
def test_a_clock_that_tells_no_number_is_refused(told: object, tmp_path: Path) -> None:
    clock: Any = lambda: told  # noqa: E731
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, clock=clock)
    with pytest.raises(dwell.ConfigError, match="what clock returned, s, is"):
        recorder.reset(seed=1)


def test_a_clock_tells_the_times_where_no_step_is_given(tmp_path: Path) -> None:
    now = iter(np.cumsum(np.full(1000, 0.03)) + 1e9)
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, clock=lambda: float(next(now)))
    played(recorder)
    recorder.write()
    with (tmp_path / "a.measured" / "trajectory.csv").open() as file:
        times = [float(row["t_s"]) for row in csv.DictReader(file)][:3]
    assert np.diff(times) == pytest.approx([0.03, 0.03], abs=1e-6)


def test_a_recording_that_is_refused_is_kept(tmp_path: Path) -> None:
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S)
    played(recorder, 1)
    with pytest.raises(ValueError, match=r"a\.log\.csv: 1.*episodes"):
        recorder.write()
    assert not (tmp_path / "a.measured").exists()
    assert len((tmp_path / "a.log.csv").read_text().splitlines()) == 42
    # What was written once is not tried again.
    recorder.close()


def episodes_of(bundle: Path) -> list[str]:
    with (bundle / "episodes.csv").open() as file:
        return [row["episode"] for row in csv.DictReader(file)]


def test_what_comes_after_a_refused_write_is_written_at_the_end(tmp_path: Path) -> None:
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S)
    played(recorder, 2)
    with pytest.raises(dwell.MeasuredDataError, match="2 episodes"):
        recorder.write()
    played(recorder, 1)
    with pytest.raises(dwell.MeasuredDataError, match="3 episodes"):
        recorder.close()
    played(recorder, 1)
    recorder.close()
    assert episodes_of(tmp_path / "a.measured") == ["e1", "e2", "e3", "e4"]


def test_what_comes_after_a_bundle_is_put_into_it(tmp_path: Path) -> None:
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S)
    played(recorder, 4)
    recorder.write()
    recorder.reset()
    recorder.step(np.array([10.0]))
    log = tmp_path / "a.log.csv"
    before = log.read_text()
    # As a disk does that a robot's own program spoils.
    log.write_text(before.replace("e2,", "e2,,"))
    with pytest.raises(dwell.MeasuredDataError, match=r"a\.log\.csv"):
        recorder.write()
    # The bundle that was there is there, and nothing else.
    assert episodes_of(tmp_path / "a.measured") == ["e1", "e2", "e3", "e4"]
    assert {path.name for path in tmp_path.iterdir()} == {"a.measured", "a.log.csv", "a.map.json"}
    log.write_text(before)
    played(recorder, 1)
    recorder.close()
    assert episodes_of(tmp_path / "a.measured") == ["e1", "e2", "e3", "e4", "e6"]


CUT_SHORT = "1 episode of fewer than 6 rows: left out 'e5' (2 rows)"


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_what_ends_a_block_comes_out_and_whole_episodes_are_the_bundle(
    tmp_path: Path, error: type[BaseException], caplog: pytest.LogCaptureFixture
) -> None:
    def stopped() -> None:
        with Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S) as recorder:
            played(recorder)
            recorder.reset()
            recorder.step(np.array([10.0]))
            raise error("the user's own")

    with pytest.raises(error, match="the user's own"):
        stopped()
    assert episodes_of(tmp_path / "a.measured") == ["e1", "e2", "e3", "e4"]
    assert CUT_SHORT in caplog.text
    # The files beside it make the same bundle.
    counts = import_files(
        [tmp_path / "a.log.csv"], tmp_path / "a.map.json", tmp_path / "b.measured", lambda *_: None
    )
    assert counts["notes"] == [CUT_SHORT]


def test_what_forbids_the_bundle_does_not_hide_what_ends_a_block(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    def stopped() -> None:
        with Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S) as recorder:
            recorder.reset()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    told = "fewer than 6 rows: left out 'e1' (1 rows); none is left"
    assert (
        f"a.measured was not written: {tmp_path / 'a.log.csv'}: 1 episode of {told}" in caplog.text
    )
    with (
        pytest.raises(dwell.MeasuredDataError, match="3 episodes"),
        Recorder(Arm(), tmp_path / "b.measured", MAP, step_s=DT_S) as recorder,
    ):
        played(recorder, 3)


def test_an_interrupt_while_a_row_is_written_does_not_write_it_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder = Recorder(Arm(), tmp_path / "a.measured", MAP, step_s=DT_S)
    played(recorder)
    recorder.reset()
    write = Recorder._write

    def interrupted(self: Recorder[Any, Any], row: Any) -> None:  # noqa: ANN401
        write(self, row)
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(Recorder, "_write", interrupted)
        with pytest.raises(KeyboardInterrupt):
            recorder.step(np.array([10.0]))
    recorder.close()
    rows = (tmp_path / "a.log.csv").read_text().splitlines()
    assert [row.split(",")[0] for row in rows].count("e5") == 1


def test_steps_without_a_reset_are_not_recorded(tmp_path: Path) -> None:
    with Recorder(Arm(steps=40), tmp_path / "a.measured", MAP, step_s=DT_S) as recorder:
        recorder.step(np.array([10.0]))
        played(recorder, 3)
        recorder.step(np.array([10.0]))
        recorder.reset()
        for _ in range(10):
            recorder.step(np.array([10.0]))
        with pytest.raises(RuntimeError, match="broken"):
            recorder.step(np.array([math.nan]))
        recorder.step(np.array([10.0]))
    with (tmp_path / "a.log.csv").open() as file:
        rows = list(csv.DictReader(file))
    names = [row["episode"] for row in rows]
    assert [names.count(f"e{k}") for k in range(6)] == [0, 41, 41, 41, 11, 0]


def test_a_map_may_be_a_file(tmp_path: Path) -> None:
    (tmp_path / "map.json").write_text(json.dumps(MAP))
    with Recorder(Arm(), tmp_path / "a.measured", tmp_path / "map.json", step_s=DT_S) as recorder:
        played(recorder)
    assert len(episodes_of(tmp_path / "a.measured")) == 4
    for text, told in (
        ("[]", r"map\.json: found \[\]; an object"),
        ("{", r"map\.json"),
        ('{"kind": "x"}', r"map\.json: kind is 'x'"),
        (json.dumps({**MAP, "confirmed": False}), r"map\.json: \"confirmed\" is false"),
    ):
        (tmp_path / "map.json").write_text(text)
        with pytest.raises(dwell.ConfigError, match=told):
            Recorder(Arm(), tmp_path / "b.measured", str(tmp_path / "map.json"))
    with pytest.raises(FileNotFoundError):
        Recorder(Arm(), tmp_path / "b.measured", "none.json")
    with pytest.raises(dwell.ConfigError, match="mapping is 3; expected a map or the path of one"):
        Recorder(Arm(), tmp_path / "b.measured", 3)  # type: ignore[arg-type]
    with pytest.raises(dwell.ConfigError, match=r"allowed is .*b\.measured"):
        Recorder(Arm(), tmp_path / "b.csv", MAP)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m.update(kind="impulse_response"), "kind is 'impulse_response'; a recorder wri"),
        (lambda m: m.pop("kind"), "kind is None"),
        (lambda m: m.pop("table"), "'table' is missing"),
        (lambda m: m["table"].update(file="x.csv"), "'file' is the recorder's own; leave it out"),
        (lambda m: m["table"].update(speed="x"), "no key 'speed'; allowed are"),
        (
            lambda m: m["table"].update(position="observation.pos"),
            "no number 'observation.pos'; th",
        ),
        (lambda m: m["table"].update(target="action.goal"), "no number 'action.goal'; there are"),
    ],
)
def test_slips_are_told_when_they_are_made(tmp_path: Path, change: Any, told: str) -> None:  # noqa: ANN401
    mapping = json.loads(json.dumps(MAP))
    change(mapping)
    with pytest.raises(dwell.ConfigError, match=told):
        played(Recorder(Arm(), tmp_path / "a.measured", mapping, step_s=DT_S))


@pytest.mark.parametrize("out", ["/", ".", ".."])
def test_a_folder_is_no_new_bundle(out: str) -> None:
    with pytest.raises(FileExistsError, match="is there already; remove it or choose"):
        Recorder(Arm(), out, MAP, step_s=DT_S)


def test_nothing_is_written_over(tmp_path: Path) -> None:
    (tmp_path / "a.log.csv").write_text("")
    with pytest.raises(FileExistsError, match=r"a\.log\.csv: is there already"):
        Recorder(Arm(), tmp_path / "a.measured", MAP)
    with pytest.raises(dwell.ConfigError, match="nothing was recorded"):
        Recorder(Arm(), tmp_path / "b.measured", MAP).write()
    with pytest.raises(dwell.ConfigError, match="step_s"):
        Recorder(Arm(), tmp_path / "b.measured", MAP, step_s=0.0)


@pytest.mark.parametrize(
    ("mapping", "names"),
    [
        (FLIGHT, ("speed, m/s", "height, m")),
        (POSES, ("speed, m/s", "spin, rad/s")),
        (DRIVE, ("speed, m/s", "turning to the left, rad/s")),
    ],
    ids=["flight", "poses", "drive"],
)
def test_recorded_states_are_drawn(
    tmp_path: Path, mapping: dict[str, Any], names: tuple[str, str]
) -> None:
    brought(tmp_path, mapping)
    found = coverage(tmp_path / "o.measured")
    assert found.names == names
    assert any("4 episodes: record 12 or more" in told for told in found.advice)
    assert 0.0 < found.share < 1.0
    picture = found.picture(width=200)
    assert picture.width == 200
    assert len(picture.getcolors(1 << 16)) > 10  # type: ignore[arg-type]


def test_advice_fits_what_was_recorded(tmp_path: Path) -> None:
    brought(tmp_path, DRIVE)
    advice = " ".join(coverage(tmp_path / "o.measured").advice)
    assert "it turns to the right in 0% of the time" in advice
    (tmp_path / "o.measured").rename(tmp_path / "drive")
    brought(tmp_path, FLIGHT)
    # Speeds of 2.4 m/s in all throws.
    assert "nearly one speed" in " ".join(coverage(tmp_path / "o.measured").advice)
    (tmp_path / "o.measured").rename(tmp_path / "flight")
    brought(tmp_path, POSES)
    advice = " ".join(coverage(tmp_path / "o.measured").advice)
    assert "0 of 4 episodes end at rest" in advice
    assert "spin" not in advice


def test_speeds_and_spins_are_those_of_the_motion(tmp_path: Path) -> None:
    brought(tmp_path, POSES)
    found = coverage(tmp_path / "o.measured")
    assert found.y == pytest.approx(np.full(160, 4.0), rel=1e-6)
    t = np.arange(40) / 100.0
    speed = np.sqrt(1.0 + 0.25 + (2.0 - 9.81 * t) ** 2)
    # The ends have differences to one side.
    assert found.x[1:39] == pytest.approx(speed[1:39], rel=1e-6)


def test_the_command_draws_and_advises(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorder = Recorder(Arm(), tmp_path / "arm.measured", MAP, step_s=DT_S)
    played(recorder)
    recorder.write()
    bundle, out = str(tmp_path / "arm.measured"), tmp_path / "c.png"
    assert cli.main(["measure", "coverage", bundle, "--out", str(out)]) == 0
    assert "4 episodes: record 12" in capsys.readouterr().out
    with Image.open(out) as picture:
        assert picture.size[0] == 640
    assert cli.main(["measure", "coverage", bundle, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["axes"] == ["position, rad", "speed, rad/s"]
    assert cli.main(["measure", "coverage", bundle, "--out", "x.jpg"]) == 1
    assert "a name that ends in .png is needed" in capsys.readouterr().err


def test_impulse_responses_have_no_states(tmp_path: Path) -> None:
    with pytest.raises(dwell.MeasuredDataError):
        coverage(tmp_path / "none.measured")
