"""The command line: ``dwell COMMAND ...``. One file a command, and one line here."""

from __future__ import annotations

import argparse
import contextlib
import errno
import importlib
import os
import re
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from dwell.messages import with_short_words

#: Command and what it does; the file of that name has ``configure(parser)`` and ``run(args)``.
COMMANDS = {
    "doctor": "versions, processor, back ends; what is missing and how to get it",
    "demo": "the whole thing once: see, hear, touch, describe, follow an instruction",
    "info": "counts, rooms, areas, categories, report of damage",
    "render": "pictures from a place in a house, plans, doll's houses, contact sheets",
    "view": "a house in the Rerun viewer, or as a recording for it",
    "replay": "a recorded episode: checked to the bit, seen and heard again",
    "describe": "sentences about houses",
    "check-text": "whether the claims of a text are true of a house or a view",
    "views": "pictures with captions, expressions, relations and questions, in bulk",
    "ir": "an impulse response between two points",
    "localize": "recordings with labels of where sounds are, and how well they are found",
    "generate": "houses from seeds, in bulk, written as files",
    "episodes": "seeded episodes of a task over many houses, as a file",
    "evaluate": "a policy plays episodes; its result, and whether a result holds",
    "record": "data sets: a person at a table points, shows and speaks",
    "measure": "tables of measurements into a bundle that calibrate reads",
    "calibrate": "measured data against the simulation: what is missing, and what it gains",
    "challenge": "cases with a hidden cause for methods of calibration, and their scores",
    "bench": "throughput of a stage",
}

#: What a system says where a user's share of the disk is full; not all have such shares.
_EDQUOT = getattr(errno, "EDQUOT", errno.ENOSPC)


#: Words that are values, though they begin as options do: -10, -.5, -1e3, -inf, and points such as
#: -2,1,3. What more they may be, whoever reads them says.
_NEGATIVE = re.compile(r"-(?:[0-9.]|(?:inf|infinity|nan)(?:,|$))", re.IGNORECASE)


class _Parser(argparse.ArgumentParser):
    """A parser, also of the commands below: any negative number is a value.

    Its errors quote the beginning of long words.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:  # noqa: ANN401 - of argparse
        """Makes a parser as argparse does."""
        super().__init__(*args, **kwargs)
        # That of argparse knows neither exponents nor infinity, before Python 3.14.
        self._negative_number_matcher = _NEGATIVE

    def error(self, message: str) -> NoReturn:
        """Says what is wrong with the arguments, and leaves."""
        super().error(with_short_words(message))


def parser(chosen: str | None = None) -> argparse.ArgumentParser:
    """The parser of all commands; only the chosen one's file is imported and adds its options."""
    top = _Parser(
        prog="dwell", description="A household that agents see, touch, hear and talk about."
    )
    top.add_argument("--version", action="store_true", help="print the version and leave")
    commands = top.add_subparsers(dest="command", metavar="COMMAND")
    for name, about in COMMANDS.items():
        command = commands.add_parser(name, help=about, description=about)
        if name == chosen:
            module = importlib.import_module(f"dwell.cli.{name.replace('-', '_')}")
            module.configure(command)
            command.set_defaults(run=module.run, parser=command)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command.

    Returns:
        0 done, 1 failed with a sentence on standard error, 2 bad usage, 130 interrupted.
    """
    try:
        return _printed(arguments)
    except KeyboardInterrupt:
        # In the middle of imports, before anything was done.
        with contextlib.suppress(OSError, ValueError):
            if sys.stderr is not None:
                print("dwell: interrupted", file=sys.stderr)
        return 130


def _printed(arguments: Sequence[str] | None) -> int:
    """Runs a command, whatever it prints through one place."""
    from dwell.cli.common import Printable, sentence

    with contextlib.ExitStack() as stack:
        # A stream that the caller closed is none to Python.
        nowhere = stack.enter_context(open(os.devnull, "w", encoding="utf-8"))
        out = Printable(sys.stdout or nowhere, "standard output")
        told = Printable(sys.stderr or nowhere, "standard error")
        # One place for all that is printed: names come from strangers.
        stack.enter_context(contextlib.redirect_stdout(out))
        stack.enter_context(contextlib.redirect_stderr(told))
        status = 0
        try:
            status = _run(arguments)
            out.flush()
        except OSError as error:
            out.discard()
            # Who closed a pipe has read enough; of what failed before there is a sentence already.
            if status == 0 and not isinstance(error, BrokenPipeError):
                print(f"dwell: {sentence(error)}", file=sys.stderr)
            status = status or 1
        return status


def _run(arguments: Sequence[str] | None) -> int:
    from dwell import DwellError, __version__
    from dwell.cli.common import sentence
    from dwell.plugin_parts import refusing_exit

    arguments = sys.argv[1:] if arguments is None else arguments
    top = parser(next((word for word in arguments if not word.startswith("-")), None))
    try:
        args = top.parse_args(arguments)
    except SystemExit as stop:
        return int(stop.code or 0)
    if args.version:
        print(__version__)
        return 0
    if args.command is None:
        top.print_usage(sys.stderr)
        return 2
    try:
        with refusing_exit():
            return int(args.run(args))
    except KeyboardInterrupt:
        print("dwell: interrupted; nothing was left half written", file=sys.stderr)
        return 130
    except BrokenPipeError:
        return 1
    except (DwellError, OSError, ValueError, ModuleNotFoundError, MemoryError) as error:
        _name_full_disk(error, getattr(args, "out", None))
        print(f"dwell {args.command}: {sentence(error)}", file=sys.stderr)
        return 1
    except Exception as error:
        # A fault of ours. People get a sentence; who looks for it sets the variable.
        if os.environ.get("DWELL_TRACEBACK"):
            raise
        print(
            f"dwell {args.command}: a bug of dwell, please report it: "
            f"{type(error).__name__}: {error} (DWELL_TRACEBACK=1 shows where)",
            file=sys.stderr,
        )
        return 1


def _name_full_disk(error: BaseException, out: str | os.PathLike[str] | None) -> None:
    """Gives an error that there is no room, and names none, that of what was being written."""
    from dwell.files import rename_error

    if not isinstance(error, OSError) or error.filename is not None or out is None:
        return
    if error.errno in (errno.ENOSPC, errno.EFBIG, _EDQUOT):
        rename_error(error, out)
