"""What errors say of odd input: which file it is, in few words, and in printable ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from dwell import cli, files

MEM = Path("/proc/self/mem")
needs_mem = pytest.mark.skipif(not MEM.exists(), reason="the system has no /proc")


@needs_mem
def test_an_open_file_that_cannot_be_read_on_is_named() -> None:
    for read in (
        lambda file: file.read(),
        lambda file: file.read(5),
        lambda file: file.readline(),
        lambda file: file.readinto(bytearray(5)),
        lambda file: next(files.lines(file, "another name")),
    ):
        with files.open_file(MEM) as file, pytest.raises(OSError, match="'/proc/self/mem'"):
            read(file)


@needs_mem
@pytest.mark.parametrize(
    "arguments",
    [
        ["check-text", "builtin:studio", "There is a lamp.", "--file", "FILE"],
        ["evaluate", "stop", "--episodes", "FILE"],
        ["measure", "import", "--init", "FILE"],
    ],
)
def test_a_command_names_the_file_that_it_cannot_read(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    link = tmp_path / "link.csv"
    link.symlink_to(MEM)
    assert cli.main([str(link) if word == "FILE" else word for word in arguments]) == 1
    told = capsys.readouterr().err
    assert told == f"dwell {arguments[0]}: {link}: Input/output error\n"
