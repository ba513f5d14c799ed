"""Maps that are filled in: each guess, once it is confirmed, must give what was measured."""

from __future__ import annotations

import contextlib
import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_measure import MAPS, shared
from test_measured_cleaning import in_world, swapped, tripled
from test_measured_kinds import JOINT, SERVO, log, recordings
from test_measured_readers import lerobot
from test_slips import DRIVE, FLIGHT, HEADS, POSES, Rows, brought, exchanged, scaled

import dwell
from dwell import cli
from dwell.measured.guessing import guessed_map
from dwell.measured.importing import import_files
from dwell.measured.names import bare, quaternion, triples, unit_in

KNOWN: dict[str, dict[str, Any]] = {
    "trajectory": {},
    "pose_trajectory": {"body": POSES["body"], "board": POSES["board"]},
    "drive": {"base": DRIVE["base"]},
}
TABLES = {"trajectory": "trajectory.csv", "pose_trajectory": "poses.csv", "drive": "drive.csv"}


def cells(path: Path) -> list[list[str]]:
    with path.open() as file:
        return [row[:2] + row[3:] for row in csv.reader(file)]


def confirmed(mapping: dict[str, Any], **known: Any) -> dict[str, Any]:  # noqa: ANN401
    """What a person does with a map: fill in what no file tells, and confirm it."""
    for key, value in known.items():
        mapping[key] = {**mapping.get(key, {}), **value}
    return {**mapping, "confirmed": True}


CASES: list[tuple[dict[str, Any], Callable[[Rows], object], str]] = [
    (FLIGHT, lambda rows: None, "t_s"),
    (FLIGHT, lambda rows: scaled(rows, 100.0, 2, 3, 4), "t_s"),
    (FLIGHT, lambda rows: scaled(rows, 1e3, 1), "time"),
    (FLIGHT, tripled, "t_s"),
    (POSES, lambda rows: None, "t_s"),
    (POSES, lambda rows: scaled(rows, 1e3, 1, 2, 3, 4, 9, 10, 11), "t"),
    (POSES, lambda rows: scaled(rows, 180 / math.pi, 12), "t_s"),
    (POSES, in_world, "t_s"),
    (POSES, tripled, "t_s"),
    (DRIVE, lambda rows: None, "t_s"),
    (DRIVE, lambda rows: scaled(rows, 180 / math.pi, 4), "t_s"),
    (DRIVE, lambda rows: scaled(rows, 1e6, 1), "stamp"),
]


@pytest.mark.parametrize(("mapping", "change", "clock"), CASES)
def test_what_is_guessed_gives_what_was_measured_once_it_is_confirmed(
    tmp_path: Path, mapping: dict[str, Any], change: Callable[[Rows], object], clock: str
) -> None:
    kind = mapping["kind"]
    brought(tmp_path, mapping)
    (tmp_path / "o.measured").rename(tmp_path / "wanted")

    def changed(rows: Rows) -> None:
        change(rows)

    # Writes the tables; whether it is imported as it stands does not matter here.
    head = HEADS[kind].replace("t_s", clock).replace("left,right", "left_ticks,right_ticks")
    with contextlib.suppress(ValueError):
        brought(tmp_path, mapping, changed, lambda text: text.replace(HEADS[kind], head))
    # Poses have no second table.
    files = [tmp_path / "data.csv", tmp_path / "index.csv"][: 1 if mapping is POSES else 2]
    guess = guessed_map(files)
    assert guess["kind"] == kind
    assert guess["confirmed"] is False
    path, out = tmp_path / "guess.json", tmp_path / "g.measured"
    path.write_text(json.dumps(guess))
    with pytest.raises(ValueError, match=r'guess\.json: "confirmed" is false: read its \d+ gue'):
        import_files(files, path, out, lambda *_: None)
    if kind == "trajectory":
        # Which of the columns is up is seen; nothing else is to be filled in.
        assert guess["axes"] == "y_up"
    path.write_text(json.dumps(confirmed(guess, **KNOWN[kind])))
    import_files(files, path, out, lambda *_: None)
    wanted, found = (cells(tmp_path / name / TABLES[kind]) for name in ("wanted", "g.measured"))
    assert len(wanted) == len(found)
    for a, b in zip(wanted[1:], found[1:], strict=True):
        assert a[0] == b[0]
        numbers = [[float(c) for c in row[1:] if c not in "xyz"] for row in (a, b)]
        if change is in_world:
            # The bundle's spins are in the frame that its manifest names.
            assert guess["poses"]["angular_velocity"] == "world"
            del numbers[0][-3:], numbers[1][-3:]
        assert numbers[0] == pytest.approx(numbers[1], rel=1e-5, abs=1e-5)


def test_every_guess_has_its_reason(tmp_path: Path) -> None:
    brought(tmp_path, POSES)
    guess = guessed_map([tmp_path / "data.csv"])
    why = guess["why"]
    assert why["axes"] == "column 'z' falls"
    assert why["table.units.x"] == "column 'z' falls by 9.81 a second squared: things do in m"
    assert why["poses.rate_hz"] == "times rise by 0.01 s as a rule"
    assert why["body.mass_kg"] == "in none of the files: fill it in"
    assert "agree with the rotations but for 0% of the turning" in why["poses.angular_velocity"]

    def leaves(part: dict[str, Any], at: str) -> list[str]:
        found = []
        for key, value in part.items():
            if isinstance(value, dict) and key not in ("why", "channels"):
                found += leaves(value, f"{at}{key}.")
            else:
                found.append(f"{at}{key}")
        return found

    bare_keys = {"kind", "confirmed", "why", "notes"}
    assert {*leaves(guess, "")} - bare_keys == {*why}


def test_an_array_s_order_is_guessed_by_the_spins(tmp_path: Path) -> None:
    head = HEADS["pose_trajectory"].replace("qx,qy,qz,qw", "q0,q1,q2,q3")
    with pytest.raises(ValueError, match=r"."):
        brought(tmp_path, POSES, swapped, lambda text: text.replace(HEADS["pose_trajectory"], head))
    table = guessed_map([tmp_path / "data.csv"])["table"]
    assert table["quaternion_wxyz"] == ["q0", "q1", "q2", "q3"]
    assert "quaternion_xyzw" not in table


def test_what_is_not_filled_in_is_refused(tmp_path: Path) -> None:
    brought(tmp_path, POSES)
    guess = confirmed(guessed_map([tmp_path / "data.csv"]))
    for known, told in (
        ({}, "body: 'mass_kg' is missing"),
        ({"body": {"name": "a", "mass_kg": 0.37}}, "body: 'half_extents_m' is missing"),
        ({"body": POSES["body"]}, "board: 'friction' is missing"),
        ({**KNOWN["pose_trajectory"], "axes": None}, "axes is null: which axis is up"),
    ):
        filled = {**guess, **known}
        (tmp_path / "map.json").write_text(json.dumps(filled))
        with pytest.raises(ValueError, match=told):
            import_files(
                [tmp_path / "data.csv"],
                tmp_path / "map.json",
                tmp_path / "b.measured",
                lambda *_: None,
            )


def test_flights_with_another_axis_up_and_heights_that_grow_downwards(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="another axis up"):
        brought(tmp_path, FLIGHT, lambda rows: exchanged(rows, 3, 4))
    assert guessed_map([tmp_path / "data.csv"])["axes"] == "z_up"
    with pytest.raises(ValueError, match="grow downwards"):
        brought(tmp_path, FLIGHT, lambda rows: scaled(rows, -1.0, 3))
    assert guessed_map([tmp_path / "data.csv"])["axes"] == ["x", "-y", "-z"]


def test_a_servo_among_several_is_asked_for(tmp_path: Path) -> None:
    log(tmp_path, lost=True)
    text = (tmp_path / "log.csv").read_text().replace("run,servo,ms", "run,servo,time_ms")
    (tmp_path / "log.csv").write_text(text)
    guess = guessed_map([tmp_path / "log.csv"])
    assert guess["table"]["only"] == {"servo": 3}
    assert "the table holds the servos [3, 4]: which?" in guess["why"]["table.only"]
    assert guess["table"]["units"]["pos"] == {"counts_per_turn": 4096, "zero": 2048}
    (tmp_path / "map.json").write_text(json.dumps(confirmed(guess, joint=JOINT)))
    counts = import_files(
        [tmp_path / "log.csv"], tmp_path / "map.json", tmp_path / "o.measured", lambda *_: None
    )
    assert counts["episodes"] == 4
    assert guess["table"]["position"] == SERVO["table"]["position"]


def test_a_lerobot_dataset_s_joint_is_guessed(tmp_path: Path) -> None:
    guess = guessed_map([lerobot(tmp_path)])
    assert guess["kind"] == "servo"
    table = guess["table"]
    assert (table["episode"], table["t_s"]) == ("episode_index", "timestamp")
    assert table["position"] == "observation.state.shoulder.pos"
    assert table["target"] == "action.shoulder.pos"
    assert "the first of 2 joints" in guess["why"]["table.position"]


def test_commands_on_a_topic_of_their_own_are_guessed(tmp_path: Path) -> None:
    module = pytest.importorskip("mcap.writer", reason="MCAP needs the package mcap")
    for run in range(4):
        with (tmp_path / f"run{run}.mcap").open("wb") as file:
            writer = module.Writer(file)
            writer.start()
            schema = writer.register_schema("numbers", "jsonschema", b"{}")
            states = writer.register_channel("/joint_states", "json", schema)
            goals = writer.register_channel("/arm/command", "json", schema)
            for k in range(30):
                at_ns = 1_700_000_000_000_000_000 + 50_000_000 * k
                state = json.dumps({"position": [0.02 * k]}).encode()
                writer.add_message(states, at_ns, state, at_ns)
                if k % 10 == 0:
                    goal = json.dumps({"data": [0.02 * (k + 10)]}).encode()
                    writer.add_message(goals, at_ns, goal, at_ns)
            writer.finish()
    files = sorted(tmp_path.glob("*.mcap"))
    guess = guessed_map(files)
    assert guess["table"]["part"] == "/joint_states"
    assert guess["table"]["episode"] == "{file}"
    commands = guess["commands"]
    assert (commands["part"], commands["target"]) == ("/arm/command", "data[0]")
    (tmp_path / "map.json").write_text(json.dumps(confirmed(guess, joint=JOINT)))
    out = tmp_path / "o.measured"
    assert import_files(files, tmp_path / "map.json", out, lambda *_: None)["rows"] == 120
    with (out / "command.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["episode"] == "run2"]
    assert [float(row["t_s"]) for row in rows] == pytest.approx([0.0, 0.5, 1.0])
    assert [float(row["value"]) for row in rows] == pytest.approx([0.2, 0.4, 0.6])


@pytest.mark.parametrize(
    ("name", "kind", "wanted"),
    [
        ("cube_toss", "pose_trajectory", {"axes": "z_up"}),
        ("ball_drops", "trajectory", {}),
        ("diffdrive_odometry", "drive", {}),
        ("servo_backlash", "servo", {}),
    ],
)
def test_real_sets_are_recognised(name: str, kind: str, wanted: dict[str, Any]) -> None:
    folder = shared() / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is absent")
    pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    guess = guessed_map([folder / "data.parquet", folder / "index.csv"])
    mapping = json.loads((MAPS / f"{name}.json").read_text())
    assert guess["kind"] == kind
    assert wanted.items() <= guess.items()
    keys = {*mapping["table"]} - {"metres_per_unit", "units", "episode", "split_group"}
    assert {key: guess["table"][key] for key in keys} == {k: mapping["table"][k] for k in keys}
    for part in ("poses", "base"):
        if part in mapping:
            assert guess[part]["rate_hz"] == mapping[part]["rate_hz"]
    if kind == "pose_trajectory":
        assert guess["poses"]["angular_velocity"] == "body"


def test_responses_are_guessed_from_a_table_of_wav_files(tmp_path: Path) -> None:
    recordings(tmp_path)
    guess = guessed_map([tmp_path / "index.csv"])
    assert guess["kind"] == "impulse_response"
    assert guess["table"]["wav"] == "wav"
    assert guess["table"]["gain"] == "gain"
    assert guess["table"]["source"] == "speaker"
    assert guess["places"]["sources"] == {"s0": None, "s1": None}


def test_files_in_which_nothing_is_known_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("colour,size\nred,1\n")
    with pytest.raises(ValueError, match=r"a\.csv: nothing that is known is measured there"):
        guessed_map([tmp_path / "a.csv"])
    (tmp_path / "b.csv").write_text("t,x,y,z\n")
    with pytest.raises(ValueError, match=r"b\.csv: no rows"):
        guessed_map([tmp_path / "b.csv"])
    with pytest.raises(ValueError, match="no table has a column of positions"):
        guessed_map([tmp_path / "a.csv"], "servo")


def test_the_command_prints_the_map_of_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    brought(tmp_path, FLIGHT)
    files = [str(tmp_path / "data.csv"), str(tmp_path / "index.csv")]
    for command in (["--init", *files], [*files, "--init"], ["--init", "trajectory", *files]):
        assert cli.main(["measure", "import", *command]) == 0
        assert json.loads(capsys.readouterr().out)["bodies"]["mass_kg"] == "mass_kg"
    assert cli.main(["measure", "import", "--init", "traject"]) == 1
    told = "--init is 'traject', which is no file that is there and no kind; of kinds did you mean"
    assert told in (said := capsys.readouterr().err)
    assert "allowed are pose_trajectory, trajectory, drive, servo, impulse_response" in said
    assert cli.main(["measure", "import", "--init", "servo"]) == 0
    template = json.loads(capsys.readouterr().out)
    assert template["confirmed"] is False
    assert template["joint"]["name"] == "elbow"


def test_units_and_triples_in_names() -> None:
    told = {
        "t [ms]": "ms",
        "x (cm)": "cm",
        "height_mm": "mm",
        "yaw_deg": "deg",
        "v_m_s": "m/s",
        "omega (rad/s)": "rad/s",
        "pos[0]": None,
        "theta": None,
        "grasp_success": None,
    }
    assert {name: unit_in(name) for name in told} == told
    assert bare("Height [mm]") == "height"
    assert triples(["index", "pos_x", "pos_y", "pos_z", "max"]) == [["pos_x", "pos_y", "pos_z"]]
    pose = [f"pose[{k}]" for k in range(3)]
    assert triples(pose) == [pose]
    names = [f"orientation.{axis}" for axis in "wxyz"]
    assert quaternion(names) == ([*names[1:], names[0]], True)
    assert np.all([quaternion(["x", "y", "z"]) is None])


def test_files_are_paths_or_texts(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("a,b\n" + "0,1\n" * 9)
    path = tmp_path / "a.csv"
    for files in ([str(path)], [path]):
        with pytest.raises(dwell.MeasuredDataError, match="nothing that is known"):
            guessed_map(files)
    with pytest.raises(dwell.ConfigError, match=r"files is 'a\.csv'; expected paths of files"):
        guessed_map("a.csv")
    with pytest.raises(dwell.ConfigError, match=r"files\[0\] is 3"):
        guessed_map([3])  # type: ignore[list-item]
    with pytest.raises(dwell.ConfigError, match="kind is 'flight'; allowed are drive"):
        guessed_map([path], "flight")
    with pytest.raises(FileNotFoundError):
        guessed_map([tmp_path / "none.csv"])


def test_no_files_are_refused() -> None:
    with pytest.raises(dwell.ConfigError, match="files is empty; expected one or more paths"):
        guessed_map([])
