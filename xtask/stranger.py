"""Measures and checks an installed dwell as a stranger meets it; needs nothing of the repository.

Run by the interpreter of the environment that holds dwell, in an empty folder, without a network.
Prints a line a check, writes ``stranger.json``, and exits with 1 if one of them failed.
"""

from __future__ import annotations

import errno
import importlib.metadata
import json
import re
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

#: Seconds of wall clock, from the start of the process; medians of so many runs.
IMPORT_S, OBSERVATION_S, RUNS = 0.5, 2.0, 5
#: What CI gives one command before it is taken to hang.
PATIENCE_S = 600

CHECK_ENV = """
import warnings
warnings.simplefilter("error")
import gymnasium
import dwell
from gymnasium.utils.env_checker import check_env
env = gymnasium.make("dwell/InstructionFollowing-v0", disable_env_checker=True).unwrapped
check_env(env)
env.close()
"""

OBSERVATION = """
import gymnasium
import dwell
env = gymnasium.make("dwell/InstructionFollowing-v0")
observation, _ = env.reset(seed=7)
assert observation["rgb"].shape == (128, 128, 3) and observation["rgb"].std() > 1
assert observation["depth"].shape[:2] == (128, 128) and (observation["depth"] > 0).any()
assert observation["semantic"].shape[:2] == (128, 128) and observation["semantic"].max() > 0
assert observation["audio"].shape == (2, 800)
print("seen", flush=True)
"""

#: This wheel has another linker than the tests' extension: what unwinds must stop at the border.
UNWINDS = """
import os, signal, threading, time
import dwell
from dwell import _native
assert not hasattr(_native, "panic_for_tests"), "the wheel has what tests alone may have"
world = dwell.World("builtin:studio")
# Ignored where this was started in the background of a script.
signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Thread(target=lambda: (time.sleep(0.2), os.kill(os.getpid(), signal.SIGINT))).start()
try:
    while True:
        world.render(agent=0, camera=dwell.Camera(4096, 4096))
except KeyboardInterrupt:
    world.step()
print("stopped", flush=True)
"""

#: Python ends daemon threads by unwinding, too: those that wait for the GIL when it ends. The last
#: function of atexit holds it.
DAEMONS = """
import atexit, threading
atexit.register(sum, range(5_000_000))
import dwell
world, begun = dwell.World("builtin:studio"), threading.Event()
def work():
    while True:
        world.step()
        begun.set()
threading.Thread(target=work, daemon=True).start()
begun.wait()
print("begun", flush=True)
"""


class Failed(Exception):
    """A check that failed, with what was found."""


def timed(code: str) -> float:
    """Seconds from the start of a new interpreter until it prints a line or ends."""
    started = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-I", "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as child:
        assert child.stdout is not None
        child.stdout.readline()
        took = time.perf_counter() - started
        _, errors = child.communicate(timeout=PATIENCE_S)
    if child.returncode != 0:
        raise Failed(errors.strip() or f"exit status {child.returncode}")
    return took


def command(*words: str) -> str:
    """Standard output of the installed ``dwell``."""
    told = subprocess.run(
        [str(Path(sys.executable).with_name("dwell")), *words],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    if told.returncode != 0:
        raise Failed(f"exit status {told.returncode}: {told.stderr.strip()}")
    return told.stdout


def median_below(code: str, limit_s: float) -> str:
    """The median of some runs, which must stay below a limit."""
    runs = [timed(code) for _ in range(RUNS)]
    median = statistics.median(runs)
    told = f"{median:.2f} s (runs {', '.join(f'{run:.2f}' for run in runs)}; limit {limit_s} s)"
    if median >= limit_s:
        raise Failed(told)
    return told


def alone() -> str:
    """No packet leaves: an address of the documentation range cannot even be tried."""
    try:
        socket.create_connection(("192.0.2.1", 9), timeout=2).close()
    except OSError as error:
        if error.errno == errno.ENETUNREACH:
            return "the network is unreachable"
        raise Failed(f"a network answered: {error}") from error
    raise Failed("a network answered")


def installed() -> str:
    """Everything is imported from the environment, and the licences are in it."""
    distribution = importlib.metadata.distribution("dwell")
    files = [str(file) for file in distribution.files or []]
    for name in ("LICENSE-MIT", "LICENSE-APACHE", "crates.txt", "rust-standard-library.html"):
        if not any(re.search(rf"dist-info/licenses/(.*/)?{name}$", file) for file in files):
            raise Failed(f"{name} is not among the licence files")
    others = sorted(
        f"{other.metadata['Name']} {other.version}" for other in importlib.metadata.distributions()
    )
    return ", ".join(others)


def clean_env() -> str:
    """Gymnasium's checker has nothing to say, warnings included."""
    timed(CHECK_ENV)
    return "nothing to say"


def unwinds() -> str:
    """Ctrl-C ends a picture, and its world goes on."""
    timed(UNWINDS)
    return "Ctrl-C stops at the border"


def daemons() -> str:
    """A program ends well in the middle of its daemon threads' calls."""
    for _ in range(RUNS):
        timed(DAEMONS)
    return f"{RUNS} programs ended well"


def doctor() -> str:
    """The doctor speaks of this machine and this version."""
    facts = json.loads(command("doctor", "--json"))
    version = importlib.metadata.version("dwell")
    if facts["version"] != version:
        raise Failed(f"says {facts['version']}, installed is {version}")
    text = command("doctor")
    for word in (f"dwell {version}", f"{facts['threads']} threads", "apartment", "rerun"):
        if word not in text:
            raise Failed(f"says nothing of {word!r}: {text}")
    return text.splitlines()[0]


def demo() -> str:
    """The demo writes a page, and all that the page shows."""
    started = time.perf_counter()
    command("demo", "--out", "demo")
    took = time.perf_counter() - started
    page = Path("demo/index.html").read_text("utf-8")
    named = {name for name in re.findall(r'(?:src|href)="([^"#:]+)"', page) if name}
    missing = sorted(name for name in named if not (Path("demo") / name).is_file())
    if missing or not named:
        raise Failed(f"the page names {len(named)} files, of which are missing {missing}")
    return f"{took:.0f} s, {len(named)} files beside the page"


CHECKS: dict[str, Callable[[], str]] = {
    "no network": alone,
    "installed": installed,
    "import": lambda: median_below("import dwell", IMPORT_S),
    "first observation": lambda: median_below(OBSERVATION, OBSERVATION_S),
    "check_env": clean_env,
    "signals": unwinds,
    "daemon threads": daemons,
    "dwell doctor": doctor,
    "dwell demo": demo,
}


def main() -> int:
    """Runs every check, however the others went."""
    failed = False
    results: dict[str, dict[str, object]] = {}
    for name, check in CHECKS.items():
        try:
            told, passed = check(), True
        except Failed as why:
            told, passed = str(why), False
        failed |= not passed
        results[name] = {"passed": passed, "told": told}
        print(f"{'ok  ' if passed else 'FAIL'} {name}: {told}", flush=True)
    Path("stranger.json").write_text(json.dumps(results, indent=1), "utf-8")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
