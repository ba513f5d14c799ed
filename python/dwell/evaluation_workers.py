"""Episodes of an evaluation are played by several processes, and come in order."""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import os
import pickle
import signal
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from dwell import ConfigError, UsageError
from dwell.arguments import quoted
from dwell.episodes import Episode
from dwell.evaluation import Evaluation
from dwell.plugin_parts import refusing_exit
from dwell.workers import worker_count

#: Of a process that plays: what makes its evaluation, and that once it is made.
_RECIPE: dict[str, Any] = {}
_JOB: list[Evaluation] = []


def played_rows(
    job: Evaluation, episodes: Sequence[Episode], *, workers: int = 1
) -> Iterator[dict[str, Any]]:
    """What a result says of each episode, in order.

    Args:
        job: The evaluation.
        episodes: Those of its episodes that are played.
        workers: How many processes play. Each makes the policy anew.

    Raises:
        ConfigError: The policy cannot be given to other processes; or as :meth:`Evaluation.play`.
        PolicyError: As :meth:`Evaluation.play`.
        UsageError: A process ended without a word.
    """
    workers = min(worker_count("workers", workers), len(episodes))
    if workers <= 1:
        yield from map(job.play, episodes)
        return
    recipe = dict(job.recipe)
    if recipe["threads"] is None:
        recipe["threads"] = max(1, (os.cpu_count() or 1) // workers)
    try:
        pickled = pickle.dumps(recipe)
    except Exception as error:
        raise ConfigError(
            f"workers is {workers}, and the policy {quoted(recipe['policy'])} cannot be given to "
            f"other processes ({error}); give its class or 'module:Name'"
        ) from None
    # Not forked: engines have threads.
    context = multiprocessing.get_context("spawn")
    before = {*multiprocessing.active_children()}
    pool = ProcessPoolExecutor(workers, context, _begin, (pickled,))
    try:
        yield from _in_order(pool, episodes, workers)
    except BrokenProcessPool:
        raise UsageError(
            "a process that plays episodes ended without a word, as where memory is short; run "
            f"again with fewer workers than {workers}"
        ) from None
    except BaseException:
        # Nobody waits for the episodes that are being played.
        for process in {*multiprocessing.active_children()} - before:
            process.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _in_order(
    pool: ProcessPoolExecutor, episodes: Sequence[Episode], workers: int
) -> Iterator[dict[str, Any]]:
    left = iter(episodes)
    ahead: deque[Future[dict[str, Any]]] = deque()
    while True:
        for one in itertools.islice(left, 2 * workers - len(ahead)):
            ahead.append(pool.submit(_play, one))
        if not ahead:
            return
        yield ahead.popleft().result()


def _begin(pickled: bytes) -> None:
    """Begins a process; what can fail comes with the first episode, whose error is told."""
    # Who interrupts means the process that waits, which ends the others.
    with contextlib.suppress(ValueError):
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    _RECIPE["pickled"] = pickled


@refusing_exit()
def _play(one: Episode) -> dict[str, Any]:
    if not _JOB:
        _JOB.append(Evaluation(**pickle.loads(_RECIPE["pickled"])))
    return _JOB[0].play(one)
