"""Finding rows by id: tables stand in the order of their ids."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from physics.jit import generic, subkernel


@subkernel
def row_of(table, identity):
    """The row of an id in a table in the order of ids, or -1. O(log rows)."""
    low = 0
    high = len(table)
    while low < high:
        middle = (low + high) // 2
        if table[middle].id < identity:
            low = middle + 1
        else:
            high = middle
    return low if low < len(table) and table[low].id == identity else -1


@generic
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
    for k in range(len(ids)):
        rows_out[k] = row_of(table, ids[k])


def rows_of(table: np.ndarray, ids: ArrayLike) -> np.ndarray:
    """Row numbers (n) int64 of ids in a table, -1 where one is not there."""
    ids = np.ascontiguousarray(ids, np.int64)
    rows = np.empty(len(ids), np.int64)
    find_rows(table, ids, rows)
    return rows


def joined(tables: Sequence[np.ndarray]) -> np.ndarray:
    """Rows of tables of one type, one after another: rows in one piece, not field by field."""
    whole = np.dtype((np.void, tables[0].itemsize))
    return np.concatenate([each.view(whole) for each in tables]).view(tables[0].dtype)
