"""Manifolds that live from step to step, in their places: recognised by their pairs, used again while nothing moved.

Source of both: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.
"""

import math

from physics.collision.box_pairs import SOLIDS
from physics.collision.carry_over import is_before, is_of, renew
from physics.collision.classify import PARTED, is_of_part, kind_asked
from physics.collision.manifold import GRID_ANY, NOTHING, SURFACE_ANY
from physics.collision.recycle import is_sound, serves_again, stands
from physics.jit import inlined, kernel
from physics.math2d import heading
from physics.tables.counters import NARROW_TESTS
from physics.tables.shape import MASK


@inlined
def take_as_it_is(a, b, row_a, row_b, candidate, place, manifold_inout):
    """Write what may be new about a manifold that is used again: the rows of its sides, SHAPE rows a and b, its
    candidate and its place among those of the step before."""
    m = manifold_inout
    m.body_row_a = a.body_row
    m.body_row_b = b.body_row
    m.row_a = row_a
    m.row_b = row_b
    m.candidate = candidate
    m.previous = place
    m.persisted_1 = True
    m.persisted_2 = True


@kernel
def recycle_manifolds(
    # read
    batch,
    distance,
    # write
    previous_inout,
    anchors_inout,
    kinds_out,
    counts_out,
    stale_out,
    work_inout,
):
    """Classify the pairs of what is solid, see classify, and use the manifolds of the last step again where they will
    do: see serves_again, distance [px]. Where both bodies stand as that step left them it has been asked already.

    previous_inout MANIFOLD and ANCHOR rows, in the order of shape ids as the candidates, follow their bodies; a pair
    that is served is NOTHING in kinds_out, and not counted; stale_out (previous) int32: the other rows, masks' always.
    Returns how many these are, and how many pairs ask for more: those to be detected, those of parts.
    O(candidates + manifolds).
    """
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    for i in range(len(counts_out)):
        counts_out[i] = 0
    stale, j = 0, 0
    row_a = -1
    p_stands = False
    for i in range(batch.count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        kind = kind_asked(bodies, a, b, batch.margin, batch.ahead, SOLIDS)
        kinds_out[i] = kind
        counts_out[kind] += 1
        if kind == NOTHING:
            continue
        counts_out[PARTED] += int(is_of_part(a, b))
        while j < len(previous_inout) and is_before(previous_inout[j], a.id, b.id):
            stale_out[stale] = j
            stale += 1
            j += 1
        if j == len(previous_inout) or not is_of(previous_inout[j], a.id, b.id) or a.kind == MASK or b.kind == MASK:
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        # The pairs of a body stand together.
        if a.body_row != row_a:
            row_a = a.body_row
            p_stands = stands(p)
        still = p_stands and stands(q)
        fits, last = True, j
        while last < len(previous_inout) and is_of(previous_inout[last], a.id, b.id):
            m = previous_inout[last]
            if fits and not (still and m.again and is_sound(m)):
                c = anchors_inout[last]
                m.row_a = candidates[i, 0]
                m.row_b = candidates[i, 1]
                p_cosine, p_sine = heading(p.angle)
                q_cosine, q_sine = heading(q.angle)
                fits = not m.swept and serves_again(
                    shapes, p, p_cosine, p_sine, q, q_cosine, q_sine, c, distance, math.inf, m
                )
            last += 1
        if not fits:
            continue  # the next candidate passes them by
        for k in range(j, last):
            take_as_it_is(a, b, candidates[i, 0], candidates[i, 1], i, k, previous_inout[k])
            renew(batch.geometry, p, q, a, b, previous_inout[k], anchors_inout[k])
        j = last
        counts_out[kind] -= 1
        kinds_out[i] = NOTHING
    for k in range(j, len(previous_inout)):
        stale_out[stale] = k
        stale += 1
    work_inout[NARROW_TESTS] += batch.count - counts_out[NOTHING]
    asking = counts_out[PARTED]
    for kind in range(NOTHING):
        asking += counts_out[kind]
    return stale, asking


@kernel
def remember_ground(
    # read
    batch,
    previous,
    # write
    memory_out,
):
    """Write where the previous manifolds of each candidate with a tile grid, or a surface, stand: memory_out (count, 2)
    first, number.

    Both in the order of shape ids. What is open from below asks who stood on it. O(candidates + previous).
    """
    j = 0
    for i in range(batch.count):
        memory_out[i, 0] = 0
        memory_out[i, 1] = 0
        if batch.kinds[i] != GRID_ANY and batch.kinds[i] != SURFACE_ANY:
            continue
        a = batch.shapes[batch.candidates[i, 0]].id
        b = batch.shapes[batch.candidates[i, 1]].id
        while j < len(previous) and is_before(previous[j], a, b):
            j += 1
        last = j
        while last < len(previous) and is_of(previous[last], a, b):
            last += 1
        memory_out[i, 0] = j
        memory_out[i, 1] = last - j
