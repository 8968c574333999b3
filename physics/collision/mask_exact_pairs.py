"""Passes over the candidate pairs with masks that are not snapped: mask against mask, mask against hull."""

from collections.abc import Callable

from physics.collision.clipping import ALL_EDGES
from physics.collision.features import pixel_feature
from physics.collision.manifold import MASK_HULL_EXACT, MASKS_EXACT, add_point
from physics.collision.mask_exact import hull_in_raster, meet_in_raster, out_of_mask
from physics.collision.mask_exact_depth import boxes_normal, exact_contact
from physics.jit import kernel, subkernel
from physics.math2d import cosine_and_sine
from physics.raster.exact import first_squares
from physics.raster.shared_squares import shared_squares
from physics.shapes.mask_pose import box_as_tested, out_of_raster, raster_in_raster, raster_of_shape
from physics.shapes.placement import rounding
from physics.tables.counters import MASK_TESTS
from physics.tables.shape import MASK


@subkernel
def share_no_area(geometry, a, b):
    """Whether the boxes of two MASK rows, as they are tested, at most touch."""
    left, top, right, bottom = box_as_tested(geometry, a)
    min_x, min_y, max_x, max_y = box_as_tested(geometry, b)
    return left >= max_x or min_x >= right or top >= max_y or min_y >= bottom


@subkernel
def is_first_the_frame(geometry, a, b):
    """In whose raster two MASK rows are tested: not in one that is only drawn; else in that of more pixels."""
    if a.snap or b.snap:
        return not a.snap
    rasters = geometry.rasters
    return rasters[raster_of_shape(geometry, a)].area >= rasters[raster_of_shape(geometry, b)].area


@subkernel
def exact_mask_area(geometry, bodies, a, b):
    """The area [px2] that two MASK rows share, not both of them snapped."""
    if share_no_area(geometry, a, b):
        return 0.0
    first = is_first_the_frame(geometry, a, b)
    f = a if first else b
    o = b if first else a
    u, v, cosine, sine = raster_in_raster(geometry, bodies[f.body_row], f, bodies[o.body_row], o)
    area, _, _ = shared_squares(
        geometry.rasters, geometry.words, raster_of_shape(geometry, f), raster_of_shape(geometry, o), u, v, cosine, sine
    )
    return area


def make_exact_mask_pass(full: bool) -> Callable:
    """The pass over pairs of masks: with area, centroid, normal and depth, or with two squares that meet alone.

    Without them the normal is the direction between the centres of the boxes and the separation -1.
    """

    @kernel
    def collide_exact_mask_pairs(
        # read
        batch,
        # write
        workspace,
        manifolds_out,
        found,
        work_inout,
    ):
        """Contacts of all pairs of masks at exact poses, appended at `found`. Returns the new count."""
        geometry = batch.geometry
        bodies = batch.bodies
        shapes = batch.shapes
        candidates = batch.candidates
        kinds = batch.kinds
        rasters = geometry.rasters
        words = geometry.words
        for i in range(batch.count):
            if kinds[i] != MASKS_EXACT:
                continue
            work_inout[MASK_TESTS] += 1
            a = shapes[candidates[i, 0]]
            b = shapes[candidates[i, 1]]
            if share_no_area(geometry, a, b):
                continue
            first = is_first_the_frame(geometry, a, b)
            f = a if first else b
            o = b if first else a
            p = bodies[f.body_row]
            frame = raster_of_shape(geometry, f)
            other = raster_of_shape(geometry, o)
            u, v, cosine, sine = raster_in_raster(geometry, p, f, bodies[o.body_row], o)
            hit, x, y, column, row = first_squares(rasters, words, frame, other, u, v, cosine, sine)
            if not hit:
                continue
            if first:
                feature = pixel_feature(y, x, rasters[frame].width)
            else:
                feature = pixel_feature(row, column, rasters[other].width)
            turn_cosine, turn_sine = cosine_and_sine(p.angle, p.angle)
            px = x + 0.5
            py = y + 0.5
            area = 0.0
            separation = -1.0
            if full:
                area, px, py, nx, ny, separation = exact_contact(
                    rasters, words, frame, other, u, v, cosine, sine, f, o, turn_cosine, turn_sine
                )
            else:
                nx, ny, _ = boxes_normal(f, o)
            px, py = out_of_raster(rasters[frame], p, turn_cosine, turn_sine, px, py)
            sign = 1.0 if first else -1.0
            found = add_point(
                shapes, candidates, i, found, sign * nx, sign * ny, px, py, separation, area, feature, manifolds_out
            )
        return found

    return collide_exact_mask_pairs


collide_exact_mask_pairs_full = make_exact_mask_pass(full=True)
collide_exact_mask_pairs_hit = make_exact_mask_pass(full=False)


@kernel
def collide_exact_hull_pairs(
    # read
    batch,
    # write
    workspace,
    manifolds_out,
    found,
    work_inout,
):
    """Contacts of all pairs of a mask that is not snapped and a hull, appended at `found`. Returns the new count."""
    geometry = batch.geometry
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    kinds = batch.kinds
    for i in range(batch.count):
        if kinds[i] != MASK_HULL_EXACT:
            continue
        work_inout[MASK_TESTS] += 1
        sign = 1.0 if shapes[candidates[i, 0]].kind == MASK else -1.0
        row = candidates[i, 0] if sign > 0.0 else candidates[i, 1]
        other = candidates[i, 1] if sign > 0.0 else candidates[i, 0]
        s = shapes[row]
        mask = raster_of_shape(geometry, s)
        count = hull_in_raster(geometry, bodies, shapes, row, other, workspace.a)
        radius = rounding(shapes, other)
        area, nx, ny, x, y, separation, feature = meet_in_raster(
            geometry.rasters, geometry.words, mask, workspace.a, count, radius, ALL_EDGES, workspace.depths
        )
        if area > 0.0:
            nx, ny, x, y = out_of_mask(geometry, bodies[s.body_row], s, nx, ny, x, y)
            found = add_point(
                shapes, candidates, i, found, sign * nx, sign * ny, x, y, separation, area, feature, manifolds_out
            )
    return found
