"""Another mask in the place of one of a body's: what is carved, and the next frame of an animation."""

from collections.abc import Sequence

import numpy as np

from physics.broadphase.rectangles import write_rectangles
from physics.collision.kept_forces import KeptForces
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.shape_rows import NONE, NewParts, append_parts, pushed_parts, say
from physics.shapes.filter import Filter
from physics.shapes.mask import PixelMask
from physics.shapes.outline_tiles import is_tiled, keep_tiles, polygons, tiled_parts
from physics.shapes.part_rows import find_equal, rows_in_tiles
from physics.shapes.rows import is_snapped, set_mass, weigh
from physics.tables.body import DYNAMIC
from physics.tables.rows import rows_of
from physics.tables.shape import PART
from physics.world_state import WorldState


def exchange_mask(
    world: WorldState, identity: int, place: int, shape_id: int, mask: PixelMask, changed: Sequence[int] | None = None
) -> None:
    """Put another mask in the place of one of a body's: its id stays, and so do parts of its outline that are the same.

    place: which of the body's shapes it is; changed: the tiles in which it differs, None: any. Bodies that touch what
    is changed wake; contacts where the new surface is the old one keep their forces. O(what is changed), but for a few
    passes over the SHAPE rows.
    """
    at, shapes = world._row_number(identity), world.shapes
    body, used = world.bodies[at : at + 1], list(world._shapes_of[identity])
    before, used[place] = used[place], mask
    old, fresh = _differences(world, shape_id, before, mask, changed)
    still = body["kind"][0] != DYNAMIC
    if not (still and sleep.disturb_shapes(world, identity, shapes["id"][old])):
        sleep.disturb(world, [identity])
    kept = KeptForces(world, old)
    own = rows_of(shapes, [shape_id])  # its parts come after it: what goes does not move it
    shapes["geometry"][own] = world.library.replace(before.bare, mask.bare, changed, shapes)
    if len(old):
        keep = np.ones(len(shapes), bool)
        keep[old] = False
        world._drop_shapes(keep)
    world._shapes_of[identity] = tuple(used)
    if any(getattr(mask, name) != getattr(before, name) for name in ("material", "filter", "sensor", "snap")):
        _say_again(world, at, shape_id, mask)
    world._tidy_library()
    append_parts(world, world.shapes[own], fresh)
    given = world._given.rows[at]
    set_mass(body, weigh(used, float(given["density"]), float(given["mass"])), used, world.effects.response)
    refresh_centers(np.array([at]), world.bodies)
    new = np.arange(len(world.shapes) - len(fresh.shapes), len(world.shapes))
    _rejoin(world, at, np.append(own, new) if still else rows_of_owner(world, shape_id))
    kept.hand_on(world, new)


def rows_of_owner(world: WorldState, shape_id: int) -> np.ndarray:
    """SHAPE rows of a shape and of its parts."""
    return np.flatnonzero(world.shapes["owner"] == shape_id)


def _differences(world, shape_id, before, mask, changed):
    """(rows of the parts that go, NewParts); what else changed of the others is written."""
    shapes = world.shapes
    if not world.effects.response:
        return np.zeros(0, np.int64), NONE
    if changed is not None and all(is_tiled(each) and not each.one_way for each in (mask, before)):
        return _differences_in_tiles(world, shape_id, before, mask, changed)
    parts = np.flatnonzero((shapes["owner"] == shape_id) & (shapes["role"] == PART))
    known = {world.library.shape_of(shapes[row]): row for row in parts.tolist()}
    fresh = []
    for tile, each in pushed_parts(mask):
        for part in each:
            row = known.pop(part.shape, -1)
            if row < 0:
                fresh.append((tile, part.inner, part.shape))
            else:
                shapes["inner"][row], shapes["tile"][row] = part.inner, tile
    return np.array(sorted(known.values()), np.int64), NewParts(*zip(*fresh, strict=True)) if fresh else NONE


def _differences_in_tiles(world, shape_id, before, mask, changed):
    """The same of masks that differ in a few tiles."""
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


def _say_again(world, at, shape_id, mask):
    """Write what a mask says of itself to its rows."""
    rows = rows_of_owner(world, shape_id)
    shapes, pairs = world.shapes, world.pairs
    some = shapes[rows]
    say(some, world._given.rows[at], mask)
    shapes[rows] = some
    shapes["snap"][rows] = is_snapped(mask) & (some["role"] != PART)
    pairs.set_filter(some["proxy"], Filter(*(some[name][0].item() for name in ("membership", "mask"))))
    pairs.set_sensor(shapes, rows)


def _rejoin(world, at, touched):
    """Have shape rows of a body looked at by the broad phase, from the next step on."""
    world.pairs.touch(world.shapes["proxy"][touched])
    if world.bodies["quarantined"][at]:
        world.pairs.free_proxies(world.shapes["proxy"][touched])
        world.shapes["proxy"][touched] = -1
    elif world.sleeps and not world.bodies["active"][at]:
        # What is not awake gets no rectangle in the next step: here, at once.
        count = write_rectangles(world, touched)
        world.pairs.again.append(world.pairs.changed[:count].copy())
    world.queries.seen = ()
    sleep.forget(world)
