"""Who renders: ``renderer=``, ``DWELL_RENDERER``, and what both back ends agree about."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import _native


def _adapter() -> str:
    adapters = json.loads(_native.doctor_json())["graphics_adapters"]
    if not adapters:
        pytest.skip("no graphics adapter, not even of software")
    return str(adapters[0]["name"])


def test_a_back_end_that_is_not_there_is_refused_with_those_that_are(shoebox: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match='no back end "opengl"; there are cpu, gpu'):
        dwell.World(shoebox, renderer="opengl")
    with pytest.raises(dwell.ConfigError, match='no graphics adapter with "no such card"'):
        dwell.World(shoebox, renderer="gpu:no such card")


@pytest.mark.parametrize("path", ["compute", "raster"])
def test_an_adapter_shows_what_the_processor_shows(
    apartment: dwell.House, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen = f"gpu+{path}:{_adapter()}"
    camera = dwell.Camera(width=64, height=48)
    eye = apartment.rooms()[0]["eye"]

    def shot(world: dwell.World) -> dict[str, NDArray[Any]]:
        return world.render(position=eye, camera=camera, channels=("rgb", "depth", "instance"))

    by_cpu = shot(dwell.World(apartment, agents=0, renderer="cpu"))
    by_gpu = shot(dwell.World(apartment, agents=0, renderer=chosen))
    monkeypatch.setenv("DWELL_RENDERER", chosen)
    by_variable = shot(dwell.World(apartment, agents=0))
    for name, image in by_gpu.items():
        assert np.array_equal(image, by_variable[name])
    # Edges of things may fall to either side.
    same = by_cpu["instance"] == by_gpu["instance"]
    assert same.mean() > 0.99
    assert (np.abs(by_cpu["depth"] - by_gpu["depth"])[same] < 1e-3).mean() > 0.99
    assert np.abs(by_cpu["rgb"].astype(int) - by_gpu["rgb"]).mean() < 0.5
