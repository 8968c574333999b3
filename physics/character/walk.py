"""Motion of one character, pixel by pixel: walking, slopes, falling, pushing, and the contacts after the motion."""

import math

from physics.character.solids import (
    BLOCKED,
    FREE,
    GIVE,
    ON_SLOPE,
    STEEP,
    STEEPEST_CLIMB,
    blocked_at,
    character_of,
    deepest_link,
    gather,
    in_shape,
    meet,
    on_pixels,
    pixels_along,
    place_outline,
    settle,
)
from physics.dynamics.integrate import LARGEST
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.geometry import SLOPE
from physics.tables.shape import CHAIN, TILES
from physics.tables.table import row_of

# ---- climb -----------------------------------------------------------------------------------------------------------
# Slopes: the rise of a character that walks onto a slope, and the drop of a character that walks down a slope.


@subkernel
def rise_onto(walk, me, rows, direction, slope):
    """Return by how many pixels a character must rise to step one pixel sideways onto walkable ground; -1: it cannot.

    The rise may exceed that of the slope by half a pixel, because outlines have corners on steps of pixels. Ground that
    is too steep to walk on does not count. walk: see solids.Walk; me: row number of the character; rows: nearby solids,
    see solids.gather; direction: -1 left, 1 right; slope: rise of the ground per px.
    """
    c = walk.characters[me]
    most = pixels_along(abs(slope) + 0.5)
    lift = 1
    before = ON_SLOPE
    while lift <= most:
        what, by, rise = blocked_at(walk, me, rows, c.left + direction, c.top - lift, direction, -lift, 0.0)
        if what == FREE:
            return lift if before == ON_SLOPE else -1
        if what == BLOCKED:
            return -1
        most = max(most, pixels_along(rise)) if what == ON_SLOPE else most
        before = what
        lift += 1
    return -1


@subkernel
def way_aside(walk, me, rows, direction):
    """Test a character's move by one pixel to the left or right. Return (pixels up, SHAPE row of the blocker, slope).

    Pixels up: rise of the character, 0 on level ground, -1 if the move is blocked. SHAPE row of the blocker: -1: none.
    Slope: rise per px of the slope that the character meets, else 0. walk: see solids.Walk; me: row number of the
    character; rows: nearby solids, see solids.gather; direction: -1 left, 1 right.
    """
    c = walk.characters[me]
    what, by, slope = blocked_at(walk, me, rows, c.left + direction, c.top, direction, 0, 0.0)
    if what == FREE:
        return 0, -1, 0.0
    if what != ON_SLOPE:
        return -1, by, 0.0
    return rise_onto(walk, me, rows, direction, slope), -1, slope


@subkernel
def drop_onto(walk, me, rows, left, onto):
    """Return (pixels down from a character to walkable ground, slope of this ground), or (0, 0) without such ground.

    onto: slope of the ground that the character leaves. If it is 0, only slopes are found. Otherwise flat ground is
    also found, at most one pixel plus the rise of `onto` lower. walk: see solids.Walk; me: row number of the character;
    rows: nearby solids, see solids.gather; left: pixel column of the character.
    """
    c = walk.characters[me]
    for drop in range(pixels_along(c.climb) + 1):
        what, by, slope = blocked_at(walk, me, rows, left, c.top + drop + 1, 0, 1, 0.0)
        if what == FREE:
            continue
        most = max(pixels_along(slope), pixels_along(onto))
        if what == ON_SLOPE and walk.bodies[walk.shapes[by].body_row].kind != STATIC:
            most += 1  # rounded feet may have been half a pixel inside moving ground, and half a pixel above it now
        if what == ON_SLOPE and drop <= most:
            return drop, slope
        if what == BLOCKED and onto != 0.0 and drop <= pixels_along(onto):
            return drop, 0.0
        return 0, 0.0
    return 0, 0.0


@subkernel
def is_wedged(walk, me, rows, slope):
    """Return whether a solid at the foot of a slope stops a character that slides down the slope.

    walk: see solids.Walk; me: row number of the character; rows: nearby solids, see solids.gather; slope: rise of the
    slope per px to the right.
    """
    c = walk.characters[me]
    side = -1 if slope > 0.0 else 1
    what, by, rise = blocked_at(walk, me, rows, c.left + side, c.top, side, 0, 0.0)
    return what != FREE


@subkernel
def steep_below(walk, me, rows, slope):
    """Return the slope of the ground just below a sliding character if this ground is too steep to walk on, else 0.

    The search goes down as far as ground with the slope `slope` drops over one pixel along x. walk: see solids.Walk;
    me: row number of the character; rows: nearby solids, see solids.gather; slope: slope down which it slides.
    """
    c = walk.characters[me]
    for drop in range(1, pixels_along(slope) + 1):
        what, by, found = blocked_at(walk, me, rows, c.left, c.top + drop, 0, drop, 0.0)
        if what != FREE:
            return found if what == STEEP else 0.0
    return 0.0


@subkernel
def slide_of(slope):
    """Return (pixels along x, pixels down) by which a character slides on a slope for each pixel of a free fall.

    Pixels along x are negative to the left. slope: rise per px to the right.
    """
    length = math.sqrt(1.0 + slope * slope)
    sine = slope / length
    return -sine / length, sine * sine


@subkernel
def slide_gently(me, rows, pixels, slope, walk_inout):
    """Slide a character down ground that is too steep to walk on but flatter than 45 degrees, instead of a free fall.

    Return True if nothing stopped the character. It moves pixel by pixel along x. me: row number of the character;
    rows: nearby solids, see solids.gather; pixels: length of the free fall; slope: rise of the ground per px to the
    right; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    aside, down = slide_of(slope)
    c.remainder_x += pixels * aside
    steps = math.floor(c.remainder_x + 0.5)
    c.remainder_x -= steps
    side = 1 if steps > 0 else -1
    for _ in range(abs(steps)):
        what, by, rise = blocked_at(walk_inout, me, rows, c.left + side, c.top, side, 0, 0.0)
        if what != FREE:
            c.remainder_x = 0.0
            return False
        c.left += side
        for _ in range(pixels_along(slope)):
            what, by, rise = blocked_at(walk_inout, me, rows, c.left, c.top + 1, 0, 1, 0.0)
            if what != FREE:
                break
            c.top += 1
    return True


# ---- feel ------------------------------------------------------------------------------------------------------------
# Contacts of a character after a move: its ground with slope, carrier and surface speed, and walls.


@subkernel
def tile_slope(walk, row, x, y):
    """Return the slope (rise per px to the right) of the slope tile at a world point (x, y) [px]; 0 for other tiles.

    walk: see solids.Walk; row: SHAPE row number of the tile grid.
    """
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    g = walk.geometry.grids[s.geometry]
    column = math.floor((x - on_pixels(b.kind, b.x)) / g.tile_size)
    line = math.floor((y - on_pixels(b.kind, b.y)) / g.tile_size)
    if not (0 <= column < g.columns and 0 <= line < g.rows):
        return 0.0
    cell = walk.geometry.cells[g.offset + line * g.columns + column]
    return cell.right - cell.left if cell.kind == SLOPE else 0.0


@subkernel
def slope_under_box(walk, me, row):
    """Return the slope of the tile under the middle of the feet of a box-shaped character.

    If this slope is 0, return the slope under the left end of the feet; if that is 0 too, under the right end. walk:
    see solids.Walk; me: row number of the character; row: SHAPE row number of the tile grid.
    """
    c = walk.characters[me]
    bottom = c.top + c.height + 0.5
    slope = tile_slope(walk, row, c.left + 0.5 * c.width, bottom)
    if slope == 0.0:
        slope = tile_slope(walk, row, c.left + 0.5, bottom)
    if slope == 0.0:
        slope = tile_slope(walk, row, c.left + c.width - 0.5, bottom)
    return slope


@subkernel
def speed_under(walk, row, x, y):
    """Return the surface speed [px/s] of a shape at the point (x, y) [px] where a character stands on it.

    The speed is along the tangent, and positive to the right on a floor (Box2D: tangent speed). walk: see solids.Walk;
    row: SHAPE row number.
    """
    s = walk.shapes[row]
    if s.kind != CHAIN:
        return s.surface_speed
    b = walk.bodies[s.body_row]
    cosine, sine = math.cos(b.angle), math.sin(b.angle)
    span = walk.geometry.chains[s.geometry]
    nearest = math.inf
    speed = s.surface_speed
    for k in range(span.offset, span.offset + span.count):
        link = walk.geometry.links[k]
        ax, ay = b.x + cosine * link.ax - sine * link.ay, b.y + sine * link.ax + cosine * link.ay
        bx, by = b.x + cosine * link.bx - sine * link.by, b.y + sine * link.bx + cosine * link.by
        if ax <= x < bx:
            off = abs(ay + (by - ay) * (x - ax) / (bx - ax) - y)
            if off < nearest:
                nearest = off
                speed = link.surface_speed if link.friction >= 0.0 else s.surface_speed
    return speed


@subkernel
def feel_ground(me, walk_inout):
    """Write to a CHARACTER row whether the character is grounded, and the body, slope and surface speed of its ground.

    me: row number of the character; walk_inout: see solids.Walk, with the nearby shapes in walk_inout.found.
    """
    c = walk_inout.characters[me]
    what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left, c.top + 1, 0, 1, 0.0)
    was_grounded = c.grounded
    c.grounded = what != FREE and (what != STEEP or is_wedged(walk_inout, me, walk_inout.found, slope))
    c.riding = -1
    c.riding_shape = -1
    c.belt = 0.0
    if what == FREE:
        # A sliding character may be above its ground, by less than the drop over one pixel.
        sliding = abs(c.slope) >= 1.0 and not was_grounded
        c.slope = steep_below(walk_inout, me, walk_inout.found, c.slope) if sliding else 0.0
        return
    c.slope = slope
    s = walk_inout.shapes[by]
    belt = speed_under(walk_inout, by, c.left + 0.5 * c.width, float(c.top + c.height))
    c.belt = (
        belt if abs(belt) < LARGEST else 0.0
    )  # a body with a non-finite surface speed is quarantined by the next step
    if s.kind == TILES and c.is_box:
        c.slope = slope_under_box(walk_inout, me, by)
    if walk_inout.bodies[s.body_row].kind != STATIC:
        c.riding = s.body
        c.riding_shape = s.id


@subkernel
def feel(me, walk_inout):
    """Write the ground and the wall that a character touches to its CHARACTER row.

    me: row number of the character; walk_inout: see solids.Walk, with the nearby shapes in walk_inout.found.
    """
    c = walk_inout.characters[me]
    feel_ground(me, walk_inout)
    c.wall = 0
    for side in range(-1, 2, 2):
        what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left + side, c.top, side, 0, 0.0)
        if (what == BLOCKED or what == STEEP) and c.wall == 0:
            c.wall = side


# ---- crush -----------------------------------------------------------------------------------------------------------
# Squeezing: a moving solid overlaps a character that had no space. The flag `squeezed` lasts as long as the overlap.


@subkernel
def depth_in(me, row, walk_inout):
    """Return the overlap (depth [px], nx, ny) of a character with a loose shape (see solids.is_loose).

    nx, ny: unit normal from the character into the shape; me: row number of the character; row: SHAPE row number;
    walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    if walk_inout.shapes[row].kind == CHAIN:
        return deepest_link(walk_inout, me, row, c.left, c.top)
    count, radius = place_outline(walk_inout, me, c.left, c.top)
    depth, nx, ny, x, y = meet(walk_inout, row, count, radius)
    return depth, nx, ny


@subkernel
def is_in_drawn(me, row, walk_inout):
    """Return whether a shape overlaps a character at its present position, so that it blocks a move in some direction.

    me: row number of the character; row: SHAPE row number; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    for side in range(-1, 2, 2):
        what, slope = in_shape(walk_inout, me, row, c.left, c.top, side, 0, 0.0)
        if what != FREE:
            return True
        what, slope = in_shape(walk_inout, me, row, c.left, c.top, 0, side, 0.0)
        if what != FREE:
            return True
    return False


@subkernel
def is_crushed(me, all_kinds, walk_inout):
    """Return whether a moving solid overlaps a character. O(nearby solids).

    An overlap with a loose solid (see solids.is_loose) counts only if it is deeper than GIVE. me: row number of the
    character; all_kinds: True: test kinematic and dynamic bodies, False: test only kinematic bodies; walk_inout: see
    solids.Walk.
    """
    gather(walk_inout, me, -1, 0.0, 0.0, 0.0, walk_inout.found)
    for k in range(1, walk_inout.found[0] + 1):
        loose = walk_inout.found[k] < 0
        row = -1 - walk_inout.found[k] if loose else walk_inout.found[k]
        s = walk_inout.shapes[row]
        kind = walk_inout.bodies[s.body_row].kind
        if kind == STATIC or (kind != KINEMATIC and not all_kinds) or character_of(walk_inout.characters, s.body) >= 0:
            continue
        if loose:
            depth, nx, ny = depth_in(me, row, walk_inout)
            if depth > GIVE:
                return True
        elif is_in_drawn(me, row, walk_inout):
            return True
    return False


# ---- way out ---------------------------------------------------------------------------------------------------------
# Moving a character out of a static solid that overlaps it: it was placed there, or the ground was changed.
#
# Walking never leads into a solid. The character leaves by the shortest of eight straight paths, PACE pixels in each
# move, independent of dx and dy. Moving bodies that overlap a character are handled by "crush" above.

PACE = 2  # [px] moved out of a solid in one move: about the push-out of overlapping bodies in a step


@subkernel
def keep_still(walk, rows_inout):
    """Remove the shapes of bodies that are not static from a list of SHAPE row numbers.

    walk: see solids.Walk; rows_inout: the list; its first element is the number of row numbers that follow.
    """
    kept = 0
    for k in range(1, rows_inout[0] + 1):
        row = rows_inout[k]
        if row >= 0 and walk.bodies[walk.shapes[row].body_row].kind == STATIC:
            kept += 1
            rows_inout[kept] = row
    rows_inout[0] = kept


@subkernel
def is_inside(me, walk_inout):
    """Return whether a character overlaps a static solid. O(nearby solids).

    me: row number of the character; walk_inout: see solids.Walk. Its list walk_inout.found of nearby solids is reduced
    to the shapes of static bodies.
    """
    c = walk_inout.characters[me]
    keep_still(walk_inout, walk_inout.found)
    what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left, c.top, 0, 0, 0.0)
    return what != FREE


@kernel
def lead_out(me, reach, walk_inout, moved_inout):
    """Move a character out of a static solid towards the nearest free position, by up to PACE pixels.

    Of equally near positions, one above is preferred to one at a side, and one at a side to one below. The character
    does not move if there is no free position within `reach` [px]. me: row number of the character; walk_inout: see
    solids.Walk; moved_inout: (4,) the pixels moved along x and y are added to elements 0 and 1. O(reach · nearby
    solids).
    """
    c = walk_inout.characters[me]
    rows = walk_inout.found
    gather(walk_inout, me, -1, reach + 1.0, reach + 1.0, reach + 1.0, rows)
    way_x, way_y = 0, 0
    nearest = 2 * reach * reach + 1
    for turn in range(8):
        # Up, left, right, the diagonals upwards, down, the diagonals downwards.
        dx = 0 if turn == 0 or turn == 5 else (-1 if turn == 1 or turn == 3 or turn == 6 else 1)
        dy = -1 if turn == 0 or turn == 3 or turn == 4 else (0 if turn < 3 else 1)
        for far in range(1, reach + 1):
            if far * far * (dx * dx + dy * dy) >= nearest:
                break
            what, by, slope = blocked_at(walk_inout, me, rows, c.left + far * dx, c.top + far * dy, 0, 0, GIVE)
            if what == FREE:
                nearest = far * far * (dx * dx + dy * dy)
                pixels = min(far, PACE)
                way_x, way_y = pixels * dx, pixels * dy
                break
    c.left += way_x
    c.top += way_y
    moved_inout[0] += way_x
    moved_inout[1] += way_y
    if way_x != 0 or way_y != 0:
        settle(me, walk_inout)
        feel(me, walk_inout)


# ---- push ------------------------------------------------------------------------------------------------------------
# Impulses between characters and the bodies of a world that stacks: pushing, landing, weight.
#
# A character has a mass but no velocity that a solver could change, because the game moves it. So it acts on bodies by
# its own impulses, and the solver leaves out the contacts under its feet: there the character acts by its weight, and
# does not block the body as an immovable ceiling would.


@subkernel
def push_body(me, row, direction, speed, left, walk_inout):
    """Push one body towards a speed [px/s] along x, by an impulse of at most `left` [mass px/s].

    Return the unused part of `left`. me: row number of the character; row: SHAPE row number of the body's shape;
    direction: -1 left, 1 right; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    settings = walk_inout.settings
    count, radius = place_outline(walk_inout, me, c.left + direction, c.top)
    depth, nx, ny, x, y = meet(walk_inout, row, count, radius)
    arm = (x - b.center_x) * ny - (y - b.center_y) * nx
    turning = b.inverse_inertia if settings.rotation == 1 else 0.0
    now = b.vx * nx + b.vy * ny + settings.dt * b.inverse_mass * (b.force_x * nx + b.force_y * ny)
    if settings.rotation == 1:
        now += (b.angular_velocity + settings.dt * turning * b.torque) * arm
    weight = b.inverse_mass + turning * arm * arm
    if weight <= 0.0:
        return left
    impulse = min((speed * nx - now) / weight, left)
    if impulse <= 0.0 or settings.dt <= 0.0:
        return left
    b.force_x += impulse / settings.dt * nx
    b.force_y += impulse / settings.dt * ny
    b.torque += impulse / settings.dt * arm
    return left - impulse


@subkernel
def shove(me, direction, speed, walk_inout):
    """Push the dynamic bodies beside a character towards the speed of its move, by at most an impulse mass · push · dt.

    The push is a force during the next step, so sufficient friction keeps a body at rest. me: row number of the
    character; direction: -1 left, 1 right; speed: speed of the move along x [px/s]; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    speed += walk_inout.bodies[c.body_row].vx  # the speed of its carrier
    left = c.mass * c.push * walk_inout.settings.dt
    for k in range(1, walk_inout.found[0] + 1):
        row = -1 - walk_inout.found[k]
        if row < 0:
            continue
        b = walk_inout.bodies[walk_inout.shapes[row].body_row]
        if b.kind != DYNAMIC or b.inverse_mass == 0.0:
            continue
        what, slope = in_shape(walk_inout, me, row, c.left + direction, c.top, direction, 0, 0.0)
        if what == BLOCKED or what == STEEP:
            left = push_body(me, row, direction, speed, left, walk_inout)


@subkernel
def foot_of(c, s):
    """Return the point (x, y) [px] at which the feet of a character (CHARACTER row c) stand on a shape (SHAPE row s).

    It is the middle of the feet, moved along x into the shape's AABB if it is outside.
    """
    return min(max(c.left + 0.5 * c.width, s.min_x), s.max_x), float(c.top + c.height)


@subkernel
def knock(me, row, direction, speed, walk_inout):
    """Apply the inelastic impact of a character that lands on a body, or hits the body from below with its head.

    me: row number of the character; row: SHAPE row number of the body's shape; direction: 1 for a landing, -1 for a hit
    from below; speed: velocity of the character along y [px/s], positive down; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    x, y = foot_of(c, walk_inout.shapes[row])
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    if b.inverse_mass == 0.0 or c.mass <= 0.0:
        return
    rotation = walk_inout.settings.rotation
    arm = (x - b.center_x) * direction
    turning = b.inverse_inertia if rotation == 1 else 0.0
    now = b.vy * direction + (b.angular_velocity * arm if rotation == 1 else 0.0)
    closing = (speed + walk_inout.bodies[c.body_row].vy) * direction - now
    if closing > 0.0:
        impulse = closing / (1.0 / c.mass + b.inverse_mass + turning * arm * arm)
        b.vy += impulse * b.inverse_mass * direction
        b.angular_velocity += impulse * turning * arm


@kernel
def press(shapes, gravity_x, gravity_y, slow, characters_inout, bodies_inout):
    """Apply the weight of characters to the awake dynamic bodies on which they stand. O(characters · log shapes).

    Also store the point under the feet of each character [px]. If the ground moves at this point faster than `slow`
    [px/s], the velocity of the character's body is set to that of the ground. A slower velocity is not used, because it
    would keep the ground awake. shapes: SHAPE table; gravity_x, gravity_y [px/s²]; characters_inout: CHARACTER table;
    bodies_inout: BODY table.
    """
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        b = bodies_inout[c.body_row]
        if b.quarantined:
            continue
        b.vx, b.vy = c.push_vx, c.push_vy
        row = row_of(shapes, c.riding_shape) if c.riding >= 0 else -1
        if row < 0:
            continue
        s = shapes[row]
        r = bodies_inout[s.body_row]
        c.foot_x, c.foot_y = foot_of(c, s)
        arm_x, arm_y = c.foot_x - r.center_x, c.foot_y - r.center_y
        vx, vy = r.vx - r.angular_velocity * arm_y, r.vy + r.angular_velocity * arm_x
        if r.kind != STATIC and abs(vx) + abs(vy) > slow:
            b.vx, b.vy = vx, vy
        if r.kind == DYNAMIC and r.awake:
            r.force_x += c.mass * gravity_x
            r.force_y += c.mass * gravity_y
            r.torque += c.mass * (arm_x * gravity_y - arm_y * gravity_x)


@subkernel
def is_between(manifold, first, second):
    """Return whether a contact (CONTACT row) is between the bodies with the ids `first` and `second`, in any order."""
    m = manifold
    return (m.body_a == first and m.body_b == second) or (m.body_b == first and m.body_a == second)


@kernel
def write_weight(characters, weight_rate, manifolds_inout):
    """Write the weight of characters as normal impulses to the contacts with the bodies on which they stand.

    The weight of a character is divided equally among all points of these contacts. characters: CHARACTER table;
    weight_rate: gravity times the length of the step [px/s]; manifolds_inout: CONTACT rows. O(characters · contacts).
    """
    for me in range(len(characters)):
        c = characters[me]
        if c.riding < 0:
            continue
        points = 0
        for k in range(len(manifolds_inout)):
            if is_between(manifolds_inout[k], c.body, c.riding):
                points += manifolds_inout[k].count
        for k in range(len(manifolds_inout)):
            m = manifolds_inout[k]
            if points > 0 and is_between(m, c.body, c.riding):
                m.normal_impulse_1 = c.mass * weight_rate / points
                m.normal_impulse_2 = c.mass * weight_rate / points


# ---- walk ------------------------------------------------------------------------------------------------------------
# Motion of one character, pixel by pixel, one axis after the other.
#
# Whole pixels with a remainder, as in Celeste and TowerFall: a character never overlaps a solid and never passes
# through a solid (Thorson, Celeste and TowerFall Physics, 2018). In addition there are slopes, pushing, and in worlds
# that stack the impulses on bodies that the character runs into and lands on.


@subkernel
def whole_pixels(remainder):
    """Return `remainder` [px], the part of a motion that has not been made yet, rounded to the nearest whole number."""
    return math.floor(remainder + 0.5)


@subkernel
def way_for_pushed(by, direction, walk_inout):
    """Return (row number of the character that blocks a move, pixels that it must rise to be pushed one pixel along x).

    The first value is -1 if the shape `by` does not belong to a character; the second is -1 if that character cannot be
    pushed. by: SHAPE row number of the shape that blocks the move; direction: -1 left, 1 right; walk_inout: see
    solids.Walk.
    """
    other = character_of(walk_inout.characters, walk_inout.shapes[by].body)
    if other < 0:
        return -1, -1
    gather(walk_inout, other, -1, 2.0, 1.0 + STEEPEST_CLIMB, 1.0, walk_inout.found_beside)
    lift, blocks, slope = way_aside(walk_inout, other, walk_inout.found_beside, direction)
    return other, lift


@subkernel
def step_sideways(me, direction, follow, walk_inout):
    """Move a character one pixel along x, if it is not blocked, and push a pushable character in front of it.

    Return whether the character `me` moved. It also moves up a slope and, if `follow` is 1, down a slope. me: row
    number of the character; direction: -1 left, 1 right; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    rows = walk_inout.found
    lift, by, slope = way_aside(walk_inout, me, rows, direction)
    if lift < 0 and by >= 0:
        # Only from the side: a character on or under a crate does not push the crate.
        other, its_lift = way_for_pushed(by, direction, walk_inout)
        if other < 0 or its_lift < 0:
            return False
        pushed = walk_inout.characters[other]
        pushed.left += direction
        pushed.top -= its_lift
        settle(other, walk_inout)
        lift, by, slope = way_aside(walk_inout, me, rows, direction)
    if lift < 0:
        return False
    if lift > 0:
        c.top -= lift
        c.slope = slope
    elif follow == 1:
        drop, onto = drop_onto(walk_inout, me, rows, c.left + direction, c.slope)
        c.top += drop
        if onto != 0.0:
            c.slope = onto
    c.left += direction
    return True


@subkernel
def walk_along(me, dx, follow, walk_inout, moved_out):
    """Move a character along x by dx [px], pixel by pixel, and push bodies in front of it by impulses.

    me: row number of the character; follow: 1: move down with the ground, 0: do not; walk_inout: see solids.Walk;
    moved_out: (4,) result of walk; element 2 is set to 1 if the character was stopped.
    """
    c = walk_inout.characters[me]
    c.remainder_x += dx
    pixels = whole_pixels(c.remainder_x)
    c.remainder_x -= pixels
    direction = 1 if pixels > 0 else -1
    for _ in range(abs(pixels)):
        if not step_sideways(me, direction, follow, walk_inout):
            c.remainder_x = 0.0
            moved_out[2] = 1
            break
    settings = walk_inout.settings
    if settings.stacking == 1 and settings.dt > 0.0 and dx != 0.0:
        # Moves of less than a pixel also push, so that a pushed body keeps its speed.
        shove(me, 1 if dx > 0.0 else -1, dx / settings.dt, walk_inout)


@subkernel
def slide_pixel(me, slope, walk_inout):
    """Move a character one pixel sideways, down a slope that is too steep to walk on, if that pixel is free.

    Return whether it was free. me: row number of the character; slope: rise of the ground per px to the right;
    walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    side = -1 if slope > 0.0 else 1
    what, by, rise = blocked_at(walk_inout, me, walk_inout.found, c.left + side, c.top, side, 0, 0.0)
    if what == FREE:
        c.left += side
    return what == FREE


@subkernel
def fall_or_rise(me, dy, walk_inout, moved_out):
    """Move a character along y by dy [px], pixel by pixel, and apply its impacts on bodies that it hits.

    On ground that is too steep to walk on, the character slides down by the component of dy along the slope. me: row
    number of the character; walk_inout: see solids.Walk; moved_out: (4,) result of walk; element 3 is set to 1 if the
    character was stopped.
    """
    c = walk_inout.characters[me]
    rows = walk_inout.found
    settings = walk_inout.settings
    slides = False
    way = dy
    if dy > 0.0 and not c.grounded and abs(c.slope) >= 1.0:
        slope = steep_below(walk_inout, me, rows, c.slope)
        slides = abs(slope) >= 1.0
        aside, down = slide_of(slope)
        way = dy * down if slides else dy
    c.remainder_y += way
    pixels = whole_pixels(c.remainder_y)
    c.remainder_y -= pixels
    direction = 1 if pixels > 0 else -1
    left = abs(pixels)
    asides = 0  # pixels moved sideways since it last moved down
    while left > 0:
        what, by, slope = blocked_at(walk_inout, me, rows, c.left, c.top + direction, 0, direction, 0.0)
        if what == FREE:
            c.top += direction
            left -= 1
            asides = 0
            continue
        body = walk_inout.bodies[walk_inout.shapes[by].body_row]
        if not slides and settings.dt > 0.0 and body.kind == DYNAMIC and (direction < 0 or not c.grounded):
            knock(me, by, direction, dy / settings.dt, walk_inout)
        if what == STEEP and abs(slope) < 1.0 and not slides:
            if not slide_gently(me, rows, left, slope, walk_inout):
                moved_out[3] = 1
            return
        if what == STEEP:
            c.slope = slope
        if what == STEEP and not slides:
            slides = True
            aside, down = slide_of(slope)
            c.remainder_y += left * down
            left = whole_pixels(c.remainder_y)
            c.remainder_y -= left
            continue
        if what != STEEP or asides > 2 or not slide_pixel(me, slope, walk_inout):
            c.remainder_y = 0.0
            moved_out[3] = 1
            return
        asides += 1


@kernel
def walk(me, dx, dy, walk_inout, moved_out):
    """Move a character by (dx, dy) [px], x first, and write its contacts. Return whether it overlaps a static solid.

    If it does, the caller must call lead_out. me: row number of the character; walk_inout: see solids.Walk; moved_out:
    (4,) pixels moved along x, pixels moved along y, 1 if stopped along x, 1 if stopped along y. O(pixels · nearby
    solids).
    """
    c = walk_inout.characters[me]
    reach = 3.0 + abs(dx) + abs(dy)
    gather(walk_inout, me, -1, reach, reach + c.climb * abs(dx), reach + c.climb * abs(dx), walk_inout.found)
    start_left, start_top = c.left, c.top
    moved_out[2] = 0
    moved_out[3] = 0
    follow = 1 if c.grounded and dy >= 0.0 and not c.drop else 0
    walk_along(me, dx, follow, walk_inout, moved_out)
    fall_or_rise(me, dy, walk_inout, moved_out)
    settle(me, walk_inout)
    feel(me, walk_inout)
    if c.squeezed:
        # This move reports the flag, which stays set as long as the solid overlaps the character.
        c.squeezed = is_crushed(me, True, walk_inout)
    moved_out[0] = c.left - start_left
    moved_out[1] = c.top - start_top
    return is_inside(me, walk_inout)


@kernel
def is_stopped(me, along_x, along_y, walk_inout):
    """Return whether a character can move neither by along_x pixels along x nor by along_y pixels along y.

    The character is not moved. For a direction (0, 0) the result is False. me: row number of the character; along_x,
    along_y: -1, 0 or 1; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    gather(walk_inout, me, -1, 3.0, 3.0 + STEEPEST_CLIMB, 3.0, walk_inout.found)
    if along_x != 0:
        lift, by, slope = way_aside(walk_inout, me, walk_inout.found, along_x)
        if lift < 0 and by >= 0:
            other, lift = way_for_pushed(by, along_x, walk_inout)
        if lift >= 0:
            return False
    if along_y != 0:
        what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left, c.top + along_y, 0, along_y, 0.0)
        if what == FREE or (what == STEEP and not is_wedged(walk_inout, me, walk_inout.found, slope)):
            return False
    return along_x != 0 or along_y != 0
