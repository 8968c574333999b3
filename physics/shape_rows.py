"""The SHAPE rows of bodies: what a body's shapes, and the parts of its masks' outlines, have in the tables."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.kinds import Shape
from physics.shapes.lines import Chain
from physics.shapes.mask import PixelMask
from physics.shapes.outline import outline_by_tile
from physics.shapes.outline_tiles import OutlinePart
from physics.shapes.rows import is_snapped, rounding_of
from physics.shapes.surface import Stretch, surfaces_of
from physics.tables.body import STATIC
from physics.tables.shape import PART, PIXELS, WHOLE, WHOLE_MASK
from physics.world_state import WorldState

MATERIAL = ("density", "friction", "restitution", "rolling_resistance", "surface_speed")
LAST_SHAPE = 2**31 - 1  # of the ids: candidates are told in 32 bits


def check_ids(world: WorldState, bodies: int, shapes: Sequence[Shape]) -> None:
    """Raises ValueError where a world has no ids left for these shapes of so many new bodies; none is given twice."""
    room = LAST_SHAPE - world._next_shape
    if room < LAST_SHAPE // 2 and bodies * len(rows_of_shapes(shapes, world.effects.response)) > room:
        raise ValueError(
            f"shapes must be at most {LAST_SHAPE} in the life of a world, whose ids are never given twice "
            f"(got {bodies} bodies with {len(shapes)} more each, after {world._next_shape}): make a new World"
        )


def add_shapes(world: WorldState, first_row: int, bodies: int, shapes: Sequence[Shape]) -> np.ndarray:
    """Append the SHAPE rows of new shapes for each of the bodies that start at a row, with what the body says of them
    or they of themselves, and give them places in the broad phase. Returns their ids."""
    pieces = rows_of_shapes(shapes, world.effects.response)
    rows = _append_rows(world, first_row, bodies, pieces)
    for i, piece in enumerate(pieces):
        each = rows[i :: len(pieces)]
        each["owner"] = each["id"] - i + piece.owner
    return rows["id"][rows["role"] != PART]


def _append_rows(world, first_row, bodies, pieces) -> np.ndarray:
    """SHAPE rows of pieces for each of the bodies that start at a row: all but who owns them."""
    n, k = bodies, len(pieces)
    ids = np.arange(world._next_shape, world._next_shape + n * k)
    if n * k == 0:
        return world._shapes.rows[:0]
    world._tidy_library()
    rows = world._shapes.append(n * k)
    world._next_shape += n * k
    owners = np.repeat(np.arange(first_row, first_row + n), k)
    rows["id"], rows["body"], rows["body_row"] = ids, world.bodies["id"][owners], owners
    given = world._given.rows[owners]
    for i, (shape, role, inner, _, tile) in enumerate(pieces):
        each = rows[i::k]
        each["role"], each["inner"], each["tile"] = role, inner, tile
        each["kind"], each["geometry"], each["wrapped"] = world.library.add(shape)
        each["radius"], each["local_x"], each["local_y"] = rounding_of(shape)
        each["snap"] = is_snapped(shape)
        say(each, given[i::k], shape)
    _enter(world, rows)
    return rows


class NewParts(NamedTuple):
    """Parts of a mask's outline that have no rows yet."""

    tiles: ArrayLike  # (n,) int64, as `tile` in SHAPE
    inner: ArrayLike  # (n,) int64, as in SHAPE
    shapes: Sequence[Circle | Capsule | Polygon | Chain]  # in body space


NONE = NewParts((), (), ())


def append_parts(world: WorldState, template: np.ndarray, parts: NewParts) -> None:
    """Append SHAPE rows of further parts of a mask, whose own row is the one row of the template."""
    count = len(parts.shapes)
    if not count:
        return
    rows = world._shapes.append(count)
    rows[:] = template
    rows["id"] = np.arange(world._next_shape, world._next_shape + count)
    world._next_shape += count
    rows["role"], rows["snap"] = PART, False
    rows["tile"], rows["inner"] = parts.tiles, parts.inner
    rows["kind"], rows["geometry"], rows["wrapped"] = world.library.add_parts(parts.shapes).T
    rows["radius"], rows["local_x"], rows["local_y"] = np.array([rounding_of(shape) for shape in parts.shapes]).T
    _enter(world, rows)


def _enter(world, rows):
    """Give new rows places in the broad phase."""
    owners = rows["body_row"]
    world.pairs.add_proxies(rows, np.arange(len(rows)), world.bodies["kind"][owners] == STATIC)
    if world.sleeps:
        # Whose body is in the step already is not taken into it again.
        world.pairs.set_awake(rows["proxy"][world.bodies["active"][owners]], True)


def say(rows: np.ndarray, given: np.ndarray, shape: Shape) -> None:
    """Write what a body says of its shapes, GIVEN rows, to SHAPE rows, or what the shape says itself."""
    for name in (*MATERIAL, "membership", "mask", "sensor"):
        rows[name] = given[name]
    for name in ("material", "filter", "sensor"):
        rows["own_" + name] = getattr(shape, name) is not None
    if shape.material is not None:
        for name in MATERIAL:
            rows[name] = getattr(shape.material, name)
    if shape.filter is not None:
        rows["membership"], rows["mask"] = shape.filter.membership, shape.filter.mask
    if shape.sensor is not None:
        rows["sensor"] = shape.sensor


class Piece(NamedTuple):
    """What one SHAPE row stands for."""

    shape: Shape
    role: int
    inner: int  # see SHAPE
    owner: int  # which piece it is a part of
    tile: int  # see SHAPE


def rows_of_shapes(shapes: Sequence[Shape], pushed: bool) -> list[Piece]:
    """The rows that a body's shapes need: one each, and where bodies are pushed, the parts of each mask's outline."""
    found: list[Piece] = []
    for shape in shapes:
        masked = pushed and isinstance(shape, PixelMask)
        owner = len(found)
        found.append(Piece(shape, PIXELS if masked else WHOLE, 0, owner, WHOLE_MASK))
        if masked:
            found += _parts(shape, owner)
    return found


def _parts(mask, owner) -> list[Piece]:
    """The parts of a mask's outline."""
    return [
        Piece(part.shape.with_(mask.material, mask.filter, mask.sensor), PART, part.inner, owner, tile)
        for tile, parts in pushed_parts(mask)
        for part in parts
    ]


def pushed_parts(mask: PixelMask) -> Sequence[tuple[int, Sequence[OutlinePart | Stretch]]]:
    """(number of the tile, its parts) of a mask's outline, see outline_by_tile.

    Of a mask that is open from below all of its upper side, in one piece.
    """
    return [(WHOLE_MASK, surfaces_of(mask))] if mask.one_way else outline_by_tile(mask)
