"""Shared parts of commands: JSON on standard output, points, progress."""

from __future__ import annotations

import argparse
import codecs
import contextlib
import json
import math
import os
import re
import sys
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, TextIO

from dwell.camera import MAX_PIXELS
from dwell.files import parse_json
from dwell.messages import printable, with_short_words
from dwell.workers import MAX_WORKERS


def print_json(value: Any) -> None:  # noqa: ANN401 - any JSON value
    """Prints one JSON object and nothing else."""
    sys.stdout.write(json.dumps(value, ensure_ascii=False, allow_nan=False) + "\n")


def decimal(text: str) -> float:
    """The number that a text says.

    Raises:
        ValueError: It is none, or written as only Python reads it: ``1_0``, or in other digits.
    """
    if "_" in text or not text.isascii():
        raise ValueError("no number in ASCII digits")
    return float(text)


def point(text: str) -> tuple[float, float, float]:
    """Reads ``X,Y,Z`` in metres."""
    try:
        x, y, z = (decimal(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected X,Y,Z in metres, found {text!r}") from None
    if not all(map(math.isfinite, (x, y, z))):
        raise argparse.ArgumentTypeError(f"expected finite numbers X,Y,Z, found {text!r}")
    return x, y, z


def number(text: str) -> float:
    """Reads a finite number."""
    try:
        value = decimal(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"expected a finite number, found {text!r}")
    return value


def count(text: str, low: int = 0, high: int = sys.maxsize) -> int:
    """Reads a whole number that is not negative: a seed, a size, how many."""
    # What Python counts with.
    is_whole = re.fullmatch(r"\+?[0-9]{1,19}", text.strip())
    if not is_whole or not low <= int(text) <= high:
        allowed = f"a whole number from {low} to {high}"
        raise argparse.ArgumentTypeError(f"expected {allowed}, found {text[:60]!r}")
    return int(text)


def count_from_1(text: str) -> int:
    """Reads a whole number of which there is at least one."""
    return count(text, low=1)


def image_edge(text: str) -> int:
    """Reads a width or a height, pixels."""
    return count(text, low=1, high=MAX_PIXELS)


def workers(text: str) -> int:
    """Reads how many threads or processes are asked for."""
    return count(text, low=1, high=MAX_WORKERS)


def sound_rate(text: str) -> int:
    """Reads the rate of impulse responses, Hz."""
    return count(text, low=8_000, high=192_000)


def shard(text: str) -> tuple[int, int]:
    """Reads ``K/N``: the K-th of N parts, from 0."""
    match = re.fullmatch(r"([0-9]{1,5})/([0-9]{1,5})", text)
    which, shards = map(int, match.groups()) if match else (0, 0)
    if not which < shards:
        told = f"expected K/N with K below N, whole numbers up to 99999, found {text!r:.60}"
        raise argparse.ArgumentTypeError(told)
    return which, shards


def settings_of(option: str, fields: Sequence[str], whole: dict[str, Any]) -> dict[str, Any]:
    """Settings, ``whole`` and those of ``FIELD=VALUE``; a value that is no JSON is text.

    Raises:
        ValueError: One of ``fields`` is of another form, or stands twice.
    """
    found = dict(whole)
    for field in fields:
        name, equals, value = field.partition("=")
        if not equals or not name.isidentifier():
            raise ValueError(f"{option}: expected FIELD=VALUE, found {field!r:.60}")
        if name in found:
            raise ValueError(f"{option}: {name} is given twice")
        try:
            found[name] = parse_json(value.encode(errors="surrogatepass"), name)
        except ValueError:
            found[name] = value
    return found


def path(text: str) -> Path:
    """Reads the path of a file or folder; to Python an empty one is where it runs."""
    if not text:
        raise argparse.ArgumentTypeError("expected a path, found ''")
    return Path(text)


def refuse_other_suffix(out: Path | None, suffix: str, option: str = "--out") -> None:
    """Refuses a file that by its name would be of another format than what an option writes.

    Raises:
        ValueError: Its suffix is another.
    """
    if out is not None and out.suffix.lower() != suffix:
        raise ValueError(f"{option} is {os.fspath(out)!r}; expected the name of a {suffix} file")


#: What the arguments of commands hold beside options.
_NO_OPTIONS = {"command", "version", "run", "parser", "house", "stage", "file", "files"}


def refuse_unused(args: argparse.Namespace, used: Collection[str], what: str) -> None:
    """Refuses options that were given and that nothing would read.

    Args:
        args: As the command line gave them.
        used: The names of those that are read.
        what: What is done with them, as the sentence says it.

    Raises:
        ValueError: It names the first such option and those that are read.
    """
    for name, value in vars(args).items():
        # What was given is an object of its own, also where it equals the default.
        is_given = value is not args.parser.get_default(name)
        if is_given and name not in used and name not in _NO_OPTIONS:
            options = sorted(f"--{other.replace('_', '-')}" for other in {*used} - _NO_OPTIONS)
            option = name.replace("_", "-")
            raise ValueError(
                f"--{option} is given, and {what} does not read it; options that it reads are "
                f"{', '.join(options)}"
            )


def add_back_end(parser: argparse.ArgumentParser) -> None:
    """Adds ``--backend`` and ``--path``; see :func:`back_end`."""
    parser.add_argument(
        "--backend",
        metavar="cpu|gpu|gpu:NAME",
        help="who renders, NAME a part of an adapter's; default: DWELL_RENDERER or cpu",
    )
    parser.add_argument(
        "--path",
        choices=("compute", "raster"),
        help="how gpu finds what pixels see; default: what is quicker there",
    )


def back_end(args: argparse.Namespace) -> str:
    """The meaning of ``--backend`` and ``--path`` together, as ``renderer=`` takes it."""
    said = args.backend or os.environ.get("DWELL_RENDERER")
    if args.path is None:
        return said or "cpu"
    head, colon, name = (said or "gpu").partition(":")
    if head.partition("+")[0] != "gpu":
        raise ValueError(f"--path {args.path}: the back end is {said!r}; gpu alone has paths")
    return f"gpu+{args.path}{colon}{name}"


def _as_json(error: UnicodeError) -> tuple[str, int]:
    """Characters that an encoding lacks, as JSON escapes them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return json.dumps(error.object[error.start : error.end])[1:-1], error.end


codecs.register_error("dwell.json", _as_json)


def _encodable(text: str, encoding: str | None) -> str:
    """Text that a stream of this encoding can print: other characters are escaped as in JSON."""
    if text.isascii() or encoding is None:
        return text
    return text.encode(encoding, "dwell.json").decode(encoding)


class Printable:
    """A stream that passes on printable text alone: all that commands print goes through it."""

    def __init__(self, stream: TextIO, name: str) -> None:
        """Writes to ``stream``, which goes on taking anything itself; errors call it ``name``."""
        self.stream = stream
        self._name = name
        self._failed: OSError | None = None

    def write(self, text: str) -> int:
        """Passes text on."""
        with self._named():
            self.stream.write(_encodable(printable(text), self.stream.encoding))
        return len(text)

    def flush(self) -> None:
        """Writes what waits in a buffer.

        Raises:
            OSError: Now, or at an earlier call, whose caller may have passed over it.
        """
        with self._named():
            self.stream.flush()
        if self._failed is not None:
            raise self._failed

    def discard(self) -> None:
        """Lets what waits in a buffer go nowhere: the interpreter would fail on it as it ends."""
        with contextlib.suppress(OSError, ValueError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self.stream.fileno())
            os.close(nowhere)

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            error.filename = error.filename or self._name
            self._failed = error
            raise

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - whatever the stream has
        """All else is the stream's own."""
        return getattr(self.stream, name)


def sentence(error: BaseException) -> str:
    """The sentence of an error for people."""
    if isinstance(error, MemoryError):
        return "not enough memory"
    said = str(error)
    if isinstance(error, OSError) and error.strerror is not None:
        where = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
        said = f"{where}{error.strerror}"
    return with_short_words(said)


class ProgressBar:
    """A progress bar on standard error; silent where that is no terminal."""

    def __init__(self) -> None:
        """Shows nothing yet."""
        # Goes back to the beginning of the line, which text for people may not.
        self._stream = getattr(sys.stderr, "stream", sys.stderr)
        self._shows = self._stream.isatty()

    def __call__(self, fraction: float, what: str) -> None:
        """Shows a fraction (0 to 1) and what is being done."""
        if self._shows:
            done = round(30 * min(max(fraction, 0.0), 1.0))
            line = f"\r[{'#' * done}{'.' * (30 - done)}] {printable(what)[:60]:<60}"
            end = "\n" if fraction >= 1.0 else ""
            print(line, end=end, file=self._stream, flush=True)
