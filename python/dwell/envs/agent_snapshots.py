"""What snapshots of environments of several agents hold beside world and episode."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from dwell import ConfigError
from dwell.arguments import quoted


def agent_parts(names: Sequence[str], live: Sequence[str], distances: Sequence[float]) -> bytes:
    """Who acts on, and each one's distance to its goal after the last step, as bytes.

    Args:
        names: All agents, scripted ones among them.
        live: Those whose episodes go on.
        distances: m; NaN where there is none.
    """
    told = {
        "of": [*names],
        "agents": [*live],
        "distances": [None if np.isnan(d) else float(d) for d in distances],
    }
    return json.dumps(told).encode()


def parts_of_agents(at: str, parts: bytes, names: Sequence[str]) -> tuple[list[str], list[float]]:
    """Who acts on, and all distances, out of the bytes of :func:`agent_parts`.

    Args:
        at: What errors begin with.
        parts: The bytes.
        names: Whom the environment has.

    Raises:
        ConfigError: They are of other agents, or of something else.
    """
    try:
        told = json.loads(parts)
        everybody = [str(name) for name in told["of"]]
        live = [str(name) for name in told["agents"]]
        distances = [float("nan") if d is None else float(d) for d in told["distances"]]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise ConfigError(
            f"{at}: it is of no environment of several agents: {quoted(error)}"
        ) from None
    if everybody != [*names] or len(distances) != len(names) or not set(live) <= set(names):
        raise ConfigError(f"{at}: it is of agents {quoted(everybody)}; here are {quoted([*names])}")
    return live, distances
