"""The first impact of shapes made of parts, on their way between two poses."""

from physics.ccd.advance import CENTER_X, CENTER_Y, MOVE_X, MOVE_Y, TURN, advance, place_at, reach_of
from physics.ccd.closed_form import MISS
from physics.ccd.rotational import depth_at_start, place_mover, sweep_part
from physics.ccd.rotational_ground import sweep_chain, sweep_tiles
from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.proximity.gjk import NX, NY
from physics.proximity.witness import copy_part


@subkernel
def begin_sweep(motion_a, motion_b, workspace, impact_out):
    """Take in two motions, with nothing met yet. Returns the way of the one as seen from the other [px]."""
    r = workspace.advance
    for k in range(6):
        r.motion_a[k] = motion_a[k]
        r.motion_b[k] = motion_b[k]
    r.totals[0] = 0.0
    r.totals[1] = 0.0
    impact_out[0] = MISS
    impact_out[1] = 1.0
    impact_out[2] = 0.0
    return length_of(motion_b[MOVE_X] - motion_a[MOVE_X], motion_b[MOVE_Y] - motion_a[MOVE_Y])


@subkernel
def gap_at_start(a_count, a_radius, b_count, b_radius, workspace):
    """At least so far [px] are the hulls in local_a and local_b apart before they move; below 0 they may touch."""
    r = workspace.advance
    place_at(r.local_a, a_count, r.motion_a, 0.0, r.motion_a[CENTER_X], r.motion_a[CENTER_Y], r.a)
    place_at(r.local_b, b_count, r.motion_b, 0.0, r.motion_a[CENTER_X], r.motion_a[CENTER_Y], r.b)
    spread = 0.0
    for k in range(1, a_count):
        spread = max(spread, length_of(r.a[k, 0] - r.a[0, 0], r.a[k, 1] - r.a[0, 1]))
    wide = 0.0
    for k in range(1, b_count):
        wide = max(wide, length_of(r.b[k, 0] - r.b[0, 0], r.b[k, 1] - r.b[0, 1]))
    return length_of(r.b[0, 0] - r.a[0, 0], r.b[0, 1] - r.a[0, 1]) - spread - wide - a_radius - b_radius


@kernel
def advance_parts(
    # read
    a,
    b,
    motion_a,
    motion_b,
    # write
    workspace,
    impact_out,
    totals_out,
):
    """Write (fraction or MISS, normal from A to B) of the first impact of a part of A with one of B to impact_out (3,).

    a, b: Parts in body space; motion_a, motion_b (6,): see advance.AdvanceWorkspace; workspace: RotationalWorkspace;
    totals_out (2,): rounds of GJK and EPA, caps hit. Pairs too far apart to meet before the first impact so far are
    skipped. O(parts of A · parts of B).
    """
    r = workspace.advance
    path = begin_sweep(motion_a, motion_b, workspace, impact_out)
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], r.local_a)
        reach_a = reach_of(r.local_a, a.counts[i])
        for j in range(len(b.counts)):
            copy_part(b.corners, j, b.counts[j], r.local_b)
            apart = gap_at_start(a.counts[i], a.radii[i], b.counts[j], b.radii[j], workspace)
            travel = path + abs(motion_a[TURN]) * reach_a + abs(motion_b[TURN]) * reach_of(r.local_b, b.counts[j])
            if apart > travel * min(1.0, impact_out[0]):
                continue
            fraction = advance(a.counts[i], a.radii[i], b.counts[j], b.radii[j], r)
            if fraction < impact_out[0]:
                impact_out[0] = fraction
                impact_out[1] = r.gap.gap[NX]
                impact_out[2] = r.gap.gap[NY]
    totals_out[0] = r.totals[0]
    totals_out[1] = r.totals[1]


@kernel
def sweep_unions(
    # read
    a,
    b,
    motion_a,
    motion_b,
    # write
    workspace,
    impact_out,
    totals_out,
):
    """As advance_parts, for shapes that are the union of their parts, which may lie flush: masks.

    By the rule of rotational.py: what gets no deeper than the two stand in each other at the start meets nothing, so no
    seam between two parts is felt, and what only grazes is not met. O(parts of A · parts of B).
    """
    r = workspace.advance
    path = begin_sweep(motion_a, motion_b, workspace, impact_out)
    depth = 0.0
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], r.local_a)
        copy_part(a.corners, i, a.counts[i], workspace.mover)
        for j in range(len(b.counts)):
            copy_part(b.corners, j, b.counts[j], r.local_b)
            if gap_at_start(a.counts[i], a.radii[i], b.counts[j], b.radii[j], workspace) <= 0.0:
                depth = max(depth, depth_at_start(a.counts[i], a.radii[i], b.counts[j], b.radii[j], workspace))
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], workspace.mover)
        reach_a = place_mover(a.counts[i], workspace)
        for j in range(len(b.counts)):
            place_mover(a.counts[i], workspace)
            copy_part(b.corners, j, b.counts[j], r.local_b)
            apart = gap_at_start(a.counts[i], a.radii[i], b.counts[j], b.radii[j], workspace)
            travel = path + abs(motion_a[TURN]) * reach_a + abs(motion_b[TURN]) * reach_of(r.local_b, b.counts[j])
            if apart > travel * min(1.0, impact_out[0]):
                continue
            fraction, _ = sweep_part(a.counts[i], a.radii[i], b.counts[j], b.radii[j], 0.0, depth, 0.0, workspace)
            if fraction < impact_out[0]:
                impact_out[0] = fraction
                impact_out[1] = r.gap.gap[NX]
                impact_out[2] = r.gap.gap[NY]
    totals_out[0] = r.totals[0]
    totals_out[1] = r.totals[1]


@kernel
def advance_on_ground(
    # read
    geometry,
    ground,
    is_chain,
    a,
    motion_a,
    motion_b,
    # write
    workspace,
    impact_out,
    totals_out,
):
    """As advance_parts, against tiles (is_chain 0), through no covered side, or a chain (1), from its front.

    ground: row of the grid or chain.
    """
    r = workspace.advance
    r.totals[0] = 0.0
    r.totals[1] = 0.0
    impact_out[0] = MISS
    impact_out[1] = 1.0
    impact_out[2] = 0.0
    for i in range(len(a.counts)):
        for k in range(6):
            r.motion_a[k] = motion_a[k]
            r.motion_b[k] = motion_b[k]
        copy_part(a.corners, i, a.counts[i], workspace.mover)
        if is_chain == 1:
            fraction, nx, ny, _ = sweep_chain(
                geometry, ground, 0.0, 0.0, a.counts[i], a.radii[i], 0.0, 0.0, -1, workspace
            )
        else:
            fraction, nx, ny, _ = sweep_tiles(
                geometry, ground, 0.0, 0.0, a.counts[i], a.radii[i], 0.0, 0.0, True, -1, workspace
            )
        if fraction < impact_out[0]:
            impact_out[0] = fraction
            impact_out[1] = -nx
            impact_out[2] = -ny
    totals_out[0] = r.totals[0]
    totals_out[1] = r.totals[1]
