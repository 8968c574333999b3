"""Bounds: the AABB tier of another shape."""

import copy
import math
from dataclasses import dataclass

from physics import checks
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.own_values import EqualByValue


@dataclass(frozen=True)
class Bounds(EqualByValue):
    """The wrapped shape's world AABB at its pose, as a shape: the AABB tier. It has the own values of what it wraps.

    Raises TypeError for what is no Circle, Capsule, Polygon or PixelMask.
    """

    shape: Circle | Capsule | Polygon | PixelMask

    def __post_init__(self):
        if not isinstance(self.shape, (Circle, Capsule, Polygon, PixelMask)):
            raise TypeError(f"shape must be a Circle, Capsule, Polygon or PixelMask (got {checks.shown(self.shape)})")
        inner = self.shape
        object.__setattr__(self, "shape", inner.bare)
        if inner is not inner.bare:
            vars(self).update(vars(copy.copy(self).with_values_of(inner)))

    @property
    def smallest_half(self) -> float:
        return self.shape.smallest_half

    def mass_of(self, density: float) -> Mass:
        return self.shape.mass_of(density)

    def reach(self, x: float, y: float) -> float:
        """Of the AABB at any angle: no corner of it is further from the origin than the shape reaches, times sqrt 2."""
        return math.sqrt(2.0) * self.shape.reach(0.0, 0.0) + math.hypot(x, y)
