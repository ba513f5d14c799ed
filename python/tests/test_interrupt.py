"""Ctrl-C in the middle of long calls."""

from __future__ import annotations

import json
import os
import runpy
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import _native
from dwell.envs import DwellVectorEnv

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals are sent by kill")
PROGRAM = Path(__file__).with_name("interrupted.py")
#: For a busy machine, and far below the calls' time; docs/python-border.md has a quiet one's.
MOST_S = 1.5


@pytest.mark.parametrize("name", runpy.run_path(str(PROGRAM))["CALLS"])
def test_ctrl_c_ends_a_long_call(name: str) -> None:
    ran = subprocess.run(
        [sys.executable, str(PROGRAM), "--one", name, "--delay", "0.15"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout) < MOST_S


class Raised(Exception):
    """What a handler raises."""


def soon(seconds: float, meanwhile: Callable[[], object] | None = None) -> None:
    """Sends a signal after a while; does something meanwhile."""

    def send() -> None:
        time.sleep(seconds)
        os.kill(os.getpid(), signal.SIGUSR1)

    threading.Thread(target=send).start()
    if meanwhile is not None:
        meanwhile()


@pytest.fixture
def raising() -> object:
    """SIGUSR1 raises."""

    def handler(*_: object) -> None:
        raise Raised

    before = signal.signal(signal.SIGUSR1, handler)
    yield
    signal.signal(signal.SIGUSR1, before)


@pytest.mark.usefixtures("raising")
def test_a_world_that_was_only_looked_at_goes_on_as_if_nothing_had_been() -> None:
    world, twin = dwell.World("builtin:studio"), dwell.World("builtin:studio")
    start = time.monotonic()
    soon(0.1)
    with pytest.raises(Raised):
        world.render(agent=0, camera=dwell.Camera(width=8192, height=8192))
    assert time.monotonic() - start < 0.1 + MOST_S
    world.step()
    twin.step()
    assert world.state_hash() == twin.state_hash()
    assert (world.render(agent=0)["rgb"] == twin.render(agent=0)["rgb"]).all()


@pytest.mark.usefixtures("raising")
@pytest.mark.parametrize("threads", [1, 2])
def test_a_batch_that_was_stopped_wants_a_reset_and_then_plays_as_ever(threads: int) -> None:
    def new() -> DwellVectorEnv:
        return DwellVectorEnv(40, houses="builtin:studio", sensors=["depth"], threads=threads)

    envs, twin = new(), new()
    forward = np.full(40, 3)
    twin.reset(seed=5)
    expected = twin.step(forward)[0]["depth"].copy()
    soon(0.3)

    def play() -> None:
        for _ in range(1000):
            envs.reset(seed=0)
            envs.step(forward)

    with pytest.raises(Raised):
        play()
    envs.reset(seed=5)
    assert (envs.step(forward)[0]["depth"] == expected).all()
    assert envs.state_hashes() == twin.state_hashes()


@pytest.mark.usefixtures("raising")
@pytest.mark.parametrize("threads", [1, 2])
def test_a_first_reset_that_was_stopped_wants_another_and_then_plays_as_ever(threads: int) -> None:
    def new() -> DwellVectorEnv:
        house = dwell.House.generate(3, home="house")
        return DwellVectorEnv(4, houses=house, sensors=["gps", "audio"], threads=threads)

    forward, refused = np.full(4, 3), 0
    twin = new()
    twin.reset(seed=0)
    twin.step(forward)
    done = twin.state_hashes()
    twin.reset(seed=5)
    expected = twin.step(forward)[0]
    # Grids, goals, planes and sounds are made in the first reset: each time another is cut off.
    for after_s in (0.01, 0.04, 0.1, 0.2):
        envs = new()
        start = time.monotonic()
        with pytest.raises(Raised):
            soon(after_s, lambda: envs.reset(seed=0))  # noqa: B023 - called at once
        assert time.monotonic() - start < after_s + MOST_S
        try:
            envs.step(forward)
        except dwell.UsageError:
            refused += 1
        else:
            # The signal came when all was done.
            assert envs.state_hashes() == done
        envs.reset(seed=5)
        found = envs.step(forward)[0]
        assert all((found[name] == expected[name]).all() for name in ("gps", "audio"))
        assert envs.state_hashes() == twin.state_hashes()
    assert refused > 0


@pytest.mark.usefixtures("raising")
def test_an_environment_whose_restoring_was_stopped_is_restored_the_next_time() -> None:
    def new() -> _native.Batch:
        house = dwell.House.generate(4, home="house")
        return _native.Batch([house.native], '{"sensors": [{"kind": "gps"}]}')

    twin, env = new(), new()
    twin.reset([1])
    saved = twin.snapshot(0)
    with pytest.raises(Raised):
        soon(0.02, lambda: env.restore(0, saved))
    with pytest.raises(dwell.UsageError):
        env.snapshot(0)
    env.restore(0, saved)
    assert env.state_hash(0) == twin.state_hash(0)


@pytest.mark.usefixtures("raising")
@pytest.mark.parametrize("after_s", [0.01, 0.06])
@pytest.mark.parametrize(
    "look",
    [
        lambda world: world.map(1500)[0],
        lambda world: world.navigation(dwell.Walker(cell_m=0.05)).occupancy().free,
        lambda world: world.listen(16_000),
        lambda world: world.render(agent=0, camera=dwell.Camera(width=1500, height=1500))["rgb"],
    ],
    ids=["map", "navigation", "listen", "render"],
)
def test_what_was_stopped_while_it_was_prepared_is_prepared_again(
    look: Callable[[dwell.World], NDArray[Any]], after_s: float
) -> None:
    world, twin = (dwell.World("builtin:apartment") for _ in range(2))

    def look_on() -> None:
        while True:
            look(world)

    with pytest.raises(Raised):
        soon(after_s, look_on)
    assert (look(world) == look(twin)).all()
    assert world.state_hash() == twin.state_hash()


def test_a_handler_that_does_not_raise_leaves_the_call_alone() -> None:
    seen: list[int] = []
    before = signal.signal(signal.SIGUSR1, lambda number, _: seen.append(number))
    try:
        world = dwell.World("builtin:studio")
        start = time.monotonic()
        soon(0.05)
        image = world.render(agent=0, camera=dwell.Camera(width=4096, height=4096))["rgb"]
        assert time.monotonic() - start > 0.05
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert seen == [signal.SIGUSR1]
    assert image.any(axis=(1, 2)).all()


def test_a_handler_that_calls_dwell_in_the_middle_of_a_call_is_refused_and_does_not_hang() -> None:
    world, said = dwell.World("builtin:studio"), []

    def handler(*_: object) -> None:
        for call in (world.step, lambda: dwell.House.open("builtin:studio")):
            try:
                call()
            except dwell.UsageError as error:
                said.append(str(error))

    before = signal.signal(signal.SIGUSR1, handler)
    try:
        soon(0.05)
        world.render(agent=0, camera=dwell.Camera(width=4096, height=4096))
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert len(said) == 2
    assert all("let it set a flag" in sentence for sentence in said)
    world.step()


def test_other_threads_go_on_when_the_main_one_is_interrupted() -> None:
    program = """
import threading, dwell, os, signal, time
images = []
def draw():
    world = dwell.World("builtin:studio")
    images.append(world.render(agent=0, camera=dwell.Camera(width=2048, height=2048))["rgb"])
thread = threading.Thread(target=draw)
world = dwell.World("builtin:studio")
thread.start()
threading.Thread(target=lambda: (time.sleep(0.1), os.kill(os.getpid(), signal.SIGINT))).start()
try:
    world.render(agent=0, camera=dwell.Camera(width=8192, height=8192))
except KeyboardInterrupt:
    thread.join()
    print(images[0].shape)
"""
    ran = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=300, check=False
    )
    assert ran.stdout.strip() == "(2048, 2048, 3)", ran.stderr
