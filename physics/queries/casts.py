"""Questions to a world between steps: rays, casts, overlaps, points. They read the present poses, and go through
the broad phase's structure; what the last one cost is in `world.queries.counters`."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from physics import checks
from physics.ccd.closed_form import MISS
from physics.ccd.parts import advance_parts
from physics.ccd.rotational import new_rotational_workspace
from physics.checks import Pair, Pose
from physics.collision.dispatch import narrow_phase_for_queries
from physics.proximity.gjk import AX, AY, BX, BY, new_gap_workspace
from physics.proximity.witness import separate_parts
from physics.queries.cast_rows import cast_hull_at_rows, cast_ray_at_rows, nearest_hull
from physics.queries.index import AskedWorld
from physics.shapes.filter import Filter
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.parts import Parts, parts_of, placed_parts
from physics.shapes.placement import is_hull, refresh_aabbs
from physics.shapes.rows import place
from physics.shapes.tiles import TileGrid
from physics.tables.body import BODY
from physics.tables.shape import MASK, SHAPE
from physics.vec2 import Vec2

RAY_PIECES = 16  # a long slanted ray asks for up to this many boxes along it, not for one around it …
PIECE = 8.0  # [m] … each about that wide


@dataclass(frozen=True)
class RayHit:
    """Where a ray meets a shape: the body, the shape's id, point [px], unit normal, fraction of the translation."""

    body: Any  # a Body, which is defined to the right of this folder
    shape: int
    point: Vec2
    normal: Vec2
    fraction: float


def ray_cast_all(
    world: AskedWorld, origin: Pair, translation: Pair, filter: Filter, sensors: bool, first: bool = False
) -> list[RayHit]:
    """All hits of a ray, nearest first, ties by shape id; with `first` no more than what is nearest.

    Inside a shape at the start: fraction 0 and the normal against the direction. Zero length: a point query, whose
    normals are (0, -1). Raises TypeError, ValueError.
    """
    x, y = checks.position("origin", origin)
    dx, dy = checks.vector("translation", translation)
    filter = _checked(filter)
    sensors = checks.flag("sensors", sensors)
    index = world.queries
    index.begin(world)
    pieces = 1 + int(min(RAY_PIECES - 1.0, min(abs(dx), abs(dy)) / (PIECE * world.tolerances.pixels_per_meter)))
    corners, asked, hits = np.zeros((16, 2)), np.zeros(0, np.int64), np.zeros((0, 4))
    for piece in range(pieces):
        ends = [(x + share * dx, y + share * dy) for share in (piece / pieces, (piece + 1) / pieces)]
        rows = _allowed(world, index.rows_in(world, *_box_around(*ends)), filter, sensors)
        rows = np.setdiff1d(rows, asked, assume_unique=True)
        asked = np.concatenate([asked, rows])
        workspace = np.zeros((len(rows), 4))
        found = cast_ray_at_rows(
            world.library.tables, world.bodies, world.shapes, rows, x, y, dx, dy, corners, workspace, index.work
        )
        hits = np.concatenate([hits, workspace[:found]])
        # What is met within the pieces so far has been asked: nothing nearer is left.
        if first and len(hits) and hits[:, 1].min() * pieces < piece + 1:
            break
    hits = hits[np.lexsort((hits[:, 0], hits[:, 1]))]
    return [
        _hit(world, row, fraction, nx, ny, (x + fraction * dx, y + fraction * dy))
        for row, fraction, nx, ny in hits[: 1 if first else None].tolist()
    ]


def shape_cast(world: AskedWorld, shape: Shape, pose: Pose, translation: Pair, filter: Filter) -> RayHit | None:
    """The first shape that a shape at a pose touches when it is moved by a translation, ties by shape id.

    Sensors are left out. The normal points from what is met to the shape, the point lies midway between them. Touching
    or overlapping at the start: fraction 0 when it approaches; when it parts or slides the cast looks on. Zero length:
    the first shape it overlaps. Masks move unsnapped, a Chain is met from its front, a one-way tile from above. Raises
    TypeError, ValueError.
    """
    pose, filter = _placeable(shape, pose), _checked(filter)
    dx, dy = checks.vector("translation", translation)
    index = world.queries
    index.begin(world)
    with world.library.visited():
        bodies, shapes = _probe(world, shape, pose)
        box = [float(shapes[name][0]) for name in ("min_x", "min_y", "max_x", "max_y")]
        rows = _allowed(
            world,
            index.rows_in(
                world,
                (min(box[0], box[0] + dx), min(box[1], box[1] + dy)),
                (max(box[2], box[2] + dx), max(box[3], box[3] + dy)),
            ),
            filter,
            False,
        )
        if dx == 0.0 and dy == 0.0:
            return _first_contact(world, bodies, shapes, rows)
        probe = placed_parts(world.library, bodies, shapes, 0, pose[0], pose[1], -math.inf)
        hits = _sweep(world, probe, is_hull(int(shapes["kind"][0])), rows, (*pose[:2], dx, dy), box[3])
        if not len(hits):
            return None
        row, fraction, nx, ny = hits[np.lexsort((hits[:, 0], hits[:, 1]))][0].tolist()
        x, y = pose[0] + fraction * dx, pose[1] + fraction * dy
        workspace = new_gap_workspace()
        other = placed_parts(world.library, world.bodies, world.shapes, int(row), x, y, box[3])
        separate_parts(probe, other, np.zeros((16, 2)), np.zeros((16, 2)), workspace, np.zeros(2))
        gap = workspace.gap.tolist()
        return _hit(world, row, fraction, nx, ny, (x + 0.5 * (gap[AX] + gap[BX]), y + 0.5 * (gap[AY] + gap[BY])))


def _sweep(world, probe, is_one_hull, rows, motion, feet) -> np.ndarray:
    """(row, fraction, normal to the probe) of the shapes that a probe meets,
    by its parts where masks or more are in play."""
    x, y, dx, dy = motion
    workspace, hits, found, work = new_rotational_workspace(), np.zeros((len(rows), 4)), 0, world.queries.work
    kinds = world.shapes["kind"][rows]
    by_parts = kinds == MASK if is_one_hull else np.ones(len(rows), bool)
    if is_one_hull:
        found = cast_hull_at_rows(
            world.library.tables,
            world.bodies,
            world.shapes,
            rows,
            probe.corners[0],
            int(probe.counts[0]),
            probe.radius,
            x,
            y,
            dx,
            dy,
            workspace,
            hits,
            work,
        )
    moving, still = np.array([0.0, 0.0, 0.0, dx, dy, 0.0]), np.zeros(6)
    for row in rows[by_parts].tolist():
        impact = np.zeros(3)
        other = placed_parts(world.library, world.bodies, world.shapes, row, x, y, feet)
        advance_parts(probe, other, moving, still, workspace, impact, np.zeros(2))
        if impact[0] < MISS:
            hits[found] = row, impact[0], -impact[1], -impact[2]
            found += 1
    return hits[:found]


def closest(world: AskedWorld, point: Pair, filter: Filter) -> tuple[Any, Vec2, float] | None:
    """(body, point, distance) [px] of the nearest point of any shape, ties by shape id; None in an empty world.

    Inside a shape: the point itself, and 0. Sensors are left out; a Chain is near from both sides, a one-way tile from
    above. Raises TypeError, ValueError.
    """
    x, y = checks.position("point", point)
    filter, index = _checked(filter), world.queries
    index.begin(world)
    reach, found = 2.0 * world.tolerances.pixels_per_meter, None
    while True:
        rows = index.rows_in(world, (x - reach, y - reach), (x + reach, y + reach))
        everything = len(rows) == np.count_nonzero(~world.bodies["quarantined"][world.shapes["body_row"]])
        found = _nearest(world, _allowed(world, rows, filter, False), x, y)
        if everything or (found and found[1] <= reach):
            break
        # What was found bounds the search; without it the box grows.
        reach = found[1] * (1.0 + 1e-9) if found else 4.0 * reach
    if not found:
        return None
    row, gap, at = found
    return world.body(int(world.shapes["body"][row])), Vec2(*at), gap


def _nearest(world, rows, x, y):
    """(row, distance, point) of the nearest point of the shapes in these rows, or None."""
    nearest, workspace, work = np.zeros(3), new_gap_workspace(), world.queries.work
    point, corners = np.zeros((16, 2)), np.zeros((16, 2))
    best = nearest_hull(
        world.library.tables, world.bodies, world.shapes, rows, x, y, point, corners, workspace, nearest, work
    )
    found = [(float(nearest[0]), best, (float(nearest[1]), float(nearest[2])))] if best >= 0 else []
    alone = parts_of([[(0.0, 0.0)]])
    for row in rows.tolist():
        if not is_hull(int(world.shapes["kind"][row])):
            parts: Parts = placed_parts(world.library, world.bodies, world.shapes, row, x, y, y)
            gap = separate_parts(alone, parts, point, corners, workspace, np.zeros(2))
            if math.isfinite(gap):
                found.append(
                    (
                        max(gap, 0.0),
                        row,
                        (x + float(workspace.gap[BX]), y + float(workspace.gap[BY])) if gap > 0.0 else (x, y),
                    )
                )
    if not found:
        return None
    gap, row, at = min(found)
    return row, gap, at


def query_point(world: AskedWorld, point: Pair) -> list:
    """Bodies with a shape that holds the point [px], sensors included."""
    checks.vector("point", point)
    hits = ray_cast_all(world, point, (0.0, 0.0), Filter.ALL, True)
    return [world.body(each) for each in sorted({hit.body.id for hit in hits})]


def overlap(world: AskedWorld, shape: Shape, pose: Pose, filter: Filter) -> list:
    """Bodies that a shape at a pose overlaps, sensors included. Raises TypeError, ValueError."""
    pose, filter = _placeable(shape, pose), _checked(filter)
    world.queries.begin(world)
    with world.library.visited():
        bodies, shapes = _probe(world, shape, pose)
        s = shapes[0]
        rows = world.queries.rows_in(world, (s["min_x"], s["min_y"]), (s["max_x"], s["max_y"]))
        contacts = _contacts(world, bodies, shapes, _allowed(world, rows, filter, True))
        return [world.body(each) for each in np.unique(contacts["body_a"]).tolist()]


def _contacts(world, bodies, shapes, rows):
    """Manifolds of a probe, as B, with the shapes in these rows; `candidate` tells which."""
    others, owners = np.unique(world.shapes["body_row"][rows], return_inverse=True)
    all_bodies = np.concatenate([world.bodies[others], bodies])
    all_shapes = np.concatenate([world.shapes[rows], shapes])
    all_shapes["body_row"] = np.append(owners, len(others))
    pairs = np.stack([np.arange(len(rows)), np.full(len(rows), len(rows))], axis=1).astype(np.int64).reshape(-1, 2)
    narrow = narrow_phase_for_queries()
    return narrow.collide(world.library.tables, all_bodies, all_shapes, pairs, 0.0, world.queries.work)


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
    """BODY and SHAPE of a shape at a pose; it stays in the library only while that is visited."""
    bodies, shapes = np.zeros(1, BODY), np.zeros(1, SHAPE)
    place(world.library, shape, bodies, shapes, 0, pose)
    refresh_aabbs(np.arange(1), world.library.tables, bodies, shapes)
    return bodies, shapes


def _placeable(shape, pose):
    if not isinstance(shape, SHAPES):
        raise TypeError(f"shape must be a shape such as Circle(8) (got {checks.shown(shape)})")
    pose = checks.pose("pose", pose)
    if isinstance(shape, TileGrid) and pose[2] != 0.0:
        raise ValueError(f"pose must have angle 0 for a TileGrid (got {pose[2]})")
    return pose


def _checked(filter):
    if not isinstance(filter, Filter):
        raise TypeError(f"filter must be a Filter (got {checks.shown(filter)})")
    return filter


def _allowed(world, rows, filter, sensors):
    """The rows whose filter agrees with the query's; without sensors unless asked for."""
    s = world.shapes
    keep = (s["membership"][rows] & filter.mask != 0) & (s["mask"][rows] & filter.membership != 0)
    return rows[keep if sensors else keep & ~s["sensor"][rows]]


def _box_around(start, end):
    return (min(start[0], end[0]), min(start[1], end[1])), (max(start[0], end[0]), max(start[1], end[1]))


def _hit(world, row, fraction, nx, ny, point):
    shape = world.shapes[int(row)]
    return RayHit(world.body(int(shape["body"])), int(shape["id"]), Vec2(*point), Vec2(nx + 0.0, ny + 0.0), fraction)
