"""Success when silent: the measure SWS of tasks whose goal sounds for a time.

C. Chen et al., "Semantic Audio-Visual Navigation", CVPR 2021: SWS is success, where the sound was
over when the agent stopped. A sound is over with its last sample at its source, as there; what the
rooms still echo does not count.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.arguments import from_json, mapping

#: The measure, a key of infos.
SWS = "sws"
#: The tasks of the engine whose goal is the first sound that the episode plays, and plays once.
_TASKS = ("SemanticAudioNav",)
#: The handle of the first sound that is played in an episode, as the engine counts them.
FIRST_PLAYED = 1 << 48


def silence_measures(config: str) -> list[str]:
    """``["sws"]`` where the task of a native ``EnvConfig`` has it; else none."""
    task = mapping("config", from_json("config", config)).get("task")
    return [SWS] if task in _TASKS else []


def success_when_silent(batch: _native.Batch, success: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where an episode is a success and its goal's sound is over, shape (n,)."""
    found = np.zeros(len(success), np.bool_)
    for k in np.flatnonzero(success).tolist():
        sounds: list[dict[str, Any]] = _native.World.of_env(batch, k).sounds()
        found[k] = not any(row["handle"] == FIRST_PLAYED for row in sounds)
    return found
