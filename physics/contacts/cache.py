"""Contact cache of worlds with a stacking solver, which updates contacts of moved bodies without a narrow phase."""

import math

import numpy as np

from physics.collision.hulls import CIRCLE_CORNER, CORNERS, PART
from physics.jit import copy_row, inlined, kernel, subkernel
from physics.math2d import norm, rotate, rotation_of, unit
from physics.settings import RECYCLE_MOVE, RECYCLE_SHARE, RECYCLE_WANDER
from physics.shapes.placement import PLACED, add_missing_rasters, is_hull, refresh_boxes
from physics.tables.contact import CONTACT, CORES, UPRIGHT, WITH_A, WITH_B
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, TILES
from physics.tables.step_state import StepState, WorldTables, stage

# ---- cache -----------------------------------------------------------------------------------------------------------
# The contact cache: the points of a manifold in the body spaces of both sides, and the frame that rotates its normal.
#
# From the cache, update_contact computes points, normal and separations at any pose, without a new narrow phase. They
# are exact to second order in the motion. The normal rotates with the side that has the reference face. A point at a
# corner follows the side with this corner. The core of a shape is its outline without the rounding; the core of a
# circle is its centre.

FACES = 1024  # smaller feature ids belong to points on a face, see hulls.py
SAME = 2.0**-20  # distance below which a point counts as a corner, as a fraction of the body's extent


@subkernel
def core_radius(shape):
    """Return the distance [px] from the core of a SHAPE row to its surface.

    The core is the shape without its rounding: the centre of a circle, the unrounded outline of a hull. The distance is
    the radius of a circle, the rounding of a hull, and 0 for other shapes.
    """
    return shape.radius if is_hull(shape.kind) and shape.kind != BOUNDS else 0.0


@subkernel
def is_ground(shape):
    """Return whether a SHAPE row is a tile grid or a chain.

    Feature ids of these shapes also contain the number of a tile run or link.
    """
    return shape.kind == TILES or shape.kind == CHAIN


@subkernel
def has_corners(shape):
    """Return whether a shape has corners in geometry.polygons, as all hulls have except circles and BOUNDS."""
    return is_hull(shape.kind) and shape.kind != BOUNDS and shape.kind != CIRCLE


@subkernel
def frame_of(a, b, feature, radii):
    """Return how the normal of a contact follows the rotation of the bodies: WITH_A, WITH_B, CORES or UPRIGHT.

    WITH_A, WITH_B: the normal rotates with body A or B. UPRIGHT: it never rotates. CORES: it is the direction between
    two points, one on A's core and one on B's core. A core is a shape without its rounding, see core_radius. a, b:
    SHAPE rows; feature: feature id of the first contact point; radii [px]: sum of both core radii.
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
    """Return whether a point is at one corner of a hull's core, the outline without the rounding.

    polygons, table: geometry.polygons and geometry.corners; body, shape: BODY and SHAPE row of the hull; corner: index
    of the corner, where an index past the end means corner 0; local_x, local_y [px]: the point in body space.
    """
    span = polygons[shape.geometry]
    c = table[span.offset + (corner if corner < span.count else 0)]
    return norm(c.x - local_x, c.y - local_y) <= SAME * body.extent


@subkernel
def core_in_body(body, turn, x, y, nx, ny, inside, behind):
    """Displace a contact point, from the surface to the core of a shape. Return the result (x, y) [px] in body space.

    x, y [px]: the contact point in the world; nx, ny: normal; inside [px]: displacement along the normal; behind [px]:
    displacement along (ny, -nx), the opposite of the tangent; body: BODY row; turn: (cosine, sine) of its angle.
    """
    return rotate(x + inside * nx + behind * ny - body.x, y + inside * ny - behind * nx - body.y, turn[0], -turn[1])


@subkernel
def share_of(polygons, table, body_a, body_b, contact, a, b, second):
    """Return which body a contact point moves with if the bodies slide along the face: 0 for A, 1 for B, 0.5 for both.

    A point at a corner or on a circle moves with the body that has the corner or circle. A point that is clipped by the
    end of a face moves with the body that has the face.

    polygons, table: geometry.polygons and geometry.corners; body_a, body_b: BODY rows; contact: CONTACT row with local
    points already written; a, b: SHAPE rows; second: True for the second point.
    """
    part = (contact.feature_2 if second else contact.feature_1) % PART
    if a.kind == MASK or b.kind == MASK:
        return 0.5
    if a.kind == CIRCLE or b.kind == CIRCLE:
        return 0.0 if a.kind == CIRCLE else 1.0
    if part >= FACES:
        return 0.5
    with_a = (part % 2 == 0) != is_ground(b)
    face_share = 0.0 if with_a else 1.0
    local_ax = contact.local_ax_2 if second else contact.local_ax_1
    local_ay = contact.local_ay_2 if second else contact.local_ay_1
    local_bx = contact.local_bx_2 if second else contact.local_bx_1
    local_by = contact.local_by_2 if second else contact.local_by_1
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
def write_cache(polygons, table, bodies, shapes, contact_inout):
    """Write the cache fields of a newly detected CONTACT row, from the present poses of its bodies.

    polygons, table: geometry.polygons and geometry.corners. The cached points are on the cores of both shapes, because
    a point on a round surface would rotate away with the body.
    """
    c = contact_inout
    a, b = bodies[c.body_row_a], bodies[c.body_row_b]
    s, o = shapes[c.row_a], shapes[c.row_b]
    c.radius_a = core_radius(s)
    c.radius_b = core_radius(o)
    c.frame = frame_of(s, o, c.feature_1, c.radius_a + c.radius_b)
    turn_a, turn_b = rotation_of(a.angle), rotation_of(b.angle)
    nx, ny = c.normal_x, c.normal_y
    c.local_nx, c.local_ny = nx, ny
    if c.frame == WITH_A:
        c.local_nx, c.local_ny = rotate(nx, ny, turn_a[0], -turn_a[1])
    elif c.frame == WITH_B:
        c.local_nx, c.local_ny = rotate(nx, ny, turn_b[0], -turn_b[1])
    c.angle_a, c.angle_b = a.angle, b.angle
    c.held_nx, c.held_ny = nx, ny
    c.apart_x, c.apart_y = b.center_x - a.center_x, b.center_y - a.center_y
    c.slips = False
    c.slipped = 0.0
    c.held_ax_1, c.held_ay_1 = c.x_1 - a.center_x, c.y_1 - a.center_y
    c.held_ax_2, c.held_ay_2 = 0.0, 0.0
    half = 0.5 * c.separation_1
    c.local_ax_1, c.local_ay_1 = core_in_body(a, turn_a, c.x_1, c.y_1, nx, ny, -(half + c.radius_a), 0.0)
    c.local_bx_1, c.local_by_1 = core_in_body(b, turn_b, c.x_1, c.y_1, nx, ny, half + c.radius_b, c.tangential_offset)
    c.base_1 = c.separation_1
    c.share_1 = share_of(polygons, table, a, b, c, s, o, False)
    c.local_ax_2, c.local_ay_2, c.local_bx_2 = 0.0, 0.0, 0.0
    c.local_by_2, c.base_2 = 0.0, 0.0
    c.share_2 = 0.5
    if c.count == 2:
        c.held_ax_2, c.held_ay_2 = c.x_2 - a.center_x, c.y_2 - a.center_y
        half = 0.5 * c.separation_2
        c.local_ax_2, c.local_ay_2 = core_in_body(a, turn_a, c.x_2, c.y_2, nx, ny, -(half + c.radius_a), 0.0)
        c.local_bx_2, c.local_by_2 = core_in_body(
            b, turn_b, c.x_2, c.y_2, nx, ny, half + c.radius_b, c.tangential_offset
        )
        c.base_2 = c.separation_2
        c.share_2 = share_of(polygons, table, a, b, c, s, o, True)


@subkernel
def reset_impulses(contact_out):
    """Clear the cached warm-start forces and the graph colour of a CONTACT row."""
    c = contact_out
    c.color = -1
    c.rolling_force, c.normal_force_1, c.tangent_force_1 = 0.0, 0.0, 0.0
    c.normal_force_2, c.tangent_force_2 = 0.0, 0.0


@kernel
def write_caches(geometry, bodies, shapes, contacts_inout):
    """Write the cache fields of newly detected contacts, and clear all their forces. O(contacts).

    The bodies must still have the poses at which the contacts were detected. contacts_inout: CONTACT rows.
    """
    for i in range(len(contacts_inout)):
        reset_impulses(contacts_inout[i])
        write_cache(geometry.polygons, geometry.corners, bodies, shapes, contacts_inout[i])


# ---- update ----------------------------------------------------------------------------------------------------------
# Update of contacts after a motion of their bodies: points, normal and separations at any pose, from the cache.


@inlined
def cores_at(a, turn_a, b, turn_b, local_ax, local_ay, local_bx, local_by):
    """Return the world positions of two cached points of a contact as (ax, ay, dx, dy) [px].

    The cache stores each contact point twice: as a point on A's core, and as a point on B's core. A core is a shape
    without its rounding, see core_radius. ax, ay: the point on A's core; dx, dy: vector from this point to the point on
    B's core.

    a, b: BODY rows; turn_a, turn_b: (cosine, sine) of their angles; local_ax, local_ay [px]: the point on A's core in
    the space of body A; local_bx, local_by [px]: the point on B's core in the space of body B.
    """
    ax, ay = rotate(local_ax, local_ay, turn_a[0], turn_a[1])
    bx, by = rotate(local_bx, local_by, turn_b[0], turn_b[1])
    ax += a.x
    ay += a.y
    return ax, ay, (b.x + bx) - ax, (b.y + by) - ay


@inlined
def clipped_gap(gap, core, other, apart, with_a, normal, wander):
    """Correct the gap between the cores at a clipped contact point. Return (gap [px], whether it was corrected).

    A clipped point is one that the end of a face cuts out of the other body's edge. If the bodies slide, it moves along
    this edge, which changes the gap. The edge is the line through the core points (see cores_at) of the body without
    the face.

    gap [px]: gap before the correction. core [px]: vector from A's to B's core point at this contact point; other [px]:
    the same vector at the other contact point. apart [px]: vector from A's core point at this contact point to A's core
    point at the other. with_a: whether A has the face; normal: unit normal of the contact; wander [px]: smaller
    corrections are omitted.
    """
    nx, ny = normal
    edge_x = apart[0] + (other[0] - core[0] if with_a else 0.0)
    edge_y = apart[1] + (other[1] - core[1] if with_a else 0.0)
    along = edge_y * nx - edge_x * ny
    across = edge_x * nx + edge_y * ny
    rise = (core[1] * nx - core[0] * ny) * across
    # A hull edge that is steep against the face is not the incident edge.
    if abs(across) >= abs(along) or along == 0.0 or abs(rise) <= wander * abs(along):
        return gap, False
    return gap - rise / along, True


@inlined
def is_clipped(contact, share):
    """Return whether a contact point was clipped by the end of a face. share: result of share_of for this point."""
    return (contact.frame == WITH_A and share == 0.0) or (contact.frame == WITH_B and share == 1.0)


@inlined
def point_of(ax, ay, dx, dy, normal, gap, share, radii):
    """Return (x, y, separation) [px] of a contact point in the world.

    ax, ay, dx, dy [px]: result of cores_at; gap [px]: gap between the cores along the normal, corrected by clipped_gap;
    share: result of share_of; radii [px]: (A's, B's) core radius.
    """
    nx, ny = normal
    radius_a, radius_b = radii
    apart = dx * nx + dy * ny
    middle = 0.5 * (radius_a + (gap - radius_b)) + share * (apart - gap)
    x = ax + share * (dx - apart * nx) + middle * nx
    y = ay + share * (dy - apart * ny) + middle * ny
    return x, y, gap - radius_a - radius_b


@inlined
def update_contact(a, turn_a, b, turn_b, wander, contact_inout):
    """Write the points, normal and separations [px] of a contact at the present poses, from its cache.

    Return (moved, rolled, corrected). moved [px]: greatest relative motion of a point since detection, along the face
    or the normal. rolled [px]: motion of the contact around a rounding since detection. corrected: whether clipped_gap
    corrected a point. a, b: BODY rows; turn_a, turn_b: (cosine, sine) of their angles; wander [px]: smaller corrections
    of a clipped point are omitted, all corrections if inf. contact_inout: CONTACT row.
    """
    c = contact_inout
    two = c.count == 2
    c.tangential_offset = 0.0
    ax_1, ay_1, dx_1, dy_1 = cores_at(a, turn_a, b, turn_b, c.local_ax_1, c.local_ay_1, c.local_bx_1, c.local_by_1)
    ax_2, ay_2, dx_2, dy_2 = ax_1, ay_1, dx_1, dy_1
    if two:
        ax_2, ay_2, dx_2, dy_2 = cores_at(a, turn_a, b, turn_b, c.local_ax_2, c.local_ay_2, c.local_bx_2, c.local_by_2)
    nx, ny = c.local_nx, c.local_ny
    moved = 0.0
    rolled = 0.0
    if c.frame == CORES:
        nx, ny = unit(dx_1, dy_1, c.normal_x, c.normal_y)
        # Relative to the normal at detection: a body that rolls around a corner leaves it.
        rolled = norm(nx - c.local_nx, ny - c.local_ny) * max(c.radius_a, c.radius_b)
    else:
        if c.frame == WITH_A:
            nx, ny = rotate(nx, ny, turn_a[0], turn_a[1])
        elif c.frame == WITH_B:
            nx, ny = rotate(nx, ny, turn_b[0], turn_b[1])
        moved = max(abs(dy_1 * nx - dx_1 * ny), abs(dy_2 * nx - dx_2 * ny))
    c.normal_x, c.normal_y = nx + 0.0, ny + 0.0
    gap_1, gap_2 = dx_1 * nx + dy_1 * ny, dx_2 * nx + dy_2 * ny
    wandered_1, wandered_2 = False, False
    if two and wander < math.inf:
        x, y = ax_2 - ax_1, ay_2 - ay_1
        with_a = c.frame == WITH_A
        first, second = (dx_1, dy_1), (dx_2, dy_2)
        if is_clipped(c, c.share_1):
            gap_1, wandered_1 = clipped_gap(gap_1, first, second, (x, y), with_a, (nx, ny), wander)
        if is_clipped(c, c.share_2):
            gap_2, wandered_2 = clipped_gap(gap_2, second, first, (-x, -y), with_a, (nx, ny), wander)
    radii = (c.radius_a, c.radius_b)
    c.x_1, c.y_1, c.separation_1 = point_of(ax_1, ay_1, dx_1, dy_1, (nx, ny), gap_1, c.share_1, radii)
    moved = max(moved, abs(c.separation_1 - c.base_1))
    if two:
        c.x_2, c.y_2, c.separation_2 = point_of(ax_2, ay_2, dx_2, dy_2, (nx, ny), gap_2, c.share_2, radii)
        moved = max(moved, abs(c.separation_2 - c.base_2))
    return moved, rolled, wandered_1 or wandered_2


@kernel
def update_contacts(bodies, contacts_inout):
    """Update the points, normals and separations of all contacts to the present poses of the bodies. O(contacts).

    contacts_inout: CONTACT rows.
    """
    row_a, row_b = -1, -1
    turn_a = (1.0, 0.0)
    turn_b = (1.0, 0.0)
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a, b = bodies[c.body_row_a], bodies[c.body_row_b]
        # The contacts of a pair, and often all contacts of a body, are adjacent.
        if c.body_row_a != row_a:
            row_a = c.body_row_a
            turn_a = rotation_of(a.angle)
        if c.body_row_b != row_b:
            row_b = c.body_row_b
            turn_b = rotation_of(b.angle)
        update_contact(a, turn_a, b, turn_b, 0.0, c)


# ---- recycle ---------------------------------------------------------------------------------------------------------
# Contact recycling: a manifold of the last step is updated and used again, without a new narrow phase. The test whether
# this is possible runs at the end of a step for the next step, and again at the start for bodies that moved meanwhile.
#
# Source: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.


@inlined
def is_finite(contact):
    """Return whether normal, points and separations of a contact are finite (x - x == 0 only for finite x)."""
    m = contact
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0


@inlined
def recycle_distance(contact, distance):
    """Return the greatest relative motion [px] at which a contact is kept without a new narrow phase (recycled).

    The motion counts from the detection of the contact. For most contacts the result is `distance` [px]. It is
    RECYCLE_MOVE times `distance` for a contact whose points are updated exactly: it is loaded, has two points that are
    not close together (see RECYCLE_SHARE), and no rounding. Unloaded contacts are detected again earlier, because the
    shortest direction out of an overlap may change.
    """
    c = contact
    loaded = c.normal_force_1 > 0.0 or c.normal_force_2 > 0.0
    if c.count == 1 or not loaded or c.radius_a > 0.0 or c.radius_b > 0.0:
        return distance
    x, y = c.x_2 - c.x_1, c.y_2 - c.y_1
    far = RECYCLE_MOVE * distance
    return far if far * far <= RECYCLE_SHARE * RECYCLE_SHARE * (x * x + y * y) else distance


@inlined
def can_recycle(shapes, a, turn_a, b, turn_b, distance, wander, contact_inout):
    """Update a contact to the present poses, and return whether the next step can use it without a new narrow phase.

    Three conditions must hold. The points have moved by at most recycle_distance. Relative rotation has moved them by
    at most `distance` [px]. No clipped point needs a correction of more than `wander` [px]. shapes: SHAPE rows; a, b:
    BODY rows; turn_a, turn_b: (cosine, sine) of their angles. contact_inout: CONTACT row.
    """
    c = contact_inout
    moved, rolled, wandered = update_contact(a, turn_a, b, turn_b, wander, c)
    # The manifold lies within both sides: a rotation moves its points by at most the extent of the smaller one.
    reach = min(a.extent, b.extent) if min(a.extent, b.extent) > 0.0 else max(a.extent, b.extent)
    turn = abs((b.angle - c.angle_b) - (a.angle - c.angle_a)) * reach
    if turn > distance and (shapes[c.row_a].kind == CIRCLE or shapes[c.row_b].kind == CIRCLE):
        turn = 0.0  # a disc may rotate freely
    near = max(rolled, turn) <= distance and moved <= recycle_distance(c, distance) and not wandered
    return near and is_finite(c) and 0.0 <= c.share_1 <= 1.0 and 0.0 <= c.share_2 <= 1.0


@inlined
def is_settled(body):
    """Return whether a BODY row has the pose at which its centre of mass was last computed."""
    return body.x == body.settled_x and body.y == body.settled_y and body.angle == body.settled_angle


@inlined
def is_unmoved(body):
    """Return whether a BODY row still has the pose to which the last step updated its contacts.

    Moving a body through the API clears has_current_contacts. A direct write to the table is detected by the pose.
    """
    return body.has_current_contacts and is_settled(body)


# ---- final poses -----------------------------------------------------------------------------------------------------
# Update of AABBs, rasters and contacts to the final poses of a step, in a world with a stacking solver.
#
# Solver, sweep and characters move the bodies one after another. Reports, sensors and sleeping use the state after all
# of these. Contacts are updated from the cache, without a second detection.


@subkernel
def update_and_flag(shapes, distance, bodies_inout, contacts_inout):
    """Update all contacts to the present poses, and write CONTACT.can_recycle for the next step. O(contacts).

    Also write BODY.has_current_contacts of the bodies in contact. distance [px]: see can_recycle. contacts_inout:
    CONTACT rows.
    """
    row_a, row_b = -1, -1
    turn_a = (1.0, 0.0)
    turn_b = (1.0, 0.0)
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a, b = bodies_inout[c.body_row_a], bodies_inout[c.body_row_b]
        # The contacts of a pair, and often all contacts of a body, are adjacent.
        if c.body_row_a != row_a:
            row_a = c.body_row_a
            turn_a = rotation_of(a.angle)
            a.has_current_contacts = is_settled(a)
        if c.body_row_b != row_b:
            row_b = c.body_row_b
            turn_b = rotation_of(b.angle)
            b.has_current_contacts = is_settled(b)
        fits = can_recycle(shapes, a, turn_a, b, turn_b, distance, RECYCLE_WANDER * distance, c)
        if not fits:
            update_contact(a, turn_a, b, turn_b, 0.0, c)
        c.can_recycle = fits and not c.swept


@kernel
def update_final_poses(shape_rows, geometry, distance, bodies_inout, shapes_inout, contacts_inout):
    """Update the AABBs of the given shapes, and all contacts, to the present poses. O(rows + contacts).

    shape_rows: row numbers in SHAPE; distance [px]: see can_recycle. bodies_inout: BODY table; shapes_inout: SHAPE
    table; contacts_inout: CONTACT rows.
    """
    refresh_boxes(shape_rows, geometry, bodies_inout, shapes_inout)
    update_and_flag(shapes_inout, distance, bodies_inout, contacts_inout)


@stage(
    "final_poses",
    reads=("tolerances", "awake", "bodies", "shapes", "library", "contact_rows"),
    writes=("contact_rows", "library", "bodies.has_current_contacts", *PLACED),
)
def update_contacts_at_final_poses(state: StepState) -> None:
    """Update AABBs and contacts (points, normals, separations) to the final poses of the step."""
    rows, bodies, shapes = state.awake.shapes, state.bodies, state.shapes
    # A body rotated by the solver may be at an angle without a raster.
    add_missing_rasters(state.library, rows, bodies, shapes, 0.0)
    distance = state.tolerances.recycle
    update_final_poses(rows, state.library.tables, distance, bodies, shapes, state.contact_rows)


# ---- removed rows ----------------------------------------------------------------------------------------------------


@kernel
def copy_kept(contacts, new_bodies, new_shapes, kept_out):
    """Copy the contacts whose bodies and shapes still exist to kept_out, with new row numbers. Return their number.

    O(contacts). contacts: CONTACT rows with the row numbers before a removal. new_bodies, new_shapes: int64 new row
    number for each old row, negative for a removed row.
    """
    found = 0
    for i in range(len(contacts)):
        c = contacts[i]
        body_a, body_b = new_bodies[c.body_row_a], new_bodies[c.body_row_b]
        row_a, row_b = new_shapes[c.row_a], new_shapes[c.row_b]
        if min(body_a, body_b, row_a, row_b) >= 0:
            k = kept_out[found]
            copy_row(c, k)
            k.body_row_a, k.body_row_b = body_a, body_b
            k.row_a, k.row_b = row_a, row_b
            found += 1
    return found


def drop_contacts(tables: WorldTables, new_bodies: np.ndarray, new_shapes: np.ndarray) -> None:
    """Drop the contacts of removed bodies and shapes, and update the row numbers in the remaining contacts.

    new_bodies, new_shapes: int64 new number of each row before the removal, negative for a removed row; tables: a World
    or StepState.
    """
    found = tables.contact_rows
    if len(found):
        kept = np.empty(len(found), CONTACT)
        tables.contact_rows = kept[: copy_kept(found, new_bodies, new_shapes, kept)]


def shift_center(contacts: np.ndarray, identity: int, dx: float, dy: float) -> None:
    """Update cached contacts after the centre of mass of a body has moved within the body, for example by carving.

    contacts: CONTACT rows, changed in place; identity: body id; dx, dy [px]: displacement of the centre, in world axes.
    """
    for name, sign in (("body_a", -1.0), ("body_b", 1.0)):
        rows = contacts[name] == identity
        contacts["apart_x"][rows] += sign * dx
        contacts["apart_y"][rows] += sign * dy
        if name == "body_a":
            for axis, change in (("x", dx), ("y", dy)):
                contacts[f"held_a{axis}_1"][rows] -= change
                contacts[f"held_a{axis}_2"][rows] -= change
