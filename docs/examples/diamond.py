"""A rhombus as an example of a new convex shape: its corners, and one line in SHAPES of physics/shapes/kinds.py."""

from dataclasses import dataclass

from physics import checks
from physics.shapes.values import Convex, Polygon


@dataclass(frozen=True)
class Diamond(Convex):
    """A rhombus about the origin, with two diagonals [px] and a rounding radius [px]. Raises TypeError, ValueError."""

    width: float
    height: float
    radius: float = 0.0

    def __post_init__(self):
        for name in ("width", "height"):
            object.__setattr__(self, name, checks.number(name, getattr(self, name), above=0.0))
        x, y = self.width / 2.0, self.height / 2.0
        # A Polygon checks the corners and the radius, and has them clockwise on the screen.
        outline = Polygon([(x, 0.0), (0.0, y), (-x, 0.0), (0.0, -y)], self.radius)
        object.__setattr__(self, "points", outline.points)
        object.__setattr__(self, "radius", outline.radius)
