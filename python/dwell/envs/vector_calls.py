"""Calls of environments that step together: one at a time, none after they were closed."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from dwell import UsageError
from dwell.envs.episode_calls import another_call, closed_together
from dwell.envs.house_assignment import HouseAssignment
from dwell.envs.native_batch import NativeBatch


class VectorCalls:
    """What environments that step together refuse.

    They may be closed while a call of another thread runs. That call is refused where it next asks
    for the batch or for the houses.
    """

    #: Batch and houses; ``None`` before they are made and after they were closed. One value, so
    #: that who asks has both or none.
    _opened: tuple[NativeBatch, HouseAssignment] | None = None
    #: The call that plays episodes at this moment.
    _call: str | None = None

    def _parts(self) -> tuple[NativeBatch, HouseAssignment]:
        opened = self._opened
        if opened is None:
            raise closed_together()
        return opened

    @property
    def _runner(self) -> NativeBatch:
        return self._parts()[0]

    @property
    def _places(self) -> HouseAssignment:
        return self._parts()[1]

    def _refuse_closed(self) -> None:
        self._parts()

    def _refuse_call(self, call: str) -> None:
        if self._call is not None:
            raise UsageError(f"{call}: {another_call(self._call)}")

    @contextlib.contextmanager
    def _calling(self, call: str) -> Iterator[None]:
        """Other calls are refused until ``call`` has come to its end."""
        self._refuse_closed()
        self._refuse_call(call)
        self._call = call
        try:
            yield
        finally:
            self._call = None

    def _drop(self) -> None:
        """Closes the worlds: other calls are refused from now on."""
        opened, self._opened = self._opened, None
        if opened is not None:
            opened[1].close()
