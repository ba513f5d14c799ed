"""Back ends: ``renderer=``, ``DWELL_RENDERER``, and the agreement of both."""

from __future__ import annotations

import multiprocessing
import os
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import _native
from dwell.envs import DwellVectorEnv


def _first() -> dict[str, Any]:
    adapters = _native.doctor()["graphics_adapters"]
    if not adapters:
        pytest.skip("no graphics adapter, not even of software")
    first: dict[str, Any] = adapters[0]
    return first


def _adapter() -> str:
    return str(_first()["name"])


def test_a_back_end_that_is_not_there_is_refused_with_those_that_are(shoebox: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match='no back end "opengl"; there are cpu, gpu'):
        dwell.World(shoebox, renderer="opengl")
    with pytest.raises(dwell.ConfigError, match='no graphics adapter with "no such card"'):
        dwell.World(shoebox, renderer="gpu:no such card")


@pytest.mark.long
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


@pytest.mark.long
@pytest.mark.parametrize("autoreset_mode", ["NextStep", "SameStep"])
def test_pictures_that_overlap_with_steps_are_the_same(
    apartment: dwell.House, autoreset_mode: str
) -> None:
    settings = {"width": 16, "height": 12, "preset": "flat"}

    def play(*, overlap: bool) -> list[NDArray[Any]]:
        envs = DwellVectorEnv(
            4,
            "InstructionFollowing",
            houses=apartment,
            sensors={"rgb": settings, "depth": settings},
            world={"renderer": f"gpu+compute:{_adapter()}"},
            threads=2,
            max_episode_steps=3,
            autoreset_mode=autoreset_mode,
            overlap=overlap,
        )
        seen = [value.copy() for value in envs.reset(seed=5)[0].values()]
        for step in range(7):
            actions = np.array([1 + (step + k) % 3 for k in range(4)])
            seen += [value.copy() for value in envs.step(actions)[0].values()]
        envs.close()
        return seen

    plain = play(overlap=False)
    overlapped = play(overlap=True)
    assert all(np.array_equal(a, b) for a, b in zip(plain, overlapped, strict=True))
    assert not np.array_equal(plain[0], plain[2])


def test_whether_pictures_overlap_is_a_bool(apartment: dwell.House) -> None:
    with pytest.raises(dwell.ConfigError, match="overlap is 1"):
        DwellVectorEnv(1, houses=apartment, overlap=1)  # type: ignore[arg-type] # the point


def _in_a_child(pipe: Connection, world: dwell.World, chosen: str) -> None:
    """Sends the errors of a forked process that uses its parent's world, and one of its own."""
    try:
        world.render(position=(1.0, 1.0, 1.0), channels=("depth",))
        pipe.send("it rendered")
    except dwell.DwellError as error:
        pipe.send(str(error))
    try:
        own = dwell.World("builtin:apartment", agents=0, renderer=chosen)
        own.render(position=(1.0, 1.0, 1.0), channels=("depth",))
        pipe.send("it rendered")
    except dwell.DwellError as error:
        pipe.send(str(error))
    pipe.close()
    # Without the drivers' goodbyes, which are the parent's.
    os._exit(0)


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_what_another_process_opened_is_refused_after_a_fork(apartment: dwell.House) -> None:
    chosen, interface = f"gpu+compute:{_adapter()}", _first()["interface"]
    world = dwell.World(apartment, agents=0, renderer=chosen)
    before = world.render(position=(1.0, 1.0, 1.0), channels=("depth",))
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    child = context.Process(target=_in_a_child, args=(theirs, world, chosen))
    child.start()
    theirs.close()
    try:
        # EOFError, should the child end without a word.
        sentence, own = ours.recv(), ours.recv()
    finally:
        child.kill()
        child.join()
    assert "process" in sentence
    assert "fork" in sentence
    if interface == "gl":
        # The display of a process has its threads: who draws in a child would wait for ever.
        assert "in the forked process" not in sentence
        assert "GL, which may have an adapter" in own
        assert 'start workers with "spawn"' in own
    else:
        # As the sentence says, worlds that the child makes itself are its own.
        assert own == "it rendered"
    # The parent goes on.
    after = world.render(position=(1.0, 1.0, 1.0), channels=("depth",))
    assert np.array_equal(before["depth"], after["depth"])
