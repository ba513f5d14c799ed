"""Prefetching: values are made in the background before they are wanted."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator
from typing import Generic, TypeVar

_Key = TypeVar("_Key", bound=Hashable)
_Prepared = TypeVar("_Prepared")


class Prefetcher(Generic[_Key, _Prepared]):
    """Makes values in a thread before they are wanted, at most so many.

    The thread lives as long as there is something to make. A forked child has none of it: what was
    made is there, what was not begins anew.
    """

    def __init__(
        self,
        make: Callable[[_Key], _Prepared],
        most: int,
        source: Callable[[_Key], Hashable] = lambda key: key,
    ) -> None:
        """Begins empty.

        Args:
            make: Makes what belongs to a key; called in another thread.
            most: How many things are kept that nobody has taken, the one in the making included.
            source: What the value of a key is made from; see :meth:`reserved`.
        """
        self._make = make
        self._most = most
        self._source = source
        #: Whether nothing is made any more.
        self.closed = False
        self._made: dict[_Key, tuple[_Prepared | None, BaseException | None]] = {}
        self._wanted: list[_Key] = []
        self._begin()

    def _begin(self) -> None:
        self._process = os.getpid()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        self._making: _Key | None = None
        #: The sources that somebody else works with.
        self._reserved: frozenset[Hashable] = frozenset()

    def _refresh(self) -> None:
        """Begins anew in a forked child: threads do not survive a fork, and locks stay as held."""
        if self._process != os.getpid():
            self._begin()

    def want(self, keys: Iterable[_Key]) -> None:
        """Sets the keys that will be wanted, the soonest first; others are dropped."""
        self._refresh()
        with self._changed:
            self._set_wanted(() if self.closed else keys)

    def _set_wanted(self, keys: Iterable[_Key]) -> None:
        self._wanted = list(dict.fromkeys(keys))[: self._most]
        self._made = {key: one for key, one in self._made.items() if key in self._wanted}
        # Who waits to take what is not wanted any more.
        self._changed.notify_all()
        self._start()

    def _start(self) -> None:
        if self._thread is None and self._next() is not None:
            self._thread = threading.Thread(target=self._work, name="dwell-ahead")
            self._thread.start()

    def _next(self) -> _Key | None:
        left = (key for key in self._wanted if key not in self._made)
        return next((key for key in left if self._source(key) not in self._reserved), None)

    def _work(self) -> None:
        while True:
            with self._changed:
                self._making = self._next()
                # The interpreter waits for threads when it ends.
                if self._making is None or not threading.main_thread().is_alive():
                    self._making = self._thread = None
                    self._changed.notify_all()
                    return
                key = self._making
            try:
                one: tuple[_Prepared | None, BaseException | None] = self._make(key), None
            except BaseException as error:
                one = None, error
            with self._changed:
                if key in self._wanted:
                    self._made[key] = one
                self._making = None
                self._changed.notify_all()
            del one

    def take(self, key: _Key) -> _Prepared | None:
        """The result for a key, once it is done; ``None`` where nobody has begun.

        Raises:
            BaseException: What making it raised.
        """
        self._refresh()
        with self._changed:
            while self._making == key and key in self._wanted:
                self._changed.wait()
            if key in self._wanted:
                self._wanted.remove(key)
            made, error = self._made.pop(key, (None, None))
        if error is not None:
            raise error
        return made

    @contextlib.contextmanager
    def reserved(self, sources: Collection[Hashable]) -> Iterator[None]:
        """Leaves sources to the caller, once what is in the making is not made from one of them.

        After :meth:`close` nobody waits: whoever works with them looks at :attr:`closed` first.
        """
        self._refresh()
        try:
            with self._changed:
                self._reserved = frozenset(sources)
                while self._is_making_of_reserved() and not self.closed:
                    self._changed.wait()
            yield
        finally:
            with self._changed:
                self._reserved = frozenset()
                self._start()

    def _is_making_of_reserved(self) -> bool:
        return self._making is not None and self._source(self._making) in self._reserved

    def close(self) -> None:
        """Drops everything for good, and waits for the value in the making."""
        self._refresh()
        with self._changed:
            self.closed = True
            self._set_wanted(())
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()
