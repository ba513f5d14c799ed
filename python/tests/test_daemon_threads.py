"""Daemon threads that are in a call of the engines when the interpreter ends."""

from __future__ import annotations

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
SCRIPT = """
import atexit, threading
import dwell
from dwell.envs import DwellEnv

world = dwell.World("builtin:studio")
env = DwellEnv("Free", houses="builtin:studio", sensors=["gps"])
env.reset(seed=1)
begun = threading.Event()

def work():
    while True:
        {call}
        begun.set()

threading.Thread(target=work, daemon=True).start()
begun.wait()
atexit.register(world.state_hash)
"""
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


def ended(script: str) -> str:
    """What a process of its own printed that runs the script; it ends well."""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize("call", CALLS)
def test_a_process_ends_well_while_a_daemon_thread_works(call: str) -> None:
    for _ in range(3):
        ended(SCRIPT.format(call=CALLS[call]))


def test_at_exit_a_thread_that_works_can_be_waited_for() -> None:
    assert ended(JOINED) == "joined\n"
