"""What contacts take over from the step before: forces, and their places among the others.

While the same shapes touch as before, what was detected anew takes the place of what it was, and nothing else is
moved: of ten thousand contacts of a pile that settles a tenth. Only when a contact begins or ends is all copied.
"""

from physics.collision.anchors import anchor_manifold, copy_anchor, rest_anchor
from physics.collision.approach import approach
from physics.collision.manifold import copy_manifold
from physics.collision.materials import mixed
from physics.jit import inlined, kernel, subkernel

LARGEST_FORCE = 1e100  # beyond, and what is no number, is not what a contact bore: it begins at rest


@subkernel
def is_before(manifold, shape_a, shape_b):
    """Whether a manifold stands before those of a pair, in the order of shape ids."""
    return manifold.shape_a < shape_a or (manifold.shape_a == shape_a and manifold.shape_b < shape_b)


@subkernel
def is_of(manifold, shape_a, shape_b):
    """Whether a manifold is one of a pair's."""
    return manifold.shape_a == shape_a and manifold.shape_b == shape_b


@subkernel
def take_over(previous, anchors, first, manifold_inout, anchor_inout):
    """Give the points of a new manifold the forces of the points with their features, among the previous manifolds of
    its pair, which begin at `first`."""
    m = manifold_inout
    c = anchor_inout
    for point in range(m.count):
        feature = m.feature_1 if point == 0 else m.feature_2
        k = first
        known = False
        while not known and k < len(previous) and is_of(previous[k], m.shape_a, m.shape_b):
            o = previous[k]
            f = anchors[k]
            second = o.count == 2 and o.feature_2 == feature and o.feature_1 != feature
            if o.feature_1 == feature or second:
                known = True
                normal_force = f.normal_force_2 if second else f.normal_force_1
                tangent_force = f.tangent_force_2 if second else f.tangent_force_1
                if point == 0:
                    c.normal_force_1 = normal_force
                    c.tangent_force_1 = tangent_force
                    c.rolling_force = 0.0 if second else f.rolling_force
                    m.persisted_1 = True
                else:
                    c.normal_force_2 = normal_force
                    c.tangent_force_2 = tangent_force
                    m.persisted_2 = True
            k += 1


@inlined
def renew(geometry, p, q, a, b, manifold_inout, anchor_inout):
    """Write what is new in every step: what the materials are now, and how fast both sides approach. p, q: BODY rows of
    the sides; a, b: their SHAPE rows."""
    m = manifold_inout
    c = anchor_inout
    m.normal_impulse_1 = 0.0
    m.tangent_impulse_1 = 0.0
    m.normal_impulse_2 = 0.0
    m.tangent_impulse_2 = 0.0
    c.color = -1
    forces = abs(c.normal_force_1) + abs(c.tangent_force_1) + abs(c.normal_force_2) + abs(c.tangent_force_2)
    if not forces + abs(c.rolling_force) < LARGEST_FORCE:
        rest_anchor(c)
    c.friction, c.restitution, rolling_resistance, surface_speed = mixed(geometry, a, b, m)
    # These stand in a line that nobody else writes: what stays as it is need not go back to memory.
    if c.rolling_resistance != rolling_resistance or c.surface_speed != surface_speed:
        c.rolling_resistance = rolling_resistance
        c.surface_speed = surface_speed
    approach(p, q, m)


@inlined
def begin_anchor(geometry, bodies, shapes, previous, previous_anchors, first, manifold_inout, anchor_out):
    """Write the anchor of a manifold that was found anew, with the forces of the points of the same pair and feature in
    the step before; first: the first of these."""
    rest_anchor(anchor_out)
    anchor_manifold(geometry.polygons, geometry.corners, bodies, shapes, manifold_inout, anchor_out)
    take_over(previous, previous_anchors, first, manifold_inout, anchor_out)
    m = manifold_inout
    sides = bodies[m.body_row_a], bodies[m.body_row_b], shapes[m.row_a], shapes[m.row_b]
    renew(geometry, *sides, m, anchor_out)


@kernel
def carry_over(
    # read
    geometry,
    bodies,
    shapes,
    previous,
    previous_anchors,
    stale,
    # write
    found_inout,
    manifolds_out,
    anchors_out,
):
    """Write the manifolds of a step and their anchors in the order of the candidates: those of the step before that are
    used again, all but the stale ones, and those that were found. Returns how many there are. O(all).

    previous and found_inout MANIFOLD rows, each in that order; previous_anchors row by row beside them; stale (any)
    int32 rows, ascending. Who is found with a row of the step before is used again too.
    """
    count = 0
    kept = 0
    passed = 0
    i = 0
    j = 0
    while True:
        while passed < len(stale) and stale[passed] == kept:
            passed += 1
            kept += 1
        if kept < len(previous) and (i == len(found_inout) or previous[kept].candidate < found_inout[i].candidate):
            copy_manifold(previous, kept, count, manifolds_out)
            copy_anchor(previous_anchors[kept], anchors_out[count])
            kept += 1
        elif i < len(found_inout):
            m = found_inout[i]
            d = anchors_out[count]
            if m.previous >= 0:
                copy_anchor(previous_anchors[m.previous], d)
            else:
                while j < len(previous) and is_before(previous[j], m.shape_a, m.shape_b):
                    j += 1
                begin_anchor(geometry, bodies, shapes, previous, previous_anchors, j, m, d)
            copy_manifold(found_inout, i, count, manifolds_out)
            i += 1
        else:
            return count
        count += 1


@kernel
def copy_kept(
    # read
    previous,
    stale,
    # write
    manifolds_out,
):
    """Copy the manifolds that are used again, all but the stale ones (any, int32, ascending). O(previous)."""
    count = 0
    passed = 0
    for k in range(len(previous)):
        if passed < len(stale) and stale[passed] == k:
            passed += 1
        else:
            copy_manifold(previous, k, count, manifolds_out)
            count += 1


@subkernel
def are_of_same_pairs(previous, stale, found):
    """Whether found manifolds are of the pairs of the stale ones, one for one."""
    if len(found) != len(stale):
        return False
    for i in range(len(found)):
        if not is_of(previous[stale[i]], found[i].shape_a, found[i].shape_b):
            return False
    return True


@kernel
def take_places(
    # read
    geometry,
    bodies,
    shapes,
    stale,
    # write
    found_inout,
    fresh_out,
    previous_inout,
    anchors_inout,
):
    """Put manifolds that were found where those of their pairs stood, with their anchors. Returns whether each pair has
    as many as before; if not, nothing is changed. O(found).

    stale (found) int32 rows, ascending; found_inout MANIFOLD rows in the order of the candidates; fresh_out (found)
    ANCHOR rows: scratch.
    """
    if not are_of_same_pairs(previous_inout, stale, found_inout):
        return False
    first = 0
    for i in range(len(found_inout)):
        m = found_inout[i]
        if i == 0 or not is_of(found_inout[i - 1], m.shape_a, m.shape_b):
            first = stale[i]
        begin_anchor(geometry, bodies, shapes, previous_inout, anchors_inout, first, m, fresh_out[i])
    # Now that none is asked any more what it bore.
    for i in range(len(found_inout)):
        copy_manifold(found_inout, i, stale[i], previous_inout)
        copy_anchor(fresh_out[i], anchors_inout[stale[i]])
    return True
