"""GJK and EPA round by round, as lists to draw: calls the very functions that run inside, one round at a time."""

import numpy as np

from physics.proximity.epa import EPA_CAP, grow_polytope, start_polytope, write_depth
from physics.proximity.gjk import (
    APART,
    AX,
    BY,
    COUNT,
    GJK_CAP,
    NORMAL_X,
    NORMAL_Y,
    NX,
    NY,
    SEARCHING,
    SEPARATION,
    TOUCHING,
    new_gap_workspace,
    reduce_simplex,
    start_walk,
    walk_on,
    write_nearest,
)


def steps_of(a: np.ndarray, b: np.ndarray) -> list[dict]:
    """What is known after each round for two hulls of corners (n, 2) [px], radii left out.

    "phase" gjk or epa; "simplex" (k, 2) and, in epa, "polytope" (k, 2): points of the difference A - B; "witness": the
    nearest points so far on A and on B; "direction": unit, searched next; "distance" so far, negative when they
    overlap.
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
        # The round may have added a corner behind what it measured: that belongs to the next round.
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
