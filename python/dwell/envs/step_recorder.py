"""What writes down the steps of several environments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

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


class AgentRecorder(Protocol):
    """A recorder of several environments, in each of which several agents act."""

    def began(self, envs: Sequence[int]) -> None:
        """Episodes have begun in these environments."""

    def check(self) -> None:
        """A step is about to be made."""

    def stepped(
        self, actions: Sequence[EngineActions], answer: Mapping[str, Any], over: NDArray[np.bool_]
    ) -> None:
        """A step was made.

        Args:
            actions: Of each agent, one for each environment, with the number -1 for none.
            answer: What the engine answered, by environments and their agents.
            over: Where the episodes of all have come to their end.
        """
