"""Polygons with holes as linked lists of sides in one table, and their convex decomposition by kernels."""

import math

import numpy as np

from physics.jit import subkernel

# ---- rings -----------------------------------------------------------------------------------------------------------
# A ring is a closed, doubly linked list of the sides around the inside of a polygon. All rings are in one table.
#
# A side starts at (x, y) and ends at the start of the next side; the inside of the polygon lies to the side's right. A
# cut is a line inside the polygon, stored as two sides of opposite directions, each the twin of the other. A cut
# between two corners of one ring splits the ring; a cut between two rings joins them. Corner k is the start of side k.

SIDE = np.dtype(
    [
        ("x", np.float64),  # [px]
        ("y", np.float64),
        ("next", np.int64),  # row of the next side of the ring
        ("previous", np.int64),
        ("twin", np.int64),  # row of the opposite side of a cut; -1: not a cut
        ("inner", np.bool_),  # the polygon continues on the other side
        ("alive", np.bool_),  # False: removed from its ring
        ("apart", np.int64),  # number of the hole that this side bounds; 0: not a hole, or already joined to a ring
        ("seen", np.bool_),  # scratch flag of a pass over all sides
    ],
    align=True,
)


@subkernel
def put_side(n, first, x, y, inner, sides_inout):
    """Append a side that starts at (x, y) [px] to a ring. Return the new number of SIDE rows.

    If the last side starts at the same point, no side is added, and only the last side's flag `inner` is replaced. n:
    number of rows before; first: row of the ring's first side; inner: whether the polygon continues beyond the side.
    sides_inout: SIDE rows.
    """
    if n > first and sides_inout[n - 1].x == x and sides_inout[n - 1].y == y:
        sides_inout[n - 1].inner = inner
        return n
    side = sides_inout[n]
    side.x, side.y = x, y
    side.next = n + 1
    side.previous = n - 1
    side.twin = -1
    side.inner = inner
    side.alive = True
    side.apart = 0
    side.seen = False
    return n + 1


@subkernel
def close_ring(n, first, sides_inout):
    """Link a ring's last side to its first, and remove collinear corners between sides of equal `inner`.

    Return the new number of SIDE rows. A ring of fewer than three sides is removed. n: number of rows before; first:
    row of the ring's first side. sides_inout: SIDE rows.
    """
    if n - 1 > first and sides_inout[n - 1].x == sides_inout[first].x and sides_inout[n - 1].y == sides_inout[first].y:
        n -= 1
    if n - first < 3:
        return first
    sides_inout[n - 1].next = first
    sides_inout[first].previous = n - 1
    left = n - first
    for k in range(first, n):
        side = sides_inout[k]
        before = sides_inout[side.previous]
        if left > 3 and side.inner == before.inner and turn_at(sides_inout, side.previous, k, side.next) == 0.0:
            before.next = side.next
            sides_inout[side.next].previous = side.previous
            side.alive = False
            left -= 1
    return n


@subkernel
def turn_at(sides, a, b, c):
    """Return the cross product [px2] of the vectors from corner a to b and from b to c.

    The product is > 0 for a turn that is clockwise on the screen (convex). a, b, c: rows of the corners in `sides`,
    SIDE rows.
    """
    p, q = sides[a], sides[b]
    r = sides[c]
    return (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x)


@subkernel
def is_reflex(sides, k):
    """Return whether corner k needs a cut, because its interior angle is more than half a turn.

    A cut is also needed at an angle of exactly half a turn between an inner side and a side on the outline. Thus each
    side of a part is either wholly inner or wholly on the outline. sides: SIDE rows.
    """
    side = sides[k]
    turn = turn_at(sides, side.previous, k, side.next)
    return turn < 0.0 or (turn == 0.0 and side.inner != sides[side.previous].inner)


@subkernel
def faces(sides, k, m):
    """Return whether the line from corner k to corner m starts strictly inside the ring of corner k.

    k, m: rows of the corners in `sides`, SIDE rows.
    """
    side = sides[k]
    to = sides[m]
    after = sides[side.next]
    before = sides[side.previous]
    x, y = to.x - side.x, to.y - side.y
    from_after = (after.x - side.x) * y - (after.y - side.y) * x
    to_before = x * (before.y - side.y) - y * (before.x - side.x)
    turn = turn_at(sides, side.previous, k, side.next)
    if turn < 0.0:
        return from_after > 0.0 or to_before > 0.0
    return from_after > 0.0 and (turn == 0.0 or to_before > 0.0)


@subkernel
def blocks(sides, k, a, b):
    """Return whether side k crosses the line between corners a and b, or starts on it.

    k, a, b: rows in `sides`, SIDE rows.
    """
    p, q = sides[a], sides[b]
    r = sides[k]
    s = sides[r.next]
    x, y = q.x - p.x, q.y - p.y
    start = x * (r.y - p.y) - y * (r.x - p.x)
    if start == 0.0:
        along = x * (r.x - p.x) + y * (r.y - p.y)
        return 0.0 < along < x * x + y * y
    end = x * (s.y - p.y) - y * (s.x - p.x)
    if end == 0.0 or (start > 0.0) == (end > 0.0):
        return False
    u, v = s.x - r.x, s.y - r.y
    of_p, of_q = u * (p.y - r.y) - v * (p.x - r.x), u * (q.y - r.y) - v * (q.x - r.x)
    return (of_p > 0.0 and of_q < 0.0) or (of_p < 0.0 and of_q > 0.0)


@subkernel
def sees(sides, a, b):
    """Return whether the line between two corners a and b of one ring is inside the ring and meets no other side.

    O(corners). a, b: rows of the corners in `sides`, SIDE rows.
    """
    if not faces(sides, a, b) or not faces(sides, b, a):
        return False
    k = sides[a].next
    while k != a:
        if blocks(sides, k, a, b):
            return False
        k = sides[k].next
    return True


@subkernel
def sees_through(sides, count, a, b):
    """Return whether the line between corners a and b of two different rings is inside both and meets no side.

    a, b: rows of the corners in `sides`, SIDE rows; count: number of sides of all rings. O(sides).
    """
    if not faces(sides, a, b) or not faces(sides, b, a):
        return False
    for k in range(count):
        if sides[k].alive and blocks(sides, k, a, b):
            return False
    return True


@subkernel
def put_cut(n, a, b, sides_inout):
    """Append a cut between corners a and b, as two sides linked into their rings. Return the new number of SIDE rows.

    n: number of rows before; a, b: rows of the corners; sides_inout: SIDE rows.
    """
    there = sides_inout[n]
    back = sides_inout[n + 1]
    start = sides_inout[a]
    end = sides_inout[b]
    there.x, there.y = start.x, start.y
    back.x, back.y = end.x, end.y
    there.previous = start.previous
    sides_inout[start.previous].next = n
    back.previous = end.previous
    sides_inout[end.previous].next = n + 1
    there.next = b
    end.previous = n
    back.next = a
    start.previous = n + 1
    there.twin = n + 1
    back.twin = n
    for k in range(n, n + 2):
        sides_inout[k].inner = True
        sides_inout[k].alive = True
        sides_inout[k].seen = False
        sides_inout[k].apart = 0
    return n + 2


@subkernel
def take_out(k, sides_inout):
    """Remove the cut that side k belongs to, so that the two pieces on its sides become one. sides_inout: SIDE rows."""
    m = sides_inout[k].twin
    for a, b in ((k, m), (m, k)):
        before = sides_inout[a].previous
        after = sides_inout[b].next
        sides_inout[before].next = after
        sides_inout[after].previous = before
        sides_inout[a].alive = False


@subkernel
def corners_of(sides, first):
    """Return the number of corners of the ring that contains side `first`. sides: SIDE rows."""
    count = 1
    k = sides[first].next
    while k != first:
        count += 1
        k = sides[k].next
    return count


# ---- few cuts --------------------------------------------------------------------------------------------------------
# Convex decomposition of rings with holes into few pieces: join holes by bridges, cut reflex corners, remove needless
# cuts.
#
# A cut resolves a reflex corner if it leaves an angle of at most half a turn on either side. A cut between two reflex
# corners can resolve both, so such cuts are made first, the shortest cut of each corner. Cuts that no corner needs are
# removed, longest first. So there are never more pieces than by Hertel and Mehlhorn 1983, and mostly as few as
# possible.


@subkernel
def bridge(n, sides_inout):
    """Join each hole to the ring around it by a bridge: a cut along the shortest line that meets no side.

    Return the new number of SIDE rows, or -1 if a hole has no such line; then the rings are not a polygon. n: number of
    rows before; sides_inout: SIDE rows.
    """
    while True:
        waiting = 0
        joined = 0
        for start in range(n):
            if sides_inout[start].alive and sides_inout[start].apart > 0:
                waiting += 1
                a, b = shortest_bridge(n, start, sides_inout)
                if a >= 0:
                    k = start
                    while sides_inout[k].apart > 0:
                        sides_inout[k].apart = 0
                        k = sides_inout[k].next
                    n = put_cut(n, a, b, sides_inout)
                    joined += 1
        if waiting == 0:
            return n
        if joined == 0:
            return -1


@subkernel
def shortest_bridge(n, start, sides):
    """Return (corner of a hole, corner of another ring), joined by the shortest line between them that meets no side.

    The other ring is not a hole, or is a hole already joined to such a ring (SIDE.apart is 0). If there is no such
    line, the result is (-1, -1). Corners are row numbers in `sides`. n: number of sides; start: row of a side of the
    hole.
    """
    best = math.inf
    best_a, best_b = -1, -1
    a = start
    while True:
        p = sides[a]
        for b in range(n):
            q = sides[b]
            if q.alive and q.apart == 0:
                distance = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y)
                if 0.0 < distance < best and sees_through(sides, n, a, b):
                    best = distance
                    best_a, best_b = a, b
        a = p.next
        if a == start:
            return best_a, best_b


@subkernel
def is_resolved(sides, a, b):
    """Return whether a cut from corner a to corner b leaves no angle of more than half a turn at corner a.

    a, b: rows of the corners in `sides`, SIDE rows.
    """
    side = sides[a]
    return turn_at(sides, side.previous, a, b) >= 0.0 and turn_at(sides, b, a, side.next) >= 0.0


@subkernel
def best_partner(sides, a, both):
    """Return the best corner for a cut from reflex corner a, or -1 if there is none.

    Among the visible corners, the best is the one whose cut resolves the most reflex corners: corner a, the other
    corner or both. Among equally good ones it is the nearest. both: True to accept only a cut that resolves both
    corners. Corners are row numbers in `sides`, SIDE rows.
    """
    best = -1
    best_score = 1 if both else -1
    best_distance = math.inf
    p = sides[a]
    b = sides[p.next].next
    while b != p.previous and b != a:
        q = sides[b]
        score = 1 if is_resolved(sides, a, b) else 0
        if is_reflex(sides, b) and is_resolved(sides, b, a):
            score += 1
        distance = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y)
        better = score > best_score or (score == best_score and distance < best_distance)
        if better and distance > 0.0 and not (both and score < 2) and sees(sides, a, b):
            best = b
            best_score = score
            best_distance = distance
        b = q.next
    return best


@subkernel
def cut_reflex(n, sides_inout):
    """Add cuts until no reflex corner remains. Return the new number of SIDE rows, or -1 if no cut is possible.

    n: number of rows before. No cut is possible if no other corner is visible from a reflex corner. sides_inout: SIDE
    rows.
    """
    for both in (True, False):
        k = 0
        while k < n:
            if sides_inout[k].alive and is_reflex(sides_inout, k):
                partner = best_partner(sides_inout, k, both)
                if partner >= 0:
                    n = put_cut(n, k, partner, sides_inout)
                    continue  # corner k may still be reflex
                if not both:
                    return -1
            k += 1
    return n


@subkernel
def cut_large(n, most, sides_inout):
    """Halve convex pieces until each has at most `most` corners. Return the new number of SIDE rows.

    n: number of rows before; sides_inout: SIDE rows, the sides of all pieces.
    """
    k = 0
    while k < n:
        if sides_inout[k].alive:
            count = corners_of(sides_inout, k)
            while count > most:
                far = k
                for _ in range(count // 2):
                    far = sides_inout[far].next
                if not faces(sides_inout, k, far):
                    break  # collinear corners: another corner is tried
                n = put_cut(n, k, far, sides_inout)
                count = corners_of(sides_inout, k)
        k += 1
    return n


@subkernel
def is_needed(sides, k, m):
    """Return whether a cut is needed, because without it the corner at the start of side k would be reflex.

    k: row of one of the two sides of the cut; m: row of its other side; sides: SIDE rows.
    """
    p, q = sides[sides[k].previous], sides[k]
    after = sides[sides[m].next]
    r = sides[after.next]
    turn = (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x)
    return turn < 0.0 or (turn == 0.0 and p.inner != after.inner)


@subkernel
def is_needless(sides, k, most):
    """Return whether the cut that side k belongs to can be removed, so that the two pieces beside it form one part.

    The part must be convex and have at most `most` corners. sides: SIDE rows.
    """
    m = sides[k].twin
    if is_needed(sides, k, m) or is_needed(sides, m, k):
        return False
    count = 1
    at = sides[k].next
    while at != k:
        if at == m:
            return False  # a bridge with the same piece on both sides
        count += 1
        at = sides[at].next
    return count + corners_of(sides, m) - 2 <= most


@subkernel
def merge(n, most, sides_inout):
    """Remove the cuts that are not needed to divide the polygon into convex pieces of at most `most` corners.

    The longest cut is tried first. n: number of SIDE rows; sides_inout: SIDE rows.
    """
    while True:
        best = -1
        longest = 0.0
        for k in range(n):
            side = sides_inout[k]
            if side.alive and side.twin > k and not side.seen:
                end = sides_inout[side.twin]
                length = (end.x - side.x) * (end.x - side.x) + (end.y - side.y) * (end.y - side.y)
                if length > longest:
                    longest = length
                    best = k
        if best < 0:
            return
        sides_inout[best].seen = True
        if is_needless(sides_inout, best, most):
            take_out(best, sides_inout)


@subkernel
def put_parts(count, low, sides_inout, corners_out, inner_out, counts_out):
    """Write the rings of convex pieces to the output arrays as parts. Return the number of parts.

    count: number of SIDE rows; low [px]: subtracted from all coordinates; corners_out (n, 2) [px]: corners part after
    part; inner_out (n,): whether the side after each corner is inner; counts_out (parts,): number of corners of each
    part. sides_inout: SIDE rows.
    """
    sides = sides_inout
    n = 0
    parts = 0
    for k in range(count):
        sides[k].seen = False
    for start in range(count):
        if not sides[start].alive or sides[start].seen:
            continue
        first = start
        k = start
        while not sides[k].seen:
            sides[k].seen = True
            if (sides[k].y, sides[k].x) < (sides[first].y, sides[first].x):
                first = k
            k = sides[k].next
        begin = n
        k = first
        while True:
            side = sides[k]
            if side.inner != sides[side.previous].inner or turn_at(sides, side.previous, k, side.next) != 0.0:
                corners_out[n, 0] = side.x - low
                corners_out[n, 1] = side.y - low
                inner_out[n] = side.inner
                n += 1
            k = side.next
            if k == first:
                break
        counts_out[parts] = n - begin
        parts += 1
    return parts


@subkernel
def write_parts(n, most, low, sides_inout, corners_out, inner_out, counts_out):
    """Decompose a polygon with holes into convex parts. Return their number, or -1 if the rings are not a polygon.

    n: number of SIDE rows; most: largest number of corners of a part; low, corners_out, inner_out, counts_out: see
    put_parts. sides_inout: SIDE rows.
    """
    n = bridge(n, sides_inout)
    if n < 0:
        return -1
    n = cut_reflex(n, sides_inout)
    if n < 0:
        return -1
    n = cut_large(n, most, sides_inout)
    merge(n, most, sides_inout)
    return put_parts(n, low, sides_inout, corners_out, inner_out, counts_out)
