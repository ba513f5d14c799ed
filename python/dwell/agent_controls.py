"""Commands to agents for a control step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import fields, quoted
from dwell.schemas import setting_checks


def controls_of(controls: object) -> NDArray[np.float32] | list[dict[str, Any]]:
    """Controls as the native half reads them: an array (agent, 4), or a mapping for each agent."""
    expected = "expected numbers of shape (agent, 4) or a mapping for each agent"
    if isinstance(controls, str | bytes | Mapping):
        raise ConfigError(f"controls is {quoted(controls)}; {expected}")
    try:
        rows = controls if isinstance(controls, np.ndarray) else list(controls)  # type: ignore[call-overload]
    except TypeError:
        raise ConfigError(f"controls is {quoted(controls)}; {expected}") from None
    if isinstance(rows, list) and any(isinstance(row, Mapping) for row in rows):
        known = setting_checks("AgentControl")
        return [fields(f"controls[{k}]", row, known) for k, row in enumerate(rows)]
    try:
        array = np.asarray(rows)
        if array.dtype.kind not in "fiu" and array.size > 0:
            raise TypeError
    except (TypeError, ValueError):
        raise ConfigError(f"controls is {quoted(controls)}; {expected}") from None
    if array.ndim != 2 or array.shape[1] != 4:
        raise ConfigError(f"controls has the shape {array.shape}; {expected}")
    # What float32 does not hold becomes infinite, and is refused by its place.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, np.float32)
