"""Ctrl-C in the middle of long calls."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import interrupted
import numpy as np
import pytest
from numpy.typing import NDArray

import dwell
from dwell import _native
from dwell.envs import DwellVectorEnv

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals are sent by kill")
#: Times that a call is tried before it counts as one that does not stop.
TRIES = 5


@pytest.mark.long
@pytest.mark.parametrize("name", interrupted.CALLS)
def test_ctrl_c_ends_a_long_call(name: str, tmp_path: Path) -> None:
    found = []
    for k in range(TRIES):
        (tmp_path / str(k)).mkdir()
        call = interrupted.prepare(name, tmp_path / str(k))
        try:
            found.append(interrupted.cut_off(lambda: interrupted.again_and_again(call)))  # noqa: B023
        except StopIteration:
            found.append("done")
        if found[-1] == "stopped":
            return
        if found[-1] == "done":
            pytest.skip(
                "no handler runs in the middle of it: it takes less than 25 ms, or is whole"
            )
    raise AssertionError(f"{name} is never stopped in the middle: {found}")


class Raised(BaseException):
    """A handler's exception: no Exception, as Ctrl-C, which may come in the middle of a log."""


def cut_off(work: Callable[[], object], at: int = 1) -> Literal["stopped", "ended", "done"]:
    """``interrupted.cut_off`` by another signal and an exception of ours."""
    return interrupted.cut_off(work, at, signal.SIGUSR1, Raised)


def test_a_world_that_was_only_looked_at_goes_on_as_if_nothing_had_been() -> None:
    world, twin = dwell.World("builtin:studio"), dwell.World("builtin:studio")
    large = dwell.Camera(width=8192, height=8192)
    assert cut_off(lambda: world.render(agent=0, camera=large)) == "stopped"
    world.step()
    twin.step()
    assert world.state_hash() == twin.state_hash()
    assert (world.render(agent=0)["rgb"] == twin.render(agent=0)["rgb"]).all()


@pytest.mark.long
@pytest.mark.parametrize("threads", [1, 2])
def test_a_batch_that_was_stopped_wants_a_reset_and_then_plays_as_ever(threads: int) -> None:
    def new() -> DwellVectorEnv:
        return DwellVectorEnv(16, houses="builtin:studio", sensors=["depth"], threads=threads)

    envs, twin = new(), new()
    forward = np.full(16, 3)
    twin.reset(seed=5)
    expected = twin.step(forward)[0]["depth"].copy()

    def play() -> None:
        envs.reset(seed=0)
        envs.step(forward)

    assert cut_off(lambda: interrupted.again_and_again(play), at=3) != "done"
    envs.reset(seed=5)
    assert (envs.step(forward)[0]["depth"] == expected).all()
    assert envs.state_hashes() == twin.state_hashes()


@pytest.mark.long
@pytest.mark.parametrize("threads", [1, 2])
def test_a_first_reset_that_was_stopped_wants_another_and_then_plays_as_ever(threads: int) -> None:
    def new() -> DwellVectorEnv:
        house = dwell.House.generate(3, home="studio")
        return DwellVectorEnv(2, houses=house, sensors=["gps", "audio"], threads=threads)

    forward, refused = np.full(2, 3), 0
    twin = new()
    twin.reset(seed=0)
    twin.step(forward)
    done = twin.state_hashes()
    twin.reset(seed=5)
    expected = twin.step(forward)[0]
    # Grids, goals, planes and sounds are made in the first reset: each time another is cut off.
    for at in (1, 2, 4, 8):
        envs = new()
        outcome = cut_off(lambda: envs.reset(seed=0), at)  # noqa: B023 - called at once
        try:
            envs.step(forward)
        except dwell.UsageError:
            refused += 1
        else:
            # All was done when, or before, the handler raised.
            assert outcome != "stopped"
            assert envs.state_hashes() == done
        envs.reset(seed=5)
        found = envs.step(forward)[0]
        assert all((found[name] == expected[name]).all() for name in ("gps", "audio"))
        assert envs.state_hashes() == twin.state_hashes()
    assert refused > 0


@pytest.mark.long
def test_an_environment_whose_restoring_was_stopped_is_restored_the_next_time() -> None:
    def new() -> _native.Batch:
        house = dwell.House.generate(4, home="house")
        return _native.Batch([house.native], '{"sensors": [{"kind": "gps"}]}')

    twin, env = new(), new()
    twin.reset([1])
    saved = twin.snapshot(0)
    assert cut_off(lambda: interrupted.again_and_again(lambda: env.restore(0, saved))) != "done"
    with pytest.raises(dwell.UsageError):
        env.snapshot(0)
    env.restore(0, saved)
    assert env.state_hash(0) == twin.state_hash(0)


@pytest.mark.long
@pytest.mark.parametrize("at", [1, 3])
@pytest.mark.parametrize(
    "look",
    [
        lambda world: world.map(800)[0],
        lambda world: world.navigation(dwell.Walker(cell_m=0.05)).occupancy().free,
        lambda world: world.listen(16_000),
        lambda world: world.render(agent=0, camera=dwell.Camera(width=600, height=600))["rgb"],
    ],
    ids=["map", "navigation", "listen", "render"],
)
def test_what_was_stopped_while_it_was_prepared_is_prepared_again(
    look: Callable[[dwell.World], NDArray[Any]], at: int
) -> None:
    world, twin = (dwell.World("builtin:apartment") for _ in range(2))
    assert cut_off(lambda: interrupted.again_and_again(lambda: look(world)), at) != "done"
    assert (look(world) == look(twin)).all()
    assert world.state_hash() == twin.state_hash()


@pytest.mark.long
def test_a_long_step_that_was_stopped_leaves_the_world_as_it_was(tmp_path: Path) -> None:
    house = interrupted.boxes_in_a_pile(tmp_path, 8)
    world, twin = (dwell.World(house, settle_s=0.0) for _ in range(2))
    assert cut_off(lambda: interrupted.again_and_again(world.step)) == "stopped"
    while twin.time_s < world.time_s:
        twin.step()
    assert world.snapshot() == twin.snapshot()
    assert world.events() == twin.events()
    world.step()
    twin.step()
    assert world.time_s == twin.time_s
    assert world.snapshot() == twin.snapshot()


def test_a_handler_that_does_not_raise_leaves_the_call_alone() -> None:
    seen: list[bool] = []
    world = dwell.World("builtin:studio")
    camera = dwell.Camera(width=1024, height=1024)
    expected = world.render(agent=0, camera=camera)["rgb"]
    with interrupted.signals(signal.SIGUSR1, lambda *_: seen.append(interrupted.in_the_middle())):
        while not any(seen):
            image = world.render(agent=0, camera=camera)["rgb"]
    assert (image == expected).all()


def test_a_handler_that_calls_dwell_in_the_middle_of_a_call_is_refused_and_does_not_hang() -> None:
    world, said = dwell.World("builtin:studio"), list[str]()

    def handler(*_: object) -> None:
        if said or not interrupted.in_the_middle():
            return
        for call in (world.step, lambda: dwell.House.open("builtin:studio")):
            try:
                call()
            except dwell.UsageError as error:
                said.append(str(error))

    with interrupted.signals(signal.SIGUSR1, handler):
        while not said:
            world.render(agent=0, camera=dwell.Camera(width=1024, height=1024))
    assert len(said) == 2
    assert all("let it set a flag" in sentence for sentence in said)
    world.step()


def test_other_threads_go_on_when_the_main_one_is_interrupted() -> None:
    images, done = list[NDArray[Any]](), threading.Event()

    def draw() -> None:
        world = dwell.World("builtin:studio")
        while not (images and done.is_set()):
            images.append(world.render(agent=0, camera=dwell.Camera(256, 256))["rgb"])

    world = dwell.World("builtin:studio")
    thread = threading.Thread(target=draw)
    thread.start()
    try:
        large = dwell.Camera(width=8192, height=8192)
        assert cut_off(lambda: world.render(agent=0, camera=large)) == "stopped"
    finally:
        done.set()
        thread.join()
    # What a thread raises besides is an error of pytest.
    assert all((image == images[0]).all() for image in images)


def test_calls_of_a_thread_are_stopped_by_its_token() -> None:
    stop, begun, ended = _native.StopToken(), threading.Event(), []
    # Of so many rays the response takes minutes.
    scene = dwell.AcousticScene(dwell.House.shoebox((6.0, 3.0, 5.0)), rays=10_000_000)

    def work() -> None:
        stop.watch_this_thread()
        begun.set()
        try:
            scene.impulse_response((1.0, 1.5, 1.0), (4.0, 1.5, 3.0))
        except KeyboardInterrupt:
            ended.append("stopped")

    thread = threading.Thread(target=work)
    thread.start()
    begun.wait()
    stop.stop()
    thread.join(60.0)
    assert ended == ["stopped"]


@pytest.mark.parametrize("asked", ["threading.main_thread", "logging.getLogger"])
def test_ctrl_c_while_the_first_call_asks_python_is_raised(asked: str) -> None:
    script = f"""
import logging, threading
from dwell import _native

module, name = {asked.split(".")[0]}, "{asked.split(".")[1]}"
real = getattr(module, name)

def interrupted(*arguments):
    setattr(module, name, real)
    raise KeyboardInterrupt

setattr(module, name, interrupted)
try:
    _native.House.open("builtin:studio")
except KeyboardInterrupt:
    print("raised")
print(_native.House.open("builtin:studio").name)
"""
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert ran.stdout.split() == ["raised", "studio"]
