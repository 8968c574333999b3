"""Masks that are not snapped, at their exact pose, against hulls and tiles: in the raster of the mask.

There the mask is drawn, and the other shape, turned back by the mask's angle, is met as mask_hulls.py has it: the same
verdict, normal and depth. The area and the point, its centroid, are those of what is shared, to rounding. A line has no
area: of it the pixels are counted, as of a mask that is snapped.
"""

from physics.collision.clipping import ALL_EDGES
from physics.collision.hull_shares import shared_with_hull
from physics.collision.mask_hulls import collide_mask_circle, collide_mask_line, collide_mask_polygon
from physics.collision.mask_rounded import collide_mask_rounded
from physics.collision.upright import upright_corners
from physics.jit import subkernel
from physics.math2d import cosine_and_sine, turned
from physics.raster.exact import ROUNDED
from physics.shapes.mask_pose import into_raster, out_of_raster, raster_of_shape
from physics.shapes.placement import polygon_at
from physics.tables.shape import BOUNDS, CIRCLE


@subkernel
def least_area(raster):
    """[px2] that a hit shares at least: rounding may leave less of a corner that is just in."""
    slack = ROUNDED * (raster.width + raster.height)
    return slack * slack


@subkernel
def hull_in_raster(geometry, bodies, shapes, mask, other, corners_out):
    """Write the corners [px] of a hull in the raster of a mask that is not snapped. Returns their number.

    mask, other: rows of SHAPE. Two angles are taken from each other first, so that both at quarter turns are exact.
    """
    s = shapes[mask]
    o = shapes[other]
    b = bodies[s.body_row]
    p = bodies[o.body_row]
    r = geometry.rasters[raster_of_shape(geometry, s)]
    cosine, sine = cosine_and_sine(b.angle, b.angle)
    if o.kind == BOUNDS:
        count = upright_corners(o, corners_out)
        for k in range(count):
            x, y = into_raster(r, b, cosine, sine, corners_out[k, 0], corners_out[k, 1])
            corners_out[k, 0] = x
            corners_out[k, 1] = y
        return count
    x, y = into_raster(r, b, cosine, sine, p.x, p.y)
    cosine, sine = cosine_and_sine(p.angle - b.angle, max(abs(p.angle), abs(b.angle)))
    if o.kind == CIRCLE:
        u, v = turned(o.local_x, o.local_y, cosine, sine)
        corners_out[0, 0] = x + u
        corners_out[0, 1] = y + v
        return 1
    return polygon_at(geometry.polygons, geometry.corners, o.geometry, x, y, cosine, sine, corners_out)


@subkernel
def meet_in_raster(rasters, words, mask, corners, count, radius, edges, depths_out):
    """(area [px2], normal from the mask, point, separation, first pixel) of a mask and a rounded hull in its raster.

    edges: bits of the edges that may be touched; depths_out (16,): scratch. The area is 0 when they share none.
    """
    if count == 1:
        pixels, nx, ny, x, y, separation, first = collide_mask_circle(
            rasters, words, mask, 0, 0, corners[0, 0], corners[0, 1], radius
        )
    elif radius > 0.0:
        pixels, nx, ny, x, y, separation, first = collide_mask_rounded(
            rasters, words, mask, 0, 0, corners, count, radius
        )
    elif count == 2:
        pixels, nx, ny, x, y, separation, first = collide_mask_line(rasters, words, mask, 0, 0, corners, depths_out)
        return float(pixels), nx, ny, x, y, separation, first
    else:
        pixels, nx, ny, x, y, separation, first = collide_mask_polygon(
            rasters, words, mask, 0, 0, corners, count, edges, depths_out
        )
    if pixels == 0:
        return 0.0, nx, ny, x, y, separation, first
    area, moment_x, moment_y = shared_with_hull(rasters, words, mask, corners, count, radius)
    least = least_area(rasters[mask])
    if area > least:
        x = moment_x / area
        y = moment_y / area
    return max(area, least), nx, ny, x, y, separation, first


@subkernel
def out_of_mask(geometry, body, shape, nx, ny, x, y):
    """A normal and a point in the raster of a mask that is not snapped, in the world."""
    cosine, sine = cosine_and_sine(body.angle, body.angle)
    wx, wy = turned(nx, ny, cosine, sine)
    px, py = out_of_raster(geometry.rasters[raster_of_shape(geometry, shape)], body, cosine, sine, x, y)
    return wx, wy, px, py


@subkernel
def meet_polygon(geometry, body, shape, corners, count, edges, scratch, depths_out):
    """As meet_in_raster, of a MASK row, snapped or not, and a convex polygon with corners in the world [px], all told
    in the world. scratch (16, 2): for the corners in its raster."""
    mask = raster_of_shape(geometry, shape)
    rasters = geometry.rasters
    words = geometry.words
    if shape.snap:
        pixels, nx, ny, x, y, separation, first = collide_mask_polygon(
            rasters, words, mask, shape.left, shape.top, corners, count, edges, depths_out
        )
        return float(pixels), nx, ny, x, y, separation, first
    cosine, sine = cosine_and_sine(body.angle, body.angle)
    for k in range(count):
        x, y = into_raster(rasters[mask], body, cosine, sine, corners[k, 0], corners[k, 1])
        scratch[k, 0] = x
        scratch[k, 1] = y
    area, nx, ny, x, y, separation, first = meet_in_raster(rasters, words, mask, scratch, count, 0.0, edges, depths_out)
    nx, ny, x, y = out_of_mask(geometry, body, shape, nx, ny, x, y)
    return area, nx, ny, x, y, separation, first


@subkernel
def exact_area(geometry, bodies, shapes, mask, other, radius, corners_out, depths_out):
    """The area [px2] of a mask that is not snapped in a hull, rows of SHAPE, of that rounding [px]."""
    count = hull_in_raster(geometry, bodies, shapes, mask, other, corners_out)
    return meet_in_raster(
        geometry.rasters,
        geometry.words,
        raster_of_shape(geometry, shapes[mask]),
        corners_out,
        count,
        radius,
        ALL_EDGES,
        depths_out,
    )[0]
