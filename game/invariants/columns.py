"""A function that copies several float64 columns of a structured array at once.

Copying ten columns of a thousand rows in this way takes as long as copying two columns one by one.
"""

from functools import cache

import numpy as np


@cache
def _words(dtype, names):
    places = [dtype.fields[name][1] // 8 for name in names]
    if places == list(range(places[0], places[0] + len(places))):
        return slice(places[0], places[-1] + 1)
    return places


def block(rows: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Return a copy of the columns `names` of a structured array, (len(names), n) for n rows.

    All columns must be float64.
    """
    table = np.ascontiguousarray(rows)
    words = table.view(np.float64).reshape(len(table), table.dtype.itemsize // 8)
    return np.array(words[:, _words(table.dtype, names)].T, order="C")  # a copy even of a single row
