"""Queries of a world between steps: ray casts, shape casts, nearest points, overlaps, points and boxes."""

import math
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from physics import checks
from physics.annotations import Pair, Pose
from physics.ccd.rotational import (
    Mover,
    advance_parts,
    new_rotational_workspace,
    place_mover,
    starts_across,
    sweep_chain,
    sweep_tiles,
    sweep_unions,
)
from physics.ccd.time_of_impact import (
    ANGLE,
    CENTER_X,
    CENTER_Y,
    MISS,
    TOUCHING_BAND,
    advance,
    new_advance_workspace,
    reach_of,
)
from physics.collision.hulls import ALL_EDGES, Hull
from physics.collision.narrow_phase import NarrowPhase
from physics.distance.gjk import (
    AX,
    AY,
    BX,
    BY,
    NX,
    NY,
    ROUNDS,
    copy_part,
    new_gap_workspace,
    separate_parts,
    shape_separation,
)
from physics.jit import kernel, subkernel
from physics.math2d import Vec2
from physics.queries.batches import beyond_drawn, cast, find_candidates, query_points, write_hit
from physics.queries.index import AskedWorld, IndexedWorld
from physics.shapes.kinds import checked_pose
from physics.shapes.library import place
from physics.shapes.placement import add_missing_rasters, hull_at, is_hull, refresh_aabbs, rounding
from physics.shapes.shape import Filter, Parts, Placed, Shape, checked_filter, parts_near, parts_of
from physics.tables.body import BODY
from physics.tables.shape import BOUNDS, CHAIN, MASK, PART, PIXELS, SHAPE, TILES
from physics.tables.step_state import CAP_HITS, GJK_ITERATIONS, NARROW_TESTS, TOI_CALLS
from physics.tables.table import joined

# ---- boxes -----------------------------------------------------------------------------------------------------------
# Boxes: the bodies whose AABBs meet a box, and the AABB of a body.


def query_aabb(world: AskedWorld, lower: Pair, upper: Pair, filter: Filter, sensors: bool) -> list:
    """Return the bodies that have a shape whose AABB overlaps or touches a box, in the order of body ids.

    Masks without solid pixels and grids without solid tiles are not found.

    lower, upper: corners (min_x, min_y), (max_x, max_y) of the box [px]; filter: Filter of the query; sensors: whether
    sensors are included. Raises TypeError for values of other types, ValueError for lower > upper.
    """
    filter, sensors = checked_filter(filter), checks.flag("sensors", sensors)
    lower, upper = checks.vector("lower", lower), checks.vector("upper", upper)
    if lower[0] > upper[0] or lower[1] > upper[1]:
        raise ValueError(f"lower must be <= upper (got {lower} and {upper})")
    world.queries.begin(world)
    rows = with_content(world, world.queries.rows_in(world, lower, upper))
    s = world.shapes[rows]
    rows = rows[
        (s["min_x"] <= upper[0]) & (s["max_x"] >= lower[0]) & (s["min_y"] <= upper[1]) & (s["max_y"] >= lower[1])
    ]
    rows = _allowed(world, rows, filter, sensors, NO_ROLE)
    return [world.body(each) for each in np.unique(world.shapes["body"][rows]).tolist()]


def query_rect(world: AskedWorld, rect: Any, filter: Filter, sensors: bool) -> list:
    """Return the bodies that have a shape whose AABB overlaps or touches a rectangle, in the order of body ids.

    rect: (x, y, width, height) or ((x, y), (width, height)) [px]; filter, sensors: see query_aabb. Raises TypeError for
    values of other types, ValueError for a width or height < 0 and for a number that is not finite.
    """
    try:
        parts = tuple(rect)
        x, y, width, height = (*parts[0], *parts[1]) if len(parts) == 2 else parts
    except (TypeError, ValueError):
        raise TypeError(f"rect must be (x, y, width, height) (got {checks.shown(rect)})") from None
    x, y = checks.position("rect", (x, y))
    width, height = checks.number("rect[2]", width, low=0.0), checks.number("rect[3]", height, low=0.0)
    end = checks.vector("rect[0] + rect[2], rect[1] + rect[3]", (x + width, y + height))
    return query_aabb(world, (x, y), end, filter, sensors)


def bounds_of(world: Any, identity: int) -> tuple[float, float, float, float] | None:
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of all shapes of a body; None if all are empty.

    world: a World, annotated Any because its module imports this one; identity: id of the body. O(shapes of the body).
    """
    rows = with_content(world, world._shape_rows(world._row_number(identity)))
    if not len(rows):
        return None
    add_missing_rasters(world.library, rows, world.bodies, world.shapes, 0.0)
    refresh_aabbs(rows, world.library.tables, world.bodies, world.shapes)
    s = world.shapes[rows]
    return (s["min_x"].min().item(), s["min_y"].min().item(), s["max_x"].max().item(), s["max_y"].max().item())


def with_content(world: IndexedWorld, rows: np.ndarray) -> np.ndarray:
    """Return the SHAPE row numbers `rows` without those of empty masks and empty tile grids."""
    shapes, library = world.shapes[rows], world.library
    kinds = np.where(shapes["kind"] == BOUNDS, shapes["wrapped"], shapes["kind"])
    keep = np.ones(len(rows), bool)
    masks = np.flatnonzero(kinds == MASK)
    if len(masks):
        upright = library.raster_of[shapes["geometry"][masks], 0]  # a rotated raster has as many pixels
        keep[masks] = library.rasters.rows["area"][upright] > 0
    grids = np.flatnonzero(kinds == TILES)
    keep[grids] = [not library.tile_grids[grid].is_empty for grid in shapes["geometry"][grids].tolist()]
    return rows[keep]


# ---- cast rows -------------------------------------------------------------------------------------------------------
# A ray, a shape that moves without rotation, or a point, against listed shapes at rest.


@kernel
def cast_hull_at_rows(geometry, bodies, shapes, rows, hull, workspace, hits_out, work_inout):
    """Cast a moving hull at listed shapes. Return the number of shapes that are hit.

    Write (SHAPE row number, fraction, normal x, normal y) of each hit to hits_out (rows, 4). The normal points from the
    shape to the hull. A shape that touches the hull at the start is hit at fraction 0 if the hull approaches it. rows:
    SHAPE row numbers, no masks or chains; hull: a Hull with corners relative to its centre of rotation; workspace:
    a RotationalWorkspace that contains the hull's motion; work_inout: counters, see COUNTERS.
    """
    r = workspace.advance
    corners, count, radius, _ = hull
    mover = Mover(count, radius, 0.0, 0.0, False)
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        b = bodies[s.body_row]
        work_inout[TOI_CALLS] += 1
        r.motion_b[CENTER_X] = b.x
        r.motion_b[CENTER_Y] = b.y
        r.motion_b[ANGLE] = 0.0
        r.totals[0] = 0.0
        r.totals[1] = 0.0
        for i in range(count):
            workspace.mover[i, 0] = corners[i, 0]
            workspace.mover[i, 1] = corners[i, 1]
        if s.kind == TILES:
            fraction, nx, ny, _ = sweep_tiles(geometry, s.geometry, (0.0, 0.0), mover, True, -1, workspace)
        else:
            n = hull_at(geometry, shapes, rows[k], 0.0, 0.0, b.angle, r.local_b)
            place_mover(count, workspace)
            fraction = advance(count, radius, n, rounding(shapes, rows[k]), workspace.advance)
            nx, ny = -r.gap.gap[NX], -r.gap.gap[NY]
        work_inout[GJK_ITERATIONS] += int(r.totals[0])
        work_inout[CAP_HITS] += int(r.totals[1])
        if fraction < MISS:
            write_hit(rows[k], (fraction, nx, ny), found, hits_out)
            found += 1
    return found


@subkernel
def write_part(parts, i, workspace):
    """Write part i of a shape to workspace.mover. Return its Mover, without slack. parts: Parts."""
    copy_part(parts.corners, i, parts.counts[i], workspace.mover)
    return Mover(parts.counts[i], parts.radii[i], 0.0, 0.0, False)


@subkernel
def is_across_surface(geometry, chain, parts, workspace):
    """Return whether a shape made of parts overlaps a one-way surface at the start, so that its cast may pass.

    chain: row of geometry.chains; parts: Parts of the shape; workspace: RotationalWorkspace with both motions.
    """
    for i in range(len(parts.counts)):
        part = write_part(parts, i, workspace)
        near = TOUCHING_BAND * (reach_of(workspace.mover, part.count) + part.radius)
        if starts_across(geometry, chain, (0.0, 0.0), Mover(part.count, part.radius, 0.0, near, False), workspace):
            return True
    return False


@kernel
def cast_parts_at_chains(geometry, bodies, shapes, rows, parts, workspace, hits_out, work_inout):
    """Cast a moving shape made of parts at the fronts of listed chains. Return the number of chains that are hit.

    rows: SHAPE row numbers of the chains; parts: Parts of the shape relative to its start. Other arguments: see
    cast_hull_at_rows. O(parts · links near the path).
    """
    r = workspace.advance
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        b = bodies[s.body_row]
        work_inout[TOI_CALLS] += 1
        r.motion_b[CENTER_X] = b.x
        r.motion_b[CENTER_Y] = b.y
        r.motion_b[ANGLE] = b.angle
        r.totals[0] = 0.0
        r.totals[1] = 0.0
        if s.role == PART and is_across_surface(geometry, s.geometry, parts, workspace):
            continue
        best, best_x, best_y = MISS, 0.0, -1.0
        for i in range(len(parts.counts)):
            part = write_part(parts, i, workspace)
            fraction, nx, ny, _ = sweep_chain(geometry, s.geometry, (0.0, 0.0), part, -1, workspace)
            if fraction < best:
                best, best_x, best_y = fraction, nx, ny
        work_inout[GJK_ITERATIONS] += int(r.totals[0])
        work_inout[CAP_HITS] += int(r.totals[1])
        if best < MISS:
            write_hit(rows[k], (best, best_x, best_y), found, hits_out)
            found += 1
    return found


@kernel
def nearest_hull(geometry, bodies, shapes, rows, point, workspace, nearest_out, work_inout):
    """Find the hull nearest to a point among listed shapes. Return its SHAPE row number, or -1 if no hull is listed.

    Write (distance, x, y of the nearest point) [px] to nearest_out (3,). If `point` is inside a hull, the distance is 0
    and the nearest point is `point`. rows: ascending SHAPE row numbers; tile grids, masks and chains are skipped;
    workspace: an AdvanceWorkspace; work_inout: counters, see COUNTERS.
    """
    x, y = point
    own, corners = workspace.local_a, workspace.local_b
    best = -1
    nearest_out[0] = math.inf
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if not is_hull(s.kind):
            continue
        b = bodies[s.body_row]
        # Coordinates relative to the point, so that precision does not depend on the distance from the origin.
        own[0, 0] = 0.0
        own[0, 1] = 0.0
        n = hull_at(geometry, shapes, rows[k], b.x - x, b.y - y, b.angle, corners)
        gap = shape_separation(own, 1, 0.0, corners, n, rounding(shapes, rows[k]), (0, 0), workspace.gap)
        distance = max(0.0, gap)
        work_inout[NARROW_TESTS] += 1
        work_inout[GJK_ITERATIONS] += int(workspace.gap.state[ROUNDS])
        if distance < nearest_out[0]:
            best = rows[k]
            nearest_out[0] = distance
            nearest_out[1] = x + (workspace.gap.gap[BX] if distance > 0.0 else 0.0)
            nearest_out[2] = y + (workspace.gap.gap[BY] if distance > 0.0 else 0.0)
    return best


# ---- casts -----------------------------------------------------------------------------------------------------------
# Queries of a world between steps: rays, casts, overlaps, points. They read the present poses and search the broad
# phase; the work of the last query is in `world.queries.counters`.

NO_ROLE = -1  # in place of a role of SHAPE
HitBody = TypeVar("HitBody")  # Body, whose module imports this one


@dataclass(frozen=True)
class RayHit(Generic[HitBody]):
    """A hit of a ray or of a cast shape: the body and the shape that were hit, the point and the normal.

    body: the Body that was hit; shape: id of the shape that was hit.
    point: point of the hit (x, y) [px].
    normal: unit normal (x, y) of the surface that was hit.
    fraction: fraction of the translation before the hit, 0 to 1.
    """

    body: HitBody
    shape: int
    point: Vec2
    normal: Vec2
    fraction: float


def ray_cast_all(
    world: AskedWorld, origin: Pair, translation: Pair, filter: Filter, sensors: bool, first: bool = False
) -> list[RayHit]:
    """Return all hits of a ray as a list, in the order of fraction, then of shape id.

    origin: start of the ray [px]; translation: vector from the start to the end of the ray [px]; filter: Filter of the
    ray; sensors: whether sensors are also hit; first: True: return only the nearest hit. A ray that starts inside a
    shape hits it at fraction 0, with a normal opposite to the ray. A ray of zero length is a point query with normals
    (0, -1). Raises TypeError for values of other types, ValueError for numbers that are not finite or an origin too far
    away.
    """
    x, y = checks.position("origin", origin)
    dx, dy = checks.vector("translation", translation)
    filter, sensors = checked_filter(filter), checks.flag("sensors", sensors)
    hits = cast(world, find_candidates(world, np.array([(x, y, dx, dy)]), filter, sensors), first)
    hits = hits[hits[:, 1] <= 1.0]
    if len(hits) > 1:
        hits = hits[np.lexsort((hits[:, 0], hits[:, 1]))]
        _, nearest = np.unique(world.shapes["parent"][hits[:, 0].astype(np.int64)], return_index=True)
        hits = hits[np.sort(nearest)]  # only the first hit of each mask's parts
    return [
        _hit(world, row, fraction, nx, ny, (x + fraction * dx, y + fraction * dy))
        for row, fraction, nx, ny in hits.tolist()
    ]


def shape_cast(
    world: AskedWorld, shape: Shape, pose: Pose, translation: Pair, filter: Filter, sensors: bool
) -> RayHit | None:
    """Return the first hit of a shape that moves from a pose by a translation [px]; None without a hit.

    Of several hits at the same fraction, the one of the smallest shape id is returned. filter: Filter of the cast
    shape; sensors: whether sensors are also hit. The normal points from the hit shape to the cast shape, and the point
    is midway between the two. A shape that touches or overlaps the cast shape at the start is hit at fraction 0 if the
    cast shape approaches it; otherwise the cast continues. A cast of zero length returns the first overlapping shape.

    A PixelMask is cast as its outline at the exact pose, and a grazing contact is not a hit. A Chain is hit only from
    its front, a one-way tile or mask only from above. Raises TypeError for values of other types, ValueError for
    numbers that are not finite or a pose that the shape cannot have.
    """
    pose, filter = checked_pose("shape", shape, "pose", pose), checked_filter(filter)
    sensors = checks.flag("sensors", sensors)
    dx, dy = checks.vector("translation", translation)
    index = world.queries
    index.begin(world)
    with world.library.visited():
        bodies, shapes = _probe(world, shape, pose)
        beyond = beyond_drawn(world)
        box = [float(shapes[name][0]) for name in ("min_x", "min_y", "max_x", "max_y")]
        rows = _allowed(
            world,
            index.rows_in(
                world,
                (min(box[0], box[0] + dx) - beyond, min(box[1], box[1] + dy) - beyond),
                (max(box[2], box[2] + dx) + beyond, max(box[3], box[3] + dy) + beyond),
            ),
            filter,
            sensors,
        )
        if dx == 0.0 and dy == 0.0:
            return _first_contact(world, bodies, shapes, rows)
        probe = shape._parts_at(Placed(world.library.tables, bodies, shapes, 0, *pose[:2], -math.inf, True))
        hits = _sweep(world, shape, probe, rows, (*pose[:2], dx, dy), box[3])
        if not len(hits):
            return None
        row, fraction, nx, ny = hits[np.lexsort((hits[:, 0], hits[:, 1]))][0].tolist()
        x, y = pose[0] + fraction * dx, pose[1] + fraction * dy
        workspace = new_gap_workspace()
        met = rows[world.shapes["parent"][rows] == world.shapes["parent"][int(row)]]
        other = _outline_at(world, met, x, y, probe, (0.0, 0.0), box[3])
        separate_parts(probe, other, np.zeros((16, 2)), np.zeros((16, 2)), workspace, np.zeros(2))
        gap = workspace.gap.tolist()
        return _hit(world, row, fraction, nx, ny, (x + 0.5 * (gap[AX] + gap[BX]), y + 0.5 * (gap[AY] + gap[BY])))


def _sweep(world, shape, probe, rows, motion, feet) -> np.ndarray:
    """Return the hits of a cast shape as an array (n, 4): (SHAPE row number, fraction, normal x, normal y).

    The normals point to the cast shape. A mask with several SHAPE rows is hit once, in its first row. probe: Parts of
    the cast shape; rows: SHAPE row numbers of the shapes to test; motion: (start x, y, translation x, y) [px]; feet: y
    coordinate [px] of the lowest point of the cast shape at the start.
    """
    x, y, dx, dy = motion
    workspace, hits, found, work = new_rotational_workspace(), np.zeros((len(rows), 4)), 0, world.queries.work
    r, s = workspace.advance, world.shapes[rows]
    r.motion_a[:] = 0.0, 0.0, 0.0, dx, dy, 0.0
    chains = s["kind"] == CHAIN
    of_masks = ~chains & ((s["kind"] == MASK) | (s["role"] == PART))
    alone = ~(of_masks | chains) if shape._is_convex else np.zeros(len(rows), bool)
    tables, bodies, shapes = world.library.tables, world.bodies, world.shapes
    r.motion_a[:2] = x, y
    if alone.any():
        hull = Hull(probe.corners[0], int(probe.counts[0]), float(probe.radii[0]), ALL_EDGES)
        found = cast_hull_at_rows(tables, bodies, shapes, rows[alone], hull, workspace, hits, work)
    if chains.any():
        free = hits[found:]
        found += cast_parts_at_chains(tables, bodies, shapes, rows[chains], probe, workspace, free, work)
    r.motion_a[:2] = r.motion_b[:] = 0.0
    others = ~(alone | chains)
    sweep_by = sweep_unions if shape._kind == MASK else advance_parts
    for owner in np.unique(s["parent"][others]).tolist():
        same = rows[others & (s["parent"] == owner)]
        impact = np.zeros(3)
        other = _outline_at(world, same, x, y, probe, (dx, dy), feet)
        sweep = sweep_unions if of_masks[others & (s["parent"] == owner)].any() else sweep_by
        sweep(probe, other, workspace, impact)
        work[TOI_CALLS] += 1
        work[GJK_ITERATIONS] += int(r.totals[0])
        work[CAP_HITS] += int(r.totals[1])
        if impact[0] < MISS:
            hits[found] = same[0], impact[0], -impact[1], -impact[2]
            found += 1
    return hits[:found]


def _outline_at(world, rows, x, y, probe, way, feet) -> Parts:
    """Return the convex parts of one shape that a cast shape may hit during its motion, relative to (x, y) [px].

    rows: SHAPE row numbers of the one shape; probe: Parts of the cast shape; way: translation of the cast shape [px];
    feet: y coordinate [px] of the lowest point of the cast shape.
    """
    every = [_swept_parts(world, row, x, y, feet) for row in rows.tolist()]
    parts = Parts(*(np.concatenate(columns) for columns in zip(*every, strict=True)))
    if not len(probe.counts):
        return parts
    (left, top), (right, bottom) = probe.boxes[:, :2].min(axis=0), probe.boxes[:, 2:].max(axis=0)
    dx, dy = way
    return parts_near(parts, left + min(0.0, dx), top + min(0.0, dy), right + max(0.0, dx), bottom + max(0.0, dy))


def _swept_parts(world, row, x, y, feet) -> Parts:
    """Return the convex parts of the shape in SHAPE row number `row`, relative to (x, y) [px], for casts.

    feet: y coordinate [px] of the lowest point of the cast shape. One-way tiles are included only if they are below it.
    """
    placed = Placed(world.library.tables, world.bodies, world.shapes, row, x, y, feet, True)
    return world.library.shape_of(world.shapes[row])._parts_at(placed)


def closest(world: AskedWorld, point: Pair, filter: Filter, sensors: bool) -> tuple[Any, Vec2, float] | None:
    """Find the shape nearest to a point. Return (its Body, nearest point [px], distance [px]), or None for no shape.

    Of several shapes at the same distance, the one with the smallest id is used. If `point` is inside a shape, the
    nearest point is `point` and the distance is 0. filter: Filter of the query; sensors: whether sensors are included.
    A Chain is measured from both sides, a one-way tile by its top. Raises TypeError for values of other types,
    ValueError for a point that is not finite or too far away.
    """
    x, y = checks.position("point", point)
    filter, sensors, index = checked_filter(filter), checks.flag("sensors", sensors), world.queries
    index.begin(world)
    reach, beyond, found = 2.0 * world.tolerances.pixels_per_meter, beyond_drawn(world), None
    while True:
        around = reach + beyond
        rows = index.rows_in(world, (x - around, y - around), (x + around, y + around))
        everything = around == math.inf or len(rows) == np.count_nonzero(
            ~world.bodies["quarantined"][world.shapes["body_row"]]
        )
        found = _nearest(world, _allowed(world, rows, filter, sensors), x, y)
        if everything or (found and found[1] <= reach):
            break
        # A result bounds the search; without a result the box grows.
        reach = found[1] * (1.0 + 1e-9) if found else 4.0 * reach
    if not found:
        return None
    row, gap, at = found
    return world.body(int(world.shapes["body"][row])), Vec2(*at), gap


def _nearest(world, rows, x, y):
    """Find the listed shape nearest to (x, y) [px]. Return (SHAPE row number, distance [px], nearest point [px]).

    Return None if there is no shape. rows: SHAPE row numbers of the listed shapes.
    """
    nearest, workspace, work = np.zeros(3), new_advance_workspace(), world.queries.work
    best = nearest_hull(world.library.tables, world.bodies, world.shapes, rows, (x, y), workspace, nearest, work)
    found = [(float(nearest[0]), best, (float(nearest[1]), float(nearest[2])))] if best >= 0 else []
    alone = parts_of([[(0.0, 0.0)]])
    for row in rows.tolist():
        if not is_hull(int(world.shapes["kind"][row])):
            parts, place = _swept_parts(world, row, x, y, y), workspace.gap.gap
            gap = separate_parts(alone, parts, workspace.local_a, workspace.local_b, workspace.gap, np.zeros(2))
            if math.isfinite(gap):
                at = (x + float(place[BX]), y + float(place[BY])) if gap > 0.0 else (x, y)
                found.append((max(gap, 0.0), row, at))
    if not found:
        return None
    gap, row, at = min(found)
    return row, gap, at


def query_point(world: AskedWorld, point: Pair, filter: Filter, sensors: bool) -> list:
    """Return the bodies that have a shape that contains `point` [px], in the order of body ids.

    filter: Filter of the query; sensors: whether sensors are included. Raises TypeError for a value that is not a
    point, ValueError for a point that is not finite or too far away.
    """
    x, y = checks.position("point", point)
    found = query_points(world, [(x, y)], filter, sensors)
    return [world.body(each) for each in found["body"].tolist()]


def overlap(world: AskedWorld, shape: Shape, pose: Pose, filter: Filter, sensors: bool) -> list:
    """Return the bodies that a shape at a pose overlaps, in the order of body ids.

    filter: Filter of the shape; sensors: whether sensors are included. Raises TypeError for values of other types,
    ValueError for a pose that the shape cannot have.
    """
    pose, filter = checked_pose("shape", shape, "pose", pose), checked_filter(filter)
    sensors = checks.flag("sensors", sensors)
    world.queries.begin(world)
    with world.library.visited():
        bodies, shapes = _probe(world, shape, pose)
        s, beyond = shapes[0], beyond_drawn(world)
        box = (s["min_x"] - beyond, s["min_y"] - beyond), (s["max_x"] + beyond, s["max_y"] + beyond)
        rows = _allowed(world, world.queries.rows_in(world, *box), filter, sensors, PART)
        contacts = _contacts(world, bodies, shapes, rows)
        return [world.body(each) for each in np.unique(contacts["body_a"]).tolist()]


def _contacts(world, bodies, shapes, rows):
    """Return the CONTACT rows between listed shapes (A) and a query shape (B).

    CONTACT.candidate is an index into `rows`. bodies, shapes: BODY and SHAPE row of the query shape, arrays (1,); rows:
    SHAPE row numbers of the listed shapes in the world.
    """
    others, owners = np.unique(world.shapes["body_row"][rows], return_inverse=True)
    all_bodies = joined([world.bodies[others], bodies])
    all_shapes = joined([world.shapes[rows], shapes])
    all_shapes["body_row"] = np.append(owners, len(others))
    pairs = np.stack([np.arange(len(rows)), np.full(len(rows), len(rows))], axis=1).astype(np.int64).reshape(-1, 2)
    narrow = NarrowPhase(full_masks=False, one_way=False, boxes_only=False)
    return narrow.collide(world.library, all_bodies, all_shapes, pairs, 0.0, world.queries.work)


def _first_contact(world, bodies, shapes, rows):
    contacts = _contacts(world, bodies, shapes, rows)
    if not len(contacts):
        return None
    c = contacts[0]
    return _hit(
        world,
        rows[int(c["candidate"])],
        0.0,
        float(c["normal_x"]),
        float(c["normal_y"]),
        (float(c["x_1"]), float(c["y_1"])),
    )


def _probe(world, shape, pose):
    """Return (BODY row, SHAPE row), two arrays (1,), for a query shape at a pose.

    The shape's geometry is added to the world's library, and removed when the context library.visited() ends.
    """
    bodies, shapes = np.zeros(1, BODY), np.zeros(1, SHAPE)
    place(world.library, shape, bodies, shapes, 0, pose)
    refresh_aabbs(np.arange(1), world.library.tables, bodies, shapes)
    return bodies, shapes


def _allowed(world, rows, filter, sensors, leave=PIXELS):
    """Return the SHAPE row numbers in `rows` that a query admits.

    filter: Filter of the query; sensors: whether sensors are admitted; leave: SHAPE.role of the rows to omit: PIXELS
    for queries of outlines, PART for queries of pixels, NO_ROLE (no row is omitted) for queries of AABBs.
    """
    s = world.shapes
    rows = rows[s["role"][rows] != leave]
    keep = (s["membership"][rows] & filter.mask != 0) & (s["mask"][rows] & filter.membership != 0)
    return rows[keep if sensors else keep & ~s["sensor"][rows]]


def _hit(world, row, fraction, nx, ny, point):
    shape = world.shapes[int(row)]
    return RayHit(
        world.body(int(shape["body"])), int(shape["parent"]), Vec2(*point), Vec2(nx + 0.0, ny + 0.0), fraction
    )
