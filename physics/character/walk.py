"""Moves one character, pixel by pixel, one axis after the other.

Whole pixels with the remainder carried over, as in Celeste and TowerFall: a character never overlaps a solid and never
misses one (Thorson, Celeste and TowerFall Physics, 2018). Added here: slopes, pushing, and in worlds that stack the
impulses that it gives to the bodies it runs into and lands on.
"""

import math

from physics.character.push import knock, shove
from physics.character.solids import BLOCKED, FREE, ON_SLOPE, blocked_at, character_of, gather_solids
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.geometry import SLOPE
from physics.tables.shape import CHAIN, TILES


@subkernel
def whole_pixels(remainder):
    """The pixels to move for a remainder: it stays within half a pixel."""
    return math.floor(remainder + 0.5)


@subkernel
def settle(me, characters_inout, bodies_inout):
    """Put the character's body where its box is."""
    c = characters_inout[me]
    b = bodies_inout[c.body_row]
    b.x = c.left + 0.5 * c.width
    b.y = c.top + 0.5 * c.height
    b.center_x = b.x
    b.center_y = b.y


@subkernel
def push_along(geometry, shapes, pushed, direction, piles, slop, scratch, rows_inout, characters_inout, bodies_inout):
    """Move a pushable character one pixel sideways if nothing is in its way. Returns whether it moved."""
    c = characters_inout[pushed]
    at = c.left + direction
    count = gather_solids(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        pushed,
        -1,
        piles,
        float(at - 1),
        float(c.top - 1),
        float(at + c.width + 1),
        float(c.top + c.height + 1),
        rows_inout,
    )
    what, by = blocked_at(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        rows_inout,
        count,
        at,
        c.top,
        c.width,
        c.height,
        direction,
        0,
        0,
        0.0,
        slop,
        scratch,
    )
    if what == FREE:
        c.left = at
        settle(pushed, characters_inout, bodies_inout)
        return True
    if what == ON_SLOPE:
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows_inout,
            count,
            at,
            c.top - 1,
            c.width,
            c.height,
            direction,
            -1,
            0,
            0.0,
            slop,
            scratch,
        )
        if what == FREE:
            c.left = at
            c.top -= 1
            settle(pushed, characters_inout, bodies_inout)
            return True
    return False


@subkernel
def step_sideways(
    geometry,
    shapes,
    me,
    direction,
    follow,
    piles,
    slop,
    scratch,
    rows,
    count,
    pushed_rows,
    characters_inout,
    bodies_inout,
):
    """One pixel along x: up a slope, down one when `follow` is 1, pushing characters that can be. Returns whether it moved."""
    c = characters_inout[me]
    at = c.left + direction
    what, by = blocked_at(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        rows,
        count,
        at,
        c.top,
        c.width,
        c.height,
        direction,
        0,
        0,
        0.0,
        slop,
        scratch,
    )
    if what == BLOCKED:
        other = character_of(characters_inout, shapes[by].body_row)
        # Only from beside: what stands on a crate, or carries it, does not push it.
        if other < 0 or not push_along(
            geometry, shapes, other, direction, piles, slop, scratch, pushed_rows, characters_inout, bodies_inout
        ):
            return False
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            at,
            c.top,
            c.width,
            c.height,
            direction,
            0,
            0,
            0.0,
            slop,
            scratch,
        )
        if what == BLOCKED:
            return False
    if what == ON_SLOPE:
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            at,
            c.top - 1,
            c.width,
            c.height,
            direction,
            -1,
            0,
            0.0,
            slop,
            scratch,
        )
        if what != FREE:
            return False
        c.top -= 1
    elif follow == 1:
        below, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            at,
            c.top + 1,
            c.width,
            c.height,
            0,
            1,
            1,
            0.0,
            slop,
            scratch,
        )
        if below == FREE:
            below, by = blocked_at(
                geometry,
                bodies_inout,
                shapes,
                characters_inout,
                rows,
                count,
                at,
                c.top + 2,
                c.width,
                c.height,
                0,
                1,
                1,
                0.0,
                slop,
                scratch,
            )
            # From the last pixel of a slope it is one more down to the flat.
            if below == ON_SLOPE or (below == BLOCKED and c.slope != 0.0):
                c.top += 1
    c.left = at
    return True


@subkernel
def slope_under(geometry, bodies, shapes, row, x, y):
    """Rise per px to the right of the slope tile at a point [px] of a tile grid, 0 elsewhere."""
    s = shapes[row]
    b = bodies[s.body_row]
    g = geometry.grids[s.geometry]
    column = math.floor((x - b.x) / g.tile_size)
    line = math.floor((y - b.y) / g.tile_size)
    if not (0 <= column < g.columns and 0 <= line < g.rows):
        return 0.0
    cell = geometry.cells[g.offset + line * g.columns + column]
    return cell.right - cell.left if cell.kind == SLOPE else 0.0


@subkernel
def speed_under(geometry, bodies, shapes, row, x, y):
    """Speed [px/s] at which a surface runs to the right under a point [px] that stands on it.

    Source: engines' conveyor materials (Box2D's tangent speed): along the tangent, to the right on a floor.
    """
    s = shapes[row]
    if s.kind != CHAIN:
        return s.surface_speed
    b = bodies[s.body_row]
    cosine = math.cos(b.angle)
    sine = math.sin(b.angle)
    span = geometry.chains[s.geometry]
    nearest = math.inf
    speed = s.surface_speed
    for k in range(span.offset, span.offset + span.count):
        link = geometry.links[k]
        ax = b.x + cosine * link.ax - sine * link.ay
        ay = b.y + sine * link.ax + cosine * link.ay
        bx = b.x + cosine * link.bx - sine * link.by
        by = b.y + sine * link.bx + cosine * link.by
        if ax <= x < bx:
            off = abs(ay + (by - ay) * (x - ax) / (bx - ax) - y)
            if off < nearest:
                nearest = off
                speed = link.surface_speed if link.friction >= 0.0 else s.surface_speed
    return speed


@subkernel
def feel(geometry, shapes, me, slop, scratch, rows, count, characters_inout, bodies_inout):
    """Write what the character touches: ground, slope, what carries it and how fast its surface runs, walls."""
    c = characters_inout[me]
    falling = 0 if c.drop else 1
    what, by = blocked_at(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        rows,
        count,
        c.left,
        c.top + 1,
        c.width,
        c.height,
        0,
        1,
        falling,
        0.0,
        slop,
        scratch,
    )
    c.grounded = what != FREE
    c.riding = -1
    c.slope = 0.0
    c.belt = 0.0
    if what != FREE:
        c.belt = speed_under(geometry, bodies_inout, shapes, by, c.left + 0.5 * c.width, float(c.top + c.height))
    if what != FREE and shapes[by].kind == TILES:
        # The slope under the middle of the feet; at its ends a foot beside it still stands on it.
        bottom = c.top + c.height + 0.5
        c.slope = slope_under(geometry, bodies_inout, shapes, by, c.left + 0.5 * c.width, bottom)
        if c.slope == 0.0:
            c.slope = slope_under(geometry, bodies_inout, shapes, by, c.left + 0.5, bottom)
        if c.slope == 0.0:
            c.slope = slope_under(geometry, bodies_inout, shapes, by, c.left + c.width - 0.5, bottom)
    if what != FREE and bodies_inout[shapes[by].body_row].kind != STATIC:
        c.riding = shapes[by].body
    c.wall = 0
    for side in range(-1, 2, 2):
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            c.left + side,
            c.top,
            c.width,
            c.height,
            side,
            0,
            0,
            0.0,
            slop,
            scratch,
        )
        if what == BLOCKED and c.wall == 0:
            c.wall = side


@kernel
def walk(
    # read
    geometry,
    shapes,
    me,
    dx,
    dy,
    piles,
    rotation,
    dt,
    slop,
    # write
    scratch,
    rows_out,
    pushed_rows_out,
    characters_inout,
    bodies_inout,
    moved_out,
):
    """Move a character by (dx, dy) [px], x first, and write what it touches then.

    me: its row; piles: 1 in a world that stacks, where it meets dynamic bodies, and rotation: 1 when these turn; dt [s]:
    time that the move stands for; rows_out, pushed_rows_out (shapes): scratch; moved_out (4,): pixels moved along x and
    y, 1 where it was stopped along x, along y. O(shapes + pixels · solids near).
    """
    c = characters_inout[me]
    reach = 3.0 + abs(dx)
    drop = 3.0 + abs(dx) + abs(dy)
    count = gather_solids(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        me,
        -1,
        piles,
        c.left - reach,
        c.top - drop,
        c.left + c.width + reach,
        c.top + c.height + drop,
        rows_out,
    )
    start_left = c.left
    start_top = c.top
    moved_out[2] = 0
    moved_out[3] = 0
    follow = 1 if c.grounded and dy >= 0.0 and not c.drop else 0
    c.remainder_x += dx
    left = whole_pixels(c.remainder_x)
    c.remainder_x -= left
    direction = 1 if left > 0 else -1
    for _ in range(abs(left)):
        if not step_sideways(
            geometry,
            shapes,
            me,
            direction,
            follow,
            piles,
            slop,
            scratch,
            rows_out,
            count,
            pushed_rows_out,
            characters_inout,
            bodies_inout,
        ):
            c.remainder_x = 0.0
            moved_out[2] = 1
            break
    if piles == 1 and dt > 0.0 and dx != 0.0:
        # Also when the next pixel is not due yet: what is pushed keeps its speed between two pixels.
        shove(
            geometry,
            shapes,
            me,
            1 if dx > 0.0 else -1,
            dx / dt,
            rotation,
            dt,
            slop,
            scratch,
            rows_out,
            count,
            characters_inout,
            bodies_inout,
        )
    c.remainder_y += dy
    left = whole_pixels(c.remainder_y)
    c.remainder_y -= left
    direction = 1 if left > 0 else -1
    falling = 1 if direction > 0 and not c.drop else 0
    for _ in range(abs(left)):
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows_out,
            count,
            c.left,
            c.top + direction,
            c.width,
            c.height,
            0,
            direction,
            falling,
            0.0,
            slop,
            scratch,
        )
        if what != FREE:
            if dt > 0.0 and bodies_inout[shapes[by].body_row].kind == DYNAMIC and (direction < 0 or not c.grounded):
                knock(shapes, me, by, direction, dy / dt, rotation, characters_inout, bodies_inout)
            c.remainder_y = 0.0
            moved_out[3] = 1
            break
        c.top += direction
    settle(me, characters_inout, bodies_inout)
    feel(geometry, shapes, me, slop, scratch, rows_out, count, characters_inout, bodies_inout)
    moved_out[0] = c.left - start_left
    moved_out[1] = c.top - start_top
