"""Bodies into a world, and changes to those that stand in it: what a user asks for is checked first, so that the world
is unchanged by what is wrong. World and Body are the ways in.
"""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from physics import checks
from physics.checks import Pair, Points
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.shapes.approximate import fit
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape, mass_of
from physics.shapes.mask import PixelMask
from physics.shapes.material import Material
from physics.shapes.rows import check_shapes, rounding_of, set_mass
from physics.shapes.tiles import TileGrid
from physics.tables.body import AUTO, CONTINUOUS, KINDS, OFF, STATIC
from physics.world_state import WorldState


def add_rows(
    world: WorldState,
    shapes: Sequence[Shape],
    positions: Points,
    velocities: Points,
    angles: Sequence[float] | np.ndarray,
    kind: str,
    angular_velocity: float,
    material: Material,
    filter: Filter,
    sensor: bool,
    bullet: bool,
    continuous: str,
    fixed_rotation: bool,
    gravity_scale: float,
    tier: str | None,
    user: Any,
) -> np.ndarray:
    """Check what a user asks for, and append BODY and SHAPE rows. Returns the ids. Raises TypeError, ValueError."""
    world._unlocked()
    kind_number = KINDS.index(checks.choice("kind", kind, KINDS))
    for name, value, wanted in (("material", material, Material), ("filter", filter, Filter)):
        if not isinstance(value, wanted):
            raise TypeError(f"{name} must be a {wanted.__name__} (got {value!r})")
    sensor = checks.flag("sensor", sensor)
    world._needs("sensors", "sensor=True", sensor)
    swept = CONTINUOUS.index(checks.choice("continuous", continuous, CONTINUOUS))
    bullet = checks.flag("bullet", bullet)
    world._needs("continuous", "bullet=True", bullet)
    if swept not in (OFF, AUTO):
        world._needs("continuous", f"continuous={continuous!r}", True)
    fixed_rotation = checks.flag("fixed_rotation", fixed_rotation)
    gravity_scale = checks.number("gravity_scale", gravity_scale)
    spin = checks.number("angular_velocity", angular_velocity)
    world._needs("rotation", f"angular_velocity={spin}", spin != 0.0)
    if kind_number == STATIC and (np.any(np.asarray(velocities) != 0.0) or spin != 0.0):
        raise ValueError(
            f"velocity and angular_velocity must be 0 for a static body (got {np.asarray(velocities).tolist()}, {spin})"
        )
    used = shapes_for_tier(shapes, tier)
    check_shapes(used, kind_number, angles, swept)
    mass = mass_of(used, material.density) if used else mass_of((), material.density)
    n = len(positions)
    ids = np.arange(world._next_body, world._next_body + n, dtype=np.int64)
    if n == 0:
        return ids
    world._next_body += n
    rows = world._bodies.append(n)
    rows["id"], rows["kind"] = ids, kind_number
    rows["x"], rows["y"] = np.asarray(positions).T
    rows["vx"], rows["vy"] = np.asarray(velocities).T
    rows["angle"], rows["angular_velocity"] = angles, spin
    for name in ("x", "y", "angle"):
        rows["previous_" + name] = rows[name]
    rows["gravity_scale"], rows["continuous"], rows["fixed_rotation"] = gravity_scale, swept, fixed_rotation
    rows["awake"], rows["fraction"], rows["bullet"], rows["island"] = True, 1.0, bullet, -1
    rows["active"] = not world.sleeps  # with it, the next step takes them in
    if kind != "dynamic":
        world.awake.stir(ids.tolist())
    set_mass(rows, mass, used)
    refresh_centers(np.arange(n), rows)
    add_shapes(world, rows, world._bodies.count - n, used, material, filter, sensor)
    source = tuple(shapes)  # one for all: a swarm costs two entries each, and no object
    for identity in ids.tolist():
        world._shapes_of[identity] = used
        if user is not None:
            world._users[identity] = user
        if tier is not None:
            world._tiers[identity], world._sources[identity] = tier, source
    return ids


def add_shapes(
    world: WorldState,
    bodies: np.ndarray,
    first_row: int,
    shapes: Sequence[Shape],
    material: Material,
    filter: Filter,
    sensor: bool,
) -> None:
    """Append the SHAPE rows of new shapes for BODY rows that start at first_row,
    and give them places in the broad phase."""
    n, k = len(bodies), len(shapes)
    if n * k == 0:
        return
    rows = world._shapes.append(n * k)
    rows["id"] = np.arange(world._next_shape, world._next_shape + n * k)
    world._next_shape += n * k
    rows["body"] = np.repeat(bodies["id"], k)
    rows["body_row"] = np.repeat(np.arange(first_row, first_row + n), k)
    for name in ("density", "friction", "restitution", "rolling_resistance", "surface_speed"):
        rows[name] = getattr(material, name)
    rows["sensor"] = sensor
    rows["membership"], rows["mask"] = filter.membership, filter.mask
    for i, shape in enumerate(shapes):
        kind, geometry, wrapped = world.library.add(shape)
        each = rows[i::k]
        each["kind"], each["geometry"], each["wrapped"] = kind, geometry, wrapped
        each["radius"], each["local_x"], each["local_y"] = rounding_of(shape)
    world.pairs.add_proxies(rows, np.arange(n * k), np.repeat(bodies["kind"] == STATIC, k))


def filter_of(world: WorldState, identity: int) -> Filter:
    """The filter of a body's shapes; Filter.ALL for a body without any."""
    world._body_row(identity)
    shapes = world.shapes[world.shapes["body"] == identity]
    return Filter(int(shapes["membership"][0]), int(shapes["mask"][0])) if len(shapes) else Filter.ALL


def set_filter(world: WorldState, identity: int, value: Filter) -> None:
    """Change the filter of all shapes of a body. Raises TypeError."""
    world._unlocked()
    if not isinstance(value, Filter):
        raise TypeError(f"filter must be a Filter (got {value!r})")
    world._body_row(identity)
    own = world.shapes["body"] == identity
    world.shapes["membership"][own], world.shapes["mask"][own] = value.membership, value.mask
    world.pairs.set_filter(world.shapes["proxy"][own], value)
    sleep.disturb(world, [identity])


def move_to(world: WorldState, identity: int, position: Pair, angle: float | None) -> None:
    """Put a body at a position [px] and an angle (None: as it is). Raises ValueError for a turned TileGrid."""
    world._unlocked()
    row = world._body_row(identity)
    if angle and any(isinstance(shape, TileGrid) for shape in world._shapes_of[identity]):
        raise ValueError(f"angle must be 0 for a body with a TileGrid (got {angle})")
    row["x"], row["y"] = position
    if angle is not None:
        row["angle"] = angle
    refresh(world, identity)


def refresh(world: WorldState, identity: int) -> None:
    """Bring what is derived from one body's pose up to date: centre of mass and motion rectangle.
    Its neighbours wake."""
    sleep.disturb(world, [identity])
    at = world._row_number(identity)
    refresh_centers(np.array([at]), world.bodies)
    world.pairs.touch(world.shapes["proxy"][world.shapes["body"] == identity])


def touch(world: WorldState, ids: Any) -> None:
    """Bring what is derived from the columns of bodies up to date. Raises KeyError, TypeError, ValueError."""
    many = ids if isinstance(ids, (list, tuple, set, np.ndarray)) else [ids]
    numbers = checks.ids("ids", [getattr(each, "id", each) for each in many])
    rows = world.rows(numbers)
    sleep.disturb(world, numbers)
    refresh_centers(rows, world.bodies)
    world.pairs.touch(world.shapes["proxy"][np.isin(world.shapes["body_row"], rows)])


def set_kind(world: WorldState, identity: int, kind: str) -> None:
    """Make a body static, kinematic or dynamic. Raises ValueError for dynamic tiles."""
    world._unlocked()
    row = world._body_row(identity)
    check_shapes(world._shapes_of[identity], KINDS.index(kind), [row["angle"].item()], int(row["continuous"]))
    row["kind"] = KINDS.index(kind)
    if kind == "static":
        row["vx"] = row["vy"] = row["angular_velocity"] = 0.0
    refresh_mass(world, identity)
    own = world.shapes["body"] == identity
    world.pairs.set_still(world.shapes["proxy"][own], kind == "static")
    world.awake.start_over()


def refresh_mass(world: WorldState, identity: int) -> None:
    """Weigh a body anew: its shapes or its kind changed."""
    at = world._row_number(identity)
    own = world.shapes[world.shapes["body"] == identity]
    density = float(own["density"][0]) if len(own) else 1.0
    used = world._shapes_of[identity]
    set_mass(world.bodies[at : at + 1], mass_of(used, density), used)
    refresh(world, identity)


def set_shapes(world: WorldState, identity: int, shapes: Sequence[Shape]) -> None:
    """Replace a body's shapes; material, filter and sensor stay. Raises TypeError, ValueError."""
    world._unlocked()
    row = world._body_row(identity)
    check_shapes(shapes, int(row["kind"]), [row["angle"].item()], int(row["continuous"]))
    own = world.shapes["body"] == identity
    first = world.shapes[own][0] if own.any() else None
    material = Material() if first is None else Material(*(float(first[each.name]) for each in fields(Material)))
    filter, sensor = filter_of(world, identity), bool(first is not None and first["sensor"])
    sleep.disturb(world, [identity])
    world._drop_shapes(~own)
    at = world._row_number(identity)
    world._shapes_of[identity] = tuple(shapes)
    add_shapes(world, world.bodies[at : at + 1], at, tuple(shapes), material, filter, sensor)
    refresh_mass(world, identity)
    if row["quarantined"]:
        own = world.shapes["body"] == identity
        world.pairs.free_proxies(world.shapes["proxy"][own])
        world.shapes["proxy"][own] = -1
    sleep.forget(world)
    world._tiers.pop(identity, None)
    world._sources.pop(identity, None)


def shapes_for_tier(shapes: Sequence[Shape], tier: str | None) -> tuple:
    """The shapes that stand for one PixelMask in a tier; as they are for None. Raises ValueError, TypeError."""
    if tier is None:
        return tuple(shapes)
    if len(shapes) != 1 or not isinstance(shapes[0], PixelMask):
        raise ValueError(f"tier {tier!r} needs exactly one PixelMask (got {shapes!r})")
    return fit(shapes[0], tier)


def set_tier(world: WorldState, identity: int, tier: str | None) -> None:
    """Collide a body's sprite more or less exactly.
    Raises ValueError for an unknown tier or a body without a sprite."""
    world._body_row(identity)
    source = world._sources.get(identity, world._shapes_of[identity])
    set_shapes(world, identity, shapes_for_tier(source, tier))
    if tier is not None:
        world._tiers[identity], world._sources[identity] = tier, source


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
