"""How far apart two shapes are at two poses, without a world; and GJK's steps between them, for drawing."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from physics import checks
from physics.checks import Pose
from physics.jit import kernel, subkernel
from physics.proximity.gjk import AX, AY, NX, NY, ROUNDS, new_gap_workspace
from physics.proximity.separation import separate
from physics.proximity.trace import steps_of
from physics.proximity.witness import separate_parts
from physics.queries.pair_manifold import collide
from physics.queries.pair_rows import any_pair, hull_pair, hull_row, order_of
from physics.shapes.bounds import Bounds
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.lines import Chain
from physics.shapes.mask import PixelMask
from physics.shapes.parts import placed_parts
from physics.shapes.placement import hull_at, rounding
from physics.shapes.tiles import TileGrid
from physics.vec2 import Vec2

ROUNDING_BAND = 1e-11  # of the size: within it the contact test says on which side of touching two shapes are
NEXT_TO_NOTHING = math.ulp(0.0)  # [px] apart, and no number is smaller: shapes that touch without a contact


@dataclass(frozen=True)
class Distance:
    """Distance [px], negative when they overlap; nearest points; unit normal from A to B; rounds of GJK and EPA.

    point_b = point_a + distance · normal. Of shapes that overlap the distance is -(the move of B along the normal that
    ends it), and the points are the two surfaces' along it.
    """

    distance: float
    point_a: Vec2
    point_b: Vec2
    normal: Vec2
    iterations: int


def distance(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> Distance:
    """Distance of two shapes at poses (x, y) or (x, y, angle). <= 0 exactly where `collide` finds a contact, of masks
    < 0.

    Convex shapes: exact to rounding. Concave ones: that of their nearest parts, and where they overlap the depth that
    `collide` gives. What touches a mask without sharing area is 0 from it, without a contact; where other shapes touch
    or cross without a contact (a Chain from behind; tiles on tiles) it is the smallest number above 0. A mask is
    measured by its pixels, a snapped one as it is drawn, on the pixel grid. Infinite, with the normal (1, 0), to a
    shape without a solid cell or pixel. Raises TypeError, ValueError.
    """
    pose_a, pose_b = checked("shape_a", shape_a, "pose_a", pose_a), checked("shape_b", shape_b, "pose_b", pose_b)
    if (*order_of(shape_b), *pose_b) < (*order_of(shape_a), *pose_a):
        found = _measure(shape_b, pose_b, shape_a, pose_a)
        return Distance(
            found.distance,
            found.point_b,
            found.point_a,
            Vec2(0.0 - found.normal[0], 0.0 - found.normal[1]),
            found.iterations,
        )
    return _measure(shape_a, pose_a, shape_b, pose_b)


def _measure(shape_a, pose_a, shape_b, pose_b) -> Distance:
    # Seen from A, so that far from the origin no digits are lost.
    x, y = pose_a[0], pose_a[1]
    workspace, row_a, row_b = new_gap_workspace(), hull_row(shape_a), hull_row(shape_b)
    boxes = isinstance(shape_a, Bounds) or isinstance(shape_b, Bounds)  # which stand where they stand in the world
    if row_a is not None and row_b is not None and not boxes:
        rows = hull_pair(row_a, pose_a, row_b, pose_b)
        found, size, rounds = separate_hulls(*rows, x, y, np.zeros((16, 2)), np.zeros((16, 2)), workspace)
    else:
        found, size, rounds = _separate_any(shape_a, pose_a, shape_b, pose_b, workspace)
    if math.isinf(found):
        return Distance(math.inf, Vec2(*pose_a[:2]), Vec2(*pose_b[:2]), Vec2(1.0, 0.0), 0)
    nx, ny, ax, ay = (float(workspace.gap[k]) for k in (NX, NY, AX, AY))
    convex = not any(isinstance(each, (TileGrid, PixelMask, Chain)) for each in (shape_a, shape_b))
    band = ROUNDING_BAND * size + 4.0 * math.ulp(max(map(abs, (*pose_a[:2], *pose_b[:2]))))
    if any(isinstance(each, Chain) for each in (shape_a, shape_b)):
        band = size  # what was pressed through a link may hang wholly behind it and still be pushed out
    if found <= band and not (convex and found < -band):
        contact = collide(shape_a, pose_a, shape_b, pose_b)
        if not len(contact):
            found = max(found, 0.0 if _are_open(shape_a, shape_b) else NEXT_TO_NOTHING)
        elif convex:
            found = min(found, 0.0)
        else:
            deepest = int(np.argmin(contact.separations))
            found, (nx, ny) = min(float(contact.separations[deepest]), 0.0), contact.normal
            ax, ay = contact.points[deepest] - 0.5 * found * np.array((nx, ny)) - (x, y)
    point_a = Vec2(x + float(ax), y + float(ay))
    nx, ny = nx + 0.0, ny + 0.0
    point_b = Vec2(point_a[0] + found * nx, point_a[1] + found * ny)
    return Distance(float(found), point_a, point_b, Vec2(nx, ny), int(rounds))


def _are_open(shape_a, shape_b) -> bool:
    """Whether one is a mask, the other no chain: touching, they are 0 apart and share nothing."""
    pair = (shape_a, shape_b)
    return any(isinstance(each, PixelMask) for each in pair) and not any(isinstance(each, Chain) for each in pair)


@kernel
def separate_hulls(geometry, bodies, shapes, x, y, corners_a_out, corners_b_out, workspace):
    """Write separation, normal and points, seen from (x, y) [px], of the hulls in rows 0 and 1 to workspace.gap.

    corners_a_out, corners_b_out (16, 2): scratch. Returns (separation [px], the greater size of both [px], rounds of
    GJK and EPA).
    """
    a = bodies[0]
    b = bodies[1]
    count_a = hull_at(geometry, shapes, 0, a.x - x, a.y - y, a.angle, corners_a_out)
    count_b = hull_at(geometry, shapes, 1, b.x - x, b.y - y, b.angle, corners_b_out)
    radius_a = rounding(shapes, 0)
    radius_b = rounding(shapes, 1)
    separation = separate(corners_a_out, count_a, radius_a, corners_b_out, count_b, radius_b, 0, 0, workspace)
    size = max(size_of(corners_a_out, count_a, radius_a), size_of(corners_b_out, count_b, radius_b))
    return separation, size, workspace.state[ROUNDS]


@subkernel
def size_of(corners, count, radius):
    """The longer side of the box [px] around a rounded hull."""
    longest = 0.0
    for axis in range(2):
        low = corners[0, axis]
        high = low
        for k in range(1, count):
            low = min(low, corners[k, axis])
            high = max(high, corners[k, axis])
        longest = max(longest, (high + radius) - (low - radius))
    return longest


def _separate_any(shape_a, pose_a, shape_b, pose_b, workspace):
    """What separate_hulls tells, of any two shapes; infinite where one has no parts."""
    parts_a, parts_b = _parts(shape_a, pose_a, shape_b, pose_b, pose_a[0], pose_a[1])
    totals = np.zeros(2)
    found = separate_parts(parts_a, parts_b, np.zeros((16, 2)), np.zeros((16, 2)), workspace, totals)
    if math.isinf(found):
        return found, 0.0, 0
    size = max(np.ptp(parts.boxes.reshape(-1, 2, 2), axis=(0, 1)).max() for parts in (parts_a, parts_b))
    return found, float(size), totals[0]


def gjk_steps(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> list[dict]:
    """The rounds of GJK, and of EPA when they overlap, between the cores of two convex shapes: see trace.steps_of.

    Points are seen from A's origin. Raises TypeError for shapes that are not convex, ValueError.
    """
    for name, shape in (("shape_a", shape_a), ("shape_b", shape_b)):
        if isinstance(shape, (TileGrid, PixelMask, Chain)):
            raise TypeError(f"{name} must be a convex shape (got {checks.shown(shape)})")
    pose_a, pose_b = checked("shape_a", shape_a, "pose_a", pose_a), checked("shape_b", shape_b, "pose_b", pose_b)
    parts_a, parts_b = _parts(shape_a, pose_a, shape_b, pose_b, pose_a[0], pose_a[1])
    return steps_of(parts_a.corners[0, : parts_a.counts[0]], parts_b.corners[0, : parts_b.counts[0]])


def _parts(shape_a, pose_a, shape_b, pose_b, x, y):
    library, (_, bodies, shapes) = any_pair(shape_a, pose_a, shape_b, pose_b)
    return tuple(placed_parts(library, bodies, shapes, row, x, y, float(shapes[1 - row]["max_y"])) for row in (0, 1))


def checked(shape_name: str, shape: Any, pose_name: str, pose: Any) -> tuple[float, float, float]:
    """The pose as numbers. Raises TypeError or ValueError that names the argument."""
    if not isinstance(shape, SHAPES):
        raise TypeError(f"{shape_name} must be a shape such as Circle(8) (got {checks.shown(shape)})")
    pose = checks.pose(pose_name, pose)
    if isinstance(shape, TileGrid) and pose[2] != 0.0:
        raise ValueError(f"{pose_name} must have angle 0 for a TileGrid (got {pose[2]})")
    return pose
