"""Pixels of several masks on a common grid of unequal columns and rows, and their sums: area and first and second
moments, alone or shared with what lies inside a boundary of lines and arcs. Exact but for rounding.

What cells and a boundary share are integrals round the boundary (Green's theorem), cut where it crosses a line of the
grid, of functions that say what is solid left of a point in its row.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.fitting.moments import WEIGHTS, Moments, nodes
from physics.fitting.union import Stretch

Placed = tuple[np.ndarray, float, float]  # solid[row, col] bool; left, top [px] of its corner
Box = tuple[float, float, float, float]  # left, top, right, bottom [px]


class Cells(NamedTuple):
    """A grid whose lines are those of all masks in it."""

    x: np.ndarray  # (w + 1,) lines between columns [px], rising
    y: np.ndarray  # (h + 1,) lines between rows
    count: np.ndarray  # (h, w) masks that are solid there


class Sums(NamedTuple):
    """Integrals over a figure, about a base."""

    area: float  # [px2]
    x: float  # [px3]
    y: float
    second: float  # of the squared distance [px4]

    def plus(self, other: "Sums", share: float = 1.0) -> "Sums":
        """With so many times another's."""
        return Sums(*(a + share * b for a, b in zip(self, other, strict=True)))

    def moments(self, base: tuple[float, float]) -> Moments:
        """Of these sums about a base; without an area there is no centre."""
        if self.area <= 0.0:
            return Moments(0.0, math.nan, math.nan, 0.0)
        x, y = self.x / self.area, self.y / self.area
        return Moments(self.area, base[0] + x, base[1] + y, self.second - self.area * (x * x + y * y))


NO_SUMS = Sums(0.0, 0.0, 0.0, 0.0)


def sums_of(found: Moments, base: tuple[float, float]) -> Sums:
    """What moments are about a base."""
    if found.area == 0.0:
        return NO_SUMS
    x, y = found.x - base[0], found.y - base[1]
    return Sums(found.area, found.area * x, found.area * y, found.inertia + found.area * (x * x + y * y))


def cells_of(masks: Sequence[Placed], window: Box) -> Cells:
    """What several masks have in a window, on a common grid."""
    lines = []
    for axis in (0, 1):
        low, high = window[axis], window[axis + 2]
        grids = [np.arange(solid.shape[1 - axis] + 1.0) + (left, top)[axis] for solid, left, top in masks]
        lines.append(np.unique(np.clip(np.concatenate([*grids, [low, high]]), low, high)))
    x, y = lines
    count = np.zeros((len(y) - 1, len(x) - 1), np.int64)
    for solid, left, top in masks:
        rows, columns = _places(y, top, solid.shape[0]), _places(x, left, solid.shape[1])
        count += solid[np.ix_(np.maximum(rows, 0), np.maximum(columns, 0))] & (rows >= 0)[:, None] & (columns >= 0)
    return Cells(x, y, count)


def _places(lines, first, size):
    """In which row or column of a mask the stretches between lines lie; -1: in none."""
    place = np.floor((lines[:-1] + lines[1:]) / 2.0 - first).astype(np.int64)
    return np.where((place >= 0) & (place < size), place, -1)


def cell_sums(cells: Cells, weights: np.ndarray, base: tuple[float, float]) -> Sums:
    """Of cells (h, w) that weigh so much a px2."""
    width, height = np.diff(cells.x), np.diff(cells.y)
    x, y = (cells.x[:-1] + cells.x[1:]) / 2.0 - base[0], (cells.y[:-1] + cells.y[1:]) / 2.0 - base[1]
    in_rows = [(weights * each).sum(axis=1) for each in (width, width * x, width * (x * x + width * width / 12.0))]
    area, first, second = in_rows
    return Sums(
        float((height * area).sum()),
        float((height * first).sum()),
        float((height * y * area).sum()),
        float((height * (second + (y * y + height * height / 12.0) * area)).sum()),
    )


def shared_sums(around: Sequence[Stretch], cells: Cells, base: tuple[float, float]) -> Sums:
    """Of what lies inside a boundary and in cells that any mask fills."""
    parts = [part for each in around for part in _cut_by_lines(each, cells)]
    if not parts or not cells.count.any():
        return NO_SUMS
    middle = np.array([each.at(np.array([0.5]))[0] for each in parts])
    row, column = (np.searchsorted(lines, middle[:, axis]) - 1 for axis, lines in ((1, cells.y), (0, cells.x)))
    within = (row >= 0) & (row < len(cells.y) - 1) & (column >= 0)
    parts = [each for each, kept in zip(parts, within.tolist(), strict=True) if kept]
    if not parts:
        return NO_SUMS
    row, column = row[within], column[within]
    place, step = nodes(parts)
    x, y = place[:, :, 0] - base[0], place[:, :, 1] - base[1]
    so_far = [_left_of(cells, power, base[0], row, column, x) for power in (0, 1, 2)]
    rise = step[:, :, 1]
    area, first, second = ((each * rise @ WEIGHTS).sum() for each in so_far)
    down, square = ((so_far[0] * each * rise @ WEIGHTS).sum() for each in (y, y * y))
    return Sums(float(area), float(first), float(down), float(second + square))


def _left_of(cells, power, base, row, column, x):
    """Integrals (n, 16) of x to a power over what is solid in a row left of points (n, 16)."""
    lines = cells.x - base
    filled = np.pad(cells.count > 0, ((0, 0), (0, 1)))  # right of the last line there is nothing
    whole = lines ** (power + 1) / (power + 1)
    left = np.zeros((len(filled), len(lines)))
    left[:, 1:] = np.cumsum(np.where(filled[:, :-1], np.diff(whole), 0.0), axis=1)
    part = np.where(filled[row, column][:, None], x ** (power + 1) / (power + 1) - whole[column][:, None], 0.0)
    return left[row, column][:, None] + part


def _cut_by_lines(stretch, cells):
    """A stretch in parts that each lie in one column and one row."""
    shares = [np.array([0.0, 1.0])]
    for axis, lines in enumerate((cells.x, cells.y)):
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
