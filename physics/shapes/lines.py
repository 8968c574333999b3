"""Lines without an inside: Segment, met from both sides, and Chain, met from the front of its links."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from physics import checks
from physics.checks import Pair, Points
from physics.shapes.convex import reach
from physics.shapes.mass import NOTHING, Mass
from physics.shapes.material import Material
from physics.shapes.own_values import EqualByValue
from physics.vec2 import Vec2

SHORTEST = 1e-12  # of the largest coordinate: below, a link has no direction


def _check_length(name, a, b):
    if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST * max(map(abs, (*a, *b))):
        raise ValueError(f"{name} must be two points with a length between them (got {a} and {b})")


@dataclass(frozen=True)
class Segment(EqualByValue):
    """The line from a to b, solid from both sides; no mass. Raises ValueError for one without length."""

    a: Pair
    b: Pair

    def __post_init__(self):
        object.__setattr__(self, "a", checks.vector("a", self.a))
        object.__setattr__(self, "b", checks.vector("b", self.b))
        _check_length("a and b", self.a, self.b)

    @property
    def points(self) -> tuple[Pair, Pair]:
        return self.a, self.b

    @property
    def smallest_half(self) -> float:
        return 0.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, 0.0, x, y)


@dataclass(frozen=True)
class Chain(EqualByValue):
    """Links from point to point, met from the side of (dy, -dx): a floor is listed left to right, a solid island
    clockwise on the screen, a room counter-clockwise. No mass; for static and kinematic bodies.

    ghosts: (before, after), neighbours of the first and last point that only smooth, either may be None; materials: one
    Material per link (None: the body's). Raises ValueError for too few points, a link without length, ghosts of a loop.
    """

    points: Points
    loop: bool = False
    ghosts: Sequence[Pair | None] | None = None
    materials: Sequence[Material] | None = None

    def __post_init__(self):
        points = tuple(Vec2(x, y) for x, y in checks.columns("points", self.points).tolist())
        loop = checks.flag("loop", self.loop)
        least = 3 if loop else 2
        if len(points) < least:
            raise ValueError(
                f"points must be at least {least} for {'a loop' if loop else 'a chain'} (got {len(points)})"
            )
        for k in range(len(points) if loop else len(points) - 1):
            following = (k + 1) % len(points)
            hint = " (a loop closes itself)" if following == 0 else ""
            _check_length(f"points[{k}] and points[{following}]{hint}", points[k], points[following])
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "loop", loop)
        object.__setattr__(self, "ghosts", self._checked_ghosts())
        object.__setattr__(self, "materials", self._checked_materials())

    def _checked_ghosts(self):
        if self.ghosts is None:
            return None
        if self.loop:
            raise ValueError(
                "ghosts must be None for a loop, whose ends are each other's neighbours "
                f"(got {checks.shown(self.ghosts)})"
            )
        try:
            before, after = self.ghosts
        except (TypeError, ValueError):
            raise TypeError(
                f"ghosts must be a pair of points (before, after) (got {checks.shown(self.ghosts)})"
            ) from None
        ghosts = tuple(
            None if each is None else checks.vector(f"ghosts[{k}]", each) for k, each in enumerate((before, after))
        )
        for k, end in enumerate((self.points[0], self.points[-1])):
            if ghosts[k] is not None:
                _check_length(f"ghosts[{k}] and the end it smooths", ghosts[k], end)
        return ghosts

    def _checked_materials(self):
        if self.materials is None:
            return None
        if not isinstance(self.materials, (tuple, list)):
            raise TypeError(f"materials must be a tuple of Material, one per link (got {checks.shown(self.materials)})")
        materials = tuple(self.materials)
        for k, each in enumerate(materials):
            if not isinstance(each, Material):
                raise TypeError(f"materials[{k}] must be a Material (got {checks.shown(each)})")
        if len(materials) != self.links:
            raise ValueError(f"materials must be {self.links}, one per link (got {len(materials)})")
        return materials

    @property
    def links(self) -> int:
        """How many links there are."""
        return len(self.points) if self.loop else len(self.points) - 1

    @property
    def smallest_half(self) -> float:
        return 0.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, 0.0, x, y)
