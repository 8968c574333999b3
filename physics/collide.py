"""Two shapes at two poses, without a world."""

from dataclasses import dataclass

import numpy as np

from physics import checks, stages
from physics.geometry import Library
from physics.narrowphase.placement import refresh_aabbs
from physics.queries import _pose, place
from physics.shapes import SHAPES, TileGrid
from physics.tables import BODY, SHAPE


@dataclass(frozen=True)
class Manifold:
    """Where two shapes touch: unit normal from A to B, points (n, 2) midway between the surfaces [px], separations (n,)
    negative where they overlap, features (n,) that tell the points apart, shared area of two masks [px2].

    len() is the number of points; without any the normal is (0, 0).
    """
    normal: tuple[float, float]
    points: np.ndarray
    separations: np.ndarray
    features: np.ndarray
    area: float

    def __len__(self):
        return len(self.points)


def collide(shape_a, pose_a, shape_b, pose_b, margin=0.0) -> Manifold:
    """Contact of two shapes at poses (x, y, angle); apart by more than margin [px]: no points.

    Against a TileGrid the points of all tiles stand together, with the normal of the deepest one. Raises TypeError,
    ValueError.
    """
    for name, shape in (("shape_a", shape_a), ("shape_b", shape_b)):
        if not isinstance(shape, SHAPES):
            raise TypeError(f"{name} must be a shape such as Circle(8) (got {shape!r})")
    margin = checks.number("margin", margin, low=0.0)
    library = Library()
    bodies, shapes = np.zeros(2, BODY), np.zeros(2, SHAPE)
    for row, (name, shape, pose) in enumerate((("pose_a", shape_a, pose_a), ("pose_b", shape_b, pose_b))):
        pose = _pose(name, pose)
        if isinstance(shape, TileGrid) and pose[2] != 0.0:
            raise ValueError(f"{name} must have angle 0 for a TileGrid (got {pose[2]})")
        place(library, shape, bodies, shapes, row, pose)
    refresh_aabbs(library.tables, bodies, shapes)
    contacts = stages.exact_narrow_phase().collide(library.tables, bodies, shapes, np.array([[0, 1]], np.int64), 1, margin,
                                                   0.0, stages.no_work())
    if not len(contacts):
        return Manifold((0.0, 0.0), np.zeros((0, 2)), np.zeros(0), np.zeros(0, np.int64), 0.0)
    deepest = contacts[np.argmin(contacts["separation"])]
    return Manifold((float(deepest["normal_x"]), float(deepest["normal_y"])),
                    np.stack([contacts["point_x"], contacts["point_y"]], axis=1), contacts["separation"].copy(),
                    contacts["feature"].copy(), float(contacts["area"].sum()))
