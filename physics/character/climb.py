"""Up and down with the ground: how far a character rises onto a slope it walks into, or drops to one it walks down."""

import math

from physics.character.ground import BLOCKED, FREE, ON_SLOPE, STEEP, pixels_along
from physics.character.solids import blocked_at
from physics.jit import subkernel
from physics.tables.body import STATIC


@subkernel
def rise_onto(walk, me, rows, direction, slope):
    """Pixels up by which a character is free one pixel to a side, where it is on ground of a slope; -1: by too many.

    Half a pixel more than the slope rises: for corners of outlines on steps of pixels. Not onto what only holds it by
    ground that is too steep.
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
    """(pixels up by which a character can go one pixel to a side, or -1; the shape row that blocks it or -1; slope)."""
    c = walk.characters[me]
    what, by, slope = blocked_at(walk, me, rows, c.left + direction, c.top, direction, 0, 0.0)
    if what == FREE:
        return 0, -1, 0.0
    if what != ON_SLOPE:
        return -1, by, 0.0
    return rise_onto(walk, me, rows, direction, slope), -1, slope


@subkernel
def drop_onto(walk, me, rows, left, onto):
    """(pixels down at a pixel column until a character stands on ground it walks, 0: none is near; its slope).

    onto: the slope it comes from; 0: from the flat, off which it drops onto slopes only. Slopes may be as steep as it
    walks; a flat is one pixel and as much lower as the slope it comes from.
    """
    c = walk.characters[me]
    for drop in range(pixels_along(c.climb) + 1):
        what, by, slope = blocked_at(walk, me, rows, left, c.top + drop + 1, 0, 1, 0.0)
        if what == FREE:
            continue
        most = max(pixels_along(slope), pixels_along(onto))
        if what == ON_SLOPE and walk.bodies[walk.shapes[by].body_row].kind != STATIC:
            most += (
                1  # feet stand on the pixel nearest to what moves: up to half a pixel in it before, and above it now
            )
        if what == ON_SLOPE and drop <= most:
            return drop, slope
        if what == BLOCKED and onto != 0.0 and drop <= pixels_along(onto):
            return drop, 0.0
        return 0, 0.0
    return 0, 0.0


@subkernel
def is_wedged(walk, me, rows, slope):
    """Whether a character on ground too steep cannot slide down it: something stands at the foot of the slope."""
    c = walk.characters[me]
    side = -1 if slope > 0.0 else 1
    what, by, rise = blocked_at(walk, me, rows, c.left + side, c.top, side, 0, 0.0)
    return what != FREE


@subkernel
def steep_below(walk, me, rows, slope):
    """The slope of the ground a character slides down, as far below as that falls on one pixel along; 0: none."""
    c = walk.characters[me]
    for drop in range(1, pixels_along(slope) + 1):
        what, by, found = blocked_at(walk, me, rows, c.left, c.top + drop, 0, drop, 0.0)
        if what != FREE:
            return found if what == STEEP else 0.0
    return 0.0


@subkernel
def slide_of(slope):
    """(pixels along x, pixels down) of a slide along a slope for each pixel of a way straight down."""
    length = math.sqrt(1.0 + slope * slope)
    sine = slope / length
    return -sine / length, sine * sine


@subkernel
def slide_gently(me, rows, pixels, slope, walk_inout):
    """Slide down ground that rises by less than it runs, for so many pixels of a way down, pixel by pixel along x.

    Returns whether nothing stopped it.
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
