"""Bounding motion rectangles with room to spare, for worlds whose bodies tremble in piles.

A rectangle is kept while what the shape needs in this step stays inside it, so a pile that rests costs the broad phase
nothing. More candidates, the same contacts: the narrow phase looks at the tight boxes. Source: Catto, Box2D v3.2,
constants.h (margin).
"""

from physics.jit import kernel
from physics.math2d import length_of
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import MASK


@kernel
def update_fat_rectangles(
    # read
    bodies,
    shapes,
    gravity_x,
    gravity_y,
    dt,
    margin,
    spare,
    spare_share,
    # write
    proxies_inout,
    changed_out,
):
    """Write the motion rectangles that no longer hold what they have to, and list the slots that changed.

    shapes SHAPE rows with their AABBs refreshed; margin [px]: contacts up to it are candidates; spare [px]: how far a rectangle outgrows its need, at most
    spare_share of the box. What is asleep and untouched is passed over. Returns the number of slots. O(shapes).
    """
    found = 0
    for row in range(len(shapes)):
        s = shapes[row]
        if s.proxy < 0:
            continue
        b = bodies[s.body_row]
        p = proxies_inout[s.proxy]
        fresh = p.row < 0
        p.row = row
        moved = b.x != b.previous_x or b.y != b.previous_y or b.angle != b.previous_angle
        if not fresh and not p.changed and not moved and (b.kind == STATIC or (b.kind == DYNAMIC and not b.awake)):
            continue
        lower_x = s.min_x
        lower_y = s.min_y
        upper_x = s.max_x
        upper_y = s.max_y
        fat = 0.0
        if b.kind != STATIC:
            dx = dt * b.vx
            dy = dt * b.vy
            if b.kind == DYNAMIC:
                dx += dt * dt * (b.gravity_scale * gravity_x + b.inverse_mass * b.force_x)
                dy += dt * dt * (b.gravity_scale * gravity_y + b.inverse_mass * b.force_y)
            # A point turns by no more than its arc, or across the whole circle.
            arc = b.extent * min(abs(dt * b.angular_velocity), 2.0)
            if s.kind == MASK:
                arc += 1.0  # snapped to the pixel grid at both ends
            lower_x += min(dx, 0.0) - arc - margin
            lower_y += min(dy, 0.0) - arc - margin
            upper_x += max(dx, 0.0) + arc + margin
            upper_y += max(dy, 0.0) + arc + margin
            fat = min(spare, spare_share * max(s.max_x - s.min_x, s.max_y - s.min_y))
        inside = p.lower_x <= lower_x and p.lower_y <= lower_y and p.upper_x >= upper_x and p.upper_y >= upper_y
        # A rectangle left over from a fast step would be far too large.
        slack = 4.0 * fat + length_of(upper_x - lower_x, upper_y - lower_y)
        small = length_of(p.upper_x - p.lower_x, p.upper_y - p.lower_y) <= slack
        if fresh or p.changed or not inside or not small:
            p.lower_x = lower_x - fat
            p.lower_y = lower_y - fat
            p.upper_x = upper_x + fat
            p.upper_y = upper_y + fat
            p.changed = True
            changed_out[found] = s.proxy
            found += 1
    return found
