"""Teleportation between steps: set the pose of one body, or of many bodies in one call."""

import math
from typing import Any, NamedTuple

import numpy as np

from physics import checks
from physics.annotations import Numbers, Pair, Points
from physics.dynamics.integrate import refresh_center, refresh_centers
from physics.edit import check_grid_stands, refresh_pose
from physics.islands import sleep
from physics.jit import kernel
from physics.settings import POSITION_LIMIT
from physics.solver.loads import blow_of, is_any_blow
from physics.tables.body import DYNAMIC, KINEMATIC, SCATTERED, STATIC
from physics.tables.table import joined, row_nearby
from physics.world_state import WorldState

NOT_SET = np.zeros((1, 2))


def check_no_character(world: WorldState, ids: Any, name: str) -> None:
    """Raise ValueError if a body is that of a Character, whose place is in whole pixels in another table.

    ids: one or many ids of bodies; name: name of the value that is to be set.
    """
    if not world.characters.count:
        return
    own = world.characters.rows["body"]
    if np.isin(own, ids).any():
        body = own[np.isin(own, ids)][0]
        raise ValueError(
            f"{name} of body {body} is set by its Character: write character.move_to(position) to teleport it, "
            "character.move(dx, dy) to walk"
        )


def move_to(
    world: WorldState, identity: int, position: Pair | None, angle: float | None, of_character: bool = False
) -> None:
    """Set the position (x, y) [px] and the angle [rad] of a body (id). None leaves the value unchanged.

    of_character: whether a Character moves its own body. Raises ValueError for an angle other than 0 of a body with a
    TileGrid, and for the body of a Character; RuntimeError during a step.
    """
    world._unstepped()
    at, columns = world._row_at(identity), world._bodies.columns
    kind = columns["kind"][at]
    if kind == KINEMATIC and not of_character:
        check_no_character(world, identity, "position" if angle is None else "angle")
    if angle:
        check_grid_stands(world._shapes_of[identity], angle, "angle")
    if position is not None:
        columns["x"][at], columns["y"][at] = position
    if angle is not None:
        columns["angle"][at] = angle
    if world._targets:
        world._targets.pop(identity, None)
    at = refresh_pose(world, identity, at)
    if kind == DYNAMIC:
        world.contact_lists.forget_loads_of(world, at)


class Motions(NamedTuple):
    """The new poses and velocities of n bodies.

    If the angles or the velocities are not changed, their array is a dummy and must not be read.
    """

    positions: np.ndarray  # (n, 2) float64 [px]
    angles: np.ndarray  # (n,) float64 [rad]
    velocities: np.ndarray  # (n, 2) float64 [px/s]
    turns: bool  # whether the angles are set
    speeds: bool  # whether the velocities are set


@kernel
def find_movable(ids, motions, limit, bodies, rows_out, dynamic_out, marks_inout):
    """Check the arguments of `move`. Write the row numbers of the bodies, and those of the dynamic bodies among them.

    Return the number of dynamic bodies, or -1 for invalid arguments: an unknown or repeated id, a number that is not
    finite, a coordinate or angle of at least `limit` [px, rad], or a velocity other than 0 of a static body. ids,
    rows_out, dynamic_out: (n,) int64; motions: a Motions; bodies: BODY rows; marks_inout: scratch (bodies,) bool, all
    False before and after the call. O(n) if no body was ever removed, otherwise O(n log bodies).
    """
    found = 0
    known = 0
    sound = True
    for k in range(len(ids)):
        row = row_nearby(bodies, ids[k])
        if row < 0 or marks_inout[row]:
            sound = False
            break
        marks_inout[row] = True
        rows_out[k] = row
        known += 1
        sound = abs(motions.positions[k, 0]) < limit and abs(motions.positions[k, 1]) < limit
        if motions.turns:
            sound = sound and abs(motions.angles[k]) < limit
        if motions.speeds:
            vx, vy = motions.velocities[k, 0], motions.velocities[k, 1]
            sound = sound and abs(vx) < math.inf and abs(vy) < math.inf
            sound = sound and (bodies[row].kind != STATIC or (vx == 0.0 and vy == 0.0))
        if not sound:
            break
        if bodies[row].kind == DYNAMIC:
            dynamic_out[found] = row
            found += 1
    for k in range(known):
        marks_inout[rows_out[k]] = False
    return found if sound else -1


@kernel
def place_bodies(rows, motions, runs, shapes, bodies_inout, proxies_inout):
    """Write the poses and velocities of bodies, and mark the proxies of static bodies as changed for the next step.

    Return the number of bodies whose SHAPE rows are not consecutive (SCATTERED). The proxies of such bodies are not
    marked; the caller must mark them. rows: BODY row numbers (n,); motions: a Motions; runs: RUN rows; shapes: SHAPE
    rows; proxies_inout: PROXY rows. O(shapes of these bodies) if no shape was ever removed, otherwise O(log shapes)
    more for each body.
    """
    scattered = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        b.x, b.y = motions.positions[k, 0], motions.positions[k, 1]
        if motions.turns:
            b.angle = motions.angles[k]
        if motions.speeds:
            b.vx, b.vy = motions.velocities[k, 0], motions.velocities[k, 1]
            b.sleep_time = 0.0
        refresh_center(b)
        run = runs[rows[k]]
        if run.count == SCATTERED:
            scattered += 1
        if run.count <= 0:
            continue
        if b.kind != STATIC:
            continue  # each step compares the swept AABBs of other bodies with their AABBs
        first = row_nearby(shapes, run.first)
        for at in range(first, first + run.count):
            if shapes[at].proxy >= 0:
                proxies_inout[shapes[at].proxy].changed = True
    return scattered


def move(world: WorldState, ids: Any, positions: Points, angles: Numbers | None, velocities: Points | None) -> None:
    """Set the positions (n, 2) [px], angles (n,) [rad] and velocities (n, 2) [px/s] of n bodies. None: unchanged.

    The result is the same as setting position, angle and velocity of one Body after another, in the order of `ids`.
    ids: Bodies or ids. Raises the errors of World.move; no body is then changed.
    """
    world._unlocked()
    checks.in_order("ids", ids, "positions")
    ids = world._identities("ids", ids, repeats=True)
    n = len(ids)
    motions = Motions(
        _numbers("positions", positions, n),
        NOT_SET[0] if angles is None else _numbers("angles", angles, n, 1),
        NOT_SET if velocities is None else _numbers("velocities", velocities, n),
        angles is not None,
        velocities is not None,
    )
    rows, dynamic, marks = np.empty(n, np.int64), np.empty(n, np.int64), np.zeros(len(world.bodies), np.bool_)
    count = find_movable(ids, motions, POSITION_LIMIT, world.bodies, rows, dynamic, marks)
    if count < 0:
        _explain(world, ids, motions)
    if motions.turns and world.library.grids.count:
        for k in np.flatnonzero(motions.angles).tolist():
            check_grid_stands(world._shapes_of[int(ids[k])], motions.angles.item(k), f"angles[{k}]")
    check_no_character(world, ids, "position")
    if n:
        _move(world, ids, rows, dynamic[:count], motions)


def _numbers(name, value, count, width=2) -> np.ndarray:
    """Convert the argument `name` to a float64 array of shape (count, width), or (count,) for width 1, and return it.

    Raises TypeError or ValueError if the argument is invalid.
    """
    if type(value) is np.ndarray and value.dtype == np.float64 and value.flags.c_contiguous:
        if value.shape == ((count, width) if width > 1 else (count,)):
            return value
    return checks.columns(name, value, count, width, like="ids")


def _explain(world, ids, motions):
    """Raise the error for the first invalid argument of `move`, which find_movable has rejected.

    ids: ids of the bodies; motions: a Motions.
    """
    checks.ids("ids", ids)
    rows = world.rows(ids)
    positions = checks.columns("positions", motions.positions)
    for k in np.flatnonzero(np.abs(positions).max(axis=1) >= POSITION_LIMIT).tolist():
        raise ValueError(
            f"positions[{k}] must lie within {POSITION_LIMIT:g} px of the origin (got {tuple(positions[k].tolist())})"
        )
    if motions.turns:
        checks.angles("angles", motions.angles)
    velocities = checks.columns("velocities", motions.velocities)
    for k in np.flatnonzero((world.bodies["kind"][rows] == STATIC) & velocities.any(axis=1)).tolist():
        raise ValueError(f"velocities[{k}] must be (0, 0) for static body {ids[k]} (got {velocities[k].tolist()})")


def _move(world, ids, rows, dynamic, motions):
    bodies, keys = world.bodies, set()
    sleeping, listed = world.awake.sleeping, ids.tolist() if world.awake.sleeping or world._targets else []
    if sleeping:
        keys = sleep.islands_at(world, listed, rows)
    if keys and is_any_blow(bodies, _contacts_at(world, keys), bodies["id"][dynamic], blow_of(world)):
        # Which forces a body releases depends on the islands that were woken before, so bodies are moved one by one.
        for k, identity in enumerate(listed):
            angle = motions.angles.item(k) if motions.turns else None
            move_to(world, identity, motions.positions[k].tolist(), angle)
        dynamic = dynamic[:0]
    elif sleeping:
        sleep.stir(world, listed, rows)
        sleep.wake(world, keys)
    for identity in world._targets.keys() & set(listed) if world._targets else ():
        del world._targets[identity]
    proxies = world.pairs.proxies
    if place_bodies(rows, motions, world._runs.rows, world.shapes, bodies, proxies):
        world.pairs.touch(world.shapes["proxy"][world._shape_rows_of(rows)])
    world.contact_lists.forget_loads(world, dynamic)


def _contacts_at(world, keys):
    """Return the CONTACT rows of the last step, and those of sleeping islands.

    keys: keys of the sleeping islands. Islands that touch bodies of these islands are included too.
    """
    sleeping_set = world.sleeping_set
    keys = set(keys)
    for key in [*keys]:
        for identity in sleeping_set.links.keys() & set(sleeping_set.islands[key].bodies.tolist()):
            keys |= sleeping_set.links[identity]
    return joined([world.contact_rows, *(sleeping_set.islands[key].contacts for key in keys)])


def touch(world: WorldState, ids: Any) -> None:
    """Wake bodies whose columns were written by the caller, and update their centres of mass and AABBs.

    ids: Bodies or ids, one or many. See World.touch.
    """
    numbers = world._identities("ids", ids)
    rows = world.rows(numbers)
    sleep.disturb(world, numbers)
    refresh_centers(rows, world.bodies)
    world.pairs.touch(world.shapes["proxy"][world._shape_rows_of(rows)])
