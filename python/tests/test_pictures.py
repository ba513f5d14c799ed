"""Plans, doll's houses, contact sheets, and cameras of any intrinsics on the command line."""

from __future__ import annotations

import functools
import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from PIL import Image

import dwell
from dwell import _native, plans
from dwell.engine_types import Channel

pytestmark = pytest.mark.usefixtures("open_once")
WALL = (40, 40, 44)


Command = Callable[..., subprocess.CompletedProcess[str]]
Files = Callable[..., list[Path]]


@pytest.fixture
def render(command: Command) -> Command:
    """``dwell render`` in this process."""
    return functools.partial(command, "render")


@pytest.fixture
def files(render: Command) -> Files:
    """What ``dwell render`` writes."""

    def written(*arguments: str | Path) -> list[Path]:
        done = render(*arguments, "--json")
        assert done.returncode == 0, done.stderr
        return [Path(name) for name in json.loads(done.stdout)["files"]]

    return written


def size(path: Path) -> tuple[int, int]:
    with Image.open(path) as image:
        return image.size


def test_channels_are_the_sensors_of_pictures(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox)
    sensors = [row["name"] for row in _native.sensors()]

    def shows(name: str) -> bool:
        try:
            world.render(camera=dwell.Camera(4, 4), channels=[name])  # type: ignore[list-item] # all names there are
        except dwell.DwellError:
            return False
        return True

    assert [name for name in sensors if shows(name)] == list(get_args(Channel))


def test_maps_show_walls_where_they_stand(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox, agents=0)
    image, (left, top), scale = world.map(400)

    def at(x: float, z: float) -> tuple[int, ...]:
        return tuple(image[int((z - top) * scale), int((x - left) * scale)])

    # The room of 6 by 5 m; its walls are sheets.
    assert {at(0.0, 2.5), at(6.0, 2.5), at(3.0, 0.0), at(3.0, 5.0)} == {WALL}
    assert WALL not in {at(3.0, 2.5), at(0.3, 0.3)}
    assert at(-0.3, 2.5) == (250, 249, 246)
    with pytest.raises(dwell.DwellError, match="no storey 1"):
        world.map(400, level=1)


def test_pictures_of_houses_hold_every_storey() -> None:
    world = dwell.World("builtin:house", agents=0)
    assert plans.levels_of(world.house) == 2
    both = [plans.floor_plan(world, level, longest_edge=300) for level in (0, 1)]
    assert [max(plan.size) for plan in both] == [300, 300]
    assert np.asarray(both[0]).tolist() != np.asarray(both[1]).tolist()
    doll = plans.dollhouse(world, width=300)
    assert doll.width == 300
    for half in (
        doll.crop((0, 0, 300, doll.height // 2)),
        doll.crop((0, doll.height // 2, *doll.size)),
    ):
        pixels = np.asarray(half).reshape(-1, 3)
        # Half of the picture is house, and some of that is wall that was cut.
        assert 0.3 < (pixels != (250, 249, 246)).any(-1).mean() < 0.9
        assert (pixels == WALL).all(-1).mean() > 0.01
    with pytest.raises(dwell.DwellError, match="down_deg is 5"):
        plans.dollhouse(world, down_deg=5.0)


def test_ways_are_drawn_where_they_lead(shoebox: dwell.House) -> None:
    world = dwell.World(shoebox, agents=0)
    plans.floor_plan(world, longest_edge=16)  # room names of less than a pixel
    plain = np.asarray(plans.floor_plan(world, longest_edge=300)).astype(int)
    way = [(1.0, 0.0, 4.0), (5.0, 0.0, 4.0)]
    drawn = np.asarray(plans.floor_plan(world, longest_edge=300, ways=[("#ff0000", way)]))
    changed = np.argwhere(np.abs(drawn - plain).sum(-1) > 60)
    _, (left, top), scale = world.map(300)
    low, high = changed.min(0), changed.max(0)
    assert abs(changed[:, 0].mean() - (4.0 - top) * scale) < 4
    assert abs(low[1] - (1.0 - left) * scale) < 12
    assert abs(high[1] - (5.0 - left) * scale) < 12


@pytest.mark.long
def test_render_writes_plans_and_sheets(tmp_path: Path, render: Command, files: Files) -> None:
    house = "builtin:studio"
    paths = files(house, "--map", "--dollhouse", "--sheet", "--width", "200", "--out", tmp_path)
    assert [path.name for path in paths] == ["map_0.png", "dollhouse.png", "sheet.png"]
    assert size(paths[1])[0] == 200
    rooms = len(dwell.House.open(house).rooms())
    rows = -(-(rooms + 2) // 4)
    assert size(paths[2])[1] == rows * (270 + 24 + 10) + 10
    (sheet,) = files("seed:1..3?home=studio", house, "--sheet", "--columns", "2", "--out", tmp_path)
    assert size(sheet) == (2 * 370 + 10, 2 * 304 + 10)
    done = render(house, "builtin:castle", "--sheet", "--out", tmp_path / "some", "--json")
    assert done.returncode == 1
    assert "castle" in done.stderr
    assert size(Path(json.loads(done.stdout)["files"][0])) == (380, 314)
    refused = render("seed:1..3", house, "--map", "--out", tmp_path)
    assert (refused.returncode, refused.stdout) == (1, "")
    assert "--sheet" in refused.stderr


@pytest.mark.parametrize("columns", [0, 65, 100])
def test_columns_are_refused_before_a_picture_is_made(
    columns: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    from dwell import cli, plans

    monkeypatch.setattr(plans, "dollhouse", None)
    for houses in (["builtin:studio"], ["builtin:studio", "seed:1"]):
        options = ["--sheet", "--columns", str(columns), "--out", str(tmp_path / "out")]
        assert cli.main(["render", *houses, *options]) == 1
        told = capsys.readouterr().err
        assert f"--columns is {columns}; allowed are whole numbers from 1 to 64" in told
    with pytest.raises(dwell.ConfigError, match="columns"):
        plans.houses_sheet(["builtin:studio"], columns=columns)


def test_a_title_of_any_length_is_drawn_within_its_tile() -> None:
    image = Image.new("RGB", (90, 60), "red")
    titles = ["n" * 1_000_001, "m" * 100, "a\nb", "i" * 1_000_001 + " m²", ""]
    for tile in ((120, 60), (40, 30), (8, 8)):
        pictures = [(title, image) for title in (*titles, "plan, 12.5 m²")]
        drawn = np.asarray(plans.sheet(pictures, columns=1, tile=tile))
        background = drawn[0, 0]
        # Nothing stands in the margin beside the tiles.
        assert (drawn[:, tile[0] + 12 :] == background).all()
    # What fits is drawn as it is: at the same place as without neighbours, to the bit.
    short, long = (
        plans.sheet([(title, image)], tile=(360, 60)) for title in ("kitchen", "m" * 100)
    )
    assert short.size == long.size
    narrow = np.asarray(plans.sheet([("kitchen", image)], tile=(100, 60)))
    assert np.array_equal(np.asarray(short)[70:, 10:110], narrow[70:, 10:110])


def test_the_middle_of_words_that_are_too_wide_is_left_out() -> None:
    def fitted(words: str, widest: float) -> str:
        return plans._fitted(words, widest, lambda part: float(len(part)))

    assert [fitted("living room", wide) for wide in (11, 10, 5, 3)] == [
        "living room",
        "livi...oom",
        "l...m",
        "...",
    ]
    assert fitted("", 0.0) == fitted("hall", 2.0) == ""
    assert fitted("n" * 1_000_001, 9.0) == "nnn...nnn"


def test_a_house_of_a_long_name_has_a_sheet_and_a_plan(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from dwell import cli

    monkeypatch.chdir(tmp_path)
    house = dwell.House.open("builtin:studio").edit()
    house.rename("n" * 1_000_001)
    house.done().write("y.dwell", "dwell")
    # The pictures are not what is tested.
    picture = Image.new("RGB", (40, 30))
    monkeypatch.setattr(plans, "dollhouse", lambda *_, **__: picture)
    monkeypatch.setattr(plans, "room_view", lambda *_, **__: picture)
    assert cli.main(["render", "y.dwell", "--sheet", "--out", "out"]) == 0, capsys.readouterr().err
    assert size(Path("out/sheet.png"))[0] == 4 * 370 + 10


@pytest.mark.long
def test_a_sheet_says_how_far_it_is() -> None:
    from dwell import plans

    told: list[tuple[float, str]] = []
    world = dwell.World("builtin:studio", agents=0)
    plans.house_sheet(world, progress=lambda share, what: told.append((share, what)))
    assert told[0] == (0.0, "doll's house")
    assert told[-1] == (1.0, f"{len(world.house.rooms()) + 2} pictures")
    assert [share for share, _ in told] == sorted(share for share, _ in told)


def test_the_command_line_takes_any_intrinsics(
    tmp_path: Path, render: Command, files: Files
) -> None:
    house = "builtin:studio"
    world = dwell.World(house, agents=0)
    view = ("--width", "40", "--height", "30", "--at", "3,1.2,4", "--yaw-deg", "30")
    lens = {"fx": 31.0, "fy": 33.0, "cx": 22.0, "cy": 12.0, "k1": -0.2, "k2": 0.03}
    cases = {
        "pinhole": {name: lens[name] for name in ("fx", "fy", "cx", "cy")},
        "brown_conrady": lens | {"k3": 0.0, "p1": 0.001, "p2": 0.0},
        "fisheye": lens | {"fx": 14.0, "k3": 0.0, "k4": 0.0, "half_angle_deg": 80.0, "k1": 0.02},
        "orthographic": {"width_m": 3.0, "height_m": 2.0},
    }
    for kind, numbers in cases.items():
        text = ",".join(f"{name}={value}" for name, value in numbers.items())
        options = ("--projection", kind, "--intrinsics", text, "--sensors", "depth")
        paths = files(house, *view, *options, "--out", tmp_path / kind)
        camera = dwell.Camera(40, 30, projection={"kind": kind, **numbers})
        place = {"position": (3.0, 1.2, 4.0), "yaw_deg": 30.0}
        expected = world.render(camera=camera, channels=["depth"], **place)["depth"]  # type: ignore[arg-type] # by name
        np.testing.assert_array_equal(np.load(paths[-1]), expected)
    assert render(house, *view, "--intrinsics", "fx", "--out", tmp_path).returncode == 2
    unknown = render(house, *view, "--intrinsics", "zoom=2", "--out", tmp_path)
    assert unknown.returncode == 1
    assert "zoom" in unknown.stderr
