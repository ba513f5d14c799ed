"""Daemon threads that are in a call of the engines when the interpreter ends."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

#: What the thread does for ever.
CALLS = {
    "step": "world.step()",
    "describe": "world.describe('house')",
    "open": "dwell.House.open('builtin:studio')",
    "env": "env.step(1)",
}
#: What it needs for that.
ENV = """
from dwell.envs import DwellEnv

env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
env.reset(seed=1)
"""
SCRIPT = """
import atexit, threading
{first}
import dwell

world = dwell.World("builtin:studio")
begun = threading.Event()
{prepare}
def work():
    while True:
        {call}
        begun.set()

threading.Thread(target=work, daemon=True).start()
begun.wait()
atexit.register(world.state_hash)
"""
#: The last function of atexit. No code of Python's runs between it and the interpreter's end: the
#: thread waits for the GIL all the while.
HOLDS_THE_GIL = "atexit.register(sum, range(5_000_000))"
#: A function of atexit, registered before dwell's own could be, may still wait for its thread.
JOINED = """
import atexit, threading

def ends():
    over.set()
    thread.join()
    print("joined")

atexit.register(ends)
import dwell

world, over = dwell.World("builtin:studio"), threading.Event()

def work():
    while not over.is_set():
        world.step()

thread = threading.Thread(target=work, daemon=True)
thread.start()
"""

#: A daemon thread whose call runs Python's code, which runs for ever.
IN_PYTHON = """
import logging, threading
import dwell

begun = threading.Event()

def never_ends(*_):
    begun.set()
    while True:
        pass

class Handler(logging.Handler):
    handle = never_ends  # not `emit`: its lock is one that the end of Python waits for

logging.getLogger("dwell").addHandler(Handler())
{prepare}
threading.Thread(target=lambda: {call}, daemon=True).start()
begun.wait()
"""
CALLS_OF_PYTHON = {
    "a handler of logs": (
        "logging.getLogger('dwell').setLevel(1)",
        "dwell.House.open('builtin:studio')",
    ),
    "progress": (
        "from dwell import _native",
        "_native.bench('load', 'builtin:studio', {}, never_ends)",
    ),
}

#: The thread asks for the GIL when there is no interpreter any more: glibc sleeps for a second.
WITHOUT_PYTHON = """
import ctypes, sys, threading
from dwell import _native

begun = threading.Event()

def work():
    while True:
        _native.bench("load", "builtin:studio", {}, lambda *_: begun.set())

threading.Thread(target=work, daemon=True).start()
begun.wait()
libc = ctypes.CDLL(None)
libc.on_exit(libc.sleep, None)  # called with the status
sys.exit(1)
"""


def ended(script: str, status: int = 0) -> str:
    """What a process of its own printed that runs the script; it ends well, with this status."""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (status, "")
    return done.stdout


@pytest.mark.long
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize(
    "first",
    [pytest.param("", marks=pytest.mark.slow), HOLDS_THE_GIL],
    ids=["at work", "waiting for the GIL"],
)
def test_a_process_ends_well_while_a_daemon_thread_works(call: str, first: str) -> None:
    for _ in range(2):
        prepare = ENV if call == "env" else ""
        ended(SCRIPT.format(call=CALLS[call], first=first, prepare=prepare))


@pytest.mark.parametrize("what", CALLS_OF_PYTHON)
def test_a_process_ends_well_while_a_daemon_threads_call_runs_python(what: str) -> None:
    prepare, call = CALLS_OF_PYTHON[what]
    ended(IN_PYTHON.format(prepare=prepare, call=call))


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="on_exit is of glibc")
def test_a_process_ends_well_whose_daemon_thread_calls_python_after_its_end() -> None:
    ended(WITHOUT_PYTHON, status=1)


def test_at_exit_a_thread_that_works_can_be_waited_for() -> None:
    assert ended(JOINED) == "joined\n"
