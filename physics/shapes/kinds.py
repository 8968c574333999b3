"""All kinds of shapes, and the mass of any of them.

A shape is an immutable value in body space, in pixels; x right, y down, angles clockwise on the screen. It knows its
geometry and its mass; where it is, its body knows. All but PixelMask and TileGrid compare by value.
"""

from physics import checks
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.lines import Chain, Segment
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.overlapping import weighed_once
from physics.shapes.tiles import TileGrid

Shape = Circle | Capsule | Polygon | Segment | Chain | TileGrid | PixelMask | Bounds
SHAPES = (Circle, Capsule, Polygon, Segment, Chain, TileGrid, PixelMask, Bounds)


def mass_of(shapes: Shape | tuple[Shape, ...] | list[Shape], density: float) -> Mass:
    """Mass of one shape or several together: inertia about the common centre of mass. Where they overlap they are
    weighed once, as the densest.

    density [mass per px2] is that of shapes without a material of their own.
    Raises TypeError for what is no shape, ValueError for a density that is not > 0.
    """
    density = checks.number("density", density, above=0.0)
    parts = shapes if isinstance(shapes, (tuple, list)) else (shapes,)
    for shape in parts:
        if not isinstance(shape, SHAPES):
            raise TypeError(f"shapes must be shapes (got {checks.shown(shape)})")
    return weighed_once([(shape, density if shape.material is None else shape.material.density) for shape in parts])
