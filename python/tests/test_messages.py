"""What errors say of odd input: which file it is, in few words, and in printable ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import dwell
from dwell import cli, files
from dwell.envs import DwellEnv
from dwell.played_actions import unpacked

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


ESC = "\x1b[31m\u202e\u200f\u061cname"


@pytest.fixture
def junk(tmp_path: Path) -> Path:
    path = tmp_path / ESC
    path.write_text('{"a": 1')
    return path


@pytest.mark.parametrize(
    "call",
    [
        lambda _: dwell.House.expand(ESC),
        lambda _: DwellEnv("Free", houses=ESC),
        lambda _: dwell.Head.from_sofa(ESC),
        lambda _: dwell.register_task(ESC, dwell.Task),
        dwell.Replay.read,
        dwell.episodes.read,
        dwell.evaluation.differences,
        files.read_json,
        lambda path: files.read(path, 3),
    ],
)
def test_no_error_has_what_commands_a_terminal(call: Callable[[Path], object], junk: Path) -> None:
    with pytest.raises(Exception, match=r"\\u001b\[31m\\u202e\\u200f\\u061cname") as caught:
        call(junk)
    assert str(caught.value).isprintable()


def test_an_error_of_a_user_is_printable_and_keeps_what_it_was_made_of() -> None:
    class MyError(dwell.UsageError):
        pass

    error = MyError(f"no {ESC}", 1)
    assert error.args == (f"no {ESC}", 1)
    assert str(MyError(f"a {ESC}\nb\t")) == "a \\u001b[31m\\u202e\\u200f\\u061cname\nb\t"
    assert str(dwell.ConfigError()) == ""


LONG = "x" * 80_000


@pytest.mark.parametrize(
    "call",
    [
        lambda: DwellEnv("Free", houses="builtin:studio", reward=LONG),
        lambda: DwellEnv(f"{LONG}:Y", houses="builtin:studio"),
        lambda: dwell.register_task(f"{LONG}?", dwell.Task),
    ],
)
def test_an_error_quotes_the_beginning_of_what_it_was_given(call: Callable[[], object]) -> None:
    with pytest.raises(dwell.ConfigError, match="xxx") as caught:
        call()
    assert len(str(caught.value)) < 1000


def test_no_error_is_longer_than_people_read() -> None:
    told = str(dwell.ConfigError(f"begin {LONG} end"))
    assert len(told) < 8000
    assert told.startswith("begin xxx")
    assert told.endswith("xxx end")
    assert "(76010 characters left out)" in told


@pytest.mark.parametrize(
    "arguments",
    [
        [LONG],
        ["info", f"--unknown={LONG}"],
        ["describe", "builtin:studio", f"--level={LONG}"],
        ["views", LONG],
        *(
            ["render", "builtin:studio", "--out", "a.png", f"--{name}={LONG}"]
            for name in ("at", "intrinsics", "projection", "width")
        ),
        ["ir", "builtin:studio", f"--source={LONG}"],
    ],
)
def test_bad_usage_is_told_in_few_words(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(arguments) == 2
    assert "error: " in (told := capsys.readouterr().err)
    assert len(told) < 2000


def test_a_field_of_a_spec_is_text_that_utf_8_can_hold(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new"
    assert cli.main(["generate", "--count", "1", "--spec", "style=\udcff", "--out", str(out)]) == 1
    told = "dwell generate: --spec is 'style=\\udcff'; expected text that UTF-8 can hold\n"
    assert capsys.readouterr().err == told
    assert not out.exists()


@pytest.mark.parametrize("command", [["render"], ["replay"]])
@pytest.mark.parametrize("edge", ["-1", "0", "16385", "١٢"])
def test_edges_of_pictures_are_told_with_what_is_allowed(
    command: list[str], edge: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for option in ("--width", "--height"):
        assert cli.main([*command, "x", "--out", "a.png", option, edge]) == 2
        told = f"{option}: expected a whole number from 1 to 16384, found {edge!r}\n"
        assert capsys.readouterr().err.endswith(told)


@pytest.mark.parametrize("number", ["١", "1_0", "１"])  # noqa: RUF001 - digits of others
def test_numbers_have_digits_that_tables_have(
    number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for option, value in (("--at", f"{number},1,1"), ("--yaw-deg", number)):
        assert cli.main(["render", "x", "--out", "a.png", f"{option}={value}"]) == 2
        assert f"found {value!r}" in capsys.readouterr().err
    assert cli.main(["check-text", "builtin:studio", "A lamp.", f"--view={number},1,1,0"]) == 1
    assert f"found '{number},1,1,0'" in capsys.readouterr().err


def test_actions_of_a_result_are_told_with_the_limit() -> None:
    told = "'1\\*99999999999999999999'; expected NUMBER or NUMBER\\*COUNT, each of 1 to 9 digits"
    with pytest.raises(dwell.ConfigError, match=told):
        unpacked("actions", "1*99999999999999999999 0")
