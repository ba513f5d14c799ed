"""The one way to read a user's file, and the one way to write a file.

To open a named pipe is to wait for somebody who writes into it, and a device may have no end; so
only regular files are read, to a cap. Only regular files are replaced, and what is written appears
whole or not at all.
"""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, BinaryIO, NoReturn

from dwell import _native

#: How the names of files in the making begin.
DRAFT = ".partial-"
#: A text that is read whole has at most so many bytes, as for the readers of houses.
MOST_TEXT_BYTES = 64 * 2**20
#: JSON is nested at most so deep, as for the readers of houses.
_MOST_DEPTH = 128
#: Values and names of a JSON text: Python takes some 70 bytes for each.
_MOST_VALUES = 4_000_000
#: Digits of a whole number: no float is larger.
_MOST_DIGITS = 309
#: What file systems say that have no hard links.
_NO_LINKS = {errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL}

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
    file = os.fdopen(os.open(name, flags | getattr(os, "O_CLOEXEC", 0)), "rb")
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


def read(path: _Name, most_bytes: int = MOST_TEXT_BYTES) -> bytes:
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


def lines(file: IO[bytes], name: _Name) -> Iterator[bytes]:
    """The lines of an open file, none of them longer than a text may be.

    Raises:
        ValueError: One is.
    """
    while line := file.readline(MOST_TEXT_BYTES + 1):
        if len(line) > MOST_TEXT_BYTES:
            _refuse_large(f"{os.fspath(name)}: a line", len(line), MOST_TEXT_BYTES)
        yield line


def read_json(path: _Name) -> Any:  # noqa: ANN401 - any JSON value
    """The value of a JSON file.

    Raises:
        OSError: The system refuses, or it is no regular file.
        ValueError: As of :func:`parse_json`, or it is too large; the message names the file.
    """
    return parse_json(read(path), os.fspath(path))


def parse_json(text: bytes, at: str) -> Any:  # noqa: ANN401 - any JSON value
    """The value of a JSON text in UTF-8.

    Raises:
        ValueError: It is none, is nested too deep, or holds more than is read; the message begins
            with ``at``.
    """
    depth, values = _native.json_extent(text)
    if depth > _MOST_DEPTH:
        raise ValueError(f"{at}: nested {depth} deep; at most {_MOST_DEPTH} is read")
    if values > _MOST_VALUES:
        raise ValueError(f"{at}: {values} values and names; at most {_MOST_VALUES} are read")
    try:
        decoded = text.decode("utf-8-sig")
        value = json.loads(
            decoded, parse_int=_whole, parse_float=_finite, parse_constant=_refuse_constant
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
    except ValueError as error:
        raise ValueError(f"{at}: no JSON: {error}") from None
    return value


@contextlib.contextmanager
def atomic(path: _Name, *, new: bool = False) -> Iterator[Path]:
    """A temporary file that takes the place of ``path`` when all went well.

    A link is followed where it leads to a regular file, which is replaced.

    Args:
        path: What shall be there; folders above it are made.
        new: Nothing may stand there, not even at the last moment.

    Raises:
        OSError: The system refuses, or something stands there that is no regular file.
        FileExistsError: It shall be new and is not.
    """
    path = Path(path)
    place = path if new else _place(path)
    make_folder(place.parent)
    handle, name = tempfile.mkstemp(prefix=DRAFT, dir=place.parent)
    os.close(handle)
    try:
        yield Path(name)
        os.chmod(name, 0o644)
        if new:
            _link(name, place)
        else:
            os.replace(name, place)
    except OSError as error:
        # What people know is the name that they gave.
        if error.filename in (None, name) and error.errno is not None:
            error.filename, error.filename2 = os.fspath(path), None
        raise
    finally:
        Path(name).unlink(missing_ok=True)


def make_folder(folder: Path) -> None:
    """Makes a folder and those above it, where they are not there.

    Raises:
        OSError: The system refuses, or something else stands there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise NotADirectoryError(errno.ENOTDIR, "is no folder", os.fspath(folder)) from None


def _place(path: Path) -> Path:
    """Where a file that is written to ``path`` stands: elsewhere when it is a link.

    Raises:
        OSError: Something stands there that is no regular file, or a link that leads nowhere.
    """
    try:
        facts = path.lstat()
    except FileNotFoundError:
        return path
    if not stat.S_ISLNK(facts.st_mode):
        _refuse_irregular(facts, os.fspath(path))
        return path
    real = Path(os.path.realpath(path))
    try:
        _refuse_irregular(real.stat(), os.fspath(path))
    except FileNotFoundError:
        told = "is a link that leads to no file"
        raise FileNotFoundError(errno.ENOENT, told, os.fspath(path)) from None
    return real


def _link(name: str, place: Path) -> None:
    """Gives a file a name that nothing has."""
    try:
        os.link(name, place)
    except FileExistsError:
        raise FileExistsError(errno.EEXIST, "is there already", os.fspath(place)) from None
    except OSError as error:
        if error.errno not in _NO_LINKS:
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
    raise ValueError(f"{name}: {found} bytes; at most {allowed} are read")


def _whole(text: str) -> int:
    if len(text) > _MOST_DIGITS:
        raise ValueError(f"a whole number of {len(text)} digits; at most {_MOST_DIGITS} are read")
    return int(text)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"the number {text:.40} is larger than any float")
    return value


def _refuse_constant(text: str) -> NoReturn:
    raise ValueError(f"{text} is no number of JSON")
