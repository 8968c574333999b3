"""Finding rows by id: tables stand in the order of their ids."""

import numpy as np
from numpy.typing import ArrayLike

from physics.jit import kernel


@kernel
def find_rows(
    # read
    table,
    ids,
    # write
    rows_out,
):
    """Write the row of every id in a table that stands in the order of ids, -1 where it is not there.

    ids, rows_out (n) int64. O(n log rows).
    """
    count = len(table)
    for k in range(len(ids)):
        low = 0
        high = count
        while low < high:
            middle = (low + high) // 2
            if table[middle].id < ids[k]:
                low = middle + 1
            else:
                high = middle
        rows_out[k] = low if low < count and table[low].id == ids[k] else -1


def rows_of(table: np.ndarray, ids: ArrayLike) -> np.ndarray:
    """Row numbers (n) int64 of ids in a table, -1 where one is not there."""
    ids = np.ascontiguousarray(ids, np.int64)
    rows = np.empty(len(ids), np.int64)
    find_rows(table, ids, rows)
    return rows
