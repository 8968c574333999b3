"""The pass over the candidate pairs with a chain, link by link;
links far from the other shape are skipped in blocks."""

import math

from physics.collision.chains import collide_link_circle, collide_link_hull, in_front, link_at
from physics.collision.features import part_feature
from physics.collision.manifold import CHAIN_ANY, add_point, add_points
from physics.collision.mask_exact import meet_polygon
from physics.collision.mask_hulls import thick_line
from physics.collision.upright import upright_corners
from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.shapes.mask_pose import box_as_tested
from physics.shapes.placement import hull_at, polygon_at, rounding
from physics.tables.counters import MASK_TESTS
from physics.tables.geometry import BLOCK_LINKS
from physics.tables.shape import BOUNDS, CHAIN, MASK, POLYGON

BACKING = 2.0  # [px] how thick a link is for masks, behind its front: a line has no area to share


@subkernel
def box_in_body(min_x, min_y, max_x, max_y, x, y, cosine, sine):
    """The AABB [px] in a body's space of a box in the world; the body stands at (x, y)."""
    middle_x, middle_y = turned(0.5 * (min_x + max_x) - x, 0.5 * (min_y + max_y) - y, cosine, -sine)
    half_x = 0.5 * (max_x - min_x)
    half_y = 0.5 * (max_y - min_y)
    reach_x = abs(cosine) * half_x + abs(sine) * half_y
    reach_y = abs(sine) * half_x + abs(cosine) * half_y
    return middle_x - reach_x, middle_y - reach_y, middle_x + reach_x, middle_y + reach_y


@subkernel
def misses_box(ax, ay, bx, by, min_x, min_y, max_x, max_y):
    """Whether the box of a and b lies beside another."""
    return max(ax, bx) < min_x or min(ax, bx) > max_x or max(ay, by) < min_y or min(ay, by) > max_y


@kernel
def collide_chain_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Contacts of all pairs of a chain and a hull or mask, appended at `found`. Returns the new count.

    O(links near the other shape).
    """
    geometry = batch.geometry
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    margin = batch.margin
    links = geometry.links
    polygons = geometry.polygons
    table = geometry.corners
    points = workspace.a
    manifold = workspace.points
    for i in range(batch.count):
        if kinds[i] != CHAIN_ANY:
            continue
        sign = 1.0 if shapes[candidates[i, 0]].kind == CHAIN else -1.0
        row = candidates[i, 0] if sign > 0.0 else candidates[i, 1]
        other = candidates[i, 1] if sign > 0.0 else candidates[i, 0]
        o = shapes[other]
        p = bodies[shapes[row].body_row]
        q = bodies[o.body_row]
        span = geometry.chains[shapes[row].geometry]
        cosine = math.cos(p.angle)
        sine = math.sin(p.angle)
        min_x = o.min_x
        min_y = o.min_y
        max_x = o.max_x
        max_y = o.max_y
        if o.kind == MASK:
            min_x, min_y, max_x, max_y = box_as_tested(geometry, o)
        n = 0
        if o.kind == POLYGON:
            n = polygon_at(polygons, table, o.geometry, q.x, q.y, math.cos(q.angle), math.sin(q.angle), workspace.b)
        elif o.kind == BOUNDS:
            n = upright_corners(o, workspace.b)
        elif o.kind != MASK:
            n = hull_at(geometry, shapes, other, q.x, q.y, q.angle, workspace.b)
        middle_x = 0.5 * (min_x + max_x)
        middle_y = 0.5 * (min_y + max_y)
        # Some digits more than the margin: turning the box must not lose what touches.
        rim = margin + 1e-9 * (max_x - min_x + max_y - min_y) + 1e-15 * (abs(p.x) + abs(p.y) + abs(q.x) + abs(q.y))
        min_x, min_y, max_x, max_y = box_in_body(
            min_x - rim, min_y - rim, max_x + rim, max_y + rim, p.x, p.y, cosine, sine
        )
        radius = 0.0
        if o.kind == MASK:
            work_inout[MASK_TESTS] += 1
        else:
            radius = rounding(shapes, other)
        start = found
        near = 0
        for attempt in range(2):
            # A hull that each link leaves to its neighbour: once more, and then only where it overlaps.
            if attempt == 1 and (near == 0 or found > start):
                break
            reach = margin if attempt == 0 else 0.0
            for block in range(span.blocks):
                box = geometry.link_blocks[span.first_block + block]
                if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, min_x, min_y, max_x, max_y):
                    continue
                for k in range(block * BLOCK_LINKS, min(span.count, (block + 1) * BLOCK_LINKS)):
                    link = links[span.offset + k]
                    if misses_box(link.ax, link.ay, link.bx, link.by, min_x, min_y, max_x, max_y):
                        continue
                    link_at(links, span.offset + k, p.x, p.y, cosine, sine, points)
                    if o.kind == MASK:
                        if in_front(points, 0, 1, middle_x, middle_y) < 0.0:
                            continue
                        thick_line(points, 0.0, BACKING, workspace.b)
                        area, nx, ny, x, y, separation, which = meet_polygon(
                            geometry, q, o, workspace.b, 4, 1, points, workspace.depths
                        )
                        if area > 0.0:
                            found = add_point(
                                shapes,
                                candidates,
                                i,
                                found,
                                -sign * nx,
                                -sign * ny,
                                x,
                                y,
                                separation,
                                area,
                                part_feature(k, 0),
                                manifolds_out,
                            )
                    elif n == 1:
                        hit, nx, ny, x, y, separation, which = collide_link_circle(
                            link, points, workspace.b[0, 0], workspace.b[0, 1], radius
                        )
                        if hit and separation <= margin:
                            found = add_point(
                                shapes,
                                candidates,
                                i,
                                found,
                                sign * nx,
                                sign * ny,
                                x,
                                y,
                                separation,
                                0.0,
                                part_feature(k, which),
                                manifolds_out,
                            )
                    else:
                        near += 1
                        met = collide_link_hull(
                            link, points, workspace.b, n, radius, reach, batch.bias, attempt == 1, manifold
                        )
                        found = add_points(
                            shapes, candidates, i, found, sign, manifold, met, part_feature(k, 0), manifolds_out
                        )
    return found
