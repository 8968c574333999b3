"""What shapes a body has, and what it weighs with them: what a user asks for is checked first, as in editing.py."""

from collections.abc import Sequence

import numpy as np

from physics import checks
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.shapes.approximate import fit
from physics.shapes.kinds import Shape, mass_of
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.rows import check_shapes, rounding_of, set_mass
from physics.shapes.tiles import TileGrid
from physics.tables.body import STATIC
from physics.world_state import WorldState

MATERIAL = ("density", "friction", "restitution", "rolling_resistance", "surface_speed")


def check_grid_stands(shapes: Sequence[Shape], turn: float, what: str = "angular_velocity") -> None:
    """Raises ValueError for a TileGrid whose body turns, or is turned."""
    if turn != 0.0 and any(isinstance(shape, TileGrid) for shape in shapes):
        raise ValueError(f"{what} must be 0 for a body with a TileGrid, which cannot turn (got {turn})")


def weigh(shapes: Sequence[Shape], density: float, mass: float) -> Mass:
    """The mass of a body's shapes, sensors among them; mass: in place of what the densities make of it, 0: none."""
    found = mass_of(tuple(shapes), density)
    if mass == 0.0:
        return found
    return Mass(mass, found.center, found.inertia * (mass / found.mass) if found.mass > 0.0 else 0.0)


def add_shapes(world: WorldState, first_row: int, bodies: int, shapes: Sequence[Shape]) -> np.ndarray:
    """Append the SHAPE rows of new shapes for each of the bodies that start at a row, with what the body says of them
    or they of themselves, and give them places in the broad phase. Returns their ids."""
    n, k = bodies, len(shapes)
    ids = np.arange(world._next_shape, world._next_shape + n * k)
    if n * k == 0:
        return ids
    world._tidy_library()
    rows = world._shapes.append(n * k)
    world._next_shape += n * k
    owners = np.repeat(np.arange(first_row, first_row + n), k)
    rows["id"], rows["body"], rows["body_row"] = ids, world.bodies["id"][owners], owners
    given = world._given.rows[owners]
    for name in (*MATERIAL, "membership", "mask", "sensor"):
        rows[name] = given[name]
    for i, shape in enumerate(shapes):
        each = rows[i::k]
        each["kind"], each["geometry"], each["wrapped"] = world.library.add(shape)
        each["radius"], each["local_x"], each["local_y"] = rounding_of(shape)
        if shape.material is not None:
            each["own_material"] = True
            for name in MATERIAL:
                each[name] = getattr(shape.material, name)
        if shape.filter is not None:
            each["own_filter"], each["membership"], each["mask"] = True, shape.filter.membership, shape.filter.mask
        if shape.sensor is not None:
            each["own_sensor"], each["sensor"] = True, shape.sensor
    world.pairs.add_proxies(rows, np.arange(n * k), world.bodies["kind"][owners] == STATIC)
    if world.sleeps:
        # Whose body is in the step already is not taken into it again.
        world.pairs.set_awake(rows["proxy"][world.bodies["active"][owners]], True)
    return ids


def refresh_mass(world: WorldState, identity: int) -> None:
    """Weigh a body anew: its shapes, its kind or what it is made of changed. Its neighbours wake."""
    at = world._row_number(identity)
    given, used = world._given.rows[at], world._shapes_of[identity]
    set_mass(world.bodies[at : at + 1], weigh(used, float(given["density"]), float(given["mass"])), used)
    refresh_pose(world, identity)


def refresh_pose(world: WorldState, identity: int) -> None:
    """Bring what is derived from one body's pose up to date: centre of mass and motion rectangle.
    Its neighbours wake."""
    at = world._row_number(identity)
    sleep.disturb(world, [identity])
    refresh_centers(np.array([at]), world.bodies)
    world.pairs.touch(world.shapes["proxy"][world.shapes["body"] == identity])


def shape_ids(world: WorldState, identity: int) -> tuple[int, ...]:
    """Ids of a body's shapes, in their order."""
    world._row_number(identity)
    return tuple(world.shapes["id"][world.shapes["body"] == identity].tolist())


def set_shapes(world: WorldState, identity: int, shapes: Sequence[Shape]) -> None:
    """Replace a body's shapes; what it says of them stays. Raises TypeError, ValueError."""
    _check(world, identity, shapes, shape_ids(world, identity))
    sleep.disturb(world, [identity])
    world._drop_shapes(world.shapes["body"] != identity)
    _add(world, identity, tuple(shapes), tuple(shapes))


def add_shape(world: WorldState, identity: int, shape: Shape) -> int:
    """Add a shape behind those that a body has. Returns its id. Raises TypeError, ValueError."""
    world._row_number(identity)
    together = (*world._shapes_of[identity], shape)
    _check(world, identity, together, [])
    return int(_add(world, identity, together, (shape,))[0])


def remove_shape(world: WorldState, identity: int, shape_id: int) -> None:
    """Take a shape away from a body. Raises KeyError for an id that is none of its shapes', TypeError, ValueError."""
    shape_id, ids = checks.whole("shape_id", shape_id, 0, 2**62), shape_ids(world, identity)
    if shape_id not in ids:
        raise checks.NoSuchId(f"shape_id must be one of body {identity}'s, {list(ids)} (got {shape_id})")
    rest = tuple(shape for each, shape in zip(ids, world._shapes_of[identity], strict=True) if each != shape_id)
    _check(world, identity, rest, [shape_id])
    sleep.disturb(world, [identity])
    world._drop_shapes(world.shapes["id"] != shape_id)
    _add(world, identity, rest, ())


def check_own_values(world: WorldState, shapes: Sequence[Shape]) -> None:
    """Raises ValueError for shapes that are sensors of their own in a world without the effect."""
    world._needs("sensors", "a shape with_(sensor=True)", any(shape.sensor for shape in shapes))


def _check(world, identity, shapes, gone):
    """Raises what the shapes that a user wants for a body, and the ids of those that go, call for."""
    world._unlocked()
    if np.isin(world.characters.rows["shape"], gone).any():
        raise ValueError(f"shapes of body {identity} must stay: it is a Character's, who walks by its shape")
    row = world._body_row(identity)
    check_shapes(shapes, int(row["kind"]), [row["angle"].item()], int(row["continuous"]))
    check_grid_stands(shapes, row["angular_velocity"].item())
    check_own_values(world, shapes)


def _add(world, identity, shapes, new) -> np.ndarray:
    """Give a body its shapes, of which the new ones have no rows yet. Returns the ids of these."""
    at = world._row_number(identity)
    world._shapes_of[identity] = shapes
    ids = add_shapes(world, at, 1, new)
    refresh_mass(world, identity)
    if world.bodies["quarantined"][at]:
        own = world.shapes["body"] == identity
        world.pairs.free_proxies(world.shapes["proxy"][own])
        world.shapes["proxy"][own] = -1
    world.awake.forget_shapes()
    sleep.forget(world)
    world._tiers.pop(identity, None)
    world._sources.pop(identity, None)
    return ids


def shapes_for_tier(shapes: Sequence[Shape], tier: str | None) -> tuple:
    """The shapes that stand for one PixelMask in a tier; as they are for None. Raises ValueError, TypeError."""
    if tier is None:
        return tuple(shapes)
    if len(shapes) != 1 or not isinstance(shapes[0], PixelMask):
        raise ValueError(f"tier {tier!r} needs exactly one PixelMask (got {checks.shown(shapes)})")
    return fit(shapes[0], tier)


def set_tier(world: WorldState, identity: int, tier: str | None) -> None:
    """Collide a body's sprite more or less exactly.
    Raises ValueError for an unknown tier or a body without a sprite."""
    world._row_number(identity)
    source = world._sources.get(identity, world._shapes_of[identity])
    set_shapes(world, identity, shapes_for_tier(source, tier))
    if tier is not None:
        world._tiers[identity], world._sources[identity] = tier, source
