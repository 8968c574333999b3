"""The contact cache: anchors, matching, recycling, and contacts at the final poses of a step."""

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
# What a manifold is fastened to: places of its points in the body spaces of its sides, and what its normal turns with.
#
# From the anchors, points, normal and separations follow at any pose (follow_anchor), without detecting again. They are
# right to second order in the motion: a normal turns with the side whose face it is, and a point stays with the corner
# that it was, on whichever side that is.

FACES = 1024  # features below: points of a face, see hulls.py
SAME = 2.0**-20  # of a body's extent: what is as near to a corner is that corner


@subkernel
def core_radius(shape):
    """Radius [px] from the core of a shape to its surface: of a circle its own, of a hull its rounding."""
    return shape.radius if is_hull(shape.kind) and shape.kind != BOUNDS else 0.0


@subkernel
def is_ground(shape):
    """Whether a shape is a grid or chain, whose runs and links come first in the features of its manifolds."""
    return shape.kind == TILES or shape.kind == CHAIN


@subkernel
def has_corners(shape):
    """Whether a shape is a row of geometry.polygons."""
    return is_hull(shape.kind) and shape.kind != BOUNDS and shape.kind != CIRCLE


@subkernel
def frame_of(a, b, feature, radii):
    """What the normal of a manifold turns with: WITH_A, WITH_B, CORES or UPRIGHT.

    a, b: SHAPE rows of its sides; feature: of its first point; radii [px]: of both sides' cores.
    """
    frame = WITH_B if a.kind == CIRCLE else WITH_A
    if a.kind != MASK and b.kind != MASK:
        part = feature % PART
        disc = a.kind == CIRCLE or b.kind == CIRCLE
        if a.kind == CIRCLE and b.kind == CIRCLE:
            return CORES
        if disc and CIRCLE_CORNER <= part < 2 * CIRCLE_CORNER:
            return CORES  # round a corner
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
    """Whether a point [px] in a body's space is a corner, by its number, of a hull's core; after the last the first."""
    span = polygons[shape.geometry]
    c = table[span.offset + (corner if corner < span.count else 0)]
    return length_of(c.x - local_x, c.y - local_y) <= SAME * body.extent


@subkernel
def core_in_body(body, cosine, sine, x, y, nx, ny, inside, behind):
    """A point, moved by `inside` [px] along the normal and back by `behind` [px] along the tangent (-ny, nx), in a
    body's space."""
    return turned(x + inside * nx + behind * ny - body.x, y + inside * ny - behind * nx - body.y, cosine, -sine)


@subkernel
def share_of(polygons, table, body_a, body_b, a, b, anchor, feature, second):
    """Where between the cores, along the face, a point of a manifold stays: 0 with A's, 1 with B's, 0.5 between them.

    A disc's middle stays over the face, and so does a corner; what a face's end cuts off stays with the face. feature:
    the point's; anchor: its ANCHOR row, with the cores already in it; second: whether it is the second point.
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
    """Remember a manifold that was detected at the present poses in the body spaces of its sides. polygons, table:
    geometry.polygons and geometry.corners, by themselves: see placement.polygon_at.

    A round side keeps its core, or the point would wander off with its spin.
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
    """An anchor without forces, and in no constraint."""
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
    """Write the anchor of every manifold that was detected at the present poses, without forces. O(manifolds)."""
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
    """ANCHOR rows, without forces, of manifolds that were detected at the present poses."""
    anchors = np.zeros(len(manifolds), ANCHOR)
    write_anchors(state.library.tables, state.bodies, state.shapes, manifolds, anchors)
    return anchors


# ---- follow ----------------------------------------------------------------------------------------------------------
# Contacts that follow their bodies: points, normal and separations of a manifold at any pose, from its anchor.
#
# An anchor keeps the surface points and the normal in the body spaces of its sides; nothing is detected again.


@inlined
def cores_at(a, a_cosine, a_sine, b, b_cosine, b_sine, local_ax, local_ay, local_bx, local_by):
    """The cores of a point at the present poses: A's [px], and B's seen from it. a, b: BODY rows, with their turns;
    local [px]: the cores in the body spaces."""
    ax, ay = turned(local_ax, local_ay, a_cosine, a_sine)
    bx, by = turned(local_bx, local_by, b_cosine, b_sine)
    ax += a.x
    ay += a.y
    return ax, ay, (b.x + bx) - ax, (b.y + by) - ay


@inlined
def carried_gap(gap, dx, dy, other_dx, other_dy, apart_x, apart_y, with_a, nx, ny, wander):
    """(the gap [px] of cores at a point that the end of a face cuts from the edge over it, whether it is another one).

    The edge runs through the other side's cores of both points: as they slide along the face, the cut wanders on it.
    gap: from core to core of the point; dx, dy: B's core of the point seen from A's, other_dx, other_dy those of the
    other point, apart_x, apart_y: the other point's core of A seen from this one's; with_a: the face is A's; wander
    [px]: it stays as it is where the cut makes no more of a difference.
    """
    edge_x = apart_x + (other_dx - dx if with_a else 0.0)
    edge_y = apart_y + (other_dy - dy if with_a else 0.0)
    along = edge_y * nx - edge_x * ny
    across = edge_x * nx + edge_y * ny
    rise = (dy * nx - dx * ny) * across
    # An edge that is too steep is not the one that lies along the face.
    if abs(across) >= abs(along) or along == 0.0 or abs(rise) <= wander * abs(along):
        return gap, False
    return gap - rise / along, True


@inlined
def is_cut(anchor, share):
    """Whether a point of an anchor, with its share, is where a face's end cuts the edge over it."""
    return (anchor.frame == WITH_A and share == 0.0) or (anchor.frame == WITH_B and share == 1.0)


@inlined
def point_of(ax, ay, dx, dy, nx, ny, gap, share, radius_a, radius_b):
    """A point of a manifold [px], x and y, and its separation. ax … dy: see cores_at; gap: from core to core along the
    normal, as the point is told."""
    apart = dx * nx + dy * ny
    middle = 0.5 * (radius_a + (gap - radius_b)) + share * (apart - gap)
    x = ax + share * (dx - apart * nx) + middle * nx
    y = ay + share * (dy - apart * ny) + middle * ny
    return x, y, gap - radius_a - radius_b


@inlined
def follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, wander, manifold_inout):
    """Write points, normal and separations [px] at the present poses. Returns (how far the points have moved on each
    other since they were detected, along a face or across it [px], how far a core rolled round a corner [px], whether
    what a face's end cuts off was carried along the edge).

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row; wander [px]: the end's
    cut is carried where that makes more of a difference, which it does only where much has moved; infinite: never.
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
        # Against where it was detected: what rolls round a corner leaves it.
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
    """Carry separations, points and normals of all manifolds to the final poses. O(manifolds)."""
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
        # The manifolds of a pair, and often those of a body, stand together.
        if m.body_row_a != row_a:
            row_a = m.body_row_a
            a_cosine, a_sine = heading(a.angle)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine, b_sine = heading(b.angle)
        follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchors[i], 0.0, m)


# ---- recycle ---------------------------------------------------------------------------------------------------------
# Whether a manifold of the step before will do again: asked where a step ends, for the next one, and where that begins
# of what was moved by hand in between.
#
# Source: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.


@inlined
def is_sound(manifold):
    """Whether a manifold has numbers that are: what is finite is 0 less than itself."""
    m = manifold
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0


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


@inlined
def serves_again(shapes, a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, distance, wander, manifold_inout):
    """Carry a manifold to the present poses, and say whether that will do: no point moved on its partner by more than
    may_move of `distance` [px], neither side turned on the other by more than that, and what a face's end cuts off is
    right to within `wander` [px] without being carried along the edge.

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row.
    """
    m = manifold_inout
    c = anchor
    moved, rolled, wandered = follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, c, wander, m)
    # The manifold lies within both: what a turn moves is no further out than the smaller side.
    reach = min(a.extent, b.extent) if min(a.extent, b.extent) > 0.0 else max(a.extent, b.extent)
    turn = abs((b.angle - c.angle_b) - (a.angle - c.angle_a)) * reach
    if turn > distance and (shapes[m.row_a].kind == CIRCLE or shapes[m.row_b].kind == CIRCLE):
        turn = 0.0  # as it likes
    near = max(rolled, turn) <= distance and moved <= may_move(m, c, distance) and not wandered
    return near and is_sound(m) and 0.0 <= c.share_1 <= 1.0 and 0.0 <= c.share_2 <= 1.0


@inlined
def is_settled(body):
    """Whether a body, a BODY row, is where its centre of mass was written last."""
    return body.x == body.settled_x and body.y == body.settled_y and body.angle == body.settled_angle


@inlined
def stands(body):
    """Whether a body, a BODY row, is where its contacts were carried to when the last step ended. Who moves it clears
    the flag; what is written into the table is seen by the pose."""
    return body.followed and is_settled(body)


# ---- carry over ------------------------------------------------------------------------------------------------------
# What contacts take over from the step before: forces, and their places among the others.
#
# While the same shapes touch as before, what was detected anew takes the place of what it was, and nothing else is
# moved: of ten thousand contacts of a pile that settles a tenth. Only when a contact begins or ends is all copied.

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


# ---- final poses -----------------------------------------------------------------------------------------------------
# What a step ends with in a world that stacks: boxes, pixels and contacts where the bodies are now.
#
# Solvers, sweeps and characters move bodies one after the other. What is told, sensed and put to sleep is what there is
# after all of them; contacts are carried there by their anchors, nothing is detected twice.


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
    """Carry points, normals and separations of all manifolds to where their bodies are, and note which will do again
    for the next step: see serves_again. O(manifolds)."""
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
        # The manifolds of a pair, and often those of a body, stand together.
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
    """Write the boxes of these shapes, and carry all manifolds to where their bodies are; distance [px]: see
    serves_again. O(rows + manifolds)."""
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
    """Boxes, and the points, normals and separations of contacts, at the final poses."""
    rows, bodies, shapes = state.awake.shapes, state.bodies, state.shapes
    # What was pushed round may stand at an angle that was not foreseen.
    add_missing_rasters(state.library, rows, bodies, shapes, 0.0)
    distance = state.tolerances.recycle
    settle(rows, state.library.tables, state.anchors, distance, bodies, shapes, state.manifolds)
