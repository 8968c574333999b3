"""Collision of masks at their exact poses (snap=False, not on whole pixels) with masks, hulls and tiles."""

import math
from typing import Any

from physics.collision.hulls import ALL_EDGES, Hull, aabb_corners, edge_normal, pixel_feature
from physics.collision.manifold import MASK_HULL, MASKS_EXACT, add_manifold, hull_of, make_pass, sides_by_kind
from physics.collision.masks import PlacedRaster, collide_mask_hull, hull_bounds, least_overlap
from physics.jit import inlined, subkernel
from physics.math2d import cosine_and_sine, norm, rotate, unit
from physics.raster.bits import is_set
from physics.raster.exact import (
    ROUNDED,
    SquaresPair,
    arc_share,
    first_squares,
    line_share,
    shared_squares,
    slack_of,
    squares_way_out,
)
from physics.shapes.placement import (
    box_as_tested,
    into_raster,
    out_of_raster,
    polygon_at,
    raster_in_raster,
    raster_of_shape,
)
from physics.tables.shape import BOUNDS, CIRCLE, MASK
from physics.tables.step_state import MASK_TESTS

# ---- hull shares -----------------------------------------------------------------------------------------------------
# Area and centroid of the overlap of a mask's pixel squares and a rounded hull, in closed form.
#
# The hull's outline consists of its edges, moved outward by the radius, and an arc around each corner. Each run of
# solid pixels in a row is a box, and each hull edge and arc contributes to the area inside the box: see
# raster/exact.py.


@subkernel
def arc_at(corners, count, k):
    """Return (start, end) [rad] of the arc around corner k of a rounded hull.

    The arc leads from the normal of the edge before the corner to the normal of the edge after it. corners, count:
    corners [px] of the hull and their number. A hull of one corner has the full circle.
    """
    if count == 1:
        return 0.0, math.tau
    ax, ay = edge_normal(corners, count, k - 1 if k > 0 else count - 1)
    bx, by = edge_normal(corners, count, k)
    start = math.atan2(ay, ax)
    if count == 2:
        return start, start + math.pi
    return start, start + max(0.0, math.atan2(ax * by - ay * bx, ax * bx + ay * by))


@subkernel
def hull_share(hull, x, y, width, height):
    """Return (area [px2], first moment in x, first moment in y [px3]) of the overlap of a Hull and a box.

    x, y [px]: top left corner of the box, about which the moments are taken; width, height [px]: size of the box.
    O(corners).
    """
    corners = hull.corners
    count = hull.count
    radius = hull.radius
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    for k in range(count):
        if count > 1:
            n = k + 1 if k + 1 < count else 0
            nx, ny = edge_normal(corners, count, k)
            part, mx, my = line_share(
                corners[k, 0] + radius * nx - x,
                corners[k, 1] + radius * ny - y,
                corners[n, 0] + radius * nx - x,
                corners[n, 1] + radius * ny - y,
                width,
                height,
            )
            area += part
            moment_x += mx
            moment_y += my
        if radius > 0.0:
            start, end = arc_at(corners, count, k)
            part, mx, my = arc_share(corners[k, 0] - x, corners[k, 1] - y, radius, start, end, width, height)
            area += part
            moment_x += mx
            moment_y += my
    return area, moment_x, moment_y


@subkernel
def shared_with_hull(rasters, words, mask, hull):
    """Return (area [px2], first moment in x, first moment in y [px3]) of the overlap of a mask and a Hull.

    The Hull and the moments are in the raster space of the mask. mask: row number in RASTER. O(runs of solid pixels in
    the hull's AABB · corners).
    """
    r = rasters[mask]
    min_x, min_y, max_x, max_y = hull_bounds(hull)
    left = max(r.set_left, math.floor(min_x))
    right = min(r.set_right, math.ceil(max_x))
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    for row in range(max(r.set_top, math.floor(min_y)), min(r.set_bottom, math.ceil(max_y))):
        start = -1
        for column in range(left, right + 1):
            if column < right and is_set(words, r.offset + row * r.stride, column):
                if start < 0:
                    start = column
            elif start >= 0:
                part, mx, my = hull_share(hull, float(start), float(row), float(column - start), 1.0)
                area += part
                moment_x += mx + start * part
                moment_y += my + row * part
                start = -1
    return area, moment_x, moment_y


# ---- mask exact ------------------------------------------------------------------------------------------------------
# Masks that are not snapped, at their exact pose, against hulls and tiles.
#
# The test is made in the space of the mask's raster, with the other shape rotated by minus the mask's angle. Overlap,
# normal and depth are computed as in masks.py. The area and the contact point (the centroid) are exact up to rounding.
# A line has no area, so the pixels that it crosses are counted, as with a snapped mask.


@subkernel
def least_area(raster):
    """Return the least area [px2] that is reported for an overlap with a mask. raster: RASTER row of the mask.

    The computed area of a tiny overlap may be smaller, or even 0, because of rounding errors.
    """
    slack = ROUNDED * (raster.width + raster.height)
    return slack * slack


@subkernel
def move_into_raster(raster, body, count, corners_inout):
    """Transform the first `count` corners [px], in place, from the world into the raster space of a mask.

    The mask is at its exact pose (snap=False). raster: RASTER row of the mask; body: BODY row of the mask.
    """
    cosine, sine = cosine_and_sine(body.angle, body.angle)
    for k in range(count):
        x, y = into_raster(raster, body, cosine, sine, corners_inout[k, 0], corners_inout[k, 1])
        corners_inout[k, 0] = x
        corners_inout[k, 1] = y


@subkernel
def hull_in_raster(geometry, bodies, shapes, mask, other, corners_out):
    """Return the Hull of shape `other` in the raster space of shape `mask`, a mask at its exact pose (snap=False).

    mask, other: row numbers in SHAPE; corners_out (16, 2) receives the corners [px]. Sine and cosine are computed of
    the difference of the two angles, so that the result is exact for bodies at multiples of 90 degrees.
    """
    s, o = shapes[mask], shapes[other]
    b = bodies[s.body_row]
    p = bodies[o.body_row]
    r = geometry.rasters[raster_of_shape(geometry, s)]
    cosine, sine = cosine_and_sine(b.angle, b.angle)
    if o.kind == BOUNDS:
        count = aabb_corners(o, corners_out)
        move_into_raster(r, b, count, corners_out)
        return Hull(corners_out, count, 0.0, ALL_EDGES)
    x, y = into_raster(r, b, cosine, sine, p.x, p.y)
    cosine, sine = cosine_and_sine(p.angle - b.angle, max(abs(p.angle), abs(b.angle)))
    count = 1
    if o.kind == CIRCLE:
        u, v = rotate(o.local_x, o.local_y, cosine, sine)
        corners_out[0, 0] = x + u
        corners_out[0, 1] = y + v
    else:
        count = polygon_at(geometry.polygons, geometry.corners, o.geometry, x, y, cosine, sine, corners_out)
    return Hull(corners_out, count, o.radius, ALL_EDGES)


@subkernel
def collide_in_raster(rasters, words, mask, hull, depths_out):
    """Collide a mask with a Hull in raster space. Return (area [px2], nx, ny, x, y, separation [px], feature).

    The area is 0 without overlap. nx, ny: unit normal from mask to Hull; x, y [px]: centroid of the overlap; feature:
    pixel_feature of the first overlapping pixel. mask: row number in RASTER; hull: Hull in the space of this raster;
    depths_out (16,): scratch.
    """
    pixels, nx, ny, x, y, separation, first = collide_mask_hull(
        PlacedRaster(rasters, words, mask, 0, 0), hull, depths_out
    )
    if pixels == 0 or (hull.count == 2 and hull.radius == 0.0):
        return float(pixels), nx, ny, x, y, separation, first
    area, moment_x, moment_y = shared_with_hull(rasters, words, mask, hull)
    least = least_area(rasters[mask])
    if area > least:
        x, y = moment_x / area, moment_y / area
    return max(area, least), nx, ny, x, y, separation, first


@subkernel
def out_of_mask(geometry, body, shape, nx, ny, x, y):
    """Transform a normal (nx, ny) and a point (x, y) from a mask's raster space to the world. Return (nx, ny, x, y).

    body, shape: BODY and SHAPE rows of the mask, which is at its exact pose (snap=False).
    """
    cosine, sine = cosine_and_sine(body.angle, body.angle)
    wx, wy = rotate(nx, ny, cosine, sine)
    px, py = out_of_raster(geometry.rasters[raster_of_shape(geometry, shape)], body, cosine, sine, x, y)
    return wx, wy, px, py


@subkernel
def collide_as_drawn(geometry, shape, hull, depths_out):
    """Collide a mask drawn on whole pixels (snap=True) with a Hull. Return (area, nx, ny, x, y, separation, feature).

    The area is the number of pixels that the Hull overlaps. The other values are those of collide_in_raster, in the
    world. shape: SHAPE row of the mask; hull: the Hull in the world; depths_out (16,): scratch.
    """
    raster = PlacedRaster(geometry.rasters, geometry.words, shape.raster, shape.left, shape.top)
    pixels, nx, ny, x, y, separation, first = collide_mask_hull(raster, hull, depths_out)
    return float(pixels), nx, ny, x, y, separation, first


@subkernel
def collide_mask_part(geometry, body, shape, hull, scratch, depths_out):
    """Collide a mask, with any `snap`, with a convex polygon. Return (area, nx, ny, x, y, separation, feature).

    The values are those of collide_in_raster, in the world. body, shape: BODY and SHAPE rows of the mask; hull: the
    polygon in the world; scratch (16, 2), depths_out (16,): scratch memory.
    """
    if shape.snap:
        return collide_as_drawn(geometry, shape, hull, depths_out)
    mask = raster_of_shape(geometry, shape)
    for k in range(hull.count):
        scratch[k, 0] = hull.corners[k, 0]
        scratch[k, 1] = hull.corners[k, 1]
    move_into_raster(geometry.rasters[mask], body, hull.count, scratch)
    inner = Hull(scratch, hull.count, hull.radius, hull.edges)
    area, nx, ny, x, y, separation, first = collide_in_raster(geometry.rasters, geometry.words, mask, inner, depths_out)
    nx, ny, x, y = out_of_mask(geometry, body, shape, nx, ny, x, y)
    return area, nx, ny, x, y, separation, first


@subkernel
def collide_mask_shape(geometry, bodies, shapes, mask, other, workspace):
    """Collide a mask, with any `snap`, with a hull. Return (area, nx, ny, x, y, separation, feature).

    The values are those of collide_in_raster, in the world. mask, other: row numbers in SHAPE of the mask and of the
    hull; workspace: scratch memory.
    """
    s = shapes[mask]
    if s.snap:
        hull = hull_of(geometry, bodies, shapes, other, workspace.a)
        whole = Hull(hull.corners, hull.count, hull.radius, ALL_EDGES)
        return collide_as_drawn(geometry, s, whole, workspace.depths)
    hull = hull_in_raster(geometry, bodies, shapes, mask, other, workspace.a)
    area, nx, ny, x, y, separation, first = collide_in_raster(
        geometry.rasters, geometry.words, raster_of_shape(geometry, s), hull, workspace.depths
    )
    nx, ny, x, y = out_of_mask(geometry, bodies[s.body_row], s, nx, ny, x, y)
    return area, nx, ny, x, y, separation, first


# ---- mask exact depth ------------------------------------------------------------------------------------------------
# Contact of two masks of which at least one is not snapped: point, normal and depth.
#
# As for snapped masks (masks.py), the normal is the direction in which moving B shrinks the shared area fastest, by
# differences of one pixel. If this gradient is 0, the direction between the centres of the AABBs is used or, if the
# centres coincide, the axis of least overlap of the AABBs. The depth along the normal is exact, not in whole pixels. If
# it exceeds the least overlap of the AABBs, the normal and depth along the axis of least overlap are used.
#
# In this section A is the mask in whose raster space (the frame) the test runs; see raster/exact.py.

NOISE = 1e-9  # rounding error of area differences, as a share of the area, or of a pixel


@subkernel
def boxes_normal(a, b):
    """Return (nx, ny, differ): the unit vector from the centre of A's AABB to the centre of B's AABB.

    differ: whether the centres differ. If they do not differ, the vector is (1, 0). a, b: SHAPE rows.
    """
    x, y = (b.min_x - a.min_x) + (b.max_x - a.max_x), (b.min_y - a.min_y) + (b.max_y - a.max_y)
    nx, ny = unit(x, y, 1.0, 0.0)
    return nx, ny, x != 0.0 or y != 0.0


@subkernel
def area_normal(shares):
    """Return (nx, ny, exists): the direction in which a move of B shrinks the shared area of two masks fastest.

    nx, ny: unit vector in A's raster space; exists: False if moves change the area only by rounding errors. shares:
    Shares of the two masks.
    """
    nx, ny = unit(shares.loss_x, shares.loss_y, 1.0, 0.0)
    return nx, ny, norm(shares.loss_x, shares.loss_y) > NOISE * max(shares.area, 1.0)


@subkernel
def depth_of_squares(pair, nx, ny, turn_cosine, turn_sine, most):
    """Return the distance [px] that B must move along the world normal (nx, ny) to end the overlap of a SquaresPair.

    A result above `most` [px] means that no move up to `most` is enough. turn_cosine, turn_sine: cosine and sine of A's
    angle.
    """
    rx, ry = rotate(nx, ny, turn_cosine, -turn_sine)
    return squares_way_out(pair, rx, ry, most)


@subkernel
def exact_contact(pair, a, b, turn_cosine, turn_sine):
    """Return (area [px2], x, y, nx, ny, separation [px]) of two overlapping masks A and B.

    x, y: centroid of the overlap in A's raster space; nx, ny: unit normal from A to B in the world; separation: minus
    the length of the move along the normal that ends the overlap. pair: SquaresPair of the masks; a, b: SHAPE rows of
    the masks; turn_cosine, turn_sine: cosine and sine of A's angle.
    """
    shares = shared_squares(pair)
    slack = slack_of(pair.rasters[pair.frame], pair.rasters[pair.other])
    area = max(shares.area, slack * slack)
    axis_x, axis_y, least = least_overlap(a.max_x - b.min_x, b.max_x - a.min_x, a.max_y - b.min_y, b.max_y - a.min_y)
    nx, ny, is_sloped = area_normal(shares)
    nx, ny = rotate(nx, ny, turn_cosine, turn_sine)
    if not is_sloped:
        nx, ny, is_sloped = boxes_normal(a, b)
    depth = math.inf
    if is_sloped:
        depth = depth_of_squares(pair, nx, ny, turn_cosine, turn_sine, least)
    if depth > least:
        nx, ny = axis_x, axis_y
        depth = depth_of_squares(pair, nx, ny, turn_cosine, turn_sine, least)
    return area, shares.moment_x / area, shares.moment_y / area, nx, ny, -depth


# ---- mask exact pairs ------------------------------------------------------------------------------------------------
# Passes over the candidate pairs with masks that are not snapped: mask against mask, mask against hull.


@subkernel
def tested_aabb(geometry, shape):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a SHAPE row; for a mask see placement.box_as_tested."""
    if shape.kind == MASK:
        return box_as_tested(geometry, shape)
    return shape.min_x, shape.min_y, shape.max_x, shape.max_y


@subkernel
def share_no_area(geometry, a, b):
    """Return whether the AABBs of two masks (SHAPE rows) do not overlap, so that their pixels cannot overlap."""
    left, top, right, bottom = box_as_tested(geometry, a)
    min_x, min_y, max_x, max_y = box_as_tested(geometry, b)
    return left >= max_x or min_x >= right or top >= max_y or min_y >= bottom


@subkernel
def is_first_the_frame(geometry, a, b):
    """Return whether two masks A and B are tested in A's raster space rather than in B's. a, b: SHAPE rows.

    The raster space of the mask with snap=False is used. If both masks have snap=False, the space of the mask with the
    greater area is used.
    """
    if a.snap or b.snap:
        return not a.snap
    rasters = geometry.rasters
    return rasters[raster_of_shape(geometry, a)].area >= rasters[raster_of_shape(geometry, b)].area


@subkernel
def squares_pair(geometry, bodies, frame, other):
    """Return the SquaresPair of two masks (SHAPE rows) in the raster space of `frame`, which has snap=False."""
    u, v, cosine, sine = raster_in_raster(geometry, bodies[frame.body_row], frame, bodies[other.body_row], other)
    rows = raster_of_shape(geometry, frame), raster_of_shape(geometry, other)
    return SquaresPair(geometry.rasters, geometry.words, rows[0], rows[1], u, v, cosine, sine)


@subkernel
def exact_mask_area(geometry, bodies, a, b):
    """Return the area [px2] that two masks (SHAPE rows) share; at least one of them has snap=False (exact pose)."""
    if share_no_area(geometry, a, b):
        return 0.0
    first = is_first_the_frame(geometry, a, b)
    f = a if first else b
    o = b if first else a
    pair = squares_pair(geometry, bodies, f, o)
    return shared_squares(pair).area


def make_exact_mask_pass(full: bool) -> Any:
    """Return the kernel that collides all pairs of masks with at least one mask at its exact pose (snap=False).

    full: True to compute area, centroid, normal and depth; False to find only two overlapping pixels. If False, the
    normal is the direction between the centres of the AABBs, and the separation is -1.
    """

    @inlined
    def collide_exact_mask_pair(batch, pair, workspace, manifolds_out, found, work_inout):
        """Append the contact of candidate number `pair`, two masks of which at least one is at its exact pose.

        Return the new number of contacts. Arguments: see manifold.make_pass.
        """
        geometry, bodies, shapes, candidates = batch.geometry, batch.bodies, batch.shapes, batch.candidates
        rasters = geometry.rasters
        work_inout[MASK_TESTS] += 1
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        if share_no_area(geometry, a, b):
            return found
        first = is_first_the_frame(geometry, a, b)
        f = a if first else b
        o = b if first else a
        p = bodies[f.body_row]
        squares = squares_pair(geometry, bodies, f, o)
        hit, x, y, column, row = first_squares(squares, squares.u, squares.v, 0)
        if not hit:
            return found
        if first:
            feature = pixel_feature(y, x, rasters[squares.frame].width)
        else:
            feature = pixel_feature(row, column, rasters[squares.other].width)
        turn_cosine, turn_sine = cosine_and_sine(p.angle, p.angle)
        px, py = x + 0.5, y + 0.5
        area = 0.0
        separation = -1.0
        if full:
            area, px, py, nx, ny, separation = exact_contact(squares, f, o, turn_cosine, turn_sine)
        else:
            nx, ny, _ = boxes_normal(f, o)
        px, py = out_of_raster(rasters[squares.frame], p, turn_cosine, turn_sine, px, py)
        sign = 1.0 if first else -1.0
        point = (sign * nx, sign * ny, px, py, separation, area, feature)
        return add_manifold(shapes, candidates, pair, point, manifolds_out, found)

    return make_pass(MASKS_EXACT, collide_exact_mask_pair)


collide_exact_mask_pairs_full = make_exact_mask_pass(full=True)
collide_exact_mask_pairs_hit = make_exact_mask_pass(full=False)


@inlined
def collide_mask_hull_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contact of candidate number `pair`, a mask and a hull. Return the new number of contacts.

    Arguments: see manifold.make_pass.
    """
    work_inout[MASK_TESTS] += 1
    sign, mask, other = sides_by_kind(batch, pair, MASK)
    area, nx, ny, x, y, separation, feature = collide_mask_shape(
        batch.geometry, batch.bodies, batch.shapes, mask, other, workspace
    )
    if area == 0.0:
        return found
    point = (sign * nx, sign * ny, x, y, separation, area, feature)
    return add_manifold(batch.shapes, batch.candidates, pair, point, manifolds_out, found)


collide_mask_hull_pairs = make_pass(MASK_HULL, collide_mask_hull_pair)
