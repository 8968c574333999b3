"""Moves one character, pixel by pixel, one axis after the other.

Whole pixels with the remainder carried over, as in Celeste and TowerFall: a character never overlaps a solid and never
misses one (Thorson, Celeste and TowerFall Physics, 2018). Added here: slopes, pushing, and in worlds that stack the
impulses that it gives to the bodies it runs into and lands on.
"""

import math

from physics.character.climb import drop_onto, is_wedged, slide_gently, slide_of, steep_below, way_aside
from physics.character.crush import is_crushed
from physics.character.feel import feel
from physics.character.ground import FREE, STEEP, STEEPEST_CLIMB
from physics.character.push import knock, shove
from physics.character.solids import blocked_at, gather
from physics.character.way_out import is_inside
from physics.character.workspace import character_of, settle
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC


@subkernel
def whole_pixels(remainder):
    """The pixels to move for a remainder: it stays within half a pixel."""
    return math.floor(remainder + 0.5)


@subkernel
def way_for_pushed(by, direction, walk_inout):
    """(the character whose shape blocks a way sideways, or -1; pixels up by which it gives way one pixel, or -1)."""
    other = character_of(walk_inout.characters, walk_inout.shapes[by].body)
    if other < 0:
        return -1, -1
    gather(walk_inout, other, -1, 2.0, 1.0 + STEEPEST_CLIMB, 1.0, walk_inout.found_beside)
    lift, blocks, slope = way_aside(walk_inout, other, walk_inout.found_beside, direction)
    return other, lift


@subkernel
def step_sideways(me, direction, follow, walk_inout):
    """One pixel along x: up a slope, down one when `follow` is 1, pushing characters. Returns whether it moved."""
    c = walk_inout.characters[me]
    rows = walk_inout.found
    lift, by, slope = way_aside(walk_inout, me, rows, direction)
    if lift < 0 and by >= 0:
        # Only from beside: what stands on a crate, or carries it, does not push it.
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
    """The part of a move along x [px]: in steps, and with what is pushed by impulses."""
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
        # Also when the next pixel is not due yet: what is pushed keeps its speed between two pixels.
        shove(me, 1 if dx > 0.0 else -1, dx / settings.dt, walk_inout)


@subkernel
def slide_pixel(me, slope, walk_inout):
    """One pixel aside, down a slope that a character is on and does not walk. Returns whether it was free."""
    c = walk_inout.characters[me]
    side = -1 if slope > 0.0 else 1
    what, by, rise = blocked_at(walk_inout, me, walk_inout.found, c.left + side, c.top, side, 0, 0.0)
    if what == FREE:
        c.left += side
    return what == FREE


@subkernel
def fall_or_rise(me, dy, walk_inout, moved_out):
    """The part of a move along y [px]. On ground too steep to stand on it slides, as far as that leads along it."""
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
    asides = 0  # since it last went down
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
def walk(
    # read
    me,
    dx,
    dy,
    # write
    walk_inout,
    moved_out,
):
    """Move a character by (dx, dy) [px], x first, and write what it touches then. Returns whether it stands in a still
    solid, see way_out.py.

    me: its row; walk_inout: a Walk; moved_out (4,): pixels moved along x and y, 1 where it was stopped along x, along
    y. O(pixels · solids near).
    """
    c = walk_inout.characters[me]
    reach = 3.0 + abs(dx) + abs(dy)
    gather(walk_inout, me, -1, reach, reach + c.climb * abs(dx), reach + c.climb * abs(dx), walk_inout.found)
    start_left = c.left
    start_top = c.top
    moved_out[2] = 0
    moved_out[3] = 0
    follow = 1 if c.grounded and dy >= 0.0 and not c.drop else 0
    walk_along(me, dx, follow, walk_inout, moved_out)
    fall_or_rise(me, dy, walk_inout, moved_out)
    settle(me, walk_inout)
    feel(me, walk_inout)
    if c.squeezed:
        # Told; from now on for as long as what crushes it is in it.
        c.squeezed = is_crushed(me, True, walk_inout)
    moved_out[0] = c.left - start_left
    moved_out[1] = c.top - start_top
    return is_inside(me, walk_inout)


@kernel
def is_stopped(
    # read
    me,
    along_x,
    along_y,
    # write
    walk_inout,
):
    """Whether a character cannot go a single pixel: along_x, along_y: -1, 0 or 1. Moves nothing. O(solids near)."""
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
