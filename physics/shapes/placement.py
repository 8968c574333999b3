"""Shapes at the poses of their bodies: corners, AABBs, and the rasters of masks, on whole pixels or at exact poses."""

import math
from typing import Any

import numpy as np

from physics.jit import kernel, subkernel
from physics.math2d import cosine_and_sine, rotate, rotation_of
from physics.settings import DRAWN, MASK_ANGLE_BUCKETS
from physics.tables.shape import BOUNDS, CAPSULE, CHAIN, CIRCLE, MASK, PIXELS, POLYGON, SEGMENT, TILES

# ---- mask pose -------------------------------------------------------------------------------------------------------
# Pose of a mask with snap=False: its raster at the angle 0, rotated and moved with its body.
#
# Other shapes are transformed into the raster space of the mask: x and y [px] are measured from the raster's top left
# corner, so that its pixels are [i, i + 1) x [j, j + 1). Positions are subtracted before they are rotated, which is
# precise far from the world's origin. Quarter turns are exact.


@subkernel
def exact_aabb(rasters, corners, raster, x, y, angle):
    """Return the tight AABB (min_x, min_y, max_x, max_y) [px] of a mask's solid pixels at an exact pose of its body.

    The AABB of an empty mask is the point (x, y). rasters, corners: tables of the geometry; raster: RASTER row number
    of the mask at the angle 0; x, y, angle [px, px, rad]: the pose. O(corners of the mask's hull).
    """
    r = rasters[raster]
    if r.hull_count == 0:
        return x, y, x, y
    cosine, sine = cosine_and_sine(angle, angle)
    first = corners[r.hull]
    min_x, min_y = rotate(first.x, first.y, cosine, sine)
    max_x, max_y = min_x, min_y
    for k in range(r.hull + 1, r.hull + r.hull_count):
        corner = corners[k]
        u, v = rotate(corner.x, corner.y, cosine, sine)
        min_x, max_x = min(min_x, u), max(max_x, u)
        min_y, max_y = min(min_y, v), max(max_y, v)
    return x + min_x, y + min_y, x + max_x, y + max_y


@subkernel
def into_raster(raster, body, cosine, sine, x, y):
    """Transform a point (x, y) [px] from the world into a mask's raster. Return its coordinates (x, y) [px].

    The raster has its top left corner at (0, 0). raster: RASTER row; body: BODY row of the mask; cosine, sine: rotation
    of the body.
    """
    u, v = rotate(x - body.x, y - body.y, cosine, -sine)
    return u + raster.origin_x, v + raster.origin_y


@subkernel
def out_of_raster(raster, body, cosine, sine, x, y):
    """Transform a point (x, y) [px] from a mask's raster into the world. Return its coordinates (x, y) [px].

    raster: RASTER row; body: BODY row of the mask; cosine, sine: rotation of the body.
    """
    u, v = rotate(x - raster.origin_x, y - raster.origin_y, cosine, sine)
    return body.x + u, body.y + v


@subkernel
def raster_of_shape(geometry, shape):
    """Return the row number of the RASTER with which a mask is tested: as drawn for snap=True, else at the angle 0.

    shape: SHAPE row.
    """
    return shape.raster if shape.snap else geometry.raster_of[shape.geometry, 0]


@subkernel
def box_as_tested(geometry, shape):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a mask's solid pixels at the pose used in collision tests.

    A mask with snap=True is tested as drawn, at whole pixels; any other mask at its exact pose. shape: SHAPE row.
    """
    r = geometry.rasters[shape.raster]
    if not shape.snap or r.area == 0:
        return shape.min_x, shape.min_y, shape.max_x, shape.max_y
    left, top = float(shape.left), float(shape.top)
    return left + r.set_left, top + r.set_top, left + r.set_right, top + r.set_bottom


@subkernel
def raster_in_raster(geometry, frame_body, frame_shape, body, shape):
    """Return the pose of one mask's raster in the coordinates of another mask's raster, the frame.

    The result is (x, y, cosine, sine): position of the top left corner [px], and cosine and sine of the angle.
    frame_body, frame_shape: BODY and SHAPE row of the frame, which has snap=False; body, shape: rows of the other mask,
    with any `snap`.
    """
    frame = geometry.rasters[raster_of_shape(geometry, frame_shape)]
    cosine, sine = cosine_and_sine(frame_body.angle, frame_body.angle)
    if shape.snap:
        x, y = into_raster(frame, frame_body, cosine, sine, float(shape.left), float(shape.top))
        return x, y, cosine, -sine
    other = geometry.rasters[raster_of_shape(geometry, shape)]
    x, y = into_raster(frame, frame_body, cosine, sine, body.x, body.y)
    angle = body.angle - frame_body.angle
    cosine, sine = cosine_and_sine(angle, max(abs(body.angle), abs(frame_body.angle)))
    u, v = rotate(other.origin_x, other.origin_y, cosine, sine)
    return x - u, y - v, cosine, sine


@kernel
def turn_of_mask(angle):
    """Return (cosine, sine) of an angle [rad], with the rounding used in tests of masks: exact for quarter turns."""
    return cosine_and_sine(angle, angle)


# ---- placement -------------------------------------------------------------------------------------------------------
# Placement of shapes at a pose: corners, raster on the pixel grid, AABB.

# The fields that a stage of the step declares as written if it calls refresh_boxes.
PLACED = tuple(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top"))
TAU = math.tau
WHOLE = 2.0**62  # larger floats do not fit int64: compiled the conversion is undefined, in plain Python it is an error
NOWHERE = -(1 << 62)  # pixel column or row that stands for a coordinate that is not finite or too large
BUCKET_TURN = math.pi / MASK_ANGLE_BUCKETS  # [rad] largest difference between an angle and its bucket's angle


@subkernel
def bucket_at(angle, buckets):
    """Return the index of the angle bucket nearest to an angle [rad]; 0 for an angle that is not finite.

    Bucket k of `buckets` is the angle k / `buckets` of a full turn.
    """
    turn = angle * buckets / TAU + 0.5
    if not abs(turn) < WHOLE:
        return 0
    # The number of buckets is a power of two, so the AND is the modulus, also of negative numbers, without a division.
    return math.floor(turn) & (buckets - 1)


@subkernel
def raster_at(geometry, mask, angle):
    """Return the row number of a mask's raster at an angle [rad]. The raster must have been added to the library.

    mask: geometry row of the mask.
    """
    return geometry.raster_of[mask, bucket_at(angle, geometry.raster_of.shape[1])]


@subkernel
def snapped(coordinate, origin):
    """Return the pixel column of a drawn raster's left side, or the pixel row of its top side.

    The result is coordinate - origin, rounded half up; NOWHERE if it is not finite or too large. coordinate [px]: x of
    the body for the column, y for the row; origin [px]: the same coordinate of the body's origin in the raster.
    """
    at = coordinate - origin + 0.5
    return math.floor(at) if abs(at) < WHOLE else NOWHERE


@subkernel
def is_drawn_when_asked(shape):
    """Return whether a SHAPE row is a mask with snap=True whose raster is not added before a test needs it.

    The AABB stored in such a row is that of the exact pose.
    """
    return shape.snap and shape.role == PIXELS


@subkernel
def drawn_beyond(body, shape):
    """Return the largest distance [px] by which a mask's drawn pixels may exceed the AABB in its SHAPE row.

    The result is 0 for other shapes. body, shape: BODY and SHAPE row of the mask.
    """
    return DRAWN + BUCKET_TURN * body.extent if is_drawn_when_asked(shape) else 0.0


@subkernel
def raster_aabb(geometry, raster, x, y):
    """Return the AABB [px] of a raster's solid pixels as drawn on whole pixels, for a body at (x, y).

    The result is (min_x, min_y, max_x, max_y); for an empty raster the point (x, y). raster: RASTER row number.
    """
    r = geometry.rasters[raster]
    if r.area == 0:
        return x, y, x, y
    left, top = float(snapped(x, r.origin_x)), float(snapped(y, r.origin_y))
    return left + r.set_left, top + r.set_top, left + r.set_right, top + r.set_bottom


@subkernel
def upright_aabb(raster, x, y):
    """Return the AABB [px] of an unrotated mask's solid pixels with its body exactly at (x, y), not on whole pixels.

    The result is (min_x, min_y, max_x, max_y); for an empty mask the point (x, y). raster: RASTER row at the angle 0.
    """
    if raster.area == 0:
        return x, y, x, y
    left, top = x - raster.origin_x, y - raster.origin_y
    return left + raster.set_left, top + raster.set_top, left + raster.set_right, top + raster.set_bottom


@subkernel
def box_corners(min_x, min_y, max_x, max_y, corners_out):
    """Write the four corners [px] of a box to corners_out, clockwise on the screen from the top left. Return 4."""
    corners_out[0, 0] = min_x
    corners_out[0, 1] = min_y
    corners_out[1, 0] = max_x
    corners_out[1, 1] = min_y
    corners_out[2, 0] = max_x
    corners_out[2, 1] = max_y
    corners_out[3, 0] = min_x
    corners_out[3, 1] = max_y
    return 4


@subkernel
def is_upright_box(corners, count):
    """Return whether the polygon of the first `count` corners [px] is an axis-aligned box."""
    if count != 4:
        return False
    along_x = corners[0, 1] == corners[1, 1] and corners[2, 1] == corners[3, 1]
    along_y = corners[0, 0] == corners[1, 0] and corners[2, 0] == corners[3, 0]
    across_x = corners[1, 0] == corners[2, 0] and corners[3, 0] == corners[0, 0]
    across_y = corners[1, 1] == corners[2, 1] and corners[3, 1] == corners[0, 1]
    return (along_x and across_x) or (along_y and across_y)


@subkernel
def round_half_up(value):
    """Return the integer nearest to a coordinate [px]; halves are rounded up."""
    return math.floor(value + 0.5)


@subkernel
def polygon_at(polygons, table, polygon, x, y, cosine, sine, corners_out):
    """Write the world corners [px] of a polygon at a pose to corners_out (16, 2). Return the number of corners.

    polygon: row of geometry.polygons; x, y [px], cosine, sine: pose of its body. polygons, table: geometry.polygons and
    geometry.corners, passed separately because passing the whole Geometry takes longer than this function.
    """
    span = polygons[polygon]
    for k in range(span.count):
        corner = table[span.offset + k]
        u, v = rotate(corner.x, corner.y, cosine, sine)
        corners_out[k, 0] = x + u
        corners_out[k, 1] = y + v
    return span.count


@subkernel
def polygon_aabb(polygons, table, polygon, radius, x, y, cosine, sine):
    """Return the tight AABB (min_x, min_y, max_x, max_y) [px] of a polygon at a pose, enlarged by a radius [px].

    polygon: row of geometry.polygons; polygons, table: geometry.polygons and geometry.corners; x, y [px], cosine, sine:
    pose of its body.
    """
    span = polygons[polygon]
    first = table[span.offset]
    min_x, min_y = rotate(first.x, first.y, cosine, sine)
    max_x, max_y = min_x, min_y
    for k in range(1, span.count):
        corner = table[span.offset + k]
        u, v = rotate(corner.x, corner.y, cosine, sine)
        min_x, max_x = min(min_x, u), max(max_x, u)
        min_y, max_y = min(min_y, v), max(max_y, v)
    return x + min_x - radius, y + min_y - radius, x + max_x + radius, y + max_y + radius


@subkernel
def is_hull(kind):
    """Return whether shapes of a kind are one convex hull with a rounding radius: not TILES, MASK or CHAIN."""
    return kind != TILES and kind != MASK and kind != CHAIN


@subkernel
def rounding(shapes, row):
    """Return the rounding radius [px] of a SHAPE row that is a hull.

    The result is 0 for a BOUNDS, even if the shape inside it is round. row: row number in SHAPE.
    """
    return 0.0 if shapes[row].kind == BOUNDS else shapes[row].radius


@subkernel
def chain_aabb(geometry, chain, cosine, sine):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a chain whose body is at (0, 0), rotated by (cosine, sine).

    chain: row of geometry.chains. O(links); without rotation O(blocks of links).
    """
    span = geometry.chains[chain]
    min_x, min_y = math.inf, math.inf
    max_x, max_y = -math.inf, -math.inf
    if sine == 0.0 and cosine == 1.0:
        for k in range(span.first_block, span.first_block + span.blocks):
            block = geometry.link_blocks[k]
            min_x, min_y = min(min_x, block.min_x), min(min_y, block.min_y)
            max_x, max_y = max(max_x, block.max_x), max(max_y, block.max_y)
        return min_x, min_y, max_x, max_y
    for k in range(span.offset, span.offset + span.count):
        link = geometry.links[k]
        for end in range(2):
            u, v = rotate(link.ax if end == 0 else link.bx, link.ay if end == 0 else link.by, cosine, sine)
            min_x, min_y = min(min_x, u), min(min_y, v)
            max_x, max_y = max(max_x, u), max(max_y, v)
    return min_x, min_y, max_x, max_y


@subkernel
def aabb_at(geometry, shapes, row, x, y, angle):
    """Return the tight AABB (min_x, min_y, max_x, max_y) [px] of a shape with its body at a pose. O(corners).

    The AABB of a mask is that of its solid pixels; for an empty mask it is the point (x, y). A mask with snap=True is
    placed on whole pixels unless its role is PIXELS. Any other mask is placed at the exact pose. row: row number in
    SHAPE; x, y, angle [px, px, rad]: the pose.
    """
    s = shapes[row]
    kind = s.kind
    if kind == BOUNDS:
        kind = s.wrapped
    if kind == CIRCLE:
        u, v = rotate(s.local_x, s.local_y, *rotation_of(angle))
        return x + u - s.radius, y + v - s.radius, x + u + s.radius, y + v + s.radius
    if kind == POLYGON or kind == CAPSULE or kind == SEGMENT:
        return polygon_aabb(geometry.polygons, geometry.corners, s.geometry, s.radius, x, y, *rotation_of(angle))
    if kind == CHAIN:
        min_x, min_y, max_x, max_y = chain_aabb(geometry, s.geometry, *rotation_of(angle))
        return x + min_x, y + min_y, x + max_x, y + max_y
    if kind == TILES:
        g = geometry.grids[s.geometry]
        return x, y, x + g.columns * g.tile_size, y + g.rows * g.tile_size
    exact = geometry.raster_of[s.geometry, 0]
    if s.role == PIXELS and angle == 0.0:
        return upright_aabb(geometry.rasters[exact], x, y)
    if s.role == PIXELS or geometry.rasters[exact].halo >= 0:
        return exact_aabb(geometry.rasters, geometry.corners, exact, x, y, angle)
    return raster_aabb(geometry, raster_at(geometry, s.geometry, angle), x, y)


@subkernel
def hull_at(geometry, shapes, row, x, y, angle, corners_out):
    """Write the world corners [px] of a hull at a pose to corners_out (16, 2). Return the number of corners.

    The corners are clockwise on the screen. A circle has one corner, its centre; for its radius see `rounding`. row:
    row number in SHAPE; x, y, angle [px, px, rad]: pose of its body.
    """
    s = shapes[row]
    if s.kind == CIRCLE:
        u, v = rotate(s.local_x, s.local_y, *rotation_of(angle))
        corners_out[0, 0] = x + u
        corners_out[0, 1] = y + v
        return 1
    return corners_at(geometry, shapes, row, x, y, angle, corners_out)


@subkernel
def corners_at(geometry, shapes, row, x, y, angle, corners_out):
    """Write the world corners [px] of a POLYGON, CAPSULE, SEGMENT or BOUNDS at a pose. Return the number of corners.

    The corners are clockwise on the screen; those of a BOUNDS are the corners of its AABB. row: row number in SHAPE; x,
    y, angle [px, px, rad]: pose of its body; corners_out (16, 2): the corners.
    """
    if shapes[row].kind != BOUNDS:
        cosine, sine = rotation_of(angle)
        return polygon_at(geometry.polygons, geometry.corners, shapes[row].geometry, x, y, cosine, sine, corners_out)
    min_x, min_y, max_x, max_y = aabb_at(geometry, shapes, row, x, y, angle)
    return box_corners(min_x, min_y, max_x, max_y, corners_out)


@kernel
def write_hull(geometry, shapes, row, x, y, angle, corners_out):
    """Write the world corners [px] of a hull to corners_out (16, 2). Return (number of corners, rounding radius [px]).

    Arguments: see hull_at.
    """
    return hull_at(geometry, shapes, row, x, y, angle, corners_out), rounding(shapes, row)


@kernel
def missing_rasters(rows, bodies, shapes, rasters, raster_of, dt, missing_out):
    """List the rasters of masks that are needed now or at the end of the step, but have not been added yet.

    Return the number found, which may exceed the capacity of missing_out. Only masks with snap=True need such rasters.
    rows: indices of SHAPE rows; dt [s]: length of the step; missing_out (capacity, 2) int64: (geometry row of the mask,
    index of the angle bucket), possibly with duplicates. O(rows).
    """
    found = 0
    buckets = raster_of.shape[1]
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if s.role == PIXELS or (s.kind != MASK and not (s.kind == BOUNDS and s.wrapped == MASK)):
            continue  # drawn when a test needs it, see library.draw_masks
        b = bodies[s.body_row]
        if b.angle == 0.0 and b.angular_velocity == 0.0:
            continue  # unrotated, drawn when the mask was added
        if rasters[raster_of[s.geometry, 0]].halo >= 0:
            continue  # tested at its exact pose
        if not abs(b.angle + dt * b.angular_velocity) < math.inf:
            continue  # pose not finite
        for end in range(2):
            bucket = bucket_at(b.angle + end * dt * b.angular_velocity, buckets)
            if raster_of[s.geometry, bucket] < 0:
                if found < missing_out.shape[0]:
                    missing_out[found, 0] = s.geometry
                    missing_out[found, 1] = bucket
                found += 1
    return found


@subkernel
def place_mask(rasters, raster_of, body, shape_inout):
    """Write four values to the SHAPE row of a mask with snap=True: raster, left, top and AABB at its body's pose.

    left, top: pixel column and row of the raster's top left corner. rasters, raster_of: tables of the geometry, passed
    separately because passing the whole Geometry takes longer. body: BODY row; shape_inout: SHAPE row.
    """
    s = shape_inout
    s.raster = raster_of[s.geometry, bucket_at(body.angle, raster_of.shape[1])]
    r = rasters[s.raster]
    s.left = snapped(body.x, r.origin_x)
    s.top = snapped(body.y, r.origin_y)
    if r.area == 0:
        s.min_x, s.min_y, s.max_x, s.max_y = body.x, body.y, body.x, body.y
        return
    s.min_x, s.min_y = float(s.left + r.set_left), float(s.top + r.set_top)
    s.max_x, s.max_y = float(s.left + r.set_right), float(s.top + r.set_bottom)


@kernel
def place_masks(rows, geometry, bodies, shapes_inout):
    """Write the columns raster, left and top of masks for the poses of their bodies. O(rows).

    raster: row number of the raster; left, top: pixel column and row of its top left corner as drawn. rows: indices of
    SHAPE rows; shapes_inout: SHAPE table.
    """
    for k in range(len(rows)):
        s = shapes_inout[rows[k]]
        b = bodies[s.body_row]
        s.raster = raster_at(geometry, s.geometry, b.angle)
        r = geometry.rasters[s.raster]
        s.left = snapped(b.x, r.origin_x)
        s.top = snapped(b.y, r.origin_y)


@subkernel
def refresh_boxes(rows, geometry, bodies, shapes_inout):
    """Write the tight AABBs of shapes at their bodies' poses. For masks with snap=True also write raster, left and top.

    raster: row number of the mask's raster; left, top: pixel column and row of its top left corner. rows: indices of
    SHAPE rows; shapes_inout: SHAPE table. O(rows).
    """
    polygons = geometry.polygons
    table = geometry.corners
    rasters = geometry.rasters
    raster_of = geometry.raster_of
    for k in range(len(rows)):
        row = rows[k]
        s = shapes_inout[row]
        b = bodies[s.body_row]
        if not abs(b.angle) < math.inf:
            continue  # pose not finite: the next step reports it
        if s.kind == MASK:
            if s.role != PIXELS and s.snap:
                place_mask(rasters, raster_of, b, s)
            if s.role == PIXELS and b.angle == 0.0:
                upright = rasters[raster_of[s.geometry, 0]]
                s.min_x, s.min_y, s.max_x, s.max_y = upright_aabb(upright, b.x, b.y)
            elif s.role == PIXELS or not s.snap:
                s.min_x, s.min_y, s.max_x, s.max_y = exact_aabb(
                    rasters, table, raster_of[s.geometry, 0], b.x, b.y, b.angle
                )
        elif s.kind == CIRCLE:
            x, y = rotate(s.local_x, s.local_y, *rotation_of(b.angle))
            s.min_x, s.min_y = b.x + x - s.radius, b.y + y - s.radius
            s.max_x, s.max_y = b.x + x + s.radius, b.y + y + s.radius
        elif s.kind == POLYGON:
            s.min_x, s.min_y, s.max_x, s.max_y = polygon_aabb(
                polygons, table, s.geometry, s.radius, b.x, b.y, *rotation_of(b.angle)
            )
        else:
            s.min_x, s.min_y, s.max_x, s.max_y = aabb_at(geometry, shapes_inout, row, b.x, b.y, b.angle)


@kernel
def refresh_aabbs(rows, geometry, bodies, shapes_inout):
    """Write the tight AABBs of shapes at their bodies' poses. O(rows).

    This is refresh_boxes for callers that are not compiled. rows: indices of SHAPE rows; shapes_inout: SHAPE table.
    """
    refresh_boxes(rows, geometry, bodies, shapes_inout)


def add_missing_rasters(library: Any, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray, dt: float) -> None:
    """Add the rasters that masks with snap=True need at their present angles and at their angles after dt [s].

    rows: indices of SHAPE rows.
    """
    if not library.masks:
        return
    missing = np.zeros((2 * len(rows), 2), np.int64)
    found = missing_rasters(rows, bodies, shapes, library.tables.rasters, library.raster_of, dt, missing)
    if found:
        for mask, bucket in np.unique(missing[:found], axis=0).tolist():
            library.add_raster(mask, bucket)
