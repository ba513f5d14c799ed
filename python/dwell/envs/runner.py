"""A batch of native environments with its buffers: what single and vector share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.envs.spaces import specs
from dwell.heads import Head
from dwell.house import House

#: Keys of a step's answer that become ``info``.
INFO_KEYS = (
    "success",
    "action_success",
    "collision",
    "distance_to_goal",
    "spl",
    "soft_spl",
    "path_length",
    "collisions",
)


class Runner:
    """Native environments and the arrays they write into."""

    def __init__(
        self,
        houses: Sequence[House],
        config: str,
        threads: int | None,
        *,
        overlap: bool = False,
        heads: Sequence[Head] = (),
    ) -> None:
        """Builds the environments, one for each house of ``houses``; agents may wear ``heads``."""
        for house in houses:
            for head in heads:
                house.native.add_head(head.native)
        self.batch = _native.Batch([house.native for house in houses], config, threads, overlap)
        self.count = len(houses)
        self.specs = specs(self.batch)
        self.buffers: list[NDArray[Any] | None] = [spec.buffer(self.count) for spec in self.specs]

    def observe(self, which: NDArray[np.bool_]) -> None:
        """Writes the observations of the environments in ``which`` into the buffers."""
        self.batch.observe(which, self.buffers)

    def observation(self) -> dict[str, Any]:
        """The buffers by name: arrays (count, *shape), overwritten later; tuples of strings."""
        return {
            spec.name: tuple(self.batch.texts(k)) if buffer is None else buffer
            for k, (spec, buffer) in enumerate(zip(self.specs, self.buffers, strict=True))
        }
