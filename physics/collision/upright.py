"""Boxes along the axes, as their AABBs stand in the table of shapes: no corner is turned, no axis but theirs is tried.

The answer is that of hulls.collide_hulls for the same boxes: points, separations, features.
"""

from physics.collision.features import clipped_feature, corners_feature
from physics.jit import subkernel
from physics.math2d import length_of, unit


@subkernel
def upright_corners(shape, corners_out):
    """Write the corners [px] of a SHAPE row's AABB, clockwise on the screen from the top left. Returns their number."""
    corners_out[0, 0] = shape.min_x
    corners_out[0, 1] = shape.min_y
    corners_out[1, 0] = shape.max_x
    corners_out[1, 1] = shape.min_y
    corners_out[2, 0] = shape.max_x
    corners_out[2, 1] = shape.max_y
    corners_out[3, 0] = shape.min_x
    corners_out[3, 1] = shape.max_y
    return 4


@subkernel
def between(value, low, high):
    """The value, or the bound that it is beyond."""
    return max(low, min(high, value))


@subkernel
def corner_of_upright(a, b, margin, manifold_out):
    """One point between the nearest corners of two boxes that lie apart along both axes. Returns the number."""
    right = b.min_x > a.max_x
    below = b.min_y > a.max_y
    ax = a.max_x if right else a.min_x
    ay = a.max_y if below else a.min_y
    dx = (b.min_x if right else b.max_x) - ax
    dy = (b.min_y if below else b.max_y) - ay
    distance = length_of(dx, dy)
    if distance > margin:
        return 0
    nx, ny = unit(dx, dy, 0.0, -1.0)
    i = (2 if right else 3) if below else (1 if right else 0)
    manifold_out[0] = 1.0
    manifold_out[1] = nx
    manifold_out[2] = ny
    manifold_out[3] = ax + 0.5 * distance * nx
    manifold_out[4] = ay + 0.5 * distance * ny
    manifold_out[5] = distance
    manifold_out[6] = float(corners_feature(i, (i + 2) % 4))
    return 1


@subkernel
def collide_upright(a, b, margin, manifold_out):
    """Manifold of the AABBs of two SHAPE rows, normal from A to B. Returns the number of points, 0 when apart by more
    than margin [px]. manifold_out: see clipping.py."""
    up = a.min_y - b.max_y
    right = b.min_x - a.max_x
    down = b.min_y - a.max_y
    left = a.min_x - b.max_x
    manifold_out[0] = 0.0
    edge = 0
    separation = up
    if right > separation:
        edge = 1
        separation = right
    if down > separation:
        edge = 2
        separation = down
    if left > separation:
        edge = 3
        separation = left
    if separation > margin:
        return 0
    if max(up, down) > 0.0 and max(left, right) > 0.0:
        return corner_of_upright(a, b, margin, manifold_out)
    manifold_out[0] = 2.0
    manifold_out[5] = separation
    manifold_out[9] = separation
    half = 0.5 * separation
    if edge == 0 or edge == 2:
        y = a.min_y - half if edge == 0 else a.max_y + half
        manifold_out[1] = 0.0
        manifold_out[2] = -1.0 if edge == 0 else 1.0
        manifold_out[3] = between(b.min_x if edge == 0 else b.max_x, a.min_x, a.max_x)
        manifold_out[4] = y
        manifold_out[7] = between(b.max_x if edge == 0 else b.min_x, a.min_x, a.max_x)
        manifold_out[8] = y
    else:
        x = a.min_x - half if edge == 3 else a.max_x + half
        manifold_out[1] = -1.0 if edge == 3 else 1.0
        manifold_out[2] = 0.0
        manifold_out[3] = x
        manifold_out[4] = between(b.min_y if edge == 1 else b.max_y, a.min_y, a.max_y)
        manifold_out[7] = x
        manifold_out[8] = between(b.max_y if edge == 1 else b.min_y, a.min_y, a.max_y)
    manifold_out[6] = float(clipped_feature(edge, (edge + 3) % 4, 0, 0))
    manifold_out[10] = float(clipped_feature(edge, (edge + 2) % 4, 1, 0))
    return 2
