"""How well hulls stand for pixels: what they cover too much and too little, and how their mass lies.

The hulls are taken as their union, the pixels as the union of their squares. All areas and moments are integrals round
the boundary of the union by Gauss's rule, exact but for rounding, and so is what both share (cells.py).
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.fitting.cells import Cells, shared_sums
from physics.fitting.contour import contours
from physics.fitting.hausdorff import hausdorff
from physics.fitting.moments import Moments, moments
from physics.fitting.union import Hull, Stretch, boundary, line


class Measured(NamedTuple):
    """Hulls beside pixels."""

    over: float  # area of the hulls outside the pixels [px2]
    missed: float  # area of the pixels outside the hulls [px2]
    hulls: Moments
    pixels: Moments
    hausdorff: float  # of the two boundaries [px]: 0 where both are none, inf where one is


def measured(solid: np.ndarray, hulls: Sequence[Hull]) -> Measured:
    """Hulls [(corners (k, 2) clockwise on the screen, radius)] in raster pixels beside solid[row, col] bool."""
    around = boundary(hulls)
    cracks = edges(solid)
    ours, theirs = moments(around), _of_pixels(solid)
    height, width = solid.shape
    cells = Cells(np.arange(width + 1.0), np.arange(height + 1.0), solid.astype(np.int64))
    both = shared_sums(around, cells, (0.0, 0.0)).area
    return Measured(max(ours.area - both, 0.0), max(theirs.area - both, 0.0), ours, theirs, hausdorff(around, cracks))


def edges(solid: np.ndarray) -> list[Stretch]:
    """The pixels' edges as straight stretches, the solid to the right."""
    loops = [loop.corners for piece in contours(solid) for loop in (piece.outer, *piece.holes)]
    return [line(a, b) for loop in loops for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True)]


def _of_pixels(solid):
    rows, columns = np.nonzero(solid)
    if not len(rows):
        return Moments(0.0, math.nan, math.nan, 0.0)
    x, y = columns + 0.5, rows + 0.5
    second = ((x - x.mean()) ** 2 + (y - y.mean()) ** 2).sum() + len(rows) / 6.0
    return Moments(float(len(rows)), float(x.mean()), float(y.mean()), float(second))
