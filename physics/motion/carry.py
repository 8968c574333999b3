"""Moving solids carry the characters that ride them and push those in their way, one axis after the other.

A character that cannot give way is squeezed: it stays, overlapping, and its next `move` says so. Source: Thorson,
Celeste and TowerFall Physics, 2018.
"""

import numpy as np

from physics.jit import kernel, subkernel
from physics.motion.solids import FREE, blocked_at, character_of, gather_solids, round_half_up
from physics.motion.walk import settle
from physics.narrowphase.contacts import new_scratch
from physics.narrowphase.placement import aabb_at, refresh_aabbs
from physics.tables import BOUNDS, KINEMATIC, POLYGON


@subkernel
def shift(geometry, shapes, me, without, pixels, along_x, slop, scratch, rows, characters_inout, bodies_inout):
    """Move a character up to `pixels` along an axis. Returns the pixels that something kept it from moving."""
    c = characters_inout[me]
    direction = 1 if pixels > 0 else -1
    reach = float(abs(pixels) + 2)
    count = gather_solids(geometry, bodies_inout, shapes, characters_inout, me, without, c.left - reach, c.top - reach,
                          c.left + c.width + reach, c.top + c.height + reach, rows)
    for done in range(abs(pixels)):
        left = c.left + direction * along_x
        top = c.top + direction * (1 - along_x)
        falling = 1 if along_x == 0 and direction > 0 else 0
        what, by = blocked_at(geometry, bodies_inout, shapes, characters_inout, rows, count, left, top, c.width, c.height,
                              falling, slop, scratch)
        if what != FREE:
            settle(me, characters_inout, bodies_inout)
            return abs(pixels) - done
        c.left = left
        c.top = top
    settle(me, characters_inout, bodies_inout)
    return 0


@subkernel
def carry_riders(geometry, shapes, along_x, slop, scratch, rows, characters_inout, bodies_inout):
    """Carry on to what stands on what was carried: the hero on a crate on a platform, whatever the height of the pile."""
    for level in range(len(characters_inout)):
        again = False
        for me in range(len(characters_inout)):
            c = characters_inout[me]
            if c.riding < 0 or c.carried != 0:
                continue
            for under in range(len(characters_inout)):
                u = characters_inout[under]
                if u.body == c.riding and u.carried != 0:
                    stopped = shift(geometry, shapes, me, u.body_row, u.carried, along_x, slop, scratch, rows,
                                    characters_inout, bodies_inout)
                    c.carried = u.carried - stopped if u.carried > 0 else u.carried + stopped
                    if stopped > 0 and along_x == 0 and u.carried < 0:
                        c.squeezed = True
                    again = again or c.carried != 0
        if not again:
            return


@kernel
def carry_and_push(
    # read
    geometry, shapes, slop,
    # write
    scratch, rows_out, characters_inout, bodies_inout,
):
    """Let every upright kinematic box that moved by whole pixels carry its riders and push what it ran into.

    characters_inout CHARACTER, bodies_inout BODY rows; rows_out (shapes): scratch. O(moved solids · characters).
    """
    for row in range(len(shapes)):
        s = shapes[row]
        b = bodies_inout[s.body_row]
        if b.kind != KINEMATIC or s.sensor or (s.kind != POLYGON and s.kind != BOUNDS):
            continue
        if character_of(characters_inout, s.body_row) >= 0:
            continue
        old_left, old_top, old_right, old_bottom = aabb_at(geometry, shapes, row, b.previous_x, b.previous_y, b.previous_angle)
        left, top, right, bottom = aabb_at(geometry, shapes, row, b.x, b.y, b.angle)
        for axis in range(2):
            along_x = 1 - axis
            if along_x == 1:
                moved = round_half_up(left) - round_half_up(old_left)
            else:
                moved = round_half_up(top) - round_half_up(old_top)
            if moved == 0:
                continue
            # All that the box swept along this axis; x has moved first.
            box_left = round_half_up(min(left, old_left)) if along_x == 1 else round_half_up(left)
            box_right = round_half_up(max(right, old_right)) if along_x == 1 else round_half_up(right)
            box_top = round_half_up(old_top) if along_x == 1 else round_half_up(min(top, old_top))
            box_bottom = round_half_up(old_bottom) if along_x == 1 else round_half_up(max(bottom, old_bottom))
            for me in range(len(characters_inout)):
                c = characters_inout[me]
                c.carried = 0
                way = 0
                if c.riding == s.body:
                    way = moved
                elif (c.left < box_right and box_left < c.left + c.width and c.top < box_bottom
                      and box_top < c.top + c.height):
                    if along_x == 1:
                        way = box_right - c.left if moved > 0 else box_left - (c.left + c.width)
                    else:
                        way = box_bottom - c.top if moved > 0 else box_top - (c.top + c.height)
                if way == 0:
                    continue
                stopped = shift(geometry, shapes, me, s.body_row, way, along_x, slop, scratch, rows_out, characters_inout,
                                bodies_inout)
                c.carried = way - stopped if way > 0 else way + stopped
                # A rider that is stopped slides; it is squeezed where the box now stands in it.
                if stopped > 0 and (c.left < box_right and box_left < c.left + c.width and c.top < box_bottom
                                    and box_top < c.top + c.height):
                    c.squeezed = True
            carry_riders(geometry, shapes, along_x, slop, scratch, rows_out, characters_inout, bodies_inout)


def carry_characters(world):
    """The stage: does nothing in a world without characters. Those that were moved meet others in this very step."""
    characters = world.characters.rows
    if not len(characters):
        return
    world.refresh_character_rows()
    before = world.bodies[characters["body_row"]][["x", "y"]]
    carry_and_push(world.library.tables, world.shapes, world.tolerances.slop, world.walk_scratch,
                   world.scratch_rows(len(world.shapes)), characters, world.bodies)
    moved = characters["body"][before != world.bodies[characters["body_row"]][["x", "y"]]]
    if len(moved):
        refresh_aabbs(world.library.tables, world.bodies, world.shapes)
        own = world.shapes[np.isin(world.shapes["body"], moved)]
        world.pairs.widen(own, world.tolerances.slop)
        world.pairs.update(world.broadphase, world.shapes, len(own), world.profile.work)


def walk_room():
    """Room for the walks of one world."""
    return new_scratch(), np.zeros(4, np.int64)
