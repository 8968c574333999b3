"""Rectangles that cover the solid cells of a grid, or the pixels of a mask: fewer parts than cells."""

import numpy as np


def solid_blocks(solid: np.ndarray) -> list[tuple[int, int, int, int]]:
    """(left, top, right, bottom) of rectangles that cover solid[row, col]: runs along rows, alike ones joined."""
    found, open_runs = [], {}
    edges = np.diff(np.pad(solid, ((0, 1), (1, 1))).astype(np.int8), axis=1)
    for row, line in enumerate(edges):
        runs = set(zip(np.flatnonzero(line > 0).tolist(), np.flatnonzero(line < 0).tolist(), strict=True))
        for run in sorted(open_runs.keys() - runs):
            found.append((run[0], open_runs.pop(run), run[1], row))
        for run in runs - open_runs.keys():
            open_runs[run] = row
    return found
