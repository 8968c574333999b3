"""What a manifold is fastened to: places of its points in the body spaces of its sides, and what its normal turns with.

From the anchors, points, normal and separations follow at any pose (follow_anchor), without detecting again. They are
right to second order in the motion: a normal turns with the side whose face it is, and a point stays with the corner
that it was, on whichever side that is.
"""

import numpy as np

from physics.collision.features import CIRCLE_CORNER, CORNERS, PART
from physics.jit import kernel, subkernel
from physics.math2d import heading, length_of, turned
from physics.shapes.placement import is_hull
from physics.tables.manifold import ANCHOR, CORES, UPRIGHT, WITH_A, WITH_B
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, TILES
from physics.tables.step_state import StepState

FACES = 1024  # features below: points of a face, see features.py
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
