"""The contact cache: local anchor points, matching, recycling, and contacts at the final poses of a step."""

import math

import numpy as np

from physics.collision.hull_pairs import approach
from physics.collision.hulls import CIRCLE_CORNER, CORNERS, PART
from physics.collision.manifold import copy_manifold, mixed
from physics.jit import inlined, kernel, subkernel
from physics.math2d import heading, length_of, turned, unit
from physics.settings import RECYCLE_MOVE, RECYCLE_SHARE, RECYCLE_WANDER
from physics.shapes.library import add_missing_rasters
from physics.shapes.placement import is_hull, refresh_boxes
from physics.tables.contact import ANCHOR, CORES, UPRIGHT, WITH_A, WITH_B
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, TILES
from physics.tables.step_state import StepState, stage

# ---- anchors ---------------------------------------------------------------------------------------------------------
# The cache row of a manifold: its points in the body spaces of both sides, and the frame its normal rotates with.
#
# Points, normal and separations at any pose follow from it (follow_anchor), without a new narrow phase. They are exact
# to second order in the motion. The normal rotates with the side that has the reference face. A point stays with its
# corner, on whichever side that is.

FACES = 1024  # features below are points of a face, see hulls.py
SAME = 2.0**-20  # of a body's extent: a point this near to a corner is that corner


@subkernel
def core_radius(shape):
    """Return the radius [px] from the core of a shape to its surface: of a circle its own, of a hull its rounding."""
    return shape.radius if is_hull(shape.kind) and shape.kind != BOUNDS else 0.0


@subkernel
def is_ground(shape):
    """Return whether a shape is a grid or chain: the features of its manifolds begin with the run or link."""
    return shape.kind == TILES or shape.kind == CHAIN


@subkernel
def has_corners(shape):
    """Return whether a shape is a row of geometry.polygons."""
    return is_hull(shape.kind) and shape.kind != BOUNDS and shape.kind != CIRCLE


@subkernel
def frame_of(a, b, feature, radii):
    """Return the frame that the normal of a manifold rotates with: WITH_A, WITH_B, CORES or UPRIGHT.

    a, b: SHAPE rows of its sides; feature: of its first point; radii [px]: sum of both core radii.
    """
    frame = WITH_B if a.kind == CIRCLE else WITH_A
    if a.kind != MASK and b.kind != MASK:
        part = feature % PART
        disc = a.kind == CIRCLE or b.kind == CIRCLE
        if a.kind == CIRCLE and b.kind == CIRCLE:
            return CORES
        if disc and CIRCLE_CORNER <= part < 2 * CIRCLE_CORNER:
            return CORES  # around a corner
        if part >= CORNERS and part < CORNERS + 256 and radii > 0.0:
            return CORES
        if not disc and part < FACES:
            flipped = part % 2 == 1
            frame = WITH_B if flipped != is_ground(b) else WITH_A
    if (a if frame == WITH_A else b).kind == BOUNDS:
        return UPRIGHT
    return frame


@subkernel
def is_corner(polygons, table, body, shape, corner, local_x, local_y):
    """Return whether a point [px] in body space is the hull core's corner of this number; the number wraps to the
    first."""
    span = polygons[shape.geometry]
    c = table[span.offset + (corner if corner < span.count else 0)]
    return length_of(c.x - local_x, c.y - local_y) <= SAME * body.extent


@subkernel
def core_in_body(body, cosine, sine, x, y, nx, ny, inside, behind):
    """Return a point in body space, moved by `inside` [px] along the normal and `behind` [px] against the tangent
    (-ny, nx)."""
    return turned(x + inside * nx + behind * ny - body.x, y + inside * ny - behind * nx - body.y, cosine, -sine)


@subkernel
def share_of(polygons, table, body_a, body_b, a, b, anchor, feature, second):
    """Return the position of a manifold point between the two cores, along the face: 0 at A's, 1 at B's, 0.5 midway.

    The centre of a disc, or a corner, stays over the face. A point clipped by the end of a face stays with the face.
    feature: the point's; anchor: its ANCHOR row, with the cores already written; second: it is the second point.
    """
    part = feature % PART
    if a.kind == MASK or b.kind == MASK:
        return 0.5
    if a.kind == CIRCLE or b.kind == CIRCLE:
        return 0.0 if a.kind == CIRCLE else 1.0
    if part >= FACES:
        return 0.5
    with_a = (part % 2 == 0) != is_ground(b)
    face_share = 0.0 if with_a else 1.0
    local_ax = anchor.local_ax_2 if second else anchor.local_ax_1
    local_ay = anchor.local_ay_2 if second else anchor.local_ay_1
    local_bx = anchor.local_bx_2 if second else anchor.local_bx_1
    local_by = anchor.local_by_2 if second else anchor.local_by_1
    corner = part // 4 % 16
    edge = part // 64
    if has_corners(b if with_a else a):
        if with_a:
            over = is_corner(polygons, table, body_b, b, corner, local_bx, local_by)
        else:
            over = is_corner(polygons, table, body_a, a, corner, local_ax, local_ay)
        return 1.0 - face_share if over else face_share
    if has_corners(a if with_a else b):
        cut = False
        for end in range(2):
            if with_a:
                cut = cut or is_corner(polygons, table, body_a, a, edge + end, local_ax, local_ay)
            else:
                cut = cut or is_corner(polygons, table, body_b, b, edge + end, local_bx, local_by)
        return face_share if cut else 1.0 - face_share
    return 0.5


@subkernel
def anchor_manifold(polygons, table, bodies, shapes, manifold, anchor_out):
    """Write the cache row of a manifold that was detected at the present poses.

    polygons, table: geometry.polygons and geometry.corners, passed separately: see placement.polygon_at. A round side
    keeps its core, because a surface point would rotate away with its spin.
    """
    m = manifold
    c = anchor_out
    a = bodies[m.body_row_a]
    b = bodies[m.body_row_b]
    s = shapes[m.row_a]
    o = shapes[m.row_b]
    c.radius_a = core_radius(s)
    c.radius_b = core_radius(o)
    c.frame = frame_of(s, o, m.feature_1, c.radius_a + c.radius_b)
    a_cosine, a_sine = heading(a.angle)
    b_cosine, b_sine = heading(b.angle)
    nx = m.normal_x
    ny = m.normal_y
    c.local_nx = nx
    c.local_ny = ny
    if c.frame == WITH_A:
        c.local_nx, c.local_ny = turned(nx, ny, a_cosine, -a_sine)
    elif c.frame == WITH_B:
        c.local_nx, c.local_ny = turned(nx, ny, b_cosine, -b_sine)
    c.angle_a = a.angle
    c.angle_b = b.angle
    c.held_nx = nx
    c.held_ny = ny
    c.apart_x = b.center_x - a.center_x
    c.apart_y = b.center_y - a.center_y
    c.held_ax_1 = m.x_1 - a.center_x
    c.held_ay_1 = m.y_1 - a.center_y
    c.held_ax_2 = 0.0
    c.held_ay_2 = 0.0
    half = 0.5 * m.separation_1
    c.local_ax_1, c.local_ay_1 = core_in_body(a, a_cosine, a_sine, m.x_1, m.y_1, nx, ny, -(half + c.radius_a), 0.0)
    c.local_bx_1, c.local_by_1 = core_in_body(b, b_cosine, b_sine, m.x_1, m.y_1, nx, ny, half + c.radius_b, m.lead)
    c.base_1 = m.separation_1
    c.share_1 = share_of(polygons, table, a, b, s, o, c, m.feature_1, False)
    c.local_ax_2 = 0.0
    c.local_ay_2 = 0.0
    c.local_bx_2 = 0.0
    c.local_by_2 = 0.0
    c.base_2 = 0.0
    c.share_2 = 0.5
    if m.count == 2:
        c.held_ax_2 = m.x_2 - a.center_x
        c.held_ay_2 = m.y_2 - a.center_y
        half = 0.5 * m.separation_2
        c.local_ax_2, c.local_ay_2 = core_in_body(a, a_cosine, a_sine, m.x_2, m.y_2, nx, ny, -(half + c.radius_a), 0.0)
        c.local_bx_2, c.local_by_2 = core_in_body(b, b_cosine, b_sine, m.x_2, m.y_2, nx, ny, half + c.radius_b, m.lead)
        c.base_2 = m.separation_2
        c.share_2 = share_of(polygons, table, a, b, s, o, c, m.feature_2, True)


@subkernel
def rest_anchor(anchor_inout):
    """Clear the forces of a cache row, and its constraint colour."""
    c = anchor_inout
    c.color = -1
    c.rolling_force = 0.0
    c.normal_force_1 = 0.0
    c.tangent_force_1 = 0.0
    c.normal_force_2 = 0.0
    c.tangent_force_2 = 0.0


@kernel
def write_anchors(
    # read
    geometry,
    bodies,
    shapes,
    manifolds,
    # write
    anchors_out,
):
    """Write the cache row of every manifold that was detected at the present poses, without forces. O(manifolds)."""
    for i in range(len(manifolds)):
        rest_anchor(anchors_out[i])
        anchor_manifold(geometry.polygons, geometry.corners, bodies, shapes, manifolds[i], anchors_out[i])


@subkernel
def copy_anchor(source, anchor_out):
    """Copy one row field by field."""
    s = source
    d = anchor_out
    d.frame = s.frame
    d.local_nx = s.local_nx
    d.local_ny = s.local_ny
    d.angle_a = s.angle_a
    d.angle_b = s.angle_b
    d.held_nx = s.held_nx
    d.held_ny = s.held_ny
    d.apart_x = s.apart_x
    d.apart_y = s.apart_y
    d.radius_a = s.radius_a
    d.radius_b = s.radius_b
    d.friction = s.friction
    d.restitution = s.restitution
    d.rolling_resistance = s.rolling_resistance
    d.surface_speed = s.surface_speed
    d.rolling_force = s.rolling_force
    d.color = s.color
    d.local_ax_1 = s.local_ax_1
    d.local_ay_1 = s.local_ay_1
    d.local_bx_1 = s.local_bx_1
    d.local_by_1 = s.local_by_1
    d.held_ax_1 = s.held_ax_1
    d.held_ay_1 = s.held_ay_1
    d.share_1 = s.share_1
    d.base_1 = s.base_1
    d.normal_force_1 = s.normal_force_1
    d.tangent_force_1 = s.tangent_force_1
    d.local_ax_2 = s.local_ax_2
    d.local_ay_2 = s.local_ay_2
    d.local_bx_2 = s.local_bx_2
    d.local_by_2 = s.local_by_2
    d.held_ax_2 = s.held_ax_2
    d.held_ay_2 = s.held_ay_2
    d.share_2 = s.share_2
    d.base_2 = s.base_2
    d.normal_force_2 = s.normal_force_2
    d.tangent_force_2 = s.tangent_force_2


def anchors_of(state: StepState, manifolds: np.ndarray) -> np.ndarray:
    """Return cache rows (ANCHOR), without forces, of manifolds that were detected at the present poses."""
    anchors = np.zeros(len(manifolds), ANCHOR)
    write_anchors(state.library.tables, state.bodies, state.shapes, manifolds, anchors)
    return anchors


# ---- follow ----------------------------------------------------------------------------------------------------------
# Update of contacts to moved bodies: points, normal and separations of a manifold at any pose, from its cache row.


@inlined
def cores_at(a, a_cosine, a_sine, b, b_cosine, b_sine, local_ax, local_ay, local_bx, local_by):
    """Return the cores of a point at the present poses: A's [px], and B's relative to it.

    a, b: BODY rows, with cosine and sine of their angles; local [px]: the cores in the body spaces.
    """
    ax, ay = turned(local_ax, local_ay, a_cosine, a_sine)
    bx, by = turned(local_bx, local_by, b_cosine, b_sine)
    ax += a.x
    ay += a.y
    return ax, ay, (b.x + bx) - ax, (b.y + by) - ay


@inlined
def carried_gap(gap, dx, dy, other_dx, other_dy, apart_x, apart_y, with_a, nx, ny, wander):
    """Return (gap [px] of the cores at a point clipped by the end of a face, whether it differs from `gap`).

    The incident edge runs through the other side's cores of both points. As the sides slide along the face, the clipped
    point moves on that edge. gap: from core to core at the point; dx, dy: B's core relative to A's; other_dx, other_dy:
    the same of the other point; apart_x, apart_y: A's core of the other point relative to this one's; with_a: the face
    is A's; wander [px]: smaller corrections are omitted.
    """
    edge_x = apart_x + (other_dx - dx if with_a else 0.0)
    edge_y = apart_y + (other_dy - dy if with_a else 0.0)
    along = edge_y * nx - edge_x * ny
    across = edge_x * nx + edge_y * ny
    rise = (dy * nx - dx * ny) * across
    # An edge that is too steep is not the one along the face.
    if abs(across) >= abs(along) or along == 0.0 or abs(rise) <= wander * abs(along):
        return gap, False
    return gap - rise / along, True


@inlined
def is_cut(anchor, share):
    """Return whether a point of a cache row, with its share, is clipped by the end of a face."""
    return (anchor.frame == WITH_A and share == 0.0) or (anchor.frame == WITH_B and share == 1.0)


@inlined
def point_of(ax, ay, dx, dy, nx, ny, gap, share, radius_a, radius_b):
    """Return a point of a manifold [px], x and y, and its separation.

    ax … dy: see cores_at; gap: from core to core along the normal, with the correction of carried_gap.
    """
    apart = dx * nx + dy * ny
    middle = 0.5 * (radius_a + (gap - radius_b)) + share * (apart - gap)
    x = ax + share * (dx - apart * nx) + middle * nx
    y = ay + share * (dy - apart * ny) + middle * ny
    return x, y, gap - radius_a - radius_b


@inlined
def follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, wander, manifold_inout):
    """Write points, normal and separations [px] at the present poses. Return (relative motion of the points since
    detection, along or across the face [px]; motion of a core around a corner [px]; whether a clipped point moved on).

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row; wander [px]: a clipped
    point is corrected only where this makes more of a difference, that is after a large motion; infinite: never.
    """
    m = manifold_inout
    c = anchor
    two = m.count == 2
    m.lead = 0.0
    ax_1, ay_1, dx_1, dy_1 = cores_at(
        a, a_cosine, a_sine, b, b_cosine, b_sine, c.local_ax_1, c.local_ay_1, c.local_bx_1, c.local_by_1
    )
    ax_2, ay_2, dx_2, dy_2 = ax_1, ay_1, dx_1, dy_1
    if two:
        ax_2, ay_2, dx_2, dy_2 = cores_at(
            a, a_cosine, a_sine, b, b_cosine, b_sine, c.local_ax_2, c.local_ay_2, c.local_bx_2, c.local_by_2
        )
    nx = c.local_nx
    ny = c.local_ny
    moved = 0.0
    rolled = 0.0
    if c.frame == CORES:
        nx, ny = unit(dx_1, dy_1, m.normal_x, m.normal_y)
        # Relative to the normal at detection: a body that rolls around a corner leaves it.
        rolled = length_of(nx - c.local_nx, ny - c.local_ny) * max(c.radius_a, c.radius_b)
    else:
        if c.frame == WITH_A:
            nx, ny = turned(nx, ny, a_cosine, a_sine)
        elif c.frame == WITH_B:
            nx, ny = turned(nx, ny, b_cosine, b_sine)
        moved = max(abs(dy_1 * nx - dx_1 * ny), abs(dy_2 * nx - dx_2 * ny))
    m.normal_x = nx + 0.0
    m.normal_y = ny + 0.0
    gap_1 = dx_1 * nx + dy_1 * ny
    gap_2 = dx_2 * nx + dy_2 * ny
    wandered_1 = False
    wandered_2 = False
    if two and wander < math.inf:
        x = ax_2 - ax_1
        y = ay_2 - ay_1
        with_a = c.frame == WITH_A
        if is_cut(c, c.share_1):
            gap_1, wandered_1 = carried_gap(gap_1, dx_1, dy_1, dx_2, dy_2, x, y, with_a, nx, ny, wander)
        if is_cut(c, c.share_2):
            gap_2, wandered_2 = carried_gap(gap_2, dx_2, dy_2, dx_1, dy_1, -x, -y, with_a, nx, ny, wander)
    m.x_1, m.y_1, m.separation_1 = point_of(ax_1, ay_1, dx_1, dy_1, nx, ny, gap_1, c.share_1, c.radius_a, c.radius_b)
    moved = max(moved, abs(m.separation_1 - c.base_1))
    if two:
        m.x_2, m.y_2, m.separation_2 = point_of(
            ax_2, ay_2, dx_2, dy_2, nx, ny, gap_2, c.share_2, c.radius_a, c.radius_b
        )
        moved = max(moved, abs(m.separation_2 - c.base_2))
    return moved, rolled, wandered_1 or wandered_2


@kernel
def follow_bodies(
    # read
    bodies,
    anchors,
    # write
    manifolds_inout,
):
    """Update separations, points and normals of all manifolds to the final poses. O(manifolds)."""
    row_a = -1
    row_b = -1
    a_cosine = 1.0
    a_sine = 0.0
    b_cosine = 1.0
    b_sine = 0.0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        a = bodies[m.body_row_a]
        b = bodies[m.body_row_b]
        # The manifolds of a pair, and often those of a body, are adjacent.
        if m.body_row_a != row_a:
            row_a = m.body_row_a
            a_cosine, a_sine = heading(a.angle)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine, b_sine = heading(b.angle)
        follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchors[i], 0.0, m)


# ---- recycle ---------------------------------------------------------------------------------------------------------
# Contact recycling: whether a manifold of the last step can be used again. It is tested at the end of a step for the
# next one, and at the beginning of a step for bodies that were moved in between.
#
# Source: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.


@inlined
def is_sound(manifold):
    """Return whether all numbers of the manifold are finite (x - x == 0 only for finite x)."""
    m = manifold
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0


@inlined
def may_move(manifold, anchor, distance):
    """Return the largest relative motion [px] of a manifold's points with which it can be recycled.

    This is the distance, or RECYCLE_MOVE times it on a loaded face that is not short itself: its points are updated
    exactly. An unloaded contact must find its own way out of an overlap.
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


@inlined
def serves_again(shapes, a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, distance, wander, manifold_inout):
    """Update a manifold to the present poses, and return whether it can be recycled.

    No point may have moved by more than may_move of `distance` [px], and neither side may have rotated relative to the
    other by more than that. Clipped points must be right to within `wander` [px] without correction.

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row.
    """
    m = manifold_inout
    c = anchor
    moved, rolled, wandered = follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, c, wander, m)
    # The manifold lies within both sides: a rotation moves its points by at most the extent of the smaller one.
    reach = min(a.extent, b.extent) if min(a.extent, b.extent) > 0.0 else max(a.extent, b.extent)
    turn = abs((b.angle - c.angle_b) - (a.angle - c.angle_a)) * reach
    if turn > distance and (shapes[m.row_a].kind == CIRCLE or shapes[m.row_b].kind == CIRCLE):
        turn = 0.0  # a disc may rotate freely
    near = max(rolled, turn) <= distance and moved <= may_move(m, c, distance) and not wandered
    return near and is_sound(m) and 0.0 <= c.share_1 <= 1.0 and 0.0 <= c.share_2 <= 1.0


@inlined
def is_settled(body):
    """Return whether a body, a BODY row, is at the pose where its centre of mass was last written."""
    return body.x == body.settled_x and body.y == body.settled_y and body.angle == body.settled_angle


@inlined
def stands(body):
    """Return whether a body, a BODY row, is at the pose to which the last step updated its contacts.

    Moving a body through the API clears the flag; a direct write to the table shows in the pose.
    """
    return body.followed and is_settled(body)


# ---- carry over ------------------------------------------------------------------------------------------------------
# Matching of contacts with those of the last step: they take over its forces and their place in the table.
#
# While the same shapes touch, a new manifold overwrites the old one, and no other row moves: a tenth of ten thousand
# contacts of a settling pile. Only when a contact begins or ends is the whole table copied.

LARGEST_FORCE = 1e100  # a larger or non-finite cached force is reset to 0


@subkernel
def is_before(manifold, shape_a, shape_b):
    """Return whether a manifold comes before those of a pair, in the order of shape ids."""
    return manifold.shape_a < shape_a or (manifold.shape_a == shape_a and manifold.shape_b < shape_b)


@subkernel
def is_of(manifold, shape_a, shape_b):
    """Return whether a manifold belongs to a pair."""
    return manifold.shape_a == shape_a and manifold.shape_b == shape_b


@subkernel
def take_over(previous, anchors, first, manifold_inout, anchor_inout):
    """Copy to a new manifold's points the forces of the previous points with equal features.

    The previous manifolds of its pair begin at row `first`.
    """
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
    """Write the fields that are new in every step: mixed materials and closing speeds.

    p, q: BODY rows of the sides; a, b: their SHAPE rows.
    """
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
    # No other field of this cache line is written: unchanged values need not go back to memory.
    if c.rolling_resistance != rolling_resistance or c.surface_speed != surface_speed:
        c.rolling_resistance = rolling_resistance
        c.surface_speed = surface_speed
    approach(p, q, m)


@inlined
def begin_anchor(geometry, bodies, shapes, previous, previous_anchors, first, manifold_inout, anchor_out):
    """Write the cache row of a newly detected manifold, with the forces of previous points of equal pair and feature.

    first: row of the first previous manifold of the pair, or where it would be.
    """
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
    """Write the manifolds of a step and their cache rows in the order of the candidates: those recycled from the last
    step, without the stale ones, and the found ones. Return how many there are. O(all).

    previous and found_inout: MANIFOLD rows, each in that order; previous_anchors: row by row beside previous; stale
    (any) int32 rows, ascending. A found manifold with a row of the last step is a recycled one.
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
    """Copy the recycled manifolds: all but the stale ones (any, int32, ascending). O(previous)."""
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
    """Return whether the found manifolds belong to the pairs of the stale ones, one for one."""
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
    """Overwrite the stale manifolds of each pair by the found ones, with their cache rows, and return True. O(found).

    Return False, with nothing changed, if a pair has another number of manifolds than before. stale (found) int32 rows,
    ascending; found_inout MANIFOLD rows in the order of the candidates; fresh_out (found) ANCHOR rows: scratch.
    """
    if not are_of_same_pairs(previous_inout, stale, found_inout):
        return False
    first = 0
    for i in range(len(found_inout)):
        m = found_inout[i]
        if i == 0 or not is_of(found_inout[i - 1], m.shape_a, m.shape_b):
            first = stale[i]
        begin_anchor(geometry, bodies, shapes, previous_inout, anchors_inout, first, m, fresh_out[i])
    # All previous forces have been read; safe to overwrite.
    for i in range(len(found_inout)):
        copy_manifold(found_inout, i, stale[i], previous_inout)
        copy_anchor(fresh_out[i], anchors_inout[stale[i]])
    return True


# ---- final poses -----------------------------------------------------------------------------------------------------
# Final poses of a step in a world with stacking: boxes, rasters and contacts are updated to them.
#
# Solvers, sweeps and characters move bodies one after the other. Reports, sensors and sleeping use the state after all
# of them. Contacts are updated from the cache; nothing is detected twice.


@subkernel
def carry_all(
    # read
    shapes,
    anchors,
    distance,
    # write
    bodies_inout,
    manifolds_inout,
):
    """Update points, normals and separations of all manifolds to the present poses, and flag those that can be recycled
    in the next step: see serves_again. O(manifolds)."""
    row_a = -1
    row_b = -1
    a_cosine = 1.0
    a_sine = 0.0
    b_cosine = 1.0
    b_sine = 0.0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        a = bodies_inout[m.body_row_a]
        b = bodies_inout[m.body_row_b]
        # The manifolds of a pair, and often those of a body, are adjacent.
        if m.body_row_a != row_a:
            row_a = m.body_row_a
            a_cosine, a_sine = heading(a.angle)
            a.followed = is_settled(a)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine, b_sine = heading(b.angle)
            b.followed = is_settled(b)
        c = anchors[i]
        fits = serves_again(shapes, a, a_cosine, a_sine, b, b_cosine, b_sine, c, distance, RECYCLE_WANDER * distance, m)
        if not fits:
            follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, c, 0.0, m)
        m.again = fits and not m.swept


@kernel
def settle(
    # read
    shape_rows,
    geometry,
    anchors,
    distance,
    # write
    bodies_inout,
    shapes_inout,
    manifolds_inout,
):
    """Write the boxes of these shapes, and update all manifolds to the present poses. O(rows + manifolds).

    distance [px]: see serves_again.
    """
    refresh_boxes(shape_rows, geometry, bodies_inout, shapes_inout)
    carry_all(shapes_inout, anchors, distance, bodies_inout, manifolds_inout)


@stage(
    "final_poses",
    reads=("tolerances", "awake", "bodies", "shapes", "library", "manifolds", "anchors"),
    writes=(
        "manifolds",
        "library",
        "bodies.followed",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def settle_contacts(state: StepState) -> None:
    """Update boxes, and points, normals and separations of contacts, to the final poses."""
    rows, bodies, shapes = state.awake.shapes, state.bodies, state.shapes
    # A body rotated by the solver may be at an angle without a raster.
    add_missing_rasters(state.library, rows, bodies, shapes, 0.0)
    distance = state.tolerances.recycle
    settle(rows, state.library.tables, state.anchors, distance, bodies, shapes, state.manifolds)
