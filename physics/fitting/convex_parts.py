"""A polygon with holes in few convex parts, cut between its corners.

Holes are bridged, rings of more than LARGEST corners halved by short cuts, what is left cut into the fewest pieces
(fewest_convex), and pieces that are convex together joined over the bridges and halvings (Hertel and Mehlhorn 1983).
With no holes and few corners the count is the least that cuts between corners can reach; else near it.
"""

from collections.abc import Sequence

import numpy as np

from physics.fitting.bridges import bridged
from physics.fitting.fewest_convex import fewest_convex
from physics.fitting.shave import shaved
from physics.fitting.sight import Ring, cross
from physics.fitting.simple_polygon import FLAT, simple_rings
from physics.settings import MAX_CORNERS

LARGEST = 40  # corners of a ring that is cut the best way: that takes the cube of them, 20 ms for 40
TRIED = 256  # halvings looked at together, shortest first
STARTS = 128  # reflex corners that a halving may begin at: bounds the memory of large rings

ConvexPart = tuple[np.ndarray, np.ndarray]  # corners (k, 2) clockwise on the screen [px], inner (k,) bool


def convex_parts(outer: np.ndarray, holes: Sequence[np.ndarray] = (), tolerance: float = 0.0) -> list[ConvexPart]:
    """Convex parts of at most 16 corners of a simple polygon, outer (n, 2) [px] and holes [(m, 2)], in either winding.

    Each part is (corners (k, 2) clockwise on the screen, inner (k,) bool): side k -> k + 1 is shared with another part.
    A corner in a straight line is kept only where an inner side meets one of the boundary. Corners are of those given:
    none is new. A part begins with its topmost, then leftmost corner.

    tolerance [px] >= 0: corners are left out before, bumps and notches alike, as long as each stays within it of the
    side that replaces it and nothing crosses; 0: the parts are exactly the polygon. Repeated corners and corners in a
    line are left out. Holes may touch the outer ring and each other in common corners only. Raises ValueError for
    edges that meet or cross (naming both), for rings without area, for holes that are not inside.
    """
    rings = simple_rings(outer, holes)
    return partition(shaved(rings, tolerance) if tolerance > 0.0 else rings)


def partition(rings: Sequence[np.ndarray]) -> list[ConvexPart]:
    """convex_parts of rings that are known to be simple: the outer one clockwise on the screen, holes the other way."""
    together = np.concatenate(rings)
    base = together.min(axis=0)
    flat = FLAT * float(np.ptp(together, axis=0).max()) ** 2
    # Equal corners have one number, so that a cut is the same pair of numbers on both its sides.
    points, numbers = np.unique(together - base, axis=0, return_inverse=True)
    ends = np.cumsum([len(ring) for ring in rings])
    loops = np.split(numbers.ravel(), ends[:-1])
    pieces = []
    for small in _halved(points, bridged(points, loops, flat), flat):
        pieces += [small[piece] for piece in fewest_convex(points[small], flat)]
    pieces = _joined(points, [piece.tolist() for piece in pieces], flat)
    pieces = [part for piece in pieces for part in _at_most(piece, MAX_CORNERS)]
    sides = {side for piece in pieces for side in _sides(piece)}
    found = []
    for piece in pieces:
        inner = np.array([side[::-1] in sides for side in _sides(piece)])
        corners, inner = _tidy(points[piece] + base, inner, flat)
        if len(corners) > 2:  # cuts along a line leave pieces without area
            found.append((corners, inner))
    return found


def _sides(piece):
    return list(zip(piece, piece[1:] + piece[:1], strict=True))


def _tidy(corners, inner, flat):
    """Without corners in a line between two sides of a kind; from the topmost, leftmost corner on."""
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    keep = (np.abs(cross(before, after)) > flat) | (inner != np.roll(inner, 1))
    corners, inner = corners[keep], inner[keep]
    if not len(corners):
        return corners, inner
    first = np.lexsort((corners[:, 0], corners[:, 1]))[0]
    return np.roll(corners, -first, axis=0), np.roll(inner, -first)


def _halved(points, rings, flat):
    """Rings of at most LARGEST corners, or convex ones."""
    todo, found = list(rings), []
    while todo:
        ring = todo.pop()
        sides = Ring(points[ring], flat)
        if len(ring) <= LARGEST or not sides.reflex.any():
            found.append(ring)
            continue
        i, j = _halving(sides)
        todo.append(ring[i : j + 1])
        todo.append(np.concatenate([ring[j:], ring[: i + 1]]))
    return found


def _halving(sides):
    """A short cut from a reflex corner that leaves about as many corners on either side."""
    count = len(sides.corners)
    starts = np.flatnonzero(sides.reflex)
    for share in (4, 8, 16, 64, count):
        some = starts if share == count else starts[:: len(starts) // STARTS + 1]
        gap = (np.arange(count) - some[:, None]) % count
        least = max(2, count // share)
        far = (gap >= least) & (gap <= count - least)
        distance = ((sides.corners[some][:, None] - sides.corners) ** 2).sum(axis=2)
        rows, j = np.nonzero(far & (distance > 0.0))
        order = np.argsort(distance[rows, j], kind="stable")
        for first in range(0, len(order), TRIED):
            a, b = some[rows[order[first : first + TRIED]]], j[order[first : first + TRIED]]
            toward = sides.corners[b] - sides.corners[a]
            sees = np.flatnonzero(sides.faces(a, toward, False) & sides.faces(b, -toward, False))
            for k in sees.tolist():
                if sides.free(sides.corners[a[k : k + 1]], sides.corners[b[k : k + 1]])[0]:
                    return min(a[k], b[k]), max(a[k], b[k])
            if first >= 8 * TRIED and share != count:
                break
    raise ValueError("points must be a simple polygon (no two corners of a part of it see each other)")


def _joined(points, pieces, flat):
    """Pieces joined over their longest common sides, where they stay convex and have 16 corners at most."""
    owner = {side: number for number, piece in enumerate(pieces) for side in _sides(piece)}
    common = [side for side in owner if side[0] < side[1] and side[::-1] in owner]
    common.sort(key=lambda side: (-float(((points[side[0]] - points[side[1]]) ** 2).sum()), side))
    x, y = points.T.tolist()

    def turn(a, b, c):
        return (x[b] - x[a]) * (y[c] - y[b]) - (y[b] - y[a]) * (x[c] - x[b]) >= -flat

    for u, v in common:
        first, second = owner[u, v], owner[v, u]
        if first == second:
            continue
        a, b = pieces[first], pieces[second]
        k, m = a.index(v), b.index(u)
        a, b = a[k:] + a[:k], b[m:] + b[:m]  # a: v ... u, b: u ... v
        whole = a + b[1:-1]
        if len(whole) <= MAX_CORNERS and turn(a[-2], u, b[1]) and turn(b[-2], v, a[1]):
            pieces[first], pieces[second] = whole, []
            for side in _sides(whole):
                owner[side] = first
    return [piece for piece in pieces if piece]


def _at_most(piece, most):
    """A convex piece in halves, until each has few enough corners."""
    if len(piece) <= most:
        return [piece]
    half = len(piece) // 2
    return _at_most(piece[: half + 1], most) + _at_most(piece[half:] + piece[:1], most)
