"""Servos, spins and impulse responses: what is written and what was made, and what is refused."""

from __future__ import annotations

import csv
import json
import math
import os
import shutil
import struct
import wave
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from dwell import _native
from dwell.measured.importing import import_files
from dwell.sounds import write_wav

ROOT = Path(__file__).resolve().parents[2]
MAPS = ROOT / "examples" / "measured"
DATA = Path(os.environ.get("DWELL_SHARED_DATA", ROOT.parent / "shared" / "data"))
JOINT = {
    "name": "elbow",
    "inertia_kg_m2": 0.01,
    "stiffness_n_m_rad": 40.0,
    "damping_n_m_s_rad": 1.0,
    "max_torque_n_m": 3.0,
}
COUNTS = {"counts_per_turn": 4096, "zero": 2048}
SERVO: dict[str, Any] = {
    "kind": "servo",
    "joint": JOINT,
    "table": {
        "file": "log.csv",
        "episode": "run",
        "only": {"servo": 3},
        "t_s": "ms",
        "units": {"ms": "ms", "pos": COUNTS, "goal": COUNTS},
        "position": "pos",
        "target": "goal",
    },
}


def brought(folder: Path, mapping: dict[str, Any], *names: str) -> dict[str, Any]:
    """Imports files of a folder."""
    (folder / "map.json").write_text(json.dumps(mapping))
    files = [folder / name for name in names]
    return import_files(files, folder / "map.json", folder / "o.measured", lambda *_: None)


def rows_of(folder: Path, table: str) -> list[dict[str, str]]:
    with (folder / "o.measured" / table).open() as file:
        return list(csv.DictReader(file))


def log(folder: Path, *, lost: bool = False) -> None:
    """Two servos at 10 Hz; of one, the target turns by a quarter after 1 s."""
    rows = ["run,servo,ms,goal,pos"]
    for run in "abcd":
        for k in range(30):
            goal = 2048 if k < 10 else 3072
            pos = 2048 if k < 12 else 3070
            cell = "" if lost and k in (0, 10) else pos
            rows.append(f"{run},3,{100 * k},{goal},{cell}")
            rows.append(f"{run},4,{100 * k},0,0")
    (folder / "log.csv").write_text("\n".join(rows) + "\n")


def test_counts_of_one_servo_become_angles_and_its_target_commands(tmp_path: Path) -> None:
    log(tmp_path)
    assert brought(tmp_path, SERVO, "log.csv") == {"rows": 120, "episodes": 4, "left_out": 0}
    samples = rows_of(tmp_path, "trajectory.csv")
    assert {row["channel"] for row in samples} == {"position"}
    assert [float(samples[k]["value"]) for k in (0, 29)] == pytest.approx(
        [0.0, 2 * math.pi * 1022 / 4096]
    )
    assert float(samples[29]["t_s"]) == 2.9
    commands = rows_of(tmp_path, "command.csv")[:2]
    assert [float(row["t_s"]) for row in commands] == [0.0, 1.0]
    assert [float(row["value"]) for row in commands] == pytest.approx([0.0, math.pi / 2])
    assert _native.check_measured(str(tmp_path / "o.measured")) == 4


def test_a_target_counts_where_no_position_was_read(tmp_path: Path) -> None:
    log(tmp_path, lost=True)
    counts = brought(tmp_path, SERVO, "log.csv")
    assert counts["notes"] == ["8 of 120 rows have no number in column pos: left out"]
    commands = rows_of(tmp_path, "command.csv")[:2]
    assert [float(row["t_s"]) for row in commands] == [0.0, 1.0]


def test_commands_may_stand_in_a_table_of_their_own(tmp_path: Path) -> None:
    log(tmp_path)
    rows = ["run,t,deg", *(f"{run},{t},{deg}" for run in "abcdx" for t, deg in ((-1, 0), (1, 90)))]
    (tmp_path / "goals.csv").write_text("\n".join(rows) + "\n")
    table = {**SERVO["table"], "target": None}
    table["units"] = {"ms": "ms", "pos": COUNTS}
    commands = {
        "file": "goals.csv",
        "episode": "run",
        "t_s": "t",
        "target": "deg",
        "units": {"deg": "deg"},
    }
    mapping = {**SERVO, "table": table, "commands": commands}
    counts = brought(tmp_path, mapping, "log.csv", "goals.csv")
    assert counts["notes"] == ["2 commands of episodes without positions: left out"]
    commands = rows_of(tmp_path, "command.csv")
    assert len(commands) == 8
    assert float(commands[1]["value"]) == pytest.approx(math.pi / 2)


def test_targets_beside_positions_have_their_clock(tmp_path: Path) -> None:
    log(tmp_path)
    brought(tmp_path, SERVO, "log.csv")
    manifest = json.loads((tmp_path / "o.measured" / "manifest.json").read_text())
    assert manifest["command_clock"] == manifest["channels"][0]["clock"] == "encoder"


def spun(folder: Path, *, lost: bool = False) -> None:
    """Four throws, z up, of a ball that spins about the user's y and z, in turns a second."""
    rows = ["throw,t,x,y,z,spin_x,spin_y,spin_z"]
    for throw in range(4):
        for k in range(30):
            t = k / 60
            z = 1.5 + (2 + throw) * t - 4.905 * t * t
            spins = ",," if lost and k % 3 else f"0,{10 + throw},-2"
            rows.append(f"{throw},{t},{3 * t},0,{z},{spins}")
    (folder / "throws.csv").write_text("\n".join(rows) + "\n")


def spins(unit: str) -> dict[str, Any]:
    columns = {f"w{axis}": f"spin_{axis}" for axis in "xyz"}
    return {
        "kind": "trajectory",
        "axes": "z_up",
        "body": {"name": "ball", "mass_kg": 0.0027, "radius_m": 0.02},
        "noise_sd": {"wy": 0.5},
        "table": {
            "file": "throws.csv",
            "episode": "throw",
            "t_s": "t",
            "channels": {axis: axis for axis in "xyz"} | columns,
            "units": dict.fromkeys(columns.values(), unit),
        },
    }


def test_spins_of_balls_turn_with_the_axes(tmp_path: Path) -> None:
    spun(tmp_path, lost=True)
    assert brought(tmp_path, spins("turn/s"), "throws.csv")["rows"] == 120
    rows = [row for row in rows_of(tmp_path, "trajectory.csv") if row["episode"] == "1"]
    first = {row["channel"]: float(row["value"]) for row in reversed(rows)}
    # The engine's y is the user's z, its z the user's -y.
    wanted = {"wx": 0.0, "wy": -2 * 2 * math.pi, "wz": -11 * 2 * math.pi}
    assert {name: first[name] for name in wanted} == pytest.approx(wanted)
    counts = {name: sum(row["channel"] == name for row in rows) for name in ("y", "wy")}
    assert counts == {"y": 30, "wy": 10}
    manifest = json.loads((tmp_path / "o.measured" / "manifest.json").read_text())
    units = {row["name"]: (row["unit"], row["noise_sd"]) for row in manifest["channels"]}
    assert (units["x"], units["wy"]) == (("m", None), ("rad/s", 0.5))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        # 150 turns a second in the units of others, read as rad/s.
        (lambda m: m["table"]["units"].update(spin_y={"factor": 5400.0}), "in deg/s"),
        (lambda m: m["table"]["units"].update(spin_y={"factor": 900.0}), "in deg/s or rpm"),
        (lambda m: m["table"]["units"].update(spin_x="m/s"), "is of a speed, and the column"),
        (lambda m: m["table"]["channels"].pop("wx"), "wx, wy and wz all or none"),
        (lambda m: m["table"].update(channels={"wx": "spin_x"}), "x, y and z are there"),
    ],
)
def test_slips_of_spins_are_told(tmp_path: Path, change: Any, told: str) -> None:  # noqa: ANN401
    spun(tmp_path)
    mapping = spins("turn/s")
    change(mapping)
    with pytest.raises(ValueError, match=told):
        brought(tmp_path, mapping, "throws.csv")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m["table"].update(target=None), "no 'target' and no 'commands' part"),
        (lambda m: m["table"].update(only={"servo": 7}), r"only is .*no row of .*log\.csv has"),
        (lambda m: m["table"]["units"].update(pos="mm"), "'mm', which is of a length, and the col"),
        (lambda m: m["table"]["units"].update(pos={"zero": 3}), "exactly one of"),
        (lambda m: m["table"]["units"].update(goal="rad", other="m"), "column 'other' is none"),
        (lambda m: m["table"]["units"].update(pos={"per_second": 3}), "is of a time"),
        (lambda m: m["table"].update(position=None), "'position' is missing"),
        (lambda m: m["joint"].update(stiffness=3), "no key 'stiffness'; allowed are"),
        (lambda m: m["joint"].update(max_torque_n_m=-3), r"map\.json: joint\.max_torque_n_m is -3"),
        (lambda m: m.update(confirmed=False), '"confirmed" is false: read it, correct what is'),
        (lambda m: m.update(confirmed="yes"), "confirmed is 'yes'; true or false is needed"),
    ],
)
def test_slips_of_a_servo_s_map_are_told(tmp_path: Path, change: Any, told: str) -> None:  # noqa: ANN401
    log(tmp_path)
    mapping = json.loads(json.dumps(SERVO))
    change(mapping)
    with pytest.raises(ValueError, match=told):
        brought(tmp_path, mapping, "log.csv")
    assert not (tmp_path / "o.measured").exists()


WALLS = {
    side: {"substance": "plaster"}
    for side in ("floor", "ceiling", "west", "east", "north", "south")
}
ROOM: dict[str, Any] = {
    "kind": "impulse_response",
    "axes": "z_up",
    "origin": [0.0, 4.0, 0.0],
    "environment": {"temperature_c": 24.0},
    "room": {"size_m": [6.0, 2.5, 4.0], "surfaces": WALLS},
    "table": {
        "file": "index.csv",
        "episode": "wav",
        "split_group": "speaker",
        "wav": "wav",
        "gain": "gain",
        "units": {"x": "cm", "y": "cm", "z": "cm"},
        "source": ["x", "y", "z"],
        "receiver": "{channel}",
    },
    "places": {"receivers": {"1": [3.0, 1.0, 1.2], "2": [3.0, 3.0, 1.2]}},
}


def recordings(folder: Path) -> NDArray[np.int16]:
    """Four recordings of two channels by the standard library."""
    draw = np.random.default_rng(7)
    sounds = draw.integers(-9000, 9000, (4, 400, 2)).astype("<i2")
    rows = ["wav,speaker,gain,x,y,z"]
    for k, sound in enumerate(sounds):
        with wave.open(str(folder / f"r{k}.wav"), "wb") as file:
            file.setnchannels(2)
            file.setsampwidth(2)
            file.setframerate(16000)
            file.writeframes(sound.tobytes())
        rows.append(f"r{k}.wav,s{k % 2},{0.5 + k},{100 + 50 * k},150,120")
    (folder / "index.csv").write_text("\n".join(rows) + "\n")
    return sounds


def floats(path: Path) -> NDArray[np.float32]:
    """The samples of a WAV file of one float channel, without the engine."""
    raw = path.read_bytes()
    assert struct.unpack_from("<HH", raw, raw.index(b"fmt ") + 8) == (3, 1)
    at = raw.index(b"data")
    (size,) = struct.unpack_from("<I", raw, at + 4)
    return np.frombuffer(raw, "<f4", size // 4, at + 8)


def test_channels_become_receivers_and_their_places_the_engine_s(tmp_path: Path) -> None:
    sounds = recordings(tmp_path)
    counts = brought(tmp_path, ROOM, "index.csv")
    assert counts == {"rows": 8, "episodes": 4, "left_out": 0}
    row = rows_of(tmp_path, "ir.csv")[5]
    assert row["episode"] == "r2.wav"
    # x 2 m, y 1.5 m, z 1.2 m up; the origin moves by 4 m along y, which points against z.
    numbers = [float(row[f"{end}_{axis}"]) for end in ("source", "receiver") for axis in "xyz"]
    assert numbers == pytest.approx([2.0, 1.2, 2.5, 3.0, 1.2, 1.0])
    found = floats(tmp_path / "o.measured" / row["file"])
    assert found == pytest.approx(2.5 * sounds[2, :, 1] / 32767.0, rel=1e-6)
    manifest = json.loads((tmp_path / "o.measured" / "manifest.json").read_text())
    assert manifest["scene"]["environment"]["temperature_c"] == 24.0
    groups = [row["split_group"] for row in rows_of(tmp_path, "episodes.csv")]
    assert groups == ["s0", "s1", "s0", "s1"]


@pytest.mark.parametrize(
    ("last", "told"),
    [(0.0, "every sample is 0; allowed"), (np.nan, "sample 399 of channel 1 is nan; allowed")],
)
def test_a_recording_without_sound_is_told_by_its_own_name(
    tmp_path: Path, last: float, told: str
) -> None:
    recordings(tmp_path)
    path = tmp_path / "r2.wav"
    write_wav(path, np.zeros((2, 400)), 16_000)
    path.write_bytes(path.read_bytes()[:-4] + np.float32(last).tobytes())
    with pytest.raises(ValueError, match=rf"r2\.wav: {told}"):
        brought(tmp_path, ROOM, "index.csv")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m.update(sofa={"file": "a.sofa"}), "one of them is needed"),
        (lambda m: m["table"].update(receiver="speaker"), "2 channels; name a column 'channel'"),
        (lambda m: m["places"]["receivers"].pop("2"), "receiver '2' has no place in"),
        (lambda m: m["table"].update(receiver=["x", "y", "z"], source="speaker"), "whose places"),
        (lambda m: m["table"].update(wav="speaker"), "there is no .*s0; give the WAV files too"),
        (lambda m: m["places"].update(receivers={"1": [1, 2]}), "1 is .*; three numbers"),
        (lambda m: m.update(axes=["x", "y", "-z"]), "left-handed: the data would be mirrored"),
        (lambda m: m.update(axes="x_up"), "axes is 'x_up'; allowed is"),
        (lambda m: m.update(origin=None), r"source_z"),
        (
            lambda m: m["room"]["surfaces"].update(
                floor={"absorption": {"centres_hz": [1000.0, "x"]}}
            ),
            r"room: surfaces: floor: absorption: centres_hz\[1\] is .x.",
        ),
        (lambda m: m["room"].update(size_m=[6.0, 2.5]), "room: size_m is .* 3 numbers"),
        (lambda m: m["room"]["surfaces"].pop("floor"), "room.surfaces.floor"),
    ],
)
def test_slips_of_a_room_s_map_are_told(tmp_path: Path, change: Any, told: str) -> None:  # noqa: ANN401
    recordings(tmp_path)
    mapping = json.loads(json.dumps(ROOM))
    change(mapping)
    with pytest.raises(ValueError, match=told):
        brought(tmp_path, mapping, "index.csv", "r0.wav")
    assert not (tmp_path / "o.measured").exists()


def test_a_recording_outside_the_table_s_folder_is_not_read(tmp_path: Path) -> None:
    recordings(tmp_path)
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "index.csv").write_text((tmp_path / "index.csv").read_text().replace("r0", "../r0"))
    (tmp_path / "map.json").write_text(json.dumps(ROOM))
    with pytest.raises(ValueError, match="leads out of the table's folder"):
        import_files(
            [inner / "index.csv"], tmp_path / "map.json", tmp_path / "o.measured", lambda *_: None
        )


def sofa_file(path: Path, data: NDArray[np.float64], kind: str) -> None:
    """As AES69-2022 has it, by h5py: a listener that faces +y, with two receivers."""
    h5py = pytest.importorskip("h5py")
    count = len(data)
    with h5py.File(path, "w") as file:
        file.attrs["SOFAConventions"] = np.bytes_("SingleRoomSRIR")
        file.attrs["DataType"] = np.bytes_(kind)
        file["Data.IR"] = data
        file["Data.SamplingRate"] = [48000.0]
        file["Data.SamplingRate"].attrs["Units"] = np.bytes_("hertz")
        file["Data.Delay"] = np.array([[0.0, 3.0]])
        places = {
            "ListenerPosition": [[2.0, 1.0, 1.5]],
            "ListenerView": [[0.0, 1.0, 0.0]],
            "ListenerUp": [[0.0, 0.0, 1.0]],
            "SourcePosition": [[4.0, 1.0 + 0.25 * k, 1.0] for k in range(count)],
            "ReceiverPosition": [[[0.0], [0.1], [0.0]], [[0.0], [-0.1], [0.0]]],
            "EmitterPosition": [[[0.0], [0.0], [0.0]]],
        }
        for name, values in places.items():
            file[name] = np.array(values)
            file[name].attrs["Type"] = np.bytes_("cartesian")
            file[name].attrs["Units"] = np.bytes_("metre")


@pytest.mark.parametrize("kind", ["FIR", "FIR-E"])
def test_a_sofa_file_is_read_with_its_places_and_delays(tmp_path: Path, kind: str) -> None:
    data = np.random.default_rng(3).standard_normal((4, 2, 200))
    sofa_file(tmp_path / "lab.sofa", data if kind == "FIR" else data[..., None], kind)
    mapping = {k: v for k, v in ROOM.items() if k not in ("table", "places")}
    mapping["sofa"] = {"file": "lab.sofa"}
    assert brought(tmp_path, mapping, "lab.sofa")["episodes"] == 4
    rows = rows_of(tmp_path, "ir.csv")
    # Left of who faces +y is -x: the first receiver stands at x 1.9.
    places = [[float(row[f"receiver_{axis}"]) for axis in "xyz"] for row in rows[:2]]
    assert places == [pytest.approx([1.9, 1.5, 3.0]), pytest.approx([2.1, 1.5, 3.0])]
    assert float(rows[4]["source_z"]) == pytest.approx(4.0 - 1.5)
    late = floats(tmp_path / "o.measured" / rows[5]["file"])
    assert late[:3] == pytest.approx([0.0, 0.0, 0.0])
    assert late[3:] == pytest.approx(data[2, 1], rel=1e-6)


def test_arrivals_that_others_picked_are_imported_without_sound(tmp_path: Path) -> None:
    rows = ["mic,spk,path,ms"]
    rows += [f"m{k},s{k % 2},{path},{5 + k}" for k in range(4) for path in ("direct", "floor")]
    (tmp_path / "toa.csv").write_text("\n".join(rows) + "\n")
    (tmp_path / "places.csv").write_text(
        "kind,id,x,y,z\nspk,s0,1,1,1.5\nspk,s1,5,1,1.5\n"
        + "".join(f"mic,m{k},3,{1 + 0.5 * k},1.2\n" for k in range(4))
    )
    places = {"file": "places.csv", "name": "id", "position": ["x", "y", "z"]}
    mapping = {key: value for key, value in ROOM.items() if key not in ("table", "places")}
    mapping |= {
        "environment": {"temperature_c": 21.0, "temperature_sd_k": 0.5},
        "response_times": "absolute",
        "arrivals": {
            "file": "toa.csv",
            "episode": ["mic"],
            "split_group": "spk",
            "path": "path",
            "t_s": "ms",
            "units": {"ms": "ms"},
            "source": "spk",
            "receiver": "mic",
        },
        "places": {
            "sources": {**places, "only": {"kind": "spk"}},
            "receivers": {**places, "only": {"kind": "mic"}},
        },
    }
    counts = brought(tmp_path, mapping, "toa.csv", "places.csv")
    assert (counts["rows"], counts["episodes"]) == (8, 4)
    rows_found = rows_of(tmp_path, "arrivals.csv")
    assert [row["path"] for row in rows_found[:2]] == ["direct", "floor"]
    # z up, with the origin at the far corner of y: (5, 1, 1.5) is (5, 1.5, 3).
    third = rows_found[2]
    assert [float(third[f"source_{axis}"]) for axis in "xyz"] == [5.0, 1.5, 3.0]
    assert float(third["t_s"]) == pytest.approx(0.006)
    manifest = json.loads((tmp_path / "o.measured" / "manifest.json").read_text())
    assert manifest["response_times"] == "absolute"
    shutil.rmtree(tmp_path / "o.measured")
    with pytest.raises(ValueError, match="response_times"):
        brought(tmp_path, mapping | {"response_times": "somehow"}, "toa.csv", "places.csv")


def test_a_sofa_file_of_a_head_is_no_room(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.sofa", "w") as file:
        file.attrs["SOFAConventions"] = np.bytes_("SimpleFreeFieldHRIR")
    mapping = {k: v for k, v in ROOM.items() if k not in ("table", "places")}
    mapping["sofa"] = {"file": "a.sofa"}
    with pytest.raises(ValueError, match="'SimpleFreeFieldHRIR'; rooms are read from"):
        brought(tmp_path, mapping, "a.sofa")


def test_a_real_room_s_responses_are_imported(tmp_path: Path) -> None:
    folder = DATA / "measured" / "acoustics" / "r3vival"
    if not folder.is_dir():
        pytest.skip(f"{folder} is absent")
    out = tmp_path / "r3vival.measured"
    counts = import_files([folder / "index.csv"], MAPS / "r3vival.json", out, lambda *_: None)
    assert (counts["rows"], counts["episodes"]) == (100, 28)
    # The front microphone of a source in front hears it 5 cm before the centre, 14.6 / 2 samples.
    with (out / "ir.csv").open() as file:
        front = [row for row in csv.DictReader(file) if row["episode"] == "000_S000-200.wav"]
    heard = [floats(out / row["file"]) for row in front]
    first, centre = (int(np.abs(heard[k]).argmax()) for k in (0, 6))
    assert 5 <= centre - first <= 9
    assert float(front[0]["receiver_x"]) - float(front[6]["receiver_x"]) == pytest.approx(0.05)
