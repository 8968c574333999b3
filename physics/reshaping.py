"""What shapes a body has, and what it weighs with them: what a user asks for is checked first, as in editing.py."""

from collections.abc import Sequence

import numpy as np

from physics import checks
from physics.collision.kept_forces import KeptForces
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.mask_exchange import exchange_mask
from physics.shape_rows import add_shapes, check_ids
from physics.shapes.approximate import fit
from physics.shapes.kinds import Shape
from physics.shapes.mask import PixelMask
from physics.shapes.rows import check_shapes, set_mass, weigh
from physics.shapes.tiles import TileGrid
from physics.tables.body import DYNAMIC
from physics.tables.shape import PART
from physics.world_state import WorldState


def check_grid_stands(shapes: Sequence[Shape], turn: float, what: str = "angular_velocity") -> None:
    """Raises ValueError for a TileGrid whose body turns, or is turned."""
    if turn != 0.0 and any(isinstance(shape, TileGrid) for shape in shapes):
        raise ValueError(f"{what} must be 0 for a body with a TileGrid, which cannot turn (got {turn})")


def set_mass_of(world: WorldState, identity: int, mass: float) -> None:
    """Have a body weigh so much, whatever its densities say."""
    at = world._row_number(identity)
    world._given.rows["mass"][at] = mass
    used, density = world._shapes_of[identity], float(world._given.rows["density"][at])
    set_mass(world.bodies[at : at + 1], weigh(used, density, mass), used, world.effects.response)
    refresh_centers(np.array([at]), world.bodies)


def refresh_mass(world: WorldState, identity: int) -> None:
    """Weigh a body anew: its shapes, its kind or what it is made of changed. Its neighbours wake."""
    at = world._row_number(identity)
    given, used = world._given.rows[at], world._shapes_of[identity]
    mass = weigh(used, float(given["density"]), float(given["mass"]))
    set_mass(world.bodies[at : at + 1], mass, used, world.effects.response)
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
    own = (world.shapes["body"] == identity) & (world.shapes["role"] != PART)
    return tuple(world.shapes["id"][own].tolist())


def set_shapes(world: WorldState, identity: int, shapes: Sequence[Shape]) -> None:
    """Replace a body's shapes; what it says of them stays, and contacts where the new surface is the old one keep their
    forces. Masks that take the place of masks keep their ids. Raises TypeError, ValueError."""
    ids, before = shape_ids(world, identity), world._shapes_of.get(identity, ())
    _check(world, identity, shapes, ids)
    check_ids(world, 1, shapes)
    sleep.disturb(world, [identity])
    masks = [each for each in shapes if isinstance(each, PixelMask)]
    if len(before) == len(shapes) == len(masks) and all(isinstance(each, PixelMask) for each in before):
        for place, (shape_id, mask) in enumerate(zip(ids, masks, strict=True)):
            exchange_mask(world, identity, place, shape_id, mask)
    else:
        kept = KeptForces(world, np.flatnonzero(world.shapes["body"] == identity))
        world._drop_shapes(world.shapes["body"] != identity)
        _add(world, identity, tuple(shapes), tuple(shapes))
        kept.hand_on(world, np.flatnonzero(world.shapes["body"] == identity))
    world._tiers.pop(identity, None)
    world._sources.pop(identity, None)


def add_shape(world: WorldState, identity: int, shape: Shape) -> int:
    """Add a shape behind those that a body has. Returns its id. Raises TypeError, ValueError."""
    world._row_number(identity)
    together = (*world._shapes_of[identity], shape)
    _check(world, identity, together, [])
    check_ids(world, 1, (shape,))
    return int(_add(world, identity, together, (shape,))[0])


def remove_shape(world: WorldState, identity: int, shape_id: int) -> None:
    """Take a shape away from a body. Raises KeyError for an id that is none of its shapes', TypeError, ValueError."""
    shape_id, ids = checks.whole("shape_id", shape_id, 0, 2**62), shape_ids(world, identity)
    if shape_id not in ids:
        raise checks.NoSuchId(f"shape_id must be one of body {identity}'s, {list(ids)} (got {shape_id})")
    rest = tuple(shape for each, shape in zip(ids, world._shapes_of[identity], strict=True) if each != shape_id)
    _check(world, identity, rest, [shape_id])
    sleep.disturb(world, [identity])
    world._drop_shapes(world.shapes["owner"] != shape_id)
    _add(world, identity, rest, ())


def check_own_values(world: WorldState, shapes: Sequence[Shape]) -> None:
    """Raises ValueError for shapes that are sensors of their own in a world without the effect."""
    world._needs("sensors", "a shape with_(sensor=True)", any(shape.sensor for shape in shapes))


def check_weight(world: WorldState, shapes: Sequence[Shape], kind: int, mass: float) -> None:
    """Raises ValueError for masks without a pixel where they were all that weighs of a body that is pushed."""
    empty = [each for each in shapes if isinstance(each, PixelMask) and not each.area]
    if world.effects.response and kind == DYNAMIC and empty and len(empty) == len(shapes) and mass == 0.0:
        raise ValueError(
            f"shapes of a dynamic body must have a solid pixel, or it a mass (got {checks.shown(empty[0])})"
        )


def _check(world, identity, shapes, gone):
    """Raises what the shapes that a user wants for a body, and the ids of those that go, call for."""
    world._unlocked()
    if np.isin(world.characters.rows["shape"], gone).any():
        raise ValueError(f"shapes of body {identity} must stay: it is a Character's, who walks by its shape")
    row = world._body_row(identity)
    check_shapes(shapes, int(row["kind"]), [row["angle"].item()])
    check_grid_stands(shapes, row["angular_velocity"].item())
    check_own_values(world, shapes)
    check_weight(world, shapes, int(row["kind"]), world._given.rows["mass"][world._row_number(identity)].item())


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


def rebuild_masks(world: WorldState) -> None:
    """Give masks the rows that the world's effects call for now: where bodies are pushed, the parts of their outlines.

    Bodies keep their tiers; their shapes get new ids."""
    for identity, shapes in [*world._shapes_of.items()]:
        if any(isinstance(shape, PixelMask) for shape in shapes):
            tier, source = world._tiers.get(identity), world._sources.get(identity)
            sleep.disturb(world, [identity])
            world._drop_shapes(world.shapes["body"] != identity)
            _add(world, identity, shapes, shapes)
            if tier is not None and source is not None:
                world._tiers[identity], world._sources[identity] = tier, source


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
