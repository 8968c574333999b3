"""How far apart two shapes are at two poses, without a world; and GJK's steps between them, for drawing."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from physics import checks
from physics.checks import Pose
from physics.proximity.gjk import AX, AY, NX, NY, new_gap_workspace
from physics.proximity.trace import steps_of
from physics.proximity.witness import separate_parts
from physics.queries.pair_manifold import collide
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Circle
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.library import Library
from physics.shapes.lines import Chain
from physics.shapes.mask import PixelMask
from physics.shapes.parts import placed_parts
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rows import place
from physics.shapes.tiles import TileGrid
from physics.tables.body import BODY
from physics.tables.shape import SHAPE
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
    """Distance of two shapes at poses (x, y) or (x, y, angle). <= 0 exactly where `collide` finds a contact.

    Convex shapes: exact to rounding. Concave ones: that of their nearest parts, and where they overlap the depth that
    `collide` gives. Where shapes touch or cross without a contact (two masks side by side; a Chain from behind; tiles
    on tiles) it is the smallest number above 0. A mask is measured as it is drawn, on the pixel grid. Infinite, with
    the normal (1, 0), to a shape without a solid cell or pixel. Raises TypeError, ValueError.
    """
    pose_a, pose_b = checked("shape_a", shape_a, "pose_a", pose_a), checked("shape_b", shape_b, "pose_b", pose_b)
    if order_of(shape_b, pose_b) < order_of(shape_a, pose_a):
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
    parts_a, parts_b = _parts(shape_a, pose_a, shape_b, pose_b, x, y)
    workspace, totals = new_gap_workspace(), np.zeros(2)
    found = separate_parts(parts_a, parts_b, np.zeros((16, 2)), np.zeros((16, 2)), workspace, totals)
    if math.isinf(found):
        return Distance(math.inf, Vec2(*pose_a[:2]), Vec2(*pose_b[:2]), Vec2(1.0, 0.0), 0)
    nx, ny, ax, ay = (float(workspace.gap[k]) for k in (NX, NY, AX, AY))
    size = float(
        max(
            np.ptp(parts_a.boxes.reshape(-1, 2, 2), axis=(0, 1)).max(),
            np.ptp(parts_b.boxes.reshape(-1, 2, 2), axis=(0, 1)).max(),
        )
    )
    convex = not any(isinstance(each, (TileGrid, PixelMask, Chain)) for each in (shape_a, shape_b))
    band = ROUNDING_BAND * size + 4.0 * math.ulp(max(map(abs, (*pose_a[:2], *pose_b[:2]))))
    if any(isinstance(each, Chain) for each in (shape_a, shape_b)):
        band = size  # what was pressed through a link may hang wholly behind it and still be pushed out
    if found <= band and not (convex and found < -band):
        contact = collide(shape_a, pose_a, shape_b, pose_b)
        if not len(contact):
            found = max(found, NEXT_TO_NOTHING)
        elif convex:
            found = min(found, 0.0)
        else:
            deepest = int(np.argmin(contact.separations))
            found, (nx, ny) = min(float(contact.separations[deepest]), 0.0), contact.normal
            ax, ay = contact.points[deepest] - 0.5 * found * np.array((nx, ny)) - (x, y)
    point_a = Vec2(x + float(ax), y + float(ay))
    nx, ny = nx + 0.0, ny + 0.0
    point_b = Vec2(point_a[0] + found * nx, point_a[1] + found * ny)
    return Distance(float(found), point_a, point_b, Vec2(nx, ny), int(totals[0]))


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
    library = Library()
    bodies, shapes = np.zeros(2, BODY), np.zeros(2, SHAPE)
    for row, (shape, pose) in enumerate(((shape_a, pose_a), (shape_b, pose_b))):
        place(library, shape, bodies, shapes, row, pose)
    refresh_aabbs(np.arange(2), library.tables, bodies, shapes)
    return tuple(placed_parts(library, bodies, shapes, row, x, y, float(shapes[1 - row]["max_y"])) for row in (0, 1))


def checked(shape_name: str, shape: Any, pose_name: str, pose: Any) -> tuple[float, float, float]:
    """The pose as numbers. Raises TypeError or ValueError that names the argument."""
    if not isinstance(shape, SHAPES):
        raise TypeError(f"{shape_name} must be a shape such as Circle(8) (got {checks.shown(shape)})")
    pose = checks.pose(pose_name, pose)
    if isinstance(shape, TileGrid) and pose[2] != 0.0:
        raise ValueError(f"{pose_name} must have angle 0 for a TileGrid (got {pose[2]})")
    return pose


def order_of(shape: Shape, *poses: tuple[float, float, float]) -> tuple:
    """A key that orders any two shapes at poses, so that swapping them changes no bit of the result but the signs."""
    kind = next(k for k, each in enumerate(SHAPES) if isinstance(shape, each))
    if isinstance(shape, Bounds):
        return (kind, *order_of(shape.shape, *poses))
    if isinstance(shape, TileGrid):
        value = (
            *shape.solid.shape,
            shape.tile_size,
            shape.solid.tobytes(),
            shape.slopes.tobytes(),
            shape.one_way.tobytes(),
        )
    elif isinstance(shape, PixelMask):
        value = (*shape.size, *shape.origin, shape.solid.tobytes())
    else:
        points = (shape.center,) if isinstance(shape, Circle) else shape.points
        value = (getattr(shape, "radius", 0.0), len(points), *(each for point in points for each in point))
    return (kind, *value, *poses)
