"""What no step can use is taken out of the simulation before it reaches anything else, and told by name.

A number that is not finite spreads: through a contact to a neighbour, from there to a heap. So every number that a step
reads of a body, a shape or a character is looked at before the first stage that reads it.
"""

import numpy as np

from physics.dynamics.integrate import refresh_centers
from physics.dynamics.sleep import disturb
from physics.jit import kernel, subkernel
from physics.settings import POSITION_LIMIT
from physics.tables.contact import QUARANTINE
from physics.tables.shape import TILES
from physics.tables.step_state import StepState, stage

NOT_FINITE = "a number of the body is not finite or beyond what a double resolves"
BAD_SHAPE = "a number of one of its shapes is not finite, too large, or below 0 where it may not be"
BAD_WALK = "a number of its character is not finite"
TURNED = "a TileGrid cannot turn: its angle and angular velocity must be 0"
LARGEST = 1e100  # of inverse masses and of a surface: beyond, products of two are no doubles
REST = ("previous_x", "previous_y", "previous_angle", "vx", "vy", "angular_velocity", "force_x", "force_y", "torque")
READS = (
    "bodies",
    "shapes",
    "awake",
    "sleepers",
    "pairs",
    "manifolds",
    "anchors",
    "touching",
    "sensing",
    "tolerances",
    "library",
    "effects",
    "gravity",
    "characters",
    "dt",
)
WRITES = (
    "events",
    "pairs",
    "awake",
    "sleepers",
    "manifolds",
    "anchors",
    "touching",
    "sensing",
    "shapes.proxy",
    "bodies.sleep_time",
    "bodies.island",
    *(f"bodies.{name}" for name in ("x", "y", "angle", "center_x", "center_y", "awake", "active", "quarantined")),
    *(f"bodies.settled_{name}" for name in ("x", "y", "angle")),
    *(f"bodies.{name}" for name in REST),
)


@subkernel
def put_aside(body_inout):
    """Quarantine a body where it is: at rest, pulled by nothing."""
    b = body_inout
    b.previous_x = b.x
    b.previous_y = b.y
    b.previous_angle = b.angle
    b.vx = 0.0
    b.vy = 0.0
    b.angular_velocity = 0.0
    b.force_x = 0.0
    b.force_y = 0.0
    b.torque = 0.0
    b.awake = False
    b.quarantined = True


@subkernel
def is_sound(body, gravity_x, gravity_y, speed_limit, dt):
    """Whether a step of dt [s] can use a body: a number that it reads and that is not finite, or an end of its motion
    that a double does not resolve, would be its neighbours' too. gravity [px/s2], speed_limit [px/s]."""
    b = body
    vx = b.vx + dt * (b.inverse_mass * b.force_x + b.gravity_scale * gravity_x)
    vy = b.vy + dt * (b.inverse_mass * b.force_y + b.gravity_scale * gravity_y)
    spin = b.angular_velocity + dt * b.inverse_inertia * b.torque
    # What is finite is 0 less than itself; what is not is not.
    sizes = b.mass + b.inertia + b.smallest_half + b.thin_half + b.fraction
    return (
        abs(b.vx) < speed_limit
        and abs(b.vy) < speed_limit
        and abs(vx) < speed_limit
        and abs(vy) < speed_limit
        and abs(spin) * b.extent < speed_limit
        and abs(b.x + dt * vx) < POSITION_LIMIT
        and abs(b.y + dt * vy) < POSITION_LIMIT
        and abs(b.angle + dt * spin) < POSITION_LIMIT
        and abs(b.local_center_x) < POSITION_LIMIT
        and abs(b.local_center_y) < POSITION_LIMIT
        and abs(b.center_x) < 2.0 * POSITION_LIMIT
        and abs(b.center_y) < 2.0 * POSITION_LIMIT
        and b.inverse_mass < LARGEST
        and b.inverse_inertia < LARGEST
        and 0.0 <= b.extent < POSITION_LIMIT
        and sizes - sizes == 0.0
    )


@kernel
def find_broken(
    # read
    rows,
    gravity_x,
    gravity_y,
    speed_limit,
    dt,
    # write
    bodies_inout,
    broken_out,
):
    """List the rows of bodies that a step of dt [s] under this gravity [px/s2] cannot use, and put them to rest.

    Each goes back to the last finite pose and is marked quarantined. Returns the number. broken_out (rows).
    """
    found = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        if b.quarantined:
            continue
        there = abs(b.x) < POSITION_LIMIT and abs(b.y) < POSITION_LIMIT and abs(b.angle) < POSITION_LIMIT
        if not there or not is_sound(b, gravity_x, gravity_y, speed_limit, dt):
            broken_out[found] = rows[k]
            found += 1
            if not there:
                b.x = b.settled_x
                b.y = b.settled_y
                b.angle = b.settled_angle
            put_aside(b)
    return found


@subkernel
def is_sound_walk(character):
    """Whether every number of a character is finite: what is finite is 0 less than itself."""
    c = character
    total = c.offset_x + c.offset_y + c.climb + c.remainder_x + c.remainder_y + c.slope + c.mass + c.push
    total += c.foot_x + c.foot_y + c.carry_x + c.carry_y + c.belt + c.belt_x + c.push_vx + c.push_vy + c.deep
    return total - total == 0.0 and abs(total) < POSITION_LIMIT


@kernel
def find_broken_characters(
    # read
    characters,
    # write
    bodies_inout,
    broken_out,
):
    """List the body rows of characters with a number that is not finite, at rest and quarantined. Returns how many."""
    found = 0
    for k in range(len(characters)):
        b = bodies_inout[characters[k].body_row]
        if not b.quarantined and not is_sound_walk(characters[k]):
            broken_out[found] = characters[k].body_row
            found += 1
            put_aside(b)
    return found


@kernel
def find_broken_shapes(
    # read
    rows,
    shapes,
    # write
    bodies_inout,
    broken_out,
):
    """List the rows of bodies one of whose shapes, of these rows, has a number that no step can use; put them to rest.

    Each is marked quarantined. Returns the number. O(rows).
    """
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        place = abs(s.local_x) + abs(s.local_y) + s.radius
        surface = s.friction + abs(s.restitution) + abs(s.rolling_resistance) + abs(s.surface_speed)
        if place < POSITION_LIMIT and surface < LARGEST and s.radius >= 0.0 and s.friction >= 0.0:
            continue
        b = bodies_inout[s.body_row]
        if not b.quarantined:
            broken_out[found] = s.body_row
            found += 1
            put_aside(b)
    return found


@kernel
def find_turned_grids(
    # read
    rows,
    shapes,
    # write
    bodies_inout,
    broken_out,
):
    """List the rows of bodies with TILES among these shape rows that turn or are turned, which only a table can make
    them; set them upright and at rest, and mark them quarantined. Returns the number. O(rows)."""
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if s.kind != TILES:
            continue
        b = bodies_inout[s.body_row]
        if b.quarantined or (b.angle == 0.0 and b.angular_velocity == 0.0):
            continue
        broken_out[found] = s.body_row
        found += 1
        b.angle = 0.0
        put_aside(b)
    return found


@stage("quarantine", reads=READS, writes=WRITES)
def quarantine(state: StepState) -> None:
    """Take what no step can use out of the simulation, and tell it; its neighbours go on as if it had been removed."""
    rows, bodies, shapes = state.awake.bodies, state.bodies, state.shapes
    gravity = state.gravity if state.effects.gravity else (0.0, 0.0)
    found = np.empty(max(len(rows), len(state.awake.shapes), len(state.characters)), np.int64)
    broken = find_broken(rows, *gravity, state.tolerances.speed_limit, state.dt, bodies, found)
    told = dict.fromkeys(found[:broken].tolist(), NOT_FINITE)
    broken = find_broken_shapes(state.awake.shapes, shapes, bodies, found)
    told.update(dict.fromkeys(found[:broken].tolist(), BAD_SHAPE))
    if state.library.grids.count:
        broken = find_turned_grids(state.awake.shapes, shapes, bodies, found)
        told.update(dict.fromkeys(found[:broken].tolist(), TURNED))
    if len(state.characters):
        broken = find_broken_characters(state.characters, bodies, found)
        told.update(dict.fromkeys(found[:broken].tolist(), BAD_WALK))
    if told:
        _take_out(state, told)


@stage("quarantine_solved", reads=READS, writes=WRITES)
def quarantine_solved(state: StepState) -> None:
    """Take out what a solver could not keep finite, and what that touched, before it is swept and told of."""
    found = np.empty(len(state.awake.bodies), np.int64)
    broken = find_broken(state.awake.bodies, 0.0, 0.0, state.tolerances.speed_limit, 0.0, state.bodies, found)
    if broken:
        ids = _take_out(state, dict.fromkeys(found[:broken].tolist(), NOT_FINITE))
        kept = ~(np.isin(state.manifolds["body_a"], ids) | np.isin(state.manifolds["body_b"], ids))
        state.manifolds, state.anchors = state.manifolds[kept], state.anchors[kept]


def _take_out(state, told):
    """Out of the broad phase and of what is awake; told: {body row: reason}. Returns the ids."""
    bodies, shapes = state.bodies, state.shapes
    broken = np.array(sorted(told), np.int64)
    ids = bodies["id"][broken]
    rows = np.array([(bodies["id"][row], told[row]) for row in sorted(told)], QUARANTINE)
    state.events.quarantined = np.sort(np.concatenate([state.events.quarantined, rows]))
    own = np.isin(shapes["body"], ids)
    state.pairs.free_proxies(shapes["proxy"][own])
    shapes["proxy"][own] = -1
    refresh_centers(broken, bodies)
    disturb(state, ids)
    state.awake.start_over()
    return ids
