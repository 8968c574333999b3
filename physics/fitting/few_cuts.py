"""Rings with holes in few convex pieces, for kernels: holes bridged, reflex corners cut away, needless cuts taken out.

A reflex corner takes one cut, if that leaves less than half a turn on either side of it; a cut between two of them can
do for both, so such cuts come first, the shortest of each corner. The cuts left that no corner needs go, longest first:
so there are never more pieces than Hertel and Mehlhorn 1983 leave, and mostly as many as there must be.
"""

import math

from physics.fitting.rings import corners_of, faces, is_reflex, put_cut, sees, sees_through, take_out, turn_at
from physics.jit import subkernel


@subkernel
def bridge(n, sides_inout):
    """Join each hole to the ring around it by its shortest free line. Returns how many sides there are; -1: a hole
    sees nothing, so the rings were none of a polygon."""
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
    """(corner of the hole that a side is of, corner of what is joined already) with the shortest free line between
    them; -1, -1: there is none."""
    best = math.inf
    best_a = -1
    best_b = -1
    a = start
    while True:
        p = sides[a]
        for b in range(n):
            q = sides[b]
            if q.alive and q.apart == 0:
                distance = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y)
                if 0.0 < distance < best and sees_through(sides, n, a, b):
                    best = distance
                    best_a = a
                    best_b = b
        a = p.next
        if a == start:
            return best_a, best_b


@subkernel
def is_resolved(sides, a, b):
    """Whether a cut from corner a to corner b leaves no reflex corner at a."""
    side = sides[a]
    return turn_at(sides, side.previous, a, b) >= 0.0 and turn_at(sides, b, a, side.next) >= 0.0


@subkernel
def best_partner(sides, a, both):
    """The corner of its ring that reflex corner a is cut to: what resolves most reflex corners, of those the nearest.

    both: only one that resolves two. -1: there is none.
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
    """Cut all reflex corners away. Returns how many sides there are; -1: a corner sees no other."""
    for both in (True, False):
        k = 0
        while k < n:
            if sides_inout[k].alive and is_reflex(sides_inout, k):
                partner = best_partner(sides_inout, k, both)
                if partner >= 0:
                    n = put_cut(n, k, partner, sides_inout)
                    continue  # it may be reflex still
                if not both:
                    return -1
            k += 1
    return n


@subkernel
def cut_large(n, most, sides_inout):
    """Halve convex pieces until they have at most so many corners. Returns how many sides there are."""
    k = 0
    while k < n:
        if sides_inout[k].alive:
            count = corners_of(sides_inout, k)
            while count > most:
                far = k
                for _ in range(count // 2):
                    far = sides_inout[far].next
                if not faces(sides_inout, k, far):
                    break  # all in one line with it: another corner's turn
                n = put_cut(n, k, far, sides_inout)
                count = corners_of(sides_inout, k)
        k += 1
    return n


@subkernel
def is_needed(sides, k, m):
    """Whether the corner where a cut starts (side k, its twin m) would be reflex without it."""
    p = sides[sides[k].previous]
    q = sides[k]
    after = sides[sides[m].next]
    r = sides[after.next]
    turn = (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x)
    return turn < 0.0 or (turn == 0.0 and p.inner != after.inner)


@subkernel
def is_needless(sides, k, most):
    """Whether the pieces on both sides of a cut are convex together and have few enough corners."""
    m = sides[k].twin
    if is_needed(sides, k, m) or is_needed(sides, m, k):
        return False
    count = 1
    at = sides[k].next
    while at != k:
        if at == m:
            return False  # a bridge with one piece on both sides
        count += 1
        at = sides[at].next
    return count + corners_of(sides, m) - 2 <= most


@subkernel
def merge(n, most, sides_inout):
    """Take out the cuts that no corner needs, longest first."""
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
