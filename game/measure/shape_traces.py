"""Iterations of the separating axis test, GJK and EPA, as data for drawing."""

import numpy as np

from physics import checks
from physics.annotations import Pose
from physics.distance.gjk import (
    APART,
    AX,
    BY,
    COUNT,
    EPA_CAP,
    GJK_CAP,
    NORMAL_X,
    NORMAL_Y,
    NX,
    NY,
    SEARCHING,
    SEPARATION,
    TOUCHING,
    grow_polytope,
    new_gap_workspace,
    reduce_simplex,
    start_polytope,
    start_walk,
    walk_on,
    write_depth,
    write_nearest,
)
from physics.queries.pairs import parts_of_pair
from physics.shapes.kinds import SHAPES, Bounds, checked_pose
from physics.shapes.shape import Shape
from physics.shapes.values import Convex, Polygon

# ---- pair axes -------------------------------------------------------------------------------------------------------
# The axes that the separating axis test tries for two convex shapes, for drawing.

AXIS = np.dtype(
    [
        ("normal_x", np.float64),
        ("normal_y", np.float64),  # unit, from A to B
        ("separation", np.float64),  # [px] of the two shapes, radii included, along the normal
        ("owner", np.int64),  # 0: an edge of A, 1: of B
        ("edge", np.int64),
    ]
)  # edge: index of its first corner; -1: the axis is the direction between the nearest corners, no edge normal


def sat_axes(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> np.ndarray:
    """Return the axes that the separating axis test tries, as (n,) AXIS rows, largest separation first.

    A pose is (x, y) [px] or (x, y, angle). The largest separation is the distance between the two shapes, or the
    negative depth of their overlap. Raises TypeError for a shape that is not convex.
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
    """Return (corners (n, 2) in the world [px], rounding radius [px]) of a convex shape at a pose.

    name, pose_name: names of the arguments `shape` and `pose`, used in error messages.
    """
    if not isinstance(shape.shape if isinstance(shape, Bounds) else shape, Convex):
        hulls = sorted((each for each in SHAPES if issubclass(each, Convex)), key=lambda each: each is Polygon)
        names = ", ".join(each.__name__ for each in hulls)
        raise TypeError(f"{name} must be a {names} or Bounds of one (got {checks.shown(shape)})")
    pose = checked_pose(name, shape, pose_name, pose)
    parts = parts_of_pair(shape, pose, shape, pose, 0.0, 0.0)[0]
    return parts.corners[0, : parts.counts[0]], float(parts.radii[0])


# ---- trace -----------------------------------------------------------------------------------------------------------
# GJK and EPA, one iteration at a time, for drawing. Each iteration calls the functions that the physics runs.


def gjk_steps(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> list[dict]:
    """Return the iterations of GJK for two convex shapes without their rounding radii, one dict per iteration.

    If the shapes overlap, the iterations of EPA follow. steps_of() describes the dicts. Points are relative to the
    origin of A. Raises TypeError for a shape that is not convex, and ValueError for an invalid pose.
    """
    pose_a = checked_pose("shape_a", shape_a, "pose_a", pose_a)
    pose_b = checked_pose("shape_b", shape_b, "pose_b", pose_b)
    for name, shape in (("shape_a", shape_a), ("shape_b", shape_b)):
        if not isinstance(shape, (Convex, Bounds)):
            raise TypeError(f"{name} must be a convex shape (got {checks.shown(shape)})")
    parts_a, parts_b = parts_of_pair(shape_a, pose_a, shape_b, pose_b, pose_a[0], pose_a[1])
    return steps_of(parts_a.corners[0, : parts_a.counts[0]], parts_b.corners[0, : parts_b.counts[0]])


def steps_of(a: np.ndarray, b: np.ndarray) -> list[dict]:
    """Return the state after each iteration of GJK and EPA, one dict per iteration.

    a, b: (n, 2) corners [px] of two polygons. The keys of a dict:
      "phase": "gjk" or "epa"
      "simplex": (k, 2) points of the Minkowski difference A - B
      "polytope": (k, 2) points of A - B, only in the phase "epa"
      "witness": the nearest points so far, one on A and one on B
      "direction": unit direction of the next search
      "distance": separation so far [px], negative if the polygons overlap
    """
    a, b = (np.ascontiguousarray(each, np.float64) for each in (a, b))
    workspace = new_gap_workspace()
    found, status = [], SEARCHING
    start_walk(a, b, 0, 0, workspace.state, workspace.simplex)
    for _ in range(GJK_CAP):
        before = workspace.simplex[: int(workspace.state[COUNT]), 2:].copy()
        status = walk_on(a, len(a), b, len(b), workspace.state, workspace.simplex)
        if status == TOUCHING:
            found.append(_step("gjk", before, workspace, 0.0))
            break
        # walk_on may have added a corner after measuring the distance; this corner belongs to the next iteration.
        kept = workspace.simplex.copy(), workspace.state.copy()
        if status == SEARCHING:
            workspace.state[COUNT] -= 1.0
        write_nearest(a, b, workspace.state, workspace.simplex, workspace.gap)
        found.append(_step("gjk", before, workspace, workspace.gap[SEPARATION]))
        workspace.simplex[:], workspace.state[:] = kept
        if status == APART:
            break
    if status == SEARCHING:
        status = reduce_simplex(a, b, workspace.state, workspace.simplex)
    if status == TOUCHING or workspace.gap[SEPARATION] <= 0.0:
        found += _depth_steps(a, b, workspace)
    return found


def _depth_steps(a, b, workspace):
    count, found = start_polytope(a, len(a), b, len(b), workspace.polytope), []
    for _ in range(EPA_CAP):
        i, j = workspace.polytope[:count, 0].astype(int), workspace.polytope[:count, 1].astype(int)
        write_depth(a, b, count, workspace.polytope, workspace.gap)
        workspace.state[NORMAL_X], workspace.state[NORMAL_Y] = workspace.gap[NX], workspace.gap[NY]
        step = _step("epa", np.zeros((0, 2)), workspace, workspace.gap[SEPARATION])
        step["polytope"] = a[i] - b[j]
        found.append(step)
        grown = count if count < 2 else grow_polytope(a, len(a), b, len(b), count, workspace.polytope)
        if grown == count:
            break
        count = grown
    return found


def _step(phase, simplex, workspace, distance):
    ax, ay, bx, by = workspace.gap[AX : BY + 1].tolist()
    return {
        "phase": phase,
        "simplex": simplex,
        "witness": ((ax, ay), (bx, by)),
        "direction": (float(workspace.state[NORMAL_X]), float(workspace.state[NORMAL_Y])),
        "distance": float(distance),
    }
