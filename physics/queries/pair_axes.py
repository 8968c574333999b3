"""Every axis that could part two convex shapes, as the separating axis test sees them: for drawing."""

import numpy as np

from physics import checks
from physics.checks import Pose
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.kinds import Shape
from physics.shapes.library import Library
from physics.shapes.lines import Segment
from physics.shapes.placement import write_hull
from physics.shapes.rows import rounding_of
from physics.tables.shape import SHAPE

AXIS = np.dtype(
    [
        ("normal_x", np.float64),
        ("normal_y", np.float64),  # unit, from A to B
        ("separation", np.float64),  # [px] of the two shapes, radii included, along the normal
        ("owner", np.int64),  # 0: an edge of A, 1: of B
        ("edge", np.int64),
    ]
)  # its first corner; -1: no edge, the way between the nearest corners
HULLS = (Circle, Capsule, Segment, Polygon, Bounds)


def sat_axes(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> np.ndarray:
    """(n,) AXIS rows of two shapes at poses (x, y) or (x, y, angle), the axis that separates most first.

    The greatest separation is the distance, or minus the depth. Raises TypeError for what is no convex shape.
    """
    a, b = _core("shape_a", shape_a, "pose_a", pose_a), _core("shape_b", shape_b, "pose_b", pose_b)
    rows = []
    for owner, mine in enumerate((a[0], b[0])):
        sign = 1.0 if owner == 0 else -1.0
        for edge in range(len(mine) if len(mine) > 1 else 0):
            dx, dy = mine[(edge + 1) % len(mine)] - mine[edge]
            normal = sign * np.array([dy, -dx]) / np.hypot(dx, dy)
            rows.append((*normal, owner, edge))
    gaps = b[0][None, :, :] - a[0][:, None, :]
    away = np.hypot(gaps[:, :, 0], gaps[:, :, 1])
    i, j = np.unravel_index(np.argmin(away), away.shape)
    if away[i, j] > 0.0:
        rows.append((*(gaps[i, j] / away[i, j]), 0, -1))
    elif not rows:
        rows.append((1.0, 0.0, 0, -1))  # two circles about one point: as collide has it
    found = np.zeros(len(rows), AXIS)
    for row, (nx, ny, owner, edge) in zip(found, rows, strict=True):
        apart = (b[0] @ (nx, ny)).min() - (a[0] @ (nx, ny)).max() - a[1] - b[1]
        row["normal_x"], row["normal_y"], row["separation"], row["owner"], row["edge"] = (
            nx + 0.0,
            ny + 0.0,
            apart,
            owner,
            edge,
        )
    return found[np.argsort(-found["separation"], kind="stable")]


def _core(name, shape, pose_name, pose):
    """(world corners (n, 2), radius) of a convex shape at a pose [px]."""
    if not isinstance(shape, HULLS) or (isinstance(shape, Bounds) and not isinstance(shape.shape, HULLS)):
        raise TypeError(
            f"{name} must be a Circle, Capsule, Segment, Polygon or Bounds of one (got {checks.shown(shape)})"
        )
    x, y, angle = checks.pose(pose_name, pose)
    library, rows, corners = Library(), np.zeros(1, SHAPE), np.zeros((16, 2))
    rows["kind"], rows["geometry"], rows["wrapped"] = library.add(shape)
    rows["radius"], rows["local_x"], rows["local_y"] = rounding_of(shape)
    count, radius = write_hull(library.tables, rows, 0, x, y, angle, corners)
    return corners[:count], radius
