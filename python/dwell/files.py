"""The one way to read a user's file, and the one way to write a file.

To open a named pipe is to wait for somebody who writes into it, and a device may have no end; so
only regular files are read, to a cap. Only regular files are replaced, and what is written appears
whole or not at all.
"""

from __future__ import annotations

import contextlib
import errno
import io
import json
import math
import os
import shutil
import stat
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, BinaryIO, NoReturn

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.messages import printable

#: Drafts for one name that may be in the making at once, and bytes that theirs take from it.
_MAX_DRAFTS = 10_000
_DRAFT_NAME_BYTES = 200
#: A text that is read whole has at most so many bytes, as for the readers of houses.
MAX_TEXT_BYTES = 64 * 2**20
#: JSON is nested at most so deep, as for the readers of houses.
_MAX_DEPTH = 128
#: Values and names of a JSON text: Python takes some 70 bytes for each.
_MAX_VALUES = 4_000_000
#: Digits of a whole number: no float is larger.
MAX_DIGITS = 309
#: What file systems say that have no hard links.
_HARD_LINK_ERRNOS = {errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL}

_Name = str | os.PathLike[str]


def open_file(path: _Name, most_bytes: int | None = None) -> BinaryIO:
    """Opens a regular file to be read, without ever waiting for somebody else.

    Raises:
        OSError: The system refuses, or it is no regular file.
        ValueError: It has more than ``most_bytes``.
    """
    name = os.fspath(path)
    if "\0" in name:
        raise ValueError(f"{name!r}: a path holds no NUL")
    # Something may happen when a device is opened, so it is looked at before.
    _refuse_irregular(os.stat(name), name)
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    opened = _NamedFile(os.open(name, flags | getattr(os, "O_CLOEXEC", 0)))
    opened.path = name
    file = io.BufferedReader(opened)
    try:
        facts = os.fstat(file.fileno())
        # Another thing may stand there by now.
        _refuse_irregular(facts, name)
        if most_bytes is not None and facts.st_size > most_bytes:
            _refuse_large(name, facts.st_size, most_bytes)
    except BaseException:
        file.close()
        raise
    return file


class _NamedFile(io.FileIO):
    """A file whose errors say which it is: of an open one the system says only what is wrong."""

    path = ""

    def readinto(self, buffer: Any) -> int:  # noqa: ANN401 - what holds bytes
        """Reads into a buffer."""
        try:
            return super().readinto(buffer)
        except OSError as error:
            raise self._named(error) from None

    def readall(self) -> bytes:
        """Reads what is left."""
        try:
            return super().readall()
        except OSError as error:
            raise self._named(error) from None

    def _named(self, error: OSError) -> OSError:
        return OSError(error.errno, error.strerror, self.path)


def read(path: _Name, most_bytes: int = MAX_TEXT_BYTES) -> bytes:
    """The bytes of a regular file.

    Raises:
        OSError: The system refuses, or it is no regular file.
        ValueError: It has more than ``most_bytes``.
    """
    with open_file(path, most_bytes) as file:
        # A file that grows while it is read still ends at the cap.
        found = file.read(most_bytes + 1)
    if len(found) > most_bytes:
        _refuse_large(os.fspath(path), len(found), most_bytes)
    return found


def is_whole(path: _Name) -> bool:
    """Returns whether there is a regular file that is not empty and ends as its form does.

    What was cut does not, as by a power cut: PNG ends with ``IEND``, NPZ with a directory, WAV
    after as many bytes as it says.
    """
    try:
        with open_file(path) as file:
            size = file.seek(0, os.SEEK_END)
            ending = os.path.splitext(path)[1]
            if ending == ".png":
                file.seek(max(0, size - 12))
                return file.read() == b"\0\0\0\0IEND\xae\x42\x60\x82"
            if ending == ".npz":
                file.seek(max(0, size - 22))
                return file.read(4) == b"PK\5\6"
            if ending == ".wav":
                file.seek(4)
                return size == int.from_bytes(file.read(4), "little") + 8
            return size > 0
    except OSError:
        return False


def lines(file: IO[bytes], name: _Name, most_bytes: int = MAX_TEXT_BYTES) -> Iterator[bytes]:
    """The lines of an open file, none of them longer than ``most_bytes``.

    Raises:
        ValueError: One is.
    """
    number = 0
    while line := file.readline(most_bytes + 1):
        number += 1
        if len(line) > most_bytes:
            _refuse_large(f"{os.fspath(name)} line {number}: a line", len(line), most_bytes)
        yield line


def split_lines(text: str) -> list[str]:
    """The lines of a text: they end by LF, or CR and LF, and by nothing else.

    ``str.splitlines`` ends lines at form feeds and separators of Unicode, too.
    """
    rows = [row.removesuffix("\r") for row in text.split("\n")]
    # What follows the last end is a line only where it is something.
    return rows if rows[-1] else rows[:-1]


def decoded(text: bytes, at: str) -> str:
    """A text in UTF-8 without a mark at its beginning.

    Raises:
        ValueError: It is in another encoding; the message begins with ``at``.
    """
    try:
        found = text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        byte = error.object[error.start]
        what = f"byte {byte:#04x} at {error.start} is no UTF-8"
        raise ValueError(f"{at}: {what}; save the file as UTF-8") from None
    if "\0" in found:
        # As UTF-16 has in nearly every letter.
        raise ValueError(f"{at}: NUL is in no text; save the file as UTF-8")
    return found


def read_json(path: _Name) -> Any:  # noqa: ANN401 - any JSON value
    """The value of a JSON file.

    Raises:
        OSError: The system refuses, or it is no regular file.
        ValueError: As of :func:`parse_json`, or it is too large; the message names the file.
    """
    return parse_json(read(path), os.fspath(path))


def parse_json(
    text: bytes, at: str, most_values: int = _MAX_VALUES, *, keep_constants: bool = False
) -> Any:  # noqa: ANN401 - any JSON value
    """The value of a JSON text in UTF-8, of at most so many values and names.

    Args:
        text: The text.
        at: What messages begin with.
        most_values: How many values and names are read.
        keep_constants: Whether ``NaN`` and ``Infinity``, which JSON does not have, are read, for
            those who check each number and can say which field it is.

    Raises:
        ValueError: It is none, names a key twice in one object, is nested too deep, or holds more
            than is read; the message begins with ``at``.
    """
    at = printable(at)
    depth, values = _native.json_size_bounds(text)
    if depth > _MAX_DEPTH:
        raise ValueError(f"{at}: nested {depth} deep; at most {_MAX_DEPTH} is read")
    if values > most_values:
        raise ValueError(f"{at}: {values} values and names; at most {most_values} are read")
    try:
        decoded = text.decode("utf-8-sig")
        value = json.loads(
            decoded,
            parse_int=_parse_integer,
            parse_float=_parse_float,
            parse_constant=float if keep_constants else _refuse_constant,
            object_pairs_hook=_unique_keys,
        )
        if "\\u" in decoded:
            # Half of a pair of surrogates is no character, and comes from such an escape alone.
            json.dumps(value, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        where = f"line {error.lineno} column {error.colno}"
        raise ValueError(f"{at}: no JSON: {where}: {error.msg}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{at}: no JSON: byte {error.start} is not UTF-8") from None
    except UnicodeEncodeError:
        raise ValueError(f"{at}: no JSON: half of a pair of surrogates") from None
    except _DuplicateKeyError as error:
        raise ValueError(f"{at}: {error}") from None
    except ValueError as error:
        raise ValueError(f"{at}: no JSON: {error}") from None
    return value


@contextlib.contextmanager
def atomic_write(path: _Name, *, new: bool = False) -> Iterator[Path]:
    """A temporary file that takes the place of ``path`` when all went well.

    A link is refused: what it leads to was named by nobody, and would be lost.

    Args:
        path: What shall be there; folders above it are made.
        new: Nothing may stand there, not even at the last moment.

    Raises:
        OSError: The system refuses, or something stands there that is no regular file.
        FileExistsError: It shall be new and is not.
    """
    place = Path(path)
    if new:
        _refuse_existing(place)
    else:
        _refuse_irreplaceable(place)
    make_folder(place.parent)
    with errors_named(path), _draft(place) as folder:
        draft = folder / "file"
        draft.touch(0o644)
        yield draft
        if new:
            _link(os.fspath(draft), place)
        else:
            os.replace(draft, place)


@contextlib.contextmanager
def atomic_folder(path: _Name) -> Iterator[Path]:
    """An empty folder that becomes ``path`` when all went well.

    Args:
        path: What shall be there and is not; folders above it are made.

    Raises:
        OSError: The system refuses.
        FileExistsError: Something stands there.
    """
    place = Path(path)
    _refuse_existing(place)
    make_folder(place.parent)
    with errors_named(place), _draft(place) as folder:
        draft = folder / "folder"
        draft.mkdir()
        yield draft
        _refuse_existing(place)
        os.rename(draft, place)


@contextlib.contextmanager
def errors_named(path: _Name) -> Iterator[None]:
    """Gives errors about drafts, and those that name no file, the name that people know."""
    try:
        yield
    except _native.DwellError:
        # They say themselves of what they are.
        raise
    except OSError as error:
        # What people know is the name that they gave.
        named = Path(error.filename) if isinstance(error.filename, str | os.PathLike) else None
        is_ours = named is None or any(map(is_draft, named.parts))
        if is_ours and error.errno is not None:
            rename_error(error, path)
        elif is_ours:
            # Some libraries say what went wrong in words alone.
            raise OSError(errno.EIO, f"cannot be written: {error}", os.fspath(path)) from error
        raise


def rename_error(error: OSError, path: _Name) -> None:
    """Gives an error the name that people know, alone."""
    error.filename = os.fspath(path)
    # None in its place would be told as "-> None".
    del error.filename2


def save_array(path: Path, array: NDArray[Any]) -> None:
    """Writes an array as NPY.

    Raises:
        OSError: The system refuses, and says why: what NumPy says of files itself does not.
    """
    with path.open("wb") as file:
        np.lib.format.write_array(_Bytes(file), array, allow_pickle=False)


class _Bytes:
    """A file that NumPy writes to by its own method alone."""

    def __init__(self, file: IO[bytes]) -> None:
        self.write = file.write


def check_writable(path: _Name) -> None:
    """Refuses what :func:`atomic_write` would refuse, before anything is computed; makes nothing.

    Raises:
        OSError: No file can stand there.
    """
    place = Path(path)
    _refuse_irreplaceable(place)
    for above in place.parents:
        if os.path.lexists(above):
            if not above.is_dir():
                raise NotADirectoryError(errno.ENOTDIR, "is no folder", os.fspath(above))
            return


def is_draft(name: str) -> bool:
    """Returns whether a name is of a file or folder in the making, or left by a killed process."""
    return name.startswith(".") and ".partial-" in name


@contextlib.contextmanager
def _draft(place: Path) -> Iterator[Path]:
    """An empty folder beside ``place``, gone afterwards, in which a file or folder is made.

    The folder's lock says that its process is alive, as those of the engine's drafts do: whoever
    makes a draft for the same name removes those of processes that were killed. What is in it has
    none, which HDF5 would take for another writer's.
    """
    folder, handle = _claim_draft(place)
    try:
        yield folder
    finally:
        try:
            if _is_at(handle, folder):
                shutil.rmtree(folder, ignore_errors=True)
        finally:
            if handle is not None:
                os.close(handle)


def _claim_draft(place: Path) -> tuple[Path, int | None]:
    """A folder that is nobody else's, and what holds its lock where there are any."""
    name = os.fsencode(place.name)[:_DRAFT_NAME_BYTES].decode(errors="ignore")
    for number in range(_MAX_DRAFTS):
        folder = place.with_name(f".{name}.partial-{number}")
        if os.path.lexists(folder) and not _is_cleared(folder):
            continue
        try:
            folder.mkdir(0o700)
        except FileExistsError:
            # Somebody was quicker.
            continue
        try:
            handle = _opened_folder(folder)
        except FileNotFoundError:
            # Somebody took it for one that was left; or the folder above is gone.
            if place.parent.is_dir():
                continue
            raise
        # Some file systems have no locks; their drafts are nobody's to remove.
        if (handle is None or lock(handle) is not False) and _is_at(handle, folder):
            return folder, handle
        if handle is not None:
            os.close(handle)
    what = f"{_MAX_DRAFTS} drafts of this name are in the making"
    raise FileExistsError(errno.EEXIST, what, os.fspath(place))


def _is_cleared(draft: Path) -> bool:
    """Removes the draft of a process that has ended; whether there was one."""
    try:
        facts = draft.lstat()
        if not stat.S_ISDIR(facts.st_mode) and not stat.S_ISREG(facts.st_mode):
            return False
        handle = _opened_folder(draft)
    except OSError:
        return False
    if handle is None:
        return False
    try:
        # Held until it is gone, so that nobody removes what comes after it.
        if lock(handle) is not True or not _is_at(handle, draft):
            return False
        if stat.S_ISDIR(facts.st_mode):
            shutil.rmtree(draft)
        else:
            draft.unlink()
    except OSError:
        return False
    else:
        return True
    finally:
        os.close(handle)


def _opened_folder(path: Path) -> int | None:
    """A handle for a lock; ``None`` where the system has none for folders."""
    if os.name == "nt":
        return None
    return os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW | os.O_CLOEXEC)


def _is_at(handle: int | None, path: Path) -> bool:
    """Returns whether a handle is that of the file at ``path`` now."""
    if handle is None:
        return path.exists()
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(handle), path.lstat())
    return False


def lock(file: int | IO[bytes]) -> bool | None:
    """Locks what is open until it is closed; ``False``: another has, ``None``: there are no locks.

    The system lets go of it when the process ends.
    """
    try:
        import fcntl
    except ImportError:  # Windows has none.
        return None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def open_exclusive(path: Path) -> IO[bytes]:
    """A file to be read and written, new or old, which no other process has as long as it is open.

    Raises:
        ValueError: Another process has it.
        OSError: The system refuses, or it is no regular file; a link to one is none either.
    """
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
    while True:
        refuse_link(path)
        if os.path.lexists(path):
            # Refuses what is no regular file.
            open_file(path).close()
        file = os.fdopen(os.open(path, flags, 0o644), "r+b")
        if lock(file) is False:
            file.close()
            raise ValueError(
                f"{path} is being written by another process; wait for its end, or give "
                "another --out"
            )
        with contextlib.suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(file.fileno()), os.stat(path)):
                return file
        # Its process came to its end in this moment, and has taken it away.
        file.close()


def append(file: IO[bytes], content: bytes, name: _Name) -> None:
    """Writes to the end of an open file and on to the disk; nothing waits in a buffer.

    Raises:
        OSError: The system refuses; the error names the file.
    """
    with errors_named(name):
        file.seek(0, os.SEEK_END)
        left = memoryview(content)
        while left:
            left = left[os.write(file.fileno(), left) :]
        os.fsync(file.fileno())


def make_folder(folder: Path) -> None:
    """Makes a folder and those above it, where they are not there.

    Raises:
        OSError: The system refuses, or something else stands there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise NotADirectoryError(errno.ENOTDIR, "is no folder", os.fspath(folder)) from None


def refuse_link(path: _Name) -> None:
    """Refuses to write where a link stands, wherever it leads.

    Raises:
        OSError: One does.
    """
    if os.path.islink(path):
        what = "is a link, and nothing is written through links; remove it, or name another place"
        raise OSError(errno.ELOOP, what, os.fspath(path))


def _refuse_irreplaceable(path: Path) -> None:
    """Refuses to replace what is no regular file, as a link is none.

    Raises:
        OSError: Such a thing stands there.
    """
    refuse_link(path)
    # Of what stands above it, whoever makes the folders says more.
    with contextlib.suppress(FileNotFoundError, NotADirectoryError):
        _refuse_irregular(path.lstat(), os.fspath(path))


def _refuse_existing(path: Path) -> None:
    """Refuses what is there, as ``/`` and ``.``, which have no name beside which a draft lies."""
    if os.path.lexists(path):
        raise FileExistsError(errno.EEXIST, "is there already", os.fspath(path))


def _link(name: str, place: Path) -> None:
    """Gives a file a name that nothing has."""
    try:
        os.link(name, place)
    except FileExistsError:
        raise FileExistsError(errno.EEXIST, "is there already", os.fspath(place)) from None
    except OSError as error:
        if error.errno not in _HARD_LINK_ERRNOS:
            raise
        # An empty file holds the name for the moment.
        os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644))
        os.replace(name, place)


def _refuse_irregular(facts: os.stat_result, name: str) -> None:
    if stat.S_ISREG(facts.st_mode):
        return
    kinds = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a named pipe", stat.S_IFSOCK: "a socket"}
    kind = kinds.get(stat.S_IFMT(facts.st_mode), "a device")
    raise OSError(errno.EINVAL, f"is {kind}, not a regular file", name)


def _refuse_large(name: str, found: int, allowed: int) -> NoReturn:
    raise ValueError(f"{printable(name)}: {found} bytes; at most {allowed} are read")


class _DuplicateKeyError(ValueError):
    """A key that stands twice in one object: which value is meant nobody knows."""


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        counts = Counter(name for name, _ in pairs)
        twice = next(name for name, count in counts.items() if count > 1)
        raise _DuplicateKeyError(f"key {twice!r:.60} stands twice in one object; once is allowed")
    return found


def _parse_integer(text: str) -> int:
    if len(text) > MAX_DIGITS:
        raise ValueError(f"a whole number of {len(text)} digits; at most {MAX_DIGITS} are read")
    return int(text)


def _parse_float(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"the number {text:.40} is larger than any float")
    return value


def _refuse_constant(text: str) -> NoReturn:
    raise ValueError(f"{text} is no number of JSON")
