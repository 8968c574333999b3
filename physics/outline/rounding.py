"""Round pieces as few corners and a radius: a disc is one corner, a pill two, a rounded box four.

A body that rolls on a polygon loses speed at every corner; on a rounded one it does not. Candidates are made from the
symmetry of the piece (disc, pill) and by moving the sides of its outline inward (others); each is measured against the
cracks, and the first with the fewest corners that keeps to the contract of fitting.outline is taken.
"""

import math

import numpy as np

from physics.outline.contour import LARGEST_REACH, Loop, doubled_area, sharp
from physics.outline.simple_shapes import convex_hull, fewer_sides
from physics.settings import MAX_CORNERS

# What pygame.draw.circle draws misses the contract by a hair: from a radius of 24 px on no disc keeps to it, and those
# of 6, 16 and 20 only touch it. A polygon in its place would lose speed at every corner.
DISC_CLEAR = 0.2  # [px] how deep in a disc a clear pixel's centre may lie, and …
DISC_SPARE = 0.13  # [px] … by how much a disc may be farther from the cracks, and they from it
REACHED = 0.21  # [px] as FARTHEST, of the contract
INSIDE = 0.001  # [px] how far inside solid pixels' centres lie at least
LEAST_RADIUS = 1.0  # [px] a smaller rounding is not seen in pixels
FARTHEST = 0.2  # [px] by how much a crack may be farther from the outline than an outline from the cracks
SPACING = 0.01  # [px] between the points of a boundary that are measured
SLACK = 0.005  # [px] what may lie between two of them
RADII = 12  # radii that are tried for a core of several corners
TRIES = (400, 24)  # moves of a core that are tried: of a disc or capsule; of others, for each corner
ROOM = 0.04  # [px] between the least and the greatest radius: enough, no need to move corners on
STEPS = (0.5, 0.25, 0.12, 0.06, 0.03)  # [px] by which the corners of a core are moved to make it fit

Core = tuple[np.ndarray, float]  # corners (k, 2) clockwise on the screen [px], radius [px]


def rounded_core(outer: np.ndarray, cracks: Loop, smooth: float) -> Core | None:
    """A convex core of 1 to 16 corners and the radius that it is grown by, for one piece without holes; or None.

    outer (n, 2): its outline; cracks: the crack loop that this came from; smooth [px], all as in fitting.outline. One
    corner is a disc, two are a capsule. The boundary keeps to the same contract: within smooth of the cracks and they
    within smooth + 0.21 of it, pixels' centres on their sides. Of a disc a clear centre may be 0.2 px inside, and the
    boundary and the cracks 0.13 px farther from each other. None for a piece with a corner that must stay sharp,
    and where rounding does not save corners. Fewest corners first; of several,
    those that keep the outline's sides.
    """
    if smooth <= 0.0 or sharp(cracks).any() or cracks.joined.any():
        return None
    judge = _Judge(cracks.corners, min(smooth, LARGEST_REACH))
    hull = convex_hull(judge.inside)
    if len(hull) > 2 and _beyond(hull, judge.outside).min() <= 0.0:
        return None  # no convex figure parts the centres
    for core in _round_ones(outer, judge.corners):
        if len(core) == 1 and (found := judge.disc(core)) is not None:
            return found
        found = judge.fitted(core)
        if found is not None:
            return found
    return _several(outer, judge)


def _round_ones(outer, corners):
    """Discs and capsules about the middle of the bounds and the centre of area."""
    area, center, axis = _moments(corners.astype(float))
    yield (corners.min(axis=0) + corners.max(axis=0))[None] / 2.0
    yield center[None]
    across = np.array([-axis[1], axis[0]])
    along, aside = outer @ axis, outer @ across
    middle = axis * (along.min() + along.max()) / 2.0 + across * (aside.min() + aside.max()) / 2.0
    radius = np.ptp(aside) / 2.0
    # The line between the ends that has the piece's length, or its area.
    for half in (np.ptp(along) / 2.0 - radius, (area - math.pi * radius * radius) / (4.0 * radius)):
        if half > 0.0:
            ends = np.stack([middle - half * axis, middle + half * axis])
            yield ends[np.lexsort((ends[:, 0], ends[:, 1]))]


def _several(outer, judge):
    """The sides of the outline moved inward by a radius, as few as do.

    Those that grow back to where they were come first, the least radius before others: faces that stand out a little
    let stacks rise, and round corners tip early. Sides that must move to suit the cracks are taken where they save
    corners; of those the largest radius.
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
    """Area, centre and the direction of the longer axis of a loop."""
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
    # Of a loop that is symmetrical the axis is exact: xy is 0, or xx equals yy.
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    return area, base + center, np.array([math.cos(angle), math.sin(angle)])


def _normals(corners):
    sides = np.roll(corners, -1, axis=0) - corners
    return np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]


def _widest(hull):
    """About the radius of the largest disc inside, by halving."""
    low, high = 0.0, float(np.ptp(hull, axis=0).min()) / 2.0
    for _ in range(12):
        middle = (low + high) / 2.0
        low, high = (middle, high) if len(_inset(hull, middle)) > 2 else (low, middle)
    return low


def _inset(hull, radius):
    """What is left of a convex polygon when each side moves inward by a radius: clipped side by side."""
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
    """The contract of one crack loop: what a rounded core has to keep to."""

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
        # Which cracks there are, by their left or upper end: to be found from any place near.
        self.low = corners.min(axis=0) - 2
        size = corners.max(axis=0) - self.low + 3
        self.across, self.down = np.zeros(size, bool), np.zeros(size, bool)
        ends = np.minimum(starts, starts + signs) - self.low
        level = signs[:, 1] == 0
        self.across[tuple(ends[level].T)] = True
        self.down[tuple(ends[~level].T)] = True

    def fitted(self, core):
        """A core, its corners moved a little where they must be, with the radius that suits it best; or None."""
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
        """A core with this very radius, where it keeps to the contract; or None."""
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
        """The least disc about a centre that holds all solid centres, where it is near enough; or None."""
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
        """Between how far radii a core has all centres on their sides; negative: there are none."""
        return _beyond(core, self.outside).min() - _beyond(core, self.inside).max()

    def _measured(self, core):
        """A core and the radius that gives it the pixels' area, as far as the contract lets; or None."""
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
        """Distance of points (m, 2) from the nearest crack, if that is less than 1 px."""
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
    """How far points (m, 2) lie outside of a core; negative: how deep inside [px]."""
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
    """Ways to move a core (m, k, 2): each corner right and down; a line also longer and turned."""
    moves = np.eye(core.size).reshape(-1, *core.shape)
    if len(core) != 2 or (core[0] == core[1]).all():
        return moves
    along = (core[1] - core[0]) / np.hypot(*(core[1] - core[0]))
    across = np.array([-along[1], along[0]])
    return np.concatenate([[(-along, along), (-across, across), (along, along), (across, across)], moves])


def _convex(core):
    """Whether three corners or more turn clockwise on the screen at each, and no two are one."""
    sides = np.roll(core, -1, axis=0) - core
    after = np.roll(sides, -1, axis=0)
    if np.hypot(*sides.T).min() < SLACK and len(core) > 1:
        return False
    return len(core) < 3 or (sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]).min() > 0.0


def _boundary(core, radius, spacing):
    """Points around a core grown by a radius, at most spacing apart [px]."""
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
