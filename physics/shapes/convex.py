"""Convex shapes: a hull of corners with a rounding radius.
Circle has one corner, Capsule two, Polygon three to sixteen."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from physics import checks
from physics.checks import Pair, Points
from physics.settings import MAX_CORNERS
from physics.shapes.mass import Mass, polygon_mass, rounded_mass
from physics.shapes.own_values import EqualByValue
from physics.vec2 import Vec2

STRAIGHT = 1e-12  # [rad] a smaller turn is none
CORNER_OF = partial(tuple.__new__, Vec2)  # of two numbers; Vec2._make counts them first
PHYSICS = __name__.removesuffix(".shapes.convex")  # what a user imports
SHORTEST = 1e-9  # of a hull's size: below, the direction of an edge is lost when the hull is moved about


def reach(points: Iterable[Pair], radius: float, x: float, y: float) -> float:
    """Distance [px] from (x, y) to the furthest point of a rounded hull."""
    return max(math.hypot(px - x, py - y) for px, py in points) + radius


@dataclass(frozen=True)
class Circle(EqualByValue):
    """A disc. Raises ValueError for a radius that is not > 0."""

    radius: float
    center: Pair = Vec2(0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "radius", checks.number("radius", self.radius, above=0.0))
        object.__setattr__(self, "center", checks.vector("center", self.center))

    @property
    def smallest_half(self) -> float:
        return self.radius

    def mass_of(self, density: float) -> Mass:
        mass = density * math.pi * self.radius * self.radius
        return Mass(mass, Vec2(*self.center), mass * self.radius * self.radius / 2.0)

    def reach(self, x: float, y: float) -> float:
        return reach((self.center,), self.radius, x, y)


@dataclass(frozen=True)
class Capsule(EqualByValue):
    """All points within a radius of the line from a to b.
    Raises ValueError for a radius that is not > 0, or no length."""

    a: Pair
    b: Pair
    radius: float

    def __post_init__(self):
        a, b = checks.vector("a", self.a), checks.vector("b", self.b)
        radius = checks.number("radius", self.radius, above=0.0)
        if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST * max(radius, *map(abs, a), *map(abs, b)):
            raise ValueError(
                f"a and b must be two points with a length between them (got {a} and {b}); "
                "a capsule without length is a Circle"
            )
        object.__setattr__(self, "a", a)
        object.__setattr__(self, "b", b)
        object.__setattr__(self, "radius", radius)

    @property
    def points(self) -> tuple[Pair, Pair]:
        return self.a, self.b

    @property
    def smallest_half(self) -> float:
        return self.radius

    def mass_of(self, density: float) -> Mass:
        """A rectangle and two half discs, whose centres of mass lie 4r/3π beyond the ends of the line."""
        length = math.hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])
        r = self.radius
        middle, ends = density * 2.0 * r * length, density * math.pi * r * r
        inertia = middle * (length * length + 4.0 * r * r) / 12.0 + ends * (
            r * r / 2.0 + length * length / 4.0 + length * 4.0 * r / (3.0 * math.pi)
        )
        center = Vec2(self.a[0] + 0.5 * (self.b[0] - self.a[0]), self.a[1] + 0.5 * (self.b[1] - self.a[1]))
        return Mass(middle + ends, center, inertia)

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, self.radius, x, y)


@dataclass(frozen=True)
class Polygon(EqualByValue):
    """A convex polygon of 3 to 16 corners in either winding; kept clockwise on the screen;
    grown and rounded by a radius.

    Raises ValueError for too few or many corners, for zero area, for three corners in line or equal ones, for a
    concave outline, and for a radius that is not >= 0.
    """

    points: Points
    radius: float = 0.0

    def __post_init__(self):
        points = checks.columns("points", self.points)
        object.__setattr__(self, "radius", checks.number("radius", self.radius, low=0.0))
        if not 3 <= len(points) <= MAX_CORNERS:
            raise ValueError(f"points must be 3..{MAX_CORNERS} corners (got {len(points)})")
        edges = np.roll(points, -1, axis=0) - points
        following = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
        scale = np.hypot(*edges.T) * np.hypot(*following.T)
        shortest = np.hypot(*edges.T).min() <= SHORTEST * np.ptp(points, axis=0).max()
        if shortest or np.any(np.abs(turns) <= STRAIGHT * scale):
            raise ValueError(f"points must have no equal corners and no three in line (got {points.tolist()})")
        # All turns to one side, and once around: a star also turns to one side only.
        around = np.arctan2(turns, (edges * following).sum(axis=1)).sum()
        if not (np.all(turns > 0) or np.all(turns < 0)) or abs(around) > 1.5 * math.tau:
            raise ValueError(
                f"points must be convex (got {checks.shown(points.tolist())}); {PHYSICS}.decompose splits a concave "
                "outline into convex parts"
            )
        if turns[0] < 0:
            points = points[::-1]
        object.__setattr__(self, "points", tuple(Vec2(x, y) for x, y in points.tolist()))

    @classmethod
    def known(cls, points: list[list[float]]) -> "Polygon":
        """Of corners [px] that are known to be as they are kept, convex and clockwise on the screen: nothing is
        checked. For outlines of masks, which have thousands."""
        found = object.__new__(cls)
        vars(found).update(points=tuple(map(CORNER_OF, points)), radius=0.0)
        return found

    @classmethod
    def box(cls, width: float, height: float, center: Pair = (0.0, 0.0), angle: float = 0.0) -> "Polygon":
        """A box of full sizes, turned about its centre."""
        half_width = checks.number("width", width, above=0.0) / 2.0
        half_height = checks.number("height", height, above=0.0) / 2.0
        x, y = checks.vector("center", center)
        angle = checks.number("angle", angle)
        cosine, sine = math.cos(angle), math.sin(angle)
        corners = (
            (-half_width, -half_height),
            (half_width, -half_height),
            (half_width, half_height),
            (-half_width, half_height),
        )
        return cls(tuple((x + cosine * u - sine * v, y + sine * u + cosine * v) for u, v in corners))

    @cached_property
    def smallest_half(self) -> float:
        """From its centre of mass to the nearest edge, and the radius: of a box, half of its shorter side."""
        points = np.array(self.points)
        edges = np.roll(points, -1, axis=0) - points
        outward = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(*edges.T)[:, None]
        from_center = points - np.array(self.mass_of(1.0).center)
        return float((from_center * outward).sum(axis=1).min()) + self.radius

    def mass_of(self, density: float) -> Mass:
        if self.radius == 0.0:
            return polygon_mass(self.points, density)
        return rounded_mass(self.points, self.radius, density)

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, self.radius, x, y)
