"""Approximation of round pieces of masks by a core polygon with few corners and a rounding radius.

The core of a disc has one corner, the core of a rounded box has four. Rounded bodies roll without loss, while a body
that rolls as a polygon loses speed at every corner. Candidate cores are made from the symmetry of the piece (discs,
capsules), and by moving the sides of its outline inward (other cores). Each candidate is compared with the edges of the
pixels. The core with the fewest corners within the tolerances of contour.outline is used.
"""

import math

import numpy as np

from physics.outline.contour import LARGEST_REACH, Loop, doubled_area, sharp, smoothed
from physics.outline.simple_shapes import convex_hull, fewer_sides
from physics.settings import MAX_CORNERS

# The discs of pygame.draw.circle exceed the tolerances of contour.outline a little: all discs with a radius of 24 px or
# more do, and discs of 6, 16 and 20 px are only just within. A polygon in their place would lose speed at every corner.
DISC_CLEAR = 0.2  # [px] largest depth of a clear pixel's centre in a disc, and …
DISC_SPARE = 0.13  # [px] … additional distance allowed between a disc and the cracks
REACHED = 0.21  # [px] as FARTHEST, but the full value of contour.outline
INSIDE = 0.001  # [px] least depth of solid pixels' centres in the figure
LEAST_RADIUS = 1.0  # [px] smaller roundings are invisible in pixels
FARTHEST = 0.2  # [px] a crack may be this much farther from the outline than the outline may be from the cracks
SPACING = 0.01  # [px] between the measured points of a boundary
SLACK = 0.005  # [px] largest error of distances between two such points
RADII = 12  # number of radii tried for a core of several corners
TRIES = (400, 24)  # number of moves tried: for a disc or capsule; for other cores, per corner
ROOM = 0.04  # [px] once a core allows radii over this range, its corners are not moved further
STEPS = (0.5, 0.25, 0.12, 0.06, 0.03)  # [px] distances by which the corners of a core are moved

Core = tuple[np.ndarray, float]  # corners (k, 2) clockwise on the screen [px], radius [px]


def rounded_core(cracks: Loop, smooth: float) -> Core | None:
    """Return (convex corners, radius) of a rounded core that replaces one piece of pixels without holes, or None.

    The core has 1 to 16 corners: 1 is a disc, 2 are a capsule. The boundary of the rounded core is within `smooth` of
    the pixel edges, and the pixel edges are within smooth + 0.21 of the boundary. Centres of solid pixels are inside,
    centres of clear pixels outside. For a disc both distances may be 0.13 px larger, and centres of clear pixels may be
    up to 0.2 px inside.

    None is returned if no core is accurate enough, or if the piece has a sharp corner. None is also returned if a
    polygon without rounding needs no more corners. Otherwise the core with the fewest corners is returned. Of several
    such cores, one with sides on the sides of the outline is preferred. cracks: loop of pixel edges around the piece;
    smooth [px]: largest distance of the outline from the pixels' edges.
    """
    if smooth <= 0.0 or sharp(cracks).any() or cracks.joined.any():
        return None
    judge = _Judge(cracks.corners, min(smooth, LARGEST_REACH))
    outer = smoothed(cracks, min(smooth, LARGEST_REACH), curves=False)
    hull = convex_hull(judge.inside)
    if len(hull) > 2 and _beyond(hull, judge.outside).min() <= 0.0:
        return None  # no convex figure separates the centres
    for core in _round_ones(outer, judge.corners):
        if len(core) == 1 and (found := judge.disc(core)) is not None:
            return found
        found = judge.fitted(core)
        if found is not None:
            return found
    return _several(outer, judge)


def _round_ones(outer, corners):
    """Yield candidate cores, corners (k, 2) [px]: the centres of two discs, then the lines of up to two capsules.

    The discs have the centre of the bounding box and the centre of area. outer (n, 2): outline of the piece; corners
    (m, 2): corners of its pixel edges.
    """
    area, center, axis = _moments(corners.astype(float))
    yield (corners.min(axis=0) + corners.max(axis=0))[None] / 2.0
    yield center[None]
    across = np.array([-axis[1], axis[0]])
    along, aside = outer @ axis, outer @ across
    middle = axis * (along.min() + along.max()) / 2.0 + across * (aside.min() + aside.max()) / 2.0
    radius = np.ptp(aside) / 2.0
    # Half the length of the capsule's line, so that the capsule has the length of the piece, or the area of the piece.
    for half in (np.ptp(along) / 2.0 - radius, (area - math.pi * radius * radius) / (4.0 * radius)):
        if half > 0.0:
            ends = np.stack([middle - half * axis, middle + half * axis])
            yield ends[np.lexsort((ends[:, 0], ends[:, 1]))]


def _several(outer, judge):
    """Return (core, radius) with the fewest corners, made by moving the outline's sides inward by a radius; or None.

    First, each core is rounded by exactly this radius, so that its sides are on the outline's sides; the smallest
    radius is tried first. Other radii and moved corners are tried later, the largest radius first, and used only if
    they save corners: they may move sides outward, which raises stacks, or make corners rounder, which lets stacks tip
    early. outer (n, 2): the outline; judge: _Judge.
    """
    hull = convex_hull(outer)
    radii = np.linspace(1.0, 0.0, RADII, endpoint=False) * _widest(hull)
    radii = radii[radii >= LEAST_RADIUS]
    best, most = None, min(len(outer) - 1, MAX_CORNERS)
    for fit, tried in ((judge.grown, radii[::-1]), (lambda core, _: judge.fitted(core), radii)):
        for radius in tried:
            core = _inset(hull, radius)
            for count in range(3, min(most, len(core)) + 1):
                fewer = fewer_sides(core, count)
                found = fit(fewer, radius) if len(fewer) == count else None
                if found is not None:
                    best, most = found, count - 1
                    break
    return best


def _moments(corners):
    """Return (area [px2], centre [px], unit vector of the longer principal axis) of a polygon, corners (n, 2) [px]."""
    area = doubled_area(corners) / 2.0
    base = corners.mean(axis=0)
    p = corners - base
    q = np.roll(p, -1, axis=0)
    weight = (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / (2.0 * area)
    center = ((p + q) * weight[:, None]).sum(axis=0) / 3.0
    p, q = p - center, q - center
    weight = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    xx, yy = ((p * p + p * q + q * q) * weight[:, None]).sum(axis=0)
    xy = ((p[:, 0] * q[:, 1] + q[:, 0] * p[:, 1]) / 2.0 + p[:, 0] * p[:, 1] + q[:, 0] * q[:, 1]) @ weight
    # For a symmetrical loop the axis is exact, because xy is 0 or xx equals yy.
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    return area, base + center, np.array([math.cos(angle), math.sin(angle)])


def _normals(corners):
    sides = np.roll(corners, -1, axis=0) - corners
    return np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]


def _widest(hull):
    """Return the radius [px] of the largest disc inside a convex polygon, found approximately by bisection."""
    low, high = 0.0, float(np.ptp(hull, axis=0).min()) / 2.0
    for _ in range(12):
        middle = (low + high) / 2.0
        low, high = (middle, high) if len(_inset(hull, middle)) > 2 else (low, middle)
    return low


def _inset(hull, radius):
    """Return a convex polygon with its sides moved inward by a radius [px].

    hull (n, 2) [px]: corners of the polygon. If no area remains, the result has fewer than 3 corners.
    """
    left = hull
    for corner, normal in zip(hull, _normals(hull), strict=True):
        over = (left - corner) @ normal + radius
        if (over <= 0.0).all():
            continue
        after = np.roll(over, -1)
        crossed = (over < 0.0) & (after > 0.0) | (over > 0.0) & (after < 0.0)
        share = over / np.where(crossed, over - after, 1.0)
        cut = left + share[:, None] * (np.roll(left, -1, axis=0) - left)
        left = np.stack([left, cut], axis=1)[np.stack([over <= 0.0, crossed], axis=1)]
        if len(left) < 3:
            break
    sides = np.hypot(*(np.roll(left, -1, axis=0) - left).T)
    return left[sides > 1e-9 * np.ptp(hull)]


class _Judge:
    """Tests of whether a rounded polygon (core) can replace one connected piece of pixels, within tolerances.

    A core is an array of corners (k, 2) [px], to which a rounding radius is added. The tests measure the distance of
    its boundary from the edges of the piece's pixels. They also check that centres of solid pixels are inside and
    centres of clear pixels outside.
    """

    def __init__(self, corners, reach):
        self.corners, self.reach = corners, reach
        runs = np.roll(corners, -1, axis=0) - corners
        lengths = np.abs(runs).sum(axis=1)
        signs = np.repeat(np.sign(runs), lengths, axis=0)
        steps = np.arange(len(signs)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        starts = np.repeat(corners, lengths, axis=0) + signs * steps[:, None]
        inward = np.stack([-signs[:, 1], signs[:, 0]], axis=1)
        self.inside, self.outside = (starts + signs / 2.0 + side * inward / 2.0 for side in (1, -1))
        shares = np.arange(0.0, 1.0, 0.125)[:, None, None]
        self.points = (starts + shares * signs).reshape(-1, 2)
        # Whether a crack has its left or upper end in a cell, for a search from nearby points.
        self.low = corners.min(axis=0) - 2
        size = corners.max(axis=0) - self.low + 3
        self.across, self.down = np.zeros(size, bool), np.zeros(size, bool)
        ends = np.minimum(starts, starts + signs) - self.low
        level = signs[:, 1] == 0
        self.across[tuple(ends[level].T)] = True
        self.down[tuple(ends[~level].T)] = True

    def fitted(self, core):
        """Return (core, radius) within the tolerances, or None if none is found.

        The radius is computed, and the corners are moved if necessary. core (k, 2) [px]: corners with which the search
        starts.
        """
        room = self._room(core)
        found = self._measured(core) if room > 0.0 else None
        if found is not None or room < (-1.0 if len(core) < 3 else -0.1):
            return found
        tries = TRIES[0] if len(core) < 3 else TRIES[1] * len(core)
        for step in STEPS:
            moved = True
            while moved and tries > 0 and room < ROOM:
                moved = False
                for move in _moves(core):
                    for change in (step * move, -step * move):
                        tries -= 1
                        new = self._room(core + change)
                        if new > room + 1e-9:
                            core, room, moved = core + change, new, True
                            break
        return self._measured(core) if room > 0.0 else None

    def grown(self, core, radius):
        """Return (core, radius) if the core, rounded by this radius [px], is within the tolerances, else None."""
        points = _beyond(core, self.points)
        low = max(_beyond(core, self.inside).max(), points.max() - self.reach - FARTHEST)
        high = min(_beyond(core, self.outside).min(), points.min() + self.reach + FARTHEST)
        if not (low + INSIDE <= radius <= high - INSIDE and _convex(core)):
            return None
        for spacing in (20.0 * SPACING, SPACING):
            if self._from_cracks(_boundary(core, radius, spacing)).max() > self.reach - SLACK:
                return None
        return core, float(radius)

    def disc(self, core):
        """Return (centre, radius) of a disc around a given point that is within the tolerances, or None.

        If no radius separates the centres of solid and clear pixels, the smallest disc with all centres of solid pixels
        is tried. core (1, 2) [px]: the given point.
        """
        if self._room(core) > 0.0:
            return self._measured(core)
        radius = _beyond(core, self.inside).max() + INSIDE
        points, clear = _beyond(core, self.points), _beyond(core, self.outside)
        if radius < LEAST_RADIUS or radius - clear.min() > DISC_CLEAR:
            return None
        if max(radius - points.min(), points.max() - radius) > self.reach + REACHED + DISC_SPARE:
            return None
        off = self._from_cracks(_boundary(core, radius, SPACING)).max()
        return (core, float(radius)) if off <= self.reach + DISC_SPARE - SLACK else None

    def _room(self, core):
        """Return the length [px] of the range of radii with centres of solid pixels inside and of clear pixels outside.

        A negative result means that no radius separates these centres. core (k, 2) [px]: polygon to which the radius is
        added.
        """
        return _beyond(core, self.outside).min() - _beyond(core, self.inside).max()

    def _measured(self, core):
        """Return (core, radius) with the radius at which the core's area is nearest to the pixels' area, or None.

        The radius is limited by the tolerances; None means that no radius is within them. core (k, 2) [px].
        """
        if not _convex(core):
            return None
        points = _beyond(core, self.points)
        low = max(_beyond(core, self.inside).max(), points.max() - self.reach - FARTHEST)
        high = min(_beyond(core, self.outside).min(), points.min() + self.reach + FARTHEST)
        around = np.hypot(*(np.roll(core, -1, axis=0) - core).T).sum()
        missing = doubled_area(self.corners) / 2.0 - doubled_area(core) / 2.0
        radius = (math.sqrt(max(around * around + 4.0 * math.pi * missing, 0.0)) - around) / math.tau
        radius = min(max(radius, low + 0.25 * (high - low)), high - 0.25 * (high - low))
        if low >= high or radius < LEAST_RADIUS:
            return None
        for spacing in (20.0 * SPACING, SPACING):
            if self._from_cracks(_boundary(core, radius, spacing)).max() > self.reach - SLACK:
                return None
        return core, float(radius)

    def _from_cracks(self, points):
        """Return the distance (m,) [px] of points (m, 2) from the nearest pixel edge.

        Distances below 1 px are exact. Larger ones may be too large, even inf.
        """
        cells = np.floor(points).astype(np.int64)
        least = np.full(len(points), math.inf)
        for axis, cracks in enumerate((self.across, self.down)):
            for right in (-1, 0, 1):
                for below in (-1, 0, 1):
                    start = cells + (right, below)
                    there = np.clip(start - self.low, 0, np.array(cracks.shape) - 1)
                    offset = points - start
                    offset[:, axis] -= np.clip(offset[:, axis], 0.0, 1.0)
                    distance = np.where(cracks[tuple(there.T)], np.hypot(*offset.T), math.inf)
                    least = np.minimum(least, distance)
        return least


def _beyond(core, points):
    """Return the distance (m,) [px] of points (m, 2) from a core (k, 2), not rounded; negative inside the core."""
    if len(core) == 1:
        return np.hypot(*(points - core[0]).T)
    sides = np.roll(core, -1, axis=0) - core
    to = points[:, None] - core
    share = np.clip((to * sides).sum(axis=2) / np.maximum((sides * sides).sum(axis=1), 1e-300), 0.0, 1.0)
    gap = np.hypot(*(to - share[:, :, None] * sides).transpose(2, 0, 1)).min(axis=1)
    if len(core) == 2:
        return gap
    within = (sides[:, 0] * to[:, :, 1] - sides[:, 1] * to[:, :, 0]).min(axis=1) > 0.0
    return np.where(within, -gap, gap)


def _moves(core):
    """Return the displacements (m, k, 2) of the k corners of a core that are tried in the search for a better core.

    Each corner alone is moved to the right, and moved down. A core of two corners is also lengthened, rotated, and
    shifted along and across its line.
    """
    moves = np.eye(core.size).reshape(-1, *core.shape)
    if len(core) != 2 or (core[0] == core[1]).all():
        return moves
    along = (core[1] - core[0]) / np.hypot(*(core[1] - core[0]))
    across = np.array([-along[1], along[0]])
    return np.concatenate([[(-along, along), (-across, across), (along, along), (across, across)], moves])


def _convex(core):
    """Return whether a core, corners (k, 2), is convex and clockwise on the screen, without equal adjacent corners."""
    sides = np.roll(core, -1, axis=0) - core
    after = np.roll(sides, -1, axis=0)
    if np.hypot(*sides.T).min() < SLACK and len(core) > 1:
        return False
    return len(core) < 3 or (sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]).min() > 0.0


def _boundary(core, radius, spacing):
    """Return points (m, 2) [px] on the boundary of a core rounded by a radius, at most about `spacing` px apart."""
    if len(core) == 1:
        angles = np.arange(0.0, math.tau, spacing / radius)
        return core + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    normals = _normals(core)
    found = []
    for k in range(len(core)):
        corner, following, normal = core[k], core[(k + 1) % len(core)], normals[k]
        count = int(np.hypot(*(following - corner)) / spacing) + 2
        found.append(corner + np.linspace(0.0, 1.0, count)[:, None] * (following - corner) + radius * normal)
        first, last = (math.atan2(each[1], each[0]) for each in (normals[k - 1], normal))
        turn = (last - first) % math.tau
        angles = first + np.linspace(0.0, turn, int(turn * radius / spacing) + 2)
        found.append(corner + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    return np.concatenate(found)
