"""Where a mask that is not snapped stands: its raster at the angle 0, turned and moved with its body.

What is tested against it is brought into its raster, where its pixels are [i, i + 1) x [j, j + 1): x and y [px] from
the raster's top left corner, along its rows and columns. Differences of positions are taken first, so that far from the
world's origin no digits are lost; quarter turns are exact.
"""

from physics.jit import kernel, subkernel
from physics.math2d import cosine_and_sine, turned


@subkernel
def exact_aabb(rasters, corners, raster, x, y, angle):
    """Tight AABB [px] of a mask's solid pixels when its body is at a pose; the point itself when there is none.

    corners: geometry.corners; raster: of the angle 0. O(corners of its hull).
    """
    r = rasters[raster]
    if r.hull_count == 0:
        return x, y, x, y
    cosine, sine = cosine_and_sine(angle, angle)
    first = corners[r.hull]
    min_x, min_y = turned(first.x, first.y, cosine, sine)
    max_x = min_x
    max_y = min_y
    for k in range(r.hull + 1, r.hull + r.hull_count):
        corner = corners[k]
        u, v = turned(corner.x, corner.y, cosine, sine)
        min_x = min(min_x, u)
        max_x = max(max_x, u)
        min_y = min(min_y, v)
        max_y = max(max_y, v)
    return x + min_x, y + min_y, x + max_x, y + max_y


@subkernel
def into_raster(raster, body, cosine, sine, x, y):
    """A point of the world [px] in the raster of a mask whose body is turned by that cosine and sine."""
    u, v = turned(x - body.x, y - body.y, cosine, -sine)
    return u + raster.origin_x, v + raster.origin_y


@subkernel
def out_of_raster(raster, body, cosine, sine, x, y):
    """A point of the raster in the world [px]."""
    u, v = turned(x - raster.origin_x, y - raster.origin_y, cosine, sine)
    return body.x + u, body.y + v


@subkernel
def raster_of_shape(geometry, shape):
    """The raster row that a MASK is tested by: as it is drawn, or that of the angle 0 where it is not snapped."""
    return shape.raster if shape.snap else geometry.raster_of[shape.geometry, 0]


@subkernel
def box_as_tested(geometry, shape):
    """AABB (min_x, min_y, max_x, max_y) [px] of the solid pixels that a MASK row is tested by: as it is drawn, or at
    its exact pose where it is not snapped."""
    r = geometry.rasters[shape.raster]
    if not shape.snap or r.area == 0:
        return shape.min_x, shape.min_y, shape.max_x, shape.max_y
    left = float(shape.left)
    top = float(shape.top)
    return left + r.set_left, top + r.set_top, left + r.set_right, top + r.set_bottom


@subkernel
def raster_in_raster(geometry, frame_body, frame_shape, body, shape):
    """Where the raster of another mask, snapped or not, stands in that of a mask that is not snapped.

    Returns (x, y of its top left corner [px], cosine and sine of its angle).
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
    u, v = turned(other.origin_x, other.origin_y, cosine, sine)
    return x - u, y - v, cosine, sine


@kernel
def turn_of_mask(angle):
    """(cosine, sine) of the angle [rad] of a mask that is not snapped."""
    return cosine_and_sine(angle, angle)
