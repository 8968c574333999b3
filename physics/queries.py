"""Questions to a world between steps: rays, overlaps, boxes, points. They read the present poses."""

from dataclasses import dataclass

import numpy as np

from physics import checks
from physics.motion.ray import cast_ray_at_all
from physics.narrowphase.placement import refresh_aabbs
from physics.shapes import SHAPES, Filter, TileGrid
from physics.stages import add_missing_rasters, narrow_phase_for_queries
from physics.tables import BODY, SHAPE


@dataclass(frozen=True)
class RayHit:
    """Where a ray meets a shape: the body, the shape's id, point [px], unit normal, fraction of the translation."""
    body: object
    shape: int
    point: tuple[float, float]
    normal: tuple[float, float]
    fraction: float


def ray_cast_all(world, origin, translation, filter, sensors) -> list[RayHit]:
    """All hits of a ray, nearest first, ties by shape id.

    Inside a shape at the start: fraction 0 and the normal against the direction. Zero length: a point query, whose
    normals are (0, -1). Raises TypeError, ValueError.
    """
    x, y = checks.position("origin", origin)
    dx, dy = checks.vector("translation", translation)
    filter = _checked(filter)
    sensors = checks.flag("sensors", sensors)
    add_missing_rasters(world, 0.0)
    hits = np.zeros((len(world.shapes), 4))
    found = cast_ray_at_all(world.library.tables, world.bodies, world.shapes, x, y, dx, dy, filter.membership, filter.mask,
                            int(sensors), np.zeros((16, 2)), hits)
    rows = hits[:found]
    rows = rows[np.argsort(rows[:, 1], kind="stable")]
    return [RayHit(world.body(int(world.shapes["body"][int(row)])), int(world.shapes["id"][int(row)]),
                   (x + fraction * dx, y + fraction * dy), (nx + 0.0, ny + 0.0), fraction) for row, fraction, nx, ny in rows.tolist()]


def query_aabb(world, lower, upper) -> list:
    """Bodies with a shape whose AABB meets the closed box [px]. Raises ValueError for lower > upper."""
    lower, upper = checks.vector("lower", lower), checks.vector("upper", upper)
    if lower[0] > upper[0] or lower[1] > upper[1]:
        raise ValueError(f"lower must be <= upper (got {lower} and {upper})")
    return [world.body(each) for each in np.unique(world.shapes["body"][_rows_in(world, lower, upper)]).tolist()]


def query_point(world, point) -> list:
    """Bodies with a shape that holds the point [px], sensors included."""
    checks.vector("point", point)
    hits = ray_cast_all(world, point, (0.0, 0.0), Filter.ALL, True)
    return [world.body(each) for each in sorted({hit.body.id for hit in hits})]


def overlap(world, shape, pose, filter) -> list:
    """Bodies that a shape at a pose (x, y, angle) overlaps. Raises TypeError, ValueError."""
    if not isinstance(shape, SHAPES):
        raise TypeError(f"shape must be a shape such as Circle(8) (got {shape!r})")
    x, y, angle = _pose("pose", pose)
    if isinstance(shape, TileGrid) and angle != 0.0:
        raise ValueError(f"pose must have angle 0 for a TileGrid (got {angle})")
    filter = _checked(filter)
    bodies, shapes = np.zeros(1, BODY), np.zeros(1, SHAPE)
    place(world.library, shape, bodies, shapes, 0, (x, y, angle))
    refresh_aabbs(world.library.tables, bodies, shapes)
    probe = shapes[0]
    rows = _rows_in(world, (probe["min_x"], probe["min_y"]), (probe["max_x"], probe["max_y"]))
    rows = rows[(world.shapes["membership"][rows] & filter.mask != 0) & (world.shapes["mask"][rows] & filter.membership != 0)]
    others, owners = np.unique(world.shapes["body_row"][rows], return_inverse=True)
    all_bodies = np.concatenate([world.bodies[others], bodies])
    all_shapes = np.concatenate([world.shapes[rows], shapes])
    all_shapes["body_row"] = np.append(owners, len(others))
    pairs = np.stack([np.arange(len(rows)), np.full(len(rows), len(rows))], axis=1).astype(np.int64).reshape(-1, 2)
    contacts = narrow_phase_for_queries().collide(world.library.tables, all_bodies, all_shapes, pairs, len(pairs), 0.0, 0.0,
                                                  np.zeros_like(world.profile.work))
    return [world.body(each) for each in np.unique(contacts["body_a"]).tolist()]


def place(library, shape, bodies, shapes, row, pose):
    """Fill a BODY and a SHAPE row for a shape at a pose that stands in no world."""
    kind, geometry, wrapped = library.add(shape)
    inner = getattr(shape, "shape", shape)
    s, b = shapes[row:row + 1], bodies[row:row + 1]
    s["id"], s["body"], s["body_row"], s["kind"], s["geometry"], s["wrapped"] = row, row, row, kind, geometry, wrapped
    if hasattr(inner, "radius"):
        s["radius"], (s["local_x"], s["local_y"]) = inner.radius, inner.center
    b["id"], b["x"], b["y"], b["angle"] = row, *pose
    b["previous_x"], b["previous_y"], b["previous_angle"] = pose
    if geometry >= 0 and hasattr(inner, "turned"):
        library.raster(geometry, pose[2])


def _pose(name, value):
    try:
        x, y, angle = value
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be (x, y, angle) (got {value!r})") from None
    return (*checks.position(name, (x, y)), checks.number(f"{name}[2]", angle))


def _checked(filter):
    if not isinstance(filter, Filter):
        raise TypeError(f"filter must be a Filter (got {filter!r})")
    return filter


def _rows_in(world, lower, upper):
    add_missing_rasters(world, 0.0)
    refresh_aabbs(world.library.tables, world.bodies, world.shapes)
    s = world.shapes
    return np.flatnonzero((s["min_x"] <= upper[0]) & (s["max_x"] >= lower[0]) & (s["min_y"] <= upper[1])
                          & (s["max_y"] >= lower[1]) & ~world.bodies["quarantined"][s["body_row"]])
