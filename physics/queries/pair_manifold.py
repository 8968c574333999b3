"""Two shapes at two poses, without a world."""

from dataclasses import dataclass

import numpy as np

from physics import checks
from physics.checks import Pose
from physics.collision.dispatch import exact_narrow_phase, no_work
from physics.collision.manifold import contacts_of
from physics.shapes.kinds import SHAPES, Shape
from physics.shapes.library import Library
from physics.shapes.mask import PixelMask
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rows import place
from physics.shapes.tiles import TileGrid
from physics.tables.body import BODY
from physics.tables.shape import SHAPE
from physics.vec2 import Vec2


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


def _order(shape, pose):
    """What decides which of two shapes goes first, whichever is named first:
    ties between equal ways out fall the same."""
    pixels = shape.solid.tobytes() if isinstance(shape, (PixelMask, TileGrid)) else b""
    return SHAPES.index(type(shape)), repr(shape), pose, pixels


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
    library = Library()
    bodies, shapes = np.zeros(2, BODY), np.zeros(2, SHAPE)
    given = ((shape_a, poses[0]), (shape_b, poses[1]))
    for row, (shape, pose) in enumerate(given):
        place(library, shape, bodies, shapes, row, pose)
    refresh_aabbs(np.arange(2), library.tables, bodies, shapes)
    narrow = exact_narrow_phase()

    def points_of(first, second):
        pair = np.array([[first, second]], np.int64)
        return contacts_of(narrow.collide(library.tables, bodies, shapes, pair, margin, no_work()))

    swapped = _order(*given[1]) < _order(*given[0])
    contacts = points_of(1, 0) if swapped else points_of(0, 1)
    if not len(contacts):
        return Manifold(Vec2(0.0, 0.0), np.zeros((0, 2)), np.zeros(0), np.zeros(0, np.int64), 0.0)
    deepest = contacts[np.argmin(contacts["separation"])]
    sign = -1.0 if swapped else 1.0
    features = contacts["feature"].copy()
    if swapped and isinstance(shape_a, PixelMask) and isinstance(shape_b, PixelMask):
        features = points_of(0, 1)["feature"].copy()  # a pixel of the mask that was named first
    return Manifold(
        Vec2(sign * float(deepest["normal_x"]) + 0.0, sign * float(deepest["normal_y"]) + 0.0),
        np.stack([contacts["point_x"], contacts["point_y"]], axis=1),
        contacts["separation"].copy(),
        features,
        float(contacts["area"].sum()),
    )
