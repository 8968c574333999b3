"""The functions collide, distance and time_of_impact, which test two shapes without a world."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from struct import Struct
from typing import NamedTuple, TypeVar

import numpy as np

from physics import checks
from physics.annotations import Pose
from physics.ccd.rotational import advance_on_ground, advance_parts, new_rotational_workspace, sweep_unions
from physics.ccd.time_of_impact import MISS, TOLERANCE, sweep_circles
from physics.collision.hull_pairs import (
    collide_aabb_pairs,
    collide_circle_pairs,
    collide_polygon_circle_pairs,
    collide_polygon_pairs,
)
from physics.collision.manifold import AABBS, CIRCLES, POLYGON_CIRCLE, POLYGONS, Batch, contacts_of, new_workspace
from physics.collision.narrow_phase import NarrowPhase, kind_of_pair, no_work
from physics.distance.gjk import AX, AY, BX, BY, NX, NY, ROUNDS, new_gap_workspace, separate_parts, shape_separation
from physics.jit import kernel, subkernel
from physics.math2d import Vec2
from physics.shapes.kinds import checked_pose, rank_of
from physics.shapes.library import Library, place, rounding_of
from physics.shapes.placement import hull_at, refresh_aabbs, rounding
from physics.shapes.shape import Parts, Placed, Shape, turned_parts
from physics.tables.body import BODY
from physics.tables.contact import CONTACT
from physics.tables.geometry import CORNER, SPAN, Geometry
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, SHAPE

# ---- pair rows -------------------------------------------------------------------------------------------------------
# Two shapes at two poses as the rows that kernels read, without a world.
#
# Data that depend only on a shape are cached with the shape, which is immutable. Convex shapes need little more than
# their corners; a pair with another shape has a library of its own, see KeptPair.

At = tuple[float, float, float]  # x, y, angle
Kept = TypeVar("Kept")


class PairRows(NamedTuple):
    """BODY and SHAPE tables of two shapes, with their geometry. Row 0 is the first shape, row 1 the second shape."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE


class HullRow(NamedTuple):
    """The table rows of a convex shape, as bytes. Concatenating bytes takes a tenth of the time that arrays take."""

    first: bytes  # its SHAPE row as the first shape of a pair
    second: bytes  # its SHAPE row as the second shape of a pair
    corners: bytes  # CORNER rows; empty for a circle
    count: int  # number of corners


def kept_with_shape(make: Callable[[Shape], Kept]) -> Callable[[Shape], Kept]:
    """Decorate `make`, a function of a shape, so that its result is cached as an attribute of the shape.

    Shapes that differ only in material, filter or sensor flag share one cached result.
    """

    def find(shape: Shape) -> Kept:
        kept = vars(shape.bare)
        if make.__name__ not in kept:
            kept[make.__name__] = make(shape.bare)
        return kept[make.__name__]

    return find


@kept_with_shape
def hull_row(shape: Shape) -> HullRow | None:
    """Return the HullRow of a convex shape; None for a mask, a tile grid, a chain and a Bounds."""
    if not shape._is_convex or shape._kind == BOUNDS:
        return None
    rows = np.zeros(2, SHAPE)
    rows["id"] = rows["body"] = rows["body_row"] = 0, 1
    rows["kind"], rows["wrapped"] = shape._kind, -1
    rows["geometry"] = (-1, -1) if shape._kind == CIRCLE else (0, 1)
    rows["radius"], rows["local_x"], rows["local_y"] = rounding_of(shape)
    points = np.array([] if shape._kind == CIRCLE else list(shape.points), CORNER)
    return HullRow(rows[:1].tobytes(), rows[1:].tobytes(), points.tobytes(), len(points))


@kept_with_shape
def order_of(shape: Shape) -> tuple:
    """Return a sort key of a shape's geometry.

    Queries process two shapes in the order of their keys, so swapping the shapes changes only signs of the result.
    """
    inside = () if shape._inner is shape else (rank_of(shape._inner),)
    return (rank_of(shape), *inside, *shape._inner._key)


@kept_with_shape
def name_of(shape: Shape) -> tuple:
    """Return a sort key of a shape, for collide(): its kind, the text of its constructor call, and order_of(shape)."""
    return rank_of(shape), repr(shape), order_of(shape)


NOTHING = Library().tables  # empty tables that a pair of hulls does not use
BODIES = np.zeros(2, BODY)
BODIES["id"] = 0, 1
SPANS = Struct("4q")
POSE = Struct("3d")  # x, y, angle, which are adjacent in BODY
FIRST_POSE = int(BODIES["x"].__array_interface__["data"][0] - BODIES.__array_interface__["data"][0])  # [bytes]


def hull_pair(a: HullRow, pose_a: At, b: HullRow, pose_b: At) -> PairRows:
    """Return the PairRows of two convex shapes at two poses. The AABBs in the rows are not set.

    a, b: HullRows of the shapes; pose_a, pose_b: (x [px], y [px], angle [rad]).
    """
    spans = np.frombuffer(bytearray(SPANS.pack(0, a.count, a.count, b.count)), SPAN)
    corners = np.frombuffer(bytearray(a.corners + b.corners), CORNER) if a.count + b.count else NOTHING.corners
    shapes = np.frombuffer(bytearray(a.first + b.second), SHAPE)
    bodies = bytearray(BODIES.tobytes())
    POSE.pack_into(bodies, FIRST_POSE, *pose_a)
    POSE.pack_into(bodies, BODY.itemsize + FIRST_POSE, *pose_b)
    return PairRows(Geometry(spans, corners, *NOTHING[2:]), np.frombuffer(bodies, BODY), shapes)


class KeptPair:
    """The library, table rows and narrow phase for two shapes, at least one of which is not convex.

    Each thread caches the KeptPairs of its last KEPT_PAIRS pairs of shapes, see kept_pair. With a cached KeptPair,
    collide() of two masks of 8 to 64 px is 2.4 to 8.5 times as fast as with a new one.
    """

    def __init__(self, shape_a: Shape, shape_b: Shape) -> None:
        self.shapes = shape_a, shape_b
        self.library, self.bodies, self.rows = Library(), np.zeros(2, BODY), np.zeros(2, SHAPE)
        self.narrow = NarrowPhase(full_masks=True, one_way=True, boxes_only=False)

    def at(self, pose_a: At, pose_b: At) -> PairRows:
        """Return the PairRows of the two shapes at two poses (x, y, angle) [px, rad]. The next call overwrites them."""
        for row, (shape, pose) in enumerate(zip(self.shapes, (pose_a, pose_b), strict=True)):
            place(self.library, shape, self.bodies, self.rows, row, pose)
        refresh_aabbs(BOTH_ROWS, self.library.tables, self.bodies, self.rows)
        return PairRows(self.library.tables, self.bodies, self.rows)


KEPT_PAIRS = 16
BOTH_ROWS = np.arange(2)
THREAD = threading.local()


def kept_pair(shape_a: Shape, shape_b: Shape) -> KeptPair:
    """Return the KeptPair of two shapes: the cached one, or a new one.

    The cache contains the KEPT_PAIRS KeptPairs that this thread used last.
    """
    kept: dict[tuple[int, int], KeptPair] = vars(THREAD).setdefault("pairs", {})
    bare = shape_a.bare, shape_b.bare
    key = id(bare[0]), id(bare[1])  # unique while the pair is kept, because the pair refers to both shapes
    pair = kept.pop(key, None) or KeptPair(*bare)
    kept[key] = pair  # the last one used is the last one in the dict
    if len(kept) > KEPT_PAIRS:
        del kept[next(iter(kept))]
    return pair


# ---- pair manifold ---------------------------------------------------------------------------------------------------
# collide: the contact of two shapes at two poses.

# Arguments of a pass over one pair; the pass only reads them.
PAIRS = {False: np.array([[0, 1]], np.int64), True: np.array([[1, 0]], np.int64)}
HULL_PASSES = {
    CIRCLES: collide_circle_pairs,
    POLYGON_CIRCLE: collide_polygon_circle_pairs,
    POLYGONS: collide_polygon_pairs,
    AABBS: collide_aabb_pairs,
}
KINDS = {kind: np.array([kind], np.int64) for kind in HULL_PASSES}
NAMES = CONTACT.names or ()


@dataclass(frozen=True)
class Manifold:
    """A contact of two shapes A and B, the result of collide. len() returns the number n of contact points.

    normal: unit vector from A to B; (0, 0) without points.
    points: contact points (n, 2) [px], midway between the two surfaces.
    separations: separation at each point (n,) [px], negative where the shapes overlap.
    features: (n,) int64, feature ids of the corners, edges, tiles or pixels that touch.
    area: area shared by two masks [px²], 0 for other shapes.
    """

    normal: Vec2
    points: np.ndarray
    separations: np.ndarray
    features: np.ndarray
    area: float

    def __len__(self):
        return len(self.points)

    def __repr__(self):
        """Return a text with normal, points and separations on one line, and with area if masks share pixels."""
        places = [(round(x, 6), round(y, 6)) for x, y in self.points.tolist()]
        gaps, area = (
            [round(each, 6) for each in self.separations.tolist()],
            f", area={self.area:g}" if self.area else "",
        )
        return f"Manifold(normal={tuple(self.normal)}, points={places}, separations={gaps}{area})"


def collide(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose, margin: float = 0.0) -> Manifold:
    """Return the contact of two shapes as a Manifold.

    shape_a, shape_b: the two shapes A and B.
    pose_a, pose_b: poses of A and B, (x, y) or (x, y, angle) [px, rad].
    margin: greatest separation of a contact point [px], >= 0.

    If A and B are swapped, the points and separations are the same, and the normal is reversed. If one shape is a
    TileGrid or a Chain, the points at all tiles or links are returned, with the normal of the deepest point. A TileGrid
    or Chain never collides with another TileGrid or Chain. Raises TypeError for values that are not shapes, poses or
    numbers, ValueError for a pose that the shape cannot have or a margin < 0.
    """
    poses = [checked_pose("shape_a", shape_a, "pose_a", pose_a), checked_pose("shape_b", shape_b, "pose_b", pose_b)]
    margin = checks.number("margin", margin, low=0.0)
    key_a, key_b = name_of(shape_a), name_of(shape_b)
    swapped = (*key_b[:2], poses[1], key_b[2]) < (*key_a[:2], poses[0], key_a[2])
    row_a, row_b = hull_row(shape_a), hull_row(shape_b)
    if row_a is None or row_b is None:
        return _collide_any(shape_a, poses[0], shape_b, poses[1], margin, swapped)
    return _collide_hulls(hull_pair(row_a, poses[0], row_b, poses[1]), margin, swapped)


def _collide_hulls(rows, margin, swapped) -> Manifold:
    """Return the Manifold of two convex shapes, with contact points of separation <= margin [px].

    rows: PairRows of the shapes; swapped: whether the shapes are processed in reverse order; the normal is then
    reversed afterwards.
    """
    low, high = sorted(rows.shapes["kind"].tolist())
    kind = kind_of_pair(low, high)
    batch = Batch(rows.geometry, rows.bodies, rows.shapes, PAIRS[swapped], KINDS[kind], 1, margin, 0.0)
    found = np.frombuffer(bytearray(CONTACT.itemsize), CONTACT)
    if not HULL_PASSES[kind](batch, new_workspace(), found, 0, no_work()):
        return nowhere()
    m = dict(zip(NAMES, found[0].item(), strict=True))
    sign, points = -1.0 if swapped else 1.0, range(1, 1 + m["count"])
    return Manifold(
        Vec2(sign * m["normal_x"] + 0.0, sign * m["normal_y"] + 0.0),
        np.array([(m[f"x_{k}"], m[f"y_{k}"]) for k in points]),
        np.array([m[f"separation_{k}"] for k in points]),
        np.array([m[f"feature_{k}"] for k in points], np.int64),
        0.0,
    )


def _collide_any(shape_a, pose_a, shape_b, pose_b, margin, swapped) -> Manifold:
    pair = kept_pair(shape_a, shape_b)
    rows = pair.at(pose_a, pose_b)

    def points_of(swapped):
        return contacts_of(
            pair.narrow.collide(pair.library, rows.bodies, rows.shapes, PAIRS[swapped], margin, no_work())
        )

    contacts = points_of(swapped)
    if not len(contacts):
        return nowhere()
    deepest = contacts[np.argmin(contacts["separation"])]
    sign = -1.0 if swapped else 1.0
    features = contacts["feature"].copy()
    if swapped and shape_a._kind == shape_b._kind == MASK:
        features = points_of(False)["feature"].copy()  # a pixel of the first mask
    return Manifold(
        Vec2(sign * float(deepest["normal_x"]) + 0.0, sign * float(deepest["normal_y"]) + 0.0),
        np.stack([contacts["point_x"], contacts["point_y"]], axis=1),
        contacts["separation"].copy(),
        features,
        float(contacts["area"].sum()),
    )


def nowhere() -> Manifold:
    """Return a Manifold without points, for shapes that do not touch."""
    return Manifold(Vec2(0.0, 0.0), np.zeros((0, 2)), np.zeros(0), np.zeros(0, np.int64), 0.0)


# ---- pair distance ---------------------------------------------------------------------------------------------------
# distance: the distance of two shapes at two poses.

ROUNDING_BAND = 1e-11  # share of the size: below this distance the contact test determines whether two shapes touch
NEXT_TO_NOTHING = math.ulp(
    0.0
)  # [px] the smallest positive number: the distance of shapes that touch without a contact


@dataclass(frozen=True)
class Distance:
    """The distance of two shapes A and B, the result of the function distance.

    distance: distance [px]. For an overlap it is negative: minus the length of the shortest translation of B along the
        normal that separates the shapes.
    point_a, point_b: nearest points on the surfaces of A and B [px]; point_b = point_a + distance · normal.
    normal: unit vector from A to B.
    iterations: number of iterations of GJK and EPA.
    """

    distance: float
    point_a: Vec2
    point_b: Vec2
    normal: Vec2
    iterations: int


def distance(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose) -> Distance:
    """Return the distance of two shapes and their nearest points, as a Distance.

    shape_a, shape_b: the two shapes A and B.
    pose_a, pose_b: poses of A and B, (x, y) or (x, y, angle) [px, rad].

    For convex shapes the result is exact up to rounding. For concave shapes it is the distance of their nearest convex
    parts, or for an overlap minus the depth that `collide` finds. A mask is measured by its pixels, as drawn if
    snap=True, otherwise at its exact pose.

    The distance is <= 0 if `collide` finds a contact, and < 0 if masks have a contact. A shape that touches a mask
    without shared area has distance 0 and no contact. Other shapes may touch or cross without a contact, for example a
    Chain from behind or tiles on tiles; the distance is then the smallest positive number. The distance to an empty
    shape is infinite, with the normal (1, 0). Raises TypeError for values that are not shapes or poses, ValueError for
    a pose that the shape cannot have.
    """
    pose_a = checked_pose("shape_a", shape_a, "pose_a", pose_a)
    pose_b = checked_pose("shape_b", shape_b, "pose_b", pose_b)
    if (*order_of(shape_b), *pose_b) < (*order_of(shape_a), *pose_a):
        found = _measure(shape_b, pose_b, shape_a, pose_a)
        return Distance(
            found.distance,
            found.point_b,
            found.point_a,
            Vec2(0.0 - found.normal[0], 0.0 - found.normal[1]),
            found.iterations,
        )
    return _measure(shape_a, pose_a, shape_b, pose_b)


def _measure(shape_a, pose_a, shape_b, pose_b) -> Distance:
    # Coordinates are relative to A, so that precision does not depend on the distance from the origin.
    x, y = pose_a[0], pose_a[1]
    workspace, row_a, row_b = new_gap_workspace(), hull_row(shape_a), hull_row(shape_b)
    if row_a is not None and row_b is not None:
        rows = hull_pair(row_a, pose_a, row_b, pose_b)
        found, size, rounds = separate_hulls(*rows, x, y, np.zeros((16, 2)), np.zeros((16, 2)), workspace)
    else:
        found, size, rounds = _separate_any(shape_a, pose_a, shape_b, pose_b, workspace)
    if math.isinf(found):
        return Distance(math.inf, Vec2(*pose_a[:2]), Vec2(*pose_b[:2]), Vec2(1.0, 0.0), 0)
    nx, ny, ax, ay = (float(workspace.gap[k]) for k in (NX, NY, AX, AY))
    convex, kinds = shape_a._is_convex and shape_b._is_convex, (shape_a._kind, shape_b._kind)
    band = ROUNDING_BAND * size + 4.0 * math.ulp(max(map(abs, (*pose_a[:2], *pose_b[:2]))))
    if CHAIN in kinds:
        band = size  # a shape that was pressed through a link may lie wholly behind the link and still be pushed out
    if found <= band and not (convex and found < -band):
        contact = collide(shape_a, pose_a, shape_b, pose_b)
        if not len(contact):
            # Masks are open sets: if they touch, they have distance 0 and share no area.
            found = max(found, 0.0 if MASK in kinds and CHAIN not in kinds else NEXT_TO_NOTHING)
        elif convex:
            found = min(found, 0.0)
        else:
            deepest = int(np.argmin(contact.separations))
            found, (nx, ny) = min(float(contact.separations[deepest]), 0.0), contact.normal
            ax, ay = contact.points[deepest] - 0.5 * found * np.array((nx, ny)) - (x, y)
    point_a = Vec2(x + float(ax), y + float(ay))
    nx, ny = nx + 0.0, ny + 0.0
    point_b = Vec2(point_a[0] + found * nx, point_a[1] + found * ny)
    return Distance(float(found), point_a, point_b, Vec2(nx, ny), int(rounds))


@kernel
def separate_hulls(geometry, bodies, shapes, x, y, corners_a_out, corners_b_out, workspace):
    """Compute the separation of two hulls. Return (separation [px], size of the larger hull [px], GJK/EPA iterations).

    Also write the separation, the normal and the nearest points, relative to (x, y) [px], to workspace.gap. The hulls
    are in rows 0 and 1 of bodies and shapes. corners_a_out, corners_b_out: (16, 2) scratch.
    """
    a, b = bodies[0], bodies[1]
    count_a = hull_at(geometry, shapes, 0, a.x - x, a.y - y, a.angle, corners_a_out)
    count_b = hull_at(geometry, shapes, 1, b.x - x, b.y - y, b.angle, corners_b_out)
    radius_a, radius_b = rounding(shapes, 0), rounding(shapes, 1)
    separation = shape_separation(corners_a_out, count_a, radius_a, corners_b_out, count_b, radius_b, (0, 0), workspace)
    size = max(size_of(corners_a_out, count_a, radius_a), size_of(corners_b_out, count_b, radius_b))
    return separation, size, workspace.state[ROUNDS]


@subkernel
def size_of(corners, count, radius):
    """Return the longer side [px] of the AABB of a rounded hull.

    corners: corners of the hull [px], of which the first `count` are in use; radius: rounding radius [px].
    """
    longest = 0.0
    for axis in range(2):
        low = corners[0, axis]
        high = low
        for k in range(1, count):
            low = min(low, corners[k, axis])
            high = max(high, corners[k, axis])
        longest = max(longest, (high + radius) - (low - radius))
    return longest


def _separate_any(shape_a, pose_a, shape_b, pose_b, workspace):
    """Compute the separation of any two shapes. Return (separation [px], larger size [px], GJK/EPA iterations).

    The separation is infinite if one shape is empty. The normal and the nearest points are written to workspace.gap,
    relative to the position of A.
    """
    parts_a, parts_b = parts_of_pair(shape_a, pose_a, shape_b, pose_b, pose_a[0], pose_a[1])
    totals = np.zeros(2)
    found = separate_parts(parts_a, parts_b, np.zeros((16, 2)), np.zeros((16, 2)), workspace, totals)
    if math.isinf(found):
        return found, 0.0, 0
    size = max(np.ptp(parts.boxes.reshape(-1, 2, 2), axis=(0, 1)).max() for parts in (parts_a, parts_b))
    return found, float(size), totals[0]


def parts_of_pair(shape_a: Shape, pose_a: At, shape_b: Shape, pose_b: At, x: float, y: float) -> tuple[Parts, ...]:
    """Return (Parts of A, Parts of B): the convex parts of two shapes, relative to the point (x, y) [px].

    pose_a, pose_b: poses (x, y, angle) of the shapes [px, rad].
    """
    geometry, bodies, shapes = kept_pair(shape_a, shape_b).at(pose_a, pose_b)
    return tuple(
        shape._parts_at(Placed(geometry, bodies, shapes, row, x, y, float(shapes[1 - row]["max_y"])))
        for row, shape in enumerate((shape_a, shape_b))
    )


# ---- pair impact -----------------------------------------------------------------------------------------------------
# time_of_impact: the first contact of two moving shapes.

BOX_STOPS = 4000  # greatest number of advances for a rotating Bounds; each ends before the impact
LOOKS = 1024  # number of parts of a motion at which touching shapes are tested until they approach


@dataclass(frozen=True)
class TimeOfImpact:
    """The first impact of two moving shapes A and B, the result of time_of_impact.

    hit: whether there is an impact.
    fraction: fraction of the motion at which the shapes touch, 0 to 1; 1 without an impact.
    point: point at which the shapes touch (x, y) [px]; None without an impact.
    normal: unit vector from A to B; None without an impact.
    """

    hit: bool
    fraction: float
    point: Vec2 | None
    normal: Vec2 | None


NO_IMPACT = TimeOfImpact(False, 1.0, None, None)


def time_of_impact(
    shape_a: Shape, start_a: Pose, end_a: Pose, shape_b: Shape, start_b: Pose, end_b: Pose
) -> TimeOfImpact:
    """Return the first impact of two shapes whose poses change linearly from start to end, as a TimeOfImpact.

    shape_a, shape_b: the two shapes A and B.
    start_a, start_b: poses of A and B at the start, (x, y) or (x, y, angle) [px, rad].
    end_a, end_b: poses of A and B at the end; angles are not wrapped.

    Two discs are solved in closed form, other convex shapes to 1e-13 of their size and motion. If the shapes touch or
    overlap at the start, the impact is at fraction 0 if they approach each other; otherwise the search continues until
    they approach.

    A Chain is hit only from its front, a one-way tile only from above. Seams between tiles or links are not hit. Tiles
    and chains do not collide with each other. Grazing contacts with tiles, links and PixelMasks are not impacts. A
    PixelMask moves as its outline at the exact pose. A Bounds whose shape rotates changes its size during the motion;
    its impact is found to 1e-12 of size and motion. Raises TypeError for values that are not shapes or poses,
    ValueError for a pose that the shape cannot have.
    """
    moves = [
        [checked_pose(f"shape_{side}", shape, f"{when}_{side}", at) for when, at in (("start", start), ("end", end))]
        for side, shape, start, end in (("a", shape_a, start_a, end_a), ("b", shape_b, start_b, end_b))
    ]
    ground = [each._is_ground for each in (shape_a, shape_b)]
    if all(ground):
        return NO_IMPACT
    swap = ground[0] or (not ground[1] and (*order_of(shape_b), *moves[1]) < (*order_of(shape_a), *moves[0]))
    given = [(shape_a, moves[0]), (shape_b, moves[1])]
    (a, move_a), (b, move_b) = reversed(given) if swap else given
    fraction, nx, ny = _first(a, move_a, b, move_b)
    if fraction > 1.0:
        return NO_IMPACT
    side = -1.0 if swap else 1.0
    return TimeOfImpact(
        True, float(fraction), _point(a, move_a, b, move_b, fraction), Vec2(side * nx + 0.0, side * ny + 0.0)
    )


def _first(a, move_a, b, move_b):
    if any(each._kind == BOUNDS and _turns(move) for each, move in ((a, move_a), (b, move_b))):
        return _advance_boxes(a, move_a, b, move_b)
    if a._kind == b._kind == CIRCLE and not (_swings(a, move_a) or _swings(b, move_b)):
        (ax, ay), (bx, by) = (_turned_point(each.points[0], move[0][2]) for each, move in ((a, move_a), (b, move_b)))
        x, y = (move_b[0][0] - move_a[0][0]) + (bx - ax), (move_b[0][1] - move_a[0][1]) + (by - ay)
        dx, dy = ((move_b[1][k] - move_b[0][k]) - (move_a[1][k] - move_a[0][k]) for k in (0, 1))
        return sweep_circles(x, y, dx, dy, a.radius + b.radius)
    workspace, found = new_rotational_workspace(), np.zeros(3)
    parts_a, workspace.advance.motion_a[:] = _local(a, move_a)
    if b._is_ground:
        library = Library()
        row = library.add(b)[1]
        workspace.advance.motion_b[:] = _motion(move_b)
        advance_on_ground(library.tables, row, int(b._kind == CHAIN), parts_a, workspace, found)
    else:
        parts_b, workspace.advance.motion_b[:] = _local(b, move_b)
        sweep = sweep_unions if MASK in (a._kind, b._kind) else advance_parts
        sweep(parts_a, parts_b, workspace, found)
    return found.tolist()


def _turns(move) -> bool:
    return move[0][2] != move[1][2]


def _swings(circle, move) -> bool:
    return _turns(move) and circle.points[0] != (0.0, 0.0)


def _turned_point(point, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]


def _motion(move):
    start, end = move
    return np.array([*start, *(q - p for p, q in zip(start, end, strict=True))])


def _local(shape, move) -> tuple[Parts, np.ndarray]:
    """Return (Parts in body space, motion) of a shape that moves from one pose to another. move: (start, end).

    motion: (6,) x, y, angle at the start, and the changes of x, y, angle. A Bounds, which must not rotate here, is
    represented by its box at the angle of the start.
    """
    motion = _motion(move)
    if shape._kind != BOUNDS:
        return shape._parts, motion
    angle, motion[2] = move[0][2], 0.0
    return shape._inner._box_at(angle), motion


def _placed(parts, pose, x=0.0, y=0.0) -> Parts:
    """Return Parts transformed to a pose (x, y, angle) [px, rad], relative to the point (x, y) [px]."""
    return turned_parts(parts, pose[0] - x, pose[1] - y, math.cos(pose[2]), math.sin(pose[2]))


def _at(move, fraction):
    return tuple(p + fraction * (q - p) for p, q in zip(*move, strict=True))


def _parts_at(shape, move, fraction, x, y) -> Parts:
    pose = _at(move, fraction)
    if shape._kind == BOUNDS:
        return _placed(shape._inner._box_at(pose[2]), (pose[0], pose[1], 0.0), x, y)
    return _placed(shape._parts, pose, x, y)


def _point(a, move_a, b, move_b, fraction):
    """Return the point [px] midway between the nearest points of two moving shapes at a fraction of their motion.

    a, b: the shapes; move_a: (start pose, end pose) of a; move_b: (start pose, end pose) of b.
    """
    x, y = move_a[0][:2]
    gap = _gap_at(*(_parts_at(each, move, fraction, x, y) for each, move in ((a, move_a), (b, move_b))))
    return Vec2(float(x + 0.5 * (gap[AX] + gap[BX])), float(y + 0.5 * (gap[AY] + gap[BY])))


def _gap_at(parts_a, parts_b):
    workspace = new_gap_workspace()
    separate_parts(parts_a, parts_b, np.zeros((16, 2)), np.zeros((16, 2)), workspace, np.zeros(2))
    return workspace.gap


def _advance_boxes(a, move_a, b, move_b):
    """Return the first impact (fraction or MISS, nx, ny) of two shapes, one of which is a Bounds that changes size.

    A Bounds changes size when its shape rotates. The method is conservative advancement with an upper bound of the
    speed. move_a, move_b: (start pose, end pose) of each shape.
    """
    x, y = move_a[0][:2]
    parts = [each._inner._pixel_parts if each._kind == BOUNDS else each._parts for each in (a, b)]
    if not all(len(each.counts) for each in parts):
        return MISS, 1.0, 0.0
    reach = [float(np.hypot(*np.abs(each.boxes).reshape(-1, 2, 2).max(axis=(0, 1)))) for each in parts]
    turn = [abs(move[1][2] - move[0][2]) for move in (move_a, move_b)]
    path = math.hypot(*((move_b[1][k] - move_b[0][k]) - (move_a[1][k] - move_a[0][k]) for k in (0, 1)))
    # Each side of a rotating box moves no faster than its shape's farthest point, and two sides contribute to a normal.
    speed = path + math.sqrt(2.0) * (turn[0] * reach[0] + turn[1] * reach[1])
    tolerance = 1e-12 * (sum(reach) + path)

    def look(fraction):
        gap = _gap_at(*(_parts_at(each, move, fraction, x, y) for each, move in ((a, move_a), (b, move_b))))
        return float(gap[0]), float(gap[NX]), float(gap[NY])

    fraction, was_apart = 0.0, False
    for _ in range(BOX_STOPS):
        separation, nx, ny = look(fraction)
        if separation <= tolerance:
            soon = min(1.0, fraction + 1.0 / (LOOKS * LOOKS))
            if was_apart or look(soon)[0] < separation - TOLERANCE * speed:
                return fraction, nx, ny
            fraction += 1.0 / LOOKS
        else:
            was_apart = True
            if fraction == 1.0:
                return MISS, nx, ny
            fraction = min(1.0, fraction + separation / speed) if speed > 0.0 else 1.0
        if fraction > 1.0:
            return MISS, nx, ny
    return fraction, nx, ny
