"""Passes over the candidate pairs of circles and other hulls, with contacts that are expected within the step."""

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
from physics.math2d import length_of
from physics.shapes.placement import polygon_at, rounding
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import BOUNDS, CIRCLE

# ---- approach --------------------------------------------------------------------------------------------------------
# How fast two bodies close in on each other at a contact: what hits report and bounces are made of.


@subkernel
def velocity_at(body, x, y):
    """Velocity [px/s] of a point of a BODY row."""
    return (
        body.vx - body.angular_velocity * (y - body.center_y),
        body.vy + body.angular_velocity * (x - body.center_x),
    )


@subkernel
def closing(p, q, ax, ay, bx, by):
    """Velocity [px/s] of the point b of body q, seen from the point a of body p."""
    px, py = velocity_at(p, ax, ay)
    qx, qy = velocity_at(q, bx, by)
    return qx - px, qy - py


@subkernel
def nearing(a, b):
    """Velocity [px/s] of B seen from A, BODY rows, at the centre of the smaller, and how fast that is."""
    x = a.center_x if a.extent < b.extent else b.center_x
    y = a.center_y if a.extent < b.extent else b.center_y
    vx, vy = closing(a, b, x, y, x, y)
    return vx, vy, length_of(vx, vy)


@subkernel
def most_nearing(a, b):
    """What neither of two bodies, BODY rows, nor one as `nearing` sees it from the other, is faster than [px/s]."""
    way = abs(b.center_x - a.center_x) + abs(b.center_y - a.center_y)
    turning = abs(a.angular_velocity) + abs(b.angular_velocity)
    return abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + turning * way


@inlined
def closing_speed(a, b, x, y, nx, ny, lead):
    """Speed [px/s] at which B nears A at a point [px] along the normal; negative when they part. a, b: BODY rows;
    lead [px]: see MANIFOLD."""
    ax = x - a.center_x
    ay = y - a.center_y
    bx = x - b.center_x + lead * ny
    by = y - b.center_y - lead * nx
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return -(nx * vx + ny * vy)


@inlined
def approach(a, b, manifold_inout):
    """Write the closing speed of both points of a MANIFOLD row of two bodies, BODY rows, before any response."""
    m = manifold_inout
    m.speed_1 = closing_speed(a, b, m.x_1, m.y_1, m.normal_x, m.normal_y, m.lead)
    if m.count == 2:
        m.speed_2 = closing_speed(a, b, m.x_2, m.y_2, m.normal_x, m.normal_y, m.lead)


@kernel
def measure_approach(bodies, manifolds_inout):
    """Write the closing speed of every point before any response. manifolds_inout MANIFOLD rows. O(manifolds)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        approach(bodies[m.body_row_a], bodies[m.body_row_b], m)


# ---- ahead -----------------------------------------------------------------------------------------------------------
# Pairs that meet within the step: found where they will touch, not where the step begins.
#
# What nears by more than the margin in a step would be seen first when it overlaps, and be pushed along where it came
# from. So B is moved against A, in a straight line, to where they touch or are nearest, and the manifold found there;
# its gap is what they have to go along that normal. A margin that is fixed is Box2D's b2_speculativeDistance (Catto);
# the search is conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996).

ADVANCES = 16  # of one pair; what is still on its way then is found when it is nearer
NEVER = -1.0


@subkernel
def is_swept(body, way):
    """Whether a body, BODY row, moves by more than half its size on a way [px]: that is left to the sweeps, or passes
    where there are none."""
    return body.kind != STATIC and way > body.thin_half


@subkernel
def reach_of(a, b, speed, margin, ahead):
    """How far apart [px] two bodies, BODY rows, that near each other at a speed [px/s] may be and still be told to
    meet: the margin, or as far as that takes them in `ahead` [s], or would if one of them were stopped."""
    way = ahead * max(speed, length_of(a.vx, a.vy), length_of(b.vx, b.vy))
    return margin if is_swept(a, way) or is_swept(b, way) else max(margin, way)


@subkernel
def reach_turning(a, b, speed, margin, ahead):
    """The same, as far as their corners get by turning: half the size of the smaller at most."""
    way = ahead * speed
    if is_swept(a, way) or is_swept(b, way):
        return margin
    turn = ahead * (abs(a.angular_velocity) * a.extent + abs(b.angular_velocity) * b.extent)
    return max(margin, min(turn, 0.5 * min(a.extent, b.extent)))


@subkernel
def time_of_discs(dx, dy, radii, vx, vy):
    """When [s] two discs touch whose centres lie dx, dy apart [px], the second moving at vx, vy [px/s]; NEVER."""
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
    """When [s] two centres that lie dx, dy apart [px] are nearest, the second moving at vx, vy [px/s]."""
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
    """When [s] two hulls are within the target [px] of each other, B moving at vx, vy [px/s]; NEVER within `most` [s].

    a, b_inout: world corners, grown by the radii together; B's are left where they are then. O(corners²) a round.
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
            return time  # nearest: what turns them aside must not drive them into each other
        if gap - target > speed * (most - time):
            return NEVER
        # To the middle of what is left to the target, which no rounding can miss.
        span = (gap - 0.5 * target) / speed
        move_corners(b_count, span * vx, span * vy, b_inout)
        time += span
    return NEVER


@subkernel
def bring_together(margin, ahead, p, q, a, a_count, b_count, radii, b_inout):
    """Move B's corners to where two hulls touch in this step, where they meet faster than the margin allows for.

    p, q: BODY rows of A and B; a, b_inout: world corners, grown by the radii together [px]. Returns (when [s], or
    NEVER; B's velocity seen from A [px/s]; how far apart [px] their points may be then: who turns nears too).
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
    """When [s] a disc at x, y [px] that moves at vx, vy [px/s] is within the target [px] of a hull, world corners grown
    by the rounding [px]; NEVER within `most` [s]. O(corners) a round."""
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
    """What B, found where it had moved for a time [s] at vx, vy [px/s], has to go along the normal until then, and
    slides along the tangent (-ny, nx) [px]."""
    return -time * (vx * nx + vy * ny), time * (vy * nx - vx * ny)


@subkernel
def set_back(time, vx, vy, points_inout):
    """Tell a manifold in flight, found where B had moved for a time [s] at vx, vy [px/s], for where B is. Returns how
    far [px] B slides along the face until then."""
    nx = points_inout[1]
    ny = points_inout[2]
    way, lead = way_back(time, vx, vy, nx, ny)
    for k in range(int(points_inout[0])):
        at = 3 + 4 * k
        # Midway between the two surfaces, as they are now.
        points_inout[at] += 0.5 * way * nx
        points_inout[at + 1] += 0.5 * way * ny
        points_inout[at + 2] += way
    return lead


# ---- hull pairs ------------------------------------------------------------------------------------------------------
# Passes over the candidate pairs of circles and other hulls.
#
# Each runs through all candidates and takes those of its kind, so contacts come out in the candidates' order.


@subkernel
def lead_on(before, found, lead, manifolds_out):
    """Note how far [px] B slides before it touches, on what was added since there were `before`."""
    if before < found <= len(manifolds_out):
        manifolds_out[before].lead = lead


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
    """Contacts of all pairs of circles, appended at `found`. Returns the new count."""
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
        lead = 0.0
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
                # Nearest: what turns them aside must not drive them into each other.
                time = time_of_nearest(bx - ax, by - ay, vx, vy)
            # Those that touch in the next step too, or they would be turned aside in this one.
            if 0.0 < time <= 2.0 * batch.ahead:
                nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx + time * vx, by + time * vy, b_radius)
                way, lead = way_back(time, vx, vy, nx, ny)
                x += 0.5 * way * nx
                y += 0.5 * way * ny
                separation += way
        before = found
        found = add_point(shapes, candidates, i, found, nx, ny, x, y, separation, 0.0, 0, manifolds_out)
        lead_on(before, found, lead, manifolds_out)
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
    """Contacts of all pairs of a hull of two or more corners and a circle, from `found` on; the new count."""
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
            way, lead = way_back(time, vx, vy, nx, ny)
            # Midway between the surfaces as they are now: on the polygon's side of its way.
            px += 0.5 * way * nx
            py += 0.5 * way * ny
            if sign < 0.0:
                # A is the disc, and its point is where the polygon's is now.
                px += lead * ny
                py -= lead * nx
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
            lead_on(before, found, lead, manifolds_out)
    return found


@subkernel
def slides_by(a, na, b, nb, rounding, graze, p, q, manifold):
    """Whether two hulls with a manifold do not meet in this step: corners that fly past each other, and who comes to a
    side that it would overlap by no more than `graze` [px] in passing.

    A side that ends a hair above the floor beside it stops nobody; what little it overlaps is pushed out upwards.
    p, q: BODY rows of a and b.
    """
    least = manifold[5] if manifold[0] == 1.0 else min(manifold[5], manifold[9])
    corners = manifold[0] == 1.0 and manifold[6] >= CORNERS
    if least <= -graze:
        return False
    vx, vy = closing(p, q, manifold[3], manifold[4], manifold[3], manifold[4])
    if corners:
        return passes_by(a, na, b, nb, rounding - graze, vx, vy)
    along = vx * manifold[1] + vy * manifold[2]
    # Only who comes along the normal passes a side: what it slides on is touched all the time.
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
    """Contacts of all pairs of hulls of two or more corners, appended at `found`. Returns the new count."""
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
            # Who is never pushed is only told of: by whichever part is met.
            deepest = margin if p.kind == DYNAMIC or q.kind == DYNAMIC else math.inf
        time, vx, vy, reach = bring_together(margin, batch.ahead, p, q, a, na, nb, a_radius + b_radius, b)
        if time < 0.0:
            continue
        points = collide_hulls(a, na, a_radius, a_edges, b, nb, b_radius, b_edges, reach, batch.bias, deepest, manifold)
        if points > 0 and slides_by(a, na, b, nb, a_radius + b_radius, batch.graze, p, q, manifold):
            continue
        if manifold[0] == LEFT:
            leave(i, workspace.left)
        lead = set_back(time, vx, vy, manifold) if points > 0 and time > 0.0 else 0.0
        before = found
        found = add_points(shapes, candidates, i, found, 1.0, manifold, points, 0, manifolds_out)
        lead_on(before, found, lead, manifolds_out)
    return found
