"""CONTACT rows: functions that write, sort and report them, mix materials, and run the passes over candidate pairs."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics.collision.hulls import ALL_EDGES, Hull, aabb_corners, part_of, write_normals
from physics.jit import copy_head, inlined, kernel, subkernel
from physics.math2d import norm, rotate, rotation_of
from physics.shapes.placement import polygon_at
from physics.tables.contact import CONTACT, CONTACT_POINT, MANIFOLD_BYTES
from physics.tables.geometry import Geometry
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, TILES

# ---- owners ----------------------------------------------------------------------------------------------------------
# Manifolds for reports: they name whole shapes (parents), not the parts that touch.

SIDES = ("body_", "shape_", "parent_", "body_row_", "row_")


@kernel
def are_whole(manifolds):
    """Return whether all manifolds are between whole shapes: no side is a part of a larger shape. O(manifolds)."""
    for i in range(len(manifolds)):
        m = manifolds[i]
        if m.of_child:
            return False
    return True


def by_parent(manifolds: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Return (CONTACT rows that name whole shapes instead of their parts, index in `manifolds` of each row).

    The rows are sorted by the ids of the whole shapes; A is the shape with the smaller id. If no contact is with a part
    of a larger shape, the result is (`manifolds` itself, None).
    """
    if are_whole(manifolds):
        return manifolds, None
    a, b = manifolds["parent_a"], manifolds["parent_b"]
    order = np.lexsort((np.maximum(a, b), np.minimum(a, b)))
    found = manifolds[order]
    found["shape_a"], found["shape_b"], found["of_child"] = found["parent_a"], found["parent_b"], False
    swapped = np.flatnonzero(found["parent_a"] > found["parent_b"])
    if len(swapped):
        for name in SIDES:
            found[name + "a"][swapped], found[name + "b"][swapped] = (
                found[name + "b"][swapped],
                found[name + "a"][swapped],
            )
        for name in ("normal_x", "normal_y"):
            found[name][swapped] = 0.0 - found[name][swapped]
    return found, order


# ---- materials -------------------------------------------------------------------------------------------------------
# Mixed materials of a contact: friction, restitution, rolling resistance, surface speed.


@inlined
def mixed(geometry, a, b, manifold):
    """Return the mixed material of a contact: (friction, restitution, rolling resistance [px], surface speed [px/s]).

    Friction is the geometric mean of both shapes, restitution and rolling resistance are the greater value, surface
    speed is the sum. Rolling resistance is a length: the coefficient times the greater radius (Catto, Box2D v3.1). a,
    b: SHAPE rows; manifold: CONTACT row, whose feature id names the link of a chain, because each link may have its own
    material.
    """
    friction = 1.0
    restitution = 0.0
    rolling = 0.0
    radius = 0.0
    speed = 0.0
    for side in range(2):
        s = a if side == 0 else b
        own_friction = s.friction
        own_restitution = s.restitution
        own_rolling = s.rolling_resistance
        own_speed = s.surface_speed
        if s.kind == CHAIN:
            link = geometry.links[geometry.chains[s.geometry].offset + part_of(manifold.feature_1)]
            if link.friction >= 0.0:
                own_friction = link.friction
                own_restitution = link.restitution
                own_rolling = link.rolling_resistance
                own_speed = link.surface_speed
        friction *= own_friction
        restitution = max(restitution, own_restitution)
        rolling = max(rolling, own_rolling)
        speed += own_speed
        if s.kind != TILES and s.kind != CHAIN and s.kind != MASK:
            radius = max(radius, s.radius)
    return math.sqrt(friction), restitution, rolling * radius, speed


# ---- manifold --------------------------------------------------------------------------------------------------------
# Rows of the manifold table: written by the passes over pairs, then sorted in the order of the candidates.

# Kinds of pairs; each pass processes the candidates of one kind. AABBS: two Bounds; MASKS_EXACT: two masks, not both
# snapped; SURFACE_ANY: a chain that is the upper side of a one-way mask; NOTHING: no test.
CIRCLES, POLYGON_CIRCLE, AABBS, POLYGONS, MASKS, MASKS_EXACT, MASK_HULL, GRID_ANY, CHAIN_ANY = range(9)
SURFACE_ANY, NOTHING = 9, 10
HULLS = 4096  # most hulls that a pass keeps for further pairs, a power of two: 2 MB
BLOCK = 64  # candidates that a pass lists before it collides them
POINTS = 11  # floats of a manifold before it is stored: see "clipping" in hulls.py


class Batch(NamedTuple):
    """Input of a pass over the candidate pairs of the broad phase."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE
    candidates: np.ndarray  # (capacity, 2) int64 shape rows
    kinds: np.ndarray  # (count,) kind of each pair
    count: int  # number of candidates in use
    margin: float  # [px] largest gap of a pair that gets a contact
    bias: float  # [px] see hulls.collide_hulls
    graze: float = 0.0  # [px] largest overlap of bodies that only pass each other, see hull_pairs.py
    lookahead: float = 0.0  # [s] pairs that meet within this time get a contact, see hull_pairs.py
    skin: float = 0.0  # [px] separation of two lines that counts as 0, see hull_pairs.py


class Workspace(NamedTuple):
    """Scratch memory of the narrow phase, mostly for the pair that is being tested."""

    a: np.ndarray  # (16, 4) corners [px], with normals where a test needs them: see hulls.write_normals
    b: np.ndarray
    c: np.ndarray
    points: np.ndarray  # (POINTS,) manifold of the pair, see "clipping" in hulls.py
    depths: np.ndarray  # (16,)
    previous: np.ndarray  # CONTACT rows of the last step, for pairs with one-way ground
    memory: np.ndarray  # (candidates, 2) first row of each pair in `previous`, number of its rows
    block: np.ndarray  # (BLOCK,) candidates that a pass collides next
    hulls: np.ndarray  # (16 · n, 4) corners and normals of the shapes that this pass has placed, see hull_in
    hull_rows: np.ndarray  # (n, 2) SHAPE row of each of them or -1, and its number of corners; n is a power of two
    fallback: np.ndarray  # (candidates + 1,) number of candidates for the fallback of mask_parts.py, then their indices


def new_workspace() -> Workspace:
    """Return a new Workspace whose arrays for candidate pairs are empty."""
    return Workspace(
        np.zeros((16, 4)),
        np.zeros((16, 4)),
        np.zeros((16, 4)),
        np.zeros(POINTS),
        np.zeros(16),
        np.zeros(0, CONTACT),
        np.zeros((0, 2), np.int64),
        np.zeros(BLOCK, np.int64),
        *empty_hulls(1),
        np.zeros(2, np.int64),
    )


def empty_hulls(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return (hulls, hull_rows) for a Workspace, with room for `count` hulls (a power of two), none stored."""
    return np.zeros((16 * count, 4)), np.full((count, 2), -1)


@subkernel
def queue_fallback(pair, fallback_inout):
    """Append a candidate pair (index) to the queue of the deep-penetration fallback of mask_parts.py.

    fallback_inout: number of queued pairs, followed by their indices.
    """
    fallback_inout[0] += 1
    fallback_inout[fallback_inout[0]] = pair


@subkernel
def open_manifold(shapes, candidates, pair, nx, ny, manifold_out):
    """Initialize a CONTACT row for candidate number `pair`, with the normal (nx, ny) and no points.

    shapes: SHAPE table; candidates: pairs of row numbers in it; manifold_out: the CONTACT row.
    """
    row_a = candidates[pair, 0]
    row_b = candidates[pair, 1]
    a, b = shapes[row_a], shapes[row_b]
    m = manifold_out
    m.body_a, m.body_b = a.body, b.body
    m.shape_a, m.shape_b = a.id, b.id
    m.parent_a, m.parent_b = a.parent, b.parent
    m.of_child = a.parent != a.id or b.parent != b.id
    m.body_row_a, m.body_row_b = a.body_row, b.body_row
    m.row_a, m.row_b = row_a, row_b
    m.candidate = pair
    m.previous = -1
    m.count = 0
    m.normal_x, m.normal_y = nx, ny
    m.tangential_offset = 0.0
    m.sensor = a.sensor or b.sensor
    m.swept, m.persisted_1, m.persisted_2 = False, False, False
    m.can_recycle, m.of_new_pair = False, False
    m.normal_impulse_1, m.tangent_impulse_1 = 0.0, 0.0
    m.normal_impulse_2, m.tangent_impulse_2 = 0.0, 0.0


@subkernel
def add_manifold(shapes, candidates, pair, point, manifolds_out, found):
    """Append a contact with one point to manifolds_out. Return the new number of contacts.

    If manifolds_out is full, nothing is written, but the number still grows, so the caller sees the size needed. pair:
    index of the candidate; point: (unit normal x and y from A to B, x, y, separation [px], shared area [px2], feature
    id); found: number of contacts before. The approach speed is written later, by `approach`. manifolds_out: CONTACT
    rows.
    """
    if found < len(manifolds_out):
        nx, ny, x, y, separation, area, feature = point
        m = manifolds_out[found]
        # Adding 0.0 turns -0.0 into 0.0, for printing and comparison.
        open_manifold(shapes, candidates, pair, nx + 0.0, ny + 0.0, m)
        m.count = 1
        m.x_1, m.y_1 = x, y
        m.separation_1 = separation
        m.area_1 = area
        m.feature_1 = feature
    return found + 1


@subkernel
def add_point(shapes, candidates, pair, point, manifolds_out, found):
    """Add a point to the last contact if it has one point and the same pair and normal, else append a new contact.

    Return the new number of contacts, which may exceed the capacity of manifolds_out. Arguments as in add_manifold.
    """
    nx, ny, x, y, separation, area, feature = point
    if 0 < found <= len(manifolds_out):
        m = manifolds_out[found - 1]
        if m.candidate == pair and m.count == 1 and m.normal_x == nx and m.normal_y == ny:
            m.count = 2
            m.x_2, m.y_2 = x, y
            m.separation_2 = separation
            m.area_2 = area
            m.feature_2 = feature
            return found
    return add_manifold(shapes, candidates, pair, point, manifolds_out, found)


@subkernel
def add_points(shapes, candidates, pair, sign, points, part, manifolds_out, found):
    """Append a contact with the manifold `points` (11,), format in hulls.clip_edges. Return the new number of contacts.

    sign: -1.0 if A and B were swapped for the test, else 1.0; part: offset added to the feature ids; pair, found: as in
    add_manifold. manifolds_out: CONTACT rows.
    """
    for k in range(int(points[0])):
        at = 3 + 4 * k
        nx, ny = sign * points[1], sign * points[2]
        point = (nx, ny, points[at], points[at + 1], points[at + 2], 0.0, part + int(points[at + 3]))
        found = add_point(shapes, candidates, pair, point, manifolds_out, found)
    return found


@inlined
def boxes_apart(a, b, margin):
    """Return whether the AABBs of two SHAPE rows are farther apart than `margin` [px] along an axis.

    An AABB or a margin that is not a number counts as apart.
    """
    return not (
        (a.min_x - margin <= b.max_x)
        & (b.min_x - margin <= a.max_x)
        & (a.min_y - margin <= b.max_y)
        & (b.min_y - margin <= a.max_y)
    )


@subkernel
def circle_at(bodies, shapes, row):
    """Return (x, y, radius) [px] of a CIRCLE shape in the world. row: row number in SHAPE.

    A circle whose centre is the body's origin needs no sine and cosine.
    """
    s = shapes[row]
    b = bodies[s.body_row]
    u, v = s.local_x, s.local_y
    if u != 0.0 or v != 0.0:
        u, v = rotate(u, v, *rotation_of(b.angle))
    return b.x + u, b.y + v, s.radius


@inlined
def hull_with(shape, corners, count):
    """Return the Hull of a SHAPE row from its world corners. count: number of corners."""
    return Hull(corners, count, 0.0 if shape.kind == BOUNDS else shape.radius, ALL_EDGES ^ shape.inner)


@inlined
def hull_of(geometry, bodies, shapes, row, corners_out):
    """Return the Hull of a shape in the world. A BOUNDS has the corners of its AABB, a CIRCLE has one corner.

    row: row number in SHAPE; corners_out (16, 4) receives the corners [px] and edge normals, see hulls.write_normals.
    """
    s = shapes[row]
    b = bodies[s.body_row]
    if s.kind == BOUNDS:
        count = aabb_corners(s, corners_out)
    elif s.kind == CIRCLE:
        corners_out[0, 0], corners_out[0, 1], _ = circle_at(bodies, shapes, row)
        count = 1
    else:
        c = math.cos(b.angle)
        count = polygon_at(geometry.polygons, geometry.corners, s.geometry, b.x, b.y, c, math.sin(b.angle), corners_out)
    if count > 1:
        write_normals(count, corners_out)
    return hull_with(s, corners_out, count)


@inlined
def hull_in(batch, row, workspace):
    """Return the Hull, in the world, of a shape with two or more corners. The Hull is cached for a pass.

    row: row number in SHAPE. The cache is direct-mapped: two shapes may have the same slot of workspace.hulls, and the
    second one overwrites the Hull of the first. batch: see Batch.
    """
    place = row & (len(workspace.hull_rows) - 1)
    corners = workspace.hulls[16 * place : 16 * place + 16]
    s = batch.shapes[row]
    if workspace.hull_rows[place, 0] != row:
        hull = hull_of(batch.geometry, batch.bodies, batch.shapes, row, corners)
        workspace.hull_rows[place, 0] = row
        workspace.hull_rows[place, 1] = hull.count
    return hull_with(s, corners, workspace.hull_rows[place, 1])


@inlined
def hulls_in(batch, row_a, row_b, workspace):
    """Return (Hull of shape A, Hull of shape B) in the world, see hull_in. row_a, row_b: row numbers in SHAPE."""
    a = hull_in(batch, row_a, workspace)
    if ((row_a ^ row_b) & (len(workspace.hull_rows) - 1)) == 0:  # both have the same place
        b = hull_of(batch.geometry, batch.bodies, batch.shapes, row_b, workspace.b)
    else:
        b = hull_in(batch, row_b, workspace)
    return a, b


# ---- passes ----------------------------------------------------------------------------------------------------------
# A pass over the candidate pairs: the same loop for each kind of pair.


@inlined
def always(batch, pair):
    """Return True: the test `may_touch` of a pass that collides every pair of its kind, see make_pass."""
    return True


def make_pass(kind: int, collide_pair: Callable, may_touch: Callable = always) -> Any:
    """Return a kernel that tests all candidate pairs of one kind.

    collide_pair(batch, pair, workspace, manifolds_out, found, work_inout) appends the contacts of candidate number
    `pair` at row `found`, and returns the new number of contacts. work_inout: counters of work done. may_touch(batch,
    pair) is a cheap test that selects pairs. The kernel first tests a block of pairs without branches, then collides
    the selected pairs, which avoids branch mispredictions. Both functions must be inlined: passing a whole Batch to a
    call costs more than a test of two circles.
    """

    @kernel
    def collide_pairs(batch, workspace, manifolds_out, found, work_inout):
        """Append the contacts of all pairs of this kind at row `found`. Return the new number of contacts.

        Arguments: as of collide_pair in make_pass. O(candidates).
        """
        kinds = batch.kinds
        block = workspace.block
        for start in range(0, batch.count, BLOCK):
            count = 0
            for pair in range(start, min(start + BLOCK, batch.count)):
                if kinds[pair] == kind:
                    block[count] = pair
                    count += int(may_touch(batch, pair))
            for k in range(count):
                found = collide_pair(batch, block[k], workspace, manifolds_out, found, work_inout)
        return found

    return collide_pairs


@inlined
def sides_by_kind(batch, pair, kind):
    """Return (sign, row number of the pair's shape of the given kind, row number of its other shape).

    sign: 1.0 if the shape of this kind is A, -1.0 if it is B. The row numbers are in SHAPE. pair: index of the
    candidate; batch: a Batch.
    """
    row_a = batch.candidates[pair, 0]
    row_b = batch.candidates[pair, 1]
    if batch.shapes[row_a].kind == kind:
        return 1.0, row_a, row_b
    return -1.0, row_b, row_a


# ---- order -----------------------------------------------------------------------------------------------------------
# Manifolds in the order of their candidates, and conversion to reported rows.


@subkernel
def copy_manifold(contacts, source, target, contacts_out):
    """Copy row `source` of `contacts` to row `target` of contacts_out, except the fields of the contact cache."""
    copy_head(contacts[source], contacts_out[target], MANIFOLD_BYTES)


@subkernel
def drop_empty(count, manifolds_inout):
    """Remove the contacts without points from the first `count` rows. Return the number of remaining contacts.

    The remaining contacts are moved to the front and keep their order. O(count). manifolds_inout: CONTACT rows.
    """
    kept = 0
    for i in range(count):
        if manifolds_inout[i].count > 0:
            if kept < i:
                copy_manifold(manifolds_inout, i, kept, manifolds_inout)
            kept += 1
    return kept


@subkernel
def is_before(contact, shape_a, shape_b):
    """Return whether a CONTACT row sorts before the rows of the pair of shapes with the ids shape_a and shape_b."""
    return contact.shape_a < shape_a or (contact.shape_a == shape_a and contact.shape_b < shape_b)


@subkernel
def is_of(contact, shape_a, shape_b):
    """Return whether a CONTACT row belongs to the pair of shapes with the ids shape_a and shape_b."""
    return contact.shape_a == shape_a and contact.shape_b == shape_b


@kernel
def place_in_order(manifolds, count, candidate_count, starts_out, manifolds_out):
    """Copy CONTACT rows to manifolds_out, sorted by candidate index (stable counting sort).

    count: number of rows in use; candidate_count: number of candidates; starts_out (candidates + 1,): scratch. O(rows +
    candidates).
    """
    for i in range(candidate_count + 1):
        starts_out[i] = 0
    for i in range(count):
        starts_out[manifolds[i].candidate + 1] += 1
    for i in range(candidate_count):
        starts_out[i + 1] += starts_out[i]
    for i in range(count):
        pair = manifolds[i].candidate
        at = starts_out[pair]
        starts_out[pair] = at + 1
        copy_manifold(manifolds, i, at, manifolds_out)


@kernel
def write_contacts(manifolds, contacts_out):
    """Write a CONTACT_POINT row for every point of the CONTACT rows. Return the number of points. O(contacts)."""
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        for k in range(m.count):
            c = contacts_out[found]
            c.body_a, c.body_b = m.body_a, m.body_b
            c.shape_a, c.shape_b = m.parent_a, m.parent_b
            c.normal_x, c.normal_y = m.normal_x, m.normal_y
            c.point_x = m.x_1 if k == 0 else m.x_2
            c.point_y = m.y_1 if k == 0 else m.y_2
            c.separation = m.separation_1 if k == 0 else m.separation_2
            c.normal_impulse = m.normal_impulse_1 if k == 0 else m.normal_impulse_2
            c.tangent_impulse = m.tangent_impulse_1 if k == 0 else m.tangent_impulse_2
            c.area = m.area_1 if k == 0 else m.area_2
            c.feature = m.feature_1 if k == 0 else m.feature_2
            found += 1
    return found


def contacts_of(manifolds: np.ndarray) -> np.ndarray:
    """Return the points of CONTACT rows as CONTACT_POINT rows, sorted by the ids of the whole shapes that touch."""
    manifolds, _ = by_parent(manifolds)
    contacts = np.zeros(int(manifolds["count"].sum()), CONTACT_POINT)
    write_contacts(manifolds, contacts)
    return contacts


# ---- approach --------------------------------------------------------------------------------------------------------
# Closing speed of two bodies at a contact: reported with hits and used by restitution.


@subkernel
def velocity_at(body, x, y):
    """Return the velocity (x, y) [px/s] of the point of a body at world position (x, y) [px]. body: BODY row."""
    return (
        body.vx - body.angular_velocity * (y - body.center_y),
        body.vy + body.angular_velocity * (x - body.center_x),
    )


@subkernel
def relative_velocity(a, b, ax, ay, bx, by):
    """Return the velocity (x, y) [px/s] of point (bx, by) of body B relative to point (ax, ay) of body A.

    a, b: BODY rows.
    """
    px, py = velocity_at(a, ax, ay)
    qx, qy = velocity_at(b, bx, by)
    return qx - px, qy - py


@subkernel
def center_velocity(a, b):
    """Return (vx, vy, speed) [px/s] of B relative to A, at the centre of mass of the smaller body.

    a, b: BODY rows.
    """
    x = a.center_x if a.extent < b.extent else b.center_x
    y = a.center_y if a.extent < b.extent else b.center_y
    vx, vy = relative_velocity(a, b, x, y, x, y)
    return vx, vy, norm(vx, vy)


@subkernel
def closing_speed_bound(a, b):
    """Return a speed [px/s] that two bodies do not exceed, alone or relative to each other.

    It is an upper bound of the speeds of both bodies, and of the relative speed that center_velocity returns. a, b:
    BODY rows.
    """
    distance = abs(b.center_x - a.center_x) + abs(b.center_y - a.center_y)
    turning = abs(a.angular_velocity) + abs(b.angular_velocity)
    return abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + turning * distance


@inlined
def closing_speed(a, b, x, y, nx, ny, tangential):
    """Return the approach speed [px/s] of two bodies along the normal at a contact point; negative if they separate.

    a, b: BODY rows; x, y [px]: the point; nx, ny: unit normal from A to B; tangential [px]: distance that B slides
    along (-ny, nx) until a predicted contact, 0 otherwise.
    """
    ax, ay = x - a.center_x, y - a.center_y
    bx, by = x - b.center_x + tangential * ny, y - b.center_y - tangential * nx
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return -(nx * vx + ny * vy)


@inlined
def approach(a, b, manifold_inout):
    """Write the approach speed [px/s] of each point of a CONTACT row, before the solver changes velocities.

    a, b: BODY rows of the two bodies.
    """
    m = manifold_inout
    m.speed_1 = closing_speed(a, b, m.x_1, m.y_1, m.normal_x, m.normal_y, m.tangential_offset)
    if m.count == 2:
        m.speed_2 = closing_speed(a, b, m.x_2, m.y_2, m.normal_x, m.normal_y, m.tangential_offset)


@kernel
def measure_approach(bodies, manifolds_inout):
    """Write the approach speed [px/s] of every point of the CONTACT rows, before the solver runs. O(contacts)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        approach(bodies[m.body_row_a], bodies[m.body_row_b], m)
