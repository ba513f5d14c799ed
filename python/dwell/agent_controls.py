"""Commands to agents for a control step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import checked_fields, quoted, refuse_no_array, sequence_items
from dwell.schemas import setting_checks


def controls_of(controls: object) -> NDArray[np.float32] | list[dict[str, Any]]:
    """Controls as the native half reads them: an array (agent, 4), or a mapping for each agent."""
    expected = "expected numbers of shape (agent, 4) or a mapping for each agent"
    is_array = isinstance(controls, np.ndarray)
    rows = controls if is_array else sequence_items("controls", controls, expected)
    if isinstance(rows, list) and any(isinstance(row, Mapping) for row in rows):
        known = setting_checks("AgentControl")
        return [checked_fields(f"controls[{k}]", row, known) for k, row in enumerate(rows)]
    refuse_no_array("controls", rows)
    try:
        table = np.asarray(rows)
        if table.dtype.kind not in "fiu" and table.size > 0:
            raise TypeError
    except (TypeError, ValueError):
        raise ConfigError(f"controls is {quoted(controls)}; {expected}") from None
    if table.shape == (0,):
        # An empty list tells no number of columns: nobody is given controls.
        table = table.reshape(0, 4)
    if table.ndim != 2 or table.shape[1] != 4:
        raise ConfigError(f"controls has the shape {table.shape}; {expected}")
    # What float32 does not hold becomes infinite, and is refused by its place.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(table, np.float32)
