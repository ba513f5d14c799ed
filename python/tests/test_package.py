"""The package for pip: typed, named as the workspace, and light."""

import importlib
import importlib.metadata
import importlib.resources
import re
import subprocess
import sys
from pathlib import Path

import pytest

import dwell

ROOT = Path(__file__).resolve().parents[2]


def test_version_is_the_workspaces() -> None:
    manifest = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    version = re.search(r'^version = "(.+)"$', manifest, re.MULTILINE)
    assert version is not None
    assert importlib.metadata.version("dwell") == version[1]


def test_package_is_marked_as_typed() -> None:
    assert importlib.resources.files("dwell").joinpath("py.typed").is_file()


def test_only_three_light_packages_are_required() -> None:
    requirements = importlib.metadata.requires("dwell") or []
    core = {re.split(r"[<>=!~ ;]", line)[0] for line in requirements if "extra ==" not in line}
    assert core == {"gymnasium", "numpy", "pillow"}


def test_command_line_is_installed() -> None:
    scripts = importlib.metadata.entry_points(group="console_scripts", name="dwell")
    assert [script.value for script in scripts] == ["dwell.cli:main"]


def test_modules_are_had_from_the_package_alone() -> None:
    names = ["sounds", "measures", "plans", "charts", "navigation", "world", "envs", "sound_maps"]
    uses = "\n".join(f"assert dwell.{name}.__name__ == 'dwell.{name}'" for name in names)
    program = f"""
import sys
sys.argv[0] = "dwell"  # as the command line imports it: without the environments
import dwell
assert "dwell.sounds" not in sys.modules and "gymnasium" not in sys.modules
assert {names!r} == [name for name in {names!r} if name in dir(dwell)]
{uses}
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_every_public_module_is_had_from_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    pages = importlib.import_module("pages.api")
    for module in pages.modules():
        assert module.removeprefix("dwell.") in {*dwell._MODULES}, module
