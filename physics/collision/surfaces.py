"""Who may stand on the upper side of a mask that is open from below: who stood on it, or was above it.

Such a side is a chain, and chains are open from their backs for what has its centre behind them. That is not enough for
a platform: what jumps half through it and falls again would be lifted out once its centre is above. So a pair counts
only if it touched in the step before, or if before the last motion nothing of the body was across the line. The line
goes on level beyond both ends, so that what comes from a side passes as well (for tiles: tile_pairs.py).
"""

import math

from physics.collision.chain_pairs import misses_box
from physics.collision.chains import link_at
from physics.collision.clipping import ALL_EDGES, best_edge
from physics.collision.hulls import edge_gap
from physics.collision.manifold import CHAIN_ANY, NOTHING, SURFACE_ANY
from physics.collision.upright import upright_corners
from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.shapes.placement import hull_at, rounding
from physics.tables.geometry import BLOCK_LINKS
from physics.tables.shape import BOUNDS, CHAIN


@subkernel
def line_gap(line, hull, count, radius):
    """Separation [px] of a hull of so many corners and rounding from the line of two points: below 0 it lies across."""
    if count > 1:
        _, _, own = best_edge(line, 2, ALL_EDGES, hull, count)
        _, _, other = best_edge(hull, count, ALL_EDGES, line, 2)
        if max(own, other) < 0.0:
            return max(own, other) - radius
    gap = math.inf
    for k in range(count):
        gap = min(gap, edge_gap(line[0, 0], line[0, 1], line[1, 0], line[1, 1], hull[k, 0], hull[k, 1]))
        if count > 1:
            after = k + 1 if k + 1 < count else 0
            for end in range(2):
                gap = min(
                    gap, edge_gap(hull[k, 0], hull[k, 1], hull[after, 0], hull[after, 1], line[end, 0], line[end, 1])
                )
    return gap - radius


@subkernel
def lies_across(geometry, chain, x, y, angle, hull, count, radius, most, line_out):
    """Whether a hull reaches deeper than `most` [px] across a chain that goes on level beyond its ends.

    chain: its row; x, y, angle: where its body is; hull (count, 2) [px] as seen from there, grown by radius;
    line_out (16, 2): room for a link. O(links near).
    """
    span = geometry.chains[chain]
    cosine = math.cos(angle)
    sine = math.sin(angle)
    min_x = math.inf
    min_y = math.inf
    max_x = -math.inf
    max_y = -math.inf
    for k in range(count):
        u, v = turned(hull[k, 0] - x, hull[k, 1] - y, cosine, -sine)
        min_x = min(min_x, u - radius)
        min_y = min(min_y, v - radius)
        max_x = max(max_x, u + radius)
        max_y = max(max_y, v + radius)
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, min_x, min_y, max_x, max_y):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            link = geometry.links[k]
            if not misses_box(link.ax, link.ay, link.bx, link.by, min_x, min_y, max_x, max_y):
                link_at(geometry.links, k, x, y, cosine, sine, line_out)
                if line_gap(line_out, hull, count, radius) < -most:
                    return True
    for end in range(2):
        link = geometry.links[span.offset if end == 0 else span.offset + span.count - 1]
        u = link.ax if end == 0 else link.bx
        v = link.ay if end == 0 else link.by
        beyond = min_x - (max_x - min_x) if end == 0 else max_x + (max_x - min_x)
        if (beyond < u) == (end == 0) and min_y <= v <= max_y:
            for k in range(2):
                du, dv = turned(u if k == 0 else beyond, v, cosine, sine)
                line_out[k, 0] = x + du
                line_out[k, 1] = y + dv
            if line_gap(line_out, hull, count, radius) < -most:
                return True
    return False


@subkernel
def was_across(batch, surface, other, most, workspace):
    """Whether a shape lay across a surface before the last motion of both; surface, other: rows of SHAPE."""
    s = batch.shapes[surface]
    o = batch.shapes[other]
    p = batch.bodies[s.body_row]
    q = batch.bodies[o.body_row]
    radius = 0.0
    if o.kind == BOUNDS:
        count = upright_corners(o, workspace.b)
        for k in range(count):
            workspace.b[k, 0] += q.previous_x - q.x
            workspace.b[k, 1] += q.previous_y - q.y
    else:
        count = hull_at(batch.geometry, batch.shapes, other, q.previous_x, q.previous_y, q.previous_angle, workspace.b)
        radius = rounding(batch.shapes, other)
    return lies_across(
        batch.geometry,
        s.geometry,
        p.previous_x,
        p.previous_y,
        p.previous_angle,
        workspace.b,
        count,
        radius,
        most,
        workspace.a,
    )


@kernel
def admit_to_surfaces(
    # read
    batch,
    known,
    # write
    workspace,
    kinds_inout,
    counts_inout,
):
    """Let the pairs of a surface and a hull that may touch go on as pairs with a chain, and drop the others.

    known: whether workspace.memory tells of the step before; kinds_inout: the batch's. O(candidates + links near).
    """
    for i in range(batch.count):
        if kinds_inout[i] != SURFACE_ANY:
            continue
        kind = CHAIN_ANY
        if not (known and workspace.memory[i, 1] > 0):
            first = batch.shapes[batch.candidates[i, 0]].kind == CHAIN
            surface = batch.candidates[i, 0] if first else batch.candidates[i, 1]
            other = batch.candidates[i, 1] if first else batch.candidates[i, 0]
            if was_across(batch, surface, other, batch.margin, workspace):
                kind = NOTHING
        kinds_inout[i] = kind
        counts_inout[SURFACE_ANY] -= 1
        counts_inout[kind] += 1
