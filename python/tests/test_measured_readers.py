"""Formats of tables: small files by their own libraries, and files that lead elsewhere."""

from __future__ import annotations

import contextlib
import csv
import json
import math
import shutil
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_measured_kinds import JOINT

from dwell.measured.importing import import_files
from dwell.measured.readers import OpenTable, open_table, reader_of

SERVO: dict[str, Any] = {"kind": "servo", "joint": JOINT}
EPISODES, LENGTH, FPS = 4, 30, 20.0


def joint_at(episode: int, k: int) -> tuple[float, float]:
    """Position and target of a joint, degrees."""
    return 10.0 * episode + 2.0 * k, 90.0 if k >= 10 else 0.0


def imported(folder: Path, table: dict[str, Any], *names: str) -> list[dict[str, str]]:
    """The samples of servos' tables."""
    (folder / "map.json").write_text(json.dumps({**SERVO, "table": table}))
    files = [folder / name for name in names]
    out = folder / "o.measured"
    assert import_files(files, folder / "map.json", out, lambda *_: None)["episodes"] == EPISODES
    with (out / "trajectory.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == EPISODES * LENGTH
    for number, row in enumerate(rows):
        episode, k = divmod(number, LENGTH)
        assert float(row["t_s"]) == pytest.approx(k / FPS, abs=1e-6)
        degrees, _ = joint_at(episode, k)
        assert float(row["value"]) == pytest.approx(math.radians(degrees), rel=1e-6, abs=1e-6)
    return rows


def lerobot(folder: Path) -> Path:
    """A dataset of two files in two chunks, as LeRobot 3.0 writes it."""
    pyarrow = pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet", reason="Parquet needs pyarrow")
    names = ["shoulder.pos", "elbow.pos"]
    state = {"dtype": "float32", "shape": [2], "names": names}
    one = {"dtype": "int64", "shape": [1], "names": None}
    info = {
        "codebase_version": "v3.0",
        "fps": FPS,
        "features": {
            "observation.state": state,
            "action": {**state, "names": {"motors": names}},
            "observation.images.top": {"dtype": "video", "shape": [8, 8, 3]},
            "timestamp": {"dtype": "float32", "shape": [1], "names": None},
            "frame_index": one,
            "episode_index": one,
        },
    }
    (folder / "set" / "meta").mkdir(parents=True)
    (folder / "set" / "meta" / "info.json").write_text(json.dumps(info))
    for chunk in range(2):
        columns: dict[str, list[Any]] = {name: [] for name in info["features"]}  # type: ignore[attr-defined]
        del columns["observation.images.top"]
        for episode in (2 * chunk, 2 * chunk + 1):
            for k in range(LENGTH):
                position, target = joint_at(episode, k)
                columns["observation.state"].append([0.0, position])
                columns["action"].append([0.0, target])
                columns["timestamp"].append(k / FPS)
                columns["frame_index"].append(k)
                columns["episode_index"].append(episode)
        path = folder / "set" / "data" / f"chunk-{chunk:03}" / "file-000.parquet"
        path.parent.mkdir(parents=True)
        parquet.write_table(pyarrow.table(columns), path)
    return folder / "set"


LEROBOT = {
    "file": "set",
    "episode": "episode_index",
    "t_s": "timestamp",
    "units": {"observation.state.elbow.pos": "deg", "action.elbow.pos": "deg"},
    "position": "observation.state.elbow.pos",
    "target": "action.elbow.pos",
}


def test_a_lerobot_dataset_is_read_by_the_names_of_its_motors(tmp_path: Path) -> None:
    table = open_table(lerobot(tmp_path))
    assert table.columns[:2] == ["observation.state.shoulder.pos", "observation.state.elbow.pos"]
    assert "fps is 20" in table.facts["timestamp"]
    imported(tmp_path, LEROBOT, "set")


def test_a_lerobot_dataset_that_is_none_or_leads_elsewhere_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bare").mkdir()
    with pytest.raises(ValueError, match=r"bare: no meta/info\.json"):
        open_table(tmp_path / "bare")
    folder = lerobot(tmp_path)
    file = folder / "data" / "chunk-001" / "file-000.parquet"
    file.rename(tmp_path / "elsewhere.parquet")
    file.symlink_to(tmp_path / "elsewhere.parquet")
    with pytest.raises(ValueError, match="a link out of the dataset"):
        list(open_table(folder).rows)
    info = json.loads((folder / "meta" / "info.json").read_text())
    (folder / "meta" / "info.json").write_text(json.dumps({**info, "codebase_version": "v1.6"}))
    with pytest.raises(ValueError, match=r"codebase_version is 'v1\.6'; v2\.x and v3\.x"):
        open_table(folder)


def test_lists_of_parquet_become_columns(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet", reason="Parquet needs pyarrow")
    path = tmp_path / "data.parquet"
    pose = [{"p": [1.0, 2.0]}, {"p": [3.0, 4.0]}]
    parquet.write_table(pyarrow.table({"t": [0.0, 0.5], "pose": pose}), path)
    table = open_table(path)
    assert table.columns == ["t", "pose.p[0]", "pose.p[1]"]
    assert [*table.rows][1] == (2, {"t": 0.5, "pose.p[0]": 3.0, "pose.p[1]": 4.0})
    path.write_bytes(b"PAR1 and then nothing")
    with pytest.raises(ValueError, match=r"data\.parquet: no Parquet"):
        open_table(path)


HDF5 = {
    "file": "demos.hdf5",
    "part": "data",
    "episode": "{group}",
    "t_s": "{index}",
    "units": {"{index}": {"per_second": FPS}, "obs/joint[1]": "deg", "actions": "deg"},
    "position": "obs/joint[1]",
    "target": "actions",
}


def demos(path: Path) -> None:
    """As robomimic has them, with pictures and more than nine episodes' numbers."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        for episode, number in enumerate((0, 2, 9, 10)):
            group = file.create_group(f"data/demo_{number}")
            rows = np.array([joint_at(episode, k) for k in range(LENGTH)])
            group["obs/joint"] = np.stack([np.zeros(LENGTH), rows[:, 0]], axis=1)
            group["obs/image"] = np.zeros((LENGTH, 4, 4, 3), np.uint8)
            group["actions"] = rows[:, 1]
            group.attrs["num_samples"] = LENGTH


def test_demonstrations_of_hdf5_are_read_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    demos(tmp_path / "demos.hdf5")
    rows = imported(tmp_path, HDF5, "demos.hdf5")
    assert [row["episode"] for row in rows[::LENGTH]] == ["demo_0", "demo_2", "demo_9", "demo_10"]
    table = open_table(tmp_path / "demos.hdf5", "data/demo_2")
    assert table.columns == ["{group}", "{index}", "actions", "obs/joint[0]", "obs/joint[1]"]
    with pytest.raises(ValueError, match="no group 'date'; it has"):
        open_table(tmp_path / "demos.hdf5", "date")


def test_arrays_of_hdf5_that_differ_in_length_are_not_cut(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "demos.hdf5"
    demos(path)
    with h5py.File(path, "a") as file:
        for group in file["data"].values():
            # Of no column of the map: a camera's matrix, a faster sensor.
            group["intrinsics"], group["force"] = np.eye(3), np.zeros((3 * LENGTH, 2))
    imported(tmp_path, HDF5, "demos.hdf5")
    # Where no column is chosen yet: those of most arrays.
    assert len(list(open_table(path, "data/demo_2").rows)) == LENGTH
    shutil.rmtree(tmp_path / "o.measured")
    for length in (LENGTH - 1, LENGTH + 5, 1):
        with h5py.File(path, "a") as file:
            group = file["data/demo_2"]
            del group["actions"]
            group["actions"] = np.zeros(length)
        told = (
            rf"demos\.hdf5: group 'demo_2': column 'actions' has {length} rows and column "
            rf"'obs/joint\[1\]' has {LENGTH}; columns of a table"
        )
        with pytest.raises(ValueError, match=told):
            imported(tmp_path, HDF5, "demos.hdf5")


def test_an_array_of_hdf5_that_is_too_large_is_named(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "demos.hdf5"
    with h5py.File(path, "w") as file:
        # Of fill values, so that it takes no room.
        file.create_dataset("data/demo_0/t", shape=(68_000_000,), dtype="f8", chunks=(1_000_000,))
    with pytest.raises(ValueError, match=r"demos\.hdf5: '/data/demo_0/t' has 68000000 numbers; at"):
        open_table(path, "data")


def test_a_chunk_of_hdf5_that_inflates_without_end_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "demos.hdf5"
    whole = zlib.compress(bytes(50 << 20), 9)
    with h5py.File(path, "w") as file:
        for shuffles in (False, True):
            name = f"data/demo_{int(shuffles)}/t"
            options = {"compression": "gzip", "shuffle": shuffles, "fletcher32": shuffles}
            file.create_dataset(name, data=np.arange(40.0), chunks=(40,), **options)
    assert len(list(open_table(path, "data").rows)) == 80
    with h5py.File(path, "r+") as file:
        file["data/demo_0/t"].id.write_direct_chunk((0,), whole)
    with pytest.raises(
        ValueError, match=r"demos\.hdf5: a chunk of '/data/demo_0/t' inflates to mo"
    ):
        list(open_table(path, "data").rows)
    with h5py.File(path, "r+") as file:
        file["data/demo_0/t"].id.write_direct_chunk((0,), zlib.compress(bytes(320)))
        # It leaves out the first filter, shuffle, and is inflated all the same.
        file["data/demo_1/t"].id.write_direct_chunk((0,), whole, 1)
    with pytest.raises(ValueError, match="a chunk of '/data/demo_1/t' inflates to more"):
        list(open_table(path, "data").rows)


def test_damaged_hdf5_is_refused_by_a_sentence_with_its_name(tmp_path: Path) -> None:
    whole, damaged = tmp_path / "whole.hdf5", tmp_path / "damaged.hdf5"
    h5py = pytest.importorskip("h5py")
    with h5py.File(whole, "w") as file:
        for k in range(4):
            group = file.create_group(f"data/demo_{k}")
            group["t"], group["place"] = np.arange(40) / 60, np.zeros((40, 3))
    content = whole.read_bytes()
    told = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        changed = bytearray(content[: rng.integers(1, len(content))] if seed % 3 else content)
        # Most of what may be wrong stands in the headers.
        for at in rng.integers(0, min(len(changed), 2000), 4):
            changed[at] ^= 1 << rng.integers(8)
        damaged.write_bytes(changed)
        try:
            for part in reader_of(damaged).parts(damaged):
                list(open_table(damaged, part).rows)
        except ValueError as error:
            told.append(str(error))
    assert len(told) > 30
    assert all(sentence.startswith(f"{damaged}: ") for sentence in told), told


def test_hdf5_that_leads_elsewhere_is_not_followed(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["secret"] = np.arange(5.0)
        file["data/demo_0/secret"] = np.arange(5.0)
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["data/demo_0/x"] = np.arange(5.0)
        file["data/demo_0/soft"] = h5py.SoftLink("/data/demo_0/x")
        file["data/demo_0/external"] = h5py.ExternalLink("other.h5", "secret")
        file["data/loop"] = file["data"]
        file["away"] = h5py.ExternalLink("other.h5", "data")
    assert open_table(path, "data").columns == ["{group}", "{index}", "x"]
    with pytest.raises(ValueError, match="'away' is a link that leads elsewhere"):
        open_table(path, "away")
    layout = h5py.VirtualLayout(shape=(5,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "secret", shape=(5,))
    for name in ("virtual", "outside"):
        with h5py.File(tmp_path / f"{name}.h5", "w") as file:
            group = file.create_group("data/demo_0")
            if name == "virtual":
                group.create_virtual_dataset("v", layout)
            else:
                raw = [(str(tmp_path / "other.h5"), 0, 40)]
                group.create_dataset("v", (5,), "f8", external=raw)
        with pytest.raises(ValueError, match="'/data/demo_0/v' has its values in another file"):
            open_table(tmp_path / f"{name}.h5", "data")
    (tmp_path / "bad.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + b"\xff" * 200)
    with pytest.raises(ValueError, match=r"bad\.h5: no HDF5 that can be read"):
        open_table(tmp_path / "bad.h5")


def json_log(path: Path, episode: int, compression: str = "ZSTD") -> None:
    """A log of a joint's states and of another topic, in JSON."""
    writer_module = pytest.importorskip("mcap.writer", reason="MCAP needs the package mcap")
    with path.open("wb") as file:
        writer = writer_module.Writer(
            file, compression=getattr(writer_module.CompressionType, compression)
        )
        writer.start()
        schema = writer.register_schema("joint", "jsonschema", b"{}")
        states = writer.register_channel("/joint", "json", schema)
        other = writer.register_channel("/other", "json", schema)
        start_ns = 1_700_000_000_000_000_000
        for k in range(LENGTH):
            position, target = joint_at(episode, k)
            data = json.dumps({"position": [0.0, position], "goal": {"elbow": target}}).encode()
            time_ns = start_ns + round(k / FPS * 1e9)
            writer.add_message(states, time_ns, data, time_ns)
            writer.add_message(other, time_ns, b'{"a": 1}', time_ns)
        writer.finish()


MCAP = {
    "file": "run*.mcap",
    "part": "/joint",
    "episode": "{file}",
    "t_s": "log_time",
    "units": {"position[1]": "deg", "goal.elbow": "deg"},
    "position": "position[1]",
    "target": "goal.elbow",
}


@pytest.mark.parametrize("compression", ["NONE", "LZ4", "ZSTD"])
def test_a_log_in_json_is_read_a_file_an_episode(tmp_path: Path, compression: str) -> None:
    for episode in range(EPISODES):
        json_log(tmp_path / f"run{episode}.mcap", episode, compression)
    imported(tmp_path, MCAP, *(f"run{k}.mcap" for k in range(EPISODES)))
    with pytest.raises(ValueError, match=r"which topic\? Write one of \['/joint', '/other'\]"):
        open_table(tmp_path / "run0.mcap")
    with pytest.raises(ValueError, match="no messages of topic '/none'"):
        open_table(tmp_path / "run0.mcap", "/none")


JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""


def test_a_log_of_ros_2_is_read_with_its_stamps(tmp_path: Path) -> None:
    ros2 = pytest.importorskip("mcap_ros2.writer", reason="CDR needs mcap-ros2-support")
    path = tmp_path / "bag.mcap"
    with path.open("wb") as file:
        writer = ros2.Writer(file)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        for k in range(5):
            stamp = {"sec": 1_700_000_000, "nanosec": 50_000_000 * k}
            message = {
                "header": {"stamp": stamp, "frame_id": "base"},
                "name": ["a", "b"],
                "position": [0.5 * k, -1.0],
            }
            time_ns = 1_700_000_000_002_000_000 + 50_000_000 * k
            writer.write_message("/joint_states", schema, message, time_ns, time_ns)
        writer.finish()
    table = open_table(path, "/joint_states")
    assert {"header.stamp", "position[0]", "name[1]", "header.frame_id"} <= {*table.columns}
    rows = [row for _, row in table.rows]
    assert [row["position[0]"] for row in rows] == [0.0, 0.5, 1.0, 1.5, 2.0]
    # Two milliseconds passed between measuring and logging.
    assert rows[0]["header.stamp"] == pytest.approx(-0.002)
    assert rows[4]["log_time"] == pytest.approx(0.2)


def test_damaged_logs_are_refused_by_a_sentence(tmp_path: Path) -> None:
    pytest.importorskip("mcap", reason="MCAP needs the package mcap")
    json_log(tmp_path / "whole.mcap", 0)
    whole = (tmp_path / "whole.mcap").read_bytes()
    path = tmp_path / "cut.mcap"
    draw = np.random.default_rng(1)
    refused = 0
    for _ in range(60):
        raw = bytearray(whole[: int(draw.integers(0, len(whole)))])
        for at in draw.integers(0, max(len(raw), 1), 3):
            if raw:
                raw[at % len(raw)] = int(draw.integers(0, 256))
        path.write_bytes(raw)
        # Nothing but a ValueError comes of it.
        is_refused = True
        with contextlib.suppress(ValueError):
            list(open_table(path, "/joint").rows)
            is_refused = False
        refused += is_refused
    assert refused > 30


def test_a_chunk_that_unpacks_to_more_than_it_says_is_refused(tmp_path: Path) -> None:
    records = pytest.importorskip("mcap.records", reason="MCAP needs the package mcap")
    builder = pytest.importorskip("mcap.data_stream", reason="MCAP needs the package mcap")
    zstandard = pytest.importorskip("zstandard")
    frame = pytest.importorskip("lz4.frame")
    zeros = bytes(40 * 2**20)
    for name, packed in (("zstd", zstandard.compress(zeros)), ("lz4", frame.compress(zeros))):
        chunk = records.Chunk(name, packed, 1, 0, 0, 100)
        record = builder.RecordBuilder()
        chunk.write(record)
        path = tmp_path / f"{name}.mcap"
        path.write_bytes(b"\x89MCAP0\r\n" + record.end())
        with pytest.raises(ValueError, match="a chunk is not of the 100 bytes that it says"):
            list(open_table(path, "/joint").rows)


@pytest.mark.parametrize(
    ("name", "module", "told"),
    [
        ("a.parquet", "pyarrow.parquet", r"needs pyarrow; pip install 'dwell\[data\]'"),
        ("a.h5", "h5py", r"needs h5py; pip install 'dwell\[hdf5\]'"),
        ("a.mcap", "mcap.stream_reader", r"needs mcap; pip install 'dwell\[mcap\]'"),
    ],
)
def test_a_missing_package_is_told_with_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, module: str, told: str
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, module, None)
    (tmp_path / name).write_bytes(b"")
    with pytest.raises(ModuleNotFoundError, match=rf"{name}: reading it {told}"):
        open_table(tmp_path / name, "x" if name == "a.mcap" else None)


def test_other_suffixes_and_parts_of_plain_tables_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a\.xlsx: \.xlsx; \.csv, .* are read as tables"):
        reader_of(tmp_path / "a.xlsx")
    (tmp_path / "a.csv").write_text("a\n1\n")
    with pytest.raises(ValueError, match="a CSV file holds one table; leave out 'part'"):
        open_table(tmp_path / "a.csv", "x")
    assert isinstance(open_table(tmp_path / "a.csv"), OpenTable)


def test_a_row_without_end_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("t,x\n1,2\n" + "3" * 1_000_001)
    with pytest.raises(ValueError, match="line 3 has more than"):
        list(open_table(path).rows)
    path.write_text("t" * 1_000_001)
    with pytest.raises(ValueError, match="line 1 has more than 1,000,000 characters"):
        open_table(path)
