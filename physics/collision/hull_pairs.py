"""Passes over the candidate pairs of circles and other hulls.

Each runs through all candidates and takes those of its kind, so contacts come out in the candidates' order.
"""

import math

from physics.collision.ahead import (
    bring_together,
    reach_of,
    set_back,
    time_of_disc,
    time_of_discs,
    time_of_nearest,
    way_back,
)
from physics.collision.approach import closing, nearing
from physics.collision.circles import COVERED, collide_circles
from physics.collision.clipping import ALL_EDGES, LEFT
from physics.collision.features import CIRCLE_CORNER, CORNERS
from physics.collision.hulls import collide_hull_circle, collide_hulls, faces_of, passes_by
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
from physics.collision.upright import collide_upright, upright_corners
from physics.jit import kernel, subkernel
from physics.shapes.placement import polygon_at, rounding
from physics.tables.body import DYNAMIC
from physics.tables.shape import BOUNDS, CIRCLE


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
