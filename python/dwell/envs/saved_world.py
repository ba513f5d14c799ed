"""An environment's episode as its engine saves it."""

from __future__ import annotations

import dataclasses


@dataclasses.dataclass(frozen=True)
class SavedWorld:
    """A snapshot of one environment of several."""

    #: The house, as the shelf of houses numbers it.
    house: int
    #: The seed of the episode.
    seed: int
    #: The engine's snapshot.
    world: bytes
    #: The states of parts in Python; empty where there are none.
    parts: bytes = b""
