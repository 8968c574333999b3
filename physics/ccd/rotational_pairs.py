"""Rotational continuous collision of one shape with any other, along the paths of their bodies."""

from physics.ccd.closed_form import MISS
from physics.ccd.rotational import CORE, depth_at_start, sweep_core, sweep_part, write_local, write_motion
from physics.ccd.rotational_ground import starts_across, sweep_chain, sweep_tiles
from physics.jit import subkernel
from physics.proximity.gjk import NX, NY
from physics.shapes.placement import is_hull, rounding
from physics.tables.body import DYNAMIC, RAY
from physics.tables.counters import CAP_HITS, GJK_ITERATIONS, TOI_CALLS
from physics.tables.shape import CHAIN, PART, TILES


@subkernel
def shrink_to_middle(count, mover_inout):
    """Leave of a hull the middle of its corners: what is swept as a ray. Returns 1, the number of corners left."""
    x = 0.0
    y = 0.0
    for k in range(count):
        x += mover_inout[k, 0] / count
        y += mover_inout[k, 1] / count
    mover_inout[0, 0] = x
    mover_inout[0, 1] = y
    return 1


@subkernel
def sweep_hull(count, radius, half, core_b, n, radius_b, slack, workspace):
    """(fraction or MISS, normal from the other) of the mover against the hull in workspace.advance.local_b.

    core_b [px]: radius of the other's core, 0: it has none.
    """
    depth = depth_at_start(count, radius, n, radius_b, workspace)
    fraction, core = sweep_part(count, radius, n, radius_b, half, depth, slack, workspace)
    if core and fraction > 1.0 and core_b > 0.0:
        # Deep in each other: at least their cores do not change places.
        workspace.advance.local_b[0, 0] = 0.0
        workspace.advance.local_b[0, 1] = 0.0
        fraction = sweep_core(CORE * half, 1, core_b, workspace)
    return fraction, -workspace.advance.gap.gap[NX], -workspace.advance.gap.gap[NY]


@subkernel
def stands_deep(geometry, bodies, shapes, motions, row, other, slack, workspace):
    """Whether a hull stands deeper than slack [px] in another before both go their ways: see sweep_rotational."""
    write_motion(motions, shapes[row].body_row, workspace.advance.motion_a)
    write_motion(motions, shapes[other].body_row, workspace.advance.motion_b)
    count = write_local(geometry, bodies, shapes, row, workspace.advance.motion_a, workspace.mover)
    n = write_local(geometry, bodies, shapes, other, workspace.advance.motion_b, workspace.advance.local_b)
    return depth_at_start(count, rounding(shapes, row), n, rounding(shapes, other), workspace) > slack


@subkernel
def sweep_rotational(geometry, bodies, shapes, motions, row, other, slack, one_way, but, workspace, work_inout):
    """Shape `row` against shape `other`, both on their way through a step:
    (fraction or MISS, normal from other to row, feature: which tiles or link, -1 of a hull).

    motions (bodies, 6) float64, by body row: centre of mass [px] and angle, at the start and at the end of the step.
    row: a hull; other: a hull, tiles or a chain, from its front; for anything else MISS. slack [px]: see sweep_part;
    one_way: whether what is open from below takes part; but: the feature, of tiles or links, that does not count, or -1
    """
    s = shapes[row]
    o = shapes[other]
    if not is_hull(s.kind) or not (is_hull(o.kind) or o.kind == TILES or o.kind == CHAIN):
        return MISS, 0.0, -1.0, -1
    work_inout[TOI_CALLS] += 1
    a = bodies[s.body_row]
    b = bodies[o.body_row]
    half = a.smallest_half
    radius = rounding(shapes, row)
    write_motion(motions, s.body_row, workspace.advance.motion_a)
    write_motion(motions, o.body_row, workspace.advance.motion_b)
    count = write_local(geometry, bodies, shapes, row, workspace.advance.motion_a, workspace.mover)
    if a.continuous == RAY:
        count = shrink_to_middle(count, workspace.mover)
        radius = 0.0
        half = 0.0
    workspace.advance.totals[0] = 0.0
    workspace.advance.totals[1] = 0.0
    if o.kind == TILES:
        fraction, nx, ny, feature = sweep_tiles(
            geometry,
            o.geometry,
            b.local_center_x,
            b.local_center_y,
            count,
            radius,
            half,
            slack,
            one_way,
            but,
            workspace,
        )
    elif (
        o.role == PART
        and o.kind == CHAIN
        and (
            not one_way
            or starts_across(geometry, o.geometry, b.local_center_x, b.local_center_y, count, radius, slack, workspace)
        )
    ):
        return MISS, 0.0, -1.0, -1
    elif o.kind == CHAIN:
        fraction, nx, ny, feature = sweep_chain(
            geometry, o.geometry, b.local_center_x, b.local_center_y, count, radius, half, slack, but, workspace
        )
    else:
        feature = -1
        n = write_local(geometry, bodies, shapes, other, workspace.advance.motion_b, workspace.advance.local_b)
        core_b = CORE * b.smallest_half if b.kind == DYNAMIC else 0.0
        fraction, nx, ny = sweep_hull(count, radius, half, core_b, n, rounding(shapes, other), slack, workspace)
    work_inout[GJK_ITERATIONS] += int(workspace.advance.totals[0])
    work_inout[CAP_HITS] += int(workspace.advance.totals[1])
    return fraction, nx, ny, feature
