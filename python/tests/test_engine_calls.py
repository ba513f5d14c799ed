"""Calls into the engines: bugs, logs, copies, threads."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell import _native
from dwell.envs import DwellVectorEnv


def python(program: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Runs a program in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


# ---- bugs


def test_a_panic_is_an_exception_with_its_place_and_nothing_is_printed(
    capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG, "dwell")
    with pytest.raises(
        dwell.EngineBug, match=r"a pool's, on purpose \(.*panic_for_tests\.rs:\d+"
    ) as caught:
        _native.panic_for_tests()
    assert isinstance(caught.value, RuntimeError)
    assert isinstance(caught.value, dwell.DwellError)
    assert capfd.readouterr() == ("", "")
    (record,) = caplog.records
    assert (record.name, record.levelno) == ("dwell.python.panics", logging.DEBUG)
    assert "a pool's, on purpose" in record.getMessage()
    # The pool goes on.
    assert dwell.World("builtin:studio").render(agent=0)["rgb"].shape == (128, 128, 3)


def test_a_world_that_a_bug_stopped_refuses_and_others_go_on() -> None:
    world, other = dwell.World("builtin:studio"), dwell.World("builtin:studio")
    with pytest.raises(dwell.EngineBug, match="a world's, on purpose"):
        _native.panic_for_tests(world.native)
    for call in (world.step, world.snapshot, lambda: world.render(agent=0), world.state_hash):
        with pytest.raises(dwell.UsageError, match="a bug of the engine stopped this world"):
            call()
    with pytest.raises(dwell.UsageError, match="a bug of the engine stopped this world"):
        world.restore(other.snapshot())
    other.step()


# ---- logs


def test_what_engines_log_arrives_in_logging(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG, "dwell")
    dwell.House.open("builtin:studio")
    (record,) = [r for r in caplog.records if r.name == "dwell.houses.formats"]
    assert record.levelno == logging.DEBUG
    assert record.getMessage().startswith("house opened (house=builtin:studio, took_ms=")
    assert Path(record.pathname).name == "house.py", "the record says who called"
    caplog.clear()
    logging.getLogger("dwell").setLevel(logging.WARNING)
    dwell.House.open("builtin:studio")
    assert not caplog.records


def test_the_level_of_the_root_counts_where_dwell_has_none(
    caplog: pytest.LogCaptureFixture,
) -> None:
    assert logging.getLogger("dwell").level == logging.NOTSET
    caplog.set_level(logging.DEBUG)
    dwell.House.open("builtin:studio")
    assert [r for r in caplog.records if r.name == "dwell.houses.formats"]


def test_records_of_other_threads_and_handlers_that_raise_do_no_harm() -> None:
    class Raising(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            raise ValueError(record.name)

    log, handler, unraisable = logging.getLogger("dwell"), Raising(), []
    log.addHandler(handler)
    log.setLevel(logging.DEBUG)
    hook, sys.unraisablehook = sys.unraisablehook, unraisable.append
    try:
        house = dwell.House.open("builtin:studio")
        thread = threading.Thread(target=dwell.House.open, args=("builtin:studio",))
        thread.start()
        thread.join()
    finally:
        sys.unraisablehook = hook
        log.removeHandler(handler)
        log.setLevel(logging.NOTSET)
    assert house.name
    assert len(unraisable) == 2


def test_nothing_is_logged_where_nobody_asked() -> None:
    program = "import dwell; dwell.World('builtin:studio').step()"
    ran = python(program)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "", "")


# ---- copies


def address(array: np.ndarray[Any, Any]) -> int:
    """The address of an array's numbers."""
    return int(array.__array_interface__["data"][0])


@pytest.mark.long
@pytest.mark.usefixtures("open_once")
def test_observations_are_written_where_they_are_read() -> None:
    envs = DwellVectorEnv(2, sensors=["rgb", "depth", "audio"])
    first, _ = envs.reset(seed=0)
    places = {name: address(value) for name, value in first.items()}
    before = first["rgb"].copy()
    for _ in range(3):
        now = envs.step(np.array([3, 1]))[0]
        assert {name: address(value) for name, value in now.items()} == places
        assert all(value.base is None or value.flags.c_contiguous for value in now.values())
    assert (before != first["rgb"]).any(), "the first observation shows the latest picture"
    kept = DwellVectorEnv(2, sensors=["rgb"], copy=True)
    one, _ = kept.reset(seed=0)
    assert address(one["rgb"]) != address(kept.step(np.array([0, 0]))[0]["rgb"])


@pytest.mark.usefixtures("open_once")
def test_the_native_batch_writes_into_the_array_it_is_given_and_only_its_part() -> None:
    envs = DwellVectorEnv(2, sensors=["rgb"])
    envs.reset(seed=0)
    batch = envs._runner.batch
    out = np.full((2, 128, 128, 3), 7, np.uint8)
    batch.observe(np.array([False, True]), [out])
    assert (out[0] == 7).all()
    assert (out[1] != 7).any()
    for wrong in (out[:, ::2], out.astype(np.float32), out.copy(order="F")):
        with pytest.raises(dwell.ConfigError, match="expected a writeable C-contiguous uint8"):
            batch.observe(np.array([True, True]), [wrong])


def test_pictures_and_sounds_belong_to_whoever_asked_and_are_no_views_of_the_engine() -> None:
    world = dwell.World("builtin:studio")
    one, two = world.render(agent=0)["rgb"], world.render(agent=0)["rgb"]
    assert address(one) != address(two)
    assert one.flags.writeable
    one[:] = 0
    assert two.any()


# ---- threads

CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
#: The same question in a process whose affinity mask is narrowed first.
DOCTOR = "import json; from dwell import _native; print(json.dumps(_native.doctor()))"
NARROW = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}); "


#: Where drivers of graphics are looked for: nowhere, for asking them takes seconds.
NO_DRIVERS = dict.fromkeys(
    ("VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_FILENAMES"), os.devnull
)


def counted(program: str, **variables: str) -> dict[str, Any]:
    ran = python(program, **NO_DRIVERS, **variables)
    assert ran.returncode == 0, ran.stderr
    facts: dict[str, Any] = json.loads(ran.stdout)
    return facts


@pytest.mark.long
def test_threads_are_the_cores_that_affinity_and_variable_leave() -> None:
    facts = counted(DOCTOR, DWELL_THREADS="1")
    assert (facts["threads"], facts["threads_variable"]) == (1, 1)
    facts = counted(DOCTOR, DWELL_THREADS="1000")
    assert facts["threads"] == facts["available_cores"] <= CORES
    if hasattr(os, "sched_setaffinity"):
        facts = counted(NARROW + DOCTOR, DWELL_THREADS="8")
        assert (facts["threads"], facts["available_cores"]) == (1, 1)


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted by /proc")
def test_no_more_threads_are_started_than_were_counted() -> None:
    program = """
import pathlib
import dwell
dwell.World("builtin:studio").render(agent=0)
names = [task.joinpath("comm").read_text() for task in pathlib.Path("/proc/self/task").iterdir()]
print(sum(name.startswith("dwell-") for name in names))
"""
    assert counted(program, DWELL_THREADS="1") == 0
    cores = counted(DOCTOR)["available_cores"]
    assert counted(program) == (cores if cores > 1 else 0)


@pytest.mark.parametrize("value", ["", "0", "-1", "two", "1.5", "1025", "9" * 30])
def test_a_variable_that_makes_no_sense_is_refused(
    value: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = f'DWELL_THREADS is "{value}"; allowed are 1 to 1024'
    monkeypatch.delenv("DWELL_THREADS", raising=False)
    house = dwell.House.open("builtin:studio")
    monkeypatch.setenv("DWELL_THREADS", value)
    for call in (
        lambda: dwell.House.open("builtin:studio"),
        lambda: DwellVectorEnv(1, houses=house),
        lambda: dwell.World(house).render(agent=0),
        _native.doctor,
    ):
        with pytest.raises(dwell.ConfigError) as caught:
            call()
        assert str(caught.value) == expected
    # A number that is asked for goes before the variable.
    DwellVectorEnv(1, houses=house, threads=1)
