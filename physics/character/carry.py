"""Moving solids carry the characters that ride them and push those in their way, one axis after the other.

A character that cannot give way is squeezed: it stays, overlapping, and its next `move` says so. Source: Thorson,
Celeste and TowerFall Physics, 2018.
"""

import math

import numpy as np

from physics.character.push import press, tell_weight
from physics.character.solids import FEET, FREE, blocked_at, character_of, gather_solids, is_loose, meet, round_half_up
from physics.character.walk import settle, whole_pixels
from physics.dynamics.sleep import disturb
from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.shapes.placement import aabb_at, refresh_aabbs
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.rows import rows_of
from physics.tables.shape import BOUNDS, POLYGON
from physics.tables.step_state import stage

GIVE = 2.0  # [px] what is carried or pressed may sink this deep into loose bodies: the solver moves them on


@subkernel
def shift(geometry, shapes, me, without, pixels, along_x, piles, slop, scratch, rows, characters_inout, bodies_inout):
    """Move a character up to `pixels` along an axis. Returns the pixels that something kept it from moving."""
    c = characters_inout[me]
    direction = 1 if pixels > 0 else -1
    reach = float(abs(pixels) + 2)
    count = gather_solids(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        me,
        without,
        piles,
        c.left - reach,
        c.top - reach,
        c.left + c.width + reach,
        c.top + c.height + reach,
        rows,
    )
    way_x = direction * along_x
    way_y = direction * (1 - along_x)
    for done in range(abs(pixels)):
        left = c.left + way_x
        top = c.top + way_y
        falling = 1 if along_x == 0 and direction > 0 else 0
        what, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            left,
            top,
            c.width,
            c.height,
            way_x,
            way_y,
            falling,
            GIVE,
            slop,
            scratch,
        )
        if what != FREE:
            settle(me, characters_inout, bodies_inout)
            return abs(pixels) - done
        c.left = left
        c.top = top
    settle(me, characters_inout, bodies_inout)
    return 0


@subkernel
def carry_riders(geometry, shapes, along_x, piles, slop, scratch, rows, characters_inout, bodies_inout):
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
                    stopped = shift(
                        geometry,
                        shapes,
                        me,
                        u.body_row,
                        u.carried,
                        along_x,
                        piles,
                        slop,
                        scratch,
                        rows,
                        characters_inout,
                        bodies_inout,
                    )
                    c.carried = u.carried - stopped if u.carried > 0 else u.carried + stopped
                    if stopped > 0 and along_x == 0 and u.carried < 0:
                        c.squeezed = True
                    again = again or c.carried != 0
        if not again:
            return


@kernel
def carry_and_push(
    # read
    geometry,
    shapes,
    piles,
    slop,
    # write
    scratch,
    rows_out,
    characters_inout,
    bodies_inout,
):
    """Let every upright kinematic box that moved by whole pixels carry its riders and push what it ran into.

    piles: 1 in a world that stacks: what turns there is left to ride_bodies. characters_inout CHARACTER, bodies_inout BODY rows; rows_out (shapes): scratch. O(moved solids · characters).
    """
    for row in range(len(shapes)):
        s = shapes[row]
        b = bodies_inout[s.body_row]
        if b.kind != KINEMATIC or s.sensor or (s.kind != POLYGON and s.kind != BOUNDS):
            continue
        if character_of(characters_inout, s.body_row) >= 0 or (piles == 1 and is_loose(bodies_inout, shapes, row)):
            continue
        old_left, old_top, old_right, old_bottom = aabb_at(
            geometry, shapes, row, b.previous_x, b.previous_y, b.previous_angle
        )
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
                elif (
                    c.left < box_right
                    and box_left < c.left + c.width
                    and c.top < box_bottom
                    and box_top < c.top + c.height
                ):
                    if along_x == 1:
                        way = box_right - c.left if moved > 0 else box_left - (c.left + c.width)
                    else:
                        way = box_bottom - c.top if moved > 0 else box_top - (c.top + c.height)
                if way == 0:
                    continue
                if along_x == 1:
                    c.push_vx = b.vx
                else:
                    c.push_vy = b.vy
                stopped = shift(
                    geometry,
                    shapes,
                    me,
                    s.body_row,
                    way,
                    along_x,
                    piles,
                    slop,
                    scratch,
                    rows_out,
                    characters_inout,
                    bodies_inout,
                )
                c.carried = way - stopped if way > 0 else way + stopped
                # A rider that is stopped slides; it is squeezed where the box now stands in it.
                if stopped > 0 and (
                    c.left < box_right
                    and box_left < c.left + c.width
                    and c.top < box_bottom
                    and box_top < c.top + c.height
                ):
                    c.squeezed = True
            carry_riders(geometry, shapes, along_x, piles, slop, scratch, rows_out, characters_inout, bodies_inout)


@subkernel
def row_of(bodies, identity):
    """The BODY row of an id, or -1. O(log bodies)."""
    low = 0
    high = len(bodies)
    while low < high:
        middle = (low + high) // 2
        if bodies[middle].id < identity:
            low = middle + 1
        else:
            high = middle
    return low if low < len(bodies) and bodies[low].id == identity else -1


@subkernel
def ridden_freely(bodies, shapes, body_row):
    """Whether a body carries by the motion of the point under the feet, and not by whole pixels of its box."""
    for row in range(len(shapes)):
        if shapes[row].body_row == body_row and not shapes[row].sensor:
            return is_loose(bodies, shapes, row)
    return False


@subkernel
def step_down(geometry, shapes, me, slop, scratch, rows, characters_inout, bodies_inout):
    """Down one pixel to a ground that is one pixel away."""
    c = characters_inout[me]
    count = gather_solids(
        geometry,
        bodies_inout,
        shapes,
        characters_inout,
        me,
        -1,
        1,
        c.left - 1.0,
        c.top - 1.0,
        c.left + c.width + 1.0,
        c.top + c.height + 3.0,
        rows,
    )
    near, by = blocked_at(
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
        1,
        0.0,
        slop,
        scratch,
    )
    if near == FREE:
        below, by = blocked_at(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            rows,
            count,
            c.left,
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
        if below != FREE:
            c.top += 1
            settle(me, characters_inout, bodies_inout)


@kernel
def take_back(characters_inout, bodies_inout):
    """Put the bodies of characters, which the solver has moved along, back where their boxes are. O(characters)."""
    for me in range(len(characters_inout)):
        settle(me, characters_inout, bodies_inout)
        characters_inout[me].push_vx = 0.0
        characters_inout[me].push_vy = 0.0


@kernel
def ride_bodies(
    # read
    geometry,
    shapes,
    piles,
    belts,
    dt,
    slop,
    # write
    scratch,
    rows_out,
    characters_inout,
    bodies_inout,
):
    """Carry characters by what the point under their feet was moved by, in whole pixels with the remainder kept.

    piles: 1 in a world that stacks: dynamic bodies carry, and kinematic ones that turn or are no boxes; they step down to
    where these went. belts: 1 where surfaces run: for dt [s]. rows_out (shapes): scratch. O(characters · shapes).
    """
    for axis in range(2):
        along_x = 1 - axis
        for me in range(len(characters_inout)):
            c = characters_inout[me]
            c.carried = 0
            way = 0
            row = row_of(bodies_inout, c.riding) if piles == 1 and c.riding >= 0 else -1
            if row >= 0 and (bodies_inout[row].kind == STATIC or not ridden_freely(bodies_inout, shapes, row)):
                row = -1
            if row < 0:
                c.carry_x = 0.0
                c.carry_y = 0.0
            else:
                r = bodies_inout[row]
                # x is carried first; the point's motion is the same for both axes.
                u, v = turned(
                    c.foot_x - r.previous_x,
                    c.foot_y - r.previous_y,
                    math.cos(r.angle - r.previous_angle),
                    math.sin(r.angle - r.previous_angle),
                )
                if along_x == 1:
                    c.carry_x += r.x + u - c.foot_x
                    way = whole_pixels(c.carry_x)
                    c.carry_x -= way
                else:
                    c.carry_y += r.y + v - c.foot_y
                    way = whole_pixels(c.carry_y)
                    c.carry_y -= way
            if belts == 1 and along_x == 1:
                c.belt_x = c.belt_x + c.belt * dt if c.belt != 0.0 else 0.0
                run = whole_pixels(c.belt_x)
                c.belt_x -= run
                way += run
            if way != 0:
                stopped = shift(
                    geometry,
                    shapes,
                    me,
                    row,
                    way,
                    along_x,
                    piles,
                    slop,
                    scratch,
                    rows_out,
                    characters_inout,
                    bodies_inout,
                )
                c.carried = way - stopped if way > 0 else way + stopped
        carry_riders(geometry, shapes, along_x, piles, slop, scratch, rows_out, characters_inout, bodies_inout)
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        row = row_of(bodies_inout, c.riding) if piles == 1 and c.riding >= 0 else -1
        if row >= 0 and ridden_freely(bodies_inout, shapes, row):
            step_down(geometry, shapes, me, slop, scratch, rows_out, characters_inout, bodies_inout)


@kernel
def give_way(
    # read
    geometry,
    shapes,
    slop,
    # write
    scratch,
    rows_out,
    more_rows_out,
    characters_inout,
    bodies_inout,
):
    """Move characters out of the loose bodies that came into them, and tell which are squeezed: in deep, and not less so.

    What has just fallen into one is deep for a moment, until the solver has pushed it out. rows_out, more_rows_out (shapes): scratch. O(characters · shapes).
    """
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        c.wedged = False
        before = c.deep
        c.deep = 0.0
        count = gather_solids(
            geometry,
            bodies_inout,
            shapes,
            characters_inout,
            me,
            -1,
            1,
            float(c.left),
            float(c.top),
            float(c.left + c.width),
            float(c.top + c.height),
            rows_out,
        )
        for k in range(count):
            if rows_out[k] >= 0:
                continue
            row = -1 - rows_out[k]
            depth, nx, ny, x, y = meet(geometry, bodies_inout, shapes, row, c.left, c.top, c.width, c.height, scratch)
            along_x = 1 if abs(nx) > abs(ny) else 0
            into = nx if along_x == 1 else ny
            speed = bodies_inout[shapes[row].body_row].vx
            if along_x == 1 and depth > 0.5 * slop and speed * into < 0.0:
                c.push_vx = speed  # what is pressed against it need not stop: it goes along
            pixels = math.ceil(depth - 1.5 * FEET)
            if pixels <= 0:
                continue
            stopped = shift(
                geometry,
                shapes,
                me,
                shapes[row].body_row,
                -pixels if into > 0.0 else pixels,
                along_x,
                1,
                slop,
                scratch,
                more_rows_out,
                characters_inout,
                bodies_inout,
            )
            if stopped > 0 and along_x == 1:
                c.push_vx = 0.0
            depth, nx, ny, x, y = meet(geometry, bodies_inout, shapes, row, c.left, c.top, c.width, c.height, scratch)
            c.deep = max(c.deep, depth)
            c.wedged = c.wedged or (depth > GIVE and ny > abs(nx))
        if before > GIVE and c.deep >= before:
            c.squeezed = True


@stage(
    "carry",
    reads=(
        "effects",
        "tolerances",
        "gravity",
        "dt",
        "broadphase",
        "bodies",
        "shapes",
        "characters",
        "library",
        "pairs",
        "manifolds",
        "awake",
        "workspace",
    ),
    writes=(
        "characters",
        "manifolds",
        "pairs",
        "broadphase",
        "work",
        "workspace",
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y")),
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def carry_characters(state):
    """Moving solids take characters along, and push them; nothing in a world without any. Those that were moved meet others
    in this very step."""
    characters = state.characters
    if not len(characters):
        return
    bodies, shapes, slop, dt, tables = state.bodies, state.shapes, state.tolerances.slop, state.dt, state.library.tables
    own = characters["body_row"]
    before = bodies[own][["x", "y"]]
    piles, belts = int(state.effects.stacking), int(state.effects.conveyor)
    scratch, room = state.workspace.walk, state.workspace.rows_for(2 * len(shapes))
    near, more = room[: len(shapes)], room[len(shapes) : 2 * len(shapes)]
    if piles:
        if state.effects.gravity and dt > 0.0:
            tell_weight(characters, dt * math.hypot(*state.gravity), state.manifolds)
        take_back(characters, bodies)
    carry_and_push(tables, shapes, piles, slop, scratch, near, characters, bodies)
    if piles or belts:
        ride_bodies(tables, shapes, piles, belts, dt, slop, scratch, near, characters, bodies)
    if piles:
        give_way(tables, shapes, slop, scratch, near, more, characters, bodies)
    moved = own[before != bodies[own][["x", "y"]]]
    if len(moved):
        rows = np.flatnonzero(np.isin(shapes["body_row"], moved))
        refresh_aabbs(state.awake.shapes, tables, bodies, shapes)  # also what carries them: feet stand on boxes
        rows = rows[shapes["proxy"][rows] >= 0]
        state.pairs.widen(shapes[rows], slop)
        state.pairs.update(state.broadphase, shapes, len(rows), state.work)


@stage(
    "weigh",
    reads=(
        "effects",
        "tolerances",
        "gravity",
        "bodies",
        "shapes",
        "characters",
        "manifolds",
        "anchors",
        "awake",
        "sleepers",
    )
    + ("pairs", "touching", "sensing"),
    writes=(
        "characters",
        "manifolds",
        "anchors",
        "awake",
        "sleepers",
        "pairs",
        "touching",
        "sensing",
        *(f"bodies.{name}" for name in ("awake", "active", "sleep_time", "island", "vx", "vy")),
        *(f"bodies.{name}" for name in ("force_x", "force_y", "torque")),
    ),
)
def bear_characters(state):
    """Before a step: characters weigh on what they ride, and wake it when they came, left or walked."""
    characters, bodies = state.characters, state.bodies
    if not len(characters):
        return
    if state.effects.sleeping:
        own = bodies[characters["body_row"]]
        new = characters["riding"] != characters["pressed"]
        stirred = new | (own["x"] != own["previous_x"]) | (own["y"] != own["previous_y"])
        ids = np.union1d(characters["riding"][stirred], characters["pressed"][new])
        rows = rows_of(bodies, ids)
        disturb(state, ids[(rows >= 0) & (bodies["kind"][rows] == DYNAMIC)])
    characters["pressed"] = characters["riding"]
    gravity = state.gravity if state.effects.gravity else (0.0, 0.0)
    press(state.shapes, *gravity, state.tolerances.sleep_speed, characters, bodies)
