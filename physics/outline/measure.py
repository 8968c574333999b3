"""Accuracy of convex hulls that replace pixels: area and moments of their union, and the Hausdorff distance."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.outline.contour import contours

# ---- union -----------------------------------------------------------------------------------------------------------
# Boundary of the union of rounded convex hulls: exact lines and arcs, for any overlaps.
#
# The boundary of each hull is cut where it meets the boundary of another hull. A stretch between two cuts belongs to
# the union's boundary unless its middle is inside another hull or on the boundary of a hull on its other side. Of
# coincident stretches only the stretch of the first hull is kept.

ROUNDING = 1e-9  # share of the hulls' size: a point nearer to a boundary than this counts as on it

Hull = tuple[np.ndarray, float]  # corners (k, 2) clockwise on the screen, 1: a disc, 2: a capsule; and radius [px]


class Stretch(NamedTuple):
    """Section of a boundary: a line, or an arc that is clockwise on the screen. The figure's inside is on its right."""

    start: np.ndarray  # (2,) [px]
    end: np.ndarray  # (2,)
    center: np.ndarray  # (2,) [px] centre of an arc
    radius: float  # 0: a line
    first: float  # [rad] angle at the start of the arc
    turn: float  # [rad] > 0: angle of the arc

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Return the points (m, 2) [px] at fractions `shares` (m,) of the length: 0 is the start, 1 the end."""
        if self.radius == 0.0:
            return self.start + shares[:, None] * (self.end - self.start)
        angles = self.first + shares * self.turn
        return self.center + self.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)

    def between(self, a: float, b: float) -> "Stretch":
        """Return the section of the stretch between two fractions of its length, 0 <= a < b <= 1."""
        start, end = self.at(np.array([a, b]))
        return Stretch(start, end, self.center, self.radius, self.first + a * self.turn, (b - a) * self.turn)

    @property
    def length(self) -> float:
        return self.radius * self.turn if self.radius > 0.0 else math.hypot(*(self.end - self.start))


def boundary(hulls: Sequence[Hull]) -> list[Stretch]:
    """Return the boundary of a union of hulls as lines and arcs with the inside on their right; [] without hulls.

    A side shared by two hulls is not part of the boundary. Only hulls with overlapping bounding boxes are compared.
    O(sides²) at worst.
    """
    if not hulls:
        return []
    low = np.array([corners.min(axis=0) - radius for corners, radius in hulls])
    high = np.array([corners.max(axis=0) + radius for corners, radius in hulls])
    near = ROUNDING * float((high.max(axis=0) - low.min(axis=0)).max())
    around = [_around(corners, radius) for corners, radius in hulls]
    found = []
    for k in range(len(hulls)):
        meet = ((low <= high[k] + near) & (high >= low[k] - near)).all(axis=1)
        others = [i for i in np.flatnonzero(meet).tolist() if i != k]
        sides = [side for i in others for side in around[i]]
        for side in around[k]:
            shares = _cuts(side, sides, near)
            for a, b in zip(shares[:-1], shares[1:], strict=True):
                stretch = side.between(a, b)
                if stretch.length > near and not any(_covered(stretch, hulls[i], i < k, near) for i in others):
                    found.append(stretch)
    return found


def line(start: np.ndarray, end: np.ndarray) -> Stretch:
    """Return the straight line from `start` to `end` as a Stretch."""
    return Stretch(np.asarray(start, float), np.asarray(end, float), np.zeros(2), 0.0, 0.0, 0.0)


def _around(corners, radius):
    """Return the boundary of one rounded hull: sides moved outward by the radius, and arcs of up to a quarter turn.

    corners (k, 2) [px]; radius [px]. The result is a list of stretches.
    """
    if len(corners) == 1:
        bounds = [(k * math.pi / 2.0, math.pi / 2.0) for k in range(4)]
        return [_arc(corners[0], radius, first, turn) for first, turn in bounds]
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]
    found = []
    for k, normal in enumerate(normals):
        start, end = corners[k] + radius * normal, corners[(k + 1) % len(corners)] + radius * normal
        found.append(line(start, end))
        if radius > 0.0:
            after = normals[(k + 1) % len(corners)]
            first, last = math.atan2(normal[1], normal[0]), math.atan2(after[1], after[0])
            turn = (last - first) % math.tau
            count = max(1, math.ceil(turn / (math.pi / 2.0) - 1e-9))
            for i in range(count):
                found.append(_arc(corners[(k + 1) % len(corners)], radius, first + i * turn / count, turn / count))
    return [each for each in found if each.length > 0.0]


def _arc(center, radius, first, turn):
    ends = np.array([first, first + turn])
    start, end = center + radius * np.stack([np.cos(ends), np.sin(ends)], axis=1)
    return Stretch(start, end, np.asarray(center, float), radius, first, turn)


def _cuts(side, others, near):
    """Return the fractions of a line's or arc's length at which other ones start, end or cross it, and 0 and 1; sorted.

    side: the line or arc, a Stretch; others: the other Stretches; near [px]: a smaller distance counts as 0.
    """
    shares = [0.0, 1.0]
    for other in others:
        points = [other.start, other.end]
        if side.radius == 0.0:
            points += _line_meets(side, other)
        else:
            points += _arc_meets(side, other)
        shares += [_share(side, point, near) for point in points]
    kept = sorted(each for each in shares if 0.0 <= each <= 1.0)
    return [a for k, a in enumerate(kept) if k == 0 or a > kept[k - 1]]


def _share(side, point, near):
    """Return the fraction of a line's or arc's length at which a point is; -1 for a point beside it.

    side: the line or arc, a Stretch; near [px]: largest distance of the point from the infinite line or full circle; if
    it is farther, -1 is returned.
    """
    if side.radius == 0.0:
        along = side.end - side.start
        share = float((point - side.start) @ along / (along @ along))
        off = abs(along[0] * (point - side.start)[1] - along[1] * (point - side.start)[0]) / math.hypot(*along)
    else:
        x, y = (point - side.center).tolist()
        share = (math.atan2(y, x) - side.first) % math.tau / side.turn
        off = abs(math.hypot(x, y) - side.radius)
    return share if off <= near else -1.0


def _line_meets(side, other):
    """Return the points where the infinite line of a straight Stretch meets the line or circle of another Stretch.

    side: the straight Stretch; other: the other Stretch, a line or arc. The list has 0 to 2 points.
    """
    along = side.end - side.start
    if other.radius > 0.0:
        return _on_circle(side.start, along, other.center, other.radius)
    way = other.end - other.start
    cross = along[0] * way[1] - along[1] * way[0]
    if cross == 0.0:
        return []
    to = other.start - side.start
    return [side.start + (to[0] * way[1] - to[1] * way[0]) / cross * along]


def _arc_meets(side, other):
    """Return the points where the full circle of an arc meets the line or circle of another Stretch.

    side: the arc, a Stretch; other: the other Stretch, a line or arc. The list has 0 or 2 points.
    """
    if other.radius == 0.0:
        return _on_circle(other.start, other.end - other.start, side.center, side.radius)
    apart = other.center - side.center
    distance = math.hypot(*apart)
    if distance == 0.0:
        return []
    # The line through both intersections is perpendicular to the line of the centres.
    ahead = (distance * distance + side.radius * side.radius - other.radius * other.radius) / (2.0 * distance)
    foot = side.center + ahead / distance * apart
    return _on_circle(foot, np.array([-apart[1], apart[0]]), side.center, side.radius)


def _on_circle(start, along, center, radius):
    """Return the two points where a line meets a circle.

    If the line misses the circle, the point of the line nearest to the centre is returned twice. start, along: a point
    on the infinite line and the line's direction; center, radius: the circle.
    """
    length = math.hypot(*along)
    along = along / length
    ahead = float((center - start) @ along)
    foot = start + ahead * along
    half = math.sqrt(max(radius * radius - float((center - foot) @ (center - foot)), 0.0))
    return [foot - half * along, foot + half * along]


def _covered(stretch, hull, earlier, near):
    """Return whether another hull removes a section of one hull's boundary from the boundary of the union of hulls.

    A section inside the other hull is removed. A section on the other hull's boundary is removed if the two hulls are
    on opposite sides of it. If both are on the same side, it is kept only for the first of the two hulls. stretch: the
    section; hull: the other hull; earlier: whether the other hull comes first; near [px]: a smaller distance counts as
    0.
    """
    point = stretch.at(np.array([0.5]))[0]
    gap, normal = gap_and_normal(hull, point)
    if abs(gap) > near:
        return gap < 0.0
    if stretch.radius > 0.0:
        outward = (point - stretch.center) / stretch.radius
    else:
        along = stretch.end - stretch.start
        outward = np.array([along[1], -along[0]]) / math.hypot(*along)
    return bool(outward @ normal < 0.0) or earlier


def gap_and_normal(hull: Hull, point: np.ndarray) -> tuple[float, np.ndarray]:
    """Return (distance [px] of a point from a rounded hull, outward unit normal of the hull there).

    The distance is negative inside the hull.
    """
    corners, radius = hull
    if len(corners) == 1:
        away = point - corners[0]
        distance = math.hypot(*away)
        return distance - radius, away / distance if distance > 0.0 else np.array([1.0, 0.0])
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]
    to = point - corners
    over = (to * normals).sum(axis=1)
    if len(corners) > 2 and over.max() <= 0.0:
        return float(over.max()) - radius, normals[over.argmax()]
    share = np.clip((to * sides).sum(axis=1) / (sides * sides).sum(axis=1), 0.0, 1.0)
    away = to - share[:, None] * sides
    distance = np.hypot(*away.T)
    k = int(distance.argmin())
    # If the point is on a side within rounding errors, the side's normal is used.
    flat = distance[k] <= ROUNDING * float(np.abs(sides).max())
    return float(distance[k]) - radius, normals[k] if flat else away[k] / distance[k]


# ---- moments ---------------------------------------------------------------------------------------------------------
# Area, centre and inertia of the inside of a boundary of lines and arcs: integrals along the boundary (Green's theorem)
# by Gaussian quadrature, exact up to rounding.

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
NODES, WEIGHTS = (NODES + 1.0) / 2.0, WEIGHTS / 2.0  # over 0..1; the error for a quarter turn is below rounding


class Moments(NamedTuple):
    """Area, centre of area and moment of inertia of a figure of density 1."""

    area: float  # [px2]
    x: float  # centre of area [px]; nan without area
    y: float
    inertia: float  # moment of inertia about the centre [px4]


def moments(around: Sequence[Stretch]) -> Moments:
    """Return the Moments of the figure inside a closed boundary.

    If the area is 0, the centre is nan and the inertia 0. around: lines and arcs of the boundary.
    """
    if not around:
        return Moments(0.0, math.nan, math.nan, 0.0)
    base = around[0].start  # integrals about a nearby point, which are precise far from the raster's corner
    place, step = nodes(around)
    x, y, dx, dy = *(place - base).transpose(2, 0, 1), *step.transpose(2, 0, 1)
    area = float((((x * dy - y * dx) / 2.0) @ WEIGHTS).sum())
    if area <= 0.0:
        return Moments(0.0, math.nan, math.nan, 0.0)
    center_x, center_y = (float((each @ WEIGHTS).sum()) / area for each in (x * x * dy / 2.0, -y * y * dx / 2.0))
    x, y = x - center_x, y - center_y
    inertia = float(((x * x * x * dy - y * y * y * dx) @ WEIGHTS).sum()) / 3.0
    return Moments(area, float(base[0]) + center_x, float(base[1]) + center_y, inertia)


def nodes(around: Sequence[Stretch]) -> tuple[np.ndarray, np.ndarray]:
    """Return (quadrature points on n stretches, derivatives of position there), both (n, 16, 2) [px].

    The derivatives are with respect to the fraction of a stretch's length, which is 0 at its start and 1 at its end.
    around: the stretches.
    """
    place = np.array([each.at(NODES) for each in around])
    step = np.empty_like(place)
    for k, each in enumerate(around):
        if each.radius == 0.0:
            step[k] = each.end - each.start
        else:
            out = place[k] - each.center
            step[k] = each.turn * np.stack([-out[:, 1], out[:, 0]], axis=1)
    return place, step


# ---- hausdorff -------------------------------------------------------------------------------------------------------
# Hausdorff distance of two boundaries of lines and arcs, by branch and bound: exact to NEAR.
#
# A stretch is halved as long as it may contain a point farther from the other boundary than the farthest point found so
# far. There are two upper bounds for the distance of a stretch's points. The first is the distance of its middle plus
# half its length. The second uses its ends: along a straight stretch the distance from one line of the other boundary
# is convex, so it is largest at an end; for an arc the height above its chord is added.

NEAR = 1e-6  # [px] largest error
ROWS = 1 << 20  # distances computed in one array operation: bounds the memory


def hausdorff(a: Sequence[Stretch], b: Sequence[Stretch]) -> float:
    """Return the Hausdorff distance [px] of two boundaries: the largest distance of a point of one from the other one.

    The result is at most 1e-6 px too small. The result is 0 if both boundaries are empty, inf if only one is empty.
    """
    if not a or not b:
        return 0.0 if not a and not b else math.inf
    return max(_farthest(a, b, 0.0), _farthest(b, a, 0.0))


class _Figure:
    """Lines and arcs of a boundary as arrays, from which the distances of many points are computed at once."""

    def __init__(self, stretches):
        lines = [each for each in stretches if each.radius == 0.0]
        self.start = np.array([each.start for each in lines]).reshape(-1, 2)
        self.along = np.array([each.end for each in lines]).reshape(-1, 2) - self.start
        arcs = [each for each in stretches if each.radius > 0.0]
        self.center = np.array([each.center for each in arcs]).reshape(-1, 2)
        self.radius, self.first, self.turn = (
            np.array([getattr(each, name) for each in arcs]) for name in ("radius", "first", "turn")
        )
        self.ends = np.array([[each.start, each.end] for each in arcs]).reshape(-1, 2, 2)

    def from_lines(self, points):
        """Return the distance [px] of each point (m, 2) from each line of the boundary: (m, lines)."""
        to = points[:, None] - self.start
        share = np.clip((to * self.along).sum(axis=2) / (self.along * self.along).sum(axis=1), 0.0, 1.0)
        return np.hypot(*(to - share[:, :, None] * self.along).transpose(2, 0, 1))

    def from_arcs(self, points):
        """Return the distance (m,) [px] of each point (m, 2) from the nearest arc of the boundary; inf without arcs."""
        if not len(self.center):
            return np.full(len(points), math.inf)
        to = points[:, None] - self.center
        angle = (np.arctan2(to[:, :, 1], to[:, :, 0]) - self.first) % math.tau
        round_one = np.where(angle <= self.turn, np.abs(np.hypot(*to.transpose(2, 0, 1)) - self.radius), math.inf)
        corners = np.hypot(*(points[:, None, None] - self.ends).transpose(3, 0, 1, 2)).min(axis=2)
        return np.minimum(round_one, corners).min(axis=1)


def _farthest(a, b, best):
    other = _Figure(b)
    rows = max(1, ROWS // (len(b) + 1))
    todo = list(a)
    while todo:
        left = []
        for first in range(0, len(todo), rows):
            some = todo[first : first + rows]
            best, open_ones = _looked_at(some, other, best)
            left += open_ones
        todo = [
            half
            for bound, each in left
            if bound > best + NEAR
            for half in (each.between(0.0, 0.5), each.between(0.5, 1.0))
        ]
    return best


def _looked_at(some, other, best):
    """Measure distances of lines and arcs from another boundary, at their ends and middles.

    Return (largest distance [px] found so far, list of the lines and arcs to divide). A line or arc must be divided if
    it may contain a point with a larger distance. It is listed as (upper bound [px] of its distance, Stretch). some:
    the lines and arcs; other: _Figure of the other boundary; best [px]: largest distance found before.
    """
    points = np.array([each.at(np.array([0.0, 0.5, 1.0])) for each in some])
    lines = other.from_lines(points.reshape(-1, 2)).reshape(len(some), 3, -1)
    nearest = np.minimum(lines.min(axis=2, initial=math.inf), other.from_arcs(points.reshape(-1, 2)).reshape(-1, 3))
    best = max(best, float(nearest.max()))
    length = np.array([each.length for each in some])
    height = np.array([each.radius * (1.0 - math.cos(each.turn / 2.0)) for each in some])
    by_ends = np.maximum(lines[:, 0], lines[:, 2]).min(axis=1, initial=math.inf) + height
    bound = np.minimum(nearest[:, 1] + length / 2.0, by_ends)
    return best, [(bound[k], some[k]) for k in np.flatnonzero(bound > best + NEAR).tolist()]


# ---- cells -----------------------------------------------------------------------------------------------------------
# Pixels of several masks on a common grid of unequal columns and rows (cells), and integrals over these cells: area,
# first and second moments, of all cells or of the part of the cells inside a boundary. Exact up to rounding.
#
# Integrals over the part inside a boundary are taken along the boundary (Green's theorem), which is cut at the lines of
# the grid. The integrand at a point is the integral over the solid cells to the left of the point in the point's row.

Placed = tuple[np.ndarray, float, float]  # solid[row, col] bool; left, top [px] of its top left corner
Box = tuple[float, float, float, float]  # left, top, right, bottom [px]


class Cells(NamedTuple):
    """Grid of columns and rows of unequal size, whose lines are the pixel edges of several masks."""

    x: np.ndarray  # (w + 1,) lines between columns [px], ascending
    y: np.ndarray  # (h + 1,) lines between rows
    count: np.ndarray  # (h, w) number of masks with a solid pixel in each cell


class Sums(NamedTuple):
    """Area, first moments and second moment of a figure about a base point."""

    area: float  # [px2]
    x: float  # integral of x [px3]
    y: float  # integral of y
    second: float  # integral of the squared distance from the base [px4]

    def plus(self, other: "Sums", share: float = 1.0) -> "Sums":
        """Return the sum of these Sums and `share` times `other`. Both must have the same base point."""
        return Sums(*(a + share * b for a, b in zip(self, other, strict=True)))

    def moments(self, base: tuple[float, float]) -> Moments:
        """Return the Moments of the figure: area, centre and inertia. base [px]: base point of these Sums."""
        if self.area <= 0.0:
            return Moments(0.0, math.nan, math.nan, 0.0)
        x, y = self.x / self.area, self.y / self.area
        return Moments(self.area, base[0] + x, base[1] + y, self.second - self.area * (x * x + y * y))


NO_SUMS = Sums(0.0, 0.0, 0.0, 0.0)


def sums_of(found: Moments, base: tuple[float, float]) -> Sums:
    """Return the Sums of a figure about the base point [px], computed from its Moments `found`."""
    if found.area == 0.0:
        return NO_SUMS
    x, y = found.x - base[0], found.y - base[1]
    return Sums(found.area, found.area * x, found.area * y, found.inertia + found.area * (x * x + y * y))


def cells_of(masks: Sequence[Placed], window: Box) -> Cells:
    """Return Cells with the pixels of several masks inside a window (left, top, right, bottom) [px].

    masks: [(solid[row, col] bool, left, top)]; left, top [px]: position of the mask's top left corner.
    """
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
    """Return, for each gap between adjacent grid lines, the row (or column) of a mask in the gap; -1 outside the mask.

    lines [px]: positions of the grid lines; first [px]: position of the mask's first row (or column); size: number of
    its rows (or columns).
    """
    place = np.floor((lines[:-1] + lines[1:]) / 2.0 - first).astype(np.int64)
    return np.where((place >= 0) & (place < size), place, -1)


def cell_sums(cells: Cells, weights: np.ndarray, base: tuple[float, float]) -> Sums:
    """Return the Sums of all cells about the base point [px]. weights (h, w): density of each cell."""
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
    """Return the Sums about the base point [px] of the solid area inside a closed boundary.

    A cell is solid if at least one mask has a solid pixel there. around: lines and arcs of the boundary.
    """
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
    """Return the integral of x ** power over the solid cells to the left of each point, in the point's row: (n, 16).

    base [px]: x of the base point; row, column (n,): cells of the points; x (n, 16) [px]: positions of the points
    relative to `base`.
    """
    lines = cells.x - base
    filled = np.pad(cells.count > 0, ((0, 0), (0, 1)))  # there is no cell to the right of the last line
    whole = lines ** (power + 1) / (power + 1)
    left = np.zeros((len(filled), len(lines)))
    left[:, 1:] = np.cumsum(np.where(filled[:, :-1], np.diff(whole), 0.0), axis=1)
    part = np.where(filled[row, column][:, None], x ** (power + 1) / (power + 1) - whole[column][:, None], 0.0)
    return left[row, column][:, None] + part


def _cut_by_lines(stretch, cells):
    """Return the parts of a line or arc (Stretch) after cutting it at all grid lines that it crosses.

    Each part is in one column and one row of cells.
    """
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


# ---- measure ---------------------------------------------------------------------------------------------------------
# Accuracy of hulls that replace pixels: excess and missing area, and moments.
#
# The union of the hulls is compared with the union of the pixels' squares. All areas and moments are integrals along
# the boundary of the union of the hulls by Gaussian quadrature, exact up to rounding; for the shared area see "cells"
# above.


class Measured(NamedTuple):
    """Accuracy of hulls that replace the pixels of a mask."""

    over: float  # area of the hulls outside the pixels [px2]
    missed: float  # area of the pixels outside the hulls [px2]
    hulls: Moments  # moments of the union of the hulls
    pixels: Moments  # moments of the union of the pixel squares
    hausdorff: float  # Hausdorff distance of the two boundaries [px]: 0 if both are empty, inf if one is empty


def measured(solid: np.ndarray, hulls: Sequence[Hull]) -> Measured:
    """Return how accurately hulls replace the pixels solid[row, col] bool.

    hulls: [(corners (k, 2) [px] clockwise on the screen, radius [px])] in raster pixels.
    """
    around = boundary(hulls)
    cracks = edges(solid)
    ours, theirs = moments(around), _of_pixels(solid)
    height, width = solid.shape
    cells = Cells(np.arange(width + 1.0), np.arange(height + 1.0), solid.astype(np.int64))
    both = shared_sums(around, cells, (0.0, 0.0)).area
    return Measured(max(ours.area - both, 0.0), max(theirs.area - both, 0.0), ours, theirs, hausdorff(around, cracks))


def edges(solid: np.ndarray) -> list[Stretch]:
    """Return the edges between solid and clear pixels as straight stretches, with the solid side on the right."""
    loops = [loop.corners for piece in contours(solid) for loop in (piece.outer, *piece.holes)]
    return [line(a, b) for loop in loops for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True)]


def _of_pixels(solid):
    rows, columns = np.nonzero(solid)
    if not len(rows):
        return Moments(0.0, math.nan, math.nan, 0.0)
    x, y = columns + 0.5, rows + 0.5
    second = ((x - x.mean()) ** 2 + (y - y.mean()) ** 2).sum() + len(rows) / 6.0
    return Moments(float(len(rows)), float(x.mean()), float(y.mean()), float(second))
