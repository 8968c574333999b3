"""Rotational continuous collision of one shape with any other, along the paths of their bodies."""

from physics.ccd.closed_form import MISS
from physics.ccd.rotational import CORE, sweep_at, sweep_core, write_local, write_motion
from physics.ccd.rotational_ground import sweep_chain, sweep_tiles
from physics.jit import subkernel
from physics.proximity.gjk import NX, NY
from physics.shapes.placement import is_hull, rounding
from physics.tables.body import DYNAMIC
from physics.tables.counters import CAP_HITS, GJK_ITERATIONS, TOI_CALLS
from physics.tables.shape import CHAIN, TILES


@subkernel
def sweep_rotational(geometry, bodies, shapes, motions, row, other, slack, one_way, workspace, work_inout):
    """Shape `row` against shape `other`, both on their way through a step:
    (fraction or MISS, normal from other to row, core).

    motions (bodies, 6) float64, by body row: centre of mass [px] and angle, at the start and at the end of the step.
    row: a hull; other: a hull, tiles or a chain, from its front; for anything else MISS. slack [px]: apart by no more
    at the start counts as in contact, and the core circle is swept instead: core tells. one_way: whether such tiles
    take part.
    """
    s = shapes[row]
    o = shapes[other]
    if not is_hull(s.kind) or not (is_hull(o.kind) or o.kind == TILES or o.kind == CHAIN):
        return MISS, 0.0, -1.0, False
    work_inout[TOI_CALLS] += 1
    b = bodies[o.body_row]
    half = bodies[s.body_row].smallest_half
    radius = rounding(shapes, row)
    write_motion(motions, s.body_row, workspace.advance.motion_a)
    write_motion(motions, o.body_row, workspace.advance.motion_b)
    count = write_local(geometry, bodies, shapes, row, workspace.advance.motion_a, workspace.mover)
    workspace.advance.totals[0] = 0.0
    workspace.advance.totals[1] = 0.0
    if o.kind == TILES:
        fraction, nx, ny, core = sweep_tiles(
            geometry,
            o.geometry,
            b.local_center_x,
            b.local_center_y,
            count,
            radius,
            CORE * half,
            slack,
            one_way,
            workspace,
        )
    elif o.kind == CHAIN:
        fraction, nx, ny, core = sweep_chain(
            geometry, o.geometry, b.local_center_x, b.local_center_y, count, radius, CORE * half, half, slack, workspace
        )
    else:
        n = write_local(geometry, bodies, shapes, other, workspace.advance.motion_b, workspace.advance.local_b)
        fraction, core = sweep_at(count, radius, n, rounding(shapes, other), CORE * half, slack, workspace)
        if core and fraction > 1.0 and b.kind == DYNAMIC:
            # Deep in each other: at least their cores do not change places.
            workspace.advance.local_b[0, 0] = 0.0
            workspace.advance.local_b[0, 1] = 0.0
            fraction = sweep_core(CORE * half, 1, CORE * b.smallest_half, workspace)
        nx = -workspace.advance.gap.gap[NX]
        ny = -workspace.advance.gap.gap[NY]
    work_inout[GJK_ITERATIONS] += int(workspace.advance.totals[0])
    work_inout[CAP_HITS] += int(workspace.advance.totals[1])
    return fraction, nx, ny, core
