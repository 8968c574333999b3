"""A character that something else moves: shifted pixel by pixel, as far as nothing keeps it."""

from physics.character.climb import drop_onto, way_aside
from physics.character.ground import FREE, GIVE
from physics.character.solids import blocked_at, gather
from physics.character.workspace import character_of, settle
from physics.jit import subkernel


@subkernel
def shift_aside(me, without, pixels, walk_inout, rows_out):
    """Move a character along x by up to so many pixels. Returns those that something kept it from moving."""
    c = walk_inout.characters[me]
    reach = 2.0 + abs(pixels)
    along_slope = c.climb * abs(pixels)
    gather(walk_inout, me, without, reach, reach + along_slope, reach + along_slope, rows_out)
    direction = 1 if pixels > 0 else -1
    for done in range(abs(pixels)):
        what, by, slope = blocked_at(walk_inout, me, rows_out, c.left + direction, c.top, direction, 0, GIVE)
        lift = 0
        if what != FREE:
            lift, by, slope = way_aside(walk_inout, me, rows_out, direction)
        if lift < 0:
            return abs(pixels) - done
        if lift == 0 and without < 0 and c.grounded:
            drop, onto = drop_onto(walk_inout, me, rows_out, c.left + direction, c.slope)
            c.top += drop
        c.left += direction
        c.top -= lift
    return 0


@subkernel
def shift_along_y(me, without, pixels, walk_inout, rows_out):
    """Move a character along y by up to so many pixels. Returns those that something kept it from moving."""
    c = walk_inout.characters[me]
    reach = 2.0 + abs(pixels)
    gather(walk_inout, me, without, 2.0, reach, reach, rows_out)
    direction = 1 if pixels > 0 else -1
    for done in range(abs(pixels)):
        what, by, slope = blocked_at(walk_inout, me, rows_out, c.left, c.top + direction, 0, direction, GIVE)
        if what != FREE:
            return abs(pixels) - done
        c.top += direction
    return 0


@subkernel
def shift(me, without, pixels, along_x, walk_inout, rows_out):
    """Move a character up to so many pixels along an axis, up and down the slopes it walks.

    without: body row that does not count, or -1; rows_out: room for the solids near. Returns the pixels that something
    kept it from moving.
    """
    if along_x == 1:
        stopped = shift_aside(me, without, pixels, walk_inout, rows_out)
    else:
        stopped = shift_along_y(me, without, pixels, walk_inout, rows_out)
    settle(me, walk_inout)
    return stopped


@subkernel
def carried_by(way, stopped):
    """The pixels of a way that were gone when some of them were not."""
    return way - stopped if way > 0 else way + stopped


@subkernel
def carry_riders(along_x, walk_inout):
    """Carry on to what stands on what was carried: the hero on a crate on a platform, whatever the pile's height."""
    characters = walk_inout.characters
    for _ in range(len(characters)):
        again = False
        for me in range(len(characters)):
            c = characters[me]
            under = character_of(characters, c.riding) if c.riding >= 0 and c.carried == 0 else -1
            if under < 0 or characters[under].carried == 0 or walk_inout.bodies[c.body_row].quarantined:
                continue
            u = characters[under]
            stopped = shift(me, u.body_row, u.carried, along_x, walk_inout, walk_inout.found)
            c.carried = carried_by(u.carried, stopped)
            if stopped > 0 and along_x == 0 and u.carried < 0:
                c.squeezed = True
            again = again or c.carried != 0
        if not again:
            return
