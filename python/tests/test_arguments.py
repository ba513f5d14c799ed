"""Arguments are checked where they enter, and refused with a sentence of dwell's tree."""

from __future__ import annotations

import array
import itertools
import json
import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.arguments import finite_number, kept
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.localization import Settings

pytestmark = pytest.mark.usefixtures("open_once")

HOUSE = "builtin:apartment"
SMALL = {"rgb": {"width": 16, "height": 16}, "instruction": {}}
MOON = "world/gravity_m_s2"


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: dwell.World(HOUSE, agents=-1), "agents is -1"),
        (lambda: dwell.World(HOUSE, seed=-1), "seed is -1"),
        (lambda: dwell.World(HOUSE, control_rate_hz=math.nan), "control_rate_hz is nan"),
        (lambda: dwell.World(HOUSE, parameters={MOON: math.nan}), f"{MOON} is nan"),
        (
            lambda: dwell.World(
                HOUSE, laws=[{"id": "drag", "version": 1, "params": {"c_d": math.inf}}]
            ),
            "c_d is inf",
        ),
        (lambda: DwellEnv(stride={"turn_deg": math.nan}), "turn_deg is nan"),
        (lambda: DwellEnv(threads=-1), "threads is -1"),
        (lambda: DwellEnv(houses=7), "houses is 7"),  # type: ignore[arg-type]
        (lambda: DwellEnv(houses=[]), "at least one"),
        (
            lambda: DwellEnv("Free", sensors={"what": {"kind": "instruction"}}),
            'a sensor\'s name is "what"; allowed is "instruction", the only one of its kind',
        ),
        (
            lambda: DwellEnv(task_settings={"min_distance_m": 5, "max_distance_m": 2}),
            "min_distance_m is 5; allowed is at most max_distance_m, which is 2",
        ),
        (
            lambda: dwell.Receiver.array((0, 0, 0), None),  # type: ignore[arg-type]
            "microphones is None; expected 1 to 128 microphones or points",
        ),
        (
            lambda: dwell.Receiver.array((0, 0, 0), [(0, 0, 0), None]),  # type: ignore[list-item]
            r"microphones\[1\]: expected three numbers",
        ),
        (
            lambda: dwell.Head.measured(nested(5000), [], 44_100),
            "sources: expected real numbers, found a list that cannot be written out",
        ),
        (
            lambda: DwellEnv("PointNav", task_settings={"reward": [0.0, 2.5]}),
            "reward is .0.0,2.5.: found sequence, expected values by name",
        ),
        (lambda: DwellEnv(world={"laws": []}), "laws="),
        (lambda: DwellEnv(world={"parameters": {}}), "parameters="),
        (lambda: DwellVectorEnv(-1), "num_envs is -1"),
    ],
)
def test_settings_that_cannot_be_are_refused(make: Callable[[], object], said: str) -> None:
    with pytest.raises(dwell.ConfigError, match=said.replace("(", r"\(")):
        make()


def test_calls_of_a_world_say_what_they_expect(apartment: dwell.House) -> None:
    world = dwell.World(apartment)
    with pytest.raises(dwell.ConfigError, match="move_forward"):
        world.do("forward")
    with pytest.raises(dwell.ConfigError, match="action is -1"):
        world.do(-1)
    with pytest.raises(dwell.ConfigError, match="agent is -1"):
        world.listen(agent=-1)
    with pytest.raises(dwell.ConfigError, match=r"position\[0\] is nan"):
        world.render(position=(math.nan, 0.0, 0.0))
    with pytest.raises(dwell.ConfigError, match="three numbers"):
        world.place_agent((1.0, 2.0))
    with pytest.raises(dwell.ConfigError, match="nan"):
        world.set_parameter(MOON, math.nan)
    with pytest.raises(dwell.ConfigError, match="seed is -2"):
        apartment.describe("instructions", seed=-2)


def test_points_may_be_arrays(apartment: dwell.House) -> None:
    world = dwell.World(apartment, agents=0)
    place = (2.0, 1.5, 2.0)
    camera = dwell.Camera(8, 8)
    listed = world.render(position=place, camera=camera)["rgb"]
    array = world.render(position=np.array(place, np.float32), camera=camera)["rgb"]
    np.testing.assert_array_equal(listed, array)


def test_what_calibration_found_reaches_worlds_and_environments(
    apartment: dwell.House, tmp_path: Path
) -> None:
    found = {"laws": [], "parameters": {MOON: 1.62}}
    path = tmp_path / "found.json"
    path.write_text(json.dumps(found), "utf-8")
    # What this release writes says its version, what older ones wrote does not.
    for laws in (path, str(path), found, {"version": 1, **found}):
        assert dwell.World(apartment, laws=laws).parameter(MOON)["value"] == pytest.approx(1.62)
    nearer = dwell.World(apartment, laws=path, parameters={MOON: 3.7})
    assert nearer.parameter(MOON)["value"] == pytest.approx(3.7)
    hashes = []
    for laws in (None, path):
        env = DwellEnv(sensors=SMALL, laws=laws)
        env.reset(seed=1)
        hashes.append(env.state_hash())
    assert hashes[0] != hashes[1]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{junk", "no JSON"),
        ("7", "found 7; expected a law's name"),
        ("[" * 100_000, "nested 100000 deep"),
        ('{"lows": []}', "lows"),
        ('{"parameters": [1]}', "by address"),
        ('{"version": 2, "laws": []}', "version is 2; this dwell reads 1"),
        ('{"version": true, "laws": []}', "version is True; this dwell reads 1"),
    ],
)
def test_files_of_laws_that_are_none_are_refused_by_name(
    apartment: dwell.House, tmp_path: Path, text: str, said: str
) -> None:
    path = tmp_path / "found.json"
    path.write_text(text, "utf-8")
    with pytest.raises(dwell.ConfigError, match=said) as caught:
        dwell.World(apartment, laws=path)
    assert str(path) in str(caught.value)
    with pytest.raises(FileNotFoundError, match=r"nothing\.json"):
        dwell.World(apartment, laws=tmp_path / "nothing.json")


@pytest.mark.parametrize(
    "laws",
    [
        "drag",
        ["drag"],
        {"drag": {}},
        {"drag": {"c_d": 0.47}},
        [{"id": "drag"}],
        {"id": "drag", "params": {"c_d": 0.47}},
        {"laws": {"drag": {"c_d": 0.47}}},
        {"laws": "drag"},
        [{"id": "drag", "version": 1, "target": None, "params": {"c_d": 0.47}}],
    ],
    ids=str,
)
def test_laws_are_given_in_short_or_in_full(shoebox: dwell.House, laws: Any) -> None:  # noqa: ANN401
    world = dwell.World(shoebox, laws=laws)
    assert world.parameter("law/drag/c_d")["value"] == pytest.approx(0.47)
    in_full = [{"id": "drag", "version": 1, "params": {"c_d": 0.47}}]
    assert world.state_hash() == dwell.World(shoebox, laws=in_full).state_hash()


@pytest.mark.parametrize(
    ("laws", "said"),
    [
        ("dragg", "laws[0]: no law 'dragg'; did you mean drag? allowed are drag, visc"),
        (
            "wind",
            "laws[0]: wind without numbers does nothing; "
            "give some, as laws={'wind': {'x_m_s': 1.0}}",
        ),
        ("", "laws[0]: no law ''; allowed are drag"),
        ([{"id": "latency", "params": {}}], "laws[0]: latency without numbers does nothing"),
        (["drag", "latency"], "laws[1]: latency without numbers does nothing"),
        ({"latency": {}}, "latency has delay_s (0 to 2 s, plausible 0.002 to 0.15)"),
        ({"drag": {"cd": 1}}, "laws.drag: drag has no parameter 'cd'; did you mean c_d? drag has"),
        ({"drag": {"c_d": 21}}, "laws.drag: drag.c_d is 21; drag has c_d (0 to 20, plausible"),
        ({"drag": {"c_d": "a"}}, "laws.drag.params.c_d is 'a'"),
        ({"drag": 5}, "laws.drag.params is 5"),
        ({"drag": {"c_d": 1}, "laws": []}, "laws: no field 'drag'"),
        ([{"params": {}}], "laws[0]: no field 'id'"),
        ([{"id": "drag", "parms": {}}], "laws[0]: no field 'parms'; did you mean params"),
        ([{"id": "drag", "version": 9}], "version is 9"),
    ],
    ids=str,
)
def test_laws_that_there_are_not_are_answered_with_those_there_are(
    shoebox: dwell.House,
    laws: Any,  # noqa: ANN401
    said: str,
) -> None:
    with pytest.raises(dwell.DwellError) as caught:
        dwell.World(shoebox, laws=laws)
    assert said in str(caught.value)


def nested(depth: int) -> list[Any]:
    whole: list[Any] = []
    for _ in range(depth):
        whole = [whole]
    return whole


DEEP = nested(100_000)
ENDLESS: list[Any] = []
ENDLESS.append(ENDLESS)


@pytest.mark.parametrize("deep", [DEEP, ENDLESS], ids=["deep", "endless"])
@pytest.mark.parametrize(
    "give",
    [
        lambda deep: dwell.World(HOUSE, laws=deep),
        lambda deep: dwell.World(HOUSE, parameters=deep),
        lambda deep: dwell.World(HOUSE, agents=deep),
        lambda deep: dwell.World(HOUSE, seed=deep),
        lambda deep: dwell.World(HOUSE, sound_preset=deep),
        lambda deep: dwell.House.generate(1, rooms=deep),
        lambda deep: DwellEnv(task_settings={"kinds": deep}),
        lambda deep: DwellEnv(sensors={"rgb": {"width": deep}}),
        lambda deep: DwellEnv(sensors=deep),
        lambda deep: DwellEnv(task=deep),
    ],
    ids=range(10),
)
def test_what_is_nested_too_deep_is_refused(give: Callable[[Any], object], deep: Any) -> None:  # noqa: ANN401
    with pytest.raises(dwell.DwellError) as caught:
        give(deep)
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize(
    "make",
    [
        lambda value: dwell.World(HOUSE, control_rate_hz=value),
        lambda value: dwell.World(HOUSE, parameters={MOON: value}),
        lambda value: dwell.House.shoebox((4.0, 3.0, 4.0), absorption=value),
        dwell.Head.spherical,
        lambda value: Settings(duration_s=value),
        lambda value: dwell.Camera(fov_deg=value),
    ],
)
def test_a_number_that_is_a_long_range_is_refused_at_once(
    make: Callable[[object], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(values: object, *_: object) -> None:
        raise AssertionError(f"an array of {values}")

    # Of the range it would have 8 GB.
    monkeypatch.setattr(np, "asarray", made)
    with pytest.raises(dwell.ConfigError, match=r"is range\(0, 1000000000\); expected a number"):
        make(range(10**9))


@pytest.mark.parametrize("value", [np.complex128(1j), np.array(1j), 1j])
def test_complex_numbers_are_no_numbers(value: object) -> None:
    with pytest.raises(dwell.ConfigError, match="expected a number"):
        dwell.World(HOUSE, parameters={MOON: value})  # type: ignore[dict-item]


def test_settings_without_an_end_are_refused_before_they_are_written_out() -> None:
    for settings in (
        {"max_distance_m": itertools.count()},
        {"max_distance_m": [itertools.count()]},
    ):
        with pytest.raises(dwell.ConfigError, match="an iterator without an end in sight; exp"):
            DwellEnv("PointNav", houses="builtin:studio", task_settings=settings)
    # Elements that were looked at are not lost.
    many = 1_000_005
    found = kept(iter(range(many)))
    assert next(found) == 0
    assert sum(1 for _ in found) == many - 1


class OfBytes:
    """A path as bytes, which ``os.PathLike`` allows."""

    def __fspath__(self) -> bytes:
        return b"x"


@pytest.mark.parametrize(
    ("name", "make"),
    [
        (r"houses\[0\]", lambda path: DwellEnv("Free", houses=path)),
        (r"houses\[1\]", lambda path: DwellEnv("Free", houses=[HOUSE, path])),
        ("laws", lambda path: dwell.World(HOUSE, laws=path)),
        ("randomize", lambda path: dwell.World(HOUSE, randomize=path)),
        ("laws", lambda path: dwell.AcousticScene(HOUSE, laws=path)),
        ("episodes", lambda path: DwellEnv("Free", episodes=path)),
        ("path", dwell.sounds.is_whole_wav),
        ("path", dwell.sounds.read_wav),
        ("path", dwell.Head.from_sofa),
        ("path", dwell.Replay.read),
    ],
)
def test_paths_of_bytes_are_told(name: str, make: Callable[[object], object]) -> None:
    with pytest.raises(dwell.ConfigError, match=f"{name} is b'x'; expected text"):
        make(OfBytes())


@pytest.mark.parametrize(
    "value",
    [
        bytearray(b"1"),
        memoryview(b"1"),
        array.array("B", b"1"),
        np.array("1"),
        np.bytes_(b"1"),
        np.complex64(1),
    ],
    ids=lambda value: type(value).__name__,
)
def test_bytes_and_text_of_any_kind_are_no_numbers(value: Any) -> None:  # noqa: ANN401 - odd
    with pytest.raises(dwell.ConfigError, match=r"gain is .*; expected a number"):
        finite_number("gain", value)


@pytest.mark.parametrize(
    "value", [1, 1.0, np.float32(1), np.array(1), np.array([1.0])[0], Fraction(1), Decimal(1)]
)
def test_what_counts_as_one_is_a_number(value: Any) -> None:  # noqa: ANN401 - odd
    assert finite_number("gain", value) == 1.0


@pytest.mark.parametrize("count", [5 * 10**7, 10**18, 10**30])
def test_a_range_that_is_too_long_is_refused_before_it_is_an_array(count: int) -> None:
    long = range(count)
    world = dwell.World("builtin:studio")
    env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"], action_mode="velocity")
    envs = DwellVectorEnv(1, "Free", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=1)
    envs.reset(seed=1)
    for call in (
        lambda: world.step([long]),
        lambda: world.step([[long] * 4]),
        lambda: env.step(long),
        lambda: envs.step([long]),
        lambda: dwell.Head.measured(long, [], 44_100),
    ):
        with pytest.raises(dwell.ConfigError, match="at most 1000000 numbers of a range"):
            call()
    holds_itself: list[Any] = [1.0]
    holds_itself.append(holds_itself)
    with pytest.raises(dwell.ConfigError, match="controls"):
        world.step(holds_itself)


@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        ({"law/drag/c_d": -4}, r'parameter address "law/drag/c_d": -4 is out of range'),
        ({"world/nothing": 1}, "nothing"),
        ({"world/gravity_m_s2": "x"}, "parameters: world/gravity_m_s2 is 'x'; expected a number"),
    ],
)
def test_parameters_of_a_file_are_refused_with_its_name(
    parameters: dict[str, Any], told: str, tmp_path: Path
) -> None:
    file = tmp_path / "found.json"
    laws = [{"id": "drag", "version": 1, "params": {"c_d": 1}}]
    file.write_text(json.dumps({"laws": laws, "parameters": parameters}))
    for make in (dwell.World, dwell.AcousticScene):
        with pytest.raises(dwell.DwellError, match=f"^laws: {file}: .*{told}"):
            make(HOUSE, laws=file)
