"""Views, routes and changes in words, by Python and by the command line."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv, ReplayRecorder

HOUSE = "builtin:studio"
Command = Callable[..., subprocess.CompletedProcess[str]]
pytestmark = pytest.mark.usefixtures("open_once")


def viewpoints(world: dwell.World) -> list[dict[str, object]]:
    return [{"position": r["eye"], "yaw_deg": r["yaw_deg"]} for r in world.house.rooms()]


@pytest.mark.long
def test_what_a_view_tells_is_in_the_picture() -> None:
    """By the instance image, which texts do not use: what is told is seen, the largest is told."""
    camera = dwell.Camera(width=256, height=256, fov_deg=90)
    told = unseen = large = missed = 0
    for name in ("builtin:apartment", "seed:12"):
        world = dwell.World(name, agents=0)
        nouns = {o["id"]: o["category"] for o in world.objects()}
        for viewer in viewpoints(world):
            text = world.describe("view", viewer=viewer, length="long")[0]
            image = world.render(
                position=viewer["position"],  # type: ignore[arg-type]
                yaw_deg=viewer["yaw_deg"],  # type: ignore[arg-type]
                camera=camera,
                channels=("instance",),
            )["instance"]
            ids, pixels = np.unique(image, return_counts=True)
            seen = dict(zip(ids.tolist(), pixels.tolist(), strict=True))
            for claim in text.claims:
                for number in set(claim["ids"]) & set(nouns):
                    told += 1
                    # Instance images end at clear glass, through which people see.
                    unseen += seen.get(number, 0) < 16
            for number, count in seen.items():
                if number in nouns and count >= 0.03 * 256 * 256:
                    large += 1
                    missed += number not in text.ids
    print(f"{told} told, {missed} of {large} large ones missed")
    assert told > 100
    assert unseen * 50 <= told
    assert missed * 20 <= large


def test_texts_are_of_the_length_and_checked() -> None:
    world = dwell.World(HOUSE, agents=0)
    for viewer in viewpoints(world):
        short, normal, long = (
            world.describe("view", viewer=viewer, length=length)[0]
            for length in ("short", "normal", "long")
        )
        assert len(short) <= len(normal) <= len(long)
        for sentence in re.findall(r"[^.]+\.", long):
            if not sentence.strip().startswith("It "):
                answer = world.check(sentence.strip(), viewer=viewer)["answer"]
                assert answer["truth"] is True, sentence


def test_levels_say_what_they_need() -> None:
    world = dwell.World(HOUSE, agents=0)
    viewer = viewpoints(world)[0]
    with pytest.raises(dwell.ConfigError, match="with viewer or agent"):
        world.describe("view")
    with pytest.raises(dwell.ConfigError, match="with to, a thing or a room"):
        world.describe("route", viewer=viewer)
    with pytest.raises(dwell.ConfigError, match="nothing is called"):
        world.describe("route", viewer=viewer, to="unicorn_1")
    with pytest.raises(dwell.ConfigError, match="with since, a snapshot"):
        world.describe("changes")
    with pytest.raises(dwell.ConfigError, match="expected the bytes"):
        world.describe("changes", since="yesterday")  # type: ignore[call-overload]
    with pytest.raises(dwell.DwellError, match="snapshot"):
        world.describe("changes", since=b"dwworld9")
    other = dwell.World("builtin:apartment", agents=0).snapshot()
    with pytest.raises(dwell.DwellError, match="another house"):
        world.describe("changes", since=other)
    assert world.describe("changes", since=world.snapshot()) == [""]


@pytest.mark.parametrize("level", ["object", "room", "house", "graph", "instructions", "view"])
def test_what_a_level_does_not_read_is_refused(level: str) -> None:
    world = dwell.World(HOUSE)
    given = {"to": "room:studio", "since": world.snapshot(), "viewer": 0, "agent": 0}
    if level == "view":
        del given["viewer"], given["agent"]
    for name, value in given.items():
        told = f"{name} is given, and level '{level}' does not read it; levels that do are"
        with pytest.raises(dwell.ConfigError, match=told):
            world.describe(level, **{name: value})  # type: ignore[call-overload]


@pytest.mark.long
def test_the_command_tells_views_routes_and_changes(tmp_path: Path, command: Command) -> None:
    done = command("describe", HOUSE, "--level", "view", "--json")
    rooms = len(dwell.House.open(HOUSE).rooms())
    rows = json.loads(done.stdout)["rows"]
    assert len(rows) == rooms
    assert {"house", "level", "viewer", "text", "claims", "ids"} <= set(rows[0])
    done = command("describe", HOUSE, "--level", "route", "--json")
    routes = json.loads(done.stdout)["rows"]
    assert len(routes) == rooms * (rooms - 1)
    assert all(row["to"].startswith("room:") for row in routes)
    seeded = command("describe", HOUSE, "--level", "view", "--seed", "4").stdout
    assert seeded != command("describe", HOUSE, "--level", "view").stdout

    env = ReplayRecorder(DwellEnv(houses=HOUSE), tmp_path)
    env.reset(seed=3)
    env.step(1)
    env.close()
    (file,) = tmp_path.glob("*.replay")
    done = command("describe", file, "--level", "changes", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["rows"][0]["text"] == ""
    refused = command("describe", HOUSE, "--level", "changes")
    assert refused.returncode == 1
    told = f"{HOUSE}: --level changes expects the file of a replay, as ReplayRecorder writes it"
    assert told in refused.stderr
    # What was played before goes on to be told.
    done = command("describe", HOUSE, file, "--level", "changes", "--out", tmp_path / "c.jsonl")
    assert done.returncode == 1
    assert len((tmp_path / "c.jsonl").read_text("utf-8").splitlines()) == 1


def test_a_reference_is_checked_to_mean_its_thing() -> None:
    world = dwell.World(HOUSE, agents=0)
    named = 0
    for row in world.objects():
        for strategy in ("shortest", "incremental", "relational"):
            words = world.refer(row["id"], strategy=strategy)
            if words is not None:
                named += 1
                assert row["id"] in words.ids
                found = world.check(f"There is {words}.")["phrases"][0]["things"]
                assert [thing["id"] for thing in found] == [row["id"]], words
    assert named > 100
    with pytest.raises(dwell.ConfigError, match="allowed are shortest, incremental, relational"):
        world.refer("sofa_1", strategy="cryptic")  # type: ignore[arg-type]
    with pytest.raises(dwell.ConfigError, match="no object"):
        world.refer("unicorn_1")
    viewer = viewpoints(world)[0]
    seen = world.describe("view", viewer=viewer)[0].ids
    assert any(world.refer(number, viewer=viewer) for number in seen)


def test_styles_are_those_of_texts_about_things() -> None:
    house = dwell.House.open("builtin:studio")
    world = dwell.World(house, agents=0)
    for level in ("object", "room", "house"):
        plain, rich = (house.describe(level, style=style) for style in ("plain", "rich"))
        assert rich == house.describe(level)
        assert sum(map(len, plain)) < sum(map(len, rich))
        assert world.describe(level, style="plain") == plain
    told: Any = "gaudy"
    with pytest.raises(dwell.ConfigError, match='style is "gaudy"; allowed are plain, rich'):
        house.describe("room", style=told)
    for level in ("graph", "instructions"):
        with pytest.raises(dwell.ConfigError, match="only the levels object, room, house, view"):
            house.describe(level, style="plain")
    with pytest.raises(dwell.ConfigError, match="style"):
        world.describe("room", style=b"plain")  # type: ignore[call-overload] # tried
