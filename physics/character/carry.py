"""Moving solids carry the characters that ride them and push those in their way, one axis after the other.

A character that cannot give way is squeezed: it stays, overlapping, and its next `move` says so. Source: Thorson,
Celeste and TowerFall Physics, 2018.
"""

import math

import numpy as np

from physics.character.ground import FREE
from physics.character.meet import box_corners, meet_hull, place_outline
from physics.character.near import near_characters
from physics.character.push import press, tell_weight
from physics.character.ride import give_way, note_feet, ride_bodies, take_back
from physics.character.shift import carried_by, carry_riders, shift
from physics.character.solids import aabb_of, in_shape, is_box, is_loose, round_half_up
from physics.character.workspace import character_of, find_own_rows, walk_for
from physics.collision.clipping import ALL_EDGES
from physics.dynamics.sleep import disturb
from physics.jit import kernel, subkernel
from physics.shapes.placement import aabb_at, refresh_aabbs
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.rows import rows_of
from physics.tables.shape import PIXELS
from physics.tables.step_state import StepState, stage


@subkernel
def swept_box(walk, row, along_x):
    """(left, top, right, bottom [px], pixels moved) of what a box swept on the pixel grid along an axis, x first."""
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
    """Whether a character, shifted by some pixels along an axis, is in what a solid swept along it; box: see swept_box.

    A solid that is no box, a grid of tiles, is tested where it stands when it has moved along this axis.
    """
    c = walk_inout.characters[me]
    left, top, right, bottom, moved = box
    at_x = c.left + shifted * along_x
    at_y = c.top + shifted * (1 - along_x)
    if not (at_x < right and left < at_x + c.width and at_y < bottom and top < at_y + c.height):
        return False
    if is_box(walk_inout, row):
        if c.is_box:
            return True
        count, radius = place_outline(walk_inout, me, at_x, at_y)
        box_corners(left, top, right - left, bottom - top, walk_inout.scratch.theirs)
        depth, nx, ny, x, y = meet_hull(walk_inout.scratch, count, radius, 4, 0.0, ALL_EDGES, math.inf)
        return depth > walk_inout.settings.slop
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    now = b.y
    if along_x == 1:
        b.y = b.previous_y  # x moves first
    what, slope = in_shape(walk_inout, me, row, at_x, at_y, 0, 0, 0.0)
    b.y = now
    return what != FREE


@subkernel
def way_clear(me, row, along_x, box, walk_inout):
    """Whole pixels along an axis, the way a solid moved, that take a character out of what it swept; 0: it is out."""
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
    """Carry or push one character with a solid that has moved by whole pixels along an axis; box: see swept_box."""
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
    # A rider that is stopped slides; it is squeezed where the solid now stands in it.
    if stopped > 0 and in_swept(me, row, 0, along_x, box, walk_inout):
        c.squeezed = True


@subkernel
def carry_and_push(movers, walk_inout):
    """Let every kinematic solid that moved by whole pixels carry its riders and push what it ran into.

    movers: shape rows, in order, of which those count that keep to the pixel grid: upright boxes and tiles; the rest is
    left to ride_bodies. O(moved solids · characters).
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
def carry_all(
    # read
    movers,
    # write
    walk_inout,
):
    """Carry, push and press characters by all that moved in the step. movers: see carry_and_push."""
    carry_and_push(movers, walk_inout)
    ride_bodies(walk_inout)
    give_way(walk_inout)


@stage(
    "carry",
    reads=(
        "effects",
        "tolerances",
        "gravity",
        "dt",
        "steps",
        "broadphase",
        "bodies",
        "shapes",
        "characters",
        "library",
        "pairs",
        "manifolds",
        "awake",
        "queries",
        "workspace",
    ),
    writes=(
        "characters",
        "manifolds",
        "awake",  # its room for the shapes of what has moved
        "pairs",
        "broadphase",
        "library",
        "queries",
        "work",
        "workspace",
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y", "force_x", "force_y", "torque")),
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def carry_characters(state: StepState) -> None:
    """Moving solids take characters along, and push them. Those that were moved meet others in this very step."""
    characters = state.characters
    bodies, shapes = state.bodies, state.shapes
    find_own_rows(bodies, shapes, characters)
    own = characters["body_row"]
    before = bodies[own][["x", "y"]]
    if state.effects.stacking:
        if state.effects.gravity and state.dt > 0.0:
            tell_weight(characters, state.dt * math.hypot(*state.gravity), state.manifolds)
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
        "pairs",
        "touching",
        "sensing",
    ),
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
def bear_characters(state: StepState) -> None:
    """Before a step: characters weigh on what they ride, and wake it when they came, left or walked."""
    characters, bodies = state.characters, state.bodies
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
