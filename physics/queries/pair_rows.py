"""Two shapes at two poses as the rows that kernels read, without a world.

What depends on a shape alone is kept with the shape, which never changes. Convex shapes need little more than their
corners; whatever is concave gets a library of its own.
"""

from struct import Struct
from typing import Any, NamedTuple

import numpy as np

from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.library import KIND_OF, Library
from physics.shapes.lines import Segment
from physics.shapes.mask import PixelMask
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rows import place, rounding_of
from physics.shapes.tiles import TileGrid
from physics.tables.body import BODY
from physics.tables.geometry import CORNER, SPAN, Geometry
from physics.tables.shape import CIRCLE, SHAPE

Pose = tuple[float, float, float]


class PairRows(NamedTuple):
    """The first shape is row 0, the second row 1."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE


class HullRow(NamedTuple):
    """What is kept of a hull: bytes, which are joined at a tenth of what joining structured arrays costs."""

    first: bytes  # its SHAPE row as the first of a pair
    second: bytes
    corners: bytes  # CORNER rows; none of a circle
    count: int  # of them


def _kept(shape, name, make) -> Any:
    """What `make` finds out about a shape, asked once."""
    kept = vars(shape.bare)
    if name not in kept:
        kept[name] = make(shape.bare)
    return kept[name]


def hull_row(shape: Shape) -> HullRow | None:
    """The row of a convex shape, but for its place; None for a mask, tiles, a chain, and a Bounds, which is its box."""
    return _kept(shape, "_hull_row", _make_hull_row)


def _make_hull_row(shape) -> HullRow | None:
    if not isinstance(shape, (Circle, Capsule, Polygon, Segment)):
        return None
    rows = np.zeros(2, SHAPE)
    rows["id"] = rows["body"] = rows["body_row"] = 0, 1
    kind = CIRCLE if isinstance(shape, Circle) else KIND_OF[type(shape)]
    rows["kind"], rows["wrapped"] = kind, -1
    rows["geometry"] = (-1, -1) if kind == CIRCLE else (0, 1)
    rows["radius"], rows["local_x"], rows["local_y"] = rounding_of(shape)
    points = np.array([] if isinstance(shape, Circle) else list(shape.points), CORNER)
    return HullRow(rows[:1].tobytes(), rows[1:].tobytes(), points.tobytes(), len(points))


def order_of(shape: Shape) -> tuple:
    """A key that orders any two shapes, so that which one is named first changes no bit of a result but the signs."""
    return _kept(shape, "_order", _make_order)


def _make_order(shape) -> tuple:
    kind = next(k for k, each in enumerate(SHAPES) if isinstance(shape, each))
    if isinstance(shape, Bounds):
        return (kind, *_make_order(shape.shape))
    if isinstance(shape, TileGrid):
        pixels = (shape.solid.tobytes(), shape.slopes.tobytes(), shape.one_way.tobytes())
        return (kind, *shape.solid.shape, shape.tile_size, *pixels)
    if isinstance(shape, PixelMask):
        return (kind, *shape.size, *shape.origin, shape.snap, shape.solid.tobytes())
    points = (shape.center,) if isinstance(shape, Circle) else shape.points
    return (kind, getattr(shape, "radius", 0.0), len(points), *(each for point in points for each in point))


def name_of(shape: Shape) -> tuple:
    """Another such key, of how a shape is written."""
    return _kept(shape, "_name", _make_name)


def _make_name(shape) -> tuple:
    pixels = shape.solid.tobytes() if isinstance(shape, (PixelMask, TileGrid)) else b""
    return SHAPES.index(type(shape)), repr(shape), pixels


NOTHING = Library().tables  # of what a pair of hulls has none
BODIES = np.zeros(2, BODY)
BODIES["id"] = 0, 1
SPANS = Struct("4q")
POSE = Struct("3d")  # x, y, angle, which stand side by side in BODY
FIRST_POSE = int(BODIES["x"].__array_interface__["data"][0] - BODIES.__array_interface__["data"][0])  # [bytes]


def hull_pair(a: HullRow, pose_a: Pose, b: HullRow, pose_b: Pose) -> PairRows:
    """Two hulls at two poses; their boxes are not written."""
    spans = np.frombuffer(bytearray(SPANS.pack(0, a.count, a.count, b.count)), SPAN)
    corners = np.frombuffer(bytearray(a.corners + b.corners), CORNER) if a.count + b.count else NOTHING.corners
    shapes = np.frombuffer(bytearray(a.first + b.second), SHAPE)
    bodies = bytearray(BODIES.tobytes())
    POSE.pack_into(bodies, FIRST_POSE, *pose_a)
    POSE.pack_into(bodies, BODY.itemsize + FIRST_POSE, *pose_b)
    return PairRows(Geometry(spans, corners, *NOTHING[2:]), np.frombuffer(bodies, BODY), shapes)


def any_pair(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> tuple[Library, PairRows]:
    """Any two shapes at two poses, and the library that they stand in."""
    library, bodies, shapes = Library(), np.zeros(2, BODY), np.zeros(2, SHAPE)
    for row, (shape, pose) in enumerate(((shape_a, pose_a), (shape_b, pose_b))):
        place(library, shape, bodies, shapes, row, pose)
    refresh_aabbs(np.arange(2), library.tables, bodies, shapes)
    return library, PairRows(library.tables, bodies, shapes)
