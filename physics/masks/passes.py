"""Passes over the candidate pairs with masks: mask against mask by AND, mask against circle, polygon and bounds."""

from physics.jit import kernel
from physics.masks.contact import center_normal, mask_contact
from physics.masks.overlap import first_pixel
from physics.masks.shapes import collide_mask_circle, collide_mask_polygon
from physics.narrowphase.contacts import MASK_CIRCLE, MASK_POLYGON, MASKS, circle_at, corners_of, write_contact
from physics.narrowphase.placement import raster_at, snapped
from physics.narrowphase.sat import ALL_EDGES
from physics.profile import MASK_TESTS
from physics.tables import MASK


def make_mask_pass(full: bool):
    """The pass over pairs of masks: with area, centroid, normal and depth, or with the first shared pixel alone.

    Without them the normal is the direction between the centres and the separation -1: one shared pixel is known.
    """
    @kernel
    def collide_mask_pairs(
        # read
        geometry, bodies, shapes, candidates, kinds, count, margin, bias,
        # write
        scratch, contacts_out, found, work_inout,
    ):
        """Contacts of all pairs of masks as drawn, by AND of words, appended at `found`. Returns the new count."""
        for i in range(count):
            if kinds[i] != MASKS:
                continue
            work_inout[MASK_TESTS] += 1
            a = shapes[candidates[i, 0]]
            b = shapes[candidates[i, 1]]
            p = bodies[a.body_row]
            q = bodies[b.body_row]
            mask_a = raster_at(geometry, a.geometry, p.angle)
            mask_b = raster_at(geometry, b.geometry, q.angle)
            r = geometry.rasters[mask_a]
            s = geometry.rasters[mask_b]
            left = snapped(p.x, r.origin_x)
            top = snapped(p.y, r.origin_y)
            dx = snapped(q.x, s.origin_x) - left
            dy = snapped(q.y, s.origin_y) - top
            hit, x, y = first_pixel(geometry.rasters, geometry.words, mask_a, mask_b, dx, dy)
            if not hit:
                continue
            feature = y * r.width + x
            if full:
                area, px, py, nx, ny, separation = mask_contact(geometry.rasters, geometry.words, mask_a, mask_b, dx, dy)
                found = write_contact(bodies, shapes, candidates, i, found, nx, ny, left + px, top + py, separation,
                                      float(area), feature, contacts_out)
            else:
                nx, ny = center_normal(r, s, dx, dy)
                found = write_contact(bodies, shapes, candidates, i, found, nx, ny, left + x + 0.5, top + y + 0.5, -1.0,
                                      0.0, feature, contacts_out)
        return found
    return collide_mask_pairs


collide_mask_pairs_full = make_mask_pass(full=True)
collide_mask_pairs_hit = make_mask_pass(full=False)


@kernel
def collide_mask_shape_pairs(
    # read
    geometry, bodies, shapes, candidates, kinds, count, margin, bias,
    # write
    scratch, contacts_out, found, work_inout,
):
    """Contacts of all pairs of a mask and a circle, polygon or bounds, appended at `found`. Returns the new count."""
    for i in range(count):
        if kinds[i] != MASK_CIRCLE and kinds[i] != MASK_POLYGON:
            continue
        work_inout[MASK_TESTS] += 1
        sign = 1.0 if shapes[candidates[i, 0]].kind == MASK else -1.0
        row = candidates[i, 0] if sign > 0.0 else candidates[i, 1]
        other = candidates[i, 1] if sign > 0.0 else candidates[i, 0]
        p = bodies[shapes[row].body_row]
        mask = raster_at(geometry, shapes[row].geometry, p.angle)
        r = geometry.rasters[mask]
        left = snapped(p.x, r.origin_x)
        top = snapped(p.y, r.origin_y)
        if kinds[i] == MASK_CIRCLE:
            cx, cy, radius = circle_at(bodies, shapes, other)
            area, nx, ny, x, y, separation, feature = collide_mask_circle(geometry.rasters, geometry.words, mask, left, top,
                                                                          cx, cy, radius)
        else:
            n = corners_of(geometry, bodies, shapes, other, scratch.a)
            area, nx, ny, x, y, separation, feature = collide_mask_polygon(geometry.rasters, geometry.words, mask, left, top,
                                                                           scratch.a, n, ALL_EDGES, scratch.depths)
        if area > 0:
            found = write_contact(bodies, shapes, candidates, i, found, sign * nx, sign * ny, x, y, separation, float(area),
                                  feature, contacts_out)
    return found
