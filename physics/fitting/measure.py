"""How well hulls stand for pixels: what they cover too much and too little, and how their mass lies.

The hulls are taken as their union, the pixels as the union of their squares. All areas and moments are integrals round
the boundary of the union, cut where it crosses a line of the pixel grid, by Gauss's rule: exact but for rounding. What
both share is one too: of the function that says how many solid pixels of a row lie left of a point (Green's theorem).
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.fitting.contour import contours
from physics.fitting.hausdorff import hausdorff
from physics.fitting.moments import WEIGHTS, Moments, moments, nodes
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
    both = _shared(around, solid)
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


def _shared(around, solid):
    """Area that lies inside a boundary and in solid pixels [px2]."""
    if not around or not solid.any():
        return 0.0
    height, width = solid.shape
    cells = [part for each in around for part in _cut_by_grid(each)]
    left = np.zeros((height, width + 1))
    left[:, 1:] = np.cumsum(solid, axis=1)  # solid pixels of a row left of a column
    filled = np.pad(solid, ((0, 0), (0, 1))).astype(float)
    middle = np.array([each.at(np.array([0.5]))[0] for each in cells])
    column = np.clip(np.floor(middle[:, 0]), -1, width).astype(np.int64)
    row = np.floor(middle[:, 1]).astype(np.int64)
    within = (row >= 0) & (row < height) & (column >= 0)
    cells = [each for each, kept in zip(cells, within.tolist(), strict=True) if kept]
    if not cells:
        return 0.0
    row, column = row[within], column[within]
    place, step = nodes(cells)
    so_far = left[row, column][:, None] + filled[row, column][:, None] * (place[:, :, 0] - column[:, None])
    return float(((so_far * step[:, :, 1]) @ WEIGHTS).sum())


def _cut_by_grid(stretch):
    """A stretch in parts that each lie in one column and one row of pixels."""
    shares = [np.array([0.0, 1.0])]
    low, high = stretch.at(np.linspace(0.0, 1.0, 9)).min(axis=0), stretch.at(np.linspace(0.0, 1.0, 9)).max(axis=0)
    for axis in (0, 1):
        reach = stretch.radius
        lines = np.arange(math.floor(low[axis] - reach), math.ceil(high[axis] + reach) + 1.0)
        if stretch.radius == 0.0:
            along = stretch.end[axis] - stretch.start[axis]
            if along != 0.0:
                shares.append((lines - stretch.start[axis]) / along)
            continue
        away = (lines - stretch.center[axis]) / stretch.radius
        angle = np.arccos(away[np.abs(away) <= 1.0]) if axis == 0 else np.arcsin(away[np.abs(away) <= 1.0])
        for each in (angle, -angle if axis == 0 else math.pi - angle):
            shares.append((each - stretch.first) % math.tau / stretch.turn)
    cuts = np.unique(np.concatenate(shares))
    cuts = cuts[(cuts >= 0.0) & (cuts <= 1.0)]
    return [stretch.between(a, b) for a, b in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True)]
