"""Calls of an environment: one at a time, none after it was closed, none without an episode."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from dwell import ConfigError, UsageError


class EpisodeCalls:
    """What an environment with one episode at a time refuses."""

    _closed: bool
    #: Whether there is no episode to go on with: none has begun, or a call did not come to its end
    #: that began, restored or stepped one.
    _stopped: bool
    #: The call that plays the episode at this moment.
    _call: str | None

    def _refuse_closed(self) -> None:
        if self._closed:
            raise UsageError("this environment is closed; make a new one")

    def _refuse_call(self, call: str) -> None:
        if self._call is not None:
            raise UsageError(f"{call}: {another_call(self._call)}")

    def _refuse_stopped(self, call: str) -> None:
        self._refuse_closed()
        self._refuse_call(call)
        if self._stopped:
            raise UsageError(f"{call}: no episode has begun; call reset first")

    @contextlib.contextmanager
    def _playing(self, call: str, *, or_stay: bool = False) -> Iterator[None]:
        """There is no episode to go on with until ``call`` has come to its end.

        Args:
            call: Its name.
            or_stay: Whether the episode goes on where the call was refused.
        """
        before, self._stopped = self._stopped, True
        with self._calling(call):
            try:
                yield
            except ConfigError:
                self._stopped = before if or_stay else True
                raise
            self._stopped = False

    @contextlib.contextmanager
    def _calling(self, call: str) -> Iterator[None]:
        """Other calls are refused until ``call`` has come to its end."""
        self._call = call
        try:
            yield
        finally:
            self._call = None


def another_call(call: str) -> str:
    """Why a call is refused while another one plays the episode."""
    return (
        f"another call ({call}) of this environment is running, in another thread or further up in "
        "this one; an environment does one call at a time"
    )


def closed_together() -> UsageError:
    """Why a call of environments that step together is refused after they were closed."""
    return UsageError("these environments are closed; make new ones")
