"""Carrying and pushing of characters by moving solids: characters on a solid move with it, others are pushed aside."""

import math

import numpy as np

from physics.character.solids import (
    FEET,
    FREE,
    GIVE,
    aabb_of,
    blocked_at,
    character_of,
    find_own_rows,
    gather,
    in_shape,
    is_box,
    is_loose,
    is_walkable,
    meet_hull,
    place_body,
    place_outline,
    settle,
    walk_for,
)
from physics.character.walk import (
    depth_in,
    drop_onto,
    foot_of,
    is_crushed,
    press,
    way_aside,
    whole_pixels,
    write_weight,
)
from physics.collision.hulls import ALL_EDGES
from physics.islands.sleep import disturb
from physics.jit import kernel, subkernel
from physics.math2d import rotate
from physics.shapes.placement import PLACED, aabb_at, box_corners, refresh_aabbs, round_half_up
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.shape import PIXELS
from physics.tables.step_state import StepState, stage
from physics.tables.table import row_of, rows_of

# ---- near ------------------------------------------------------------------------------------------------------------
# The shapes that may carry, push or stop each character in a step: shapes near characters whose surroundings moved.


@subkernel
def motion_of(b):
    """Return an upper bound of the distance [px] by which any point of a body moved in this step. b: BODY row."""
    turn = abs(b.angle - b.previous_angle) * (b.extent + abs(b.local_center_x) + abs(b.local_center_y))
    return abs(b.x - b.previous_x) + abs(b.y - b.previous_y) + turn


@kernel
def find_stirred(bodies, shapes, characters, pairs, count, stirred_out):
    """Flag the characters that this step may move. Return the greatest motion [px] of the bodies that may move them.

    A character is flagged if it stands on a moving body or a conveyor, or if it is paired with a body that is not
    static. bodies, shapes, characters: BODY, SHAPE and CHARACTER tables; pairs: (count, 2) candidate pairs as SHAPE row
    numbers; stirred_out: (characters,) bool, the flags. O(pairs · log characters).
    """
    most = 0.0
    for me in range(len(characters)):
        c = characters[me]
        stirred_out[me] = c.riding >= 0 or c.belt != 0.0
        row = row_of(bodies, c.riding) if c.riding >= 0 else -1
        if row >= 0:
            most = max(most, motion_of(bodies[row]))
    for k in range(count):
        for side in range(2):
            me = character_of(characters, shapes[pairs[k, side]].body)
            b = bodies[shapes[pairs[k, 1 - side]].body_row]
            if me >= 0 and b.kind != STATIC:
                stirred_out[me] = True
                most = max(most, motion_of(b))
    return most


def near_characters(state: StepState) -> tuple[np.ndarray, np.ndarray]:
    """Find the shapes that may carry, push or stop each character in this step. Return (near, spans) for a Walk.

    near: SHAPE row numbers, first those for the first character, and so on; spans: (characters, 2) first index in
    `near` and number of rows for each character.
    """
    rows, pairs = state.characters, state.pairs.rows
    dirty = np.zeros(len(rows), bool)
    motion = find_stirred(state.bodies, state.shapes, rows, pairs, len(pairs), dirty)
    near, spans, start = [], np.zeros((len(rows), 2), np.int64), 0
    for me in np.flatnonzero(dirty).tolist():
        if not near:
            state.queries.begin(state)
        row = rows[me]
        # The reach: the greatest motion of any body, or of a push-out, and the rise of a slope over this distance.
        reach = 2.0 * motion + abs(float(row["belt"])) * state.dt + 8.0
        climb = reach * float(row["climb"])
        left, top = float(row["left"]), float(row["top"])
        right, bottom = left + float(row["width"]), top + float(row["height"])
        found = state.queries.rows_in(
            state, (left - reach, top - reach - climb), (right + reach, bottom + reach + climb)
        )
        near.append(found)
        spans[me] = start, len(found)
        start += len(found)
    return np.concatenate(near) if near else np.zeros(0, np.int64), spans


# ---- shift -----------------------------------------------------------------------------------------------------------
# A character that a solid moves is shifted pixel by pixel, until it is blocked.


@subkernel
def shift_aside(me, without, pixels, walk_inout, rows_out):
    """Move a character along x by up to `pixels` (negative: left). Return the number of pixels that were blocked.

    The character also moves up and down walkable slopes. me: row number of the character; without: row number of a body
    to ignore, or -1; walk_inout: see solids.Walk; rows_out: scratch array for the nearby solids.
    """
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
    """Move a character along y by up to `pixels` (negative: up). Return the number of pixels that were blocked.

    me: row number of the character; without: row number of a body to ignore, or -1; walk_inout: see solids.Walk;
    rows_out: scratch array for the nearby solids.
    """
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
    """Move a character and its body by up to `pixels` along one axis. Return the number of pixels that were blocked.

    along_x: 1 for the x axis, 0 for the y axis. On the x axis the character also moves up and down walkable slopes. me:
    row number of the character; without: row number of a body to ignore, or -1; walk_inout: see solids.Walk; rows_out:
    scratch array for the nearby solids.
    """
    if along_x == 1:
        stopped = shift_aside(me, without, pixels, walk_inout, rows_out)
    else:
        stopped = shift_along_y(me, without, pixels, walk_inout, rows_out)
    settle(me, walk_inout)
    return stopped


@subkernel
def carried_by(way, stopped):
    """Return the signed number of pixels by which a character was moved.

    way: intended motion [px], with a sign; stopped: number of pixels that were blocked.
    """
    return way - stopped if way > 0 else way + stopped


@subkernel
def carry_riders(along_x, walk_inout):
    """Move the characters that stand on characters which have been moved, by the same number of pixels.

    In a stack of characters, the lower ones are moved first. along_x: 1 for the x axis, 0 for the y axis; walk_inout:
    see solids.Walk.
    """
    characters = walk_inout.characters
    for _ in range(len(characters)):
        repeated = False
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
            repeated = repeated or c.carried != 0
        if not repeated:
            return


# ---- ride ------------------------------------------------------------------------------------------------------------
# Characters on bodies that rotate, are dynamic or are not boxes: the point under the feet carries them, and bodies that
# moved into them push them out.


@subkernel
def loose_under(walk, me):
    """Return the SHAPE row number of the loose shape (see solids.is_loose) on which a character stands, or -1.

    A loose shape carries the character by the motion of the shape's point under the feet. walk: see solids.Walk; me:
    row number of the character.
    """
    c = walk.characters[me]
    row = row_of(walk.shapes, c.riding_shape) if c.riding >= 0 else -1
    if row < 0 or walk.shapes[row].sensor or not is_loose(walk, row):
        return -1
    kind = walk.bodies[walk.shapes[row].body_row].kind
    return -1 if kind == DYNAMIC and walk.settings.stacking == 0 else row


@kernel
def note_feet(shapes, characters_inout):
    """Store the point [px] under the feet of each character that stands on a moving body, before the body moves it.

    O(characters · log shapes). shapes: SHAPE table; characters_inout: CHARACTER table.
    """
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        row = row_of(shapes, c.riding_shape) if c.riding >= 0 else -1
        if row >= 0:
            c.foot_x, c.foot_y = foot_of(c, shapes[row])


@kernel
def take_back(characters_inout, bodies_inout):
    """Move the bodies of all characters back to the characters' pixel boxes, because the step has moved the bodies.

    O(characters). characters_inout: CHARACTER table, whose push velocities are set to 0; bodies_inout: BODY table.
    """
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        if not bodies_inout[c.body_row].quarantined:
            place_body(c, bodies_inout[c.body_row])
        c.push_vx, c.push_vy = 0.0, 0.0


@subkernel
def motion_under(c, body):
    """Return the displacement (x, y) [px] in this step of the point of a body that was under a character's feet.

    c: CHARACTER row; body: BODY row of the body on which the character stands.
    """
    u, v = rotate(
        c.foot_x - body.previous_x,
        c.foot_y - body.previous_y,
        math.cos(body.angle - body.previous_angle),
        math.sin(body.angle - body.previous_angle),
    )
    return body.x + u - c.foot_x, body.y + v - c.foot_y


@subkernel
def pixels_carried(me, row, along_x, walk_inout):
    """Return by how many whole pixels the ground and its conveyor carry a character along an axis in this step.

    Fractions of a pixel are stored for the next step. me: row number of the character; row: SHAPE row number of the
    ground, -1 if its motion does not carry the character; along_x: 1 for the x axis, 0 for the y axis; walk_inout: see
    solids.Walk.
    """
    c = walk_inout.characters[me]
    way = 0
    if row < 0:
        c.carry_x, c.carry_y = 0.0, 0.0
    else:
        # The axes are processed one after the other; the motion of the point is the same for both.
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
    """Move a character down to walkable ground just below it, at most as far as ground can drop over 1 px of walking.

    me: row number of the character; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    gather(walk_inout, me, -1, 1.0, 1.0, 3.0 + c.climb, walk_inout.found)
    drop, slope = drop_onto(walk_inout, me, walk_inout.found, c.left, 0.5)
    if drop > 0:
        c.top += drop
        settle(me, walk_inout)


@subkernel
def ride_bodies(walk_inout):
    """Carry characters by the motion of the loose shapes and conveyors under their feet, in whole pixels.

    Then move the characters down onto ground that rotated or was pushed down. The remainders below one pixel are stored
    for the next step. O(characters · nearby solids). walk_inout: see solids.Walk.
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
    """Move a character out of a loose shape (see solids.is_loose), as far as it is free, and store the remaining depth.

    me: row number of the character; row: SHAPE row number of the loose shape; walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    depth, nx, ny = depth_in(me, row, walk_inout)
    body_row = walk_inout.shapes[row].body_row
    along_x = 1 if abs(nx) > abs(ny) and not is_walkable(c, nx, ny) else 0
    into = nx if along_x == 1 else ny
    speed = walk_inout.bodies[body_row].vx
    if along_x == 1 and depth > 0.5 * walk_inout.settings.slop and speed * into < 0.0:
        c.push_vx = speed  # a body that presses against the character need not stop, because the character moves along
    too_deep = depth - 1.5 * FEET
    if along_x == 0 and abs(nx) > ny > 0.0:
        too_deep /= ny  # the way up out of a walkable slope steeper than 45 degrees
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
    """Move characters out of loose shapes (see solids.is_loose) that moved into them, or mark them as squeezed.

    A character is squeezed if the overlap was deeper than GIVE and is at least as deep one step later. The second
    condition excludes bodies that have just fallen onto a character: they overlap it until the solver has separated the
    two. O(characters · nearby solids). walk_inout: see solids.Walk.
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


# ---- carry -----------------------------------------------------------------------------------------------------------
# Moving solids carry the characters that ride them and push the characters in front of them, one axis after the other.
#
# A character without space is squeezed: it stays overlapped, and its next `move` reports that. Source: Thorson, Celeste
# and TowerFall Physics, 2018.


@subkernel
def swept_box(walk, row, along_x):
    """Return the area that a box sweeps along one axis in this step, as (left, top, right, bottom, pixels moved).

    All values are whole pixels, and pixels moved has a sign. The box moves along x first, then along y. walk: see
    solids.Walk; row: SHAPE row number of the box; along_x: 1 for the x axis, 0 for the y axis.
    """
    b = walk.bodies[walk.shapes[row].body_row]
    old_left, old_top, old_right, old_bottom = aabb_at(
        walk.geometry, walk.shapes, row, b.previous_x, b.previous_y, b.previous_angle
    )
    left, top, right, bottom = aabb_of(walk, row)
    if along_x == 1:
        return (
            round_half_up(min(left, old_left)),
            round_half_up(old_top),
            round_half_up(max(right, old_right)),
            round_half_up(old_bottom),
            round_half_up(left) - round_half_up(old_left),
        )
    return (
        round_half_up(left),
        round_half_up(min(top, old_top)),
        round_half_up(right),
        round_half_up(max(bottom, old_bottom)),
        round_half_up(top) - round_half_up(old_top),
    )


@subkernel
def in_swept(me, row, shifted, along_x, box, walk_inout):
    """Return whether a character, moved by `shifted` pixels along an axis, would overlap the area that a solid sweeps.

    A tile grid is tested at its pose after the motion along this axis. me: row number of the character; row: SHAPE row
    number of the solid; along_x: 1 for the x axis, 0 for the y axis; box: result of swept_box for the solid;
    walk_inout: see solids.Walk.
    """
    c = walk_inout.characters[me]
    left, top, right, bottom, moved = box
    at_x, at_y = c.left + shifted * along_x, c.top + shifted * (1 - along_x)
    if not (at_x < right and left < at_x + c.width and at_y < bottom and top < at_y + c.height):
        return False
    if is_box(walk_inout, row):
        if c.is_box:
            return True
        count, radius = place_outline(walk_inout, me, at_x, at_y)
        box_corners(left, top, right, bottom, walk_inout.scratch.theirs)
        depth, nx, ny, x, y = meet_hull(walk_inout.scratch, count, radius, 4, 0.0, ALL_EDGES, math.inf)
        return depth > walk_inout.settings.slop
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    now = b.y
    if along_x == 1:
        b.y = b.previous_y  # the motion along x comes first
    what, slope = in_shape(walk_inout, me, row, at_x, at_y, 0, 0, 0.0)
    b.y = now
    return what != FREE


@subkernel
def way_clear(me, row, along_x, box, walk_inout):
    """Return the displacement [px] along a solid's motion that moves a character out of the area the solid sweeps.

    It is a signed whole number, and 0 if the character does not overlap this area. For the arguments see in_swept.
    """
    if not in_swept(me, row, 0, along_x, box, walk_inout):
        return 0
    left, top, right, bottom, moved = box
    c = walk_inout.characters[me]
    if along_x == 1:
        most = right - c.left if moved > 0 else left - (c.left + c.width)
    else:
        most = bottom - c.top if moved > 0 else top - (c.top + c.height)
    if c.is_box and is_box(walk_inout, row):
        return most
    direction = 1 if moved > 0 else -1
    for pixels in range(1, abs(most)):
        if not in_swept(me, row, pixels * direction, along_x, box, walk_inout):
            return pixels * direction
    return most


@subkernel
def carry_one(me, row, along_x, box, walk_inout):
    """Carry or push one character by a solid that moved by whole pixels along an axis. Arguments: see in_swept."""
    c = walk_inout.characters[me]
    s = walk_inout.shapes[row]
    b = walk_inout.bodies[s.body_row]
    c.carried = 0
    if walk_inout.bodies[c.body_row].quarantined:
        return
    way = box[4] if c.riding == s.body else way_clear(me, row, along_x, box, walk_inout)
    if way == 0:
        return
    if along_x == 1:
        c.push_vx = b.vx
    else:
        c.push_vy = b.vy
    stopped = shift(me, s.body_row, way, along_x, walk_inout, walk_inout.found)
    c.carried = carried_by(way, stopped)
    # A stopped rider slides; it is squeezed only if the solid now overlaps it.
    if stopped > 0 and in_swept(me, row, 0, along_x, box, walk_inout):
        c.squeezed = True


@subkernel
def carry_and_push(movers, walk_inout):
    """Carry the characters on kinematic solids that moved by whole pixels, and push the characters in front of them.

    Only axis-aligned boxes and tile grids are handled here; other shapes are handled by ride_bodies and give_way.
    movers: ascending SHAPE row numbers; walk_inout: see solids.Walk. O(moved solids · characters).
    """
    for k in range(len(movers)):
        row = movers[k]
        s = walk_inout.shapes[row]
        b = walk_inout.bodies[s.body_row]
        if b.kind != KINEMATIC or s.sensor or b.quarantined or s.role == PIXELS:
            continue
        if character_of(walk_inout.characters, s.body) >= 0 or is_loose(walk_inout, row):
            continue
        for axis in range(2):
            along_x = 1 - axis
            box = swept_box(walk_inout, row, along_x)
            if box[4] == 0:
                continue
            for me in range(len(walk_inout.characters)):
                carry_one(me, row, along_x, box, walk_inout)
            carry_riders(along_x, walk_inout)


@kernel
def carry_all(movers, walk_inout):
    """Carry and push all characters by the motion of solids in this step.

    movers: ascending SHAPE row numbers of the solids; walk_inout: see solids.Walk.
    """
    carry_and_push(movers, walk_inout)
    ride_bodies(walk_inout)
    give_way(walk_inout)


@stage(
    "carry",
    reads=(
        "effects", "tolerances", "gravity", "dt", "steps", "broadphase", "bodies", "shapes", "characters", "library",
        "pairs", "contact_rows", "awake", "queries", "workspace",
    ),
    writes=(
        "characters", "contact_rows",
        "awake",  # its array for the shapes that moved
        "pairs", "broadphase", "library", "queries", "work", "workspace",
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y", "force_x", "force_y", "torque")), *PLACED,
    ),
)  # fmt: skip
def carry_characters(state: StepState) -> None:
    """Move the characters that are carried or pushed by moving solids.

    The candidate pairs of moved characters are updated, so that their contacts are found in the same step.
    """
    characters = state.characters
    bodies, shapes = state.bodies, state.shapes
    find_own_rows(bodies, shapes, characters)
    own = characters["body_row"]
    before = bodies[own][["x", "y"]]
    if state.effects.stacking:
        if state.effects.gravity and state.dt > 0.0:
            write_weight(characters, state.dt * math.hypot(*state.gravity), state.contact_rows)
        take_back(characters, bodies)
    else:
        note_feet(shapes, characters)
    near, spans = near_characters(state)
    carry_all(np.unique(near), walk_for(state, characters, near, spans, state.dt))
    moved = own[before != bodies[own][["x", "y"]]]
    if len(moved):
        rows = np.flatnonzero(np.isin(shapes["body_row"], moved))
        refresh_aabbs(rows, state.library.tables, bodies, shapes)
        widened = state.pairs.widen(shapes[rows], state.tolerances.slop)
        state.pairs.update(state.broadphase, shapes, widened, state.work)


@stage(
    "weigh",
    reads=(
        "effects", "tolerances", "gravity", "bodies", "shapes", "characters", "contact_rows", "joints", "awake",
        "sleeping_set", "pairs", "touching_pairs", "sensing_pairs",
    ),
    writes=(
        "characters", "contact_rows", "awake", "sleeping_set", "pairs", "touching_pairs", "sensing_pairs",
        *(f"bodies.{name}" for name in ("awake", "active", "sleep_time", "island", "vx", "vy")),
        *(f"bodies.{name}" for name in ("force_x", "force_y", "torque")),
    ),
)  # fmt: skip
def apply_character_weight(state: StepState) -> None:
    """Apply the weight of characters to the bodies on which they stand, before the step.

    A sleeping body is woken if a character has stepped onto it, left it or walked on it.
    """
    characters, bodies = state.characters, state.bodies
    if state.effects.sleeping:
        own = bodies[characters["body_row"]]
        new = characters["riding"] != characters["pressed"]
        dirty = new | (own["x"] != own["previous_x"]) | (own["y"] != own["previous_y"])
        ids = np.union1d(characters["riding"][dirty], characters["pressed"][new])
        rows = rows_of(bodies, ids)
        disturb(state, ids[(rows >= 0) & (bodies["kind"][rows] == DYNAMIC)])
    characters["pressed"] = characters["riding"]
    gravity = state.gravity if state.effects.gravity else (0.0, 0.0)
    press(state.shapes, *gravity, state.tolerances.sleep_speed, characters, bodies)
