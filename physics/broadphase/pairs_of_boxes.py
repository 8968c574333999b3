"""The method find_pairs of all broad phases, which finds the overlapping pairs among given boxes."""

import numpy as np
from numpy.typing import ArrayLike

from physics.broadphase.proxies import Arena, Strategy
from physics.tables.shape import PROXY


def find_pairs(strategy: Strategy, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
    """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

    strategy: a broad phase without proxies, which finds the pairs; lower, upper: corners of n boxes (n, 2) [px]. Raises
    the errors of Strategy.find_pairs.
    """
    lower, upper = _corners("lower", lower), _corners("upper", upper)
    if len(lower) != len(upper):
        raise ValueError(f"lower and upper must have as many rows (got {len(lower)} and {len(upper)})")
    wrong = (lower > upper).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"lower[{row}] must be <= upper[{row}] (got {lower[row].tolist()} and {upper[row].tolist()})")
    arena = Arena()
    arena.proxies = np.zeros(len(lower), PROXY)
    arena.proxies["lower_x"], arena.proxies["lower_y"] = lower.T
    arena.proxies["upper_x"], arena.proxies["upper_y"] = upper.T
    for name in ("row", "body"):
        arena.proxies[name] = np.arange(len(lower))
    arena.proxies["membership"] = arena.proxies["mask"] = 1
    arena.proxies["changed"] = arena.proxies["awake"] = True
    arena.changed = np.arange(len(lower), dtype=np.int64)
    strategy.update(arena)
    count = arena.collect(strategy.query(arena))
    pairs = np.sort(arena.pairs[:count], axis=1)
    order = np.argsort(pairs[:, 0].astype(np.int64) << 32 | pairs[:, 1])
    return np.ascontiguousarray(pairs[order])


def _corners(name, value):
    try:
        array = np.array(value, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} must be an (n, 2) array of numbers (got {type(value).__name__})") from None
    if array.size == 0:
        array = array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have shape (n, 2) (got {array.shape})")
    if np.isnan(array).any():
        row = int(np.argwhere(np.isnan(array))[0][0])
        raise ValueError(f"{name}[{row}] must not be NaN (got {array[row].tolist()})")
    return array
