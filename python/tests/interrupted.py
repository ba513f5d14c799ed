"""Signals in the middle of long calls: what ``test_interrupt.py`` uses, and figures.

As a program it sends Ctrl-C into each of the calls and prints the median and the longest time from
the signal to ``KeyboardInterrupt``, ms:

    .venv/bin/python python/tests/interrupted.py --rounds 20
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import logging
import os
import signal
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Literal

import numpy as np

import dwell
import dwell.listening
from dwell import _native
from dwell.envs import DwellVectorEnv

#: A call that takes long, after what it needs was made.
Call = Callable[[], object]
#: Calls after which one that is never stopped is given up.
MOST_CALLS = 20
#: What the engines log of a call that was stopped before it had done its work.
STOPPED = "a call was stopped before its work was done"


def in_the_middle() -> bool:
    """Returns whether a handler of signals runs in the middle of a call of the engines."""
    try:
        _native.seed_range("builtin:studio")
    except dwell.UsageError:
        return True
    return False


@contextlib.contextmanager
def signals(number: int, handler: Callable[..., object]) -> Iterator[None]:
    """Sends this process signals, one after the other, as long as the block lasts.

    The handler is set here: a process started in the background of a script ignores Ctrl-C.
    """
    before, done = signal.signal(number, handler), threading.Event()

    def send() -> None:
        while not done.wait(0.001):
            os.kill(os.getpid(), number)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        yield
    finally:
        done.set()
        sender.join()
        signal.signal(number, before)


def cut_off(
    work: Callable[[], object],
    at: int = 1,
    number: int = signal.SIGINT,
    error: type[BaseException] = KeyboardInterrupt,
) -> Literal["stopped", "ended", "done"]:
    """Does some work, and raises in the middle of a call of the engines.

    Nothing here depends on how quick the machine is: signals come all the while, and the handler
    raises the ``at``-th time that it runs in the middle of a call.

    Returns:
        ``stopped``: the exception came out of a call that had not done its work; ``ended``: of one
        that had; ``done``: the work was done before.
    """
    told: list[str] = []
    asked, is_looking = 0, False

    def handler(*_: object) -> None:
        nonlocal asked, is_looking
        if is_looking:
            # In the middle of the very call that finds out, which a busy machine may stretch.
            return
        is_looking = True
        is_inside = in_the_middle()
        is_looking = False
        if is_inside:
            asked += 1
            if asked >= at:
                raise error

    log, note = logging.getLogger("dwell"), logging.Handler()
    note.emit = lambda record: told.append(record.getMessage())  # type: ignore[method-assign]
    level = log.level
    log.setLevel(logging.DEBUG)
    log.addHandler(note)
    try:
        with signals(number, handler):
            work()
    except error:
        return "stopped" if STOPPED in told else "ended"
    finally:
        log.removeHandler(note)
        log.setLevel(level)
    return "done"


def again_and_again(call: Call) -> None:
    """Calls until something raises, and not for ever."""
    for _ in range(MOST_CALLS):
        call()


def generate() -> Call:
    """Generating houses, large ones."""
    seeds = itertools.count()
    return lambda: dwell.House.generate(next(seeds), home="house", storeys=2)


def open_file(folder: Path) -> Call:
    """Opening a house from a file."""
    path = folder / "house.dwell"
    dwell.House.generate(7).write(str(path), "dwell")
    return lambda: dwell.House.open(str(path))


def make_world() -> Call:
    """A world with all that engines derive from a house that nobody has used."""
    houses = iter([dwell.House.generate(seed) for seed in range(4)])
    return lambda: dwell.World(next(houses)).render(agent=0)


def _mujoco(folder: Path, bodies: Iterator[str]) -> dwell.House:
    path = folder / "pile.xml"
    ground = '<geom type="plane" size="9 9 1"/>'
    path.write_text(f"<mujoco><worldbody>{ground}{''.join(bodies)}</worldbody></mujoco>")
    return dwell.House.open(str(path))


def boxes_in_a_pile(folder: Path, edge: int) -> dwell.House:
    """A house of ``edge`` boxes along each edge of a cube, each a little in its neighbours."""
    places = enumerate(itertools.product(range(edge), repeat=3))
    bodies = (
        f'<body name="thing_{k}" pos="{0.195 * x} {0.195 * y} {0.1 + 0.195 * z}"><freejoint/>'
        '<geom type="box" size="0.1 0.1 0.1"/></body>'
        for k, (x, y, z) in places
    )
    return _mujoco(folder, bodies)


def make_pile(folder: Path) -> Call:
    """A world of 4,096 things, each a little in its neighbours."""
    house = boxes_in_a_pile(folder, 16)
    return lambda: dwell.World(house)


def snapshot(folder: Path) -> Call:
    """Packing a world of 2,197 boxes that fall on each other."""
    places = enumerate(itertools.product(range(13), repeat=3))
    bodies = (
        f'<body name="thing_{k}" pos="{0.21 * x} {0.21 * y} {0.11 + 0.21 * z}"><freejoint/>'
        '<geom type="box" size="0.1 0.1 0.1"/></body>'
        for k, (x, y, z) in places
    )
    world = dwell.World(_mujoco(folder, bodies))
    for _ in range(5):
        world.step()
    return lambda: world.snapshot()


def responses() -> Call:
    """Impulse responses at many places."""
    scene = dwell.AcousticScene("builtin:apartment", rays=200_000)
    ears = [dwell.listening.Receiver.omni((2.0 + 0.1 * k, 1.2, 2.0)) for k in range(4)]
    return lambda: scene.impulse_responses(dwell.Source((3.0, 1.5, 3.0)), ears)


def long_response() -> Call:
    """A long response, nearly all of which is noise: few rays, many arrivals, a high rate."""
    air = {"rate_hz": 192_000, "max_duration_s": 20.0, "arrivals_per_s": 100_000.0}
    house = dwell.House.shoebox((30.0, 10.0, 30.0), absorption=0.02)
    scene = dwell.AcousticScene(house, rays=200, **air)
    return lambda: scene.impulse_response((3.0, 1.5, 3.0), (7.0, 1.5, 3.0))


def render() -> Call:
    """A picture of 16 million pixels."""
    world = dwell.World("builtin:apartment")
    return lambda: world.render(agent=0, camera=dwell.Camera(width=4096, height=4096))


def draw_map() -> Call:
    """A map of many pixels."""
    world = dwell.World("builtin:apartment")
    return lambda: world.map(4096)


def navigation() -> Call:
    """A grid of places with cells of 2 cm."""
    world = dwell.World("builtin:apartment")
    return lambda: world.navigation(dwell.Walker(cell_m=0.02))


def calibrate(folder: Path) -> Call:
    """A calibration without anybody who watches its progress."""
    _native.calibration_example(str(folder), 0)
    return lambda: _native.calibrate(str(folder))


def bench() -> Call:
    """A bench in the engines."""
    options = {"worlds": 8, "repeats": 1000, "steps": 100_000}
    return lambda: _native.bench("physics", "builtin:studio", options)


def step_batch() -> Call:
    """Steps of many environments in one call."""
    envs = DwellVectorEnv(8, sensors={"rgb": {"width": 512, "height": 512}})
    envs.reset(seed=0)
    return lambda: envs.step(np.full(8, 3))


def reset_batch() -> Call:
    """New episodes of many environments in one call."""
    envs = DwellVectorEnv(16)
    return lambda: envs.reset(seed=0)


def listen() -> Call:
    """Ten seconds of sound."""
    world = dwell.World("builtin:apartment")
    return lambda: world.listen(10 * 16_000)


def write(folder: Path) -> Call:
    """Writing a house."""
    house = dwell.House.generate(7)
    return lambda: house.write(str(folder / "out.glb"), "glb")


def heap(count: int) -> dwell.House:
    """A house with so many desks at one place."""
    edits = dwell.House.open("builtin:studio").edit()
    for k in range(count):
        edits.add("desk", seed=k % 4, at=(2.0, 0.0, 2.0))
    return edits.done()


def describe() -> Call:
    """A description of a heap."""
    house = heap(300)
    return lambda: house.describe("graph")


def edit() -> Call:
    """A thousand desks at one place."""
    return lambda: heap(1000)


CALLS: dict[str, Callable[..., Call]] = {
    "generate": generate,
    "open": open_file,
    "world": make_world,
    "pile": make_pile,
    "snapshot": snapshot,
    "responses": responses,
    "long response": long_response,
    "render": render,
    "map": draw_map,
    "navigation": navigation,
    "calibrate": calibrate,
    "bench": bench,
    "batch step": step_batch,
    "batch reset": reset_batch,
    "describe": describe,
    "edit": edit,
    "listen": listen,
    "write": write,
}


def prepare(name: str, folder: Path) -> Call:
    """A call whose files, if any, lie in a folder."""
    make = CALLS[name]
    return make(folder) if make.__code__.co_argcount else make()  # type: ignore[no-any-return]


def latency_s(name: str, delay_s: float, folder: Path) -> float:
    """From the signal to the exception, s."""
    call, sent = prepare(name, folder), list[float]()

    def send() -> None:
        time.sleep(delay_s)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        again_and_again(call)
    except KeyboardInterrupt:
        return time.monotonic() - sent[0]
    except StopIteration:
        pass
    finally:
        sender.join()
    raise AssertionError(f"{name} had the signal and did not stop")


def main() -> None:
    """Prints figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("names", nargs="*", default=[])
    args = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with tempfile.TemporaryDirectory() as folder:
        draw = np.random.default_rng(0)
        for name in args.names or CALLS:
            found: list[float] = []
            for _ in range(args.rounds):
                own = Path(tempfile.mkdtemp(dir=folder))
                found.append(1e3 * latency_s(name, float(draw.uniform(0.02, 0.4)), own))
            print(f"{name}: median {statistics.median(found):.0f}, longest {max(found):.0f} ms")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
