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
    new_gap_room,
    reduce_simplex,
    start_walk,
    walk_on,
    write_nearest,
)


def steps_of(a, b) -> list[dict]:
    """What is known after each round for two hulls of corners (n, 2) [px], radii left out.

    "phase" gjk or epa; "simplex" (k, 2) and, in epa, "polytope" (k, 2): points of the difference A - B; "witness": the
    nearest points so far on A and on B; "direction": unit, searched next; "distance" so far, negative when they overlap.
    """
    a, b = (np.ascontiguousarray(each, np.float64) for each in (a, b))
    room = new_gap_room()
    found, status = [], SEARCHING
    start_walk(a, b, 0, 0, room.state, room.simplex)
    for _ in range(GJK_CAP):
        before = room.simplex[: int(room.state[COUNT]), 2:].copy()
        status = walk_on(a, len(a), b, len(b), room.state, room.simplex)
        if status == TOUCHING:
            found.append(_step("gjk", before, room, 0.0))
            break
        # The round may have added a corner behind what it measured: that belongs to the next round.
        kept = room.simplex.copy(), room.state.copy()
        if status == SEARCHING:
            room.state[COUNT] -= 1.0
        write_nearest(a, b, room.state, room.simplex, room.gap)
        found.append(_step("gjk", before, room, room.gap[SEPARATION]))
        room.simplex[:], room.state[:] = kept
        if status == APART:
            break
    if status == SEARCHING:
        status = reduce_simplex(a, b, room.state, room.simplex)
    if status == TOUCHING or room.gap[SEPARATION] <= 0.0:
        found += _depth_steps(a, b, room)
    return found


def _depth_steps(a, b, room):
    count, found = start_polytope(a, len(a), b, len(b), room.polytope), []
    for _ in range(EPA_CAP):
        i, j = room.polytope[:count, 0].astype(int), room.polytope[:count, 1].astype(int)
        write_depth(a, b, count, room.polytope, room.gap)
        room.state[NORMAL_X], room.state[NORMAL_Y] = room.gap[NX], room.gap[NY]
        step = _step("epa", np.zeros((0, 2)), room, room.gap[SEPARATION])
        step["polytope"] = a[i] - b[j]
        found.append(step)
        grown = count if count < 2 else grow_polytope(a, len(a), b, len(b), count, room.polytope)
        if grown == count:
            break
        count = grown
    return found


def _step(phase, simplex, room, distance):
    ax, ay, bx, by = room.gap[AX : BY + 1].tolist()
    return {
        "phase": phase,
        "simplex": simplex,
        "witness": ((ax, ay), (bx, by)),
        "direction": (float(room.state[NORMAL_X]), float(room.state[NORMAL_Y])),
        "distance": float(distance),
    }
