"""What pip sees: the package is typed, named as the workspace, and light."""

import importlib.metadata
import importlib.resources
import re
from pathlib import Path

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
