"""Processes that are forked from one that has used the engines."""

from __future__ import annotations

import logging
import multiprocessing
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import gymnasium
import interrupted
import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
#: Python warns of forks beside threads; that is what these tests are about.
warned = pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
WALK = (3, 1, 3, 3, 2)


def senses(world: dwell.World) -> list[Any]:
    """Steps, looks, listens, asks the way."""
    world.step()
    heard = world.listen(1600)
    image = world.render(agent=0, camera=dwell.Camera(48, 48))["rgb"]
    scene = dwell.AcousticScene("builtin:studio", rays=200)
    response = scene.impulse_response((1.5, 1.5, 1.5), (2.0, 1.0, 2.0))
    return [world.state_hash(), heard.sum(), int(image.sum()), float(np.abs(response).sum())]


def in_child(work: Callable[[], Any]) -> Any:  # noqa: ANN401 - whatever the work gives
    """The result of ``work`` in a forked child; EOFError, should it end without giving anything."""
    fork = multiprocessing.get_context("fork")
    ours, theirs = fork.Pipe()
    process = fork.Process(target=lambda: theirs.send(work()))
    process.start()
    theirs.close()
    try:
        return ours.recv()
    finally:
        process.kill()
        process.join()


@pytest.mark.long
@warned
def test_a_child_of_a_used_parent_steps_sees_and_hears_the_same() -> None:
    world, twin = dwell.World("builtin:studio"), dwell.World("builtin:studio")
    assert senses(world) == senses(twin)
    there = in_child(lambda: senses(world))
    assert there == senses(world) == senses(twin)
    # A grandchild, and the parent meanwhile.
    assert in_child(lambda: in_child(lambda: senses(twin))) == senses(world)


@pytest.mark.long
@warned
def test_environments_in_forked_workers_play_what_one_here_plays() -> None:
    here = DwellEnv(houses="builtin:studio", sensors=["rgb", "audio"])
    played = [here.reset(seed=4)[0]] + [here.step(np.int64(a))[0] for a in WALK]

    def make() -> gymnasium.Env[Any, Any]:
        return DwellEnv(houses="builtin:studio", sensors=["rgb", "audio"])

    envs = gymnasium.vector.AsyncVectorEnv([make] * 3, context="fork")
    try:
        there = [envs.reset(seed=[4, 4, 5])[0]]
        there += [envs.step(np.full(3, action))[0] for action in WALK]
    finally:
        envs.close()
    for one, many in zip(played, there, strict=True):
        for name, value in one.items():
            assert (many[name][0] == value).all(), name
            assert (many[name][1] == value).all(), name


@pytest.mark.long
@warned
def test_a_fork_beside_a_busy_thread_waits_for_its_call(caplog: pytest.LogCaptureFixture) -> None:
    """Locks that another thread holds at the fork would stay locked in the child for ever."""
    world, done = dwell.World("builtin:studio"), threading.Event()

    def work() -> None:
        own = dwell.World("builtin:studio")
        while not done.is_set():
            own.render(agent=0, camera=dwell.Camera(128, 128))
            own.listen(80)

    expected = dwell.World("builtin:studio").render(agent=0)["rgb"].sum()
    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    try:
        for _ in range(5):
            found = in_child(lambda: dwell.World("builtin:studio").render(agent=0)["rgb"].sum())
            assert found == expected
            assert in_child(lambda: world.render(agent=0)["rgb"].sum()) == expected
    finally:
        done.set()
        for thread in threads:
            thread.join()
    # Where calls that follow each other closely keep a fork waiting, it says so.
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


@pytest.mark.long
def test_a_fork_waits_for_a_while_and_no_longer() -> None:
    # The thread's call takes many minutes; forks before it has begun do not wait.
    program = """
import json, logging, os, threading
import dwell
from dwell import _native
warned = []
handler = logging.Handler()
handler.emit = lambda record: warned.append(record.getMessage())
logging.getLogger("dwell").addHandler(handler)
endless = {"worlds": 1, "repeats": 100, "steps": 10**6}
work = lambda: _native.bench("physics", "builtin:studio", endless)
thread = threading.Thread(target=work, daemon=True)
thread.start()
while thread.is_alive() and not warned:
    child = os.fork()
    if child == 0:
        os._exit(0)
    os.waitpid(child, 0)
print(thread.is_alive(), *warned, flush=True)
os._exit(0)
"""
    ran = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("True fork while engines work in other threads")


@warned
def test_a_forked_child_hears_ctrl_c() -> None:
    world = dwell.World("builtin:studio")
    world.render(agent=0)
    large = dwell.Camera(8192, 8192)
    assert in_child(lambda: interrupted.cut_off(lambda: world.render(agent=0, camera=large))) == (
        "stopped"
    )
