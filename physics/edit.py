"""Functions that add, change and remove bodies and shapes. They check all arguments before they change anything."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.annotations import ContinuousName, KindName, Points, TierName
from physics.broadphase.proxies import write_rectangles
from physics.contacts.cache import shift_center
from physics.contacts.matching import KeptImpulses
from physics.dynamics.integrate import refresh_centers, write_center
from physics.hints import MATERIALS
from physics.islands import sleep
from physics.shapes.approximate import fit
from physics.shapes.kinds import check_shapes
from physics.shapes.library import find_equal, rounding_of, rows_in_tiles, set_mass, weigh
from physics.shapes.mask import PixelMask
from physics.shapes.outline import is_tiled, keep_tiles, polygons, tiled_parts
from physics.shapes.shape import Filter, Material, Shape, checked_filter, checked_material
from physics.shapes.values import TileGrid
from physics.tables.body import AUTO, CONTINUOUS, DYNAMIC, KINDS, KINEMATIC, OFF, STATIC
from physics.tables.contact import without_removed
from physics.tables.shape import MASK, PART, PIXELS, WHOLE, WHOLE_MASK
from physics.tables.table import row_number, rows_of
from physics.world_state import WorldState

# ---- shape rows ------------------------------------------------------------------------------------------------------
# SHAPE rows of the shapes of a body, and of the parts of the outlines of its masks.

LAST_SHAPE = 2**31 - 1  # greatest shape id, because candidates are reported in 32 bits


def check_ids(world: WorldState, bodies: int, shapes: Sequence[Shape]) -> None:
    """Raise ValueError if the world has too few unused shape ids for a number of new bodies, each with `shapes`."""
    room = LAST_SHAPE - world._next_shape
    if room < LAST_SHAPE // 2 and bodies * len(rows_of_shapes(shapes, world.effects.response)) > room:
        raise ValueError(
            f"shapes must be at most {LAST_SHAPE} in the life of a world, whose ids are never given twice "
            f"(got {bodies} bodies with {len(shapes)} more each, after {world._next_shape}): make a new World"
        )


def add_shapes(world: WorldState, first_row: int, bodies: int, shapes: Sequence[Shape]) -> np.ndarray:
    """Append SHAPE rows for new shapes of bodies, and add the proxies. Return the ids (n,) of the new shapes.

    Rows of parts of a mask's outline are appended too, but their ids are not returned. first_row: row number of the
    first body; bodies: number of consecutive BODY rows, each of which gets all shapes. A shape's own values override
    those of the body.
    """
    pieces = rows_of_shapes(shapes, world.effects.response)
    rows = _append_rows(world, first_row, bodies, pieces)
    for i, piece in enumerate(pieces):
        each = rows[i :: len(pieces)]
        each["parent"] = each["id"] - i + piece.parent
    return rows["id"][rows["role"] != PART]


def _append_rows(world, first_row, bodies, pieces) -> np.ndarray:
    """Append a SHAPE row for each Piece in `pieces` and each body in a range of bodies, and return the new rows.

    first_row: row number of the first body; bodies: number of bodies. The column `parent` is not written.
    """
    n, k = bodies, len(pieces)
    ids = np.arange(world._next_shape, world._next_shape + n * k)
    if n * k == 0:
        return world._shapes.rows[:0]
    world._tidy_library()
    rows = world._shapes.append(n * k)
    world._next_shape += n * k
    owners = np.repeat(np.arange(first_row, first_row + n), k)
    rows["id"], rows["body"], rows["body_row"] = ids, world.bodies["id"][owners], owners
    given = world._definitions.rows[owners]
    for i, (shape, role, inner, _, tile) in enumerate(pieces):
        each = rows[i::k]
        each["role"], each["inner"], each["tile"] = role, inner, tile
        each["kind"], each["geometry"], each["wrapped"] = world.library.add(shape)
        each["radius"], each["local_x"], each["local_y"] = rounding_of(shape)
        each["snap"] = shape.snap
        write_own_values(each, given[i::k], shape)
    _enter(world, rows)
    return rows


class NewParts(NamedTuple):
    """Convex parts of a mask's outline that have no SHAPE rows yet."""

    tiles: ArrayLike  # (n,) int64 values of SHAPE.tile
    inner: ArrayLike  # (n,) int64 values of SHAPE.inner
    shapes: Sequence[Shape]  # (n,) parts in body space


NONE = NewParts((), (), ())


def append_parts(world: WorldState, template: np.ndarray, parts: NewParts) -> None:
    """Append SHAPE rows for new parts of a mask's outline. template: array (1,), the SHAPE row of the mask."""
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
    """Add the proxies of new SHAPE rows to the broad phase."""
    owners = rows["body_row"]
    world.pairs.add_proxies(rows, np.arange(len(rows)), world.bodies["kind"][owners] == STATIC)
    if world.sleeps:
        # A body that is already awake is not included again, so its new proxies are marked as awake here.
        world.pairs.set_awake(rows["proxy"][world.bodies["active"][owners]], True)


def write_own_values(rows: np.ndarray, given: np.ndarray, shape: Shape) -> None:
    """Write the material, filter and sensor flag of a shape to SHAPE rows.

    A value that the shape does not have is taken from `given`, the BODY_DEF rows of the bodies.
    """
    for name in (*MATERIALS, "membership", "mask", "sensor"):
        rows[name] = given[name]
    for name in ("material", "filter", "sensor"):
        rows["own_" + name] = getattr(shape, name) is not None
    if shape.material is not None:
        for name in MATERIALS:
            rows[name] = getattr(shape.material, name)
    if shape.filter is not None:
        rows["membership"], rows["mask"] = shape.filter.membership, shape.filter.mask
    if shape.sensor is not None:
        rows["sensor"] = shape.sensor


class Piece(NamedTuple):
    """The values for one SHAPE row, which belongs to a shape or to a part of a mask's outline."""

    shape: Shape
    role: int  # WHOLE, PIXELS or PART
    inner: int  # see SHAPE
    parent: int  # index of the piece of the whole mask, or of this piece if it is not a PART
    tile: int  # see SHAPE


def rows_of_shapes(shapes: Sequence[Shape], pushed: bool) -> list[Piece]:
    """Return a Piece for each shape and, if `pushed` (the effect `response`), for each part of a mask's outline."""
    found: list[Piece] = []
    for shape in shapes:
        tiles, owner = shape._response_parts() if pushed else (), len(found)
        found.append(Piece(shape, PIXELS if tiles else WHOLE, 0, owner, WHOLE_MASK))
        found += [
            Piece(part.shape.with_(shape.material, shape.filter, shape.sensor), PART, part.inner, owner, tile)
            for tile, parts in tiles
            for part in parts
        ]
    return found


# ---- mask exchange ---------------------------------------------------------------------------------------------------
# Replacement of one mask of a body by another: after carving, and for the next frame of an animation.


def replace_mask(
    world: WorldState, identity: int, place: int, shape_id: int, mask: PixelMask, changed: Sequence[int] | None = None
) -> None:
    """Replace a mask of a body by another mask. The shape id stays, and equal parts keep their SHAPE rows.

    identity: id of the body; place: index of the mask in the body's shapes; shape_id: id of the mask; mask: the new
    mask; changed: numbers of the tiles in which the two masks may differ, None: all tiles. Bodies that touch changed
    parts wake. Contacts on unchanged parts keep their cached forces. O(changes), and a few passes over the SHAPE rows.
    """
    at, shapes = world._row_number(identity), world.shapes
    body, used = world.bodies[at : at + 1], list(world._shapes_of[identity])
    before, used[place] = used[place], mask
    old, fresh = _differences(world, shape_id, before, mask, changed)
    still = body["kind"][0] != DYNAMIC
    if not (still and sleep.disturb_shapes(world, identity, shapes["id"][old])):
        sleep.disturb(world, [identity])
    kept = KeptImpulses(world, old)
    own = rows_of(shapes, [shape_id])  # the parts follow this row, so their removal does not move it
    world._templates.clear()  # the geometry of a mask may be overwritten in place
    shapes["geometry"][own] = world.library.replace(before.bare, mask.bare, changed, shapes)
    if len(old):
        keep = np.ones(len(shapes), bool)
        keep[old] = False
        world._drop_shapes(keep)
    world._shapes_of[identity] = tuple(used)
    if any(getattr(mask, name) != getattr(before, name) for name in ("material", "filter", "sensor", "snap")):
        _rewrite_own_values(world, at, shape_id, mask)
    world._tidy_library()
    append_parts(world, world.shapes[own], fresh)
    world._write_run(at)
    _weigh(world, at, used)
    new = np.arange(len(world.shapes) - len(fresh.shapes), len(world.shapes))
    _rejoin(world, at, np.append(own, new) if still else rows_of_parent(world, shape_id))
    kept.transfer(world, new)


def exchange_cells(world: WorldState, identity: int, cells: Any, solid: Any) -> None:
    """Make cells of the TileGrid of a body solid or empty. The shape id does not change.

    identity: id of the body; cells: (n, 2) int, (column, row) of each cell; solid: a bool for all cells, or (n,) bools.
    Bodies that touch a changed cell wake. Contacts with shapes near changed cells are detected again, and keep their
    cached forces only where the new surface coincides with the old one. All other contacts are unchanged. O(cells of
    the grid). Raises TypeError if cells or solid have a wrong type; ValueError for cells outside the grid, or for a
    body without exactly one TileGrid; RuntimeError during a step.
    """
    world._unlocked()
    at, used = world._row_number(identity), list(world._shapes_of[identity])
    grids = [(k, shape) for k, shape in enumerate(used) if isinstance(shape, TileGrid)]
    if len(grids) != 1:
        raise ValueError(f"set_cells needs a body with one TileGrid; body {identity} has {checks.shown(tuple(used))}")
    place, before = grids[0]
    cells, solid = checked_cells(cells, solid, *before.solid.shape)
    columns, rows = cells.T
    wanted = before.solid.copy()
    wanted[rows, columns] = solid
    changed = np.zeros(wanted.shape, bool)
    other = before.one_way | (before.slopes > 0.0).any(axis=2)
    changed[rows, columns] = ((before.solid != wanted) | other)[rows, columns]
    if not changed.any():
        return
    slopes = np.where(changed[:, :, None], 0.0, before.slopes)
    after = TileGrid(wanted, before.tile_size, before.one_way & ~changed, slopes).with_values_of(before)
    shape_id = shape_ids(world, identity)[place]
    touching = rows_at_cells(world, at, before.tile_size, changed, world.tolerances.slop)
    _wake_at_cells(world, at, touching)
    near = world.shapes["id"][rows_at_cells(world, at, before.tile_size, changed, world.tolerances.speculative)]
    own = rows_of(world.shapes, [shape_id])
    found = world.contact_rows
    goes = ((found["shape_a"] == shape_id) & np.isin(found["shape_b"], near)) | (
        (found["shape_b"] == shape_id) & np.isin(found["shape_a"], near)
    )
    kept = KeptImpulses(world, own)
    if len(kept.contacts):  # only contacts near changed cells are detected again
        kept.contacts, kept.others = found[goes], np.intersect1d(kept.others, near)
        world.contact_rows = found[~goes]
    used[place] = after
    world.shapes["geometry"][own] = world.library.add(after)[1]
    world._shapes_of[identity] = tuple(used)
    world._tidy_library()
    _rejoin(world, at, own)
    kept.transfer(world, own)


def checked_cells(cells: Any, solid: Any, rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Check the arguments of exchange_cells. Return (cells (n, 2) int64, solid (n,) bool).

    rows, columns: size of the grid in cells. Raises TypeError or ValueError for invalid arguments.
    """
    found = checks.columns("cells", cells)
    if found.size and np.asarray(cells).dtype.kind not in "iu":
        raise TypeError(f"cells must be whole numbers (column, row) (got {checks.shown(cells)})")
    found = found.astype(np.int64)
    bad = np.flatnonzero(((found < 0) | (found >= (columns, rows))).any(axis=1))
    if len(bad):
        raise ValueError(
            f"cells[{bad[0]}] must be (column, row) within 0..{columns - 1} and 0..{rows - 1} "
            f"(got {tuple(found[bad[0]].tolist())})"
        )
    try:
        flags = np.asarray(solid)
    except ValueError:  # rows of different lengths
        flags = None
    if flags is None or flags.dtype != np.bool_:
        raise TypeError(f"solid must be a bool, or one for each of cells (got {checks.shown(solid)})")
    if flags.shape not in ((), (len(found),)):
        raise ValueError(f"solid must be a bool or have shape ({len(found)},), as cells has (got {flags.shape})")
    return found, np.broadcast_to(flags, len(found))


def rows_at_cells(world: WorldState, at: int, size: float, cells: np.ndarray, margin: float) -> np.ndarray:
    """Return the SHAPE row numbers of the shapes near marked cells of a TileGrid, except shapes of the grid's body.

    A shape is near if its AABB, enlarged by `margin` [px], overlaps or touches a marked cell. at: row number of the
    grid's body; size: size of a cell [px]; cells: bool array [row, column], True for marked cells.
    """
    body, marked = world.bodies[at], np.argwhere(cells)
    origin = np.array([body["x"], body["y"]])
    lower, upper = (origin + size * (each[::-1] + k) for k, each in enumerate((marked.min(axis=0), marked.max(axis=0))))
    world.queries.begin(world)
    rows = world.queries.rows_in(world, lower - margin, upper + margin)
    rows = rows[world.shapes["body_row"][rows] != at]
    shapes, sums = world.shapes[rows], np.pad(np.cumsum(np.cumsum(cells, axis=0), axis=1), ((1, 0), (1, 0)))
    spans = []
    for axis, count in enumerate(cells.shape[::-1]):
        name = "xy"[axis]
        first = np.ceil((shapes[f"min_{name}"] - margin - origin[axis]) / size) - 1.0  # closed: boundaries count
        last = np.floor((shapes[f"max_{name}"] + margin - origin[axis]) / size) + 1.0
        spans += [np.clip(each, 0, count).astype(np.int64) for each in (first, last)]
    left, right, top, bottom = spans
    return rows[sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left] > 0]


def _wake_at_cells(world, at, rows):
    """Wake the sleeping islands at changed cells of a grid, and have the next step visit other bodies at these cells.

    Kinematic bodies are visited; static bodies are visited only if they touch the grid. at: row number of the grid's
    body; rows: SHAPE row numbers of the shapes at the changed cells.
    """
    if not world.sleeps:
        return
    bodies = world.bodies[np.unique(world.shapes["body_row"][rows])]
    dynamic = bodies["kind"] == DYNAMIC
    sleep.wake(world, bodies["island"][dynamic & ~bodies["awake"]].tolist())
    others = bodies["id"][~dynamic]
    met_pairs = [
        table[["body_a", "body_b"]] for table in (world.sleeping_set.touching_pairs, world.sleeping_set.sensing_pairs)
    ]
    mine = world.bodies["id"][at]
    met = [np.where(each["body_a"] == mine, each["body_b"], -1) for each in met_pairs]
    met += [np.where(each["body_b"] == mine, each["body_a"], -1) for each in met_pairs]
    touched = others[np.isin(others, np.concatenate(met)) | (bodies["kind"][~dynamic] == KINEMATIC)]
    sleep.disturb(world, touched.tolist())


def rows_of_parent(world: WorldState, shape_id: int) -> np.ndarray:
    """Return the SHAPE row numbers (n,) of a shape, given by its id, and of the parts of its outline."""
    return np.flatnonzero(world.shapes["parent"] == shape_id)


def _differences(world, shape_id, before, mask, changed):
    """Compare the outline parts of a new mask with those of the old one. Return (rows to remove, NewParts to add).

    The rows are SHAPE row numbers. The SHAPE rows of parts that stay are updated. shape_id: id of the mask; before: the
    old mask; mask: the new one; changed: numbers of the tiles in which they may differ, None: all.
    """
    shapes = world.shapes
    if not world.effects.response:
        return np.zeros(0, np.int64), NONE
    if changed is not None and all(is_tiled(each) and not each.one_way for each in (mask, before)):
        return _differences_in_tiles(world, shape_id, before, mask, changed)
    parts = np.flatnonzero((shapes["parent"] == shape_id) & (shapes["role"] == PART))
    known = {world.library.shape_of(shapes[row]): row for row in parts.tolist()}
    fresh = []
    for tile, each in mask._response_parts():
        for part in each:
            row = known.pop(part.shape, -1)
            if row < 0:
                fresh.append((tile, part.inner, part.shape))
            else:
                shapes["inner"][row], shapes["tile"][row] = part.inner, tile
    return np.array(sorted(known.values()), np.int64), NewParts(*zip(*fresh, strict=True)) if fresh else NONE


def _differences_in_tiles(world, shape_id, before, mask, changed):
    """Do the work of _differences for two tiled masks that differ only in the tiles with the numbers `changed`."""
    tiles = keep_tiles(mask.bare, before.bare, before.tiles.differences(mask.tiles, changed))
    if not tiles:
        return np.zeros(0, np.int64), NONE
    wanted = np.zeros(len(mask.tiles.words), bool)
    wanted[tiles] = True
    shapes, new = world.shapes, tiled_parts(mask.bare, tiles)
    parts = rows_in_tiles(shapes, shape_id, wanted)
    found = find_equal(world.library.tables, shapes, parts, new.corners, new.counts)
    stays, goes = found >= 0, np.ones(len(parts), bool)
    shapes["inner"][parts[found[stays]]] = new.inner[stays]
    goes[found[stays]] = False
    fresh = np.flatnonzero(~stays)
    return parts[goes], NewParts(new.tiles[fresh], new.inner[fresh], polygons(new.corners, new.counts, fresh))


def _rewrite_own_values(world, at, shape_id, mask):
    """Write material, filter, sensor flag and `snap` of a mask to the SHAPE rows of the mask and of its parts.

    at: row number of the body; shape_id: id of the mask.
    """
    rows = rows_of_parent(world, shape_id)
    shapes, pairs = world.shapes, world.pairs
    some = shapes[rows]
    write_own_values(some, world._definitions.rows[at], mask)
    shapes[rows] = some
    shapes["snap"][rows] = mask.snap & (some["role"] != PART)
    pairs.set_filter(some["proxy"], Filter(*(some[name][0].item() for name in ("membership", "mask"))))
    pairs.set_sensor(shapes, rows)


def _rejoin(world, at, touched):
    """Mark shapes of a body, so that the broad phase searches their candidate pairs again in the next step.

    at: row number of the body; touched: SHAPE row numbers.
    """
    world.pairs.touch(world.shapes["proxy"][touched])
    if world.bodies["quarantined"][at]:
        world.pairs.free_proxies(world.shapes["proxy"][touched])
        world.shapes["proxy"][touched] = -1
    elif world.sleeps and not (world.bodies["active"][at] and world.bodies["kind"][at] == DYNAMIC):
        # Bodies that are not awake get no swept AABB in the next step, so they get one here; so do bodies that the last
        # step visited only because they were edited or moved before it.
        count = write_rectangles(world, touched)
        world.pairs.search_again.append(world.pairs.changed[:count].copy())
    world.queries.seen = ()
    world.contact_rows = without_removed(world.bodies, world.shapes, world.contact_rows)


# ---- reshaping -------------------------------------------------------------------------------------------------------
# The shapes of a body, and its mass. Arguments are checked before anything is changed.


def check_grid_stands(shapes: Sequence[Shape], turn: float, what: str = "angular_velocity") -> None:
    """Raise ValueError if there is a TileGrid among the shapes and `turn` is not 0, because a TileGrid cannot rotate.

    turn: angle [rad] or angular velocity [rad/s]; what: name of this quantity, for the message.
    """
    for shape in shapes if turn != 0.0 else ():
        if not shape._may_turn:
            raise ValueError(
                f"{what} must be 0 for a body with a {type(shape).__name__}, which cannot turn (got {turn})"
            )


def set_mass_of(world: WorldState, identity: int, mass: float) -> None:
    """Set the mass of a body (id), in place of the mass computed from the densities of its shapes.

    mass: [density px²]; 0: use the densities.
    """
    at = world._row_number(identity)
    world._definitions.rows["mass"][at] = mass
    used, density = world._shapes_of[identity], float(world._definitions.rows["density"][at])
    set_mass(world.bodies[at : at + 1], weigh(used, density, mass), used, world.effects.response)
    refresh_centers(np.array([at]), world.bodies)


def _weigh(world, at, used):
    """Write mass, inertia and centre of mass of a body (row number) with shapes `used`; update its cached contacts."""
    given, body = world._definitions.rows[at], world.bodies[at]
    x, y = body["center_x"], body["center_y"]
    mass = weigh(used, float(given["density"]), float(given["mass"]))
    set_mass(world.bodies[at : at + 1], mass, used, world.effects.response)
    refresh_centers(np.array([at]), world.bodies)
    if body["center_x"] != x or body["center_y"] != y:
        shift_center(world.contact_rows, body["id"], body["center_x"] - x, body["center_y"] - y)


def refresh_mass(world: WorldState, identity: int) -> None:
    """Recompute the mass and inertia of a body (id) after its shapes, kind or material changed. Wake the body."""
    at = world._row_number(identity)
    _weigh(world, at, world._shapes_of[identity])
    refresh_pose(world, identity, at)


def refresh_pose(world: WorldState, identity: int, at: int) -> int:
    """Update the centre of mass and the proxies of a moved body. Wake the body and the bodies that touch it.

    identity: id of the body; at: its row number. Return its row number afterwards, which may differ, because waking may
    drop the rows of removed bodies (see sleep.disturb_one).
    """
    at = sleep.disturb_one(world, identity, at)
    write_center(world._bodies, at)
    if world._bodies.columns["kind"][at] != STATIC:
        return at  # each step compares the swept AABBs with the AABBs
    run = world._runs.columns
    if run["count"][at] == 1:
        slot = world._shapes.columns["proxy"][row_number(world._shapes, run["first"][at])]
        if slot >= 0:
            world.pairs.proxies["changed"][slot] = True
    else:
        world.pairs.touch(world._shapes.rows["proxy"][world._shape_rows(at)])
    return at


def shape_ids(world: WorldState, identity: int) -> tuple[int, ...]:
    """Return the ids of a body's shapes, in the order of the shapes. identity: id of the body."""
    at = world._row_number(identity)
    own = world.shapes[world._shape_rows(at)]
    return tuple(own["id"][own["role"] != PART].tolist())


def set_shapes(world: WorldState, identity: int, shapes: Sequence[Shape]) -> None:
    """Replace the shapes of a body (id). Its tier becomes None.

    The other values of the body stay, and contacts on surface that did not change keep their impulses. The shape ids
    stay if all old and new shapes are masks and their number is unchanged; otherwise the shapes get new ids. Raises
    TypeError or ValueError for invalid shapes.
    """
    ids, before = shape_ids(world, identity), world._shapes_of.get(identity, ())
    _check(world, identity, shapes, ids)
    check_ids(world, 1, shapes)
    sleep.disturb(world, [identity])
    masks = [each for each in shapes if isinstance(each, PixelMask)]
    if len(before) == len(shapes) == len(masks) and all(each._kind == MASK for each in before):
        for place, (shape_id, mask) in enumerate(zip(ids, masks, strict=True)):
            replace_mask(world, identity, place, shape_id, mask)
    else:
        at = world._row_number(identity)
        own, keep = world._shape_rows(at), np.ones(len(world.shapes), bool)
        keep[own] = False
        kept = KeptImpulses(world, own)
        world._drop_shapes(keep)
        _add(world, identity, tuple(shapes), tuple(shapes))
        kept.transfer(world, world._shape_rows(at))
    world._tiers.pop(identity, None)
    world._sources.pop(identity, None)


def add_shape(world: WorldState, identity: int, shape: Shape) -> int:
    """Append a shape to a body (id), and return the id of the shape.

    Raises TypeError or ValueError if the body cannot have the shape.
    """
    world._row_number(identity)
    together = (*world._shapes_of[identity], shape)
    _check(world, identity, together, [])
    check_ids(world, 1, (shape,))
    return int(_add(world, identity, together, (shape,))[0])


def remove_shape(world: WorldState, identity: int, shape_id: int) -> None:
    """Remove a shape from a body. identity: id of the body.

    Raises KeyError if the body has no shape with this id, ValueError if the body cannot have only its other shapes.
    """
    shape_id, ids = checks.whole("shape_id", shape_id, 0, 2**62), shape_ids(world, identity)
    if shape_id not in ids:
        raise checks.NoSuchId(f"shape_id must be one of body {identity}'s, {list(ids)} (got {shape_id})")
    rest = tuple(shape for each, shape in zip(ids, world._shapes_of[identity], strict=True) if each != shape_id)
    _check(world, identity, rest, [shape_id])
    sleep.disturb(world, [identity])
    world._drop_shapes(world.shapes["parent"] != shape_id)
    _add(world, identity, rest, ())


def check_own_values(world: WorldState, shapes: Sequence[Shape]) -> None:
    """Raise ValueError for a sensor or one-way shape if the world lacks the effect `sensors` or `one_way`."""
    world._needs("sensors", "a shape with_(sensor=True)", any(shape.sensor for shape in shapes))
    for shape in shapes:
        world._needs("one_way", f"{type(shape).__name__} with one_way", bool(np.any(getattr(shape, "one_way", False))))


def check_weight(world: WorldState, shapes: Sequence[Shape], kind: int, mass: float) -> None:
    """Raise ValueError if a dynamic body has only masks without solid pixels and no given mass, so that its mass is 0.

    kind: DYNAMIC, KINEMATIC or STATIC; mass: given mass, 0: none. Without the effect `response`, no error is raised.
    """
    empty = [each for each in shapes if each._kind == MASK and each.bounds is None]
    if world.effects.response and kind == DYNAMIC and empty and len(empty) == len(shapes) and mass == 0.0:
        raise ValueError(
            f"shapes of a dynamic body must have a solid pixel (got {checks.shown(empty[0])}): write mass=…, or check "
            "the transparency of the image"
        )


def _check(world, identity, shapes, gone):
    """Raise TypeError or ValueError if a body (id) cannot have these shapes.

    gone: ids of the shapes that the body would lose.
    """
    world._unlocked()
    if np.isin(world.characters.rows["shape"], gone).any():
        raise ValueError(f"shapes of body {identity} must stay: it is a Character's, who walks by its shape")
    row = world._body_row(identity)
    check_shapes(shapes, int(row["kind"]), [row["angle"].item()])
    check_grid_stands(shapes, row["angular_velocity"].item())
    check_own_values(world, shapes)
    check_weight(world, shapes, int(row["kind"]), world._definitions.rows["mass"][world._row_number(identity)].item())


def _add(world, identity, shapes, new) -> np.ndarray:
    """Set the shapes of a body (id), and add SHAPE rows for the shapes `new`. Return the ids of `new`.

    shapes: all shapes of the body; new: those at the end of `shapes` that have no SHAPE rows yet.
    """
    at = world._row_number(identity)
    world._shapes_of[identity] = shapes
    ids = add_shapes(world, at, 1, new)
    world._write_run(at)
    refresh_mass(world, identity)
    if world.bodies["quarantined"][at]:
        own = world._shape_rows(at)
        world.pairs.free_proxies(world.shapes["proxy"][own])
        world.shapes["proxy"][own] = -1
    world.awake.forget_shapes()
    world.contact_rows = without_removed(world.bodies, world.shapes, world.contact_rows)
    world._tiers.pop(identity, None)
    world._sources.pop(identity, None)
    return ids


def rebuild_masks(world: WorldState) -> None:
    """Rebuild the SHAPE rows of all bodies with masks, after the effect `response` was added or removed.

    Masks have rows for the parts of their outlines only with this effect. The shapes of these bodies get new ids; the
    tiers of the bodies stay.
    """
    for identity, shapes in [*world._shapes_of.items()]:
        if any(shape._kind == MASK for shape in shapes):
            tier, source = world._tiers.get(identity), world._sources.get(identity)
            sleep.disturb(world, [identity])
            world._drop_shapes(world.shapes["body"] != identity)
            _add(world, identity, shapes, shapes)
            if tier is not None and source is not None:
                world._tiers[identity], world._sources[identity] = tier, source


def shapes_for_tier(shapes: Sequence[Shape], tier: TierName | None) -> tuple:
    """Return the shapes of physics.fit that replace one PixelMask at a tier, such as "hull".

    If the tier is None, return `shapes` as a tuple. Raises ValueError if `shapes` is not exactly one PixelMask.
    """
    if tier is None:
        return tuple(shapes)
    if len(shapes) != 1 or not isinstance(shapes[0], PixelMask):
        raise ValueError(f"tier {tier!r} needs exactly one PixelMask (got {checks.shown(shapes)})")
    return fit(shapes[0], tier)


def set_tier(world: WorldState, identity: int, tier: TierName | None) -> None:
    """Set the tier of a body (id) that was made from one PixelMask: replace its shapes by those of physics.fit.

    tier: one of TIERS; None: use the PixelMask itself. Raises ValueError for an unknown tier, and for a body that was
    not made from one PixelMask.
    """
    world._row_number(identity)
    source = world._sources.get(identity, world._shapes_of[identity])
    set_shapes(world, identity, shapes_for_tier(source, tier))
    if tier is not None:
        world._tiers[identity], world._sources[identity] = tier, source


# ---- editing ---------------------------------------------------------------------------------------------------------
# Adding bodies, and changing their values; World and Body call these functions. Arguments are checked first, so that
# invalid arguments leave the world unchanged.


class BodyDef(NamedTuple):
    """The definition of a body: the arguments of World.add_body except shapes, position, angle and velocity."""

    kind: KindName = "dynamic"
    angular_velocity: float = 0.0
    mass: float | None = None
    material: Material = Material()
    filter: Filter = Filter.ALL
    sensor: bool = False
    bullet: bool = False
    continuous: ContinuousName = "auto"
    fixed_rotation: bool = False
    gravity_scale: float = 1.0
    allow_sleep: bool = True
    tier: TierName | None = None
    user: Any = None


def add_rows(
    world: WorldState,
    shapes: Sequence[Shape],
    positions: Points,
    velocities: Points,
    angles: Sequence[float] | np.ndarray,
    wanted: BodyDef,
) -> np.ndarray:
    """Add n bodies with the same shapes: check the arguments, append the rows, and return the body ids (n,) int64.

    positions (n, 2) [px]; velocities (n, 2) [px/s]; angles (n,) [rad]; wanted: definition of the bodies. Raises
    TypeError or ValueError for invalid arguments; the world is then unchanged.
    """
    world._unlocked()
    kind = KINDS.index(checks.choice("kind", wanted.kind, KINDS))
    material, filter = checked_material(wanted.material), checked_filter(wanted.filter)
    sensor, bullet = checked_sensor(world, wanted.sensor), checked_bullet(world, wanted.bullet)
    swept = checked_continuous(world, wanted.continuous)
    fixed_rotation = checks.flag("fixed_rotation", wanted.fixed_rotation)
    gravity_scale = checks.number("gravity_scale", wanted.gravity_scale)
    allow_sleep = checks.flag("allow_sleep", wanted.allow_sleep)
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
    users = checks.users(wanted.user, n)
    ids = np.arange(world._next_body, world._next_body + n, dtype=np.int64)
    if n == 0:
        return ids
    world._next_body += n
    given = world._definitions.append(n)
    given["mass"], given["sensor"] = own_mass, sensor
    write_material(given, material)
    given["membership"], given["mask"] = filter.membership, filter.mask
    rows = world._bodies.append(n)
    rows["id"], rows["kind"] = ids, kind
    rows["x"], rows["y"] = np.asarray(positions).T
    rows["vx"], rows["vy"] = np.asarray(velocities).T
    rows["angle"], rows["angular_velocity"] = angles, spin
    for name in ("x", "y", "angle"):
        rows["previous_" + name] = rows["still_" + name] = rows["rocking_" + name] = rows[name]
    rows["gravity_scale"], rows["continuous"], rows["fixed_rotation"] = gravity_scale, swept, fixed_rotation
    rows["allow_sleep"] = allow_sleep
    rows["awake"], rows["fraction"], rows["bullet"], rows["island"] = True, 1.0, bullet, -1
    rows["active"] = not world.sleeps  # so the next step includes them
    if wanted.kind != "dynamic":
        world.awake.mark_dirty(ids.tolist())
    set_mass(rows, mass, used, world.effects.response)
    refresh_centers(np.arange(n), rows)
    first = world._next_shape
    add_shapes(world, world._bodies.count - n, n, used)
    runs, each = world._runs.append(n), (world._next_shape - first) // n
    runs["first"], runs["count"] = np.arange(first, world._next_shape, each) if each else 0, each
    source = tuple(shapes)  # one tuple shared by all bodies, to save memory
    for identity, user in zip(ids.tolist(), users, strict=True):
        world._shapes_of[identity] = used
        if user is not None:
            world._users[identity] = user
        if wanted.tier is not None:
            world._tiers[identity], world._sources[identity] = wanted.tier, source
    return ids


# --- checks of arguments ----------------------------------------------------------------------------------------


def checked_sensor(world: WorldState, value: Any) -> bool:
    """Return a sensor flag as a bool.

    Raises TypeError if `value` is not a bool, ValueError for True in a world without the effect `sensors`.
    """
    value = checks.flag("sensor", value)
    world._needs("sensors", "sensor=True", value)
    return value


def checked_bullet(world: WorldState, value: Any) -> bool:
    """Return a bullet flag as a bool.

    Raises TypeError if `value` is not a bool, ValueError for True in a world without the effect `continuous`.
    """
    value = checks.flag("bullet", value)
    world._needs("continuous", "bullet=True", value)
    return value


def checked_continuous(world: WorldState, value: Any) -> int:
    """Return the index of a mode of continuous collision, such as "toi", in CONTINUOUS.

    Raises TypeError or ValueError for an unknown mode, ValueError for "ray", "swept" and "toi" without the effect.
    """
    swept = CONTINUOUS.index(checks.choice("continuous", value, CONTINUOUS))
    world._needs("continuous", f"continuous={value!r}", swept not in (OFF, AUTO))
    return swept


def write_material(rows: np.ndarray, material: Material) -> None:
    """Write the values of a material to all of the given rows, which are SHAPE or BODY_DEF rows."""
    for name in MATERIALS:
        rows[name] = getattr(material, name)


def set_kind(world: WorldState, identity: int, kind: KindName) -> None:
    """Set the kind of a body (id). The velocities of a body that becomes static are set to 0.

    Raises ValueError if a body of this kind cannot have the present shapes, and for the body of a character unless
    `kind` is "kinematic".
    """
    world._unlocked()
    row = world._body_row(identity)
    if kind != "kinematic" and (world.characters.rows["body"] == identity).any():
        raise ValueError(f"kind must be 'kinematic' for the body of a character (got {kind!r}, body {identity})")
    at = world._row_number(identity)
    shapes, own_mass = world._shapes_of[identity], world._definitions.rows["mass"][at].item()
    check_shapes(shapes, KINDS.index(kind), [row["angle"].item()])
    check_weight(world, shapes, KINDS.index(kind), own_mass)
    row["kind"] = KINDS.index(kind)
    if kind == "static":
        row["vx"] = row["vy"] = row["angular_velocity"] = 0.0
    if kind != "kinematic":
        world._targets.pop(identity, None)
    refresh_mass(world, identity)
    world.pairs.set_still(world.shapes["proxy"][world._shape_rows(at)], kind == "static")
    world.awake.start_over()


def restore(world: WorldState, identity: int) -> None:
    """Add a quarantined body (id) to the simulation again. Do nothing for a body that is not quarantined.

    A body is quarantined (disabled) when one of its numbers is not finite or out of range.
    """
    world._unlocked()
    row = world._body_row(identity)
    if row["quarantined"]:
        row["quarantined"], row["awake"] = False, True
        world.awake.start_over()
        world.awake.mark_dirty([identity])
        own = world._shape_rows(world._row_number(identity))
        world.pairs.add_proxies(world.shapes, own, np.full(len(own), row["kind"] == STATIC))
