"""Changes to a body that stands in a world already: filter, pose, kind, shapes, tier. Body is the way in."""

from dataclasses import fields

import numpy as np

from physics import sleep
from physics.fitting import fit
from physics.motion.integrate import refresh_centers
from physics.shape_rows import add_shapes, check_shapes, set_mass
from physics.shapes import Filter, Material, PixelMask, TileGrid, mass_of
from physics.tables import KINDS, STATIC


def filter_of(world, identity) -> Filter:
    """The filter of a body's shapes; Filter.ALL for a body without any."""
    world._body_row(identity)
    shapes = world.shapes[world.shapes["body"] == identity]
    return Filter(int(shapes["membership"][0]), int(shapes["mask"][0])) if len(shapes) else Filter.ALL


def set_filter(world, identity, value):
    """Change the filter of all shapes of a body. Raises TypeError."""
    world._unlocked()
    if not isinstance(value, Filter):
        raise TypeError(f"filter must be a Filter (got {value!r})")
    world._body_row(identity)
    own = world.shapes["body"] == identity
    world.shapes["membership"][own], world.shapes["mask"][own] = value.membership, value.mask
    world.pairs.set_filter(world.shapes["proxy"][own], value)
    sleep.wake_ids(world, [identity])


def move_to(world, identity, position, angle):
    """Put a body at a position [px] and an angle (None: as it is). Raises ValueError for a turned TileGrid."""
    world._unlocked()
    row = world._body_row(identity)
    if angle and any(isinstance(shape, TileGrid) for shape in world._shapes_of[identity]):
        raise ValueError(f"angle must be 0 for a body with a TileGrid (got {angle})")
    row["x"], row["y"] = position
    if angle is not None:
        row["angle"] = angle
    refresh(world, identity)


def refresh(world, identity):
    """Bring what is derived from one body's pose up to date: centre of mass and motion rectangle. Its neighbours wake."""
    sleep.wake_ids(world, [identity])
    at = world._row_number(identity)
    refresh_centers(world.bodies[at : at + 1])
    world.pairs.touch(world.shapes["proxy"][world.shapes["body"] == identity])


def set_kind(world, identity, kind):
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


def refresh_mass(world, identity):
    """Weigh a body anew: its shapes or its kind changed."""
    at = world._row_number(identity)
    own = world.shapes[world.shapes["body"] == identity]
    density = float(own["density"][0]) if len(own) else 1.0
    used = world._shapes_of[identity]
    set_mass(world.bodies[at : at + 1], mass_of(used, density), used)
    refresh(world, identity)


def set_shapes(world, identity, shapes):
    """Replace a body's shapes; material, filter and sensor stay. Raises TypeError, ValueError."""
    world._unlocked()
    row = world._body_row(identity)
    check_shapes(shapes, int(row["kind"]), [row["angle"].item()], int(row["continuous"]))
    own = world.shapes["body"] == identity
    first = world.shapes[own][0] if own.any() else None
    material = Material() if first is None else Material(*(float(first[each.name]) for each in fields(Material)))
    filter, sensor = filter_of(world, identity), bool(first is not None and first["sensor"])
    sleep.wake_ids(world, [identity])
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


def shapes_for_tier(shapes, tier) -> tuple:
    """The shapes that stand for one PixelMask in a tier; as they are for None. Raises ValueError, TypeError."""
    if tier is None:
        return tuple(shapes)
    if len(shapes) != 1 or not isinstance(shapes[0], PixelMask):
        raise ValueError(f"tier {tier!r} needs exactly one PixelMask (got {shapes!r})")
    return fit(shapes[0], tier)


def set_tier(world, identity, tier):
    """Collide a body's sprite more or less exactly. Raises ValueError for an unknown tier or a body without a sprite."""
    world._body_row(identity)
    source = world._sources.get(identity, world._shapes_of[identity])
    set_shapes(world, identity, shapes_for_tier(source, tier))
    if tier is not None:
        world._tiers[identity], world._sources[identity] = tier, source


def restore(world, identity):
    """Take a quarantined body back into the simulation."""
    world._unlocked()
    row = world._body_row(identity)
    if row["quarantined"]:
        row["quarantined"] = False
        own = np.flatnonzero(world.shapes["body"] == identity)
        world.pairs.add_proxies(world.shapes, own, np.full(len(own), row["kind"] == STATIC))
