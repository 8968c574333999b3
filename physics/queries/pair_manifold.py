"""Two shapes at two poses, without a world."""

from dataclasses import dataclass

import numpy as np

from physics import checks
from physics.checks import Pose
from physics.collision.classify import kind_of_pair
from physics.collision.dispatch import exact_narrow_phase, no_work
from physics.collision.hull_pairs import collide_circle_pairs, collide_polygon_circle_pairs, collide_polygon_pairs
from physics.collision.manifold import CIRCLES, POLYGON_CIRCLE, POLYGONS, Batch, contacts_of, new_workspace
from physics.queries.pair_rows import any_pair, hull_pair, hull_row, name_of
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.mask import PixelMask
from physics.shapes.tiles import TileGrid
from physics.tables.manifold import MANIFOLD
from physics.vec2 import Vec2

# What a pass over one pair is given and only reads.
PAIRS = {False: np.array([[0, 1]], np.int64), True: np.array([[1, 0]], np.int64)}
KINDS = {kind: np.array([kind], np.int64) for kind in (CIRCLES, POLYGON_CIRCLE, POLYGONS)}
HULL_PASSES = {
    CIRCLES: collide_circle_pairs,
    POLYGON_CIRCLE: collide_polygon_circle_pairs,
    POLYGONS: collide_polygon_pairs,
}
NAMES = MANIFOLD.names or ()


@dataclass(frozen=True)
class Manifold:
    """Where two shapes touch: unit normal from A to B, points (n, 2) midway between the surfaces [px], separations (n,)
    negative where they overlap, features (n,) that tell the points apart, shared area of two masks [px2].

    len() is the number of points; without any the normal is (0, 0).
    """

    normal: Vec2
    points: np.ndarray
    separations: np.ndarray
    features: np.ndarray
    area: float

    def __len__(self):
        return len(self.points)


def collide(shape_a: Shape, pose_a: Pose, shape_b: Shape, pose_b: Pose, margin: float = 0.0) -> Manifold:
    """Contact of two shapes at poses (x, y) or (x, y, angle); apart by more than margin [px]: no points.

    Asked in the other order the points and separations are the same, and the normal is turned round. Against a TileGrid
    or a Chain the points of all tiles or links stand together, with the normal of the deepest one; two of these never
    meet. Raises TypeError, ValueError.
    """
    for name, shape in (("shape_a", shape_a), ("shape_b", shape_b)):
        if not isinstance(shape, SHAPES):
            raise TypeError(f"{name} must be a shape such as Circle(8) (got {checks.shown(shape)})")
    margin = checks.number("margin", margin, low=0.0)
    poses = []
    for name, shape, pose in (("pose_a", shape_a, pose_a), ("pose_b", shape_b, pose_b)):
        poses.append(checks.pose(name, pose))
        if isinstance(shape, TileGrid) and poses[-1][2] != 0.0:
            raise ValueError(f"{name} must have angle 0 for a TileGrid (got {poses[-1][2]})")
    key_a, key_b = name_of(shape_a), name_of(shape_b)
    swapped = (*key_b[:2], poses[1], key_b[2]) < (*key_a[:2], poses[0], key_a[2])
    row_a, row_b = hull_row(shape_a), hull_row(shape_b)
    if row_a is None or row_b is None:
        return _collide_any(shape_a, poses[0], shape_b, poses[1], margin, swapped)
    return _collide_hulls(hull_pair(row_a, poses[0], row_b, poses[1]), margin, swapped)


def _collide_hulls(rows, margin, swapped) -> Manifold:
    """Of two convex shapes: the one pass that they need, and at most one manifold."""
    low, high = sorted(rows.shapes["kind"].tolist())
    kind = kind_of_pair(low, high)
    batch = Batch(rows.geometry, rows.bodies, rows.shapes, PAIRS[swapped], KINDS[kind], 1, margin, 0.0)
    found = np.frombuffer(bytearray(MANIFOLD.itemsize), MANIFOLD)
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
    library, rows = any_pair(shape_a, pose_a, shape_b, pose_b)
    narrow = exact_narrow_phase()

    def points_of(swapped):
        return contacts_of(narrow.collide(library, rows.bodies, rows.shapes, PAIRS[swapped], margin, no_work()))

    contacts = points_of(swapped)
    if not len(contacts):
        return nowhere()
    deepest = contacts[np.argmin(contacts["separation"])]
    sign = -1.0 if swapped else 1.0
    features = contacts["feature"].copy()
    if swapped and isinstance(shape_a, PixelMask) and isinstance(shape_b, PixelMask):
        features = points_of(False)["feature"].copy()  # a pixel of the mask that was named first
    return Manifold(
        Vec2(sign * float(deepest["normal_x"]) + 0.0, sign * float(deepest["normal_y"]) + 0.0),
        np.stack([contacts["point_x"], contacts["point_y"]], axis=1),
        contacts["separation"].copy(),
        features,
        float(contacts["area"].sum()),
    )


def nowhere() -> Manifold:
    """Of shapes that do not touch."""
    return Manifold(Vec2(0.0, 0.0), np.zeros((0, 2)), np.zeros(0), np.zeros(0, np.int64), 0.0)
