"""Examples and the README's programs run as they stand."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("open_once")
ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*.py"))


def test_an_example_runs_in_a_process_of_its_own() -> None:
    done = subprocess.run(
        [sys.executable, EXAMPLES[0]], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


@pytest.mark.long
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_says_something(
    example: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", [str(example)])
    runpy.run_path(str(example), run_name="__main__")
    assert capsys.readouterr().out.strip()


def test_examples_are_short_and_listed() -> None:
    listed = (ROOT / "examples" / "README.md").read_text("utf-8")
    assert len(EXAMPLES) >= 6
    for example in EXAMPLES:
        assert f"]({example.name})" in listed
        assert len(example.read_text("utf-8").splitlines()) < 60


PROGRAMS = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL)


@pytest.mark.long
@pytest.mark.parametrize("program", PROGRAMS, ids=range(len(PROGRAMS)))
def test_the_programs_of_the_readme_run(
    program: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "program.py"
    path.write_text(program, "utf-8")
    runpy.run_path(str(path), run_name="__main__")
    # The first one's expert succeeds, and a claim is true; the others print shapes.
    told = capsys.readouterr().out
    assert ("True" if "success" in program or "check(" in program else "(") in told
