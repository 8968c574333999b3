"""Characters on what turns, is pushed or is no box: carried by the point under the feet, moved out of what came in."""

import math

from physics.character.climb import drop_onto
from physics.character.crush import depth_in, is_crushed
from physics.character.ground import FEET, GIVE, is_walkable
from physics.character.push import foot_of
from physics.character.shift import carried_by, carry_riders, shift
from physics.character.solids import gather, is_loose
from physics.character.walk import whole_pixels
from physics.character.workspace import place_body, settle
from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.tables.body import DYNAMIC
from physics.tables.rows import row_of


@subkernel
def loose_under(walk, me):
    """The shape row that carries a character by the motion of the point under its feet, or -1."""
    c = walk.characters[me]
    row = row_of(walk.shapes, c.riding_shape) if c.riding >= 0 else -1
    if row < 0 or walk.shapes[row].sensor or not is_loose(walk, row):
        return -1
    kind = walk.bodies[walk.shapes[row].body_row].kind
    return -1 if kind == DYNAMIC and walk.settings.stacking == 0 else row


@kernel
def note_feet(shapes, characters_inout):
    """Remember the point under the feet of those that ride: where it is before the step. O(characters · log shapes)."""
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        row = row_of(shapes, c.riding_shape) if c.riding >= 0 else -1
        if row >= 0:
            c.foot_x, c.foot_y = foot_of(c, shapes[row])


@kernel
def take_back(characters_inout, bodies_inout):
    """Put the bodies of characters, which the solver has moved along, back where their boxes are. O(characters)."""
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        if not bodies_inout[c.body_row].quarantined:
            place_body(c, bodies_inout[c.body_row])
        c.push_vx = 0.0
        c.push_vy = 0.0


@subkernel
def motion_under(c, body):
    """How far [px] the point under a character's feet was moved by the body it stands on."""
    u, v = turned(
        c.foot_x - body.previous_x,
        c.foot_y - body.previous_y,
        math.cos(body.angle - body.previous_angle),
        math.sin(body.angle - body.previous_angle),
    )
    return body.x + u - c.foot_x, body.y + v - c.foot_y


@subkernel
def pixels_carried(me, row, along_x, walk_inout):
    """Whole pixels that a character is carried along an axis by what is under it (shape row or -1) and by its belt."""
    c = walk_inout.characters[me]
    way = 0
    if row < 0:
        c.carry_x = 0.0
        c.carry_y = 0.0
    else:
        # x is carried first; the point's motion is the same for both axes.
        x, y = motion_under(c, walk_inout.bodies[walk_inout.shapes[row].body_row])
        if along_x == 1:
            c.carry_x += x
            way = whole_pixels(c.carry_x)
            c.carry_x -= way
        else:
            c.carry_y += y
            way = whole_pixels(c.carry_y)
            c.carry_y -= way
    if walk_inout.settings.conveyor == 1 and along_x == 1:
        c.belt_x = c.belt_x + c.belt * walk_inout.settings.dt if c.belt != 0.0 else 0.0
        run = whole_pixels(c.belt_x)
        c.belt_x -= run
        way += run
    return way


@subkernel
def step_down(me, walk_inout):
    """Down to a ground that has gone down by less than it may fall on a pixel along."""
    c = walk_inout.characters[me]
    gather(walk_inout, me, -1, 1.0, 1.0, 3.0 + c.climb, walk_inout.found)
    drop, slope = drop_onto(walk_inout, me, walk_inout.found, c.left, 0.5)
    if drop > 0:
        c.top += drop
        settle(me, walk_inout)


@subkernel
def ride_bodies(walk_inout):
    """Carry characters by what the point under their feet was moved by, in whole pixels with the remainder kept.

    walk_inout: a Walk for the step. They step down to where what turns or is pushed went. O(characters · solids near).
    """
    for axis in range(2):
        along_x = 1 - axis
        for me in range(len(walk_inout.characters)):
            c = walk_inout.characters[me]
            c.carried = 0
            if walk_inout.bodies[c.body_row].quarantined:
                continue
            row = loose_under(walk_inout, me)
            way = pixels_carried(me, row, along_x, walk_inout)
            if way != 0:
                without = walk_inout.shapes[row].body_row if row >= 0 else -1
                stopped = shift(me, without, way, along_x, walk_inout, walk_inout.found)
                c.carried = carried_by(way, stopped)
        carry_riders(along_x, walk_inout)
    for me in range(len(walk_inout.characters)):
        if loose_under(walk_inout, me) >= 0 and not walk_inout.bodies[walk_inout.characters[me].body_row].quarantined:
            step_down(me, walk_inout)


@subkernel
def move_out(me, row, walk_inout):
    """Move a character out of one loose shape, as far as nothing keeps it, and note how deep it stays."""
    c = walk_inout.characters[me]
    depth, nx, ny = depth_in(me, row, walk_inout)
    body_row = walk_inout.shapes[row].body_row
    along_x = 1 if abs(nx) > abs(ny) and not is_walkable(c, nx, ny) else 0
    into = nx if along_x == 1 else ny
    speed = walk_inout.bodies[body_row].vx
    if along_x == 1 and depth > 0.5 * walk_inout.settings.slop and speed * into < 0.0:
        c.push_vx = speed  # what is pressed against it need not stop: it goes along
    too_deep = depth - 1.5 * FEET
    if along_x == 0 and abs(nx) > ny > 0.0:
        too_deep /= ny  # up a slope steeper than 45 degrees, which he walks
    pixels = math.ceil(too_deep)
    if pixels <= 0:
        return
    way = -pixels if into > 0.0 else pixels
    stopped = shift(me, body_row, way, along_x, walk_inout, walk_inout.found_beside)
    if stopped > 0 and along_x == 1:
        c.push_vx = 0.0
    depth, nx, ny = depth_in(me, row, walk_inout)
    c.deep = max(c.deep, depth)
    c.wedged = c.wedged or (depth > GIVE and ny > abs(nx))


@subkernel
def give_way(walk_inout):
    """Move characters out of the loose bodies that came into them; squeezed are those in which something stays.

    walk_inout: a Walk for the step. What has just fallen into one is deep for a moment, until the solver has pushed it
    out: it squeezes when it is no less deep after that. O(characters · solids near).
    """
    for me in range(len(walk_inout.characters)):
        c = walk_inout.characters[me]
        c.wedged = False
        before = c.deep
        c.deep = 0.0
        if walk_inout.bodies[c.body_row].quarantined:
            continue
        gather(walk_inout, me, -1, 0.0, 0.0, 0.0, walk_inout.found)
        for k in range(1, walk_inout.found[0] + 1):
            if walk_inout.found[k] < 0:
                move_out(me, -1 - walk_inout.found[k], walk_inout)
        if (before > GIVE and c.deep >= before) or is_crushed(me, False, walk_inout):
            c.squeezed = True
