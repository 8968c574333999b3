"""Table: a structured array that grows, and begins where a line of the cache does."""

import numpy as np
from numpy.typing import DTypeLike

from physics.tables.lines import zeros_in_lines


class Table:
    """A structured array that grows by doubling; `rows` is the used part."""

    def __init__(self, dtype: DTypeLike, capacity: int = 16) -> None:
        self.data: np.ndarray = zeros_in_lines(capacity, dtype)
        self.count = 0

    @property
    def rows(self) -> np.ndarray:
        return self.data[: self.count]

    def reserve(self, count: int) -> None:
        """Make room for `count` rows, keeping what is there."""
        if count > len(self.data):
            grown = zeros_in_lines(max(count, 2 * len(self.data)), self.data.dtype)
            grown[: self.count] = self.rows
            self.data = grown

    def append(self, count: int = 1) -> np.ndarray:
        """Room for `count` new zeroed rows at the end; returns them."""
        self.reserve(self.count + count)
        added = self.data[self.count : self.count + count]
        added.view(np.uint8).fill(0)
        self.count += count
        return added

    def keep(self, flags: np.ndarray) -> None:
        """Drop the rows whose flag is False; the others keep their order."""
        kept = np.flatnonzero(flags)
        first = len(kept) if len(kept) == len(flags) else int(np.argmin(flags))  # what stands before stays where it is
        whole = self.data.view(np.dtype((np.void, self.data.itemsize)))  # rows in one piece, not field by field
        whole[first : len(kept)] = whole[kept[first:]]
        self.count = len(kept)
