"""Manifolds that live from step to step, in their places: recognised by their pairs, used again while nothing moved.

Source of both: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.
"""

from physics.collision.box_pairs import SOLIDS
from physics.collision.carry_over import is_before, is_of, renew
from physics.collision.classify import PARTED, classify_pairs
from physics.collision.follow import follow
from physics.collision.manifold import GRID_ANY, NOTHING, SURFACE_ANY
from physics.jit import inlined, kernel, subkernel
from physics.math2d import heading
from physics.settings import RECYCLE_MOVE, RECYCLE_SHARE
from physics.tables.shape import CIRCLE, MASK


@inlined
def is_sound(manifold, anchor):
    """Whether a manifold that followed its anchor has numbers that are: what is finite is 0 less than itself."""
    m = manifold
    c = anchor
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0 and 0.0 <= c.share_1 <= 1.0 and 0.0 <= c.share_2 <= 1.0


@inlined
def may_move(manifold, anchor, distance):
    """How far [px] points may move on each other: the distance, or RECYCLE_MOVE times that on a face that bears another
    and is not short itself: they follow it exactly.

    What bears nothing has to find its own way out of an overlap.
    """
    m = manifold
    c = anchor
    loaded = c.normal_force_1 > 0.0 or c.normal_force_2 > 0.0
    if m.count == 1 or not loaded or c.radius_a > 0.0 or c.radius_b > 0.0:
        return distance
    x = m.x_2 - m.x_1
    y = m.y_2 - m.y_1
    far = RECYCLE_MOVE * distance
    return far if far * far <= RECYCLE_SHARE * RECYCLE_SHARE * (x * x + y * y) else distance


@subkernel
def use_again(
    # read
    batch,
    distance,
    # write
    previous_inout,
    anchors_inout,
    kinds_inout,
    counts_inout,
    stale_out,
):
    """Use the manifolds of the last step again where no point moved on its partner by more than may_move of `distance`
    [px], and neither side turned on the other by more than that.

    previous_inout MANIFOLD and ANCHOR rows, in the order of shape ids as the candidates, follow their bodies; a pair
    that is served is NOTHING in kinds_inout; stale_out (previous) int32: the other rows, masks' always. Returns how
    many these are. O(both).
    """
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    stale, j = 0, 0
    row_a, row_b = -1, -1
    p_cosine, p_sine, q_cosine, q_sine = 1.0, 0.0, 1.0, 0.0
    for i in range(batch.count):
        if kinds_inout[i] == NOTHING:
            continue
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        while j < len(previous_inout) and is_before(previous_inout[j], a.id, b.id):
            stale_out[stale] = j
            stale += 1
            j += 1
        if j >= len(previous_inout):
            break
        if not is_of(previous_inout[j], a.id, b.id) or a.kind == MASK or b.kind == MASK:
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        # The manifold lies within both: what a turn moves is no further out than the smaller side.
        reach = min(p.extent, q.extent) if min(p.extent, q.extent) > 0.0 else max(p.extent, q.extent)
        # The pairs of a body stand together.
        if a.body_row != row_a:
            row_a = a.body_row
            p_cosine, p_sine = heading(p.angle)
        if b.body_row != row_b:
            row_b = b.body_row
            q_cosine, q_sine = heading(q.angle)
        turns = a.kind == CIRCLE or b.kind == CIRCLE  # as it likes
        fits, last = True, j
        while last < len(previous_inout) and is_of(previous_inout[last], a.id, b.id):
            m = previous_inout[last]
            c = anchors_inout[last]
            if fits and not m.swept:
                moved, rolled = follow(p, p_cosine, p_sine, q, q_cosine, q_sine, c, False, m)
                turn = 0.0 if turns else abs((q.angle - c.angle_b) - (p.angle - c.angle_a)) * reach
                fits = max(rolled, turn) <= distance and moved <= may_move(m, c, distance) and is_sound(m, c)
            else:
                fits = False
            last += 1
        if not fits:
            continue  # the next candidate passes them by
        for k in range(j, last):
            m = previous_inout[k]
            m.body_row_a = a.body_row
            m.body_row_b = b.body_row
            m.row_a = candidates[i, 0]
            m.row_b = candidates[i, 1]
            m.candidate = i
            m.previous = k
            m.persisted_1 = True
            m.persisted_2 = True
            renew(batch.geometry, bodies, shapes, m, anchors_inout[k])
        j = last
        counts_inout[kinds_inout[i]] -= 1
        kinds_inout[i] = NOTHING
    for k in range(j, len(previous_inout)):
        stale_out[stale] = k
        stale += 1
    return stale


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
    """Classify the pairs of what is solid, and use the manifolds of the last step again where that will do: see
    classify_pairs, use_again. O(candidates + manifolds).

    Returns how many manifolds are stale, and how many pairs ask for more: those to be detected, those of parts.
    """
    classify_pairs(
        batch.bodies,
        batch.shapes,
        batch.candidates,
        batch.count,
        batch.margin,
        batch.ahead,
        SOLIDS,
        kinds_out,
        counts_out,
        work_inout,
    )
    stale = use_again(batch, distance, previous_inout, anchors_inout, kinds_out, counts_out, stale_out)
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
