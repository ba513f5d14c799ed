"""HDF5: groups of arrays with a row a sample, as robomimic writes them, by h5py.

Files are untrusted: only arrays of numbers that lie in the file itself are read. Soft and external
links, virtual datasets and values in other files are refused.
"""

from __future__ import annotations

import contextlib
import zlib
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dwell.files import open_file
from dwell.measured.readers.form import (
    MAX_COLUMNS,
    OpenTable,
    Row,
    TableReader,
    missing_package,
)

#: Bytes of a file, numbers of an array, groups of an episode each, and depth of groups.
_MAX_BYTES = 8 * 2**30
_MAX_VALUES = 2**26
_MAX_GROUPS = 20_000
_MAX_DEPTH = 8
#: Bytes that the filter fletcher32 adds to a chunk.
_CHECKSUM_BYTES = 4
#: Arrays with longer rows are pictures.
_MAX_WIDTH = 256
GROUP_COLUMN = "{group}"


def _module(path: Path) -> Any:  # noqa: ANN401 - an extra without types
    try:
        import h5py
    except ModuleNotFoundError:
        raise missing_package(path, "h5py", "hdf5") from None
    return h5py


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[tuple[Any, Any]]:
    """The module ``h5py``, and the file.

    Raises:
        OSError: The system refuses to read it.
        ValueError: It is damaged; the message names the file.
    """
    h5py = _module(path)
    try:
        with open_file(path, _MAX_BYTES) as handle, h5py.File(handle, "r") as file:
            yield h5py, file
    except (OSError, RuntimeError, LookupError, TypeError, ValueError, ArithmeticError) as error:
        is_systems = isinstance(error, OSError) and None not in (error.errno, error.filename)
        if is_systems or (isinstance(error, ValueError) and str(error).startswith(f"{path}: ")):
            raise
        # h5py says by many types what is wrong with a file, and never in which.
        raise ValueError(f"{path}: no HDF5 that can be read: {error}") from None


def _open(path: Path, part: str | None) -> OpenTable:
    with _opened(path) as (h5py, file):
        root = _group(h5py, path, file, part or "/")
        first = next(iter(_episodes(h5py, path, root)), None)
        if first is None:
            raise ValueError(f"{path}: no arrays of numbers in {part or '/'!r}")
        widths = {name: a.shape for name, a in _arrays(h5py, path, first[1]).items()}
    columns = [name for own in _columns(widths).values() for name in own]
    if len(columns) > MAX_COLUMNS:
        raise ValueError(f"{path}: {len(columns)} columns; at most {MAX_COLUMNS} are read")
    return OpenTable(
        [GROUP_COLUMN, "{index}", *columns],
        _rows(path, part),
        rows_with=lambda needed: _rows(path, part, needed),
    )


def _parts(path: Path) -> list[str]:
    """Groups that hold episodes or arrays."""
    with _opened(path) as (h5py, file):
        names = [name for name in file if _is_hard(h5py, file, name)]
        groups = [name for name in names if isinstance(file[name], h5py.Group)]
        return groups or ["/"]


def _rows(path: Path, part: str | None, needed: Sequence[str] = ()) -> Iterator[tuple[int, Row]]:
    """The rows of all groups, of the arrays that are as long as those of the needed columns."""
    number = 0
    with _opened(path) as (h5py, file):
        for name, group in _episodes(h5py, path, _group(h5py, path, file, part or "/")):
            arrays = _arrays(h5py, path, group)
            own = _columns({key: array.shape for key, array in arrays.items()})
            lengths = {key: array.shape[0] for key, array in arrays.items()}
            count = _length(f"{path}: group {name!r}", lengths, own, {*needed})
            blocks = {}
            for key, array in arrays.items():
                if lengths[key] == count:
                    _check_inflation(h5py, path, array)
                    blocks[key] = np.asarray(array, np.float64).reshape(count, -1)
            for k in range(count):
                number += 1
                row: Row = {GROUP_COLUMN: name, "{index}": k}
                for key, block in blocks.items():
                    row.update(zip(own[key], block[k].tolist(), strict=True))
                yield number, row


def _check_inflation(h5py: Any, path: Path, array: Any) -> None:  # noqa: ANN401
    """Refuses an array of which a compressed chunk holds more than it has.

    HDF5 inflates a chunk to whatever it holds, a thousand times what stands in the file.
    """
    if array.chunks is None:
        return
    filters = array.id.get_create_plist()
    codes = [filters.get_filter(k)[0] for k in range(filters.get_nfilters())]
    deflate = h5py.h5z.FILTER_DEFLATE
    if deflate not in codes:
        return
    outer = [code for code in codes if code != h5py.h5z.FILTER_FLETCHER32]
    if outer[-1] != deflate or outer.count(deflate) > 1:
        raise ValueError(f"{path}: {array.name!r} has gzip below other filters; write it anew")
    size = int(np.prod(array.chunks)) * array.dtype.itemsize
    for k in range(array.id.get_num_chunks()):
        chunk = array.id.get_chunk_info(k)
        # Chunks may leave filters out, one by one.
        if chunk.filter_mask >> codes.index(deflate) & 1:
            continue
        _, stored = array.id.read_direct_chunk(chunk.chunk_offset)
        try:
            inflated = zlib.decompressobj().decompress(stored, size + _CHECKSUM_BYTES + 1)
        except zlib.error as error:
            raise ValueError(f"{path}: {array.name!r} is damaged: {error}") from None
        if len(inflated) > size + _CHECKSUM_BYTES:
            raise ValueError(
                f"{path}: a chunk of {array.name!r} inflates to more bytes than the {size} that "
                "it has"
            )


def _length(
    at: str, lengths: dict[str, int], columns: dict[str, list[str]], needed: set[str]
) -> int:
    """How many rows a group has: of the arrays of needed columns, else of most arrays.

    Raises:
        ValueError: Two arrays of needed columns differ; nobody knows which rows belong together.
    """
    first: tuple[str, int] | None = None
    for key, names in columns.items():
        if not (used := [name for name in names if name in needed]):
            continue
        if first is None:
            first = used[0], lengths[key]
        elif lengths[key] != first[1]:
            raise ValueError(
                f"{at}: column {first[0]!r} has {first[1]} rows and column {used[0]!r} has "
                f"{lengths[key]}; columns of a table are needed of one length"
            )
    if first is not None:
        return first[1]
    counts = Counter(lengths.values())
    return max(counts, key=lambda count: (counts[count], count))


def _is_hard(h5py: Any, group: Any, name: str) -> bool:  # noqa: ANN401
    return isinstance(group.get(name, getlink=True), h5py.HardLink)


def _group(h5py: Any, path: Path, file: Any, part: str) -> Any:  # noqa: ANN401
    """A group by its path, each step of which is a plain link."""
    found = file
    for step in [step for step in part.split("/") if step]:
        if step not in found:
            raise ValueError(f"{path}: no group {part!r}; it has {list(file)[:12]}")
        if not _is_hard(h5py, found, step):
            raise ValueError(f"{path}: {part!r} is a link that leads elsewhere; it is not followed")
        found = found[step]
    if not isinstance(found, h5py.Group):
        raise ValueError(f"{path}: {part!r} is an array; a group of arrays is needed")
    return found


def _episodes(h5py: Any, path: Path, group: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """The group itself where it holds arrays, else its groups, ``demo_2`` before ``demo_10``."""
    if _arrays(h5py, path, group, deep=False):
        yield str(group.name), group
        return
    names = [name for name in group if _is_hard(h5py, group, name)]
    if len(names) > _MAX_GROUPS:
        raise ValueError(f"{path}: {len(names)} groups; at most {_MAX_GROUPS} are read")

    def order(name: str) -> tuple[str, int]:
        digits = name[len(name.rstrip("0123456789")) :]
        return name.removesuffix(digits), int(digits[:18] or -1)

    for name in sorted(names, key=order):
        inner = group[name]
        if isinstance(inner, h5py.Group) and _arrays(h5py, path, inner):
            yield name, inner


def _arrays(h5py: Any, path: Path, group: Any, *, deep: bool = True) -> dict[str, Any]:  # noqa: ANN401
    """The arrays of numbers of a group and those below it, by path."""
    found: dict[str, Any] = {}
    seen: set[int] = set()

    def look(group: Any, prefix: str, depth: int) -> None:  # noqa: ANN401
        address = hash(group.id)
        if address in seen or depth > _MAX_DEPTH:
            return
        seen.add(address)
        for name in group:
            if not _is_hard(h5py, group, name):
                continue
            inner = group[name]
            if isinstance(inner, h5py.Group):
                if deep:
                    look(inner, f"{prefix}{name}/", depth + 1)
            elif isinstance(inner, h5py.Dataset) and _is_column(inner):
                if inner.size > _MAX_VALUES:
                    raise ValueError(
                        f"{path}: {inner.name!r} has {inner.size} numbers; at most {_MAX_VALUES} "
                        "are read: cut it into parts, or leave rows out"
                    )
                if inner.is_virtual or inner.external:
                    raise ValueError(
                        f"{path}: {inner.name!r} has its values in another file; copy them into it"
                    )
                found[f"{prefix}{name}"] = inner

    look(group, "", 0)
    return found


def _is_column(array: Any) -> bool:  # noqa: ANN401
    """Whether an array has a row of few numbers a sample."""
    if array.dtype.kind not in "fiub" or array.ndim not in (1, 2) or array.shape[0] < 1:
        return False
    return bool(array.ndim == 1 or 0 < array.shape[1] <= _MAX_WIDTH)


def _columns(shapes: dict[str, tuple[int, ...]]) -> dict[str, list[str]]:
    return {
        key: [key] if len(shape) == 1 else [f"{key}[{k}]" for k in range(shape[1])]
        for key, shape in shapes.items()
    }


READER = TableReader("HDF5", (".hdf5", ".h5"), _open, _parts)
