"""Passes over the candidate pairs with masks: mask against mask by AND, mask against circle, polygon and bounds."""

from collections.abc import Callable

from physics.collision.clipping import ALL_EDGES
from physics.collision.features import pixel_feature
from physics.collision.manifold import BLOCK, MASK_CIRCLE, MASK_POLYGON, MASKS, add_manifold, circle_at, corners_of
from physics.collision.mask_depth import center_normal, mask_contact
from physics.collision.mask_hulls import collide_mask_circle, collide_mask_line, collide_mask_polygon
from physics.collision.mask_rounded import collide_mask_rounded
from physics.jit import kernel, subkernel, word
from physics.raster.bits import lowest_bit, shared_row
from physics.raster.overlap import first_pixel, shared_rectangle
from physics.shapes.placement import rounding
from physics.tables.counters import MASK_TESTS
from physics.tables.shape import MASK


@subkernel
def list_near(rasters, shapes, candidates, kinds, start, end, near_out):
    """List the candidates from start up to end that are masks whose solid bounds meet as drawn. Returns their number.

    near_out (BLOCK, 6) int64: the candidate; where in the words their shared rectangle begins, in A and in B, and in
    which columns; its rows, -1 where a raster has several words per row. Without a branch, and apart from the search
    for a shared pixel: what no processor predicts is waited for once, with all that it needs at hand. O(candidates).
    """
    found = 0
    for i in range(start, end):
        if kinds[i] == MASKS:
            a = shapes[candidates[i, 0]]
            b = shapes[candidates[i, 1]]
            dx = b.left - a.left
            dy = b.top - a.top
            r = rasters[a.raster]
            s = rasters[b.raster]
            left, top, right, bottom = shared_rectangle(r, s, dx, dy)
            near_out[found, 0] = i
            near_out[found, 1] = r.offset + top
            near_out[found, 2] = s.offset + top - dy
            near_out[found, 3] = left
            near_out[found, 4] = left - dx
            near_out[found, 5] = bottom - top if r.stride == 1 and s.stride == 1 else -1
            found += int((left < right) & (top < bottom))
    return found


def make_mask_pass(full: bool) -> Callable:
    """The pass over pairs of masks: with area, centroid, normal and depth, or with the first shared pixel alone.

    Without them the normal is the direction between the centres and the separation -1: one shared pixel is known.
    """

    @kernel
    def collide_mask_pairs(
        # read
        batch,
        # write
        workspace,
        manifolds_out,
        found,
        work_inout,
    ):
        """Contacts of all pairs of masks as drawn, by AND of words, appended at `found`. Returns the new count."""
        geometry = batch.geometry
        bodies = batch.bodies
        shapes = batch.shapes
        candidates = batch.candidates
        kinds = batch.kinds
        near = workspace.near
        for start in range(0, batch.count, BLOCK):
            count = list_near(geometry.rasters, shapes, candidates, kinds, start, min(start + BLOCK, batch.count), near)
            work_inout[MASK_TESTS] += count
            for k in range(count):
                i = near[k, 0]
                row = 0
                shared = word(0)
                if near[k, 5] >= 0:
                    # Sprites up to 64 px wide: one word per row, so both shifts are the same in every row.
                    row, shared = shared_row(geometry.words, near[k, 1], near[k, 3], near[k, 2], near[k, 4], near[k, 5])
                    if shared == word(0):
                        continue
                a = shapes[candidates[i, 0]]
                b = shapes[candidates[i, 1]]
                left = a.left
                top = a.top
                dx = b.left - left
                dy = b.top - top
                r = geometry.rasters[a.raster]
                s = geometry.rasters[b.raster]
                if near[k, 5] >= 0:
                    x = near[k, 3] + lowest_bit(shared)
                    y = near[k, 1] - r.offset + row
                else:
                    hit, x, y = first_pixel(geometry.rasters, geometry.words, a.raster, b.raster, dx, dy)
                    if not hit:
                        continue
                feature = pixel_feature(y, x, r.width)
                if full:
                    q = bodies[b.body_row]
                    p = bodies[a.body_row]
                    area, px, py, nx, ny, separation = mask_contact(
                        geometry.rasters,
                        geometry.words,
                        a.raster,
                        b.raster,
                        dx,
                        dy,
                        p.x - r.origin_x + 0.5 - a.left,
                        p.y - r.origin_y + 0.5 - a.top,
                        q.x - s.origin_x + 0.5 - b.left,
                        q.y - s.origin_y + 0.5 - b.top,
                    )
                    found = add_manifold(
                        shapes,
                        candidates,
                        i,
                        found,
                        nx,
                        ny,
                        left + px,
                        top + py,
                        separation,
                        float(area),
                        feature,
                        manifolds_out,
                    )
                else:
                    nx, ny = center_normal(r, s, dx, dy)
                    found = add_manifold(
                        shapes,
                        candidates,
                        i,
                        found,
                        nx,
                        ny,
                        left + x + 0.5,
                        top + y + 0.5,
                        -1.0,
                        0.0,
                        feature,
                        manifolds_out,
                    )
        return found

    return collide_mask_pairs


collide_mask_pairs_full = make_mask_pass(full=True)
collide_mask_pairs_hit = make_mask_pass(full=False)


@kernel
def collide_mask_shape_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Contacts of all pairs of a mask and a hull, appended at `found`. Returns the new count."""
    geometry = batch.geometry
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    for i in range(batch.count):
        if kinds[i] != MASK_CIRCLE and kinds[i] != MASK_POLYGON:
            continue
        work_inout[MASK_TESTS] += 1
        sign = 1.0 if shapes[candidates[i, 0]].kind == MASK else -1.0
        row = candidates[i, 0] if sign > 0.0 else candidates[i, 1]
        other = candidates[i, 1] if sign > 0.0 else candidates[i, 0]
        mask = shapes[row].raster
        left = shapes[row].left
        top = shapes[row].top
        if kinds[i] == MASK_CIRCLE:
            cx, cy, radius = circle_at(bodies, shapes, other)
            area, nx, ny, x, y, separation, feature = collide_mask_circle(
                geometry.rasters, geometry.words, mask, left, top, cx, cy, radius
            )
        else:
            n = corners_of(geometry, bodies, shapes, other, workspace.a)
            radius = rounding(shapes, other)
        if kinds[i] == MASK_POLYGON and radius > 0.0:
            area, nx, ny, x, y, separation, feature = collide_mask_rounded(
                geometry.rasters, geometry.words, mask, left, top, workspace.a, n, radius
            )
        elif kinds[i] == MASK_POLYGON and n == 2:
            area, nx, ny, x, y, separation, feature = collide_mask_line(
                geometry.rasters, geometry.words, mask, left, top, workspace.a, workspace.depths
            )
        elif kinds[i] == MASK_POLYGON:
            area, nx, ny, x, y, separation, feature = collide_mask_polygon(
                geometry.rasters, geometry.words, mask, left, top, workspace.a, n, ALL_EDGES, workspace.depths
            )
        if area > 0:
            found = add_manifold(
                shapes,
                candidates,
                i,
                found,
                sign * nx,
                sign * ny,
                x,
                y,
                separation,
                float(area),
                feature,
                manifolds_out,
            )
    return found
