"""How deep a character is in one shape, and which way that lies: its outline against hulls, discs, masks and links."""

import math

from physics.collision.chains import collide_link_circle, collide_link_hull
from physics.collision.circles import collide_circles
from physics.collision.clipping import ALL_EDGES
from physics.collision.hulls import collide_hull_circle, collide_hulls
from physics.collision.mask_hulls import collide_mask_circle, collide_mask_polygon
from physics.collision.mask_rounded import collide_mask_rounded
from physics.jit import subkernel
from physics.math2d import turned
from physics.shapes.placement import corners_at, hull_at, raster_at, rounding, snapped
from physics.tables.shape import CIRCLE, MASK


@subkernel
def box_corners(left, top, width, height, corners_out):
    """The corners of a box of pixels."""
    corners_out[0, 0] = left
    corners_out[0, 1] = top
    corners_out[1, 0] = left + width
    corners_out[1, 1] = top
    corners_out[2, 0] = left + width
    corners_out[2, 1] = top + height
    corners_out[3, 0] = left
    corners_out[3, 1] = top + height


@subkernel
def place_outline(walk, me, left, top):
    """Write the character's corners, its box at a pixel, to scratch.mine. Returns their number and their rounding."""
    c = walk.characters[me]
    if c.is_box:
        box_corners(left, top, c.width, c.height, walk.scratch.mine)
        return 4, 0.0
    x = left + c.offset_x
    y = top + c.offset_y
    count = hull_at(walk.geometry, walk.shapes, c.shape_row, x, y, 0.0, walk.scratch.mine)
    return count, rounding(walk.shapes, c.shape_row)


@subkernel
def manifold_depth(points, manifold):
    """(depth [px], normal, the middle of the points) of a manifold with so many points; depth 0: apart."""
    if points == 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    depth = -manifold[5]
    x = manifold[3]
    y = manifold[4]
    if points == 2:
        depth = max(depth, -manifold[9])
        x = 0.5 * (x + manifold[7])
        y = 0.5 * (y + manifold[8])
    return max(depth, 0.0), manifold[1], manifold[2], x, y


@subkernel
def meet_disc(scratch, count, radius, x, y, other):
    """As meet, for a disc of radius `other` [px] at (x, y)."""
    mine = scratch.mine
    if count == 1:
        nx, ny, px, py, separation = collide_circles(mine[0, 0], mine[0, 1], radius, x, y, other)
        return max(-separation, 0.0), nx, ny, px, py
    hit, nx, ny, px, py, separation, feature = collide_hull_circle(mine, count, ALL_EDGES, radius, x, y, other)
    return -separation if hit and separation < 0.0 else 0.0, nx, ny, px, py


@subkernel
def meet_hull(scratch, count, radius, corners, rounded):
    """As meet, for the hull in scratch.theirs, of so many corners and that rounding [px]."""
    mine = scratch.mine
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_hull_circle(
            scratch.theirs, corners, ALL_EDGES, rounded, mine[0, 0], mine[0, 1], radius
        )
        return -separation if hit and separation < 0.0 else 0.0, -nx, -ny, x, y
    points = collide_hulls(
        mine, count, radius, ALL_EDGES, scratch.theirs, corners, rounded, ALL_EDGES, 0.0, 0.0, math.inf, scratch.points
    )
    return manifold_depth(points, scratch.points)


@subkernel
def meet_mask(walk, row, count, radius):
    """As meet, for a mask, by its pixels as drawn; depth 0: no pixel is shared."""
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    rasters = walk.geometry.rasters
    words = walk.geometry.words
    mine = walk.scratch.mine
    mask = raster_at(walk.geometry, s.geometry, b.angle)
    left = snapped(b.x, rasters[mask].origin_x)
    top = snapped(b.y, rasters[mask].origin_y)
    if count == 1:
        area, nx, ny, x, y, separation, first = collide_mask_circle(
            rasters, words, mask, left, top, mine[0, 0], mine[0, 1], radius
        )
    elif radius > 0.0:
        area, nx, ny, x, y, separation, first = collide_mask_rounded(
            rasters, words, mask, left, top, mine, count, radius
        )
    else:
        area, nx, ny, x, y, separation, first = collide_mask_polygon(
            rasters, words, mask, left, top, mine, count, ALL_EDGES, walk.scratch.depths
        )
    return -separation if area > 0 else 0.0, -nx, -ny, x, y


@subkernel
def meet_link(links, link, scratch, count, radius):
    """As meet, for one link of a chain, with its ends in scratch.theirs; from its back it is not met."""
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_link_circle(
            links[link], scratch.theirs, scratch.mine[0, 0], scratch.mine[0, 1], radius
        )
        return -separation if hit and separation < 0.0 else 0.0, -nx, -ny, x, y
    points = collide_link_hull(
        links[link], scratch.theirs, scratch.mine, count, radius, 0.0, 0.0, False, scratch.points
    )
    depth, nx, ny, x, y = manifold_depth(points, scratch.points)
    return depth, -nx, -ny, x, y


@subkernel
def meet(walk, row, count, radius):
    """(depth [px], normal from the character, the middle of what touches) of scratch.mine in a hull, disc or mask.

    count, radius: of the character, see place_outline. Depth 0: apart.
    """
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        return meet_disc(walk.scratch, count, radius, b.x + u, b.y + v, s.radius)
    if s.kind == MASK:
        return meet_mask(walk, row, count, radius)
    corners = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
    return meet_hull(walk.scratch, count, radius, corners, rounding(walk.shapes, row))
