"""The reader of HDF5 against h5py: every form that h5py writes, and files that lead elsewhere."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell._native import Hdf5

h5py = pytest.importorskip("h5py")

DATA = Path(os.environ.get("DWELL_SHARED_DATA", Path(__file__).parents[3] / "shared" / "data"))
KEMAR = DATA / "measured" / "acoustics" / "hrtf" / "MIT_KEMAR_normal_pinna.sofa"

VERSIONS = ["earliest", "v108", "v110", "latest"]
STORAGE: list[dict[str, Any]] = [
    {},
    {"chunks": (2, 2, 5)},
    {"chunks": (7, 2, 16)},
    {"chunks": (2, 2, 5), "compression": "gzip"},
    {"chunks": (2, 1, 5), "shuffle": True, "compression": "gzip", "compression_opts": 9},
    {"chunks": (3, 2, 8), "fletcher32": True},
    {"chunks": (3, 2, 8), "shuffle": True, "compression": "gzip", "fletcher32": True},
    # Grow along one axis, along several, and to an end.
    {"chunks": (1, 1, 2), "maxshape": (None, 2, 16)},
    {"chunks": (1, 2, 3), "maxshape": (7, 2, None), "compression": "gzip"},
    {"chunks": (1, 2, 3), "maxshape": (None, 2, None), "compression": "gzip"},
    {"chunks": (1, 2, 3), "maxshape": (None, None, None)},
    {"chunks": (2, 2, 4), "maxshape": (20, 5, 40)},
    {"chunks": (2, 2, 4), "maxshape": (20, 5, 40), "shuffle": True, "fletcher32": True},
]
TYPES = [">f8", "<f4", ">f4", "<i2", ">i4", "<u8", "i1"]


def _values(kind: str, shape: tuple[int, ...]) -> NDArray[Any]:
    low = 0 if np.dtype(kind).kind == "u" else -50
    values: NDArray[Any] = np.random.default_rng(3).integers(low, 100, shape).astype(kind)
    return values


def _numbers(file: Path | Hdf5, name: str) -> NDArray[np.float64]:
    opened = file if isinstance(file, Hdf5) else Hdf5.open(str(file))
    numbers, shape = opened.numbers(name)
    return numbers.reshape(shape)


@pytest.mark.parametrize("version", VERSIONS)
def test_every_storage_reads_as_h5py_reads_it(tmp_path: Path, version: str) -> None:
    path = tmp_path / "a.h5"
    pairs = [*zip(STORAGE, itertools.cycle(TYPES)), *(({}, kind) for kind in TYPES)]
    with h5py.File(path, "w", libver=version) as file:
        for k, (storage, kind) in enumerate(pairs):
            file.create_dataset(f"v{k}", data=_values(kind, (7, 2, 16)), **storage)
        # In the header.
        compact = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        compact.set_layout(h5py.h5d.COMPACT)
        space = h5py.h5s.create_simple((3,))
        held = h5py.h5d.create(file.id, b"compact", h5py.h5t.IEEE_F64LE, space, compact)
        held.write(h5py.h5s.ALL, h5py.h5s.ALL, np.array([1.0, -2.0, 0.5]))
        # Room for all chunks at once: their index is none.
        early = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        early.set_chunk((2, 3))
        early.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        space = h5py.h5s.create_simple((5, 7))
        held = h5py.h5d.create(file.id, b"early", h5py.h5t.IEEE_F32LE, space, early)
        held.write(h5py.h5s.ALL, h5py.h5s.ALL, _values("f4", (5, 7)))
        file["alone"] = 2.5
        file["none"] = np.zeros((0, 3))
        file.attrs["fixed"] = np.bytes_("a text")
        file["v0"].attrs["long"] = "any länge " * 3
        file["v0"].attrs["number"] = 3
        file["v0"].attrs["empty"] = h5py.Empty("S10")
        for k in range(30):
            file["v1"].attrs[f"x{k}"] = f"{k}"
    read = Hdf5.open(str(path))
    with h5py.File(path) as file:
        for name in file:
            found = _numbers(read, name)
            assert np.array_equal(found, np.asarray(file[name][()], np.float64)), name
            assert found.shape == file[name].shape
    assert read.text(None, "fixed") == "a text"
    assert read.text("v0", "long") == ("any länge " * 3).strip()
    assert [read.text("v1", f"x{k}") for k in range(30)] == [f"{k}" for k in range(30)]
    assert read.text("v0", "other") is None
    assert read.text("v0", "empty") is None
    assert read.shape("other") is None
    with pytest.raises(dwell.MeasuredDataError, match=r"a\.h5: v0: number: is a number"):
        read.text("v0", "number")


@pytest.mark.parametrize("version", ["earliest", "latest"])
def test_indices_of_many_chunks(tmp_path: Path, version: str) -> None:
    """Trees of several levels, arrays in pages and in blocks of blocks; groups of many names."""
    path = tmp_path / "many.h5"
    shapes = {"fixed": None, "endless": (None,), "tree": (None, None)}
    with h5py.File(path, "w", libver=version) as file:
        for name, longest in shapes.items():
            two = name == "tree"
            shape, chunks = ((60, 60), (1, 1)) if two else ((3000,), (1,))
            data = np.arange(np.prod(shape), dtype="f4").reshape(shape)
            more = {} if longest is None else {"maxshape": longest}
            file.create_dataset(name, data=data, chunks=chunks, **more)
        file.create_dataset("packed", data=np.arange(3000.0), chunks=(1,), compression="gzip")
        for k in range(400):
            file[f"name{k}"] = [float(k)]
    read = Hdf5.open(str(path))
    with h5py.File(path) as file:
        for name in [*shapes, "packed", *(f"name{k}" for k in range(0, 400, 13))]:
            assert np.array_equal(_numbers(read, name), file[name][()]), name


#: h5py has no types.
File = Any
Change = Callable[[File, Path], None]


def _external(file: File, folder: Path) -> None:
    (folder / "secret").write_bytes(b"secret bytes" * 10)
    file.create_dataset("x", (8,), "f8", external=[(str(folder / "secret"), 0, 64)])


def _linked(file: File, folder: Path) -> None:
    with h5py.File(folder / "other.h5", "w") as other:
        other["x"] = [1.0]
    file["x"] = h5py.ExternalLink("other.h5", "/x")


def _virtual(file: File, folder: Path) -> None:
    with h5py.File(folder / "other.h5", "w") as other:
        other["x"] = [1.0]
    layout = h5py.VirtualLayout(shape=(1,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(folder / "other.h5"), "x", shape=(1,))
    file.create_virtual_dataset("x", layout)


def _soft(file: File, _: Path) -> None:
    file["x"] = h5py.SoftLink("/x")


def _long(file: File, _: Path) -> None:
    file.create_dataset("x", (100_000_000, 2), "f8", chunks=(1000, 2), compression="gzip")


def _sparse(file: File, _: Path) -> None:
    file.create_dataset("x", (1_000_000, 2), "f8", chunks=(1000, 2))[:1000] = 1.0


def _unwritten(file: File, _: Path) -> None:
    file.create_dataset("x", (1000, 2), "f8")


def _packed(file: File, _: Path) -> None:
    file.create_dataset("x", data=np.zeros(64), compression="lzf")


def _text(file: File, _: Path) -> None:
    file["x"] = "text"


def _compound(file: File, _: Path) -> None:
    file["x"] = np.zeros(3, [("a", "f8"), ("b", "i4")])


def _group(file: File, _: Path) -> None:
    file.create_group("x")


@pytest.mark.parametrize("version", ["earliest", "latest"])
@pytest.mark.parametrize(
    ("change", "part"),
    [
        (_external, "values stand in another file"),
        (_linked, "a link to another file|a link of an unknown kind"),
        (_virtual, "a virtual dataset"),
        (_soft, "a soft link"),
        (_long, "more than the 67108864 numbers"),
        (_sparse, "999 of 1000 chunks were never written"),
        (_unwritten, "never written"),
        (_packed, "compressed by filter 32000"),
        (_text, "text; expected numbers"),
        (_compound, "neither numbers nor text"),
        (_group, "is no variable"),
    ],
)
def test_what_leads_elsewhere_or_is_no_numbers_is_refused(
    tmp_path: Path, version: str, change: Change, part: str
) -> None:
    path = tmp_path / "a.h5"
    with h5py.File(path, "w", libver=version) as file:
        change(file, tmp_path)
    with pytest.raises(dwell.MeasuredDataError, match=f"a.h5: x: .*({part})") as error:
        _numbers(path, "x")
    assert "secret bytes" not in str(error.value)


def test_loops_end(tmp_path: Path) -> None:
    """A tree whose root is its own child, and a header that goes on in itself."""
    path = tmp_path / "a.h5"
    with h5py.File(path, "w", libver="earliest") as file:
        file.create_dataset("x", data=np.arange(2000.0), chunks=(4,))
    sound = path.read_bytes()
    # The chunks' tree has two levels; its root names its first child behind a key of 24 bytes.
    at = next(
        at
        for at in range(len(sound))
        if sound[at : at + 4] == b"TREE" and sound[at + 4 : at + 6] == b"\x01\x01"
    )
    child = at + 24 + 24
    path.write_bytes(sound[:child] + at.to_bytes(8, "little") + sound[child + 8 :])
    with pytest.raises(dwell.MeasuredDataError, match="x: damaged at byte"):
        _numbers(path, "x")
    with h5py.File(path, "w", libver="earliest") as file:
        file["x"] = [1.0]
        for k in range(20):
            file["x"].attrs[f"a{k}"] = "text"
    sound = path.read_bytes()
    # A continuation: type 16 and length 16, then where it is and how long.
    at = sound.index(b"\x10\x00\x10\x00")
    place = int.from_bytes(sound[at + 8 : at + 16], "little")
    again = sound[:place] + sound[at : at + 24] + sound[place + 24 :]
    path.write_bytes(again)
    with pytest.raises(dwell.MeasuredDataError, match="loop"):
        _numbers(path, "x")


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(dwell.MeasuredDataError, match="regular file"):
        Hdf5.open(str(tmp_path))
    with pytest.raises(dwell.MeasuredDataError, match=r"regular file"):
        dwell.Head.from_sofa("/dev/zero")


@pytest.mark.skipif(not KEMAR.is_file(), reason=f"{KEMAR} is not there")
def test_a_measured_head_reads_as_h5py_reads_it() -> None:
    read = Hdf5.open(str(KEMAR))
    compared = 0
    with h5py.File(KEMAR) as file:
        for name, variable in file.items():
            # Dimensions alone were never written.
            if "." not in name and not name.endswith(("Position", "View", "Up")):
                continue
            assert np.array_equal(_numbers(read, name), variable[()]), name
            units = variable.attrs.get("Units")
            told = units.decode() if isinstance(units, bytes) else units
            assert read.text(name, "Units") == told
            compared += 1
        assert compared >= 8
        for name, value in file.attrs.items():
            told = value.decode() if isinstance(value, bytes) else value
            if isinstance(told, str) and len(told) < 1000:
                assert read.text(None, name) == told.strip("\0 "), name
