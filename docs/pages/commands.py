"""The command line: what every command says of itself."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Iterator

from dwell.cli import COMMANDS, parser

#: Those with commands of their own below them.
_BELOW = {
    "challenge": ("make", "run", "score"),
    "localize": ("make", "score"),
    "measure": ("import", "coverage"),
    "record": ("teach",),
    "views": ("make", "clip", "export", "datasheet"),
}


@contextlib.contextmanager
def _plain(columns: int = 100) -> Iterator[None]:
    """Makes argparse write as for a terminal of a fixed width without colours."""
    wanted = {"COLUMNS": str(columns), "NO_COLOR": "1"}
    before = {name: os.environ.get(name) for name in wanted}
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def usage(*words: str) -> str:
    """What ``dwell WORDS --help`` prints."""
    said = io.StringIO()
    with _plain(), contextlib.redirect_stdout(said), contextlib.suppress(SystemExit):
        parser(words[0] if words else None).parse_args([*words, "--help"])
    return said.getvalue()


def _section(*words: str) -> str:
    return f"## dwell {' '.join(words)}\n\n```text\n{usage(*words)}```\n"


def page() -> str:
    """The page."""
    sections = []
    for name in COMMANDS:
        sections.append(_section(name))
        sections += [_section(name, below) for below in _BELOW.get(name, ())]
    return "\n".join(
        [
            "# Command line\n",
            "Exit codes: 0 done, 1 failed with a sentence on standard error, 2 bad usage,",
            "130 interrupted.\n",
            f"```text\n{usage()}```\n",
            *sections,
        ]
    )
