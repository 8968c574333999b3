"""Passes over the candidate pairs of circles and polygons, and the pass that stops at AABBs.

Each runs through all candidates and takes those of its kind, so contacts come out in the candidates' order.
"""

import math

from physics.jit import kernel
from physics.narrowphase.circles import collide_circles, collide_polygon_circle
from physics.narrowphase.contacts import CIRCLES, POLYGON_CIRCLE, POLYGONS, circle_at, corners_of, write_contact
from physics.narrowphase.placement import aabb_at
from physics.narrowphase.sat import ALL_EDGES, collide_polygons
from physics.profile import NARROW_TESTS, SENSOR_TESTS
from physics.tables import CIRCLE


@kernel
def collide_circle_pairs(
    # read
    geometry, bodies, shapes, candidates, kinds, count, margin, bias,
    # write
    scratch, contacts_out, found, work_inout,
):
    """Contacts of all pairs of circles, appended at `found`. Returns the new count."""
    for i in range(count):
        if kinds[i] != CIRCLES:
            continue
        ax, ay, a_radius = circle_at(bodies, shapes, candidates[i, 0])
        bx, by, b_radius = circle_at(bodies, shapes, candidates[i, 1])
        nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx, by, b_radius)
        if separation <= margin:
            found = write_contact(shapes, candidates, i, found, nx, ny, x, y, separation, 0.0, 0, contacts_out)
    return found


@kernel
def collide_polygon_circle_pairs(
    # read
    geometry, bodies, shapes, candidates, kinds, count, margin, bias,
    # write
    scratch, contacts_out, found, work_inout,
):
    """Contacts of all pairs of a polygon (or bounds) and a circle, appended at `found`. Returns the new count."""
    for i in range(count):
        if kinds[i] != POLYGON_CIRCLE:
            continue
        sign = -1.0 if shapes[candidates[i, 0]].kind == CIRCLE else 1.0
        polygon = candidates[i, 1] if sign < 0.0 else candidates[i, 0]
        circle = candidates[i, 0] if sign < 0.0 else candidates[i, 1]
        n = corners_of(geometry, bodies, shapes, polygon, scratch.a)
        x, y, radius = circle_at(bodies, shapes, circle)
        hit, nx, ny, px, py, separation, feature = collide_polygon_circle(scratch.a, n, ALL_EDGES, x, y, radius)
        if hit and separation <= margin:
            found = write_contact(shapes, candidates, i, found, sign * nx, sign * ny, px, py, separation, 0.0,
                                  feature, contacts_out)
    return found


@kernel
def collide_polygon_pairs(
    # read
    geometry, bodies, shapes, candidates, kinds, count, margin, bias,
    # write
    scratch, contacts_out, found, work_inout,
):
    """Contacts of all pairs of polygons (or bounds), appended at `found`. Returns the new count."""
    manifold = scratch.manifold
    for i in range(count):
        if kinds[i] != POLYGONS:
            continue
        na = corners_of(geometry, bodies, shapes, candidates[i, 0], scratch.a)
        nb = corners_of(geometry, bodies, shapes, candidates[i, 1], scratch.b)
        points = collide_polygons(scratch.a, na, ALL_EDGES, scratch.b, nb, ALL_EDGES, margin, bias, math.inf, manifold)
        for k in range(points):
            at = 3 + 4 * k
            found = write_contact(shapes, candidates, i, found, manifold[1], manifold[2], manifold[at],
                                  manifold[at + 1], manifold[at + 2], 0.0, int(manifold[at + 3]), contacts_out)
    return found


@kernel
def collide_boxes(
    # read
    geometry, bodies, shapes, candidates, count,
    # write
    contacts_out, work_inout,
):
    """Contacts of all candidates by their AABBs alone: normal along the axis of least overlap, point in its middle.

    Returns the number of contacts. O(candidates).
    """
    found = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        work_inout[NARROW_TESTS] += 1
        if a.sensor or b.sensor:
            work_inout[SENSOR_TESTS] += 1
        a_left, a_top, a_right, a_bottom = aabb_at(geometry, shapes, candidates[i, 0], p.x, p.y, p.angle)
        b_left, b_top, b_right, b_bottom = aabb_at(geometry, shapes, candidates[i, 1], q.x, q.y, q.angle)
        right = a_right - b_left
        left = b_right - a_left
        down = a_bottom - b_top
        up = b_bottom - a_top
        least = min(min(right, left), min(down, up))
        if least < 0.0:
            continue
        nx = 0.0
        ny = -1.0
        if least == right:
            nx = 1.0
            ny = 0.0
        elif least == left:
            nx = -1.0
            ny = 0.0
        elif least == down:
            ny = 1.0
        x = 0.5 * (max(a_left, b_left) + min(a_right, b_right))
        y = 0.5 * (max(a_top, b_top) + min(a_bottom, b_bottom))
        found = write_contact(shapes, candidates, i, found, nx, ny, x, y, -least, 0.0, 0, contacts_out)
    return found
