"""Rings of sides around the inside of a polygon, in one table: to be joined, cut and merged.

A side starts at (x, y) and ends where the next one starts; the inside lies to its right. A cut is two sides, one there
and one back, each other's twin: between corners of one ring it parts this in two, between two rings it makes them one.
"""

import numpy as np

from physics.jit import subkernel

SIDE = np.dtype(
    [
        ("x", np.float64),  # [px]
        ("y", np.float64),
        ("next", np.int64),
        ("previous", np.int64),
        ("twin", np.int64),  # -1: no cut
        ("inner", np.bool_),  # more of the inside lies beyond it
        ("alive", np.bool_),
        ("apart", np.int64),  # 0: its ring is joined to what is around it; else a hole's number
        ("seen", np.bool_),
    ],
    align=True,
)


@subkernel
def put_side(n, first, x, y, inner, sides_inout):
    """Append a side to the ring that starts at a row; none without length. Returns how many sides there are."""
    if n > first and sides_inout[n - 1].x == x and sides_inout[n - 1].y == y:
        sides_inout[n - 1].inner = inner
        return n
    side = sides_inout[n]
    side.x = x
    side.y = y
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
    """Join the last side of a ring to its first one; corners in a line between sides of a kind go.
    Returns how many sides there are: as many as before the ring when nothing is left of it."""
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
    """How the way over three corners turns at the second one: > 0 clockwise on the screen, the way of a convex corner
    [px2]."""
    p = sides[a]
    q = sides[b]
    r = sides[c]
    return (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x)


@subkernel
def is_reflex(sides, k):
    """Whether the inside is more than half a turn at a corner; or just that, where a side that is inner goes on in one
    that is not: no part may have both in one edge."""
    side = sides[k]
    turn = turn_at(sides, side.previous, k, side.next)
    return turn < 0.0 or (turn == 0.0 and side.inner != sides[side.previous].inner)


@subkernel
def faces(sides, k, m):
    """Whether the line from corner k to corner m starts into the inside, along no side."""
    side = sides[k]
    to = sides[m]
    after = sides[side.next]
    before = sides[side.previous]
    x = to.x - side.x
    y = to.y - side.y
    from_after = (after.x - side.x) * y - (after.y - side.y) * x
    to_before = x * (before.y - side.y) - y * (before.x - side.x)
    turn = turn_at(sides, side.previous, k, side.next)
    if turn < 0.0:
        return from_after > 0.0 or to_before > 0.0
    return from_after > 0.0 and (turn == 0.0 or to_before > 0.0)


@subkernel
def blocks(sides, k, a, b):
    """Whether side k crosses the line between corners a and b, or starts on it between its ends."""
    p = sides[a]
    q = sides[b]
    r = sides[k]
    s = sides[r.next]
    x = q.x - p.x
    y = q.y - p.y
    start = x * (r.y - p.y) - y * (r.x - p.x)
    if start == 0.0:
        along = x * (r.x - p.x) + y * (r.y - p.y)
        return 0.0 < along < x * x + y * y
    end = x * (s.y - p.y) - y * (s.x - p.x)
    if end == 0.0 or (start > 0.0) == (end > 0.0):
        return False
    u = s.x - r.x
    v = s.y - r.y
    of_p = u * (p.y - r.y) - v * (p.x - r.x)
    of_q = u * (q.y - r.y) - v * (q.x - r.x)
    return (of_p > 0.0 and of_q < 0.0) or (of_p < 0.0 and of_q > 0.0)


@subkernel
def sees(sides, a, b):
    """Whether the line between two corners of a ring lies inside it and meets no other side of it. O(corners)."""
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
    """The same between corners of two rings, past the sides of all. O(sides)."""
    if not faces(sides, a, b) or not faces(sides, b, a):
        return False
    for k in range(count):
        if sides[k].alive and blocks(sides, k, a, b):
            return False
    return True


@subkernel
def put_cut(n, a, b, sides_inout):
    """Append a cut between corners a and b. Returns how many sides there are."""
    there = sides_inout[n]
    back = sides_inout[n + 1]
    start = sides_inout[a]
    end = sides_inout[b]
    there.x = start.x
    there.y = start.y
    back.x = end.x
    back.y = end.y
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
    """Take a cut out again: the pieces on its two sides become one."""
    m = sides_inout[k].twin
    for a, b in ((k, m), (m, k)):
        before = sides_inout[a].previous
        after = sides_inout[b].next
        sides_inout[before].next = after
        sides_inout[after].previous = before
        sides_inout[a].alive = False


@subkernel
def corners_of(sides, first):
    """How many corners the ring of a side has."""
    count = 1
    k = sides[first].next
    while k != first:
        count += 1
        k = sides[k].next
    return count
