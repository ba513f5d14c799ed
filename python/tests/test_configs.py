"""Settings that type checkers know are those that the engine knows."""

from __future__ import annotations

import pytest

import dwell
from dwell import _native
from dwell.configs import (
    AcousticSettings,
    AirSettings,
    GeneratorSettings,
    WorldSettings,
)

#: What World has as arguments of their own.
_OWN = {"agents", "laws", "parameters"}


def _allowed(message: str) -> set[str]:
    """The names that the engine's error lists."""
    return set(message.split("expected one of ")[1].replace("`", "").split(" at ")[0].split(", "))


def test_the_names_are_those_of_the_engine() -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError) as world:
        _native.World(room.native, '{"nope": 1}', 0)
    assert _allowed(str(world.value)) - _OWN == set(WorldSettings.__annotations__)
    scene = dwell.AcousticScene(room)
    assert set(scene.config) == set(AcousticSettings.__annotations__)
    assert set(scene.config["air"]) == set(AirSettings.__annotations__)
    with pytest.raises(dwell.HouseError) as spec:
        dwell.House.open('seed:1?nope="x"')
    assert _allowed(str(spec.value).split("; ")[0]) == set(GeneratorSettings.__annotations__)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"rays": "many"}, "rays is 'many'; allowed are whole numbers from 0"),
        ({"rays": 3.5}, "rays is 3.5; allowed are whole numbers from 0"),
        ({"max_duration_s": {}}, "max_duration_s is {}; expected a number"),
        ({"diffraction": 1}, "diffraction is 1; allowed are True and False"),
        ({"air": {"temperature_c": "warm"}}, "air.temperature_c is 'warm'; expected a number"),
        ({"air": 20}, "air is 20; expected values by name"),
    ],
)
def test_wrong_types_are_refused_by_name(settings: dict[str, object], sentence: str) -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError) as error:
        dwell.AcousticScene(room, **settings)  # type: ignore[arg-type] # what is tested
    assert str(error.value).startswith(sentence)


def test_the_same_holds_for_worlds() -> None:
    room = dwell.House.shoebox((4.0, 2.5, 3.0))
    with pytest.raises(dwell.ConfigError, match=r"sound_rate_hz is 16000.0; allowed are whole"):
        dwell.World(room, sound_rate_hz=16000.0)  # type: ignore[arg-type] # what is tested
    with pytest.raises(dwell.ConfigError, match=r"sound_preset is 3; allowed are 'rl', 'full'"):
        dwell.World(room, sound_preset=3)  # type: ignore[arg-type] # what is tested
