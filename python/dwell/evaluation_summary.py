"""What a result says of all its episodes together: means with intervals, and groups."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dwell import _native
from dwell.envs.silence import SWS

#: Of the intervals: how many samples of episodes, with what seed, and how wide.
_RESAMPLES, _BOOTSTRAP_SEED, _LEVEL = 1000, 0, 0.95
#: What is averaged over episodes.
METRICS = (
    "success",
    "spl",
    "soft_spl",
    "na",
    "sna",
    "distance_to_goal",
    "normalized_distance_to_goal",
    "path_length",
    "collisions",
    "steps",
    "reward",
)
#: What success is counted by.
_GROUPS = ("goal_kind", "goal_class")
#: Metrics of floats: equal where they differ by less than a text of JSON may round.
_TOLERANCE = 1e-9


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Means with their intervals, and success by what was asked."""
    groups = {}
    for key in _GROUPS:
        names = sorted({row[key] for row in rows if row[key] is not None})
        groups[f"by_{key}"] = {
            name: _group([row for row in rows if row[key] == name]) for name in names
        }
    own = [measure["name"] for task in _native.tasks() for measure in task["measures"]]
    measured = [name for name in (*own, SWS) if all(name in row for row in rows)]
    return {
        "bootstrap": {"resamples": _RESAMPLES, "seed": _BOOTSTRAP_SEED, "level": _LEVEL},
        "metrics": {name: _mean([row[name] for row in rows]) for name in (*METRICS, *measured)},
        **groups,
    }


def _group(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {"episodes": len(rows)}
    for name in ("success", "spl"):
        values = [float(row[name]) for row in rows if row[name] is not None]
        found[name] = math.fsum(values) / len(values) if values else None
    return found


def _mean(values: Sequence[float | None]) -> dict[str, Any]:
    """The mean of those that there are, and a percentile interval by a bootstrap."""
    known = np.array([float(value) for value in values if value is not None])
    if not known.size:
        return {"episodes": 0, "mean": None, "low": None, "high": None}
    stream = np.random.default_rng(_BOOTSTRAP_SEED)
    means = [
        float(known[stream.integers(known.size, size=known.size)].mean()) for _ in range(_RESAMPLES)
    ]
    low, high = np.quantile(means, [(1 - _LEVEL) / 2, (1 + _LEVEL) / 2])
    mean = math.fsum(known.tolist()) / known.size
    return {"episodes": int(known.size), "mean": mean, "low": float(low), "high": float(high)}


def is_same(one: object, other: object) -> bool:
    """Returns whether two values of JSON are the same, floats but for rounding."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(is_same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(itertools.starmap(is_same, pairs))
    if isinstance(one, bool) or isinstance(other, bool):
        return one is other
    if isinstance(one, int | float) and isinstance(other, int | float):
        try:
            return math.isclose(one, other, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)
        except OverflowError:
            # A whole number that no float reaches.
            return one == other
    return one == other
