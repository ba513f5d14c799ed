"""What writes down the steps of several environments."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dwell.envs.action_modes import EngineActions


class Recorder(Protocol):
    """A recorder of several environments."""

    def began(self, envs: Sequence[int]) -> None:
        """Episodes have begun in these environments."""

    def check(self) -> None:
        """A step is about to be made."""

    def stepped(
        self,
        actions: EngineActions,
        success: NDArray[np.bool_],
        ended: NDArray[np.bool_],
    ) -> None:
        """A step was made: by actions with the number -1 for none. Those that ended still stand."""
