"""The number of convex pieces of a polygon, by other methods than that of the engine.

One searches all cuts. The other is the method of Hertel and Mehlhorn on a triangulation.
"""

from functools import cache

import shapely
from shapely import LineString, Polygon


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def fewest(corners):
    """Return the least number of convex pieces that cuts between corners give, by a search of
    all; at most ten corners.
    """
    corners = [tuple(each) for each in corners.tolist()]
    if not Polygon(corners).exterior.is_ccw:
        corners.reverse()

    @cache
    def count(ring):
        reflex = [k for k in range(len(ring)) if turn(ring[k - 1], ring[k], ring[(k + 1) % len(ring)]) < -1e-12]
        if not reflex:
            return 1
        whole, best = Polygon(ring), len(ring)
        k = reflex[0]  # some cut must leave from it
        for m in range(len(ring)):
            if (m - k) % len(ring) in (0, 1, len(ring) - 1):
                continue
            line = LineString([ring[k], ring[m]])
            others = [ring[i] for i in range(len(ring)) if i not in (k, m)]
            if not whole.buffer(1e-9).covers(line) or min(line.distance(shapely.Point(each)) for each in others) < 1e-9:
                continue
            i, j = sorted((k, m))
            best = min(best, count(ring[i : j + 1]) + count(ring[j:] + ring[: i + 1]))
        return best

    return count(tuple(corners))


def hertel_mehlhorn(outer, holes=()):
    """Return the number of convex pieces that the method of Hertel and Mehlhorn gives.

    It removes needless cuts from a constrained Delaunay triangulation.
    """
    triangles = shapely.constrained_delaunay_triangles(Polygon(outer, holes)).geoms
    pieces = [list(shapely.normalize(each).exterior.coords)[:-1] for each in triangles]
    pieces = [each if Polygon(each).exterior.is_ccw else each[::-1] for each in pieces]
    owner = {side: k for k, each in enumerate(pieces) for side in zip(each, each[1:] + each[:1], strict=True)}
    for a, b in sorted(owner):
        if a > b or (b, a) not in owner:
            continue
        first, second = owner[a, b], owner[b, a]
        p, q = pieces[first], pieces[second]
        p, q = p[p.index(b) :] + p[: p.index(b)], q[q.index(a) :] + q[: q.index(a)]
        if turn(p[-2], a, q[1]) < -1e-12 or turn(q[-2], b, p[1]) < -1e-12:
            continue
        whole = p + q[1:-1]
        pieces[first], pieces[second] = whole, []
        owner |= {side: first for side in zip(whole, whole[1:] + whole[:1], strict=True)}
    return sum(bool(each) for each in pieces)


def tangle(rng, count):
    """Return the corners of a random simple polygon: random points, reordered until no edges cross."""
    points = rng.random((count, 2))
    order, again = list(range(count)), True
    while again:
        again = False
        for i in range(count):
            for j in range(i + 2, count - (i == 0)):
                a, b, c, d = (points[order[k % count]] for k in (i, i + 1, j, j + 1))
                if turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0:
                    order[i + 1 : j + 1] = order[i + 1 : j + 1][::-1]
                    again = True
    return points[order]


def reflex_count(outer, holes=()):
    """Return the number of corners at which the inside angle of a polygon with holes exceeds a straight angle."""
    found = 0
    for ring in (outer, *holes):
        ring = ring.tolist()
        sign = 1.0 if Polygon(ring).exterior.is_ccw == (ring == outer.tolist()) else -1.0
        found += sum(sign * turn(ring[k - 2], ring[k - 1], ring[k]) < -1e-12 for k in range(len(ring)))
    return found
