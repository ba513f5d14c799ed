"""Things that are made in the background before they are wanted."""

from __future__ import annotations

import os
import threading
import time

import pytest

from dwell.envs.prefetch import Prefetcher


class Workshop:
    """Makes keys, each when it is let."""

    def __init__(self) -> None:
        self.made: list[int] = []
        self.begun = threading.Semaphore(0)
        self.let = threading.Semaphore(0)

    def make(self, key: int) -> str:
        self.begun.release()
        self.let.acquire()
        self.made.append(key)
        if key < 0:
            raise KeyError(key)
        return f"thing {key}"


def test_what_is_wanted_first_is_made_first_and_no_more_than_allowed() -> None:
    workshop = Workshop()
    ahead = Prefetcher(workshop.make, 2)
    ahead.want([5, 7, 5, 9])
    for _ in range(2):
        workshop.let.release()
    workshop.begun.acquire()
    assert ahead.take(5) == "thing 5"
    # Nobody waits for what was not begun.
    assert ahead.take(9) is None
    ahead.close()
    assert 9 not in workshop.made
    assert not [one for one in threading.enumerate() if one.name == "dwell-ahead"]


def test_who_takes_what_is_in_the_making_waits_for_it() -> None:
    workshop = Workshop()
    ahead = Prefetcher(workshop.make, 4)
    ahead.want([1, 2])
    workshop.begun.acquire()
    threading.Timer(0.05, lambda: workshop.let.release(2)).start()
    assert ahead.take(1) == "thing 1"
    ahead.close()


def test_what_went_wrong_is_told_to_who_takes_it_and_to_nobody_else() -> None:
    workshop = Workshop()
    ahead = Prefetcher(workshop.make, 4)
    workshop.let.release(4)
    ahead.want([-1, 2])
    workshop.begun.acquire()
    with pytest.raises(KeyError):
        ahead.take(-1)
    workshop.begun.acquire()
    assert ahead.take(2) == "thing 2"
    # Again: as if for the first time.
    ahead.want([-1])
    ahead.want([])
    ahead.close()


def test_what_is_not_wanted_any_more_is_dropped() -> None:
    workshop = Workshop()
    ahead = Prefetcher(workshop.make, 4)
    ahead.want([1, 2])
    workshop.begun.acquire()
    ahead.want([3])
    workshop.let.release(4)
    workshop.begun.acquire()
    assert ahead.take(3) == "thing 3"
    assert ahead.take(1) is None
    ahead.close()
    assert workshop.made == [1, 3]


def test_none_is_made_where_none_may_wait() -> None:
    ahead = Prefetcher(Workshop().make, 0)
    ahead.want([1])
    assert ahead.take(1) is None
    ahead.close()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_forked_child_begins_anew() -> None:
    workshop = Workshop()
    ahead = Prefetcher(workshop.make, 2)
    ahead.want([1])
    workshop.begun.acquire()
    child = os.fork()
    if child == 0:
        # The thread that makes 1 is not here, and its lock may be.
        workshop.let, workshop.begun = threading.Semaphore(9), threading.Semaphore(0)
        good = ahead.take(1) is None
        ahead.want([4])
        workshop.begun.acquire()
        good = good and ahead.take(4) == "thing 4"
        ahead.close()
        os._exit(0 if good else 1)
    workshop.let.release()
    end = time.monotonic() + 60.0
    done, status = os.waitpid(child, os.WNOHANG)
    while not done and time.monotonic() < end:
        time.sleep(0.01)
        done, status = os.waitpid(child, os.WNOHANG)
    assert done, "the child hangs"
    assert os.waitstatus_to_exitcode(status) == 0
    assert ahead.take(1) == "thing 1"
    ahead.close()
