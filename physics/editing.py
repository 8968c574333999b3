"""Bodies into a world, and changes to where and what they are: what a user asks for is checked first, so that the world
is unchanged by what is wrong. World and Body are the ways in. What shapes a body has: reshaping.py.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from physics import checks
from physics.checks import Pair, Points
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.reshaping import (
    check_grid_stands,
    check_own_values,
    check_weight,
    refresh_mass,
    refresh_pose,
    shapes_for_tier,
)
from physics.shape_rows import MATERIAL, add_shapes, check_ids
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.shapes.material import Material
from physics.shapes.rows import check_shapes, set_mass, weigh
from physics.solver.unloading import forget_loads
from physics.tables.body import AUTO, CONTINUOUS, DYNAMIC, KINDS, OFF, STATIC
from physics.world_state import WorldState


class Wanted(NamedTuple):
    """What a user asks of new bodies besides shapes and motion: see World.add_body."""

    kind: str
    angular_velocity: float
    mass: float | None
    material: Material
    filter: Filter
    sensor: bool
    bullet: bool
    continuous: str
    fixed_rotation: bool
    gravity_scale: float
    tier: str | None
    user: Any


def add_rows(
    world: WorldState,
    shapes: Sequence[Shape],
    positions: Points,
    velocities: Points,
    angles: Sequence[float] | np.ndarray,
    wanted: Wanted,
) -> np.ndarray:
    """Check what a user asks for, and append BODY, GIVEN and SHAPE rows. Returns the ids. Raises TypeError,
    ValueError."""
    world._unlocked()
    kind = KINDS.index(checks.choice("kind", wanted.kind, KINDS))
    material, filter = checked_material(wanted.material), checked_filter(wanted.filter)
    sensor, bullet = checked_sensor(world, wanted.sensor), checked_bullet(world, wanted.bullet)
    swept = checked_continuous(world, wanted.continuous)
    fixed_rotation = checks.flag("fixed_rotation", wanted.fixed_rotation)
    gravity_scale = checks.number("gravity_scale", wanted.gravity_scale)
    own_mass = 0.0 if wanted.mass is None else checks.number("mass", wanted.mass, above=0.0)
    spin = checks.number("angular_velocity", wanted.angular_velocity)
    world._needs("rotation", f"angular_velocity={spin}", spin != 0.0)
    if kind == STATIC and (np.any(np.asarray(velocities) != 0.0) or spin != 0.0):
        raise ValueError(
            f"velocity and angular_velocity must be 0 for a static body (got {np.asarray(velocities).tolist()}, {spin})"
        )
    used = shapes_for_tier(shapes, wanted.tier)
    check_shapes(used, kind, angles)
    check_grid_stands(used, spin)
    check_own_values(world, used)
    check_weight(world, used, kind, own_mass)
    check_ids(world, len(positions), used)
    mass = weigh(used, material.density, own_mass)
    n = len(positions)
    ids = np.arange(world._next_body, world._next_body + n, dtype=np.int64)
    if n == 0:
        return ids
    world._next_body += n
    given = world._given.append(n)
    given["mass"], given["sensor"] = own_mass, sensor
    write_material(given, material)
    given["membership"], given["mask"] = filter.membership, filter.mask
    rows = world._bodies.append(n)
    rows["id"], rows["kind"] = ids, kind
    rows["x"], rows["y"] = np.asarray(positions).T
    rows["vx"], rows["vy"] = np.asarray(velocities).T
    rows["angle"], rows["angular_velocity"] = angles, spin
    for name in ("x", "y", "angle"):
        rows["previous_" + name] = rows["still_" + name] = rows[name]
    rows["gravity_scale"], rows["continuous"], rows["fixed_rotation"] = gravity_scale, swept, fixed_rotation
    rows["awake"], rows["fraction"], rows["bullet"], rows["island"] = True, 1.0, bullet, -1
    rows["active"] = not world.sleeps  # with it, the next step takes them in
    if wanted.kind != "dynamic":
        world.awake.stir(ids.tolist())
    set_mass(rows, mass, used, world.effects.response)
    refresh_centers(np.arange(n), rows)
    add_shapes(world, world._bodies.count - n, n, used)
    source = tuple(shapes)  # one for all: a swarm costs two entries each, and no object
    for identity in ids.tolist():
        world._shapes_of[identity] = used
        if wanted.user is not None:
            world._users[identity] = wanted.user
        if wanted.tier is not None:
            world._tiers[identity], world._sources[identity] = wanted.tier, source
    return ids


# --- what a user may ask of a body -------------------------------------------------------------------------------


def checked_material(value: Any) -> Material:
    """A Material. Raises TypeError."""
    if not isinstance(value, Material):
        raise TypeError(f"material must be a Material (got {checks.shown(value)})")
    return value


def checked_filter(value: Any) -> Filter:
    """A Filter. Raises TypeError."""
    if not isinstance(value, Filter):
        raise TypeError(f"filter must be a Filter (got {checks.shown(value)})")
    return value


def checked_sensor(world: WorldState, value: Any) -> bool:
    """A bool. Raises TypeError, and ValueError for True without the effect sensors."""
    value = checks.flag("sensor", value)
    world._needs("sensors", "sensor=True", value)
    return value


def checked_bullet(world: WorldState, value: Any) -> bool:
    """A bool. Raises TypeError, and ValueError for True without the effect continuous."""
    value = checks.flag("bullet", value)
    world._needs("continuous", "bullet=True", value)
    return value


def checked_continuous(world: WorldState, value: Any) -> int:
    """The number of a way of sweeping. Raises TypeError, and ValueError for one that needs the effect continuous."""
    swept = CONTINUOUS.index(checks.choice("continuous", value, CONTINUOUS))
    world._needs("continuous", f"continuous={value!r}", swept not in (OFF, AUTO))
    return swept


# --- changes to a body that is there ----------------------------------------------------------------------------


def write_material(rows: np.ndarray, material: Material) -> None:
    """Write a material to rows that have its columns."""
    for name in MATERIAL:
        rows[name] = getattr(material, name)


def _own_rows(world, identity, own) -> np.ndarray:
    """Rows of the shapes of a body that have no value of their own of this name."""
    return np.flatnonzero((world.shapes["body"] == identity) & ~world.shapes[own])


def set_material(world: WorldState, identity: int, value: Material) -> None:
    """Change what a body's shapes are made of; those with a material of their own keep it. Raises TypeError."""
    world._unlocked()
    value = checked_material(value)
    at = world._row_number(identity)
    write_material(world._given.rows[at : at + 1], value)
    for row in _own_rows(world, identity, "own_material"):
        write_material(world.shapes[row : row + 1], value)
    refresh_mass(world, identity)


def set_filter(world: WorldState, identity: int, value: Filter) -> None:
    """Change the filter of a body's shapes; those with one of their own keep it. Raises TypeError."""
    world._unlocked()
    value = checked_filter(value)
    given = world._given.rows[world._row_number(identity)]
    given["membership"], given["mask"] = value.membership, value.mask
    rows = _own_rows(world, identity, "own_filter")
    world.shapes["membership"][rows], world.shapes["mask"][rows] = value.membership, value.mask
    world.pairs.set_filter(world.shapes["proxy"][rows], value)
    sleep.disturb(world, [identity])


def set_sensor(world: WorldState, identity: int, value: bool) -> None:
    """Make a body's shapes sensors, or solid again; those that say so themselves stay. Raises TypeError, ValueError."""
    world._unlocked()
    value = checked_sensor(world, value)
    world._given.rows["sensor"][world._row_number(identity)] = value
    rows = _own_rows(world, identity, "own_sensor")
    world.shapes["sensor"][rows] = value
    world.pairs.set_sensor(world.shapes, rows)
    sleep.disturb(world, [identity])


def set_continuous(world: WorldState, identity: int, value: str) -> None:
    """Change how a body is swept. Raises TypeError, ValueError."""
    world._unlocked()
    swept, row = checked_continuous(world, value), world._body_row(identity)
    row["continuous"] = swept


def set_fixed_rotation(world: WorldState, identity: int, value: bool) -> None:
    """Say whether contacts and impulses leave a body's turn alone; who is fixed stops turning. Raises TypeError."""
    world._unlocked()
    value, row = checks.flag("fixed_rotation", value), world._body_row(identity)
    row["fixed_rotation"] = value
    if value:
        row["angular_velocity"] = 0.0
    refresh_mass(world, identity)


def move_to(world: WorldState, identity: int, position: Pair, angle: float | None) -> None:
    """Put a body at a position [px] and an angle (None: as it is). Raises ValueError for a turned TileGrid."""
    world._unlocked()
    row = world._body_row(identity)
    check_grid_stands(world._shapes_of[identity], angle or 0.0, "angle")
    row["x"], row["y"] = position
    if angle is not None:
        row["angle"] = angle
    world._targets.pop(identity, None)
    refresh_pose(world, identity)
    if row["kind"] == DYNAMIC:
        forget_loads(world, [identity])


def touch(world: WorldState, ids: Any) -> None:
    """Bring what is derived from the columns of bodies up to date. Raises KeyError, TypeError, ValueError."""
    numbers = world._identities("ids", ids)
    rows = world.rows(numbers)
    sleep.disturb(world, numbers)
    refresh_centers(rows, world.bodies)
    world.pairs.touch(world.shapes["proxy"][np.isin(world.shapes["body_row"], rows)])


def set_kind(world: WorldState, identity: int, kind: str) -> None:
    """Make a body static, kinematic or dynamic. Raises ValueError for dynamic tiles, and for what walks: the body of a
    character is kinematic."""
    world._unlocked()
    row = world._body_row(identity)
    if kind != "kinematic" and (world.characters.rows["body"] == identity).any():
        raise ValueError(f"kind must be 'kinematic' for the body of a character (got {kind!r}, body {identity})")
    shapes, own_mass = world._shapes_of[identity], world._given.rows["mass"][world._row_number(identity)].item()
    check_shapes(shapes, KINDS.index(kind), [row["angle"].item()])
    check_weight(world, shapes, KINDS.index(kind), own_mass)
    row["kind"] = KINDS.index(kind)
    if kind == "static":
        row["vx"] = row["vy"] = row["angular_velocity"] = 0.0
    if kind != "kinematic":
        world._targets.pop(identity, None)
    refresh_mass(world, identity)
    own = world.shapes["body"] == identity
    world.pairs.set_still(world.shapes["proxy"][own], kind == "static")
    world.awake.start_over()


def restore(world: WorldState, identity: int) -> None:
    """Take a quarantined body back into the simulation."""
    world._unlocked()
    row = world._body_row(identity)
    if row["quarantined"]:
        row["quarantined"], row["awake"] = False, True
        world.awake.start_over()
        world.awake.stir([identity])
        own = np.flatnonzero(world.shapes["body"] == identity)
        world.pairs.add_proxies(world.shapes, own, np.full(len(own), row["kind"] == STATIC))
