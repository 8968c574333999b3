"""List of all types of shapes, checks of arguments, and the shape Bounds, which is the AABB of another shape."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks, hints
from physics.annotations import Pose
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass, weighed_once
from physics.shapes.shape import EqualByValue, Parts, Placed, Shape, immutable, parts_of, rectangle
from physics.shapes.values import Capsule, Chain, Circle, Polygon, Segment, TileGrid
from physics.tables.body import DYNAMIC
from physics.tables.shape import BOUNDS


@immutable
@dataclass(frozen=True)
class Bounds(EqualByValue):
    """A shape that is the world AABB of another shape at its present pose.

    shape: a Circle, Capsule, Polygon or PixelMask. The Bounds has this shape's material, filter and sensor.

    Raises TypeError if `shape` is of another type.
    """

    shape: Shape
    _kind, _is_convex, _has_mass = BOUNDS, True, True

    def __post_init__(self):
        if not isinstance(self.shape, solids := with_area()):
            hint = hints.in_place_of_shape(self.shape)
            raise TypeError(f"shape must be a {names_of(solids)} (got {checks.shown(self.shape)}){hint}")
        inner = self.shape
        object.__setattr__(self, "shape", inner.bare)
        if inner is not inner.bare:
            vars(self).update(vars(copy.copy(self).with_values_of(inner)))

    @property
    def _inner(self) -> Shape:
        return self.shape

    @property
    def bounds(self) -> tuple[float, float, float, float] | None:
        return self.shape.bounds

    @property
    def min_half_extent(self) -> float:
        return self.shape.min_half_extent

    def mass_of(self, density: float) -> Mass:
        return self.shape.mass_of(density)

    def reach(self, x: float, y: float) -> float:
        """Return an upper bound of the distance [px] from (x, y) to the farthest point of the AABB, at any angle.

        x, y: coordinates in body space [px]; they are not checked.
        """
        return math.sqrt(2.0) * self.shape.reach(0.0, 0.0) + math.hypot(x, y)

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        """Return the AABB at angle 0 as one convex hull [(corners (4, 2), radius 0)]; [] if the shape is empty."""
        hulls = self.shape._hulls()
        if not hulls:
            return []
        low = np.min([corners.min(axis=0) - radius for corners, radius in hulls], axis=0)
        high = np.max([corners.max(axis=0) + radius for corners, radius in hulls], axis=0)
        return [(np.array(rectangle(*low, *high)), 0.0)]

    def _parts_at(self, placed: Placed) -> Parts:
        box, x, y = placed.shapes[placed.row], placed.x, placed.y
        return parts_of([rectangle(box["min_x"] - x, box["min_y"] - y, box["max_x"] - x, box["max_y"] - y)])


# A new type of shape is added at the end: in a test of two shapes, the shape whose type is listed earlier comes first.
SHAPES: list[type[Shape]] = [
    Circle,
    Capsule,
    Polygon,
    Segment,
    Chain,
    TileGrid,
    PixelMask,
    Bounds,
]  # fmt: skip


def with_area() -> tuple[type[Shape], ...]:
    """Return the types of shapes that have an area: they can carve masks and be wrapped in a Bounds."""
    return tuple(each for each in SHAPES if each._has_mass and each is not Bounds)


def names_of(types: Iterable[type[Shape]]) -> str:
    """Return the names of types as text for an error message: "A, B or C"."""
    *most, last = (each.__name__ for each in types)
    return f"{', '.join(most)} or {last}" if most else last


def checked_shapes(name: str, values: Iterable[Any]) -> tuple[Shape, ...]:
    """Return `values` as a tuple of shapes.

    Raises TypeError for a value that is not a shape; the message contains `name`, the name of the argument.
    """
    values, types = tuple(values), tuple(SHAPES)
    for each in values:
        if not isinstance(each, types):
            hint = hints.in_place_of_shape(each, many=True)
            raise TypeError(f"{name} must be shapes such as Circle(8) (got {checks.shown(each)}){hint}")
    return values


def checked_shape(name: str, value: Any) -> Shape:
    """Return `value` if it is a shape, else raise TypeError. name: name of the argument, for the message."""
    if not isinstance(value, tuple(SHAPES)):
        hint = hints.in_place_of_shape(value)
        raise TypeError(f"{name} must be a shape such as Circle(8) (got {checks.shown(value)}){hint}")
    return value


def checked_pose(shape_name: str, shape: Any, pose_name: str, pose: Pose) -> tuple[float, float, float]:
    """Return `pose` as (x, y, angle) [px, px, rad] if the shape can have this pose, else raise an error.

    shape_name, pose_name: names of the two arguments, for messages. Raises TypeError if `shape` is not a shape, and
    TypeError or ValueError if `pose` is not a pose. Raises ValueError if the shape cannot have the pose's angle.
    """
    checked_shape(shape_name, shape)
    found = checks.pose(pose_name, pose)
    if found[2] != 0.0 and not shape._may_turn:
        raise ValueError(f"{pose_name} must have angle 0 for a {type(shape).__name__} (got {found[2]})")
    return found


def check_shapes(shapes: Sequence, kind: int, angles: ArrayLike) -> None:
    """Raise an error if bodies of this kind at these angles [rad] cannot have these shapes.

    kind: STATIC, KINEMATIC or DYNAMIC. Raises TypeError for a value that is not a shape, ValueError for a shape that
    such bodies cannot have. A dynamic body needs a shape with an area.
    """
    for shape in checked_shapes("shapes", shapes):
        shape._check_body(kind, angles)
    if kind == DYNAMIC and shapes and not any(shape._has_mass for shape in shapes):
        raise ValueError(
            f"shapes of a dynamic body must include one with an area, a {type(shapes[0]).__name__} has none "
            f'(got {checks.shown(shapes)}): write kind="static", or add such a shape'
        )


def rank_of(shape: Shape) -> int:
    """Return the index of a shape's type in SHAPES. In a test of two shapes, the lower index is first."""
    return next(k for k, each in enumerate(SHAPES) if isinstance(shape, each))


def mass_of(shapes: Shape | tuple[Shape, ...] | list[Shape], density: float) -> Mass:
    """Return the total Mass of one or more shapes, with the inertia about their common centre of mass.

    shapes: a shape, or a tuple or list of shapes. Area shared by several shapes counts once, with the highest of their
        densities.
    density: mass per area [per px²], > 0, of shapes without a material.

    Raises TypeError for a value that is not a shape, ValueError for a density that is not > 0.
    """
    density = checks.number("density", density, above=0.0)
    parts = checked_shapes("shapes", shapes if isinstance(shapes, (tuple, list)) else (shapes,))
    return weighed_once([(shape, density if shape.material is None else shape.material.density) for shape in parts])
