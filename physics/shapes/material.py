"""Material: what a shape's surface and inside are made of."""

from dataclasses import dataclass

from physics import checks


@dataclass(frozen=True)
class Material:
    """What a shape is made of: density [mass per px2] > 0; friction, restitution and rolling_resistance >= 0;
    surface_speed [px/s], at which its surface runs like a conveyor's. Raises ValueError.

    rolling_resistance is a share of the radius: the torque against rolling is at most that times radius and load.
    """

    density: float = 1.0
    friction: float = 0.6
    restitution: float = 0.0
    rolling_resistance: float = 0.0
    surface_speed: float = 0.0

    def __post_init__(self):
        object.__setattr__(self, "density", checks.number("density", self.density, above=0.0))
        for name in ("friction", "restitution", "rolling_resistance"):
            object.__setattr__(self, name, checks.number(name, getattr(self, name), low=0.0))
        object.__setattr__(self, "surface_speed", checks.number("surface_speed", self.surface_speed))
