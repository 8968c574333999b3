"""Structured arrays that grow and are aligned to cache lines, search for rows by id, and union-find over rows."""

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any, Never

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from physics import hints
from physics.jit import generic, subkernel

# ---- lines -----------------------------------------------------------------------------------------------------------
# Rows and arrays aligned to the cache lines of the processor.
#
# Aligned rows and arrays make the substeps of a step 6 % faster (388 µs instead of 413 µs, pyramid of 1,035 boxes).

LINE = 64  # [bytes]


def in_lines(fields: Sequence[tuple[str, Any]]) -> np.dtype:
    """Return a structured dtype with these (name, type) fields, aligned as in C and padded to whole cache lines."""
    packed = np.dtype(list(fields), align=True)
    placed: Any = packed.fields
    return np.dtype(
        {
            "names": [name for name, _ in fields],
            "formats": [kind for _, kind in fields],
            "offsets": [placed[name][1] for name, _ in fields],
            "itemsize": -(-packed.itemsize // LINE) * LINE,
        },
        align=True,
    )


def zeros_in_lines(count: int, dtype: Any) -> np.ndarray:
    """Return an array of `count` zeros of a dtype. The array's memory starts at a cache line."""
    dtype = np.dtype(dtype)
    bytes_ = np.zeros(count * dtype.itemsize + LINE, np.uint8)
    first = -bytes_.ctypes.data % LINE
    return bytes_[first : first + count * dtype.itemsize].view(dtype)


def columns_of(rows: Any) -> dict[str, Any]:
    """Return {name: memoryview} of the columns of a structured array.

    Reading a number from a memoryview takes 40 ns, from a NumPy array 100 ns.
    """
    return {name: memoryview(rows[name]) for name in rows.dtype.names}


# ---- table -----------------------------------------------------------------------------------------------------------


FEW = 16  # up to this number of removed rows, moving the ranges between them is faster than gathering the others


class Table:
    """A structured array that grows by doubling; `rows` are the rows in use. The memory starts at a cache line."""

    def __init__(self, dtype: DTypeLike, capacity: int = 16) -> None:
        self.data: np.ndarray = zeros_in_lines(capacity, dtype)
        self.count = 0
        self._columns = self._whole = None

    def __getstate__(self):
        return self.data, self.count

    def __setstate__(self, state):
        (self.data, self.count), self._columns, self._whole = state, None, None

    @property
    def rows(self) -> np.ndarray:
        return self.data[: self.count]

    @property
    def columns(self) -> dict[str, Any]:
        """Memoryviews of the columns by name, valid until the table grows. Rows beyond `count` are included."""
        if self._columns is None:
            self._columns = columns_of(self.data)
        return self._columns

    def reserve(self, count: int) -> None:
        """Grow the table to a capacity of at least `count` rows. The rows in use are kept."""
        if count > len(self.data):
            grown = zeros_in_lines(max(count, 2 * len(self.data)), self.data.dtype)
            whole = np.dtype((np.void, self.data.itemsize))
            grown.view(whole)[: self.count] = self.data.view(whole)[: self.count]
            self.data, self._columns, self._whole = grown, None, None

    @property
    def whole(self) -> np.ndarray:
        """All rows as opaque items (void). A row is then copied at once instead of field by field."""
        if self._whole is None:
            self._whole = self.data.view(np.dtype((np.void, self.data.itemsize)))
        return self._whole

    def row_bytes(self, row: int) -> np.void:
        """Return a copy of a row as an opaque item (void), for append_bytes."""
        return self.whole[row].copy()

    def append_bytes(self, row: np.void) -> int:
        """Append a row that was returned by row_bytes. Return its row number."""
        at = self.count
        if at == len(self.data):
            self.reserve(at + 1)
        self.whole[at] = row
        self.count = at + 1
        return at

    def append(self, count: int = 1) -> np.ndarray:
        """Add `count` rows of zeros at the end. Return a view of them."""
        self.reserve(self.count + count)
        added = self.data[self.count : self.count + count]
        added.view(np.uint8).fill(0)
        self.count += count
        return added

    def keep(self, flags: np.ndarray) -> None:
        """Remove the rows whose flag is False. The remaining rows keep their order.

        flags (rows,) bool.
        """
        gone = np.flatnonzero(~flags)
        if len(gone) > FEW:
            kept, first = np.flatnonzero(flags), gone[0]  # rows before the first stay in place
            self.whole[first : len(kept)] = self.whole[kept[first:]]
        else:
            for k, row in enumerate(gone.tolist()):
                end = gone[k + 1] if k + 1 < len(gone) else len(flags)
                self.whole[row - k : end - k - 1] = self.whole[row + 1 : end]
        self.count = len(flags) - len(gone)


class Record(np.void):
    """A row of a report, such as world.contacts[0]. A Record is printed with the names of its columns.

    A dtype (Record, fields) is equal to the dtype of the fields, and its arrays are plain NumPy arrays.
    """

    __slots__ = ()

    def __getattr__(self, name: str) -> Never:
        raise AttributeError(f"{type(self).__name__} has no attribute {name}{hints.in_place_of_column(self, name)}")

    def __repr__(self):
        values = ((name, self[name].item()) for name in self.dtype.names or ())
        shown = ", ".join(
            f"{name}={value:.6g}" if type(value) is float else f"{name}={value!r}" for name, value in values
        )
        return f"{type(self).__name__}({shown})"

    __str__ = __repr__


# ---- rows ------------------------------------------------------------------------------------------------------------
# Binary search for rows by id.


@subkernel
def row_of(table, identity):
    """Return the row number of an id in a table sorted by id; -1 for an absent id. O(log rows)."""
    low, high = 0, len(table)
    while low < high:
        middle = (low + high) // 2
        if table[middle].id < identity:
            low = middle + 1
        else:
            high = middle
    return low if low < len(table) and table[low].id == identity else -1


@subkernel
def row_nearby(table, identity):
    """Return the row number of an id in a table sorted by id; -1 for an absent id.

    Faster than row_of: O(1) if no row was ever removed, else O(log rows).
    """
    row = identity - table[0].id if len(table) > 0 else -1
    return row if 0 <= row < len(table) and table[row].id == identity else row_of(table, identity)


@generic
def find_rows(table, ids, rows_out):
    """Write the row number of each id in a table sorted by id to rows_out; -1 for an absent id.

    ids, rows_out: (n,) int64. O(n log rows).
    """
    for k in range(len(ids)):
        rows_out[k] = row_of(table, ids[k])


def rows_of(table: np.ndarray, ids: ArrayLike) -> np.ndarray:
    """Return the row numbers (n,) int64 of ids (n,) in a table sorted by id; -1 for an absent id."""
    ids = np.ascontiguousarray(ids, np.int64)
    rows = np.empty(len(ids), np.int64)
    find_rows(table, ids, rows)
    return rows


def row_number(table: Table, identity: int) -> int:
    """Return the row number of an id in a Table sorted by id; -1 for an absent id.

    O(1) if no row was removed, else O(log rows).
    """
    ids, count = table.columns["id"], table.count
    row = identity - ids[0]
    if 0 <= row < count and ids[row] == identity:
        return row
    row = bisect_left(ids, identity, 0, count)
    return row if row < count and ids[row] == identity else -1


def rows_in(table: Table, ids: np.ndarray) -> np.ndarray:
    """Return the row numbers (n,) of ids (n,) int64 in a Table sorted by id; -1 for an absent id.

    This is faster than rows_of if no row of the table was ever removed.
    """
    if table.count and len(ids):
        known = table.rows["id"]
        rows = ids - known[0]
        if rows.min() >= 0 and rows.max() < len(known) and (known[rows] == ids).all():
            return rows
    return rows_of(table.rows, ids)


def distinct(rows: np.ndarray, count: int) -> np.ndarray:
    """Return the distinct numbers of `rows` (n,), which are row numbers of a table, ascending. O(n + count).

    count: number of rows of the table. This function takes a tenth of the time of np.unique for 4,500 row numbers of
    1,500 rows.
    """
    marks = np.zeros(count, np.bool_)
    marks[rows] = True
    return np.flatnonzero(marks)


def without(rows: np.ndarray, others: np.ndarray, count: int) -> np.ndarray:
    """Return the row numbers in `rows` (n,) that are not in `others` (m,), in their order. O(n + m + count).

    count: number of rows of the table. For n = m = 1,500 this function takes a tenth of the time of np.setdiff1d.
    """
    marks = np.ones(count, np.bool_)
    marks[others] = False
    return rows[marks[rows]]


def numbers_after(keep: np.ndarray) -> np.ndarray:
    """Return the new row number (int64) of each row after a removal; -1 for a removed row.

    keep (rows,) bool: False for the rows that are removed.
    """
    return np.where(keep, np.cumsum(keep) - 1, -1)


def joined(tables: Sequence[np.ndarray]) -> np.ndarray:
    """Return the rows of several tables of the same dtype as one array, one table after another."""
    whole = np.dtype((np.void, tables[0].itemsize))
    return np.concatenate([each.view(whole) for each in tables]).view(tables[0].dtype)


# ---- union-find ------------------------------------------------------------------------------------------------------
# Disjoint sets of rows as a forest: a row is the parent of another, and a root is its own parent.


@subkernel
def root_of(row, parents_inout):
    """Return the root of the tree that contains a row (union-find). parents_inout: parent of each row.

    The path from the row to the root is shortened (path halving).
    """
    while parents_inout[row] != row:
        parents_inout[row] = parents_inout[parents_inout[row]]
        row = parents_inout[row]
    return row


@subkernel
def join_trees(a, b, parents_inout):
    """Join the trees of rows a and b (union-find). The root with the lower number becomes the common root.

    parents_inout: parent of each row.
    """
    first, second = root_of(a, parents_inout), root_of(b, parents_inout)
    parents_inout[max(first, second)] = min(first, second)
