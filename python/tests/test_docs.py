"""The documentation: links lead somewhere, tables say what the engine says, and the site builds."""

from __future__ import annotations

import importlib
import importlib.util
import os
import posixpath
import re
import runpy
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import gymnasium
import pytest

import dwell
import dwell.envs
import dwell.world
from dwell import _native
from dwell.envs.info_keys import EPISODE_KEYS, INFO_KEYS
from dwell.schemas import settings

ROOT = Path(__file__).resolve().parents[2]
MARKDOWN = sorted(
    path.relative_to(ROOT).as_posix()
    for pattern in ("*.md", "docs/**/*.md", "examples/*.md", "assets/*.md", "benches/**/*.md")
    for path in ROOT.glob(pattern)
)


PROGRAMS = [
    file
    for file in MARKDOWN
    if file.startswith("docs/") and "```python" in (ROOT / file).read_text("utf-8")
]


@pytest.mark.long
@pytest.mark.usefixtures("open_once")
@pytest.mark.parametrize("file", PROGRAMS)
def test_the_python_of_a_page_runs_from_its_beginning_to_its_end(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (ROOT / file).read_text("utf-8")
    program = "\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL))
    path = tmp_path / "program.py"
    path.write_text(program, "utf-8")
    monkeypatch.chdir(tmp_path)
    if "logging" in program:
        # What it sets holds for its process.
        done = subprocess.run(
            [sys.executable, "-W", "error", path], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    else:
        runpy.run_path(str(path), run_name="__main__")


def test_one_agent_of_the_readme_is_visible_to_the_other() -> None:
    text = (ROOT / "README.md").read_text("utf-8").split("## Run several agents", 1)[1]
    programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    program = next(program for program in programs if "dwell.World(" in program)
    names: dict[str, Any] = {}
    exec(program, names)
    # Agents have the numbers behind those of the things.
    agent_0 = 1 + max(row["id"] for row in names["world"].objects())
    assert (names["seen"]["instance"] == agent_0).mean() > 0.05


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    return importlib.import_module("pages")


def broken_links(pages: ModuleType, file: str, markdown: str) -> list[str]:
    """Links of a file to files or headings that do not exist."""
    broken = []
    for target in pages.sources.local_links(markdown):
        path, _, anchor = target.partition("#")
        there = posixpath.normpath(posixpath.join(posixpath.dirname(file), path)) if path else file
        if there != file and not (ROOT / there).exists():
            broken.append(target)
        elif anchor and there.endswith(".md"):
            text = markdown if there == file else (ROOT / there).read_text("utf-8")
            if anchor not in pages.sources.anchors(text):
                broken.append(target)
    return broken


def rows_of(table: str, heading: str) -> list[list[str]]:
    """The cells of the first table below a heading."""
    below = table.split(f"{heading}\n", 1)[1]
    lines = re.search(r"(?:^\|.*\n)+", below, re.MULTILINE)
    assert lines is not None
    cells = [re.split(r" (?<!\\)\| ", line[2:-2]) for line in lines[0].splitlines()]
    return [[cell.strip().strip("`") for cell in row] for row in cells[2:]]


@pytest.mark.parametrize("file", MARKDOWN)
def test_links_of_a_file_lead_to_files_and_headings(pages: ModuleType, file: str) -> None:
    assert broken_links(pages, file, (ROOT / file).read_text("utf-8")) == []


def test_broken_links_and_headings_are_found(pages: ModuleType) -> None:
    text = "# A b\n[x](no.md) [y](#a-b) [z](#c) [w](physics.md#none) `[v](gone.md)`\n"
    text += "```text\n[u](gone.md)\n```\n[t](https://example.org/gone)\n"
    assert broken_links(pages, "docs/page.md", text) == ["no.md", "#c", "physics.md#none"]


def test_links_of_the_site_lead_to_its_pages(pages: ModuleType) -> None:
    linked = pages.sources.linked
    assert linked("index.md", "[a](docs/laws.md#physics)") == "[a](laws.md#physics)"
    assert linked("index.md", "[a](examples/README.md)") == "[a](guide/index.md)"
    assert linked("guide/index.md", "[a](10_act.py)") == "[a](10_act.md)"
    assert linked("decisions/0004-rays.md", "[a](../physics.md)") == "[a](../physics.md)"
    assert linked("peers.md", "[a](../../docs/laws.md)") == "[a](laws.md)"
    assert linked("index.md", "![a](docs/images/demo.jpg)") == "![a](images/demo.jpg)"
    # What the site does not show is named; what does not exist is left for mkdocs to refuse.
    assert linked("index.md", "[the rules](clippy.toml)") == "the rules (`clippy.toml`)"
    assert linked("index.md", "[a](docs/none.md)") == "[a](docs/none.md)"


@pytest.mark.long
def test_every_sensor_stands_in_the_table_with_its_space(pages: ModuleType) -> None:
    rows = {row[0]: row for row in rows_of(pages.observations.page(), "# Observations")}
    sensors = {sensor["name"]: sensor["about"] for sensor in _native.sensors()}
    assert list(rows) == list(sensors)
    spaces = {}
    named: dict[tuple[str, bool], list[str]] = {}
    for row in _native.sensors():
        (task, *_) = row["goal_tasks"] or ["InstructionFollowing"]
        named.setdefault((task, row["name"] == "wheel_odometry"), []).append(row["name"])
    on_wheels = {"agents": [{"locomotion": "differential_drive"}]}
    for (task, needs_wheels), names in named.items():
        world = on_wheels if needs_wheels else None
        env = gymnasium.make(f"dwell/{task}-v0", sensors=names, world=world)
        assert isinstance(env.observation_space, gymnasium.spaces.Dict)
        spaces |= env.observation_space.spaces
        env.close()
    for name, (_, kind, shape, dtype, _, low, high, about) in rows.items():
        space = spaces[name]
        assert (kind, about) == (type(space).__name__, sensors[name])
        if isinstance(space, gymnasium.spaces.Text):
            assert (dtype, high) == ("text", f"{space.max_length} characters")
            continue
        assert (shape, dtype) == (str(space.shape), str(space.dtype))
        if isinstance(space, gymnasium.spaces.MultiDiscrete):
            assert (float(low), float(high.replace(",", ""))) == (0, space.nvec.max() - 1)
        else:
            assert isinstance(space, gymnasium.spaces.Box)
            bounds = (float(low.replace(",", "")), float(high.replace(",", "")))
            assert bounds == pytest.approx((space.low.min(), space.high.max()), rel=1e-5)


def test_every_sensor_is_under_settings_once(pages: ModuleType) -> None:
    below = pages.observations.page().split("## Settings")[1]
    named = re.findall(r"`(\w+)`", " ".join(re.findall(r"^(?:Of|The others) .*$", below, re.M)))
    assert sorted(named) == sorted(pages.observations.sensor_names())


def test_every_action_stands_in_the_tables(pages: ModuleType, apartment: dwell.House) -> None:
    page = pages.actions.page()
    discrete = rows_of(page, "## Discrete")
    assert [row[:2] for row in discrete] == [
        [str(number), name] for number, name in enumerate(_native.actions())
    ]
    assert all(row[2] for row in discrete)
    world = dwell.World(apartment)
    with pytest.raises(dwell.ConfigError) as refused:
        world.act("fly")
    kinds = re.findall(r"\w+", str(refused.value).split("there are")[1])
    assert [row[0] for row in rows_of(page, "## Hands")] == kinds
    continuous = rows_of(page, "## Continuous")
    assert [row[0] for row in continuous] == [row["name"] for row in settings()["AgentControl"]]
    assert [row[1] for row in continuous] == ["0", "1", "2", "3", "", ""]


def test_the_tables_of_limits_are_those_of_a_world(pages: ModuleType) -> None:
    page = pages.actions.page()
    room = dwell.House.shoebox((4.0, 2.5, 4.0), substance="plaster")
    world = dwell.World(room, agents=[{"locomotion": {"holonomic": {}}}])
    told = {
        name: one for name, one in world.parameters().items() if name.startswith("agent/0/base")
    }
    rows = {row[0]: row for row in rows_of(page, "### Holonomic")}
    assert rows
    assert set(rows) == set(told)
    for name, (_, value, unit, low, high) in rows.items():
        shown = [float(cell.replace(",", "")) for cell in (value, low, high)]
        assert shown == pytest.approx([told[name][key] for key in ("value", "low", "high")])
        assert unit == told[name]["unit"]


def test_every_environment_has_its_section(pages: ModuleType) -> None:
    page = pages.environments.page()
    for task in _native.tasks():
        assert f"## {task['id']}\n" in page
        rows = rows_of(page, f"### Observations of {task['name']}")
        assert [row[0] for row in rows] == task["sensors"]


def test_settings_of_worlds_and_bodies_are_those_that_worlds_take(pages: ModuleType) -> None:
    page = pages.environments.page()
    room = dwell.House.shoebox((4.0, 2.5, 4.0), substance="plaster")
    # Of a person all fields are told; of a capsule those of persons are not.
    body = dwell.World(room, agents=[{"kind": "person"}]).agents()[0]["body"]
    assert [row[0] for row in rows_of(page, "## Bodies of agents")] == list(body)
    with pytest.raises(dwell.ConfigError) as refused:
        dwell.World(room, no_such_setting=1)
    taken = re.findall(r"`(\w+)`", str(refused.value).split("expected one of")[1])
    assert [row[0] for row in rows_of(page, "## Settings of worlds")] == taken


def test_what_is_generated_is_not_stale(pages: ModuleType) -> None:
    assert importlib.import_module("pages.generated").stale() == []


def test_every_command_says_its_help(pages: ModuleType) -> None:
    page = pages.commands.page()
    for name in dwell.cli.COMMANDS:
        assert f"## dwell {name}\n\n```text\nusage: dwell {name}" in page
    assert "--out" in page.split("## dwell measure import")[1].split("## ")[0]


def test_every_public_name_is_in_the_reference(pages: ModuleType) -> None:
    index = pages.pages()["api/index.md"]
    for name in {*dwell.__all__, *dwell.envs.__all__} - {"__version__"}:
        assert re.search(rf"\| \[`dwell\.(?:\w+\.)?{name}`\]", index), name
    for module, names in pages.api.modules().items():
        assert all(hasattr(importlib.import_module(module), name) for name in names)


def test_every_example_is_in_the_guide(pages: ModuleType) -> None:
    made = pages.pages()
    for example in sorted((ROOT / "examples").glob("[0-9]*.py")):
        program = example.read_text("utf-8").split('"""')[2].strip()
        assert program in made[f"guide/{example.stem}.md"]


def test_a_type_that_nobody_explained_is_refused(pages: ModuleType) -> None:
    words = importlib.import_module("pages.schema_words").schema_words
    assert words({"type": ["number", "null"]}) == "number, or none"
    with pytest.raises(LookupError, match="no word for"):
        words({"type": "thing"})


def test_the_site_builds_strictly(tmp_path: Path) -> None:
    for needed in ("mkdocs", "material", "mkdocstrings", "mkdocstrings_handlers.python"):
        top = needed.split(".")[0]
        if importlib.util.find_spec(top) is None:
            pytest.skip(f"{top} is not installed; `make docs` installs it")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", tmp_path],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    world = (tmp_path / "api" / "world.html").read_text("utf-8")
    assert 'id="dwell.world.World.step"' in world
    assert ":meth:" not in world
    assert "InstructionFollowing" in (tmp_path / "index.html").read_text("utf-8")


def test_the_page_for_who_begins_says_what_the_engine_does() -> None:
    text = (ROOT / "docs/environments-at-a-glance.md").read_text("utf-8")

    def named(cell: str) -> list[str]:
        return cell.replace("`", "").split(", ")

    actions = rows_of(text, "## Actions")
    assert [row[:2] for row in actions] == [
        [str(k), name] for k, name in enumerate(_native.chosen_actions("{}"))
    ]
    assert "the episode ends" in actions[0][2]
    tasks = _native.tasks()
    assert [(row[0], row[1], named(row[2])) for row in rows_of(text, "## Environments")] == [
        (task["id"], task["about"], task["sensors"]) for task in tasks
    ]
    longer = {task["name"]: task["max_steps"] for task in tasks if task["max_steps"] != 1000}
    assert longer == {
        "Rearrange": 5000,
        "Tidy": 3000,
        "Cooperate": 1500,
        "SocialNav": 1500,
        "Carry": 1500,
    }
    assert "after 5,000" in text.split("## Environments")[1].split("<!--")[0]
    info = text.split("## Info")[1].split("## Sensors")[0]
    assert [key for key in (*INFO_KEYS, *EPISODE_KEYS) if f"`{key}`" not in info] == []


def test_the_wheel_for_this_machine_is_chosen_among_several(tmp_path: Path) -> None:
    for machine in ("x86_64", "aarch64", "riscv64"):
        (tmp_path / f"dwell-1.0-cp310-abi3-manylinux_2_28_{machine}.whl").touch()
    told = re.search(r"^pip install (.+?\.whl) ", (ROOT / "README.md").read_text("utf-8"), re.M)
    assert told is not None
    done = subprocess.run(
        ["sh", "-c", f"echo {told[1]}"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    own = os.uname().machine
    assert done.stdout.split() == [f"dwell-1.0-cp310-abi3-manylinux_2_28_{own}.whl"]
