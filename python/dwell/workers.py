"""Threads of jobs in Python: how many, and how they end."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

from dwell import _native
from dwell.arguments import integer_in_range

#: The most workers that may be asked for, as threads of the engines.
MAX_WORKERS = 1024
#: Threads that are started for each processor: more would only wait for each other.
_PER_PROCESSOR = 4


def worker_count(name: str, value: object) -> int:
    """How many workers are asked for.

    Raises:
        ConfigError: It is no whole number from 1 to :data:`MAX_WORKERS`.
    """
    return integer_in_range(name, value, low=1, high=MAX_WORKERS)


def thread_count(asked: int | None, jobs: int) -> int:
    """How many threads are started, at least 1.

    Args:
        asked: How many are asked for; as many as processors by default.
        jobs: How many jobs there are; further threads would have nothing to do.
    """
    processors = os.cpu_count() or 1
    most = min(processors if asked is None else asked, _PER_PROCESSOR * processors)
    return max(1, min(most, jobs))


@contextlib.contextmanager
def thread_pool(threads: int) -> Iterator[ThreadPoolExecutor]:
    """Threads whose jobs end with the block: nobody waits for what is not done by then.

    Calls of the engines are stopped, and jobs that have not begun are cancelled.
    """
    stop = _native.StopToken()
    pool = ThreadPoolExecutor(threads, initializer=stop.watch_this_thread)
    try:
        yield pool
    finally:
        stop.stop()
        pool.shutdown(cancel_futures=True)
