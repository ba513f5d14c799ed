"""The assignment problem: pairs of rows and columns with the least sum of costs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def least_cost_pairs(
    costs: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs each row of a table with a column of its own, or each column with a row of its own.

    H. W. Kuhn's Hungarian method with potentials and shortest augmenting paths (R. Jonker, A.
    Volgenant, Computing 38, 325 (1987)).

    Args:
        costs: Shape (rows, columns), finite.

    Returns:
        Rows in order and the column of each, as many as the shorter edge has.
    """
    if costs.shape[0] > costs.shape[1]:
        columns, rows = least_cost_pairs(costs.T)
        order = np.argsort(rows)
        return rows[order], columns[order]
    rows_count, columns_count = costs.shape
    # Row and column 0 stand for none.
    of_row, of_column = np.zeros(rows_count + 1), np.zeros(columns_count + 1)
    row_at = np.zeros(columns_count + 1, np.int64)
    for row in range(1, rows_count + 1):
        row_at[0], at = row, 0
        least = np.full(columns_count + 1, np.inf)
        before = np.zeros(columns_count + 1, np.int64)
        done = np.zeros(columns_count + 1, bool)
        while row_at[at] != 0:
            done[at] = True
            reduced = costs[row_at[at] - 1] - of_row[row_at[at]] - of_column[1:]
            better = ~done[1:] & (reduced < least[1:])
            least[1:][better] = reduced[better]
            before[1:][better] = at
            nearest = 1 + int(np.argmin(np.where(done[1:], np.inf, least[1:])))
            step = least[nearest]
            of_row[row_at[done]] += step
            of_column[done] -= step
            least[~done] -= step
            at = nearest
        while at:
            row_at[at] = row_at[before[at]]
            at = int(before[at])
    taken = np.flatnonzero(row_at[1:])
    order = np.argsort(row_at[1:][taken])
    return np.arange(rows_count), taken[order]
