"""The state of all agents of an environment as numbers, for critics that see everything."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

#: The numbers of an agent's state: name, lowest, highest.
STATE_FIELDS: tuple[tuple[str, float, float], ...] = (
    ("x_m", -1e4, 1e4),
    ("y_m", -1e4, 1e4),
    ("z_m", -1e4, 1e4),
    ("cos_yaw", -1.0, 1.0),
    ("sin_yaw", -1.0, 1.0),
    ("pitch_rad", -1.6, 1.6),
    ("velocity_x_m_s", -1e3, 1e3),
    ("velocity_y_m_s", -1e3, 1e3),
    ("velocity_z_m_s", -1e3, 1e3),
    ("collided", 0.0, 1.0),
    ("holds", 0.0, 1.0),
    # -1 where the task has no goal to go to, and before the first step.
    ("distance_to_goal_m", -1.0, 1e4),
    ("active", 0.0, 1.0),
)


def state_space(agents: int) -> spaces.Box:
    """The space of the states of so many agents, one after the other."""
    low = np.tile(np.array([row[1] for row in STATE_FIELDS], np.float32), agents)
    high = np.tile(np.array([row[2] for row in STATE_FIELDS], np.float32), agents)
    return spaces.Box(low, high, dtype=np.float32)


def agent_state_rows(
    states: Sequence[Mapping[str, Any]],
    distances: NDArray[np.float64],
    active: NDArray[np.bool_],
) -> NDArray[np.float32]:
    """The state of each agent as :data:`STATE_FIELDS`, shape (agent, 13).

    Args:
        states: The engine's states of agents.
        distances: To each one's goal, m; NaN where there is none.
        active: Whose episodes go on.
    """
    rows = np.empty((len(states), len(STATE_FIELDS)), np.float32)
    for k, state in enumerate(states):
        yaw = state["yaw_rad"]
        rows[k] = (
            *state["position"],
            np.cos(yaw),
            np.sin(yaw),
            state["pitch_rad"],
            *state["velocity"],
            state["collided"],
            state["holding"] is not None,
            -1.0 if np.isnan(distances[k]) else distances[k],
            active[k],
        )
    low, high = (np.array([row[k] for row in STATE_FIELDS], np.float32) for k in (1, 2))
    return np.clip(rows, low, high)
