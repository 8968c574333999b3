"""How deep a character is in one shape, and which way that lies: its outline against hulls, discs and links."""

import math

from physics.character.ground import deepest_of
from physics.collision.chains import collide_link_circle, collide_link_hull
from physics.collision.circles import COVERED, collide_circles
from physics.collision.clipping import ALL_EDGES, LEFT
from physics.collision.hulls import collide_hull_circle, collide_hulls, faces_of
from physics.jit import subkernel
from physics.math2d import turned
from physics.shapes.placement import corners_at, hull_at, rounding
from physics.tables.shape import CIRCLE


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
def meet_hull(scratch, count, radius, corners, rounded, edges, deepest):
    """As meet, for the hull in scratch.theirs, of so many corners and that rounding [px].

    edges, deepest: as in hulls.collide_hulls. scratch.points[0] is LEFT where a neighbour is to tell it.
    """
    mine = scratch.mine
    scratch.points[0] = 0.0
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_hull_circle(
            scratch.theirs, corners, edges, rounded, mine[0, 0], mine[0, 1], radius
        )
        depth = -separation if hit and separation < 0.0 else 0.0
        if feature == COVERED or (edges != ALL_EDGES and depth > deepest):
            scratch.points[0] = LEFT
            return 0.0, -nx, -ny, x, y
        scratch.points[0] = 1.0 if depth > 0.0 else 0.0
        return depth, -nx, -ny, x, y
    own = faces_of(mine, count, scratch.theirs, corners, edges) if edges != ALL_EDGES else ALL_EDGES
    points = collide_hulls(
        mine, count, radius, own, scratch.theirs, corners, rounded, edges, 0.0, 0.0, deepest, scratch.points
    )
    return manifold_depth(points, scratch.points)


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
    """(depth [px], normal from the character, the middle of what touches) of scratch.mine in a hull or a disc.

    count, radius: of the character, see place_outline. Depth 0: apart; or a neighbour in its mask's outline has the
    nearer surface, which scratch.points[0] says: LEFT.
    """
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        walk.scratch.points[0] = 0.0
        return meet_disc(walk.scratch, count, radius, b.x + u, b.y + v, s.radius)
    corners = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
    deepest = math.inf if s.inner == 0 else deepest_of(b, walk.settings.slop, walk.settings.dt)
    return meet_hull(walk.scratch, count, radius, corners, rounding(walk.shapes, row), ALL_EDGES ^ s.inner, deepest)
