"""Passes over the candidate pairs of circles and other hulls, with speculative contacts."""

import math

from physics.collision.hulls import (
    ALL_EDGES,
    CIRCLE_CORNER,
    CORNERS,
    COVERED,
    LEFT,
    best_edge,
    collide_circles,
    collide_hull_circle,
    collide_hulls,
    collide_upright,
    edge_normal,
    faces_of,
    passes_by,
    upright_corners,
)
from physics.collision.manifold import (
    CIRCLES,
    POLYGON_CIRCLE,
    POLYGONS,
    add_point,
    add_points,
    circle_at,
    corners_of,
    leave,
)
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm
from physics.shapes.placement import polygon_at, rounding
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import BOUNDS, CIRCLE

# ---- approach --------------------------------------------------------------------------------------------------------
# Closing speed of two bodies at a contact: reported with hits and used by restitution.


@subkernel
def velocity_at(body, x, y):
    """Return the velocity [px/s] of a world point of a BODY row."""
    return (
        body.vx - body.angular_velocity * (y - body.center_y),
        body.vy + body.angular_velocity * (x - body.center_x),
    )


@subkernel
def closing(p, q, ax, ay, bx, by):
    """Return the velocity [px/s] of point b of body q relative to point a of body p."""
    px, py = velocity_at(p, ax, ay)
    qx, qy = velocity_at(q, bx, by)
    return qx - px, qy - py


@subkernel
def nearing(a, b):
    """Return the velocity [px/s] of B relative to A, BODY rows, at the centre of the smaller one, and its norm."""
    x = a.center_x if a.extent < b.extent else b.center_x
    y = a.center_y if a.extent < b.extent else b.center_y
    vx, vy = closing(a, b, x, y, x, y)
    return vx, vy, norm(vx, vy)


@subkernel
def most_nearing(a, b):
    """Return an upper bound [px/s] of both bodies' speeds and of their relative speed (nearing), BODY rows."""
    way = abs(b.center_x - a.center_x) + abs(b.center_y - a.center_y)
    turning = abs(a.angular_velocity) + abs(b.angular_velocity)
    return abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + turning * way


@inlined
def closing_speed(a, b, x, y, nx, ny, tangential_offset):
    """Return the closing speed [px/s] of B and A at a point [px] along the normal; negative when they separate.

    a, b: BODY rows; lead [px]: the tangential offset, see CONTACT.
    """
    ax = x - a.center_x
    ay = y - a.center_y
    bx = x - b.center_x + tangential_offset * ny
    by = y - b.center_y - tangential_offset * nx
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return -(nx * vx + ny * vy)


@inlined
def approach(a, b, manifold_inout):
    """Write the closing speed of both points of a CONTACT row of two bodies, BODY rows, before any response."""
    m = manifold_inout
    m.speed_1 = closing_speed(a, b, m.x_1, m.y_1, m.normal_x, m.normal_y, m.tangential_offset)
    if m.count == 2:
        m.speed_2 = closing_speed(a, b, m.x_2, m.y_2, m.normal_x, m.normal_y, m.tangential_offset)


@kernel
def measure_approach(bodies, manifolds_inout):
    """Write the closing speed of every point before any response. manifolds_inout CONTACT rows. O(manifolds)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        approach(bodies[m.body_row_a], bodies[m.body_row_b], m)


# ---- ahead -----------------------------------------------------------------------------------------------------------
# Speculative contacts: pairs that meet within the step, evaluated at the predicted contact and not at the start pose.
#
# A pair that closes by more than the margin in a step would first be seen overlapping, and be pushed back along its
# path. So B is moved relative to A, in a straight line, to the pose of contact or of least distance. The manifold is
# computed there; its gap is the distance left along that normal. The fixed margin is Box2D's b2_speculativeDistance
# (Catto). The search is conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996).

ADVANCES = 16  # most rounds for one pair; a pair that has not met by then is found when it is nearer
NEVER = -1.0


@subkernel
def is_swept(body, way):
    """Return whether a way [px] is longer than half the size of a body, BODY row.

    Such a body is left to continuous collision detection, or passes through where there is none.
    """
    return body.kind != STATIC and way > body.inradius


@subkernel
def reach_of(a, b, speed, margin, ahead):
    """Return the largest gap [px] at which two bodies, BODY rows, that close at a speed [px/s] get a contact.

    It is the margin, or the distance closed in `ahead` [s], also if one of the two is stopped.
    """
    way = ahead * max(speed, norm(a.vx, a.vy), norm(b.vx, b.vy))
    return margin if is_swept(a, way) or is_swept(b, way) else max(margin, way)


@subkernel
def reach_turning(a, b, speed, margin, ahead):
    """Return reach_of plus rotation: the largest gap [px] that corners may close by turning.

    The share of the rotation is at most half the extent of the smaller body.
    """
    way = ahead * speed
    if is_swept(a, way) or is_swept(b, way):
        return margin
    turn = ahead * (abs(a.angular_velocity) * a.extent + abs(b.angular_velocity) * b.extent)
    return max(margin, min(turn, 0.5 * min(a.extent, b.extent)))


@subkernel
def time_of_discs(dx, dy, radii, vx, vy):
    """Return the time [s] at which two discs touch, or NEVER.

    dx, dy: offset of the centres [px]; vx, vy: velocity of the second disc [px/s].
    """
    along = dx * vx + dy * vy
    square = vx * vx + vy * vy
    rest = dx * dx + dy * dy - radii * radii
    root = along * along - square * rest
    if along >= 0.0 or root < 0.0 or square == 0.0:
        return NEVER
    # The root that does not cancel.
    return rest / (-along + math.sqrt(root))


@subkernel
def time_of_nearest(dx, dy, vx, vy):
    """Return the time [s] at which two centres dx, dy apart [px] are nearest; the second moves at vx, vy [px/s]."""
    square = vx * vx + vy * vy
    return -(dx * vx + dy * vy) / square if square > 0.0 else 0.0


@subkernel
def move_corners(count, x, y, corners_inout):
    """Move corners by x, y [px]."""
    for k in range(count):
        corners_inout[k, 0] += x
        corners_inout[k, 1] += y


@subkernel
def time_of_hulls(a, a_count, b_count, radii, vx, vy, target, most, b_inout):
    """Return the time [s] at which two hulls are within the target [px], B moving at vx, vy [px/s] (conservative
    advancement); NEVER if not within `most` [s].

    a, b_inout: world corners, grown by the radii together. B's are left at that pose. O(corners²) a round.
    """
    time = 0.0
    for _ in range(ADVANCES):
        a_edge, _, of_a = best_edge(a, a_count, ALL_EDGES, b_inout, b_count)
        b_edge, _, of_b = best_edge(b_inout, b_count, ALL_EDGES, a, a_count)
        gap = max(of_a, of_b) - radii
        if gap <= target:
            return time
        if of_a >= of_b:
            nx, ny = edge_normal(a, a_count, a_edge)
        else:
            nx, ny = edge_normal(b_inout, b_count, b_edge)
            nx = -nx
            ny = -ny
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time  # least distance: a deflection must not drive the bodies into each other
        if gap - target > speed * (most - time):
            return NEVER
        # Half the target is left, so that rounding cannot miss it.
        span = (gap - 0.5 * target) / speed
        move_corners(b_count, span * vx, span * vy, b_inout)
        time += span
    return NEVER


@subkernel
def bring_together(margin, ahead, p, q, a, a_count, b_count, radii, b_inout):
    """Move B's corners to the predicted contact of two hulls if they close by more than the margin in this step.

    p, q: BODY rows of A and B; a, b_inout: world corners, grown by the radii together [px]. Return (time [s] or NEVER;
    velocity of B relative to A [px/s]; largest gap [px] of a contact point at that pose, for rotation closes gaps too).
    """
    if ahead == 0.0:
        return 0.0, 0.0, 0.0, margin
    vx, vy, speed = nearing(p, q)
    far = reach_of(p, q, speed, margin, ahead)
    reach = max(far, reach_turning(p, q, speed, margin, ahead))
    if far <= margin or ahead * speed <= margin:
        return 0.0, 0.0, 0.0, reach
    return time_of_hulls(a, a_count, b_count, radii, vx, vy, margin, ahead, b_inout), vx, vy, reach


@subkernel
def time_of_disc(corners, count, rounding, x, y, radius, vx, vy, target, most):
    """Return the time [s] at which a moving disc is within the target [px] of a hull; NEVER if not within `most` [s].

    x, y, radius [px], vx, vy [px/s]: the disc; corners: world corners of the hull, grown by the rounding [px].
    O(corners) a round.
    """
    time = 0.0
    for _ in range(ADVANCES):
        hit, nx, ny, _, _, gap, _ = collide_hull_circle(
            corners, count, ALL_EDGES, rounding, x + time * vx, y + time * vy, radius
        )
        if not hit or gap <= target:
            return time
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time
        if gap - target > speed * (most - time):
            return NEVER
        time += (gap - 0.5 * target) / speed
    return NEVER


@subkernel
def way_back(time, vx, vy, nx, ny):
    """Return the distances [px] that B, moved for a time [s] at vx, vy [px/s], has covered: against the normal, and
    along the tangent (-ny, nx)."""
    return -time * (vx * nx + vy * ny), time * (vy * nx - vx * ny)


@subkernel
def set_back(time, vx, vy, points_inout):
    """Convert a manifold in flight, computed with B moved for a time [s] at vx, vy [px/s], to B's present position.

    Return the tangential offset [px] of B until the contact.
    """
    nx = points_inout[1]
    ny = points_inout[2]
    way, tangential_offset = way_back(time, vx, vy, nx, ny)
    for k in range(int(points_inout[0])):
        at = 3 + 4 * k
        # Midway between the two surfaces at their present positions.
        points_inout[at] += 0.5 * way * nx
        points_inout[at + 1] += 0.5 * way * ny
        points_inout[at + 2] += way
    return tangential_offset


# ---- hull pairs ------------------------------------------------------------------------------------------------------
# Passes over the candidate pairs of circles and other hulls.
#
# Each pass runs through all candidates and takes those of its kind, so contacts come in the order of the candidates.


@subkernel
def lead_on(before, found, tangential_offset, manifolds_out):
    """Write the tangential offset [px] to the manifold added since there were `before`, if one was added."""
    if before < found <= len(manifolds_out):
        manifolds_out[before].tangential_offset = tangential_offset


@kernel
def collide_circle_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Append the contacts of all pairs of circles from `found` on. Return the new count."""
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    margin = batch.margin
    for i in range(batch.count):
        if kinds[i] != CIRCLES:
            continue
        ax, ay, a_radius = circle_at(bodies, shapes, candidates[i, 0])
        bx, by, b_radius = circle_at(bodies, shapes, candidates[i, 1])
        nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx, by, b_radius)
        tangential_offset = 0.0
        if separation > 0.0:
            p = bodies[shapes[candidates[i, 0]].body_row]
            q = bodies[shapes[candidates[i, 1]].body_row]
            if separation > margin:
                _, _, speed = nearing(p, q)
                if separation > reach_of(p, q, speed, margin, batch.ahead):
                    continue
            vx, vy = closing(p, q, ax, ay, bx, by)
            time = time_of_discs(bx - ax, by - ay, a_radius + b_radius, vx, vy)
            if time < 0.0:
                # Least distance: a deflection must not drive the bodies into each other.
                time = time_of_nearest(bx - ax, by - ay, vx, vy)
            # Pairs that touch in the next step are included: their present normal would deflect them in this one.
            if 0.0 < time <= 2.0 * batch.ahead:
                nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx + time * vx, by + time * vy, b_radius)
                way, tangential_offset = way_back(time, vx, vy, nx, ny)
                x += 0.5 * way * nx
                y += 0.5 * way * ny
                separation += way
        before = found
        found = add_point(shapes, candidates, i, found, nx, ny, x, y, separation, 0.0, 0, manifolds_out)
        lead_on(before, found, tangential_offset, manifolds_out)
    return found


@kernel
def collide_polygon_circle_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Append the contacts of all pairs of a hull of two or more corners and a circle. Return the new count."""
    geometry = batch.geometry
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    margin = batch.margin
    polygons = geometry.polygons
    table = geometry.corners
    for i in range(batch.count):
        if kinds[i] != POLYGON_CIRCLE:
            continue
        sign = -1.0 if shapes[candidates[i, 0]].kind == CIRCLE else 1.0
        polygon = candidates[i, 1] if sign < 0.0 else candidates[i, 0]
        circle = candidates[i, 0] if sign < 0.0 else candidates[i, 1]
        s = shapes[polygon]
        p = bodies[s.body_row]
        if s.kind == BOUNDS:
            n = corners_of(geometry, bodies, shapes, polygon, workspace.a)
        else:
            n = polygon_at(polygons, table, s.geometry, p.x, p.y, math.cos(p.angle), math.sin(p.angle), workspace.a)
        x, y, radius = circle_at(bodies, shapes, circle)
        time = 0.0
        vx = 0.0
        vy = 0.0
        reach = margin
        q = bodies[shapes[circle].body_row]
        if batch.ahead > 0.0:
            _, _, speed = nearing(p, q)
            reach = reach_of(p, q, speed, margin, batch.ahead)
            if reach > margin and batch.ahead * speed > margin:
                vx, vy = closing(p, q, x, y, x, y)
                time = time_of_disc(
                    workspace.a, n, rounding(shapes, polygon), x, y, radius, vx, vy, margin, batch.ahead
                )
                if time < 0.0:
                    continue
        hit, nx, ny, px, py, separation, feature = collide_hull_circle(
            workspace.a, n, ALL_EDGES ^ s.inner, rounding(shapes, polygon), x + time * vx, y + time * vy, radius
        )
        if not hit and feature == COVERED:
            leave(i, workspace.left)
        if hit and batch.graze < separation <= reach and feature >= CIRCLE_CORNER:
            wx, wy = closing(p, q, px, py, x, y)
            workspace.b[0, 0] = x
            workspace.b[0, 1] = y
            if passes_by(workspace.a, n, workspace.b, 1, rounding(shapes, polygon) + radius, wx, wy):
                continue
        if hit and separation <= reach:
            way, tangential_offset = way_back(time, vx, vy, nx, ny)
            # Midway between the present surfaces, measured on the polygon's side.
            px += 0.5 * way * nx
            py += 0.5 * way * ny
            if sign < 0.0:
                # A is the disc: move the point to where the polygon is now.
                px += tangential_offset * ny
                py -= tangential_offset * nx
            before = found
            found = add_point(
                shapes,
                candidates,
                i,
                found,
                sign * nx,
                sign * ny,
                px,
                py,
                separation + way,
                0.0,
                feature,
                manifolds_out,
            )
            lead_on(before, found, tangential_offset, manifolds_out)
    return found


@subkernel
def slides_by(a, na, b, nb, rounding, graze, p, q, manifold):
    """Return whether two hulls with a manifold do not meet in this step.

    Either corners pass each other, or a body passes a side that it would overlap by at most `graze` [px]. A side that
    ends slightly above the floor beside it must not stop a body; the small overlap is pushed out upwards. p, q: BODY
    rows of a and b.
    """
    least = manifold[5] if manifold[0] == 1.0 else min(manifold[5], manifold[9])
    corners = manifold[0] == 1.0 and manifold[6] >= CORNERS
    if least <= -graze:
        return False
    vx, vy = closing(p, q, manifold[3], manifold[4], manifold[3], manifold[4])
    if corners:
        return passes_by(a, na, b, nb, rounding - graze, vx, vy)
    along = vx * manifold[1] + vy * manifold[2]
    # Only a motion along the normal passes a side: a surface that a body slides on is touched all the time.
    return 2.0 * along * along > vx * vx + vy * vy and passes_by(a, na, b, nb, rounding - graze, vx, vy)


@kernel
def collide_polygon_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Append the contacts of all pairs of hulls of two or more corners from `found` on. Return the new count."""
    geometry = batch.geometry
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    margin = batch.margin
    manifold = workspace.points
    a = workspace.a
    b = workspace.b
    polygons = geometry.polygons
    table = geometry.corners
    for i in range(batch.count):
        if kinds[i] != POLYGONS:
            continue
        s = shapes[candidates[i, 0]]
        o = shapes[candidates[i, 1]]
        p = bodies[s.body_row]
        q = bodies[o.body_row]
        if s.kind == BOUNDS and o.kind == BOUNDS:
            points = collide_upright(s, o, margin, manifold)
            if points == 1 and manifold[5] > 0.0:
                vx, vy = closing(p, q, manifold[3], manifold[4], manifold[3], manifold[4])
                if passes_by(a, upright_corners(s, a), b, upright_corners(o, b), 0.0, vx, vy):
                    continue
            found = add_points(shapes, candidates, i, found, 1.0, manifold, points, 0, manifolds_out)
            continue
        if s.kind == BOUNDS or o.kind == BOUNDS:
            na = corners_of(geometry, bodies, shapes, candidates[i, 0], a)
            nb = corners_of(geometry, bodies, shapes, candidates[i, 1], b)
        else:
            na = polygon_at(polygons, table, s.geometry, p.x, p.y, math.cos(p.angle), math.sin(p.angle), a)
            nb = polygon_at(polygons, table, o.geometry, q.x, q.y, math.cos(q.angle), math.sin(q.angle), b)
        a_radius = 0.0 if s.kind == BOUNDS else s.radius
        b_radius = 0.0 if o.kind == BOUNDS else o.radius
        a_edges = ALL_EDGES
        b_edges = ALL_EDGES
        deepest = math.inf
        if s.inner != 0 or o.inner != 0:
            a_edges = (ALL_EDGES ^ s.inner) & faces_of(a, na, b, nb, ALL_EDGES ^ o.inner)
            b_edges = (ALL_EDGES ^ o.inner) & faces_of(b, nb, a, na, ALL_EDGES ^ s.inner)
            # Without a dynamic body there is no response: the contact of any part will do.
            deepest = margin if p.kind == DYNAMIC or q.kind == DYNAMIC else math.inf
        time, vx, vy, reach = bring_together(margin, batch.ahead, p, q, a, na, nb, a_radius + b_radius, b)
        if time < 0.0:
            continue
        points = collide_hulls(a, na, a_radius, a_edges, b, nb, b_radius, b_edges, reach, batch.bias, deepest, manifold)
        if points > 0 and slides_by(a, na, b, nb, a_radius + b_radius, batch.graze, p, q, manifold):
            continue
        if manifold[0] == LEFT:
            leave(i, workspace.left)
        tangential_offset = set_back(time, vx, vy, manifold) if points > 0 and time > 0.0 else 0.0
        before = found
        found = add_points(shapes, candidates, i, found, 1.0, manifold, points, 0, manifolds_out)
        lead_on(before, found, tangential_offset, manifolds_out)
    return found
